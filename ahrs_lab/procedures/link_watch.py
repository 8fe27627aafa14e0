"""What went wrong on the wire to the device, segment by segment, for the record and its warnings."""

from __future__ import annotations

from typing import Final

from ahrs_lab.instruments.interfaces import Ahrs, CountsLink
from ahrs_lab.messages import Message

_TOLD: Final[dict[str, Message]] = {
    "failed": Message("damaged frames"),
    "skipped_bytes": Message("bytes that made no frame"),
    "untimed": Message("samples without a time"),
    "lost": Message("samples lost"),
    "repeated": Message("samples repeated"),
    "implausible": Message("samples left out as impossible"),
    "reconnections": Message("times the link was lost and came back"),
}


class LinkWatch:
    """Counts of a segment are differences; a device that is in process has none."""

    def __init__(self, ahrs: Ahrs) -> None:
        self._ahrs = ahrs
        self._before: dict[str, int] = {}
        self.totals: dict[str, int] = {}
        """Over all segments."""

    def begin(self) -> None:
        """A segment begins."""
        self._before = self._counts()

    def end(self) -> Message | None:
        """What went wrong since it began; None where nothing did."""
        now = self._counts()
        passed = {name: value - self._before.get(name, 0) for name, value in now.items()}
        for name, value in passed.items():
            self.totals[name] = self.totals.get(name, 0) + value
        wrong = {name: value for name, value in passed.items() if name in _TOLD and value > 0}
        if not wrong:
            return None
        parts = [Message("{count} {what}", count=value, what=_TOLD[name]) for name, value in wrong.items()]
        told = parts[0]
        for part in parts[1:]:
            told = Message("{first}, {second}", first=told, second=part)
        return Message("On the wire to the device: {what}.", what=told)

    def _counts(self) -> dict[str, int]:
        return dict(self._ahrs.link_counts) if isinstance(self._ahrs, CountsLink) else {}
