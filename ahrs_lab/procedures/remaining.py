"""How long it still takes: the run as a whole, and until the operator is needed again."""

from __future__ import annotations

from collections.abc import Sequence

from ahrs_lab.procedures.commands import Step


class Remaining:
    """From the steps' estimates and where the run is."""

    def __init__(self, steps: Sequence[Step]) -> None:
        self._steps = tuple(steps)
        self._place = {step.key: index for index, step in enumerate(self._steps)}
        self._current: Step | None = None
        self._started_s = 0.0

    def enter(self, step: Step, now_s: float) -> None:
        """``step`` begins."""
        self._current, self._started_s = step, now_s

    def seconds(self, now_s: float) -> tuple[float, float]:
        """Bench time left in the whole run, and until the next mounting (or the end)."""
        if self._current is None:
            total = sum(step.estimate_s for step in self._steps)
            return total, 0.0
        left = max(self._current.estimate_s - (now_s - self._started_s), 0.0)
        following = self._steps[self._place.get(self._current.key, len(self._steps)) + 1 :]
        mounting = 0.0 if self._current.kind == "mount" else left
        if self._current.kind != "mount":
            for step in following:
                if step.kind == "mount" and step.estimate_s > 0.0:
                    break
                mounting += step.estimate_s
        return left + sum(step.estimate_s for step in following), mounting
