"""What a laboratory declares of its table's place, which no instrument of the bench measures (JJF 1536 clause
6): the earth resistance and the table's foundation."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from dataclasses import asdict, dataclass
from typing import Any

from ahrs_lab.errors import InputError
from ahrs_lab.messages import Message
from ahrs_lab.metrology.json_reader import JsonReader

NOTE = "declared_place"
"""Key of the declaration in the notes of a recording and of its result."""
EARTH_RESISTANCE_LIMIT_OHM = 4.0


@dataclass(frozen=True)
class DeclaredPlace:
    """None: not declared."""

    earth_resistance_ohm: float | None = None
    isolated_foundation: bool | None = None

    def __post_init__(self) -> None:
        if self.earth_resistance_ohm is not None and not 0.0 <= self.earth_resistance_ohm < math.inf:
            raise InputError("The earth resistance has to be a number of ohms that is not negative.")

    @property
    def complete(self) -> bool:
        """Whether all is declared."""
        return self.earth_resistance_ohm is not None and self.isolated_foundation is not None


def place_violations(place: DeclaredPlace, *, needed: bool) -> tuple[Message, ...]:
    """What of the place violates clause 6; where it is ``needed``, also what is not declared."""
    found: list[Message] = []
    if place.earth_resistance_ohm is None:
        if needed:
            found.append(
                Message("The earth resistance is not declared: enter it on the page Set-up (clause 6.2.1).")
            )
    elif place.earth_resistance_ohm >= EARTH_RESISTANCE_LIMIT_OHM:
        found.append(
            Message(
                "The earth resistance is declared as {value} Ω; it has to be below {limit} Ω (clause 6.2.1).",
                value=place.earth_resistance_ohm,
                limit=EARTH_RESISTANCE_LIMIT_OHM,
            )
        )
    if place.isolated_foundation is None:
        if needed:
            found.append(
                Message(
                    "It is not declared whether the table stands on an isolated foundation: say so on the "
                    "page Set-up (clause 6.2.1)."
                )
            )
    elif not place.isolated_foundation:
        found.append(
            Message("The table is declared as not standing on an isolated foundation (clause 6.2.1).")
        )
    return tuple(found)


def place_note(place: DeclaredPlace) -> dict[str, Any]:
    """What is declared, for the notes of a recording; empty where nothing is."""
    said = {key: value for key, value in asdict(place).items() if value is not None}
    return {NOTE: said} if said else {}


def noted_place(notes: Mapping[str, Any]) -> DeclaredPlace | None:
    """The declaration that the notes of a recording or a result hold, or None."""
    return _read(notes[NOTE]) if NOTE in notes else None


def place_to_json(place: DeclaredPlace) -> str:
    """As the records keep it; "" where nothing is declared."""
    said = place_note(place)
    return json.dumps(said[NOTE], allow_nan=False) if said else ""


def place_from_json(text: str) -> DeclaredPlace:
    """The inverse of :func:`place_to_json`; raises InputError for what it did not write."""
    if not text.strip():
        return DeclaredPlace()
    try:
        data = json.loads(text)
    except (ValueError, RecursionError) as error:
        raise InputError(
            "The laboratory's declaration of its place is not valid JSON: {reason}", reason=str(error)
        ) from error
    return _read(data)


def _read(data: object) -> DeclaredPlace:
    reader = JsonReader(data, NOTE)
    isolated = reader.data.get("isolated_foundation")
    if isolated is not None and not isinstance(isolated, bool):
        raise reader.fault("isolated_foundation", Message("true or false"))
    return DeclaredPlace(reader.optional_number("earth_resistance_ohm"), isolated)
