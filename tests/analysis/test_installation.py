"""Installation angles on recordings: what is read, what is refused, what the corrected copy holds."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from ahrs_lab.analysis.installation import (
    bracket_from_json,
    bracket_to_json,
    calibrate_bracket,
    compensate_angles,
    compensate_recording,
    known_bracket,
    level_reading,
)
from ahrs_lab.analysis.report import report_text
from ahrs_lab.errors import InputError
from ahrs_lab.inertial.installation import LevelCarrier
from ahrs_lab.laboratory.analyses import analyses
from ahrs_lab.laboratory.analyses.files import write_outcome
from ahrs_lab.recording.orientation import Orientation
from ahrs_lab.recording.read import read_bundle
from ahrs_lab.recording.samples import ATTITUDE, Samples
from ahrs_lab.recording.segment import DeviceDescription, RecordingHeader, Segment, Site
from ahrs_lab.recording.write import BundleWriter

LEVEL = LevelCarrier(0.0, 0.0, 0.7)


def segment(name: str) -> Segment:
    return Segment(name, Orientation("ENU"), "dynamic", "z", "position")


def angles_bundle(folder: Path, angles: Any, takes: int = 1) -> Path:
    """A recording of heading, pitch and roll only, ``angles`` (n, 3)."""
    rows = np.asarray(angles, dtype=float)
    header = RecordingHeader("dynamic", Site(39.9), DeviceDescription(sample_rate_hz=10.0))
    with BundleWriter(folder, header, file_format="csv") as writer:
        for _ in range(takes):
            writer.begin(segment("run"))
            times = (np.arange(len(rows)) + 1) / 10
            writer.append(
                Samples({"t_s": times, **dict(zip(ATTITUDE, rows.T, strict=True)), "extra": times**2})
            )
            writer.finish()
    return folder


def test_the_bracket_of_a_recording_is_its_mean_pitch_and_roll(tmp_path: Path) -> None:
    rng = np.random.default_rng(4)
    rows = np.column_stack([np.full(2000, 33.0), rng.normal(0.4, 0.05, 2000), rng.normal(-0.6, 0.05, 2000)])
    recording = read_bundle(angles_bundle(tmp_path, rows))
    reading = LevelCarrier(0.0, 0.0, 0.7, u_attitude_deg=0.0, u_level_deg=0.0, u_heading_error_deg=0.02)
    result = level_reading(recording, None, reading)
    data = result.to_json()
    assert data["bracket_deg"]["heading"] == pytest.approx(0.7)
    assert data["bracket_deg"]["pitch"] == pytest.approx(0.4, abs=0.005)
    assert data["bracket_deg"]["roll"] == pytest.approx(-0.6, abs=0.005)
    assert data["standard_uncertainty_deg"]["pitch"] == pytest.approx(0.05 / 2000**0.5, rel=0.8)
    assert data["warnings"] == []
    assert "C(carrier) = C(unit)·D" in report_text(result.report())


def test_a_carrier_that_moved_is_told(tmp_path: Path) -> None:
    rows = np.column_stack([np.zeros(100), np.linspace(0.0, 0.3, 100), np.zeros(100)])
    result = level_reading(read_bundle(angles_bundle(tmp_path, rows)), "run", LEVEL)
    assert "moved by" in result.warnings[0].text()


def test_a_carrier_that_was_not_level_all_the_time_is_refused(tmp_path: Path) -> None:
    rows = np.column_stack([np.zeros(100), np.linspace(0.0, 34.0, 100), np.zeros(100)])
    with pytest.raises(InputError, match="record it at rest"):
        level_reading(read_bundle(angles_bundle(tmp_path, rows)), "run", LEVEL)


@pytest.mark.parametrize(
    ("reading", "what"),
    [
        (LevelCarrier(91.0, 0.0, 0.0), "the unit's pitch is 91.0"),
        (LevelCarrier(0.0, float("nan"), 0.0), "the unit's roll is nan"),
        (LevelCarrier(0.0, 0.0, float("inf")), "heading error is inf"),
        (LevelCarrier(0.0, 0.0, 0.0, carrier_pitch_deg=2.0), "from level"),
        (LevelCarrier(0.0, 0.0, 0.0, carrier_roll_deg=float("nan")), "from level"),
        (LevelCarrier(0.0, 0.0, 0.0, u_level_deg=-0.1), "0 or more"),
        (LevelCarrier(89.9, 0.0, 0.0), "no heading"),
    ],
)
def test_readings_that_cannot_be_are_refused(reading: LevelCarrier, what: str) -> None:
    with pytest.raises(InputError, match=what):
        calibrate_bracket(reading)


def test_too_few_rows_or_no_angles_are_refused(tmp_path: Path) -> None:
    recording = read_bundle(angles_bundle(tmp_path, np.zeros((5, 3))))
    with pytest.raises(InputError, match="too few"):
        level_reading(recording, None, LEVEL)
    with pytest.raises(InputError, match="No usable segment"):
        level_reading(recording, "other", LEVEL)


def test_the_set_survives_json_with_what_is_unknown() -> None:
    calibrated = calibrate_bracket(
        LevelCarrier(1.0, -2.0, 3.0, u_attitude_deg=0.1, u_level_deg=0.1)
    ).calibrated
    back = bracket_from_json(bracket_to_json(calibrated), "set.json")
    assert back.angles == calibrated.angles
    np.testing.assert_array_equal(back.covariance_deg2, calibrated.covariance_deg2)
    assert np.isnan(back.standard_uncertainty_deg[0])


@pytest.mark.parametrize("data", [{}, [], None, {"bracket_deg": {"heading": "x"}, "direction": "sideways"}])
def test_what_is_no_set_is_refused(data: object) -> None:
    with pytest.raises(InputError, match="no set of installation angles"):
        bracket_from_json(data, "set.json")


def test_every_row_becomes_the_carriers_and_the_copy_says_how(tmp_path: Path) -> None:
    rng = np.random.default_rng(5)
    carrier = np.column_stack([rng.uniform(0, 360, 50), rng.uniform(-80, 80, 50), rng.uniform(-170, 170, 50)])
    box = Rotation.from_euler("ZXY", carrier * [-1, 1, 1], degrees=True) * Rotation.from_euler(
        "ZXY", [-5.0, 2.0, 3.0], degrees=True
    )
    source = angles_bundle(tmp_path / "in", box.as_euler("ZXY", degrees=True) * [-1, 1, 1], takes=2)
    result = compensate_recording(read_bundle(source), known_bracket(5.0, 2.0, 3.0))
    np.testing.assert_allclose(result.corrected_deg, carrier, atol=1e-10)
    assert result.to_json()["last"]["heading_deg"] == pytest.approx(carrier[-1, 0])

    (kind,) = [kind for kind in analyses() if kind.key == "installation-compensate"]
    settings = {"bracket_heading_deg": 5.0, "bracket_pitch_deg": 2.0, "bracket_roll_deg": 3.0}
    outcome = kind.run([source], {**kind.defaults(), **settings})
    files = write_outcome(outcome, tmp_path / "out")
    copy = read_bundle(files["corrected"])
    assert [one.segment.superseded for one in copy.segments] == [True, False]
    np.testing.assert_allclose(copy.segments[1].samples.matrix(ATTITUDE), carrier, atol=1e-10)
    np.testing.assert_array_equal(
        copy.segments[1].samples["extra"], read_bundle(source).segments[1].samples["extra"]
    )
    assert copy.header.notes["installation"]["bracket_deg"] == {"heading": 5.0, "pitch": 2.0, "roll": 3.0}
    assert copy.header.notes["installation"]["source_sha256"] == read_bundle(source).sha256
    with pytest.raises(InputError, match="carrier's already"):
        compensate_recording(copy, known_bracket(5.0, 2.0, 3.0))


def test_gimbal_lock_is_counted_and_explained(tmp_path: Path) -> None:
    source = angles_bundle(tmp_path, [[10.0, 88.0, 0.0], [10.0, 88.5, 0.0], [10.0, 20.0, 0.0]])
    result = compensate_recording(read_bundle(source), known_bracket(0.0, -1.5, 0.0))
    assert result.to_json()["gimbal_lock_rows"] == 1
    assert "Gimbal lock" in result.report().warnings[0].text()
    assert compensate_angles(10.0, 88.5, 0.0, known_bracket(0.0, -1.5, 0.0)).to_json()["gimbal_lock"] is True


def test_columns_out_of_order_are_noticed(tmp_path: Path) -> None:
    source = angles_bundle(tmp_path, [[1.0, 200.0, 0.0], [1.0, 201.0, 0.0]])
    with pytest.raises(InputError, match="pitch_deg reaches 201"):
        compensate_recording(read_bundle(source), known_bracket(0.0, 0.0, 0.0))
