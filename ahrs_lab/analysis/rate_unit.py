"""Whether rates are in the unit that a recording's header names: told only where it is clear.

Degrees and radians differ by 57.3, far more than any gyro's scale error, so a rate that is known otherwise
decides: what the table was asked for or reports, whole turns, or gravity turning through the accelerometers.
At rest only the Earth turns; a bias hides that of a MEMS unit, so both its vertical and its horizontal part
have to agree within 5 % of the Earth's rate in the other unit, which a bias all but never does.
"""

from __future__ import annotations

from math import radians

import numpy as np
from numpy.typing import NDArray

from ahrs_lab.inertial.earth import earth_rate_enu_radps

Array = NDArray[np.float64]

SLOWEST_RADPS = radians(1.0)
"""A rate known otherwise below that is not told from a bias."""
_AGREES = 1.25
_AGREES_AT_REST = 0.05
_WINDOW_S = 0.25
_CORRELATED = 0.9
_FEWEST_WINDOWS = 8


def agrees(ratio: float) -> bool:
    """Whether shown over true is about 1."""
    return 1.0 / _AGREES <= ratio <= _AGREES


def table_ratio(rate: Array, table_radps: Array | float) -> float | None:
    """Shown over true: ``rate`` (n, 3) in the header's unit against the table's, (n,) or one for all; None
    where the table stands."""
    true = np.abs(np.broadcast_to(np.asarray(table_radps, dtype=np.float64), len(rate)))
    turning = true >= SLOWEST_RADPS
    if 2 * np.count_nonzero(turning) < len(rate) or not turning.any():
        return None
    return float(np.median(np.linalg.norm(rate[turning], axis=1) / true[turning]))


def turns_ratio(increments_rad: Array, turns: float) -> float | None:
    """Shown over true: the sum of ``increments_rad`` (n, 3) against whole turns."""
    if not turns:
        return None
    return float(np.linalg.norm(increments_rad.sum(axis=0)) / (2.0 * np.pi * abs(turns)))


def gravity_ratio(increments_rad: Array, interval_s: Array, force: Array) -> float | None:
    """Shown over true: how far the rates turn the specific force (n, 3) against how far it really turned;
    None where it did not turn by the rates alone. Least squares of Δf on −Δθ × f."""
    step = max(1, round(_WINDOW_S / float(np.median(interval_s))))
    count = len(force) // step
    if count < _FEWEST_WINDOWS:
        return None
    means = force[: count * step].reshape(count, step, 3).mean(axis=1)
    angles = increments_rad[: count * step].reshape(count, step, 3).sum(axis=1)
    between = 0.5 * (angles[1:] + angles[:-1])
    change = np.diff(means, axis=0)
    turned = -np.cross(between, 0.5 * (means[1:] + means[:-1]))
    size = np.linalg.norm(np.median(np.abs(means), axis=0))
    if np.sqrt(np.mean(change**2)) < 0.5 * SLOWEST_RADPS * _WINDOW_S * size:
        return None
    product, own, other = (
        float(np.sum(a * b)) for a, b in ((change, turned), (change, change), (turned, turned))
    )
    if product < _CORRELATED * np.sqrt(own * other):
        return None
    return other / product


def shows_earth(mean_rate: Array, up: Array, latitude_deg: float) -> bool:
    """Whether a mean rate at rest (3,), rad/s, is the Earth's: along ``up`` (3,) and across it."""
    _, north, vertical = earth_rate_enu_radps(latitude_deg)
    along = float(mean_rate @ up)
    across = float(np.linalg.norm(mean_rate - along * up))
    allowed = _AGREES_AT_REST * float(np.hypot(north, vertical))
    return bool(abs(along - vertical) <= allowed and abs(across - north) <= allowed)
