"""What an instrument of a served virtual bench says when it is asked who it is: that it is simulated, and how
fast its time runs."""

from __future__ import annotations

import re

_SAID = re.compile(r"\(simulated(?: (\d+(?:\.\d+)?)x)?\)")


def simulated_name(name: str, speed: float = 1.0) -> str:
    """``name`` with the mark; ``speed`` is bench seconds per wall second."""
    if speed == 1.0:
        return f"{name} (simulated)"
    factor = f"{speed:.6f}".rstrip("0").rstrip(".")
    return f"{name} (simulated {factor}x)"


def said_speed(identity: str) -> float | None:
    """The speed that an identity says; None where it does not say that it is simulated."""
    said = _SAID.search(identity)
    return None if said is None else float(said[1] or 1.0)
