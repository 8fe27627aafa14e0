"""What the pages share beyond the workspace: who is signed in, the worker for long work, starting a job's
run and taking its end to a result.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, TypeVar, cast

from PySide6.QtCore import QObject, Signal
from PySide6.QtWidgets import QWidget

from ahrs_lab.errors import AhrsLabError, PermissionDeniedError
from ahrs_lab.messages import Message
from ahrs_lab.records.rows import JobRow, SignedIn
from ahrs_lab.ui.pages.background import Background
from ahrs_lab.ui.workspace import OpenJob, Worker, Workspace

if TYPE_CHECKING:
    from ahrs_lab.laboratory.laboratory import Laboratory
    from ahrs_lab.laboratory.live_run import LiveRun
    from ahrs_lab.ui.run.bridge import RunBridge

T = TypeVar("T")


class Desk(QObject):
    """One per window. ``jobs_changed`` follows all that changes a job; close it before the laboratory."""

    jobs_changed = Signal()
    new_job = Signal()
    """The page of the jobs, which is in front, begins a new one."""
    actor_changed = Signal()
    evaluating = Signal(bool)

    def __init__(self, workspace: Workspace, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self.workspace = workspace
        self.background = Background(self)
        self.actor: SignedIn | None = None
        self._running: tuple[str, SignedIn] | None = None
        workspace.run_ended.connect(self._run_ended)

    @property
    def laboratory(self) -> Laboratory:
        """The laboratory of the workspace."""
        return cast("Laboratory", self.workspace.laboratory)

    @property
    def number(self) -> str:
        """The open job's number, empty where none is open."""
        return self.workspace.job.number if self.workspace.job is not None else ""

    # people ---------------------------------------------------------------------------------------------

    def sign_in(self, actor: SignedIn | None) -> None:
        """From now on this person acts."""
        self.actor = actor
        if actor is None:
            self.workspace.set_worker(None)
        else:
            person = actor.person
            self.workspace.set_worker(Worker(str(person.id), person.name, person.name_en))
            self.laboratory.settings.last_person = person.name
        self.actor_changed.emit()

    def ask_actor(self, parent: QWidget) -> SignedIn | None:
        """Who is signed in; asks for it where nobody is. None: the person went away."""
        if self.actor is None:
            self.change_actor(parent)
        return self.actor

    def change_actor(self, parent: QWidget, prefer: str = "") -> None:
        """Ask who works now, with the person called ``prefer`` chosen; whoever is signed in stays so unless
        somebody else signs in."""
        from ahrs_lab.ui.pages.sign_in import SignInDialog

        dialog = SignInDialog(self, parent, prefer=prefer)
        if dialog.exec():
            self.sign_in(dialog.actor)
        dialog.deleteLater()

    # jobs -----------------------------------------------------------------------------------------------

    def open(self, number: str, page: str = "") -> None:
        """Make it the job of all pages, and bring ``page`` to the front."""
        try:
            self.workspace.open_job(open_job(self.laboratory.job(number)))
        except AhrsLabError as error:
            self.tell(error)
            return
        if page:
            self.workspace.go_to(page)

    def changed(self) -> None:
        """Something about jobs was written: everybody looks again."""
        if self.number:
            self.open(self.number)
        self.jobs_changed.emit()

    # runs -----------------------------------------------------------------------------------------------

    def start_run(
        self, number: str, actor: SignedIn, violations_reason: str = "", second: SignedIn | None = None
    ) -> bool:
        """Start the job's calibration and bring its page to the front; False where it was refused."""

        def make(bridge: RunBridge) -> LiveRun:
            return self.laboratory.start_run(
                number,
                actor,
                on_event=bridge.on_event,
                on_samples=bridge.on_samples,
                speed=self.workspace.speed,
                violations_reason=violations_reason,
                second_person=second,
            )

        if self.workspace.run.live:
            self.workspace.notice("warn", self.tr("A run is going on: stop it or wait for its end."))
            return False
        self._running = (number, actor)
        try:
            self.workspace.start_run(make)
        except AhrsLabError as error:
            self.tell(error)
            return False
        finally:
            self.changed()
        return True

    def resume_run(self) -> None:
        """The run that broke off goes on. Raises where the person at the screen may not, or it cannot."""
        self._take_up(self.workspace.run.resume_recording, "")

    def repeat_segment(self, segment: str, reason: str) -> None:
        """One segment of the last run is recorded again. Raises like :meth:`resume_run`."""
        self._take_up(lambda: self.workspace.run.repeat(segment, reason), reason)

    def _take_up(self, launch: Callable[[], None], reason: str) -> None:
        if self._running is None:
            return
        number, _ = self._running
        if self.actor is None:
            raise PermissionDeniedError("Sign in first.")
        self.laboratory.take_up_run(number, self.actor, reason)
        self._running = (number, self.actor)
        self.workspace.run_starting.emit()
        try:
            launch()
        except AhrsLabError as error:
            self.laboratory.leave_run(number, self.actor, error.message)
            raise
        finally:
            self.open(number)
            self.jobs_changed.emit()

    def _run_ended(self) -> None:
        if self._running is None:
            return
        number, actor = self._running
        if self.workspace.run.model.state == "done":
            self.evaluating.emit(True)
            self.run(
                self, lambda: self.laboratory.finish_run(number, actor), self._evaluated, self._not_evaluated
            )
            return
        why = self.workspace.run.model.reason or Message("The run broke off.")
        try:
            self.laboratory.leave_run(number, actor, why)
        except AhrsLabError as error:
            self.tell(error)
        self.changed()

    def _evaluated(self, _result: object) -> None:
        self.evaluating.emit(False)
        if self._running is not None:
            # Another job may have been opened meanwhile.
            self.open(self._running[0])
        self.jobs_changed.emit()
        self.workspace.go_to("results")

    def _not_evaluated(self, error: AhrsLabError) -> None:
        self.evaluating.emit(False)
        self.tell(error)
        self.changed()

    # work -----------------------------------------------------------------------------------------------

    def run(
        self,
        owner: QObject,
        work: Callable[[], T],
        done: Callable[[T], None],
        failed: Callable[[AhrsLabError], None] | None = None,
        *,
        topic: str = "",
    ) -> None:
        """Long work in the worker, see :class:`Background`; without ``failed`` an error is a notice."""
        self.background.run(owner, work, done, failed or self.tell, topic=topic)

    def tell(self, error: AhrsLabError) -> None:
        """What went wrong, over whatever page is in front."""
        self.workspace.notice("bad", error.message)

    def close(self) -> None:
        """Wait for the worker's end."""
        self.background.close()


def open_job(job: JobRow) -> OpenJob:
    """A job as the context bar names it."""
    device, customer = job.device, job.customer
    return OpenJob(
        job.number,
        job.number,
        device.model or device.name,
        device.serial_number,
        customer.name,
        device.model or device.name_en,
        customer.name_en,
    )
