"""The virtual person at a table without a wire: turns the virtual table as asked, and mounts the case."""

from __future__ import annotations

from ahrs_lab.errors import AbortedError
from ahrs_lab.instruments.by_hand import HandRequest
from ahrs_lab.instruments.interfaces import Clock, Operator, RateTable
from ahrs_lab.messages import Message
from ahrs_lab.recording.orientation import Orientation
from ahrs_lab.simulation.faults import FaultSwitches

_HAND_DPS = 60.0
"""How fast a hand turns a table to an angle."""
_STEADY_S = 1.0
_PATIENCE = 3


class SimulatedSetter:
    """An :class:`~ahrs_lab.instruments.interfaces.Operator` and
    :class:`~ahrs_lab.instruments.by_hand.Setter`. Where the fault ``wrong_rate`` is set, rates and turns are
    set in the wrong sense."""

    def __init__(self, operator: Operator, table: RateTable, clock: Clock, faults: FaultSwitches) -> None:
        self._operator = operator
        self._table = table
        self._clock = clock
        self._faults = faults
        self._request: HandRequest | None = None
        self._refused = 0

    def mount(self, orientation: Orientation, previous: Orientation | None) -> None:
        """See :class:`~ahrs_lab.instruments.interfaces.Operator`."""
        self._operator.mount(orientation, previous)

    def ask(self, request: HandRequest, because: Message | None = None) -> None:
        """See :class:`~ahrs_lab.instruments.by_hand.Setter`; a table that has to rest is braked at once, as
        whoever stands beside it would."""
        self._request = request
        self._refused = 0 if because is None else self._refused + 1
        if self._refused > _PATIENCE:
            raise AbortedError("The simulated operator gives up: {because}", because=because or "")
        if request.kind == "rest":
            self._table.stop()

    def has_set(self, wait_s: float) -> bool:  # noqa: ARG002
        """Does what was asked, and says so."""
        request, self._request = self._request, None
        if request is not None:
            self._clock.wait(self._set(request) + _STEADY_S)
        return True

    def _set(self, request: HandRequest) -> float:
        """Begin to do it; how long that takes, s."""
        acceleration = max(self._table.limits.max_acceleration_dps2, 1e-3)
        if request.kind == "rate":
            rate = self._sense() * request.rate_dps
            change = abs(rate - self._table.state().rate_dps)
            self._table.set_rate(rate)
            return change / acceleration
        if request.kind in ("rest", "switch_off"):
            rate = abs(self._table.state().rate_dps)
            self._table.stop()
            return rate / acceleration
        if request.kind == "switch_on":
            self._table.enable()
        angle = self._table.state().angle_deg
        if request.kind == "turns":
            travel, speed = self._sense() * request.travel_deg, request.rate_dps
        else:
            travel, speed = (request.angle_deg - angle + 180.0) % 360.0 - 180.0, _HAND_DPS
        self._table.move_to(angle + travel, speed)
        return abs(travel) / speed + 2.0 * speed / acceleration

    def _sense(self) -> float:
        fault = self._faults.active("wrong_rate", self._clock.now_s())
        if fault is None:
            return 1.0
        if fault.once:
            self._faults.clear("wrong_rate")
        return -1.0
