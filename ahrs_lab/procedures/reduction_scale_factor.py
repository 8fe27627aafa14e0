"""K and F₀ of one axis from its segments (7.1)."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial

import numpy as np

from ahrs_lab.errors import InputError
from ahrs_lab.messages import Message
from ahrs_lab.metrology.conditions import AVERAGING_ANGLES_DEG, rate_band
from ahrs_lab.metrology.result import ResultWarning, ScaleFactorResult
from ahrs_lab.metrology.scale_factor import fit_scale_factor
from ahrs_lab.metrology.uncertainty.full_model import check_by_monte_carlo
from ahrs_lab.metrology.uncertainty.full_scale_factor import offset_model, scale_factor_model
from ahrs_lab.metrology.uncertainty.gum_scale_factor import ScaleFactorEvidence, scale_factor_uncertainty
from ahrs_lab.metrology.uncertainty.noise import standard_error
from ahrs_lab.procedures.reduction_evidence import Evidence, axis_batches
from ahrs_lab.procedures.reduction_output import table_rate
from ahrs_lab.procedures.reduction_selection import Take, left_out, names
from ahrs_lab.recording.orientation import AXES, Axis

FEWEST_RATES = 7


@dataclass(frozen=True)
class _Mean:
    """Mean of several recordings of the same thing, with its standard error."""

    value: float
    error: float
    dof: float
    duration_s: float
    start_s: float


def scale_factor_unit(device_unit: str) -> str:
    """Unit of K as the result names it."""
    return "LSB/(deg/s)" if device_unit == "LSB" else f"({device_unit})/(deg/s)"


def reduce_scale_factor(
    evidence: Evidence, axis: Axis
) -> tuple[ScaleFactorResult | None, list[ResultWarning]]:
    """The axis's scale factor, None where nothing was recorded for it or the standard's minimum is missed.

    Raises InputError where the table's rates are asked for and its angle was not recorded.
    """
    takes = evidence.selection.of("scale_factor", axis)
    lacking = ("scale_factor", axis) in evidence.selection.lacking
    if not takes and not lacking:
        return None, []
    groups = _Groups(
        at_rates=tuple(take for take in takes if take.segment.role == "rate"),
        before=tuple(take for take in takes if take.segment.role == "static_before"),
        after=tuple(take for take in takes if take.segment.role == "static_after"),
    )
    missing = Message("segments are missing, see the other warnings.")
    reason = missing if lacking else _unfit(groups) or _shown_elsewhere(groups, axis)
    if reason is not None:
        return None, [left_out(Message("scale factor"), axis, reason)]
    warnings = [warning for take in groups.at_rates if (warning := _part_of_a_turn(take)) is not None]
    return _result(evidence, axis, groups), warnings


@dataclass(frozen=True)
class _Groups:
    """The takes of one axis by their role."""

    at_rates: tuple[Take, ...]
    before: tuple[Take, ...]
    after: tuple[Take, ...]

    @property
    def demanded(self) -> list[float]:
        return [take.segment.rate_dps for take in self.at_rates]


def _unfit(groups: _Groups) -> Message | None:
    """Why (11) to (15) cannot be formed, None where they can."""
    if not groups.before or not groups.after:
        return Message("no usable recording at rest before or after the rates is left.")
    rates = set(groups.demanded)
    if len(rates) < FEWEST_RATES or max(rates) <= 0.0 or min(rates) >= 0.0:
        return Message.counted(
            len(rates),
            Message(
                "1 usable rate is left, the standard asks for {fewest} or more in both senses.",
                fewest=FEWEST_RATES,
            ),
            Message(
                "{count} usable rates are left, the standard asks for {fewest} or more in both senses.",
                count=len(rates),
                fewest=FEWEST_RATES,
            ),
        )
    return None


def _shown_elsewhere(groups: _Groups, axis: Axis) -> Message | None:
    """The output that shows the turns more than the axis's own does: cables, axes or units are mixed up."""
    rates = np.array(groups.demanded)
    centred = rates - rates.mean()
    shown = {
        other: abs(float(centred @ [take.output.mean(other) for take in groups.at_rates])) for other in AXES
    }
    most = max(AXES, key=lambda other: (shown[other], other == axis))
    if most == axis:
        return None
    return Message(
        "the turns about it show on output {other} more than on its own: check which axis of the case each "
        "output belongs to.",
        other=most.upper(),
    )


def _rates(evidence: Evidence, groups: _Groups) -> list[float]:
    """The Ω_j, °/s."""
    if evidence.rate_source == "demanded":
        return groups.demanded
    found = []
    for take in groups.at_rates:
        rate = table_rate(take.samples, take.segment.rate_dps)
        if rate is None:
            raise InputError(
                "{file}: the table's angle was not recorded (table_angle_deg): evaluate with demanded rates.",
                file=take.segment.file,
            )
        found.append(rate)
    return found


