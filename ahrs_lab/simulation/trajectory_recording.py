"""A flight as a recording bundle: what real sensors show of it, and where wanted the truth beside it."""

from __future__ import annotations

from pathlib import Path
from typing import Final

import numpy as np
from numpy.typing import NDArray

from ahrs_lab.inertial.attitude import attitude_angles_deg
from ahrs_lab.recording.orientation import Orientation
from ahrs_lab.recording.samples import ACCEL, GYRO, Samples
from ahrs_lab.recording.segment import DeviceDescription, RecordingHeader, Segment, Site
from ahrs_lab.recording.write import BundleWriter, FileFormat
from ahrs_lab.simulation.sensors import Sensors
from ahrs_lab.simulation.settings import DeviceSettings, RoomSettings, SensorSettings
from ahrs_lab.simulation.trajectory import Flight

Array = NDArray[np.float64]

PROCEDURE: Final = "dynamic"


def flight_samples(
    flight: Flight, sensors: SensorSettings | None = None, seed: int = 0, *, reference: bool = False
) -> Samples:
    """The columns of a recording, rates in °/s and specific forces in m/s², means over the intervals.

    ``sensors`` None: an ideal unit. ``reference``: true attitude, velocity and position as further columns.
    """
    # the interval as a reader of the recording forms it, so that his increments are the flight's
    interval = np.diff(flight.t_s[1:], prepend=0.0)
    rate = np.degrees(flight.angle_rad.T) / interval
    force = flight.velocity_mps.T / interval
    if sensors is not None:
        rate, force = _shown(flight, rate, force, sensors, seed)
    columns = {"t_s": flight.t_s[1:], **dict(zip(GYRO, rate, strict=True))}
    columns |= dict(zip(ACCEL, force, strict=True))
    if reference:
        columns |= _truth(flight)
    return Samples(columns)


def write_flight(
    folder: Path,
    flight: Flight,
    sensors: SensorSettings | None = None,
    seed: int = 0,
    *,
    reference: bool = False,
    device: DeviceDescription | None = None,
    initial: bool = True,
    file_format: FileFormat = "parquet",
) -> Path:
    """The bundle of one segment “dynamic” in a new ``folder``, with the true state at its start.

    ``device`` names the unit; its units and sample rate are the flight's. See :func:`flight_samples`.
    """
    given = device or DeviceDescription(model="virtual carrier", serial_number=f"SIM-{seed:04d}")
    place = _place(flight)
    header = RecordingHeader(
        PROCEDURE,
        Site(place["latitude_deg"], place["altitude_m"], place["longitude_deg"]),
        DeviceDescription(
            given.name, given.manufacturer, given.model, given.serial_number, sample_rate_hz=_rate_hz(flight)
        ),
        initial_state(flight) if initial else None,
    )
    segment = Segment("dynamic", Orientation("ENU"), "dynamic", "z", "position")
    with BundleWriter(folder, header, file_format=file_format) as writer:
        writer.begin(segment)
        writer.append(flight_samples(flight, sensors, seed, reference=reference))
        writer.finish()
    return folder


def initial_state(flight: Flight) -> dict[str, object]:
    """``[initial]`` of the recording: the true state at the first interval's start."""
    heading, pitch, roll = (float(angle) for angle in attitude_angles_deg(flight.C_bn[0]))
    return {
        "heading_deg": heading,
        "pitch_deg": pitch,
        "roll_deg": roll,
        "velocity_enu_mps": flight.velocity_enu_mps[0].tolist(),
        **_place(flight),
    }


def _place(flight: Flight) -> dict[str, float]:
    return {
        "latitude_deg": float(np.degrees(flight.latitude_rad[0])),
        "longitude_deg": float(np.degrees(flight.longitude_rad[0])),
        "altitude_m": float(flight.altitude_m[0]),
    }


def _rate_hz(flight: Flight) -> float:
    return float(1.0 / flight.t_s[1])


def _shown(
    flight: Flight, rate: Array, force: Array, settings: SensorSettings, seed: int
) -> tuple[Array, Array]:
    """What the sensors make of it, powered on at the flight's beginning."""
    device = DeviceSettings(sample_rate_hz=_rate_hz(flight))
    sensors = Sensors(settings, device, RoomSettings(), np.random.SeedSequence(seed))
    shown = np.empty((6, rate.shape[1]))
    sensors.show(rate, force, shown)
    sensors.disturb(sensors.power_on(0.0, 0.0), flight.t_s, shown)
    gain = np.array((*settings.gyro.scale_factor, *settings.accel.scale_factor))[:, np.newaxis]
    shown *= gain
    return shown[:3], shown[3:]


def _truth(flight: Flight) -> dict[str, Array]:
    """At the end of each interval."""
    heading, pitch, roll = attitude_angles_deg(flight.C_bn[1:])
    east, north, up = flight.velocity_enu_mps[1:].T
    return {
        "heading_deg": heading,
        "pitch_deg": pitch,
        "roll_deg": roll,
        "ve_mps": east,
        "vn_mps": north,
        "vu_mps": up,
        "latitude_deg": np.degrees(flight.latitude_rad[1:]),
        "longitude_deg": np.degrees(flight.longitude_rad[1:]),
        "altitude_m": flight.altitude_m[1:],
    }
