"""Tables whose columns are measured from what stands in them, never guessed."""

from __future__ import annotations

from dataclasses import replace
from typing import NamedTuple

from ahrs_lab.certificates.boxes import Box, one_line
from ahrs_lab.certificates.documents import Column, Label, Table
from ahrs_lab.certificates.drawing import GREY, RULE, Pen, text_width, widest_word, wrap
from ahrs_lab.certificates.richtext import RichText, bold, grey, joined

_GAP = 9.0
_SMALLEST = 6.0
_MOST_AIR = 30.0
_KEPT_WHOLE = 270.0
"""Lower tables are not cut, points; nor one that asks for it up to most of a page."""
_MOST_OF_A_PAGE = 560.0
_FEWEST_ROWS = 3
"""On either side of a cut, unless a row is as high as a good part of a page."""
_MUCH_ROOM = 400.0
_LONGEST_WORD = 84.0
"""Longer words are cut rather than that they squeeze the other columns, points."""


class _Measured(NamedTuple):
    size: float
    widths: tuple[float, ...]


def _header_lines(column: Column, size: float, width: float) -> list[RichText]:
    unit = joined("  ", column.unit) if column.unit else ()
    lines = wrap(joined(column.label.main, unit), size, width)
    if column.label.second:
        lines += wrap(grey(column.label.second), size, width)
    return lines


def column_widths(table: Table, width: float) -> _Measured:
    """Type size and the width of each column so that every cell fits into ``width`` points together.

    What fits is set on one line; else the columns with slack give way down to their widest word, then the
    type gets smaller, and at last words are cut.
    """
    size = table.size
    while True:
        natural = [_natural(table, index, size) for index in range(len(table.columns))]
        least = [min(_least(table, index, size), wide) for index, wide in enumerate(natural)]
        room = width - _GAP * (len(natural) - 1)
        if sum(natural) <= room:
            return _Measured(size, _spread(table, natural, room - sum(natural)))
        if sum(least) <= room:
            share = (room - sum(least)) / (sum(natural) - sum(least))
            return _Measured(size, tuple(a + share * (b - a) for a, b in zip(least, natural, strict=True)))
        if size <= _SMALLEST:
            return _Measured(size, tuple(room * a / sum(least) for a in least))
        size -= 0.5


def _spread(table: Table, natural: list[float], spare: float) -> tuple[float, ...]:
    """Spare width evenly over the columns; columns of numbers take no more than keeps a row together."""
    share = spare / len(natural)
    most = [_MOST_AIR if column.align == "right" else share for column in table.columns]
    widths = [wide + min(share, air) for wide, air in zip(natural, most, strict=True)]
    widths[0] += spare + sum(natural) - sum(widths)
    return tuple(widths)


def _natural(table: Table, index: int, size: float) -> float:
    column = table.columns[index]
    head = size - 0.5
    unit = joined("  ", column.unit) if column.unit else ()
    widths = [text_width(joined(column.label.main, unit), head), text_width(grey(column.label.second), head)]
    first_summary = len(table.rows) - table.summary_rows
    for number, row in enumerate(table.rows):
        cell = _cell(column, row[index])
        widths.append(text_width(bold(cell) if number >= first_summary else cell, size))
    return max(widths) + 0.5


def _least(table: Table, index: int, size: float) -> float:
    column = table.columns[index]
    texts = [column.unit, grey(column.label.second)]
    texts += [bold(_cell(column, row[index])) for row in table.rows]
    # Numbers are never cut.
    longest = _LONGEST_WORD if column.align == "left" else float("inf")
    heading = min(text_width(column.label.main, size - 0.5), longest)
    return max(heading, *(min(widest_word(text, size), longest) for text in texts)) + 0.5


def _cell(column: Column, cell: Label) -> RichText:
    text = one_line(cell)
    return bold(text) if column.strong else text


