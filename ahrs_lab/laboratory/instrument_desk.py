"""The bench's instruments at a desk: connect each, see what it says, configure it, move the table by hand.

No Qt. Every instrument is talked to by a thread of its own (:class:`~ahrs_lab.laboratory.instrument_station.
Station`); the screen reads :attr:`InstrumentDesk.views` and never waits. The table hangs on the supervisor,
so that it is stopped when the application dies, and on the soft limits, whoever moves it.
"""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Mapping
from concurrent.futures import Future
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, cast

from ahrs_lab.errors import AhrsLabError, InputError, InstrumentError
from ahrs_lab.instruments.by_hand import HandFinding, HandRequest, SetByHand
from ahrs_lab.instruments.drivers.tables.soft_limits import SoftLimits
from ahrs_lab.instruments.interfaces import Clock, RateTable, Supply, TableState
from ahrs_lab.instruments.motion_limits import LimitedTable
from ahrs_lab.instruments.real_clock import RealClock
from ahrs_lab.instruments.registry import Drivers, Kind, Surroundings, create_instrument, find_drivers
from ahrs_lab.instruments.settings import Difference
from ahrs_lab.instruments.supervisor.client import Supervisor
from ahrs_lab.instruments.supervisor.last_stop import stop_bench
from ahrs_lab.instruments.supervisor.making import table_wire
from ahrs_lab.laboratory.bench_speed import bench_speed, check_said_speed
from ahrs_lab.laboratory.instrument_live import AhrsLook, TableLive, UnplugTest, read_room, read_supply
from ahrs_lab.laboratory.instrument_station import Station, StationView
from ahrs_lab.messages import Message

HOLD_LIMIT_S = 0.5
"""A jog button that has not been heard of for so long counts as released."""
_TABLE_LOOK_S = 0.05
_END_REACTION_S = 0.6
"""Before the limits themselves would stop the table as for a fault."""
FIRST_JOG_DPS = 30.0
_SOURCE = "bench"


@dataclass(frozen=True)
class JogLimits:
    """What a hand at the buttons may do: at most what the table's own settings allow. Angles None: no end."""

    max_rate_dps: float
    min_angle_deg: float | None = None
    max_angle_deg: float | None = None


