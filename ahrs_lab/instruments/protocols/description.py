"""A private format described in TOML: what a file says of delimited text or fixed binary frames, checked.

::

    name = "Example unit"
    kind = "binary"                    # or "text"
    rate_unit = "deg/s"                # of the recording: deg/s, rad/s or LSB
    accel_unit = "m/s^2"               # m/s^2, g or LSB
    axes = "y x -z"                    # the case's x, y, z are the unit's y, x and −z
    [binary]
    sync = "AA 55"
    payload = "<HI6fh"                 # struct format of what stands between sync and checksum
    checksum = "crc16-modbus"          # none xor sum8 sum16 crc16-ccitt crc16-xmodem crc16-modbus
                                       # fletcher crc32
    checksum_from = 2                  # first byte it counts, from the frame's start; default: behind sync
    checksum_order = "little"          # default: as the payload
    [text]
    separator = ","                    # "whitespace" for any number of blanks
    prefix = "$IMU,"                   # what a line begins with, if anything
    fields = 8                         # how many fields a line has, behind the prefix
    checksum = "xor"                   # hexadecimal, of what stands between the prefix's first character and
    checksum_marker = "*"              # this marker
    [[column]]
    name = "gyro_x"                    # of the bundle, or another
    field = 2                          # counted from 0
    unit = "rad/s"                     # what is sent
    scale = 1.0                        # number × scale is in that unit
    sign = -1
    offset = 0.0                       # added last, in the recording's unit
    modulus = 65536                    # t_s and counter: where the number sent wraps to 0
"""

from __future__ import annotations

import re
import struct
import tomllib
from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, Final, Literal, cast

import numpy as np

from ahrs_lab.errors import InputError
from ahrs_lab.instruments.protocols.checksums import CHECKSUMS, ChecksumKind
from ahrs_lab.recording.samples import ACCEL, ANGLE, ATTITUDE, GYRO
from ahrs_lab.recording.segment import AccelUnit, RateUnit

_RATE: Final = {"deg/s": 1.0, "rad/s": 180.0 / np.pi, "deg/h": 1.0 / 3600.0, "mrad/s": 0.18 / np.pi}
_ACCEL: Final = {"m/s^2": 1.0, "g": 9.80665, "mg": 9.80665e-3}
_ANGLE: Final = {"deg": 1.0, "rad": 180.0 / np.pi, "mrad": 0.18 / np.pi}
_TIME: Final = {"s": 1.0, "ms": 1e-3, "us": 1e-6, "ns": 1e-9}
_TOP: Final = {"name", "kind", "rate_unit", "accel_unit", "axes", "binary", "text", "column"}
_BINARY: Final = {"sync", "payload", "checksum", "checksum_from", "checksum_order"}
_TEXT: Final = {"separator", "prefix", "fields", "checksum", "checksum_marker"}
_COLUMN: Final = {"name", "field", "unit", "scale", "sign", "offset", "modulus"}
_ITEM: Final = r"(\d*)([xbBhHiIqQfd])"
_STRUCT = re.compile(_ITEM)
_PAYLOAD = re.compile(f"[<>](?:{_ITEM})+")
_TRIPLES: Final = (GYRO, ACCEL, ANGLE, ("mag_x", "mag_y", "mag_z"))


@dataclass(frozen=True)
class ColumnDescription:
    """``column = number sent × factor + offset``; ``modulus`` (in numbers sent) only of time and counter."""

    name: str
    field: int
    factor: float
    offset: float = 0.0
    modulus: int | None = None


@dataclass(frozen=True)
class BinaryDescription:
    """``fields`` are (place in the frame, numpy code)."""

    sync: bytes
    fields: tuple[tuple[int, str], ...]
    payload_length: int
    checksum: ChecksumKind
    checksum_from: int
    checksum_order: Literal["little", "big"]


@dataclass(frozen=True)
class TextDescription:
    """``separator`` None: any number of blanks."""

    separator: bytes | None
    prefix: bytes
    fields: int
    checksum: ChecksumKind
    marker: bytes


@dataclass(frozen=True)
class StreamDescription:
    """A whole format."""

    name: str
    rate_unit: RateUnit
    accel_unit: AccelUnit
    frame: BinaryDescription | TextDescription
    columns: tuple[ColumnDescription, ...]


def load_description(path: Path) -> StreamDescription:
    """Read and check a file; raises InputError that names the file, the place and what to write."""
    try:
        data = tomllib.loads(path.read_text(encoding="utf-8"))
    except OSError as error:
        raise InputError(
            "{path} cannot be read: {error}", path=path, error=error.strerror or error
        ) from error
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
        raise InputError("{path} is no TOML file: {error}", path=path, error=error) from error
    return description_from_toml(data, str(path))


