"""``ahrs-lab allan``: noise coefficients from a recording at rest."""

from __future__ import annotations

import argparse
from pathlib import Path

NAME = "allan"
HELP = "Allan deviation of a recording at rest, with the noise coefficients of each channel"


def options(parser: argparse.ArgumentParser) -> None:
    """The command's arguments."""
    from ahrs_lab.cli.analysis.outcome import out_option

    parser.add_argument("bundle", type=Path, metavar="BUNDLE", help="recording: a folder or .ahrsrec")
    parser.add_argument("--segment", metavar="FILE", default="", help="default: the longest segment at rest")
    parser.add_argument(
        "--taus",
        default="octave",
        help="octave, all, or averaging times in seconds: 1,10,100 (default: octave)",
    )
    out_option(parser)


def run(arguments: argparse.Namespace) -> int:
    """Do it."""
    from ahrs_lab.cli.analysis.outcome import run_kind
    from ahrs_lab.laboratory.analyses.allan import KIND

    settings = {"segment": arguments.segment, "taus": arguments.taus}
    return run_kind(KIND, [arguments.bundle], settings, arguments)
