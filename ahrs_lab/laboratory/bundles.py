"""A folder to record into: a new recording, or the one that is begun there."""

from __future__ import annotations

from pathlib import Path

from ahrs_lab.errors import InputError
from ahrs_lab.recording.bundle_source import HEADER_FILE
from ahrs_lab.recording.segment import RecordingHeader, Segment
from ahrs_lab.recording.write import BundleWriter


def open_bundle(folder: Path, header: RecordingHeader) -> BundleWriter:
    """Begin a recording in ``folder``, or go on with one of the same device and plan.

    Raises InputError where the recording there is of something else: recordings are never mixed.
    """
    if not (folder / HEADER_FILE).is_file():
        return BundleWriter(folder, header)
    writer = BundleWriter.resume(folder)
    found = writer.header
    same = (found.device, found.site, found.notes.get("plan")) == (
        header.device,
        header.site,
        header.notes.get("plan"),
    )
    if not same:
        writer.close()
        raise InputError(
            "{folder} holds a recording of another device, site or plan (s/n {serial}): choose another "
            "folder.",
            folder=folder,
            serial=found.device.serial_number or "?",
        )
    return writer


def sound(writer: BundleWriter) -> frozenset[str]:
    """Names of the segments in the writer's folder that count and hold what the standard asks at least.

    One that lost too many samples is recorded again by the next run instead of failing every evaluation.
    """
    from ahrs_lab.recording.read import read_bundle

    if not writer.segments:
        return frozenset()
    return frozenset(r.segment.name for r in read_bundle(writer.folder).segments if r.usable)


def counting(segments: tuple[Segment, ...]) -> tuple[Segment, ...]:
    """Those that are whole and not replaced by another take."""
    return tuple(s for s in segments if not s.superseded and not s.interrupted)
