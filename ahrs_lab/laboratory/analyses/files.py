"""What ``--out DIR`` and the Analysis page's “save” leave: result, series, further files."""

from __future__ import annotations

import csv
from pathlib import Path

from ahrs_lab.laboratory.analyses.kinds import Outcome
from ahrs_lab.laboratory.evaluation import OutputFolder, write_json


def write_outcome(outcome: Outcome, folder: Path) -> dict[str, Path]:
    """``result.json``, ``series.csv`` where there is a series, and what the analysis itself can save."""
    files = {"result": folder / "result.json"}
    with OutputFolder(folder):
        write_json(outcome.data, files["result"])
        if outcome.series:
            files["series"] = folder / "series.csv"
            with files["series"].open("w", encoding="utf-8", newline="") as file:
                writer = csv.writer(file)
                writer.writerow(outcome.series)
                columns = [values.tolist() for values in outcome.series.values()]
                writer.writerows(zip(*columns, strict=True))
        for name, save in outcome.saves.items():
            files[name] = folder / name
            save(files[name])
    return files
