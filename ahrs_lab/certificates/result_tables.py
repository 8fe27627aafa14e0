"""Annex C: the result sheet, each value rounded to its uncertainty, in annex C's words and order."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from string import ascii_lowercase
from typing import Literal

from ahrs_lab.certificates import conformity_wording, wording
from ahrs_lab.certificates.documents import EMPTY, Column, Label, Table, Words, label, same
from ahrs_lab.certificates.job_sheet import CertificateLanguage
from ahrs_lab.certificates.richtext import RichText, Run, joined, plain, symbol
from ahrs_lab.metrology.requirements import ResultUnits
from ahrs_lab.metrology.result import (
    MISALIGNMENT_KEYS,
    AxisName,
    BudgetRow,
    CalibrationResult,
    MisalignmentResult,
    ScaleFactorResult,
    Uncertainty,
    ZeroOffsetResult,
)
from ahrs_lab.metrology.rounding import format_grouped, round_to_place, round_to_uncertainty
from ahrs_lab.metrology.scale_factor import asymmetry_standard_ppm

AXES: tuple[AxisName, ...] = ("x", "y", "z")
PER_HOUR = 3600.0
DEGREE = 180.0 / math.pi
ARCMIN = 60.0 * DEGREE
_OFFSET_UNITS = {"deg/s": ("°/s", 1.0), "deg/h": ("°/h", PER_HOUR)}
_ANGLE_UNITS = {
    "rad": ("rad", 1.0),
    "arcmin": ("′", ARCMIN),
    "arcsec": ("″", 60.0 * ARCMIN),
    "deg": ("°", DEGREE),
}
DASH = "—"

_UNITS = {
    "deg/s": "°/s",
    "(deg/s)/(deg/s)": "(°/s)/(°/s)",
    "(rad/s)/(deg/s)": "(rad/s)/(°/s)",
    "LSB/(deg/s)": "LSB/(°/s)",
}


def unit_text(unit: str) -> RichText:
    """A unit of the results as it is printed."""
    return plain(_UNITS.get(unit, unit.replace("deg", "°")))


def significant(value: float, digits: int = 2) -> str:
    """``value`` with that many significant digits, written out, grouped; for figures that have no
    uncertainty."""
    if value == 0 or not math.isfinite(value):
        return "0" if value == 0 else "∞" if value > 0 else DASH
    decimals = digits - 1 - math.floor(math.log10(abs(value)))
    if abs(float(round_to_place(value, decimals))) >= 10.0 ** (digits - decimals):  # 0.0996 became 0.100
        decimals -= 1
    return format_grouped(round_to_place(value, decimals))


def without_noise(product: float) -> float:
    """Twelve digits: the last bits of a change of unit must not decide a tie or raise a digit."""
    return float(f"{product:.12g}")


def contribution(value: float, combined: float) -> str:
    """A contribution to one digit more than the combined uncertainty's two; what vanishes there as ``<
    0.001``."""
    if not (math.isfinite(value) and combined > 0 and math.isfinite(combined)):
        return significant(value)
    if value == 0.0:
        return "0"
    decimals = 2 - math.floor(math.log10(combined))
    text = round_to_place(value, decimals)
    if float(text) == 0 and value > 0:
        return f"< {format_grouped(round_to_place(10.0**-decimals, decimals))}"
    return format_grouped(text)


@dataclass(frozen=True)
class ResultWriter:
    """How results are written: the languages, the rounding and the units of the job.

    The quantities in ``raised`` ("K_x") carry the footnote ``raised_mark``, those in ``widened``
    ``widened_mark``.
    """

    language: CertificateLanguage
    rounding: Literal["half-even", "up"]
    units: ResultUnits = field(default_factory=ResultUnits)
    raised: tuple[str, ...] = ()
    raised_mark: str = ""
    widened: tuple[str, ...] = ()
    widened_mark: str = ""

    def words(self, words: Words) -> Label:
        """Our own wording."""
        return label(words, self.language)

    def pair(self, value: float, uncertainty: Uncertainty, factor: float = 1.0) -> tuple[Label, Label]:
        """Value and U, both times ``factor``, rounded to the same place and grouped."""
        rounded = round_to_uncertainty(
            without_noise(value * factor), without_noise(uncertainty.expanded * factor), self.rounding
        )
        return same(format_grouped(rounded.value)), same(format_grouped(rounded.expanded))

    def quantity(self, words: Words, letter: str, index: str) -> Label:
        """Annex C's words with the symbol; with the footnote where U was raised or is from the trials."""
        name = self.words(words)
        key = f"{letter}_{index}"
        mark = (Run(self.raised_mark, "sup"),) if key in self.raised else self.widened_of(key)
        return Label(joined(name.main, mark, "  ", symbol(letter, index)), name.second)

    def widened_of(self, key: str) -> RichText:
        """The footnote's mark where U of ``key`` is from the trials."""
        return (Run(self.widened_mark, "sup"),) if key in self.widened else ()

    def missing(self, name: Label, columns: int) -> tuple[Label, ...]:
        """The row of a quantity that was not calibrated."""
        return (name, self.words(wording.NOT_CALIBRATED), *[same(DASH)] * (columns - 2))

    def column(self, words: Words, unit: RichText | str = (), *, strong: bool = False) -> Column:
        """A column of numbers."""
        return Column(self.words(words), plain(unit) if isinstance(unit, str) else unit, "right", strong)

    def marked(self, words: Words, mark: str) -> Column:
        """The quantities' column, with footnote marks."""
        name = self.words(words)
        return Column(Label(joined(name.main, (Run(mark, "sup"),)), name.second))


