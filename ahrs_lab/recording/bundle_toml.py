"""``recording.toml``: the header and the list of segments, read with precise complaints and written back.

Keys and tables that this version does not know are carried: unknown tables and top-level keys in
``RecordingHeader.notes``, unknown keys of ``[site]`` and ``[device]`` under ``notes["site"]`` and
``notes["device"]``, unknown keys of a segment in ``Segment.extra``.
"""

from __future__ import annotations

import re
import tomllib
from collections.abc import Mapping, Sequence
from pathlib import PurePosixPath
from typing import Any, get_args

from ahrs_lab.errors import InputError
from ahrs_lab.messages import Message
from ahrs_lab.recording.orientation import AXES, Orientation
from ahrs_lab.recording.segment import (
    AccelUnit,
    DeviceDescription,
    Item,
    RateUnit,
    RecordingHeader,
    Role,
    Segment,
    Site,
)
from ahrs_lab.recording.toml_table import TomlTable, parse_toml

FORMAT = "ahrs-lab-recording"
VERSION = 1
PROCEDURES = ("jjf1536-2015", "imu-discrete", "static", "dynamic")
SUFFIXES = (".csv", ".parquet")
MAX_BYTES = 16 * 2**20

_LARGEST = 1e6
"""No table turns faster (°/s) or more often; beyond, products of two such numbers need not be finite."""

_ENTRY = re.compile(r"""[ \t]*\[\[[ \t]*(segment|"segment"|'segment')[ \t]*\]\]""")

_TOP = ("format", "version", "procedure", "site", "device", "initial", "segment")
_SITE = ("latitude_deg", "longitude_deg", "altitude_m")
_DEVICE = (
    "name",
    "manufacturer",
    "model",
    "serial_number",
    "rate_unit",
    "accel_unit",
    "sample_rate_hz",
)
_SEGMENT = (
    "file",
    "name",
    "orientation",
    "item",
    "axis",
    "role",
    "rate_dps",
    "position",
    "turns",
    "superseded",
    "reason",
    "interrupted",
    "azimuth_deg",
    "started_utc",
)


def parse(data: bytes, where: str) -> tuple[RecordingHeader, tuple[Segment, ...]]:
    """Header and segments of a ``recording.toml``; ``where`` names the file in messages.

    No segment is no error here (a run that has just begun); whether the files exist is the reader's question.
    """
    if len(data) > MAX_BYTES:
        raise InputError(
            "{where} is larger than {limit} MiB: this is not a recording's header.",
            where=where,
            limit=MAX_BYTES // 2**20,
        )
    try:
        document = parse_toml(data.decode("utf-8-sig"))
    except UnicodeDecodeError as error:
        raise InputError(
            "{where} is not UTF-8 text (byte {byte}): save it as UTF-8.", where=where, byte=error.start
        ) from error
    except tomllib.TOMLDecodeError as error:
        raise InputError("{where} is not valid TOML: {error}", where=where, error=error) from error
    top = TomlTable(document, where, "")
    _check_format(top)
    procedure = top.choice("procedure", PROCEDURES)
    site = _site(top.table("site"))
    device = _device(top.table("device"))
    initial = document.get("initial")
    if initial is not None and not isinstance(initial, dict):
        raise InputError("{where}: [initial] has to be a table.", where=where)
    notes = {key: value for key, value in document.items() if key not in _TOP}
    for name, known in (("site", _SITE), ("device", _DEVICE)):
        unknown = {key: value for key, value in document[name].items() if key not in known}
        if unknown:
            notes[name] = unknown
    listed = document.get("segment", [])
    if not isinstance(listed, list) or not all(isinstance(entry, dict) for entry in listed):
        raise InputError("{where}: segments are written as [[segment]] tables.", where=where)
    segments = tuple(
        segment_from_table(entry, where, f"[[segment]] {i + 1}") for i, entry in enumerate(listed)
    )
    _refuse_repeated_files(segments, where)
    return RecordingHeader(procedure, site, device, initial, notes), segments


def entry_lines(data: bytes, count: int) -> list[int]:
    """The line of each of the ``count`` [[segment]] entries of a ``recording.toml`` that :func:`parse` has
    read; zeros where it is written in another way, so that a line cannot be told."""
    text = data.decode("utf-8-sig")
    lines = [number for number, line in enumerate(text.split("\n"), 1) if _ENTRY.match(line)]
    return lines if len(lines) == count else [0] * count


def compose(header: RecordingHeader, segments: Sequence[Segment]) -> dict[str, Any]:
    """The document of ``recording.toml``; the inverse of :func:`parse`."""
    notes = dict(header.notes)
    site = {"latitude_deg": header.site.latitude_deg, "altitude_m": header.site.altitude_m}
    if header.site.longitude_deg is not None:
        site["longitude_deg"] = header.site.longitude_deg
    device = {key: getattr(header.device, key) for key in _DEVICE}
    document: dict[str, Any] = {
        "format": FORMAT,
        "version": VERSION,
        "procedure": header.procedure,
        "site": {**notes.pop("site", {}), **site},
        "device": {**notes.pop("device", {}), **device},
    }
    if header.initial is not None:
        document["initial"] = header.initial
    for key in notes:
        if key in _TOP:
            raise ValueError(f"a note may not be called {key!r}: the recording's header has it")
    document.update(_without_none(notes))
    if segments:
        document["segment"] = [segment_to_table(segment) for segment in segments]
    return document


