"""A unit at 2 kHz over a pseudo-terminal with live plots for as long as asked: is a sample lost, and how late
do they come?

    python benchmarks/soak.py [--seconds 600] [--rate 2000] [--json]

Another process serves the bench. As in the application a thread reads the port, a second looks twenty times a
second as a run does and feeds the live plot's rings, and the window draws 12 curves over the last minute at
its own frame rate. Printed: what was lost; latency from the sample's making to its arrival and to its
being looked at, counted from the least that was seen; frames drawn and their time; how long the threads of
either process were ready and waited for a processor, which tells a loaded machine from a slow program. The
exit code is 1 where a sample was lost or nothing was drawn.
"""

from __future__ import annotations

import argparse
import gc
import json
import os
import signal
import socket
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

os.environ.setdefault("QT_QPA_PLATFORM", "offscreen")

import numpy as np
from PySide6.QtCore import QEvent, QTimer
from PySide6.QtWidgets import QApplication, QVBoxLayout, QWidget

from ahrs_lab.instruments.drivers.ahrs.xsens import XsensAhrs, XsensSettings
from ahrs_lab.instruments.links.link_settings import LinkSettings, make_link
from ahrs_lab.instruments.real_clock import RealClock
from ahrs_lab.recording.orientation import AXES
from ahrs_lab.recording.samples import ACCEL, Samples
from ahrs_lab.ui.application import GuiCollector
from ahrs_lab.ui.plots.envelope import EnvelopeRing
from ahrs_lab.ui.plots.live_plot import Channel, LivePlot, PanelSpec
from ahrs_lab.ui.run.live_data import LiveData
from ahrs_lab.ui.theme import AXIS_COLOURS, AXIS_PENS, ThemeSwitch

BAUD = 2_000_000
LOOK_S = 0.05
WINDOW = (1920, 1080)
PERCENTS = (50, 95, 99, 99.9, 100)
ATTITUDE = ("heading_deg", "pitch_deg", "roll_deg")
MADE_SHARE = 0.9
"""What has to come of the samples of that time: the rest is on its way at both ends, longer on a loaded
machine. What is lost on the way is told by the counter."""


