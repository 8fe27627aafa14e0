"""The virtual unit under calibration: boots, samples, scales, rounds, and sends over a link that is late and
loses."""

from __future__ import annotations

import threading
from math import floor
from typing import Final

import numpy as np
from numpy.typing import NDArray

from ahrs_lab.inertial.attitude import attitude_angles_deg
from ahrs_lab.inertial.earth import STANDARD_GRAVITY_MPS2
from ahrs_lab.instruments.interfaces import Clock
from ahrs_lab.recording.samples import ACCEL, ANGLE, ATTITUDE, GYRO, Samples, concatenate
from ahrs_lab.recording.segment import DeviceDescription
from ahrs_lab.simulation.faults import FaultSwitches
from ahrs_lab.simulation.motion import Motion
from ahrs_lab.simulation.mounted_case import MountedCase
from ahrs_lab.simulation.sensors import Sensors, Session
from ahrs_lab.simulation.settings import AttitudeErrors, DeviceSettings, SimulationSettings

Array = NDArray[np.float64]

_BLOCK: Final = 16384
"""Samples worked on at once: what a processor's cache holds. The numbers do not depend on it."""

_ON_TIME: Final = 1e-6
"""Of an interval: a sample whose end is that near counts as made."""

_FAULTY_LOSS: Final = 0.1
_ANGLE_STEP_DEG: Final = 2.0**-36

_RIGHT_FORWARD_UP = [1, 2, 0]
"""The case axes that attitude angles are of, as the standard ties them: Y right (pitch), Z forward (roll),
X up (heading)."""


