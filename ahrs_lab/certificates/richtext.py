"""Text with raised and lowered parts, weight and tone: what a certificate prints.

The shipped fonts lack most Unicode superscripts, so exponents and indices are ordinary characters that are
drawn smaller and shifted. Texts that come from elsewhere and use Unicode superscripts are converted.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass, replace
from itertools import groupby
from typing import Literal

Shift = Literal["", "sub", "sup"]
THIN_SPACE = "\N{THIN SPACE}"
MINUS = "\N{MINUS SIGN}"

_RAISED = dict(zip("⁰¹²³⁴⁵⁶⁷⁸⁹⁺⁻⁽⁾ⁿᵀ", "0123456789+−()nT", strict=True))
_LOWERED = dict(zip("₀₁₂₃₄₅₆₇₈₉₊₋₍₎ₓ", "0123456789+−()x", strict=True))
_DRAWN = _RAISED | _LOWERED
_SHIFTED = re.compile("[" + "".join(_DRAWN) + "]")


@dataclass(frozen=True, slots=True)
class Run:
    """Characters of one appearance."""

    text: str
    shift: Shift = ""
    bold: bool = False
    grey: bool = False


RichText = tuple[Run, ...]


def plain(text: str, *, bold: bool = False, grey: bool = False) -> RichText:
    """``text`` as it stands; Unicode super- and subscripts become raised and lowered runs."""
    if not _SHIFTED.search(text):
        return (Run(text, "", bold, grey),) if text else ()
    return tuple(
        Run("".join(_DRAWN.get(character, character) for character in part), shift, bold, grey)
        for shift, characters in groupby(text, _shift)
        for part in ("".join(characters),)
    )


def _shift(character: str) -> Shift:
    return "sup" if character in _RAISED else "sub" if character in _LOWERED else ""


def markup(text: str) -> RichText:
    """Our own wording, and figures of accuracy, where ``_{yx}`` lowers and ``^{−4}`` raises."""
    return tuple(_marked(text))


def _marked(text: str) -> Iterator[Run]:
    rest = text
    while rest:
        starts = [i for i in (rest.find("_{"), rest.find("^{")) if i >= 0]
        if not starts:
            yield from plain(rest)
            return
        start = min(starts)
        end = rest.find("}", start)
        if end < 0:
            yield from plain(rest)
            return
        yield from plain(rest[:start])
        yield Run(rest[start + 2 : end], "sub" if rest[start] == "_" else "sup")
        rest = rest[end + 1 :]


def symbol(letter: str, index: str) -> RichText:
    """A quantity's letter with its index, as ``L`` with ``yx`` lowered."""
    return (Run(letter), Run(index, "sub"))


def joined(*parts: RichText | str) -> RichText:
    """One text of several; strings are taken as they stand."""
    runs: list[Run] = []
    for part in parts:
        runs.extend(plain(part) if isinstance(part, str) else part)
    return tuple(runs)


def bold(text: RichText) -> RichText:
    """The same in bold."""
    return tuple(replace(run, bold=True) for run in text)


def grey(text: RichText) -> RichText:
    """The same in grey."""
    return tuple(replace(run, grey=True) for run in text)


def text_of(rich: RichText) -> str:
    """The characters alone."""
    return "".join(run.text for run in rich)


def number_of(text: str) -> float:
    """The inverse of :func:`~ahrs_lab.metrology.rounding.format_grouped`, for those who trace a printed
    number to its result."""
    return float(text.replace(THIN_SPACE, "").replace(" ", "").replace(MINUS, "-"))
