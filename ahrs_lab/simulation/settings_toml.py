"""From TOML tables to frozen settings: known keys and right types only, said with the key's full name."""

from __future__ import annotations

import difflib
import types
from collections.abc import Mapping
from dataclasses import fields, is_dataclass, replace
from typing import Any, Literal, Union, get_args, get_origin, get_type_hints

from ahrs_lab.errors import InputError
from ahrs_lab.messages import Message


def from_table(base: Any, table: Mapping[str, Any], where: str = "") -> Any:
    """``base`` (an instance of a settings dataclass) with the keys of ``table`` replaced, tables within
    tables too."""
    hints = _hints(type(base))
    names = [field.name for field in fields(base)]
    values: dict[str, Any] = {}
    for key, value in table.items():
        if key not in names:
            raise _unknown(where + key, key, names)
        values[key] = _convert(hints[key], value, where + key, getattr(base, key))
    return replace(base, **values)


def _hints(cls: type) -> dict[str, Any]:
    return get_type_hints(cls)


def _unknown(path: str, key: str, names: list[str]) -> InputError:
    close = difflib.get_close_matches(key, names, 1)
    if close:
        return InputError(
            "“{path}” is not a setting of the virtual bench; did you mean “{close}”?",
            path=path,
            close=close[0],
        )
    return InputError(
        "“{path}” is not a setting of the virtual bench; known here are: {known}.",
        path=path,
        known=", ".join(names),
    )


def _convert(hint: Any, value: Any, path: str, present: Any) -> Any:
    """``value`` as ``hint``; ``present`` is what a table starts from."""
    origin = get_origin(hint)
    if origin in (Union, types.UnionType):
        return _convert(next(part for part in get_args(hint) if part is not type(None)), value, path, present)
    if origin is Literal:
        return _choice(get_args(hint), value, path)
    if origin is tuple:
        return _sequence(get_args(hint), value, path)
    if is_dataclass(hint):
        if not isinstance(value, Mapping):
            raise _wrong_type(path, Message("a table"), value)
        if present is None:
            return _new(hint, value, path)
        return from_table(present, value, path + ".")
    if hint is float and isinstance(value, (int, float)) and not isinstance(value, bool):
        return _finite(float(value), path)
    if isinstance(value, hint) and not (hint is int and isinstance(value, bool)):
        return value
    raise _wrong_type(path, _EXPECTED[hint], value)


_EXPECTED = {
    float: Message("a number"),
    int: Message("a whole number"),
    bool: Message("true or false"),
    str: Message("text"),
}


def _finite(value: float, path: str) -> float:
    if value - value != 0.0:
        raise _wrong_type(path, Message("a finite number"), value)
    return value


def _choice(choices: tuple[Any, ...], value: Any, path: str) -> Any:
    if value not in choices:
        raise InputError(
            "Setting “{path}” of the virtual bench is “{value}”; it has to be one of {choices}.",
            path=path,
            value=value,
            choices=", ".join(str(choice) for choice in choices),
        )
    return value


def _sequence(items: tuple[Any, ...], value: Any, path: str) -> tuple[Any, ...]:
    if not isinstance(value, (list, tuple)):
        raise _wrong_type(path, Message("a list"), value)
    if items[-1] is Ellipsis:
        return tuple(_convert(items[0], item, f"{path}[{i}]", None) for i, item in enumerate(value))
    if len(value) != len(items):
        raise InputError(
            "Setting “{path}” of the virtual bench has {count} entries; it needs {needed}.",
            path=path,
            count=len(value),
            needed=len(items),
        )
    return tuple(
        _convert(hint, item, f"{path}[{i}]", None)
        for i, (hint, item) in enumerate(zip(items, value, strict=True))
    )


def _new(cls: Any, table: Mapping[str, Any], path: str) -> Any:
    """An entry of a list of tables, which starts from nothing."""
    hints, names = _hints(cls), [field.name for field in fields(cls)]
    for key in table:
        if key not in names:
            raise _unknown(f"{path}.{key}", key, names)
    values = {key: _convert(hints[key], value, f"{path}.{key}", None) for key, value in table.items()}
    if "name" in names and "name" not in values:
        raise InputError("Entry “{path}” of the bench file has no name.", path=path)
    return cls(**values)


def _wrong_type(path: str, expected: Message, value: Any) -> InputError:
    return InputError(
        "Setting “{path}” of the virtual bench has to be {expected}, not “{value}”.",
        path=path,
        expected=expected,
        value=value,
    )
