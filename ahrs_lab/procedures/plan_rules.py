"""What a plan may not be, and what it may be only by leaving the standard.

A *refusal* (:func:`check_plan`) is a plan that its procedure does not know how to evaluate or that the bench
cannot run. A *deviation* (:func:`deviations`) can be run and evaluated; it is kept with the result and
printed.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence

from ahrs_lab.errors import InputError
from ahrs_lab.instruments.interfaces import TableLimits
from ahrs_lab.messages import Message
from ahrs_lab.metrology.plan_labels import PLAN_LABELS
from ahrs_lab.procedures.figures import figure
from ahrs_lab.procedures.imu_rules import check_imu, imu_remarks
from ahrs_lab.procedures.plan_settings import (
    STANDARD_DURATION_S,
    MisalignmentPlan,
    Plan,
    PowerPlan,
    SettlingPlan,
)

FEWEST_RATES, MOST_RATES = 7, 11
LEAST_DWELL_S = 20.0
LEAST_SAMPLE_RATE_HZ = 10.0
RECOMMENDED_POSITIONS = 12
"""Of the multi-position method, 30° apart (7.2.2)."""
RATE_RANGE_DPS = (0.001, 1000.0)
"""Clause 6.1: where the standard states the table's uncertainty."""
_MOST_RATE_DPS = 1e5
_LONGEST_S = 7 * 86400.0


def check_plan(
    plan: Plan,
    limits: TableLimits | None = None,
    device_range_dps: float | None = None,
    sample_rate_hz: float | None = None,
) -> None:
    """Raise InputError for the first setting that cannot be run.

    ``limits`` of the table, ``device_range_dps`` (±) and ``sample_rate_hz`` of the unit are checked where
    given.
    """
    _check_numbers(plan)
    if plan.procedure == "imu-discrete":
        check_imu(plan)
    else:
        _check_jjf1536(plan, sample_rate_hz)
    if limits is not None:
        _check_table(plan, limits)
    if device_range_dps is not None:
        _check_device(plan, device_range_dps)


def _check_jjf1536(plan: Plan, sample_rate_hz: float | None) -> None:
    _check_choice_lists(plan)
    if "scale_factor" in plan.items:
        _check_rates(plan.scale_factor.rates_dps)
        _at_least("scale_factor.dwell_s", plan.scale_factor.dwell_s, LEAST_DWELL_S)
        _at_least("scale_factor.static_s", plan.scale_factor.static_s, LEAST_DWELL_S)
    if "zero_offset" in plan.items:
        _at_least("zero_offset.duration_s", plan.zero_offset.duration_s, LEAST_DWELL_S)
        _check_positions(plan)
    if "misalignment" in plan.items:
        _check_turns(plan.misalignment)
    if sample_rate_hz is not None and sample_rate_hz < LEAST_SAMPLE_RATE_HZ:
        raise InputError(
            "The device gives {rate_hz} samples per second; zero offset and misalignment need at least "
            "{least}: set the device to a higher output rate.",
            rate_hz=figure(sample_rate_hz),
            least=figure(LEAST_SAMPLE_RATE_HZ),
        )


def _check_choice_lists(plan: Plan) -> None:
    for setting, chosen in (("items", plan.items), ("axes", plan.axes)):
        if not chosen:
            raise InputError("{setting} is empty: name at least one.", setting=setting)
        if len(set(chosen)) != len(chosen):
            raise InputError("{setting} names something twice: remove the repetition.", setting=setting)


