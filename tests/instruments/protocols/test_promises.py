"""What every decoder promises: the same for any split, never an exception, found again after garbage."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from ahrs_lab.instruments.protocols.stream import StreamDecoder, joined
from ahrs_lab.recording.samples import Samples
from tests.instruments.protocols.streams_at_hand import CODECS, Codec

each_codec = pytest.mark.parametrize("codec", CODECS, ids=lambda codec: codec.name)


def pieces(codec: Codec) -> st.SearchStrategy[list[bytes]]:
    """Frames, replies, frames cut short, with a flipped bit, or with a right checksum around anything; sync
    bytes and garbage; in any order."""
    frames = st.sampled_from(codec.frames + codec.replies)
    cut = st.builds(lambda frame, part: frame[: max(1, int(part * len(frame)))], frames, st.floats(0, 0.99))
    flipped = st.builds(_flipped, frames, st.integers(0, 10_000))
    garbage = st.binary(max_size=40)
    sealed = st.builds(codec.sealed, st.binary(max_size=60))
    sync = st.sampled_from([codec.sync[:n] for n in range(1, len(codec.sync) + 1)])
    return st.lists(st.one_of(frames, frames, cut, flipped, sealed, sync, garbage), max_size=25)


def _flipped(frame: bytes, bit: int) -> bytes:
    place, digit = divmod(bit % (8 * len(frame)), 8)
    return frame[:place] + bytes((frame[place] ^ 1 << digit,)) + frame[place + 1 :]


def split(data: bytes, cuts: list[int]) -> list[bytes]:
    places = sorted({cut % (len(data) + 1) for cut in cuts} | {0, len(data)})
    return [data[a:b] for a, b in pairwise(places)]


def decoded(decoder: StreamDecoder, blocks: list[bytes]) -> Samples:
    return joined([*(decoder.feed(block) for block in blocks), decoder.flush()])


def assert_equal(one: Samples, other: Samples) -> None:
    assert set(one.columns) == set(other.columns)
    for name in one.columns:
        np.testing.assert_array_equal(one[name], other[name], err_msg=name)


@each_codec
@settings(max_examples=60, deadline=None)
@given(data=st.data())
def test_any_split_gives_the_same(codec: Codec, data: st.DataObject) -> None:
    stream = b"".join(data.draw(pieces(codec)))
    cuts = data.draw(st.lists(st.integers(0, 5000), max_size=30))
    whole, parts = codec.decoder(), codec.decoder()
    assert_equal(decoded(whole, [stream]), decoded(parts, split(stream, cuts)))
    assert whole.counts == parts.counts
    assert whole.replies == parts.replies


@each_codec
@settings(max_examples=25, deadline=None)
@given(stream=st.binary(max_size=3000))
def test_no_bytes_raise(codec: Codec, stream: bytes) -> None:
    decoder = codec.decoder()
    decoded(decoder, [stream[i : i + 1] for i in range(len(stream))])
    assert decoder.counts.received_bytes == len(stream)


@each_codec
@settings(max_examples=60, deadline=None)
@given(data=st.data())
def test_every_byte_is_in_a_frame_or_skipped(codec: Codec, data: st.DataObject) -> None:
    stream = b"".join(data.draw(pieces(codec)))
    scanner = codec.scanner()
    runs = [*scanner.feed(stream), *scanner.flush()]
    counts = scanner.counts
    assert sum(run.length * run.many for run in runs) + counts.skipped_bytes == len(stream)
    assert sum(run.many for run in runs) == counts.frames


@each_codec
def test_frames_are_found_again_behind_garbage(codec: Codec) -> None:
    rng = np.random.default_rng(5)
    for frame in codec.frames[:4]:
        for garbage in (
            b"\0",
            codec.sync,
            frame[:-1],
            frame[: len(frame) // 2],
            rng.bytes(37),
            b"M,4169\r\n",
        ):
            scanner = codec.scanner()
            runs = [*scanner.feed(garbage + codec.stream), *scanner.flush()]
            assert sum(run.many for run in runs) == len(codec.frames), (frame, garbage)
            assert scanner.counts.skipped_bytes == len(garbage)


@each_codec
def test_a_broken_frame_is_counted_once_and_costs_no_other(codec: Codec) -> None:
    broken = bytearray(codec.frames[1])
    broken[len(broken) // 2] ^= 0x04
    stream = codec.frames[0] + bytes(broken) + b"".join(codec.frames[2:])
    scanner = codec.scanner()
    runs = [*scanner.feed(stream), *scanner.flush()]
    assert sum(run.many for run in runs) == len(codec.frames) - 1
    assert scanner.counts.failed == 1
    assert scanner.counts.skipped_bytes == len(broken)


@each_codec
def test_a_stream_that_already_runs_is_joined(codec: Codec) -> None:
    whole = decoded(codec.decoder(), [codec.stream])
    joined_late = decoded(codec.decoder(), [codec.stream[len(codec.frames[0]) // 2 :]])
    assert len(whole) - len(joined_late) == 1


@pytest.mark.parametrize("codec", [codec for codec in CODECS if codec.replies], ids=lambda codec: codec.name)
def test_replies_are_kept_apart_from_samples(codec: Codec) -> None:
    decoder = codec.decoder()
    rows = decoded(decoder, [codec.stream + b"".join(codec.replies)])
    assert len(decoder.replies) == len(codec.replies)
    assert len(rows) == len(decoded(codec.decoder(), [codec.stream]))


def test_an_item_cut_off_in_one_message_does_not_hide_those_of_the_next() -> None:
    """Equally long messages that begin alike: the first one's second item runs over its end."""
    codec = next(codec for codec in CODECS if codec.name == "xsens")
    whole = codec.frames[0]
    counter = whole[4:9]
    odd = codec.sealed(counter + b"\x04\x0b\xff" + bytes(len(whole) - 5 - 8))
    assert len(odd) == len(whole)
    rows = decoded(codec.decoder(), [odd + codec.stream])
    assert len(rows) == len(codec.frames)
