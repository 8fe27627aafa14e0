"""The page Certificate: preview, three signatures in their order, verification, files."""

from __future__ import annotations

from pathlib import Path

import pytest
from PySide6.QtCore import QTimer
from PySide6.QtWidgets import QApplication, QFileDialog
from pytestqt.qtbot import QtBot

from ahrs_lab.certificates.verify import SignatureReport, VerificationReport
from ahrs_lab.errors import MachineError
from ahrs_lab.messages import Message
from ahrs_lab.records.rows import SignedIn
from ahrs_lab.ui.pages.certificate_signing import SignDialog
from ahrs_lab.ui.pages.jobs.send_back_dialog import SendBackDialog
from ahrs_lab.ui.pages.pdf_pages import draw_pages
from tests.ui.pages.conftest import Screens
from tests.ui.pages.fake_laboratory import PASSWORD


def open_certificate(screens: Screens, qtbot: QtBot, state: str) -> str:
    number = screens.number(state)
    screens.desk.open(number, "certificate")
    screens.settle(qtbot)
    return number


def test_the_preview_shows_its_pages_in_each_language(screens: Screens, qtbot: QtBot) -> None:
    open_certificate(screens, qtbot, "measured")
    assert screens.certificate.view.count() == 2
    assert screens.certificate._page_label.text() == "page 1 of 2"
    screens.certificate.view.show_page(2)
    assert screens.certificate._page_label.text() == "page 2 of 2"
    screens.certificate.language.changed.emit("zh")
    screens.settle(qtbot)
    assert screens.certificate.view.count() == 2


def test_the_budgets_are_annexed_before_the_first_signature_and_never_after(
    screens: Screens, qtbot: QtBot, actors: dict[str, SignedIn]
) -> None:
    open_certificate(screens, qtbot, "measured")
    page = screens.certificate
    assert page.view.count() == 2
    page.budget_annex.click()
    screens.settle(qtbot)
    assert page.view.count() == 3

    def answer() -> None:
        dialog = QApplication.activeModalWidget()
        assert isinstance(dialog, SignDialog)
        dialog.password.set_text(PASSWORD)
        dialog.action.click()

    screens.desk.sign_in(actors["operator"])
    QTimer.singleShot(50, answer)
    page.panels["operator"].sign.click()
    screens.settle(qtbot)
    assert screens.laboratory.signed_with_annex
    assert not page.budget_annex.isVisible()
    page.budget_annex.setChecked(False)


def test_three_people_sign_one_after_the_other(
    screens: Screens, qtbot: QtBot, actors: dict[str, SignedIn]
) -> None:
    number = open_certificate(screens, qtbot, "measured")
    for role in ("operator", "verifier", "approver"):
        screens.desk.sign_in(actors[role])
        panel = screens.certificate.panels[role]
        assert panel.chip.text() == "your turn"
        others = [p for key, p in screens.certificate.panels.items() if key != role]
        assert not any(p.sign.isVisible() for p in others)

        def answer() -> None:
            dialog = QApplication.activeModalWidget()
            assert isinstance(dialog, SignDialog)
            dialog.password.set_text(PASSWORD)
            dialog.action.click()

        QTimer.singleShot(50, answer)
        panel.sign.click()
        screens.settle(qtbot)
        assert panel.chip.text() == "signed"
    assert screens.laboratory.job(number).state == "issued"
    assert screens.certificate.save_button.isEnabled()
    assert screens.certificate.verdict.texts()[0].startswith("Intact")


def test_a_wrong_password_is_said_in_the_dialog(
    screens: Screens, qtbot: QtBot, actors: dict[str, SignedIn]
) -> None:
    number = screens.number("measured")
    dialog = SignDialog(screens.desk, number, "operator", actors["operator"], "bilingual")
    qtbot.addWidget(dialog)
    dialog.show()
    dialog.action.click()
    assert dialog.password.error()
    dialog.password.set_text("wrong")
    dialog.action.click()
    qtbot.waitUntil(lambda: bool(dialog.refusal()))
    assert dialog.refusal() == "Name or password is not right."
    assert screens.laboratory.signatures(number) == ()


def test_whoever_is_not_assigned_is_asked_to_sign_in(
    screens: Screens, qtbot: QtBot, actors: dict[str, SignedIn]
) -> None:
    open_certificate(screens, qtbot, "checked")
    panel = screens.certificate.panels["approver"]
    assert panel.chip.text() == "waits"
    assert panel.change.isVisible()
    assert not panel.sign.isVisible()
    screens.desk.sign_in(actors["approver"])
    assert panel.sign.isVisible()


