"""Whole calibrations of simulated units on simulated benches, with the truth of each: what the coverage is
counted on.

Nothing here knows the budgets. Each calibration draws, once, the unit's constants from its grade and the
errors of the bench from what :class:`BenchCapability` states (k = 2, so the standard deviation is half the
figure), and turns the case by rotation matrices; noise, flicker and random walk run through the whole time of
the calibration, pauses and re-mountings included. What is handed out are recordings, reduced by the same
function as anybody's.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ahrs_lab.inertial.attitude import rotation_from_vector
from ahrs_lab.inertial.earth import STANDARD_GRAVITY_MPS2, earth_rate_enu_dps
from ahrs_lab.inertial.sensor_model import GyroModel, Matrix, Vector
from ahrs_lab.inertial.sensor_noise import NoiseCoefficients, SlowDrift, WhiteNoise
from ahrs_lab.instruments.interfaces import TableLimits
from ahrs_lab.metrology.conditions import ARCSEC, BenchCapability, rate_band
from ahrs_lab.procedures.commands import Record
from ahrs_lab.procedures.plan_settings import Plan
from ahrs_lab.procedures.schedule import Mounting, plan_mountings
from ahrs_lab.procedures.takes import blocks
from ahrs_lab.recording.orientation import AXES, Orientation
from ahrs_lab.recording.read import RecordedSegment, Recording
from ahrs_lab.recording.samples import Samples
from ahrs_lab.recording.segment import DeviceDescription, RecordingHeader, Segment, Site
from ahrs_lab.simulation.presets import Grade

Array = NDArray[np.float64]

RATE_HZ = 10.0
"""The fewest samples a second that 7.2 and 7.3 allow."""
INTERVAL_S = 1.0 / RATE_HZ
LATITUDE_DEG = 39.9042
LIMITS = TableLimits(max_rate_dps=1000.0, max_acceleration_dps2=100.0)
MOUNTING_S, WARM_UP_S, SETTLING_S, LEAD_S = 180.0, 75.0, 4.0, 2.0
"""Pauses in which nothing is recorded and the bias drifts on; rest before the turns."""
_WALK_PER_INSTABILITY = 0.3
"""°/h/√h per °/h, as in the presets."""
_SECOND_OF_NODES = 0.87
"""Weight of a second's first node in its mean, the rest is its last node's: so weighted, the means have the
Allan variance of flicker (2 ln 2/π)·B² within 2 % at 1 s, 2 s, 4 s … (half the nodes' sum would have half of
it at 1 s, the first node alone 1.4 times)."""
_BATCH = 32
"""Calibrations whose slow drift is made together."""


def coefficients(grade: Grade) -> NoiseCoefficients:
    """The grade's noise in °/s and seconds."""
    return NoiseCoefficients(
        white=grade.angle_random_walk / 60.0,
        bias_instability=grade.instability / 3600.0,
        random_walk=_WALK_PER_INSTABILITY * grade.instability / 3600.0 / 60.0,
        quantisation=grade.quantisation_arcsec / 3600.0,
    )


@dataclass(frozen=True)
class Take:
    """A segment of the plan, when it is recorded (s since the calibration began) and for how many samples."""

    segment: Segment
    mounting: int
    start_s: float
    samples: int

    @property
    def duration_s(self) -> float:
        return self.samples * INTERVAL_S


@dataclass(frozen=True)
class Course:
    """What is recorded when: the plan's own segments, in its own order."""

    plan: Plan
    mountings: tuple[Mounting, ...]
    takes: tuple[Take, ...]
    switched_on_s: tuple[float, ...]

    @property
    def ends_s(self) -> float:
        return self.takes[-1].start_s + self.takes[-1].duration_s

    def of(self, item: str, axis: str) -> list[Take]:
        return [take for take in self.takes if (take.segment.item, take.segment.axis) == (item, axis)]


def course_of(plan: Plan) -> Course:
    """The time line of ``plan``: the pauses of mounting, warm-up and settling between its recordings."""
    mountings = plan_mountings(plan)
    takes, switched_on, now = [], [], 0.0
    for index, mounting in enumerate(mountings):
        now += MOUNTING_S
        switched_on.append(now)
        now += WARM_UP_S
        for block in blocks(plan, mounting, index + 1, LIMITS):
            for take in block.takes:
                now = math.ceil(now + SETTLING_S)
                record = take.commands[-1]
                seconds = record.duration_s if isinstance(record, Record) else take.estimate_s
                takes.append(Take(take.segment, index, now, round(seconds * RATE_HZ)))
                now += takes[-1].duration_s
    return Course(plan, mountings, tuple(takes), tuple(switched_on))


