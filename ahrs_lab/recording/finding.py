"""Findings: what a recording is found to lack or to have wrong, each with file and line."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from ahrs_lab.messages import Message

Severity = Literal["note", "unusable"]

Kind = Literal[
    "absent",  # recording.toml lists it, and it is not there
    "file",  # no sample can be read from it
    "bad_cell",  # not a number, not finite, or a row of the wrong length: the row is left out
    "time",  # repeated or backward time: the row is left out
    "gap",  # time jumps, or the counter does
    "sample_rate",  # below the standard's minimum, or not the one that the header names
    "dwell",  # shorter than the standard's minimum, or no whole averaging angle
    "orientation",  # gravity, or the demanded axis, disagrees with it
    "magnitude",  # specific force at rest is far from gravity
    "rate",  # the table did not hold its rate
    "rest",  # the table did not stay where it had to
    "turns",  # not the whole turns that were demanded
    "missing",  # a segment that the procedure needs
    "set_aside",  # superseded or interrupted
]


@dataclass(frozen=True)
class Finding:
    """One fact about a recording.

    ``segment`` is the file as ``recording.toml`` names it, empty for all of the recording; ``line`` counts
    from 1 in that file, the header row being line 1 (a Parquet file's first row is line 2 likewise), and 0 is
    all of it.
    ``"unusable"``: the segment (or, with an empty ``segment``, the ``item`` of ``axis``) does not fulfil the
    standard's minimum; ``"note"``: it may be evaluated, and the reader of the result is told.
    """

    what: Message
    segment: str = ""
    line: int = 0
    severity: Severity = "note"
    kind: Kind = "file"
    item: str = ""
    axis: str = ""

    @property
    def placed(self) -> Message:
        """The finding as a sentence that says where."""
        if not self.segment:
            return self.what
        if not self.line:
            return Message("{file}: {what}", file=self.segment, what=self.what)
        return Message("{file}, line {line}: {what}", file=self.segment, line=self.line, what=self.what)
