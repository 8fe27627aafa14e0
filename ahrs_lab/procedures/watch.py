"""Time passes on the bench, and nothing of it goes unseen: samples, table, supply and room while anything
waits.

Every wait of a run goes through :meth:`Watch.let_pass`, so a fault of the table, a silent sensor, a tripped
supply or a stop request is noticed within one step of the clock, whatever the run is doing.
"""

from __future__ import annotations

import time
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from ahrs_lab.errors import InstrumentError
from ahrs_lab.instruments.interfaces import Bench, RoomReading, SupplyReading, TableState
from ahrs_lab.instruments.patience import patient_s
from ahrs_lab.procedures.table_trace import TableTrace
from ahrs_lab.recording.samples import Samples

Array = NDArray[np.float64]

READING_INTERVAL_S = 0.2
"""Wall time between two readings that are told."""
_SILENCE_S = 1.0
_SILENCE_INTERVALS = 5.0
_FIRST_SAMPLE_S = 10.0
"""A device that has just been told to stream may still be starting."""


class Watch:
    """What is seen while time passes. ``raise_if_stopped`` is asked at every step; ``on_reading`` told at
    most five times a second of wall time."""

    def __init__(
        self,
        bench: Bench,
        on_samples: Callable[[Samples], None],
        on_reading: Callable[[TableState, SupplyReading, RoomReading], None],
        raise_if_stopped: Callable[[], None],
    ) -> None:
        self._bench = bench
        self._on_samples = on_samples
        self._on_reading = on_reading
        self._raise_if_stopped = raise_if_stopped
        self.trace = TableTrace(patient_s(bench.clock, _SILENCE_S))
        self.sink: Callable[[Samples], None] | None = None
        """Who wants the samples that arrive while time passes, besides the screen."""
        self.offset_held = False
        """Set while a segment is recorded: its times on the bench all have the same offset."""
        self.feel: Callable[[Samples], None] | None = None
        """Who is told of them before the table is looked at."""
        self.powered = False
        self._streaming = False
        self._last_arrival_s = 0.0
        self._offset_s: float | None = None
        self._next_reading = 0.0

    @property
    def interval_s(self) -> float:
        """Nominal time between two samples."""
        return 1.0 / self._bench.ahrs.description.sample_rate_hz

    @property
    def streaming(self) -> bool:
        """Whether the unit is to send."""
        return self._streaming

    @property
    def offset_s(self) -> float | None:
        """Bench time minus device time: the smallest delay of arrival seen since the stream began, so that a
        late packet does not shift it. A constant latency of the link cannot be told from it."""
        return self._offset_s

    @property
    def last_arrival_s(self) -> float:
        """Bench time at which the last sample that was read came."""
        return self._last_arrival_s

    def start_stream(self) -> None:
        """The unit begins to stream; what it sent before is dropped."""
        self._bench.ahrs.start()
        self._streaming = True
        self._offset_s = None
        self._last_arrival_s = self._bench.clock.now_s()

    def stop_stream(self) -> None:
        """No more samples are expected."""
        self._streaming = False
        self._bench.ahrs.stop()

    def let_pass(self, seconds: float) -> None:
        """Let bench time pass. Raises what is wrong with an instrument, and AbortedError when the run is
        stopped."""
        clock = self._bench.clock
        end = clock.now_s() + seconds
        while True:
            self._raise_if_stopped()
            left = end - clock.now_s()
            if left <= 1e-9:
                return
            step = clock.step_s
            clock.wait(left if step is None else min(left, step))
            self.look()

    def look(self) -> None:
        """See what has come meanwhile, without waiting."""
        samples = self._bench.ahrs.read() if self._streaming else Samples()
        limit = self._silence_limit_s
        silence = self._arrival_gap(samples)
        if self.feel is not None and len(samples):
            self.feel(samples)
        state = self._bench.table.state()
        self.trace.add(self._bench.table.log(), state)
        if len(samples):
            samples = self._with_table(samples)
            self._on_samples(samples)
            if self.sink is not None:
                self.sink(samples)
        check_table(state)
        if silence > limit:
            raise InstrumentError(
                "The device has sent nothing for {silence} s: check its data cable, its power and its output "
                "settings. What was recorded is kept; start the run again to go on.",
                silence=round(silence, 1),
            )
        if time.monotonic() >= self._next_reading:
            supply = self.read_supply()
            self._next_reading = time.monotonic() + READING_INTERVAL_S
            self._on_reading(state, supply, self._bench.room.read())

    def follow(self) -> None:
        """Take in what the unit feels and judge nothing: at the end of a run."""
        if self.feel is not None and self._streaming:
            samples = self._bench.ahrs.read()
            self._arrival_gap(samples)
            if len(samples):
                self.feel(samples)

    def tell(self) -> None:
        """Look, and tell what is read at once: before somebody is asked, or when the run pauses."""
        self._next_reading = 0.0
        self.look()

    def _with_table(self, samples: Samples) -> Samples:
        return samples.with_columns(self.trace.columns(samples["t_s"] + (self._offset_s or 0.0)))

    def read_supply(self) -> SupplyReading:
        """Raises InstrumentError where the output is off though it should be on."""
        reading = self._bench.supply.read()
        if self.powered and not reading.output_on:
            raise InstrumentError(
                "The supply has switched its output off at {voltage} V: check the current limit and the "
                "cable for a short circuit.",
                voltage=round(reading.voltage_v, 2),
            )
        return reading

    @property
    def _silence_limit_s(self) -> float:
        least = _FIRST_SAMPLE_S if self._offset_s is None else _SILENCE_S
        return patient_s(self._bench.clock, max(least, _SILENCE_INTERVALS * self.interval_s))

    def _arrival_gap(self, samples: Samples) -> float:
        """The longest time without an arrival up to now, s; keeps the time offset up to date."""
        if not self._streaming:
            return 0.0
        now = self._bench.clock.now_s()
        gap = 0.0
        if len(samples):
            arrivals = samples["host_t_s"]
            gap = float(np.max(np.diff(arrivals, prepend=self._last_arrival_s)))
            self._last_arrival_s = float(arrivals[-1])
            smallest = float(np.min(arrivals - samples["t_s"]))
            if self._offset_s is None:
                self._offset_s = smallest
            elif not self.offset_held:
                self._offset_s = min(self._offset_s, smallest)
        return max(gap, now - self._last_arrival_s)


def check_table(state: TableState) -> None:
    """Raises InstrumentError on a fault that the table reports."""
    if state.fault:
        raise InstrumentError(
            "The rate table reports a fault: {fault}. Find its cause, then start "
            "the run again; what was recorded is kept.",
            fault=state.fault,
        )
