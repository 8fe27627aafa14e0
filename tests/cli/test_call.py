"""The call itself: help, unknown words, exit codes, one line for a fault."""

import subprocess
import sys
from pathlib import Path

import pytest

from ahrs_lab.cli import main

COMMANDS = ("demo", "run", "evaluate", "certificate", "verify", "export", "import")


@pytest.mark.parametrize("command", COMMANDS)
def test_each_command_explains_itself(command: str, capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as end:
        main([command, "--help"])
    assert end.value.code == 0
    assert command in capsys.readouterr().out


@pytest.mark.parametrize(
    "call",
    [
        ["fly"],
        ["evaluate"],
        ["evaluate", "x", "--uncertainty", "guess"],
        ["demo", "--speed", "0"],
        ["demo", "--speed", "fast"],
    ],
)
def test_a_wrong_call_is_one_line_and_exit_2(call: list[str], capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as end:
        main(call)
    captured = capsys.readouterr()
    assert end.value.code == 2
    assert captured.out == ""
    assert captured.err.count("\n") == 1


@pytest.mark.parametrize(
    "call",
    [
        ["evaluate", "/nowhere/at-all"],
        ["verify", "/nowhere/at-all.pdf"],
        ["certificate", "/nowhere.json", "--job", "/nowhere.toml", "--out", "/tmp/never.pdf"],
        ["run", "/nowhere.toml", "--bench", "/nowhere.toml", "--out", "/tmp/never"],
        ["import", "/nowhere/at-all"],
        ["export", "1999-0001", "/tmp/never"],
        ["demo", "--headless"],
        ["demo", "--out", "/tmp/never"],
    ],
)
def test_what_is_not_there_is_named_in_one_line(call: list[str], capsys: pytest.CaptureFixture[str]) -> None:
    assert main(call) == 2
    captured = capsys.readouterr()
    assert captured.out == ""
    assert captured.err.startswith("ahrs-lab: ")
    assert captured.err.count("\n") == 1


def test_help_needs_none_of_the_heavy_libraries() -> None:
    code = (
        "import sys; from ahrs_lab.cli import main\n"
        "try: main(['--help'])\n"
        "except SystemExit: pass\n"
        "heavy = {'numpy', 'scipy', 'PySide6', 'pyarrow', 'reportlab', 'pyhanko', 'sqlalchemy'}\n"
        "print(sorted(heavy & set(sys.modules)), file=sys.stderr)"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stderr.strip() == "[]"


def test_a_name_from_a_file_keeps_the_complaint_on_one_line(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["evaluate", str(tmp_path / "a\nb\x1b[2J")]) == 2
    said = capsys.readouterr().err
    assert said.count("\n") == 1
    assert "\x1b" not in said


WRITES = """
import sys
from ahrs_lab import cli
from ahrs_lab.cli import commands
commands.run = lambda arguments: print("a result") or 0
sys.exit(cli.main([]))
"""


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="there is no such device")
def test_output_that_the_disk_does_not_take_is_said_in_one_line() -> None:
    with Path("/dev/full").open("wb") as full:
        command = [sys.executable, "-c", WRITES]
        done = subprocess.run(command, stdout=full, stderr=subprocess.PIPE, check=False)
    assert done.returncode == 3
    assert done.stderr.count(b"\n") == 1
    assert b"not full" in done.stderr
