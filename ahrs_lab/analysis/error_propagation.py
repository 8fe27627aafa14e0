"""How one error of an inertial system at rest grows over hours: the model (2-90), drawn.

The periods that the curves are made of stand as marks: Schuler's 84.4 min, the day, and the turn of
Foucault's pendulum, 2π/(ω_ie sin L).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Final, Literal

import numpy as np
from numpy.typing import NDArray

from ahrs_lab.analysis.report import Chart, Curve, Mark, Report, Table
from ahrs_lab.analysis.report_cells import digits
from ahrs_lab.errors import InputError
from ahrs_lab.inertial.earth import EARTH_RATE_RADPS, STANDARD_GRAVITY_MPS2
from ahrs_lab.inertial.error_dynamics import (
    DLAT,
    DLON,
    DV_E,
    DV_N,
    INPUTS,
    PHI_E,
    PHI_N,
    PHI_U,
    POLE_DEG,
    RestingPlace,
    eigenfrequencies_radps,
    propagate,
)
from ahrs_lab.messages import Message

Array = NDArray[np.float64]

_ARCSEC: Final = float(np.radians(1.0 / 3600.0))
_DEG_PER_H: Final = float(np.radians(1.0) / 3600.0)
_MICRO_G: Final = 1e-6 * STANDARD_GRAVITY_MPS2
_POINTS: Final = 2000
LONGEST_H: Final = 1000.0
_LEAST_LATITUDE_OF_FOUCAULT_DEG: Final = 0.1


@dataclass(frozen=True)
class Source:
    """An error to begin with or to go on with. ``of`` is the index of a state of (2-90) (``constant`` false)
    or of a sensor; ``si`` is the unit in m, s and rad."""

    name: Message
    unit: str
    si: float
    of: int
    constant: bool
    usual: float


SOURCES: Final = {
    "tilt_east": Source(Message("initial tilt about east"), "″", _ARCSEC, PHI_E, False, 10.0),
    "tilt_north": Source(Message("initial tilt about north"), "″", _ARCSEC, PHI_N, False, 10.0),
    "azimuth": Source(Message("initial error of heading"), "′", 60 * _ARCSEC, PHI_U, False, 5.0),
    "velocity_east": Source(Message("initial error of velocity east"), "m/s", 1.0, DV_E, False, 0.1),
    "velocity_north": Source(Message("initial error of velocity north"), "m/s", 1.0, DV_N, False, 0.1),
    "latitude": Source(Message("initial error of latitude"), "″", _ARCSEC, DLAT, False, 10.0),
    "gyro_east": Source(Message("gyro bias east"), "°/h", _DEG_PER_H, INPUTS.index("gyro_e"), True, 0.01),
    "gyro_north": Source(Message("gyro bias north"), "°/h", _DEG_PER_H, INPUTS.index("gyro_n"), True, 0.01),
    "gyro_up": Source(Message("gyro bias up"), "°/h", _DEG_PER_H, INPUTS.index("gyro_u"), True, 0.01),
    "accel_east": Source(
        Message("accelerometer bias east"), "µg", _MICRO_G, INPUTS.index("accel_e"), True, 100.0
    ),
    "accel_north": Source(
        Message("accelerometer bias north"), "µg", _MICRO_G, INPUTS.index("accel_n"), True, 100.0
    ),
}


@dataclass(frozen=True)
class ErrorPropagation:
    """``hours`` (n,) and ``states`` (7, n) of :mod:`ahrs_lab.inertial.error_dynamics`."""

    source: str
    size: float
    latitude_deg: float
    place: RestingPlace
    hours: Array
    states: Array

    def series(self) -> dict[str, Array]:
        """Columns in the units a person reads: m, m/s, ″."""
        place = self.place
        return {
            "t_h": self.hours,
            "error_north_m": self.states[DLAT] * place.meridian_m,
            "error_east_m": self.states[DLON] * place.transverse_m * np.cos(place.latitude_rad),
            "error_vn_mps": self.states[DV_N],
            "error_ve_mps": self.states[DV_E],
            "tilt_east_arcsec": self.states[PHI_E] / _ARCSEC,
            "tilt_north_arcsec": self.states[PHI_N] / _ARCSEC,
            "error_heading_arcsec": self.states[PHI_U] / _ARCSEC,
        }

    def periods_h(self) -> dict[str, float | None]:
        """Schuler's, the day, Foucault's (None at the equator)."""
        slow = abs(self.latitude_deg) < _LEAST_LATITUDE_OF_FOUCAULT_DEG
        foucault = None if slow else 2 * np.pi / self.place.foucault_radps / 3600.0
        return {
            "schuler": 2 * np.pi / self.place.schuler_radps / 3600.0,
            "earth": 2 * np.pi / EARTH_RATE_RADPS / 3600.0,
            "foucault": foucault,
        }

    def to_json(self) -> dict[str, Any]:
        """Source, frequencies and periods, the errors at the end and their largest."""
        series = {name: values for name, values in self.series().items() if name != "t_h"}
        return {
            "source": self.source,
            "size": self.size,
            "unit": SOURCES[self.source].unit,
            "latitude_deg": self.latitude_deg,
            "hours": float(self.hours[-1]),
            "eigenfrequencies_radps": list(eigenfrequencies_radps(self.place)),
            "period_h": self.periods_h(),
            "final": {name: float(values[-1]) for name, values in series.items()},
            "largest": {name: float(np.max(np.abs(values))) for name, values in series.items()},
        }

    def report(self) -> Report:
        """The errors in a table, and drawn with the periods as marks."""
        source, series = SOURCES[self.source], self.series()
        rows = tuple(
            (name, unit, digits(series[key][-1]), digits(float(np.max(np.abs(series[key])))))
            for key, name, unit in _SHOWN
        )
        hours = f"{self.hours[-1]:g}"
        title = Message(
            "{source} of {size} {unit}, at rest at {latitude}°",
            source=source.name,
            size=f"{self.size:g}",
            unit=source.unit,
            latitude=f"{self.latitude_deg:g}",
        )
        head = ("", Message("unit"), Message("after {hours} h", hours=hours), Message("largest"))
        return Report(
            title=Message("Propagation of an error"),
            tables=(Table(title, head, rows), self._frequencies()),
            charts=self._charts(series),
            notes=(
                Message(
                    "Errors are computed minus true; the tilts turn the true level into the computed one "
                    "about east and north by the right hand, heading is clockwise. A bias is what the sensor "
                    "shows too much. The height is held from outside."
                ),
            ),
        )

    def _frequencies(self) -> Table:
        rows = tuple((f"{w:.5e}", f"{2 * np.pi / w / 3600:.4f}") for w in eigenfrequencies_radps(self.place))
        return Table(Message("Eigenfrequencies"), (Message("rad/s"), Message("period, h")), rows)

    def _charts(self, series: dict[str, Array]) -> tuple[Chart, ...]:
        names = {
            "schuler": Message("84.4 min"),
            "earth": Message("24 h"),
            "foucault": Message("Foucault"),
        }
        marks = tuple(
            Mark(period, names[key])
            for key, period in self.periods_h().items()
            if period is not None and period <= self.hours[-1]
        )
        axes: dict[str, Literal["x", "y", "z"]] = {"n": "y", "e": "x", "u": "z"}
        charts = []
        for title, label, keys in (
            (
                Message("Error of position"),
                Message("error, m"),
                (("error_north_m", "n"), ("error_east_m", "e")),
            ),
            (
                Message("Error of velocity"),
                Message("error, m/s"),
                (("error_vn_mps", "n"), ("error_ve_mps", "e")),
            ),
            (
                Message("Error of level"),
                Message("error, ″"),
                (("tilt_east_arcsec", "e"), ("tilt_north_arcsec", "n")),
            ),
            (Message("Error of heading"), Message("error, ″"), (("error_heading_arcsec", "u"),)),
        ):
            curves = tuple(Curve(_NAMES[key], self.hours, series[key], axis=axes[axis]) for key, axis in keys)
            charts.append(Chart(title, Message("time, h"), label, curves, marks))
        return tuple(charts)


_SHOWN: Final = (
    ("error_north_m", Message("position north"), "m"),
    ("error_east_m", Message("position east"), "m"),
    ("error_vn_mps", Message("velocity north"), "m/s"),
    ("error_ve_mps", Message("velocity east"), "m/s"),
    ("tilt_east_arcsec", Message("tilt about east"), "″"),
    ("tilt_north_arcsec", Message("tilt about north"), "″"),
    ("error_heading_arcsec", Message("heading"), "″"),
)
_NAMES: Final = {key: name for key, name, _ in _SHOWN}


def propagate_error(source: str, size: float, latitude_deg: float, hours: float) -> ErrorPropagation:
    """One error of ``size`` (in the source's unit) over ``hours``, at sea level.

    Raises InputError for what has no meaning.
    """
    if source not in SOURCES:
        raise InputError(
            "“{source}” is no source of error; there are: {known}.", source=source, known=", ".join(SOURCES)
        )
    if not np.isfinite(size):
        raise InputError("The size of the error is {size}: write a finite number.", size=size)
    if not (np.isfinite(hours) and 0.0 < hours <= LONGEST_H):
        raise InputError(
            "{hours} h cannot be drawn: write a time above 0 and up to {most} h.", hours=hours, most=LONGEST_H
        )
    if not (np.isfinite(latitude_deg) and abs(latitude_deg) <= 90.0):
        raise InputError(
            "The latitude is {latitude}°: it has to lie between −90° and 90°.", latitude=latitude_deg
        )
    if abs(latitude_deg) > POLE_DEG:
        raise InputError(
            "At latitude {latitude}° east and north are lost (tan L grows without bound): the model ends at "
            "{limit}°.",
            latitude=latitude_deg,
            limit=POLE_DEG,
        )
    known = SOURCES[source]
    initial, sensors = np.zeros(7), np.zeros(len(INPUTS))
    (sensors if known.constant else initial)[known.of] = size * known.si
    place = RestingPlace.on_earth(latitude_deg)
    states = propagate(place, initial, sensors, hours * 3600.0 / _POINTS, _POINTS)
    return ErrorPropagation(source, size, latitude_deg, place, np.linspace(0.0, hours, _POINTS + 1), states)
