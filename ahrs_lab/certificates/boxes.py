"""Blocks of a document with their measured height: headings, running text, fields.

A box knows how high it is for a given width, draws itself below a given line, and can be cut where a page
ends.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Protocol

from ahrs_lab.certificates.documents import Fields, Heading, Label, Paragraph
from ahrs_lab.certificates.drawing import ACCENT, GREY, INK, RULE, Pen, text_width, wrap
from ahrs_lab.certificates.richtext import RichText, Run, bold, grey, joined

GAP = 10.0


class Box(Protocol):
    """Something of measured height."""

    space_before: float
    keep_with_next: bool

    def height(self, width: float) -> float:
        """Points needed at this width."""

    def draw(self, pen: Pen, x: float, top: float, width: float) -> None:
        """Ink from ``top`` downward."""

    def cut(self, width: float, room: float) -> tuple[Box, Box] | None:
        """The part that fits into ``room`` and the rest; None where it cannot be cut there."""


def one_line(label: Label) -> RichText:
    """Both languages one after the other."""
    if not label.second:
        return label.main
    return joined(label.main, "  ", grey(label.second)) if label.main else grey(label.second)


class HeadingBox:
    """Level 1: in the accent colour above a line; level 2: bold, above one table or picture."""

    keep_with_next = True

    def __init__(self, heading: Heading) -> None:
        self._level = heading.level
        number = (Run(heading.number + "  "),) if heading.number else ()
        self._text = joined(bold(joined(number, heading.label.main)), "   ", grey(heading.label.second))
        self._size = 11.5 if heading.level == 1 else 9.0
        self.space_before = 14.0 if heading.level == 1 else 10.0

    def height(self, width: float) -> float:
        lines = len(wrap(self._text, self._size, width))
        return lines * self._size * 1.35 + (5.0 if self._level == 1 else 2.0)

    def draw(self, pen: Pen, x: float, top: float, width: float) -> None:
        lines = wrap(self._text, self._size, width)
        ink = ACCENT if self._level == 1 else INK
        pen.lines(x, top - self._size, lines, self._size, self._size * 1.35, ink=ink)
        if self._level == 1:
            bottom = top - self.height(width)
            pen.rule(x, bottom, x + width, bottom, ink=ACCENT, width=0.9)

    def cut(self, width: float, room: float) -> None:  # noqa: ARG002 - a heading is not cut
        return None


class TextBox:
    """Running text; both languages as paragraphs of their own, the second grey."""

    space_before = 3.0

    def __init__(
        self, paragraphs: Sequence[RichText], size: float, mark: str = "", *, kept: bool = False
    ) -> None:
        self.keep_with_next = kept
        self._paragraphs = tuple(paragraphs)
        self._size = size
        self._mark = mark
        self._leading = size * 1.5

    @classmethod
    def of(cls, paragraph: Paragraph) -> TextBox:
        """The box of a paragraph."""
        text = paragraph.text
        if paragraph.together:
            return cls([one_line(text)], paragraph.size, paragraph.mark, kept=paragraph.kept)
        parts = [text.main] + ([grey(text.second)] if text.second else [])
        return cls(parts, paragraph.size, paragraph.mark, kept=paragraph.kept)

    def _indent(self) -> float:
        return self._size * 1.1 if self._mark else 0.0

    def _lines(self, width: float) -> list[RichText]:
        return [
            line
            for paragraph in self._paragraphs
            for line in wrap(paragraph, self._size, width - self._indent())
        ]

    def height(self, width: float) -> float:
        return len(self._lines(width)) * self._leading + 1.0

    def draw(self, pen: Pen, x: float, top: float, width: float) -> None:
        if self._mark.strip():
            pen.text(x, top - self._size, (Run(self._mark, "sup"),), self._size, ink=GREY)
        pen.lines(x + self._indent(), top - self._size, self._lines(width), self._size, self._leading)

    def cut(self, width: float, room: float) -> tuple[Box, Box] | None:
        lines = self._lines(width)
        fitting = int((room - 1.0) / self._leading)
        # What is kept together with its like is short, and goes over whole.
        if fitting < 2 or fitting >= len(lines) or self.keep_with_next:
            return None
        rest = " " if self._mark else ""
        return TextBox(lines[:fitting], self._size, self._mark), TextBox(lines[fitting:], self._size, rest)


class FieldsBox:
    """Lines of label and value below a thin line; the label columns are measured, the values wrap."""

    keep_with_next = False
    space_before = 8.0
    _size = 9.5
    _leading = 16.0
    _pad = 8.0

    def __init__(self, fields: Fields, labels: tuple[float, float] | None = None) -> None:
        self._fields = fields
        self._labels = labels or self.label_widths((fields,))

    @classmethod
    def label_widths(cls, groups: Sequence[Fields]) -> tuple[float, float]:
        """Widths of the two label columns that all ``groups`` share."""
        labels = [field.label for group in groups for field in group.fields]
        main = max((text_width(bold(one.main), cls._size) for one in labels), default=0.0)
        second = max((text_width(grey(one.second), cls._size) for one in labels), default=0.0)
        return main + GAP, second + GAP if second else 0.0

    def _rows(self, width: float) -> list[tuple[Label, list[RichText]]]:
        room = width - sum(self._labels)
        rows = []
        for field in self._fields.fields:
            value = one_line(field.value)
            lines = wrap(value, self._size, room)
            if len(lines) > 1 and field.value.main and field.value.second:
                lines = wrap(field.value.main, self._size, room) + wrap(
                    grey(field.value.second), self._size, room
                )
            rows.append((field.label, lines))
        return rows

    def height(self, width: float) -> float:
        return self._pad + sum(len(lines) for _, lines in self._rows(width)) * self._leading

    def draw(self, pen: Pen, x: float, top: float, width: float) -> None:
        if self._fields.ruled:
            pen.rule(x, top, x + width, top, ink=RULE)
        main, second = self._labels
        y = top - self._pad - self._size
        for label, lines in self._rows(width):
            pen.text(x, y, bold(label.main), self._size)
            pen.text(x + main, y, grey(label.second), self._size)
            pen.lines(x + main + second, y, lines, self._size, self._leading)
            y -= len(lines) * self._leading

    def cut(self, width: float, room: float) -> tuple[Box, Box] | None:
        used = self._pad
        for index, (_, lines) in enumerate(self._rows(width)):
            used += len(lines) * self._leading
            if used > room:
                if index == 0:
                    return None
                first, rest = self._fields.fields[:index], self._fields.fields[index:]
                return FieldsBox(replace(self._fields, fields=first), self._labels), FieldsBox(
                    replace(self._fields, fields=rest), self._labels
                )
        return None