@dataclass(frozen=True)
class Unit:
    """One unit: its gyros, and the bias (3,) that each power-on adds."""

    gyro: GyroModel
    turn_on: Array


@dataclass(frozen=True)
class BenchErrors:
    """What is wrong with one bench, in its own units; a perfect bench has zeros throughout.

    ``seats`` are the rotation vectors, rad, shape (mountings, 3), by which the case stands off the platform
    (table axes): its level anew at each mounting, and the fixture's face. ``stops_deg``: shape (takes,), by
    which a turned table misses its angle. ``wobble``: the platform's normal against the axis that it turns
    about, arcsec and degrees of azimuth.
    """

    rate_relative: Array
    stops_deg: Array
    wobble: tuple[float, float]
    tilt_arcsec: tuple[float, float]
    north_arcsec: float
    seats: Array
    latitude_deg: float
    clock_relative: float


def draw_unit(grade: Grade, mountings: int, rng: np.random.Generator) -> Unit:
    """Constants normally distributed with the grade's figures."""
    bias = 3.0 * max(grade.turn_on, grade.instability) / 3600.0
    cross = grade.misalignment * rng.standard_normal((3, 3))
    np.fill_diagonal(cross, 0.0)
    sensitivity = grade.g_sensitivity / 3600.0 / STANDARD_GRAVITY_MPS2
    gyro = GyroModel(
        scale_factor=_vector(1.0 + grade.scale * rng.standard_normal(3)),
        bias_dps=_vector(bias * rng.standard_normal(3)),
        g_sensitivity=_matrix(np.diag(np.full(3, sensitivity))),
        misalignment_rad=_matrix(cross),
        nonlinearity=_vector(grade.nonlinearity * rng.standard_normal(3)),
        range_dps=grade.range_dps,
    )
    return Unit(gyro, grade.turn_on / 3600.0 * rng.standard_normal((mountings, 3)))


def draw_bench(course: Course, stated: BenchCapability, rng: np.random.Generator) -> BenchErrors:
    """Each error normal with half its stated figure, tilts in both directions; zero where it states zero.

    The stop from which a mounting's others are turned is the one that north is laid to.
    """
    count = len(course.mountings)
    normal = rng.standard_normal
    level = np.column_stack([normal((count, 2)), np.zeros(count)]) * stated.level_arcsec
    faces = normal((count, 3)) * stated.fixture_perpendicularity_arcsec
    turned = np.array(
        [bool(take.segment.azimuth_deg) or take.segment.item == "misalignment" for take in course.takes]
    )
    wobble = 0.5 * stated.wobble_arcsec * normal(2)
    tilt = 0.5 * stated.axis_tilt_arcsec * normal(2)
    return BenchErrors(
        rate_relative=0.5 * np.array(stated.rate_relative) * normal(3),
        stops_deg=np.where(turned, 0.5 * stated.position_arcsec / 3600.0 * normal(len(turned)), 0.0),
        wobble=(float(np.hypot(*wobble)), math.degrees(math.atan2(wobble[1], wobble[0]))),
        tilt_arcsec=(float(tilt[0]), float(tilt[1])),
        north_arcsec=float(0.5 * stated.azimuth_arcsec * normal()),
        seats=0.5 * ARCSEC * (level + faces),
        latitude_deg=LATITUDE_DEG + float(0.5 * stated.latitude_deg * normal()),
        clock_relative=float(0.5 * stated.timing_relative * normal()),
    )


class Noise:
    """Random terms of one calibration: for each take the samples, shape (3, n), °/s, and the mean drift."""

    def __init__(self, course: Course, grade: Grade, nodes: Array, seed: np.random.SeedSequence) -> None:
        """``nodes``: shape (3, seconds), the slow drift on its grid."""
        self.samples: list[Array] = []
        self.mean_drift = np.empty((len(course.takes), 3))
        drift = _SECOND_OF_NODES * nodes[:, :-1] + (1.0 - _SECOND_OF_NODES) * nodes[:, 1:]
        terms = coefficients(grade)
        white = [WhiteNoise(terms, INTERVAL_S, one) for one in seed.spawn(3)]
        for index, take in enumerate(course.takes):
            # one sample ahead: the angle's noise at the start is not that at the end of the take before
            made, scratch = np.zeros((3, take.samples + 1)), np.empty(take.samples + 1)
            seconds = int(take.start_s) + np.arange(take.samples) // round(RATE_HZ)
            slow = np.take(drift, seconds, axis=1)
            self.mean_drift[index] = slow.mean(axis=1)
            for axis in range(3):
                white[axis].add_to(made[axis], scratch)
            self.samples.append(made[:, 1:] + slow)


