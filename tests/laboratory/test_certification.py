"""Three people, one after the other, over one file that nobody changes in between."""

from __future__ import annotations

import shutil
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import pikepdf
import pytest

from ahrs_lab.certificates.content import mismatches_of
from ahrs_lab.cli import main
from ahrs_lab.errors import InputError, MachineError, PermissionDeniedError
from ahrs_lab.laboratory import job_sheets
from ahrs_lab.laboratory.demonstration import APPROVER, OPERATOR, PASSWORD, VERIFIER
from ahrs_lab.laboratory.evaluation import EvaluationSettings, evaluate_bundle
from ahrs_lab.laboratory.laboratory import Laboratory
from ahrs_lab.laboratory.results import AnyResult
from ahrs_lab.metrology.result import CalibrationResult
from ahrs_lab.records.rows import JobDraft, PersonRow, SignedIn, SigningRole
from tests.laboratory.short_run import PLAN

PEOPLE: dict[SigningRole, PersonRow] = {"operator": OPERATOR, "verifier": VERIFIER, "approver": APPROVER}


@pytest.fixture(scope="module")
def measured(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, str]:
    """The home of a laboratory with one measured job, and the job's number."""
    home = tmp_path_factory.mktemp("measured") / "home"
    with Laboratory(home) as laboratory:
        laboratory.prepare_demo()
        actor = laboratory.sign_in(OPERATOR.name, PASSWORD)
        number = laboratory.jobs()[0].number
        job = laboratory.job(number)
        assert job.operator is not None
        assert job.verifier is not None
        assert job.approver is not None
        draft = JobDraft(
            customer=job.customer,
            device=job.device,
            received=job.received,
            place=job.place,
            plan_toml=PLAN,
            bench_toml=job.bench_toml,
            standard_ids=tuple(row.id for row in job.standards),
            operator_id=job.operator.id,
            verifier_id=job.verifier.id,
            approver_id=job.approver.id,
        )
        laboratory.update_job(number, draft, actor)
        run = laboratory.start_run(
            number, actor, on_event=lambda _e: None, on_samples=lambda _s: None, speed=None, ask=False
        )
        run.start()
        assert run.join(60)
        laboratory.finish_run(number, actor)
    return home, number


class Desk:
    """One laboratory, one job, and the three people at it."""

    def __init__(self, laboratory: Laboratory, number: str) -> None:
        self.laboratory = laboratory
        self.number = number
        self._signed_in: dict[SigningRole, SignedIn] = {}

    def person(self, role: SigningRole) -> SignedIn:
        if role not in self._signed_in:
            self._signed_in[role] = self.laboratory.sign_in(PEOPLE[role].name, PASSWORD)
        return self._signed_in[role]

    def sign(self, role: SigningRole, who: SigningRole | None = None, password: str = PASSWORD) -> Path:
        return self.laboratory.sign(self.number, role, self.person(who or role), password)

    @property
    def state(self) -> str:
        return self.laboratory.job(self.number).state


@pytest.fixture
def desk(measured: tuple[Path, str], tmp_path: Path) -> Iterator[Desk]:
    """The measured job in a copy of the laboratory; its recording stays where it was made."""
    home = tmp_path / "ahrs-lab-home"
    shutil.copytree(measured[0], home)
    with Laboratory(home) as laboratory:
        yield Desk(laboratory, measured[1])


@pytest.fixture(autouse=True)
def unsigned(measured: tuple[Path, str]) -> Iterator[None]:
    """The job's folder is the same in every copy of the laboratory: what a test signs there goes with it."""
    yield
    for path in (measured[0] / "jobs" / measured[1]).glob("AL-*"):
        path.unlink()


def test_the_first_signature_fixes_whether_the_budgets_are_annexed(desk: Desk) -> None:
    def pages(file: Path) -> int:
        with pikepdf.open(file) as pdf:
            return len(pdf.pages)

    laboratory, number = desk.laboratory, desk.number
    annexed = pages(laboratory.draft_certificate(number, budget_annex=True))
    assert pages(laboratory.draft_certificate(number)) < annexed
    file = laboratory.sign(number, "operator", desk.person("operator"), PASSWORD, budget_annex=True)
    assert pages(file) == annexed
    desk.sign("verifier")
    assert pages(file) == annexed
    assert laboratory.verify(file).valid


def test_the_three_sign_in_their_order_and_the_file_verifies(desk: Desk) -> None:
    states = []
    for role in PEOPLE:
        file = desk.sign(role)
        states.append(desk.state)
    assert states == ["measured", "checked", "issued"]
    assert desk.laboratory.certificate(desk.number) == file
    report = desk.laboratory.verify(file)
    assert report.valid
    assert [signature.role for signature in report.signatures] == ["operator", "verifier", "approver"]
    assert [signature.signer for signature in report.signatures] == [
        f"{row.name_en} (Demonstration)" for row in PEOPLE.values()
    ]
    assert main(["verify", str(file)]) == 0


