"""What a recording says beside its samples, as every result carries it: unit, site, room, deviations, what
the run warned of, which takes do not count."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

from ahrs_lab.errors import InputError
from ahrs_lab.messages import Message
from ahrs_lab.metrology.json_reader import message_from_json
from ahrs_lab.metrology.result import Environment, ResultWarning
from ahrs_lab.recording.read import Recording
from ahrs_lab.recording.segment import RecordingHeader


def run_warnings(recording: Recording) -> list[ResultWarning]:
    """What the runs warned of while they recorded: the room, the azimuth, lost samples; each once."""
    noted = recording.header.notes.get("run_warnings")
    files = {r.segment.name: r.segment.file for r in recording.segments if r.counts}
    found: list[ResultWarning] = []
    for entry in noted if isinstance(noted, list) else []:
        if not isinstance(entry, Mapping) or "what" not in entry:
            continue
        name = str(entry.get("segment", ""))
        warning = ResultWarning(message_from_json(entry["what"], "run_warnings"), files.get(name, name))
        if warning not in found:
            found.append(warning)
    return found


def set_aside(recording: Recording) -> dict[str, Any]:
    """The takes that do not count, each with its reason, for the original record."""
    takes = [
        {"segment": segment.file, "reason": segment.reason}
        for segment in (recorded.segment for recorded in recording.segments)
        if segment.superseded or segment.interrupted
    ]
    return {"repeated": takes} if takes else {}


def segment_starts(recording: Recording) -> dict[str, Any]:
    """When each whole take began, in the order recorded, for the original record; nothing where no take says
    so."""
    starts = [
        {"segment": segment.name if recorded.counts else segment.file, "started_utc": segment.started_utc}
        for recorded in recording.segments
        for segment in (recorded.segment,)
        if segment.started_utc and not segment.interrupted
    ]
    return {"segment_starts": starts} if starts else {}


def noted_deviations(notes: Mapping[str, Any]) -> tuple[Message, ...]:
    """What left the procedure, as the run wrote it down; raises InputError for what is no list of
    sentences."""
    listed = notes.get("deviations", [])
    if not isinstance(listed, list):
        raise InputError(
            "recording.toml: [notes] deviations has to be a list of sentences: correct or remove it."
        )
    return tuple(message_from_json(entry, f"deviations[{index}]") for index, entry in enumerate(listed))


def noted_environment(notes: Mapping[str, Any]) -> Environment | None:
    """The room over the whole run; None where nobody read it. Raises InputError where numbers are missing."""
    table = notes.get("environment")
    if table is None:
        return None
    keys = ("temperature_c", "temperature_spread_c", "humidity_percent", "humidity_spread_percent")
    values = [table.get(key) if isinstance(table, Mapping) else None for key in keys]
    numbers = [
        float(value)
        for value in values
        if isinstance(value, (int, float)) and not isinstance(value, bool) and math.isfinite(value)
    ]
    if len(numbers) < len(keys):
        raise InputError(
            "recording.toml: [notes] environment has to hold the numbers {keys}: correct or remove it.",
            keys=", ".join(keys),
        )
    return Environment(*numbers)


def device_facts(header: RecordingHeader) -> dict[str, Any]:
    """The unit as its recording names it."""
    device = header.device
    return {
        "name": device.name,
        "manufacturer": device.manufacturer,
        "model": device.model,
        "serial_number": device.serial_number,
        "rate_unit": device.rate_unit,
        "accel_unit": device.accel_unit,
        "sample_rate_hz": device.sample_rate_hz,
    }


def site_facts(header: RecordingHeader) -> dict[str, Any]:
    """Where the bench stood."""
    site = header.site
    return {
        "latitude_deg": site.latitude_deg,
        "longitude_deg": site.longitude_deg,
        "altitude_m": site.altitude_m,
    }
