"""The fitted K as a source of what is scaled by it: B and L of outputs in counts."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal

from ahrs_lab.messages import Message
from ahrs_lab.metrology.result import BudgetRow, Origin, Uncertainty
from ahrs_lab.metrology.uncertainty.budget import shares

SIGNIFICANT_SHARE = 0.05
"""Part of the variance of K from which a row has a say in what u(K) rests on."""


@dataclass(frozen=True)
class FittedScale:
    """Relative standard uncertainty of K, and how it is known; 0 where nothing was scaled by K."""

    relative: float = 0.0
    dof: float = math.inf
    kind: Literal["A", "B"] = "A"
    origin: Origin = "data"
    certificate: str = ""

    @classmethod
    def of(cls, K: float, budget: Uncertainty) -> FittedScale:
        """What K's budget hands on: its degrees of freedom, the least that its significant rows rest on
        (an assumption before a certificate before data), type B where such rows make up the most of it."""
        parts = list(zip(budget.rows, shares(budget), strict=True))
        origins = {row.origin for row, share in parts if share >= SIGNIFICANT_SHARE}
        origin: Origin = next((one for one in _WORST_FIRST if one in origins), "data")
        numbers = dict.fromkeys(
            row.certificate for row, share in parts if share >= SIGNIFICANT_SHARE and row.certificate
        )
        return cls(
            relative=budget.standard / abs(K),
            dof=budget.dof,
            kind="B" if sum(share for row, share in parts if row.kind == "B") > 0.5 else "A",
            origin=origin,
            certificate=", ".join(numbers) if origin == "certificate" else "",
        )

    def row(self, value: float) -> BudgetRow:
        """Of a quantity that was divided by K."""
        return BudgetRow(
            symbol="K",
            source=Message("Fitted scale factor"),
            unit="1",
            standard_uncertainty=self.relative,
            sensitivity=-value,
            contribution=abs(value) * self.relative,
            kind=self.kind,
            distribution="t" if math.isfinite(self.dof) else "normal",
            divisor=1.0,
            dof=self.dof,
            origin=self.origin,
            estimate=1.0,
            certificate=self.certificate,
        )


UNSCALED = FittedScale()

_WORST_FIRST: tuple[Origin, ...] = ("assumption", "certificate", "data")