class SimulatedAhrs:
    """An :class:`~ahrs_lab.instruments.interfaces.Ahrs`. It streams while it has power, after its boot time;
    device time and counter start with each boot. Samples are made when they are read."""

    def __init__(
        self,
        settings: SimulationSettings,
        sensors: Sensors,
        motion: Motion,
        clock: Clock,
        faults: FaultSwitches,
        seed: np.random.SeedSequence,
        lock: threading.RLock,
    ) -> None:
        device = settings.device
        self.description = DeviceDescription(
            name=device.name,
            manufacturer=device.manufacturer,
            model=device.model,
            serial_number=device.serial_number,
            rate_unit=device.rate_unit,
            accel_unit=device.accel_unit,
            sample_rate_hz=device.sample_rate_hz,
        )
        self._device = device
        self._sensors = sensors
        self._motion = motion
        self._clock = clock
        self._lock = lock
        self._link = _Link(device, faults, seed)
        self._output = OutputStage(settings)
        self._attitude_error = settings.sensor.attitude
        self._attitude_rng = np.random.Generator(np.random.SFC64(seed.spawn(1)[0]))
        self._case: MountedCase | None = None
        self._streaming = False
        self._made = 0
        self._pending: list[Samples] = []
        self._off_since_s = 0.0
        self._excess_c = 0.0
        self._powered = False
        self.sessions: list[Session] = []

    def identify(self) -> str:
        device = self._device
        return f"{device.manufacturer} {device.model} s/n {device.serial_number} (simulated)"

    def start(self) -> None:
        """See :class:`~ahrs_lab.instruments.interfaces.Ahrs`."""
        with self._lock:
            self._streaming = True
            self._made = max(self._made, self._ended(self._clock.now_s()))
            self._output.restart()
            self._pending.clear()

    def stop(self) -> None:
        with self._lock:
            self.catch_up()
            self._streaming = False

    def read(self) -> Samples:
        """See :class:`~ahrs_lab.instruments.interfaces.Ahrs`."""
        with self._lock:
            self.catch_up()
            if not self._pending:
                return Samples()
            waiting = concatenate(self._pending)
            if not len(waiting):  # every row of it was lost
                self._pending = []
                return Samples()
            arrived = int(
                np.searchsorted(waiting["host_t_s"], self._clock.now_s() + self._on_time_s, "right")
            )
            self._pending = [waiting.rows(arrived)] if arrived < len(waiting) else []
            return waiting.rows(0, arrived) if arrived else Samples()

    def clamp(self, case: MountedCase) -> None:
        """The case stands like this from now on."""
        with self._lock:
            self.catch_up()
            self._case = case

    def power(self, powered: bool) -> None:
        """The supply gives or takes the voltage."""
        with self._lock:
            now = self._clock.now_s()
            if powered:
                self._excess_c = self._sensors.cooled_c(self._excess_c, now - self._off_since_s)
                self.sessions.append(self._sensors.power_on(now, self._excess_c))
                self._made = 0
                self._output.restart()
            elif self._powered:
                self.catch_up()
                self._excess_c = float(self._sensors.excess_c(self.sessions[-1], now))
                self._off_since_s = now
            self._powered = powered

    def catch_up(self) -> None:
        """Make the samples whose interval has ended."""
        last = self._ended(self._clock.now_s())
        if last <= self._made:
            return
        if self._streaming:
            self._pending.append(self._make(self._made + 1, last))
        self._made = last

    @property
    def powered(self) -> bool:
        """Whether it has its voltage."""
        return self._powered

    @property
    def made_until_s(self) -> float:
        """Bench time before which no sample will be made any more."""
        return self._booted_s + self._made * self._interval_s if self._powered else self._clock.now_s()

    @property
    def _interval_s(self) -> float:
        return 1.0 / self._device.sample_rate_hz

    @property
    def _on_time_s(self) -> float:
        return _ON_TIME * self._interval_s

    @property
    def _booted_s(self) -> float:
        return self.sessions[-1].started_s + self._device.boot_time_s

    def _ended(self, t_s: float) -> int:
        """Number of the last sample that has ended at ``t_s``; 0 before the first."""
        if not self._powered:
            return 0
        return max(floor((t_s - self._booted_s) * self._device.sample_rate_hz + _ON_TIME), 0)

    def _make(self, first: int, last: int) -> Samples:
        """Samples number first … last, as they will arrive."""
        count = last - first + 1
        columns = {name: np.empty(count) for name in self._output.names}
        for begin in range(0, count, _BLOCK):
            end = min(begin + _BLOCK, count)
            edges = (
                self._booted_s
                + np.arange(first + begin - 1, first + end, dtype=np.float64) * self._interval_s
            )
            self._fill(edges, {name: column[begin:end] for name, column in columns.items()})
        number = np.arange(first, last + 1, dtype=np.float64)
        t_s = number * self._interval_s
        return self._link.carry(
            Samples({"t_s": t_s, **columns, "counter": number, "host_t_s": t_s + self._booted_s})
        )

    def _fill(self, edges_s: Array, columns: dict[str, Array]) -> None:
        if self._case is None:
            raise RuntimeError("the world has not put the case on the table")
        session = self.sessions[-1]
        if self._output.inertial:
            shown = np.empty((6, len(edges_s) - 1))
            self._sensors.indicate(session, self._motion, self._case, edges_s, shown)
            self._output.write(shown, columns)
        if ATTITUDE[0] in columns:
            self._write_attitude(self._case, edges_s[1:], columns)
        if "temperature_c" in columns:
            columns["temperature_c"][:] = self._sensors.temperature_c(session, edges_s[1:])

    def _write_attitude(self, case: MountedCase, times_s: Array, columns: dict[str, Array]) -> None:
        errors: AttitudeErrors = self._attitude_error
        heading, pitch, roll = (columns[name] for name in ATTITUDE)
        # up to and including the last sample, whose end may be where the next piece begins
        for start, stop, piece in self._motion.spans(times_s[0], times_s[-1] + self._interval_s):
            a, b = np.searchsorted(times_s, (start, stop))
            if b > a:
                angles = piece.angles(times_s[a : a + 1] if piece.at_rest else times_s[a:b])
                body = case.attitude(angles)[..., _RIGHT_FORWARD_UP]
                heading[a:b], pitch[a:b], roll[a:b] = attitude_angles_deg(body)
        age_h = (times_s - self.sessions[-1].started_s) / 3600.0
        heading += errors.heading_offset_deg + errors.heading_drift_deg_per_h * age_h
        pitch += errors.pitch_offset_deg
        roll += errors.roll_offset_deg
        if errors.noise_deg:
            noise = errors.noise_deg * self._attitude_rng.standard_normal((len(times_s), 3))
            heading += noise[:, 0]
            pitch += noise[:, 1]
            roll += noise[:, 2]
        heading %= 360.0
        roll[roll > 180.0] -= 360.0
        roll[roll <= -180.0] += 360.0


class OutputStage:
    """From indicated rates and specific forces to what the unit sends: unit, scale factor, rounding."""

    def __init__(self, settings: SimulationSettings) -> None:
        device, sensor = settings.device, settings.sensor
        outputs = device.outputs
        self._rates = "rate" in outputs or "increment" in outputs
        self._angles = "angle" in outputs
        self._accels = "accel" in outputs
        self.inertial = self._rates or self._angles or self._accels
        self.names = (
            (GYRO if self._rates else ())
            + (ACCEL if self._accels else ())
            + (ANGLE if self._angles else ())
            + (ATTITUDE if "attitude" in outputs else ())
            + (("temperature_c",) if "temperature" in outputs else ())
        )
        interval_s = 1.0 / device.sample_rate_hz
        carried = "increment" in outputs
        gyro_step, gyro_unit = _step(device.gyro_lsb, carried, interval_s), rate_units_per_dps(device)
        accel_step, accel_unit = _step(device.accel_lsb, carried, interval_s), _accel_unit(device)
        self._gyro = [_Channel(k, gyro_step, gyro_unit, carried) for k in sensor.gyro.scale_factor]
        self._accel = [_Channel(k, accel_step, accel_unit, carried) for k in sensor.accel.scale_factor]
        self._accumulated = [_Accumulator() for _ in ANGLE]
        self._angle_scale = [k * interval_s / _ANGLE_STEP_DEG for k in sensor.gyro.scale_factor]

    def restart(self) -> None:
        """The accumulated angle begins at zero, nothing is left over."""
        for accumulator in (*self._accumulated, *(channel.rest for channel in self._gyro + self._accel)):
            accumulator.value = 0

    def write(self, shown: Array, columns: dict[str, Array]) -> None:
        """``shown`` (6, n) into the columns asked for; overwrites ``shown``."""
        for axis in range(3):
            if self._angles:
                steps = self._accumulated[axis].add(
                    np.rint(shown[axis] * self._angle_scale[axis]).astype(np.int64)
                )
                np.multiply(steps, _ANGLE_STEP_DEG, out=columns[ANGLE[axis]])
            if self._rates:
                self._gyro[axis].write(shown[axis], columns[GYRO[axis]])
            if self._accels:
                self._accel[axis].write(shown[3 + axis], columns[ACCEL[axis]])