def _check_numbers(plan: Plan) -> None:
    settling, power = plan.settling, plan.power
    positive = {
        "settling.position_tolerance_deg": settling.position_tolerance_deg,
        "settling.hold_s": settling.hold_s,
        "settling.timeout_s": settling.timeout_s,
        "settling.pointing_rate_dps": settling.pointing_rate_dps,
        "power.voltage_v": power.voltage_v,
        "power.current_limit_a": power.current_limit_a,
        "power.current_tolerance": power.current_tolerance,
        "power.current_hold_s": power.current_hold_s,
        "power.current_timeout_s": power.current_timeout_s,
        "mounting_tolerance_deg": plan.mounting_tolerance_deg,
        "mounting_check_s": plan.mounting_check_s,
    }
    for setting, value in positive.items():
        if not (math.isfinite(value) and value > 0.0):
            raise InputError(
                "{setting} is {value}: write a number above zero.", setting=setting, value=figure(value)
            )
    _within("mounting_tolerance_deg", plan.mounting_tolerance_deg, 0.0, 30.0)
    _within("mounting_check_s", plan.mounting_check_s, 0.5, 600.0)
    _within("repeats", plan.repeats, 1, 100)
    _within("settling.rate_tolerance_relative", settling.rate_tolerance_relative, 0.0, 0.1)
    _within("settling.rate_tolerance_dps", settling.rate_tolerance_dps, 0.0, 10.0)
    if settling.rate_tolerance_relative == 0.0 and settling.rate_tolerance_dps == 0.0:
        raise InputError(
            "Both rate tolerances are zero, so the table would never count as steady: set one of "
            "settling.rate_tolerance_dps and settling.rate_tolerance_relative above zero."
        )
    _within("power.voltage_v", power.voltage_v, 0.0, 30.0)
    _within("power.warm_up_s", power.warm_up_s, 0.0, 86400.0)
    for setting, hold, timeout in (
        ("settling.timeout_s", settling.hold_s, settling.timeout_s),
        ("power.current_timeout_s", power.current_hold_s, power.current_timeout_s),
    ):
        if timeout <= hold:
            raise InputError(
                "{setting} is {timeout} s, not longer than the {hold} s for which it has to be steady: "
                "make it longer.",
                setting=setting,
                timeout=figure(timeout),
                hold=figure(hold),
            )


def _within(setting: str, value: float, low: float, high: float) -> None:
    if not low <= value <= high:
        raise InputError(
            "{setting} is {value}: write a number from {low} to {high}.",
            setting=setting,
            value=figure(value),
            low=figure(low),
            high=figure(high),
        )


def _at_least(setting: str, value: float, least: float) -> None:
    if not least <= value <= _LONGEST_S:
        raise InputError(
            "{setting} is {value} s: the standard asks for at least {least} s; write {least} or more, up to "
            "a week.",
            setting=setting,
            value=figure(value),
            least=figure(least),
        )


def _check_rates(rates: Sequence[float]) -> None:
    if not FEWEST_RATES <= len(rates) <= MOST_RATES:
        raise InputError(
            "scale_factor.rates_dps has {count} rates: 7.1 asks for {fewest} to {most}; add or remove some.",
            count=len(rates),
            fewest=FEWEST_RATES,
            most=MOST_RATES,
        )
    for rate in rates:
        if rate == 0.0 or not math.isfinite(rate):
            raise InputError(
                "scale_factor.rates_dps contains {rate} °/s: rest is recorded before and after by itself; "
                "replace it by a rate.",
                rate=figure(rate),
            )
        if not RATE_RANGE_DPS[0] <= abs(rate) <= _MOST_RATE_DPS:
            raise InputError(
                "scale_factor.rates_dps contains {rate} °/s, which cannot be averaged over a whole angle in "
                "reasonable time or is beyond any table: use magnitudes from {least} °/s on.",
                rate=figure(rate),
                least=figure(RATE_RANGE_DPS[0]),
            )
        if list(rates).count(rate) > 1:
            raise InputError(
                "scale_factor.rates_dps contains {rate} °/s more than once: remove the repetition.",
                rate=figure(rate),
            )
    if min(rates) > 0.0 or max(rates) < 0.0:
        raise InputError(
            "scale_factor.rates_dps turns in one sense only: add rates of the other sign, best as ± pairs."
        )


def _check_positions(plan: Plan) -> None:
    if plan.zero_offset.schedule == "multi-position":
        _within("zero_offset.positions", plan.zero_offset.positions, 2, 360)


