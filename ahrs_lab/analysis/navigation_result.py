"""What navigation of a recording gives: the series, the final state, and how a person reads them."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any, Final, Literal

import numpy as np
from numpy.typing import NDArray

from ahrs_lab.analysis.report import Cell, Chart, Curve, Report, Table
from ahrs_lab.analysis.report_cells import digits
from ahrs_lab.inertial.earth import meridian_radius_m, transverse_radius_m
from ahrs_lab.messages import Message

Array = NDArray[np.float64]
Damping = Literal["none", "baro"]

COLUMNS: Final = (
    "heading_deg",
    "pitch_deg",
    "roll_deg",
    "ve_mps",
    "vn_mps",
    "vu_mps",
    "latitude_deg",
    "longitude_deg",
    "altitude_m",
)
"""Of the result, and of a recording's reference."""

ERRORS: Final = (
    "error_heading_deg",
    "error_pitch_deg",
    "error_roll_deg",
    "error_ve_mps",
    "error_vn_mps",
    "error_vu_mps",
    "error_north_m",
    "error_east_m",
    "error_up_m",
)
"""Navigation minus the recording's own column."""

_DRAWN: Final = 20000
"""More points of a curve are not seen."""


@dataclass(frozen=True)
class NavigationResult:
    """``t_s`` (n,) and ``series`` name → (n,), of :data:`COLUMNS`, at the end of each row's interval;
    ``start`` the same, and ``t_s``, at the first row's start; ``errors`` name → (n,), of :data:`ERRORS`, of
    those columns that the recording has (NaN where a cell had no number)."""

    files: tuple[str, ...]
    t_s: Array
    series: dict[str, Array]
    start: dict[str, float]
    errors: dict[str, Array]
    damping: Damping
    notes: tuple[Message, ...]
    warnings: tuple[Message, ...]

    @property
    def duration_s(self) -> float:
        """From the first row's start to the last row."""
        return float(self.t_s[-1] - self.start["t_s"])

    def to_json(self) -> dict[str, Any]:
        """``{"final": …}``."""
        last = {name: float(values[-1]) for name, values in self.series.items()}
        velocity = [last.pop(name) for name in COLUMNS[3:6]]
        angles = {name: last.pop(name) for name in COLUMNS[:3]}
        return {"final": {"t_s": float(self.t_s[-1]), **angles, "velocity_enu_mps": velocity, **last}}

    def report(self) -> Report:
        """Start and end, errors against the recording's own columns, and the charts."""
        tables = (self._states(), *self._error_table())
        return Report(
            title=Message("Strapdown navigation"),
            tables=tables,
            charts=tuple(self._charts()),
            notes=(
                Message(
                    "Navigated: {files}, {rows} rows, {duration} s.",
                    files=", ".join(self.files),
                    rows=len(self.t_s),
                    duration=f"{self.duration_s:.6g}",
                ),
                *self.notes,
            ),
            warnings=self.warnings,
        )

    def _states(self) -> Table:
        places = ("{:z.4f}",) * 6 + ("{:z.8f}", "{:z.8f}", "{:z.3f}")
        rows = tuple(
            (name, unit, place.format(self.start[key]), place.format(float(self.series[key][-1])))
            for (name, unit), key, place in zip(_QUANTITIES, COLUMNS, places, strict=True)
        )
        return Table(Message("State"), ("", Message("unit"), Message("start"), Message("end")), rows)

    def _error_table(self) -> Iterator[Table]:
        if not self.errors:
            return
        rows: list[tuple[Cell, ...]] = []
        for (name, unit), key in zip(_DIFFERENCES, ERRORS, strict=True):
            if key in self.errors:
                error = self.errors[key]
                known = error[np.isfinite(error)]
                largest = known[np.argmax(np.abs(known))]
                rms = np.sqrt(np.mean(known**2))
                rows.append((name, unit, *(digits(float(value), 3) for value in (known[-1], largest, rms))))
        yield Table(
            Message("Navigation minus the recording's own columns"),
            ("", Message("unit"), Message("end"), Message("largest"), Message("root mean square")),
            tuple(rows),
        )

    def _charts(self) -> Iterator[Chart]:
        thin = slice(None, None, -(-len(self.t_s) // _DRAWN))
        t = self.t_s[thin]
        time = Message("time, s")

        def curves(values: dict[str, Array], keys: tuple[str, ...]) -> tuple[Curve, ...]:
            return tuple(
                Curve(_NAMES[key], t, values[key][thin], axis=axis)
                for key, axis in zip(keys, _AXES, strict=True)
                if key in values
            )

        angles = self.series | {"heading_deg": np.unwrap(self.series["heading_deg"], period=360.0)}
        yield Chart(Message("Attitude"), time, Message("angle, °"), curves(angles, COLUMNS[:3]))
        yield Chart(Message("Velocity"), time, Message("velocity, m/s"), curves(self.series, COLUMNS[3:6]))
        east, north = self._metres()
        track = Curve(Message("track"), east[thin], north[thin])
        yield Chart(Message("Track"), Message("east, m"), Message("north, m"), (track,), equal=True)
        height = Curve(_NAMES["altitude_m"], t, self.series["altitude_m"][thin], axis="z")
        yield Chart(Message("Height"), time, Message("height, m"), (height,))
        for title, label, keys in (
            (Message("Error of attitude"), Message("error, °"), ERRORS[:3]),
            (Message("Error of velocity"), Message("error, m/s"), ERRORS[3:6]),
            (Message("Error of position"), Message("error, m"), ERRORS[6:]),
        ):
            shown = curves(self.errors, keys)
            if shown:
                yield Chart(title, time, label, shown)

    def _metres(self) -> tuple[Array, Array]:
        """East and north of the start."""
        latitude, longitude = self.start["latitude_deg"], self.start["longitude_deg"]
        away = (self.series["longitude_deg"] - longitude + 180.0) % 360.0 - 180.0
        east = np.radians(away) * np.cos(np.radians(latitude)) * float(transverse_radius_m(latitude))
        north = np.radians(self.series["latitude_deg"] - latitude) * float(meridian_radius_m(latitude))
        return np.asarray(east, dtype=np.float64), np.asarray(north, dtype=np.float64)


_AXES: Final[tuple[Literal["x", "y", "z"], ...]] = ("x", "y", "z")
_QUANTITIES: Final = (
    (Message("heading"), "°"),
    (Message("pitch"), "°"),
    (Message("roll"), "°"),
    (Message("velocity east"), "m/s"),
    (Message("velocity north"), "m/s"),
    (Message("velocity up"), "m/s"),
    (Message("latitude"), "°"),
    (Message("longitude"), "°"),
    (Message("height"), "m"),
)
_DIFFERENCES: Final = (
    *_QUANTITIES[:6],
    (Message("position north"), "m"),
    (Message("position east"), "m"),
    (Message("height"), "m"),
)
_NAMES: Final = {
    **{key: name for key, (name, _) in zip(COLUMNS, _QUANTITIES, strict=True)},
    **{key: name for key, (name, _) in zip(ERRORS, _DIFFERENCES, strict=True)},
}
