"""A report's cells as they are set: true minus, raised powers, lowered indices; which columns are numbers.

What an analysis writes (``f"{value:.3g}"``) is plain text for a terminal; a screen and a PDF set it better.
"""

from __future__ import annotations

import re

from ahrs_lab.analysis.report import Table, cell_text

_MINUS = "\N{MINUS SIGN}"
_SIGN = re.compile(r"(?<![\w.)\]-])-(?=[\d.])")
_POWER = re.compile(r"(?<![\w.])(\d+\.?\d*|\.\d+)[eE]([+-]?)0*(\d+)(?!\w)|(?<=\d\))[eE]([+-]?)0*(\d+)(?!\w)")
_INDEX = re.compile(r"(?<![A-Za-z0-9_./\\-])([^\W\d_]|∇)_(\w{1,3})(?!\w|\.\w)")
_NUMBER = re.compile(r"[+\-−±≤≥<>~≈]?\s?(\d|\.\d)")
_NOTHING = ("", "–", "—", "-", "−", "∞", "nan")


def readable(text: str) -> str:
    """``-1.2e-05`` as ``−1.2×10^{−5}``, ``φ_E`` as ``φ_{E}``: ``^{…}`` is raised, ``_{…}`` lowered."""

    def power(found: re.Match[str]) -> str:
        mantissa, sign, digits = found[1] or "", found[2] or found[4], found[3] or found[5]
        return f"{mantissa}×10^{{{_MINUS if sign == '-' else ''}{digits}}}"

    return _INDEX.sub(r"\1_{\2}", _SIGN.sub(_MINUS, _POWER.sub(power, text)))


def number_columns(table: Table) -> tuple[bool, ...]:
    """Which columns hold numbers, and stand right: each of their cells is one, or empty, and at least one is.

    Columns in which somebody wrote words in any language are not.
    """
    return tuple(_is_numbers(table, place) for place in range(len(table.head)))


def _is_numbers(table: Table, place: int) -> bool:
    texts = [cell_text(row[place]).strip() for row in table.rows]
    filled = [text for text in texts if text not in _NOTHING]
    return bool(filled) and all(_NUMBER.match(text) for text in filled)
