"""A calibration set applied to a recording, (2-190) … (2-193): rates in °/s and specific forces in m/s² come
out.

The exact inverse of (2-27), (2-28): f from the accelerometers first, then ω. In increments over an interval τ
every term accumulates: B0·τ and Bf·f·τ alike ((2-191) prints τ_c with the one and leaves τ out with the
other).
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ahrs_lab.analysis.imu_calibration import NOMINAL_RATE_SCALE, site_gravity_mps2
from ahrs_lab.analysis.imu_report import DPH, FORMULA
from ahrs_lab.analysis.imu_segments import at_rest, case_to_enu_of
from ahrs_lab.analysis.report import Chart, Curve, Report, Table
from ahrs_lab.analysis.report_cells import column
from ahrs_lab.errors import InputError
from ahrs_lab.inertial.earth import STANDARD_GRAVITY_MPS2, earth_rate_enu_dps
from ahrs_lab.messages import Message
from ahrs_lab.metrology.imu_calibration import ImuCalibration
from ahrs_lab.recording.read import RecordedSegment, Recording
from ahrs_lab.recording.samples import ACCEL, ANGLE, GYRO, Samples
from ahrs_lab.recording.segment import RecordingHeader, Segment
from ahrs_lab.recording.write_whole import write_bundle

Array = NDArray[np.float64]

NOTE = "compensation"
"""Table of the compensated recording's header that says where it comes from."""
NOMINAL_ACCEL_SCALE = {"m/s^2": 1.0, "g": 1.0 / STANDARD_GRAVITY_MPS2}
UNLIKE_GRAVITY = 0.05


def compensate(
    found: ImuCalibration, gyro: Array, accel: Array | None, interval_s: Array | None = None
) -> tuple[Array, Array | None]:
    """Shape (n, 3) each: ω in °/s and f in m/s² of outputs of shape (n, 3) in the set's units.

    ``interval_s`` (n,): the outputs are increments (pulses) over it; None: they are means. Without ``accel``
    the forces are None; a set whose Bf is not zero then cannot be applied: ValueError.
    """
    if interval_s is not None:
        gyro = gyro / interval_s[:, np.newaxis]
        accel = None if accel is None else accel / interval_s[:, np.newaxis]
    g, a = found.gyro, found.accel
    force: Array | None = None
    felt: Array | float = 0.0
    if accel is not None:
        force = np.asarray(np.linalg.solve(np.eye(3) + a.K, (accel / a.K1 - a.K0).T).T, dtype=np.float64)
        felt = force @ g.Bf.T
    elif g.Bf.any():
        raise ValueError("Bf needs the specific force")
    rate = np.linalg.solve(np.eye(3) + g.E, (gyro / g.E1 - g.B0 - felt).T).T
    return np.asarray(rate, dtype=np.float64), force


@dataclass(frozen=True)
class StaticCheck:
    """A dwell at rest: what gyros (°/s) and accelerometers (m/s²) show beyond the Earth's rate and gravity,
    shape (3,) each, before and after. Before, a physical unit is taken at its word and counts are divided by
    E1, K1. Forces are None where there are none."""

    file: str
    rate_before_dps: Array
    rate_after_dps: Array
    force_before_mps2: Array | None
    force_after_mps2: Array | None


@dataclass(frozen=True)
class Compensated:
    """The compensated recording, not yet written."""

    header: RecordingHeader
    segments: tuple[tuple[Segment, Samples], ...]
    checks: tuple[StaticCheck, ...]
    warnings: tuple[Message, ...]
    source_sha256: str
    set_sha256: str

    def to_json(self) -> dict[str, Any]:
        """Residuals against the Earth's rate and gravity of every dwell at rest, before and after."""

        def listed(vector: Array | None) -> list[float] | None:
            return None if vector is None else vector.tolist()

        return {
            "source_sha256": self.source_sha256,
            "set_sha256": self.set_sha256,
            "rate_unit": self.header.device.rate_unit,
            "accel_unit": self.header.device.accel_unit,
            "formula": FORMULA.text(),
            "segments": [segment.file for segment, _ in self.segments],
            "static": [
                {
                    "segment": check.file,
                    "rate_residual_before_dps": listed(check.rate_before_dps),
                    "rate_residual_after_dps": listed(check.rate_after_dps),
                    "force_residual_before_mps2": listed(check.force_before_mps2),
                    "force_residual_after_mps2": listed(check.force_after_mps2),
                }
                for check in self.checks
            ],
            "warnings": [{"what": m.text(), "message": m.to_json()} for m in self.warnings],
        }

    def report(self) -> Report:
        """Before and after, dwell by dwell."""
        return Report(
            title=Message("Compensated recording"),
            tables=(_table(self.checks),) if self.checks else (),
            charts=_charts(self.checks) if self.checks else (),
            notes=(
                FORMULA,
                Message(
                    "The compensated recording is in deg/s and m/s^2; the residuals take the case to stand "
                    "exactly as each segment says."
                ),
            ),
            warnings=self.warnings,
        )

    def write(self, folder: Path) -> None:
        """As a recording bundle in a new folder, or packed where the name ends in ``.ahrsrec``."""
        write_bundle(folder, self.header, self.segments)


