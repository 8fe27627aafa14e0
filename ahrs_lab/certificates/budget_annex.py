"""Annex pages of a certificate with every uncertainty budget in full: a table for each of K, B and L, its sum
and its Monte Carlo check. Printed where the job asks for them."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace

from ahrs_lab.certificates import wording
from ahrs_lab.certificates.documents import (
    EMPTY,
    Block,
    Column,
    Heading,
    Label,
    Paragraph,
    Table,
    Words,
    both,
    label,
    same,
)
from ahrs_lab.certificates.result_tables import (
    DASH,
    PER_HOUR,
    ResultWriter,
    contribution,
    significant,
    unit_text,
)
from ahrs_lab.certificates.richtext import RichText, Run, joined, plain, symbol
from ahrs_lab.metrology.budgets import QuantityBudget, budgets_of
from ahrs_lab.metrology.result import BudgetRow, CalibrationResult, MonteCarloCheck, Uncertainty
from ahrs_lab.metrology.rounding import format_grouped, round_to_place
from ahrs_lab.metrology.uncertainty.budget import shares

_SIZE = 7.0
_NAMES = {
    "K": wording.SCALE_FACTOR_NAMES,
    "B": wording.ZERO_OFFSET_NAMES,
    "L": wording.MISALIGNMENT_NAMES,
}
_MILLIONTH = (Run("10"), Run("−6", "sup"))
_MEAN = "\N{COMBINING MACRON}"
_NO_DIFFERENCE = 9999.0
"""Degrees of freedom from which k is that of the normal distribution to four digits."""


@dataclass(frozen=True)
class _Scale:
    """A quantity's values times ``factor`` are in ``unit``, as its contributions are printed."""

    factor: float
    unit: RichText


def budget_annex(result: CalibrationResult, writer: ResultWriter) -> tuple[Block, ...]:
    """A heading and a table for each budget of K, B and L; F₀ is informative and has none here."""
    notes = [wording.BUDGETS_NOTE]
    if any(budget.uncertainty.correlations for budget in budgets_of(result)):
        notes.append(wording.BUDGETS_CORRELATED)
    blocks: list[Block] = [Heading(writer.words(wording.BUDGETS_ANNEX))]
    blocks += [Paragraph(label(note, writer.language), size=7.0, together=True, kept=True) for note in notes]
    for budget in budgets_of(result):
        if budget.letter != "F0" and budget.uncertainty.rows:
            blocks += _of_quantity(budget, writer)
    return tuple(blocks)


def _of_quantity(budget: QuantityBudget, writer: ResultWriter) -> Iterator[Block]:
    scale = _scale(budget)
    name = writer.quantity(_NAMES[budget.letter][budget.index], budget.letter, budget.index)
    yield Heading(name, level=2)
    check = budget.uncertainty.monte_carlo
    table = _table(budget.uncertainty, scale, writer)
    yield replace(table, kept=check is not None, whole=True)
    if check is not None:
        # K itself, which in millionths would be a number of seven digits.
        ratio = scale.unit == _MILLIONTH
        divided = () if ratio else joined(" / (", scale.unit, ")")
        start = joined(symbol(budget.letter, budget.index), divided, ": ")
        said = _check_text(budget.uncertainty, check, 1.0 if ratio else scale.factor, writer)
        yield Paragraph(Label(joined(start, said.main), said.second), size=7.0, together=True)


def _scale(budget: QuantityBudget) -> _Scale:
    """B in °/h, L in 10⁻⁶, K in 10⁻⁶ where it has no unit, else in its own."""
    if budget.letter == "B":
        return _Scale(PER_HOUR, plain("°/h"))
    if budget.letter == "L":
        return _Scale(1e6, joined(_MILLIONTH, " rad"))
    if budget.unit in ("1", "(deg/s)/(deg/s)"):
        return _Scale(1e6, _MILLIONTH)
    return _Scale(1.0, unit_text(budget.unit))


