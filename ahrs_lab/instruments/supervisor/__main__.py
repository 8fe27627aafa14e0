"""``python -m ahrs_lab.instruments.supervisor [--report FILE]``: started by the application, not by hand."""

from __future__ import annotations

import argparse
import os
import sys
from pathlib import Path

from ahrs_lab.instruments.supervisor.supervisor import main

if __name__ == "__main__":
    parser = argparse.ArgumentParser(
        prog="ahrs_lab.instruments.supervisor",
        description="Stops table and supply when the application that started it is gone.",
    )
    parser.add_argument("--report", type=Path, help="file that every stop is written to")
    code = main(parser.parse_args().report)
    sys.stdout.flush()
    # Calls to instruments that never answered are still waiting in threads; they must not keep the process.
    os._exit(code)