def _result(evidence: Evidence, axis: Axis, groups: _Groups) -> ScaleFactorResult:
    rates = _rates(evidence, groups)
    means = [_mean(evidence, [take], axis) for take in groups.at_rates]
    rest = _mean(evidence, groups.before, axis), _mean(evidence, groups.after, axis)
    fit = fit_scale_factor(rates, [mean.value for mean in means], rest[0].value, rest[1].value)
    output = groups.at_rates[0].output
    budget, budget_F0 = scale_factor_uncertainty(
        fit,
        _budget_input(evidence, axis, groups, means, rest),
        evidence.capability,
        device_unit=output.unit,
        rate_source=evidence.rate_source,
        time_scaled=output.source != "rate",
    )
    unit = scale_factor_unit(output.unit)
    budget_F0 = check_by_monte_carlo(
        budget_F0, fit.F0, partial(offset_model, fit, budget_F0), evidence.monte_carlo, f"F0_{axis}"
    )
    if evidence.method == "annex-a":
        fastest = max(abs(rate) for rate in rates)
        scatter = math.sqrt(sum(row.contribution**2 for row in budget.rows if row.kind == "A"))
        budget = evidence.annex_a(fit.K, unit, fastest, evidence.acquisition_bits(axis), [scatter])
    else:
        budget = check_by_monte_carlo(
            budget, fit.K, partial(scale_factor_model, fit, budget), evidence.monte_carlo, f"K_{axis}"
        )
    return ScaleFactorResult(
        axis=axis,
        K=fit.K,
        F0=fit.F0,
        unit=unit,
        rates_dps=tuple(rates),
        demanded_rates_dps=tuple(groups.demanded),
        means=tuple(mean.value for mean in means),
        residuals=fit.residuals,
        static_before=rest[0].value,
        static_after=rest[1].value,
        nonlinearity_ppm=fit.nonlinearity_ppm,
        asymmetry_ppm=fit.asymmetry_ppm,
        uncertainty=budget,
        rate_source=evidence.rate_source,
        segments=names((*groups.before, *groups.at_rates, *groups.after)),
        standard_errors=tuple(mean.error for mean in means),
        F0_uncertainty=budget_F0,
    )


def _budget_input(
    evidence: Evidence, axis: Axis, groups: _Groups, means: Sequence[_Mean], rest: tuple[_Mean, _Mean]
) -> ScaleFactorEvidence:
    before, after = rest
    return ScaleFactorEvidence(
        standard_errors=np.array([mean.error for mean in means]),
        dofs=np.array([mean.dof for mean in means]),
        durations_s=np.array([mean.duration_s for mean in means]),
        starts_s=np.array([mean.start_s for mean in means]),
        rest_standard_errors=(before.error, after.error),
        rest_dofs=(before.dof, after.dof),
        rest_durations_s=(before.duration_s, after.duration_s),
        rest_starts_s=(before.start_s, after.start_s),
        rest_samples=(samples_of(groups.before), samples_of(groups.after)),
        samples=np.array([float(take.output.samples) for take in groups.at_rates]),
        resolution=evidence.resolution[axis],
        noise=evidence.noise[axis],
        latitude_deg=evidence.site.latitude_deg,
    )


def samples_of(takes: Sequence[Take]) -> float:
    """In all of them."""
    return float(sum(take.output.samples for take in takes))


def _mean(evidence: Evidence, takes: Sequence[Take], axis: Axis) -> _Mean:
    """(10) for one recording; of several the mean of their means."""
    noise = evidence.noise[axis]
    errors = [
        standard_error(axis_batches(take.output, axis)[0], noise.inflation(take.output.duration_s))
        for take in takes
    ]
    count = len(takes)
    return _Mean(
        value=sum(take.output.mean(axis) for take in takes) / count,
        error=math.sqrt(sum(error**2 for error, _ in errors)) / count,
        dof=sum(dof for _, dof in errors),
        duration_s=sum(take.output.duration_s for take in takes) / count,
        start_s=sum(take.start_s for take in takes) / count,
    )


def _part_of_a_turn(take: Take) -> ResultWarning | None:
    """Clause 6: the table's rate holds as a mean over whole averaging angles."""
    rate = abs(take.segment.rate_dps)
    whole = AVERAGING_ANGLES_DEG[rate_band(rate)]
    turned = rate * take.output.duration_s
    off = abs(turned - whole * round(turned / whole))
    if turned < whole or off <= 1.5 * rate * take.output.step_s + 1e-9:
        return None  # less than one is already among the recording's findings
    return ResultWarning(
        Message(
            "{turned}° were turned at {rate} °/s: the table's rate is specified as a mean over whole "
            "multiples of {whole}°.",
            turned=round(turned, 3),
            rate=take.segment.rate_dps,
            whole=whole,
        ),
        take.segment.file,
    )
