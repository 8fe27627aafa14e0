"""Recordings out of the records and into them."""

from __future__ import annotations

import json
import shutil
from datetime import date, datetime
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ahrs_lab.errors import InputError
from ahrs_lab.laboratory.evaluation import EvaluationSettings, OutputFolder, evaluate_bundle
from ahrs_lab.metrology.result_json import to_json
from ahrs_lab.records.rows import CustomerRow, DeviceRow, JobDraft, SignedIn

if TYPE_CHECKING:
    from ahrs_lab.laboratory.laboratory import Laboratory


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

    recording = read_bundle(bundle)
    result = evaluate_bundle(bundle, EvaluationSettings())
    person = actor or laboratory.records.people.machine_user()
    device = recording.header.device
    notes: dict[str, Any] = recording.header.notes
    import tomli_w

    number = laboratory.create_job(
        JobDraft(
            customer=CustomerRow(0, "—"),
            device=DeviceRow(0, device.name, "", device.manufacturer, device.model, device.serial_number),
            received=_day(notes.get("started_utc")),
            plan_toml=tomli_w.dumps(notes["plan"]) if isinstance(notes.get("plan"), dict) else "",
        ),
        person,
    )
    target = laboratory.bundle(number)
    with OutputFolder(target.parent):
        if bundle.is_dir():
            shutil.copytree(bundle, target)
        else:
            unpack(bundle, target)
    text = json.dumps(to_json(result), ensure_ascii=False, allow_nan=False)
    laboratory.records.jobs.add_result(number, text, person)
    laboratory.records.jobs.move(number, "measured", person)
    return number


def _day(utc: object) -> date:
    try:
        return datetime.fromisoformat(str(utc)).date()
    except ValueError:
        return date.today()  # noqa: DTZ011  the day of the import, where the recording does not say
