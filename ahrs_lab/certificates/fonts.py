"""The two embedded fonts of every document, and whether they can show a text.

A character without a glyph would print as a box, on a certificate that somebody then signs. So every text is
checked before the page is drawn.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING
from unicodedata import normalize

from ahrs_lab.certificates.richtext import RichText
from ahrs_lab.errors import InputError, MachineError
from ahrs_lab.resource_files import resource_path

if TYPE_CHECKING:
    from reportlab.pdfbase.ttfonts import TTFont

REGULAR = "NotoSansSC"
BOLD = "NotoSansSC-Bold"
_FILES = {REGULAR: "fonts/NotoSansSC-Regular.ttf", BOLD: "fonts/NotoSansSC-Bold.ttf"}

_NEAREST = {"\u0302": "^", "\u0303": "~", "\u0304": "¯", "\u0305": "¯", "∘": "○"}
"""Of marks above a letter and of signs that the fonts lack."""

# Drawn as an ordinary space of other width.
_SPACES = " \N{NO-BREAK SPACE}\N{THIN SPACE}\N{NARROW NO-BREAK SPACE}"


def font_file(name: str) -> Path:
    """The file of one of the two fonts."""
    return resource_path(_FILES[name])


@cache
def _font(name: str) -> TTFont:
    from reportlab.pdfbase import pdfmetrics
    from reportlab.pdfbase.ttfonts import TTFError, TTFont

    path = font_file(name)
    try:
        font = TTFont(name, str(path))
    except (OSError, TTFError) as error:
        raise MachineError(
            "The font {path} cannot be read ({reason}): install the application again",
            path=path,
            reason=error,
        ) from error
    pdfmetrics.registerFont(font)
    return font


def register_fonts() -> None:
    """Make both fonts known to reportlab; cheap when called again."""
    _font(REGULAR)
    _font(BOLD)


@cache
def _characters(name: str) -> frozenset[int]:
    return frozenset(_font(name).face.charToGlyph)


def font_name(*, is_bold: bool) -> str:
    """The name under which reportlab knows the font."""
    return BOLD if is_bold else REGULAR


def check_glyphs(texts: Iterable[tuple[str, RichText]]) -> None:
    """Refuse texts that the fonts cannot show. ``texts``: (where it stands, text) pairs.

    Raises:
        InputError: names the first missing character and where it stands.
    """
    for where, rich in texts:
        for run in rich:
            known = _characters(font_name(is_bold=run.bold))
            for character in run.text:
                if ord(character) not in known and character not in _SPACES:
                    raise InputError(
                        "The character {character} (U+{code}) in “{where}” cannot be printed: the "
                        "certificate's font has no glyph for it; write it differently",
                        character=character if character.isprintable() else "?",
                        code=f"{ord(character):04X}",
                        where=where,
                    )


def printable(rich: RichText) -> RichText:
    """``rich`` with the nearest that the fonts can show, a hat behind its letter, at last “?”: for texts that
    nobody signs."""
    known = _characters(font_name(is_bold=False))

    def shown(character: str) -> str:
        if character in _SPACES or ord(character) in known:
            return character
        near = _NEAREST.get(character) or "".join(
            _NEAREST.get(part, part) for part in normalize("NFKD", character)
        )
        return near if all(ord(part) in known for part in near) else "?"

    return tuple(replace(run, text="".join(map(shown, run.text))) for run in rich)