def test_nobody_signs_out_of_turn_in_a_role_they_lack_or_twice(desk: Desk) -> None:
    def refused(
        error: type[InputError], match: str, role: SigningRole, who: SigningRole | None = None
    ) -> None:
        before = desk.state, desk.laboratory.signatures(desk.number)
        with pytest.raises(error, match=match):
            desk.sign(role, who)
        assert (desk.state, desk.laboratory.signatures(desk.number)) == before

    turn = "operator, verifier and approver sign in this order"
    refused(InputError, turn, "verifier")
    refused(InputError, turn, "approver")
    desk.sign("operator")
    refused(InputError, turn, "approver")
    refused(PermissionDeniedError, "takes the role verifier", "verifier", "operator")
    refused(PermissionDeniedError, "has signed job", "operator")
    desk.sign("verifier")
    refused(PermissionDeniedError, "takes the role approver", "approver", "verifier")
    refused(PermissionDeniedError, "has signed job", "verifier")


def test_a_wrong_password_leaves_nothing(desk: Desk) -> None:
    with pytest.raises(PermissionDeniedError):
        desk.sign("operator", password="guess")
    assert desk.laboratory.signatures(desk.number) == ()
    assert desk.laboratory.certificate(desk.number) is None
    desk.sign("operator")
    before = desk.laboratory.certificate(desk.number)
    assert before is not None
    content = before.read_bytes()
    with pytest.raises(PermissionDeniedError):
        desk.sign("verifier", password="guess")
    assert before.read_bytes() == content
    desk.sign("verifier")


def test_a_certificate_that_changed_since_is_not_signed_again(desk: Desk) -> None:
    file = desk.sign("operator")
    content = file.read_bytes()
    file.write_bytes(content + b"\n% one more line\n")
    with pytest.raises(InputError, match="changed outside this program"):
        desk.sign("verifier")
    file.unlink()
    with pytest.raises(MachineError, match="is not where it was signed"):
        desk.sign("verifier")
    file.write_bytes(content)
    desk.sign("verifier")
    assert desk.state == "checked"


def test_a_signature_that_the_records_cannot_keep_is_not_on_the_file(
    desk: Desk, monkeypatch: pytest.MonkeyPatch
) -> None:
    file = desk.sign("operator")
    content = file.read_bytes()

    def refuse(*_: object) -> None:
        raise MachineError("The records cannot be written.")

    with monkeypatch.context() as patch:
        patch.setattr(desk.laboratory.records.jobs, "add_signature", refuse)
        with pytest.raises(MachineError):
            desk.sign("verifier")
    assert file.read_bytes() == content
    desk.sign("verifier")
    desk.sign("approver")
    assert desk.laboratory.verify(file).valid


def test_a_job_sent_back_becomes_a_new_revision_that_all_sign_again(desk: Desk) -> None:
    desk.sign("operator")
    first = desk.sign("verifier")
    content = first.read_bytes()
    with pytest.raises(InputError, match="reason"):
        desk.laboratory.send_back(desk.number, desk.person("approver"), " ")
    with pytest.raises(PermissionDeniedError):
        desk.laboratory.send_back(desk.number, desk.person("operator"), "wrong address")
    desk.laboratory.send_back(desk.number, desk.person("approver"), "wrong address of the customer")
    assert desk.state == "measured"
    assert desk.laboratory.signatures(desk.number) == ()
    for role in PEOPLE:
        second = desk.sign(role)
    assert second.name == first.name.replace(".pdf", "-R1.pdf")
    assert first.read_bytes() == content
    assert desk.laboratory.verify(second).valid
    assert desk.state == "issued"


def test_a_signed_job_takes_no_other_result(desk: Desk) -> None:
    desk.laboratory.recalculate(
        desk.number, EvaluationSettings(uncertainty="annex-a"), desk.person("operator")
    )
    desk.sign("operator")
    with pytest.raises(InputError, match="send it back"):
        desk.laboratory.recalculate(desk.number, EvaluationSettings(), desk.person("operator"))
    result = desk.laboratory.result(desk.number)
    assert isinstance(result, CalibrationResult)
    assert result.scale_factor["x"].uncertainty.method == "annex-a"


def test_a_job_without_a_verifier_is_not_certified(desk: Desk) -> None:
    job = desk.laboratory.job(desk.number)
    assert job.operator is not None
    assert job.approver is not None
    draft = JobDraft(
        customer=replace(job.customer, address="new address"),
        device=job.device,
        received=job.received,
        plan_toml=job.plan_toml,
        bench_toml=job.bench_toml,
        standard_ids=tuple(row.id for row in job.standards),
        operator_id=job.operator.id,
        approver_id=job.approver.id,
    )
    desk.laboratory.update_job(desk.number, draft, desk.person("operator"))
    with pytest.raises(InputError, match=r"no verifier yet: choose one"):
        desk.sign("operator")
    assert desk.laboratory.certificate(desk.number) is None


