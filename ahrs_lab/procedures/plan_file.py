"""Plans as TOML files: read strictly, so that a misspelt setting is never silently the default."""

from __future__ import annotations

import math
import tomllib
from collections.abc import Mapping
from dataclasses import asdict, fields, is_dataclass
from difflib import get_close_matches
from pathlib import Path
from typing import Any, Literal, cast, get_args, get_origin, get_type_hints

from ahrs_lab.errors import InputError, MachineError
from ahrs_lab.messages import Message
from ahrs_lab.procedures.plan_rules import check_plan
from ahrs_lab.procedures.plan_settings import IMU_NAME, STANDARD_DURATION_S, Plan, ProcedureName
from ahrs_lab.recording.toml_table import parse_toml

_LARGEST_FILE = 1_000_000
_FOREIGN: Mapping[ProcedureName, tuple[str, ...]] = {
    "jjf1536-2015": ("procedure", "imu"),
    "imu-discrete": ("items", "axes", "scale_factor", "zero_offset", "misalignment"),
}
"""Settings that mean nothing to a procedure."""


def plan_from_text(text: str, source: str) -> Plan:
    """A checked plan from TOML text; ``source`` names it in what InputError says."""
    try:
        return plan_from_toml(parse_toml(text))
    except tomllib.TOMLDecodeError as error:
        raise InputError(
            "The plan {file} is not valid TOML: {reason}.", file=source, reason=str(error)
        ) from error
    except InputError as error:
        raise InputError("Plan {file}: {problem}", file=source, problem=error.message) from error


def load_plan(path: Path) -> Plan:
    """Read and check a plan; raises InputError that names the file, the setting and what to change."""
    try:
        with path.open("rb") as opened:
            data = opened.read(_LARGEST_FILE + 1)
        text = data.decode("utf-8-sig")
    except FileNotFoundError as error:
        raise InputError("The plan {file} does not exist: check its path.", file=str(path)) from error
    except UnicodeDecodeError as error:
        raise InputError(
            "The plan {file} is not a text in UTF-8: save it as such.", file=str(path)
        ) from error
    except OSError as error:
        raise MachineError(
            "The plan {file} cannot be read ({reason}): check its permissions.",
            file=str(path),
            reason=error.strerror or str(error),
        ) from error
    if len(data) > _LARGEST_FILE:
        raise InputError("The plan {file} is too large for a plan: check its path.", file=str(path))
    return plan_from_text(text, str(path))


def save_plan(plan: Plan, path: Path) -> None:
    """Write every setting of ``plan``; raises MachineError where the file cannot be written."""
    import tomli_w

    try:
        path.write_text(tomli_w.dumps(plan_to_toml(plan)), encoding="utf-8")
    except OSError as error:
        raise MachineError(
            "The plan {file} cannot be written ({reason}): choose another folder.",
            file=str(path),
            reason=error.strerror or str(error),
        ) from error


def plan_from_toml(data: Mapping[str, Any]) -> Plan:
    """A checked plan from TOML tables; settings left out have the standard's values."""
    zero_offset = data.get("zero_offset")
    if isinstance(zero_offset, Mapping) and "duration_s" not in zero_offset:
        schedule = zero_offset.get("schedule")
        if schedule == "multi-position":
            filled = {**zero_offset, "duration_s": STANDARD_DURATION_S["multi-position"]}
            data = {**data, "zero_offset": filled}
    if data.get("procedure") == "imu-discrete":
        data = _filled_for_an_imu(data)
    plan = cast(Plan, _table(Plan, data, ""))
    check_plan(plan)
    return plan


def _filled_for_an_imu(data: Mapping[str, Any]) -> Mapping[str, Any]:
    """Where the plan leaves it out: power stays on, as the set is of one power-on, whose constant drift the
    positions of all mountings share."""
    for key in _FOREIGN["imu-discrete"]:
        if key in data:
            raise InputError(
                "{setting} means nothing to the procedure {procedure}: remove it.",
                setting=key,
                procedure="imu-discrete",
            )
    power = data.get("power", {})
    if isinstance(power, Mapping):
        power = {"off_between_mountings": False, **power}
    return {"name": IMU_NAME, **data, "power": power}


