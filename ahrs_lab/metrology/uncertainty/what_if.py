"""What a budget would give if a source were better or worse known: a question, never a result.

The rows that are asked about are changed and combined again by the budget's own method, with its correlations
and shared estimates. The Monte Carlo check is of the budget as it was, so the answer carries none.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

from ahrs_lab.errors import InputError
from ahrs_lab.metrology.result import BudgetRow, Uncertainty
from ahrs_lab.metrology.uncertainty.annex_a import combine_annex_a
from ahrs_lab.metrology.uncertainty.budget import combine
from ahrs_lab.metrology.uncertainty.distributions import refuse_dof

_LARGEST = 1e150
"""Its square is still a number."""


@dataclass(frozen=True)
class Change:
    """Of one row, in the row's own unit; what is None stays.

    ``half_width`` is the row's half-width or expanded uncertainty, u(x) times its divisor; give it or
    ``standard_uncertainty``. ``left_out``: as if the source did not exist; the row stays in its place with 0.
    """

    standard_uncertainty: float | None = None
    half_width: float | None = None
    dof: float | None = None
    left_out: bool = False


def what_if(uncertainty: Uncertainty, changes: Mapping[int, Change]) -> Uncertainty:
    """The budget combined again with ``changes``, by the place of the row; without any it is the same.

    A new u(x) is of that row alone; new degrees of freedom are of the estimate, so of every row that shares
    it. Raises InputError for a row that is not there, for an uncertainty that is negative or not finite, or
    given twice, and for degrees of freedom that are not positive.
    """
    rows = list(uncertainty.rows)
    for place, change in sorted(changes.items()):
        if not 0 <= place < len(rows):
            raise InputError(
                "The budget has no row {row}: it has {count}.", row=place + 1, count=len(uncertainty.rows)
            )
        rows[place] = _with_uncertainty(rows[place], change)
        if change.dof is not None:
            _set_dof(rows, place, change.dof)
    if tuple(rows) == uncertainty.rows:
        return uncertainty
    if uncertainty.method == "annex-a":
        return combine_annex_a(rows)
    return combine(rows, uncertainty.method, uncertainty.correlations)


def _with_uncertainty(row: BudgetRow, change: Change) -> BudgetRow:
    if change.standard_uncertainty is not None and change.half_width is not None:
        raise InputError(
            "{symbol} is changed twice: give its standard uncertainty or its half-width.", symbol=row.symbol
        )
    standard = change.standard_uncertainty
    if change.half_width is not None:
        standard = change.half_width / row.divisor
    if change.left_out:
        standard = 0.0
    if standard is None or standard == row.standard_uncertainty:
        return row
    if not 0.0 <= standard * max(1.0, abs(row.sensitivity)) < _LARGEST:
        raise InputError(
            "{symbol}: {value} is not an uncertainty: it has to be 0 or more, and not beyond all bounds.",
            symbol=row.symbol,
            value=standard,
        )
    return replace(
        row,
        standard_uncertainty=standard,
        contribution=abs(row.sensitivity) * standard,
        half_width=None if row.half_width is None else standard * row.divisor,
    )


def _set_dof(rows: list[BudgetRow], place: int, dof: float) -> None:
    """An estimate has one number of degrees of freedom: of all the rows that share it."""
    refuse_dof(dof, rows[place].symbol)
    shared = rows[place].shared
    for index, row in enumerate(rows):
        if index == place or (shared and row.shared == shared):
            rows[index] = replace(row, dof=dof)
