"""Bundles for the tests: a bench as interfaces.md describes it, written as text by this file, not by ours."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ahrs_lab.recording.finding import Finding
from ahrs_lab.recording.read import Recording, read_bundle

RATE_HZ = 50.0
UP = {"U": 9.80665, "D": -9.80665}

HEADER = f"""format = "ahrs-lab-recording"
version = 1
procedure = "jjf1536-2015"
[site]
latitude_deg = 39.9042
[device]
rate_unit = "deg/s"
sample_rate_hz = {RATE_HZ}
"""

Columns = dict[str, NDArray[np.float64]]


@dataclass
class Take:
    """A segment to be: its keys in recording.toml and its file's lines (the header row is ``lines[0]``)."""

    name: str
    keys: dict[str, object]
    lines: list[str] = field(default_factory=list)


def columns(seconds: float, orientation: str, rate_dps: float = 0.0, rate_hz: float = RATE_HZ) -> Columns:
    """What an ideal unit and table give: gravity on the axis that is up, the rate on it too."""
    count = round(seconds * rate_hz)
    t_s = np.arange(1, count + 1) / rate_hz
    made: dict[str, NDArray[Any]] = {"t_s": t_s}
    for axis, letter in zip("xyz", orientation, strict=True):
        made[f"gyro_{axis}"] = np.full(count, {"U": 1.0, "D": -1.0}.get(letter, 0.0) * rate_dps)
    for axis, letter in zip("xyz", orientation, strict=True):
        made[f"accel_{axis}"] = np.full(count, UP.get(letter, 0.0))
    made["counter"] = np.arange(count) % 256.0
    made["table_angle_deg"] = (rate_dps * t_s) % 360.0
    return made


def take(name: str, seconds: float = 30.0, **keys: object) -> Take:
    """A clean segment, by default of the zero offset of x in position 1."""
    described: dict[str, object] = {
        "orientation": "ENU",
        "item": "zero_offset",
        "axis": "x",
        "role": "position",
    }
    described |= keys
    if described["role"] == "position":
        described.setdefault("position", 1)
    made = columns(seconds, str(described["orientation"]), float(str(described.get("rate_dps", 0.0))))
    return Take(name, described, csv_lines(made))


def csv_lines(made: Columns) -> list[str]:
    rows = zip(*(column.tolist() for column in made.values()), strict=True)
    return [",".join(made), *(",".join(repr(cell) for cell in row) for row in rows)]


def rate_take(rate_dps: float = 100.0, seconds: float = 36.0, **keys: object) -> Take:
    return take(
        "sf_x",
        seconds,
        orientation="UEN",
        item="scale_factor",
        axis="x",
        role="rate",
        rate_dps=rate_dps,
        **keys,
    )


def four_positions() -> list[Take]:
    """A complete zero offset of x."""
    letters = ("ENU", "ESD", "WSU", "WND")
    return [take(f"zo_x_{i + 1}", orientation=letters[i], position=i + 1) for i in range(4)]


def write_bundle(folder: Path, takes: Iterable[Take], header: str = HEADER) -> Path:
    """The folder as other software would write it."""
    (folder / "segments").mkdir(parents=True)
    text = header
    for entry in takes:
        text += f'\n[[segment]]\nfile = "segments/{entry.name}.csv"\n'
        for key, value in entry.keys.items():
            shown = f'"{value}"' if isinstance(value, str) else str(value).lower()
            text += f"{key} = {shown}\n"
        (folder / "segments" / f"{entry.name}.csv").write_text(
            "\n".join(entry.lines) + "\n", encoding="utf-8"
        )
    (folder / "recording.toml").write_text(text, encoding="utf-8")
    return folder


def read_one(folder: Path, entry: Take, header: str = HEADER) -> tuple[Recording, tuple[Finding, ...]]:
    """A recording of one segment, read back, and that segment's findings."""
    recording = read_bundle(write_bundle(folder, [entry], header))
    return recording, recording.segments[0].findings


def cell(lines: list[str], line: int, column: str, value: str) -> None:
    """Replace a cell of a file line (the header row is line 1)."""
    index = lines[0].split(",").index(column)
    cells = lines[line - 1].split(",")
    cells[index] = value
    lines[line - 1] = ",".join(cells)


def change(
    entry: Take, column: str, function: Callable[[NDArray[np.float64]], NDArray[np.floating[Any]]]
) -> Take:
    """The same segment with a column replaced."""
    index = entry.lines[0].split(",").index(column)
    rows = [line.split(",") for line in entry.lines[1:]]
    values = function(np.array([float(row[index]) for row in rows]))
    for row, value in zip(rows, values.tolist(), strict=True):
        row[index] = repr(value)
    entry.lines[1:] = [",".join(row) for row in rows]
    return entry
