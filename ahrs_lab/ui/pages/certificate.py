"""The page Certificate: as the customer will see it, who signs, and whether it is still what was signed."""

from __future__ import annotations

import shutil
from pathlib import Path

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QFileDialog, QHBoxLayout, QScrollArea, QStackedWidget, QVBoxLayout, QWidget

from ahrs_lab.certificates.job_sheet import CertificateLanguage
from ahrs_lab.certificates.verify import VerificationReport
from ahrs_lab.errors import AhrsLabError, MachineError
from ahrs_lab.metrology.result import CalibrationResult
from ahrs_lab.records.rows import JobRow, SigningRole
from ahrs_lab.ui.page import Page
from ahrs_lab.ui.pages.certificate_model import SIGNING_ORDER, signing_places
from ahrs_lab.ui.pages.certificate_signing import SignDialog, SignPanel
from ahrs_lab.ui.pages.certificate_verdict import VerdictCard
from ahrs_lab.ui.pages.desk import Desk
from ahrs_lab.ui.pages.jobs.send_back_dialog import SendBackDialog
from ahrs_lab.ui.pages.pdf_pages import PdfPicture, draw_pages
from ahrs_lab.ui.pages.widgets.pdf_view import PdfView
from ahrs_lab.ui.pages.widgets.tick_box import TickBox
from ahrs_lab.ui.theme import CARD_MARGIN, GAP
from ahrs_lab.ui.widgets import (
    Card,
    ElidedLabel,
    EmptyState,
    IconButton,
    Label,
    ProgressBar,
    QuietButton,
    SecondaryButton,
    SegmentedSwitch,
)

CERTIFICATE_LANGUAGES: tuple[CertificateLanguage, ...] = ("bilingual", "zh", "en")
_SIDE_PX = 348
_SHARPEST = 3.0
_A4_POINTS = 595.0


