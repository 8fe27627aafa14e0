"""From the rows of a file to the rows that count: bad cells, repeated and backward times out, gaps named.

What is left has finite times that rise strictly and a finite rate in every row; each row knows its line.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ahrs_lab.messages import Message
from ahrs_lab.recording.finding_list import FindingList
from ahrs_lab.recording.raw_segment import RawSegment, required_columns
from ahrs_lab.recording.samples import GAP_STEPS, Array, Samples

Mask = NDArray[np.bool_]
Rows = NDArray[np.int64]

RATE_TOLERANCE = 0.01
"""A device's clock may differ by this much from the sample rate that the header names."""
WRONG_RATE = 0.1
"""Beyond this the header's sample rate is not believed."""


@dataclass(frozen=True)
class CleanRows:
    """``lines``, shape (n,), is the line of each row of ``samples``; ``lost`` counts the rows known to be
    missing or left out; ``step_s`` is the sample interval, by the header where the times agree with it."""

    samples: Samples
    lines: Rows
    lost: int
    step_s: float


def clean_rows(raw: RawSegment, sample_rate_hz: float, found: FindingList) -> CleanRows:
    """The rows that count, with everything that is wrong with the others added to ``found``.

    Raises :class:`~ahrs_lab.recording.raw_segment.SegmentFileError` where needed columns are missing.
    """
    needed = required_columns(list(raw.columns))
    for name in raw.left_out:
        found.add(
            "bad_cell", Message("the column {column} holds no numbers and is not used.", column=name), 1
        )
    good = _report_bad_cells(raw, needed, found)
    t_s = raw.columns["t_s"]
    timed = np.flatnonzero(np.isfinite(t_s))
    rising = timed[_report_backward_times(t_s[timed], raw.lines[timed], found)]
    step_s = _sample_interval(t_s[rising], sample_rate_hz, raw, found)
    lost = _report_gaps(t_s[rising], raw.lines[rising], _counter(raw, rising), step_s, found)
    rows = rising[good[rising]]
    lost += len(rising) - len(rows)
    if len(rows) == len(raw):
        return CleanRows(Samples(raw.columns), raw.lines, lost, step_s)
    kept = Samples({name: column[rows] for name, column in raw.columns.items()})
    return CleanRows(kept, raw.lines[rows], lost, step_s)


def _report_bad_cells(raw: RawSegment, needed: tuple[str, ...], found: FindingList) -> Mask:
    """Which rows have a number in every needed column; each run of equal bad rows is one finding."""
    names = tuple(raw.columns)
    bad_by_column = [~np.isfinite(raw.columns[name]) for name in names]
    any_bad: Mask = np.logical_or.reduce(bad_by_column)
    rows = np.flatnonzero(any_bad)
    if not len(rows):
        return ~any_bad
    bad = np.column_stack([column[rows] for column in bad_by_column])
    alone = np.isin(rows, [row for row, _ in raw.texts] + list(raw.ragged))
    breaks = (np.diff(rows) != 1) | np.any(bad[1:] != bad[:-1], axis=1) | alone[1:] | alone[:-1]
    starts = np.concatenate([[0], np.flatnonzero(breaks) + 1])
    ends = np.concatenate([starts[1:], [len(rows)]]) - 1
    for start, end in zip(starts, ends, strict=True):
        columns = [name for name, flag in zip(names, bad[start], strict=True) if flag]
        what = _bad_row(raw, int(rows[start]), columns, any(name in needed for name in columns))
        last = int(raw.lines[rows[end]])
        if end > start:
            what = Message("{what} So up to line {last}.", what=what, last=last)
        found.add("bad_cell", what, int(raw.lines[rows[start]]))
    unusable = np.logical_or.reduce(
        [column for name, column in zip(names, bad_by_column, strict=True) if name in needed]
    )
    return np.asarray(~unusable)


def _bad_row(raw: RawSegment, row: int, columns: list[str], left_out: bool) -> Message:
    if row in raw.ragged:
        found, columns_named = raw.ragged[row], len(raw.columns) + len(raw.left_out)
        return Message.counted(
            found,
            Message(
                "the row has 1 cell, the header row {columns}. The row is left out.", columns=columns_named
            ),
            Message(
                "the row has {cells} cells, the header row {columns}. The row is left out.",
                cells=found,
                columns=columns_named,
            ),
        )
    cells = ", ".join(f"{name} = “{raw.texts.get((row, name), raw.columns[name][row])}”" for name in columns)
    if left_out:
        return Message("no number: {cells}. The row is left out.", cells=cells)
    return Message("no number: {cells}. The value counts as unknown.", cells=cells)


