"""``ahrs-lab installation calibrate|compensate``: on angles, or on a recording."""

from __future__ import annotations

import argparse
import json
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from ahrs_lab.inertial.installation import Calibrated

NAME = "installation"
HELP = "Installation angles of a unit's bracket: calibrate them, or compensate angles for them."

_DIRECTIONS = ("box-in-aircraft", "aircraft-in-box")


def options(parser: argparse.ArgumentParser) -> None:
    """Two actions, each with its own options."""
    actions = parser.add_subparsers(dest="action", metavar="calibrate|compensate", required=True)

    def action(name: str, text: str) -> argparse.ArgumentParser:
        made = actions.add_parser(name, help=text, description=text)
        # the command has --json too; SUPPRESS keeps what was said there
        made.add_argument(
            "--json",
            action="store_true",
            default=argparse.SUPPRESS,
            help="one JSON object on standard output",
        )
        made.add_argument("bundle", type=Path, nargs="?", metavar="BUNDLE", help="recording with the angles")
        return made

    calibrate = action("calibrate", "δψ, δθ, δγ of the bracket from the aligned unit on the level carrier.")
    _angle(calibrate, "--pitch", "the unit's pitch, where there is no BUNDLE", None)
    _angle(calibrate, "--roll", "the unit's roll, where there is no BUNDLE", None)
    calibrate.add_argument(
        "--heading-error",
        type=float,
        required=True,
        metavar="DEG",
        help="surveyed heading of the bracket minus the carrier's",
    )
    _angle(calibrate, "--carrier-pitch", "what levelling left")
    _angle(calibrate, "--carrier-roll", "what levelling left")
    _angle(calibrate, "--u-attitude", "standard uncertainty of the unit's pitch and roll", None)
    _angle(calibrate, "--u-level", "standard uncertainty of the carrier's level", None)
    _angle(calibrate, "--u-heading-error", "standard uncertainty of the survey", None)
    calibrate.add_argument("--segment", default="", metavar="FILE", help="which one (the first)")
    calibrate.add_argument("--save", type=Path, metavar="SET.json", help="write the angles, for compensate")

    compensate = action("compensate", "The carrier's angles from the unit's.")
    for name in ("heading", "pitch", "roll"):
        _angle(compensate, f"--{name}", f"the unit's {name}, where there is no BUNDLE", None)
    compensate.add_argument(
        "--set", type=Path, metavar="SET.json", help="angles that “calibrate --save” wrote"
    )
    for name in ("heading", "pitch", "roll"):
        _angle(compensate, f"--bracket-{name}", f"installation angle of {name}, without --set", None)
    compensate.add_argument(
        "--direction",
        choices=_DIRECTIONS,
        help="whose attitude the installation angles are (box-in-aircraft)",
    )
    compensate.add_argument("--out", type=Path, metavar="BUNDLE2", help="write the corrected recording")


def _angle(parser: argparse.ArgumentParser, name: str, text: str, default: float | None = 0.0) -> None:
    parser.add_argument(name, type=float, default=default, metavar="DEG", help=text)


def run(arguments: argparse.Namespace) -> int:
    """Calibrate or compensate; returns the exit code."""
    return _calibrate(arguments) if arguments.action == "calibrate" else _compensate(arguments)


def _calibrate(arguments: argparse.Namespace) -> int:
    from ahrs_lab.analysis.report import report_text
    from ahrs_lab.errors import InputError
    from ahrs_lab.laboratory.analyses.installation import CALIBRATE
    from ahrs_lab.laboratory.evaluation import OutputFolder

    given = (arguments.pitch, arguments.roll)
    if arguments.bundle is None and None in given:
        raise InputError("Give the unit's --pitch and --roll on the level carrier, or a recording of them.")
    if arguments.bundle is not None and given != (None, None):
        raise InputError("Give either a recording or --pitch and --roll, not both.")
    for uncertainty in (arguments.u_attitude, arguments.u_level, arguments.u_heading_error):
        if uncertainty is not None and not uncertainty >= 0:
            raise InputError("A standard uncertainty is {value}°: it has to be 0 or more.", value=uncertainty)
    settings = {
        **CALIBRATE.defaults(),
        "unit_pitch_deg": arguments.pitch or 0.0,
        "unit_roll_deg": arguments.roll or 0.0,
        "heading_error_deg": arguments.heading_error,
        "carrier_pitch_deg": arguments.carrier_pitch,
        "carrier_roll_deg": arguments.carrier_roll,
        "u_attitude_deg": _or_open(arguments.u_attitude),
        "u_level_deg": _or_open(arguments.u_level),
        "u_heading_error_deg": _or_open(arguments.u_heading_error),
        "segment": arguments.segment,
    }
    outcome = CALIBRATE.run([] if arguments.bundle is None else [arguments.bundle], settings)
    if arguments.save is not None:
        with OutputFolder(arguments.save.parent):
            outcome.saves["installation.json"](arguments.save)
    print(
        json.dumps(outcome.data, ensure_ascii=False, allow_nan=False)
        if arguments.json
        else report_text(outcome.report)
    )
    return 0


def _or_open(uncertainty: float | None) -> float:
    return -1.0 if uncertainty is None else uncertainty


def _compensate(arguments: argparse.Namespace) -> int:
    from ahrs_lab.analysis.installation import compensate_angles, compensate_recording
    from ahrs_lab.analysis.report import report_text
    from ahrs_lab.errors import InputError
    from ahrs_lab.laboratory.analyses.installation import write_compensated
    from ahrs_lab.recording.read import read_bundle

    bracket = _bracket(arguments)
    given = (arguments.heading, arguments.pitch, arguments.roll)
    if arguments.bundle is None:
        if None in given:
            raise InputError("Give the unit's --heading, --pitch and --roll, or a recording of them.")
        if arguments.out is not None:
            raise InputError("--out belongs to a recording; the angles themselves are printed.")
        one = compensate_angles(*given, bracket)
        data, report = one.to_json(), one.report()
    else:
        if given != (None, None, None):
            raise InputError("Give either a recording or --heading, --pitch and --roll, not both.")
        recording = read_bundle(arguments.bundle)
        many = compensate_recording(recording, bracket)
        data, report = many.to_json(), many.report()
        if arguments.out is not None:
            write_compensated(recording, bracket, arguments.out)
            data["out"] = str(arguments.out)
    print(json.dumps(data, ensure_ascii=False, allow_nan=False) if arguments.json else report_text(report))
    return 0


def _bracket(arguments: argparse.Namespace) -> Calibrated:
    from ahrs_lab.analysis.installation import known_bracket
    from ahrs_lab.errors import InputError
    from ahrs_lab.laboratory.analyses.installation import read_bracket

    angles = (arguments.bracket_heading, arguments.bracket_pitch, arguments.bracket_roll)
    if arguments.set is not None:
        if angles != (None, None, None) or arguments.direction is not None:
            raise InputError("Give either --set or the bracket's angles and their direction, not both.")
        return read_bracket(arguments.set)
    if angles == (None, None, None):
        raise InputError(
            "Give the bracket with --set SET.json, or with --bracket-heading, --bracket-pitch and "
            "--bracket-roll."
        )
    heading, pitch, roll = (0.0 if angle is None else angle for angle in angles)
    return known_bracket(heading, pitch, roll, arguments.direction or "box-in-aircraft")
