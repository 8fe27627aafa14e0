"""Reads ``JOB.toml``. The file may come from anybody: every key is checked and every refusal says where and
why."""

from __future__ import annotations

import tomllib
from collections.abc import Mapping
from datetime import date, datetime
from itertools import pairwise
from pathlib import Path
from typing import Any, Literal, TypeVar, cast

from ahrs_lab.certificates.job_sheet import DeviceUnderTest, JobSheet, Party, Person
from ahrs_lab.certificates.job_sheet_figures import check_figures, read_figures
from ahrs_lab.certificates.job_sheet_limits import read_best_capability, read_requirements
from ahrs_lab.errors import InputError
from ahrs_lab.messages import Message
from ahrs_lab.metrology.capability import capability_of
from ahrs_lab.metrology.conditions import BenchCapability, Standard, StandardKind
from ahrs_lab.metrology.declared_place import DeclaredPlace

FORMAT = "ahrs-lab-job"
VERSION = 1
_LARGEST_FILE = 1_000_000
_LONGEST_TEXT = 500
_MOST_ENTRIES = 100
_LARGEST = 1e12
_KINDS: tuple[StandardKind, ...] = ("table", "supply", "fixture", "room", "north", "other")
_Choice = TypeVar("_Choice", bound=str)


class _Table:
    """One table of the file, read key by key; keys that nobody asked for are refused at the end."""

    def __init__(self, data: Mapping[str, Any], where: str, path: Path) -> None:
        self._data = dict(data)
        self.where = where
        self._path = path
        self._known: set[str] = set()

    def _place(self, key: str) -> str:
        return f"{self.where}.{key}" if self.where else key

    def _take(self, key: str) -> Any:
        self._known.add(key)
        return self._data.get(key)

    def has(self, key: str) -> bool:
        return key in self._data

    def missing(self, key: str) -> InputError:
        return InputError("{file}: “{key}” is missing; add it", file=self._path.name, key=self._place(key))

    def wrong(self, key: str, expected: Message) -> InputError:
        return InputError(
            "{file}: “{key}” must be {expected}",
            file=self._path.name,
            key=self._place(key),
            expected=expected,
        )

    def text(self, key: str, default: str | None = None, *, empty: bool = True) -> str:
        value = self._take(key)
        if value is None:
            if default is None:
                raise self.missing(key)
            return default
        return self._checked_text(key, value, empty=empty and default is not None)

    def _checked_text(self, key: str, value: object, *, empty: bool) -> str:
        if not isinstance(value, str):
            raise self.wrong(key, Message("a text in quotation marks"))
        value = value.strip()
        if len(value) > _LONGEST_TEXT:
            raise self.wrong(key, Message("at most {limit} characters", limit=_LONGEST_TEXT))
        if any(not c.isprintable() for c in value):
            raise self.wrong(key, Message("one line of printable characters"))
        if not value and not empty:
            raise self.wrong(key, Message("a text that is not empty"))
        return value

    def texts(self, key: str) -> tuple[str, ...]:
        value = self._take(key)
        if value is None:
            return ()
        if not isinstance(value, list) or len(value) > _MOST_ENTRIES:
            raise self.wrong(key, Message("a list of at most {limit} texts", limit=_MOST_ENTRIES))
        return tuple(self._checked_text(f"{key}[{i}]", v, empty=False) for i, v in enumerate(value, 1))

    def day(self, key: str, *, required: bool) -> date | None:
        value = self._take(key)
        if value is None and not required:
            return None
        if value is None:
            raise self.missing(key)
        if isinstance(value, datetime) or not isinstance(value, date):
            raise self.wrong(key, Message("a date without quotation marks, as 2026-11-22"))
        return value

    def number(self, key: str, default: float) -> float:
        value = self._take(key)
        return default if value is None else self._checked_number(key, value)

    def _checked_number(self, key: str, value: object) -> float:
        if isinstance(value, bool) or not isinstance(value, (int, float)) or not 0 <= value < _LARGEST:
            raise self.wrong(key, Message("a number, not negative"))
        return float(value)

    def signed(self, key: str) -> float | None:
        value = self._take(key)
        if value is None:
            return None
        if isinstance(value, bool) or not isinstance(value, (int, float)) or not abs(value) < _LARGEST:
            raise self.wrong(key, Message("a number"))
        return float(value)

    def numbers(self, key: str, default: tuple[float, float, float]) -> tuple[float, float, float]:
        value = self._take(key)
        if value is None:
            return default
        if not isinstance(value, list) or len(value) != 3:
            raise self.wrong(key, Message("a list of three numbers"))
        first, second, third = (self._checked_number(key, v) for v in value)
        return (first, second, third)

    def whole(self, key: str, default: int, low: int, high: int) -> int:
        value = self._take(key)
        if value is None:
            return default
        if isinstance(value, bool) or not isinstance(value, int) or not low <= value <= high:
            raise self.wrong(key, Message("a whole number from {low} to {high}", low=low, high=high))
        return value

    def flag(self, key: str) -> bool:
        value = self._take(key)
        if value is not None and not isinstance(value, bool):
            raise self.wrong(key, Message("true or false"))
        return bool(value)

    def choice(self, key: str, choices: tuple[_Choice, ...], default: _Choice | None = None) -> _Choice:
        value = self._take(key)
        if value is None and default is not None:
            return default
        if value is None:
            raise self.missing(key)
        if value not in choices:
            raise self.wrong(key, Message("one of {choices}", choices=", ".join(choices)))
        return cast("_Choice", value)

    def table(self, key: str, *, required: bool = True) -> _Table:
        value = self._take(key)
        if value is None and not required:
            value = {}
        if value is None:
            raise self.missing(key)
        if not isinstance(value, dict):
            raise self.wrong(key, Message("a table [{key}]", key=self._place(key)))
        return _Table(value, self._place(key), self._path)

    def tables(self, key: str) -> list[_Table]:
        value = self._take(key)
        if value is None:
            return []
        if (
            not isinstance(value, list)
            or len(value) > _MOST_ENTRIES
            or any(not isinstance(v, dict) for v in value)
        ):
            raise self.wrong(
                key, Message("at most {limit} tables [[{key}]]", limit=_MOST_ENTRIES, key=self._place(key))
            )
        return [_Table(v, f"{self._place(key)}[{i}]", self._path) for i, v in enumerate(value, 1)]

    def refused(self, error: InputError) -> InputError:
        """What the rooms below say of this table's values, with its place."""
        return InputError(
            "{file}: “{key}”: {reason}", file=self._path.name, key=self.where, reason=error.message
        )

    def finish(self) -> None:
        unknown = sorted(set(self._data) - self._known)
        if unknown:
            raise InputError(
                "{file}: “{key}” is not known here; correct its spelling or take it out (known: {known})",
                file=self._path.name,
                key=self._place(unknown[0]),
                known=", ".join(sorted(self._known)),
            )


