"""Which jobs the list shows for what was typed. No Qt here."""

from __future__ import annotations

from collections.abc import Iterable

from ahrs_lab.records.rows import JobRow


def matching(jobs: Iterable[JobRow], typed: str) -> tuple[JobRow, ...]:
    """Jobs that have every typed word in number, customer, device or state, whatever the case."""
    words = typed.casefold().split()
    return tuple(job for job in jobs if all(word in _haystack(job) for word in words))


def _haystack(job: JobRow) -> str:
    customer, device = job.customer, job.device
    parts = (
        job.number, job.state, customer.name, customer.name_en, device.name, device.name_en,
        device.manufacturer, device.model, device.serial_number, job.received.isoformat(),
        job.certificate_number,
    )  # fmt: skip
    return "\n".join(parts).casefold()
