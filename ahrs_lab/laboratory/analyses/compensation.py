"""A calibration set applied to another recording."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

from ahrs_lab.errors import InputError
from ahrs_lab.laboratory.analyses.kinds import AnalysisKind, Outcome, Setting, Value
from ahrs_lab.laboratory.evaluation import SOFTWARE
from ahrs_lab.messages import Message

RECORDING = "compensated"
"""Name of the compensated recording's folder among what can be saved."""


def _run(bundles: Sequence[Path], settings: Mapping[str, Value]) -> Outcome:
    from ahrs_lab.analysis.calibration_set_file import read_set
    from ahrs_lab.analysis.compensation import compensate_recording
    from ahrs_lab.recording.read import read_bundle

    path = str(settings["set"]).strip()
    if not path:
        raise InputError("Choose the calibration set (the JSON file that the IMU calibration saved).")
    found, sha256 = read_set(Path(path))
    compensated = compensate_recording(read_bundle(bundles[0]), found, set_sha256=sha256, software=SOFTWARE)
    return Outcome(compensated.to_json(), compensated.report(), saves={RECORDING: compensated.write})


KIND = AnalysisKind(
    key="compensate",
    name=Message("IMU compensation"),
    explains=Message(
        "Applies a calibration set to a recording of the same unit: rates in °/s and specific forces in m/s² "
        "come out, and what is left of the errors at rest is shown before and after."
    ),
    inputs=(Message("recording of the unit, as it came from it"),),
    settings=(Setting(key="set", label=Message("Calibration set"), kind="file", default=""),),
    run=_run,
)
