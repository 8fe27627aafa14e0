"""The complete standard calibration without a screen: how long, how much memory, against drawing its noise.

    python benchmarks/calibration.py [--repeat 3]

Prints, for the standard plan on the demonstration bench (100 Hz, twelve zero-offset positions): bench time,
wall time from plan to result, the same with certificate and three signatures, peak memory of all processes,
and the ratio to merely drawing the normal deviates of its samples (six channels).
"""

from __future__ import annotations

import argparse
import json
import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np

AIM_RESULT_S, AIM_CERTIFICATE_S, AIM_MEMORY_GB, AIM_RATIO = 5.0, 8.0, 1.0, 20.0
CHANNELS = 6
ROOT = Path(__file__).resolve().parents[1]


def timed(arguments: list[str], folder: Path) -> tuple[float, float]:
    """Wall time in s of one command, and peak memory in GB of its processes together."""
    environment = {**os.environ, "AHRS_LAB_HOME": str(folder / "home")}
    started, peak = time.perf_counter(), 0.0
    with subprocess.Popen([sys.executable, "-m", "ahrs_lab", *arguments], env=environment,
                          stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
                          start_new_session=True) as command:  # fmt: skip
        while True:
            try:
                command.wait(0.05)
                break
            except subprocess.TimeoutExpired:
                peak = max(peak, memory_gb(command.pid))
    seconds = time.perf_counter() - started
    if command.returncode:
        raise SystemExit(f"{arguments[0]} ended with {command.returncode}")
    return seconds, peak


def memory_gb(session: int) -> float:
    """What the processes of a session hold now; pages that several share count once. Linux only."""
    total_kb = 0
    for process in Path("/proc").glob("[0-9]*"):
        try:
            if os.getsid(int(process.name)) == session:
                lines = (process / "smaps_rollup").read_text(encoding="ascii").splitlines()
                total_kb += sum(int(line.split()[1]) for line in lines if line.startswith("Pss:"))
        except OSError:  # it has ended meanwhile
            continue
    return total_kb / 2**20


def recorded_samples(bundle: Path) -> int:
    """Rows of all segments."""
    import pyarrow.parquet as parquet

    return sum(parquet.read_metadata(path).num_rows for path in (bundle / "segments").glob("*.parquet"))


def drawing_normals(samples: int) -> float:
    """Seconds to draw the deviates of six channels of white noise, in blocks, the way a simulation would."""
    generator = np.random.Generator(np.random.SFC64(1))
    block = np.empty(180_000 * CHANNELS)
    started = time.perf_counter()
    for _ in range(round(samples / 180_000)):
        generator.standard_normal(out=block)
    return time.perf_counter() - started


def main() -> int:
    """Print the figures as text and, last, as one line of JSON."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--repeat", type=int, default=3)
    repeat = parser.parse_args().repeat
    plan, bench = ROOT / "resources/plans/standard.toml", ROOT / "resources/benches/demo.toml"
    results, certificates, memory = [], [], 0.0
    samples = 0
    for _ in range(repeat):
        with tempfile.TemporaryDirectory() as name:
            folder = Path(name)
            seconds, peak = timed(
                ["run", str(plan), "--bench", str(bench), "--out", str(folder / "run")], folder
            )
            samples = recorded_samples(folder / "run" / "recording")
            results.append(seconds)
            memory = max(memory, peak)
            seconds, peak = timed(
                ["demo", "--headless", "--speed", "max", "--out", str(folder / "demo")], folder
            )
            certificates.append(seconds)
            memory = max(memory, peak)
    drawing = min(drawing_normals(samples) for _ in range(3))
    figures = {
        "samples": samples,
        "bench_time_h": round(samples / 100 / 3600, 2),
        "plan_to_result_s": round(min(results), 2),
        "with_certificate_and_signatures_s": round(min(certificates), 2),
        "peak_memory_gb": round(memory, 2),
        "drawing_normals_s": round(drawing, 3),
        "ratio_to_drawing": round(min(results) / drawing, 1),
    }
    aims = {
        "plan_to_result_s": AIM_RESULT_S,
        "with_certificate_and_signatures_s": AIM_CERTIFICATE_S,
        "peak_memory_gb": AIM_MEMORY_GB,
        "ratio_to_drawing": AIM_RATIO,
    }
    for name, value in figures.items():
        aim = f"   aim ≤ {aims[name]}" if name in aims else ""
        print(f"{name:36} {value:>12}{aim}")
    print(json.dumps(figures))
    return 0


if __name__ == "__main__":
    sys.exit(main())
