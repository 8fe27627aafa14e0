"""The Allan deviation as a kind of analysis."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ahrs_lab.analysis.allan import AllanResult, Taus, analyse_allan, longest_at_rest
from ahrs_lab.analysis.allan_report import allan_report
from ahrs_lab.analysis.inertial_record import records
from ahrs_lab.errors import InputError
from ahrs_lab.laboratory.analyses.kinds import AnalysisKind, Outcome, Setting, Value
from ahrs_lab.messages import Message
from ahrs_lab.recording.read import read_bundle


def taus_of(text: str) -> Taus:
    """``octave``, ``all``, or averaging times in seconds with commas between them."""
    word = text.strip().lower()
    if word in ("", "octave", "octaves"):
        return "octave"
    if word == "all":
        return "all"
    try:
        return [float(part) for part in text.replace("，", ",").split(",") if part.strip()]
    except ValueError:
        raise InputError(
            "“{text}” is no list of averaging times: write seconds with commas between them, such as "
            "1,10,100, or octave, or all.",
            text=text,
        ) from None


def _run(bundles: Sequence[Path], settings: Mapping[str, Value]) -> Outcome:
    taus = taus_of(str(settings["taus"]))
    file = str(settings["segment"]).strip()
    found = records(read_bundle(bundles[0]), file or None)
    record = found[0] if file else longest_at_rest(found)
    result = analyse_allan(record, taus)
    return Outcome(result.to_json(), allan_report(result), _series(result))


def _series(result: AllanResult) -> dict[str, NDArray[Any]]:
    """One row a channel and averaging time."""
    rows = [
        (one.name, one.unit, *row)
        for one in result.channels
        for row in zip(
            one.tau_s,
            one.deviation,
            one.low,
            one.high,
            one.fit.deviation(one.tau_s) if one.fit is not None else np.zeros(len(one.tau_s)),
            strict=True,
        )
    ]
    names = ("channel", "unit", "tau_s", "oadev", "oadev_low", "oadev_high", "fit")
    return {name: np.array(column) for name, column in zip(names, zip(*rows, strict=True), strict=True)}


KIND = AnalysisKind(
    key="allan",
    name=Message("Allan deviation"),
    explains=Message(
        "Noise of a unit at rest over averaging time, and from it the noise coefficients of each gyro and "
        "accelerometer. Needs one long recording at rest: a coefficient that acts at 100 s asks for an hour."
    ),
    inputs=(Message("recording"),),
    settings=(
        Setting(
            "segment",
            Message("segment"),
            "text",
            "",
            hint=Message("File of the segment; empty: the longest one at rest."),
        ),
        Setting(
            "taus",
            Message("averaging times"),
            "text",
            "octave",
            unit="s",
            hint=Message("octave, all, or seconds with commas between them: 1,10,100"),
        ),
    ),
    run=_run,
)
