"""The command line: the commands, options, JSON and exit codes that people script against.

``main`` only reads the call; what a command does stands in :mod:`ahrs_lab.cli.commands`, imported when one is
asked for, so that ``--help`` answers at once.

Exit codes: 0 done; 1 done, but the answer is no; 2 the input or the call is at fault; 3 an instrument or the
machine failed; 130 interrupted by the person.
"""

from __future__ import annotations

import argparse
import os
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import NoReturn

import ahrs_lab
from ahrs_lab.cli.analysis import commands as analysis_commands
from ahrs_lab.errors import AhrsLabError

INTERRUPTED = 130


class _Parser(argparse.ArgumentParser):
    """One line for a wrong call, as for every other fault of the input."""

    def error(self, message: str) -> NoReturn:
        sys.stderr.write(f"{self.prog}: {message}; see “{self.prog} --help”.\n")
        raise SystemExit(2)


def _speed(text: str) -> float | None:
    """A factor over real time; None for ``max``: as fast as the machine can."""
    if text == "max":
        return None
    try:
        factor = float(text)
    except ValueError:
        factor = 0.0
    if not 0 < factor <= 1e6:
        raise argparse.ArgumentTypeError(f"“{text}” is not a speed: a factor above 0 such as 60, or max")
    return factor


def _trials(text: str) -> int:
    """A whole number; which ones can be made is known where they are made."""
    if text.isascii() and text.isdecimal() and len(text) <= 20:
        return int(text)
    from ahrs_lab.metrology.uncertainty.monte_carlo import BLOCK, MAXIMAL_TRIALS

    raise argparse.ArgumentTypeError(
        f"“{text}” is not a number of trials: a whole number from {BLOCK} to {MAXIMAL_TRIALS}, or 0 for none"
    )


def _parser() -> argparse.ArgumentParser:
    parser = _Parser(
        prog="ahrs-lab",
        description="Calibration of attitude and heading reference systems to JJF 1536-2015. "
        "Without a command the application opens.",
    )
    parser.add_argument("--version", action="version", version=f"ahrs-lab {ahrs_lab.__version__}")
    commands = parser.add_subparsers(dest="command", metavar="COMMAND", parser_class=_Parser)

    def command(name: str, text: str) -> argparse.ArgumentParser:
        made = commands.add_parser(name, help=text, description=text)
        made.add_argument("--json", action="store_true", help="one JSON object on standard output")
        return made

    demo = command("demo", "The demonstration laboratory on a simulated bench, ready to run.")
    demo.add_argument("--language", choices=("en", "zh"), help="language of screen and texts")
    demo.add_argument("--speed", type=_speed, metavar="N|max", help="bench time over wall time")
    demo.add_argument("--headless", action="store_true", help="the whole calibration without a screen")
    demo.add_argument(
        "--out", type=Path, metavar="DIR", help="where a headless demonstration leaves its files"
    )
    demo.add_argument("--plan", type=Path, metavar="PLAN.toml", help="another plan than the standard one")

    run = command("run", "Runs a plan on a bench without a screen and evaluates it.")
    run.add_argument("plan", type=Path, metavar="PLAN.toml")
    run.add_argument("--bench", type=Path, required=True, metavar="BENCH.toml")
    run.add_argument("--out", type=Path, required=True, metavar="DIR")
    run.add_argument("--speed", type=_speed, default=None, metavar="N|max", help="of a simulated bench (max)")
    run.add_argument(
        "--from", dest="again_from", default="", metavar="SEGMENT", help="record from there on again"
    )
    run.add_argument("--reason", default="", metavar="TEXT", help="why, with --from: it goes into the record")
    _evaluation_options(run)

    evaluate = command("evaluate", "Reduces a recording: results with uncertainty, plots, original record.")
    evaluate.add_argument("bundle", type=Path, metavar="BUNDLE")
    evaluate.add_argument("--out", type=Path, metavar="DIR")
    _strict_option(evaluate)
    _evaluation_options(evaluate)

    certificate = command("certificate", "Lays a certificate out from a result and a job.")
    certificate.add_argument("result", type=Path, metavar="RESULT")
    certificate.add_argument("--job", type=Path, required=True, metavar="JOB.toml")
    certificate.add_argument("--out", type=Path, required=True, metavar="FILE.pdf")
    certificate.add_argument("--language", choices=("bilingual", "zh", "en"), default="bilingual")
    _strict_option(certificate)
    certificate.add_argument(
        "--budget-annex", action="store_true", help="every uncertainty budget in full on annex pages"
    )

    verify = command("verify", "Who signed a certificate, when, and whether anything changed since.")
    verify.add_argument("file", type=Path, metavar="FILE.pdf")
    verify.add_argument(
        "--trust",
        type=Path,
        action="append",
        default=[],
        metavar="ROOT.pem",
        help="a root certificate to trust beside the laboratory's own",
    )

    export = command("export", "Writes a job's recording out of the records.")
    export.add_argument("job", metavar="JOB")
    export.add_argument("dir", type=Path, metavar="DIR")

    take_in = command("import", "Takes a recording into the records.")
    take_in.add_argument("bundle", type=Path, metavar="BUNDLE")

    simulate = command("simulate", "Serves simulated instruments in their real protocols, and says where.")
    simulate.add_argument("--bench", type=Path, required=True, metavar="BENCH.toml")
    simulate.add_argument(
        "--ahrs", choices=("vectornav", "xsens", "microstrain"), help="protocol of the unit (vectornav)"
    )
    simulate.add_argument("--tcp", action="store_true", help="the unit on TCP, not on a pseudo-terminal")
    simulate.add_argument(
        "--fixed-ports", action="store_true", help="the ports of the bench demo-linked, on TCP"
    )
    simulate.add_argument("--faults", default="", metavar="NAME=VALUE,…", help="what goes wrong, how much")
    simulate.add_argument("--speed", type=float, default=1.0, metavar="N", help="bench over wall time (1)")
    simulate.add_argument(
        "--write-bench", type=Path, metavar="FILE.toml", help="bench file for “ahrs-lab run” on these ports"
    )

    replay = command("replay", "Decodes raw bytes of a link as the live driver would.")
    replay.add_argument("raw", type=Path, metavar="RAW")
    replay.add_argument(
        "--protocol",
        required=True,
        metavar="NAME",
        help="vectornav, xsens, mip, anpp, nmea, or a FILE.toml that describes a private format",
    )
    replay.add_argument("--rate", type=float, metavar="HZ", help="sample rate where the device sends no time")
    replay.add_argument("--latitude", type=float, default=0.0, metavar="DEG", help="of the bench, for --out")
    replay.add_argument("--out", type=Path, metavar="BUNDLE", help="write the samples as a recording")

    for analysis in analysis_commands():
        analysis.options(command(analysis.NAME, analysis.HELP))
    return parser


