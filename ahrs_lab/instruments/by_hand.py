"""Instruments without a wire: a person sets them, and the unit on the table tells whether it happened.

A demand to such an instrument returns at once and leaves a :class:`HandRequest`. Whoever made the demand
shows it to a :class:`Setter`, lets time pass, and has it checked once the person says that it is done; nobody
waits inside a driver, so a stop ends the question wherever it stands.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal, Protocol, runtime_checkable

import numpy as np
from numpy.typing import NDArray

from ahrs_lab.messages import Message

Array = NDArray[np.float64]

HandKind = Literal["switch_on", "rate", "angle", "turns", "rest", "switch_off"]


@dataclass(frozen=True)
class HandRequest:
    """What a person has to do; ``message`` says all of it. Rates and angles are positive by the right hand
    about up: anticlockwise seen from above. ``travel_deg``: from where the table stands, for an angle and for
    turns."""

    kind: HandKind
    message: Message
    rate_dps: float = 0.0
    angle_deg: float = 0.0
    travel_deg: float = 0.0


@dataclass(frozen=True)
class Felt:
    """What the unit feels of the request now; None where it feels nothing. ``rate_dps`` is a mean of the last
    second, ``travel_deg`` the turning since the request, ``allowed`` how far off is accepted (°/s or °);
    ``holds``: it is within."""

    rate_dps: float | None
    travel_deg: float | None
    allowed: float
    holds: bool


@dataclass(frozen=True)
class HandFinding:
    """Whether the request counts as carried out, and what to do where not. ``felt``: the unit has told,
    otherwise it is the operator's word."""

    accepted: bool
    felt: bool
    message: Message
    begin_again: bool = False
    """What was done cannot be corrected any more: the motion has to be made again from its start."""


@runtime_checkable
class SetByHand(Protocol):
    """What an instrument has that a person sets, besides the interface of its kind."""

    @property
    def request(self) -> HandRequest | None:
        """What the person has to do; None where everything demanded is carried out."""
        ...

    def feel(self, t_s: Array, rate_dps: Array) -> None:
        """Bench times and the unit's rates about up (°/s), shapes (n,), as they arrive."""
        ...

    def felt(self) -> Felt:
        """What the unit feels of the request now."""
        ...

    def check(self, since_s: float, *, blind: bool) -> HandFinding | None:
        """Judge what was felt since a bench time at which the person said "done"; None: too little yet.
        ``blind``: no unit feels it, it is taken at the person's word. A request that is accepted is over."""
        ...

    def strayed(self) -> HandFinding | None:
        """Where, since the last request was accepted, the unit has felt something else for a second, what;
        told once."""
        ...


@runtime_checkable
class Setter(Protocol):
    """The person who sets what has no wire. Every method may raise AbortedError where the person gives up."""

    def ask(self, request: HandRequest, because: Message | None = None) -> None:
        """Show what to do; returns at once. ``because``: why it is asked again."""
        ...

    def has_set(self, wait_s: float) -> bool:
        """Whether the person says that it is done; waits for the answer at most that long (wall time)."""
        ...
