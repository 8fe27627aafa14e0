"""The virtual world: one clock, one platform, one case on it, and what may go wrong; the truth is here."""

from __future__ import annotations

import threading
from datetime import UTC, datetime
from typing import Final

import numpy as np

from ahrs_lab.errors import InstrumentError
from ahrs_lab.recording.orientation import Orientation
from ahrs_lab.simulation.ahrs import SimulatedAhrs
from ahrs_lab.simulation.clock import SimulatedClock, parse_utc
from ahrs_lab.simulation.faults import FaultSwitches
from ahrs_lab.simulation.motion import Piece
from ahrs_lab.simulation.mounted_case import MountedCase
from ahrs_lab.simulation.operator import SimulatedOperator
from ahrs_lab.simulation.room import SimulatedRoom
from ahrs_lab.simulation.sensors import Sensors
from ahrs_lab.simulation.settings import SimulationSettings
from ahrs_lab.simulation.supply import SimulatedSupply
from ahrs_lab.simulation.table import SimulatedTable

_ARCSEC: Final = np.pi / 648000.0
_FACES: Final = ("x+", "x-", "y+", "y-", "z+", "z-")
_TABLE, _SENSORS, _LINK, _SUPPLY, _ROOM, _FIXTURE, _HAND = range(7)
"""What a seed is for; each has its own numbers, so that one error does not move another's."""


class World:
    """All of the virtual bench. One lock guards it: a screen may switch faults and place the case while a run
    goes on in its thread."""

    def __init__(self, settings: SimulationSettings, speed: float | None = None) -> None:
        self.settings = settings
        start = parse_utc(settings.start_utc) if settings.start_utc else datetime.now(UTC)
        self.clock = SimulatedClock(speed, start)
        self.lock = threading.RLock()
        self.faults = FaultSwitches(self.clock.now_s)
        self.table = SimulatedTable(settings.table, self.clock, self.faults, self._seed(_TABLE), self.lock)
        self.sensors = Sensors(settings.sensor, settings.device, settings.room, self._seed(_SENSORS))
        self.ahrs = SimulatedAhrs(
            settings, self.sensors, self.table.motion, self.clock, self.faults, self._seed(_LINK), self.lock
        )
        self.supply = SimulatedSupply(
            settings.supply, settings.device, self.clock, self.faults, self._seed(_SUPPLY), self.lock
        )
        self.room = SimulatedRoom(settings.room, self.clock, self.faults, self._seed(_ROOM), self.lock)
        self.operator = SimulatedOperator(self.clock, self.faults, self.place, settings.operator.mount_time_s)
        self._hand = np.random.Generator(np.random.SFC64(self._seed(_HAND)))
        self._cases: dict[str, MountedCase] = {}
        self.orientation = Orientation(settings.operator.first_orientation)
        self.supply.feeds(self.ahrs.power)
        self.clock.drive(self, self._advance)
        self.place(self.orientation)
        for fault in settings.fault:
            self.faults.trigger(
                fault.name,
                fault.at_s,
                fault.until_s,
                once=fault.once,
                orientation=Orientation(fault.orientation) if fault.orientation else None,
                above_dps=fault.above_dps,
            )

    def place(self, orientation: Orientation) -> None:
        """Clamp the case so that it stands like ``orientation`` with the table at its north angle."""
        with self.lock:
            if self.table.turning():
                raise InstrumentError("The table is turning: stop it before the case is mounted.")
            self.orientation = orientation
            self.ahrs.clamp(self._case(orientation))

    def fixture_error_rad(self, face: str) -> np.ndarray[tuple[int], np.dtype[np.float64]]:
        """Shape (3,): the small rotation by which a face of the fixture is off, table axes; the same each
        time."""
        spread = self.settings.fixture.perpendicularity_arcsec * _ARCSEC
        seed = np.random.SeedSequence(self.settings.seed, spawn_key=(_FIXTURE, _FACES.index(face)))
        drawn: np.ndarray[tuple[int], np.dtype[np.float64]] = np.random.Generator(
            np.random.SFC64(seed)
        ).standard_normal(3)
        return spread * drawn

    def _case(self, orientation: Orientation) -> MountedCase:
        """What this mounting feels; kept where the fixture repeats."""
        repeatability = self.settings.fixture.repeatability_arcsec * _ARCSEC
        known = self._cases.get(orientation.letters)
        if known is not None and not repeatability:
            return known
        error = self.fixture_error_rad(orientation.face) + repeatability * self._hand.standard_normal(3)
        settings = self.settings
        case = MountedCase(
            orientation.matrix, error, settings.site, settings.table, settings.fixture.lever_arm_m
        )
        self._cases[orientation.letters] = case
        return case

    def _advance(self, start_s: float, stop_s: float) -> None:
        """Time went from ``start_s`` to ``stop_s``: what happened meanwhile."""
        with self.lock:
            trip = self.faults.get("table_trips")
            if trip is not None and not trip.spent and trip.at_s <= stop_s and start_s < trip.until_s:
                moment = self._reaches(trip.above_dps, max(start_s, trip.at_s), stop_s)
                if moment is not None:
                    trip.spent = True
                    self.table.trip(moment)
            self.table.motion.forget_before(min(self.ahrs.made_until_s, self.table.logged_until_s, start_s))

    def _reaches(self, rate_dps: float, start_s: float, stop_s: float) -> float | None:
        """When the platform first turns at ``rate_dps`` or more in that time."""
        for start, stop, piece in self.table.motion.spans(start_s, stop_s):
            if not piece.at_rest and abs(piece.rate_at(start)) >= rate_dps:
                return start
            if not piece.at_rest and abs(piece.rate_at(stop)) >= rate_dps:
                return start + _time_to(rate_dps, piece, start)
        return None

    def _seed(self, purpose: int) -> np.random.SeedSequence:
        return np.random.SeedSequence(self.settings.seed, spawn_key=(purpose,))


def _time_to(rate_dps: float, piece: Piece, start_s: float) -> float:
    """How long a piece that speeds up through ``rate_dps`` takes to it."""
    aim = rate_dps if piece.acceleration > 0.0 else -rate_dps
    return (aim - piece.rate_at(start_s)) / piece.acceleration
