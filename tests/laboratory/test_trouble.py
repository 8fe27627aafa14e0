"""Bad input and trouble, seen from outside: exit code, what is said, a safe bench, and what is kept.

``run`` reports its steps on standard error; what it fails by is the last line there.
"""

from __future__ import annotations

import errno
import os
import shutil
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

from ahrs_lab.cli import main
from ahrs_lab.instruments.interfaces import Bench
from tests.laboratory.short_run import (
    SEGMENTS,
    assert_safe,
    assert_same_results,
    call,
    counted,
    only_json,
    write_bench,
    write_plan,
)

Capture = pytest.CaptureFixture[str]
WELL = "-200.0, -100.0, -50.0, 25.0, 50.0, 100.0, 200.0"


def finished(folder: Path, capsys: Capture, undisturbed: dict[str, Any]) -> None:
    """The same call once the trouble is over goes on and ends as if there had been none."""
    capsys.readouterr()
    assert main(call(folder, "--json")) == 0
    bundle = folder / "out" / "recording"
    assert counted(bundle) == SEGMENTS
    assert_same_results(only_json(capsys.readouterr().out), undisturbed)


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        (WELL, "-200.0, -100.0, -50.0, 50.0, 100.0, 200.0", ["rates_dps", "6 rates", "7 to 11"]),
        (WELL, "-6, -5, -4, -3, -2, -1, 1, 2, 3, 4, 5, 6", ["rates_dps", "12 rates", "7 to 11"]),
        (WELL, WELL.replace("-200.0", "-1500.0"), ["rates_dps", "1500 °/s", "1000 °/s", "lower the rate"]),
        (WELL, WELL.replace("25.0", "0.0"), ["rates_dps", "0 °/s"]),
        ("static_s = 20.0", "static_s = 20.0\ndwell_s = 19.9", ["scale_factor.dwell_s", "19.9 s", "20"]),
        ("static_s = 20.0", "static_s = 5.0", ["scale_factor.static_s", "20"]),
        ("duration_s = 20.0", "duration_s = 19.0", ["zero_offset.duration_s", "20"]),
        ("turns = 2", "turns = 2.5", ["misalignment.turns", "2.5", "whole"]),
        ("turns = 2", "turns = 0", ["misalignment.turns", "whole"]),
        ("turns = 2", "turn = 2", ["turn", "misalignment"]),
        ("turns = 2", 'turns = "two"', ["misalignment.turns"]),
        ("turns = 2", "turns = ", ["plan.toml", "TOML"]),
    ],
)
def test_a_plan_that_cannot_be_run_is_refused_before_anything_moves(
    tmp_path: Path, capsys: Capture, old: str, new: str, words: list[str]
) -> None:
    write_plan(tmp_path, old, new)
    write_bench(tmp_path)
    assert main(call(tmp_path)) == 2
    captured = capsys.readouterr()
    assert captured.out == ""
    assert captured.err.count("\n") == 1
    for word in words:
        assert word in captured.err
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("max_rate_dps = 1000.0", "max_rate_dps = 150.0", ["200 °/s", "150 °/s", "lower the rate"]),
        ("sample_rate_hz = 100.0", "sample_rate_hz = 5.0", ["5 samples per second", "10"]),
        ('kind = "simulated"', 'kind = "real"', ["bench.toml", "simulated", "real"]),
        ("seed = 1536", "sead = 1536", ["sead", "seed"]),
    ],
)
def test_a_bench_that_cannot_do_it_is_refused_before_anything_moves(
    tmp_path: Path, capsys: Capture, old: str, new: str, words: list[str]
) -> None:
    write_plan(tmp_path)
    write_bench(tmp_path, old=old, new=new)
    assert main(call(tmp_path)) == 2
    captured = capsys.readouterr()
    assert captured.out == ""
    assert captured.err.count("\n") == 1
    for word in words:
        assert word in captured.err
    assert not list(tmp_path.glob("out/recording/segments/*"))


FIRST_MOUNTING = frozenset({"zo_x_1", "zo_x_3"})
UNTIL_THE_RATES = FIRST_MOUNTING | {"sf_x_before", "sf_x_03", "sf_x_04"}