def compensate_recording(
    recording: Recording, found: ImuCalibration, *, set_sha256: str = "", software: str = ""
) -> Compensated:
    """Apply ``found`` to every segment that counts.

    Raises InputError where the set's units are not the recording's, where it was applied already, or where
    columns are missing.
    """
    header = recording.header
    _refuse_unfit(header, found)
    kept = [r for r in recording.segments if r.counts and len(r.samples)]
    if not kept:
        raise InputError(
            "The recording has no segment with samples that count: there is nothing to compensate."
        )
    gravity, _ = site_gravity_mps2(header)
    segments, checks, warnings = [], [], list(_doubts(header, found))
    for recorded in kept:
        samples, told = _applied(recorded, found)
        warnings += told
        segments.append((recorded.segment, samples))
        if recorded.usable and at_rest(recorded.segment):
            checks.append(_check(recorded, samples, header, found, gravity))
    warnings += _unlike_gravity(checks, gravity)
    said: dict[str, Any] = {
        "source_sha256": recording.sha256,
        "set_sha256": set_sha256,
        "software": software,
        "formula": FORMULA.text(),
        "source_rate_unit": header.device.rate_unit,
        "source_accel_unit": header.device.accel_unit,
        "set": {key: value for key, value in found.provenance.items() if value != ""},
        "warnings": [warning.text() for warning in warnings],
    }
    device = replace(header.device, rate_unit="deg/s", accel_unit="m/s^2")
    return Compensated(
        header=replace(header, device=device, notes={**header.notes, NOTE: said}),
        segments=tuple(segments),
        checks=tuple(checks),
        warnings=tuple(warnings),
        source_sha256=recording.sha256,
        set_sha256=set_sha256,
    )


def _refuse_unfit(header: RecordingHeader, found: ImuCalibration) -> None:
    if NOTE in header.notes:
        raise InputError(
            "The recording was compensated already (its recording.toml has a table [compensation]): apply "
            "the set to the recording as it came from the unit."
        )
    device = header.device
    for key, has, needs in (
        ("rate_unit", device.rate_unit, found.rate_unit),
        ("accel_unit", device.accel_unit, found.accel_unit),
    ):
        if needs and has != needs:
            raise InputError(
                "The recording's {key} is {has}, but the calibration set was made from outputs in {needs}: "
                "record in the same unit, or calibrate again.",
                key=key,
                has=has,
                needs=needs,
            )
    for name, scale, nominal, unit in (
        ("E1", found.gyro.E1, NOMINAL_RATE_SCALE.get(device.rate_unit), device.rate_unit),
        ("K1", found.accel.K1, NOMINAL_ACCEL_SCALE.get(device.accel_unit), device.accel_unit),
    ):
        if nominal is not None and not np.all((scale / nominal > 0.5) & (scale / nominal < 2.0)):
            raise InputError(
                "The calibration set's {name} is {scale}, but a recording in {unit} needs about {nominal}: "
                "the set was made from outputs in another unit.",
                name=name,
                scale=", ".join(f"{value:.6g}" for value in scale),
                unit=unit,
                nominal=f"{nominal:.6g}",
            )


def _doubts(header: RecordingHeader, found: ImuCalibration) -> Iterator[Message]:
    made_from, here = str(found.provenance.get("serial_number", "")), header.device.serial_number
    if made_from and here and made_from != here:
        yield Message(
            "The set was made from the unit s/n {set}, the recording is of s/n {here}.",
            set=made_from,
            here=here,
        )
    if "bundle_sha256" not in found.provenance:
        yield Message("The calibration set does not say which recording it was made from.")


