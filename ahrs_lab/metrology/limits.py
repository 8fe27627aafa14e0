"""Limits that a customer sets: of which quantity, from where to where, in which unit.

A limit is kept as it was written. What is measured is brought into the limit's unit, never the other way
round, so that the limit printed is the limit agreed.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from decimal import Decimal

from ahrs_lab.errors import InputError
from ahrs_lab.metrology.result import MISALIGNMENT_KEYS, CalibrationResult, Uncertainty

_PER_RAD_IN_DEG = 180.0 / math.pi

QUANTITY_KEYS: tuple[str, ...] = (
    *(f"{letter}_{axis}" for letter in "KB" for axis in "xyz"),
    *(f"L_{pair}" for pair in MISALIGNMENT_KEYS),
)
"""All calibrated quantities in annex C's order."""
LIMITED: tuple[str, ...] = ("K", *QUANTITY_KEYS[:3], "B", *QUANTITY_KEYS[3:6], "L", *QUANTITY_KEYS[6:])
"""What a limit can be of: a group, or one quantity of it."""


@dataclass(frozen=True)
class LimitUnit:
    """How a result's v stands in a limit's unit: ``factor``·v, or ``relative``: ``factor``·(v/K₀ − 1).

    ``of`` is the unit of the result that it is meant for.
    """

    label: str
    of: str
    factor: float = 1.0
    relative: bool = False


LIMIT_UNITS: Mapping[str, Mapping[str, LimitUnit]] = {
    "K": {
        "1": LimitUnit("(°/s)/(°/s)", "(deg/s)/(deg/s)"),
        "(rad/s)/(deg/s)": LimitUnit("(rad/s)/(°/s)", "(rad/s)/(deg/s)"),
        "LSB/(deg/s)": LimitUnit("LSB/(°/s)", "LSB/(deg/s)"),
        "ppm": LimitUnit("10^{−6}", "", 1e6, relative=True),
        "%": LimitUnit("%", "", 1e2, relative=True),
        "fraction": LimitUnit("1", "", 1.0, relative=True),
    },
    "B": {"deg/h": LimitUnit("°/h", "deg/s", 3600.0), "deg/s": LimitUnit("°/s", "deg/s")},
    "L": {
        "arcmin": LimitUnit("′", "rad", 60.0 * _PER_RAD_IN_DEG),
        "arcsec": LimitUnit("″", "rad", 3600.0 * _PER_RAD_IN_DEG),
        "deg": LimitUnit("°", "rad", _PER_RAD_IN_DEG),
        "rad": LimitUnit("rad", "rad"),
    },
}
"""Units by the quantity's letter; those of K that are relative take a nominal value K₀."""

_RATIO_DECIMALS = 14
"""Of v/K₀ − 1: beyond lie the last bits of the ratio, which would count as digits of a small deviation."""
_DIMENSIONLESS = ("1", "(deg/s)/(deg/s)")


