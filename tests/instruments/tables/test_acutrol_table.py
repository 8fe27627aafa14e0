"""The ACUTROL driver: order of commands, unwrapped angles, moves of many turns, faults, limits, watchdog."""

from __future__ import annotations

import numpy as np
import pytest

from ahrs_lab.errors import AbortedError, InputError, InstrumentError
from ahrs_lab.instruments.angles import wrap_180
from ahrs_lab.instruments.drivers.tables.acutrol import AcutrolSettings, AcutrolTable
from ahrs_lab.instruments.drivers.tables.soft_limits import SoftLimits
from ahrs_lab.instruments.links.faulty import ByteDamage, LinkFaults
from ahrs_lab.instruments.links.link import LinkLostError
from ahrs_lab.instruments.links.link_settings import LinkSettings, make_link
from ahrs_lab.instruments.protocols.acutrol import encode_reply
from ahrs_lab.instruments.protocols.acutrol_responder import AclResponder
from ahrs_lab.instruments.real_clock import RealClock
from tests.instruments.links.ports import TcpEnd, answering, tcp_end
from tests.instruments.tables.acl_bench import AclBench
from tests.instruments.tables.plant import Plant


def test_enabling_says_what_ran_on_hardware_in_that_order() -> None:
    bench = AclBench()
    bench.enable()
    assert bench.said() == [
        ":Interlock:Reset 1",
        ":Mode:Off 1",
        ":Interlock:Close 1",
        ":Demand:Rate 1,0",
        ":Mode:Rate 1",
    ]
    assert bench.table.state().enabled


def test_state_changing_commands_are_a_fifth_of_a_second_apart() -> None:
    bench = AclBench()
    times: list[float] = []
    answer = bench.link.answer

    def noting(data: bytes) -> bytes:
        if b"?" not in data:
            times.append(bench.clock.now_s())
        return answer(data)

    bench.link.answer = noting
    table = bench.enable()
    table.set_rate(20.0)
    table.move_to(3600.0, 100.0)
    bench.clock.wait(45.0)
    table.move_to(3590.0, 10.0)
    bench.clock.wait(5.0)
    assert len(times) > 12
    assert min(np.diff(times)) >= 0.2 - 1e-9


@pytest.mark.parametrize("rate_dps", [7.5, 100.0, 400.0])
@pytest.mark.parametrize("sense", [1, -1])
def test_ten_turns_and_back_end_exactly_at_the_start(rate_dps: float, sense: int) -> None:
    bench = AclBench()
    table = bench.enable()
    start = 37.25
    table.move_to(start, 30.0)
    bench.clock.wait(10.0)
    assert bench.plant.angle_deg == pytest.approx(start, abs=1e-6)
    time_needed = 3600.0 / rate_dps + rate_dps / 100.0
    for target in (start + sense * 3600.0, start):
        table.move_to(target, rate_dps)
        assert table.state().moving
        # procedures allow two seconds and two per cent on top of the ideal run
        bench.clock.wait(1.02 * time_needed + (3.0 if rate_dps <= 100.0 else 6.0))
        state = table.state()
        assert not state.moving
        assert bench.plant.angle_deg == pytest.approx(target, abs=1e-6)
        assert state.angle_deg == pytest.approx(target, abs=1e-6)
        assert bench.plant.largest_rate_dps <= rate_dps * (1.0 + 1e-9) or rate_dps < 30.0


def test_the_reported_angle_wraps_and_the_driver_does_not() -> None:
    bench = AclBench()
    table = bench.enable()
    table.set_rate(300.0)
    bench.clock.wait(20.0)
    log = table.log()
    assert log.angle_deg[-1] == pytest.approx(bench.plant.angle_deg, abs=1e-3)
    assert log.angle_deg[-1] > 5000.0
    assert abs(wrap_180(log.angle_deg[-1])) <= 180.0
    assert np.all(np.diff(log.angle_deg) >= -1e-6)
    steady = log.t_s > 5.0
    slope = np.polyfit(log.t_s[steady], log.angle_deg[steady], 1)[0]
    assert slope == pytest.approx(300.0, rel=1e-4)


def test_a_late_reading_does_not_cost_a_turn() -> None:
    bench = AclBench()
    table = bench.enable()
    table.set_rate(300.0)
    bench.clock.wait(5.0)
    bench.clock.look_s = 1.9  # more than a turn between two looks
    bench.clock.wait(9.5)
    assert table.log().angle_deg[-1] == pytest.approx(bench.plant.angle_deg, abs=1e-3)


@pytest.mark.parametrize("target", [171.0, 185.0, -200.0, 359.0, 725.0])
def test_a_move_while_the_table_spins_ends_at_the_angle(target: float) -> None:
    bench = AclBench()
    table = bench.enable()
    table.set_rate(-250.0)
    bench.clock.wait(6.0)
    table.move_to(target, 90.0)
    bench.clock.wait(60.0)
    assert bench.plant.angle_deg == pytest.approx(target, abs=1e-6)
    assert not table.state().moving


