"""What one analysis is asked and what it answered: its recordings, its settings, the last outcome. It stays
as it was left while another analysis is in front."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import QFrame, QHBoxLayout, QScrollArea, QVBoxLayout, QWidget

from ahrs_lab.laboratory.analyses.kinds import AnalysisKind, Outcome, Value
from ahrs_lab.messages import Message
from ahrs_lab.ui.page import Translated
from ahrs_lab.ui.pages.analysis.recording_field import RecordingField
from ahrs_lab.ui.pages.analysis.recordings import RecordingShelf
from ahrs_lab.ui.pages.analysis.setting_fields import SettingField, field_of
from ahrs_lab.ui.theme import CARD_MARGIN
from ahrs_lab.ui.translation import said
from ahrs_lab.ui.widgets import Label, QuietButton


@dataclass(frozen=True)
class Asked:
    """What an analysis is started with."""

    bundles: tuple[Path, ...]
    settings: Mapping[str, Value]


class KindForm(Translated):
    """``edited`` tells every change by the person, ``submitted`` that Return was pressed in a field."""

    edited = Signal()
    submitted = Signal()

    def __init__(self, kind: AnalysisKind, shelf: RecordingShelf) -> None:
        super().__init__()
        self.kind = kind
        self.outcome: Outcome | None = None
        self.answered: Asked | None = None
        """What ``outcome`` is the answer to."""
        self.error: Message | None = None
        self.running = False
        self.again = False
        """Something changed while it ran."""
        self.recordings = [
            RecordingField(label, shelf, offer=place == 0) for place, label in enumerate(kind.inputs)
        ]
        self.fields: dict[str, SettingField] = {setting.key: field_of(setting) for setting in kind.settings}
        outer = QVBoxLayout(self)
        outer.setContentsMargins(0, 0, 0, 0)
        inside = QWidget()
        inside.setObjectName("scrolled")
        self._column = QVBoxLayout(inside)
        self._column.setContentsMargins(0, 0, 2, 0)
        self._column.setSpacing(CARD_MARGIN)
        area = QScrollArea()
        area.setFrameShape(QFrame.Shape.NoFrame)
        area.setWidgetResizable(True)
        area.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        area.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        area.setWidget(inside)
        outer.addWidget(area)
        self._lay_out()
        self.retranslate()

    def _lay_out(self) -> None:
        self._explains = Label(tone="muted", wrap=True)
        self._column.addWidget(self._explains)
        for recording in self.recordings:
            recording.edited.connect(self.edited)
            self._column.addWidget(recording)
        head = QHBoxLayout()
        self._settings_title = Label(role="strong")
        self.defaults = QuietButton(icon="repeat")
        self.defaults.clicked.connect(self.put_defaults)
        head.addWidget(self._settings_title, 1)
        head.addWidget(self.defaults)
        for widget in (self._settings_title, self.defaults):
            widget.setVisible(bool(self.fields))
        self._column.addLayout(head)
        for field in self.fields.values():
            field.edited.connect(self.edited)
            field.submitted.connect(self.submitted)
            self._column.addWidget(field)
        self._column.addStretch(1)

    def asked(self) -> Asked | None:
        """What to start with; None where something is missing or wrong, which is said at its field."""
        missing = [recording.missing() for recording in self.recordings]
        values = {key: field.read() for key, field in self.fields.items()}
        settings = {key: value for key, value in values.items() if value is not None}
        if any(missing) or len(settings) < len(values):
            return None
        paths = [recording.path() for recording in self.recordings]
        return Asked(tuple(path for path in paths if path is not None), settings)

    def changed(self) -> bool:
        """Whether the outcome is not the answer to what stands here now."""
        if self.outcome is None or self.answered is None:
            return False
        paths = tuple(recording.path() for recording in self.recordings)
        if paths != self.answered.bundles:
            return True
        return any(field.read() != self.answered.settings[key] for key, field in self.fields.items())

    def put_defaults(self) -> None:
        """Each setting as it is proposed; recordings stay."""
        for field in self.fields.values():
            field.put(field.setting.default)
        self.edited.emit()

    def take(self, paths: list[Path]) -> None:
        """Recordings that were dropped: one each, the fields without one first."""
        order = sorted(self.recordings, key=lambda recording: recording.path() is not None)
        for recording, path in zip(order, paths, strict=False):
            recording.choose(path)

    def refresh(self) -> None:
        """Other recordings may be on offer."""
        for recording in self.recordings:
            recording.refresh()

    def retranslate(self) -> None:
        self._explains.setText(said(self.kind.explains))
        self._settings_title.setText(self.tr("Settings"))
        self.defaults.setText(self.tr("Defaults"))
        for field in self.fields.values():
            field.retranslate()
