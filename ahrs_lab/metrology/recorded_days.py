"""The days a recording says it was made on."""

from __future__ import annotations

from collections.abc import Mapping
from datetime import date, datetime, timedelta
from typing import Any

_ANOTHER_ZONE = timedelta(days=1)
"""The recording's times are UTC, a date on paper is the laboratory's own."""


def recorded_days(notes: Mapping[str, Any]) -> tuple[date, date] | None:
    """First and last day, UTC; None where the recording does not say."""
    days = [day for key in ("started_utc", "finished_utc") if (day := _day(notes.get(key))) is not None]
    return (min(days), max(days)) if days else None


def is_recorded_on(notes: Mapping[str, Any], day: date) -> bool:
    """Whether ``day`` can be one of those, in any time zone; so too where the recording does not say."""
    days = recorded_days(notes)
    return days is None or days[0] - _ANOTHER_ZONE <= day <= days[1] + _ANOTHER_ZONE


def _day(utc: object) -> date | None:
    try:
        day = datetime.fromisoformat(str(utc)).date()
    except ValueError:
        return None
    return day if date.min < day < date.max else None
