"""Recordings out of the records and into them."""

from __future__ import annotations

import json
import shutil
import tempfile
from datetime import date, datetime
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ahrs_lab.errors import InputError
from ahrs_lab.laboratory.evaluation import EvaluationSettings, OutputFolder, evaluate_bundle
from ahrs_lab.laboratory.results import to_json
from ahrs_lab.recording.bundle_source import HEADER_FILE
from ahrs_lab.records.rows import CustomerRow, DeviceRow, JobDraft, SignedIn

if TYPE_CHECKING:
    from ahrs_lab.laboratory.laboratory import Laboratory
    from ahrs_lab.recording.read import Recording


def export_job(laboratory: Laboratory, number: str, target: Path) -> Path:
    """``<number>.ahrsrec`` in ``target``, beside the result where there is one; nothing is overwritten."""
    from ahrs_lab.laboratory.evaluation import write_json
    from ahrs_lab.recording.archive import pack

    bundle = laboratory.bundle(number)
    if not bundle.is_dir():
        raise InputError("Job {number} has no recording yet.", number=number)
    with OutputFolder(target):
        file = target / f"{number}.ahrsrec"
        if file.exists():
            raise InputError("{path} exists already: choose another folder.", path=file)
        pack(bundle, file)
        result = laboratory.result(number)
        if result is not None:
            write_json(to_json(result), target / f"{number}.json")
    return file


def import_bundle(laboratory: Laboratory, bundle: Path, actor: SignedIn | None) -> str:
    """A job made of what the recording says of itself; it has to be one that can be evaluated.

    Without ``actor`` (the command line, where nobody signs in) it is done in the name of the machine's user,
    who has the laboratory's folder and so may; certificates still need three people.
    """
    from ahrs_lab.recording.archive import unpack
    from ahrs_lab.recording.read import read_bundle

    folder = _folder(bundle)
    recording = read_bundle(bundle)
    _refuse_incomplete(recording)
    result = evaluate_bundle(bundle, EvaluationSettings())
    person = actor or laboratory.records.people.machine_user()
    device = recording.header.device
    notes: dict[str, Any] = recording.header.notes
    import tomli_w

    draft = JobDraft(
        customer=CustomerRow(0, "—"),
        device=DeviceRow(0, device.name, "", device.manufacturer, device.model, device.serial_number),
        received=_day(notes.get("started_utc")),
        plan_toml=tomli_w.dumps(notes["plan"]) if isinstance(notes.get("plan"), dict) else "",
    )
    # Whole beside the jobs first: a copy that fails half-way leaves no job behind.
    with (
        OutputFolder(laboratory.home),
        tempfile.TemporaryDirectory(dir=laboratory.home, prefix="import.") as beside,
    ):
        copy = Path(beside) / "recording"
        if folder is None:
            unpack(bundle, copy)
        else:
            _refuse_links(folder)
            shutil.copytree(folder, copy)
        number = laboratory.create_job(draft, person)
        target = laboratory.bundle(number)
        target.parent.mkdir(parents=True, exist_ok=True)
        copy.replace(target)
    text = json.dumps(to_json(result), ensure_ascii=False, allow_nan=False)
    laboratory.records.jobs.add_result(number, text, person)
    laboratory.records.jobs.move(number, "measured", person)
    return number


def _folder(bundle: Path) -> Path | None:
    """The recording's folder, which may be named by its ``recording.toml``; None for an archive."""
    if bundle.is_dir():
        return bundle
    return bundle.parent if bundle.name == HEADER_FILE else None


def _refuse_incomplete(recording: Recording) -> None:
    """What the records keep is whole: a file that is not there now would be missed for good."""
    for finding in recording.findings:
        if finding.kind == "absent":
            raise InputError(
                "{where} lists {file}, which is not there: copy it into the recording.",
                where=HEADER_FILE,
                file=finding.segment,
            )


def _refuse_links(folder: Path) -> None:
    """A link would bring in what the sender only knows the place of, and the next export send it out."""
    for path in folder.rglob("*"):
        if path.is_symlink() or not (path.is_dir() or path.is_file()):
            raise InputError(
                "{file} of {folder} is missing or is a link: copy the file itself there.",
                file=path.relative_to(folder),
                folder=folder,
            )


def _day(utc: object) -> date:
    try:
        return datetime.fromisoformat(str(utc)).date()
    except ValueError:
        return date.today()  # noqa: DTZ011  the day of the import, where the recording does not say
