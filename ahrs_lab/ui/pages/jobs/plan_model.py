"""The plan as a form: the settings people change, as texts, on top of a whole plan. No Qt here.

What the form does not show stays as it is in the plan underneath (edited as TOML).
"""

from __future__ import annotations

import math
import tomllib
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Literal, cast, get_args

from ahrs_lab.errors import InputError
from ahrs_lab.instruments.interfaces import TableLimits
from ahrs_lab.messages import Message
from ahrs_lab.procedures.plan import (
    Plan,
    PositionScheme,
    ProcedureName,
    check_plan,
    deviations,
    plan_from_toml,
    plan_to_toml,
)

EntryName = Literal[
    "rates", "order", "dwell", "static", "schedule", "duration", "positions", "turn_rate", "turns", "repeats",
    "mounting_order", "power", "warm_up", "scheme", "own", "imu_dwell", "imu_rate", "imu_turns",
]  # fmt: skip
ENTRIES: tuple[EntryName, ...] = get_args(EntryName)
Fault = Literal["number", "whole", "list"]
"""A text that is no number, no whole number, no list of numbers."""

Entries = Mapping[EntryName, str]
ORDERS = ("pairs", "ascending", "as_listed")
SCHEDULES = ("standard", "combined", "multi-position")
MOUNTING_ORDERS = ("shortest", "standard")
POWERS = ("off", "on")
SCHEMES: tuple[PositionScheme, ...] = get_args(PositionScheme)
PROCEDURES: tuple[ProcedureName, ...] = get_args(ProcedureName)


@dataclass(frozen=True)
class PlanView:
    """What the form says of itself: faults and refusals at their entries, deviations of a plan that can be
    run as sentences.

    ``plan`` is None where an entry cannot be read; ``refusal`` is one that belongs to no entry of the form.
    """

    plan: Plan | None
    faults: Mapping[EntryName, Fault]
    refusals: Mapping[EntryName, Message]
    refusal: Message | None
    deviations: tuple[Message, ...]

    @property
    def runnable(self) -> bool:
        """Nothing stands against this plan."""
        return self.plan is not None and not self.refusals and self.refusal is None


def entries_of(plan: Plan) -> dict[EntryName, str]:
    """The form's texts of ``plan``."""
    return {
        "rates": ", ".join(_text(rate) for rate in plan.scale_factor.rates_dps),
        "order": plan.scale_factor.order,
        "dwell": _text(plan.scale_factor.dwell_s),
        "static": _text(plan.scale_factor.static_s),
        "schedule": plan.zero_offset.schedule,
        "duration": _text(plan.zero_offset.duration_s),
        "positions": str(plan.zero_offset.positions),
        "turn_rate": _text(plan.misalignment.rate_dps),
        "turns": str(plan.misalignment.turns),
        "repeats": str(plan.repeats),
        "mounting_order": plan.mounting_order,
        "power": "off" if plan.power.off_between_mountings else "on",
        "warm_up": _text(plan.power.warm_up_s),
        "scheme": plan.imu.scheme,
        "own": ", ".join(plan.imu.positions),
        "imu_dwell": _text(plan.imu.dwell_s),
        "imu_rate": _text(plan.imu.rate_dps),
        "imu_turns": str(plan.imu.turns),
    }


def default_plan(procedure: ProcedureName) -> Plan:
    """What a plan of this procedure begins with."""
    return plan_from_toml({"procedure": procedure})


def view(entries: Entries, base: Plan, limits: TableLimits | None = None) -> PlanView:
    """Read the form onto ``base`` and judge it against the standard and the table's ``limits``."""
    plan, faults = _read(entries, base)
    if plan is None:
        return PlanView(None, faults, {}, None, ())
    try:
        check_plan(plan, limits)
    except InputError as error:
        culprit = _culprit(entries, error, default_plan(base.procedure), limits)
        refusals = {culprit: error.message} if culprit is not None else {}
        return PlanView(plan, {}, refusals, None if culprit else error.message, ())
    return PlanView(plan, {}, {}, None, deviations(plan))


