"""Uncertainties as JSON and back: budget, correlations, Monte Carlo check. Infinite degrees of freedom are
null."""

from __future__ import annotations

import math
from dataclasses import asdict, replace
from typing import Any, get_args

from ahrs_lab.messages import Message
from ahrs_lab.metrology.json_reader import JsonReader, message_from_json
from ahrs_lab.metrology.result import (
    BudgetRow,
    Correlation,
    Distribution,
    Method,
    MonteCarloCheck,
    Origin,
    Uncertainty,
)


def uncertainty_json(found: Uncertainty) -> dict[str, Any]:
    """The keys of one uncertainty, beside the quantity's own."""
    return {
        "standard_uncertainty": found.standard,
        "expanded_uncertainty": found.expanded,
        "coverage_factor": found.coverage_factor,
        "dof": _dof(found.dof),
        "method": found.method,
        "budget": [_row(row) for row in found.rows],
        "correlations": [asdict(entry) for entry in found.correlations],
        "monte_carlo": None if found.monte_carlo is None else _monte_carlo(found.monte_carlo),
        "from_monte_carlo": found.from_monte_carlo,
    }


def read_uncertainty(reader: JsonReader) -> Uncertainty:
    """The inverse of :func:`uncertainty_json`; raises InputError that names the key at fault."""
    rows = tuple(_read_row(entry) for entry in reader.objects("budget"))
    return Uncertainty(
        standard=reader.number("standard_uncertainty"),
        expanded=reader.number("expanded_uncertainty"),
        coverage_factor=reader.number("coverage_factor"),
        dof=reader.dof("dof"),
        method=reader.choice("method", get_args(Method), "gum"),
        rows=rows,
        correlations=_read_correlations(reader, len(rows)),
        monte_carlo=_read_monte_carlo(reader.object("monte_carlo")) if reader.has("monte_carlo") else None,
        from_monte_carlo=reader.has("from_monte_carlo") and reader.value("from_monte_carlo") is True,
    )


def _read_correlations(reader: JsonReader, rows: int) -> tuple[Correlation, ...]:
    if not reader.has("correlations"):
        return ()
    found = []
    for entry in reader.objects("correlations"):
        correlation = Correlation(entry.whole("first"), entry.whole("second"), entry.number("coefficient"))
        if not (
            0
            <= min(correlation.first, correlation.second)
            <= max(correlation.first, correlation.second)
            < rows
        ):
            raise entry.fault("first", Message("the place of a row in the budget"))
        found.append(correlation)
    return tuple(found)


def _monte_carlo(found: MonteCarloCheck) -> dict[str, Any]:
    return {
        "trials": found.trials,
        "seed": found.seed,
        "mean": found.mean,
        "standard_uncertainty": found.standard,
        "symmetric_interval": list(found.symmetric),
        "shortest_interval": list(found.shortest),
        "significant_digits": found.digits,
        "tolerance": found.tolerance,
        "validated": found.validated,
        "histogram": {"from": found.bins[0], "to": found.bins[1], "counts": list(found.counts)},
        "gum_expanded_uncertainty": found.gum_expanded,
    }


def _read_monte_carlo(reader: JsonReader) -> MonteCarloCheck:
    histogram = reader.object("histogram")
    return MonteCarloCheck(
        trials=reader.whole("trials"),
        seed=reader.whole("seed"),
        mean=reader.number("mean"),
        standard=reader.optional_number("standard_uncertainty"),
        symmetric=_interval(reader, "symmetric_interval"),
        shortest=_interval(reader, "shortest_interval"),
        digits=reader.whole("significant_digits"),
        tolerance=reader.number("tolerance"),
        validated=reader.value("validated") is True,
        bins=(histogram.number("from"), histogram.number("to")),
        counts=tuple(int(count) for count in histogram.numbers("counts")),
        gum_expanded=reader.optional_number("gum_expanded_uncertainty"),
    )


def _interval(reader: JsonReader, name: str) -> tuple[float, float]:
    ends = reader.numbers(name)
    if len(ends) != 2:
        raise reader.fault(name, Message("two numbers"))
    return ends[0], ends[1]


def _row(row: BudgetRow) -> dict[str, Any]:
    return {
        "symbol": row.symbol,
        "source": row.source.text(),
        "message": row.source.to_json(),
        "unit": row.unit,
        "standard_uncertainty": row.standard_uncertainty,
        "sensitivity": row.sensitivity,
        "contribution": row.contribution,
        "kind": row.kind,
        "distribution": row.distribution,
        "divisor": row.divisor,
        "dof": _dof(row.dof),
        "origin": row.origin,
        "estimate": row.estimate,
        "half_width": row.half_width,
        "shared": row.shared,
        "certificate": row.certificate,
    }


def _read_row(reader: JsonReader) -> BudgetRow:
    """A row of earlier releases that names no certificate by its number is an assumption."""
    row = BudgetRow(
        symbol=reader.text("symbol"),
        source=message_from_json(reader.value("message"), reader.key("message")),
        unit=reader.text("unit"),
        standard_uncertainty=reader.number("standard_uncertainty"),
        sensitivity=reader.number("sensitivity"),
        contribution=reader.number("contribution"),
        kind=reader.choice("kind", ("A", "B")),
        distribution=reader.choice("distribution", get_args(Distribution)),
        divisor=reader.number("divisor"),
        dof=reader.dof("dof"),
        origin=reader.choice("origin", get_args(Origin)),
        estimate=reader.optional_number("estimate"),
        half_width=reader.optional_number("half_width"),
        shared=reader.text("shared") if reader.has("shared") else "",
        certificate=reader.text("certificate") if reader.has("certificate") else "",
    )
    unnamed = row.origin == "certificate" and not row.certificate.strip()
    return replace(row, origin="assumption", certificate="") if unnamed else row


def _dof(dof: float) -> float | None:
    return dof if math.isfinite(dof) else None