def noises(course: Course, grade: Grade, seed: np.random.SeedSequence) -> Iterator[Noise]:
    """One after the other, without end."""
    last = math.ceil(course.ends_s) + 2
    while True:
        slow, *single = seed.spawn(1 + _BATCH)
        drift = SlowDrift((coefficients(grade),) * (3 * _BATCH), slow).nodes(0, last)
        for index, one in enumerate(single):
            yield Noise(course, grade, drift[3 * index : 3 * index + 3], one)


def record(course: Course, unit: Unit, bench: BenchErrors, noise: Noise | None) -> Recording:
    """The recording of one calibration; without ``noise`` the unit is noiseless."""
    cases = [
        _mounted(mounting.orientation, seat, bench)
        for mounting, seat in zip(course.mountings, bench.seats, strict=True)
    ]
    segments = []
    for index, take in enumerate(course.takes):
        shown = _shown(course, index, unit, bench, cases[take.mounting])
        shown += unit.turn_on[take.mounting][:, np.newaxis]
        if noise is not None:
            shown += noise.samples[index]
        shown *= np.array(unit.gyro.scale_factor)[:, np.newaxis]
        begun = take.start_s - course.switched_on_s[take.mounting]
        t_s = (begun + np.arange(1, take.samples + 1) * INTERVAL_S) * (1.0 + bench.clock_relative)
        columns = {"t_s": t_s, **{f"gyro_{axis}": shown[i] for i, axis in enumerate(AXES)}}
        lines = np.arange(2, take.samples + 2)
        segments.append(RecordedSegment(take.segment, Samples(columns), (), lines, 0, INTERVAL_S))
    device = DeviceDescription(rate_unit="deg/s", sample_rate_hz=RATE_HZ)
    notes = {"plan": {"zero_offset": {"schedule": course.plan.zero_offset.schedule}}}
    header = RecordingHeader("jjf1536-2015", Site(LATITUDE_DEG), device, notes=notes)
    return Recording(header, tuple(segments), "00" * 32)


def truth_of(course: Course, unit: Unit, noise: Noise | None) -> dict[str, float]:
    """What the calibration has to find, by ``K_x``, ``F0_x``, ``B_x``, ``L_yx`` …

    K: slope of the least squares line through the unit's true response at the rates of the plan (that is
    what 7.1 defines, nonlinearity or not). F₀: what the unit shows at the rates beyond that line and beyond
    its rest: nothing but the Earth's horizontal rate seen through its misalignment at rest. B: mean of the
    offset over the dwells, drift and turn-on included. L: the constant, in units of its output.
    """
    gyro, values = unit.gyro, dict[str, float]()
    scale, cross = np.array(gyro.scale_factor), np.array(gyro.misalignment_rad)
    rates = np.array(course.plan.scale_factor.rates_dps)
    for i, axis in enumerate(AXES):
        response = rates + gyro.nonlinearity[i] * rates * (rates / gyro.nonlinearity_rate_dps) ** 2
        values[f"K_{axis}"] = scale[i] * float(np.polyfit(rates, response, 1)[0])
        reference = course.mountings[course.of("scale_factor", axis)[0].mounting].orientation
        felt = reference.matrix.T @ earth_rate_enu_dps(LATITUDE_DEG)
        values[f"F0_{axis}"] = -scale[i] * float(cross[i] @ felt)
        for j, other in enumerate(AXES):
            if i != j:
                values[f"L_{axis}{other}"] = scale[i] * cross[i, j]
    combined = course.plan.zero_offset.schedule == "combined"
    for i, axis in enumerate(AXES):
        dwells = [
            index
            for index, take in enumerate(course.takes)
            if take.segment.item == "zero_offset" and (combined or take.segment.axis == axis)
        ]
        offsets = [unit.turn_on[course.takes[index].mounting, i] for index in dwells]
        drift = 0.0 if noise is None else float(noise.mean_drift[dwells, i].mean())
        values[f"B_{axis}"] = scale[i] * (gyro.bias_dps[i] + float(np.mean(offsets)) + drift)
    return values


def perfect() -> BenchCapability:
    """A bench without errors."""
    return BenchCapability((0.0, 0.0, 0.0), *(0.0,) * 8)


