"""The virtual bench behind its wires: protocols, pacing, faults; any program may be at the other end."""

from __future__ import annotations

import socket
import struct
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace

import numpy as np
import pytest

from ahrs_lab.errors import InputError
from ahrs_lab.instruments.links.faulty import LinkFaults
from ahrs_lab.recording.samples import Samples
from ahrs_lab.simulation.servers.ahrs_service import AhrsService, UnitFaults
from ahrs_lab.simulation.servers.linked_toml import linked_bench
from ahrs_lab.simulation.servers.served_bench import (
    ServedBench,
    ServeSettings,
    bench_from_toml,
    serve_bench,
    unit_faults_from_text,
)
from ahrs_lab.simulation.servers.served_world import ServedWorld
from ahrs_lab.simulation.servers.vectornav_speech import VectorNavSpeech
from ahrs_lab.simulation.settings import SimulationSettings


@contextmanager
def connected(bench: ServedBench, name: str) -> Iterator[socket.socket]:
    place = bench.places[name]
    with socket.create_connection((place.host, place.port), 5.0) as wire:
        wire.settimeout(5.0)
        yield wire


@pytest.fixture
def bench() -> Iterator[ServedBench]:
    with serve_bench(SimulationSettings.ideal(), ServeSettings(ahrs_on="tcp")) as served:
        yield served
        assert served.server.failure is None


def ask_acl(wire: socket.socket, text: str) -> tuple[int, str]:
    wire.sendall(text.encode() + b"\r\n")
    reply = b""
    while len(reply) < 8 or len(reply) < 8 + struct.unpack_from("<i", reply, 4)[0]:
        reply += wire.recv(4096)
    return struct.unpack_from("<i", reply)[0], reply[8:].decode()


def ask_line(wire: socket.socket, text: str) -> str:
    wire.sendall(text.encode() + b"\n")
    reply = b""
    while not reply.endswith(b"\n"):
        reply += wire.recv(4096)
    return reply.decode().strip()


def test_the_table_turns_when_told_in_acl(bench: ServedBench) -> None:
    with connected(bench, "table") as wire:
        for command in (":Interlock:Reset 1", ":I:C 1", ":D:R 1,20", ":M:R 1"):
            assert ask_acl(wire, command) == (0, "OK")
        time.sleep(0.2)
        code, text = ask_acl(wire, ":Read:Pos? 1;Rate? 1")
        angle, rate = (float(part) for part in text.split(";"))
        assert code == 0
        assert angle > 0.5
        assert rate == pytest.approx(20.0)
        assert ask_acl(wire, ":Nonsense 1")[0] != 0
    assert bench.served.world.table.turning()


def test_every_acl_answer_takes_the_tables_two_milliseconds(bench: ServedBench) -> None:
    with connected(bench, "table") as wire:
        ask_acl(wire, "*IDN?")
        start = time.monotonic()
        for _ in range(20):
            ask_acl(wire, ":Mode? 1")
        assert time.monotonic() - start >= 20 * 0.002


def test_supply_and_room_answer_scpi_and_the_supply_feeds_the_unit(bench: ServedBench) -> None:
    with connected(bench, "supply") as supply, connected(bench, "room") as room:
        assert "supply" in ask_line(supply, "*IDN?")
        supply.sendall(b"CURR 1.0\nVOLT 12\nOUTP ON\n")
        assert ask_line(supply, "OUTP?;VOLT?") == "1;12"
        assert float(ask_line(supply, "MEASure:VOLTage:DC?")) == pytest.approx(12.0)
        assert ask_line(supply, "NONSENSE;SYST:ERR?").startswith("-113")
        assert float(ask_line(room, "MEAS:TEMP?")) == pytest.approx(20.0)
    assert bench.served.powered


def test_the_fixture_mounts_and_sets_faults(bench: ServedBench) -> None:
    with connected(bench, "fixture") as wire:
        assert ask_line(wire, "mount UEN") == "OK"
        assert bench.served.world.orientation.letters == "UEN"
        assert ask_line(wire, "mount XYZ").startswith("NO ")
        assert ask_line(wire, "fault table_ignores_commands") == "OK"
        assert bench.served.world.faults.active("table_ignores_commands", bench.served.now_s) is not None
        assert ask_line(wire, "mend table_ignores_commands") == "OK"
        assert ask_line(wire, "dance").startswith("NO ")


