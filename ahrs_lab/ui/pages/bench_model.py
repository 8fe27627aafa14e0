"""What a bench says of itself, from its TOML. No Qt here."""

from __future__ import annotations

import math
import tomllib
from dataclasses import dataclass
from typing import Any

from ahrs_lab.errors import InputError
from ahrs_lab.instruments.interfaces import TableLimits
from ahrs_lab.laboratory.benches import bench_from_text
from ahrs_lab.messages import Message
from ahrs_lab.recording.segment import DeviceDescription, Site
from ahrs_lab.simulation.faults import FAULT_NAMES


@dataclass(frozen=True)
class BenchView:
    """Identities of the instruments, what the table may do, where it stands, and its settings as written:
    (section, name, value)."""

    table: str | Message
    ahrs: str | Message
    supply: str | Message
    limits: TableLimits
    device: DeviceDescription
    site: Site
    north_deg: float
    temperature_c: float
    humidity_percent: float
    simulated: bool
    settings: tuple[tuple[str, str, str], ...]


def look_at(text: str) -> BenchView:
    """Build the bench, ask who is there, let it go; raises InputError where the text is no bench. Real
    instruments are not connected for that: they are described as their settings say."""
    data = _document(text)
    if data.get("kind") == "instruments":
        from ahrs_lab.laboratory.supervised_bench import described_bench

        found = described_bench(data, "bench")
        return BenchView(
            table=found.names["table"],
            ahrs=found.names["ahrs"],
            supply=found.names["supply"],
            limits=found.limits,
            device=found.device,
            site=found.site,
            north_deg=found.north_deg,
            temperature_c=math.nan,
            humidity_percent=math.nan,
            simulated=found.simulated,
            settings=settings_of(text),
        )
    bench = bench_from_text(text, "bench")
    try:
        room = bench.room.read()
        return BenchView(
            table=bench.table.identify(),
            ahrs=bench.ahrs.identify(),
            supply=bench.supply.identify(),
            limits=bench.table.limits,
            device=bench.ahrs.description,
            site=bench.site,
            north_deg=bench.north_deg,
            temperature_c=room.temperature_c,
            humidity_percent=room.humidity_percent,
            simulated=bench.simulated,
            settings=settings_of(text),
        )
    finally:
        bench.close()


def settings_of(text: str) -> tuple[tuple[str, str, str], ...]:
    """Every setting that the text gives, in its order; tables in tables have dotted section names."""
    return tuple(_flat(_document(text), ""))


def _flat(table: dict[str, Any], section: str) -> list[tuple[str, str, str]]:
    found: list[tuple[str, str, str]] = []
    inner: list[tuple[str, str, str]] = []
    for key, value in table.items():
        if isinstance(value, dict):
            inner += _flat(value, f"{section}.{key}".lstrip("."))
        else:
            found.append((section, key, _written(value)))
    return found + inner


def _written(value: object) -> str:
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, list):
        return ", ".join(_written(item) for item in value)
    return str(value).replace("-", "\u2212") if isinstance(value, (int, float)) else str(value)


FAULTS: tuple[str, ...] = FAULT_NAMES
"""Faults of the virtual bench that can be tried."""


def faults_of(text: str) -> frozenset[str]:
    """Names of the faults that the bench's text sets."""
    listed = _document(text).get("fault", [])
    if not isinstance(listed, list):
        return frozenset()
    return frozenset(str(entry.get("name", "")) for entry in listed if isinstance(entry, dict))


def with_fault(text: str, name: str, on: bool) -> str:
    """The text with one fault set from the start, or without it; other settings stay (comments do not)."""
    import tomli_w

    data = _document(text)
    listed = data.pop("fault", [])
    kept = [entry for entry in listed if isinstance(entry, dict) and entry.get("name") != name]
    if on:
        kept.append({"name": name})
    if kept:
        data["fault"] = kept
    return tomli_w.dumps(data)


def _document(text: str) -> dict[str, Any]:
    try:
        return tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        raise InputError(
            "{source} is not valid TOML: {reason}.", source="bench", reason=str(error)
        ) from error