def _strict_option(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "--strict",
        action="store_true",
        help="exit 1 where a value is out of specification; a conditional pass exits 0",
    )


def _evaluation_options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "--rates",
        choices=("demanded", "table"),
        default="demanded",
        help="Ω: the demanded rates, or the table's angle over time",
    )
    parser.add_argument("--uncertainty", choices=("gum", "annex-a"), default="gum")
    parser.add_argument(
        "--job",
        type=Path,
        metavar="JOB.toml",
        help="job sheet: its standards' figures for the budgets; evaluate: its limits and capability too",
    )
    parser.add_argument(
        "--trials",
        type=_trials,
        metavar="N",
        help="of the Monte Carlo check of each uncertainty (as many as it needs; 0: without)",
    )


def _one_line(text: str) -> str:
    """Names in a message may come from files of anybody: none may drive the terminal or break the line."""
    return "".join(c if c.isprintable() else " " if c.isspace() else "�" for c in text)


def main(argv: Sequence[str] | None = None) -> int:
    """Run one command; returns the exit code."""
    for stream in (sys.stdout, sys.stderr):
        reconfigure = getattr(stream, "reconfigure", None)
        if reconfigure is not None:  # a Windows console's code page lacks ° and Chinese
            reconfigure(encoding="utf-8", errors="replace")
    # Our matrices are small: threads of the linear algebra would only keep a core busy waiting, and rounding
    # would depend on how many there are.
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    arguments = _parser().parse_args(argv)
    try:
        from ahrs_lab.cli import commands

        code = commands.run(arguments)
        sys.stdout.flush()
        return code
    except AhrsLabError as error:
        sys.stderr.write(f"ahrs-lab: {_one_line(error.message.text())}\n")
        return error.exit_code
    except MemoryError:
        sys.stderr.write("ahrs-lab: The memory of this machine is not enough for this file.\n")
        return AhrsLabError.exit_code
    except KeyboardInterrupt:
        sys.stderr.write("ahrs-lab: interrupted\n")
        return INTERRUPTED
    except BrokenPipeError:  # whoever read our output has gone; nothing is wrong
        _forget_output()
        return 0
    except OSError as error:  # what no room expected: standard output on a full disk, say
        _forget_output()
        where = _one_line(f"{error.filename}: " if error.filename else "")
        sys.stderr.write(
            f"ahrs-lab: {where}{error.strerror or error}. See that the disk is writable and not full.\n"
        )
        return AhrsLabError.exit_code


def _forget_output() -> None:
    """What is left of it would be written when Python ends, and fail once more."""
    os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
