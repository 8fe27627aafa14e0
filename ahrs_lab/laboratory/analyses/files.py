"""What ``--out DIR`` and the Analysis page's “save” leave: result, series, plots, further files."""

from __future__ import annotations

import csv
from collections.abc import Sequence
from pathlib import Path

from ahrs_lab.laboratory.analyses.kinds import Outcome
from ahrs_lab.laboratory.evaluation import SOFTWARE, OutputFolder, write_json


def file_names(outcome: Outcome) -> tuple[str, ...]:
    """What :func:`write_outcome` will write."""
    series = ("series.csv",) if outcome.series else ()
    return ("result.json", *series, "plots.pdf", *outcome.saves)


def write_outcome(outcome: Outcome, folder: Path, bundles: Sequence[Path] = ()) -> dict[str, Path]:
    """``result.json``, ``series.csv`` where there is a series, ``plots.pdf`` (the report with its charts, in
    both languages), and what the analysis itself can save. ``bundles`` are named in the report."""
    from ahrs_lab.laboratory.analyses.report_document import save_report

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
        files["plots"] = folder / "plots.pdf"
        save_report(outcome.report, files["plots"], bundles=bundles, software=SOFTWARE)
        for name, save in outcome.saves.items():
            files[name] = folder / name
            save(files[name])
    return files
