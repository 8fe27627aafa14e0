"""Strapdown navigation of a recording, as the command line and the Analysis page start it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import cast

from ahrs_lab.laboratory.analyses.kinds import AnalysisKind, Outcome, Setting, Value
from ahrs_lab.messages import Message


def _run(bundles: Sequence[Path], settings: Mapping[str, Value]) -> Outcome:
    from ahrs_lab.analysis.navigation import navigate_recording
    from ahrs_lab.analysis.navigation_result import Damping
    from ahrs_lab.recording.read import read_bundle

    result = navigate_recording(read_bundle(bundles[0]), cast(Damping, settings["altitude_damping"]))
    series = {"t_s": result.t_s, **result.series, **result.errors}
    return Outcome(result.to_json(), result.report(), series)


KIND = AnalysisKind(
    key="navigate",
    name=Message("Navigation"),
    explains=Message(
        "Attitude, velocity and position from gyros and accelerometers, from the state in [initial] on. "
        "Where the recording has columns of attitude, velocity or position, the errors against them are "
        "shown."
    ),
    inputs=(Message("Recording with [initial]"),),
    settings=(
        Setting(
            key="altitude_damping",
            label=Message("Altitude damping"),
            kind="choice",
            default="none",
            choices=(
                ("none", Message("none: the height is inertial and runs away")),
                ("baro", Message("baro: the height follows the column altitude_m, or the initial height")),
            ),
        ),
    ),
    run=_run,
)