def _k(uncertainty: Uncertainty) -> Label:
    return same(f"{uncertainty.coverage_factor:.2f}")


def rate_range(result: ScaleFactorResult) -> str:
    """The span of the rates, ``±300 °/s`` or ``−100 … 300 °/s``."""
    low, high = min(result.demanded_rates_dps), max(result.demanded_rates_dps)
    if math.isclose(-low, high, rel_tol=1e-6):
        return f"±{format_grouped(f'{high:g}')} °/s"
    return f"{format_grouped(f'{low:g}')} … {format_grouped(f'{high:g}')} °/s"


def scale_factor_table(results: Mapping[AxisName, ScaleFactorResult], writer: ResultWriter) -> Table:
    """C.1, 1: K_x, K_y, K_z; where the job asks for ppm the deviation from 1 beside them."""
    deviation = writer.units.scale_factor == "ppm"
    million = joined("10", (Run("−6", "sup"),))
    units = {result.unit for result in results.values()}
    unit = unit_text(units.pop()) if len(units) == 1 else ()
    columns = (
        Column(writer.words(wording.QUANTITY)),
        writer.column(wording.VALUE, unit, strong=True),
        writer.column(wording.EXPANDED_SHORT if deviation else wording.EXPANDED, unit),
        *((writer.column(conformity_wording.DEVIATION, million, strong=True),) if deviation else ()),
        *((writer.column(wording.EXPANDED_SHORT, million),) if deviation else ()),
        writer.column(wording.COVERAGE),
        writer.column(wording.RANGE),
    )
    rows = []
    for axis in AXES:
        name = writer.quantity(wording.SCALE_FACTOR_NAMES[axis], "K", axis)
        result = results.get(axis)
        if result is None:
            rows.append(writer.missing(name, len(columns)))
            continue
        value, expanded = writer.pair(result.K, result.uncertainty)
        if not unit:
            value = Label(joined(value.main, " ", unit_text(result.unit)))
        cells = [name, value, expanded]
        if deviation:
            cells += writer.pair(result.K - 1.0, result.uncertainty, 1e6)
        rows.append((*cells, _k(result.uncertainty), same(rate_range(result))))
    return Table(columns, tuple(rows))


