"""Allan deviation of a recording at rest: curve, confidence limits, and the noise terms of each channel.

Missing samples: the values are put on the grid of the sample interval, and an average counts where at least
95 % of it is there (:mod:`ahrs_lab.inertial.allan`). Limits are 95 %, χ² with the degrees of freedom that the
fitted noise gives the estimate. The terms are fitted to the octaves, whichever averaging times are shown.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Final, Literal

import numpy as np
from numpy.typing import NDArray

from ahrs_lab.analysis.inertial_record import TO_MPS2, TO_RADPS, InertialRecord, some_of, unit_doubts
from ahrs_lab.errors import InputError
from ahrs_lab.inertial.allan import (
    Counts,
    all_factors,
    octave_factors,
    overlapping_allan_variance,
    own_factors,
)
from ahrs_lab.inertial.allan_covariance import (
    allan_covariance,
    confidence_limits,
    equivalent_dof,
    pair_moments,
)
from ahrs_lab.inertial.allan_fit import AllanFit, fit_allan, in_seconds
from ahrs_lab.messages import Message
from ahrs_lab.recording.samples import ACCEL, GYRO

Array = NDArray[np.float64]
Taus = Sequence[float] | Literal["octave", "all"]

CONFIDENCE: Final = 0.95
GYRO_KEYS: Final = (
    "quantisation_arcsec",
    "angle_random_walk_deg_per_sqrt_h",
    "bias_instability_deg_per_h",
    "rate_random_walk_deg_per_h_per_sqrt_h",
    "rate_ramp_deg_per_h_per_h",
)
"""Q, N, B, K, R as data sheets have them."""
ACCEL_KEYS: Final = (
    "quantisation_mps",
    "velocity_random_walk_mps_per_sqrt_s",
    "bias_instability_mps2",
    "acceleration_random_walk_mps2_per_sqrt_s",
    "acceleration_ramp_mps2_per_s",
)
_PER_DEG = np.array([3600.0, 60.0, 3600.0, 3600.0 * 60.0, 3600.0**2])
"""From degrees and seconds to the units of GYRO_KEYS."""
_LONGEST_STEPS: Final = 50_000_000
"""Of the grid: more would be a wrong time in the file."""


@dataclass(frozen=True)
class AllanChannel:
    """One channel, ``unit`` as recorded; ``tau_s``, ``deviation``, ``low``, ``high`` (f,) in it.

    ``fit`` has the terms in ``unit`` and seconds (None: no noise, or under two values); ``factors`` (5,) take
    them to the units of ``keys``, None for a unit that counts.
    """

    name: str
    unit: str
    tau_s: Array
    deviation: Array
    low: Array
    high: Array
    fit: AllanFit | None
    factors: Array | None

    @property
    def keys(self) -> tuple[str, ...]:
        """Names of the terms, with the unit."""
        return GYRO_KEYS if self.name in GYRO else ACCEL_KEYS


@dataclass(frozen=True)
class AllanResult:
    """``missing`` counts the samples that the grid lacks; ``warnings`` what stands against the numbers."""

    file: str
    interval_s: float
    samples: int
    missing: int
    channels: tuple[AllanChannel, ...]
    warnings: tuple[Message, ...]

    def to_json(self) -> dict[str, Any]:
        """``{"gyro_x": {…}, …}``; a term that the data do not show is 0, and its upper limit is in
        ``upper_limit``; in counts the terms are null and only ``own_unit`` has them."""
        return {channel.name: self._channel(channel) for channel in self.channels}

    def _channel(self, channel: AllanChannel) -> dict[str, Any]:
        fit, factors = channel.fit, channel.factors
        blank: list[float | None] = [None] * 5
        terms = uncertainty = upper = blank
        if factors is not None:
            terms = [0.0] * 5 if fit is None else _numbers(fit.terms * factors)
        if factors is not None and fit is not None:
            uncertainty, upper = _numbers(fit.uncertainty * factors), _numbers(fit.upper * factors)
        own = {
            name: 0.0 if fit is None else float(fit.terms[index])
            for index, name in enumerate(("quantisation", "white", "flicker", "walk", "ramp"))
        }
        return {
            "tau_s": channel.tau_s.tolist(),
            "oadev": channel.deviation.tolist(),
            "oadev_low": channel.low.tolist(),
            "oadev_high": channel.high.tolist(),
            **dict(zip(channel.keys, terms, strict=True)),
            "standard_uncertainty": dict(zip(channel.keys, uncertainty, strict=True)),
            "upper_limit": dict(zip(channel.keys, upper, strict=True)),
            "unit": channel.unit,
            "own_unit": own,
            "confidence": CONFIDENCE,
            "segment": self.file,
            "samples": self.samples,
            "missing": self.missing,
            "warnings": [str(warning) for warning in self.warnings],
        }


def longest_at_rest(records: Sequence[InertialRecord]) -> InertialRecord:
    """The segment with the most time in which nothing is moved; raises InputError where there is none."""
    still = [record for record in records if at_rest(record)]
    if not still:
        raise InputError(
            "The recording has no segment at rest (item static or zero_offset); name the segment to take. "
            "There are: {known}.",
            known=some_of([record.segment.file for record in records]),
        )
    return max(still, key=len)


def at_rest(record: InertialRecord) -> bool:
    """By what the recording's header says of the segment."""
    segment = record.segment
    if segment.rate_dps or segment.turns:
        return False
    return segment.item in ("static", "zero_offset") or segment.role in ("static_before", "static_after")


