"""A link whose other end is a function, or a conversation written down beforehand."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager

from ahrs_lab.instruments.links.link import LinkLostError


class FakeLink:
    """A :class:`~ahrs_lab.instruments.links.link.Link`. ``answer`` gets what is written and gives what can be
    read; ``broken`` makes everything fail as if unplugged."""

    def __init__(self, answer: Callable[[bytes], bytes], bits_per_second: int | None = None) -> None:
        self.answer = answer
        self.bits_per_second = bits_per_second
        self.name = "fake"
        self.opened = False
        self.broken = False
        self.written: list[bytes] = []
        self._waiting = b""

    def open(self) -> None:
        self._check(opening=True)
        self.opened = True

    def close(self) -> None:
        self.opened = False
        self._waiting = b""

    def read(self, timeout_s: float) -> bytes:
        self._check()
        data, self._waiting = self._waiting, b""
        return data

    def write(self, data: bytes) -> None:
        self._check()
        self.written.append(data)
        self._waiting += self.answer(data)

    def _check(self, opening: bool = False) -> None:
        if self.broken or not (self.opened or opening):
            raise LinkLostError("fake is unplugged")


@contextmanager
def expected_conversation(pairs: Sequence[tuple[bytes, bytes]]) -> Iterator[FakeLink]:
    """A link that takes exactly these requests in this order and gives these answers; fails where anything
    else is said, or where something of it has not been said at the end."""
    left = list(pairs)

    def answer(request: bytes) -> bytes:
        assert left, f"nothing more was to be said, but {request!r} was"
        wanted, reply = left.pop(0)
        assert request == wanted
        return reply

    yield FakeLink(answer)
    assert not left, f"never said: {left[0][0]!r} and {len(left) - 1} more"