def description_from_toml(data: Mapping[str, Any], where: str) -> StreamDescription:
    """Check a format; ``where`` names it in messages. Raises InputError."""
    top = _Table(dict(data), where, "")
    top.allow(_TOP)
    rate_unit = cast(RateUnit, top.choice("rate_unit", ("deg/s", "rad/s", "LSB"), "deg/s"))
    accel_unit = cast(AccelUnit, top.choice("accel_unit", ("m/s^2", "g", "LSB"), "m/s^2"))
    frame: BinaryDescription | TextDescription
    if top.choice("kind", ("text", "binary"), None) == "text":
        frame = _text(top.table("text", _TEXT))
        count = frame.fields
    else:
        frame = _binary(top.table("binary", _BINARY))
        count = len(frame.fields)
    columns = tuple(_column(table, count, rate_unit, accel_unit) for table in top.tables("column", _COLUMN))
    _check_columns(columns, top)
    columns = _turned(columns, top)
    return StreamDescription(top.text("name", ""), rate_unit, accel_unit, frame, columns)


class _Table:
    """A TOML table that says in the person's words what is wrong with it."""

    def __init__(self, values: dict[str, Any], where: str, name: str) -> None:
        self._values = values
        self._where = where
        self._name = name

    def wrong(self, key: str, expected: str) -> InputError:
        return InputError(
            "{where}: “{key}” has to be {expected}.",
            where=self._where,
            key=self._path(key),
            expected=expected,
        )

    def _path(self, key: str) -> str:
        return f"{self._name}.{key}" if self._name else key

    def allow(self, known: set[str]) -> None:
        for key in self._values:
            if key not in known:
                raise InputError(
                    "{where}: “{key}” is not known; there are {known}.",
                    where=self._where,
                    key=self._path(key),
                    known=", ".join(sorted(known)),
                )

    def has(self, key: str) -> bool:
        return key in self._values

    def table(self, key: str, known: set[str]) -> _Table:
        value = self._values.get(key)
        if not isinstance(value, dict):
            raise self.wrong(key, f"[{key}]")
        found = _Table(value, self._where, key)
        found.allow(known)
        return found

    def tables(self, key: str, known: set[str]) -> list[_Table]:
        value = self._values.get(key)
        if not isinstance(value, list) or not value or not all(isinstance(entry, dict) for entry in value):
            raise self.wrong(key, f"[[{key}]]")
        found = [_Table(entry, self._where, f"{key}[{i}]") for i, entry in enumerate(value)]
        for table in found:
            table.allow(known)
        return found

    def text(self, key: str, default: str | None) -> str:
        value = self._values.get(key, default)
        if not isinstance(value, str):
            raise self.wrong(key, '"…"')
        return value

    def choice(self, key: str, choices: tuple[str, ...], default: str | None) -> str:
        value = self._values.get(key, default)
        if value not in choices:
            raise self.wrong(key, " / ".join(f'"{choice}"' for choice in choices))
        return str(value)

    def number(self, key: str, default: float) -> float:
        value = self._values.get(key, default)
        if isinstance(value, bool) or not isinstance(value, (int, float)) or not np.isfinite(value):
            raise self.wrong(key, "1.0, −0.5, …")
        return float(value)

    def whole(self, key: str, lowest: int, highest: int, default: int | None = None) -> int:
        value = self._values.get(key, default)
        if isinstance(value, bool) or not isinstance(value, int) or not lowest <= value <= highest:
            raise self.wrong(key, f"{lowest} … {highest}")
        return value


def _binary(table: _Table) -> BinaryDescription:
    try:
        sync = bytes.fromhex(table.text("sync", None))
    except ValueError:
        raise table.wrong("sync", '"AA 55"') from None
    if not sync:
        raise table.wrong("sync", '"AA 55"')
    payload = table.text("payload", None).replace(" ", "")
    if not _PAYLOAD.fullmatch(payload):
        raise table.wrong("payload", '"<HI6fh": < / >, x b B h H i I q Q f d')
    fields, place = [], len(sync)
    for count, letter in _STRUCT.findall(payload[1:]):
        size = struct.calcsize("=" + letter)
        for _ in range(min(int(count or 1), 4096)):
            if letter != "x":
                fields.append((place, payload[0] + np.dtype(letter).str[1:]))
            place += size
    if not fields or place > 4096:
        raise table.wrong("payload", "1 … 4096 B")
    kind = cast(ChecksumKind, table.choice("checksum", tuple(CHECKSUMS), None))
    order = "little" if payload[0] == "<" else "big"
    return BinaryDescription(
        sync,
        tuple(fields),
        place - len(sync),
        kind,
        table.whole("checksum_from", 0, place - 1, len(sync)),
        cast(Literal["little", "big"], table.choice("checksum_order", ("little", "big"), order)),
    )


