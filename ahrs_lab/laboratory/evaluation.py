"""From a recording to its result and the files that show it; the live run and ``evaluate`` both come here, so
they give the same numbers."""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

import ahrs_lab
from ahrs_lab.errors import InputError, MachineError
from ahrs_lab.laboratory.results import AnyResult, from_json, to_json
from ahrs_lab.metrology.conditions import BenchCapability
from ahrs_lab.metrology.imu_result import PROCEDURE as IMU_PROCEDURE
from ahrs_lab.metrology.imu_result import ImuResult

if TYPE_CHECKING:
    from ahrs_lab.recording.read import ReadAhead

SOFTWARE = f"ahrs-lab {ahrs_lab.__version__}"
MAXIMAL_RESULT_BYTES = 64 * 2**20


@dataclass(frozen=True)
class EvaluationSettings:
    """What the person chooses: Ω from the demand or the table, the method of uncertainty, and the trials of
    its Monte Carlo check (None: as many as it needs; 0: without)."""

    rates: Literal["demanded", "table"] = "demanded"
    uncertainty: Literal["gum", "annex-a"] = "gum"
    trials: int | None = None
    repeatability: bool = False
    """U of B includes what B may be another day, as the job asks."""


Evaluate = Callable[[Path, EvaluationSettings | None, BenchCapability | None], AnyResult]
"""From a recording, what the person chose and the bench's figures to the result."""


def evaluate_bundle(
    bundle: Path,
    settings: EvaluationSettings | None = None,
    capability: BenchCapability | None = None,
    ahead: ReadAhead | None = None,
) -> AnyResult:
    """Read ``bundle`` (folder or ``.ahrsrec``) with all its checks and reduce it by the procedure it was
    recorded for; ``settings`` are of JJF 1536.

    ``capability``: the bench's figures; None: those that the recording names, else clause 6's own.
    ``ahead``: what was read of the folder before.
    """
    from ahrs_lab.procedures.reduction import reduce_recording
    from ahrs_lab.recording.read import read_bundle

    recording = read_bundle(bundle, ahead)
    if recording.header.procedure == IMU_PROCEDURE:
        from ahrs_lab.laboratory.imu_evaluation import evaluate_imu

        return evaluate_imu(recording, capability, SOFTWARE)
    settings = settings or EvaluationSettings()
    return reduce_recording(
        recording,
        rates=settings.rates,
        uncertainty=settings.uncertainty,
        capability=capability,
        software=SOFTWARE,
        trials=settings.trials,
        repeatability=settings.repeatability,
    )


def write_files(result: AnyResult, folder: Path, *, record: bool = True) -> dict[str, Path]:
    """Leave ``result.json``, ``budget.csv``, ``plots.pdf`` and, with ``record``, ``original-record.pdf`` in
    ``folder``; returns where they are. Of an IMU the result, which is its calibration set, and the record."""
    from ahrs_lab.certificates.original_record import original_record_pdf
    from ahrs_lab.certificates.plots import plots_pdf
    from ahrs_lab.laboratory.budget_csv import save_budget_csv

    files = {"result": folder / "result.json"}
    with OutputFolder(folder):
        write_json(to_json(result), files["result"])
        if not isinstance(result, ImuResult):
            files |= {"budget": folder / "budget.csv", "plots": folder / "plots.pdf"}
            save_budget_csv(result, files["budget"])
            plots_pdf(result, files["plots"])
        if record:
            files["original_record"] = folder / "original-record.pdf"
            original_record_pdf(result, files["original_record"])
    return files


def write_json(data: dict[str, Any], target: Path) -> None:
    """Strict JSON, readable, whole or not at all."""
    partial = target.with_name(target.name + ".part")
    partial.write_text(
        json.dumps(data, ensure_ascii=False, indent=1, allow_nan=False) + "\n", encoding="utf-8"
    )
    partial.replace(target)


def read_result(path: Path) -> AnyResult:
    """A result file written earlier; from outside, so it is checked."""
    try:
        with path.open("rb") as file:
            text = file.read(MAXIMAL_RESULT_BYTES + 1)
        if len(text) > MAXIMAL_RESULT_BYTES:
            raise InputError("{path} is too large for a result: is it the right file?", path=path)
        data = json.loads(text.decode("utf-8"))
    except OSError as error:
        raise InputError("{path} cannot be read ({reason}).", path=path, reason=error.strerror) from error
    except (ValueError, RecursionError) as error:
        raise InputError(
            "{path} is not a result: it is not JSON ({reason}). Give the result.json that “evaluate” wrote.",
            path=path,
            reason=str(error),
        ) from error
    if not isinstance(data, dict):
        raise InputError("{path} is not a result: it holds no JSON object.", path=path)
    return from_json(data)


class OutputFolder:
    """``with OutputFolder(path)``: the folder exists, and what the machine refuses is said in plain
    words."""

    def __init__(self, path: Path) -> None:
        self._path = path

    def __enter__(self) -> Path:
        try:
            self._path.mkdir(parents=True, exist_ok=True)
        except OSError as error:
            raise self._refused(error) from error
        return self._path

    def __exit__(self, kind: object, error: BaseException | None, trace: object) -> None:
        if isinstance(error, OSError):
            raise self._refused(error) from error

    def _refused(self, error: OSError) -> MachineError:
        return MachineError(
            "Cannot write into {path}: {reason}. Free space or choose another folder; nothing recorded is "
            "lost.",
            path=self._path,
            reason=error.strerror or str(error),
        )
