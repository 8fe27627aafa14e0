"""A recording written again with columns corrected: what was done stands in its notes, the original stays."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

from ahrs_lab.errors import InputError
from ahrs_lab.recording.bundle_source import HEADER_FILE
from ahrs_lab.recording.read import RecordedSegment, Recording
from ahrs_lab.recording.samples import Samples
from ahrs_lab.recording.write import BundleWriter


def write_corrected(
    recording: Recording,
    folder: Path,
    correct: Callable[[RecordedSegment], Samples],
    notes: Mapping[str, Any],
) -> None:
    """All segments of ``recording`` that can be read, each as ``correct`` gives it, into a new ``folder``.

    The copy has the rows that count; superseded and interrupted segments go along, marked as they were.
    ``notes`` are added to the header's, with the original's sha256 as ``corrected_from``.
    """
    if (folder / HEADER_FILE).exists():
        raise InputError(
            "{folder} holds a recording already: choose a new folder for the copy.", folder=folder
        )
    with BundleWriter(folder, recording.header) as writer:
        for recorded in recording.segments:
            if not len(recorded.samples):
                continue
            writer.begin(recorded.segment)
            writer.append(correct(recorded))
            if recorded.segment.interrupted:
                writer.interrupt(recorded.segment.reason)
            else:
                writer.finish()
        writer.update_notes({**notes, "corrected_from": recording.sha256})