def _text(table: _Table) -> TextDescription:
    separator = table.text("separator", None)
    if not separator or not separator.isascii() or "\n" in separator or "\r" in separator:
        raise table.wrong("separator", '"," / ";" / "whitespace"')
    prefix, marker = table.text("prefix", ""), table.text("checksum_marker", "*")
    kind = cast(ChecksumKind, table.choice("checksum", tuple(CHECKSUMS), "none"))
    for key, value in (("prefix", prefix), ("checksum_marker", marker)):
        if not value.isascii() or any(ord(letter) < 32 for letter in value):
            raise table.wrong(key, "ASCII")
    if kind != "none" and not marker:
        raise table.wrong("checksum_marker", '"*"')
    return TextDescription(
        None if separator == "whitespace" else separator.encode("ascii"),
        prefix.encode("ascii"),
        table.whole("fields", 1, 1000),
        kind,
        marker.encode("ascii"),
    )


def _units_of(name: str, rate_unit: str, accel_unit: str) -> tuple[dict[str, float], str]:
    """Units that may be sent for a column, and the one it is kept in."""
    if name in GYRO:
        return ({"LSB": 1.0}, "LSB") if rate_unit == "LSB" else (_RATE, rate_unit)
    if name in ACCEL:
        return ({"LSB": 1.0}, "LSB") if accel_unit == "LSB" else (_ACCEL, accel_unit)
    if name in ATTITUDE or name in ANGLE:
        return _ANGLE, "deg"
    return (_TIME, "s") if name == "t_s" else ({}, "")


def _column(table: _Table, fields: int, rate_unit: str, accel_unit: str) -> ColumnDescription:
    name = table.text("name", None)
    if not re.fullmatch(r"[a-z][a-z0-9_]*", name):
        raise table.wrong("name", '"gyro_x", "t_s", "counter", "temperature_c", …')
    units, kept = _units_of(name, rate_unit, accel_unit)
    unit = table.text("unit", kept)
    if units and unit not in units:
        raise table.wrong("unit", " / ".join(f'"{known}"' for known in units))
    scale = table.number("scale", 1.0)
    if not scale:
        raise table.wrong("scale", "≠ 0")
    sign = table.whole("sign", -1, 1, 1)
    if not sign:
        raise table.wrong("sign", "1 / -1")
    factor = scale * sign * (units[unit] / units[kept] if units else 1.0)
    modulus = None
    if table.has("modulus"):
        if name not in ("t_s", "counter"):
            raise table.wrong("name", '"t_s" / "counter" (modulus)')
        modulus = table.whole("modulus", 2, 1 << 53)
    return ColumnDescription(
        name, table.whole("field", 0, fields - 1), factor, table.number("offset", 0.0), modulus
    )


def _check_columns(columns: tuple[ColumnDescription, ...], top: _Table) -> None:
    names = [column.name for column in columns]
    twice = sorted({name for name in names if names.count(name) > 1})
    if twice:
        raise top.wrong("column", "≠ " + ", ".join(twice))
    if not set(names) & {*GYRO, *ANGLE, *ATTITUDE}:
        raise top.wrong("column", '"gyro_x" / "angle_x" / "heading_deg", …')


def _turned(columns: tuple[ColumnDescription, ...], top: _Table) -> tuple[ColumnDescription, ...]:
    """Columns of the unit's axes under the names of the case's."""
    words = top.text("axes", "x y z").split()
    if sorted(word.lstrip("-") for word in words) != ["x", "y", "z"] or any(len(w) > 2 for w in words):
        raise top.wrong("axes", '"x y z" / "y x -z", …')
    return tuple(_turned_column(column, words) for column in columns)


def _turned_column(column: ColumnDescription, words: list[str]) -> ColumnDescription:
    triple = next((t for t in _TRIPLES if column.name in t), None)
    if triple is None:
        return column
    letter = "xyz"[triple.index(column.name)]
    case = next(i for i, word in enumerate(words) if word[-1] == letter)
    sign = -1.0 if words[case].startswith("-") else 1.0
    factor, offset = sign * column.factor, sign * column.offset
    return replace(column, name=triple[case], factor=factor, offset=offset)
