"""Processor time of a frame of the live plot: 12 curves × 2 kHz × 60 s at 1920×1080. Aim: 12 ms.

    QT_QPA_PLATFORM=offscreen python benchmarks/live_plot.py [frames]

Each frame appends what 1/30 s brings, draws all panels and has Qt paint the window.
"""

from __future__ import annotations

import argparse
import os
import time

os.environ.setdefault("QT_QPA_PLATFORM", "offscreen")

import numpy as np
from PySide6.QtWidgets import QApplication

from ahrs_lab.recording.orientation import AXES
from ahrs_lab.ui.plots.envelope import EnvelopeRing
from ahrs_lab.ui.plots.live_plot import Channel, LivePlot, PanelSpec
from ahrs_lab.ui.theme import AXIS_COLOURS, AXIS_PENS, ThemeSwitch

PANELS = 4
RATE_HZ = 2000
SPAN_S = 60.0
FRAMES_PER_S = 30
AIM_MS = 12.0


def measure(frames: int) -> float:
    """Milliseconds of processor time a frame, appending included."""
    application = QApplication.instance()
    app = application if isinstance(application, QApplication) else QApplication([])
    ThemeSwitch(app, "light")
    rings = [EnvelopeRing(3, SPAN_S) for _ in range(PANELS)]
    channels = tuple(Channel(i, AXIS_COLOURS[axis], AXIS_PENS[axis]) for i, axis in enumerate(AXES))
    plot = LivePlot([PanelSpec(ring, channels) for ring in rings], span_s=SPAN_S)
    plot.resize(1920, 1080)
    plot.show()
    plot.set_running(False)
    noise = np.random.default_rng(1)
    start = np.arange(int(SPAN_S * RATE_HZ)) / RATE_HZ
    for ring in rings:
        ring.append(start, noise.normal(0.0, 0.05, (3, len(start))))
    now = float(start[-1])
    spent = 0.0
    warm_up = 5
    for frame in range(warm_up + frames):
        count = RATE_HZ // FRAMES_PER_S
        t_s = now + np.arange(1, count + 1) / RATE_HZ
        blocks = [noise.normal(0.0, 0.05, (3, count)) for _ in rings]
        now = float(t_s[-1])
        begun = time.process_time()
        for ring, block in zip(rings, blocks, strict=True):
            ring.append(t_s, block)
        plot.draw()
        # What the draw marked is painted into the window's picture here, once, as on a screen.
        app.processEvents()
        if frame >= warm_up:
            spent += time.process_time() - begun
    plot.close()
    return 1000.0 * spent / frames


def main() -> None:
    """Print the figure."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("frames", nargs="?", type=int, default=150)
    figure = measure(parser.parse_args().frames)
    verdict = "within" if figure <= AIM_MS else "above"
    print(f"live plot: {figure:.1f} ms of processor time a frame, {verdict} the aim of {AIM_MS:.0f} ms")


if __name__ == "__main__":
    main()
