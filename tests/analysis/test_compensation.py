"""A calibration set undoes exactly what the unit did: any motion, counts or rates, as a recording, as C."""

from __future__ import annotations

import csv
import json
import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from ahrs_lab.analysis.calibration_set_file import header_text, read_set, save_set
from ahrs_lab.analysis.compensation import compensate, compensate_recording
from ahrs_lab.analysis.imu_calibration import calibrate_recording
from ahrs_lab.analysis.report import report_text
from ahrs_lab.errors import InputError
from ahrs_lab.inertial.sensor_model import AccelModel, GyroModel, Matrix
from ahrs_lab.metrology.imu_calibration import Coefficients, ImuCalibration
from ahrs_lab.recording.read import read_bundle
from tests.analysis.imu_bundle import GRAVITY_MPS2, Recorder, changed, unit

Array = NDArray[np.float64]


def nested(matrix: Array) -> Matrix:
    x, y, z = (tuple(row) for row in matrix.tolist())
    return (x, y, z)


def motion(seed: int, rows: int = 50) -> tuple[Array, Array]:
    rng = np.random.default_rng(seed)
    return rng.normal(0.0, 100.0, (rows, 3)), rng.normal(0.0, 10.0, (rows, 3))


@settings(max_examples=50)
@given(st.integers(0, 2**32 - 1), st.sampled_from([1.0, 0.0174533, -3e4]))
def test_compensation_undoes_the_sensor_model(seed: int, scale: float) -> None:
    true = unit(seed, scale, 2.0 * scale)
    rate, force = motion(seed)
    gyro = GyroModel(
        scale_factor=tuple(true.gyro.E1),
        bias_dps=tuple(true.gyro.B0),
        g_sensitivity=nested(true.gyro.Bf),
        misalignment_rad=nested(true.gyro.E),
        range_dps=1e9,
    )
    accel = AccelModel(tuple(true.accel.K1), tuple(true.accel.K0), nested(true.accel.K), 1e9)
    outputs = gyro.output(rate.T, force.T).T, accel.output(force.T).T
    back, felt = compensate(ImuCalibration(true), *outputs)
    assert felt is not None
    assert back == pytest.approx(rate, abs=1e-10)
    assert felt == pytest.approx(force, abs=1e-11)


def test_in_increments_every_term_accumulates_over_the_interval() -> None:
    """(2-190), (2-191) written out, with τ beside the drift and beside the f-terms."""
    true = unit(8, 200.0, 50.0)
    rate, force = motion(8)
    recorder = Recorder(true)
    tau = np.linspace(0.005, 0.02, len(rate))[:, np.newaxis]
    pulses, accel_pulses = (output * tau for output in recorder.output(rate, force))
    g, a = true.gyro, true.accel
    velocity = accel_pulses / a.K1
    f = (np.linalg.inv(np.eye(3) + a.K) @ (velocity - a.K0 * tau).T).T / tau
    angle = pulses / g.E1
    w = (np.linalg.inv(np.eye(3) + g.E) @ (angle - g.B0 * tau - (f @ g.Bf.T) * tau).T).T / tau
    back, felt = compensate(ImuCalibration(true), pulses, accel_pulses, tau[:, 0])
    assert felt == pytest.approx(f, rel=1e-12, abs=1e-12)
    assert back == pytest.approx(w, rel=1e-12, abs=1e-12)
    assert w == pytest.approx(rate, abs=1e-10)


def a_set(folder: Path, recorder: Recorder) -> ImuCalibration:
    return calibrate_recording(
        read_bundle(recorder.write(folder / "calibration", recorder.everything("8")))
    ).calibration


@pytest.mark.parametrize(
    ("rate_unit", "accel_unit", "scale"), [("LSB", "LSB", 5000.0), ("deg/s", "m/s^2", 1.0)]
)
def test_another_recording_of_the_unit_comes_out_true(
    tmp_path: Path, rate_unit: str, accel_unit: str, scale: float
) -> None:
    recorder = Recorder(unit(9, scale, scale), rate_unit, accel_unit)
    found = a_set(tmp_path, recorder)
    rate, force = motion(3)
    made = [recorder.moving("flight", rate, force), *recorder.everything("6")[6:]]
    source = read_bundle(recorder.write(tmp_path / "source", made, "dynamic", order="7"))
    compensated = compensate_recording(source, found, set_sha256="ab", software="s")
    compensated.write(tmp_path / "out")
    back = read_bundle(tmp_path / "out")
    device = back.header.device
    assert (device.rate_unit, device.accel_unit) == ("deg/s", "m/s^2")
    assert back.header.procedure == "dynamic"
    flight = back.segments[0]
    assert flight.segment.file == "flight.csv"
    assert flight.samples.matrix(("gyro_x", "gyro_y", "gyro_z")) == pytest.approx(rate, abs=1e-6)
    assert flight.samples.matrix(("accel_x", "accel_y", "accel_z")) == pytest.approx(force, abs=1e-7)
    assert flight.samples["t_s"].tolist() == source.segments[0].samples["t_s"].tolist()
    assert "table_angle_deg" in back.segments[1].samples
    said = back.header.notes["compensation"]
    assert said["source_sha256"] == source.sha256
    assert said["set_sha256"] == "ab"
    assert said["set"]["bundle_sha256"]
    assert back.header.notes["order"] == "7"
    checks = compensated.checks
    assert len(checks) == 6
    for check in checks:
        assert check.force_before_mps2 is not None
        assert check.force_after_mps2 is not None
        assert np.linalg.norm(check.rate_before_dps) > 1e-3
        assert np.linalg.norm(check.rate_after_dps) < 1e-9
        assert np.linalg.norm(check.force_before_mps2) > 1e-3
        assert np.linalg.norm(check.force_after_mps2) < 1e-8
    assert compensated.warnings == ()
    assert "ω = (I + E)⁻¹" in report_text(compensated.report())
    json.dumps(compensated.to_json(), allow_nan=False)


