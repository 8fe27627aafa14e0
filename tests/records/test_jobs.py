"""Jobs from order to issued certificate."""

from __future__ import annotations

import hashlib
from dataclasses import replace
from datetime import date

import pytest

from ahrs_lab.errors import InputError, PermissionDeniedError
from ahrs_lab.records.jobs import TRANSITIONS
from ahrs_lab.records.rows import CustomerRow, JobState, LaboratoryRow, PersonRow, SignedIn, StandardRow
from ahrs_lab.records.store import Records
from tests.records.conftest import Staff, choosing, draft, standard


def test_numbers_count_up_within_the_year_of_receipt(records: Records, staff: Staff) -> None:
    made = [
        records.jobs.create(draft(staff, date(year, 3, 1)), staff.operator)
        for year in (2026, 2026, 2027, 2026)
    ]
    assert made == ["2026-0001", "2026-0002", "2027-0001", "2026-0003"]


def test_numbers_go_on_after_ten_thousand(records: Records, staff: Staff) -> None:
    from sqlalchemy import update

    from ahrs_lab.records import schema

    first = records.jobs.create(draft(staff), staff.operator)
    with records.writing() as connection:
        connection.execute(
            update(schema.jobs).where(schema.jobs.c.number == first).values(number="2026-9999")
        )
    assert records.jobs.create(draft(staff), staff.operator) == "2026-10000"
    assert records.jobs.create(draft(staff), staff.operator) == "2026-10001"


def test_a_job_comes_back_with_what_was_entered(records: Records, staff: Staff) -> None:
    used = standard(records, staff)
    wanted = choosing(draft(staff), used)
    number = records.jobs.create(wanted, staff.operator)
    found = records.jobs.get(number)
    assert (found.state, found.number, found.received, found.plan_toml) == (
        "draft",
        number,
        wanted.received,
        wanted.plan_toml,
    )
    assert replace(found.customer, id=0) == wanted.customer
    assert replace(found.device, id=0) == wanted.device
    assert found.standards == (used,)
    assert (found.operator, found.verifier, found.approver) == (
        staff.operator.person,
        staff.verifier.person,
        staff.approver.person,
    )
    assert records.jobs.all() == (found,)


def test_what_a_job_cannot_be_is_refused(records: Records, staff: Staff) -> None:
    good = draft(staff)
    wrong = [
        (replace(good, customer=CustomerRow(0, " ")), "customer"),
        (replace(good, device=replace(good.device, name="", model="")), "name or model"),
        (replace(good, verifier_id=good.operator_id), "three different people"),
        (replace(good, approver_id=good.operator_id), "three different people"),
        (replace(good, operator_id=staff.administrator.person.id), "Choose as operator"),
        (replace(good, standard_ids=(99,)), "standards 99 is not in the records"),
        (replace(good, customer=CustomerRow(99, "?")), "customers 99 is not in the records"),
    ]
    for entered, words in wrong:
        with pytest.raises(InputError, match=words):
            records.jobs.create(entered, staff.operator)
    assert records.jobs.all() == ()
    assert records.registry.customers() == ()


def test_one_person_with_two_roles_cannot_verify_what_they_measured(records: Records, staff: Staff) -> None:
    both = PersonRow(0, "both", roles=frozenset({"operator", "verifier"}))
    both = records.people.add(both, "both-1", staff.administrator)
    signed_in = records.people.sign_in("both", "both-1")
    number = records.jobs.create(replace(draft(staff), verifier_id=both.id), staff.operator)
    records.jobs.move(number, "ready", signed_in)
    with pytest.raises(PermissionDeniedError, match="not assigned to both"):
        records.jobs.move(number, "running", signed_in)
    records.jobs.move(number, "running", staff.operator)
    records.jobs.move(number, "measured", staff.operator)
    other = PersonRow(0, "other", roles=frozenset({"operator"}))
    other = records.people.add(other, "x", staff.administrator)
    with pytest.raises(InputError, match="its operator is who ran it"):
        records.jobs.change(number, replace(draft(staff), operator_id=other.id), staff.operator)


def every_step() -> list[tuple[JobState, JobState]]:
    states: tuple[JobState, ...] = ("draft", "ready", "running", "measured", "checked", "issued")
    return [(before, after) for before in states for after in states]


