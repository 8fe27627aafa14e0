"""What an analysis is to those who start it: the command line and the Analysis page start the same thing."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Literal, Protocol

from ahrs_lab.analysis.report import Report
from ahrs_lab.messages import Message

Value = str | float | bool


@dataclass(frozen=True)
class Setting:
    """One choice of the person. ``kind`` "number" takes ``unit``, ``low``, ``high``; "choice" takes
    ``choices`` (key, what the person reads); "text" is free (a list of averaging times, a file inside the
    recording); "file" is a path to choose."""

    key: str
    label: Message
    kind: Literal["number", "choice", "flag", "text", "file"]
    default: Value
    unit: str = ""
    low: float | None = None
    high: float | None = None
    choices: tuple[tuple[str, Message], ...] = ()
    hint: Message | None = None
    blank: float | None = None
    """The number for which a field stays empty: it stands for “not stated”."""


@dataclass(frozen=True)
class Outcome:
    """``data`` is the JSON object of ``interfaces``; ``series`` are columns for a CSV file (name with unit →
    values of equal length); ``saves`` write further files, named as the person would name them."""

    data: dict[str, Any]
    report: Report
    series: Mapping[str, Any] = field(default_factory=dict)
    saves: Mapping[str, Callable[[Path], None]] = field(default_factory=dict)


class Run(Protocol):
    """Does the work; called in a thread that is not the screen's. Raises InputError, MachineError."""

    def __call__(self, bundles: Sequence[Path], settings: Mapping[str, Value]) -> Outcome: ...


@dataclass(frozen=True)
class AnalysisKind:
    """``inputs`` names the recordings it takes, in their order (none for a pure computation such as the
    propagation of an error); ``explains`` says in a sentence or two what it does and what it needs.

    ``live``: fast enough to be done again while a setting is changed, so that the screen follows the settings
    instead of waiting to be told."""

    key: str
    name: Message
    explains: Message
    inputs: tuple[Message, ...]
    settings: tuple[Setting, ...]
    run: Run
    live: bool = False

    def defaults(self) -> dict[str, Value]:
        """Each setting's default."""
        return {setting.key: setting.default for setting in self.settings}