def test_the_approver_sends_back_with_a_reason(
    screens: Screens, qtbot: QtBot, actors: dict[str, SignedIn]
) -> None:
    number = open_certificate(screens, qtbot, "checked")
    assert not screens.certificate.send_back.isVisible()
    screens.desk.sign_in(actors["approver"])

    def answer() -> None:
        dialog = QApplication.activeModalWidget()
        assert isinstance(dialog, SendBackDialog)
        dialog.action.click()
        assert dialog.reason.error()
        dialog.reason.set_text("address is wrong")
        dialog.action.click()

    QTimer.singleShot(50, answer)
    screens.certificate.send_back.click()
    screens.settle(qtbot)
    assert screens.laboratory.job(number).state == "measured"
    assert screens.laboratory.signatures(number) == ()


def test_what_verification_finds_is_said_in_words(screens: Screens, qtbot: QtBot) -> None:
    report = VerificationReport(
        False,
        (
            SignatureReport("operator", "operator", "Demo operator", None, True, True, False, "forbidden"),
            SignatureReport(
                "verifier", "verifier", "Demo verifier", None, False, False, False, "none",
                (Message("The signature does not fit its bytes."),),
            ),
        ),
        Message("Page 2 was changed after the first signature."),
        Message("Not intact."),
    )  # fmt: skip
    screens.certificate.verdict.show_report(report)
    texts = screens.certificate.verdict.texts()
    assert texts[:2] == ["Not intact.", "Page 2 was changed after the first signature."]
    assert texts[2].startswith("Verifier: Demo verifier")
    assert "The signature does not fit its bytes." in texts[2]


def test_the_signed_file_is_saved_as_it_is(
    screens: Screens, qtbot: QtBot, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    number = open_certificate(screens, qtbot, "issued")
    target = tmp_path / "out.pdf"
    monkeypatch.setattr(QFileDialog, "getSaveFileName", lambda *_: (str(target), ""))
    screens.certificate.save_button.click()
    screens.settle(qtbot)
    source = screens.laboratory.certificate(number)
    assert source is not None
    assert target.read_bytes() == source.read_bytes()
    assert screens.notices[-1][0] == "good"
    monkeypatch.setattr(QFileDialog, "getSaveFileName", lambda *_: (str(tmp_path / "no" / "x.pdf"), ""))
    screens.certificate.record_button.click()
    screens.settle(qtbot)
    assert screens.notices[-1][0] == "bad"


def test_a_signed_file_is_not_called_a_preview_before_it_is_checked(screens: Screens, qtbot: QtBot) -> None:
    open_certificate(screens, qtbot, "issued")
    screens.certificate._show_signing()
    assert screens.certificate.verdict.texts() == ["The signatures are being checked."]


def test_an_unsigned_certificate_cannot_be_saved(screens: Screens, qtbot: QtBot) -> None:
    open_certificate(screens, qtbot, "measured")
    assert not screens.certificate.save_button.isEnabled()
    assert screens.certificate.verdict.texts() == ["A preview: nothing is signed yet."]


def test_a_file_that_is_no_pdf_is_refused(tmp_path: Path) -> None:
    bad = tmp_path / "bad.pdf"
    bad.write_bytes(b"not a pdf")
    with pytest.raises(MachineError, match=r"bad\.pdf"):
        draw_pages(bad, 1.0)
    with pytest.raises(MachineError, match=r"none\.pdf"):
        draw_pages(tmp_path / "none.pdf", 1.0)


def test_pages_are_drawn_in_their_size(tmp_path: Path) -> None:
    from reportlab.lib.pagesizes import A4
    from reportlab.pdfgen.canvas import Canvas

    file = tmp_path / "page.pdf"
    canvas = Canvas(str(file), pagesize=A4)
    canvas.setFillColorRGB(1, 0, 0)
    canvas.rect(0, 0, 100, 100, stroke=0, fill=1)
    canvas.showPage()
    canvas.save()
    picture = draw_pages(file, 2.0).pages[0]
    assert (picture.width(), picture.height()) == (1191, 1684)
    # PDF counts from the bottom: the red corner is at the lower left.
    assert picture.pixelColor(50, 1650).name() == "#ff0000"
    assert picture.pixelColor(50, 50).name() == "#ffffff"
