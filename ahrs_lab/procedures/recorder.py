"""One segment from the bench to the writer: cut to its duration, with the table's angle and rate at each
sample.

Device time and bench time: a sample's ``t_s`` is the device's; on the bench it ended at ``t_s`` plus the
smallest delay of arrival seen before the segment began (:attr:`Watch.offset_s`). A constant latency of the
link is not seen: it shifts the table's columns by rate × latency, which matters neither to a rate nor to
turns from rest to rest. A smaller delay that is seen meanwhile counts from the next segment on: the table
would seem to jump.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, Protocol

import numpy as np

from ahrs_lab.errors import AhrsLabError, InstrumentError
from ahrs_lab.instruments.interfaces import Bench
from ahrs_lab.instruments.patience import patient_s
from ahrs_lab.messages import Message
from ahrs_lab.procedures.events import Activity, Event, SegmentFinished, SegmentStarted, Warned
from ahrs_lab.procedures.figures import figure
from ahrs_lab.procedures.watch import Watch
from ahrs_lab.recording.samples import Samples
from ahrs_lab.recording.segment import Segment

_LONGEST_S = 86400.0

Action = tuple[float, Callable[[], None]]
"""Seconds after the start, and what is done then."""


class SegmentWriter(Protocol):
    """What a recording is written by: :class:`ahrs_lab.recording.bundle_writer.BundleWriter`."""

    @property
    def segments(self) -> tuple[Segment, ...]: ...
    @property
    def notes(self) -> Mapping[str, Any]: ...
    def begin(self, segment: Segment) -> None: ...
    def append(self, samples: Samples) -> None: ...
    def finish(self) -> Segment: ...
    def interrupt(self, reason: str) -> object: ...
    def update_notes(self, notes: dict[str, Any]) -> object: ...


@dataclass(frozen=True)
class Recorded:
    """A finished segment with the means of its columns, for what is checked while the run goes on."""

    segment: Segment
    samples: int
    lost: int
    means: dict[str, float]
    scatter: dict[str, float]
    """Standard deviation of the samples, per column."""


class _Cut:
    """The rows of ``duration_s`` of device time, from the first whole interval after a bench time on."""

    def __init__(self, start_bench_s: float, duration_s: float, interval_s: float) -> None:
        self._start_bench_s = start_bench_s
        self._interval_s = interval_s
        self.duration_s = max(1, round(duration_s / interval_s)) * interval_s
        self._start_s: float | None = None
        self.complete = False
        self.rows = 0

    def end_at(self, duration_s: float) -> None:
        """Now it is known how long it lasts."""
        self.duration_s = max(1, round(duration_s / self._interval_s)) * self._interval_s

    @property
    def lost(self) -> int:
        """Samples that the duration has room for and that did not come."""
        return max(0, round(self.duration_s / self._interval_s) - self.rows)

    def take(self, samples: Samples, offset_s: float) -> Samples:
        """The rows of ``samples`` that belong to the segment."""
        t = samples["t_s"]
        half = 0.5 * self._interval_s
        if self._start_s is None:
            began = np.flatnonzero(t + offset_s - self._interval_s >= self._start_bench_s - 1e-6)
            if len(began) == 0:
                return samples.rows(0, 0)
            self._start_s = float(t[began[0]]) - self._interval_s
        after = t - self._start_s
        inside = (after > half) & (after < self.duration_s + half)
        self.complete = self.complete or bool(np.any(after > self.duration_s - half))
        self.rows += int(np.count_nonzero(inside))
        if inside.all():
            return samples
        rows = np.flatnonzero(inside)
        if len(rows) and rows[-1] - rows[0] + 1 == len(rows):
            return samples.rows(int(rows[0]), int(rows[-1]) + 1)
        return Samples({name: column[rows] for name, column in samples.columns.items()})


class _Sums:
    """Means and scatter of columns over blocks."""

    def __init__(self) -> None:
        self._count = 0
        self._sum: dict[str, float] = {}
        self._squares: dict[str, float] = {}
        self._first: dict[str, float] = {}

    def add(self, samples: Samples) -> None:
        if not len(samples):
            return
        self._count += len(samples)
        for name, column in samples.columns.items():
            if not name.startswith("gyro_"):
                continue
            about = self._first.setdefault(name, float(column[0]))
            off = column - about
            self._sum[name] = self._sum.get(name, 0.0) + float(off.sum())
            self._squares[name] = self._squares.get(name, 0.0) + float(off @ off)

    def means(self) -> dict[str, float]:
        return {name: self._first[name] + total / self._count for name, total in self._sum.items()}

    def scatter(self) -> dict[str, float]:
        return {
            name: float(np.sqrt(max(self._squares[name] / self._count - (total / self._count) ** 2, 0.0)))
            for name, total in self._sum.items()
        }


class Recorder:
    """Records segments; ``conditions`` gives what is kept with each of them (temperature, power-on number
    …)."""

    def __init__(
        self,
        bench: Bench,
        writer: SegmentWriter,
        watch: Watch,
        emit: Callable[[Event], None],
        conditions: Callable[[], dict[str, Any]],
    ) -> None:
        self._bench = bench
        self._writer = writer
        self._watch = watch
        self._emit = emit
        self._conditions = conditions

    def record(
        self,
        segment: Segment,
        duration_s: float,
        actions: Sequence[Action] = (),
        verify: Callable[[], None] = lambda: None,
        tail_s: float | None = None,
    ) -> Recorded:
        """Record ``segment`` for ``duration_s``; ``actions`` are done at their times after the start, in
        order, and ``verify`` raises where the segment may not count. With ``tail_s`` the actions may take as
        long as they do, and the recording ends so long after the last of them.

        Whatever ends it early, what came is kept as interrupted.
        """
        self._watch.look()
        segment = replace(
            segment,
            started_utc=self._bench.clock.utc().isoformat(),
            extra={**segment.extra, **self._conditions()},
        )
        self._writer.begin(segment)
        self._emit(SegmentStarted(segment, duration_s))
        try:
            cut, sums = self._collect(segment, duration_s, actions, tail_s)
            verify()
        except AhrsLabError as error:
            self._keep_interrupted(str(error))
            raise
        except BaseException as error:
            self._keep_interrupted(f"{type(error).__name__}: {error}")
            raise
        written = self._writer.finish()
        self._emit(SegmentFinished(written, cut.rows, cut.lost))
        if cut.lost:
            self._emit(Warned(_lost_message(cut), segment.name))
        return Recorded(written, cut.rows, cut.lost, sums.means(), sums.scatter())

    def _keep_interrupted(self, reason: str) -> None:
        """What ended the recording is the error to be seen; that its rest could not be sealed is told beside
        it."""
        try:
            self._writer.interrupt(reason)
        except AhrsLabError as error:
            self._emit(Warned(error.message))

    def _collect(
        self, segment: Segment, duration_s: float, actions: Sequence[Action], tail_s: float | None
    ) -> tuple[_Cut, _Sums]:
        clock, watch = self._bench.clock, self._watch
        start = clock.now_s()
        longest_s = duration_s if tail_s is None else _LONGEST_S
        cut, sums = _Cut(start, longest_s, watch.interval_s), _Sums()

        def take(samples: Samples) -> None:
            rows = cut.take(samples, watch.offset_s or 0.0)
            if len(rows):
                self._writer.append(rows)
                sums.add(rows)

        watch.sink, watch.offset_held = take, True
        try:
            self._wait_for_rows(segment, start, cut, list(actions), tail_s)
        finally:
            watch.sink, watch.offset_held = None, False
        if not cut.rows:
            raise InstrumentError(
                "No sample of {segment} came from the device although it sends: its time column does not "
                "advance as its sample rate of {rate} Hz says. Check the device's output settings.",
                segment=segment.name,
                rate=figure(self._bench.ahrs.description.sample_rate_hz),
            )
        return cut, sums

    def _wait_for_rows(
        self, segment: Segment, start: float, cut: _Cut, actions: list[Action], tail_s: float | None
    ) -> None:
        clock, watch = self._bench.clock, self._watch
        interval = watch.interval_s
        while not cut.complete:
            passed = clock.now_s() - start
            if actions and passed >= actions[0][0] - 1e-9:
                actions.pop(0)[1]()
                if tail_s is not None and not actions:
                    cut.end_at(clock.now_s() - start + tail_s)
                continue
            arrived = watch.last_arrival_s - start
            if arrived > cut.duration_s * 1.02 + patient_s(clock, 5.0):
                raise InstrumentError(
                    "The device's clock has not reached the {duration} s of {segment} after {passed} s: its "
                    "time column or its sample rate is wrong. Check the device's output settings.",
                    duration=figure(cut.duration_s),
                    segment=segment.name,
                    passed=round(arrived, 1),
                )
            left = (actions[0][0] if actions else cut.duration_s + interval) - passed
            chunk = left if left > interval / 2 or actions else max(2.0 * interval, 0.01)
            step = clock.step_s
            watch.let_pass(max(chunk if step is None else min(chunk, step), 1e-6))
            self._tell_progress(segment, cut, clock.now_s() - start)

    def _tell_progress(self, segment: Segment, cut: _Cut, passed: float) -> None:
        self._emit(
            Activity(
                Message("Recording {segment}", segment=segment.name),
                min(passed / cut.duration_s, 1.0),
                max(cut.duration_s - passed, 0.0),
            )
        )


def _lost_message(cut: _Cut) -> Message:
    wanted = cut.lost + cut.rows
    return Message.counted(
        cut.lost,
        Message("1 of {wanted} samples was lost on the way.", wanted=wanted),
        Message("{lost} of {wanted} samples were lost on the way.", lost=cut.lost, wanted=wanted),
    )