def test_a_unit_without_power_says_nothing_and_with_it_streams_unasked(bench: ServedBench) -> None:
    with connected(bench, "ahrs") as wire:
        wire.sendall(b"$VNRRG,01*XX\r\n")
        wire.settimeout(0.2)
        with pytest.raises(TimeoutError):
            wire.recv(100)
        with bench.served.world.lock:
            bench.served.world.supply.set_output(12.0, 1.0)
            bench.served.world.supply.on()
        wire.settimeout(5.0)
        received = b""
        while received.count(b"$VNYMR") < 3:
            received += wire.recv(4096)


def test_samples_at_a_lower_rate_are_means_over_what_is_left_out() -> None:
    world = ServedWorld(SimulationSettings.ideal(), stepped=True)
    service = AhrsService(world, VectorNavSpeech(100.0, "VN-100", "1"))
    speech = service.speech
    assert isinstance(speech, VectorNavSpeech)
    assert speech.rate_hz == 25.0
    number = np.arange(1.0, 43.0)
    whole = Samples({"t_s": number * 0.01, "counter": number, "gyro_x": number})
    blocks = [service._at_its_rate(whole.rows(a, b)) for a, b in ((0, 3), (3, 4), (4, 17), (17, 42))]
    joined = np.concatenate([block["gyro_x"] for block in blocks if len(block)])
    assert joined == pytest.approx(number[:40].reshape(10, 4).mean(axis=1))
    times = np.concatenate([block["t_s"] for block in blocks if len(block)])
    assert times == pytest.approx(np.arange(1, 11) * 0.04)


def test_bytes_are_lost_as_asked_and_always_the_same_ones() -> None:
    faults = UnitFaults(LinkFaults(lose=0.01), seed=3)
    sent = []
    for _ in range(2):
        service = AhrsService(
            ServedWorld(SimulationSettings.ideal()), VectorNavSpeech(100.0, "V", "1"), faults
        )
        service._send(bytes(10_000), 0.0)
        sent.append(len(service._held[0]))
    assert sent[0] == sent[1]
    assert 9800 < sent[0] < 9980


def test_faults_from_a_command_line() -> None:
    text = "lose=1e-5,merge_s=0.016,reboot_at_s=30,counter_start=65000,table_trips=12"
    unit, settings = unit_faults_from_text(text, SimulationSettings.ideal())
    assert unit == UnitFaults(LinkFaults(lose=1e-5, merge_s=0.016), reboot_at_s=30.0, counter_start=65000)
    assert [(fault.name, fault.at_s) for fault in settings.fault] == [("table_trips", 12.0)]
    with pytest.raises(InputError, match="did you mean"):
        unit_faults_from_text("loose=1", SimulationSettings.ideal())
    with pytest.raises(InputError, match="needs a number"):
        unit_faults_from_text("reboot_at_s=soon", SimulationSettings.ideal())


def test_a_bench_file_with_and_without_a_serve_table() -> None:
    settings, serve = bench_from_toml({"kind": "simulated", "seed": 4, "serve": {"ahrs": "xsens"}})
    assert settings.seed == 4
    assert serve.ahrs == "xsens"
    assert bench_from_toml({})[1] == ServeSettings()
    with pytest.raises(InputError, match="“simulated” can be served"):
        bench_from_toml({"kind": "instruments"})


def test_the_bench_file_for_the_other_side_names_every_port(bench: ServedBench) -> None:
    data = linked_bench(bench)
    assert data["table"]["link"] == {"host": "127.0.0.1", "port": bench.places["table"].port}
    assert data["ahrs"]["rate_hz"] == 100.0
    assert data["operator"]["kind"] == "simulated-hands"
    assert "speed" not in data


def test_ports_can_be_chosen_and_a_taken_one_is_told() -> None:
    from ahrs_lab.errors import MachineError

    with socket.create_server(("127.0.0.1", 0)) as taken:
        port = taken.getsockname()[1]
        with pytest.raises(MachineError, match=f"Port {port} cannot be opened"):
            serve_bench(SimulationSettings.ideal(), replace(ServeSettings(), table_port=port))
