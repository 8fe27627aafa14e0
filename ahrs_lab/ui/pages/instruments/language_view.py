"""The language of an ASCII table, tried text by text: what is sent, what comes back, and what is read out of
it."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import QFrame, QGridLayout, QHBoxLayout, QLineEdit, QScrollArea, QVBoxLayout, QWidget

from ahrs_lab.errors import AhrsLabError
from ahrs_lab.laboratory.instrument_benches import InstrumentBenches, inline
from ahrs_lab.laboratory.instrument_station import StationView
from ahrs_lab.ui.formatting import number
from ahrs_lab.ui.page import Translated
from ahrs_lab.ui.pages.instruments.numbers import NumberField
from ahrs_lab.ui.pages.instruments.session import InstrumentSession
from ahrs_lab.ui.pages.instruments.words import command_names
from ahrs_lab.ui.pages.widgets.form import TextField
from ahrs_lab.ui.pages.widgets.icon_line import IconLine
from ahrs_lab.ui.theme import CARD_MARGIN, GAP, STEP
from ahrs_lab.ui.translation import said
from ahrs_lab.ui.widgets import Card, ElidedLabel, Label, PrimaryButton, SecondaryButton, StateIcon

_LISTS = ("connect", "enable", "rate", "position", "stop", "off")


class LanguageView(Translated):
    """``changed`` gives the template as the person has edited it."""

    changed = Signal(object)

    def __init__(self, session: InstrumentSession, benches: InstrumentBenches) -> None:
        super().__init__()
        self._session, self._benches = session, benches
        self._table: dict[str, Any] = {}
        column = QVBoxLayout(self)
        column.setContentsMargins(0, 0, 0, 0)
        self._card = Card()
        column.addWidget(self._card, 1)
        self._text = Label(tone="muted", wrap=True)
        self._card.add(self._text)
        top = QHBoxLayout()
        top.setSpacing(CARD_MARGIN)
        self.rate, self.angle = NumberField(5.0), NumberField(0.0)
        self.save = PrimaryButton()
        self.save.clicked.connect(self._save)
        top.addWidget(self.rate)
        top.addWidget(self.angle)
        top.addStretch(1)
        top.addWidget(self.save, 0, Qt.AlignmentFlag.AlignBottom)
        self._card.add(top)
        self._card.add(self._make_texts(), 1)
        self.refusal = IconLine("bad", "")
        self.refusal.setVisible(False)
        self._card.add(self.refusal)
        self.retranslate()

    def _make_texts(self) -> QScrollArea:
        inside = QWidget()
        inside.setObjectName("scrolled")
        grid = QGridLayout(inside)
        grid.setContentsMargins(0, 0, GAP, 0)
        grid.setHorizontalSpacing(GAP)
        grid.setVerticalSpacing(STEP)
        self.names: dict[str, Label] = {}
        self.texts: dict[str, QLineEdit] = {}
        self.tries: dict[str, SecondaryButton] = {}
        self.replies: dict[str, ElidedLabel] = {}
        self.marks: dict[str, StateIcon] = {}
        for row, name in enumerate(command_names()):
            text, button, reply, mark = QLineEdit(), SecondaryButton(), ElidedLabel(tone="muted"), StateIcon()
            self.names[name] = Label(tone="muted")
            button.clicked.connect(lambda _on=False, name=name: self._try(name))
            self.texts[name], self.tries[name], self.replies[name], self.marks[name] = (
                text,
                button,
                reply,
                mark,
            )
            for column, widget in enumerate((self.names[name], text, button, mark, reply)):
                grid.addWidget(widget, row, column)
        self.query, self.acknowledgement = TextField(), TextField()
        grid.addWidget(self.query, len(self.texts), 0, 1, 3)
        grid.addWidget(self.acknowledgement, len(self.texts), 3, 1, 2)
        grid.setColumnStretch(1, 5)
        grid.setColumnStretch(4, 4)
        grid.setRowStretch(len(self.texts) + 1, 1)
        area = QScrollArea()
        area.setWidgetResizable(True)
        area.setFrameShape(QFrame.Shape.NoFrame)
        area.setWidget(inside)
        return area

    # content ──────────────────────────────────────────────────────────────────────────────────────────────

    def show_table(self, table: Mapping[str, Any]) -> None:
        """The bench file's table of an ASCII table."""
        self._table = dict(table)
        template = table.get("template", {})
        commands, replies = template.get("commands", {}), template.get("replies", {})
        for name, field in self.texts.items():
            value = commands.get(name, "")
            field.setText(" | ".join(value) if isinstance(value, (list, tuple)) else str(value))
        self.query.set_text(str(replies.get("query", "")))
        self.acknowledgement.set_text(str(replies.get("acknowledgement", "")))
        self.refusal.setVisible(False)
        for name in self.replies:
            self._show_reply(name, "unknown", "")

    def refresh(self, view: StationView | None) -> None:
        """Texts are tried on a table that is connected."""
        usable = view is not None and view.connected and not view.busy
        for button in self.tries.values():
            button.setEnabled(usable)

    def _edited(self) -> dict[str, Any]:
        template = dict(self._table.get("template", {}))
        commands: dict[str, Any] = {}
        for name, field in self.texts.items():
            parts = [part.strip() for part in field.text().split("|") if part.strip()]
            if parts:
                commands[name] = parts if name in _LISTS else parts[0]
        replies = {**template.get("replies", {}), "query": self.query.text()}
        replies["acknowledgement"] = self.acknowledgement.text()
        return {**self._table, "template": {**template, "commands": commands, "replies": replies}}

    # actions ──────────────────────────────────────────────────────────────────────────────────────────────

    def _save(self) -> None:
        table = self._edited()
        settings = {key: value for key, value in table.items() if key != "driver"}
        try:
            self._benches.with_instrument({}, "table", str(table.get("driver", "")), settings)
        except AhrsLabError as error:
            self.refusal.set_content("bad", said(error.message))
            self.refusal.setVisible(True)
            return
        self.refusal.setVisible(False)
        self.changed.emit(table)

    def _try(self, name: str) -> None:
        rate, angle = self.rate.value() or 0.0, self.angle.value() or 0.0
        self._show_reply(name, "unknown", "…")
        self._session.attempt(
            lambda desk: desk.try_text(name, rate_dps=rate, angle_deg=angle),
            lambda trials: self._tried(name, trials),
        )

    def _tried(self, name: str, trials: Any) -> None:
        parts, good = [], True
        for trial in trials:
            reply = self.tr("no reply") if trial.reply is None else inline(trial.reply)
            text = f"{trial.sent}  →  {reply}"
            if trial.reading is not None:
                rate = number(trial.reading.rate_dps, 3)
                text += f"  =  {number(trial.reading.angle_deg, 3)}°, {rate} °/s"
            parts.append(text)
            good = good and trial.good
        self._show_reply(name, "good" if good else "bad", ";  ".join(parts))

    def _show_reply(self, name: str, state: str, text: str) -> None:
        self.replies[name].setText(text)
        self.marks[name].setVisible(bool(text))
        self.marks[name].set_state(state)  # type: ignore[arg-type]

    def retranslate(self) -> None:
        self._card.set_title(self.tr("Language of the table"))
        self._text.setText(
            self.tr(
                "Each text is said to the table and its reply is shown. {rate} and {angle} are filled in; "
                "several "
                "texts of one command stand apart by |. Those that turn or point move the table."
            )
        )
        self.rate.set_name(self.tr("Rate to try, °/s"))
        self.angle.set_name(self.tr("Angle to try, °"))
        self.save.setText(self.tr("Save and connect again"))
        for name, text in command_names().items():
            self.names[name].setText(text)
            self.texts[name].setAccessibleName(text)
            self.tries[name].setText(self.tr("Try"))
        self.query.set_name(self.tr("How the reply to the query is read (regular expression)"))
        self.acknowledgement.set_name(self.tr("How a good reply begins"))
