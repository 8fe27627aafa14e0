"""A small bench of perfect instruments whose every call is logged and can be made to fail.

The numbers it gives follow from two lines of arithmetic (the gyro shows the table's rate about the case axis
that is up, the accelerometers g along it), so that what the runner records can be told beforehand.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from datetime import UTC, datetime, timedelta
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ahrs_lab.errors import AhrsLabError
from ahrs_lab.instruments.interfaces import (
    Bench,
    RoomReading,
    SupplyReading,
    TableLimits,
    TableLog,
    TableState,
)
from ahrs_lab.recording.orientation import Orientation
from ahrs_lab.recording.samples import ACCEL, GYRO, Samples, concatenate
from ahrs_lab.recording.segment import DeviceDescription, Segment, Site

Array = NDArray[np.float64]
START = datetime(2026, 3, 2, 8, 0, tzinfo=UTC)
LOG_HZ = 50.0


@dataclass
class FakeClock:
    """Bench time that passes when somebody waits. ``on_wait`` is called before each wait."""

    step_s: float | None = None
    time_s: float = 0.0
    interrupts: int = 0
    on_wait: Callable[[], None] = lambda: None

    def now_s(self) -> float:
        return self.time_s

    def utc(self) -> datetime:
        return START + timedelta(seconds=self.time_s)

    def wait(self, seconds: float) -> None:
        self.on_wait()
        self.time_s += seconds

    def interrupt(self) -> None:
        self.interrupts += 1


class Calls:
    """The log of calls to instruments; ``before`` may raise instead of letting one through."""

    def __init__(self) -> None:
        self.log: list[str] = []
        self.before: Callable[[str], None] = lambda name: None

    def __call__(self, name: str) -> None:
        self.log.append(name)
        self.before(name)

    @property
    def commands(self) -> list[str]:
        """What table and supply were told, without what they were asked."""
        return [call for call in self.log if call.split()[0] in _COMMANDS]


_COMMANDS = {
    "table.set_rate",
    "table.move_to",
    "table.stop",
    "table.enable",
    "table.disable",
    "supply.on",
    "supply.off",
    "supply.set_output",
}


class FakeTable:
    """Changes its rate at once. ``fault`` and ``sticks`` (ignores demands) are set by tests."""

    limits = TableLimits(400.0, 1e6)

    def __init__(self, clock: FakeClock, calls: Calls) -> None:
        self._clock, self._calls = clock, calls
        self._pieces: list[tuple[float, float, float]] = [(0.0, 0.0, 0.0)]  # from when, angle then, rate
        self._logged = 0
        self._demanded = 0.0
        self.fault = ""
        self.sticks = False
        self.rate_error_dps = 0.0

    def identify(self) -> str:
        return "fake table"

    def enable(self) -> None:
        self._calls("table.enable")

    def disable(self) -> None:
        self._calls("table.disable")

    def set_rate(self, rate_dps: float) -> None:
        self._calls(f"table.set_rate {rate_dps:g}")
        self._demanded = rate_dps
        if not self.sticks:
            self._go(rate_dps + self.rate_error_dps)

    def move_to(self, angle_deg: float, rate_dps: float) -> None:
        self._calls(f"table.move_to {angle_deg:g}")
        if self.sticks:
            return
        now, here = self._clock.now_s(), float(self.angle(np.array([self._clock.now_s()]))[0])
        self._go(np.sign(angle_deg - here) * rate_dps)
        self._pieces.append((now + abs(angle_deg - here) / rate_dps, angle_deg, 0.0))

    def stop(self) -> None:
        self._calls("table.stop")
        self._go(0.0)

    def state(self) -> TableState:
        self._calls("table.state")
        now = np.array([self._clock.now_s()])
        rate = float(self._rate(now)[0])
        moving = rate != 0.0 or self._pieces[-1][0] > now[0]
        return TableState(
            float(now[0]), float(self.angle(now)[0]), rate, self._demanded, moving, True, self.fault
        )

    def log(self) -> TableLog:
        last = int(self._clock.now_s() * LOG_HZ)
        t = np.arange(self._logged, last + 1) / LOG_HZ
        self._logged = last + 1
        return TableLog(t, self.angle(t), self._rate(t))

    def angle(self, t_s: Array) -> Array:
        """Shape (n,): where the table was."""
        starts = np.array([piece[0] for piece in self._pieces])
        index = np.maximum(np.searchsorted(starts, t_s, "right") - 1, 0)
        angles = np.array([piece[1] for piece in self._pieces])
        rates = np.array([piece[2] for piece in self._pieces])
        return np.asarray(angles[index] + rates[index] * (t_s - starts[index]))

    def _rate(self, t_s: Array) -> Array:
        starts = np.array([piece[0] for piece in self._pieces])
        rates = np.array([piece[2] for piece in self._pieces])
        return np.asarray(rates[np.maximum(np.searchsorted(starts, t_s, "right") - 1, 0)])

    def _go(self, rate_dps: float) -> None:
        now = self._clock.now_s()
        here = float(self.angle(np.array([now]))[0])
        self._pieces = [piece for piece in self._pieces if piece[0] < now] + [(now, here, rate_dps)]


class FakeAhrs:
    """Noiseless samples on the grid of the bench's clock. ``silent_from_s``, ``lose`` (a mask over sample
    numbers) and ``latency_s`` are set by tests."""

    def __init__(self, clock: FakeClock, calls: Calls, table: FakeTable, rate_hz: float = 20.0) -> None:
        self.description = DeviceDescription(sample_rate_hz=rate_hz)
        self._clock, self._calls, self._table = clock, calls, table
        self.orientation = Orientation("ENU")
        self._next = 1
        self._streaming = False
        self.silent_from_s = np.inf
        self.latency_s = 0.0
        self.lose: Callable[[NDArray[np.int64]], NDArray[np.bool_]] | None = None
        self.device_time_zero_s = 1000.0
        self.extra_rate: Callable[[Array], Array] | None = None

    def identify(self) -> str:
        return "fake sensor"

    def start(self) -> None:
        self._calls("ahrs.start")
        self._streaming = True
        self._next = int(self._clock.now_s() * self.description.sample_rate_hz + 1e-9) + 1

    def stop(self) -> None:
        self._calls("ahrs.stop")
        self._streaming = False

    def read(self) -> Samples:
        self._calls("ahrs.read")
        rate = self.description.sample_rate_hz
        arrived = min(self._clock.now_s() - self.latency_s, self.silent_from_s)
        last = int(arrived * rate + 1e-9)
        if not self._streaming or last < self._next:
            return Samples()
        number = np.arange(self._next, last + 1)
        self._next = last + 1
        if self.lose is not None:
            number = number[~self.lose(number)]
        end = number / rate
        turned = (self._table.angle(end) - self._table.angle(end - 1.0 / rate)) * rate
        up = self.orientation.gravity_unit()
        columns: dict[str, Array] = {
            "t_s": end - self.device_time_zero_s,
            "host_t_s": end + self.latency_s,
            "counter": number.astype(np.float64),
        }
        for i in range(3):
            columns[GYRO[i]] = turned * up[i]
            columns[ACCEL[i]] = np.full(len(end), 9.80665 * up[i])
        if self.extra_rate is not None:
            columns[GYRO[0]] = columns[GYRO[0]] + self.extra_rate(end)
        return Samples(columns)


class FakeSupply:
    """Draws ``current_a(seconds since on)``."""

    def __init__(self, clock: FakeClock, calls: Calls) -> None:
        self._clock, self._calls = clock, calls
        self._on_since: float | None = None
        self.current_a: Callable[[float], float] = lambda seconds: 0.2
        self.trips_at_s = np.inf

    def identify(self) -> str:
        return "fake supply"

    def set_output(self, voltage_v: float, current_limit_a: float) -> None:
        self._calls(f"supply.set_output {voltage_v:g}")

    def on(self) -> None:
        self._calls("supply.on")
        self._on_since = self._clock.now_s()

    def off(self) -> None:
        self._calls("supply.off")
        self._on_since = None

    def read(self) -> SupplyReading:
        self._calls("supply.read")
        now = self._clock.now_s()
        if self._on_since is None or now >= self.trips_at_s:
            return SupplyReading(now, 0.0, 0.0, False)
        return SupplyReading(now, 12.0, self.current_a(now - self._on_since), True)


@dataclass
class FakeRoom:
    clock: FakeClock
    temperature_c: float = 20.0
    humidity_percent: float = 50.0

    def read(self) -> RoomReading:
        return RoomReading(self.clock.now_s(), self.temperature_c, self.humidity_percent)


@dataclass
class FakeOperator:
    """Mounts as asked, or as ``instead`` says, in turn."""

    ahrs: FakeAhrs
    calls: Calls
    instead: list[str] = field(default_factory=list)
    asked: list[str] = field(default_factory=list)
    on_mount: Callable[[], None] = lambda: None

    def mount(self, orientation: Orientation, previous: Orientation | None) -> None:
        self.calls(f"operator.mount {orientation}")
        self.asked.append(orientation.letters)
        self.on_mount()
        self.ahrs.orientation = Orientation(self.instead.pop(0)) if self.instead else orientation


class FakeBench:
    """The parts of a bench at hand, and :attr:`bench` as procedures see it."""

    def __init__(self, *, step_s: float | None = None, rate_hz: float = 20.0) -> None:
        self.calls = Calls()
        self.clock = FakeClock(step_s)
        self.table = FakeTable(self.clock, self.calls)
        self.ahrs = FakeAhrs(self.clock, self.calls, self.table, rate_hz)
        self.supply = FakeSupply(self.clock, self.calls)
        self.room = FakeRoom(self.clock)
        self.operator = FakeOperator(self.ahrs, self.calls)

    @property
    def bench(self) -> Bench:
        return Bench(
            clock=self.clock,
            table=self.table,
            ahrs=self.ahrs,
            supply=self.supply,
            room=self.room,
            operator=self.operator,
            site=Site(40.0),
            simulated=True,
        )


class MemoryWriter:
    """A recording in memory: the writer's side of a bundle. ``fails`` is raised by the next append."""

    def __init__(self, segments: tuple[Segment, ...] = ()) -> None:
        self._segments = list(segments)
        self.samples: dict[str, Samples] = {}
        self._notes: dict[str, Any] = {}
        self.fails: AhrsLabError | None = None
        self._open: Segment | None = None
        self._blocks: list[Samples] = []

    @property
    def segments(self) -> tuple[Segment, ...]:
        return tuple(self._segments)

    @property
    def notes(self) -> dict[str, Any]:
        return self._notes

    @property
    def finished(self) -> list[str]:
        return [s.name for s in self._segments if not s.interrupted and not s.superseded]

    def begin(self, segment: Segment) -> None:
        assert self._open is None, "two segments at once"
        self._open, self._blocks = segment, []

    def append(self, samples: Samples) -> None:
        assert self._open is not None
        if self.fails is not None:
            raise self.fails
        self._blocks.append(samples)

    def finish(self) -> Segment:
        assert self._open is not None
        segment = self._open
        self._segments = [
            replace(s, superseded=True) if s.name == segment.name and not s.interrupted else s
            for s in self._segments
        ]
        return self._close(segment)

    def interrupt(self, reason: str) -> Segment:
        assert self._open is not None
        return self._close(replace(self._open, interrupted=True, reason=reason))

    def update_notes(self, notes: dict[str, Any]) -> None:
        self.notes.update(notes)

    def _close(self, segment: Segment) -> Segment:
        self._segments.append(segment)
        self.samples[segment.name] = concatenate(self._blocks)
        self._open = None
        return segment
