"""Transfer alignment on recordings of a virtual carrier, whose truth is known, and on recordings that cannot
be."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from ahrs_lab.analysis.report import report_text
from ahrs_lab.errors import InputError
from ahrs_lab.inertial.attitude import attitude_angles_deg, rotation_from_vector
from ahrs_lab.laboratory.analyses.files import write_outcome
from ahrs_lab.laboratory.analyses.kinds import Outcome
from ahrs_lab.laboratory.analyses.transfer_alignment import KIND
from ahrs_lab.recording.orientation import Orientation
from ahrs_lab.recording.samples import ACCEL, GYRO, Samples
from ahrs_lab.recording.segment import DeviceDescription, RecordingHeader, Segment, Site
from ahrs_lab.recording.write import BundleWriter
from ahrs_lab.simulation.manoeuvres import Accelerate, Steady, STurns
from ahrs_lab.simulation.trajectory import Flight, Start, fly
from ahrs_lab.simulation.trajectory_recording import flight_samples, initial_state

Array = NDArray[np.float64]

MOUNTING = np.radians([0.4, -0.3, 0.9])
GYRO_BIAS_DEG_PER_H = np.array([6.0, -4.0, 8.0])
ACCEL_BIAS_MPS2 = np.array([4e-3, -3e-3, 5e-3])
METHODS = ("velocity", "position", "velocity-azimuth", "velocity-attitude")


@cache
def carrier(rate_hz: float = 20.0, seconds: float = 90.0, latitude: float = 45.0) -> Flight:
    way = (Steady(5), STurns(seconds - 35, 35, 2), Accelerate(20, 25), Steady(10))
    return fly(Start(latitude_deg=latitude, speed_mps=70.0, heading_deg=120.0), way, rate_hz)


def bundle(folder: Path, samples: Samples, rate_hz: float, initial: dict[str, Any] | None = None) -> Path:
    header = RecordingHeader("dynamic", Site(45.0), DeviceDescription(sample_rate_hz=rate_hz), initial)
    with BundleWriter(folder, header, file_format="parquet") as writer:
        writer.begin(Segment("dynamic", Orientation("ENU"), "dynamic", "z", "position"))
        writer.append(samples)
        writer.finish()
    return folder


def reference(tmp: Path, *, rate_hz: float = 5.0, change: Callable[[Samples], Samples] | None = None) -> Path:
    """The truth with noise as the settings assume it, without inertial columns."""
    rng = np.random.default_rng(1)
    flight = carrier()
    samples = flight_samples(flight, reference=True)
    every = round(20.0 / rate_hz)
    columns = {
        name: column[every - 1 :: every]
        for name, column in samples.columns.items()
        if name not in (*GYRO, *ACCEL)
    }
    for name in ("ve_mps", "vn_mps", "vu_mps"):
        columns[name] = columns[name] + 0.05 * rng.normal(size=len(columns[name]))
    metre = np.degrees(2.0 / 6.371e6)
    columns["latitude_deg"] = columns["latitude_deg"] + metre * rng.normal(size=len(columns["t_s"]))
    columns["longitude_deg"] = columns["longitude_deg"] + metre / np.cos(np.radians(45)) * rng.normal(
        size=len(columns["t_s"])
    )
    rows = np.arange(every, len(flight.t_s), every)
    turned = rotation_from_vector(np.radians(0.02) * rng.normal(size=(len(rows), 3))) @ flight.C_bn[rows]
    columns |= dict(zip(("heading_deg", "pitch_deg", "roll_deg"), attitude_angles_deg(turned), strict=True))
    shown = Samples(columns)
    return bundle(tmp / "reference", shown if change is None else change(shown), rate_hz)


def unit(
    tmp: Path,
    *,
    mounting: Array = MOUNTING,
    initial: dict[str, Any] | None = None,
    change: Callable[[Samples], Samples] | None = None,
) -> Path:
    """Gyros and accelerometers with biases and white noise, the case turned by ``mounting``."""
    rng = np.random.default_rng(2)
    samples = flight_samples(carrier().mounted(rotation_from_vector(mounting)))
    root = np.sqrt(20.0)
    columns = dict(samples.columns)
    for i in range(3):
        noise = rng.normal(size=(2, len(samples)))
        columns[GYRO[i]] = columns[GYRO[i]] + GYRO_BIAS_DEG_PER_H[i] / 3600 + 0.1 / 60 * root * noise[0]
        columns[ACCEL[i]] = columns[ACCEL[i]] + ACCEL_BIAS_MPS2[i] + 0.05 / 60 * root * noise[1]
    shown = Samples(columns)
    return bundle(tmp / "unit", shown if change is None else change(shown), 20.0, initial)


def aligned(reference: Path, unit: Path, method: str = "velocity", **settings: Any) -> Outcome:
    chosen = {**KIND.defaults(), "method": method, **settings}
    return KIND.run([reference, unit], chosen)


def wrong_start(**change: float) -> dict[str, Any]:
    initial = initial_state(carrier())
    return {**initial, **{name: float(str(initial[name])) + by for name, by in change.items()}}


@pytest.mark.parametrize("method", METHODS)
def test_a_copied_start_shows_how_the_unit_is_mounted(tmp_path: Path, method: str) -> None:
    data = aligned(reference(tmp_path), unit(tmp_path), method).data
    truth = carrier().C_bn[-1] @ MOUNTING
    if method in ("velocity", "position"):
        # the computed frame keeps how it stood at the start; Earth and drift turn it by some 0.02°
        truth = carrier().C_bn[0] @ MOUNTING
    u = np.array(data["standard_uncertainty_deg"])
    assert np.all(
        np.abs(data["misalignment_deg"] - np.degrees(truth)) < 3.5 * u + 0.15 * (method == "position")
    )
    assert np.all(u < [0.2, 0.2, 1.2])
    # the unit has no scale errors, of which the filter considers some
    assert 0.7 * data["nis_expected"] < data["nis_mean"] < data["nis_band"][1]
    assert ("mounting_deg" in data) == (method not in ("velocity", "position"))


def test_azimuth_in_a_bank_is_not_misled_by_a_mounting_about_the_wing(tmp_path: Path) -> None:
    """A carrier that always hangs by 3°, a case that is pitched and rolled in it, sensors without errors:
    what is found has to be far nearer than its uncertainty says."""
    turned = np.radians([1.5, -1.0, 0.8])
    hanging = carrier().mounted(rotation_from_vector(np.radians([0.0, 3.0, 0.0])))
    pitched = hanging.mounted(rotation_from_vector(turned))
    shown = bundle(tmp_path / "reference", flight_samples(hanging, reference=True), 20.0)
    unit = bundle(tmp_path / "unit", flight_samples(pitched), 20.0)
    data = aligned(shown, unit, "velocity-azimuth", level_limit_deg=10.0).data
    assert data["mounting_deg"] == pytest.approx(np.degrees(turned), abs=0.01)
    assert data["misalignment_deg"] == pytest.approx(np.degrees(hanging.C_bn[-1] @ turned), abs=0.01)
    assert data["nis_mean"] < 0.5


def test_biases_come_out_within_what_is_said(tmp_path: Path) -> None:
    data = aligned(reference(tmp_path), unit(tmp_path), "velocity-attitude").data
    assert data["mounting_deg"] == pytest.approx(np.degrees(MOUNTING), abs=0.02)
    for value, truth, u in (
        ("gyro_bias_deg_per_h", GYRO_BIAS_DEG_PER_H, "gyro_bias_standard_uncertainty_deg_per_h"),
        ("accel_bias_mps2", ACCEL_BIAS_MPS2, "accel_bias_standard_uncertainty_mps2"),
    ):
        assert np.all(np.abs(np.array(data[value]) - truth) < 3.5 * np.array(data[u]))
    assert aligned(reference(tmp_path / "2"), tmp_path / "unit").data["gyro_bias_deg_per_h"] == [None] * 3


def test_a_wrong_initial_attitude_is_the_misalignment(tmp_path: Path) -> None:
    """Heading 1.5° too far clockwise is −1.5° about up, pitch 0.5° too high at heading 120° about the
    wing."""
    start = wrong_start(heading_deg=1.5, pitch_deg=0.5)
    data = aligned(reference(tmp_path), unit(tmp_path, mounting=np.zeros(3), initial=start)).data
    heading = np.radians(120.0)
    truth = np.array([-0.5 * np.cos(heading), 0.5 * np.sin(heading), 1.5])
    u = np.array(data["standard_uncertainty_deg"])
    assert np.all(np.abs(data["misalignment_deg"] - truth) < 3.5 * u)
    assert np.all(u < [0.1, 0.1, 0.6])


def test_the_report_shows_convergence_innovations_and_what_was_not_seen(tmp_path: Path) -> None:
    outcome = aligned(reference(tmp_path), unit(tmp_path), "velocity-attitude")
    titles = [chart.title.text() for chart in outcome.report.charts]
    assert titles[0].startswith("Misalignment of the computed frame")
    assert any(title.startswith("Innovations of angle") for title in titles)
    assert any("NIS" in title for title in titles)
    first = outcome.report.charts[0].curves[0]
    assert first.low is not None
    assert first.low[-1] < first.y[-1]
    text = report_text(outcome.report)
    assert "did not show δL" in text
    assert report_text(outcome.report, "zh").count("机动未能反映") == 1
    files = write_outcome(outcome, tmp_path / "out")
    assert files["series"].read_text(encoding="utf-8").startswith("t_s,nis,misalignment_e_deg")


def test_no_manoeuvre_is_told(tmp_path: Path) -> None:
    flight = fly(Start(latitude_deg=45.0, speed_mps=70.0), (Steady(40),), 20.0)
    one = bundle(tmp_path / "r", flight_samples(flight, reference=True), 20.0)
    other = bundle(tmp_path / "u", flight_samples(flight), 20.0)
    outcome = aligned(one, other)
    assert outcome.data["not_shown"] == ["φ_U"]
    assert "S-turns" in report_text(outcome.report)


def test_a_bias_far_beyond_the_assumption_widens_it(tmp_path: Path) -> None:
    def biased(s: Samples) -> Samples:
        return s.with_columns({"gyro_y": s["gyro_y"] + 120.0 / 3600})

    data = aligned(reference(tmp_path), unit(tmp_path, change=biased), "velocity-attitude").data
    assert "gyro bias: 11" in data["warnings"][0]
    away = np.array(data["gyro_bias_deg_per_h"]) - GYRO_BIAS_DEG_PER_H - [0.0, 120.0, 0.0]
    assert np.all(np.abs(away) < 3.5 * np.array(data["gyro_bias_standard_uncertainty_deg_per_h"]))
    assert data["mounting_deg"] == pytest.approx(np.degrees(MOUNTING), abs=0.07)


def test_too_little_noise_assumed_is_told(tmp_path: Path) -> None:
    outcome = aligned(reference(tmp_path), unit(tmp_path), velocity_noise_mps=0.005)
    assert "larger than assumed" in outcome.data["warnings"][0]


def test_other_sample_rates_and_a_later_start_go_together(tmp_path: Path) -> None:
    whole = aligned(reference(tmp_path), unit(tmp_path)).data
    late = aligned(
        reference(tmp_path / "late", rate_hz=2.5, change=lambda s: s.rows(25)), tmp_path / "unit", "velocity"
    ).data
    away = np.abs(np.array(late["misalignment_deg"]) - whole["misalignment_deg"])
    assert np.all(away < 4 * np.array(late["standard_uncertainty_deg"]) + 0.3)
    assert late["t_s"] == pytest.approx(whole["t_s"], abs=1.5)


def test_a_unit_that_knows_its_state_may_begin_before_the_reference(tmp_path: Path) -> None:
    start = wrong_start(heading_deg=0.7)
    late = reference(tmp_path, change=lambda s: s.rows(50))
    data = aligned(late, unit(tmp_path, mounting=np.zeros(3), initial=start)).data
    u = np.array(data["standard_uncertainty_deg"])
    assert np.all(np.abs(data["misalignment_deg"] - np.array([0.0, 0.0, 0.7])) < 3.5 * u)
    del start["velocity_enu_mps"]
    with pytest.raises(InputError, match="does not give its whole state"):
        aligned(late, unit(tmp_path / "less", initial=start))


def test_columns_that_are_not_compared_may_be_empty(tmp_path: Path) -> None:
    def unknown(s: Samples) -> Samples:
        rates = {name: np.zeros(len(s)) for name in GYRO}
        return s.with_columns({**rates, **{n: np.full(len(s), np.nan) for n in ("heading_deg", "pitch_deg")}})

    empty = reference(tmp_path, change=unknown)
    whole = unit(tmp_path, initial=wrong_start(), mounting=np.zeros(3))
    assert len(aligned(empty, whole).data["misalignment_deg"]) == 3
    with pytest.raises(InputError, match=r"no column heading_deg|no two rows"):
        aligned(empty, whole, "velocity-attitude")


def test_a_reference_without_a_usable_row_says_why(tmp_path: Path) -> None:
    empty = reference(tmp_path, change=lambda s: s.with_columns({"heading_deg": np.full(len(s), np.nan)}))
    with pytest.raises(InputError, match="can be used: "):
        aligned(empty, unit(tmp_path))


def test_position_alone_is_enough_for_position(tmp_path: Path) -> None:
    names = ("ve_mps", "vn_mps", "vu_mps")
    only = reference(
        tmp_path,
        change=lambda s: Samples({name: column for name, column in s.columns.items() if name not in names}),
    )
    outcome = aligned(only, unit(tmp_path), "position", velocity_mps=10.0)
    assert "slope of the position" in outcome.data["warnings"][0]
    assert np.all(np.array(outcome.data["standard_uncertainty_deg"])[:2] < 0.3)


def test_velocity_alone_is_enough_for_velocity(tmp_path: Path) -> None:
    names = ("ve_mps", "vn_mps", "vu_mps")
    only = reference(
        tmp_path,
        change=lambda s: Samples({name: s[name] for name in ("t_s", *names)}),
    )
    with pytest.raises(InputError, match="how the unit stands at the start"):
        aligned(only, unit(tmp_path))
    whole = unit(tmp_path / "told", initial=wrong_start(), mounting=np.zeros(3))
    outcome = aligned(only, whole)
    assert "reckoned from its velocity" in outcome.data["warnings"][0]
    assert np.all(
        np.abs(outcome.data["misalignment_deg"]) < 3.5 * np.array(outcome.data["standard_uncertainty_deg"])
    )


def without(name: str) -> Callable[[Samples], Samples]:
    return lambda s: Samples({key: column for key, column in s.columns.items() if key != name})


def shifted(by: float) -> Callable[[Samples], Samples]:
    return lambda s: s.with_columns({"t_s": s["t_s"] + by})


def without_force(s: Samples) -> Samples:
    return s.with_columns({"accel_x": np.full(len(s), np.nan)})


def holed(s: Samples) -> Samples:
    keep = (s["t_s"] < 30) | (s["t_s"] > 33)
    return Samples({name: column[keep] for name, column in s.columns.items()})


@pytest.mark.parametrize(
    "change",
    [
        lambda s: s.with_columns({"accel_x": s["accel_z"], "accel_z": s["accel_x"]}),
        lambda s: s.with_columns({name: np.radians(s[name]) for name in GYRO}),
        lambda s: s.with_columns({"gyro_x": s["gyro_x"] + 1e5}),
    ],
    ids=["axes", "units", "nonsense"],
)
@pytest.mark.parametrize("method", METHODS)
def test_recordings_that_contradict_each_other_are_refused(
    tmp_path: Path, change: Callable[[Samples], Samples], method: str
) -> None:
    with pytest.raises(InputError, match="contradict each other"):
        aligned(reference(tmp_path), unit(tmp_path, change=change), method)


@pytest.mark.parametrize(
    ("of_reference", "of_unit", "method", "settings", "what"),
    [
        (without("vn_mps"), None, "velocity", {}, "no column vn_mps, which the method velocity"),
        (without("roll_deg"), None, "velocity-attitude", {}, "no column roll_deg"),
        (shifted(1000.0), None, "velocity", {}, "do not overlap"),
        (lambda s: s.rows(0, 6), None, "velocity", {}, "instants in common"),
        (
            lambda s: s.with_columns({"latitude_deg": s["latitude_deg"] * 60}),
            None,
            "velocity",
            {},
            "in degrees",
        ),
        (
            lambda s: s.with_columns({"latitude_deg": s["latitude_deg"] + 44}),
            None,
            "velocity",
            {},
            "near a pole",
        ),
        (None, without("accel_z"), "velocity", {}, "no accelerometer"),
        (None, without_force, "velocity", {}, "not one row has numbers"),
        (None, holed, "velocity", {}, "too long to navigate over"),
        (None, lambda s: s.with_columns({n: s[n] / 9.8 for n in ACCEL}), "velocity", {}, "look like g"),
        (None, None, "velocity", {"velocity_noise_mps": 0.0}, "above 0"),
        (None, None, "velocity", {"level_deg": float("nan")}, "above 0"),
        (None, None, "velocity-attitude", {"attitude_noise_deg": 1e300}, "at most 1000000"),
        (None, None, "velocity", {"every_s": -1.0}, "above 0"),
        (None, None, "angles", {}, "no method angles"),
        (None, None, "velocity", {"reference_segment": "x"}, "has no segment x"),
    ],
)
def test_what_cannot_be_aligned_is_told(
    tmp_path: Path,
    of_reference: Callable[[Samples], Samples] | None,
    of_unit: Callable[[Samples], Samples] | None,
    method: str,
    settings: dict[str, Any],
    what: str,
) -> None:
    with pytest.raises(InputError, match=what):
        aligned(reference(tmp_path, change=of_reference), unit(tmp_path, change=of_unit), method, **settings)


def test_a_place_that_is_none_is_told_where_the_reference_has_none(tmp_path: Path) -> None:
    names = ("latitude_deg", "longitude_deg", "altitude_m")
    shown = reference(
        tmp_path, change=lambda s: Samples({n: c for n, c in s.columns.items() if n not in names})
    )
    for place in ("north", [45.0]):
        broken = {**initial_state(carrier()), "latitude_deg": place}
        with pytest.raises(InputError, match="latitude_deg is no number"):
            aligned(shown, unit(tmp_path / str(place), initial=broken))


def test_what_is_known_exactly_is_not_missed(tmp_path: Path) -> None:
    data = aligned(reference(tmp_path), unit(tmp_path, mounting=0 * MOUNTING), level_deg=0.0).data
    assert not {"φ_E", "φ_N"} & set(data["not_shown"])


def test_an_initial_state_that_is_none_is_told(tmp_path: Path) -> None:
    broken = {**wrong_start(), "heading_deg": "north"}
    with pytest.raises(InputError, match="heading_deg is no number"):
        aligned(reference(tmp_path), unit(tmp_path, initial=broken))
    short = {**wrong_start(), "velocity_enu_mps": [1.0]}
    with pytest.raises(InputError, match="three numbers"):
        aligned(tmp_path / "reference", unit(tmp_path / "short", initial=short))


def test_a_short_gap_is_bridged_and_told(tmp_path: Path) -> None:
    def gap(s: Samples) -> Samples:
        keep = (s["t_s"] < 30) | (s["t_s"] > 30.3)
        return Samples({name: column[keep] for name, column in s.columns.items()})

    data = aligned(reference(tmp_path), unit(tmp_path, change=gap)).data
    assert any("are bridged" in warning for warning in data["warnings"])


def test_a_lever_arm_between_the_systems_is_taken_out(tmp_path: Path) -> None:
    flight = carrier()
    lever = np.array([2.0, 8.0, 0.0])
    swing = np.gradient(flight.C_bn @ lever, flight.t_s, axis=0)
    moved = replace(flight, velocity_enu_mps=flight.velocity_enu_mps - swing)
    one = bundle(tmp_path / "r", flight_samples(moved, reference=True), 20.0)
    other = bundle(tmp_path / "u", flight_samples(flight), 20.0)
    arm: dict[str, Any] = {"lever_x_m": 2.0, "lever_y_m": 8.0}
    with_it, without_it = (aligned(one, other, **each).data["nis_mean"] for each in (arm, {}))
    assert with_it < 0.05 * without_it
