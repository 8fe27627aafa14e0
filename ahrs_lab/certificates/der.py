"""Whether bytes are one ASN.1 value in its distinguished encoding (ITU-T X.690, 10 and 11), as far as its
tags tell: then it cannot be written another way and still mean the same."""

from __future__ import annotations

import re
from collections.abc import Callable

_DEEPEST = 64
SEQUENCE, SET = 0x30, 0x31


class _NotCanonicalError(Exception):
    """Another encoding would have been the distinguished one."""


def is_distinguished(data: bytes) -> bool:
    """Lengths as short as can be, sets in order, numbers and object identifiers without padding, and nothing
    behind. What an implicit tag stands for is not known: a set behind one is for the caller to look at."""
    try:
        return _end(data, 0, len(data), 0) == len(data)
    except (_NotCanonicalError, IndexError):
        return False


def length_of(data: bytes) -> int:
    """Bytes of the value that ``data`` begins with; −1 where there is none."""
    try:
        return _extent(data, 0, len(data))[1]
    except (_NotCanonicalError, IndexError):
        return -1


def value(tag: int, *contents: bytes) -> bytes:
    """A value of its contents."""
    whole = b"".join(contents)
    length = len(whole)
    octets = b"" if length < 0x80 else length.to_bytes((length.bit_length() + 7) // 8, "big")
    return bytes([tag, 0x80 | len(octets) if octets else length]) + octets + whole


def _extent(data: bytes, at: int, stop: int) -> tuple[int, int]:
    """Where the contents of the value at ``at`` begin and end."""
    first = data[at + 1]
    start, length = at + 2, first
    if first >= 0x80:
        start += first & 0x7F
        octets = data[at + 2 : start]
        length = int.from_bytes(octets, "big")
        if not octets or octets[0] == 0 or length < 0x80:
            raise _NotCanonicalError
    if start + length > stop:
        raise _NotCanonicalError
    return start, start + length


def _end(data: bytes, at: int, stop: int, depth: int) -> int:
    """Where the value at ``at`` ends, which is to be before ``stop``; raises what is no such value."""
    tag = data[at]
    universal = tag < 0x40
    if tag & 0x1F == 0x1F or depth > _DEEPEST:  # tags beyond 30 are not used by what is read here
        raise _NotCanonicalError
    start, end = _extent(data, at, stop)
    if not tag & 0x20:
        if universal and not _PRIMITIVE.get(tag, _anything)(data[start:end]):
            raise _NotCanonicalError
        return end
    if universal and tag not in (SEQUENCE, SET):
        raise _NotCanonicalError
    parts = []
    while start < end:
        after = _end(data, start, end, depth + 1)
        parts.append(data[start:after])
        start = after
    if tag == SET and parts != sorted(parts):
        raise _NotCanonicalError
    return end


def _anything(_contents: bytes) -> bool:
    return True


def _never(_contents: bytes) -> bool:
    return False


def _is_boolean(contents: bytes) -> bool:
    return contents in (b"\x00", b"\xff")


def _is_integer(contents: bytes) -> bool:
    """The first nine bits are not all alike."""
    if len(contents) < 2:
        return len(contents) == 1
    return not (contents[0] in (0x00, 0xFF) and (contents[0] ^ contents[1]) < 0x80)


def _is_bit_string(contents: bytes) -> bool:
    unused = contents[0]
    if unused == 0 or len(contents) == 1:
        return unused == 0
    return unused < 8 and not contents[-1] & ((1 << unused) - 1)


def _is_null(contents: bytes) -> bool:
    return not contents


def _is_object_identifier(contents: bytes) -> bool:
    """No number begins with an empty septet, and the last one ends."""
    starts = [0, *(index + 1 for index, octet in enumerate(contents[:-1]) if octet < 0x80)]
    return contents[-1] < 0x80 and all(contents[index] != 0x80 for index in starts)


def _matches(pattern: bytes) -> Callable[[bytes], bool]:
    compiled = re.compile(pattern)
    return lambda contents: compiled.fullmatch(contents) is not None


_PRIMITIVE: dict[int, Callable[[bytes], bool]] = {
    0x00: _never,  # an end of contents, which only indefinite lengths have
    0x01: _is_boolean,
    0x02: _is_integer,
    0x03: _is_bit_string,
    0x05: _is_null,
    0x06: _is_object_identifier,
    0x0A: _is_integer,
    0x10: _never,
    0x11: _never,
    0x17: _matches(rb"[0-9]{12}Z"),
    0x18: _matches(rb"[0-9]{14}(\.[0-9]*[1-9])?Z"),
}
