"""Collects the findings of one segment; a defect that comes a thousand times is named a hundred times."""

from __future__ import annotations

from collections import Counter

from ahrs_lab.messages import Message
from ahrs_lab.recording.finding import Finding, Kind, Severity
from ahrs_lab.recording.segment import Segment

MOST_OF_A_KIND = 100


class FindingList:
    """Findings of ``segment``, in the order they are added."""

    def __init__(self, segment: Segment) -> None:
        self.segment = segment
        self._found: list[Finding] = []
        self._counts: Counter[Kind] = Counter()
        self._last: dict[Kind, Finding] = {}

    def add(self, kind: Kind, what: Message, line: int = 0, severity: Severity = "note") -> None:
        """One more finding."""
        segment = self.segment
        finding = Finding(what, segment.file, line, severity, kind, segment.item, segment.axis)
        self._counts[kind] += 1
        self._last[kind] = finding
        if self._counts[kind] <= MOST_OF_A_KIND:
            self._found.append(finding)

    def finished(self) -> tuple[Finding, ...]:
        """All of them; where there were too many of a kind, how many more and up to which line."""
        rest = []
        for kind, count in self._counts.items():
            if count > MOST_OF_A_KIND:
                last = self._last[kind]
                what = Message(
                    "{count} more of this kind, the last in line {line}: {what}",
                    count=count - MOST_OF_A_KIND,
                    line=last.line,
                    what=last.what,
                )
                rest.append(Finding(what, last.segment, last.line, last.severity, kind, last.item, last.axis))
        return (*self._found, *rest)
