"""From a recording to the result: the one function that live runs and ``evaluate`` both call."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

import numpy as np

import ahrs_lab
from ahrs_lab.errors import InputError
from ahrs_lab.metrology.conditions import BenchCapability
from ahrs_lab.metrology.figures_json import noted_capability, with_capability
from ahrs_lab.metrology.result import (
    CalibrationResult,
    Method,
    ResultWarning,
    ScaleFactorResult,
)
from ahrs_lab.metrology.uncertainty.full_model import MonteCarloSettings
from ahrs_lab.metrology.uncertainty.monte_carlo import check_trials
from ahrs_lab.procedures.recorded_facts import (
    device_facts,
    noted_deviations,
    noted_environment,
    run_warnings,
    segment_starts,
    set_aside,
    site_facts,
)
from ahrs_lab.procedures.reduction_diagnosis import diagnose
from ahrs_lab.procedures.reduction_evidence import Evidence, RateSource, unknown_resolution
from ahrs_lab.procedures.reduction_misalignment import reduce_misalignments
from ahrs_lab.procedures.reduction_scale_factor import reduce_scale_factor
from ahrs_lab.procedures.reduction_selection import listed, select
from ahrs_lab.procedures.reduction_validation import not_validated
from ahrs_lab.procedures.reduction_zero_offset import reduce_zero_offsets
from ahrs_lab.recording.finding import Finding
from ahrs_lab.recording.orientation import AXES, Axis
from ahrs_lab.recording.read import Recording


def reduce_recording(
    recording: Recording,
    *,
    rates: RateSource = "demanded",
    uncertainty: Method = "gum",
    capability: BenchCapability | None = None,
    software: str | None = None,
    trials: int | None = None,
    repeatability: bool = False,
) -> CalibrationResult:
    """K, B and L with their uncertainties, of whatever the recording holds (JJF 1536 7.1 to 7.3).

    ``rates``: Ω as demanded, or as the table measured it (angle turned over time). ``capability``: the
    bench's figures for the type B terms, by default those that the recording names, else the assumptions of
    :class:`BenchCapability`; the result's notes say which. ``trials``: of the Monte Carlo check of each GUM
    uncertainty; None as many as it needs, 0 without. ``repeatability``: U of B includes what B may be
    another day. The last take of a segment counts. Raises InputError,
    with file and line, where a recorded segment does not reach the standard's minimum or nothing can be
    evaluated; a quantity that lacks segments is left out and named in the warnings.
    """
    figures = capability or noted_capability(recording.header.notes) or BenchCapability()
    if trials:
        check_trials(trials)
    settings = MonteCarloSettings(recording.sha256, trials)
    with np.errstate(over="ignore", invalid="ignore"):
        result = _reduce(recording, rates, uncertainty, figures, software, settings, repeatability)
    _check_finite(result)
    return result


def _reduce(
    recording: Recording,
    rates: RateSource,
    method: Method,
    capability: BenchCapability,
    software: str | None,
    monte_carlo: MonteCarloSettings,
    with_repeatability: bool,
) -> CalibrationResult:
    selection = select(recording)
    header = recording.header
    combined = _schedule(header.notes) == "combined"
    evidence = Evidence(
        selection=selection,
        device=header.device,
        site=header.site,
        rate_source=rates,
        method=method,
        capability=capability,
        monte_carlo=monte_carlo,
        with_repeatability=with_repeatability,
    )
    warnings: list[ResultWarning] = [*selection.warnings, *run_warnings(recording)]
    scale_factors: dict[Axis, ScaleFactorResult] = {}
    for axis in AXES:
        scale_factor, said = reduce_scale_factor(evidence, axis)
        warnings += said
        if scale_factor is not None:
            scale_factors[axis] = scale_factor
    misalignments, said = reduce_misalignments(evidence, scale_factors)
    zero_offsets, of_B = reduce_zero_offsets(evidence, scale_factors, misalignments, combined=combined)
    warnings += [*of_B, *said]
    if not scale_factors and not zero_offsets and not misalignments:
        raise _nothing(warnings)
    warnings += unknown_resolution(evidence, scale_factors, zero_offsets, misalignments)
    diagnosis, said = diagnose(evidence, scale_factors, zero_offsets, misalignments)
    warnings += said
    warnings += not_validated(scale_factors, zero_offsets, misalignments)
    return CalibrationResult(
        procedure=header.procedure,
        bundle_sha256=recording.sha256,
        software=software or f"ahrs-lab {ahrs_lab.__version__}",
        scale_factor=scale_factors,
        zero_offset=zero_offsets,
        misalignment=misalignments,
        warnings=tuple(warnings),
        deviations=noted_deviations(header.notes),
        environment=noted_environment(header.notes),
        device=device_facts(header),
        site=site_facts(header),
        notes=with_capability(
            {**header.notes, **set_aside(recording), **segment_starts(recording)}, capability
        ),
        simulated=header.notes.get("simulated") is True,
        diagnosis=diagnosis,
    )


def _check_finite(result: CalibrationResult) -> None:
    """Cells may hold numbers so large that their sums are none."""
    values = [
        *((f"K_{axis}", found.K, found.uncertainty) for axis, found in result.scale_factor.items()),
        *((f"B_{axis}", found.B, found.uncertainty) for axis, found in result.zero_offset.items()),
        *((f"L_{key}", found.L, found.uncertainty) for key, found in result.misalignment.items()),
    ]
    for symbol, value, stated in values:
        if not math.isfinite(value) or not math.isfinite(stated.expanded):
            raise InputError(
                "{symbol} is not a finite number: some values in its segments are too large. Check the "
                "columns gyro_x, gyro_y, gyro_z.",
                symbol=symbol,
            )


def _nothing(warnings: list[ResultWarning]) -> InputError:
    reasons = [Finding(warning.what, warning.segment, warning.line).placed for warning in warnings]
    if not reasons:
        return InputError(
            "The recording holds no segment that is evaluated by JJF 1536: check item, axis and role."
        )
    return InputError("Nothing in the recording can be evaluated. {reasons}", reasons=listed(reasons))


def _schedule(notes: Mapping[str, Any]) -> str:
    plan = notes.get("plan")
    zero_offset = plan.get("zero_offset") if isinstance(plan, Mapping) else None
    schedule = zero_offset.get("schedule") if isinstance(zero_offset, Mapping) else None
    return schedule if isinstance(schedule, str) else "standard"
