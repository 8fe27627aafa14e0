"""Lines of text out of a stream of bytes."""

from __future__ import annotations

from ahrs_lab.instruments.protocols.frames import LinkCounts

LONGEST_LINE = 4096


class LineDecoder:
    """Splits at ``terminator``; a line longer than ``longest`` is skipped up to the next terminator. Bytes
    that are no ASCII become U+FFFD and count as failed lines; nothing raises."""

    def __init__(self, terminator: bytes = b"\n", longest: int = LONGEST_LINE) -> None:
        self.counts = LinkCounts()
        self._terminator = terminator
        self._longest = longest
        self._rest = b""
        self._too_long = False

    def feed(self, data: bytes) -> list[str]:
        """The lines completed by ``data``, without terminator."""
        self.counts.received_bytes += len(data)
        *lines, rest = (self._rest + data).split(self._terminator)
        found = [text for line in lines if (text := self._line(line)) is not None]
        if len(rest) > self._longest + len(self._terminator) - 1:
            # What may be the beginning of a terminator has to stay.
            keep = len(self._terminator) - 1
            self.counts.skipped_bytes += len(rest) - keep
            rest = rest[len(rest) - keep :] if keep else b""
            self._too_long = True
        self._rest = rest
        return found

    def flush(self) -> list[str]:
        """Forget a line that was not finished."""
        self.counts.skipped_bytes += len(self._rest)
        self._rest = b""
        self._too_long = False
        return []

    def _line(self, line: bytes) -> str | None:
        whole = len(line) + len(self._terminator)
        if self._too_long or len(line) > self._longest:
            self._too_long = False
            self.counts.failed += 1
            self.counts.skipped_bytes += whole
            return None
        self.counts.frames += 1
        text = line.decode("ascii", errors="replace")
        if "\ufffd" in text:
            self.counts.failed += 1
        return text