def _check_turns(plan: MisalignmentPlan) -> None:
    if plan.turns != int(plan.turns) or plan.turns < 1:
        raise InputError(
            "misalignment.turns is {turns}: write a whole number of turns from 1 on; both senses are always "
            "run.",
            turns=figure(plan.turns),
        )
    _within("misalignment.turns", plan.turns, 1, 10000)
    if not 0.1 <= plan.rate_dps <= _MOST_RATE_DPS:
        raise InputError(
            "misalignment.rate_dps is {rate} °/s: write the magnitude of a rate, 0.1 °/s or more; both "
            "senses are always run.",
            rate=figure(plan.rate_dps),
        )


def _rates_in_use(plan: Plan) -> list[tuple[str, float]]:
    used: list[tuple[str, float]] = []
    if plan.procedure == "imu-discrete":
        return [("imu.rate_dps", plan.imu.rate_dps)]
    if "scale_factor" in plan.items:
        used += [("scale_factor.rates_dps", rate) for rate in plan.scale_factor.rates_dps]
    if "misalignment" in plan.items:
        used.append(("misalignment.rate_dps", plan.misalignment.rate_dps))
    return used


def _check_table(plan: Plan, limits: TableLimits) -> None:
    for setting, rate in [
        *_rates_in_use(plan),
        ("settling.pointing_rate_dps", plan.settling.pointing_rate_dps),
    ]:
        if abs(rate) > limits.max_rate_dps:
            raise InputError(
                "{setting} asks for {rate} °/s; the table may turn at {limit} °/s at most: lower the rate.",
                setting=setting,
                rate=figure(rate),
                limit=figure(limits.max_rate_dps),
            )


def _check_device(plan: Plan, range_dps: float) -> None:
    for setting, rate in _rates_in_use(plan):
        if abs(rate) > range_dps:
            raise InputError(
                "{setting} asks for {rate} °/s; the device measures ±{range} °/s: lower the rate.",
                setting=setting,
                rate=figure(rate),
                range=figure(range_dps),
            )


def deviations(plan: Plan, device_range_dps: float | None = None) -> tuple[Message, ...]:
    """Each setting that leaves the plan's procedure and can be run, as a sentence for record and
    certificate."""
    found: list[Message] = []
    if plan.procedure == "imu-discrete":
        found += imu_remarks(plan)
        found += _settling(plan.settling, plan.mounting_tolerance_deg, plan.power)
        return tuple(found)
    found += _scope(plan)
    found += _settling(plan.settling, plan.mounting_tolerance_deg, plan.power)
    if "scale_factor" in plan.items:
        found += _scale_factor(plan, device_range_dps)
    if "zero_offset" in plan.items:
        found += _zero_offset(plan)
    if "misalignment" in plan.items:
        found += _misalignment(plan.misalignment)
    return tuple(found)


def _scope(plan: Plan) -> list[Message]:
    found = []
    missing_items = [m for name, m in _ITEM_NAMES.items() if name not in plan.items]
    for item in missing_items:
        found.append(Message("Not calibrated by this plan: {item}.", item=item))
    if len(plan.axes) < 3:
        axes = ", ".join(axis.upper() for axis in plan.axes)
        found.append(Message("Only these axes are calibrated by this plan: {axes}.", axes=axes))
    return found


_ITEM_NAMES = {
    "scale_factor": Message("scale factor"),
    "zero_offset": Message("zero offset"),
    "misalignment": Message("misalignment"),
}


def _scale_factor(plan: Plan, device_range_dps: float | None) -> list[Message]:
    found = []
    top = max(abs(rate) for rate in plan.scale_factor.rates_dps)
    if top > RATE_RANGE_DPS[1]:
        found.append(
            Message(
                "The rates go up to {rate} °/s; clause 6 states the table's uncertainty up to {limit} °/s "
                "only.",
                rate=figure(top),
                limit=figure(RATE_RANGE_DPS[1]),
            )
        )
    if device_range_dps is not None and top < 0.8 * device_range_dps:
        found.append(
            Message(
                "The rates go up to {rate} °/s and do not cover the device's range of ±{range} °/s.",
                rate=figure(top),
                range=figure(device_range_dps),
            )
        )
    if not plan.power.off_between_mountings:
        found.append(Message("Power stays on while the case is re-mounted; 7.1 has it switched off."))
    return found


