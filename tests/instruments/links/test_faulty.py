"""The faulty link: what it does to bytes is the seed's and the place's, not the split's."""

from __future__ import annotations

import time

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from ahrs_lab.errors import InputError
from ahrs_lab.instruments.links.faulty import ByteDamage, FaultyLink, LinkFaults, faults_from_text
from ahrs_lab.instruments.links.link import LinkLostError
from tests.instruments.fake_link import FakeLink


class Stream(FakeLink):
    """A link with bytes to come; time passes where a read waits for nothing."""

    def __init__(self, *parts: bytes) -> None:
        super().__init__(lambda data: b"")
        self.parts = list(parts)
        self.t_s = 0.0

    def now_s(self) -> float:
        return self.t_s

    def read(self, timeout_s: float) -> bytes:
        self._check()
        if self.parts:
            self.t_s += 0.001
            return self.parts.pop(0)
        self.t_s += max(timeout_s, 1e-4)
        return b""


def faulty(stream: Stream, faults: LinkFaults, seed: int = 1) -> FaultyLink:
    link = FaultyLink(stream, faults, seed, now_s=stream.now_s)
    link.open()
    return link


def drain(link: FaultyLink, times: int = 50) -> list[bytes]:
    return [data for _ in range(times) if (data := link.read(0.05))]


@given(st.lists(st.binary(min_size=1, max_size=30), min_size=1, max_size=8))
def test_damage_does_not_depend_on_the_split(parts: list[bytes]) -> None:
    faults = LinkFaults(lose=0.1, double=0.1, flip=0.1)
    whole = ByteDamage(faults, 7).apply(b"".join(parts))
    split = ByteDamage(faults, 7)
    assert b"".join(split.apply(part) for part in parts) == whole


def test_as_many_bytes_suffer_as_were_asked_for() -> None:
    sent = bytes(200_000)
    lost = ByteDamage(LinkFaults(lose=0.01), 1).apply(sent)
    assert len(sent) - len(lost) == pytest.approx(2000, abs=5 * np.sqrt(2000))
    doubled = ByteDamage(LinkFaults(double=0.01), 1).apply(sent)
    assert len(doubled) - len(sent) == pytest.approx(2000, abs=5 * np.sqrt(2000))
    flipped = np.frombuffer(ByteDamage(LinkFaults(flip=0.01), 1).apply(sent), dtype=np.uint8)
    changed = flipped[flipped != 0]
    assert len(changed) == pytest.approx(2000, abs=5 * np.sqrt(2000))
    assert set(changed.tolist()) == {1 << bit for bit in range(8)}


def test_without_faults_nothing_changes() -> None:
    stream = Stream(b"abc", b"def")
    assert b"".join(drain(faulty(stream, LinkFaults()))) == b"abcdef"


def test_split_packets_keep_every_byte() -> None:
    parts = [bytes([i]) * 10 for i in range(40)]
    got = drain(faulty(Stream(*parts), LinkFaults(split=0.5)), 200)
    assert b"".join(got) == b"".join(parts)
    assert len(got) > 45


def test_merged_packets_come_at_multiples_of_the_time() -> None:
    stream = Stream(*[bytes([i]) for i in range(64)])
    link = faulty(stream, LinkFaults(merge_s=0.016))
    got, times = [], []
    for _ in range(20):
        data = link.read(0.05)
        if data:
            got.append(data)
            times.append(stream.t_s)
    assert b"".join(got) == bytes(range(64))
    assert len(got) <= 6
    assert all(t % 0.016 < 0.006 for t in times)


def test_a_stall_holds_everything_back_for_its_time() -> None:
    stream = Stream(b"a" * 10, b"b" * 10)
    link = faulty(stream, LinkFaults(stall_after=10, stall_s=0.5))
    assert link.read(0.3) == b""
    begin = stream.t_s
    got = drain(link)
    assert b"".join(got) == b"a" * 10 + b"b" * 10
    assert begin < 0.5 <= stream.t_s


def test_a_disconnected_link_comes_back_when_its_time_is_over() -> None:
    stream = Stream(b"a" * 10, b"b" * 10)
    link = faulty(stream, LinkFaults(disconnect_after=10, disconnect_s=1.0))
    with pytest.raises(LinkLostError):
        drain(link)
    link.close()
    with pytest.raises(LinkLostError):
        link.open()
    stream.t_s += 1.1
    link.open()
    assert b"".join(drain(link)) == b"b" * 10


def test_written_bytes_suffer_only_where_asked() -> None:
    for writes, count in ((False, 1000), (True, 0)):
        stream = Stream()
        link = faulty(stream, LinkFaults(lose=1.0, writes=writes))
        link.write(bytes(1000))
        assert len(b"".join(stream.written)) == count


def test_faults_are_written_on_a_line() -> None:
    assert faults_from_text("lose=1e-5, merge_s=0.016,again=true") == LinkFaults(
        lose=1e-5, merge_s=0.016, again=True
    )
    for wrong in ("lose", "loose=1", "lose=2", "lose=x"):
        with pytest.raises(InputError):
            faults_from_text(wrong)


def test_real_time_is_the_default() -> None:
    link = FaultyLink(FakeLink(lambda data: b""), LinkFaults())
    link.open()
    link.stall(0.05)
    begin = time.monotonic()
    assert link.read(0.02) == b""
    assert time.monotonic() - begin >= 0.02
