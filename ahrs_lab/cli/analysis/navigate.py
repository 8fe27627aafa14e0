"""``ahrs-lab navigate BUNDLE``."""

from __future__ import annotations

import argparse
from pathlib import Path

NAME = "navigate"
HELP = "Navigates a recording from its [initial] state: attitude, velocity, position."


def options(parser: argparse.ArgumentParser) -> None:
    """The recording, the height loop, where the series goes."""
    parser.add_argument("bundle", type=Path, metavar="BUNDLE", help="recording with gyros and accelerometers")
    parser.add_argument(
        "--altitude-damping",
        choices=("none", "baro"),
        default="none",
        help="baro: the height follows the column altitude_m, or the initial height (default: none)",
    )
    parser.add_argument("--out", type=Path, metavar="DIR", help="result and series go there")


def run(arguments: argparse.Namespace) -> int:
    """Navigate and say the final state."""
    from ahrs_lab.cli.analysis.outcome import run_kind
    from ahrs_lab.laboratory.analyses.navigation import KIND

    return run_kind(KIND, [arguments.bundle], {"altitude_damping": arguments.altitude_damping}, arguments)
