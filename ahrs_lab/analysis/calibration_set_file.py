"""A calibration set as a file: JSON (both ways), CSV for a table, a C header for the unit's own software."""

from __future__ import annotations

import csv
import hashlib
import io
import json
from pathlib import Path
from typing import BinaryIO

import numpy as np
from numpy.typing import NDArray

from ahrs_lab.analysis.imu_report import coefficient_rows
from ahrs_lab.errors import InputError
from ahrs_lab.metrology.imu_calibration import AXES, ImuCalibration
from ahrs_lab.metrology.imu_calibration_json import from_json, to_json
from ahrs_lab.recording.machine_faults import machine_faults, write_atomically

Array = NDArray[np.float64]

MOST_BYTES = 4 * 2**20


def read_set(path: Path) -> tuple[ImuCalibration, str]:
    """The set in a JSON file, and the file's SHA-256; raises InputError for anything else."""
    try:
        with path.open("rb") as file:
            data = file.read(MOST_BYTES + 1)
    except OSError as error:
        raise InputError("{path} cannot be read ({reason}).", path=path, reason=error.strerror) from error
    if len(data) > MOST_BYTES:
        raise InputError("{path} is too large for a calibration set: is it the right file?", path=path)
    try:
        found = json.loads(data.decode("utf-8-sig"))
    except (ValueError, RecursionError) as error:
        raise InputError(
            "{path} is not a calibration set: it is not JSON ({reason}). Give the file that “ahrs-lab "
            "imu-calibrate --save SET.json” wrote.",
            path=path,
            reason=str(error),
        ) from error
    return from_json(found), hashlib.sha256(data).hexdigest()


def save_set(found: ImuCalibration, path: Path) -> None:
    """Write the set as the suffix says: .json, .csv or .h."""
    forms = {".json": json_text, ".csv": csv_text, ".h": header_text}
    form = forms.get(path.suffix.lower())
    if form is None:
        raise InputError("{path}: a calibration set is saved as .json, .csv or .h.", path=path)
    text = form(found).encode()
    with machine_faults(path.parent):
        path.parent.mkdir(parents=True, exist_ok=True)
        write_atomically(path, lambda file: _write(file, text))


def _write(file: BinaryIO, text: bytes) -> None:
    file.write(text)


def json_text(found: ImuCalibration) -> str:
    """What :func:`read_set` reads."""
    return json.dumps(to_json(found), ensure_ascii=False, indent=1, allow_nan=False) + "\n"


def csv_text(found: ImuCalibration) -> str:
    """One coefficient a row, in full precision, with its standard uncertainties."""
    target = io.StringIO()
    writer = csv.writer(target, lineterminator="\n")
    writer.writerow(("sensor", "coefficient", "channel", "input", "value", "u_noise", "u_bench", "unit"))
    quality = found.quality
    for row in coefficient_rows(found.rate_unit, found.accel_unit):
        noise = "" if quality is None else repr(row.of(quality.standard_uncertainty))
        bench = "" if quality is None or quality.bench is None else repr(row.of(quality.bench))
        value = repr(row.of(found.coefficients))
        writer.writerow((row.sensor, row.symbol, AXES[row.channel], row.input, value, noise, bench, row.unit))
    return target.getvalue()


def header_text(found: ImuCalibration) -> str:
    """C99: the coefficients, both matrices inverted, and the compensation as an inline function."""
    g, a = found.gyro, found.accel
    said = found.provenance
    lines = [
        f"{key}: {said[key]}"
        for key in ("manufacturer", "device", "model", "serial_number", "bundle_sha256", "software")
        if said.get(key)
    ]
    return _HEADER.format(
        about="\n".join(" * " + _comment(line) for line in lines) or " *",
        rate_unit=_comment(found.rate_unit or "the gyros' own unit"),
        accel_unit=_comment(found.accel_unit or "the accelerometers' own unit"),
        E1=_vector(g.E1),
        B0=_vector(g.B0),
        Bf=_matrix(g.Bf),
        E=_matrix(_inverse(g.E)),
        K1=_vector(a.K1),
        K0=_vector(a.K0),
        K=_matrix(_inverse(a.K)),
    )


def _comment(text: str) -> str:
    """Names come from recordings: nothing in them may end the comment."""
    return (
        text.encode("ascii", "replace")
        .decode()
        .replace("*/", "* /")
        .replace("/*", "/ *")
        .replace("\n", " ")[:200]
    )


def _inverse(misalignment: Array) -> Array:
    return np.asarray(np.linalg.inv(np.eye(3) + misalignment), dtype=np.float64)


def _vector(values: Array) -> str:
    return "{" + ", ".join(repr(float(value)) for value in values) + "}"


def _matrix(values: Array) -> str:
    return "{" + ", ".join(_vector(row) for row in values) + "}"


_HEADER = """/* Calibration set of an inertial measurement unit.
{about}
 *
 * Rows are output channels, columns input axes (x, y, z). The unit indicates
 *   N   = E1 * (B0 + Bf f + (I + E) w)   in {rate_unit},
 *   N_A = K1 * (K0 + (I + K) f)          in {accel_unit},
 * w in deg/s, f in m/s^2, means over the sample's interval.
 */
#ifndef AHRS_LAB_CALIBRATION_SET_H
#define AHRS_LAB_CALIBRATION_SET_H

static const double imu_E1[3] = {E1};
static const double imu_B0_dps[3] = {B0};
static const double imu_Bf_dps_per_mps2[3][3] = {Bf};
static const double imu_I_plus_E_inverse[3][3] = {E};
static const double imu_K1[3] = {K1};
static const double imu_K0_mps2[3] = {K0};
static const double imu_I_plus_K_inverse[3][3] = {K};

/* Outputs in, rate and specific force out. */
static inline void imu_compensate(const double gyro[3], const double accel[3],
                                  double rate_dps[3], double force_mps2[3])
{{
    double left[3];
    int i, j;
    for (i = 0; i < 3; i++)
        left[i] = accel[i] / imu_K1[i] - imu_K0_mps2[i];
    for (i = 0; i < 3; i++) {{
        force_mps2[i] = 0.0;
        for (j = 0; j < 3; j++)
            force_mps2[i] += imu_I_plus_K_inverse[i][j] * left[j];
    }}
    for (i = 0; i < 3; i++) {{
        left[i] = gyro[i] / imu_E1[i] - imu_B0_dps[i];
        for (j = 0; j < 3; j++)
            left[i] -= imu_Bf_dps_per_mps2[i][j] * force_mps2[j];
    }}
    for (i = 0; i < 3; i++) {{
        rate_dps[i] = 0.0;
        for (j = 0; j < 3; j++)
            rate_dps[i] += imu_I_plus_E_inverse[i][j] * left[j];
    }}
}}

#endif
"""
