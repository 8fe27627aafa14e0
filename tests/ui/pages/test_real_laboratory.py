"""The pages on the real laboratory: a job is started, measured, looked at, signed three times, verified."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import cast

import pytest
from PySide6.QtCore import QTimer
from PySide6.QtWidgets import QApplication
from pytestqt.qtbot import QtBot

from ahrs_lab.laboratory.demonstration import PASSWORD
from ahrs_lab.laboratory.laboratory import Laboratory
from ahrs_lab.ui.main_window import MainWindow
from ahrs_lab.ui.pages.all_pages import page_entries
from ahrs_lab.ui.pages.certificate import CertificatePage
from ahrs_lab.ui.pages.certificate_signing import SignDialog
from ahrs_lab.ui.pages.desk import Desk
from ahrs_lab.ui.pages.jobs.page import JobsPage
from ahrs_lab.ui.pages.jobs.plan_model import EntryName
from ahrs_lab.ui.pages.results.page import ResultsPage
from ahrs_lab.ui.pages.widgets.form import TextField
from ahrs_lab.ui.workspace import Workspace
from tests.ui.conftest import Look

ACCELERATED = 0
"""The first of the demonstration's jobs."""


@pytest.fixture
def real(look: Look, qtbot: QtBot, tmp_path: Path) -> Iterator[tuple[MainWindow, Desk, Laboratory]]:
    """The demonstration laboratory behind all pages, at full speed; its operator is signed in."""
    with Laboratory(tmp_path) as laboratory:
        laboratory.prepare_demo()
        workspace = Workspace(laboratory, laboratory.settings, speed=None)
        desk = Desk(workspace, workspace)
        window = MainWindow(workspace, theme="light")
        for entry in page_entries(desk):
            window.add_entry(entry)
        window.show()
        operator = next(p for p in laboratory.people() if "operator" in p.roles)
        desk.sign_in(laboratory.sign_in(operator.name, PASSWORD))
        yield window, desk, laboratory
        # The run first: a window with a live run asks before it closes.
        workspace.run.close()
        desk.close()
        window.close()
        window.deleteLater()


def measure(window: MainWindow, desk: Desk, number: str, qtbot: QtBot) -> None:
    desk.open(number, "jobs")
    page = window.pages["jobs"]
    assert isinstance(page, JobsPage)
    page.editor.start_button.click()
    run = desk.workspace.run
    assert desk.laboratory.job(number).state == "running"

    def ended() -> bool:
        run.confirm_mounted()
        return not run.live

    qtbot.waitUntil(ended, timeout=60_000)
    assert run.model.state == "done", run.model.reason
    qtbot.waitUntil(lambda: desk.laboratory.job(number).state == "measured", timeout=30_000)
    qtbot.waitUntil(lambda: not desk.background.busy, timeout=30_000)


def test_a_job_goes_from_its_start_to_three_valid_signatures(
    real: tuple[MainWindow, Desk, Laboratory], qtbot: QtBot
) -> None:
    window, desk, laboratory = real
    number = laboratory.jobs()[-1 - ACCELERATED].number
    measure(window, desk, number, qtbot)
    results, certificate = window.pages["results"], window.pages["certificate"]
    assert isinstance(results, ResultsPage)
    assert isinstance(certificate, CertificatePage)
    assert window.current_page() == "results"
    assert sum(len(card.rows) for card in results.cards.values()) == 12
    assert results.plot.plot is not None
    results.plot.plot.picked.emit(0)
    qtbot.waitUntil(lambda: bool(results.plot.shows_segment()), timeout=20_000)
    desk.open(number, "certificate")
    qtbot.waitUntil(lambda: certificate.view.count() >= 3, timeout=30_000)
    for role in ("operator", "verifier", "approver"):
        person = getattr(laboratory.job(number), role)
        desk.sign_in(laboratory.sign_in(person.name, PASSWORD))

        def answer() -> None:
            dialog = QApplication.activeModalWidget()
            assert isinstance(dialog, SignDialog)
            dialog.password.set_text(PASSWORD)
            dialog.action.click()

        QTimer.singleShot(50, answer)
        certificate.panels[role].sign.click()
        assert len(laboratory.signatures(number)) == 1 + ("operator", "verifier", "approver").index(role)
    qtbot.waitUntil(lambda: not desk.background.busy, timeout=30_000)
    file = laboratory.certificate(number)
    assert file is not None
    assert laboratory.verify(file).intact
    assert laboratory.job(number).state == "issued"
    assert "changed" not in " ".join(certificate.verdict.texts()).replace("unchanged", "")