def zero_offset_table(results: Mapping[AxisName, ZeroOffsetResult], writer: ResultWriter) -> Table:
    """C.1, 2: heading, pitch, roll zero offset, °/s and °/h or as chosen; where known, the repeatability
    beside them."""
    chosen = writer.units.zero_offset
    units = [_OFFSET_UNITS[chosen]] if chosen else list(_OFFSET_UNITS.values())
    repeatable = any(result.repeatability_dps is not None for result in results.values())
    columns = [
        writer.marked(wording.QUANTITY, "2"),
        *(
            column
            for unit, _ in units
            for column in (
                writer.column(wording.VALUE, unit, strong=True),
                writer.column(wording.EXPANDED_SHORT, unit),
            )
        ),
        writer.column(wording.COVERAGE),
    ]
    if repeatable:
        columns.append(writer.column(wording.REPEATABILITY, units[-1][0]))
    rows = []
    for axis in AXES:
        name = writer.quantity(wording.ZERO_OFFSET_NAMES[axis], "B", axis)
        result = results.get(axis)
        if result is None:
            rows.append(writer.missing(name, len(columns)))
            continue
        row = [name]
        for _, factor in units:
            row += writer.pair(result.B, result.uncertainty, factor)
        row.append(_k(result.uncertainty))
        if repeatable:
            known = result.repeatability_dps
            row.append(same(DASH if known is None else significant(known * units[-1][1])))
        rows.append(tuple(row))
    return Table(tuple(columns), tuple(rows))


def misalignment_table(results: Mapping[str, MisalignmentResult], writer: ResultWriter) -> Table:
    """C.1, 3: six misalignments as ratio (rad), ′ and °, or in the unit chosen."""
    chosen = writer.units.misalignment
    units = [_ANGLE_UNITS[key] for key in ((chosen,) if chosen else ("rad", "arcmin"))]
    columns = [writer.marked(wording.QUANTITY, "1, 2, 3")]
    for unit, _ in units:
        columns.append(writer.column(wording.VALUE, unit, strong=True))
        columns.append(writer.column(wording.EXPANDED_SHORT, unit))
    if not chosen:
        columns.append(writer.column(wording.VALUE, "°"))
    columns.append(writer.column(wording.COVERAGE))
    rows = []
    for key in MISALIGNMENT_KEYS:
        name = writer.quantity(wording.MISALIGNMENT_NAMES[key], "L", key)
        result = results.get(key)
        if result is None:
            rows.append(writer.missing(name, len(columns)))
            continue
        cells = [name]
        for _, factor in units:
            cells += writer.pair(result.L, result.uncertainty, factor)
        if not chosen:
            cells.append(writer.pair(result.L, result.uncertainty, DEGREE)[0])
        rows.append((*cells, _k(result.uncertainty)))
    return Table(tuple(columns), tuple(rows))


def linearity_table(results: Mapping[AxisName, ScaleFactorResult], writer: ResultWriter) -> Table:
    """Usual for gyros and beyond the standard: nonlinearity, asymmetry, fitted zero."""
    million = joined("10", (Run("−6", "sup"),))
    columns = (
        Column(writer.words(wording.AXIS)),
        writer.column(wording.NONLINEARITY, million),
        writer.column(wording.ASYMMETRY, million),
        writer.column(wording.ASYMMETRY_U, million),
        writer.column(wording.FITTED_ZERO),
        writer.column(wording.COVERAGE),
    )
    rows = tuple(
        (
            same(joined(axis.upper(), writer.widened_of(f"F0_{axis}"))),
            same(significant(result.nonlinearity_ppm)),
            *_asymmetry(result, writer),
            *_fitted_zero(result, writer),
        )
        for axis, result in results.items()
    )
    return Table(columns, rows)


def _asymmetry(result: ScaleFactorResult, writer: ResultWriter) -> tuple[Label, Label]:
    """The value to the place of its standard uncertainty, and that; without it two digits."""
    standard = asymmetry_standard_ppm(result.rates_dps, result.K, result.standard_errors)
    if not standard:
        return same(significant(result.asymmetry_ppm)), same(DASH)
    rounded = round_to_uncertainty(
        without_noise(result.asymmetry_ppm), without_noise(standard), writer.rounding
    )
    return same(format_grouped(rounded.value)), same(format_grouped(rounded.expanded))