def plan_of_text(text: str) -> Plan:
    """A plan of its TOML; raises InputError."""
    try:
        data = tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        raise InputError("The plan is not valid TOML: {reason}.", reason=str(error)) from error
    return plan_from_toml(data)


def text_of_plan(plan: Plan) -> str:
    """All settings as TOML."""
    import tomli_w

    return tomli_w.dumps(plan_to_toml(plan))


def _culprit(
    entries: Entries, error: InputError, usual: Plan, limits: TableLimits | None
) -> EntryName | None:
    """The entry that alone, on the procedure's own plan, is refused in the same way."""
    for name in ENTRIES:
        changed = {**entries_of(usual), name: entries[name]}
        if name in ("duration", "positions"):
            changed["schedule"] = entries["schedule"]
        if name == "scheme" and entries["scheme"] == "own":
            continue  # the list is at fault, not that there is one
        if name == "own":
            changed["scheme"] = entries["scheme"]
        plan, _ = _read(changed, usual)
        if plan is None:
            continue
        try:
            check_plan(plan, limits)
        except InputError as other:
            if other.message.template == error.message.template:
                return name
    return None


def _read(entries: Entries, base: Plan) -> tuple[Plan | None, dict[EntryName, Fault]]:
    faults: dict[EntryName, Fault] = {}

    def number(name: EntryName) -> float:
        value = _number(entries[name])
        if value is None:
            faults[name] = "number"
            return 0.0
        return value

    def whole(name: EntryName) -> int:
        value = _number(entries[name])
        if value is None or value != int(value):
            faults[name] = "whole"
            return 0
        return int(value)

    rates = _rates(entries["rates"])
    if rates is None:
        faults["rates"] = "list"
    scale = replace(
        base.scale_factor,
        rates_dps=rates or (),
        order=cast('Literal["pairs", "ascending", "as_listed"]', entries["order"]),
        dwell_s=number("dwell"),
        static_s=number("static"),
    )
    zero = replace(
        base.zero_offset,
        schedule=cast('Literal["standard", "combined", "multi-position"]', entries["schedule"]),
        duration_s=number("duration"),
        positions=whole("positions"),
    )
    angle = replace(base.misalignment, rate_dps=number("turn_rate"), turns=whole("turns"))
    imu = replace(
        base.imu,
        scheme=cast(PositionScheme, entries["scheme"]),
        positions=_words(entries["own"]) if entries["scheme"] == "own" else (),
        dwell_s=number("imu_dwell"),
        rate_dps=number("imu_rate"),
        turns=whole("imu_turns"),
    )
    power = replace(base.power, off_between_mountings=entries["power"] == "off", warm_up_s=number("warm_up"))
    plan = replace(
        base,
        scale_factor=scale,
        zero_offset=zero,
        misalignment=angle,
        imu=imu,
        power=power,
        repeats=whole("repeats"),
        mounting_order=cast('Literal["shortest", "standard"]', entries["mounting_order"]),
    )
    return (None, faults) if faults else (plan, faults)


def _words(text: str) -> tuple[str, ...]:
    parts = text.replace(";", ",").replace("，", ",").replace("；", ",").split(",")
    return tuple(part.strip() for part in parts if part.strip())


def _rates(text: str) -> tuple[float, ...] | None:
    values = [_number(part) for part in _words(text)]
    if not values or any(value is None for value in values):
        return None
    return tuple(value for value in values if value is not None)


def _number(text: str) -> float | None:
    cleaned = text.strip().replace("\u2212", "-").replace("\u2009", "").replace(" ", "")
    try:
        value = float(cleaned)
    except ValueError:
        return None
    return value if math.isfinite(value) else None


def _text(value: float) -> str:
    return f"{value:.10g}"