def test_the_compensated_recording_can_be_packed(tmp_path: Path) -> None:
    recorder = Recorder(unit(9))
    source = read_bundle(recorder.write(tmp_path / "source", recorder.everything("6")[6:], "static"))
    compensate_recording(source, ImuCalibration(recorder.unit)).write(tmp_path / "out.ahrsrec")
    assert (tmp_path / "out.ahrsrec").is_file()
    assert len(read_bundle(tmp_path / "out.ahrsrec").segments) == 6


def test_nothing_is_compensated_twice(tmp_path: Path) -> None:
    recorder = Recorder(unit(9))
    found = a_set(tmp_path, recorder)
    source = read_bundle(recorder.write(tmp_path / "source", recorder.everything("6")[6:], "static"))
    compensate_recording(source, found).write(tmp_path / "out")
    with pytest.raises(InputError, match="compensated already"):
        compensate_recording(read_bundle(tmp_path / "out"), found)
    with pytest.raises(InputError, match="not empty"):
        compensate_recording(source, found).write(tmp_path / "out")


def test_a_set_of_another_unit_of_measurement_is_refused(tmp_path: Path) -> None:
    counts = Recorder(unit(9, 100.0), "LSB")
    found = a_set(tmp_path, counts)
    rates = Recorder(unit(9))
    source = read_bundle(rates.write(tmp_path / "source", rates.everything("6")[6:], "static"))
    with pytest.raises(InputError, match=r"rate_unit is deg/s, but the calibration set was made .* LSB"):
        compensate_recording(source, found)
    bare = ImuCalibration(found.coefficients)
    with pytest.raises(InputError, match=r"E1 is .* needs about 1: "):
        compensate_recording(source, bare)


def test_a_set_of_another_device_and_one_that_does_not_fit_are_doubted(tmp_path: Path) -> None:
    recorder = Recorder(unit(9))
    found = a_set(tmp_path, recorder)
    other = ImuCalibration(
        found.coefficients, "deg/s", "m/s^2", provenance={"serial_number": "T-2", "bundle_sha256": "x"}
    )
    made = recorder.everything("6")[6:]
    source = read_bundle(recorder.write(tmp_path / "source", made, "static"))
    (warning,) = compensate_recording(source, other).warnings
    assert "s/n T-2" in warning.text()
    gyro, accel = found.coefficients.vectors()
    accel[:, 0] *= 1.2
    wrong = ImuCalibration(Coefficients.from_vectors(gyro, accel), provenance={"bundle_sha256": "x"})
    (warning,) = compensate_recording(source, wrong).warnings
    assert f"off by {GRAVITY_MPS2 * (1 - 1 / 1.2):.3g}" in warning.text()


def test_rows_and_columns_that_cannot_be_compensated_are_left_out_and_said(tmp_path: Path) -> None:
    recorder = Recorder(unit(9))
    found = a_set(tmp_path, recorder)
    made = recorder.everything("6")[6:]
    holes = made[0][1]["accel_y"].copy()
    holes[5:8] = np.nan
    made = changed(made, 0, accel_y=holes, angle_x=np.ones(len(holes)))
    compensated = compensate_recording(read_bundle(recorder.write(tmp_path / "a", made, "static")), found)
    assert len(compensated.segments[0][1]) == len(holes) - 3
    assert "angle_x" not in compensated.segments[0][1]
    texts = [w.text() for w in compensated.warnings]
    assert any("3 rows without numbers" in text for text in texts)
    assert any("angle_x, the unit's own sums" in text for text in texts)
    without = changed(made, 1, accel_x=None)
    with pytest.raises(InputError, match=r"position_02\.csv has no column accel_x"):
        compensate_recording(read_bundle(recorder.write(tmp_path / "b", without, "static")), found)


