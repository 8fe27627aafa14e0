"""``ahrs-lab imu-calibrate BUNDLE [--save SET.json]``."""

from __future__ import annotations

import argparse
from pathlib import Path

NAME = "imu-calibrate"
HELP = "Calibrates an inertial measurement unit from turns and positions."


def options(parser: argparse.ArgumentParser) -> None:
    """Arguments of the command."""
    parser.add_argument("bundle", type=Path, metavar="BUNDLE", help="recording of turns and positions")
    parser.add_argument(
        "--save", type=Path, metavar="SET.json", help="the set, as .json, .csv or .h (C header)"
    )
    parser.add_argument(
        "--gravity", type=float, metavar="MPS2", default=0.0, help="measured at the site, m/s²"
    )
    parser.add_argument("--out", type=Path, metavar="DIR", help="result and the set in all forms go there")


def run(arguments: argparse.Namespace) -> int:
    """Calibrate, print, save."""
    from ahrs_lab.cli.analysis.outcome import show
    from ahrs_lab.laboratory.analyses.files import write_outcome
    from ahrs_lab.laboratory.analyses.imu_calibration import KIND, SET

    outcome = KIND.run([arguments.bundle], {**KIND.defaults(), "gravity_mps2": arguments.gravity})
    files = [] if arguments.out is None else list(write_outcome(outcome, arguments.out).values())
    if arguments.save is not None:
        outcome.saves[SET](arguments.save)  # by its own suffix
        files.append(arguments.save)
    show(outcome, files, arguments)
    return 0
