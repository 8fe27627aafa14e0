"""Pictures of the application on the simulated bench: for the README and to look at.

    python packaging/screenshots.py FOLDER [--theme light|dark] [--language en|zh] [--size 1366x768]

A demonstration laboratory is made in a temporary folder, its accelerated job is run, and each page is
pictured on the way: what is seen is what the application does.
"""

from __future__ import annotations

import argparse
import os
import sys
import time
from collections.abc import Callable
from pathlib import Path
from tempfile import TemporaryDirectory

os.environ.setdefault("QT_QPA_PLATFORM", "offscreen")
sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from PySide6.QtCore import QCoreApplication, QEventLoop
from PySide6.QtWidgets import QApplication

from ahrs_lab.laboratory.laboratory import Laboratory
from ahrs_lab.messages import Message
from ahrs_lab.simulation.clock import SimulatedClock
from ahrs_lab.ui.application import Screen
from ahrs_lab.ui.pages.analysis.page import AnalysisPage
from ahrs_lab.ui.pages.results.page import ResultsPage
from ahrs_lab.ui.run.model import RunModel

PATIENCE_S = 120.0
FAST, VISIBLE = 200.0, 4.0
"""Bench seconds per second while nothing is pictured, and for a picture of something that moves."""


class Photographer:
    """Plays the operator and takes pictures."""

    def __init__(self, screen: Screen, laboratory: Laboratory, folder: Path, suffix: str) -> None:
        self._screen = screen
        self._laboratory = laboratory
        self._folder = folder
        self._suffix = suffix

    def _model(self) -> RunModel:
        return self._screen.workspace.run.model

    def take(self, name: str) -> None:
        """A picture of the window as it is."""
        self._settle(0.4)
        target = self._folder / f"{name}{self._suffix}.png"
        self._screen.window.grab().save(str(target))
        print(target)

    def _settle(self, seconds: float) -> None:
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            QCoreApplication.processEvents(QEventLoop.ProcessEventsFlag.AllEvents, 20)
            time.sleep(0.005)

    def until(self, there: Callable[[], bool], what: str) -> None:
        """Wait for ``what``, with the event loop going on."""
        end = time.monotonic() + PATIENCE_S
        while not there():
            if time.monotonic() > end:
                raise SystemExit(f"not there after {PATIENCE_S:.0f} s: {what}")
            self._settle(0.02)

    def _speed(self, speed: float) -> None:
        run = self._screen.workspace.run.run
        assert run is not None
        assert isinstance(run.bench.clock, SimulatedClock)
        run.bench.clock.speed = speed

    def everything(self) -> None:
        """All pages, in the order of a job."""
        screen, desk = self._screen, self._screen.desk
        go = screen.workspace.go_to
        self.take("start")
        number = next(job.number for job in self._laboratory.jobs() if "Accelerated" in job.plan_toml)
        desk.open(number, "jobs")
        self.take("jobs")
        go("run")
        self.take("run-none")
        assert desk.actor is not None
        desk.start_run(number, desk.actor)
        self.until(lambda: self._model().request is not None, "the first mounting is asked for")
        self.take("run-mount")
        self._measure()
        go("results")
        self._settle(1.0)
        self.take("results")
        self._result_tabs()
        go("certificate")
        self.until(lambda: not desk.background.busy, "the certificate is drawn")
        self.take("certificate")
        self._analyses()
        for page in ("bench", "instruments", "setup"):
            go(page)
            self.take(page)

    def _analyses(self) -> None:
        """The job's own recording, and one without any."""
        self._screen.workspace.go_to("analyse")
        page = self._screen.window.findChild(AnalysisPage)
        assert page is not None
        self.until(lambda: page.workbench is not None, "the analyses are listed")
        assert page.workbench is not None
        for key in ("allan", "error-propagation"):
            page.workbench.choose(key)
            page.workbench.start()
            self.until(lambda: not self._screen.desk.background.busy, f"{key} is done")
            self.take(f"analyse-{key}")

    def _result_tabs(self) -> None:
        results = self._screen.window.findChild(ResultsPage)
        assert results is not None
        results.tabs.setCurrentIndex(2)
        self.take("results-budget")
        results.tabs.setCurrentIndex(results.tabs.count() - 2)
        for key in ("K.x", "B.x"):
            results.choose(key)
            self.take(f"results-diagnosis-{key[0]}")
        results.tabs.setCurrentIndex(0)

    def _measure(self) -> None:
        run, model = self._screen.workspace.run, self._model
        self._speed(FAST)
        run.confirm_mounted()
        self.until(lambda: model().activity is not None and model().powered, "the device is powered")
        self._speed(VISIBLE)
        self.take("run-power")
        self._speed(FAST)
        self.until(self._at_a_rate, "a recording at 100 °/s")
        self._speed(VISIBLE)
        self._settle(2.5)
        self.take("run-record")
        run.toggle_pause()
        self._speed(FAST)
        self.until(lambda: model().state == "paused", "the run is paused")
        self.take("run-paused")
        run.toggle_pause()
        run.stop()
        self.until(lambda: not run.live, "the run is stopped")
        self._screen.workspace.go_to("run")
        self.take("run-stopped")
        self._screen.desk.resume_run()
        while run.live:
            self.until(lambda: model().request is not None or not run.live, "the next mounting or the end")
            if model().request is not None and not model().confirmed:
                self._speed(FAST * 20)
                run.confirm_mounted()
            self._settle(0.05)
        assert model().state == "done", model().reason or Message("no reason")
        self.until(lambda: not self._screen.desk.background.busy, "the result is evaluated")
        self._screen.workspace.go_to("run")
        self.take("run-done")

    def _at_a_rate(self) -> bool:
        segment = self._model().segment
        return (
            segment is not None and segment.segment.role == "rate" and abs(segment.segment.rate_dps) == 100.0
        )


def main() -> int:
    """Take them."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("folder", type=Path)
    parser.add_argument("--theme", choices=("light", "dark"), default="light")
    parser.add_argument("--language", choices=("en", "zh"), default="en")
    parser.add_argument("--size", default="1366x768")
    arguments = parser.parse_args()
    width, height = (int(part) for part in arguments.size.split("x"))
    arguments.folder.mkdir(parents=True, exist_ok=True)
    app = QApplication(sys.argv[:1])
    with TemporaryDirectory() as home, Laboratory(Path(home)) as laboratory:
        laboratory.prepare_demo()
        laboratory.settings.theme = arguments.theme
        screen = Screen(app, laboratory, language=arguments.language, speed=VISIBLE, demo=True)
        screen.window.resize(width, height)
        screen.window.show()
        suffix = f"-{arguments.theme}-{arguments.language}"
        try:
            Photographer(screen, laboratory, arguments.folder, suffix).everything()
        finally:
            screen.close()
            screen.window.close()
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
