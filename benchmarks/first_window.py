"""How long from the command to the first window drawn, and to the help text.

    python benchmarks/first_window.py [--repeat 5]

Each start is a process of its own on the offscreen platform: the very first one (the laboratory is made) and
later ones. The clock starts before the process and stops when the event loop has drawn the window.
"""

from __future__ import annotations

import argparse
import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path

AIM_WINDOW_S, AIM_HELP_S = 1.5, 0.3

_START = """
import sys, time
# In the order in which the command itself imports: what comes after Qt is dearer.
import ahrs_lab.cli.commands, ahrs_lab.laboratory.laboratory
from PySide6.QtWidgets import QApplication
def drawn(*_):
    QApplication.processEvents()
    print(time.time())
    return 0
QApplication.exec = drawn
from ahrs_lab.cli import main
sys.exit(main(["demo"]))
"""


def window_s(home: Path) -> float:
    """Seconds until the window is drawn."""
    environment = {**os.environ, "AHRS_LAB_HOME": str(home), "QT_QPA_PLATFORM": "offscreen"}
    started = time.time()
    done = subprocess.run(
        [sys.executable, "-c", _START], env=environment, capture_output=True, text=True, check=True
    )
    return float(done.stdout.split()[-1]) - started


def help_s() -> float:
    """Seconds of ``ahrs-lab --help``."""
    started = time.perf_counter()
    subprocess.run([sys.executable, "-m", "ahrs_lab", "--help"], stdout=subprocess.DEVNULL, check=True)
    return time.perf_counter() - started


def main() -> int:
    """Print minimum and median of each."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--repeat", type=int, default=5)
    repeat = parser.parse_args().repeat
    first, later = [], []
    for _ in range(repeat):
        with tempfile.TemporaryDirectory() as name:
            first.append(window_s(Path(name)))
            later.append(window_s(Path(name)))
    rows = {
        f"first window, very first start (aim ≤ {AIM_WINDOW_S} s)": sorted(first),
        f"first window, later starts (aim ≤ {AIM_WINDOW_S} s)": sorted(later),
        f"ahrs-lab --help (aim ≤ {AIM_HELP_S} s)": sorted(help_s() for _ in range(repeat)),
    }
    for name, seconds in rows.items():
        print(f"{name:52} min {seconds[0]:.2f} s   median {seconds[len(seconds) // 2]:.2f} s")
    return 0


if __name__ == "__main__":
    sys.exit(main())
