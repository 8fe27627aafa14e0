"""Starting an analysis and saying what came out: the same for each command.

Each command's options need this module, so it imports what is heavy only where an analysis is run.
"""

from __future__ import annotations

import argparse
import json
import sys
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from ahrs_lab.laboratory.analyses.kinds import AnalysisKind, Outcome, Value


def out_option(parser: argparse.ArgumentParser) -> None:
    """``--out DIR``, for :func:`run_kind`."""
    parser.add_argument("--out", type=Path, metavar="DIR", help="result, series and plots go there")


def run_kind(
    kind: AnalysisKind, bundles: Sequence[Path], settings: Mapping[str, Value], arguments: argparse.Namespace
) -> int:
    """Run ``kind`` with its defaults and these ``settings``; prints JSON or text, writes ``--out``."""
    from ahrs_lab.laboratory.analyses.files import write_outcome

    outcome = kind.run(bundles, {**kind.defaults(), **settings})
    show(
        outcome,
        write_outcome(outcome, arguments.out, bundles).values() if arguments.out is not None else (),
        arguments,
    )
    return 0


def show(outcome: Outcome, files: Iterable[Path], arguments: argparse.Namespace) -> None:
    """Print what came out, as text with the ``files`` that were written, or as one JSON object; then what
    stands against the numbers goes to standard error, for not every object has a place for it."""
    from ahrs_lab.analysis.report import report_text

    if arguments.json:
        for warning in outcome.report.warnings:
            sys.stderr.write(f"ahrs-lab: warning: {_printable(warning.text())}\n")
    text = _printable(report_text(outcome.report))
    written = ", ".join(str(path) for path in files)
    if written:
        text += f"\n\nFiles: {written}"
    print(json.dumps(outcome.data, ensure_ascii=False, allow_nan=False) if arguments.json else text)


def _printable(text: str) -> str:
    """Names in a report come from files of anybody: none may drive the terminal."""
    return "".join(c if c == "\n" or c.isprintable() else " " for c in text)
