"""What the settings of a plan are called where a person reads them; a plan's file has the keys."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType

from ahrs_lab.messages import Message

_POWER = Message("Power")
_RATES = Message("Scale factor")
_OFFSET = Message("Zero offset")
_TURNS = Message("Misalignment")
_STEADY = Message("Steady table")
_IMU = Message("IMU")


def _of(group: Message, what: Message, unit: str = "") -> Message:
    if unit:
        return Message("{group}: {what} / {unit}", group=group, what=what, unit=unit)
    return Message("{group}: {what}", group=group, what=what)


def _alone(what: Message, unit: str) -> Message:
    return Message("{what} / {unit}", what=what, unit=unit)


PLAN_LABELS: Mapping[str, Message] = MappingProxyType(
    {
        "name": Message("Name of the plan"),
        "items": Message("Items"),
        "axes": Message("Axes"),
        "mounting_order": Message("Order of the mountings"),
        "mounting_tolerance_deg": _alone(Message("Tolerance of the mounting check"), "°"),
        "mounting_check_s": _alone(Message("Duration of the mounting check"), "s"),
        "repeats": Message("Repetitions"),
        "scale_factor.rates_dps": _of(_RATES, Message("rates"), "(°/s)"),
        "scale_factor.order": _of(_RATES, Message("order of the rates")),
        "scale_factor.dwell_s": _of(_RATES, Message("time at each rate"), "s"),
        "scale_factor.static_s": _of(_RATES, Message("time at rest before and after"), "s"),
        "zero_offset.schedule": _of(_OFFSET, Message("schedule")),
        "zero_offset.duration_s": _of(_OFFSET, Message("time at each position"), "s"),
        "zero_offset.positions": _of(_OFFSET, Message("positions (multi-position method)")),
        "misalignment.rate_dps": _of(_TURNS, Message("rate"), "(°/s)"),
        "misalignment.turns": _of(_TURNS, Message("turns in each sense")),
        "procedure": Message("Procedure"),
        "imu.rate_dps": _of(_IMU, Message("rate of the turns"), "(°/s)"),
        "imu.turns": _of(_IMU, Message("turns in each sense")),
        "imu.scheme": _of(_IMU, Message("scheme of positions")),
        "imu.positions": _of(_IMU, Message("positions of the own scheme")),
        "imu.dwell_s": _of(_IMU, Message("time at each position"), "s"),
        "settling.rate_tolerance_relative": _of(_STEADY, Message("relative tolerance of the rate")),
        "settling.rate_tolerance_dps": _of(_STEADY, Message("tolerance of the rate"), "(°/s)"),
        "settling.position_tolerance_deg": _of(_STEADY, Message("tolerance of the position"), "°"),
        "settling.hold_s": _of(_STEADY, Message("time within the tolerance"), "s"),
        "settling.timeout_s": _of(_STEADY, Message("longest wait"), "s"),
        "settling.pointing_rate_dps": _of(_STEADY, Message("rate between positions"), "(°/s)"),
        "power.voltage_v": _of(_POWER, Message("voltage"), "V"),
        "power.current_limit_a": _of(_POWER, Message("current limit"), "A"),
        "power.off_between_mountings": _of(_POWER, Message("off between mountings")),
        "power.current_tolerance": _of(_POWER, Message("relative tolerance of the current")),
        "power.current_hold_s": _of(_POWER, Message("time within the tolerance of the current"), "s"),
        "power.current_timeout_s": _of(_POWER, Message("longest wait for the current"), "s"),
        "power.warm_up_s": _of(_POWER, Message("warm-up"), "s"),
    }
)
"""By the dotted key."""

PLAN_VALUES: Mapping[str, Message] = MappingProxyType(
    {
        "True": Message("yes"),
        "False": Message("no"),
        "scale_factor": _RATES,
        "zero_offset": _OFFSET,
        "misalignment": _TURNS,
        "shortest": Message("shortest way"),
        "standard": Message("as the standard lists them"),
        "pairs": Message("± pairs"),
        "ascending": Message("ascending"),
        "as_listed": Message("as listed"),
        "combined": Message("combined"),
        "multi-position": Message("multi-position"),
        "jjf1536-2015": Message("JJF 1536-2015"),
        "imu-discrete": Message("discrete IMU calibration"),
        "own": Message("own list"),
    }
)
"""Values of settings that are words."""
