"""The plan: every setting of a calibration, with the standard's values as default, read from TOML.

``load_plan`` refuses what cannot be run and says what to change; ``deviations`` names, for the record and the
certificate, each setting that leaves JJF 1536-2015 but can be run.

The settings are in :mod:`~ahrs_lab.procedures.plan_settings`, their file form in
:mod:`~ahrs_lab.procedures.plan_file`, what is refused or noted in :mod:`~ahrs_lab.procedures.plan_rules`.
"""

from ahrs_lab.procedures.plan_file import load_plan, plan_from_text, plan_from_toml, plan_to_toml, save_plan
from ahrs_lab.procedures.plan_rules import check_plan, default_rates, deviations
from ahrs_lab.procedures.plan_settings import (
    ImuPlan,
    ItemName,
    MisalignmentPlan,
    MountingOrder,
    Plan,
    PositionScheme,
    PowerPlan,
    ProcedureName,
    RateOrder,
    ScaleFactorPlan,
    Schedule,
    SettlingPlan,
    ZeroOffsetPlan,
)

__all__ = [
    "ImuPlan",
    "ItemName",
    "MisalignmentPlan",
    "MountingOrder",
    "Plan",
    "PositionScheme",
    "PowerPlan",
    "ProcedureName",
    "RateOrder",
    "ScaleFactorPlan",
    "Schedule",
    "SettlingPlan",
    "ZeroOffsetPlan",
    "check_plan",
    "default_rates",
    "deviations",
    "load_plan",
    "plan_from_text",
    "plan_from_toml",
    "plan_to_toml",
    "save_plan",
]