def _report_backward_times(t_s: Array, lines: Rows, found: FindingList) -> Rows:
    """Indices of the rows whose times rise strictly; the others are reported.

    A single time that lies ahead of its followers is left out itself, not they.
    """
    rows = np.arange(len(t_s))
    if len(t_s) < 2 or np.all(t_s[1:] > t_s[:-1]):
        return rows
    ahead = np.zeros(len(t_s), dtype=bool)
    ahead[1:-1] = (t_s[1:-1] > t_s[2:]) & (t_s[2:] > t_s[:-2])
    rest = rows[~ahead]
    before = np.maximum.accumulate(t_s[rest])
    late = np.concatenate([[False], t_s[rest][1:] <= before[:-1]])
    for index in np.flatnonzero(ahead):
        found.add(
            "time",
            Message(
                "the time goes backward, from {before} s to {after} s. The row before is left out.",
                before=float(t_s[index]),
                after=float(t_s[index + 1]),
            ),
            int(lines[index + 1]),
        )
    for first, last in _runs(late):
        time, previous = float(t_s[rest[first]]), float(before[first - 1])
        what = _not_later(previous, time, last - first + 1, int(lines[rest[last]]))
        found.add("time", what, int(lines[rest[first]]))
    return np.asarray(rest[~late])


def _not_later(before_s: float, after_s: float, count: int, last: int) -> Message:
    """What is said of ``count`` rows, the last in line ``last``, that do not come after the row before."""
    if after_s == before_s:
        return Message.counted(
            count,
            Message("the time {time} s is repeated. The row is left out.", time=after_s),
            Message(
                "the time {time} s is repeated. {count} rows up to line {last} are left out.",
                time=after_s,
                count=count,
                last=last,
            ),
        )
    return Message.counted(
        count,
        Message(
            "the time goes backward, from {before} s to {after} s. The row is left out.",
            before=before_s,
            after=after_s,
        ),
        Message(
            "the time goes backward, from {before} s to {after} s. "
            "{count} rows up to line {last} are left out.",
            before=before_s,
            after=after_s,
            count=count,
            last=last,
        ),
    )


def _runs(mask: Mask) -> list[tuple[int, int]]:
    """First and last index of every run of True."""
    edges = np.flatnonzero(np.diff(np.concatenate([[False], mask, [False]]).astype(np.int8)))
    return [(int(start), int(end) - 1) for start, end in zip(edges[::2], edges[1::2], strict=True)]


def _sample_interval(t_s: Array, sample_rate_hz: float, raw: RawSegment, found: FindingList) -> float:
    nominal_s = 1.0 / sample_rate_hz
    if len(t_s) < 3:
        return nominal_s
    step_s = float(np.median(np.diff(t_s)))
    if abs(step_s / nominal_s - 1) <= WRONG_RATE:
        return nominal_s
    found.add(
        "sample_rate",
        Message(
            "the times step by {step} s, but the header says {rate} samples/s: correct sample_rate_hz.",
            step=round(step_s, 9),
            rate=sample_rate_hz,
        ),
        int(raw.lines[0]),
    )
    return step_s


def _counter(raw: RawSegment, rows: Rows) -> Array | None:
    """Shape (len(rows) − 1,): how far the counter goes on from row to row, in samples; None without one."""
    column = raw.columns.get("counter")
    if column is None or len(rows) < 3 or not np.all(np.isfinite(column[rows])):
        return None
    steps = np.diff(column[rows])
    forward = steps[steps > 0]
    usual = float(np.median(forward)) if len(forward) else 0.0
    if usual <= 0:
        return None
    for wrap in (2.0**8, 2.0**16, 2.0**32):
        if np.max(column[rows]) < wrap:
            steps = np.where(steps < 0, steps + wrap, steps)
            break
    return np.asarray(steps / usual)


def _report_gaps(t_s: Array, lines: Rows, counted: Array | None, step_s: float, found: FindingList) -> int:
    """Name every jump of time or counter; the number of rows that are missing."""
    if len(t_s) < 2:
        return 0
    steps = np.diff(t_s)
    gap = steps > GAP_STEPS * step_s
    jump = np.zeros_like(gap) if counted is None else np.abs(counted - 1) > 0.5
    total = 0
    for index in np.flatnonzero(gap | jump):
        missing = round(float(steps[index]) / step_s) - 1
        if counted is not None and jump[index] and counted[index] > 0:
            missing = max(round(float(counted[index])) - 1, 0)
        total += missing
        what = _missing(float(t_s[index]), float(steps[index]) if gap[index] else None, missing)
        found.add("gap", what, int(lines[index + 1]))
    return total


def _missing(time_s: float, gap_s: float | None, missing: int) -> Message:
    """``gap_s`` is None where only the counter shows it."""
    if gap_s is None:
        return Message.counted(
            missing,
            Message(
                "the counter jumps: {missing} sample is missing after {time} s.", time=time_s, missing=missing
            ),
            Message(
                "the counter jumps: {missing} samples are missing after {time} s.",
                time=time_s,
                missing=missing,
            ),
        )
    gap_s = round(gap_s, 6)
    return Message.counted(
        missing,
        Message(
            "a gap of {gap} s after {time} s: {missing} sample is missing.",
            gap=gap_s,
            time=time_s,
            missing=missing,
        ),
        Message(
            "a gap of {gap} s after {time} s: {missing} samples are missing.",
            gap=gap_s,
            time=time_s,
            missing=missing,
        ),
    )