def plan_to_toml(plan: Plan) -> dict[str, Any]:
    """Every setting of the plan's procedure, as TOML (and JSON) can hold it; ``plan_from_toml`` gives it
    back.

    JJF 1536 is not named, being what a plan without a name is: a recording that was begun before there was a
    choice is gone on with.
    """
    plain: dict[str, Any] = _plain(asdict(plan))
    return {key: value for key, value in plain.items() if key not in _FOREIGN[plan.procedure]}


def _plain(value: Any) -> Any:
    if isinstance(value, dict):
        return {key: _plain(item) for key, item in value.items()}
    if isinstance(value, (list, tuple)):
        return [_plain(item) for item in value]
    return value


def _table(kind: type, data: Any, where: str) -> Any:
    if not isinstance(data, Mapping):
        raise InputError(
            "{setting} is {value}: make it a table, written [{setting}].", setting=where, value=repr(data)
        )
    hints = get_type_hints(kind)
    known = {item.name for item in fields(kind)}
    for key in data:
        if key not in known:
            _refuse_unknown(str(key), where, sorted(known))
    return kind(**{key: _value(hints[key], data[key], f"{where}.{key}".lstrip(".")) for key in data})


def _refuse_unknown(key: str, where: str, known: list[str]) -> None:
    name = f"{where}.{key}".lstrip(".")
    close = get_close_matches(key, known, n=1)
    if close:
        raise InputError(
            "There is no setting {setting}: did you mean {suggestion}?", setting=name, suggestion=close[0]
        )
    raise InputError(
        "There is no setting {setting}: remove it, or use one of {known}.",
        setting=name,
        known=", ".join(known),
    )


def _value(hint: Any, value: Any, where: str) -> Any:
    if is_dataclass(hint):
        return _table(cast(type, hint), value, where)
    if get_origin(hint) is tuple:
        return _list(get_args(hint)[0], value, where)
    if get_origin(hint) is Literal:
        return _choice(get_args(hint), value, where)
    if hint is bool:
        return value if isinstance(value, bool) else _refuse_type(where, value, Message("true or false"))
    if hint is int:
        return _whole(value, where)
    if hint is float:
        return _number(value, where)
    return value if isinstance(value, str) else _refuse_type(where, value, Message("a text in quotes"))


def _list(hint: Any, value: Any, where: str) -> tuple[Any, ...]:
    if not isinstance(value, (list, tuple)):
        _refuse_type(where, value, Message("a list in brackets"))
    return tuple(_value(hint, item, f"{where}[{index}]") for index, item in enumerate(value))


def _choice(choices: tuple[str, ...], value: Any, where: str) -> str:
    if isinstance(value, str) and value in choices:
        return value
    raise InputError(
        "{setting} is {value}: write one of {choices}.",
        setting=where,
        value=repr(value),
        choices=", ".join(choices),
    )


def _number(value: Any, where: str) -> float:
    if isinstance(value, bool) or not isinstance(value, (int, float)) or not math.isfinite(value):
        _refuse_type(where, value, Message("a finite number"))
    return float(value)


def _whole(value: Any, where: str) -> int:
    if isinstance(value, bool) or not isinstance(value, (int, float)) or not math.isfinite(value):
        _refuse_type(where, value, Message("a whole number"))
    if value != int(value):
        raise InputError(
            "{setting} is {value}, which is not whole: write a whole number, for example {example}.",
            setting=where,
            value=value,
            example=max(1, round(value)),
        )
    return int(value)


def _refuse_type(where: str, value: Any, wanted: Message) -> Any:
    raise InputError("{setting} is {value}: write {wanted}.", setting=where, value=repr(value), wanted=wanted)
