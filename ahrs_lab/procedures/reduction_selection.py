"""Which segments of a recording are evaluated, and what the reader of the result is told about the others.

A segment that does not reach the standard's minimum itself (20 s, 10 samples/s, whole turns, lost samples)
stops the evaluation: it was recorded to count and cannot. A segment that is missing, wrongly mounted or at a
rate that the table did not hold takes with it only the quantities that cannot stand without it; the others
are evaluated, and the warnings name what is left out. Where nothing stands, the evaluation stops.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from ahrs_lab.errors import InputError
from ahrs_lab.messages import Message
from ahrs_lab.metrology.result import ResultWarning
from ahrs_lab.procedures.reduction_output import DeviceOutput, device_output
from ahrs_lab.recording.finding import Finding
from ahrs_lab.recording.orientation import Axis
from ahrs_lab.recording.read import RecordedSegment, Recording
from ahrs_lab.recording.samples import Samples
from ahrs_lab.recording.segment import Segment

PROCEDURE = "jjf1536-2015"

_STOPPING = frozenset({"dwell", "sample_rate", "turns", "gap", "bad_cell", "time"})
"""Kinds of finding that, unusable, mean the standard's minimum is not reached."""

_NAMED = 5
"""A refusal is one line: this many reasons in full, then how many more."""


@dataclass(frozen=True)
class Take:
    """A segment that is evaluated: ``start_s`` on one time scale for the whole recording."""

    segment: Segment
    samples: Samples
    output: DeviceOutput
    start_s: float

    @property
    def at_rest(self) -> bool:
        return self.segment.role in ("static_before", "static_after", "position") or (
            self.segment.item == "static"
        )


@dataclass(frozen=True)
class Selection:
    """``lacking`` are the (item, axis) that lack a segment as a whole."""

    takes: tuple[Take, ...]
    warnings: tuple[ResultWarning, ...]
    lacking: frozenset[tuple[str, str]]

    def of(self, item: str, axis: Axis) -> tuple[Take, ...]:
        return tuple(take for take in self.takes if take.segment.item == item and take.segment.axis == axis)


def select(recording: Recording) -> Selection:
    """The takes that count; raises InputError with file and line where the standard's minimum is not
    reached."""
    if recording.header.procedure != PROCEDURE:
        raise InputError(
            "The recording's procedure is “{procedure}”: only “{expected}” is evaluated here.",
            procedure=recording.header.procedure,
            expected=PROCEDURE,
        )
    warnings = [_warning(finding) for finding in recording.findings]
    lacking = {
        (finding.item, finding.axis)
        for finding in recording.findings
        if finding.severity == "unusable" and not finding.segment
    }
    _refuse_below_minimum(recording)
    takes: list[Take] = []
    end_s, clock_s = 0.0, 0.0
    for recorded in recording.segments:
        if not _usable(recorded):
            continue
        output = device_output(recorded.samples, recording.header.device)
        first_s = float(recorded.samples["t_s"][0]) - output.step_s
        # the device's clock where it runs on; else (power was off, or it starts anew) what is next follows
        if first_s <= 0.5 * output.step_s or first_s + clock_s < end_s:
            clock_s = end_s - first_s
        start_s = first_s + clock_s
        end_s = start_s + output.duration_s
        takes.append(Take(recorded.segment, recorded.samples, output, start_s))
    return Selection(tuple(takes), tuple(warnings), frozenset(lacking))


def _refuse_below_minimum(recording: Recording) -> None:
    """Raises InputError where a segment does not reach the standard's minimum, and names all that do not."""
    stopping = [
        finding
        for recorded in recording.segments
        if recorded.counts
        for finding in recorded.findings
        if finding.severity == "unusable" and finding.kind in _STOPPING
    ]
    if not stopping:
        return
    where = listed([finding.placed for finding in stopping])
    if len({finding.segment for finding in stopping}) == 1:
        raise InputError(
            "{where} The standard's minimum is not reached: record the segment again, or take it out of "
            "recording.toml.",
            where=where,
        )
    raise InputError(
        "{where} The standard's minimum is not reached: record these segments again, or take them out of "
        "recording.toml.",
        where=where,
    )


def listed(sentences: Sequence[Message]) -> Message:
    """The sentences one after the other, of many the first ones and how many more there are."""
    said = sentences[0]
    for sentence in sentences[1:_NAMED]:
        said = Message("{before} {sentence}", before=said, sentence=sentence)
    if len(sentences) > _NAMED:
        said = Message("{before} And {count} more.", before=said, count=len(sentences) - _NAMED)
    return said


def _usable(recorded: RecordedSegment) -> bool:
    return recorded.usable and len(recorded.samples) >= 2


def _warning(finding: Finding) -> ResultWarning:
    return ResultWarning(finding.what, finding.segment, finding.line)


def left_out(item: Message, axis: str, reason: Message) -> ResultWarning:
    """The warning that a quantity is not in the result."""
    return ResultWarning(
        Message("{item} {axis} is not evaluated: {reason}", item=item, axis=axis, reason=reason)
    )


def names(takes: Iterable[Take]) -> tuple[str, ...]:
    return tuple(take.segment.name for take in takes)
