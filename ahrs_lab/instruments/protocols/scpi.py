"""SCPI: lines of ASCII, what a DC supply and a room sensor are asked, and how their answers are read."""

from __future__ import annotations

import math
import re

from ahrs_lab.instruments.protocols.lines import LineDecoder

_NUMBER = re.compile(r"\s*([-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?)\s*[A-Za-z%°]*\s*")
_ERROR = re.compile(r"\s*([-+]?\d+)\s*(?:,\s*(.*))?")
_NOT_A_NUMBER = 9.9e37
"""SCPI 1999.0, 7.2.1.4 and 7.2.1.5: 9.9E37 is infinity, 9.91E37 not a number."""


def encode_line(text: str, terminator: str = "\n") -> bytes:
    """A command or query."""
    return (text + terminator).encode("ascii", errors="replace")


def answer_decoder(terminator: str = "\n") -> LineDecoder:
    """Of the answers; a CR before the terminator is left to be stripped."""
    return LineDecoder(terminator.encode("ascii"), 4096)


def parse_number(text: str) -> float | None:
    """The first number of an answer, a unit behind it is passed over; None where there is none, or the
    instrument's own not-a-number or infinity."""
    match = _NUMBER.fullmatch(text.partition(",")[0])
    if match is None:
        return None
    value = float(match[1])
    return None if not math.isfinite(value) or abs(value) >= _NOT_A_NUMBER else value


def parse_switch(text: str) -> bool | None:
    """ON, OFF, 1, 0; None for anything else."""
    return {"ON": True, "1": True, "+1": True, "OFF": False, "0": False, "+0": False}.get(
        text.strip().upper()
    )


def parse_error(text: str) -> tuple[int, str] | None:
    """Of ``SYST:ERR?``: code and text; code 0 is no error."""
    match = _ERROR.fullmatch(text)
    if match is None or len(match[1]) > 9:
        return None
    return int(match[1]), (match[2] or "").strip().strip('"')


def number_text(value: float) -> str:
    """A number as every SCPI instrument takes it."""
    return f"{value:.6f}".rstrip("0").rstrip(".") or "0"
