"""Actidyn controllers: lines ended by LF; the first comma field of an answer ends in the count of its values.

Experimental: known from one user's code only.
"""

from __future__ import annotations

import math
import re

DEFAULT_PORT = 62000
_COUNT = re.compile(r"(\d+)\s*$")


def encode_command(word: str, *arguments: str) -> bytes:
    """``RAT 1,10,50`` LF."""
    return f"{word} {','.join(arguments)}\n".encode("ascii", errors="replace")


def parse_values(line: str) -> tuple[float, ...] | None:
    """The values of an answer; None where it is none, or not of as many finite numbers as it says."""
    head, *fields = (part.strip() for part in line.split(","))
    count = _COUNT.search(head)
    # More digits than that are no count; the number may directly follow a name that ends in a letter.
    if count is None or len(count[1]) > 3 or int(count[1]) != len(fields):
        return None
    try:
        values = tuple(float(field) for field in fields)
    except ValueError:
        return None
    return values if all(math.isfinite(value) for value in values) else None


def encode_values(name: str, *values: float) -> bytes:
    """The table's side."""
    return (f"{name} {len(values)}," + ",".join(f"{value:.6f}" for value in values) + "\n").encode("ascii")
