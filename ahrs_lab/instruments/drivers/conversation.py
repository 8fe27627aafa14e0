"""One question, one answer, over a link: for instruments that speak only when asked.

Not for several threads: the driver holds its own lock around a conversation.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import Generic, Protocol, TypeVar

from ahrs_lab.instruments.links.link import Link, LinkLostError

_SLICE_S = 0.05
_BITS_OF_BYTE = 10.0

_T = TypeVar("_T")


class AnswerDecoder(Protocol[_T]):
    """What finds answers in the bytes that come."""

    def feed(self, data: bytes) -> list[_T]: ...
    def flush(self) -> list[_T]: ...


class Conversation(Generic[_T]):
    """Asks over ``link`` and decodes with ``decoder``. An answer that stays out for ``timeout_s`` counts as a
    lost link: what comes later could be taken for the answer to something else."""

    def __init__(
        self,
        link: Link,
        decoder: AnswerDecoder[_T],
        timeout_s: float = 0.8,
        *,
        now_s: Callable[[], float] = time.monotonic,
    ) -> None:
        self.link = link
        self.timeout_s = timeout_s
        self._decoder = decoder
        self._now_s = now_s
        self._answers: list[_T] = []

    def open(self) -> None:
        """Open the link; forget what was left of an earlier conversation."""
        self.link.open()
        self.forget()

    def close(self) -> None:
        """Close the link."""
        self.link.close()

    def forget(self) -> None:
        """Drop what has arrived unasked."""
        while self.link.read(0.0):
            pass
        self._decoder.flush()
        self._answers.clear()

    def say(self, request: bytes) -> None:
        """Send without waiting for an answer."""
        self.link.write(request)

    def ask(self, request: bytes, *, tries: int = 1) -> _T:
        """Send and wait for the first answer, ``tries`` times: more than once only what may be asked twice.
        Raises LinkLostError."""
        answer: _T | None = None
        for _ in range(tries):
            self.forget()
            self.link.write(request)
            answer = self.listen(self.timeout_s)
            if answer is not None:
                break
        if answer is None:
            raise LinkLostError(
                "{name} has not answered “{request}” within {timeout} s: check the cable, the power and "
                "the settings of the link.",
                name=self.link.name,
                request=request.decode("ascii", errors="replace").strip(),
                timeout=round(tries * self.timeout_s, 3),
            )
        return answer

    def listen(self, timeout_s: float) -> _T | None:
        """The next answer; None where none comes within ``timeout_s``."""
        end = self._now_s() + timeout_s
        while not self._answers:
            data = self.link.read(_SLICE_S)
            self._answers += self._decoder.feed(data)
            if not self._answers and self._now_s() >= end:
                return None
        return self._answers.pop(0)

    def on_the_wire_s(self, count: int) -> float:
        """How long ``count`` bytes take at the link's rate, with start and stop bit."""
        rate = self.link.bits_per_second
        return 0.0 if rate is None else count * _BITS_OF_BYTE / rate
