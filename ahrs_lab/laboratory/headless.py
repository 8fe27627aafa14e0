"""A calibration without a screen: a plan on a bench, from the first mounting to the result's files."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from ahrs_lab.certificates.libraries import load_layout
from ahrs_lab.errors import AbortedError, AhrsLabError
from ahrs_lab.instruments.interfaces import Bench
from ahrs_lab.laboratory.evaluation import EvaluationSettings, write_files
from ahrs_lab.laboratory.evaluation_beside import EvaluationBeside
from ahrs_lab.laboratory.header import recording_header
from ahrs_lab.laboratory.live_run import LiveRun
from ahrs_lab.laboratory.results import AnyResult
from ahrs_lab.messages import Message
from ahrs_lab.metrology.conditions import BenchCapability
from ahrs_lab.procedures.events import Event
from ahrs_lab.procedures.plan import Plan, check_plan
from ahrs_lab.recording.samples import Samples

_LOOK_S = 0.2
"""A wait without an end cannot be interrupted on every system."""
_SAFE_LIMIT_S = 300.0
"""Wall time; making the bench safe has limits of its own, which are shorter."""


class InterruptedRunError(AbortedError):
    """The program itself was told to stop, at the keyboard or by the system."""

    exit_code = 130


def _unheard(_samples: Samples) -> None:
    """Nobody looks at the samples while they are recorded."""


@dataclass(frozen=True)
class HeadlessOutcome:
    """What a run left: the recording, its result, and the files by kind."""

    bundle: Path
    result: AnyResult
    files: dict[str, Path]


def run_plan(
    plan: Plan,
    bench: Bench,
    out: Path,
    *,
    on_event: Callable[[Event], None],
    settings: EvaluationSettings | None = None,
    capability: BenchCapability | None = None,
    again_from: str = "",
    reason: str = "",
    beside: bool = False,
) -> HeadlessOutcome:
    """Run ``plan`` on ``bench`` into ``out/recording``, evaluate it, leave result, plots and original record.

    A recording of the same plan that an earlier run left unfinished in ``out`` is gone on with. Raises what
    the run ended with; the bench is then safe and what was recorded is kept. ``again_from``: that segment and
    all that follow it are recorded, once more where they are there, for ``reason``. ``beside``: a second
    process may evaluate while the run goes on (:mod:`~ahrs_lab.laboratory.evaluation_beside`).
    """
    check_plan(plan, bench.table.limits)
    bundle = out / "recording"
    header = recording_header(bench, plan, capability=capability)
    run = LiveRun(bench, plan, bundle, header, on_event=on_event, on_samples=_unheard, ask=False)
    with EvaluationBeside(run, load_layout, allowed=beside) as evaluation:
        if again_from:
            run.start_from(again_from, reason)
        else:
            run.start()
        wait_for(run)
        result = evaluation.evaluate(bundle, settings, capability)
        return HeadlessOutcome(bundle, result, write_files(result, out))


def wait_for(run: LiveRun) -> None:
    """Wait for the end of a started run and raise what ended it early.

    A keyboard interrupt aborts the run, waits until the bench is safe, and comes out as InterruptedRunError.
    """
    try:
        while not run.join(_LOOK_S):
            pass
    except KeyboardInterrupt:
        run.abort(Message("interrupted at the keyboard"))
        _wait_until_safe(run)
        said = Message(
            "Interrupted: what was recorded is kept in {folder}. Give the same command again to go on.",
            folder=run.folder,
        )
        raise InterruptedRunError(said) from None
    if run.outcome is None:
        raise AhrsLabError("The run broke off.")
    run.outcome.raise_error()


def _wait_until_safe(run: LiveRun) -> None:
    """Pressing the keys again does not leave the table turning."""
    end = time.monotonic() + _SAFE_LIMIT_S
    while time.monotonic() < end:
        try:
            if run.join(_LOOK_S):
                return
        except KeyboardInterrupt:
            continue
