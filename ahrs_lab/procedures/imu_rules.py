"""What a plan of the discrete calibration may not be, and what is said of one that can be run.

The rank of the scheme is checked here, before anything moves.
"""

from __future__ import annotations

import numpy as np

from ahrs_lab.errors import InputError
from ahrs_lab.messages import Message
from ahrs_lab.metrology.imu_calibration import PositionData
from ahrs_lab.procedures.figures import figure
from ahrs_lab.procedures.imu_discrete import Position, positions
from ahrs_lab.procedures.plan_settings import ImuPlan, Plan

LEAST_DWELL_S = 10.0
MOST_POSITIONS = 360


def check_imu(plan: Plan) -> None:
    """Raise InputError for the first setting of ``plan.imu`` that cannot be run or evaluated."""
    imu = plan.imu
    for setting, value, low, high in (
        ("imu.turns", imu.turns, 1, 10_000),
        ("imu.rate_dps", imu.rate_dps, 0.1, 1e5),
        ("imu.dwell_s", imu.dwell_s, LEAST_DWELL_S, 7 * 86400.0),
    ):
        if not low <= value <= high:
            raise InputError(
                "{setting} is {value}: write a number from {low} to {high}.",
                setting=setting,
                value=figure(value),
                low=figure(low),
                high=figure(high),
            )
    _check_list(imu)
    check_scheme(positions(imu))


def _check_list(imu: ImuPlan) -> None:
    if imu.scheme != "own" and imu.positions:
        raise InputError(
            "imu.positions is a list of your own, but imu.scheme asks for {scheme}: write scheme = “own”, or "
            "remove the list.",
            scheme=imu.scheme,
        )
    if len(imu.positions) > MOST_POSITIONS:
        raise InputError(
            "imu.positions lists {count} positions: {most} are the most.",
            count=len(imu.positions),
            most=MOST_POSITIONS,
        )
    if len(set(positions(imu))) < len(imu.positions):
        raise InputError(
            "imu.positions names a position twice: remove one; “repeats” has each recorded more than once."
        )


def check_scheme(wanted: tuple[Position, ...]) -> float:
    """The condition number of the positions; raises InputError where the coefficients are not separated."""
    from ahrs_lab.metrology.imu_estimation import check_positions  # not every plan pays for its statistics

    nothing = np.zeros(3)
    return check_positions([PositionData(one.case_to_enu, nothing, nothing, 1.0) for one in wanted])


def imu_remarks(plan: Plan) -> list[Message]:
    """What the textbook's scheme has otherwise, and what widens the results, as sentences for the record."""
    found = []
    wanted = positions(plan.imu)
    if plan.imu.scheme == "own":
        found.append(Message("The {count} positions are a list of the laboratory's own.", count=len(wanted)))
    north = np.array([one.case_to_enu[1] for one in wanted])
    up = np.array([one.case_to_enu[2] for one in wanted])
    design = np.column_stack([np.ones(len(up)), up])
    if np.max(np.abs(np.linalg.pinv(design) @ north)) > 1e-9:
        found.append(
            Message(
                "The azimuths of the positions do not balance: an error of the table's north enters the "
                "gyros' constant drifts and specific-force coefficients."
            )
        )
    if plan.power.off_between_mountings:
        found.append(
            Message(
                "Power is off between mountings: the positions are of several power-ons, and what the unit's "
                "drift differs between them is in the results."
            )
        )
    return found
