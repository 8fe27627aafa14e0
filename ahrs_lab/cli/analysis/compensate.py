"""``ahrs-lab compensate BUNDLE --set SET.json --out BUNDLE2``."""

from __future__ import annotations

import argparse
from pathlib import Path

NAME = "compensate"
HELP = "Applies a calibration set to a recording."


def options(parser: argparse.ArgumentParser) -> None:
    """Arguments of the command."""
    parser.add_argument("bundle", type=Path, metavar="BUNDLE", help="recording, as it came from the unit")
    parser.add_argument(
        "--set", type=Path, metavar="SET.json", required=True, help="from imu-calibrate --save"
    )
    parser.add_argument(
        "--out", type=Path, metavar="BUNDLE2", required=True, help="the compensated recording"
    )


def run(arguments: argparse.Namespace) -> int:
    """Compensate, print, write the new recording."""
    from ahrs_lab.cli.analysis.outcome import show
    from ahrs_lab.laboratory.analyses.compensation import KIND, RECORDING

    outcome = KIND.run([arguments.bundle], {**KIND.defaults(), "set": str(arguments.set)})
    outcome.saves[RECORDING](arguments.out)
    show(outcome, [arguments.out], arguments)
    return 0
