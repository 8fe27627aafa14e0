"""Benches and plans from TOML: a file, or the text that a job keeps."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from ahrs_lab.errors import InputError
from ahrs_lab.instruments.interfaces import Bench
from ahrs_lab.procedures.plan import Plan, plan_from_toml
from ahrs_lab.recording.toml_table import parse_toml
from ahrs_lab.resource_files import resource_path

_LARGEST_FILE = 1_000_000


def load_bench(path: Path, *, speed: float | None = None) -> Bench:
    """The bench of ``BENCH.toml``; ``speed`` is bench time over wall time of a simulated one (None: no
    waiting)."""
    try:
        with path.open("rb") as file:
            data = file.read(_LARGEST_FILE + 1)
        text = data.decode("utf-8-sig")
    except OSError as error:
        raise InputError(
            "The bench file {path} cannot be read ({reason}).", path=path, reason=error.strerror or str(error)
        ) from error
    except UnicodeDecodeError as error:
        raise InputError("The bench file {path} is not UTF-8 text.", path=path) from error
    if len(data) > _LARGEST_FILE:
        raise InputError("The bench file {path} is too large for one: check its path.", path=path)
    return bench_from_text(text, str(path), speed=speed)


def bench_from_text(text: str, source: str, *, speed: float | None = None) -> Bench:
    """The bench that ``text`` describes; ``source`` names it in messages."""
    return bench_from_toml(_parsed(text, source), source, speed=speed)


def _parsed(text: str, source: str) -> dict[str, Any]:
    try:
        return parse_toml(text)
    except ValueError as error:
        raise InputError("{source} is not valid TOML: {reason}.", source=source, reason=str(error)) from error


def bench_from_toml(data: dict[str, Any], source: str, *, speed: float | None = None) -> Bench:
    """The bench of a TOML document; ``kind`` says what it is made of."""
    kind = data.get("kind", "simulated")
    if kind == "instruments":
        from ahrs_lab.laboratory.home import home_folder
        from ahrs_lab.laboratory.supervised_bench import supervised_bench

        return supervised_bench(data, source, speed=speed, report=home_folder() / "supervisor.jsonl")
    if kind != "simulated":
        raise InputError(
            "{source}: there are benches of kind “simulated” and “instruments”, not “{kind}”.",
            source=source,
            kind=kind,
        )
    from ahrs_lab.simulation.bench import build_bench
    from ahrs_lab.simulation.settings import simulation_from_toml

    settings = {key: value for key, value in data.items() if key not in ("kind", "serve")}
    return build_bench(simulation_from_toml(settings), speed=speed)


def is_simulated(text: str) -> bool:
    """Whether the bench that ``text`` describes is not real; what cannot be read counts as real."""
    try:
        data = parse_toml(text)
    except ValueError:
        return False
    operator = data.get("operator")
    served = isinstance(operator, dict) and operator.get("kind") == "simulated-hands"
    return served or data.get("kind", "simulated") == "simulated"


def plan_from_text(text: str, source: str) -> Plan:
    """The plan that a job keeps; ``source`` names it in messages."""
    return plan_from_toml(_parsed(text, source))


def bench_presets() -> dict[str, str]:
    """Bench files that come along, name → text."""
    return _texts("benches")


def plan_presets() -> dict[str, str]:
    """Plans that come along, name → text."""
    return _texts("plans")


def _texts(folder: str) -> dict[str, str]:
    return {
        path.stem: path.read_text(encoding="utf-8") for path in sorted(resource_path(folder).glob("*.toml"))
    }
