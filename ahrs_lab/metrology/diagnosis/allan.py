"""Overlapping Allan deviation pooled over recordings, and where T lies on it (IEEE 952, NIST SP 1065)."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
import scipy
from numpy.typing import NDArray

from ahrs_lab.messages import Message
from ahrs_lab.metrology.diagnosis.model import AllanDiagnosis, DiagnosisFinding, FloorVerdict
from ahrs_lab.metrology.diagnosis.words import figures
from ahrs_lab.metrology.uncertainty.noise import FLICKER_SQUARED, NoiseModel

Array = NDArray[np.float64]

CONFIDENCE = 0.95
DOMINATES = 2.0
"""Ratio of variances from which one term of the noise dominates the other at T."""
SHORTEST_S = 120.0
"""A position shorter than that does not show a floor: the fit needs five octaves, and more than one
difference in the longest."""
_DPH = 3600.0


def running_sum(rates: Array) -> Array:
    """Shape (n + 1,): the phase of SP 1065, of means over equal adjoining intervals, shape (n,)."""
    # the mean is taken out so that the sum stays small: an offset does not enter anyway
    return np.concatenate(([0.0], np.cumsum(rates - rates.mean())))


def pooled_overlapping(sums: Sequence[Array], factor: int) -> float:
    """Overlapping Allan variance over averages of ``factor`` values, pooled over the second differences of
    recordings with equal intervals, each as its :func:`running_sum`; 0 where all are too short."""
    total, count = 0.0, 0
    for phase in sums:
        if len(phase) > 2 * factor:
            second = phase[2 * factor :] - 2.0 * phase[factor:-factor] + phase[: -2 * factor]
            total += float(second @ second)
            count += len(second)
    return total / (2.0 * count * factor**2) if count else 0.0


def equivalent_dof(points: int, factor: int, noise: str) -> float:
    """Degrees of freedom of one overlapping estimate from ``points`` values of the rate (SP 1065, table 5).

    ``noise``: white, flicker or walk (of the rate: white, flicker and random walk FM there).
    """
    n, m = float(points + 1), float(factor)  # the table counts values of the phase
    if noise == "white":
        dof = (3.0 * (n - 1.0) / (2.0 * m) - 2.0 * (n - 2.0) / n) * 4.0 * m**2 / (4.0 * m**2 + 5.0)
    elif noise == "flicker":
        dof = (
            2.0 * (n - 2.0) ** 2 / (2.3 * n - 4.9) if factor == 1 else 5.0 * n**2 / (4.0 * m * (n + 3.0 * m))
        )
    else:
        whole = (n - 1.0) ** 2 - 3.0 * m * (n - 1.0) + 4.0 * m**2
        dof = (n - 2.0) / m * whole / (n - 3.0) ** 2 if n > 3.0 else 1.0
    return max(1.0, dof)


def confidence_limits(variance: float, dof: float) -> tuple[float, float]:
    """Of the deviation, by χ² at 95 %."""
    tail = 0.5 * (1.0 - CONFIDENCE)
    high, low = (2.0 * float(scipy.special.gammaincinv(0.5 * dof, p)) for p in (tail, 1.0 - tail))
    return math.sqrt(variance * dof / low), math.sqrt(variance * dof / high)


def diagnose_allan(
    dwells: Sequence[Array], batch_s: float, noise: NoiseModel, duration_s: float
) -> AllanDiagnosis | None:
    """Octaves of the recordings at the positions (means over ``batch_s``, °/s), with the noise model that the
    budgets use (°/s) and T; None where there is no noise to see."""
    sums = [running_sum(dwell) for dwell in dwells if len(dwell) >= 2]
    longest = max((len(phase) - 1 for phase in sums), default=0)
    factors = [2**octave for octave in range(longest.bit_length()) if 2 * 2**octave <= longest]
    taus = [factor * batch_s for factor in factors]
    variances = [pooled_overlapping(sums, factor) for factor in factors]
    dofs = [_pooled_dof(sums, factor, dominant(noise, factor * batch_s)) for factor in factors]
    if not taus or min(variances) <= 0.0:
        return None
    limits = [confidence_limits(v, dof) for v, dof in zip(variances, dofs, strict=True)]
    model_taus = [*(tau for tau in taus if tau < duration_s), duration_s]
    return AllanDiagnosis(
        taus_s=tuple(taus),
        deviations_dps=tuple(math.sqrt(variance) for variance in variances),
        low_dps=tuple(low for low, _ in limits),
        high_dps=tuple(high for _, high in limits),
        model_taus_s=tuple(model_taus),
        model_dps=tuple(noise.allan_deviation(tau) for tau in model_taus),
        white=noise.white,
        flicker_dps=noise.flicker,
        walk=noise.walk,
        duration_s=duration_s,
        at_duration_dps=noise.allan_deviation(duration_s),
        verdict=floor_verdict(noise, duration_s),
    )


def _pooled_dof(sums: Sequence[Array], factor: int, noise: str) -> float:
    """Of all recordings together; none has more than its differences."""
    points = [len(phase) - 1 for phase in sums if len(phase) > 2 * factor]
    return sum(min(equivalent_dof(n, factor, noise), float(n - 2 * factor + 1)) for n in points)


def _terms(noise: NoiseModel, tau_s: float) -> tuple[float, float, float]:
    """White, flicker and walk part of the Allan variance at τ."""
    return noise.white**2 / tau_s, FLICKER_SQUARED * noise.flicker**2, noise.walk**2 * tau_s / 3.0


def dominant(noise: NoiseModel, tau_s: float) -> str:
    """Which term of the model is the largest at τ."""
    terms = dict(zip(("white", "flicker", "walk"), _terms(noise, tau_s), strict=True))
    return max(terms, key=lambda name: terms[name])


def floor_verdict(noise: NoiseModel, duration_s: float) -> FloorVerdict:
    """Whether white noise at T is above, at or below what drifts, by a factor 2 in variance."""
    if duration_s < SHORTEST_S:
        return "short"
    white, flicker, walk = _terms(noise, duration_s)
    if white >= DOMINATES * (flicker + walk):
        return "before"
    return "past" if DOMINATES * white <= flicker + walk else "at"


def allan_finding(found: AllanDiagnosis) -> DiagnosisFinding:
    """The plain sentence: where T lies, and whether longer positions would help."""
    flicker, walk = FLICKER_SQUARED * found.flicker_dps**2, found.walk**2 * found.duration_s / 3.0
    drift = math.sqrt(flicker + walk)
    numbers = {
        "T": f"{found.duration_s:g}",
        "white": figures(_DPH * found.white / math.sqrt(found.duration_s)),
        "drift": figures(_DPH * drift),
    }
    if found.verdict == "short":
        what = Message(
            "Positions of {T} s are too short to tell where the bias-instability floor lies: the standard "
            "takes 1800 s.",
            T=numbers["T"],
        )
        return DiagnosisFinding("look", what)
    if found.verdict == "before" and drift == 0.0:
        what = Message(
            "At T = {T} s white noise ({white} °/h) dominates and no bias instability is seen: doubling T "
            "would lower it by 1/√2.",
            T=numbers["T"],
            white=numbers["white"],
        )
    elif found.verdict == "before":
        what = Message(
            "At T = {T} s white noise ({white} °/h) still dominates over the bias instability ({drift} °/h): "
            "doubling T would lower it by 1/√2.",
            **numbers,
        )
    elif found.verdict == "at":
        what = Message(
            "At T = {T} s white noise ({white} °/h) and bias instability ({drift} °/h) are about equal: T is "
            "at the floor, and longer positions would gain little.",
            **numbers,
        )
    elif walk <= flicker:
        what = Message(
            "At T = {T} s white noise ({white} °/h) lies below the bias-instability floor ({drift} °/h): "
            "longer positions would not make B better known.",
            **numbers,
        )
    else:
        what = Message(
            "At T = {T} s white noise ({white} °/h) lies below the drift ({drift} °/h): T is past the "
            "bias-instability floor, and longer positions would make B less well known.",
            **numbers,
        )
    return DiagnosisFinding("fine", what)
