"""Starting an analysis and saying what came out: the same for each command."""

from __future__ import annotations

import argparse
import json
from collections.abc import Mapping, Sequence
from pathlib import Path

from ahrs_lab.analysis.report import report_text
from ahrs_lab.laboratory.analyses.files import write_outcome
from ahrs_lab.laboratory.analyses.kinds import AnalysisKind, Value


def out_option(parser: argparse.ArgumentParser) -> None:
    """``--out DIR``, for :func:`run_kind`."""
    parser.add_argument("--out", type=Path, metavar="DIR", help="result, series and plots go there")


def run_kind(
    kind: AnalysisKind, bundles: Sequence[Path], settings: Mapping[str, Value], arguments: argparse.Namespace
) -> int:
    """Run ``kind`` with its defaults and these ``settings``; prints JSON or text, writes ``--out``."""
    outcome = kind.run(bundles, {**kind.defaults(), **settings})
    text = report_text(outcome.report)
    if arguments.out is not None:
        files = write_outcome(outcome, arguments.out)
        text += "\n\nFiles: " + ", ".join(str(path) for path in files.values())
    print(json.dumps(outcome.data, ensure_ascii=False, allow_nan=False) if arguments.json else text)
    return 0
