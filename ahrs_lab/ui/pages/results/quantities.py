"""The numbers of a result as the cards show them: one row a quantity, in the unit that is chosen.

No Qt here. Rounding is :mod:`ahrs_lab.metrology.rounding`'s; this module only changes units and sets digits.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal

from ahrs_lab.metrology.result import (
    MISALIGNMENT_KEYS,
    AxisName,
    CalibrationResult,
    MisalignmentResult,
    ScaleFactorResult,
    Uncertainty,
    ZeroOffsetResult,
)
from ahrs_lab.metrology.rounding import RoundingMode, format_grouped, round_to_uncertainty
from ahrs_lab.recording.orientation import AXES

Group = Literal["scale_factor", "zero_offset", "misalignment"]
GROUPS: tuple[Group, ...] = ("scale_factor", "zero_offset", "misalignment")
DASH = "–"
"""Stands where there is no number."""


@dataclass(frozen=True)
class Unit:
    """How a base value v is shown: (v − reference)·factor, with ``label`` beside it."""

    key: str
    label: str
    factor: float = 1.0
    reference: float = 0.0


_SCALE_UNITS = (Unit("1", "1"), Unit("ppm", "ppm", 1e6, 1.0))
_OFFSET_UNITS = (Unit("dph", "°/h", 3600.0), Unit("dps", "°/s"))
_DEG = 180.0 / math.pi
_ANGLE_UNITS = (
    Unit("arcmin", "′", 60.0 * _DEG),
    Unit("arcsec", "″", 3600.0 * _DEG),
    Unit("deg", "°", _DEG),
    Unit("rad", "rad"),
)
_DIMENSIONLESS = ("1", "(deg/s)/(deg/s)")


@dataclass(frozen=True)
class Quantity:
    """One calibrated number. ``key`` is "K.x", "B.y", "L.yx"; ``axis`` gives the colour (the turned axis of
    L); ``index`` stands lowered after ``symbol``."""

    key: str
    group: Group
    axis: AxisName
    symbol: str
    index: str
    value: float
    unit: str
    uncertainty: Uncertainty
    source: ScaleFactorResult | ZeroOffsetResult | MisalignmentResult


@dataclass(frozen=True)
class Shown:
    """Texts of one quantity in one unit."""

    value: str
    expanded: str
    unit: str


def quantities(result: CalibrationResult) -> tuple[Quantity, ...]:
    """All that ``result`` holds, in annex C's order; what was not measured is not there."""
    found: list[Quantity] = []
    for axis in AXES:
        scale = result.scale_factor.get(axis)
        if scale is not None:
            found.append(
                Quantity(
                    f"K.{axis}",
                    "scale_factor",
                    axis,
                    "K",
                    axis,
                    scale.K,
                    scale.unit,
                    scale.uncertainty,
                    scale,
                )
            )
    for axis in AXES:
        offset = result.zero_offset.get(axis)
        if offset is not None:
            found.append(
                Quantity(
                    f"B.{axis}",
                    "zero_offset",
                    axis,
                    "B",
                    axis,
                    offset.B,
                    offset.unit,
                    offset.uncertainty,
                    offset,
                )
            )
    for pair in MISALIGNMENT_KEYS:
        angle = result.misalignment.get(pair)
        if angle is not None:
            found.append(
                Quantity(
                    f"L.{pair}",
                    "misalignment",
                    angle.turned_axis,
                    "L",
                    pair,
                    angle.L,
                    angle.unit,
                    angle.uncertainty,
                    angle,
                )
            )
    return tuple(found)


def units(quantity: Quantity) -> tuple[Unit, ...]:
    """The units it can be shown in, the usual one first. A device that counts has no nominal K, so no ppm."""
    if quantity.group == "scale_factor":
        if quantity.unit in _DIMENSIONLESS:
            return _SCALE_UNITS
        return (Unit("own", quantity.unit.replace("(deg/s)", "(°/s)").replace("deg/s", "°/s")),)
    return _OFFSET_UNITS if quantity.group == "zero_offset" else _ANGLE_UNITS


def show(quantity: Quantity, unit: Unit, mode: RoundingMode = "half-even") -> Shown:
    """Value and U rounded together; U unknown is a dash and the value has nine decimals."""
    value = (quantity.value - unit.reference) * unit.factor
    expanded = quantity.uncertainty.expanded * abs(unit.factor)
    if not math.isfinite(value):
        return Shown(DASH, DASH, unit.label)
    if not (math.isfinite(expanded) and expanded > 0.0):
        return Shown(format_grouped(f"{value:.9f}"), DASH, unit.label)
    rounded = round_to_uncertainty(value, expanded, mode)
    return Shown(format_grouped(rounded.value), format_grouped(rounded.expanded), unit.label)