class InstrumentDesk:
    """One bench (the TOML of kind "instruments") with its instruments; :meth:`close` it before another one,
    or a run, opens the same wires."""

    def __init__(
        self,
        bench: Mapping[str, Any],
        *,
        drivers: Drivers | None = None,
        supervised: bool = True,
        report: Path | None = None,
        clock: Clock | None = None,
    ) -> None:
        self._bench = dict(bench)
        self._drivers = drivers or find_drivers()
        self._supervised = supervised
        self._report = report
        self._speed, self._speed_refused = 1.0, None
        try:
            self._speed = bench_speed(bench, None, _SOURCE)
        except InputError as error:
            self._speed_refused = error  # told where somebody connects
        self._clock = clock or RealClock(self._speed)
        self._supervisor: Supervisor | None = None
        self._limited: LimitedTable | None = None
        self._jog = JogLimits(FIRST_JOG_DPS)
        self._held: tuple[float, float] | None = None
        self._released = True
        self._turning = False
        self._stopping: threading.Thread | None = None
        self.stop_problems: tuple[Message, ...] | None = None
        """What did not work when the bench was stopped last; None before the first stop and during one."""
        self._ahrs_look = AhrsLook()
        self.stations: dict[Kind, Station[Any]] = {
            part: station for part, station in self._all_stations().items() if part in self._bench
        }

    def _all_stations(self) -> dict[Kind, Station[Any]]:
        return {
            "table": Station(
                "table",
                self._make_table,
                self._look_at_table,
                opened=self._table_opened,
                let_go=self._let_table_go,
                look_s=_TABLE_LOOK_S,
            ),
            "ahrs": Station("ahrs", lambda: self._make("ahrs"), self._look_at_ahrs, opened=self._ahrs_opened),
            "supply": Station(
                "supply",
                lambda: self._make("supply"),
                read_supply,
                opened=lambda supply: self._check_speed("supply", supply),
            ),
            "room": Station("room", lambda: self._make("room"), read_room),
        }

    @property
    def views(self) -> dict[Kind, StationView]:
        """What is known of each instrument of the bench."""
        return {part: station.view for part, station in self.stations.items()}

    @property
    def supervised(self) -> bool:
        """Whether a supervising process watches over the table now."""
        return self._supervisor is not None and self._supervisor.running

    def station(self, part: Kind) -> Station[Any]:
        """Raises InputError where the bench has no such instrument."""
        if part not in self.stations:
            raise InputError("The bench has no {part}: add one first.", part=part)
        return self.stations[part]

    # connecting ───────────────────────────────────────────────────────────────────────────────────────────

    def connect(self, part: Kind) -> None:
        """Begin to connect; shows in :attr:`views`."""
        self.station(part).connect()

    def disconnect(self, part: Kind) -> Future[None]:
        """Let it go, the table stopped; in a thread of its own."""
        return _in_thread(self.station(part).disconnect, f"disconnect {part}")

    def close(self) -> None:
        """Release the buttons, stop the table, let everything go, take leave of the supervisor. Waits."""
        if self._stopping is not None:
            self._stopping.join()
        for station in self.stations.values():
            station.disconnect()
        self._end_supervisor()

    def _check_speed(self, part: Kind, instrument: Any) -> None:
        check_said_speed(self._speed, part, str(instrument.identify()), _SOURCE)

    def _make(self, part: Kind) -> Any:
        if self._speed_refused is not None:
            raise self._speed_refused
        return create_instrument(part, self._bench[part], Surroundings(self._clock), self._drivers)

    def _make_table(self) -> Any:
        if self._speed_refused is not None:
            raise self._speed_refused
        table = self._bench["table"]
        around = Surroundings(self._clock)
        if self._supervised and table_wire(table, self._clock, self._drivers) is not None:
            self._end_supervisor()
            supervisor = Supervisor(table, self._bench.get("supply"), speed=self._speed, report=self._report)
            supervisor.start()
            self._supervisor = supervisor
            around = replace(around, link=supervisor.table_links)
        return create_instrument("table", table, around, self._drivers)

    def _table_opened(self, table: Any) -> None:
        self._check_speed("table", table)
        self._limit(table, self._jog)

    def _let_table_go(self, table: Any) -> None:
        self._limited = None
        self._held = None
        turning, self._turning = self._turning, False
        try:
            try:
                if turning:
                    table.stop()
            finally:
                table.close()
        except AhrsLabError:
            # Not in order: the supervisor hears no farewell, tries itself, and says what came of it.
            self._abandon_supervisor()
            raise
        self._end_supervisor()

    def _abandon_supervisor(self) -> None:
        supervisor, self._supervisor = self._supervisor, None
        if supervisor is not None:
            supervisor.abandon()

    def _end_supervisor(self) -> None:
        supervisor, self._supervisor = self._supervisor, None
        if supervisor is not None:
            supervisor.close()

    # any instrument ───────────────────────────────────────────────────────────────────────────────────────

    def identify(self, part: Kind) -> Future[str]:
        """Ask it again who it is."""
        return self.station(part).ask(lambda instrument: instrument.identify())

    def configure(self, part: Kind) -> Future[tuple[Difference, ...]]:
        """Set what the bench file says, read it back; what differs, also in the view. Fails with InputError
        where the driver has nothing to configure."""
        station = self.station(part)

        def work(instrument: Any) -> tuple[Difference, ...]:
            configure = getattr(instrument, "configure", None)
            if configure is None or part == "supply":
                raise InputError("This instrument has no settings of its own that could be set.")
            differences = tuple(configure())
            station.set_differences(differences)
            if part == "ahrs":
                instrument.start()
                self._ahrs_look.restart()
            return differences

        return station.ask(work)

    # AHRS ─────────────────────────────────────────────────────────────────────────────────────────────────

    def _ahrs_opened(self, ahrs: Any) -> None:
        self._ahrs_look.restart()
        ahrs.start()

    def _look_at_ahrs(self, ahrs: Any) -> Any:
        return self._ahrs_look(ahrs)

    @property
    def unplug_test(self) -> UnplugTest:
        """Of the AHRS' data cable; ``begin()`` it."""
        return self._ahrs_look.unplug

    # power ────────────────────────────────────────────────────────────────────────────────────────────────

    def power_on(self, voltage_v: float, current_limit_a: float) -> Future[None]:
        """Set the supply and switch it on."""

        def work(supply: Supply) -> None:
            supply.set_output(voltage_v, current_limit_a)
            supply.on()

        return self.station("supply").ask(work)

    def power_off(self) -> Future[None]:
        """Switch the supply off."""
        return self.station("supply").ask(lambda supply: supply.off())

    def enter_room(self, temperature_c: float, humidity_percent: float) -> Future[None]:
        """Values that were read off a dial. Fails with InputError where the room has a sensor of its own."""

        def work(room: Any) -> None:
            enter = getattr(room, "enter", None)
            if enter is None:
                raise InputError("The room has a sensor: its values are not typed in.")
            enter(temperature_c, humidity_percent)

        return self.station("room").ask(work)

    # the table by hand ────────────────────────────────────────────────────────────────────────────────────

    @property
    def jog_limits(self) -> JogLimits:
        """What the buttons may do now."""
        return self._jog

    def set_jog_limits(self, limits: JogLimits) -> None:
        """Raises InputError where they exceed the table's own. The table has to be released."""
        if self._held is not None:
            raise InputError("The table is being moved: release the button first.")
        table = self.station("table").instrument
        if table is not None:
            self._limit(table, limits)
        self._jog = limits

    def _limit(self, table: Any, limits: JogLimits) -> None:
        own = table.limits
        rate = min(limits.max_rate_dps, own.max_rate_dps) if limits is self._jog else limits.max_rate_dps
        low = float("-inf") if limits.min_angle_deg is None else limits.min_angle_deg
        high = float("inf") if limits.max_angle_deg is None else limits.max_angle_deg
        soft = SoftLimits(rate, own.max_acceleration_dps2, low, high)
        self._limited = LimitedTable(cast(RateTable, table), soft)
        self._jog = replace(limits, max_rate_dps=rate)

    def drive_on(self) -> Future[None]:
        """Switch the table's drive on, at rest; acknowledges faults."""
        return self.station("table").ask(lambda _: self._limited_table().enable())

    def drive_off(self) -> Future[None]:
        """Stop the table and switch its drive off."""
        self.release()
        return self.station("table").ask(lambda _: self._limited_table().disable())

    def move_to(self, angle_deg: float, rate_dps: float) -> Future[None]:
        """Go to an unwrapped angle and stay."""

        def work(_: Any) -> None:
            self._limited_table().move_to(angle_deg, rate_dps)
            self._turning = True

        return self.station("table").ask(work)

    def set_rate(self, rate_dps: float) -> Future[None]:
        """Turn until something else is demanded; for a table that the operator sets by hand, which has no
        buttons to hold: what he has to do is in :attr:`hand_request`."""

        def work(_: Any) -> None:
            self._limited_table().set_rate(rate_dps)

        return self.station("table").ask(work)

    @property
    def hand_request(self) -> HandRequest | None:
        """What the operator is asked to set, at a table without a wire."""
        table = self.stations["table"].instrument if "table" in self.stations else None
        return table.request if isinstance(table, SetByHand) else None

    def confirm_set(self) -> Future[HandFinding | None]:
        """The operator says that the table does what was asked. No unit looks on here: it is his word."""

        def work(table: Any) -> HandFinding | None:
            if not isinstance(table, SetByHand):
                return None
            return table.check(self._clock.now_s(), blind=True)

        return self.station("table").ask(work)

    def hold(self, rate_dps: float) -> None:
        """A jog button is held: call again at least every half second, or the table stops. Raises InputError
        beyond the limits. After a stop nothing happens until the button was released."""
        self._limited_table().soft_limits.check_rate(rate_dps)
        if self._released:
            self._held = (rate_dps, time.monotonic())

    def release(self) -> None:
        """The button was released: the table stops."""
        self._held, self._released = None, True

    def stop(self) -> None:
        """Rate to zero, mode off, supply off: begins at once, in a thread of its own, whatever is going
        on."""
        self._held, self._released = None, False
        if self._stopping is not None and self._stopping.is_alive():
            return
        self.stop_problems = None
        self._stopping = threading.Thread(target=self._stop, name="desk stop", daemon=True)
        self._stopping.start()

    def _stop(self) -> None:
        table = self.stations["table"].instrument if "table" in self.stations else None
        supply = self.stations["supply"].instrument if "supply" in self.stations else None
        problems = stop_bench(table, supply, self._clock, rate_to_zero=None if table is None else table.stop)
        self._turning = False
        self.stop_problems = problems

    def _limited_table(self) -> LimitedTable:
        limited = self._limited
        if limited is None:
            raise InstrumentError("The rate table is not connected.")
        return limited

    def _look_at_table(self, _: Any) -> TableLive:
        limited = self._limited_table()
        self._obey(limited)
        state: TableState = limited.state()
        return TableLive(state, self._held is not None)

    def _obey(self, table: LimitedTable) -> None:
        """Turn while a button is held, stop when it is not. A refusal releases the button."""
        held = self._held
        if held is not None and time.monotonic() - held[1] > HOLD_LIMIT_S:
            self._held = held = None
        if held is not None and _at_the_end(table, held[0]):
            self._held, self._released = None, False
            held = None
        try:
            if held is not None:
                if not self._turning or table.state().demanded_rate_dps != held[0]:
                    self._turning = True
                    table.set_rate(held[0])
            elif self._turning and not _moves_to_target(table):
                table.set_rate(0.0)
                self._turning = False
        except AhrsLabError:
            self._held, self._released = None, False
            if self._turning:
                self._turning = False
                table.stop()
            raise

    # the language of an ASCII table ───────────────────────────────────────────────────────────────────────

    def try_text(self, name: str, *, rate_dps: float = 0.0, angle_deg: float = 0.0) -> Future[Any]:
        """Say one command of the table's language ("query", "enable" …) and show what comes back. Fails with
        InputError where the table's language is not described by a template."""

        def work(table: Any) -> Any:
            tried = getattr(table, "try_template", None)
            if tried is None:
                raise InputError("Only a table with an ASCII language has texts to try.")
            if name in ("rate", "position"):
                self._limited_table().soft_limits.check_rate(rate_dps)
                self._limited_table().soft_limits.check_angle(angle_deg)
                # Left turning until the person says stop: this is a trial of words, not a button that is
                # held.
            return tried(name, rate_dps=rate_dps, angle_deg=angle_deg)

        return self.station("table").ask(work)


def _at_the_end(table: LimitedTable, rate_dps: float) -> bool:
    """Whether the range ends so soon that a held button has to count as released."""
    return table.soft_limits.must_stop(table.state().angle_deg, rate_dps, _END_REACTION_S)


def _moves_to_target(table: LimitedTable) -> bool:
    """Whether a move to an angle is under way; its end is the table's own."""
    state = table.state()
    return state.demanded_rate_dps == 0.0 and state.moving


def _in_thread(work: Callable[[], None], name: str) -> Future[None]:
    future: Future[None] = Future()

    def run() -> None:
        try:
            work()
        except Exception as error:
            future.set_exception(error)
        else:
            future.set_result(None)

    threading.Thread(target=run, name=name, daemon=True).start()
    return future
