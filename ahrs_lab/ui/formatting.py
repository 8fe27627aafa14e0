"""Numbers as a person reads them: as many digits as are meant, thin space for thousands, true minus."""

from __future__ import annotations

import math
from datetime import timedelta

THIN_SPACE = "\u2009"
NO_BREAK_SPACE = "\u00a0"
WORD_JOINER = "\u2060"
MINUS = "\u2212"
_SECONDS_ALONE = 100
DASH = "–"
"""Stands where there is no value yet."""


def number(value: float | None, decimals: int, *, plus: bool = False) -> str:
    """``12 345.60``, ``−0.5``; ``plus`` writes the sign of positive values too. A value that rounds to zero
    has no sign; None and not-a-number are a dash."""
    if value is None or not math.isfinite(value):
        return DASH
    text = f"{abs(value):,.{decimals}f}".replace(",", THIN_SPACE)
    if float(f"{value:.{decimals}f}") == 0.0:
        return text
    if value < 0:
        return MINUS + text
    return "+" + text if plus else text


def count(value: int) -> str:
    """``41 200``."""
    return number(float(value), 0)


def signed_rate(value_dps: float) -> str:
    """A demanded rate without digits that are not meant: ``−100``, ``0.5``."""
    text = f"{abs(value_dps):.6f}".rstrip("0").rstrip(".")
    return (MINUS if value_dps < 0 else "") + text


def duration(seconds: float | None, *, short: bool = False) -> str:
    """``24 s``, ``52 min 10 s``, ``1 h 05 min``; rounded up, so that nothing stands at zero before it is
    over. ``short``: seconds alone below 100 s, whole minutes from there on."""
    if seconds is None or not math.isfinite(seconds):
        return DASH
    whole = max(0, math.ceil(seconds - 1e-6))
    if whole >= 3600:
        hours, minutes = divmod(math.ceil(whole / 60), 60)
        parts = [f"{hours} h", *([f"{minutes:02d} min"] if minutes else [])]
    else:
        minutes, left = divmod(whole, 60)
        if short:
            minutes, left = (0, whole) if whole < _SECONDS_ALONE else (math.ceil(whole / 60), 0)
        parts = [f"{minutes} min"] if minutes else []
        parts += [f"{left:02d} s" if minutes else f"{left} s"] if left or not minutes else []
    return " ".join(parts).replace(" ", NO_BREAK_SPACE)


def unbroken(text: str) -> str:
    """For a text that wraps: no line ends within °/s, nor between it and its number."""
    return text.replace(" °/", f"{NO_BREAK_SPACE}°/").replace("°/s", f"°{WORD_JOINER}/{WORD_JOINER}s")


def wall_time_left(bench_seconds: float, speed: float | None) -> timedelta | None:
    """How long that takes by the clock on the wall; None where the bench runs as fast as it goes."""
    return None if speed is None or speed <= 0 else timedelta(seconds=bench_seconds / speed)
