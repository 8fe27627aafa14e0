"""``ahrs-lab error-propagation``."""

from __future__ import annotations

import argparse
from pathlib import Path

NAME = "error-propagation"
HELP = "Shows how one error of an inertial system at rest grows over hours."


def options(parser: argparse.ArgumentParser) -> None:
    """The error, where, how long."""
    parser.add_argument(
        "source",
        metavar="SOURCE",
        help="tilt_east, tilt_north (″), azimuth (′), velocity_east, velocity_north (m/s), latitude (″), "
        "gyro_east, gyro_north, gyro_up (°/h), accel_east, accel_north (µg)",
    )
    parser.add_argument("size", type=float, metavar="SIZE", help="in the unit named with the source")
    parser.add_argument("--latitude", type=float, required=True, metavar="DEG", help="of the place, °")
    parser.add_argument("--hours", type=float, default=48.0, help="how long (default: 48)")
    parser.add_argument("--out", type=Path, metavar="DIR", help="result and series go there")


def run(arguments: argparse.Namespace) -> int:
    """Propagate and say the errors."""
    from ahrs_lab.cli.analysis.outcome import run_kind
    from ahrs_lab.laboratory.analyses.error_propagation import KIND

    settings = {
        "source": arguments.source,
        "size": arguments.size,
        "latitude_deg": arguments.latitude,
        "hours": arguments.hours,
    }
    return run_kind(KIND, [], settings, arguments)