def test_gyros_alone_are_compensated_where_the_set_needs_no_force(tmp_path: Path) -> None:
    true = unit(9)
    true.gyro.Bf[:] = 0.0
    recorder = Recorder(true)
    rate, force = motion(4)
    segment, samples = recorder.moving("flight", rate, force)
    alone = type(samples)({n: c for n, c in samples.columns.items() if not n.startswith("accel")})
    source = read_bundle(recorder.write(tmp_path / "a", [(segment, alone)], "dynamic"))
    compensated = compensate_recording(source, ImuCalibration(true, provenance={"bundle_sha256": "x"}))
    assert compensated.segments[0][1].matrix(("gyro_x", "gyro_y", "gyro_z")) == pytest.approx(rate, abs=1e-10)
    with pytest.raises(ValueError, match="Bf needs"):
        compensate(ImuCalibration(unit(9)), rate, None)


def test_the_set_as_csv_holds_every_coefficient_in_full(tmp_path: Path) -> None:
    found = a_set(tmp_path, Recorder(unit(9)))
    save_set(found, tmp_path / "set.csv")
    with (tmp_path / "set.csv").open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    assert len(rows) == 33
    values = {(r["coefficient"], r["channel"], r["input"]): float(r["value"]) for r in rows}
    assert values["E", "x", "z"] == found.gyro.E[0, 2]
    assert values["Bf", "z", "y"] == found.gyro.Bf[2, 1]
    assert values["K0", "y", ""] == found.accel.K0[1]
    assert {r["unit"] for r in rows if r["coefficient"] == "B0"} == {"°/s"}


def test_the_set_as_json_is_read_back_and_an_unknown_form_refused(tmp_path: Path) -> None:
    found = a_set(tmp_path, Recorder(unit(9)))
    save_set(found, tmp_path / "set.json")
    back, sha256 = read_set(tmp_path / "set.json")
    assert back.gyro.Bf.tolist() == found.gyro.Bf.tolist()
    assert len(sha256) == 64
    with pytest.raises(InputError, match=r"\.json, \.csv or \.h"):
        save_set(found, tmp_path / "set.xlsx")


@pytest.mark.parametrize(
    ("content", "named"),
    [
        (b"", "not JSON"),
        (b"\xff\xfe", "not JSON"),
        (b"[" * 100_000, "not JSON"),
        (b"[1]", "an object"),
        (b'{"gyro": {}}', "accel|E1"),
        (b" " * (4 * 2**20 + 1), "too large"),
    ],
)
def test_a_file_that_is_no_set_is_refused(tmp_path: Path, content: bytes, named: str) -> None:
    (tmp_path / "set.json").write_bytes(content)
    with pytest.raises(InputError, match=named):
        read_set(tmp_path / "set.json")
    with pytest.raises(InputError, match="cannot be read"):
        read_set(tmp_path / "none.json")


C_PROGRAM = """#include <stdio.h>
#include "set.h"
int main(void)
{
    double n[3], a[3], w[3], f[3];
    while (scanf("%lf%lf%lf%lf%lf%lf", n, n + 1, n + 2, a, a + 1, a + 2) == 6) {
        imu_compensate(n, a, w, f);
        printf("%.17g %.17g %.17g %.17g %.17g %.17g\\n", w[0], w[1], w[2], f[0], f[1], f[2]);
    }
    return 0;
}
"""


@pytest.mark.skipif(shutil.which("cc") is None, reason="there is no C compiler")
def test_the_c_header_compiles_and_compensates_alike(tmp_path: Path) -> None:
    true = unit(10, 300.0, 100.0)
    found = ImuCalibration(
        true, "LSB", "LSB", provenance={"device": "a */ int x; /* 航姿", "serial_number": "1\n2"}
    )
    save_set(found, tmp_path / "set.h")
    assert header_text(found) == (tmp_path / "set.h").read_text(encoding="ascii")
    (tmp_path / "use.c").write_text(C_PROGRAM, encoding="ascii")
    flags = ["-std=c99", "-Wall", "-Wextra", "-Wpedantic", "-Werror", "-O1"]
    subprocess.run(["cc", *flags, "use.c", "-o", "use"], cwd=tmp_path, check=True, capture_output=True)
    rate, force = motion(5)
    outputs = np.hstack(Recorder(true).output(rate, force))
    lines = "\n".join(" ".join(repr(float(v)) for v in row) for row in outputs)
    shown = subprocess.run(
        [str(tmp_path / "use")], input=lines, capture_output=True, text=True, check=True
    ).stdout
    back = np.array([[float(v) for v in line.split()] for line in shown.splitlines()])
    assert back == pytest.approx(np.hstack([rate, force]), abs=1e-10)