def read_job_sheet(path: Path) -> JobSheet:
    """See :func:`ahrs_lab.certificates.job_sheet.load_job_sheet`."""
    top = _Table(_parsed(path), "", path)
    if top.text("format") != FORMAT:
        raise InputError(
            "{file} is not a job sheet: it has to begin with format = “{format}”",
            file=path.name,
            format=FORMAT,
        )
    top.whole("version", VERSION, VERSION, VERSION)
    people = top.table("people")
    calibrated = cast("date", top.day("calibrated", required=True))
    standards = tuple(_standard(table, path) for table in top.tables("standard"))
    laboratory = top.table("laboratory")
    best_capability = read_best_capability(laboratory.table("capability", required=False))
    declared_place = _declared_place(laboratory.table("place", required=False))
    defaults = JobSheet.__dataclass_fields__
    sheet = JobSheet(
        number=top.text("number"),
        certificate_number=top.text("certificate_number"),
        laboratory=_party(laboratory),
        customer=_party(top.table("customer")),
        device=_device(top.table("device")),
        operator=_person(people.table("operator")),
        verifier=_person(people.table("verifier")),
        approver=_person(people.table("approver")),
        received=cast("date", top.day("received", required=True)),
        calibrated=calibrated,
        issued=top.day("issued", required=False),
        place=top.text("place", ""),
        place_en=top.text("place_en", ""),
        standards=standards,
        capability=_capability(top.table("capability", required=False), standards, calibrated, path),
        procedure=top.text("procedure", str(defaults["procedure"].default), empty=False),
        procedure_en=top.text("procedure_en", str(defaults["procedure_en"].default), empty=False),
        recalibration_months=top.whole("recalibration_months", 24, 1, 120),
        requirements=read_requirements(top),
        best_capability=best_capability,
        declared_place=declared_place,
        rounding=top.choice("rounding", ("half-even", "up"), "half-even"),
        uncertainty_method=top.choice("uncertainty_method", ("gum", "annex-a"), "gum"),
        notes=top.texts("notes"),
        accepted_violations=top.texts("accepted_violations"),
        demonstration=top.flag("demonstration"),
        budget_annex=top.flag("budget_annex"),
        seal=_seal(top, path),
    )
    people.finish()
    top.finish()
    _check_dates(sheet, path)
    return sheet


