"""Text with raised and lowered parts, weight and tone: what a certificate prints.

The shipped fonts lack most Unicode superscripts, so exponents and indices are ordinary characters that are
drawn smaller and shifted. Texts that come from elsewhere and use Unicode superscripts are converted.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Literal

Shift = Literal["", "sub", "sup"]
THIN_SPACE = "\N{THIN SPACE}"
MINUS = "\N{MINUS SIGN}"

_RAISED = dict(zip("⁰¹²³⁴⁵⁶⁷⁸⁹⁺⁻⁽⁾ⁿ", "0123456789+−()n", strict=True))
_LOWERED = dict(zip("₀₁₂₃₄₅₆₇₈₉₊₋₍₎ₓ", "0123456789+−()x", strict=True))


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
    runs: list[Run] = []
    for character in text:
        shift: Shift = "sup" if character in _RAISED else "sub" if character in _LOWERED else ""
        drawn = _RAISED.get(character) or _LOWERED.get(character) or character
        if runs and runs[-1].shift == shift:
            runs[-1] = replace(runs[-1], text=runs[-1].text + drawn)
        else:
            runs.append(Run(drawn, shift, bold, grey))
    return tuple(runs)


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
