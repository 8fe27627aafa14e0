"""The application that will be killed: spins the served table under a supervisor, says so, and goes on.

``python spinner.py BENCH REPORT``, BENCH the bench's tables as JSON; prints ``spinning`` and the supervisor's
process number."""

from __future__ import annotations

import json
import sys
import time
from pathlib import Path

from ahrs_lab.instruments.real_clock import RealClock
from ahrs_lab.instruments.registry import Surroundings, create_instrument
from ahrs_lab.instruments.supervisor.client import Supervisor


def main() -> None:
    bench = json.loads(sys.argv[1])
    toml = bench["table"]
    supervisor = Supervisor(toml, bench.get("supply"), report=Path(sys.argv[2]))
    supervisor.start()
    table = create_instrument("table", toml, Surroundings(RealClock(), supervisor.table_links))
    table.open()
    table.enable()
    table.set_rate(100.0)
    while abs(table.state().rate_dps - 100.0) > 1.0:
        time.sleep(0.02)
    print("spinning", supervisor.process_id, flush=True)
    while True:
        # The rate is demanded again and again, so that the application dies in the middle of a conversation.
        table.set_rate(100.0)
        time.sleep(0.01)


if __name__ == "__main__":
    main()
