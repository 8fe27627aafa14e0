"""The standard's own method (annex A): relative components, coverage factor 2.

Kept as printed, with its ways: the full step of the acquisition is divided by √3, and the repeatability of
positions or of senses of rotation is added linearly, as if fully correlated.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

from ahrs_lab.messages import Message
from ahrs_lab.metrology.result import BudgetRow, Origin, Uncertainty

COVERAGE_FACTOR = 2.0


def acquisition_uncertainty(bits: float) -> float:
    """u₂ = 2⁻ᴺ/√3 (A.3), relative."""
    return float(2.0 ** (-bits)) / math.sqrt(3.0)


def annex_a_uncertainty(
    value: float,
    unit: str,
    *,
    table_expanded: float,
    table_origin: Origin,
    bits: float,
    bits_origin: Origin,
    repeatability: Sequence[float],
    table_certificate: str = "",
) -> Uncertainty:
    """u_c and U = 2·u_c in the unit of ``value``.

    ``table_expanded`` (k = 2) is relative, ``table_certificate`` the number of the certificate that states
    it; ``bits`` is the N of (A.3); ``repeatability`` holds absolute standard uncertainties that are added
    linearly: one for K, one for each position for B, one for each sense for L. For the printed examples,
    where everything is relative, ``value`` is 1.
    """
    scale = abs(value)
    table = table_expanded / COVERAGE_FACTOR
    acquisition = acquisition_uncertainty(bits)
    repeated = float(sum(repeatability))
    rows = (
        BudgetRow(
            symbol="u₁",
            source=Message("Rate table (annex A, u₁)"),
            unit="1",
            standard_uncertainty=table,
            sensitivity=scale,
            contribution=scale * table,
            kind="B",
            distribution="normal",
            divisor=COVERAGE_FACTOR,
            dof=math.inf,
            origin=table_origin,
            half_width=table_expanded,
            certificate=table_certificate,
        ),
        BudgetRow(
            symbol="u₂",
            source=Message("Data acquisition, {bits} effective bits (annex A, u₂)", bits=round(bits, 1)),
            unit="1",
            standard_uncertainty=acquisition,
            sensitivity=scale,
            contribution=scale * acquisition,
            kind="B",
            distribution="rectangular",
            divisor=math.sqrt(3.0),
            dof=math.inf,
            origin=bits_origin,
            half_width=2.0 ** (-bits),
        ),
        BudgetRow(
            symbol="u₃",
            source=Message(
                "Repeatability, {count} terms added linearly (annex A, u₃)", count=len(repeatability)
            ),
            unit=unit,
            standard_uncertainty=repeated,
            sensitivity=1.0,
            contribution=repeated,
            kind="A",
            distribution="normal",
            divisor=1.0,
            dof=math.inf,
            origin="data",
        ),
    )
    return combine_annex_a(rows)


def combine_annex_a(rows: Sequence[BudgetRow]) -> Uncertainty:
    """u_c from the squares of the rows' contributions, U = 2·u_c."""
    standard = math.sqrt(sum(row.contribution**2 for row in rows))
    return Uncertainty(
        standard=standard,
        expanded=COVERAGE_FACTOR * standard,
        coverage_factor=COVERAGE_FACTOR,
        dof=math.inf,
        method="annex-a",
        rows=tuple(rows),
    )
