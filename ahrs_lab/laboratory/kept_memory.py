"""For a process that makes one calculation and ends: memory once taken is kept for the next array."""

from __future__ import annotations

import ctypes
import sys

_TRIM_THRESHOLD, _MMAP_THRESHOLD, _ARENA_MAX = -1, -3, -8
"""Of glibc's ``mallopt``."""


def keep_memory() -> None:
    """Let the C library neither give freed memory back nor ask for each large array anew: where a fresh page
    is slow to get, as on a virtual machine, that is a tenth of a whole calibration. Does nothing where the
    library is another."""
    mallopt = getattr(ctypes.CDLL(None), "mallopt", None) if sys.platform == "linux" else None
    if mallopt is not None:
        mallopt(_TRIM_THRESHOLD, 2**30)
        mallopt(_MMAP_THRESHOLD, 2**28)
        mallopt(_ARENA_MAX, 1)
