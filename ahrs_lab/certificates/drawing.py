"""Ink on a page: measures, wraps and draws rich text; lines, boxes and curves on a reportlab canvas.

Coordinates are PDF points from the lower left; texts are placed by their baseline.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import TYPE_CHECKING, Literal

from ahrs_lab.certificates.fonts import font_name
from ahrs_lab.certificates.richtext import THIN_SPACE, RichText, Run

if TYPE_CHECKING:
    from reportlab.pdfgen.canvas import Canvas

Colour = tuple[float, float, float]
Align = Literal["left", "right", "centre"]


def colour(code: str) -> Colour:
    """``"#1F4FA8"`` as red, green, blue of 0…1."""
    return (int(code[1:3], 16) / 255, int(code[3:5], 16) / 255, int(code[5:7], 16) / 255)


INK = colour("#111827")
GREY = colour("#667085")
RULE = colour("#C9CFD8")
ACCENT = colour("#1F4FA8")
TINT = colour("#EEF3FB")
WARNING = colour("#B42318")
AXIS_COLOURS: dict[str, Colour] = {"x": colour("#D55E00"), "y": colour("#009E73"), "z": colour("#0072B2")}
"""The same three everywhere in the house (colour-blind safe)."""
AXIS_DASHES: dict[str, tuple[float, ...]] = {"x": (), "y": (4.0, 2.0), "z": (1.0, 1.8)}

_SMALL = 0.68
_RAISE = {"": 0.0, "sup": 0.34, "sub": -0.16}
_THIN = 0.9
_GREY = 0.86
"""The second language is grey and smaller, so that the first leads the eye."""
# Marks that must not begin a line, and those that must not end one (Chinese typesetting).
# A range as (10～1000) °/s is one word.
_NEVER_FIRST = "，。、；：！？）】》”’·～,.;:!?)]}%°′″"
_EQUALS = "\N{NO-BREAK SPACE}=\N{NO-BREAK SPACE}"
_NEVER_LAST = "（【《“‘～([{±"


def _is_cjk(character: str) -> bool:
    code = ord(character)
    return 0x2E80 <= code <= 0x9FFF or 0xF900 <= code <= 0xFAFF or 0xFF00 <= code <= 0xFFEF


def _pieces(run: Run) -> Sequence[Run]:
    """The run, with thin spaces apart: they are drawn as smaller ordinary spaces."""
    if THIN_SPACE not in run.text:
        return (run,)
    parts: list[Run] = []
    for index, text in enumerate(run.text.split(THIN_SPACE)):
        if index:
            parts.append(_with_text(run, THIN_SPACE))
        if text:
            parts.append(_with_text(run, text))
    return parts


def _size_of(run: Run, size: float) -> float:
    drawn = size * (_SMALL if run.shift else 1.0) * (_GREY if run.grey else 1.0)
    return drawn * _THIN if run.text == THIN_SPACE else drawn


def _drawn_text(run: Run) -> str:
    return run.text.replace(THIN_SPACE, " ").replace("\N{NO-BREAK SPACE}", " ").replace("\u202f", " ")


@lru_cache(maxsize=16384)
def text_width(rich: RichText, size: float) -> float:
    """Width of ``rich`` on one line, points."""
    from reportlab.pdfbase.pdfmetrics import stringWidth

    return sum(
        stringWidth(_drawn_text(piece), font_name(is_bold=piece.bold), _size_of(piece, size))
        for run in rich
        for piece in _pieces(run)
    )


@lru_cache(maxsize=8192)
def _atoms(rich: RichText) -> tuple[RichText, ...]:
    """What may not be broken: a word with its trailing space, or one Chinese character."""
    atoms: list[list[Run]] = []
    open_atom = False
    last = ""
    for run in rich:
        start = 0
        for index, character in enumerate(run.text):
            wide = _is_cjk(character)
            joins = (open_atom and not wide) or character in _NEVER_FIRST or last in _NEVER_LAST
            if not (last and joins):
                _add(atoms, run, start, index)
                atoms.append([])
                start = index
            open_atom, last = not (wide or character == " "), character
        _add(atoms, run, start, len(run.text))
    return tuple(tuple(atom) for atom in atoms)


def _add(atoms: list[list[Run]], run: Run, start: int, end: int) -> None:
    if end > start:
        atoms[-1].append(_with_text(run, run.text[start:end]))


def _with_text(run: Run, text: str) -> Run:
    return Run(text, run.shift, run.bold, run.grey)


def _look(run: Run) -> tuple[object, ...]:
    return (run.shift, run.bold, run.grey)


def _merged(atoms: Sequence[RichText]) -> RichText:
    runs: list[Run] = []
    for atom in atoms:
        for run in atom:
            if runs and _look(runs[-1]) == _look(run):
                runs[-1] = _with_text(run, runs[-1].text + run.text)
            else:
                runs.append(run)
    if runs:
        runs[-1] = _with_text(runs[-1], runs[-1].text.rstrip(" "))
    return tuple(run for run in runs if run.text)


def _broken(atom: RichText, size: float, width: float) -> list[RichText]:
    """A word that is wider than the line, cut into characters."""
    if text_width(atom, size) <= width:
        return [atom]
    return [(_with_text(run, character),) for run in atom for character in run.text]


def wrap(rich: RichText, size: float, width: float) -> list[RichText]:
    """Lines of at most ``width`` points; words wider than that are cut. A line feed begins a new line."""
    return list(_lines(rich, size, width))


@lru_cache(maxsize=8192)  # a table measures each cell for its columns, its heights and its drawing
def _lines(rich: RichText, size: float, width: float) -> tuple[RichText, ...]:
    paragraphs: list[list[Run]] = [[]]
    for run in rich:
        first, *others = run.text.replace(" = ", _EQUALS).split("\n")
        paragraphs[-1].append(_with_text(run, first))
        paragraphs.extend([_with_text(run, text)] for text in others)
    return tuple(line for paragraph in paragraphs for line in _wrap_one(tuple(paragraph), size, width))


def _wrap_one(rich: RichText, size: float, width: float) -> list[RichText]:
    if text_width(rich, size) <= width:
        return [_merged([rich])]
    lines: list[list[RichText]] = [[]]
    used = 0.0
    for atom in (piece for whole in _atoms(rich) for piece in _broken(whole, size, width)):
        wide = text_width(atom, size)
        if lines[-1] and used + text_width(_merged([atom]), size) > width + 0.01:
            lines.append([])
            used = 0.0
        lines[-1].append(atom)
        used += wide
    return [_merged(line) for line in lines]


def widest_word(rich: RichText, size: float) -> float:
    """Width of the widest part that is not broken, points."""
    return max((text_width(_merged([atom]), size) for atom in _atoms(rich)), default=0.0)


@dataclass
class Pen:
    """Draws on one page of ``canvas``."""

    canvas: Canvas

    def text(
        self,
        x: float,
        y: float,
        rich: RichText,
        size: float,
        *,
        ink: Colour = INK,
        align: Align = "left",
        air: float = 0.0,
    ) -> None:
        """One line with its baseline at ``y``; ``x`` is the left end, the right end or the centre.

        ``air`` is added after each character; below a tenth of the size, else readers take it for a blank.
        """
        from reportlab.pdfbase.pdfmetrics import stringWidth

        if align != "left":
            spread = air * (sum(len(run.text) for run in rich) - 1)
            x -= (text_width(rich, size) + spread) * (1.0 if align == "right" else 0.5)
        for run in rich:
            for piece in _pieces(run):
                font, drawn, shown = font_name(is_bold=piece.bold), _size_of(piece, size), _drawn_text(piece)
                self.canvas.setFillColorRGB(*(GREY if piece.grey else ink))
                self.canvas.setFont(font, drawn)
                self.canvas.drawString(x, y + _RAISE[piece.shift] * size, shown, charSpace=air)
                x += stringWidth(shown, font, drawn) + air * len(shown)

    def lines(
        self,
        x: float,
        y: float,
        lines: Sequence[RichText],
        size: float,
        leading: float,
        *,
        ink: Colour = INK,
        align: Align = "left",
    ) -> None:
        """Lines downward; ``y`` is the first baseline."""
        for index, line in enumerate(lines):
            self.text(x, y - index * leading, line, size, ink=ink, align=align)

    def rule(
        self,
        x0: float,
        y0: float,
        x1: float,
        y1: float,
        *,
        ink: Colour = RULE,
        width: float = 0.6,
        dash: Sequence[float] = (),
    ) -> None:
        """A straight line."""
        self.canvas.setStrokeColorRGB(*ink)
        self.canvas.setLineWidth(width)
        self.canvas.setDash(list(dash))
        self.canvas.line(x0, y0, x1, y1)
        self.canvas.setDash([])

    def box(
        self,
        x: float,
        y: float,
        width: float,
        height: float,
        *,
        fill: Colour | None = None,
        edge: Colour | None = None,
        radius: float = 0.0,
        line: float = 0.7,
    ) -> None:
        """A rectangle by its lower left corner, filled, edged or both."""
        if fill is not None:
            self.canvas.setFillColorRGB(*fill)
        if edge is not None:
            self.canvas.setStrokeColorRGB(*edge)
            self.canvas.setLineWidth(line)
        flags = {"stroke": int(edge is not None), "fill": int(fill is not None)}
        if radius:
            self.canvas.roundRect(x, y, width, height, radius, **flags)
        else:
            self.canvas.rect(x, y, width, height, **flags)

    def polyline(
        self,
        points: Sequence[tuple[float, float]],
        *,
        ink: Colour,
        width: float = 1.0,
        dash: Sequence[float] = (),
    ) -> None:
        """A curve through ``points``."""
        path = self.canvas.beginPath()
        for index, (x, y) in enumerate(points):
            (path.lineTo if index else path.moveTo)(x, y)
        self.canvas.setStrokeColorRGB(*ink)
        self.canvas.setLineWidth(width)
        self.canvas.setDash(list(dash))
        self.canvas.drawPath(path, stroke=1, fill=0)
        self.canvas.setDash([])

    def dot(self, x: float, y: float, radius: float, *, ink: Colour) -> None:
        """A filled circle."""
        self.canvas.setFillColorRGB(*ink)
        self.canvas.circle(x, y, radius, stroke=0, fill=1)