@pytest.mark.parametrize(("before", "after"), every_step())
def test_only_the_tables_steps_are_taken_and_only_by_their_role(
    records: Records, staff: Staff, job: str, before: JobState, after: JobState
) -> None:
    from sqlalchemy import update

    from ahrs_lab.records import schema

    with records.writing() as connection:
        connection.execute(update(schema.jobs).values(state=before))
    allowed = TRANSITIONS.get((before, after), ()) if after not in ("checked", "issued") else ()
    for role in ("administrator", "operator", "verifier", "approver"):
        actor: SignedIn = getattr(staff, role)
        if role in allowed:
            continue
        with pytest.raises(InputError):
            records.jobs.move(job, after, actor, "a reason")
        assert records.jobs.get(job).state == before
    for role in allowed:
        if role != "importer":
            records.jobs.move(job, after, getattr(staff, role), "a reason")
            assert records.jobs.get(job).state == after


def test_going_back_needs_a_reason_which_is_kept(records: Records, staff: Staff, measured: str) -> None:
    with pytest.raises(InputError, match="Say why"):
        records.jobs.move(measured, "running", staff.operator, "  ")
    records.jobs.move(measured, "running", staff.operator, "cable was loose")
    assert "cable was loose" in records.audit.rows(f"job {measured}")[-1].after


def test_a_job_changes_until_its_run_and_its_plan_never_after(
    records: Records, staff: Staff, measured: str
) -> None:
    kept = draft(staff)
    records.jobs.change(measured, replace(kept, place="北京"), staff.operator)
    assert records.jobs.get(measured).place == "北京"
    with pytest.raises(InputError, match="plan and bench stay"):
        records.jobs.change(measured, replace(kept, plan_toml="x"), staff.operator)
    records.jobs.add_signature(measured, "operator", staff.operator, "c.pdf", "0" * 64)
    with pytest.raises(InputError, match="until the first signature"):
        records.jobs.change(measured, replace(kept, place="上海"), staff.operator)


def test_a_customer_that_changed_stays_as_it_was_for_older_jobs(
    records: Records, staff: Staff, job: str
) -> None:
    old = records.jobs.get(job).customer
    moved = replace(draft(staff), customer=replace(old, address="新址"))
    second = records.jobs.create(moved, staff.operator)
    assert records.jobs.get(job).customer == old
    assert records.jobs.get(second).customer.address == "新址"


def test_a_standards_next_certificate_is_not_that_of_a_job_already_measured(
    records: Records, staff: Staff
) -> None:
    used = standard(records, staff, "C-2025")
    numbers = [records.jobs.create(choosing(draft(staff), used), staff.operator) for _ in range(2)]
    records.jobs.move(numbers[0], "ready", staff.operator)
    records.jobs.move(numbers[0], "running", staff.operator)
    records.jobs.move(numbers[0], "measured", staff.operator)
    renewed = replace(used, certificate_number="C-2026", due=date(2028, 1, 1))
    records.registry.save_standard(renewed, staff.operator)
    assert records.jobs.get(numbers[0]).standards == (used,)
    assert records.jobs.get(numbers[1]).standards == (renewed,)
    records.jobs.move(numbers[0], "running", staff.operator, "measured again")
    records.jobs.move(numbers[0], "measured", staff.operator)
    assert records.jobs.get(numbers[0]).standards == (renewed,)


def test_results_are_added_and_the_newest_counts(records: Records, staff: Staff, measured: str) -> None:
    again = records.jobs.add_result(measured, '{"K": 2.0}', staff.verifier)
    assert again.sha256 == hashlib.sha256(b'{"K": 2.0}').hexdigest()
    stored = records.jobs.results(measured)
    assert [row.json for row in stored] == ['{"K": 1.0}', '{"K": 2.0}']
    assert stored[-1] == again
    with pytest.raises(PermissionDeniedError):
        records.jobs.add_result(measured, "{}", staff.approver)


def sign_all(records: Records, staff: Staff, number: str) -> None:
    records.jobs.add_signature(number, "operator", staff.operator, "c.pdf", "1" * 64)
    records.jobs.add_signature(number, "verifier", staff.verifier, "c.pdf", "2" * 64)
    records.jobs.add_signature(number, "approver", staff.approver, "c.pdf", "3" * 64)


def test_three_signatures_in_order_issue_the_certificate(
    records: Records, staff: Staff, measured: str
) -> None:
    with pytest.raises(InputError, match="0 of 3 signatures"):
        records.jobs.may_sign(measured, "verifier", staff.verifier)
    states = []
    for role, actor in (
        ("operator", staff.operator),
        ("verifier", staff.verifier),
        ("approver", staff.approver),
    ):
        records.jobs.add_signature(measured, role, actor, "c.pdf", "1" * 64)  # type: ignore[arg-type]
        states.append(records.jobs.get(measured).state)
    assert states == ["measured", "checked", "issued"]
    assert [row.role for row in records.jobs.signatures(measured)] == ["operator", "verifier", "approver"]
    assert records.jobs.get(measured).issued is not None
    with pytest.raises(InputError, match="is issued"):
        records.jobs.move(measured, "measured", staff.approver, "too late")


