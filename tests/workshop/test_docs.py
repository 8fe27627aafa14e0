"""What README, CONTRIBUTING and docs/ name has to exist: files, modules, commands, options, settings."""

from __future__ import annotations

import argparse
import importlib
import importlib.util
import re
from dataclasses import fields, is_dataclass
from pathlib import Path

import pytest

from ahrs_lab import cli
from ahrs_lab.procedures.plan import Plan
from ahrs_lab.simulation.faults import FAULT_NAMES

ROOT = Path(__file__).resolve().parents[2]
PAGES = [
    "README.md",
    "CONTRIBUTING.md",
    "CHANGELOG.md",
    *(f"docs/{p.name}" for p in (ROOT / "docs").glob("*.md")),
]
ROOMS = ("ahrs_lab", "resources", "tests", "packaging", "benchmarks", "docs", ".ci")
LONGEST_PAGE = 120


@pytest.fixture(params=sorted(PAGES))
def page(request: pytest.FixtureRequest) -> Path:
    return ROOT / str(request.param)


def text_of(page: Path) -> str:
    return page.read_text(encoding="utf-8")


def code_of(page: Path) -> list[str]:
    """Every piece of code in the text: in backquotes, or in a fenced block."""
    blocks = re.findall(r"^```\w*\n(.*?)^```", text_of(page), re.MULTILINE | re.DOTALL)
    without = re.sub(r"^```.*?^```", "", text_of(page), flags=re.MULTILINE | re.DOTALL)
    lines = [line for block in blocks for line in block.splitlines()]
    return [*lines, *re.findall(r"`([^`\n]+)`", without)]


def commands() -> dict[str, set[str]]:
    """Each command of ``ahrs-lab`` with its options, and those of what it is divided into."""
    return {name: options_of(parser) for name, parser in parts_of(cli._parser()).items()}


def parts_of(parser: argparse.ArgumentParser) -> dict[str, argparse.ArgumentParser]:
    return {
        name: part
        for action in parser._actions
        if isinstance(action, argparse._SubParsersAction)
        for name, part in action.choices.items()
    }


def options_of(parser: argparse.ArgumentParser) -> set[str]:
    own = {option for action in parser._actions for option in action.option_strings}
    return own.union(*map(options_of, parts_of(parser).values()))


def test_pages_are_short_and_listed() -> None:
    index = text_of(ROOT / "docs/README.md")
    for path in (ROOT / "docs").glob("*.md"):
        written = re.sub(r"<!-- table: begin -->.*<!-- table: end -->", "", text_of(path), flags=re.DOTALL)
        assert len(written.splitlines()) <= LONGEST_PAGE, path.name
        if path.name != "README.md":
            assert f"]({path.name})" in index, path.name


def test_links_lead_somewhere(page: Path) -> None:
    links = re.findall(r"\]\(([^)#]+)", text_of(page))
    local = [link for link in links if not re.match(r"\w+:", link)]
    assert [link for link in local if not (page.parent / link).exists()] == []


def test_files_that_are_named_exist(page: Path) -> None:
    named = {
        word.rstrip(".,:;)")
        for code in code_of(page)
        for word in re.findall(r"(?<![\w/.<])[\w.][\w./*-]*", code)
        if word.split("/")[0] in ROOMS and "/" in word
    }
    missing = [name for name in named if not list(ROOT.glob(name.rstrip("/")))]
    assert missing == []


def test_modules_and_names_in_them_exist(page: Path) -> None:
    for dotted in {name for code in code_of(page) for name in re.findall(r"\bahrs_lab(?:\.\w+)+", code)}:
        module, _, last = dotted.rpartition(".")
        is_module = importlib.util.find_spec(module) and importlib.util.find_spec(dotted)
        assert is_module or hasattr(importlib.import_module(module), last), dotted


def test_commands_and_options_that_are_named_exist(page: Path) -> None:
    known = commands()
    every = set().union(*known.values())
    for code in code_of(page):
        match = re.search(r"\bahrs-lab ([a-z][a-z-]*)(.*)", code)
        if match:
            assert match[1] in known, code
            assert set(re.findall(r"--[a-z][a-z0-9-]*", match[2])) <= known[match[1]], code
        elif code.startswith("--"):
            assert set(re.findall(r"(?<![\w-])--[a-z][a-z0-9-]*", code)) <= every, code


def settings() -> set[str]:
    """Every setting of a plan, with its table's name in front."""
    found = {field.name for field in fields(Plan)}
    for field in fields(Plan):
        part = getattr(Plan(), field.name)
        if is_dataclass(part):
            found |= {f"{field.name}.{inner.name}" for inner in fields(part)}
    return found


def test_settings_and_faults_that_are_named_exist() -> None:
    known = settings()
    tables = {name.split(".")[0] for name in known if "." in name}
    for page in ("docs/procedures.md", "docs/metrology.md"):
        for code in code_of(ROOT / page):
            if re.fullmatch(r"\w+\.\w+", code) and code.split(".")[0] in tables:
                assert code in known
    named = re.findall(r"^\| `(\w+)` \|", text_of(ROOT / "docs/simulation.md"), re.MULTILINE)
    assert set(named) == set(FAULT_NAMES)


def test_every_command_and_option_is_on_the_page_of_the_command_line() -> None:
    text = text_of(ROOT / "docs/laboratory.md")
    for command, options in commands().items():
        assert f"`ahrs-lab {command}" in text, command
        for option in options - {"-h", "--help"}:
            assert option in text, (command, option)