def test_stop_is_one_word_said_at_once() -> None:
    bench = AclBench()
    table = bench.enable()
    table.move_to(3600.0, 100.0)
    bench.said()
    before = bench.clock.now_s()
    table.stop()
    assert bench.said() == [":Mode:Off 1"]
    assert bench.clock.now_s() == before
    bench.clock.wait(3.0)
    assert bench.said() == []
    assert bench.plant.rate_dps == 0.0
    assert not table.state().moving


def test_a_stop_between_two_commands_cancels_the_rest() -> None:
    bench = AclBench()
    table = bench.enable()
    bench.clock.wait(0.3)
    table.stop()
    bench.clock.wait(0.3)
    bench.said()
    looks = 0

    def stop_meanwhile() -> None:
        nonlocal looks
        looks += 1
        if looks == 2:
            table.stop()

    bench.clock.on_step = stop_meanwhile
    with pytest.raises(AbortedError, match="told to stop"):
        table.set_rate(50.0)
    assert bench.said() == [":Demand:Rate 1,50", ":Mode:Off 1"]
    bench.clock.on_step = table.poll
    bench.clock.wait(2.0)
    assert bench.plant.rate_dps == 0.0


def test_rate_angle_and_acceleration_beyond_the_limits_are_refused_unsaid() -> None:
    bench = AclBench(max_rate_dps=120.0, min_angle_deg=-90.0, max_angle_deg=90.0)
    table = bench.enable()
    bench.said()
    for wrong in (
        lambda: table.set_rate(120.1),
        lambda: table.set_rate(float("nan")),
        lambda: table.move_to(90.5, 10.0),
        lambda: table.move_to(float("nan"), 10.0),
        lambda: table.move_to(10.0, 121.0),
        lambda: table.move_to(10.0, 0.0),
        lambda: table.configure(acceleration_dps2=101.0),
    ):
        with pytest.raises(InputError):
            wrong()
    assert bench.said() == []


def test_a_table_that_would_leave_its_range_is_stopped_within_it() -> None:
    bench = AclBench(min_angle_deg=-90.0, max_angle_deg=90.0)
    table = bench.enable()
    table.set_rate(50.0)
    bench.clock.wait(6.0)
    assert bench.plant.rate_dps == 0.0
    assert 60.0 < bench.plant.angle_deg <= 90.0
    assert "left the range" in table.state().fault


def test_a_trip_is_told_in_the_registers_words_and_stays_until_enabled_again() -> None:
    bench = AclBench()
    table = bench.enable()
    bench.responder.trip_limits["R"] = 40.0
    table.set_rate(60.0)
    bench.clock.wait(3.0)
    state = table.state()
    assert "rate trip" in state.fault
    assert not state.enabled
    with pytest.raises(InstrumentError, match="rate trip"):
        table.set_rate(10.0)
    bench.responder.trip_limits["R"] = 500.0
    table.enable()
    assert table.state().fault == ""
    table.set_rate(10.0)
    bench.clock.wait(2.0)
    assert table.state().rate_dps == pytest.approx(10.0)


def test_what_the_table_refuses_comes_with_its_own_text() -> None:
    bench = AclBench()
    table = bench.enable()
    bench.responder.rate_limits["R"] = 50.0
    with pytest.raises(InstrumentError, match="error 203, demand exceeds limit"):
        table.set_rate(60.0)


def test_configure_returns_what_reads_back_otherwise() -> None:
    bench = AclBench(max_rate_dps=120.0)
    table = bench.enable()
    bench.clock.wait(0.5)
    assert table.configure() == ()
    assert bench.responder.rate_limits["P"] == 120.0
    answer = bench.link.answer
    bench.link.answer = lambda data: answer(data.replace(b":Limit:Rate R,1,120", b":Limit:Rate R,1,80"))
    (difference,) = table.configure()
    assert (difference.setting, difference.wanted, difference.found) == ("Rate R", "120", "80")


def test_a_lost_link_is_told_and_the_table_is_stopped_when_it_comes_back() -> None:
    bench = AclBench()
    table = bench.enable()
    table.set_rate(60.0)
    bench.clock.wait(3.0)
    bench.link.broken = True
    bench.clock.wait(0.1)
    with pytest.raises(LinkLostError):
        table.state()
    with pytest.raises(LinkLostError):
        table.stop()
    bench.link.broken = False
    bench.clock.wait(2.0)
    assert bench.plant.rate_dps == 0.0
    state = table.state()
    assert "lost" in state.fault
    assert state.angle_deg == pytest.approx(bench.plant.angle_deg, abs=1e-3)
    table.enable()
    assert table.state().fault == ""


def test_the_watchdog_stops_the_table_when_the_heart_does() -> None:
    bench = AclBench()
    table = bench.enable()
    table.keep_alive()
    table.set_rate(60.0)
    for _ in range(8):
        bench.clock.wait(0.5)
        table.keep_alive()
    assert table.state().rate_dps == pytest.approx(60.0)
    bench.clock.wait(2.0 + 0.05 + 0.6 + 0.1)
    assert bench.plant.rate_dps == 0.0
    assert "sign of life" in table.state().fault


