"""Figures that a standard's certificate states: what is known, how well, and in which words.

A figure is an expanded uncertainty U with its coverage factor k, or limits ± a with their distribution (JCGM
100, 4.3.3 and 4.3.7). What cannot be one is refused when it is made, wherever it comes from.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Literal, get_args

from ahrs_lab.errors import InputError
from ahrs_lab.messages import Message
from ahrs_lab.metrology.result import Distribution
from ahrs_lab.metrology.uncertainty.budget import DIVISORS

FigureName = Literal[
    "rate_relative_below_1",
    "rate_relative_1_to_10",
    "rate_relative_from_10",
    "position_arcsec",
    "wobble_arcsec",
    "axis_tilt_arcsec",
    "azimuth_arcsec",
    "level_arcsec",
    "fixture_perpendicularity_arcsec",
    "latitude_deg",
    "timing_relative",
    "fixture_flatness_mm",
    "supply_relative",
    "supply_ripple_mv",
]

RATE_FIGURES: tuple[FigureName, FigureName, FigureName] = (
    "rate_relative_below_1",
    "rate_relative_1_to_10",
    "rate_relative_from_10",
)
"""The table's relative rate error in each band of clause 6."""

StatedDistribution = Literal["normal", "rectangular", "triangular", "arcsine"]
LIMITS: tuple[StatedDistribution, ...] = ("rectangular", "triangular", "arcsine")

UNITS: Mapping[str, Mapping[str, float]] = {
    "1": {"1": 1.0, "%": 1e-2, "ppm": 1e-6},
    "arcsec": {
        "arcsec": 1.0,
        "arcmin": 60.0,
        "deg": 3600.0,
        "mrad": math.degrees(1e-3) * 3600.0,
        "urad": math.degrees(1e-6) * 3600.0,
    },
    "deg": {"deg": 1.0, "arcmin": 1.0 / 60.0, "arcsec": 1.0 / 3600.0},
    "mm": {"mm": 1.0, "um": 1e-3},
    "mV": {"mV": 1.0, "uV": 1e-3},
}
"""In which units a figure may be stated, by the unit it is used in; factors to that."""

_LARGEST_K = 100.0


@dataclass(frozen=True)
class FigureKind:
    """What a figure is called, the unit it is used in, and whose certificates can state it."""

    name: Message
    unit: str
    kinds: tuple[str, ...]


FIGURES: Mapping[FigureName, FigureKind] = {
    "rate_relative_below_1": FigureKind(Message("table rate, |Ω| < 1 °/s"), "1", ("table", "other")),
    "rate_relative_1_to_10": FigureKind(Message("table rate, 1 ≤ |Ω| < 10 °/s"), "1", ("table", "other")),
    "rate_relative_from_10": FigureKind(Message("table rate, |Ω| ≥ 10 °/s"), "1", ("table", "other")),
    "position_arcsec": FigureKind(Message("table position"), "arcsec", ("table", "other")),
    "wobble_arcsec": FigureKind(Message("wobble of the table's axis"), "arcsec", ("table", "other")),
    "axis_tilt_arcsec": FigureKind(Message("table axis against the vertical"), "arcsec", ("table", "other")),
    "azimuth_arcsec": FigureKind(Message("azimuth reference (north)"), "arcsec", ("north", "other")),
    "level_arcsec": FigureKind(Message("level of the seat"), "arcsec", ("fixture", "table", "other")),
    "fixture_perpendicularity_arcsec": FigureKind(
        Message("perpendicularity of the fixture"), "arcsec", ("fixture", "other")
    ),
    "latitude_deg": FigureKind(Message("latitude"), "deg", ("north", "other")),
    "timing_relative": FigureKind(Message("time base, relative"), "1", ("table", "other")),
    "fixture_flatness_mm": FigureKind(Message("flatness of the fixture"), "mm", ("fixture", "other")),
    "supply_relative": FigureKind(Message("supply voltage, relative"), "1", ("supply", "other")),
    "supply_ripple_mv": FigureKind(Message("ripple and noise of the supply"), "mV", ("supply", "other")),
}

CLAUSE_6_ONLY: tuple[FigureName, ...] = ("fixture_flatness_mm", "supply_relative", "supply_ripple_mv")
"""Those that clause 6 asks for and no budget takes."""


def figures_of_kind(kind: str) -> tuple[FigureName, ...]:
    """The figures that a standard of ``kind`` can state."""
    return tuple(name for name, figure in FIGURES.items() if kind in figure.kinds)


@dataclass(frozen=True)
class StatedFigure:
    """One figure of a certificate.

    ``value`` in ``unit`` is U where ``coverage_factor`` k is given (``distribution`` normal, with ``dof``
    where the certificate states them), else the limit a of ± a. Raises InputError for what states nothing.
    """

    figure: FigureName
    value: float
    unit: str
    coverage_factor: float | None = None
    distribution: StatedDistribution = "normal"
    dof: float = math.inf

    def __post_init__(self) -> None:
        if self.figure not in FIGURES:
            raise InputError(
                "“{figure}” is no figure of the bench: choose one of {choices}.",
                figure=self.figure,
                choices=", ".join(get_args(FigureName)),
            )
        name = FIGURES[self.figure].name
        units = UNITS[FIGURES[self.figure].unit]
        if self.unit not in units:
            raise InputError(
                "The figure “{name}” cannot be in “{unit}”: state it in one of {choices}.",
                name=name,
                unit=self.unit,
                choices=", ".join(units),
            )
        if not _positive(self.value):
            raise InputError(
                "The figure “{name}” has no uncertainty: enter U or the limit as a number above 0.", name=name
            )
        if self.distribution in LIMITS:
            self._check_limits(name)
        else:
            self._check_expanded(name)

    def _check_limits(self, name: Message) -> None:
        if self.coverage_factor is not None or self.dof != math.inf:
            raise InputError(
                "The figure “{name}” is a limit and has neither k nor degrees of freedom: take them out, or "
                "state U with k.",
                name=name,
            )

    def _check_expanded(self, name: Message) -> None:
        if self.distribution != "normal":
            raise InputError(
                "The figure “{name}” has no distribution that is known: choose normal or one of {choices}.",
                name=name,
                choices=", ".join(LIMITS),
            )
        if not _positive(self.coverage_factor) or (self.coverage_factor or 0.0) > _LARGEST_K:
            raise InputError(
                "The figure “{name}” has no coverage factor: U says nothing without the k that the "
                "certificate states, a number above 0.",
                name=name,
            )
        if not self.dof >= 1.0:
            raise InputError(
                "The figure “{name}” has less than one degree of freedom: enter what the certificate "
                "states, or nothing.",
                name=name,
            )

    @property
    def limit_or_expanded(self) -> float:
        """``value`` in the unit that the figure is used in."""
        return self.value * UNITS[FIGURES[self.figure].unit][self.unit]

    @property
    def divisor(self) -> float:
        """k, or that of the distribution of the limits."""
        return self.coverage_factor or DIVISORS[self.distribution]

    @property
    def claimed(self) -> float:
        """What clause 6 looks at: U at k = 2, or the limit itself."""
        if self.coverage_factor is None:
            return self.limit_or_expanded
        return 2.0 * self.limit_or_expanded / self.coverage_factor

    @property
    def budget_distribution(self) -> Distribution:
        """As a budget's row says it."""
        return "t" if math.isfinite(self.dof) else self.distribution


def _positive(value: object) -> bool:
    return (
        isinstance(value, (int, float))
        and not isinstance(value, bool)
        and math.isfinite(value)
        and value > 0.0
    )