@contextmanager
def served(rate_hz: float) -> Iterator[tuple[dict[str, Any], int]]:
    """The places of a bench that another process serves, and that process' number."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "bench.toml"
        path.write_text(f"[device]\nsample_rate_hz = {rate_hz}\nboot_time_s = 0.1\n", encoding="utf-8")
        words = [sys.executable, "-m", "ahrs_lab", "simulate"]
        words += ["--bench", str(path), "--ahrs", "xsens", "--json"]
        with subprocess.Popen(words, stdout=subprocess.PIPE, text=True) as process:
            assert process.stdout is not None
            try:
                yield json.loads(process.stdout.readline())["instruments"], process.pid
            finally:
                process.send_signal(signal.SIGINT)


def waited_s(process_id: int) -> float | None:
    """Seconds that the threads of a process were ready and waited for a processor; None where the system does
    not tell."""
    total = 0
    for file in Path(f"/proc/{process_id}/task").glob("*/schedstat"):
        try:
            total += int(file.read_text(encoding="ascii").split()[1])
        except (OSError, IndexError):
            continue
    return total / 1e9 if total else None


class Looking:
    """What the thread of a run does with the samples: looks, and feeds what the screen draws."""

    def __init__(self, ahrs: XsensAhrs, clock: RealClock, rate_hz: float) -> None:
        self.data = LiveData(rate_hz)
        self.acceleration, self.attitude, self.line = (EnvelopeRing(3) for _ in range(3))
        self.arrived: list[np.ndarray] = []
        self.looked: list[np.ndarray] = []
        self.count = 0
        self.failure: Exception | None = None
        self._ahrs = ahrs
        self._clock = clock

    def run(self, seconds: float) -> None:
        """Read for so long; what goes wrong is kept in :attr:`failure`."""
        try:
            self._ahrs.start()
            end = self._clock.now_s() + seconds
            while self._clock.now_s() < end:
                self._clock.wait(LOOK_S)
                self._take(self._ahrs.read())
        except Exception as error:
            self.failure = error

    def _take(self, samples: Samples) -> None:
        if not len(samples):
            return
        late_s = samples["host_t_s"] - samples["t_s"]
        self.arrived.append(late_s)
        self.looked.append(self._clock.now_s() - samples["t_s"])
        self.count += len(samples)
        self.data.add(samples)
        t_s = samples["host_t_s"]
        self.acceleration.append(t_s, np.vstack([samples[name] for name in ACCEL]))
        self.attitude.append(t_s, np.vstack([samples[name] for name in ATTITUDE]))
        steps = np.diff(samples["counter"], prepend=samples["counter"][0] - 1.0)
        told = samples.get("temperature_c")
        temperature = np.full(len(samples), np.nan) if told is None else told
        self.line.append(t_s, np.vstack([1e3 * (late_s - late_s.min()), steps, temperature]))


class Window(QWidget):
    """The live plot, and how long each of its frames took: what it draws, and what Qt then paints."""

    def __init__(self, looking: Looking) -> None:
        super().__init__()
        channels = tuple(Channel(i, AXIS_COLOURS[axis], AXIS_PENS[axis]) for i, axis in enumerate(AXES))
        rings = (looking.data.gyro, looking.acceleration, looking.attitude, looking.line)
        self.frames_s: list[float] = []
        self.begun_s: list[float] = []
        self.plot = TimedPlot([PanelSpec(ring, channels) for ring in rings])
        QVBoxLayout(self).addWidget(self.plot)
        self.resize(*WINDOW)

    def event(self, event: QEvent) -> bool:
        """A request to update paints everything that was marked, before it returns."""
        begun = time.perf_counter()
        done = super().event(event)
        if event.type() == QEvent.Type.UpdateRequest and (drawn := self.plot.take_drawn()) is not None:
            self.frames_s.append(drawn[1] + time.perf_counter() - begun)
            self.begun_s.append(drawn[0])
        return done


class TimedPlot(LivePlot):
    """Keeps when the last frame began and how long it took."""

    _drawn: tuple[float, float] | None = None

    def draw(self) -> None:
        begun = time.perf_counter()
        super().draw()
        self._drawn = begun, time.perf_counter() - begun

    def take_drawn(self) -> tuple[float, float] | None:
        """When the frame that has not been painted yet began, and how long drawing it took."""
        drawn, self._drawn = self._drawn, None
        return drawn


def soak(ahrs: XsensAhrs, seconds: float, rate_hz: float, served_by: int) -> dict[str, Any]:
    """Read, draw and count for so long."""
    app = QApplication([])
    ThemeSwitch(app, "light")
    clock = RealClock()
    looking = Looking(ahrs, clock, rate_hz)
    window = Window(looking)
    thread = threading.Thread(target=looking.run, args=(seconds,), name="run")
    over = QTimer()
    over.setInterval(200)
    over.timeout.connect(lambda: None if thread.is_alive() else app.quit())
    window.show()
    collector = GuiCollector(app)
    thread.start()
    over.start()
    used_s, begun_s = time.process_time(), time.perf_counter()
    before = {"reading": waited_s(os.getpid()), "serving": waited_s(served_by)}
    app.exec()
    waited = {"reading": waited_s(os.getpid()), "serving": waited_s(served_by)}
    share = (time.process_time() - used_s) / (time.perf_counter() - begun_s)
    thread.join()
    collector.stop()
    window.close()
    gc.collect()
    if looking.failure is not None:
        raise looking.failure
    return _report(ahrs, looking, window, seconds, rate_hz) | {
        "processor_share": share,
        "waited_s": {name: (value or 0.0) - (before[name] or 0.0) for name, value in waited.items()},
    }


def _report(
    ahrs: XsensAhrs, looking: Looking, window: Window, seconds: float, rate_hz: float
) -> dict[str, Any]:
    arrived, looked = np.concatenate(looking.arrived), np.concatenate(looking.looked)
    relation = ahrs.time_relation
    return {
        "seconds": seconds,
        "samples": looking.count,
        "about": round(seconds * rate_hz),
        "counts": ahrs.link_counts,
        "arrival_ms": _percentiles(arrived - arrived.min()),
        "look_ms": _percentiles(looked - arrived.min()),
        "ppm": None if relation is None else relation.rate_ppm,
        "frames": len(window.frames_s),
        "frame_ms": _percentiles(np.array(window.frames_s)),
        "between_frames_ms": _percentiles(np.diff(window.begun_s)),
    }


def _percentiles(values_s: np.ndarray) -> list[float]:
    return [round(float(value), 2) for value in np.percentile(1e3 * values_s, PERCENTS)]


def _well(report: dict[str, Any]) -> bool:
    counts = report["counts"]
    clean = all(counts[name] == 0 for name in ("lost", "failed", "skipped_bytes", "repeated", "implausible"))
    return clean and report["samples"] > MADE_SHARE * report["about"] and report["frames"] > 0


def _text(report: dict[str, Any]) -> str:
    def times(name: str) -> str:
        names = ("p50", "p95", "p99", "p99.9", "max")
        return ", ".join(f"{n} {v:.2f}" for n, v in zip(names, report[name], strict=True))

    counts, seconds = report["counts"], report["seconds"]
    lines = [
        f"{report['samples']} samples in {seconds:g} s (about {report['about']} made), lost {counts['lost']}",
        f"frames of the line {counts['frames']}, failed {counts['failed']}, "
        f"bytes skipped {counts['skipped_bytes']}",
        f"latency to arrival ms: {times('arrival_ms')}",
        f"latency to the look ms: {times('look_ms')}",
        f"plot: {report['frames']} frames drawn ({report['frames'] / seconds:.1f} a second)",
        f"time of a frame ms: {times('frame_ms')}",
        f"between frames ms: {times('between_frames_ms')}",
        f"processor: {100 * report['processor_share']:.0f} % of a core",
        "waited for a processor s: "
        + ", ".join(f"{name} {value:.1f}" for name, value in report["waited_s"].items()),
    ]
    if report["ppm"] is not None:
        lines.append(f"device against host clock: {report['ppm']:+.2f} ppm")
    return "\n".join(lines)


def main() -> int:
    """Soak, tell, judge."""
    parser = argparse.ArgumentParser(description="2 kHz over a pseudo-terminal, with live plots")
    parser.add_argument("--seconds", type=float, default=20.0)
    parser.add_argument("--rate", type=float, default=2000.0)
    parser.add_argument("--json", action="store_true")
    call = parser.parse_args()
    with served(call.rate) as (places, served_by):
        supply = socket.create_connection((places["supply"]["host"], places["supply"]["port"]))
        supply.sendall(b"CURR 1\nVOLT 12\nOUTP ON\n")
        link = LinkSettings(device=places["ahrs"]["device"], baud=BAUD)
        settings = XsensSettings(link, rate_hz=call.rate, attitude=True)
        ahrs = XsensAhrs(settings, make_link(link), RealClock())
        try:
            report = soak(ahrs, call.seconds, call.rate, served_by)
        finally:
            ahrs.close()
            supply.close()
    print(json.dumps(report) if call.json else _text(report), flush=True)
    return 0 if _well(report) else 1


if __name__ == "__main__":
    raise SystemExit(main())
