"""An evaluation that begins while the recording is still being made: a second process reads each segment as
it is sealed, and reduces them all when the run has ended.

For long runs at full speed on a simulated bench, where the evaluation is what a person waits for. It only
reads. It does what :func:`~ahrs_lab.laboratory.evaluation.evaluate_bundle` does, so the numbers are the same;
where the second process cannot do it, for whatever reason, that function does it here and raises what is to
be raised.
"""

from __future__ import annotations

import signal
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from multiprocessing import get_context, resource_tracker
from multiprocessing.connection import Connection
from pathlib import Path
from queue import SimpleQueue
from types import TracebackType
from typing import TYPE_CHECKING, Any, Self

from ahrs_lab.errors import AhrsLabError
from ahrs_lab.laboratory.evaluation import EvaluationSettings, evaluate_bundle
from ahrs_lab.laboratory.kept_memory import keep_memory
from ahrs_lab.laboratory.results import AnyResult
from ahrs_lab.metrology.conditions import BenchCapability
from ahrs_lab.procedures.events import Event, SegmentFinished
from ahrs_lab.recording.segment import RecordingHeader, Segment

if TYPE_CHECKING:
    from ahrs_lab.laboratory.live_run import LiveRun

LEAST_SAMPLES = 500_000
"""Of fewer the reading is over before a process has started."""


class EvaluationBeside:
    """``with EvaluationBeside(run) as beside:`` before the run starts; after its end :meth:`evaluate`.

    ``meanwhile`` is done here while the second process reduces. With ``allowed`` False there is none: it
    loads the main module once more, which has to be one that does nothing then.
    """

    def __init__(
        self, run: LiveRun, meanwhile: Callable[[], None] = lambda: None, *, allowed: bool = True
    ) -> None:
        self._worker = _started(run) if allowed and _worth_it(run) else None
        self._meanwhile = meanwhile
        if self._worker is not None:
            run.listen(self._hear)

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if self._worker is not None:
            self._worker.close()

    def _hear(self, event: Event) -> None:
        if self._worker is not None and isinstance(event, SegmentFinished):
            self._worker.give(event.segment)

    def evaluate(
        self, bundle: Path, settings: EvaluationSettings | None, capability: BenchCapability | None
    ) -> AnyResult:
        """See :func:`~ahrs_lab.laboratory.evaluation.evaluate_bundle`; ``bundle`` is the run's folder."""
        result = None
        if self._worker is not None:
            self._worker.give((settings, capability))
            self._meanwhile()
            result = self._worker.result()
        return evaluate_bundle(bundle, settings, capability) if result is None else result


def _started(run: LiveRun) -> _Worker | None:
    try:
        return _Worker(run.folder, run.header)
    except (OSError, RuntimeError, MemoryError):  # no more processes, threads, memory
        return None


def _worth_it(run: LiveRun) -> bool:
    planned = sum(step.estimate_s for step in run.steps) * run.header.device.sample_rate_hz
    return run.bench.clock.step_s is None and planned >= LEAST_SAMPLES


class _Worker:
    """The second process and the wire to it; giving never waits."""

    def __init__(self, folder: Path, header: RecordingHeader) -> None:
        context = get_context("spawn")
        self._wire, far = context.Pipe()
        self._process = context.Process(target=_work, args=(far, folder, header), daemon=True)
        with _no_interrupt():
            self._process.start()
        far.close()
        self._given: SimpleQueue[Any] = SimpleQueue()
        self._sender = threading.Thread(target=self._send, name="evaluation-beside", daemon=True)
        try:
            self._sender.start()
        except RuntimeError:
            self._process.kill()
            self._process.join()
            raise

    def give(self, what: Segment | tuple[EvaluationSettings | None, BenchCapability | None]) -> None:
        self._given.put(what)

    def result(self) -> AnyResult | None:
        """None where it could not be done there."""
        try:
            found: AnyResult = self._wire.recv()
        except Exception:
            # It has ended, or what came cannot be read: evaluated here, whatever is the matter is said.
            return None
        return found

    def close(self) -> None:
        self._process.kill()
        self._process.join()
        self._given.put(None)
        self._sender.join()
        self._wire.close()
        self._process.close()

    def _send(self) -> None:
        for what in iter(self._given.get, None):
            try:
                self._wire.send(what)
            except Exception:
                # It has ended, or this cannot be sent: result() is not to wait for what never comes.
                self._process.kill()
                return


@contextmanager
def _no_interrupt() -> Iterator[None]:
    """A process that is started within does not see Ctrl-C, which is for the run."""
    if not hasattr(signal, "pthread_sigmask"):
        yield
        return
    resource_tracker.ensure_running()  # its start would let the signal through again
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


def _work(wire: Connection, folder: Path, header: RecordingHeader) -> None:
    """The second process: ends with its work, or when the first one is gone."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    keep_memory()
    import scipy.special  # noqa: F401  what the reduction asks for at its first number

    import ahrs_lab.procedures.reduction  # noqa: F401
    from ahrs_lab.recording.read import ReadAhead

    ahead = ReadAhead(folder)
    try:
        while isinstance(given := wire.recv(), Segment):
            ahead.read(given, header)
        settings, capability = given
        wire.send(evaluate_bundle(folder, settings, capability, ahead))
    except (EOFError, AhrsLabError, OSError):
        return
