"""Between the run's thread and the screen: events queue up and are taken over a few times a second, samples
go straight to the rings. The only place of the screen that another thread touches."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from typing import TYPE_CHECKING

from PySide6.QtCore import QObject, QTimer, Signal

from ahrs_lab.messages import Message
from ahrs_lab.procedures.events import BenchReading, Event, SegmentFinished, SegmentStarted, StateChanged
from ahrs_lab.recording.samples import Samples
from ahrs_lab.ui.run.live_data import LiveData
from ahrs_lab.ui.run.model import RunModel

if TYPE_CHECKING:
    from ahrs_lab.laboratory.live_run import LiveRun

POLL_MS = 60


class RunBridge(QObject):
    """The run that is going on, or the last one, as the screen sees it. All methods but ``on_event`` and
    ``on_samples`` belong to the screen's thread."""

    started = Signal()
    """A run began: ``model`` and ``data`` are new."""
    changed = Signal()
    """The model took events over; at most every POLL_MS."""
    ended = Signal()
    """The run came to its end, whichever."""

    def __init__(self, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self.model = RunModel()
        self.data = LiveData()
        self.rate_unit = "deg/s"
        self._live: LiveRun | None = None
        self._queue: deque[Event] = deque()
        self._going = False
        self._timer = QTimer(self)
        self._timer.setInterval(POLL_MS)
        self._timer.timeout.connect(self.poll)

    # ── called by the run's thread ──────────────────────────────────────────────────────────────────────

    def on_event(self, event: Event) -> None:
        """For ``LiveRun(on_event=…)``."""
        # The segment has to begin with its first sample, not with the screen's next look.
        if isinstance(event, SegmentStarted):
            self.data.begin_segment(event.segment.axis)
        elif isinstance(event, SegmentFinished):
            self.data.end_segment(event.samples, event.lost)
        elif isinstance(event, BenchReading):
            self.data.add_table(event.table.t_s, event.table.rate_dps)
        self._queue.append(event)

    def on_samples(self, samples: Samples) -> None:
        """For ``LiveRun(on_samples=…)``."""
        self.data.add(samples)

    # ── called by the screen ────────────────────────────────────────────────────────────────────────────

    def start(self, make: Callable[[RunBridge], LiveRun]) -> None:
        """Make a run and start it. What either raises comes through, and the picture before stays."""
        live = make(self)
        self._begin(live, live.start)

    def _begin(self, live: LiveRun, launch: Callable[[], None]) -> None:
        before = self._live, self.model, self.data, self.rate_unit
        self._queue.clear()
        self._live = live
        device = live.bench.ahrs.description
        self.rate_unit = device.rate_unit
        self.data = LiveData(device.sample_rate_hz)
        try:
            launch()
        except BaseException:
            self._live, self.model, self.data, self.rate_unit = before
            raise
        # Only now the run knows what an earlier one has recorded. Its news wait in the queue meanwhile.
        self.model = RunModel(
            live.steps,
            power_off_between=live.plan.power.off_between_mountings,
            before=live.recorded_before,
        )
        # From here on there is something to stop, whether or not its first news has been read.
        self._going = True
        self._timer.start()
        self.started.emit()

    def poll(self) -> None:
        """Take over what has queued up."""
        if not self._queue:
            self.model.segment_elapsed_s = self.data.running.elapsed_s
            self._look_for_a_silent_end()
            return
        ended = False
        while self._queue:
            event = self._queue.popleft()
            self.model.apply(event)
            ended = isinstance(event, StateChanged) and not self.model.live
        self.model.segment_elapsed_s = self.data.running.elapsed_s
        self.changed.emit()
        if ended:
            self._going = False
            self._timer.stop()
            self.ended.emit()

    def _look_for_a_silent_end(self) -> None:
        # The thread is over and never said so: a fault of ours, which must not leave the screen waiting.
        if self._live is not None and self._going and self._live.join(0) and not self._queue:
            self._queue.append(
                StateChanged(
                    "failed", Message("The run ended without saying why: look at the log, then resume it.")
                )
            )

    @property
    def live(self) -> bool:
        """A run is going on."""
        return self._going

    @property
    def run(self) -> LiveRun | None:
        """The run itself, also after its end."""
        return self._live

    def confirm_mounted(self) -> None:
        """The person says that the case stands as asked."""
        if self._live is not None and self.model.request is not None:
            self.model.confirmed = True
            self._live.confirm_mounted()
            self.changed.emit()

    def confirm(self) -> None:
        """The person says that what is asked is done: the case mounted, or the table set."""
        if self._live is not None and self.model.hand is not None and self.model.state == "waiting":
            if not self.model.confirmed:
                self.model.confirmed = True
                self._live.confirm_set()
                self.changed.emit()
        else:
            self.confirm_mounted()

    def toggle_pause(self) -> None:
        """Pause before the next command, or go on."""
        if self._live is None or not self.live:
            return
        if self.model.state in ("paused", "pausing"):
            self._live.resume()
        else:
            self._live.pause()

    def resume_recording(self) -> None:
        """After an end that was not the end: go on with what is recorded. Raises what :meth:`LiveRun.start`
        does."""
        if self._live is not None and not self.live:
            self._begin(self._live, self._live.start)

    def repeat(self, segment_name: str, reason: str) -> None:
        """Record one segment again. Raises what :meth:`LiveRun.repeat` does."""
        if self._live is not None and not self.live:
            live = self._live
            self._begin(live, lambda: live.repeat(segment_name, reason))

    def stop(self) -> bool:
        """Table, then supply, to rest; False where nothing runs."""
        if self._live is None or not self.live:
            return False
        self._live.abort(Message("Stopped by the operator."))
        return True

    def release(self) -> None:
        """Let the wires of an ended run's instruments go, for another run or the page Instruments. That run
        is gone on with by starting its job again."""
        from ahrs_lab.laboratory.linked_benches import LinkedBench

        live = self._live
        if live is not None and not self.live and isinstance(live.bench, LinkedBench):
            self._live = None
            live.bench.close()

    def close(self, timeout_s: float = 10.0) -> bool:
        """Bring the bench to a safe state and wait for it; True when the run is over."""
        self.stop()
        over = self._live is None or self._live.join(timeout_s)
        self.poll()
        self._timer.stop()
        if over and self._live is not None:
            self._going = False
            self.release()
        return over
