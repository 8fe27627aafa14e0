"""Benches of real instruments as files: which drivers there are, what each can be set to, and the
laboratory's own bench files (TOML, ``kind = "instruments"``) in ``benches/`` of its folder."""

from __future__ import annotations

import copy
import re
import tomllib
import types
from collections.abc import Mapping
from dataclasses import MISSING, dataclass, fields, is_dataclass
from pathlib import Path
from typing import Any, Literal, Union, cast, get_args, get_origin, get_type_hints

from ahrs_lab.errors import InputError, MachineError
from ahrs_lab.instruments.registry import Driver, Drivers, Kind, find_drivers
from ahrs_lab.instruments.settings import settings_from_toml, settings_to_toml
from ahrs_lab.resource_files import resource_path

PARTS: tuple[Kind, ...] = get_args(Kind)
FieldKind = Literal["text", "number", "whole", "switch", "choice", "toml"]

_NAME = re.compile(r"[\w][\w .-]{0,63}")


@dataclass(frozen=True)
class SettingField:
    """One setting of a driver. ``path`` is dotted ("link.port"); ``default`` as text, "" where there is none;
    a "toml" field holds a list or a table in TOML's inline writing."""

    path: str
    kind: FieldKind
    default: str = ""
    required: bool = False
    choices: tuple[str, ...] = ()

    @property
    def group(self) -> str:
        """The table it stands in, "" at the top."""
        return self.path.rpartition(".")[0]


def setting_fields(driver: Driver) -> tuple[SettingField, ...]:
    """Every setting of a driver, those without default first in each table."""
    return tuple(_fields(driver.settings, "", None))


def _fields(cls: type[Any], prefix: str, defaults: object) -> list[SettingField]:
    hints = get_type_hints(cls)
    found: list[SettingField] = []
    for field in fields(cast(Any, cls)):
        path = f"{prefix}{field.name}"
        hint = _without_none(hints[field.name])
        required = (
            defaults is None
            and field.default is MISSING
            and field.default_factory is MISSING
            and hint is hints[field.name]
        )
        default = getattr(defaults, field.name) if defaults is not None else _default(field)
        if is_dataclass(hint):
            found += _fields(cast(type[Any], hint), path + ".", default)
        else:
            found.append(_field(path, hint, default, required))
    return sorted(found, key=lambda one: not one.required)


def _default(field: Any) -> Any:
    if field.default is not MISSING:
        return field.default
    return field.default_factory() if field.default_factory is not MISSING else None


def _without_none(hint: Any) -> Any:
    if get_origin(hint) in (Union, types.UnionType):
        return next(part for part in get_args(hint) if part is not type(None))
    return hint


def _field(path: str, hint: Any, default: Any, required: bool) -> SettingField:
    if get_origin(hint) is Literal:
        choices = tuple(str(choice) for choice in get_args(hint))
        if all(isinstance(choice, str) and choice.isprintable() for choice in get_args(hint)):
            return SettingField(path, "choice", value_text(default), required, choices)
        return SettingField(path, "toml", inline(default), required)
    plain: dict[Any, FieldKind] = {float: "number", int: "whole", bool: "switch", str: "text"}
    if hint in plain:
        text = value_text(default)
        # Terminators and the like would be invisible in a line of text.
        if hint is str and not text.isprintable():
            return SettingField(path, "toml", inline(default), required)
        return SettingField(path, plain[hint], text, required)
    return SettingField(path, "toml", inline(default), required)


def value_text(value: Any) -> str:
    """A plain value as a form shows it."""
    if value is None:
        return ""
    if isinstance(value, bool):
        return "true" if value else "false"
    return f"{value:g}" if isinstance(value, float) else str(value)


def inline(value: Any) -> str:
    """A list, table or text with control characters in TOML's inline writing."""
    if value is None:
        return ""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        escapes = {"\r": "\\r", "\n": "\\n", "\t": "\\t", "\\": "\\\\", '"': '\\"'}
        return '"' + "".join(escapes.get(c, c) for c in value) + '"'
    if isinstance(value, Mapping):
        return "{ " + ", ".join(f"{key} = {inline(item)}" for key, item in value.items()) + " }"
    if isinstance(value, (list, tuple)):
        return "[" + ", ".join(inline(item) for item in value) + "]"
    if is_dataclass(value) and not isinstance(value, type):
        return inline(settings_to_toml(value))
    return repr(value)


def setting(table: Mapping[str, Any], field: SettingField) -> str:
    """The text of a setting in an instrument's table; "" where it is left to its default."""
    value: Any = table
    for key in field.path.split("."):
        if not isinstance(value, Mapping) or key not in value:
            return ""
        value = value[key]
    return inline(value) if field.kind == "toml" else value_text(value)


