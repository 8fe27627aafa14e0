"""JJF 1536-2015, 7.1 to 7.3: what is recorded in each mounting.

Rest → rates in ± pairs → rest → ±n turns → positions.
"""

from __future__ import annotations

from ahrs_lab.instruments.interfaces import TableLimits
from ahrs_lab.procedures.blocks import Session
from ahrs_lab.procedures.plan_settings import Plan
from ahrs_lab.procedures.schedule import plan_mountings
from ahrs_lab.procedures.takes import blocks


def sessions(plan: Plan, limits: TableLimits) -> tuple[Session, ...]:
    """The mountings of ``plan`` in their order, each with all its blocks."""
    return tuple(
        Session(index, mounting.orientation, blocks(plan, mounting, index, limits))
        for index, mounting in enumerate(plan_mountings(plan), start=1)
    )
