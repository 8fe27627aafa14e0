"""For a process that makes one calculation and ends: memory once taken is kept, and seldom looked through."""

from __future__ import annotations

import ctypes
import gc
import os
import sys

_TRIM_THRESHOLD, _MMAP_THRESHOLD, _ARENA_MAX = -1, -3, -8
"""Of glibc's ``mallopt``."""


def keep_memory() -> None:
    """Let the C library neither give freed memory back nor ask for each large array anew, and Arrow, where it
    is not loaded yet, take its memory from there too: a fresh page is slow to get, most of all on a virtual
    machine. Cycles of Python's objects are few and may wait. Of a whole calibration a fifth."""
    gc.set_threshold(100_000, 20, 20)
    os.environ.setdefault("ARROW_DEFAULT_MEMORY_POOL", "system")
    mallopt = getattr(ctypes.CDLL(None), "mallopt", None) if sys.platform == "linux" else None
    # Where the first is refused, the second alone would make each large array a new one for good.
    if mallopt is not None and mallopt(_MMAP_THRESHOLD, 2**28):
        mallopt(_TRIM_THRESHOLD, 2**30)
        mallopt(_ARENA_MAX, 1)