def test_nobody_signs_for_another_or_twice(records: Records, staff: Staff, measured: str) -> None:
    with pytest.raises(PermissionDeniedError, match="takes the role operator"):
        records.jobs.add_signature(measured, "operator", staff.verifier, "c.pdf", "1" * 64)
    stranger = PersonRow(0, "stranger", roles=frozenset({"operator"}))
    records.people.add(stranger, "s-1", staff.administrator)
    with pytest.raises(PermissionDeniedError, match="not assigned to stranger"):
        records.jobs.add_signature(
            measured, "operator", records.people.sign_in("stranger", "s-1"), "c", "1" * 64
        )
    records.jobs.add_signature(measured, "operator", staff.operator, "c.pdf", "1" * 64)
    with pytest.raises(PermissionDeniedError, match="has signed job"):
        records.jobs.add_signature(measured, "operator", staff.operator, "c.pdf", "1" * 64)


def test_a_job_sent_back_gets_a_new_revision_and_needs_all_signatures_again(
    records: Records, staff: Staff, measured: str
) -> None:
    records.jobs.add_signature(measured, "operator", staff.operator, "c.pdf", "1" * 64)
    with pytest.raises(InputError, match="is signed"):
        records.jobs.add_result(measured, "{}", staff.operator)
    records.jobs.add_signature(measured, "verifier", staff.verifier, "c.pdf", "2" * 64)
    first = records.jobs.get(measured).certificate_number
    records.jobs.move(measured, "measured", staff.approver, "wrong address")
    assert records.jobs.get(measured).certificate_number == f"{first}-R1"
    assert records.jobs.signatures(measured) == ()
    records.jobs.add_result(measured, "{}", staff.operator)
    sign_all(records, staff, measured)
    assert records.jobs.get(measured).state == "issued"


def test_run_events_are_kept_in_order(records: Records, job: str) -> None:
    records.jobs.add_run_event(job, "started")
    records.jobs.add_run_event(job, "stopped", "table fault")
    assert [(row.what, row.detail) for row in records.jobs.run_events(job)] == [
        ("started", ""),
        ("stopped", "table fault"),
    ]


def test_a_jobs_folder_is_said_once(records: Records, staff: Staff, job: str) -> None:
    records.jobs.set_folder(job, "a", staff.operator)
    records.jobs.set_folder(job, "a", staff.operator)
    with pytest.raises(InputError, match="elsewhere"):
        records.jobs.set_folder(job, "b", staff.operator)
    assert records.jobs.get(job).folder == "a"


def test_the_machines_user_takes_recordings_in_and_does_nothing_else(records: Records, staff: Staff) -> None:
    machine = records.people.machine_user()
    number = records.jobs.create(draft(staff), machine)
    records.jobs.add_result(number, "{}", machine)
    records.jobs.move(number, "measured", machine)
    with pytest.raises(PermissionDeniedError):
        records.jobs.move(number, "running", machine, "x")
    with pytest.raises(PermissionDeniedError):
        records.jobs.change(number, draft(staff), machine)
    with pytest.raises(PermissionDeniedError):
        standard(records, replace(staff, operator=machine))


def test_a_job_that_is_not_there_is_named(records: Records, staff: Staff) -> None:
    with pytest.raises(InputError, match="no job 2026-0042"):
        records.jobs.get("2026-0042")


def test_the_laboratory_and_its_standards_are_kept(records: Records, staff: Staff) -> None:
    assert records.registry.laboratory() is None
    for name in ("甲", "乙"):
        records.registry.set_laboratory(LaboratoryRow(name, address="北京"), staff.administrator)
        assert records.registry.laboratory() == LaboratoryRow(name, address="北京")
    with pytest.raises(PermissionDeniedError):
        records.registry.set_laboratory(LaboratoryRow("丙"), staff.operator)
    saved = standard(records, staff)
    records.registry.save_standard(replace(saved, name="Table 2"), staff.operator)
    assert records.registry.standards() == (replace(saved, name="Table 2"),)
    with pytest.raises(InputError, match="name and a kind"):
        records.registry.save_standard(StandardRow(0, "gyro", "x"), staff.operator)
    with pytest.raises(PermissionDeniedError):
        standard(records, replace(staff, operator=staff.verifier))
