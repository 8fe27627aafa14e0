"""Raw bytes of an earlier run as a link, so that a driver reads them as if they came just now."""

from __future__ import annotations

import math
from collections.abc import Iterator
from pathlib import Path

from ahrs_lab.instruments.links.link import LinkLostError
from ahrs_lab.instruments.links.raw_log import Block, BlockKind, read_raw


class ReplayLink:
    """A :class:`~ahrs_lab.instruments.links.link.Link` that gives the blocks as they arrived, one a read, as
    fast as they are asked for. ``t_s`` is the time of the block given last, so that ``now_s`` of a reader can
    be the run's. What is written goes nowhere."""

    def __init__(self, path: Path) -> None:
        self._path = path
        self._blocks: Iterator[Block] | None = None
        self.t_s = math.nan
        self.finished = False

    @property
    def name(self) -> str:
        """The file."""
        return str(self._path)

    @property
    def bits_per_second(self) -> int | None:
        """None."""
        return None

    def open(self) -> None:
        """Begin, or go on after a recorded loss of the link."""
        if self._blocks is None:
            self._blocks = read_raw(self._path)

    def close(self) -> None:
        """Nothing to release; a replay goes on where it was."""

    def read(self, timeout_s: float) -> bytes:  # noqa: ARG002 - nothing is waited for
        """The next block; a recorded loss is a LinkLostError again; b"" at the end."""
        if self._blocks is None:
            raise LinkLostError("The replay of {path} is not open.", path=self._path)
        for block in self._blocks:
            self.t_s = block.t_s
            if block.kind is BlockKind.LOST:
                raise LinkLostError("The link was lost here when {path} was recorded.", path=self._path)
            if block.data:
                return block.data
        self.finished = True
        return b""

    def write(self, data: bytes) -> None:
        """Nobody listens."""