def _table(found: Uncertainty, scale: _Scale, writer: ResultWriter) -> Table:
    total = found.standard * scale.factor
    columns = (
        Column(writer.words(wording.SYMBOL)),
        Column(writer.words(wording.SOURCE)),
        Column(same("u(x)"), (), "right"),
        Column(writer.words(wording.DISTRIBUTION)),
        Column(same("ν"), (), "right"),
        Column(same("|c| u(x)"), scale.unit, "right"),
        writer.column(wording.SHARE),
    )
    rows = [
        _row(row, share, scale.factor, total, writer)
        for row, share in zip(found.rows, shares(found), strict=True)
    ]
    expanded = same(writer.pair(0.0, found, scale.factor)[1].main)
    blank = (EMPTY, EMPTY)
    rows += [
        (
            EMPTY,
            writer.words(wording.COMBINED),
            *blank,
            same(_dof(found.dof)),
            same(significant(total)),
            same("100"),
        ),
        (EMPTY, _expanded_words(found, writer), *blank, EMPTY, expanded, EMPTY),
    ]
    return Table(columns, tuple(rows), size=_SIZE, summary_rows=2)


def _expanded_words(found: Uncertainty, writer: ResultWriter) -> Label:
    words = writer.words(wording.EXPANDED_UNCERTAINTY)
    return Label(joined(words.main, f", k = {found.coverage_factor:.2f}"), words.second)


def _row(
    row: BudgetRow, share: float, factor: float, total: float, writer: ResultWriter
) -> tuple[Label, ...]:
    source = both(row.source.text("zh"), row.source.text("en"), writer.language)
    mark = " *" if row.origin == "assumption" else ""
    unit = () if row.unit == "1" else joined(" ", unit_text(row.unit.replace("arcsec", "″")))
    return (
        same(_symbol(row.symbol)),
        Label(joined(source.main, mark), source.second),
        same(joined(_small(row.standard_uncertainty), unit)),
        writer.words(wording.DISTRIBUTIONS[row.distribution]),
        same(_dof(row.dof)),
        same(contribution(row.contribution * factor, total)),
        same(format_grouped(round_to_place(100.0 * share, 1))),
    )


def _symbol(text: str) -> RichText:
    """``N_1`` with its index lowered; a macron over a mean is left away, the fonts lack it."""
    letter, _, index = text.replace(_MEAN, "").partition("_")
    return symbol(letter, index) if index else plain(letter)


def _small(value: float) -> RichText:
    """Three significant digits, with a power of ten where there are too many zeros."""
    if value == 0.0 or not math.isfinite(value):
        return plain(significant(value))
    power = math.floor(math.log10(abs(value)))
    if -4 <= power < 6:
        return plain(significant(value, 3))
    digits = significant(value / 10.0**power, 3)
    return joined(digits, "×10", (Run(f"{power}".replace("-", "−"), "sup"),))


def _dof(dof: float) -> str:
    return "∞" if dof > _NO_DIFFERENCE else format_grouped(f"{dof:.0f}")


def _check_text(found: Uncertainty, check: MonteCarloCheck, factor: float, writer: ResultWriter) -> Label:
    """Trials, mean, u, both intervals and the verdict of clause 8, to one digit beyond δ."""
    delta = check.tolerance * factor
    decimals = 1 - math.floor(math.log10(delta)) if delta > 0.0 else 6

    def text(value: float) -> str:
        return format_grouped(round_to_place(value * factor, decimals))

    def interval(ends: tuple[float, float]) -> str:
        return f"[{text(ends[0])}, {text(ends[1])}]"

    verdict = wording.CHECK_VALIDATED if check.validated else wording.CHECK_NOT_VALIDATED
    if found.from_monte_carlo:
        verdict = wording.CHECK_WIDENED
    values = {
        "trials": format_grouped(str(check.trials)),
        "mean": text(check.mean),
        "u": "–" if check.standard is None else text(check.standard),
        "gum": text(found.gum_expanded),
        "symmetric": interval(check.symmetric),
        "shortest": interval(check.shortest),
        "delta": significant(delta) if delta > 0.0 else DASH,
    }
    said = Words(wording.CHECK.zh + verdict.zh, f"{wording.CHECK.en} {verdict.en}").filled(**values)
    return label(said, writer.language)
