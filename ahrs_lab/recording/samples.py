"""Samples are columns: a block holds arrays of equal length, nothing handles one sample at a time.

Column names are those of the recording bundle: ``t_s`` (end of the sample's interval, device time base),
``gyro_x …`` (the device's rate unit, mean over the interval), ``accel_x …``, ``angle_x …`` (deg,
accumulated), ``heading_deg pitch_deg roll_deg``, ``temperature_c``, ``counter``, ``host_t_s``,
``table_angle_deg`` (unwrapped while live), ``table_rate_dps``. Unknown columns are carried.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from ahrs_lab.recording.orientation import AXES

Array = NDArray[np.float64]

GYRO = tuple(f"gyro_{axis}" for axis in AXES)
ACCEL = tuple(f"accel_{axis}" for axis in AXES)
ANGLE = tuple(f"angle_{axis}" for axis in AXES)
ATTITUDE = ("heading_deg", "pitch_deg", "roll_deg")
VELOCITY_ENU = ("ve_mps", "vn_mps", "vu_mps")
POSITION = ("latitude_deg", "longitude_deg", "altitude_m")

GAP_STEPS = 1.5
"""A step in time of more sample intervals than this is a gap."""


@dataclass(frozen=True)
class Samples:
    """A block of n samples: each column a float64 array of shape (n,)."""

    columns: Mapping[str, Array] = field(default_factory=dict)

    def __post_init__(self) -> None:
        lengths = {len(column) for column in self.columns.values()}
        if len(lengths) > 1:
            raise ValueError(f"columns of unequal length: {sorted(lengths)}")

    def __len__(self) -> int:
        return len(next(iter(self.columns.values()))) if self.columns else 0

    def __contains__(self, name: str) -> bool:
        return name in self.columns

    def __getitem__(self, name: str) -> Array:
        return self.columns[name]

    def get(self, name: str) -> Array | None:
        """The column, or None where the device does not give it."""
        return self.columns.get(name)

    def matrix(self, names: Iterable[str]) -> Array:
        """Shape (n, len(names)), float64."""
        return np.column_stack([self.columns[name] for name in names])

    def rows(self, start: int, stop: int | None = None) -> Samples:
        """The rows start:stop, as views."""
        return Samples({name: column[start:stop] for name, column in self.columns.items()})

    def with_columns(self, columns: Mapping[str, Array]) -> Samples:
        """This block with columns added or replaced."""
        return Samples({**self.columns, **columns})


def concatenate(blocks: Iterable[Samples]) -> Samples:
    """One block of several, in order; empty blocks count for nothing; the first names the columns."""
    full = [block for block in blocks if len(block)]
    if not full:
        return Samples()
    if len(full) == 1:
        return full[0]
    return Samples({name: np.concatenate([block[name] for block in full]) for name in full[0].columns})


def interval_s(samples: Samples, sample_rate_hz: float, *, bridge_gaps: bool = True) -> Array:
    """Shape (n,): the interval each row is the mean over, s: its ``t_s`` minus the one before it.

    The first row's interval is 1/``sample_rate_hz``. A column times this is the row's increment, and the sum
    of increments the change of angle. Where rows are missing (a step of more than :data:`GAP_STEPS` sample
    intervals) the next row's mean is taken for the whole step, so that a turn stays whole; with
    ``bridge_gaps`` off that row counts for one sample interval, so that a dwell is averaged over what was
    really seen.
    """
    t_s = samples["t_s"]
    if not len(t_s):
        return np.empty(0)
    nominal_s = 1.0 / sample_rate_hz
    interval = np.diff(t_s, prepend=t_s[0] - nominal_s)
    if not bridge_gaps:
        interval[interval > GAP_STEPS * nominal_s] = nominal_s
    return interval
