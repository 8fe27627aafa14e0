"""What the bench must be (JJF 1536 clause 6): standards used, room, and what violates the clause.

Also where the uncertainty's type B terms come from: each figure knows whether it comes from a certificate or
is an assumption.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from datetime import date
from typing import Literal

from ahrs_lab.messages import Message
from ahrs_lab.metrology.declared_place import DeclaredPlace, place_violations
from ahrs_lab.metrology.result import Environment, Origin
from ahrs_lab.metrology.stated_figures import FIGURES, FigureName, StatedFigure
from ahrs_lab.metrology.uncertainty.bench_figure import BenchFigure

ARCSEC = math.radians(1.0 / 3600.0)
"""One second of arc, rad."""

RATE_BANDS_DPS = (1.0, 10.0)
"""|Ω| from which the second and the third band of clause 6 hold, °/s."""
RATE_BAND_NAMES = ("|Ω| < 1 °/s", "1 ≤ |Ω| < 10 °/s", "|Ω| ≥ 10 °/s")
AVERAGING_ANGLES_DEG = (1.0, 10.0, 360.0)
"""Angle over which each band's rate is averaged."""
CLAUSE_6_RATE_RELATIVE = (2e-2, 2e-3, 2e-4)
CLAUSE_6_POSITION_ARCSEC = 10.0
CLAUSE_6_PERPENDICULARITY_ARCSEC = 5.0
CLAUSE_6_STATED: Mapping[FigureName, float] = {
    "fixture_flatness_mm": 0.01,
    "supply_relative": 2e-3,
    "supply_ripple_mv": 0.3,
}
"""Largest figures of the standards that no budget takes, in the unit of their name."""


def rate_band(rate_dps: float) -> int:
    """0, 1 or 2: the band of clause 6 that a rate lies in."""
    size = abs(rate_dps)
    return sum(size >= limit for limit in RATE_BANDS_DPS)


StandardKind = Literal["table", "supply", "fixture", "room", "north", "other"]


@dataclass(frozen=True)
class Standard:
    """A measurement standard or auxiliary instrument with its own certificate (clause 6, clause 8 h), and
    the figures that the certificate states."""

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
    figures: tuple[StatedFigure, ...] = ()


