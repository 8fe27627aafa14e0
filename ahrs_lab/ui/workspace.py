"""What the pages share: the laboratory, who works, which job is open, the run that is going on.

Pages talk to each other only through this: they change it, and hear its signals.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Literal, Protocol

from PySide6.QtCore import QObject, Signal

from ahrs_lab.laboratory.settings import Settings
from ahrs_lab.messages import Message
from ahrs_lab.ui.run.bridge import RunBridge

if TYPE_CHECKING:
    from ahrs_lab.laboratory.live_run import LiveRun

NoticeKind = Literal["info", "good", "warn", "bad"]


@dataclass(frozen=True)
class OpenJob:
    """The job in the context bar. ``key`` is what the laboratory knows it by; the English names stand in an
    English screen where there are some."""

    key: str
    number: str
    device: str = ""
    serial_number: str = ""
    customer: str = ""
    device_en: str = ""
    customer_en: str = ""


@dataclass(frozen=True)
class Worker:
    """The person at the screen. ``name_en`` stands in an English screen where there is one."""

    key: str
    name: str
    name_en: str = ""


class Stoppable(Protocol):
    """What STOP stops besides the run."""

    @property
    def live(self) -> bool:
        """There is something to stop."""
        ...

    def stop(self) -> bool:
        """Begin to stop, at once; False where there was nothing."""
        ...


class Workspace(QObject):
    """See the module. ``laboratory`` is :class:`ahrs_lab.laboratory.Laboratory`; tests may give a smaller
    one."""

    job_changed = Signal()
    worker_changed = Signal()
    run_starting = Signal()
    """A run is about to take the bench: whoever holds its wires lets them go."""
    run_started = Signal()
    run_ended = Signal()
    closing = Signal()
    """The window goes: whoever holds something lets it go."""
    page_requested = Signal(str)
    theme_chosen = Signal(str)
    language_chosen = Signal(str)
    noticed = Signal(str, object)
    """kind, Message or str: shown as a banner over the page until it is closed."""

    def __init__(
        self, laboratory: Any, settings: Settings, *, speed: float | None = 1.0, parent: QObject | None = None
    ) -> None:
        super().__init__(parent)
        self.laboratory = laboratory
        self.settings = settings
        self.speed = speed
        """Bench seconds per second of the wall clock; None: as fast as it goes."""
        self.job: OpenJob | None = None
        self.worker: Worker | None = None
        self.run = RunBridge(self)
        self.run.ended.connect(self.run_ended)
        self.stoppable: list[Stoppable] = []

    def open_job(self, job: OpenJob | None) -> None:
        """Make it the job of all pages; also to say that its headline changed."""
        self.job = job
        self.job_changed.emit()

    def set_worker(self, worker: Worker | None) -> None:
        """Another person works at the screen."""
        self.worker = worker
        self.worker_changed.emit()

    def go_to(self, page_key: str) -> None:
        """Bring a page to the front: start, jobs, run, results, certificate, analyse, bench,
        setup."""
        self.page_requested.emit(page_key)

    def notice(self, kind: NoticeKind, what: Message | str) -> None:
        """Tell the person, on whatever page they are."""
        self.noticed.emit(kind, what)

    def start_run(self, make: Callable[[RunBridge], LiveRun]) -> None:
        """Start the run that ``make`` builds; it gives the bridge's ``on_event`` and ``on_samples`` to
        :class:`LiveRun`. What ``make`` and the start raise is the caller's to show."""
        self.run_starting.emit()
        self.run.release()
        self.run.start(make)
        self.run_started.emit()
        self.go_to("run")