def test_disabling_stops_first_and_opens_last() -> None:
    bench = AclBench()
    table = bench.enable()
    table.set_rate(10.0)
    bench.said()
    table.disable()
    assert bench.said() == [":Mode:Off 1", ":Demand:Rate 1,0", ":Interlock:Open 1"]
    assert not table.state().enabled


def test_one_damaged_reading_is_asked_again_and_not_kept() -> None:
    bench = AclBench()
    table = bench.enable()
    table.set_rate(30.0)
    bench.clock.wait(3.0)
    table.log()
    answer = bench.link.answer
    damaged = 0

    def flipping(data: bytes) -> bytes:
        nonlocal damaged
        reply = bytearray(answer(data))
        if b":Read" in data and bench.clock.now_s() > 4.5 and not damaged:
            damaged = 1
            reply[8] ^= 0x08  # 1 becomes 9
        return bytes(reply)

    bench.link.answer = flipping
    bench.clock.wait(2.0)
    assert damaged
    log = table.log()
    assert np.max(np.abs(log.angle_deg - 30.0 * log.t_s - np.mean(log.angle_deg - 30.0 * log.t_s))) < 0.01
    assert table.state().fault == ""


def test_a_table_that_has_lost_its_position_is_stopped() -> None:
    bench = AclBench()
    table = bench.enable()
    table.set_rate(30.0)
    bench.clock.wait(3.0)
    bench.plant.angle_deg += 25.0
    bench.clock.wait(2.0)
    assert "jumped" in table.state().fault
    assert bench.plant.rate_dps == 0.0


def test_an_interlock_that_does_not_close_is_told() -> None:
    bench = AclBench()
    answer = bench.link.answer
    bench.link.answer = lambda data: encode_reply(0, "Open") if b":Interlock?" in data else answer(data)
    with pytest.raises(InstrumentError, match="stays open"):
        bench.table.enable()
    with pytest.raises(InstrumentError, match="not enabled"):
        bench.table.set_rate(1.0)


def test_an_interlock_that_opens_while_turning_is_told() -> None:
    bench = AclBench()
    table = bench.enable()
    table.set_rate(30.0)
    bench.clock.wait(2.0)
    bench.responder.answer(":Interlock:Open 1")
    bench.clock.wait(1.0)
    assert "interlock has opened" in table.state().fault
    assert not table.state().enabled


def is_lost(table: AcutrolTable) -> bool:
    try:
        table.state()
    except LinkLostError:
        return True
    return False


def test_over_real_tcp_in_real_time_a_thread_does_it_all_and_notices_the_plug() -> None:
    clock = RealClock()
    plant = Plant(clock, acceleration=3000.0)
    responder = AclResponder(plant)
    with tcp_end() as end:
        settings = AcutrolSettings(
            LinkSettings(host="127.0.0.1", port=end.port),
            limits=SoftLimits(1000.0, 3000.0),
            pause_s=0.02,
            reply_timeout_s=0.3,
        )
        table = AcutrolTable(settings, make_link(settings.link), clock)
        with answering(end, responder.feed):
            assert table.open() == "ACUTROL3000 (simulated)"
            table.enable()
            table.move_to(1080.0, 1000.0)
            waited = 0.0
            while table.state().moving and waited < 10.0:
                clock.wait(0.02)
                waited += 0.02
            assert table.state().angle_deg == pytest.approx(1080.0, abs=1e-3)
            assert plant.state().angle_deg == pytest.approx(1080.0, abs=1e-6)
            times = table.log().t_s
            assert np.all(np.diff(times) > 0.0)
            assert len(times) > 20
            table.set_rate(100.0)
        end.unplug()
        begin = clock.now_s()
        while not is_lost(table) and clock.now_s() < begin + 5.0:
            clock.wait(0.01)
        assert clock.now_s() - begin < 1.0
        again = TcpEnd(end.port)
        with answering(again, responder.feed):
            while plant.state().rate_dps != 0.0 and clock.now_s() < begin + 8.0:
                clock.wait(0.02)
            assert plant.state().rate_dps == 0.0
            table.close()
        again.unplug()


@pytest.mark.parametrize("seed", range(6))
def test_a_disturbed_line_ends_in_right_angles_or_in_a_fault_that_is_told(seed: int) -> None:
    bench = AclBench()
    bench.enable()
    damage = ByteDamage(LinkFaults(lose=2e-4, double=2e-4, flip=4e-4), seed)
    answer = bench.link.answer
    bench.link.answer = lambda data: damage.apply(answer(data))
    table = bench.table
    ended = ""
    try:
        table.set_rate(60.0)
        for _ in range(200):
            bench.clock.wait(0.1)
            ended = table.state().fault
            if ended:
                break
    except InstrumentError as error:
        ended = str(error)
    log = table.log()
    turning = log.t_s > 3.0
    line = np.polyfit(log.t_s[turning], log.angle_deg[turning], 1)
    if not ended:
        assert line[0] == pytest.approx(60.0, rel=1e-3)
    assert ended or np.max(np.abs(np.polyval(line, log.t_s[turning]) - log.angle_deg[turning])) < 0.5
