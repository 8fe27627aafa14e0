"""Our encoders against decoders that others wrote, and theirs against ours."""

from __future__ import annotations

import socket
import threading
import time
from typing import Any

import numpy as np
import pytest

from ahrs_lab.instruments.protocols import anpp, microstrain, nmea
from ahrs_lab.instruments.protocols.catalogue import replayed, stream_decoder
from ahrs_lab.instruments.protocols.stream import joined
from tests.instruments.protocols.streams_at_hand import samples

DEG = np.pi / 180.0


def test_the_vendor_s_decoder_reads_our_mip_stream() -> None:
    mscl = pytest.importorskip("mscl", reason="pymscl, the vendor's decoder, is not installed here")
    said = samples(400)
    stream = microstrain.encode_samples([0xD5, 0x04, 0x05, 0x0C, 0x14], said)
    done = threading.Event()
    with socket.create_server(("127.0.0.1", 0)) as server:

        def serve() -> None:
            peer, _ = server.accept()
            with peer:
                # Damage between the packets: theirs and ours have to find the next one.
                peer.sendall(b"\x75\x65\x80" + stream[: len(stream) // 2] + stream[len(stream) // 2 :])
                done.wait(30.0)

        thread = threading.Thread(target=serve)
        thread.start()
        connection = mscl.Connection.TcpIp("127.0.0.1", server.getsockname()[1])
        node = mscl.InertialNode(connection)
        packets: list[Any] = []
        end = time.monotonic() + 30.0
        while len(packets) < 400 and time.monotonic() < end:
            packets.extend(node.getDataPackets(100))
        connection.disconnect()
        done.set()
        thread.join(10.0)
    assert len(packets) == 400
    theirs = [{point.channelName(): point for point in packet.data()} for packet in packets]
    ours = replayed(stream, stream_decoder("mip"))
    for column, channel, per_unit in (
        ("gyro_x", "scaledGyroX", 1.0), ("gyro_y", "scaledGyroY", 1.0), ("gyro_z", "scaledGyroZ", 1.0),
        ("accel_x", "scaledAccelX", 1.0), ("accel_y", "scaledAccelY", 1.0), ("accel_z", "scaledAccelZ", 1.0),
        ("roll_deg", "roll", DEG), ("pitch_deg", "pitch", DEG), ("heading_deg", "yaw", DEG),
        ("temperature_c", "tempStats_mean", 1.0),
    ):  # fmt: skip
        read = np.array([point[channel].as_float() for point in theirs])
        np.testing.assert_allclose(ours[column] * per_unit, read, rtol=2e-7, atol=1e-9, err_msg=channel)
        np.testing.assert_allclose(said[column] * per_unit, read, rtol=2e-7, atol=1e-9, err_msg=channel)
    nanoseconds = [int(point["timeInfo_referenceTime_ahrsImu"].as_string()) for point in theirs]
    np.testing.assert_array_equal(np.array(nanoseconds) / 1e9, ours["t_s"])


def test_the_manufacturer_s_package_reads_our_anpp_stream() -> None:
    protocol = pytest.importorskip("advanced_navigation.anpp_packets.an_packet_protocol")
    state = pytest.importorskip("advanced_navigation.anpp_packets.an_packet_20")
    raw = pytest.importorskip("advanced_navigation.anpp_packets.an_packet_28")
    said = samples(50)
    stream = anpp.encode_samples([20, 28], said)
    theirs = protocol.ANDecoder()
    theirs.add_data(b"\x00\xff\x31" + stream)
    states: list[Any] = []
    sensors: list[Any] = []
    while (packet := theirs.decode()) is not None:
        kind, kept = (state.SystemStatePacket, states) if packet.id == 20 else (raw.RawSensorsPacket, sensors)
        found = kind()
        assert found.decode(packet) == 0
        kept.append(found)
    ours = replayed(stream, stream_decoder("anpp"))
    assert len(ours) == len(states) == len(sensors) == 50
    for i, axis in enumerate("xyz"):
        np.testing.assert_array_equal(ours[f"gyro_{axis}"], [packet.gyroscopes[i] for packet in sensors])
        np.testing.assert_array_equal(ours[f"accel_{axis}"], [packet.accelerometers[i] for packet in sensors])
    np.testing.assert_array_equal(ours["temperature_c"], [packet.imu_temperature for packet in sensors])
    for i, name in enumerate(("roll_deg", "pitch_deg", "heading_deg")):
        np.testing.assert_allclose(ours[name] * DEG, np.array([p.orientation[i] for p in states]), rtol=1e-14)
        np.testing.assert_allclose(ours[name], said[name], rtol=2e-7)
    times = [packet.unix_time_seconds + packet.microseconds / 1e6 for packet in states]
    np.testing.assert_array_equal(ours["t_s"], times)


def test_our_anpp_commands_are_the_manufacturer_s() -> None:
    periods = pytest.importorskip("advanced_navigation.anpp_packets.an_packet_181")
    timer = pytest.importorskip("advanced_navigation.anpp_packets.an_packet_180")
    wanted = periods.PacketsPeriodPacket(
        permanent=0,
        clear_existing_packets=1,
        packet_periods=[periods.PacketPeriod(20, 10), periods.PacketPeriod(28, 1)],
    )
    assert anpp.encode_packets_period([(20, 10), (28, 1)]) == anpp.encode_object(wanted)
    assert wanted.encode().bytes() == anpp.encode_packets_period([(20, 10), (28, 1)])
    period = timer.PacketTimerPeriodPacket(permanent=1, utc_synchronisation=1, packet_timer_period=1000)
    assert anpp.encode_timer_period(1000, permanent=True) == period.encode().bytes()


def test_the_manufacturer_s_objects_are_new_each_time_and_unknown_values_give_none() -> None:
    command = anpp.encode_packets_period([(28, 1)])
    packets = anpp.AnppDecoder().feed(anpp.encode_acknowledge(command) + anpp.encode_acknowledge(command, 3))
    first, second = (anpp.packet_object(packet) for packet in packets)
    assert first is not None
    assert second is not None
    assert (first.packet_id, first.acknowledge_result.value) == (181, 0)
    assert second.acknowledge_result.value == 3
    assert first.packet_crc == command[3] | command[4] << 8
    assert anpp.packet_object(anpp.AnppPacket(3, b"\xff" * 24)) is None
    assert anpp.packet_object(anpp.AnppPacket(3, b"\xff")) is None
    assert anpp.packet_object(anpp.AnppPacket(28, bytes(48))) is None


def test_published_nmea_sentences_are_read() -> None:
    # The two sentences as receiver manuals print them.
    stream = (
        b"$HEHDT,274.07,T*19\r\n$PASHR,085335.000,224.19,T,-01.26,+00.83,+00.10,0.101,0.113,0.267,1,0*07\r\n"
    )
    rows = replayed(stream, stream_decoder("nmea"))
    assert len(rows) == 1
    assert rows["t_s"][0] == 8 * 3600 + 53 * 60 + 35
    assert (rows["heading_deg"][0], rows["pitch_deg"][0], rows["roll_deg"][0]) == (224.19, 0.83, -1.26)
    heading = replayed(b"$HEHDT,274.07,T*19\r\n" * 3, stream_decoder("nmea"))
    np.testing.assert_array_equal(heading["heading_deg"], 274.07)
    assert "t_s" not in heading


def test_nmea_time_goes_on_over_midnight() -> None:
    said = samples(20)
    t_s = 86_399.5 + 0.05 * np.arange(20, dtype=np.float64)
    decoder = stream_decoder("nmea")
    data = nmea.encode_attitude(said.with_columns({"t_s": t_s}))
    rows = joined([decoder.feed(data[:700]), decoder.feed(data[700:]), decoder.flush()])
    np.testing.assert_allclose(rows["t_s"], t_s, rtol=0, atol=1e-9)
    np.testing.assert_allclose(rows["pitch_deg"], said["pitch_deg"], atol=0.005 + 1e-9)
