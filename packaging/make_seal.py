"""Draws the seal of the demonstration laboratory into resources/seal. Not run at installation.

A laboratory uses its own seal; this one says on its face that it is for demonstration, so that no certificate
of the simulated bench is taken for a real one. Characters are drawn as outlines of the font in
resources/fonts, so that the seal looks the same everywhere::

    pip install -e .[assets]
    python packaging/make_seal.py
"""

from __future__ import annotations

import math
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

RESOURCES = Path(__file__).resolve().parents[1] / "resources"
FONT = RESOURCES / "fonts" / "NotoSansSC-Bold.ttf"
SEAL = RESOURCES / "seal" / "demo-seal.svg"

SIZE = 600
CENTRE = SIZE / 2
RED = "#C8102E"
PNG_SIZE = 600


class Lettering:
    """Outlines of characters, placed by their centre."""

    def __init__(self, font_file: Path) -> None:
        from fontTools.ttLib import TTFont

        self._font: Any = TTFont(font_file)
        self._names: dict[int, str] = self._font.getBestCmap()
        self._glyphs: Any = self._font.getGlyphSet()
        self._em: int = self._font["head"].unitsPerEm

    def advance(self, text: str, size: float) -> float:
        """Width of the text set at this size."""
        return float(sum(self._glyphs[self._names[ord(c)]].width for c in text)) * size / self._em

    def character(self, character: str, x: float, y: float, size: float, turn_deg: float = 0.0) -> str:
        """One character with the middle of its cell at (x, y)."""
        from fontTools.pens.svgPathPen import SVGPathPen

        glyph = self._glyphs[self._names[ord(character)]]
        pen = SVGPathPen(self._glyphs)
        glyph.draw(pen)
        scale = size / self._em
        # Capitals and Chinese characters both sit around 0.36 em above the base line.
        middle = 0.36 * self._em
        placed = f"translate({x:.2f} {y:.2f}) rotate({turn_deg:.2f}) scale({scale:.5f} {-scale:.5f})"
        centred = f"translate({-glyph.width / 2:.1f} {-middle:.1f})"
        return f'<path transform="{placed} {centred}" d="{pen.getCommands()}"/>'

    def line(self, text: str, y: float, size: float, spacing: float = 0.0) -> Iterator[str]:
        """A line of text centred in the seal."""
        x = CENTRE - (self.advance(text, size) + spacing * (len(text) - 1)) / 2
        for character in text:
            width = self.advance(character, size)
            if not character.isspace():
                yield self.character(character, x + width / 2, y, size)
            x += width + spacing

    def arc(self, text: str, radius: float, size: float, span_deg: float) -> Iterator[str]:
        """Text around the upper half of the seal, each character upright to the centre."""
        for index, character in enumerate(text):
            turn = -span_deg / 2 + span_deg * index / (len(text) - 1)
            x = CENTRE + radius * math.sin(math.radians(turn))
            y = CENTRE - radius * math.cos(math.radians(turn))
            yield self.character(character, x, y, size, turn)


def star(x: float, y: float, radius: float) -> str:
    """The five-pointed star of a Chinese seal."""
    corners = []
    for index in range(10):
        reach = radius if index % 2 == 0 else radius * 0.382
        angle = math.radians(36 * index)
        corners.append(f"{x + reach * math.sin(angle):.2f},{y - reach * math.cos(angle):.2f}")
    return f'<polygon points="{" ".join(corners)}"/>'


def seal(lettering: Lettering) -> str:
    """The seal as SVG, transparent where it is not red."""
    rings = (
        f'<circle cx="{CENTRE}" cy="{CENTRE}" r="286" fill="none" stroke="{RED}" stroke-width="16"/>'
        f'<circle cx="{CENTRE}" cy="{CENTRE}" r="267" fill="none" stroke="{RED}" stroke-width="4"/>'
    )
    drawn = [
        *lettering.arc("演示校准实验室", 212, 72, 200),
        star(CENTRE, 270, 66),
        *lettering.line("校准专用章", 414, 54, 4),
        *lettering.line("演示 DEMO", 488, 40, 3),
    ]
    title = "<title>演示校准实验室 校准专用章 · 演示 DEMO</title>"
    head = (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {SIZE} {SIZE}" width="{SIZE}" height="{SIZE}">'
    )
    return f'{head}\n{title}\n{rings}\n<g fill="{RED}">\n' + "\n".join(drawn) + "\n</g>\n</svg>\n"


def render(source: Path, target: Path, size: int) -> None:
    """Draw an SVG as a PNG with a transparent ground."""
    from PySide6.QtCore import Qt
    from PySide6.QtGui import QImage, QPainter
    from PySide6.QtSvg import QSvgRenderer

    image = QImage(size, size, QImage.Format.Format_ARGB32)
    image.fill(Qt.GlobalColor.transparent)
    painter = QPainter(image)
    QSvgRenderer(str(source)).render(painter)
    painter.end()
    if not image.save(str(target)):
        sys.exit(f"{target} cannot be written")


def main() -> None:
    """Write the seal as SVG and PNG."""
    SEAL.parent.mkdir(parents=True, exist_ok=True)
    SEAL.write_text(seal(Lettering(FONT)), encoding="utf-8")
    render(SEAL, SEAL.with_suffix(".png"), PNG_SIZE)


if __name__ == "__main__":
    main()
