"""Where the laboratory keeps what is its own: records, recordings, keys, settings."""

from __future__ import annotations

import os
from pathlib import Path

from ahrs_lab.errors import MachineError


def home_folder(chosen: Path | None = None) -> Path:
    """``chosen``, else ``AHRS_LAB_HOME`` where it is set, else the place the operating system has for it;
    made if absent."""
    named = os.environ.get("AHRS_LAB_HOME")
    if chosen is not None:
        folder = chosen
    elif named:
        folder = Path(named)
    else:
        from platformdirs import user_data_path

        folder = user_data_path("ahrs-lab", appauthor=False)
    try:
        folder.mkdir(parents=True, exist_ok=True, mode=0o700)
    except OSError as error:
        raise MachineError(
            "The laboratory's folder {path} cannot be made ({reason}). Set AHRS_LAB_HOME to a folder you "
            "may write.",
            path=folder,
            reason=error.strerror or str(error),
        ) from error
    return folder