@dataclass(frozen=True)
class BenchCapability:
    """Figures of the bench for the budget, all expanded (k = 2) unless said: assumptions, for no certificate
    with a number stands behind them (:class:`ahrs_lab.metrology.capability.StatedCapability` has those).

    ``rate_relative`` per band (|Ω| < 1, < 10, ≤ 1000 °/s), relative, one error for a whole band; angles in
    the unit of their name. Leans hold for each of two directions: ``wobble_arcsec`` of the platform's normal
    against the axis that it turns about, the same in every mounting; ``level_arcsec`` of the case's seat on
    the platform, anew in each; ``fixture_perpendicularity_arcsec`` of each face. ``position_arcsec`` of each
    stop against the one that north was laid to.
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
    acquisition_bits: float | None = None
    """Effective bits of the data acquisition for annex A (its example: 12); None: from the output's
    resolution."""
    certified: tuple[str, ...] = ()
    """Names that recordings of earlier releases call certified. Kept as recorded; without the certificate's
    number they count as assumptions."""

    def origin(self, name: str, band: int = 0) -> Origin:
        """Where the figure ``name`` comes from; ``band`` of ``rate_relative``."""
        return self.figure(name, band).origin

    def figure(self, name: str, band: int = 0) -> BenchFigure:
        """The figure ``name`` as a budget takes it, in the unit of its name; ``band`` of
        ``rate_relative``."""
        expanded = self.rate_relative[band] if name == "rate_relative" else getattr(self, name)
        return BenchFigure(expanded, origin="assumption")


@dataclass(frozen=True)
class RoomLimits:
    """Clause 6.2.1."""

    temperature_c: tuple[float, float] = (17.0, 23.0)
    humidity_percent: tuple[float, float] = (30.0, 85.0)


_NEEDED: tuple[tuple[StandardKind, Message], ...] = (
    ("table", Message("single-axis position and rate table")),
    ("supply", Message("linear DC supply")),
    ("fixture", Message("mounting fixture")),
)


def clause6_violations(
    standards: Sequence[Standard],
    *,
    on_date: date,
    environment: Environment | None = None,
    capability: BenchCapability | None = None,
    limits: RoomLimits | None = None,
    place: DeclaredPlace | None = None,
    place_needed: bool = False,
) -> tuple[Message, ...]:
    """What keeps a job from starting (clause 6), each a sentence; empty where the bench is as it has to be.

    A standard without a certificate number, without a due date or past it; a kind that is missing; the room,
    where it is known, outside its limits with its spread; the bench, or a figure that a certificate states,
    worse than the clause's; the ``place`` as it is declared, and not being declared where that is
    ``place_needed``.
    """
    found = _standards(standards, on_date) + _stated(standards)
    if environment is not None:
        found += _room(environment, limits or RoomLimits())
    if capability is not None:
        found += _bench(capability)
    return (*found, *place_violations(place or DeclaredPlace(), needed=place_needed))


def _standards(standards: Sequence[Standard], on_date: date) -> list[Message]:
    present = {standard.kind for standard in standards}
    found = [
        Message("No {kind} is among the standards used: choose one (clause 6.1).", kind=name)
        for kind, name in _NEEDED
        if kind not in present
    ]
    for standard in standards:
        named = {"name": standard.name, "serial_number": standard.serial_number}
        if not standard.certificate_number.strip():
            found.append(
                Message(
                    "{name} s/n {serial_number} has no certificate number: enter it or use another.", **named
                )
            )
        if standard.due is None:
            found.append(
                Message("{name} s/n {serial_number} has no due date: enter it or use another.", **named)
            )
        elif standard.due < on_date:
            found.append(
                Message(
                    "The certificate of {name} s/n {serial_number} ran out on {due}: have it calibrated or "
                    "use another.",
                    due=standard.due.isoformat(),
                    **named,
                )
            )
    return found


def _stated(standards: Sequence[Standard]) -> list[Message]:
    return [
        Message(
            "{name} s/n {serial_number} states {has} for “{figure}”; clause 6 asks for {needed}.",
            name=standard.name,
            serial_number=standard.serial_number,
            figure=FIGURES[stated.figure].name,
            has=f"{stated.claimed:.3g}",
            needed=f"{CLAUSE_6_STATED[stated.figure]:g}",
        )
        for standard in standards
        for stated in standard.figures
        if stated.figure in CLAUSE_6_STATED and _worse(stated.claimed, CLAUSE_6_STATED[stated.figure])
    ]


def _room(environment: Environment, limits: RoomLimits) -> list[Message]:
    found = []
    low, high = limits.temperature_c
    value, spread = environment.temperature_c, environment.temperature_spread_c
    if not (low <= value - spread and value + spread <= high):
        found.append(
            Message(
                "The room was at ({value} ± {spread}) °C; it has to stay within {low} °C to {high} °C "
                "(clause 6.2.1).",
                value=round(value, 1),
                spread=round(spread, 1),
                low=low,
                high=high,
            )
        )
    low, high = limits.humidity_percent
    value, spread = environment.humidity_percent, environment.humidity_spread_percent
    if not (low <= value - spread and value + spread <= high):
        found.append(
            Message(
                "The humidity was ({value} ± {spread}) %RH; it has to stay within {low} % to {high} % "
                "(clause 6.2.1).",
                value=round(value, 1),
                spread=round(spread, 1),
                low=low,
                high=high,
            )
        )
    return found


def _bench(capability: BenchCapability) -> list[Message]:
    rates = [capability.figure("rate_relative", band).claimed for band in range(len(RATE_BAND_NAMES))]
    position = capability.figure("position_arcsec").claimed
    perpendicularity = capability.figure("fixture_perpendicularity_arcsec").claimed
    found = [
        Message(
            "The table's rate is known to {has} (k = 2) for {band}; clause 6.1 asks for {needed}.",
            has=f"{has:.1e}",
            band=band,
            needed=f"{needed:.1e}",
        )
        for has, needed, band in zip(rates, CLAUSE_6_RATE_RELATIVE, RATE_BAND_NAMES, strict=True)
        if _worse(has, needed)
    ]
    if _worse(position, CLAUSE_6_POSITION_ARCSEC):
        found.append(
            Message(
                "The table's position is known to {has}″ (k = 2); clause 6.1 asks for {needed}″.",
                has=round(position, 2),
                needed=CLAUSE_6_POSITION_ARCSEC,
            )
        )
    if _worse(perpendicularity, CLAUSE_6_PERPENDICULARITY_ARCSEC):
        found.append(
            Message(
                "The fixture's faces are perpendicular to {has}″; clause 6.2.2 asks for {needed}″.",
                has=round(perpendicularity, 2),
                needed=CLAUSE_6_PERPENDICULARITY_ARCSEC,
            )
        )
    return found


def _worse(has: float, needed: float) -> bool:
    """Beyond what rounding of a unit or of k does."""
    return has > needed * (1.0 + 1e-9)
