"""How the run ended, what it left, and what can be done next."""

from __future__ import annotations

from PySide6.QtCore import Signal
from PySide6.QtWidgets import QHBoxLayout, QVBoxLayout

from ahrs_lab.ui.formatting import count
from ahrs_lab.ui.page import Translated
from ahrs_lab.ui.run.model import RunModel
from ahrs_lab.ui.theme import CARD_MARGIN, GAP
from ahrs_lab.ui.translation import said
from ahrs_lab.ui.widgets import Banner, KeyValueTable, Label, PrimaryButton, SecondaryButton

_FACTS = ("segments", "lost", "warnings")
_WARNINGS_SHOWN = 3


class EndView(Translated):
    """``wanted`` names the next action: results, resume, repeat."""

    wanted = Signal(str)

    def __init__(self) -> None:
        super().__init__()
        self._model = RunModel()
        column = QVBoxLayout(self)
        column.setContentsMargins(0, 0, 0, 0)
        column.setSpacing(CARD_MARGIN)
        self.banner = Banner(large=True)
        column.addWidget(self.banner)
        self._facts = KeyValueTable(_FACTS, numbers=False)
        column.addWidget(self._facts)
        self._warnings = Label(tone="warn", wrap=True)
        column.addWidget(self._warnings)
        column.addStretch(1)
        row = QHBoxLayout()
        row.setSpacing(GAP)
        self.repeat = SecondaryButton(icon="repeat")
        self.repeat.clicked.connect(lambda: self.wanted.emit("repeat"))
        self.main = PrimaryButton(large=True)
        self.main.setMinimumWidth(200)
        self.main.clicked.connect(lambda: self.wanted.emit("results" if self._done else "resume"))
        row.addStretch(1)
        row.addWidget(self.repeat)
        row.addWidget(self.main)
        column.addLayout(row)
        self.retranslate()

    @property
    def _done(self) -> bool:
        return self._model.state == "done"

    def refresh(self, model: RunModel) -> None:
        """Look at the model."""
        self._model = model
        reason = said(model.reason) if model.reason is not None else ""
        if model.state == "done":
            self.banner.set_content(
                "good", self.tr("The run is complete"), self.tr("The table rests, the supply is off.")
            )
        elif model.state == "aborted":
            kept = self._kept(
                model, self.tr("The table rests, the supply is off. What was recorded is kept.")
            )
            self.banner.set_content("warn", self.tr("The run was stopped"), f"{reason}\n{kept}".strip())
        else:
            kept = self._kept(model, self.tr("The bench was brought to rest. What was recorded is kept."))
            self.banner.set_content("bad", self.tr("The run could not go on"), f"{reason}\n{kept}".strip())
        self._facts.set_value("segments", count(len(model.segments)))
        self._facts.set_value("lost", count(model.lost), "warn" if model.lost else "text")
        self._facts.set_value("warnings", count(len(model.warnings)))
        shown = [said(warned.what) for warned in model.warnings[:_WARNINGS_SHOWN]]
        if len(model.warnings) > _WARNINGS_SHOWN:
            shown.append(
                self.tr("and {n} more, in the result").format(n=len(model.warnings) - _WARNINGS_SHOWN)
            )
        self._warnings.setText("\n".join(shown))
        self._warnings.setVisible(bool(shown))
        self.repeat.setEnabled(bool(model.on_disk))
        self.main.setText(self.tr("Show the results") if self._done else self.tr("Resume the run"))

    def _kept(self, model: RunModel, safe: str) -> str:
        """Nobody is told that the bench is at rest where it may not be."""
        if not model.unsafe:
            return safe
        return "\n".join([*map(said, model.unsafe), self.tr("What was recorded is kept.")])

    def retranslate(self) -> None:
        """Set every text."""
        self._facts.set_name("segments", self.tr("Segments recorded in this run"))
        self._facts.set_name("lost", self.tr("Samples lost"))
        self._facts.set_name("warnings", self.tr("Warnings"))
        self.repeat.setText(self.tr("Repeat a segment …"))
        self.refresh(self._model)