@pytest.mark.parametrize(
    ("fault", "words", "kept", "interrupted"),
    [
        (
            'name = "table_trips"\nat_s = 300.0',
            ["rate table reports a fault", "Find its cause", "is kept"],
            UNTIL_THE_RATES,
            True,
        ),
        (
            'name = "table_never_settles"\nat_s = 300.0',
            ["has not held 100 °/s", "Check its load"],
            UNTIL_THE_RATES | {"sf_x_02"},
            False,
        ),
        (
            'name = "supply_never_settles"\nat_s = 100.0',
            ["supply current has not settled within 300 s", "Check the cable"],
            FIRST_MOUNTING,
            False,
        ),
        (
            'name = "wrong_mounting"\nat_s = 100.0',
            ["Asked: X up", "feels Z up", "tilt 90.0°", "Turn the case"],
            FIRST_MOUNTING,
            False,
        ),
        (
            'name = "ahrs_silent"\nat_s = 300.0',
            ["has sent nothing for", "data cable", "is kept"],
            UNTIL_THE_RATES,
            True,
        ),
    ],
)
def test_an_instrument_in_trouble_ends_the_run_safely_and_it_goes_on_afterwards(
    tmp_path: Path,
    capsys: Capture,
    benches: list[Bench],
    undisturbed: dict[str, Any],
    fault: str,
    words: list[str],
    kept: frozenset[str],
    interrupted: bool,
) -> None:
    write_plan(tmp_path)
    write_bench(tmp_path, fault)
    assert main(call(tmp_path, "--json")) == 3
    captured = capsys.readouterr()
    assert captured.out == ""
    said = captured.err.splitlines()[-1]
    assert said.startswith("ahrs-lab: ")
    for word in words:
        assert word in said
    assert "Traceback" not in captured.err
    assert_safe(benches[-1])
    bundle = tmp_path / "out" / "recording"
    assert counted(bundle) == kept
    broken_off = list(bundle.glob("segments/sf_x_02.parquet")) if interrupted else []
    before = {path.name: path.read_bytes() for path in bundle.glob("segments/*")}
    assert len(before) == len(kept) + len(broken_off)

    write_bench(tmp_path)
    finished(tmp_path, capsys, undisturbed)
    for name, content in before.items():
        assert (bundle / "segments" / name).read_bytes() == content


def test_where_a_table_that_runs_away_cannot_be_stopped_it_is_said_and_the_supply_is_off(
    tmp_path: Path, capsys: Capture, benches: list[Bench]
) -> None:
    write_plan(tmp_path)
    write_bench(tmp_path, 'name = "table_runs_away"\nat_s = 300.0')
    assert main(call(tmp_path)) == 3
    said = capsys.readouterr().err
    assert "warning: The table could not be stopped (it is still turning): use its own stop button." in said
    last = said.splitlines()[-1]
    assert last.startswith("ahrs-lab: The table could not be stopped (it is still turning)")
    assert "The table turns the wrong way: it turns at" in last
    assert "emergency stop" in last
    assert "widen" not in last
    assert not benches[-1].supply.read().output_on
    assert not benches[-1].table.state().enabled
    assert counted(tmp_path / "out" / "recording") == UNTIL_THE_RATES | {"sf_x_02"}


def test_a_wrong_mounting_that_is_put_right_is_asked_for_again_and_not_recorded(
    tmp_path: Path, capsys: Capture, undisturbed: dict[str, Any]
) -> None:
    write_plan(tmp_path)
    write_bench(tmp_path, 'name = "wrong_mounting"\nonce = true')
    assert main(call(tmp_path, "--json")) == 0
    captured = capsys.readouterr()
    assert_same_results(only_json(captured.out), undisturbed)
    assert counted(tmp_path / "out" / "recording") == SEGMENTS


def test_lost_samples_are_named_and_below_the_minimum_nothing_is_evaluated(
    tmp_path: Path, capsys: Capture
) -> None:
    write_plan(tmp_path)
    write_bench(tmp_path, 'name = "ahrs_dropouts"\nat_s = 300.0')
    assert main(call(tmp_path)) == 2
    captured = capsys.readouterr()
    assert captured.out == ""
    assert "were lost on the way" in captured.err
    assert "fewer than the 20.0 s" in captured.err.splitlines()[-1]
    assert counted(tmp_path / "out" / "recording") == SEGMENTS


