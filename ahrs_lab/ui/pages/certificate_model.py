"""Who has signed, who signs next, and may the person at the screen. No Qt here."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

from ahrs_lab.records.rows import JobRow, JobState, PersonRow, SignatureRow, SigningRole

SIGNING_ORDER: tuple[SigningRole, ...] = ("operator", "verifier", "approver")
Turn = Literal["signed", "yours", "theirs", "later", "unmeasured", "nobody"]
_STATE_TO_SIGN: dict[SigningRole, JobState] = {
    "operator": "measured",
    "verifier": "measured",
    "approver": "checked",
}

_BEFORE: tuple[JobState, ...] = ("draft", "ready", "running")
"""States in which a job has no finished run, be it one that is repeated."""


@dataclass(frozen=True)
class SigningPlace:
    """One of the three fields: whose it is, and what it waits for.

    ``turn``: signed; yours (the person at the screen signs now); theirs (its person signs now); later
    (another signature comes first); unmeasured (the run is not finished); nobody (the job names nobody).
    """

    role: SigningRole
    person: PersonRow | None
    turn: Turn
    signature: SignatureRow | None


def signing_places(
    job: JobRow, signatures: Sequence[SignatureRow], actor: PersonRow | None
) -> tuple[SigningPlace, ...]:
    """The three fields in their order."""
    people = {"operator": job.operator, "verifier": job.verifier, "approver": job.approver}
    done = {signature.role: signature for signature in signatures}
    places: list[SigningPlace] = []
    for number, role in enumerate(SIGNING_ORDER):
        person = people[role]
        turn: Turn
        if role in done:
            turn = "signed"
        elif person is None:
            turn = "nobody"
        elif job.state in _BEFORE:
            turn = "unmeasured"
        elif len(done) == number and job.state == _STATE_TO_SIGN[role]:
            turn = "yours" if actor is not None and actor.id == person.id else "theirs"
        else:
            turn = "later"
        places.append(SigningPlace(role, person, turn, done.get(role)))
    return tuple(places)