def analyse_allan(record: InertialRecord, taus: Taus = "octave") -> AllanResult:
    """All channels of one segment. ``taus``: octaves, all, or own averaging times, s.

    Raises InputError where a time is not positive, where the record is under two samples, or where none of
    the times can be shown.
    """
    steps, interval_s = _grid(record)
    count = int(steps[-1]) + 1
    factors = _factors(taus, interval_s, count)
    names = [name for name in (*GYRO, *ACCEL) if name in record.samples]
    channels = tuple(
        _channel(record, name, _on_grid(record.samples[name], steps), factors, interval_s) for name in names
    )
    warnings = [*record.warnings, *unit_doubts(record)]
    if not at_rest(record):
        warnings.append(
            Message(
                "{file} is not a recording at rest: motion counts as noise here.", file=record.segment.file
            )
        )
    return AllanResult(
        record.segment.file,
        interval_s,
        len(record),
        count - len(record),
        channels,
        (*warnings, *_left_out(taus, interval_s, count), *_misfits(channels)),
    )


def _grid(record: InertialRecord) -> tuple[Counts, float]:
    """Where each row lies on the grid of the sample interval, and that interval by the device's clock."""
    if len(record) < 2:
        raise InputError(
            "{file} has {count} usable samples: an Allan deviation needs two at least, and is worth reading "
            "from some hundred.",
            file=record.segment.file,
            count=len(record),
        )
    typical = float(np.median(np.diff(record.t_s)))
    jumps = np.maximum(1.0, np.rint(np.diff(record.t_s) / typical))
    last = float(np.sum(jumps))
    if last > _LONGEST_STEPS:
        raise InputError(
            "{file} spans {last} sample intervals of {typical} s: a time in it is wrong.",
            file=record.segment.file,
            last=f"{last:.3g}",
            typical=f"{typical:.4g}",
        )
    steps = np.concatenate(([0], np.cumsum(jumps))).astype(np.int64)
    return steps, float(record.t_s[-1] - record.t_s[0]) / last


def _on_grid(values: Array, steps: Counts) -> Array:
    if len(values) == int(steps[-1]) + 1:
        return values
    grid = np.full(int(steps[-1]) + 1, np.nan)
    grid[steps] = values
    return grid


def _factors(taus: Taus, interval_s: float, count: int) -> Counts:
    if taus == "octave":
        return octave_factors(count)
    if taus == "all":
        return all_factors(count)
    own = [float(tau) for tau in taus]
    for tau in own:
        if not (np.isfinite(tau) and tau > 0.0):
            raise InputError("The averaging time {tau} s has to be a number above 0.", tau=tau)
    factors = own_factors(own, interval_s, count)
    if not len(factors):
        raise InputError(
            "None of the averaging times can be shown: the recording has averages from {shortest} s to "
            "{longest} s.",
            shortest=f"{interval_s:.4g}",
            longest=f"{count // 2 * interval_s:.4g}",
        )
    return factors


def _channel(
    record: InertialRecord, name: str, values: Array, factors: Counts, interval_s: float
) -> AllanChannel:
    octaves = overlapping_allan_variance(values, octave_factors(len(values)))
    fit = fit_allan(octaves, allan_covariance(octaves.factors, octaves.differences, len(values)), interval_s)
    shown = octaves
    if not np.array_equal(factors, octave_factors(len(values))):
        shown = overlapping_allan_variance(values, factors)
    low, high = shown.deviation, shown.deviation
    if fit is not None:
        terms = (fit.terms / in_seconds(interval_s)) ** 2
        missed = (len(values) - 2 * shown.factors + 1) / shown.differences
        dof = np.array([_dof(int(m), len(values), terms) for m in shown.factors]) / missed
        low, high = confidence_limits(shown.variance, dof, CONFIDENCE)
    device = record.header.device
    unit = device.rate_unit if name in GYRO else device.accel_unit
    factor = np.ones(5) * TO_MPS2[unit] if name in ACCEL else np.degrees(TO_RADPS[unit]) * _PER_DEG
    return AllanChannel(
        name,
        unit,
        np.asarray(shown.factors * interval_s, dtype=np.float64),
        shown.deviation,
        low,
        high,
        fit,
        None if unit == "LSB" else factor,
    )


def _dof(factor: int, count: int, terms: Array) -> float:
    """Of one estimate from a record without gaps, ``terms`` being squared and in sample intervals."""
    noise, ramp = terms[:4], terms[4]
    quadratic, linear = pair_moments(factor, factor, count)
    m = float(factor)
    unit = np.array([3.0 / m**2, 1.0 / m, 2.0 * np.log(2.0) / np.pi, m / 3.0, m**2 / 2.0])
    return equivalent_dof(
        float(unit @ terms), float(noise @ quadratic @ noise + ramp * (linear @ noise)) or np.inf
    )


def _left_out(taus: Taus, interval_s: float, count: int) -> list[Message]:
    if isinstance(taus, str):
        return []
    lost = [t for t in taus if round(t / interval_s) < 1 or round(t / interval_s) > count // 2]
    if not lost:
        return []
    return [
        Message(
            "averaging times left out, which the recording cannot show: {lost} s.",
            lost=", ".join(f"{tau:g}" for tau in lost),
        )
    ]


def _misfits(channels: Sequence[AllanChannel]) -> list[Message]:
    found = []
    for channel in channels:
        fit = channel.fit
        if fit is None:
            found.append(
                Message(
                    "{channel}: the values do not change; there is no noise to see.", channel=channel.name
                )
            )
        elif not fit.describes:
            found.append(
                Message(
                    "{channel}: the noise terms do not describe the deviation well (χ² {chi} with {dof} "
                    "degrees of freedom): vibration, a filter or a temperature change may be in it.",
                    channel=channel.name,
                    chi=f"{fit.chi_squared:.0f}",
                    dof=fit.dof,
                )
            )
    return found


def _numbers(values: Array) -> list[float | None]:
    return [float(value) if np.isfinite(value) else None for value in values]