def _applied(recorded: RecordedSegment, found: ImuCalibration) -> tuple[Samples, list[Message]]:
    """The segment's samples after compensation, and what had to be left out of them."""
    samples, file = recorded.samples, recorded.segment.file
    missing = [name for name in GYRO if name not in samples]
    has_force = all(name in samples for name in ACCEL)
    if not has_force and found.gyro.Bf.any():
        missing += [name for name in ACCEL if name not in samples]
    if missing:
        raise InputError(
            "{file} has no column {missing}: the compensation needs it (Bf·f takes the accelerometers).",
            file=file,
            missing=", ".join(missing),
        )
    told = []
    if has_force:
        blind = ~np.all(np.isfinite(samples.matrix(ACCEL)), axis=1)
        if blind.all():
            raise InputError("{file}: no row has numbers of all accelerometers.", file=file)
        if blind.any():
            samples = Samples({name: column[~blind] for name, column in samples.columns.items()})
            told.append(
                Message(
                    "{file}: {count} rows without numbers of all accelerometers are left out.",
                    file=file,
                    count=int(blind.sum()),
                )
            )
    stale = [name for name in ANGLE if name in samples]
    if stale:
        samples = Samples({name: column for name, column in samples.columns.items() if name not in stale})
        told.append(
            Message(
                "{file}: {columns}, the unit's own sums of uncompensated rates, are left out.",
                file=file,
                columns=", ".join(stale),
            )
        )
    rate, force = compensate(found, samples.matrix(GYRO), samples.matrix(ACCEL) if has_force else None)
    columns: Mapping[str, Array] = {name: rate[:, i].copy() for i, name in enumerate(GYRO)}
    if force is not None:
        columns = {**columns, **{name: force[:, i].copy() for i, name in enumerate(ACCEL)}}
    return samples.with_columns(columns), told


def _check(
    recorded: RecordedSegment, after: Samples, header: RecordingHeader, found: ImuCalibration, gravity: float
) -> StaticCheck:
    matrix = case_to_enu_of(recorded.segment)
    earth = matrix.T @ earth_rate_enu_dps(header.site.latitude_deg)
    up = matrix.T @ np.array([0.0, 0.0, gravity])
    rate_scale = NOMINAL_RATE_SCALE.get(header.device.rate_unit, found.gyro.E1)
    force_scale = NOMINAL_ACCEL_SCALE.get(header.device.accel_unit, found.accel.K1)
    before = recorded.samples
    has_force = all(name in before for name in ACCEL)
    return StaticCheck(
        file=recorded.segment.file,
        rate_before_dps=before.matrix(GYRO).mean(axis=0) / rate_scale - earth,
        rate_after_dps=after.matrix(GYRO).mean(axis=0) - earth,
        force_before_mps2=np.nanmean(before.matrix(ACCEL), axis=0) / force_scale - up if has_force else None,
        force_after_mps2=after.matrix(ACCEL).mean(axis=0) - up if has_force else None,
    )


def _unlike_gravity(checks: Sequence[StaticCheck], gravity: float) -> list[Message]:
    forces = [float(np.linalg.norm(c.force_after_mps2)) for c in checks if c.force_after_mps2 is not None]
    if not forces or float(np.median(forces)) <= UNLIKE_GRAVITY * gravity:
        return []
    return [
        Message(
            "At rest the compensated specific force is off by {off} m/s² (median): is the set of this unit, "
            "and are the orientations right?",
            off=f"{float(np.median(forces)):.3g}",
        )
    ]


def _table(checks: Sequence[StaticCheck]) -> Table:
    def sizes(vectors: Iterable[Array | None], factor: float) -> tuple[str, ...]:
        return column(
            np.nan if vector is None else factor * float(np.linalg.norm(vector)) for vector in vectors
        )

    head = (
        Message("at rest"),
        Message("rate before, °/h"),
        Message("rate after, °/h"),
        Message("force before, mm/s²"),
        Message("force after, mm/s²"),
    )
    columns = (
        (check.file for check in checks),
        sizes((check.rate_before_dps for check in checks), DPH),
        sizes((check.rate_after_dps for check in checks), DPH),
        sizes((check.force_before_mps2 for check in checks), 1e3),
        sizes((check.force_after_mps2 for check in checks), 1e3),
    )
    title = Message("Residual against the Earth's rate and gravity")
    return Table(title, head, tuple(zip(*columns, strict=True)))


def _charts(checks: Sequence[StaticCheck]) -> tuple[Chart, ...]:
    numbers = np.arange(1.0, len(checks) + 1.0)

    def curves(before: Sequence[Array], after: Sequence[Array], factor: float) -> tuple[Curve, ...]:
        return (
            Curve(
                Message("before compensation"),
                numbers,
                factor * np.linalg.norm(before, axis=1),
                style="points",
            ),
            Curve(
                Message("after compensation"), numbers, factor * np.linalg.norm(after, axis=1), style="points"
            ),
        )

    position = Message("position, number")
    rates = curves([c.rate_before_dps for c in checks], [c.rate_after_dps for c in checks], DPH)
    charts = [
        Chart(Message("Rate beyond the Earth's"), position, Message("residual, °/h"), rates, log_y=True)
    ]
    before = [c.force_before_mps2 for c in checks if c.force_before_mps2 is not None]
    after = [c.force_after_mps2 for c in checks if c.force_after_mps2 is not None]
    if len(before) == len(after) == len(checks):
        forces = curves(before, after, 1e3)
        charts.append(
            Chart(Message("Force beyond gravity"), position, Message("residual, mm/s²"), forces, log_y=True)
        )
    return tuple(charts)
