"""How fast the time of a bench of instruments runs. Other than real time is only for a bench that ``ahrs-lab
simulate`` serves, and its instruments have to say so themselves: a real table would not be waited for."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

from ahrs_lab.errors import InputError
from ahrs_lab.instruments.simulated_identity import said_speed

_SAME = 1e-5


def bench_speed(data: Mapping[str, Any], asked: float | None, source: str) -> float:
    """Bench seconds per wall second: ``asked`` where that is other than real time, else the file's ``speed``.

    Raises InputError where it is other than 1 on a bench that is not said to be simulated.
    """
    written = data.get("speed", 1.0)
    if isinstance(written, bool) or not isinstance(written, (int, float)) or not 0.0 < written < 1e6:
        raise InputError("{source}: “{key}” has to be a number above 0.", source=source, key="speed")
    speed = float(written) if asked is None or asked == 1.0 else asked
    operator = data.get("operator", {})
    simulated = isinstance(operator, Mapping) and operator.get("kind") == "simulated-hands"
    if speed != 1.0 and not simulated:
        raise InputError(
            "{source}: real instruments keep real time; a speed of {speed} is only for simulated ones.",
            source=source,
            speed=speed,
        )
    return speed


def check_said_speed(speed: float, part: str, identity: str, source: str) -> None:
    """Raises InputError where the table or the supply (``part``) does not say that its time runs at
    ``speed``."""
    said = said_speed(identity)
    if said is None and speed != 1.0:
        raise InputError(
            "{source}: a speed of {speed} is only for a bench that “ahrs-lab simulate” serves, but [{part}] "
            "is “{identity}”, which does not say that it is simulated. Nothing was moved; take “speed” out.",
            source=source,
            speed=speed,
            part=part,
            identity=identity,
        )
    if said is not None and not math.isclose(said, speed, rel_tol=_SAME):
        raise InputError(
            "{source}: [{part}] is served at {said} times real time, the bench file says {speed}: write "
            "“speed = {said}”.",
            source=source,
            part=part,
            said=said,
            speed=speed,
        )
