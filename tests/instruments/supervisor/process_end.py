"""The end of a process that is nobody's child."""

from __future__ import annotations

import time
from pathlib import Path


def wait_for_end(process_id: int) -> None:
    """The supervisor is nobody's child any more once its application is gone."""
    end = time.monotonic() + 10.0
    while process_id and time.monotonic() < end:
        try:
            state = Path(f"/proc/{process_id}/stat").read_text(encoding="ascii").rsplit(")", 1)[1].split()[0]
        except OSError:
            return
        if state == "Z":
            return
        time.sleep(0.02)
