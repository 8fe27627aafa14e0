"""Self-alignment, as the command line and the Analysis page start it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import cast

from ahrs_lab.analysis.alignment import (
    ACCEL_BIAS_MPS2,
    GYRO_BIAS_DEG_PER_H,
    HEADING_LIMIT_DEG,
    AlignmentSettings,
    Axes,
    Method,
    align,
)
from ahrs_lab.analysis.alignment_report import METHOD_NAMES, ORTHOGONALISATION_NAMES
from ahrs_lab.analysis.inertial_record import InertialRecord, records
from ahrs_lab.inertial.alignment import Orthogonalisation
from ahrs_lab.laboratory.analyses.kinds import AnalysisKind, Outcome, Setting, Value
from ahrs_lab.messages import Message
from ahrs_lab.recording.read import read_bundle

AXES_NAMES: Mapping[Axes, Message] = {
    "xyz": Message("x right, y forward, z up"),
    "yzx": Message("y right, z forward, x up (JJF 1536)"),
}


def run(bundles: Sequence[Path], settings: Mapping[str, Value]) -> Outcome:
    """Align the unit of the first segment at rest, or of the one that is named."""
    file = str(settings["segment"])
    # how the unit stands is what is asked here: it need not be as the recording says
    record = _at_rest(records(read_bundle(bundles[0]), file or None, tolerated=("orientation",)))
    found = align(
        record,
        AlignmentSettings(
            method=cast(Method, settings["method"]),
            gyro_bias_deg_per_h=float(settings["gyro_bias_deg_per_h"]),
            accel_bias_mps2=float(settings["accel_bias_mps2"]),
            orthogonalisation=cast(Orthogonalisation, settings["orthogonalisation"]),
            axes=cast(Axes, settings["axes"]),
            heading_limit_deg=float(settings["heading_limit_deg"]),
        ),
    )
    return Outcome(found.to_json(), found.report(), found.series())


def _at_rest(found: Sequence[InertialRecord]) -> InertialRecord:
    """The first static segment, else the first that is not meant to turn, else the first."""
    still = [one for one in found if one.segment.item == "static"]
    still += [one for one in found if one.segment.role not in ("rate", "turns")]
    return (still or list(found))[0]


KIND = AnalysisKind(
    key="align",
    name=Message("Self-alignment"),
    explains=Message(
        "Finds heading, pitch and roll of a unit at rest from the Earth's rate and gravity. Needs gyros and "
        "accelerometers in SI units and gyros that are good to a fraction of the Earth's rate."
    ),
    inputs=(Message("Recording at rest"),),
    settings=(
        Setting("method", Message("Method"), "choice", "kalman-closed", choices=tuple(METHOD_NAMES.items())),
        Setting(
            "gyro_bias_deg_per_h",
            Message("Gyro bias assumed (1σ)"),
            "number",
            GYRO_BIAS_DEG_PER_H,
            "°/h",
            0.0,
            1000.0,
            hint=Message("An assumption: no recording at rest shows the bias of the gyro that points east."),
        ),
        Setting(
            "accel_bias_mps2",
            Message("Accelerometer bias assumed (1σ)"),
            "number",
            ACCEL_BIAS_MPS2,
            "m/s²",
            0.0,
            1.0,
            hint=Message("An assumption: all constant errors of one axis in this position."),
        ),
        Setting(
            "orthogonalisation",
            Message("Coarse: orthogonalisation"),
            "choice",
            "rows",
            choices=tuple(ORTHOGONALISATION_NAMES.items()),
        ),
        Setting("axes", Message("Axes of the angles"), "choice", "xyz", choices=tuple(AXES_NAMES.items())),
        Setting(
            "heading_limit_deg",
            Message("Refuse above a heading uncertainty of"),
            "number",
            HEADING_LIMIT_DEG,
            "°",
            0.001,
            20.0,
        ),
        Setting("segment", Message("Segment (empty: the first at rest)"), "text", ""),
    ),
    run=run,
)
