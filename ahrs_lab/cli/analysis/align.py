"""``ahrs-lab align BUNDLE``: self-alignment of a recorded unit at rest."""

from __future__ import annotations

import argparse
from pathlib import Path

from ahrs_lab.cli.analysis.outcome import out_option, run_kind

NAME = "align"
HELP = "Self-alignment of a unit at rest: heading, pitch and roll with their uncertainty."


def options(parser: argparse.ArgumentParser) -> None:
    """Add the command's arguments."""
    parser.add_argument("bundle", type=Path, metavar="BUNDLE")
    parser.add_argument(
        "--method", choices=("coarse", "fine", "kalman-open", "kalman-closed"), default="kalman-closed"
    )
    parser.add_argument("--segment", default="", metavar="FILE", help="default: the first segment at rest")
    parser.add_argument(
        "--gyro-bias",
        type=_at_least_zero,
        metavar="DEG_PER_H",
        help="assumed standard deviation of the gyros' constant bias, °/h (0.03)",
    )
    parser.add_argument(
        "--accel-bias",
        type=_at_least_zero,
        metavar="MPS2",
        help="assumed standard deviation of the accelerometers' constant error, m/s² (0.001)",
    )
    parser.add_argument(
        "--orthogonalisation",
        choices=("rows", "columns", "svd"),
        default="rows",
        help="of the coarse method: rows, up first; the printed column order; the nearest matrix",
    )
    parser.add_argument(
        "--axes",
        choices=("xyz", "yzx"),
        default="xyz",
        help="case axes that are right, forward, up to the angles; yzx is JJF 1536's",
    )
    parser.add_argument(
        "--heading-limit", type=_positive, metavar="DEG", help="refuse above this uncertainty of heading (5)"
    )
    out_option(parser)


def run(arguments: argparse.Namespace) -> int:
    """Align and print."""
    from ahrs_lab.laboratory.analyses.alignment import KIND

    settings = {
        "method": arguments.method,
        "segment": arguments.segment,
        "orthogonalisation": arguments.orthogonalisation,
        "axes": arguments.axes,
        "gyro_bias_deg_per_h": arguments.gyro_bias,
        "accel_bias_mps2": arguments.accel_bias,
        "heading_limit_deg": arguments.heading_limit,
    }
    given = {key: value for key, value in settings.items() if value is not None}
    return run_kind(KIND, [arguments.bundle], given, arguments)


def _at_least_zero(text: str) -> float:
    return _number(text, 0.0, "0 or more")


def _positive(text: str) -> float:
    return _number(text, 1e-9, "above 0")


def _number(text: str, low: float, what: str) -> float:
    try:
        value = float(text)
    except ValueError:
        value = float("nan")
    if not low <= value < 1e6:
        raise argparse.ArgumentTypeError(f"“{text}” is not a number {what}")
    return value
