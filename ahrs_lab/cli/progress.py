"""Progress in a terminal: one line that is written over, or a line a step where the output is no terminal."""

from __future__ import annotations

import shutil
import time
from typing import TextIO

from ahrs_lab.procedures.events import Activity, BenchReading, Event, StepFinished, StepStarted, Warned

_REFRESH_S = 0.1
_BAR = 24


class ProgressLine:
    """Fed with a run's events; the share done is bench time, known from the steps' estimates."""

    def __init__(self, stream: TextIO) -> None:
        self._stream = stream
        self._live = stream.isatty()
        self._total_s = 0.0
        self._left_s = 0.0
        self._what = ""
        self._drawn_at = 0.0

    def __enter__(self) -> ProgressLine:
        return self

    def __exit__(self, *error: object) -> None:
        if self._live:
            self._stream.write("\r\x1b[K")
            self._stream.flush()

    def event(self, event: Event) -> None:
        """Take one piece of news."""
        if isinstance(event, StepStarted):
            step = event.step
            self._what = " ".join(part for part in (step.mounting, step.kind, step.detail) if part)
            if not self._live:
                self._stream.write(f"{self._what}\n")
        elif isinstance(event, BenchReading):
            self._left_s = event.remaining_s
            self._total_s = max(self._total_s, event.remaining_s)
        elif isinstance(event, Warned):
            self._write_line(f"warning: {event.what.text()}")
        if isinstance(event, (StepStarted, StepFinished, BenchReading, Activity)):
            self._draw()

    def stage(self, text: str) -> None:
        """What follows the measuring: evaluating, signing …"""
        self._what, self._left_s = text, 0.0
        if self._live:
            self._draw(force=True)
        else:
            self._stream.write(f"{text}\n")

    def _write_line(self, text: str) -> None:
        self._stream.write(f"\r\x1b[K{text}\n" if self._live else f"{text}\n")

    def _draw(self, *, force: bool = False) -> None:
        now = time.monotonic()
        if not self._live or (now - self._drawn_at < _REFRESH_S and not force):
            return
        self._drawn_at = now
        share = 1.0 - self._left_s / self._total_s if self._total_s > 0 else 0.0
        filled = round(share * _BAR)
        minutes = f"{self._left_s / 60:.0f} min of bench time left" if self._left_s > 0 else ""
        text = f"[{'█' * filled}{'·' * (_BAR - filled)}] {share * 100:3.0f} %  {self._what}  {minutes}"
        width = shutil.get_terminal_size().columns - 1
        self._stream.write("\r\x1b[K" + text[:width])
        self._stream.flush()
