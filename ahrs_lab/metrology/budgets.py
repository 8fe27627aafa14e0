"""All budgets of a result, in annex C's order: what is printed, saved and shown goes through them alike."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from ahrs_lab.metrology.result import MISALIGNMENT_KEYS, AxisName, CalibrationResult, Uncertainty

_AXES: tuple[AxisName, ...] = ("x", "y", "z")


@dataclass(frozen=True)
class QuantityBudget:
    """One quantity with its budget: ``letter`` K, F0, B or L, ``index`` its axis or, for L, output and turned
    axis; ``value`` in ``unit``."""

    letter: Literal["K", "F0", "B", "L"]
    index: str
    value: float
    unit: str
    uncertainty: Uncertainty

    @property
    def name(self) -> str:
        """``K_x``, ``F0_y``, ``L_yx``."""
        return f"{self.letter}_{self.index}"


def budgets_of(result: CalibrationResult) -> tuple[QuantityBudget, ...]:
    """K and F₀ of each axis, B of each axis, L of each pair; what has none is not there."""
    found: list[QuantityBudget] = []
    for axis in (axis for axis in _AXES if axis in result.scale_factor):
        scale = result.scale_factor[axis]
        found.append(QuantityBudget("K", axis, scale.K, scale.unit, scale.uncertainty))
        if scale.F0_uncertainty is not None:
            unit = "deg/s" if scale.unit == "1" else scale.unit.split("/(deg/s)")[0].strip("()")
            found.append(QuantityBudget("F0", axis, scale.F0, unit, scale.F0_uncertainty))
    for axis in (axis for axis in _AXES if axis in result.zero_offset):
        offset = result.zero_offset[axis]
        found.append(QuantityBudget("B", axis, offset.B, offset.unit, offset.uncertainty))
    for key in (key for key in MISALIGNMENT_KEYS if key in result.misalignment):
        angle = result.misalignment[key]
        found.append(QuantityBudget("L", key, angle.L, angle.unit, angle.uncertainty))
    return tuple(found)
