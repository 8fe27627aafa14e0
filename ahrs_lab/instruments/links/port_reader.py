"""One plain thread per port: timed blocking reads, stamped and handed on; lost links opened again.

The thread owns the link from :meth:`PortReader.start` to :meth:`PortReader.close`: nobody else opens, reads
or closes it meanwhile, anybody may write.
"""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from dataclasses import dataclass

from ahrs_lab.errors import AhrsLabError
from ahrs_lab.instruments.links.link import Link, LinkLostError
from ahrs_lab.instruments.links.raw_log import Block, BlockKind, RawLog

READ_TIMEOUT_S = 0.1
"""How long the thread may be deaf to being told to end."""
FIRST_BACK_OFF_S = 0.1
LONGEST_BACK_OFF_S = 2.0


@dataclass(frozen=True)
class Gap:
    """A time without a link, host time; ``back_s`` None while it lasts."""

    lost_s: float
    back_s: float | None
    reason: str


class PortReader:
    """Reads ``link`` until closed. Blocks carry ``now_s()`` of their arrival and are taken with :meth:`take`;
    where ``on_block`` is given it gets them instead, in the reader's thread, and has to be quick.

    A link that is lost is opened again, after 0.1 s, 0.2 s … up to every 2 s. ``connections`` counts how
    often it was open: whoever configured the instrument compares it and verifies the settings again.
    """

    def __init__(
        self,
        link: Link,
        *,
        now_s: Callable[[], float] = time.monotonic,
        raw: RawLog | None = None,
        on_block: Callable[[Block], None] | None = None,
    ) -> None:
        self._link = link
        self._now_s = now_s
        self._raw = raw
        self._on_block = on_block
        self._blocks: list[Block] = []
        self._gaps: list[Gap] = []
        self._news = threading.Condition()
        self._end = threading.Event()
        self._thread: threading.Thread | None = None
        self._failure: AhrsLabError | None = None
        self._lost: LinkLostError | None = None
        self.connections = 0
        self.received_bytes = 0

    def start(self) -> None:
        """Open the link, raising LinkLostError where that fails, and begin to read."""
        if self._thread is not None:
            return
        self._link.open()
        self.connections += 1
        self._end.clear()
        self._thread = threading.Thread(target=self._work, name=f"reader {self._link.name}", daemon=True)
        self._thread.start()

    def close(self) -> None:
        """End the thread, close the link and the raw file. May be called again, and without a start."""
        self._end.set()
        thread, self._thread = self._thread, None
        if thread is not None:
            thread.join()
        self._link.close()
        raw, self._raw = self._raw, None
        if raw is not None:
            raw.close()

    @property
    def lost(self) -> LinkLostError | None:
        """Why there is no link at the moment; None while there is."""
        return self._lost

    @property
    def gaps(self) -> tuple[Gap, ...]:
        """All times without a link since the start."""
        with self._news:
            return tuple(self._gaps)

    def keep_raw(self, raw: RawLog | None) -> None:
        """From the next block on write to ``raw`` (a run begins), or to nothing; closes the file before."""
        with self._news:
            before, self._raw = self._raw, raw
            if before is not None:
                before.close()

    def take(self, timeout_s: float = 0.0) -> list[Block]:
        """The blocks since the last call; waits up to ``timeout_s`` for the first. Raises MachineError where
        the raw bytes could not be written."""
        with self._news:
            if not self._blocks and self._failure is None and timeout_s > 0.0:
                self._news.wait_for(lambda: bool(self._blocks) or self._failure is not None, timeout_s)
            if self._failure is not None:
                failure, self._failure = self._failure, None
                raise failure
            blocks, self._blocks = self._blocks, []
            return blocks

    def _work(self) -> None:
        while not self._end.is_set():
            try:
                data = self._link.read(READ_TIMEOUT_S)
            except LinkLostError as error:
                self._reconnect(error)
                continue
            if data:
                self.received_bytes += len(data)
                self._hand_on(Block(self._now_s(), data))

    def _reconnect(self, error: LinkLostError) -> None:
        self._lost = error
        lost_s = self._now_s()
        with self._news:
            self._gaps.append(Gap(lost_s, None, str(error)))
        self._hand_on(Block(lost_s, b"", BlockKind.LOST))
        self._link.close()
        back_off = FIRST_BACK_OFF_S
        while not self._end.wait(back_off):
            try:
                self._link.open()
            except LinkLostError as still:
                self._lost = still
                back_off = min(2.0 * back_off, LONGEST_BACK_OFF_S)
                continue
            back_s = self._now_s()
            with self._news:
                self._gaps[-1] = Gap(lost_s, back_s, str(error))
                self.connections += 1
            self._lost = None
            self._hand_on(Block(back_s, b"", BlockKind.BACK))
            return

    def _hand_on(self, block: Block) -> None:
        with self._news:
            if self._raw is not None:
                try:
                    self._raw.add(block)
                except AhrsLabError as error:
                    self._failure, self._raw = error, None
            if self._on_block is None:
                self._blocks.append(block)
            self._news.notify_all()
        if self._on_block is not None:
            self._on_block(block)
