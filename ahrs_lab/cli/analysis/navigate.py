"""``ahrs-lab navigate BUNDLE``."""

from __future__ import annotations

import argparse
from pathlib import Path

NAME = "navigate"
HELP = "strapdown navigation of a recording from its [initial] state"


def options(parser: argparse.ArgumentParser) -> None:
    """The recording, the height loop, where the series goes."""
    from ahrs_lab.cli.analysis.outcome import out_option

    parser.add_argument("bundle", type=Path, metavar="BUNDLE", help="recording with gyros and accelerometers")
    parser.add_argument(
        "--altitude-damping",
        choices=("none", "baro"),
        default="none",
        help="baro: the height follows the column altitude_m, or the initial height (default: none)",
    )
    out_option(parser)


def run(arguments: argparse.Namespace) -> int:
    """Navigate and say the final state."""
    from ahrs_lab.cli.analysis.outcome import run_kind
    from ahrs_lab.laboratory.analyses.navigation import KIND

    return run_kind(KIND, [arguments.bundle], {"altitude_damping": arguments.altitude_damping}, arguments)
