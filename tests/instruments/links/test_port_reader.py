"""The reader thread: everything in order with its time, raw bytes kept, unplugging noticed and mended."""

from __future__ import annotations

import math
import threading
import time
from collections.abc import Callable
from functools import partial
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from ahrs_lab.errors import InputError, MachineError
from ahrs_lab.instruments.links.port_reader import PortReader
from ahrs_lab.instruments.links.raw_log import Block, BlockKind, RawLog, read_raw
from ahrs_lab.instruments.links.replay_link import ReplayLink
from ahrs_lab.instruments.links.serial_link import SerialLink
from ahrs_lab.instruments.links.tcp_link import TcpLink
from tests.instruments.links.ports import TcpEnd, needs_pty, pty_end, tcp_end


def wait_for(condition: Callable[[], bool], limit_s: float = 5.0) -> float:
    begin = time.monotonic()
    while not condition():
        assert time.monotonic() - begin < limit_s, "waited too long"
        time.sleep(0.005)
    return time.monotonic() - begin


def has_received(reader: PortReader, count: int) -> bool:
    return reader.received_bytes == count


def bytes_of(blocks: list[Block]) -> bytes:
    return b"".join(block.data for block in blocks)


@needs_pty
def test_bytes_arrive_in_order_with_times_that_do_not_go_back() -> None:
    sent = bytes(range(256)) * 40
    with pty_end() as end:
        reader = PortReader(SerialLink(end.path, 921600))
        reader.start()
        feeder = threading.Thread(target=end.send, args=(sent,))
        feeder.start()
        blocks: list[Block] = []
        while len(bytes_of(blocks)) < len(sent):
            blocks += reader.take(5.0)
        feeder.join()
        reader.close()
    assert bytes_of(blocks) == sent
    times = [block.t_s for block in blocks]
    assert times == sorted(times)
    assert reader.received_bytes == len(sent)


@needs_pty
def test_an_unplugged_port_is_noticed_within_a_second() -> None:
    with pty_end() as end:
        reader = PortReader(SerialLink(end.path))
        reader.start()
        end.send(b"alive")
        wait_for(lambda: reader.received_bytes == 5)
        end.unplug()
        assert wait_for(lambda: reader.lost is not None) < 1.0
        reader.close()
    assert reader.gaps[0].back_s is None
    blocks = reader.take()
    assert bytes_of(blocks) == b"alive"
    assert [block.kind for block in blocks if not block.data] == [BlockKind.LOST]


def test_a_connection_that_comes_back_is_used_again_and_the_gap_is_told() -> None:
    with tcp_end() as end:
        reader = PortReader(TcpLink("127.0.0.1", end.port))
        reader.start()
        end.accept().sendall(b"before")
        wait_for(lambda: reader.received_bytes == 6)
        port = end.port
        end.unplug()
        assert wait_for(lambda: reader.lost is not None) < 1.0
        again = TcpEnd(port)
        again.accept().sendall(b"after")
        wait_for(lambda: reader.received_bytes == 11)
        assert reader.lost is None
        assert reader.connections == 2
        (gap,) = reader.gaps
        assert gap.back_s is not None
        assert gap.back_s > gap.lost_s
        blocks = reader.take()
        reader.close()
        again.unplug()
    assert bytes_of(blocks) == b"beforeafter"
    assert [b.kind for b in blocks if not b.data] == [BlockKind.LOST, BlockKind.BACK]


def test_closing_twice_and_without_a_start_is_quiet() -> None:
    reader = PortReader(TcpLink("127.0.0.1", 9))
    reader.close()
    reader.close()


def test_the_raw_bytes_of_a_run_replay_as_the_same_blocks(tmp_path: Path) -> None:
    with tcp_end() as end:
        reader = PortReader(TcpLink("127.0.0.1", end.port), raw=RawLog(tmp_path / "raw" / "ahrs"))
        reader.start()
        peer = end.accept()
        sent = 0
        for part in (b"one", b"two", b"three"):
            sent += len(part)
            peer.sendall(part)
            wait_for(partial(has_received, reader, sent))
        blocks = reader.take()
        reader.close()
    assert list(read_raw(tmp_path / "raw" / "ahrs.bin")) == blocks
    link = ReplayLink(tmp_path / "raw" / "ahrs.bin")
    link.open()
    replayed = []
    while data := link.read(0.1):
        replayed.append(Block(link.t_s, data))
    assert replayed == blocks
    assert link.finished


def test_a_full_disk_is_told_to_who_takes_the_bytes(tmp_path: Path) -> None:
    raw = RawLog(tmp_path / "x")

    def full(block: Block) -> None:
        raise MachineError("disk full")

    raw.add = full  # type: ignore[method-assign]
    with tcp_end() as end:
        reader = PortReader(TcpLink("127.0.0.1", end.port), raw=raw)
        reader.start()
        end.accept().sendall(b"x")
        with pytest.raises(MachineError, match="disk full"):
            wait_for(lambda: bool(reader.take(0.1)))
        assert bytes_of(reader.take(0.5)) == b"x"
        reader.close()
    raw.close()


def test_raw_bytes_are_never_written_over(tmp_path: Path) -> None:
    RawLog(tmp_path / "a").close()
    with pytest.raises(InputError, match="never written over"):
        RawLog(tmp_path / "a")


@given(
    parts=st.lists(st.binary(min_size=1, max_size=20), max_size=10),
    cut_bytes=st.integers(0, 300),
    cut_index=st.integers(0, 300),
)
def test_what_a_kill_left_reads_as_far_as_it_goes(
    tmp_path_factory: pytest.TempPathFactory, parts: list[bytes], cut_bytes: int, cut_index: int
) -> None:
    stem = tmp_path_factory.mktemp("raw") / "x"
    with RawLog(stem) as log:
        for i, part in enumerate(parts):
            log.add(Block(float(i), part))
    data = log.bytes_path.read_bytes()
    left = data[: max(len(data) - cut_bytes, 0)]
    log.bytes_path.write_bytes(left)
    index = log.index_path.read_bytes()
    log.index_path.write_bytes(index[: max(len(index) - cut_index, len(b"AHRSRAW1"))])
    blocks = list(read_raw(log.bytes_path))
    assert bytes_of(blocks) == left
    times = [block.t_s for block in blocks if not math.isnan(block.t_s)]
    assert times == [float(i) for i in range(len(times))]