def _fitted_zero(result: ScaleFactorResult, writer: ResultWriter) -> tuple[Label, Label]:
    """F₀ ± U in the device's unit, rounded together, and k; two digits where there is no budget of it."""
    unit = unit_text(result.unit.split("/(deg/s)")[0].strip("()") if result.unit != "1" else "°/s")
    stated = result.F0_uncertainty
    if stated is None:
        return Label(joined(significant(result.F0), " ", unit)), same(DASH)
    value, expanded = writer.pair(result.F0, stated)
    return Label(joined("(", value.main, " ± ", expanded.main, ") ", unit)), _k(stated)


def budget_table(
    names: Mapping[str, tuple[RichText, RichText]],
    uncertainties: Mapping[str, Uncertainty],
    factor: Mapping[str, float],
    marks: Mapping[str, str],
    writer: ResultWriter,
) -> Table:
    """Contributions of every source to the quantities of one kind, one column each.

    ``names``: the head of each column and its unit, to which ``factor`` scales a quantity's contribution. A
    source that a certificate states carries that one's mark of ``marks`` (:func:`certificates_of`), an
    assumption a star.
    """
    sources: dict[tuple[str, ...], tuple[Label, str]] = {}
    for uncertainty in uncertainties.values():
        for row in uncertainty.rows:
            sources.setdefault(_source(row), (_source_name(row, marks, writer), row.kind))
    columns = (
        Column(writer.words(wording.SOURCE)),
        Column(writer.words(wording.KIND)),
        *(Column(Label(names[key][0]), names[key][1], "right") for key in uncertainties),
    )
    rows = []
    for source, (name, kind) in sources.items():
        cells = []
        for key, uncertainty in uncertainties.items():
            parts = [r.contribution for r in uncertainty.rows if _source(r) == source]
            total = uncertainty.standard * factor[key]
            cells.append(same(contribution(math.hypot(*parts) * factor[key], total) if parts else DASH))
        rows.append((name, same(kind), *cells))
    rows.append(
        (
            writer.words(wording.COMBINED),
            EMPTY,
            *(same(significant(u.standard * factor[key])) for key, u in uncertainties.items()),
        )
    )
    rows.append((writer.words(wording.COVERAGE_FACTOR), EMPTY, *(_k(u) for u in uncertainties.values())))
    rows.append(
        (
            writer.words(wording.EXPANDED_UNCERTAINTY),
            EMPTY,
            *(writer.pair(0.0, u, factor[key])[1] for key, u in uncertainties.items()),
        )
    )
    return Table(columns, tuple(rows), size=7.5, summary_rows=3)


def _source(row: BudgetRow) -> tuple[str, ...]:
    """Rows of the same source stand in one line; each band of the table's rate is a source of its own."""
    band = str(row.source.params.get("band", ""))
    return row.symbol, row.source.template, band, row.origin, row.certificate


def _source_name(row: BudgetRow, marks: Mapping[str, str], writer: ResultWriter) -> Label:
    name = writer.words(Words(row.source.text("zh"), row.source.text("en")))
    if row.origin == "assumption":
        return Label(joined(name.main, " *"), name.second)
    mark = marks.get(row.certificate, "")
    return Label(joined(name.main, (Run(f" {mark})", "sup"),)), name.second) if mark else name


def certificates_of(result: CalibrationResult) -> dict[str, str]:
    """The certificates that state figures of the budgets, each with the letter that marks its rows."""
    budgets = [one.uncertainty for one in result.scale_factor.values()]
    budgets += [one.uncertainty for one in result.zero_offset.values()]
    budgets += [one.uncertainty for one in result.misalignment.values()]
    numbers = dict.fromkeys(row.certificate for one in budgets for row in one.rows if row.certificate)
    return dict(zip(numbers, ascii_lowercase, strict=False))


def methods_of(result: CalibrationResult) -> set[str]:
    """The methods by which the uncertainties of ``result`` were evaluated."""
    methods: set[str] = {one.uncertainty.method for one in result.scale_factor.values()}
    methods |= {one.uncertainty.method for one in result.zero_offset.values()}
    return methods | {one.uncertainty.method for one in result.misalignment.values()}
