"""Reading a driver as a run does."""

from __future__ import annotations

import time

from ahrs_lab.instruments.drivers.ahrs.streaming import StreamingAhrs
from ahrs_lab.recording.samples import Samples, concatenate


def read_until(ahrs: StreamingAhrs, count: int) -> Samples:
    """What comes until there are ``count`` samples, for five seconds at most."""
    blocks: list[Samples] = []
    end = time.monotonic() + 5.0
    while sum(len(block) for block in blocks) < count and time.monotonic() < end:
        blocks.append(ahrs.read())
        time.sleep(0.002)
    return concatenate(blocks)
