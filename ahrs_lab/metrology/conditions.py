"""What the bench must be (JJF 1536 clause 6): standards used, room, and what violates the clause.

Also where the uncertainty's type B terms come from: each figure knows whether it comes from a certificate or is
an assumption.
"""

from __future__ import annotations

from dataclasses import dataclass
from datetime import date
from typing import Literal

StandardKind = Literal["table", "supply", "fixture", "room", "north", "other"]


@dataclass(frozen=True)
class Standard:
    """A measurement standard or auxiliary instrument with its own certificate (clause 6, clause 8 h)."""

    kind: StandardKind
    name: str
    name_zh: str
    manufacturer: str
    model: str
    serial_number: str
    accuracy: str
    accuracy_zh: str
    certificate_number: str
    due: date | None
    traceability: str = ""


@dataclass(frozen=True)
class BenchCapability:
    """Figures of the bench for the budget, all expanded (k = 2) unless said, and whether each is certified.

    ``rate_relative`` per band (|Ω| < 1, < 10, ≤ 1000 °/s), relative; angles in the unit of their name.
    """

    rate_relative: tuple[float, float, float] = (2e-2, 2e-3, 2e-4)
    position_arcsec: float = 10.0
    wobble_arcsec: float = 2.0
    axis_tilt_arcsec: float = 10.0
    azimuth_arcsec: float = 60.0
    level_arcsec: float = 20.0
    fixture_perpendicularity_arcsec: float = 5.0
    latitude_deg: float = 0.001
    timing_relative: float = 1e-6
    certified: tuple[str, ...] = ()
    """Names of the fields above that a certificate of the standards states; the rest are assumptions."""


@dataclass(frozen=True)
class RoomLimits:
    """Clause 6.2.1."""

    temperature_c: tuple[float, float] = (17.0, 23.0)
    humidity_percent: tuple[float, float] = (30.0, 85.0)
