"""The commands of the systems beside the standard, one module each: ``NAME``, ``HELP``, ``options(parser)``
and ``run(arguments)``. Modules import what they do only in ``run``, so that ``--help`` answers at once."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from typing import Protocol


class Command(Protocol):
    """What the parser needs of such a module."""

    NAME: str
    HELP: str

    def options(self, parser: argparse.ArgumentParser) -> None:
        """Add the command's arguments."""

    def run(self, arguments: argparse.Namespace) -> int:
        """Do it; returns the exit code."""


def commands() -> Sequence[Command]:
    """In the order of the help text."""
    from ahrs_lab.cli.analysis import (
        align,
        allan,
        compensate,
        error_propagation,
        imu_calibrate,
        installation,
        navigate,
        transfer_align,
    )

    return (
        allan,
        imu_calibrate,
        compensate,
        navigate,
        error_propagation,
        align,
        transfer_align,
        installation,
    )