def with_setting(table: Mapping[str, Any], field: SettingField, text: str) -> dict[str, Any]:
    """The instrument's table with one setting changed; an empty text leaves it to its default. Raises
    InputError where the text is no such value."""
    changed = copy.deepcopy(dict(table))
    *outer, key = field.path.split(".")
    place = changed
    for name in outer:
        place = place.setdefault(name, {})
    if text.strip():
        place[key] = _parsed(field, text.strip())
    else:
        place.pop(key, None)
    return cast(dict[str, Any], _without_empty(changed))


def _without_empty(value: Any) -> Any:
    if not isinstance(value, dict):
        return value
    kept = {key: _without_empty(item) for key, item in value.items()}
    return {key: item for key, item in kept.items() if item != {}}


def _parsed(field: SettingField, text: str) -> Any:
    try:
        if field.kind == "number":
            return float(text.replace("−", "-"))
        if field.kind == "whole":
            return int(text)
        if field.kind == "toml":
            return tomllib.loads(f"value = {text}")["value"]
    except ValueError as error:
        raise InputError(
            "Setting “{path}”: “{text}” is no such value.", path=field.path, text=text
        ) from error
    return text == "true" if field.kind == "switch" else text


class InstrumentBenches:
    """The bench files of ``folder`` (made when the first one is saved)."""

    def __init__(self, folder: Path, drivers: Drivers | None = None) -> None:
        self._folder = folder
        self._drivers = drivers

    @property
    def drivers(self) -> Drivers:
        """All drivers that are installed; looked for once."""
        if self._drivers is None:
            self._drivers = find_drivers()
        return self._drivers

    def names(self) -> tuple[str, ...]:
        """Of the bench files, in order."""
        return tuple(sorted(path.stem for path in self._folder.glob("*.toml")))

    def text(self, name: str) -> str:
        """The TOML of a bench. Raises InputError where there is none or it cannot be read."""
        path = self._path(name)
        try:
            return path.read_text(encoding="utf-8")
        except (OSError, UnicodeDecodeError) as error:
            raise InputError(
                "The bench file {path} cannot be read ({reason}).", path=path, reason=str(error)
            ) from error

    def load(self, name: str) -> dict[str, Any]:
        """A bench. Raises InputError."""
        try:
            return tomllib.loads(self.text(name))
        except tomllib.TOMLDecodeError as error:
            raise InputError(
                "{source} is not valid TOML: {reason}.", source=name, reason=str(error)
            ) from error

    def save(self, name: str, bench: Mapping[str, Any]) -> None:
        """Write a bench, a new one or over the old one. Raises InputError for a name that is none,
        MachineError where the folder cannot be written."""
        import tomli_w

        path = self._path(name)
        partial = path.with_suffix(".part")
        try:
            self._folder.mkdir(parents=True, exist_ok=True)
            partial.write_text(tomli_w.dumps({"kind": "instruments", **bench}), encoding="utf-8")
            partial.replace(path)
        except OSError as error:
            raise MachineError(
                "{path} cannot be written ({reason}): free space on the disk or choose another folder.",
                path=path,
                reason=error.strerror or str(error),
            ) from error

    def remove(self, name: str) -> None:
        """Delete a bench file."""
        self._path(name).unlink(missing_ok=True)

    def with_instrument(
        self, bench: Mapping[str, Any], part: Kind, driver: str, settings: Mapping[str, Any]
    ) -> dict[str, Any]:
        """The bench with an instrument added or changed. Raises InputError where its driver does not take the
        settings."""
        found = self.drivers.get(part, driver)
        settings_from_toml(found.settings, settings, part)
        return {**bench, part: {"driver": driver, **settings}}

    def without_instrument(self, bench: Mapping[str, Any], part: Kind) -> dict[str, Any]:
        """The bench without that instrument."""
        return {key: value for key, value in bench.items() if key != part}

    def driver_of(self, bench: Mapping[str, Any], part: Kind) -> Driver | None:
        """The driver of an instrument of the bench; None where the bench has none. Raises InputError where it
        is not installed."""
        table = bench.get(part)
        if not isinstance(table, Mapping):
            return None
        return self.drivers.get(part, str(table.get("driver", "")))

    def _path(self, name: str) -> Path:
        if not _NAME.fullmatch(name):
            raise InputError(
                "“{name}” is no name for a bench: use letters, digits, spaces, points and hyphens.", name=name
            )
        return self._folder / f"{name}.toml"


def table_languages() -> dict[str, dict[str, Any]]:
    """Languages of ASCII tables that come along, to begin with: name → TOML."""
    return {
        path.stem: tomllib.loads(path.read_text(encoding="utf-8"))
        for path in sorted(resource_path("tables").glob("*.toml"))
    }
