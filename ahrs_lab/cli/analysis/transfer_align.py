"""``ahrs-lab transfer-align REFERENCE UNIT``: every setting of the analysis is an option."""

from __future__ import annotations

import argparse
from pathlib import Path

from ahrs_lab.cli.analysis.outcome import out_option, run_kind

NAME = "transfer-align"
HELP = "Aligns a unit against a reference inertial system on the same carrier."

_METHODS = ("velocity", "position", "velocity-azimuth", "velocity-attitude")
# as the analysis has them; written out, so that --help need not import it
_NUMBERS = (
    ("velocity_noise_mps", "noise of the reference's velocity (0.05)"),
    ("position_noise_m", "noise of the reference's position (2)"),
    ("attitude_noise_deg", "noise of the reference's angles (0.02)"),
    ("angle_random_walk_deg_per_sqrt_h", "the unit's angle random walk (0.1)"),
    ("velocity_random_walk_mps_per_sqrt_h", "the unit's velocity random walk (0.05)"),
    ("level_deg", "assumed misalignment at the start, level (1)"),
    ("azimuth_deg", "assumed misalignment at the start, azimuth (3)"),
    ("mounting_deg", "assumed mounting of the unit's case (2)"),
    ("velocity_mps", "assumed error of the unit's velocity at the start (0.5)"),
    ("position_m", "assumed error of the unit's position at the start (10)"),
    ("gyro_bias_deg_per_h", "assumed gyro bias (10)"),
    ("accel_bias_mps2", "assumed accelerometer bias (0.01)"),
    ("gyro_scale_ppm", "assumed scale error of the gyros (500)"),
    ("accel_scale_ppm", "assumed scale error of the accelerometers (500)"),
    ("gyro_cross_mrad", "assumed misalignment of the gyros in the case (0.5)"),
    ("accel_cross_mrad", "assumed misalignment of the accelerometers in the case (0.5)"),
    ("level_limit_deg", "azimuth is compared below this roll and pitch (5)"),
    ("every_s", "least time between comparisons (1)"),
)


def options(parser: argparse.ArgumentParser) -> None:
    """Two recordings, the method, and what is assumed."""
    parser.add_argument("reference", type=Path, metavar="REFERENCE", help="recording of the reference")
    parser.add_argument("unit", type=Path, metavar="UNIT", help="recording of the unit")
    parser.add_argument("--method", choices=_METHODS, default="velocity", help="what is compared (velocity)")
    for key, text in _NUMBERS:
        parser.add_argument(f"--{key.replace('_', '-')}", type=float, metavar="X", help=text)
    parser.add_argument(
        "--lever",
        type=float,
        nargs=3,
        metavar=("X", "Y", "Z"),
        help="the unit's place from the reference's along the unit's axes, m (0 0 0)",
    )
    parser.add_argument("--reference-segment", metavar="FILE", help="which of the reference's (the first)")
    out_option(parser)


def run(arguments: argparse.Namespace) -> int:
    """Align; returns the exit code."""
    from ahrs_lab.laboratory.analyses.transfer_alignment import KIND

    keys = ["method", *(key for key, _ in _NUMBERS), "reference_segment"]
    settings = {key: getattr(arguments, key) for key in keys if getattr(arguments, key) is not None}
    if arguments.lever is not None:
        settings |= {f"lever_{axis}_m": value for axis, value in zip("xyz", arguments.lever, strict=True)}
    return run_kind(KIND, (arguments.reference, arguments.unit), settings, arguments)
