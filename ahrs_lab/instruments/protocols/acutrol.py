"""ACUTROL 3000, language ACL: what both sides say on TCP and on the serial–TCP bridge.

A request is a line ``:Main:Sub args`` CR LF. Every request is answered by an int32 error code, an int32
length, both little-endian, and that many ASCII characters; ``OK`` where there is nothing else to say. Padding
of the text is not documented: it is read by length and stripped.

Here is the side of the client, and the grammar of requests that the responder
(:mod:`ahrs_lab.instruments.protocols.acutrol_responder`) reads.
"""

from __future__ import annotations

import struct
from collections.abc import Mapping
from dataclasses import dataclass

from ahrs_lab.instruments.protocols.frames import LinkCounts

DEFAULT_PORT = 9878
LONGEST_REPLY = 8192
_HEADER = struct.Struct("<ii")
_TEXT = frozenset(range(0x20, 0x7F)) | {0x09, 0x0A, 0x0D}
_LARGEST_CODE = 1_000_000
"""Four characters of text taken for a code are far more."""


@dataclass(frozen=True)
class Reply:
    """``code`` 0: well. ``text`` stripped of padding."""

    code: int
    text: str


def encode_request(text: str) -> bytes:
    """The bytes of a request line."""
    return text.encode("ascii", errors="replace") + b"\r\n"


def encode_reply(code: int, text: str) -> bytes:
    """The bytes of an answer (the table's side)."""
    body = text.encode("ascii", errors="replace")
    return _HEADER.pack(code, len(body)) + body


class ReplyDecoder:
    """Finds answers. There is no sync mark: a header counts where its length is plausible and the text after
    it is text; any other place is left by one byte."""

    def __init__(self) -> None:
        self.counts = LinkCounts()
        self._rest = b""

    def feed(self, data: bytes) -> list[Reply]:
        """The answers completed by ``data``."""
        self.counts.received_bytes += len(data)
        data = self._rest + data
        found: list[Reply] = []
        at = 0
        while len(data) - at >= _HEADER.size:
            code, length = _HEADER.unpack_from(data, at)
            begin, end = at + _HEADER.size, at + _HEADER.size + length
            plausible = 0 <= length <= LONGEST_REPLY and abs(code) <= _LARGEST_CODE
            # NULs may pad the text, at its end only.
            if not plausible or not _TEXT.issuperset(data[begin:end].rstrip(b"\0")):
                self.counts.skipped_bytes += 1
                at += 1
                continue
            if end > len(data):
                break
            found.append(Reply(code, data[begin:end].decode("ascii").strip("\0 \t\r\n")))
            self.counts.frames += 1
            at = end
        self._rest = data[at:]
        return found

    def flush(self) -> list[Reply]:
        """Forget an answer that was not finished."""
        if self._rest:
            self.counts.failed += 1
        self.counts.skipped_bytes += len(self._rest)
        self._rest = b""
        return []


# the grammar of requests ──────────────────────────────────────────────────────────────────────────────────


@dataclass(frozen=True)
class Node:
    """A word of the command tree. ``acts``: it may be said as a command; ``asks``: with a question mark."""

    parts: Mapping[str, Node]
    acts: bool = False
    asks: bool = False


def _leaf(*, acts: bool = False, asks: bool = False) -> Node:
    return Node({}, acts, asks)


_ACT = _leaf(acts=True)
_ASK = _leaf(asks=True)
_BOTH = _leaf(acts=True, asks=True)

TREE = Node(
    {
        "Utility": Node({"Lockout": _BOTH}),
        "Interlock": Node({"Reset": _ACT, "Close": _ACT, "Open": _ACT}, asks=True),
        "Mode": Node({"Off": _ACT, "Position": _ACT, "Rate": _ACT, "ARate": _ACT}, asks=True),
        "Demand": Node({"Position": _BOTH, "Rate": _BOTH, "DeltaPosition": _BOTH}),
        "Read": Node({"Position": _ASK, "Rate": _ASK, "Acceleration": _ASK}),
        "Limit": Node({"Rate": _BOTH, "Acceleration": _BOTH, "Vtrip": _BOTH, "Absolute": _BOTH}),
        "Status": Node({"STB": _ASK, "CSR": _ASK, "ESR": _ASK}),
        "Query": Node({"Error": _ASK}),
    }
)


