"""Bundles for the analyses' tests, written as somebody else's software would write them."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

HEADER = """format = "ahrs-lab-recording"
version = 1
procedure = "static"
[site]
latitude_deg = 39.9042
altitude_m = 50.0
[device]
rate_unit = "{rate_unit}"
accel_unit = "{accel_unit}"
sample_rate_hz = {rate_hz}
"""


def write_bundle(
    folder: Path,
    segments: Mapping[str, tuple[Mapping[str, Array], str]],
    rate_unit: str = "deg/s",
    accel_unit: str = "m/s^2",
    rate_hz: float = 10.0,
) -> Path:
    """``segments``: file → its columns and the further lines of its table in ``recording.toml``."""
    text = HEADER.format(rate_unit=rate_unit, accel_unit=accel_unit, rate_hz=rate_hz)
    for file, (columns, lines) in segments.items():
        text += f'[[segment]]\nfile = "{file}"\n{lines}\n'
        table = np.column_stack(list(columns.values()))
        np.savetxt(folder / file, table, delimiter=",", header=",".join(columns), comments="", fmt="%.12g")
    folder.joinpath("recording.toml").write_text(text, encoding="utf-8")
    return folder


def columns(t_s: Array, gyro: Array, accel: Array | None = None) -> dict[str, Array]:
    """The columns of a segment; ``gyro``, ``accel`` (n, 3)."""
    made = {"t_s": t_s, **{f"gyro_{axis}": gyro[:, i] for i, axis in enumerate("xyz")}}
    if accel is not None:
        made |= {f"accel_{axis}": accel[:, i] for i, axis in enumerate("xyz")}
    return made
