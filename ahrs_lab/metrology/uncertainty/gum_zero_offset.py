"""Budget of B (JCGM 100): noise of the dwells, and what pointing and levelling errors let in of the Earth's
rate.

A small error δ of the case's attitude (a rotation vector in east, north, up) changes the rate felt along the
direction d by δ·(d × ω). How far the reversals cancel that depends on what the error is tied to, so each
source is summed over the positions with its own correlation.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ahrs_lab.messages import Message
from ahrs_lab.metrology.conditions import ARCSEC, BenchCapability
from ahrs_lab.metrology.result import BudgetRow, Uncertainty
from ahrs_lab.metrology.uncertainty.bench_figure import from_figure
from ahrs_lab.metrology.uncertainty.budget import combine, from_half_width, type_a
from ahrs_lab.metrology.uncertainty.fitted_scale import UNSCALED, FittedScale
from ahrs_lab.metrology.uncertainty.noise import WHITE_NOISE, NoiseModel
from ahrs_lab.metrology.uncertainty.resolution import Resolution
from ahrs_lab.metrology.zero_offset import EARTH_RATE_DPS

Array = NDArray[np.float64]

REPEATABILITY = "R"
"""Symbol of the row that a job may ask for."""


@dataclass(frozen=True)
class Repeatability:
    """What B may be another day: ``deviation_dps`` of a single B, from ``cycles`` power-ons; with 0 cycles
    the Allan deviation at the dwell, which shows the bias instability alone.

    As a row of U it counts once in full, for the one power-on that the user will meet. The noise of a single
    determination is in it, and in the rows of the dwells again: on the safe side.
    """

    deviation_dps: float
    cycles: int

    def row(self) -> BudgetRow:
        """Its row in the budget of B."""
        source = (
            Message("Repeatability over {count} power-ons: what B may be another day", count=self.cycles)
            if self.cycles
            else Message("Bias instability (Allan deviation at the dwell): what B may be another day")
        )
        dof = self.cycles - 1.0 if self.cycles else math.inf
        return type_a(REPEATABILITY, source, "deg/s", self.deviation_dps, 1.0, dof)


@dataclass(frozen=True)
class ZeroOffsetEvidence:
    """The n dwells of one axis, in order. Rates in °/s.

    ``directions``: shape (n, 3), where the axis points, east-north-up. ``turned_deg``: shape (n,), the
    table's azimuth; ``mountings``: shape (n,), equal where the case
    was not re-mounted between. ``resolution`` is in °/s, or of the angle in deg.
    ``scale``: the fitted K where counts were scaled by it. ``leans``: |L|, rad, by which the axis feels the
    rate about the vertical at every stop of the multi-position method; 0 where it is not known or cancels.
    """

    directions: Array
    turned_deg: Array
    mountings: tuple[str, ...]
    angles_deg: Array
    durations_s: Array
    repeats: Array
    samples: Array
    resolution: Resolution
    noise: NoiseModel
    latitude_deg: float
    scale: FittedScale = UNSCALED
    time_scaled: bool = False
    leans: float = 0.0
    repeatability: Repeatability | None = None


def zero_offset_uncertainty(
    B: float, evidence: ZeroOffsetEvidence, capability: BenchCapability
) -> Uncertainty:
    """u_c and U of B in °/s. Rate random walk and flicker during the dwells belong to B, not to U (7.2); so
    does what B may be another day, unless ``evidence.repeatability`` is given."""
    rows = [*_dwell_rows(evidence), *_earth_rows(evidence, capability), _resolution_row(evidence)]
    if evidence.leans > 0.0:
        rows.append(_vertical_row(evidence))
    if evidence.time_scaled:
        rows.append(from_figure("t", Message("Time base"), "1", capability.figure("timing_relative"), -B))
    if evidence.scale.relative > 0.0:
        rows.append(evidence.scale.row(B))
    if evidence.repeatability is not None:
        rows.append(evidence.repeatability.row())
    return combine(rows)


def _resolution_row(evidence: ZeroOffsetEvidence) -> BudgetRow:
    """Undithered, the positions show the same code, and its error is that of all of them: 1, not 1/√n."""
    resolution = evidence.resolution
    factors = resolution.mean_factors(evidence.durations_s, evidence.samples) / len(evidence.durations_s)
    return from_half_width(
        "q",
        Message("Resolution of the output"),
        "deg" if resolution.of_angle else "deg/s",
        0.5 * resolution.step,
        math.sqrt(float(factors @ factors)) if resolution.dithered else float(factors.sum()),
        "data",
    )


def _vertical_row(evidence: ZeroOffsetEvidence) -> BudgetRow:
    """7.2.2 turns about the vertical alone, so what the axis feels of the vertical rate by its own
    misalignment stays. By the standard's formula it belongs to the value; it is stated, not taken off."""
    return from_half_width(
        "λ",
        Message("Misalignment of the axis, through the Earth's vertical rate"),
        "rad",
        evidence.leans,
        abs(float(earth_rate_vector(evidence.latitude_deg)[2])),
        "data",
    )


