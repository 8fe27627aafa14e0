"""What if a source of the chosen quantity were better known: what was typed, what it would give. No Qt."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping

from ahrs_lab.errors import InputError
from ahrs_lab.metrology.result import Uncertainty
from ahrs_lab.metrology.uncertainty.what_if import Change, what_if
from ahrs_lab.ui.formatting import MINUS, THIN_SPACE, number
from ahrs_lab.ui.pages.results.quantities import Quantity

_GROUPED = re.compile(r"[+-]?[1-9]\d{0,2}(,\d{3})+(\.\d*)?")
"""May be thousands and may be a decimal comma."""


class WhatIfModel:
    """Never touches the result; forgets its changes with another quantity or another result."""

    def __init__(self) -> None:
        self._quantity: Quantity | None = None
        self._changes: dict[int, Change] = {}
        self._found: Uncertainty | None = None

    def follow(self, quantity: Quantity) -> bool:
        """Of this quantity from now on; whether it is another one."""
        another = quantity != self._quantity
        if another:
            self._quantity = quantity
            self.reset()
        return another

    @property
    def changes(self) -> Mapping[int, Change]:
        """By the place of the row in the budget."""
        return self._changes

    @property
    def uncertainty(self) -> Uncertainty:
        """With the changes; without any the result's own."""
        if self._found is None:
            raise ValueError("no quantity is followed")
        return self._found

    def change(self, row: int, text: str) -> None:
        """A new u(x), as typed in the row's unit; empty, or what it is, restores the row.

        Raises InputError for what is no number or no uncertainty; then nothing changes.
        """
        if self._quantity is None:
            return
        budget = self._quantity.uncertainty
        changes = {place: change for place, change in self._changes.items() if place != row}
        if text.strip():
            value = _number(text)
            if value != budget.rows[row].standard_uncertainty:
                changes[row] = Change(standard_uncertainty=value)
        self._found = what_if(budget, changes)
        self._changes = changes

    def reset(self) -> None:
        """Back to the result."""
        self._changes = {}
        self._found = self._quantity.uncertainty if self._quantity is not None else None


def _number(text: str) -> float:
    plain = "".join(text.split()).replace(THIN_SPACE, "").replace(MINUS, "-")
    if _GROUPED.fullmatch(plain):
        raise InputError(
            "“{text}” can be read in two ways: write a decimal point, and thousands without a comma.",
            text=text.strip()[:40],
        )
    try:
        value = float(plain.replace(",", "."))
    except ValueError:
        value = math.nan
    if not math.isfinite(value):
        raise InputError("“{text}” is not a number: type one such as 0.02 or 2e-5.", text=text.strip()[:40])
    return value


def significant(value: float, digits: int = 3) -> str:
    """So many significant digits; with a power of ten, its exponent in ``^{…}``, where there are too many
    zeros."""
    if value == 0.0:
        return "0"
    if not math.isfinite(value):
        return "∞"
    power = math.floor(math.log10(abs(value)))
    if -4 <= power < 6:
        return number(value, max(0, digits - 1 - power))
    mantissa = number(value / 10.0**power, digits - 1)
    return f"{mantissa}×10^{{{MINUS if power < 0 else ''}{abs(power)}}}"


def degrees_of_freedom(dof: float) -> str:
    """Whole; ∞ where it makes no difference."""
    return "∞" if dof > 9999 else number(dof, 0)
