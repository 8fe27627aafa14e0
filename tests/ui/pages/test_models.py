"""The Qt-free models: agenda, search, checks before a run, signing places, the bench's text."""

from __future__ import annotations

from dataclasses import replace
from datetime import date

import pytest

from ahrs_lab.errors import InputError
from ahrs_lab.records.rows import (
    CustomerRow,
    DeviceRow,
    JobDraft,
    JobRow,
    JobState,
    PersonRow,
    SignatureRow,
    SigningRole,
    StandardRow,
)
from ahrs_lab.resource_files import resource_path
from ahrs_lab.ui.pages import bench_model
from ahrs_lab.ui.pages.certificate_model import signing_places
from ahrs_lab.ui.pages.jobs import checks
from ahrs_lab.ui.pages.jobs.list_model import matching
from ahrs_lab.ui.pages.start_model import agenda, next_action

OPERATOR = PersonRow(1, "甲", "A", roles=frozenset({"operator"}))
VERIFIER = PersonRow(2, "乙", "B", roles=frozenset({"verifier"}))
APPROVER = PersonRow(3, "丙", "C", roles=frozenset({"approver"}))


def job(number: str, state: JobState, received: date = date(2026, 11, 1), **changes: object) -> JobRow:
    base = checks.preview(
        JobDraft(
            CustomerRow(1, "航空仪表研究所", "Institute of Aviation"),
            DeviceRow(1, "航姿仪", "AHRS", "VectorNav", "VN-100", "0100"),
            received,
            plan_toml="x",
            bench_toml="y",
            standard_ids=(1,),
            operator_id=1,
            verifier_id=2,
            approver_id=3,
        ),
        [StandardRow(1, "table", "Table")],
        [OPERATOR, VERIFIER, APPROVER],
    )
    return replace(base, number=number, state=state, **changes)  # type: ignore[arg-type]


def test_jobs_stand_with_whoever_has_to_act() -> None:
    states: tuple[JobState, ...] = ("draft", "ready", "running", "measured", "checked", "issued")
    found = agenda([job(f"2026-{n}", state) for n, state in enumerate(states)])
    assert [t.job.state for t in found.tasks["measure"]] == ["draft", "ready", "running"]
    assert [t.job.state for t in found.tasks["verify"]] == ["measured"]
    assert [t.job.state for t in found.tasks["approve"]] == ["checked"]
    assert [j.state for j in found.issued] == ["issued"]
    assert not found.empty


def test_the_longest_waiting_job_comes_first() -> None:
    jobs = [job("2026-2", "ready", date(2026, 11, 9)), job("2026-1", "ready", date(2026, 11, 10))]
    assert [t.job.number for t in agenda(jobs).tasks["measure"]] == ["2026-2", "2026-1"]


def test_no_jobs_is_an_empty_agenda() -> None:
    assert agenda([]).empty


@pytest.mark.parametrize(
    ("state", "signatures", "action"),
    [
        ("ready", 0, "start"),
        ("running", 0, "watch"),
        ("measured", 0, "certify"),
        ("measured", 1, "check"),
        ("checked", 2, "approve"),
    ],
)
def test_each_state_has_its_one_next_action(state: JobState, signatures: int, action: str) -> None:
    assert next_action(job("2026-1", state), signatures) == action


def test_a_job_that_lacks_something_is_completed_first() -> None:
    assert next_action(job("2026-1", "ready", verifier=None), 0) == "complete"


def test_search_finds_every_typed_word_in_either_script() -> None:
    jobs = [job("2026-0001", "ready"), job("2026-0002", "issued")]
    assert len(matching(jobs, "vn-100 aviation")) == 2
    assert [j.number for j in matching(jobs, "航空 0002")] == ["2026-0002"]
    assert matching(jobs, "xsens") == ()
    assert len(matching(jobs, "  ")) == 2


def test_missing_entries_are_named_in_the_order_of_the_form() -> None:
    empty = JobDraft(CustomerRow(0, " "), DeviceRow(0, ""), date(2026, 1, 1))
    assert checks.missing(empty) == (
        "customer", "device", "standards", "operator", "verifier", "approver", "bench",
    )  # fmt: skip


def test_a_standard_is_overdue_the_day_after_its_due_date() -> None:
    row = StandardRow(1, "table", "Table", due=date(2026, 11, 22))
    assert not checks.overdue(row, date(2026, 11, 22))
    assert checks.overdue(row, date(2026, 11, 23))
    assert not checks.overdue(replace(row, due=None), date(2026, 11, 23))


def signature(role: SigningRole) -> SignatureRow:
    return SignatureRow(role, "x", "2026-11-23T00:00:00+00:00", "f.pdf", "", 0)


@pytest.mark.parametrize(
    ("state", "signed", "actor", "turns"),
    [
        ("measured", (), OPERATOR, ["yours", "later", "later"]),
        ("measured", (), VERIFIER, ["theirs", "later", "later"]),
        ("measured", ("operator",), VERIFIER, ["signed", "yours", "later"]),
        ("checked", ("operator", "verifier"), APPROVER, ["signed", "signed", "yours"]),
        ("checked", ("operator", "verifier"), None, ["signed", "signed", "theirs"]),
        ("issued", ("operator", "verifier", "approver"), None, ["signed", "signed", "signed"]),
    ],
)
def test_signatures_follow_in_their_order(
    state: JobState, signed: tuple[SigningRole, ...], actor: PersonRow | None, turns: list[str]
) -> None:
    places = signing_places(job("2026-1", state), [signature(role) for role in signed], actor)
    assert [place.turn for place in places] == turns


def test_a_field_of_nobody_says_so() -> None:
    places = signing_places(job("2026-1", "measured", verifier=None), [], OPERATOR)
    assert [place.turn for place in places] == ["yours", "nobody", "later"]


def demo_bench() -> str:
    return resource_path("benches/demo.toml").read_text(encoding="utf-8")


def test_a_bench_tells_who_is_there() -> None:
    seen = bench_model.look_at(demo_bench())
    assert seen.simulated
    assert seen.limits.max_rate_dps == 1000.0
    assert "VU-100" in str(seen.ahrs)
    assert ("site", "latitude_deg", "39.9042") in seen.settings


def test_a_fault_is_switched_on_and_off_in_the_text() -> None:
    on = bench_model.with_fault(demo_bench(), "ahrs_silent", True)
    assert bench_model.faults_of(on) == {"ahrs_silent"}
    assert bench_model.look_at(on).limits.max_rate_dps == 1000.0
    both = bench_model.with_fault(on, "table_trips", True)
    assert bench_model.faults_of(both) == {"ahrs_silent", "table_trips"}
    assert bench_model.faults_of(bench_model.with_fault(both, "ahrs_silent", False)) == {"table_trips"}
    off = bench_model.with_fault(bench_model.with_fault(both, "ahrs_silent", False), "table_trips", False)
    assert bench_model.faults_of(off) == frozenset()


def test_a_text_that_is_no_bench_is_refused() -> None:
    with pytest.raises(InputError):
        bench_model.look_at("kind = [")
    with pytest.raises(InputError):
        bench_model.faults_of("= 3")


def test_nobody_signs_before_a_repeated_run_is_finished() -> None:
    places = signing_places(job("1", "running"), [], OPERATOR)
    assert [place.turn for place in places] == ["unmeasured"] * 3
