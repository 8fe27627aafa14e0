"""The five ways a step can stand; without Qt, because view models speak of it."""

from typing import Literal

StepMark = Literal["pending", "active", "done", "skipped", "failed"]