class CertificatePage(Page):
    """The signed certificate where there is one, else its preview."""

    key = "certificate"

    def __init__(self, desk: Desk) -> None:
        super().__init__(desk.workspace)
        self._desk = desk
        self._job: JobRow | None = None
        self._shown: Path | None = None
        self._has_budgets = True
        self._stack = QStackedWidget()
        self.outer.addWidget(self._stack)
        self._empty = EmptyState("certificate")
        self._empty.pressed.connect(lambda: self.workspace.go_to("jobs"))
        self._stack.addWidget(self._empty)
        whole = QWidget()
        row = QHBoxLayout(whole)
        row.setContentsMargins(0, 0, 0, 0)
        row.setSpacing(CARD_MARGIN)
        row.addWidget(self._make_preview(), 1)
        row.addWidget(self._make_side())
        self._stack.addWidget(whole)
        desk.jobs_changed.connect(self._changed)
        desk.actor_changed.connect(self._show_signing)
        self.retranslate()

    # layout ---------------------------------------------------------------------------------------------

    def _make_preview(self) -> Card:
        card = Card()
        head = QHBoxLayout()
        head.setSpacing(GAP)
        self.language = SegmentedSwitch([("bilingual", ""), ("zh", "中文"), ("en", "English")], "bilingual")
        self.language.changed.connect(lambda _key: self._render())
        self.budget_annex = TickBox()
        self.budget_annex.toggled.connect(lambda _on: self._render())
        self._page_label = Label(tone="muted")
        self._busy = ProgressBar()
        self._busy.setFixedWidth(100)
        self._busy.setVisible(False)
        self._smaller, self._larger = IconButton("zoom_out"), IconButton("zoom_in")
        self._smaller.clicked.connect(lambda: self._zoom(-1))
        self._larger.clicked.connect(lambda: self._zoom(1))
        self._file = ElidedLabel(role="strong")
        head.addWidget(self.language)
        head.addWidget(self.budget_annex)
        head.addWidget(self._file, 1)
        for widget in (self._busy, self._page_label, self._smaller, self._larger):
            head.addWidget(widget, 0, Qt.AlignmentFlag.AlignVCenter)
        self.view = PdfView()
        self.view.page_changed.connect(lambda _page: self._name_page())
        card.add(head)
        card.add(self.view, 1)
        return card

    def _make_side(self) -> QWidget:
        inside = QWidget()
        inside.setObjectName("scrolled")
        column = QVBoxLayout(inside)
        column.setContentsMargins(0, 0, 0, 0)
        column.setSpacing(CARD_MARGIN)
        self._signing_card = Card()
        self.panels: dict[SigningRole, SignPanel] = {}
        for role in SIGNING_ORDER:
            panel = SignPanel(role)
            panel.sign_wanted.connect(self._sign)
            panel.sign_in_wanted.connect(self._sign_in)
            self.panels[role] = panel
            self._signing_card.add(panel)
        self.send_back = QuietButton(icon="back")
        self.send_back.clicked.connect(self._send_back)
        self._signing_card.add(self.send_back)
        column.addWidget(self._signing_card)
        self.verdict = VerdictCard()
        self.verdict.again.connect(self._verify)
        column.addWidget(self.verdict)
        self._files_card = Card()
        self.save_button = SecondaryButton(icon="export")
        self.save_button.clicked.connect(self._save)
        self.record_button = SecondaryButton(icon="record")
        self.record_button.clicked.connect(self._original_record)
        self._files_card.add(self.save_button)
        self._files_card.add(self.record_button)
        column.addWidget(self._files_card)
        column.addStretch(1)
        area = QScrollArea()
        area.setWidgetResizable(True)
        area.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        area.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        area.setWidget(inside)
        area.setFixedWidth(_SIDE_PX)
        return area

    # content --------------------------------------------------------------------------------------------

    def entered(self) -> None:
        self.refresh()

    def job_changed(self) -> None:
        if self.isVisible():
            self.refresh()

    def _changed(self) -> None:
        if self.isVisible():
            self.refresh()

    def refresh(self) -> None:
        """Look at the open job again."""
        number, laboratory = self._desk.number, self._desk.laboratory
        self._job = None
        try:
            result = laboratory.result(number) if number else None
            if result is not None:
                self._job = laboratory.job(number)
            self._has_budgets = isinstance(result, CalibrationResult)
        except AhrsLabError as error:
            self._desk.tell(error)
        self._stack.setCurrentIndex(1 if self._job is not None else 0)
        self._name_empty()
        if self._job is not None:
            self._show_signing()
            self._render()

    def _show_signing(self) -> None:
        if self._job is None:
            return
        signatures = self._desk.laboratory.signatures(self._job.number)
        actor = self._desk.actor.person if self._desk.actor is not None else None
        for place in signing_places(self._job, signatures, actor):
            self.panels[place.role].show_place(place)
        signed = bool(signatures)
        self.language.setVisible(not signed)
        self.budget_annex.setVisible(not signed and self._has_budgets)
        self._file.setText(f"{self._job.certificate_number}.pdf" if signed else "")
        may_send_back = self._job.state == "checked" and actor is not None and "approver" in actor.roles
        self.send_back.setVisible(may_send_back)
        self.save_button.setEnabled(signed)
        if signed:
            self.verdict.show_checking()  # never the verdict on the file before
        else:
            self.verdict.show_unsigned()

    def _chosen_language(self) -> CertificateLanguage:
        return next((key for key in CERTIFICATE_LANGUAGES if key == self.language.current()), "bilingual")

    def _render(self) -> None:
        """Lay out (where nothing is signed) and draw, in the worker."""
        if self._job is None:
            return
        number, laboratory, chosen = self._job.number, self._desk.laboratory, self._chosen_language()
        annex = self.budget_annex.isChecked()
        scale = min(max(self.view.wanted_width() / _A4_POINTS, 1.0), _SHARPEST)
        self._set_busy(True)

        def work() -> tuple[PdfPicture, VerificationReport | None]:
            signed = laboratory.certificate(number)
            file = signed or laboratory.draft_certificate(number, chosen, budget_annex=annex)
            report = laboratory.verify(file) if signed else None
            return draw_pages(file, scale), report

        self._desk.run(self, work, self._drawn, self._not_drawn, topic="pages")

    def _drawn(self, found: tuple[PdfPicture, VerificationReport | None]) -> None:
        picture, report = found
        self._set_busy(False)
        self.view.show_pages(picture.pages, keep_place=self._shown == picture.file)
        self._shown = picture.file
        self._name_page()
        if report is not None:
            self.verdict.show_report(report)

    def _not_drawn(self, error: AhrsLabError) -> None:
        self._set_busy(False)
        self._desk.tell(error)

    def _set_busy(self, busy: bool) -> None:
        self._busy.set_value(None if busy else 0.0)
        self._busy.setVisible(busy)

    def _zoom(self, step: int) -> None:
        self.view.zoom(step)
        self._render()

    # actions --------------------------------------------------------------------------------------------

    def _sign_in(self, role: SigningRole) -> None:
        person = getattr(self._job, role) if self._job is not None else None
        self._desk.change_actor(self, person.name if person is not None else "")

    def _sign(self, role: SigningRole) -> None:
        actor = self._desk.ask_actor(self)
        if actor is None or self._job is None:
            return
        dialog = SignDialog(
            self._desk,
            self._job.number,
            role,
            actor,
            self._chosen_language(),
            self,
            budget_annex=self.budget_annex.isChecked(),
        )
        signed = dialog.exec()
        dialog.deleteLater()
        if signed:
            self._desk.changed()
            if not self.isVisible():
                self.refresh()

    def _send_back(self) -> None:
        actor = self._desk.ask_actor(self)
        if actor is None or self._job is None:
            return
        dialog = SendBackDialog(self._job.number, self)
        accepted, reason = bool(dialog.exec()), dialog.reason_text()
        dialog.deleteLater()
        if not accepted:
            return
        try:
            self._desk.laboratory.send_back(self._job.number, actor, reason)
        except AhrsLabError as error:
            self._desk.tell(error)
        self._desk.changed()

    def _verify(self) -> None:
        if self._job is None:
            return
        number, laboratory = self._job.number, self._desk.laboratory

        def work() -> VerificationReport | None:
            signed = laboratory.certificate(number)
            return laboratory.verify(signed) if signed else None

        self._desk.run(
            self, work, lambda report: self.verdict.show_report(report) if report else None, topic="verify"
        )

    def _save(self) -> None:
        if self._job is None:
            return
        number, laboratory = self._job.number, self._desk.laboratory
        target = self._ask_target(f"{self._job.certificate_number}.pdf")
        if target is not None:
            self._desk.run(
                self, lambda: _copy(laboratory.certificate(number), target), self._saved, topic="save"
            )

    def _original_record(self) -> None:
        if self._job is None:
            return
        number, laboratory = self._job.number, self._desk.laboratory
        target = self._ask_target(f"{number}-original-record.pdf")
        if target is not None:
            self._desk.run(
                self, lambda: _copy(laboratory.original_record(number), target), self._saved, topic="save"
            )

    def _ask_target(self, name: str) -> Path | None:
        path, _ = QFileDialog.getSaveFileName(
            self, self.tr("Save as"), str(Path.home() / name), self.tr("PDF files (*.pdf)")
        )
        return Path(path) if path else None

    def _saved(self, target: Path) -> None:
        self.workspace.notice("good", self.tr("Saved as {path}.").format(path=target))

    # words ----------------------------------------------------------------------------------------------

    def _name_page(self) -> None:
        page, count = self.view.current_page(), self.view.count()
        self._page_label.setText(
            self.tr("page {page} of {count}").format(page=page, count=count) if count else ""
        )

    def _name_empty(self) -> None:
        if self._desk.number:
            self._empty.set_content(
                self.tr("No certificate yet"),
                self.tr(
                    "After the calibration is measured, its certificate will be here to look at and to sign."
                ),
                self.tr("Go to the job"),
            )
        else:
            self._empty.set_content(
                self.tr("No job is open"),
                self.tr("Open a measured job to look at its certificate and to sign it."),
                self.tr("Choose a job"),
            )

    def retranslate(self) -> None:
        self.language.set_texts([("bilingual", self.tr("Bilingual"))])
        self.budget_annex.setText(self.tr("Uncertainty budgets"))
        self.budget_annex.setToolTip(self.tr("With the uncertainty budgets as annex pages"))
        self._smaller.set_hint(self.tr("Smaller"))
        self._larger.set_hint(self.tr("Larger"))
        self._signing_card.set_title(self.tr("Signatures"))
        self._files_card.set_title(self.tr("Files"))
        self.send_back.setText(self.tr("Send back for a new certificate …"))
        self.save_button.setText(self.tr("Save the certificate as …"))
        self.record_button.setText(self.tr("Save the original record as …"))
        self._name_empty()
        self._name_page()


def _copy(source: Path | None, target: Path) -> Path:
    if source is None:
        raise MachineError("There is no signed certificate yet.")
    try:
        shutil.copyfile(source, target)
    except OSError as error:
        raise MachineError(
            "Cannot write into {path}: {reason}. Free space or choose another folder; "
            "nothing recorded is lost.",
            path=target,
            reason=error.strerror or str(error),
        ) from error
    return target
