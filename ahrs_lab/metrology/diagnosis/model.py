"""The diagnosis of a result, frozen: numbers, p-values and the sentences a person reads.

Arrays are tuples of one length inside each record; rates in °/s, times in s, ``residuals`` in the unit said.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Literal

from ahrs_lab.messages import Message

State = Literal["fine", "look", "warn"]
FloorVerdict = Literal["before", "at", "past", "short"]

LOOK_LEVEL = 0.01
"""Probability of a false alarm from which a test is worth a look; of outliers for all points together."""
WARN_LEVEL = 0.001
"""… from which the reader of the result is warned: some twenty tests of a good run stay silent in 98 %."""


def state_of(p: float) -> State:
    """What a p-value asks of the reader."""
    return "warn" if p < WARN_LEVEL else "look" if p < LOOK_LEVEL else "fine"


@dataclass(frozen=True)
class DiagnosisFinding:
    """One sentence; ``p`` where a test stands behind it, ``segment`` where it is about one recording."""

    state: State
    what: Message
    p: float | None = None
    segment: str = ""


@dataclass(frozen=True)
class Residuals:
    """Residuals of n recordings and what stands apart; ``residuals`` and ``standard_errors`` of one unit.

    ``studentised``: externally, against the scatter of the others with ``dof``; ``limit``: of its absolute
    value, for all n together at 1 % (Bonferroni). ``outliers`` are places in the arrays; ``outlier_p`` is the
    probability of the largest by chance, for all n together.
    """

    segments: tuple[str, ...]
    starts_s: tuple[float, ...]
    residuals: tuple[float, ...]
    standard_errors: tuple[float, ...]
    studentised: tuple[float, ...]
    dof: int
    limit: float
    outliers: tuple[int, ...]
    outlier_p: float


@dataclass(frozen=True)
class LackOfFit:
    """Residual variance over what noise and drift explain, by F with ``dof_fit`` and ``dof_noise``.

    ``share``: of the variance of K by scatter that no smooth curve explains, 0…1.
    """

    F: float
    dof_fit: float
    dof_noise: float
    p: float
    share: float


@dataclass(frozen=True)
class Change:
    """A difference or a slope with its standard uncertainty and a two-sided t-test against zero."""

    value: float
    standard: float
    dof: float
    p: float


@dataclass(frozen=True)
class ScaleFactorDiagnosis:
    """7.1: ``residuals`` v_j of (13) in the device's unit, in the order of the result's rates.

    ``order``: 1 for the rate recorded first. ``full_scale`` = max|F_j|, for ppm. ``trend``: of the residuals,
    unit per s. ``drift``: F_e − F_s of (11).
    """

    rates_dps: tuple[float, ...]
    order: tuple[int, ...]
    full_scale: float
    residuals: Residuals
    trend: Change | None
    lack_of_fit: LackOfFit | None
    drift: Change | None
    findings: tuple[DiagnosisFinding, ...] = ()


@dataclass(frozen=True)
class Harmonic:
    """7.2.2: the Earth's horizontal rate in the mean outputs over azimuth, °/s and degrees.

    ``amplitude`` and ``phase`` are differences from ω_ie·cos φ and from the azimuths' north. The curves, over
    ``curve_azimuths_deg``, are the fit and what is expected.
    """

    amplitude_dps: float
    expected_dps: float
    amplitude: Change
    phase: Change
    azimuths_deg: tuple[float, ...]
    rates_dps: tuple[float, ...]
    standard_error_dps: float
    curve_azimuths_deg: tuple[float, ...]
    fitted_dps: tuple[float, ...]
    expected_curve_dps: tuple[float, ...]


@dataclass(frozen=True)
class AllanDiagnosis:
    """Overlapping Allan deviation of the positions, pooled, °/s; 95 % limits; the model of the noise rows.

    ``white`` is N in (°/s)·√s, ``flicker_dps`` the bias instability, ``walk`` K_r in (°/s)/√s. The model
    reaches to T = ``duration_s``, where its deviation is ``at_duration_dps``.
    """

    taus_s: tuple[float, ...]
    deviations_dps: tuple[float, ...]
    low_dps: tuple[float, ...]
    high_dps: tuple[float, ...]
    model_taus_s: tuple[float, ...]
    model_dps: tuple[float, ...]
    white: float
    flicker_dps: float
    walk: float
    duration_s: float
    at_duration_dps: float
    verdict: FloorVerdict


@dataclass(frozen=True)
class ZeroOffsetDiagnosis:
    """7.2: ``residuals`` of the single recordings in °/s, from B and the Earth's rate (multi-position: from
    the fitted harmonic)."""

    residuals: Residuals | None
    harmonic: Harmonic | None
    allan: AllanDiagnosis | None
    findings: tuple[DiagnosisFinding, ...] = ()


@dataclass(frozen=True)
class MisalignmentDiagnosis:
    """7.3: what the two senses have in common and in what they differ."""

    rest_rate_dps: float
    duration_difference_s: float
    findings: tuple[DiagnosisFinding, ...] = ()


@dataclass(frozen=True)
class Diagnosis:
    """By the keys of the result: axis, axis, two letters of L."""

    scale_factor: Mapping[str, ScaleFactorDiagnosis] = field(default_factory=dict)
    zero_offset: Mapping[str, ZeroOffsetDiagnosis] = field(default_factory=dict)
    misalignment: Mapping[str, MisalignmentDiagnosis] = field(default_factory=dict)
