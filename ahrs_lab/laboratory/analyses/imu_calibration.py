"""Discrete calibration of an inertial measurement unit, from one recording."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import partial
from pathlib import Path

from ahrs_lab.laboratory.analyses.kinds import AnalysisKind, Outcome, Setting, Value
from ahrs_lab.laboratory.evaluation import SOFTWARE
from ahrs_lab.messages import Message

SET = "calibration-set.json"
"""Name of the set among what can be saved."""


def _run(bundles: Sequence[Path], settings: Mapping[str, Value]) -> Outcome:
    from ahrs_lab.analysis.calibration_set_file import save_set
    from ahrs_lab.analysis.imu_calibration import calibrate_recording
    from ahrs_lab.recording.read import read_bundle

    gravity = float(settings["gravity_mps2"])
    found = calibrate_recording(
        read_bundle(bundles[0]), gravity_mps2=gravity if gravity else None, software=SOFTWARE
    )
    names = (SET, "calibration-set.csv", "calibration_set.h")
    saves = {name: partial(save_set, found.calibration) for name in names}
    return Outcome(found.to_json(), found.report(), saves=saves)


KIND = AnalysisKind(
    key="imu-calibrate",
    name=Message("IMU calibration"),
    explains=Message(
        "Scale factors, zero offsets, specific-force coefficients and misalignments of all gyros and "
        "accelerometers from whole turns about each axis in both senses and six or more positions at rest. "
        "The result is the calibration set that the compensation takes."
    ),
    inputs=(Message("recording of turns and positions (procedure imu-discrete)"),),
    settings=(
        Setting(
            key="gravity_mps2",
            label=Message("Gravity at the site"),
            kind="number",
            default=0.0,
            unit="m/s²",
            low=9.7,
            high=9.9,
            hint=Message("As measured; empty: what the recording says, else the normal formula."),
            blank=0.0,
        ),
    ),
    run=_run,
)