def test_the_command_line_does_not_call_a_half_signed_certificate_good(desk: Desk) -> None:
    file = desk.sign("operator")
    root = desk.laboratory.home / "authority" / "root.pem"
    assert desk.laboratory.verify(file).valid
    assert main(["verify", str(file), "--trust", str(root)]) == 1


def rows_of(result: AnyResult | None) -> dict[str, tuple[str, str]]:
    """Symbol → origin and certificate of the bench's rows."""
    assert isinstance(result, CalibrationResult)
    stated = [
        *(found.uncertainty for found in result.scale_factor.values()),
        *(found.uncertainty for found in result.zero_offset.values()),
        *(found.uncertainty for found in result.misalignment.values()),
    ]
    return {
        row.symbol: (row.origin, row.certificate) for one in stated for row in one.rows if row.kind == "B"
    }


def test_rows_say_which_certificate_states_them_and_the_rest_are_assumptions(desk: Desk) -> None:
    rows = rows_of(desk.laboratory.result(desk.number))
    assert rows["Ω"] == ("certificate", "DEMO-26-0815")
    assert rows["ε"] == ("assumption", "")  # of its three figures the level is in no certificate
    assert rows["q"] == ("data", "")


def test_the_recording_alone_evaluates_to_the_same_object(desk: Desk) -> None:
    bundle = desk.laboratory.bundle(desk.number)
    assert evaluate_bundle(bundle) == desk.laboratory.result(desk.number)


def test_next_years_figures_are_not_those_of_a_measured_job(desk: Desk) -> None:
    before = desk.laboratory.result(desk.number)
    table = desk.laboratory.standards()[0]
    renewed = replace(table, figures_json="", certificate_number="DEMO-27-0001")
    desk.laboratory.save_standard(renewed, desk.person("operator"))
    desk.laboratory.recalculate(desk.number, EvaluationSettings(), desk.person("operator"))
    assert desk.laboratory.result(desk.number) == before


def test_figures_that_the_job_no_longer_names_are_said_until_it_is_evaluated_again(desk: Desk) -> None:
    said = "evaluated with other figures of the standards"
    laboratory, actor = desk.laboratory, desk.person("operator")
    job = laboratory.job(desk.number)
    ids = [person.id if person else 0 for person in (job.operator, job.verifier, job.approver)]
    others = tuple(row.id for row in job.standards if row.kind != "table")
    draft = JobDraft(job.customer, job.device, job.received, job.place, job.place_en, job.plan_toml,
                     job.bench_toml, others, ids[0], ids[1], ids[2])  # fmt: skip

    def remarks() -> list[str]:
        result = laboratory.result(desk.number)
        assert isinstance(result, CalibrationResult)
        sheet = job_sheets.job_sheet(laboratory.job(desk.number), laboratory.profile(), result, issued=None)
        return [message.text() for message in mismatches_of(result, sheet) if said in message.text()]

    assert not remarks()
    laboratory.update_job(desk.number, draft, actor)
    assert remarks()
    laboratory.recalculate(desk.number, EvaluationSettings(), actor)
    assert not remarks()
    assert rows_of(laboratory.result(desk.number))["Ω"] == ("assumption", "")


def test_two_standards_that_state_the_same_stop_the_job_before_it_runs(desk: Desk) -> None:
    laboratory, actor = desk.laboratory, desk.person("operator")
    other = replace(laboratory.standards()[0], id=0, serial_number="T-0008")
    laboratory.save_standard(other, actor)
    number = laboratory.jobs()[1].number
    job = laboratory.job(number)
    ids = [person.id if person else 0 for person in (job.operator, job.verifier, job.approver)]
    draft = JobDraft(job.customer, job.device, job.received, job.place, job.place_en, job.plan_toml,
                     job.bench_toml, tuple(row.id for row in laboratory.standards()), ids[0], ids[1],
                     ids[2])  # fmt: skip
    laboratory.update_job(number, draft, actor)
    assert "both state the figure" in laboratory.clause6(number)[0].text()
    with pytest.raises(InputError, match=r"s/n T-0007 and .* s/n T-0008 both state the figure"):
        laboratory.start_run(number, actor, on_event=lambda _e: None, on_samples=lambda _s: None,
                             violations_reason="we know", second_person=desk.person("verifier"))  # fmt: skip
    assert laboratory.job(number).state == "draft"


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"due": None}, "enter the number and the due date"),
        ({"certificate_number": " "}, "enter the number and the due date"),
        ({"kind": "supply"}, "cannot state the figure"),
        (
            {"figures_json": '[{"figure": "position_arcsec", "value": 1, "unit": "arcsec"}]'},
            "no coverage factor",
        ),
    ],
)
def test_a_standard_whose_figures_cannot_be_used_is_not_saved(
    desk: Desk, changes: dict[str, Any], said: str
) -> None:
    table = desk.laboratory.standards()[0]
    with pytest.raises(InputError, match=said):
        desk.laboratory.save_standard(replace(table, **changes), desk.person("operator"))
    assert desk.laboratory.standards()[0] == table
