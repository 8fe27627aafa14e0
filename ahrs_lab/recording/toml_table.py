"""Reading TOML that nobody vouches for: whole texts, and tables key by key, where every complaint says file,
table, key and what to write instead."""

from __future__ import annotations

import math
import tomllib
from collections.abc import Mapping, Sequence
from typing import Any

from ahrs_lab.errors import InputError
from ahrs_lab.messages import Message

_KINDS = {
    "str": Message("text in quotation marks"),
    "float": Message("a finite number"),
    "int": Message("a whole number"),
    "bool": Message("true or false"),
}


_MOST_LEVELS = 64


def parse_toml(text: str) -> dict[str, Any]:
    """The document of ``text``; raises only :class:`tomllib.TOMLDecodeError`.

    Also for what Python's own reader lets through or stumbles over: whole numbers beyond the 64 bits of TOML,
    and nesting so deep that nobody can walk it.
    """
    try:
        document = tomllib.loads(text)
    except tomllib.TOMLDecodeError:
        raise
    except RecursionError as error:
        raise tomllib.TOMLDecodeError("tables or lists are nested too deeply") from error
    except ValueError as error:  # more digits than Python turns into a number
        raise tomllib.TOMLDecodeError("a whole number has more than 64 bits") from error
    left: list[tuple[object, int]] = [(document, 0)]
    while left:
        value, level = left.pop()
        if level > _MOST_LEVELS:
            raise tomllib.TOMLDecodeError("tables or lists are nested too deeply")
        if isinstance(value, dict):
            left.extend((entry, level + 1) for entry in value.values())
        elif isinstance(value, list):
            left.extend((entry, level + 1) for entry in value)
        elif isinstance(value, int) and not -(2**63) <= value < 2**63:
            raise tomllib.TOMLDecodeError("a whole number has more than 64 bits")
    return document


class TomlTable:
    """One table, read key by key. ``where`` names the file and ``what`` the table in every complaint."""

    def __init__(self, entries: Mapping[str, Any], where: str, what: str) -> None:
        self.entries = entries
        self.where = f"{where}, {what}" if what else where
        self.file = where

    def fault(self, what: Message) -> InputError:
        return InputError("{where}: {what}", where=self.where, what=what)

    def missing(self, key: str) -> InputError:
        return self.fault(Message("“{key}” is missing.", key=key))

    def wrong(self, key: str, kind: str) -> InputError:
        return self.fault(
            Message(
                "“{key}” is {value}: write {kind}.", key=key, value=repr(self.entries[key]), kind=_KINDS[kind]
            )
        )

    def table(self, key: str) -> TomlTable:
        if key not in self.entries:
            raise self.fault(Message("the table [{key}] is missing.", key=key))
        if not isinstance(self.entries[key], dict):
            raise self.fault(
                Message("“{key}” has to be a table: write [{key}] on a line of its own.", key=key)
            )
        return TomlTable(self.entries[key], self.file, f"[{key}]")

    def text(self, key: str, default: str | None = None) -> str:
        value = self.entries.get(key, default)
        if value is None:
            raise self.missing(key)
        if not isinstance(value, str):
            raise self.wrong(key, "str")
        return value

    def number(
        self, key: str, default: float | None, low: float = -math.inf, high: float = math.inf
    ) -> float:
        value = self.entries.get(key, default)
        if value is None:
            raise self.missing(key)
        if isinstance(value, bool) or not isinstance(value, (int, float)) or not math.isfinite(value):
            raise self.wrong(key, "float")
        if not low <= value <= high:
            raise self.fault(
                Message(
                    "“{key}” is {value}: it has to lie between {low} and {high}.",
                    key=key,
                    value=value,
                    low=low,
                    high=high,
                )
            )
        return float(value)

    def whole(self, key: str, *, required: bool) -> int | None:
        value = self.entries.get(key)
        if value is None:
            if required:
                raise self.missing(key)
            return None
        if isinstance(value, float) and value.is_integer():
            return int(value)
        if isinstance(value, bool) or not isinstance(value, int):
            raise self.wrong(key, "int")
        return value

    def flag(self, key: str) -> bool:
        value = self.entries.get(key, False)
        if not isinstance(value, bool):
            raise self.wrong(key, "bool")
        return value

    def choice(self, key: str, allowed: Sequence[str], default: str | None = None) -> Any:
        value = self.text(key, default)
        if value not in allowed:
            raise self.fault(
                Message(
                    "“{key}” is “{value}”: write one of {allowed}.",
                    key=key,
                    value=value,
                    allowed=", ".join(allowed),
                )
            )
        return value
