"""Twenty seconds of the soak: 2 kHz over a pseudo-terminal while the live plot draws. No sample is lost."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import pytest

from tests.instruments.links.ports import needs_pty

SOAK = Path(__file__).resolve().parents[2] / "benchmarks" / "soak.py"
SECONDS, RATE_HZ = 20, 2000
FAULTS = ("lost", "failed", "skipped_bytes", "untimed", "repeated", "implausible", "reconnections")


@needs_pty
@pytest.mark.slow
@pytest.mark.timeout(300)
def test_two_thousand_samples_a_second_come_complete_beside_the_live_plot() -> None:
    words = [sys.executable, str(SOAK), "--seconds", str(SECONDS), "--rate", str(RATE_HZ), "--json"]
    done = subprocess.run(words, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    report = json.loads(done.stdout.splitlines()[-1])
    print(f"latency ms, p50 p95 p99 p99.9 max: {report['arrival_ms']}, {report['frames']} frames")
    assert {name: report["counts"][name] for name in FAULTS} == dict.fromkeys(FAULTS, 0)
    assert report["samples"] > 0.9 * SECONDS * RATE_HZ
    assert report["frames"] > SECONDS, "the plot was drawn all the time"
