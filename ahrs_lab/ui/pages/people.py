"""Names as a reader of either language knows them. No Qt here."""

from __future__ import annotations

from typing import Protocol

from ahrs_lab.records.rows import JobRow, PersonRow


class Named(Protocol):
    """Whatever has a name in both scripts."""

    @property
    def name(self) -> str: ...
    @property
    def name_en(self) -> str: ...


def shown_name(row: Named, language: str) -> str:
    """The English name on an English screen where there is one, else the name."""
    return row.name_en if language == "en" and row.name_en else row.name


def shown_position(person: PersonRow, language: str) -> str:
    """Like :func:`shown_name`."""
    return person.position_en if language == "en" and person.position_en else person.position


def device_line(job: JobRow, language: str) -> str:
    """``VN-100 · s/n 0100012345``: model, or the name where there is no model."""
    model = job.device.model or shown_name(job.device, language)
    word = "出厂编号" if language == "zh" else "s/n"
    return f"{model} · {word} {job.device.serial_number}" if job.device.serial_number else model
