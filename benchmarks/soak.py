"""A unit at 2 kHz over a pseudo-terminal for as long as asked: is a sample lost, and how late do they come?

``python benchmarks/soak.py --seconds 600`` serves the bench in another process and reads it with the driver,
looking twenty times a second as a run does. Latency is counted from the least that was seen. The exit code is
1 where a sample was lost.
"""

from __future__ import annotations

import argparse
import json
import signal
import socket
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np

from ahrs_lab.instruments.drivers.ahrs.xsens import XsensAhrs, XsensSettings
from ahrs_lab.instruments.links.link_settings import LinkSettings, make_link
from ahrs_lab.instruments.real_clock import RealClock

BAUD = 2_000_000
LOOK_S = 0.05


@contextmanager
def served(rate_hz: float) -> Iterator[dict[str, Any]]:
    """The places of a bench that another process serves."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "bench.toml"
        path.write_text(f"[device]\nsample_rate_hz = {rate_hz}\nboot_time_s = 0.1\n", encoding="utf-8")
        words = [
            sys.executable,
            "-m",
            "ahrs_lab",
            "simulate",
            "--bench",
            str(path),
            "--ahrs",
            "xsens",
            "--json",
        ]
        with subprocess.Popen(words, stdout=subprocess.PIPE, text=True) as process:
            assert process.stdout is not None
            try:
                yield json.loads(process.stdout.readline())["instruments"]
            finally:
                process.send_signal(signal.SIGINT)


def main() -> int:
    """Soak, tell, judge."""
    parser = argparse.ArgumentParser(description="2 kHz over a pseudo-terminal")
    parser.add_argument("--seconds", type=float, default=20.0)
    parser.add_argument("--rate", type=float, default=2000.0)
    arguments = parser.parse_args()
    with served(arguments.rate) as places:
        supply = socket.create_connection((places["supply"]["host"], places["supply"]["port"]))
        supply.sendall(b"CURR 1\nVOLT 12\nOUTP ON\n")
        link = LinkSettings(device=places["ahrs"]["device"], baud=BAUD)
        clock = RealClock()
        ahrs = XsensAhrs(XsensSettings(link, rate_hz=arguments.rate), make_link(link), clock)
        try:
            late, count = _read(ahrs, clock, arguments.seconds)
            counts, relation = ahrs.counts, ahrs.time_relation
        finally:
            ahrs.close()
            supply.close()
    expected = round(arguments.seconds * arguments.rate)
    percentiles = np.percentile((late - late.min()) * 1e3, [50, 95, 99, 99.9, 100])
    print(f"{count} samples in {arguments.seconds:g} s (about {expected} made), lost {counts.lost}")
    print(f"frames {counts.frames}, failed {counts.failed}, bytes skipped {counts.skipped_bytes}")
    print("latency ms: " + ", ".join(f"{n} {v:.2f}" for n, v in zip(
        ("p50", "p95", "p99", "p99.9", "max"), percentiles, strict=True)))  # fmt: skip
    if relation is not None and relation.rate_ppm is not None:
        print(f"device against host clock: {relation.rate_ppm:+.2f} ppm")
    well = counts.lost == counts.failed == counts.skipped_bytes == 0 and count > 0.99 * expected
    return 0 if well else 1


def _read(ahrs: XsensAhrs, clock: RealClock, seconds: float) -> tuple[np.ndarray, int]:
    ahrs.start()
    late, count = [], 0
    end = clock.now_s() + seconds
    while clock.now_s() < end:
        clock.wait(LOOK_S)
        samples = ahrs.read()
        if len(samples):
            late.append(samples["host_t_s"] - samples["t_s"])
            count += len(samples)
    return np.concatenate(late), count


if __name__ == "__main__":
    raise SystemExit(main())