def _parsed(path: Path) -> dict[str, Any]:
    try:
        with path.open("rb") as file:
            data = file.read(_LARGEST_FILE + 1)
    except OSError as error:
        raise InputError(
            "The job sheet {path} cannot be read ({reason})", path=path, reason=error.strerror or error
        ) from error
    if len(data) > _LARGEST_FILE:
        raise InputError(
            "{file} is too large for a job sheet (more than {limit} bytes)",
            file=path.name,
            limit=_LARGEST_FILE,
        )
    try:
        return tomllib.loads(data.decode("utf-8-sig").replace("\r\n", "\n"))
    except UnicodeDecodeError as error:
        raise InputError("{file} is not UTF-8 text: save it as UTF-8", file=path.name) from error
    except (ValueError, RecursionError) as error:  # ValueError: also a number of too many digits
        raise InputError("{file} is not valid TOML: {reason}", file=path.name, reason=error) from error


def _party(table: _Table) -> Party:
    party = Party(
        name=table.text("name"),
        address=table.text("address"),
        name_en=table.text("name_en", ""),
        address_en=table.text("address_en", ""),
    )
    table.finish()
    return party


def _declared_place(table: _Table) -> DeclaredPlace:
    """``[laboratory.place]``: earth resistance in Ω and whether the table's foundation is isolated."""
    earth, isolated = table.number("earth_resistance_ohm", 0.0), table.flag("isolated_foundation")
    table.finish()
    return DeclaredPlace(
        earth if table.has("earth_resistance_ohm") else None,
        isolated if table.has("isolated_foundation") else None,
    )


def _person(table: _Table) -> Person:
    person = Person(
        name=table.text("name"),
        position=table.text("position", ""),
        name_en=table.text("name_en", ""),
        position_en=table.text("position_en", ""),
    )
    table.finish()
    return person


def _device(table: _Table) -> DeviceUnderTest:
    device = DeviceUnderTest(
        name=table.text("name"),
        manufacturer=table.text("manufacturer"),
        model=table.text("model"),
        serial_number=table.text("serial_number"),
        name_en=table.text("name_en", ""),
    )
    table.finish()
    return device


def _standard(table: _Table, path: Path) -> Standard:
    standard = Standard(
        kind=table.choice("kind", _KINDS),
        name=table.text("name"),
        name_zh=table.text("name_zh", ""),
        manufacturer=table.text("manufacturer", ""),
        model=table.text("model", ""),
        serial_number=table.text("serial_number"),
        accuracy=table.text("accuracy"),
        accuracy_zh=table.text("accuracy_zh", ""),
        certificate_number=table.text("certificate_number"),
        due=table.day("due", required=False),
        traceability=table.text("traceability", ""),
        figures=read_figures(table, path),
    )
    table.finish()
    return standard


def _capability(
    table: _Table, standards: tuple[Standard, ...], calibrated: date, path: Path
) -> BenchCapability:
    """The figures of ``[capability]``, and those of the standards' certificates before them."""
    known = BenchCapability()
    names = [
        name for name in BenchCapability.__dataclass_fields__ if name not in ("rate_relative", "certified")
    ]
    values = {name: table.number(name, getattr(known, name)) for name in names}
    relative = table.numbers("rate_relative", known.rate_relative)
    if table.texts("certified"):
        raise table.wrong(
            "certified",
            Message(
                "left out: enter each figure as [[standard.figure]] of the standard whose certificate "
                "states it, so that its number stands behind the figure"
            ),
        )
    table.finish()
    check_figures(standards, table, path)
    base = BenchCapability(rate_relative=relative, certified=(), **values)
    return capability_of(standards, calibrated, base)


def _seal(top: _Table, path: Path) -> Path | None:
    name = top.text("seal", "")
    if not name:
        return None
    seal = path.parent / name
    if seal.suffix.lower() != ".png" or not seal.is_file():
        raise top.wrong("seal", Message("the name of a PNG image beside the job sheet"))
    return seal


def _check_dates(sheet: JobSheet, path: Path) -> None:
    days: list[tuple[Literal["received", "calibrated", "issued"], date]] = [
        ("received", sheet.received),
        ("calibrated", sheet.calibrated),
    ]
    if sheet.issued is not None:
        days.append(("issued", sheet.issued))
    for (earlier, first), (later, second) in pairwise(days):
        if second < first:
            raise InputError(
                "{file}: “{later}” ({second}) is before “{earlier}” ({first}); correct one of them",
                file=path.name,
                later=later,
                second=second,
                earlier=earlier,
                first=first,
            )