def segment_to_table(segment: Segment) -> dict[str, Any]:
    """The ``[[segment]]`` of a segment; what has its default is left out."""
    table: dict[str, Any] = {
        "file": segment.file,
        "orientation": segment.orientation.letters,
        "item": segment.item,
        "axis": segment.axis,
        "role": segment.role,
        "rate_dps": float(segment.rate_dps),
    }
    if not segment.file or segment.name != _name_of(segment.file):
        table["name"] = segment.name
    for key in ("position", "turns", "azimuth_deg"):
        value = getattr(segment, key)
        if value is not None:
            table[key] = value
    for key in ("superseded", "reason", "interrupted", "started_utc"):
        value = getattr(segment, key)
        if value:
            table[key] = value
    return {**_without_none(segment.extra), **table}


def segment_from_table(entry: Mapping[str, Any], where: str, what: str) -> Segment:
    """A ``[[segment]]`` table as a segment; raises :class:`InputError` naming ``where`` and ``what``."""
    table = TomlTable(entry, where, what)
    file = table.text("file")
    table = TomlTable(entry, where, f"{what} ({file})")
    _check_path(file, table)
    item = table.choice("item", get_args(Item))
    orientation = _orientation(table)
    free = item in ("static", "dynamic", "rotation")
    role = table.choice("role", get_args(Role), "position" if free else None)
    rate = table.number("rate_dps", None if role == "rate" else 0.0, -_LARGEST, _LARGEST)
    turns = table.whole("turns", required=role == "turns")
    if turns == 0:
        raise table.fault(Message("“{key}” is 0: write the whole turns, signed.", key="turns"))
    if turns is not None and abs(turns) > _LARGEST:
        raise table.wrong("turns", "int")
    position = table.whole("position", required=role == "position" and not free)
    if position is not None and position < 1:
        raise table.fault(Message("“{key}” counts from 1.", key="position"))
    return Segment(
        name=table.text("name", _name_of(file)),
        orientation=orientation,
        item=item,
        axis=table.choice("axis", AXES, orientation.up_axis if free else None),
        role=role,
        rate_dps=rate,
        position=position,
        turns=turns,
        file=file,
        superseded=table.flag("superseded"),
        reason=table.text("reason", ""),
        interrupted=table.flag("interrupted"),
        azimuth_deg=table.number("azimuth_deg", None, -1e6, 1e6) if "azimuth_deg" in entry else None,
        started_utc=table.text("started_utc", ""),
        extra={key: value for key, value in entry.items() if key not in _SEGMENT},
    )


def _check_format(top: TomlTable) -> None:
    if top.text("format") != FORMAT:
        raise top.fault(
            Message(
                "“format” is “{value}”: a recording says “{expected}”.",
                value=top.entries["format"],
                expected=FORMAT,
            )
        )
    version = top.whole("version", required=True)
    assert version is not None
    if version > VERSION:
        raise top.fault(
            Message(
                "the recording has format version {version}, this software reads up to {known}: "
                "read it with a newer version of the software.",
                version=version,
                known=VERSION,
            )
        )
    if version < 1:
        raise top.fault(Message("“{key}” counts from 1.", key="version"))


def _site(table: TomlTable) -> Site:
    longitude = table.number("longitude_deg", None, -360, 360) if "longitude_deg" in table.entries else None
    return Site(
        latitude_deg=table.number("latitude_deg", None, -90, 90),
        altitude_m=table.number("altitude_m", 0.0),
        longitude_deg=longitude,
    )


def _device(table: TomlTable) -> DeviceDescription:
    return DeviceDescription(
        name=table.text("name", "AHRS"),
        manufacturer=table.text("manufacturer", ""),
        model=table.text("model", ""),
        serial_number=table.text("serial_number", ""),
        rate_unit=table.choice("rate_unit", get_args(RateUnit)),
        accel_unit=table.choice("accel_unit", get_args(AccelUnit), "m/s^2"),
        sample_rate_hz=table.number("sample_rate_hz", None, 1e-3, 1e6),
    )


def _orientation(table: TomlTable) -> Orientation:
    try:
        return Orientation(table.text("orientation"))
    except InputError as error:
        if "orientation" not in table.entries or not isinstance(table.entries["orientation"], str):
            raise
        raise InputError("{where}: {what}", where=table.where, what=error.message) from error


def _check_path(file: str, table: TomlTable) -> None:
    path = PurePosixPath(file)
    inside = bool(file) and file.isprintable() and not path.is_absolute() and ".." not in path.parts
    if not inside or "\\" in file or ":" in file or "\0" in file:
        raise table.fault(
            Message(
                "the file has to lie inside the recording: write its path relative to recording.toml, "
                "with forward slashes, for example segments/sf_x_before.csv."
            )
        )
    if path.suffix.lower() not in SUFFIXES:
        raise table.fault(Message("a segment file is .csv or .parquet."))


def _refuse_repeated_files(segments: Sequence[Segment], where: str) -> None:
    seen: set[str] = set()
    for segment in segments:
        if segment.file in seen:
            raise InputError(
                "{where} lists {file} twice: every segment has its own file.", where=where, file=segment.file
            )
        seen.add(segment.file)


def _name_of(file: str) -> str:
    """``segments/zo_x_1.2.parquet`` → ``zo_x_1``: the second take of the same segment."""
    return re.sub(r"\.\d+$", "", PurePosixPath(file).stem)


def _without_none(value: Any) -> Any:
    """TOML has no null: keys without a value are left out."""
    if isinstance(value, Mapping):
        return {str(key): _without_none(entry) for key, entry in value.items() if entry is not None}
    if isinstance(value, (list, tuple)):
        return [_without_none(entry) for entry in value if entry is not None]
    return value
