"""The figures of ``JOB.toml`` that each standard's certificate states.

``[[standard.figure]]`` names a figure with ``U`` and ``k`` (and ``dof`` where the certificate states them),
or with ``limit`` and its ``distribution``; ``unit`` is that of the figure's name where it is left out.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, cast, get_args

from ahrs_lab.errors import InputError
from ahrs_lab.messages import Message
from ahrs_lab.metrology.capability import figure_conflicts
from ahrs_lab.metrology.conditions import Standard
from ahrs_lab.metrology.stated_figures import FIGURES, LIMITS, RATE_FIGURES, UNITS, FigureName, StatedFigure

if TYPE_CHECKING:
    from ahrs_lab.certificates.job_sheet_file import _Table

_NAMES: tuple[FigureName, ...] = get_args(FigureName)


def read_figures(standard: _Table, path: Path) -> tuple[StatedFigure, ...]:
    """The tables ``[[standard.figure]]`` of one standard; such a standard needs its due date."""
    tables = standard.tables("figure")
    if tables:
        standard.day("due", required=True)
    return tuple(_figure(table, path) for table in tables)


def _figure(table: _Table, path: Path) -> StatedFigure:
    name = table.choice("figure", _NAMES)
    base = FIGURES[name].unit
    unit = table.choice("unit", tuple(UNITS[base]), base)
    limited = table.has("limit")
    if limited and (table.has("U") or table.has("k") or table.has("dof")):
        raise table.wrong(
            "limit", Message("left out where U and k are given; keep what the certificate states")
        )
    if limited:
        value, k, dof = _above_zero(table, "limit"), None, math.inf
        distribution = table.choice("distribution", LIMITS, "rectangular")
    else:
        value, k = _above_zero(table, "U"), _above_zero(table, "k")
        dof = table.number("dof", math.inf)
        distribution = table.choice("distribution", ("normal",), "normal")
    table.finish()
    try:
        return StatedFigure(name, value, unit, k, distribution, dof)
    except InputError as error:
        raise InputError(
            "{file}: “{key}”: {reason}", file=path.name, key=table.where, reason=error.message
        ) from error


def _above_zero(table: _Table, key: str) -> float:
    if not table.has(key):
        raise table.missing(key)
    value = table.number(key, 0.0)
    if value <= 0.0:
        raise table.wrong(key, Message("a number above 0, as the certificate states it"))
    return value


def check_figures(standards: Sequence[Standard], capability: _Table, path: Path) -> None:
    """Raises InputError where a figure is stated twice: by two standards, or in ``[capability]`` too."""
    for message in figure_conflicts(standards):
        raise InputError("{file}: {reason}", file=path.name, reason=message)
    for index, standard in enumerate(standards, 1):
        for stated in standard.figures:
            name = "rate_relative" if stated.figure in RATE_FIGURES else cast("str", stated.figure)
            if capability.has(name):
                raise capability.wrong(
                    name, Message("left out: standard[{index}] states this figure", index=index)
                )
