"""``python -m ahrs_lab``."""

import sys

from ahrs_lab.cli import main

if __name__ == "__main__":
    sys.exit(main())