@dataclass(frozen=True)
class Call:
    """One command or query of a request, its words written out: ``("Demand", "Rate")``. ``*IDN?`` has the
    path ``("*IDN",)``."""

    path: tuple[str, ...]
    query: bool
    arguments: tuple[str, ...]


@dataclass(frozen=True)
class Misunderstood:
    """A part of a request that is no ACL; ``reason`` as the responder answers it."""

    text: str
    reason: str


def parse_request(line: str, tree: Node = TREE) -> list[Call | Misunderstood]:
    """The calls of a request line, in order; after a part that is not understood nothing more is read.

    ``;`` stays in the subsystem of the call before, ``;:`` returns to the root, the first colon is optional.
    Any line gives an answer, never an exception.
    """
    calls: list[Call | Misunderstood] = []
    subsystem: tuple[str, ...] = ()
    for part in line.split(";"):
        text = part.strip()
        if not text:
            continue
        if text.startswith("*"):
            head, _, rest = text.partition(" ")
            calls.append(
                Call((head.removesuffix("?").upper(),), head.endswith("?"), _arguments(rest.strip()))
            )
            continue
        if text.startswith(":"):
            subsystem, text = (), text[1:]
        call = _call(text, subsystem, tree)
        calls.append(call)
        if isinstance(call, Misunderstood):
            break
        subsystem = call.path[:-1]
    return calls


def _call(text: str, subsystem: tuple[str, ...], tree: Node) -> Call | Misunderstood:
    head, _, rest = text.partition(" ")
    query = head.endswith("?")
    words = head.removesuffix("?").split(":")
    node = tree
    for word in subsystem:
        node = node.parts[word]
    path = subsystem
    for word in words:
        matches = _matches(word, node)
        if len(matches) != 1:
            reason = "ambiguous command" if matches else "unknown command"
            return Misunderstood(text, reason)
        path = (*path, matches[0])
        node = node.parts[matches[0]]
    if not (node.asks if query else node.acts):
        return Misunderstood(text, "not a query" if query else "not a command")
    return Call(path, query, _arguments(rest.strip()))


def _matches(word: str, node: Node) -> list[str]:
    """Every word of ``node`` that ``word`` begins; only the whole one where it is whole."""
    word = word.lower()
    if not word:
        return []
    whole = [name for name in node.parts if name.lower() == word]
    return whole or [name for name in node.parts if name.lower().startswith(word)]


def _arguments(text: str) -> tuple[str, ...]:
    return tuple(part.strip() for part in text.split(",")) if text else ()


# what the registers say ───────────────────────────────────────────────────────────────────────────────────

INTERLOCK_STATES = ("Close", "Open", "Fault")

REGISTER_BITS: Mapping[str, Mapping[int, str]] = {
    "DYN": {
        2: "acceleration limit +",
        3: "acceleration limit -",
        4: "rate limit +",
        5: "rate limit -",
        6: "position limit",
        7: "position limit",
        8: "position profile complete",
        9: "rate profile complete",
    },
    "STATE": {4: "servoed", 6: "soft abort", 7: "hard abort"},
    "SWFLT": {
        0: "abort",
        1: "rate trip",
        2: "tracking error",
        7: "feedback loss",
        8: "feedback loss",
        9: "self-test",
    },
    "INTLK": {6: "power amplifier", 7: "interlock", 8: "interlock", 9: "master"},
}
"""Bits of the axis registers ``A<axis><name>``."""


def bit_names(register: str, value: int) -> tuple[str, ...]:
    """What the set bits of a register ("DYN", "STATE", "SWFLT", "INTLK") mean; a bit without a name is called
    by its number."""
    names = REGISTER_BITS[register]
    found = [names.get(bit, f"bit {bit}") for bit in range(32) if value >> bit & 1]
    return tuple(dict.fromkeys(found))


def register(axis: int, name: str) -> str:
    """The name of an axis register, ``A1DYN``."""
    return f"A{axis}{name}"
