"""What comes into the laboratory from outside, and several instances that start at once."""

from __future__ import annotations

import json
import sys
import threading
from pathlib import Path

import pytest

from ahrs_lab.errors import InputError, MachineError
from ahrs_lab.laboratory import demonstration, exchange
from ahrs_lab.laboratory.benches import load_bench
from ahrs_lab.laboratory.evaluation import read_result
from ahrs_lab.laboratory.laboratory import Laboratory
from ahrs_lab.procedures.plan import load_plan
from tests.recording.making import four_positions, write_bundle


def test_a_link_in_a_recording_brings_nothing_in(tmp_path: Path) -> None:
    secret = tmp_path / "secret"
    secret.write_text("private", encoding="utf-8")
    bundle = write_bundle(tmp_path / "bundle", four_positions())
    try:
        (bundle / "notes.txt").symlink_to(secret)
    except OSError:
        pytest.skip("this machine makes no links")
    with Laboratory(tmp_path / "home") as laboratory:
        with pytest.raises(InputError, match=r"notes\.txt"):
            laboratory.import_bundle(bundle)
        assert laboratory.jobs() == ()
    assert [path.name for path in (tmp_path / "home").iterdir()] == ["records.sqlite"]


def test_a_copy_that_fails_leaves_no_job(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def full(*_: object, **__: object) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(exchange.shutil, "copytree", full)  # type: ignore[attr-defined]
    bundle = write_bundle(tmp_path / "bundle", four_positions())
    with Laboratory(tmp_path / "home") as laboratory:
        with pytest.raises(MachineError, match="No space left"):
            laboratory.import_bundle(bundle)
        assert laboratory.jobs() == ()


def test_a_recording_is_imported_by_its_header_too(tmp_path: Path) -> None:
    bundle = write_bundle(tmp_path / "bundle", four_positions())
    with Laboratory(tmp_path / "home") as laboratory:
        number = laboratory.import_bundle(bundle / "recording.toml")
        copied = laboratory.bundle(number)
        assert laboratory.job(number).state == "measured"
    names = [sorted(path.name for path in folder.rglob("*")) for folder in (bundle, copied)]
    assert names[0] == names[1]


def test_several_first_starts_make_one_demonstration(tmp_path: Path) -> None:
    failed: list[BaseException] = []

    def start() -> None:
        try:
            with Laboratory(tmp_path) as laboratory:
                laboratory.prepare_demo()
                assert len(laboratory.people()) == 3
                assert len(laboratory.jobs()) == 2
        except BaseException as error:
            failed.append(error)

    threads = [threading.Thread(target=start) for _ in range(3)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert failed == []
    assert not (tmp_path / ".writing").exists()


def test_a_first_start_that_was_killed_is_gone_on_with(tmp_path: Path) -> None:
    with Laboratory(tmp_path) as laboratory:
        laboratory.add_person(demonstration.OPERATOR, demonstration.PASSWORD, None)
        laboratory.prepare_demo()
        assert len(laboratory.people()) == 3
        assert len(laboratory.jobs()) == 2
        assert len(laboratory.standards()) == 4


@pytest.mark.parametrize("text", ["1" + "0" * 5000, '{"a":' * 3000 + "1" + "}" * 3000])
def test_json_that_nobody_can_hold_is_no_result(tmp_path: Path, text: str) -> None:
    file = tmp_path / "result.json"
    file.write_text(text, encoding="utf-8")
    with pytest.raises(InputError):
        read_result(file)


def test_sentences_nested_without_end_are_refused(tmp_path: Path) -> None:
    sentence: dict[str, object] = {"template": "x"}
    for _ in range(200):
        sentence = {"template": "{a}", "params": {"a": sentence}}
    warning = {"segment": "", "line": 0, "message": sentence}
    result = {"procedure": "", "bundle_sha256": "", "software": "", "warnings": [warning]}
    file = tmp_path / "result.json"
    file.write_text(json.dumps(result), encoding="utf-8")
    with pytest.raises(InputError, match="has to be a number or a text"):
        read_result(file)


@pytest.mark.skipif(sys.platform == "win32", reason="there is no such device")
def test_endless_files_are_no_plan_bench_or_result() -> None:
    endless = Path("/dev/zero")
    with pytest.raises(InputError, match="too large"):
        load_plan(endless)
    with pytest.raises(InputError, match="too large"):
        load_bench(endless)
    with pytest.raises(InputError, match="too large"):
        read_result(endless)
