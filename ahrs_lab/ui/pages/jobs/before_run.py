"""The card "Before the run": a check list that is always in sight while a job is edited."""

from __future__ import annotations

from dataclasses import dataclass

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QScrollArea, QVBoxLayout, QWidget

from ahrs_lab.messages import Message
from ahrs_lab.ui.formatting import duration
from ahrs_lab.ui.pages.jobs.checks import Estimate, Missing
from ahrs_lab.ui.pages.widgets.icon_line import IconLine
from ahrs_lab.ui.theme import CARD_MARGIN
from ahrs_lab.ui.translation import said
from ahrs_lab.ui.widgets import Card, Label, Panel


@dataclass(frozen=True)
class Readiness:
    """All that the list shows. ``plan_ok`` False: the plan cannot be run and says so at its field.
    ``limits``: why the limits cannot be stored, None where they can."""

    missing: tuple[Missing, ...]
    violations: tuple[Message, ...]
    plan_ok: bool
    deviations: tuple[Message, ...]
    estimate: Estimate | None
    limits: Message | None = None
    by_standard: bool = True
    """The plan is one of JJF 1536."""
    limits_unused: bool = False
    """There are limits, but not of what the plan finds."""


class BeforeRunCard(Card):
    """``show_readiness`` replaces the whole list."""

    def __init__(self) -> None:
        super().__init__()
        self._found: Readiness | None = None
        self._time = Panel("accent")
        self._time_caption = Label(tone="muted")
        self._time_value = Label(role="title", tone="accent")
        self._time_detail = Label(tone="muted", wrap=True)
        for label in (self._time_caption, self._time_value, self._time_detail):
            self._time.body.addWidget(label)
        area = QScrollArea()
        area.setWidgetResizable(True)
        area.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        area.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        inside = QWidget()
        inside.setObjectName("scrolled")
        self._list = QVBoxLayout(inside)
        self._list.setContentsMargins(0, 0, 0, 0)
        self._list.setSpacing(CARD_MARGIN)
        self._list.addStretch(1)
        area.setWidget(inside)
        self.add(area, 1)
        self.add(self._time)
        self.retranslate()

    def show_readiness(self, found: Readiness) -> None:
        """Icons and sentences, the worst first."""
        self._found = found
        while self._list.count() > 1:
            item = self._list.takeAt(0)
            widget = item.widget() if item is not None else None
            if widget is not None:
                widget.hide()
                widget.deleteLater()
        for place, line in enumerate(self._lines(found)):
            self._list.insertWidget(place, line)
        self._time.setVisible(found.estimate is not None)
        if found.estimate is not None:
            self._time_value.setText(duration(found.estimate.seconds))
            self._time_detail.setText(
                self.tr("of bench time; mountings: {count}").format(count=found.estimate.mountings)
            )

    def texts(self) -> list[str]:
        """The sentences as they stand there."""
        labels: list[str] = []
        for place in range(self._list.count()):
            item = self._list.itemAt(place)
            widget = item.widget() if item is not None else None
            if widget is not None:
                labels += [label.text() for label in widget.findChildren(Label)]
        return labels

    def _lines(self, found: Readiness) -> list[QWidget]:
        words = self._missing_words()
        lines: list[QWidget] = [IconLine("bad", words[key]) for key in found.missing]
        lines += [IconLine("bad", said(message)) for message in found.violations]
        if found.limits is not None:
            lines.append(IconLine("bad", self.tr("A limit is not right: see the tab Limits.")))
        if not found.plan_ok:
            lines.append(IconLine("bad", self.tr("The plan cannot be run as it stands: see the tab Plan.")))
        lines += [IconLine("warn", said(message)) for message in found.deviations]
        if found.limits_unused:
            lines.append(
                IconLine(
                    "warn",
                    self.tr("No conformity is stated: the limits are of quantities of JJF 1536-2015."),
                )
            )
        if not found.missing:
            lines.append(IconLine("good", self.tr("Customer, device and people are entered.")))
        if not found.violations and "standards" not in found.missing:
            lines.append(IconLine("good", self.tr("The standards satisfy clause 6.")))
        if found.plan_ok:
            if not found.by_standard:
                text = self.tr("The plan can be run.")
            elif found.deviations:
                text = self.tr(
                    "The plan can be run; what leaves the standard goes into the record and the certificate."
                )
            else:
                text = self.tr("The plan follows JJF 1536-2015.")
            lines.append(IconLine("good", text))
        return lines

    def _missing_words(self) -> dict[Missing, str]:
        return {
            "customer": self.tr("Enter the customer."),
            "device": self.tr("Enter the device's name or model."),
            "standards": self.tr("Choose the standards used."),
            "operator": self.tr("Choose the operator."),
            "verifier": self.tr("Choose the verifier."),
            "approver": self.tr("Choose the approver."),
            "bench": self.tr("Choose the bench."),
        }

    def retranslate(self) -> None:
        """Called by the editor, which hears of the language."""
        self.set_title(self.tr("Before the run"))
        self._time_caption.setText(self.tr("This plan takes"))
        if self._found is not None:
            self.show_readiness(self._found)