def _dwell_rows(evidence: ZeroOffsetEvidence) -> list[BudgetRow]:
    """u(N_i) = √(N²T + 2Q²) from the white noise of rate and angle, ∂B/∂N_i = 1/(n·T_i); repeats are
    averaged."""
    count = len(evidence.durations_s)
    return [
        type_a(
            f"N_{index}",
            Message("Sensor noise in position {position}", position=index),
            "deg",
            math.sqrt(evidence.noise.angle_variance(duration) / repeats),
            1.0 / (count * duration),
            evidence.noise.white_dof,
            estimate=float(angle),
            shared=WHITE_NOISE,
        )
        for index, (duration, repeats, angle) in enumerate(
            zip(evidence.durations_s, evidence.repeats, evidence.angles_deg, strict=True), start=1
        )
    ]


def earth_rate_vector(latitude_deg: float) -> Array:
    """Shape (3,): ω_ie in east, north, up, °/s."""
    latitude = math.radians(latitude_deg)
    return EARTH_RATE_DPS * np.array([0.0, math.cos(latitude), math.sin(latitude)])


@dataclass(frozen=True)
class EarthLeverage:
    """How the errors of the case's attitude let the Earth's rate in; °/s per rad, east-north-up.

    ``each``: shape (n, 3), of each stop, weighted by 1/n; ``with_table``: shape (mountings, 3), summed over
    each of the mountings ``names`` in axes that turn with the table; ``first_stops``: shape (n,).
    """

    earth: Array
    each: Array
    with_table: Array
    names: tuple[str, ...]
    first_stops: NDArray[np.bool_]

    @classmethod
    def of(cls, evidence: ZeroOffsetEvidence) -> EarthLeverage:
        """Of the stops of one axis."""
        omega = earth_rate_vector(evidence.latitude_deg)
        each = np.cross(evidence.directions, omega) / len(evidence.directions)
        return cls(
            earth=omega,
            each=each,
            with_table=_per_mounting(_turned_back(each, evidence.turned_deg), evidence.mountings),
            names=tuple(sorted(set(evidence.mountings))),
            first_stops=_first_of_mounting(evidence.mountings),
        )

    @property
    def tilts(self) -> Array:
        """Shape (mountings,): by a tilt of each about its worst horizontal axis of the table."""
        return np.asarray(np.hypot(self.with_table[:, 0], self.with_table[:, 1]))

    @property
    def common_tilt(self) -> float:
        """By a tilt that all mountings have about one horizontal axis of the table, the worst."""
        east, north, _ = self.with_table.sum(axis=0).tolist()
        return math.hypot(east, north)


def _earth_rows(evidence: ZeroOffsetEvidence, capability: BenchCapability) -> list[BudgetRow]:
    leverage = EarthLeverage.of(evidence)
    common = leverage.each.sum(axis=0)
    tilts = leverage.tilts
    latitude = math.radians(evidence.latitude_deg)
    change = EARTH_RATE_DPS * np.array([0.0, -math.sin(latitude), math.cos(latitude)])
    cos_phi = Message("Azimuth reference (north); reversal cancels it")

    def row(symbol: str, source: Message, name: str, sensitivity: float, to_rad: float = ARCSEC) -> BudgetRow:
        return from_figure(symbol, source, "rad", capability.figure(name).times(to_rad), sensitivity)

    return [
        row(
            "α",
            Message("Table position from stop to stop, through the Earth's rate"),
            "position_arcsec",
            math.sqrt(float(np.sum(leverage.each[~leverage.first_stops, 2] ** 2))),
        ),
        row("ψ", cos_phi, "azimuth_arcsec", _clean(float(common[2]))),
        row(
            "τ",
            Message("Table axis against the vertical; reversal cancels it"),
            "axis_tilt_arcsec",
            _clean(math.hypot(float(common[0]), float(common[1]))),
        ),
        # what turns with the table: the platform's own lean is the same in every mounting, the seat is not
        row(
            "w",
            Message("Wobble of the table's axis, through the Earth's rate"),
            "wobble_arcsec",
            _clean(leverage.common_tilt),
        ),
        row(
            "β",
            Message("Level of the case, through the Earth's rate"),
            "level_arcsec",
            _clean(math.sqrt(float(np.sum(tilts**2)))),
        ),
        row(
            "γ",
            Message("Perpendicularity of the fixture, through the Earth's rate"),
            "fixture_perpendicularity_arcsec",
            _clean(math.sqrt(float(np.sum(tilts**2)))),
        ),
        row(
            "φ",
            Message("Latitude; reversal cancels it"),
            "latitude_deg",
            _clean(float((evidence.directions @ change).mean())),
            math.radians(1.0),
        ),
    ]


def _clean(sensitivity: float) -> float:
    """A sum that cancels but for the last bits is 0."""
    return 0.0 if abs(sensitivity) < 1e-12 * EARTH_RATE_DPS else sensitivity


def _turned_back(leverage: Array, turned_deg: Array) -> Array:
    """Into axes that turn with the table: an error fixed to it is the same vector at every stop."""
    angle = np.radians(turned_deg)
    cosine, sine = np.cos(angle), np.sin(angle)
    east = cosine * leverage[:, 0] + sine * leverage[:, 1]
    north = -sine * leverage[:, 0] + cosine * leverage[:, 1]
    return np.column_stack([east, north, leverage[:, 2]])


def _per_mounting(vectors: Array, mountings: tuple[str, ...]) -> Array:
    names = sorted(set(mountings))
    return np.array([vectors[[m == name for m in mountings]].sum(axis=0) for name in names])


def _first_of_mounting(mountings: tuple[str, ...]) -> NDArray[np.bool_]:
    """The first stop of a mounting is the reference from which the others are turned."""
    return np.array([mounting not in mountings[:index] for index, mounting in enumerate(mountings)])
