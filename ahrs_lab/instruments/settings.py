"""Typed settings of instruments: TOML tables become frozen dataclasses, with messages that name the key.

A driver's settings are a frozen dataclass whose fields all have defaults where a default makes sense. Known
keys and right types only; a misspelt key is answered with the one that was probably meant.
"""

from __future__ import annotations

import difflib
import math
import types
from collections.abc import Mapping
from dataclasses import MISSING, Field, dataclass, fields, is_dataclass
from typing import Any, Literal, TypeVar, Union, cast, get_args, get_origin, get_type_hints

from ahrs_lab.errors import InputError
from ahrs_lab.messages import Message

_T = TypeVar("_T")


@dataclass(frozen=True)
class Difference:
    """A setting that an instrument reads back otherwise than it was set."""

    setting: str
    wanted: str
    found: str

    @property
    def message(self) -> Message:
        """What a person reads."""
        return Message(
            "{setting} was set to {wanted}, but the instrument says {found}.",
            setting=self.setting,
            wanted=self.wanted,
            found=self.found,
        )


def settings_from_toml(cls: type[_T], table: Mapping[str, Any], where: str = "") -> _T:
    """An instance of the settings dataclass ``cls`` from a TOML table; ``where`` is the table's name in
    messages ("table", "supply.link"). Raises InputError for what is unknown, missing or of a wrong type."""
    prefix = f"{where}." if where else ""
    hints = get_type_hints(cls)
    known = {field.name: field for field in fields(cast(Any, cls))}
    values: dict[str, Any] = {}
    for key, value in table.items():
        if key not in known:
            raise _unknown(prefix + key, key, list(known))
        values[key] = _convert(hints[key], value, prefix + key)
    for key, field in known.items():
        if key not in values and _has_no_default(field):
            raise InputError("Setting “{path}” is missing: it has no default.", path=prefix + key)
    return cls(**values)


def settings_to_toml(settings: object) -> dict[str, Any]:
    """The inverse. Keys that are None or infinite, which only a default can be, are left out."""
    table: dict[str, Any] = {}
    for field in fields(cast(Any, settings)):
        value = getattr(settings, field.name)
        if value is not None and not (isinstance(value, float) and math.isinf(value)):
            table[field.name] = _plain(value)
    return table


def within(path: str, value: float, low: float, high: float) -> None:
    """Raises InputError where ``value`` lies outside ``low`` … ``high`` or is not a number."""
    if not low <= value <= high:
        raise InputError(
            "Setting “{path}” is {value}; it has to lie between {low} and {high}.",
            path=path,
            value=value,
            low=low,
            high=high,
        )


def _has_no_default(field: Field[Any]) -> bool:
    return field.default is MISSING and field.default_factory is MISSING


def _plain(value: Any) -> Any:
    if is_dataclass(value) and not isinstance(value, type):
        return settings_to_toml(value)
    if isinstance(value, (tuple, list)):
        return [_plain(item) for item in value]
    if isinstance(value, Mapping):
        return {key: _plain(item) for key, item in value.items()}
    return value


def _unknown(path: str, key: str, names: list[str]) -> InputError:
    close = difflib.get_close_matches(key, names, 1)
    if close:
        return InputError("“{path}” is not a setting; did you mean “{close}”?", path=path, close=close[0])
    return InputError(
        "“{path}” is not a setting; known here are: {known}.", path=path, known=", ".join(names)
    )


def _convert(hint: Any, value: Any, path: str) -> Any:
    origin = get_origin(hint)
    if origin in (Union, types.UnionType):
        return _convert(next(part for part in get_args(hint) if part is not type(None)), value, path)
    if origin is Literal:
        return _choice(get_args(hint), value, path)
    if origin is tuple:
        return _sequence(get_args(hint), value, path)
    if origin is dict:
        return _mapping(get_args(hint)[1], value, path)
    if is_dataclass(hint):
        if not isinstance(value, Mapping):
            raise _wrong_type(path, Message("a table"), value)
        return settings_from_toml(cast(type[object], hint), value, path)
    if hint is float and isinstance(value, (int, float)) and not isinstance(value, bool):
        if value - value != 0.0:
            raise _wrong_type(path, Message("a finite number"), value)
        return float(value)
    if isinstance(value, hint) and not (hint is int and isinstance(value, bool)):
        return value
    raise _wrong_type(path, _EXPECTED[hint], value)


_EXPECTED = {
    float: Message("a number"),
    int: Message("a whole number"),
    bool: Message("true or false"),
    str: Message("text"),
}


def _choice(choices: tuple[Any, ...], value: Any, path: str) -> Any:
    if value not in choices:
        raise InputError(
            "Setting “{path}” is “{value}”; it has to be one of {choices}.",
            path=path,
            value=value,
            choices=", ".join(str(choice) for choice in choices),
        )
    return value


def _sequence(items: tuple[Any, ...], value: Any, path: str) -> tuple[Any, ...]:
    """Lists of one kind of entry, ``tuple[X, ...]``."""
    if not isinstance(value, (list, tuple)):
        raise _wrong_type(path, Message("a list"), value)
    return tuple(_convert(items[0], item, f"{path}[{i}]") for i, item in enumerate(value))


def _mapping(hint: Any, value: Any, path: str) -> dict[str, Any]:
    if not isinstance(value, Mapping):
        raise _wrong_type(path, Message("a table"), value)
    return {str(key): _convert(hint, item, f"{path}.{key}") for key, item in value.items()}


def _wrong_type(path: str, expected: Message, value: Any) -> InputError:
    return InputError(
        "Setting “{path}” has to be {expected}, not “{value}”.", path=path, expected=expected, value=value
    )
