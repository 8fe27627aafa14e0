"""The calibration set as rows to read: value ± U (k = 2), rounded as on its sheet. No Qt here."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ahrs_lab.metrology.imu_calibration import Coefficients
from ahrs_lab.metrology.imu_result import ImuResult
from ahrs_lab.metrology.rounding import format_grouped, round_to_uncertainty

Array = NDArray[np.float64]

COVERAGE_FACTOR = 2.0
STANDARD_GRAVITY_MPS2 = 9.80665
AXES = ("x", "y", "z")


@dataclass(frozen=True)
class Matrix:
    """Rows are output channels; ``cells`` (3, columns) texts value ± U in ``unit``. ``columns`` are the input
    axes, or one unnamed column for a vector."""

    key: str
    unit: str
    columns: tuple[str, ...]
    cells: tuple[tuple[str, ...], ...]


def gyro_matrices(result: ImuResult) -> tuple[Matrix, ...]:
    """E1, B0, Bf, E."""
    found, u = result.calibration.gyro, _combined(result).gyro
    scale = _per(result.calibration.rate_unit or "deg/s", "°/s").replace("deg", "°")
    return (
        _matrix("E1", scale, found.E1, u.E1),
        _matrix("B0", "°/h", found.B0, u.B0, 3600.0),
        _matrix("Bf", "(°/h)/g", found.Bf, u.Bf, 3600.0 * STANDARD_GRAVITY_MPS2),
        _matrix("E", "µrad", found.E, u.E, 1e6),
    )


def accel_matrices(result: ImuResult) -> tuple[Matrix, ...]:
    """K1, K0, K."""
    found, u = result.calibration.accel, _combined(result).accel
    scale = _per((result.calibration.accel_unit or "m/s^2").replace("^2", "²"), "m/s²")
    return (
        _matrix("K1", scale, found.K1, u.K1),
        _matrix("K0", "mm/s²", found.K0, u.K0, 1e3),
        _matrix("K", "µrad", found.K, u.K, 1e6),
    )


def residual_rows(result: ImuResult) -> Iterator[tuple[str, str, tuple[str, ...]]]:
    """Per position: its name, where x, y, z pointed, residuals in °/h and mm/s²."""
    quality = result.calibration.quality
    if quality is None:
        return
    known = {dwell.name: dwell for dwell in result.dwells}
    for row, name in enumerate(quality.positions):
        dwell = known.get(name)
        turned = f" + {dwell.beyond_deg:g}°" if dwell and dwell.beyond_deg else ""
        stood = f"{dwell.orientation}{turned}" if dwell else ""
        gyro = [f"{value:.2f}" for value in quality.gyro_residuals[row] * 3600.0]
        accel = [f"{value:.3f}" for value in quality.accel_residuals[row] * 1e3]
        yield name.split(" (")[0], stood, tuple(format_grouped(text) for text in (*gyro, *accel))


def _combined(result: ImuResult) -> Coefficients:
    """Zero where the set comes without: values then stand alone."""
    combined = result.combined
    if combined is not None:
        return combined
    return Coefficients.from_vectors(np.zeros((3, 7)), np.zeros((3, 4)))


def _per(outer: str, inner: str) -> str:
    return f"({outer})/({inner})" if "/" in outer else f"{outer}/({inner})"


def _matrix(key: str, unit: str, values: Array, standard: Array, factor: float = 1.0) -> Matrix:
    table, spread = (np.atleast_2d(one.T).T for one in (values, standard))
    columns = AXES if table.shape[1] == 3 else ("",)
    cells = tuple(
        tuple(_cell(table[i, j], spread[i, j], factor) for j in range(table.shape[1])) for i in range(3)
    )
    return Matrix(key, unit, columns, cells)


def _cell(value: float, standard: float, factor: float) -> str:
    if value == 0.0 and standard == 0.0:
        return "0"
    expanded = float(f"{COVERAGE_FACTOR * float(standard) * factor:.12g}")
    rounded = round_to_uncertainty(float(f"{float(value) * factor:.12g}"), expanded)
    text = format_grouped(rounded.value)
    return text if expanded == 0.0 else f"{text} ± {format_grouped(rounded.expanded)}"
