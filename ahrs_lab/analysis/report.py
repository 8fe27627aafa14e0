"""What an analysis shows: tables, charts and sentences, without saying where they are drawn.

A terminal prints :func:`report_text`; the Analysis page and the PDF draw the same tables and charts.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from ahrs_lab.messages import Message

Array = NDArray[np.float64]
Cell = Message | str
"""A word of a person's language, or what is the same in each: a number, a unit, a symbol."""


@dataclass(frozen=True)
class Curve:
    """One line of a chart: ``x`` and ``y`` of shape (n,), and where known the band ``low`` … ``high``.

    ``axis`` x, y, z takes the axis' colour and dash everywhere the same; "" the next of the chart's own.
    """

    label: Cell
    x: Array
    y: Array
    low: Array | None = None
    high: Array | None = None
    axis: Literal["x", "y", "z", ""] = ""
    style: Literal["line", "dashed", "points"] = "line"


@dataclass(frozen=True)
class Mark:
    """A vertical line at ``x`` with its name: a period, an instant."""

    x: float
    label: Cell


@dataclass(frozen=True)
class Chart:
    """Curves on one pair of axes; the axes' labels carry the unit: ``Message("time, h")``.

    ``equal``: both axes are lengths of one place, and are drawn to one scale.
    """

    title: Message
    x_label: Message
    y_label: Message
    curves: tuple[Curve, ...]
    marks: tuple[Mark, ...] = ()
    log_x: bool = False
    log_y: bool = False
    equal: bool = False


@dataclass(frozen=True)
class Table:
    """Rows under a head; numbers are rounded as they shall be read."""

    title: Message
    head: tuple[Cell, ...]
    rows: tuple[tuple[Cell, ...], ...]


@dataclass(frozen=True)
class Report:
    """All that a person reads of one analysis. ``notes`` explain (the formula and its direction);
    ``warnings`` say what stands against the numbers."""

    title: Message
    tables: tuple[Table, ...] = ()
    charts: tuple[Chart, ...] = ()
    notes: tuple[Message, ...] = ()
    warnings: tuple[Message, ...] = ()


def cell_text(cell: Cell, language: str = "en") -> str:
    """The cell in ``language``."""
    return cell.text(language) if isinstance(cell, Message) else cell


def report_text(report: Report, language: str = "en") -> str:
    """The report for a terminal: columns measured from their content, charts left out."""
    lines = [report.title.text(language)]
    for table in report.tables:
        lines += ["", table.title.text(language), *_columns(table, language)]
    lines += [f"  {note.text(language)}" for note in report.notes]
    lines += ["  " + Message("warning: {what}", what=what).text(language) for what in report.warnings]
    return "\n".join(lines)


def _columns(table: Table, language: str) -> Iterator[str]:
    rows = [[cell_text(cell, language) for cell in row] for row in (table.head, *table.rows)]
    widths = [max(len(row[i]) for row in rows) for i in range(len(table.head))]
    for row in rows:
        cells = [cell.rjust(width) for cell, width in zip(row, widths, strict=True)]
        yield "  " + "  ".join((row[0].ljust(widths[0]), *cells[1:])).rstrip()
