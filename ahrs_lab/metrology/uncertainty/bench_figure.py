"""A figure of the bench as a budget takes it: how uncertain, how that is known, and who says so."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

from ahrs_lab.messages import Message
from ahrs_lab.metrology.result import BudgetRow, Distribution, Origin
from ahrs_lab.metrology.uncertainty.budget import effective_dof


@dataclass(frozen=True)
class BenchFigure:
    """``half_width`` is the expanded uncertainty U or the limit a; over ``divisor`` it is the standard
    uncertainty. ``certificate`` is the number of the certificate that states it, where one does."""

    half_width: float
    divisor: float = 2.0
    distribution: Distribution = "normal"
    dof: float = math.inf
    origin: Origin = "assumption"
    certificate: str = ""

    @property
    def standard(self) -> float:
        """Standard uncertainty."""
        return self.half_width / self.divisor

    @property
    def double(self) -> float:
        """Twice the standard uncertainty: U at k = 2."""
        return 2.0 * self.standard

    @property
    def claimed(self) -> float:
        """What clause 6 looks at: U at k = 2, or the limit itself."""
        return self.double if self.distribution in ("normal", "t") else self.half_width

    def times(self, factor: float) -> BenchFigure:
        """In another unit."""
        return replace(self, half_width=abs(factor) * self.half_width)


def root_sum(figures: Sequence[BenchFigure]) -> BenchFigure:
    """Independent figures in quadrature, at k = 2; certified where all of them are."""
    parts = [figure.standard for figure in figures]
    dof = effective_dof(parts, [figure.dof for figure in figures])
    certified = all(figure.origin == "certificate" for figure in figures)
    numbers = dict.fromkeys(figure.certificate for figure in figures if figure.certificate)
    return BenchFigure(
        half_width=2.0 * math.hypot(*parts),
        distribution="t" if math.isfinite(dof) else "normal",
        dof=dof,
        origin="certificate" if certified else "assumption",
        certificate=", ".join(numbers) if certified else "",
    )


def from_figure(
    symbol: str, source: Message, unit: str, figure: BenchFigure, sensitivity: float
) -> BudgetRow:
    """A type B row; ``figure`` is in ``unit``."""
    return BudgetRow(
        symbol=symbol,
        source=source,
        unit=unit,
        standard_uncertainty=figure.standard,
        sensitivity=sensitivity,
        contribution=abs(sensitivity) * figure.standard,
        kind="B",
        distribution=figure.distribution,
        divisor=figure.divisor,
        dof=figure.dof,
        origin=figure.origin,
        half_width=figure.half_width,
        certificate=figure.certificate,
    )