@dataclass(frozen=True)
class _Mounted:
    """A case as it stands on its table, turning about the fixed direction ``axis``. The Earth's rate in case
    axes at table angle θ is ``along + across·cos θ + beside·sin θ`` (Rodrigues), °/s, each of shape (3,);
    ``axis`` and ``up`` in case axes, unit length, the latter at θ = 0."""

    axis: Array
    up: Array
    along: Array
    across: Array
    beside: Array

    def felt(self, angle_deg: Array, turned_deg: Array) -> Array:
        """Shape (3, n), °/s·1: mean Earth's rate over intervals about ``angle_deg`` in which the table turns
        by ``turned_deg``."""
        shrink = np.sinc(turned_deg / 360.0)
        phase = np.radians(angle_deg)
        return (
            self.along[:, np.newaxis]
            + np.outer(self.across, shrink * np.cos(phase))
            + np.outer(self.beside, shrink * np.sin(phase))
        )


def _mounted(orientation: Orientation, seat_rad: Array, bench: BenchErrors) -> _Mounted:
    wobble, towards = bench.wobble
    lean = wobble * ARCSEC * np.array([math.cos(math.radians(towards)), math.sin(math.radians(towards)), 0.0])
    tilt = rotation_from_vector(np.array([*bench.tilt_arcsec, 0.0]) * ARCSEC)
    north = rotation_from_vector(np.array([0.0, 0.0, bench.north_arcsec * ARCSEC]))
    case = tilt @ north @ rotation_from_vector(lean) @ rotation_from_vector(seat_rad) @ orientation.matrix
    axis, earth = tilt[:, 2], earth_rate_enu_dps(bench.latitude_deg)
    along = axis * (axis @ earth)
    return _Mounted(
        case.T @ axis,
        case.T @ np.array([0.0, 0.0, 1.0]),
        case.T @ along,
        case.T @ (earth - along),
        # the Earth turns backwards as seen from the table
        -case.T @ np.cross(axis, earth),
    )


def _shown(course: Course, index: int, unit: Unit, bench: BenchErrors, case: _Mounted) -> Array:
    """Shape (3, n): what the noiseless gyros indicate, before their scale factors."""
    take = course.takes[index]
    edges = _table_angle_deg(take, float(bench.stops_deg[index]), bench)
    force = STANDARD_GRAVITY_MPS2 * case.up[:, np.newaxis]
    if edges is None:
        angle = np.array([(take.segment.azimuth_deg or 0.0) + float(bench.stops_deg[index])])
        rate = case.felt(angle, np.zeros(1))
        return np.repeat(unit.gyro.indicated_dps(rate, force), take.samples, axis=1)
    turned = np.diff(edges)
    rate = case.felt(0.5 * (edges[1:] + edges[:-1]), turned)
    rate += np.outer(case.axis, turned * RATE_HZ)
    return unit.gyro.indicated_dps(rate, force)


def _table_angle_deg(take: Take, off_deg: float, bench: BenchErrors) -> Array | None:
    """Shape (n + 1,): the table's angle at the edges of the samples, None at rest."""
    segment, edges = take.segment, np.arange(take.samples + 1) * INTERVAL_S
    if segment.role == "rate":
        relative = float(bench.rate_relative[rate_band(segment.rate_dps)])
        return np.asarray(edges * (segment.rate_dps * (1.0 + relative)))
    if segment.role != "turns":
        return None
    rate, total = abs(segment.rate_dps), 360.0 * abs(segment.turns or 0)
    ramp_s = rate / LIMITS.max_acceleration_dps2
    flat_s = total / rate - ramp_s
    since = np.clip(edges - LEAD_S, 0.0, 2.0 * ramp_s + flat_s)
    up = np.minimum(since, ramp_s)
    down = np.maximum(since - ramp_s - flat_s, 0.0)
    steady = np.clip(since - ramp_s, 0.0, flat_s)
    travelled = rate * (up**2 / (2.0 * ramp_s) + steady + down - down**2 / (2.0 * ramp_s))
    # the stop is missed by what the turns are too long or too short
    return np.asarray(math.copysign(1.0, segment.rate_dps) * travelled * (1.0 + off_deg / total))


def _vector(values: Array) -> Vector:
    x, y, z = values.tolist()
    return (x, y, z)


def _matrix(values: Array) -> Matrix:
    return (_vector(values[0]), _vector(values[1]), _vector(values[2]))
