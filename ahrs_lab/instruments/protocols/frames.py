"""Finding frames in a stream of bytes, whatever lies between them and however it was split.

One rule makes the frames independent of the split: the scanner walks from left to right and decides on a
place only when all the bytes that matter for it are there. A place where no valid frame begins is left by one
byte, so a sync byte inside garbage or a frame cut short never hides the frame that follows it.
"""

from __future__ import annotations

from collections.abc import Hashable, Iterable, Sequence
from dataclasses import dataclass, replace
from typing import Final, NamedTuple, Protocol, TypeVar

import numpy as np
from numpy.typing import NDArray

Bytes2D = NDArray[np.uint8]
"""Shape (frames, length): equally long frames, one a row."""

FrameT = TypeVar("FrameT")
KeyT = TypeVar("KeyT", bound=Hashable)

UNDECIDED: Final = 0
"""An extent: more bytes are needed to say."""

NO_FRAME: Final = -1
"""An extent: no frame begins here."""

_FIRST_WINDOW: Final = 64


@dataclass
class LinkCounts:
    """What came over a link. Bytes received are bytes of frames, skipped bytes, and the few not yet decided.

    ``failed`` counts frames whose checksum or length was wrong; their bytes are among ``skipped_bytes``.
    ``untimed`` counts samples dropped because the frame that carries their device time was lost.
    """

    received_bytes: int = 0
    frames: int = 0
    failed: int = 0
    skipped_bytes: int = 0
    untimed: int = 0

    def snapshot(self) -> LinkCounts:
        """A copy that stays as it is."""
        return replace(self)


class Decoder(Protocol[FrameT]):
    """Bytes in, frames out: the same frames for any split of the bytes, and never an exception."""

    counts: LinkCounts

    def feed(self, data: bytes) -> list[FrameT]:
        """The frames completed by ``data``, in order."""
        ...

    def flush(self) -> list[FrameT]:
        """The stream has ended: what was waiting for more bytes is decided now."""
        ...


class FrameFormat(Protocol):
    """What the scanner has to know of one kind of frame."""

    def find(self, data: bytes, start: int) -> int:
        """First place ≥ ``start`` where a frame may begin; ``len(data)`` where there is none."""
        ...

    def extent(self, data: bytes, start: int) -> int:
        """Length of the frame that begins at ``start``, :data:`UNDECIDED` or :data:`NO_FRAME`.

        It may depend only on the frame's own bytes, so that more data never changes the answer.
        """
        ...

    def holds(self, data: bytes, start: int, stop: int) -> bool:
        """Whether the checksum of the whole frame ``data[start:stop]`` is right."""
        ...

    def key_length(self, data: bytes, start: int, /) -> int:
        """How many leading bytes fix the frame's length, so that frames which share them can be checked
        together; 0 where frames are looked at one by one."""
        ...

    def rows_hold(self, rows: Bytes2D) -> NDArray[np.bool_]:
        """Shape (k,): :meth:`holds` of each row. Asked only where :meth:`key_length` is not 0."""
        ...


class Run(NamedTuple):
    """``many`` valid frames of one format, each ``length`` bytes, one behind the other in ``data``.

    ``order`` is the number of the first among all frames of the stream.
    """

    format: FrameFormat
    order: int
    data: bytes
    start: int
    length: int
    many: int

    def frames(self) -> list[bytes]:
        """The bytes of each frame."""
        stop = self.start + self.length * self.many
        return [self.data[at : at + self.length] for at in range(self.start, stop, self.length)]


class FrameScanner:
    """Walks a stream and gives its valid frames as runs; keeps the counts."""

    def __init__(self, formats: Sequence[FrameFormat]) -> None:
        self.counts = LinkCounts()
        self._formats = tuple(formats)
        self._rest = b""
        self._offset = 0
        self._failed_until = 0

    def feed(self, data: bytes) -> list[Run]:
        """The runs of frames completed by ``data``."""
        self.counts.received_bytes += len(data)
        return self._scan(self._rest + data if self._rest else bytes(data), final=False)

    def flush(self) -> list[Run]:
        """What waited for more bytes is decided as if none ever came."""
        return self._scan(self._rest, final=True)

    def _scan(self, data: bytes, final: bool) -> list[Run]:
        runs: list[Run] = []
        counts, end, at = self.counts, len(data), 0
        places = [-1] * len(self._formats)
        while at < end:
            for i, place in enumerate(places):
                if place < at:
                    places[i] = self._formats[i].find(data, at)
            begin = min(places)
            counts.skipped_bytes += begin - at
            at = begin
            if at >= end:
                break
            found = self._formats[places.index(begin)]
            extent = found.extent(data, at)
            stop = at + extent
            if (extent == UNDECIDED or stop > end) and not final:
                break
            if extent > 0 and stop <= end:
                if found.holds(data, at, stop):
                    count = 1 + self._followers(found, data, at, stop)
                    runs.append(Run(found, counts.frames, data, at, extent, count))
                    counts.frames += count
                    at += extent * count
                    continue
                if self._offset + at >= self._failed_until:
                    # Whatever looks like a frame inside a broken one is part of the same damage.
                    counts.failed += 1
                    self._failed_until = self._offset + stop
            counts.skipped_bytes += 1
            at += 1
        self._rest = data[at:]
        self._offset += at
        return runs

    @staticmethod
    def _followers(found: FrameFormat, data: bytes, start: int, stop: int) -> int:
        """How many valid frames with the same leading bytes follow at once."""
        key = found.key_length(data, start)
        head = data[start : start + key]
        if not key or not data.startswith(head, stop):
            return 0
        length = stop - start
        wanted = np.frombuffer(head, dtype=np.uint8)
        count, window = 0, _FIRST_WINDOW
        while True:
            begin = stop + count * length
            many = min((len(data) - begin) // length, window)
            if many <= 0:
                return count
            rows = np.frombuffer(data, np.uint8, many * length, begin).reshape(many, length)
            same = _leading((rows[:, :key] == wanted).all(axis=1))
            good = _leading(found.rows_hold(rows[:same])) if same else 0
            count += good
            if good < window:
                return count
            window *= 4


def _leading(flags: NDArray[np.bool_]) -> int:
    """How many are true before the first that is not."""
    return len(flags) if flags.all() else int(np.argmin(flags))


def stacked(runs: Iterable[Run]) -> tuple[NDArray[np.int64], Bytes2D]:
    """Orders (k,) and bytes (k, length) of runs of equally long frames."""
    runs = list(runs)
    length = runs[0].length
    pieces = [np.frombuffer(r.data, np.uint8, r.many * length, r.start) for r in runs]
    rows = (pieces[0] if len(pieces) == 1 else np.concatenate(pieces)).reshape(-1, length)
    if len(runs) == 1:
        return np.arange(runs[0].order, runs[0].order + runs[0].many, dtype=np.int64), rows
    first = np.array([r.order for r in runs], dtype=np.int64)
    counts = np.array([r.many for r in runs], dtype=np.int64)
    ends = np.cumsum(counts)
    return np.arange(ends[-1], dtype=np.int64) + np.repeat(first - (ends - counts), counts), rows


def grouped(runs: Iterable[tuple[KeyT, Run]]) -> dict[KeyT, list[Run]]:
    """Runs by key, in order of first appearance."""
    groups: dict[KeyT, list[Run]] = {}
    for key, run in runs:
        groups.setdefault(key, []).append(run)
    return groups