@dataclass(frozen=True)
class Limit:
    """Of ``quantity`` (one of :data:`LIMITED`): ``low`` ≤ value ≤ ``high`` in ``unit``; None: no such bound.

    In a relative unit low and high are deviations from ``nominal``, which is in the result's own unit. Raises
    InputError where that cannot be a limit.
    """

    quantity: str
    low: float | None
    high: float | None
    unit: str
    nominal: float | None = None

    def __post_init__(self) -> None:
        if self.quantity not in LIMITED:
            raise InputError(
                "A limit can be of {known}, not of “{found}”.", known=", ".join(LIMITED), found=self.quantity
            )
        if self.unit not in LIMIT_UNITS[self.letter]:
            raise InputError(
                "The limit of {quantity} can be in {known}, not in “{found}”.",
                quantity=self.quantity,
                known=", ".join(LIMIT_UNITS[self.letter]),
                found=self.unit,
            )
        self._check_numbers()

    def _check_numbers(self) -> None:
        numbers = [one for one in (self.low, self.high, self.nominal) if one is not None]
        if not all(math.isfinite(one) for one in numbers):
            raise InputError("The limit of {quantity} has to be finite numbers.", quantity=self.quantity)
        if self.low is None and self.high is None:
            raise InputError(
                "The limit of {quantity} has neither a lower nor an upper bound: enter one.",
                quantity=self.quantity,
            )
        if self.low is not None and self.high is not None and self.low >= self.high:
            raise InputError(
                "The limit of {quantity} goes from {low:.10g} to {high:.10g}: the lower bound has to be the "
                "smaller.",
                quantity=self.quantity,
                low=self.low,
                high=self.high,
            )
        if self.kind.relative and not self.nominal:
            raise InputError(
                "The limit of {quantity} is relative ({unit}): enter the nominal value it deviates from.",
                quantity=self.quantity,
                unit=self.unit,
            )
        if not self.kind.relative and self.nominal is not None:
            raise InputError(
                "The limit of {quantity} is in {unit}, which takes no nominal value: leave it out, or write "
                "the limit in ppm.",
                quantity=self.quantity,
                unit=self.unit,
            )

    @property
    def letter(self) -> str:
        """K, B or L."""
        return self.quantity[0]

    @property
    def kind(self) -> LimitUnit:
        """What stands behind the unit's key."""
        return LIMIT_UNITS[self.letter][self.unit]

    def covers(self, key: str) -> bool:
        """Whether it is a limit of the quantity ``key``, alone or as one of its group."""
        return key == self.quantity or key[0] == self.quantity

    def value(self, measured: Measured) -> float:
        """The measured value in the limit's unit."""
        kind = self.kind
        if kind.relative:
            assert self.nominal
            deviation = round(measured.value / self.nominal - 1.0, _RATIO_DECIMALS)
            return steady(deviation * kind.factor)
        self._check_unit(measured)
        return steady(measured.value * kind.factor)

    def size(self, amount: float) -> float:
        """An amount in the result's unit (an uncertainty) as an amount in the limit's unit."""
        kind = self.kind
        return steady(amount * kind.factor / (abs(self.nominal) if self.nominal else 1.0))

    def _check_unit(self, measured: Measured) -> None:
        wanted, found = self.kind.of, measured.unit
        if found != wanted and not (found in _DIMENSIONLESS and wanted in _DIMENSIONLESS):
            raise InputError(
                "The limit of {quantity} is in {wanted}, but the result is in {found}: correct the limit.",
                quantity=measured.key,
                wanted=wanted,
                found=found,
            )


def steady(number: float, size: float = 0.0) -> float:
    """Twelve digits, of ``size`` where that is larger: the last bits of a change of unit, or of a difference,
    must not put a value beyond a limit it lies on. So the limit that it is compared with has as many."""
    largest = max(abs(number), size)
    if largest == 0.0 or not math.isfinite(largest):
        return number
    return round(number, 11 - Decimal(repr(largest)).adjusted())


@dataclass(frozen=True)
class Measured:
    """One calibrated quantity: ``key`` as "K_x", value and uncertainty in ``unit``."""

    key: str
    value: float
    unit: str
    uncertainty: Uncertainty


def measured(result: CalibrationResult) -> tuple[Measured, ...]:
    """All quantities of a result in annex C's order."""
    found = {
        f"K_{axis}": Measured(f"K_{axis}", k.K, k.unit, k.uncertainty)
        for axis, k in result.scale_factor.items()
    }
    found |= {
        f"B_{axis}": Measured(f"B_{axis}", b.B, b.unit, b.uncertainty)
        for axis, b in result.zero_offset.items()
    }
    found |= {
        f"L_{pair}": Measured(f"L_{pair}", m.L, m.unit, m.uncertainty)
        for pair, m in result.misalignment.items()
    }
    return tuple(found[key] for key in QUANTITY_KEYS if key in found)


def limit_of(key: str, limits: Iterable[Limit]) -> Limit | None:
    """The limit that holds for a quantity: its own before its group's."""
    covering = [limit for limit in limits if limit.covers(key)]
    return next((limit for limit in covering if limit.quantity == key), covering[0] if covering else None)


def check_distinct(limits: Iterable[Limit]) -> None:
    """Raises InputError where two limits are of the same quantity."""
    seen: set[str] = set()
    for limit in limits:
        if limit.quantity in seen:
            raise InputError("{quantity} has two limits: keep one.", quantity=limit.quantity)
        seen.add(limit.quantity)
