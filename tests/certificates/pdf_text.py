"""Reads text and its boxes back out of a PDF, by the PDF's own tables and nothing of ours."""

from __future__ import annotations

import re
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

import pikepdf

Matrix = tuple[float, float, float, float, float, float]


@dataclass(frozen=True)
class Span:
    """One shown string: page from 0, baseline start, size and width in points."""

    page: int
    x: float
    y: float
    size: float
    width: float
    text: str

    def overlaps(self, other: Span) -> bool:
        """Whether ink of both shares more than a hair; heights from the middle of the x-height zone."""
        across = min(self.x + self.width, other.x + other.width) - max(self.x, other.x)
        top, bottom = self.y + 0.68 * self.size, self.y
        other_top, other_bottom = other.y + 0.68 * other.size, other.y
        return across > 0.6 and min(top, other_top) - max(bottom, other_bottom) > 0.6


class _Font:
    def __init__(self, font: Any) -> None:
        cmap = font.ToUnicode.read_bytes().decode("latin-1")
        self.characters: dict[int, str] = {}
        for first, _, listed in re.findall(r"<(\w+)>\s*<(\w+)>\s*\[([^\]]*)\]", cmap):
            for offset, code in enumerate(re.findall(r"<(\w+)>", listed)):
                self.characters[int(first, 16) + offset] = bytes.fromhex(code).decode("utf-16-be")
        for block in re.findall(r"beginbfchar(.*?)endbfchar", cmap, re.S):
            for code, target in re.findall(r"<(\w+)>\s*<(\w+)>", block):
                self.characters[int(code, 16)] = bytes.fromhex(target).decode("utf-16-be")
        first = int(font.FirstChar)
        self.widths = {first + i: float(width) for i, width in enumerate(font.Widths)}

    def text(self, data: bytes) -> str:
        return "".join(self.characters[code] for code in data)

    def width(self, data: bytes) -> float:
        return sum(self.widths[code] for code in data) / 1000


def spans(path: Path) -> list[Span]:
    """Every upright string of the document."""
    return list(_spans(path, path.stat().st_mtime_ns))


@cache
def _spans(path: Path, _changed: int) -> tuple[Span, ...]:
    found: list[Span] = []
    with pikepdf.open(path) as pdf:
        for number, page in enumerate(pdf.pages):
            fonts = {str(name): _Font(font) for name, font in page.Resources.Font.items()}
            found += _page(number, pikepdf.parse_content_stream(page), fonts)
    return tuple(found)


def _page(number: int, instructions: Any, fonts: dict[str, _Font]) -> list[Span]:
    found: list[Span] = []
    stack: list[bool] = []
    upright = True
    font, size, x, y, space = "", 0.0, 0.0, 0.0, 0.0
    for operands, operator in instructions:
        match str(operator):
            case "q":
                stack.append(upright)
            case "Q":
                upright = stack.pop()
            case "cm":
                upright = upright and abs(float(operands[1])) < 1e-6
            case "Tf":
                font, size = str(operands[0]), float(operands[1])
            case "Tm":
                x, y = float(operands[4]), float(operands[5])
            case "Td":
                x, y = x + float(operands[0]), y + float(operands[1])
            case "Tc":
                space = float(operands[0])
            case "Tj":
                data = bytes(operands[0])
                width = fonts[font].width(data) * size + space * len(fonts[font].text(data))
                if upright:
                    found.append(Span(number, x, y, size, width, fonts[font].text(data)))
                x += width
    return found


def lines(path: Path, page: int | None = None) -> list[str]:
    """Lines of text as a reader sees them: spans of one baseline (with its sub- and superscripts) in
    order."""
    rows: dict[tuple[int, int], list[Span]] = {}
    for span in spans(path):
        if page is not None and span.page != page:
            continue
        for key, row in rows.items():
            if key[0] == span.page and abs(row[0].y - span.y) < 0.36 * max(row[0].size, span.size):
                row.append(span)
                break
        else:
            rows[(span.page, len(rows))] = [span]
    return [_joined(sorted(row, key=lambda one: one.x)) for row in rows.values()]


def _joined(row: list[Span]) -> str:
    text, end = "", row[0].x
    for span in row:
        if span.x - end > 0.2 * span.size and not text.endswith(" "):
            text += " "
        text += span.text
        end = span.x + span.width
    return text


def whole_text(path: Path) -> str:
    """All of it, blanks made single."""
    return re.sub(r"\s+", " ", "\n".join(lines(path)))