class TableBox:
    """A table between thin lines; cut between rows, with its heading on each page."""

    space_before = 5.0
    _pad = 4.0

    def __init__(self, table: Table, measured: _Measured | None = None) -> None:
        self._table = table
        self._measured = measured
        self._wrapped: tuple[float, list[list[list[RichText]]]] | None = None
        self._heading: tuple[float, list[list[RichText]]] | None = None
        self.keep_with_next = table.kept

    def _layout(self, width: float) -> _Measured:
        if self._measured is None:
            self._measured = column_widths(self._table, width)
        return self._measured

    def _header(self, width: float) -> list[list[RichText]]:
        if self._heading is None or self._heading[0] != width:
            size, widths = self._layout(width)
            lines = [
                _header_lines(c, size - 0.5, w) for c, w in zip(self._table.columns, widths, strict=True)
            ]
            self._heading = (width, lines)
        return self._heading[1]

    def _rows(self, width: float) -> list[list[list[RichText]]]:
        if self._wrapped is None or self._wrapped[0] != width:
            size, widths = self._layout(width)
            rows = [
                [
                    wrap(bold(_cell(c, cell)) if self._is_summary(index) else _cell(c, cell), size, w)
                    for c, cell, w in zip(self._table.columns, row, widths, strict=True)
                ]
                for index, row in enumerate(self._table.rows)
            ]
            self._wrapped = (width, rows)
        return self._wrapped[1]

    def _is_summary(self, index: int) -> bool:
        return index >= len(self._table.rows) - self._table.summary_rows

    def _line(self, width: float) -> float:
        return self._layout(width).size * 1.5

    def _header_height(self, width: float) -> float:
        return max(len(lines) for lines in self._header(width)) * self._line(width) * 0.9 + 2 * self._pad

    def _row_heights(self, width: float) -> list[float]:
        line = self._line(width)
        return [max(len(lines) for lines in row) * line + 2.4 for row in self._rows(width)]

    def height(self, width: float) -> float:
        return self._header_height(width) + sum(self._row_heights(width)) + 2 * self._pad

    def draw(self, pen: Pen, x: float, top: float, width: float) -> None:
        size, widths = self._layout(width)
        line = self._line(width)
        y = top - self._pad - (size - 0.5)
        lefts = [x + sum(widths[:i]) + i * _GAP for i in range(len(widths))]
        for column, left, wide, lines in zip(
            self._table.columns, lefts, widths, self._header(width), strict=True
        ):
            self._place(pen, column, left, wide, y, lines, (size - 0.5, line * 0.9), heading=True)
        y = top - self._header_height(width)
        pen.rule(x, y, x + width, y, ink=RULE)
        y -= self._pad
        for index, (row, height) in enumerate(zip(self._rows(width), self._row_heights(width), strict=True)):
            if self._table.summary_rows and index == len(self._table.rows) - self._table.summary_rows:
                pen.rule(x, y + 0.8, x + width, y + 0.8, ink=RULE, width=0.4)
            for column, left, wide, lines in zip(self._table.columns, lefts, widths, row, strict=True):
                self._place(pen, column, left, wide, y - size - 1.0, lines, (size, line))
            y -= height
        y -= self._pad
        pen.rule(x, y, x + width, y, ink=RULE)

    @staticmethod
    def _place(
        pen: Pen,
        column: Column,
        left: float,
        width: float,
        y: float,
        lines: list[RichText],
        type_: tuple[float, float],
        *,
        heading: bool = False,
    ) -> None:
        size, leading = type_
        right = column.align == "right"
        start = left + width if right else left
        more = {"ink": GREY} if heading else {}
        pen.lines(start, y, lines, size, leading, align="right" if right else "left", **more)

    def cut(self, width: float, room: float) -> tuple[Box, Box] | None:
        if self.height(width) <= (_MOST_OF_A_PAGE if self._table.whole else _KEPT_WHOLE):
            return None
        count = len(self._table.rows)
        used = self._header_height(width) + 2 * self._pad
        for index, height in enumerate(self._row_heights(width)):
            used += height
            if used > room:
                end = min(index, count - _FEWEST_ROWS)
                if end < _FEWEST_ROWS:
                    if index == 0 or room < _MUCH_ROOM:
                        return None
                    end = index
                measured = self._layout(width)
                first = replace(self._table, rows=self._table.rows[:end], summary_rows=0, kept=False)
                rest = replace(self._table, rows=self._table.rows[end:])
                return TableBox(first, measured), TableBox(rest, measured)
        return None
