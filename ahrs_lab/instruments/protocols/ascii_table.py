"""A rate table's short ASCII language, described in a TOML file.

Most tables in the field have one and no public manual. Texts hold ``{rate}`` and ``{angle}`` with a format
(``{rate:.4f}``, ``{angle:+09.3f}``); an answer to the query is read by a regular expression with the groups
``angle`` and, where the table tells them, ``rate`` and ``fault``.
"""

from __future__ import annotations

import math
import re
import string
from dataclasses import dataclass, field

from ahrs_lab.errors import InputError
from ahrs_lab.instruments.settings import within

PLACEHOLDERS = ("rate", "angle")


@dataclass(frozen=True)
class AsciiCommands:
    """What is said for what. ``identify`` and ``query`` ask; all others are lists said one by one, the last
    of ``position`` starts the motion."""

    query: str
    connect: tuple[str, ...] = ()
    identify: str = ""
    enable: tuple[str, ...] = ()
    rate: tuple[str, ...] = ()
    position: tuple[str, ...] = ()
    stop: tuple[str, ...] = ()
    off: tuple[str, ...] = ()
    keep_alive: str = ""


@dataclass(frozen=True)
class AsciiReplies:
    """How answers look. ``acknowledgement``: regular expression of a good answer to a command; empty where
    commands are not answered. ``no_fault``: of the group ``fault`` when all is well."""

    query: str
    acknowledgement: str = ""
    no_fault: str = "^0*$"


@dataclass(frozen=True)
class AsciiUnits:
    """How many degrees, and °/s, the table's unit is; negative where its sense is clockwise."""

    angle_deg: float = 1.0
    rate_dps: float = 1.0

    def __post_init__(self) -> None:
        for key, value in (("angle_deg", self.angle_deg), ("rate_dps", self.rate_dps)):
            if value == 0.0:
                raise InputError("Setting “units.{key}” is 0; a unit has a size.", key=key)


@dataclass(frozen=True)
class AsciiTiming:
    """``pause_s`` between two commands, ``keep_alive_s`` between two ``keep_alive`` texts."""

    pause_s: float = 0.1
    reply_timeout_s: float = 0.4
    keep_alive_s: float = 10.0

    def __post_init__(self) -> None:
        within("timing.pause_s", self.pause_s, 0.0, 10.0)
        within("timing.reply_timeout_s", self.reply_timeout_s, 0.01, 10.0)
        within("timing.keep_alive_s", self.keep_alive_s, 0.1, 600.0)


@dataclass(frozen=True)
class AsciiTemplate:
    """One table's language. ``wraps``: the reported angle wraps and a position is reached on the shortest
    path."""

    name: str
    commands: AsciiCommands
    replies: AsciiReplies
    terminator: str = "\r\n"
    reply_terminator: str = "\r\n"
    wraps: bool = True
    units: AsciiUnits = field(default_factory=AsciiUnits)
    timing: AsciiTiming = field(default_factory=AsciiTiming)

    def __post_init__(self) -> None:
        if not self.terminator or not self.reply_terminator:
            raise InputError("A table's language needs “terminator” and “reply_terminator”.")
        for key, texts in self._texts().items():
            for text in texts:
                _check_text(f"commands.{key}", text)
        for key in ("enable", "rate", "position", "stop"):
            if not getattr(self.commands, key):
                raise InputError("The table's language does not say what to send for “{key}”.", key=key)
        for key in ("query", "acknowledgement", "no_fault"):
            _check_expression(f"replies.{key}", getattr(self.replies, key))
        if "angle" not in re.compile(self.replies.query).groupindex:
            raise InputError("“replies.query” needs a group (?P<angle>…): the table's angle is read from it.")

    def _texts(self) -> dict[str, tuple[str, ...]]:
        return {
            key: value if isinstance(value, tuple) else (value,) for key, value in vars(self.commands).items()
        }

    def names(self) -> tuple[str, ...]:
        """The commands that have a text."""
        return tuple(key for key, texts in self._texts().items() if any(texts))

    def render(self, name: str, *, rate_dps: float = 0.0, angle_deg: float = 0.0) -> tuple[str, ...]:
        """The texts of a command with the numbers in the table's units."""
        rate, angle = rate_dps / self.units.rate_dps, angle_deg / self.units.angle_deg
        if name == "position":
            rate = abs(rate)  # the speed of a move has no sense
        # + 0.0: no table likes −0
        return tuple(text.format(rate=rate + 0.0, angle=angle + 0.0) for text in self._texts()[name] if text)

    def encode(self, text: str) -> bytes:
        """The bytes of a text."""
        return (text + self.terminator).encode("ascii", errors="replace")

    def parse(self, line: str) -> AsciiReading | None:
        """What an answer to the query says; None where it does not fit."""
        match = re.search(self.replies.query, line)
        if match is None:
            return None
        groups = match.groupdict()
        angle, rate = _number(groups.get("angle")), _number(groups.get("rate"))
        if angle is None:
            return None
        fault = groups.get("fault") or ""
        if re.search(self.replies.no_fault, fault):
            fault = ""
        return AsciiReading(
            angle * self.units.angle_deg, None if rate is None else rate * self.units.rate_dps, fault
        )

    def acknowledges(self, line: str) -> bool:
        """Whether an answer to a command is a good one."""
        return re.search(self.replies.acknowledgement, line) is not None


@dataclass(frozen=True)
class AsciiReading:
    """An answer to the query in our units."""

    angle_deg: float
    rate_dps: float | None
    fault: str


def _number(text: str | None) -> float | None:
    try:
        value = float(text) if text else math.nan
    except ValueError:
        return None
    return value if math.isfinite(value) else None


def _check_text(path: str, text: str) -> None:
    """Placeholders with a plain format only: ``{rate.real}`` and the like are refused."""
    try:
        for _, name, _, conversion in string.Formatter().parse(text):
            if name is not None and (name not in PLACEHOLDERS or conversion):
                raise InputError(
                    "“{path}” holds {{{name}}}; only {{rate}} and {{angle}} are known.", path=path, name=name
                )
        text.format(rate=-1.5, angle=-1.5)
    except (ValueError, KeyError, IndexError, AttributeError, TypeError) as error:
        raise InputError(
            "“{path}” = “{text}” cannot be filled in ({reason}); write numbers like {{rate:.4f}}.",
            path=path,
            text=text,
            reason=str(error),
        ) from error


def _check_expression(path: str, expression: str) -> None:
    try:
        re.compile(expression)
    except re.error as error:
        raise InputError(
            "“{path}” is no regular expression ({reason}).", path=path, reason=str(error)
        ) from error
