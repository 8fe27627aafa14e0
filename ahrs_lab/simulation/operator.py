"""The virtual person at the bench."""

from __future__ import annotations

from collections.abc import Callable

from ahrs_lab.instruments.interfaces import Clock
from ahrs_lab.recording.orientation import Orientation
from ahrs_lab.simulation.faults import FaultSwitches


class SimulatedOperator:
    """Somebody who mounts the case as asked, after a while; wrongly where that fault is set."""

    def __init__(
        self,
        clock: Clock,
        faults: FaultSwitches,
        place: Callable[[Orientation], None],
        mount_time_s: float,
    ) -> None:
        self._clock = clock
        self._faults = faults
        self._place = place
        self._mount_time_s = mount_time_s

    def mount(self, orientation: Orientation, previous: Orientation | None) -> None:  # noqa: ARG002
        """See :class:`~ahrs_lab.instruments.interfaces.Operator`."""
        self._clock.wait(self._mount_time_s)
        fault = self._faults.active("wrong_mounting", self._clock.now_s())
        if fault is not None:
            if fault.once:
                self._faults.clear("wrong_mounting")
            letters = orientation.letters
            orientation = fault.orientation or Orientation(letters[1:] + letters[0])
        self._place(orientation)