@pytest.mark.slow
def test_an_imu_goes_from_its_plan_to_its_signed_sheet(
    real: tuple[MainWindow, Desk, Laboratory], qtbot: QtBot
) -> None:
    window, desk, laboratory = real
    number = laboratory.jobs()[-1 - ACCELERATED].number
    desk.open(number, "jobs")
    page = window.pages["jobs"]
    assert isinstance(page, JobsPage)
    plan = page.editor.plan
    plan.procedure.set_key("imu-discrete")
    plan.procedure.edited.emit()
    for name, text in (("imu_dwell", "20"), ("imu_turns", "2")):
        field = plan.fields[cast(EntryName, name)]
        assert isinstance(field, TextField)
        field.set_text(text)
        field.edited.emit()
    assert page.editor.save()
    measure(window, desk, number, qtbot)
    results, certificate = window.pages["results"], window.pages["certificate"]
    assert isinstance(results, ResultsPage)
    assert isinstance(certificate, CertificatePage)
    assert window.current_page() == "results"
    assert results.imu.isVisible()
    assert "12 positions" in results.imu.verdict.title()
    desk.open(number, "certificate")
    qtbot.waitUntil(lambda: certificate.view.count() >= 3, timeout=30_000)
    assert not certificate.budget_annex.isVisible()
    for role in ("operator", "verifier", "approver"):
        person = getattr(laboratory.job(number), role)
        laboratory.sign(number, role, laboratory.sign_in(person.name, PASSWORD), PASSWORD)
    file = laboratory.certificate(number)
    assert file is not None
    assert laboratory.verify(file).intact
    assert laboratory.job(number).state == "issued"


def test_a_stopped_run_leaves_the_job_ready_to_go_on(
    real: tuple[MainWindow, Desk, Laboratory], qtbot: QtBot
) -> None:
    window, desk, laboratory = real
    number = laboratory.jobs()[-1 - ACCELERATED].number
    desk.open(number, "jobs")
    page = window.pages["jobs"]
    assert isinstance(page, JobsPage)
    page.editor.start_button.click()
    run = desk.workspace.run
    qtbot.waitUntil(lambda: run.model.request is not None, timeout=20_000)
    run.stop()
    qtbot.waitUntil(lambda: not run.live, timeout=20_000)
    qtbot.waitUntil(lambda: laboratory.job(number).state == "ready", timeout=5_000)
    released: list[str] = []
    desk.workspace.run_starting.connect(lambda: released.append("instruments"))
    desk.resume_run()
    assert released == ["instruments"]
    assert laboratory.job(number).state == "running"
    run.stop()
    qtbot.waitUntil(lambda: not run.live, timeout=20_000)
    qtbot.waitUntil(lambda: laboratory.job(number).state == "ready", timeout=5_000)


def test_a_run_that_is_refused_says_why_and_moves_nothing(
    real: tuple[MainWindow, Desk, Laboratory], qtbot: QtBot
) -> None:
    window, desk, laboratory = real
    number = laboratory.jobs()[-1 - ACCELERATED].number
    verifier = next(p for p in laboratory.people() if "verifier" in p.roles)
    notices: list[str] = []
    desk.workspace.noticed.connect(lambda _kind, what: notices.append(str(what)))
    desk.open(number, "jobs")
    desk.sign_in(laboratory.sign_in(verifier.name, PASSWORD))
    page = window.pages["jobs"]
    assert isinstance(page, JobsPage)
    page.editor.start_button.click()
    assert notices
    assert laboratory.job(number).state == "draft"
    assert not desk.workspace.run.live