def test_a_full_disk_keeps_what_was_recorded(
    tmp_path: Path,
    capsys: Capture,
    benches: list[Bench],
    undisturbed: dict[str, Any],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    write_plan(tmp_path)
    write_bench(tmp_path)
    calls = iter(range(10_000))

    def until_full(descriptor: int) -> None:
        if next(calls) >= 12:
            raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    with monkeypatch.context() as patch:
        patch.setattr(os, "fsync", until_full)
        assert main(call(tmp_path)) == 3
    said = capsys.readouterr().err.splitlines()[-1]
    assert "is full" in said
    assert "make room and resume" in said
    assert_safe(benches[-1])
    kept = counted(tmp_path / "out" / "recording")
    assert kept
    assert kept < SEGMENTS
    finished(tmp_path, capsys, undisturbed)


@pytest.fixture
def small_disk(tmp_path: Path) -> Iterator[Callable[[str], Path]]:
    """A file system of its own; called with mount options, again to change them. Needs the right to mount."""
    place = tmp_path / "disk"
    place.mkdir()
    mount, umount = shutil.which("mount"), shutil.which("umount")
    if mount is None or umount is None or not hasattr(os, "geteuid") or os.geteuid() != 0:
        pytest.skip("only root mounts a file system")
    mounted = False

    def disk(options: str) -> Path:
        nonlocal mounted
        how = f"remount,{options}" if mounted else options
        done = subprocess.run(
            [mount, "-t", "tmpfs", "-o", how, "tmpfs", str(place)], capture_output=True, check=False
        )
        if done.returncode:
            pytest.skip("mounting is not allowed here")
        mounted = True
        return place

    yield disk
    if mounted:
        subprocess.run([umount, str(place)], check=True)


def test_a_really_full_and_then_a_read_only_disk(
    small_disk: Callable[[str], Path],
    capsys: Capture,
    benches: list[Bench],
    undisturbed: dict[str, Any],
) -> None:
    disk = small_disk("size=600k")
    write_plan(disk)
    write_bench(disk)
    assert main(call(disk)) == 3
    said = capsys.readouterr().err.splitlines()[-1]
    assert "is full" in said
    assert str(disk / "out" / "recording") in said
    assert_safe(benches[-1])
    kept = counted(disk / "out" / "recording")
    assert kept
    small_disk("size=40m")
    finished(disk, capsys, undisturbed)

    small_disk("size=40m,ro")
    for words in (
        call(disk),
        [*call(disk)[:-1], str(disk / "elsewhere")],
        ["evaluate", str(disk / "out" / "recording"), "--out", str(disk / "evaluated")],
        ["demo", "--headless", "--out", str(disk / "demo")],
    ):
        assert main(words) == 3
        captured = capsys.readouterr()
        assert captured.out == ""
        assert captured.err.count("\n") == 1
        assert "choose another folder" in captured.err
    assert main(["evaluate", str(disk / "out" / "recording"), "--json"]) == 0
    only_json(capsys.readouterr().out)


def test_a_file_where_the_folder_should_be_is_named(tmp_path: Path, capsys: Capture) -> None:
    write_plan(tmp_path)
    write_bench(tmp_path)
    (tmp_path / "out").write_text("", encoding="utf-8")
    assert main(call(tmp_path)) == 3
    captured = capsys.readouterr()
    assert captured.err.count("\n") == 1
    assert "choose another folder" in captured.err


def test_a_folder_of_another_plan_is_not_gone_on_with(tmp_path: Path, capsys: Capture) -> None:
    write_plan(tmp_path)
    write_bench(tmp_path, 'name = "wrong_mounting"\nat_s = 100.0')
    assert main(call(tmp_path)) == 3
    before = {path: path.read_bytes() for path in (tmp_path / "out").rglob("*") if path.is_file()}
    write_plan(tmp_path, "turns = 2", "turns = 3")
    capsys.readouterr()
    assert main(call(tmp_path)) == 2
    captured = capsys.readouterr()
    assert captured.err.count("\n") == 1
    assert "another device, site or plan" in captured.err
    assert {path: path.read_bytes() for path in before} == before


@pytest.mark.skipif(sys.platform == "win32", reason="the message of a locked folder differs")
def test_a_second_demonstration_does_not_move_a_running_recording(tmp_path: Path, capsys: Capture) -> None:
    from ahrs_lab.recording.folder_lock import FolderLock

    plan = write_plan(tmp_path)
    bundle = tmp_path / "out" / "recording"
    bundle.mkdir(parents=True)
    lock = FolderLock(bundle)
    try:
        assert main(["demo", "--headless", "--plan", str(plan), "--out", str(tmp_path / "out")]) == 2
    finally:
        lock.release()
    captured = capsys.readouterr()
    assert captured.err.count("\n") == 1
    assert "another instance" in captured.err
    assert bundle.is_dir()
