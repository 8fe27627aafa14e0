"""L of the two other outputs about each turned axis, from its turns in both senses (7.3)."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import partial

from ahrs_lab.messages import Message
from ahrs_lab.metrology.misalignment import misalignment
from ahrs_lab.metrology.result import (
    MISALIGNMENT_KEYS,
    MisalignmentResult,
    ResultWarning,
    ScaleFactorResult,
)
from ahrs_lab.metrology.uncertainty.fitted_scale import UNSCALED, FittedScale
from ahrs_lab.metrology.uncertainty.full_misalignment import misalignment_model
from ahrs_lab.metrology.uncertainty.full_model import check_by_monte_carlo
from ahrs_lab.metrology.uncertainty.gum_misalignment import MisalignmentEvidence, misalignment_uncertainty
from ahrs_lab.procedures.reduction_evidence import Evidence
from ahrs_lab.procedures.reduction_output import degrees_factor
from ahrs_lab.procedures.reduction_selection import Take, left_out, names
from ahrs_lab.recording.orientation import AXES, Axis

MOST_MISALIGNED = 0.5
"""|L| from which output and axis are mixed up, rad: a small angle is what 7.3 is made for."""


def reduce_misalignments(
    evidence: Evidence, scale_factors: Mapping[Axis, ScaleFactorResult]
) -> tuple[dict[str, MisalignmentResult], list[ResultWarning]]:
    """Every L_ij that the recording holds, by its two letters."""
    found: dict[str, MisalignmentResult] = {}
    warnings: list[ResultWarning] = []
    for turned in AXES:
        takes = evidence.selection.of("misalignment", turned)
        lacking = ("misalignment", turned) in evidence.selection.lacking
        if not takes and not lacking:
            continue
        positive = [take for take in takes if (take.segment.turns or 0) > 0]
        negative = [take for take in takes if (take.segment.turns or 0) < 0]
        missing = Message("segments are missing, see the other warnings.")
        reason = missing if lacking else _unfit(positive, negative)
        if reason is not None:
            warnings.append(left_out(Message("misalignment about"), turned, reason))
            continue
        warnings += _unequal_durations(turned, positive, negative)
        for output in AXES:
            if output == turned:
                continue
            scale = _scale(output, positive[0].output.unit, scale_factors)
            if scale is None:
                needs_K = Message("its counts need the fitted scale factor, which is not there.")
                warnings.append(left_out(Message("misalignment"), output + turned, needs_K))
                continue
            result = _result(evidence, output, turned, positive, negative, scale)
            if abs(result.L) >= MOST_MISALIGNED:
                too_large = Message(
                    "it would be {L} rad: check which axis of the case each output belongs to.",
                    L=round(result.L, 3),
                )
                warnings.append(left_out(Message("misalignment"), output + turned, too_large))
                continue
            found[output + turned] = result
    return {key: found[key] for key in MISALIGNMENT_KEYS if key in found}, warnings


def _unfit(positive: Sequence[Take], negative: Sequence[Take]) -> Message | None:
    """Why (17) cannot be formed, None where it can."""
    if not positive or not negative:
        return Message("no usable turns in one of the senses are left.")
    counts = {abs(take.segment.turns or 0) for take in (*positive, *negative)}
    if len(counts) != 1:
        return Message(
            "the recordings have different numbers of turns ({counts}): (17) needs the same in both senses.",
            counts=", ".join(str(count) for count in sorted(counts)),
        )
    return None


def _duration(takes: Sequence[Take]) -> float:
    return sum(take.output.duration_s for take in takes) / len(takes)


def _unequal_durations(
    turned: Axis, positive: Sequence[Take], negative: Sequence[Take]
) -> list[ResultWarning]:
    difference = _duration(positive) - _duration(negative)
    if abs(difference) <= 1.5 * positive[0].output.step_s:
        return []
    return [
        ResultWarning(
            Message(
                "misalignment about {axis}: the recordings of the two senses differ by {difference} s; a "
                "constant zero "
                "offset does not cancel by that much.",
                axis=turned,
                difference=round(difference, 3),
            ),
            negative[0].segment.file,
        )
    ]


def _scale(
    output: Axis, unit: str, scale_factors: Mapping[Axis, ScaleFactorResult]
) -> tuple[float, FittedScale] | None:
    """Factor to °/s and what it rests on; None for counts without a fitted K."""
    factor = degrees_factor(unit)
    if factor is not None:
        return factor, UNSCALED
    K = scale_factors.get(output)
    return None if K is None or K.K == 0.0 else (1.0 / K.K, FittedScale.of(K.K, K.uncertainty))


def _result(
    evidence: Evidence,
    output: Axis,
    turned: Axis,
    positive: Sequence[Take],
    negative: Sequence[Take],
    scale: tuple[float, FittedScale],
) -> MisalignmentResult:
    factor, fitted = scale
    turns = abs(positive[0].segment.turns or 0)
    angle_positive, angle_negative = (
        factor * sum(take.output.turned_angle(output) for take in takes) / len(takes)
        for takes in (positive, negative)
    )
    L = misalignment(angle_positive, angle_negative, turns)
    duration = _duration(positive)
    recorded = MisalignmentEvidence(
        turns=turns,
        angle_positive_deg=angle_positive,
        angle_negative_deg=angle_negative,
        duration_positive_s=duration,
        duration_negative_s=_duration(negative),
        starts_s=(positive[0].start_s, negative[0].start_s),
        repeats=min(len(positive), len(negative)),
        samples=positive[0].output.samples,
        resolution=evidence.resolution[output].scaled(factor),
        noise=evidence.noise[output].scaled(factor),
        # what both recordings show alike: zero offset and Earth's rate
        rest_rate_dps=0.5 * (angle_positive + angle_negative) / duration,
        scale=fitted,
    )
    budget = misalignment_uncertainty(L, recorded, evidence.capability)
    rate = abs(positive[0].segment.rate_dps)
    if evidence.method == "annex-a":
        repeated = [row.contribution for row in budget.rows if row.symbol in ("N⁺", "N⁻")]
        budget = evidence.annex_a(L, "rad", rate, evidence.acquisition_bits(output), repeated)
    else:
        model = partial(misalignment_model, L, recorded, budget)
        budget = check_by_monte_carlo(budget, L, model, evidence.monte_carlo, f"L_{output}{turned}")
    return MisalignmentResult(
        output_axis=output,
        turned_axis=turned,
        L=L,
        turns=turns,
        angle_positive_deg=angle_positive,
        angle_negative_deg=angle_negative,
        uncertainty=budget,
        rate_dps=rate,
        duration_s=duration,
        segments=names((*positive, *negative)),
    )