def _zero_offset(plan: Plan) -> list[Message]:
    found = []
    zero_offset = plan.zero_offset
    if zero_offset.schedule == "combined":
        found.append(
            Message(
                "Zero offset by the combined schedule: one set of four positions for all three axes; 7.2.1 "
                "has four positions for each axis."
            )
        )
    if zero_offset.schedule == "multi-position" and zero_offset.positions != RECOMMENDED_POSITIONS:
        found.append(
            Message(
                "Zero offset by the multi-position method of 7.2.2 with {positions} positions; 7.2.2 "
                "recommends 12 at 30° and permits others in equal steps.",
                positions=zero_offset.positions,
            )
        )
    usual = STANDARD_DURATION_S[zero_offset.schedule]
    if zero_offset.duration_s != usual:
        found.append(
            Message(
                "Each zero-offset position is recorded for {duration} s instead of {usual} s "
                "(the note to 7.2 permits a time that fits the device).",
                duration=figure(zero_offset.duration_s),
                usual=figure(usual),
            )
        )
    return found


def _misalignment(plan: MisalignmentPlan) -> list[Message]:
    if plan == MisalignmentPlan():
        return []
    return [
        Message(
            "Misalignment with ±{turns} turns at {rate} °/s instead of ±10 turns at 100 °/s (permitted by "
            "the note to 7.3 where agreed).",
            turns=plan.turns,
            rate=figure(plan.rate_dps),
        )
    ]


def _settling(settling: SettlingPlan, mounting_tolerance_deg: float, power: PowerPlan) -> list[Message]:
    usual, usual_power = SettlingPlan(), PowerPlan()
    settings = (
        (
            "settling.rate_tolerance_relative",
            settling.rate_tolerance_relative,
            usual.rate_tolerance_relative,
        ),
        ("settling.rate_tolerance_dps", settling.rate_tolerance_dps, usual.rate_tolerance_dps),
        ("settling.position_tolerance_deg", settling.position_tolerance_deg, usual.position_tolerance_deg),
        ("mounting_tolerance_deg", mounting_tolerance_deg, Plan().mounting_tolerance_deg),
        ("power.current_tolerance", power.current_tolerance, usual_power.current_tolerance),
    )
    return [
        Message(
            "{setting} is {value}, wider than the usual {usual}.",
            setting=PLAN_LABELS[setting],
            value=figure(value),
            usual=figure(limit),
        )
        for setting, value, limit in settings
        if value > limit
    ]


def default_rates(range_dps: float, table_limit_dps: float = math.inf) -> tuple[float, ...]:
    """Ten rates, ± pairs over the range of a device (±``range_dps``) as far as the table turns, rounded to
    two digits; for ±300 °/s those of :class:`ScaleFactorPlan`: 1/30, 1/6, 1/3, 2/3 and all of it."""
    top = min(range_dps, table_limit_dps)
    if not (math.isfinite(top) and top >= 30 * RATE_RANGE_DPS[0]):
        raise InputError(
            "No rates can be proposed for a range of {range} °/s: state the device's range in °/s.",
            range=figure(top),
        )
    steps = [min(_two_digits(top * part, math.floor), top) for part in (1 / 30, 1 / 6, 1 / 3, 2 / 3, 1.0)]
    return (*(-rate for rate in reversed(steps)), *steps)


def _two_digits(value: float, rounding: Callable[[float], int]) -> float:
    unit = 10.0 ** (math.floor(math.log10(value)) - 1)
    return float(f"{rounding(value / unit + 1e-9) * unit:.12g}")
