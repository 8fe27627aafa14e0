"""What verification says of the signed file: intact, signed by whom, changed since."""

from __future__ import annotations

from PySide6.QtCore import Signal
from PySide6.QtWidgets import QVBoxLayout

from ahrs_lab.certificates.verify import SignatureReport, VerificationReport
from ahrs_lab.ui.pages.widgets.icon_line import IconLine
from ahrs_lab.ui.pages.words import listed, role_names
from ahrs_lab.ui.theme import GAP
from ahrs_lab.ui.translation import said
from ahrs_lab.ui.widgets import Card, IconButton


class VerdictCard(Card):
    """``again`` asks for another look at the file."""

    again = Signal()

    def __init__(self) -> None:
        super().__init__()
        self._button = IconButton("repeat")
        self._button.clicked.connect(self.again)
        self.add_tool(self._button)
        self._lines = QVBoxLayout()
        self._lines.setSpacing(GAP)
        self.add(self._lines)
        self.show_unsigned()

    def show_unsigned(self) -> None:
        """Nothing to verify yet."""
        self._name()
        self._button.setVisible(False)
        self._replace([("info", self.tr("A preview: nothing is signed yet."))])

    def show_checking(self) -> None:
        """A signed file whose report is not there yet."""
        self._name()
        self._button.setVisible(False)
        self._replace([("info", self.tr("The signatures are being checked."))])

    def show_report(self, report: VerificationReport) -> None:
        """Every statement with its mark, never colour alone."""
        self._name()
        self._button.setVisible(True)
        state = "good" if report.valid else "warn" if report.intact else "bad"
        lines = [(state, self._summary(report))]
        if report.changed_since is not None:
            lines.append(("bad", said(report.changed_since)))
        # Who signed when stands beside each signature already; here only what is wrong with one.
        lines += [
            self._signature(signature)
            for signature in report.signatures
            if signature.problems or not (signature.trusted and signature.intact)
        ]
        self._replace(lines)

    def texts(self) -> list[str]:
        """The sentences as they stand there."""
        found: list[str] = []
        for place in range(self._lines.count()):
            item = self._lines.itemAt(place)
            widget = item.widget() if item is not None else None
            if isinstance(widget, IconLine):
                found.append(widget.text())
        return found

    def _summary(self, report: VerificationReport) -> str:
        """The report's own words name the signers as their certificates do; where all is well the signatures
        beside say it in the words of the screen."""
        if not report.valid:
            return said(report.summary)
        if report.unsigned_fields:
            names = {str(role): name for role, name in role_names().items()}
            missing = listed(names.get(field, field) for field in report.unsigned_fields)
            return self.tr("Intact; not yet signed: {roles}").format(roles=missing)
        return self.tr("Intact and unchanged since the last signature")

    def _signature(self, signature: SignatureReport) -> tuple[str, str]:
        role = {str(key): text for key, text in role_names().items()}.get(signature.role, signature.role)
        when = signature.signed_at.astimezone().strftime("%Y-%m-%d %H:%M") if signature.signed_at else "–"
        words = self.tr("{role}: {name}, {when}").format(role=role, name=signature.signer, when=when)
        if signature.problems:
            return ("bad", words + "; " + " ".join(said(problem) for problem in signature.problems))
        if not signature.intact:
            return ("bad", words)
        return ("warn", words + "; " + self.tr("the signer is not known to this laboratory"))

    def _replace(self, lines: list[tuple[str, str]]) -> None:
        while self._lines.count():
            item = self._lines.takeAt(0)
            widget = item.widget() if item is not None else None
            if widget is not None:
                widget.hide()
                widget.deleteLater()
        for state, text in lines:
            self._lines.addWidget(IconLine(state, text))

    def _name(self) -> None:
        self.set_title(self.tr("Verification"))
        self._button.set_hint(self.tr("Verify again"))
