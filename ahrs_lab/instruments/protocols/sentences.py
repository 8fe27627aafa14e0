"""Sentences of printable characters, ``$…*CS`` CR LF, in a stream of anything."""

from __future__ import annotations

import re
from typing import Final

import numpy as np
from numpy.typing import NDArray

from ahrs_lab.instruments.protocols.checksums import crc16_xmodem, xor8
from ahrs_lab.instruments.protocols.frames import NO_FRAME, UNDECIDED, Bytes2D

_MAX_LENGTH: Final = 512
_BODY: Final = re.compile(rb"[ -#%-)+-~]*")
_LONGEST_BODY: Final = _MAX_LENGTH - 2
_TAIL_LENGTH: Final = 7
_STAR: Final = 0x2A


def printable(body: bytes) -> bool:
    """Whether these characters may stand between ``$`` and ``*``."""
    return _BODY.fullmatch(body) is not None


class SentenceFormat:
    """See :class:`~ahrs_lab.instruments.protocols.frames.FrameFormat`. ``prefix`` begins with ``$``;
    ``tail`` matches ``*``, the checksum and the line's end, at most 7 bytes."""

    def __init__(self, prefix: bytes, tail: re.Pattern[bytes]) -> None:
        self._prefix = prefix
        self._tail = tail
        body = re.escape(prefix) + b"[ -#%%-)+-~]{0,%d}" % (_LONGEST_BODY + 1 - len(prefix))
        self._whole = re.compile(body + tail.pattern)

    def find(self, data: bytes, start: int) -> int:
        place = data.find(b"$", start)
        return place if place >= 0 else len(data)

    def extent(self, data: bytes, start: int) -> int:
        # Nearly every place that is asked about begins a whole sentence.
        whole = self._whole.match(data, start)
        if whole:
            return whole.end() - start
        if not self._prefix.startswith(data[start : start + len(self._prefix)]):
            return NO_FRAME
        match = _BODY.match(data, start + 1, start + _MAX_LENGTH)
        stop = match.end() if match else start
        if stop >= start + _MAX_LENGTH:
            return NO_FRAME
        if stop >= len(data):
            return UNDECIDED
        tail = data[stop : stop + _TAIL_LENGTH]
        found = self._tail.match(tail)
        if found:
            return stop + found.end() - start
        waiting = len(tail) < _TAIL_LENGTH and tail[0] == _STAR and b"\n" not in tail
        return UNDECIDED if waiting else NO_FRAME

    def holds(self, data: bytes, start: int, stop: int) -> bool:
        star = data.rindex(b"*", start, stop)
        given = data[star + 1 : stop].rstrip()
        if given == b"XX":
            return True
        body = data[start + 1 : star]
        return int(given, 16) == (xor8(body) if len(given) == 2 else crc16_xmodem(body))

    def key_length(self, _data: bytes, _start: int) -> int:
        return 0

    def rows_hold(self, rows: Bytes2D) -> NDArray[np.bool_]:
        return np.array([self.holds(row.tobytes(), 0, len(row)) for row in rows], dtype=np.bool_)