class _Accumulator:
    """A running sum of whole numbers: exact, so it is the same in whatever pieces it is made."""

    def __init__(self) -> None:
        self.value = 0

    def add(self, steps: NDArray[np.int64]) -> NDArray[np.int64]:
        total = np.cumsum(steps)
        total += self.value
        self.value = int(total[-1])
        return total


class _Channel:
    """One output: scaled, then rounded to ``step`` (in °/s or m/s²; 0: not at all), then in its unit. Where
    increments are rounded, what is left over is carried on, in 2⁻²⁰ of a step."""

    _FINE: Final = 20

    def __init__(self, scale_factor: float, step: float, unit: float, carried: bool) -> None:
        self._step = step
        self._factor = scale_factor / step if step else scale_factor * unit
        self._unit = unit * step
        self._carried = carried
        self.rest = _Accumulator()

    def write(self, shown: Array, out: Array) -> None:
        np.multiply(shown, self._factor, out=out)
        if not self._step:
            return
        if self._carried:
            out *= 2.0**self._FINE
            fine = np.rint(out).astype(np.int64)
            before = self.rest.value
            counts = (self.rest.add(fine) + (1 << (self._FINE - 1))) >> self._FINE
            first = (before + (1 << (self._FINE - 1))) >> self._FINE
            out[:] = np.diff(counts, prepend=first)
        else:
            np.rint(out, out=out)
        out *= self._unit


class _Link:
    """From the unit to the host: late, in bunches, losing some."""

    def __init__(self, device: DeviceSettings, faults: FaultSwitches, seed: np.random.SeedSequence) -> None:
        self._device = device
        self._faults = faults
        loss, faulty = seed.spawn(2)
        self._loss_rng = np.random.Generator(np.random.SFC64(loss))
        self._faulty_rng = np.random.Generator(np.random.SFC64(faulty))

    def carry(self, samples: Samples) -> Samples:
        """``samples`` with their times of arrival; ``host_t_s`` comes in as the end of their interval."""
        host = samples["host_t_s"]
        if self._device.latency_s:
            host = host + self._device.latency_s
        if self._device.bunching_s:
            host = np.ceil(host / self._device.bunching_s - _ON_TIME) * self._device.bunching_s
        kept: NDArray[np.bool_] | None = None
        for apply in (self._lost, self._lost_by_fault, self._silent):
            lost = apply(host)
            if lost is not None:
                kept = ~lost if kept is None else kept & ~lost
        samples = samples.with_columns({"host_t_s": host})
        if kept is None:
            return samples
        return Samples({name: column[kept] for name, column in samples.columns.items()})

    def _lost(self, host: Array) -> NDArray[np.bool_] | None:
        probability = self._device.dropout_probability
        return self._loss_rng.random(len(host)) < probability if probability else None

    def _lost_by_fault(self, host: Array) -> NDArray[np.bool_] | None:
        fault = self._faults.get("ahrs_dropouts")
        if fault is None:
            return None
        lost = (host >= fault.at_s) & (host < fault.until_s)
        lost[lost] = self._faulty_rng.random(int(lost.sum())) < _FAULTY_LOSS
        return lost

    def _silent(self, host: Array) -> NDArray[np.bool_] | None:
        fault = self._faults.get("ahrs_silent")
        return None if fault is None else (host >= fault.at_s) & (host < fault.until_s)


def _step(lsb: float, carried: bool, interval_s: float) -> float:
    """Step of a mean rate: of an increment it is the step over the interval."""
    return lsb / interval_s if carried else lsb


def rate_units_per_dps(device: DeviceSettings) -> float:
    """Output unit per °/s."""
    if device.rate_unit == "LSB":
        return 1.0 / device.gyro_lsb
    return float(np.radians(1.0)) if device.rate_unit == "rad/s" else 1.0


def _accel_unit(device: DeviceSettings) -> float:
    """Output unit per m/s²."""
    if device.accel_unit == "LSB":
        return 1.0 / device.accel_lsb
    return 1.0 / STANDARD_GRAVITY_MPS2 if device.accel_unit == "g" else 1.0
