"""Reading JSON that nobody vouches for: every value is checked, and a fault is named by its key."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from string import Formatter
from typing import Any

from ahrs_lab.errors import InputError
from ahrs_lab.messages import Message


class JsonReader:
    """One JSON object and the key under which it was found."""

    def __init__(self, data: object, path: str = "") -> None:
        if not isinstance(data, Mapping):
            raise _fault(path or "the result", Message("an object"), data)
        self.data: Mapping[str, Any] = data
        self.path = path

    def key(self, name: str) -> str:
        """The full name of a key, for messages."""
        return f"{self.path}.{name}" if self.path else name

    def has(self, name: str) -> bool:
        """Whether the key is there and not null."""
        return self.data.get(name) is not None

    def fault(self, name: str, wanted: Message) -> InputError:
        """What to raise where the value of a key is not what it has to be."""
        return _fault(self.key(name), wanted, self.data.get(name))

    def value(self, name: str) -> Any:
        """Anything, but there."""
        if name not in self.data:
            raise InputError(
                "The result lacks the key {key}: it was not written by ahrs-lab.", key=self.key(name)
            )
        return self.data[name]

    def number(self, name: str, default: float | None = None) -> float:
        """A finite number."""
        if default is not None and name not in self.data:
            return default
        return _number(self.value(name), self.key(name))

    def whole(self, name: str) -> int:
        """A whole number."""
        found = self.value(name)
        if isinstance(found, bool) or not isinstance(found, int):
            raise _fault(self.key(name), Message("a whole number"), found)
        return found

    def optional_number(self, name: str) -> float | None:
        """A finite number, or None where the key is absent or null."""
        return self.number(name) if self.has(name) else None

    def dof(self, name: str) -> float:
        """Degrees of freedom: null is infinite."""
        return math.inf if self.value(name) is None else self.number(name)

    def numbers(self, name: str, default: Iterable[float] | None = None) -> tuple[float, ...]:
        """A list of finite numbers."""
        if default is not None and name not in self.data:
            return tuple(default)
        return tuple(_number(entry, f"{self.key(name)}[{i}]") for i, entry in enumerate(self.items(name)))

    def text(self, name: str, default: str | None = None) -> str:
        """A string."""
        if default is not None and name not in self.data:
            return default
        found = self.value(name)
        if not isinstance(found, str):
            raise _fault(self.key(name), Message("a text"), found)
        return found

    def texts(self, name: str) -> tuple[str, ...]:
        """A list of strings; an absent key is an empty list."""
        found = self.items(name) if name in self.data else []
        for index, entry in enumerate(found):
            if not isinstance(entry, str):
                raise _fault(f"{self.key(name)}[{index}]", Message("a text"), entry)
        return tuple(found)

    def choice(self, name: str, allowed: Iterable[str], default: str | None = None) -> Any:
        """One of the strings ``allowed``."""
        found = self.text(name, default)
        if found not in tuple(allowed):
            raise _fault(self.key(name), Message("one of {allowed}", allowed=", ".join(allowed)), found)
        return found

    def items(self, name: str) -> list[Any]:
        """A list of anything."""
        found = self.value(name)
        if not isinstance(found, list):
            raise _fault(self.key(name), Message("a list"), found)
        return found

    def objects(self, name: str) -> tuple[JsonReader, ...]:
        """A list of objects; an absent key is an empty list."""
        found = self.items(name) if name in self.data else []
        return tuple(JsonReader(entry, f"{self.key(name)}[{index}]") for index, entry in enumerate(found))

    def object(self, name: str) -> JsonReader:
        """An object."""
        return JsonReader(self.value(name), self.key(name))

    def members(self, name: str, allowed: Iterable[str]) -> dict[str, JsonReader]:
        """The objects of an object whose keys are among ``allowed``, in the order of ``allowed``; empty if
        absent."""
        if not self.has(name):
            return {}
        inside = self.object(name)
        known = tuple(allowed)
        for key in inside.data:
            if key not in known:
                raise _fault(inside.path, Message("one of {allowed}", allowed=", ".join(known)), key)
        return {key: inside.object(key) for key in known if key in inside.data}


_MOST_LEVELS = 8
"""A sentence in a sentence in a sentence: ours stop at three."""


def message_from_json(data: object, key: str, level: int = 0) -> Message:
    """A :class:`Message` whose template can be filled with its values and does nothing else; InputError
    otherwise."""
    if isinstance(data, str):
        return Message(data)
    if level > _MOST_LEVELS:
        raise _fault(key, Message("a number or a text"), "{…}")
    reader = JsonReader(data, key)
    template = reader.text("template")
    params: dict[str, object] = {}
    for name, value in (reader.object("params").data if reader.has("params") else {}).items():
        if isinstance(value, Mapping):
            params[name] = message_from_json(value, f"{key}.params.{name}", level + 1)
        elif value is None or isinstance(value, (str, int, float, bool)):
            params[name] = value
        else:
            raise _fault(f"{key}.params.{name}", Message("a number or a text"), value)
    _check_template(template, params, key)
    return Message(template, **params)


def _check_template(template: str, params: Mapping[str, object], key: str) -> None:
    """Plain fields only: attributes, indices and format widths reach further than a sentence needs."""
    if not params:
        return  # shown as it is
    try:
        fields = [(name, spec, conversion) for _, name, spec, conversion in Formatter().parse(template)]
    except ValueError as error:
        raise _fault(key, Message("a sentence with fields in braces"), template) from error
    for name, spec, conversion in fields:
        if name is not None and (name not in params or spec or conversion):
            raise _fault(key, Message("a sentence with fields in braces"), template)


def _number(value: object, key: str) -> float:
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        raise _fault(key, Message("a number"), value)
    try:
        number = float(value)
    except OverflowError:
        number = math.inf
    if not math.isfinite(number):
        raise _fault(key, Message("a finite number"), value)
    return number


def _fault(key: str, wanted: Message, found: object) -> InputError:
    shown = str(found)
    return InputError(
        "In the result, {key} has to be {wanted}, not “{found}”.",
        key=key,
        wanted=wanted,
        found=shown if len(shown) <= 40 else shown[:40] + "…",
    )
