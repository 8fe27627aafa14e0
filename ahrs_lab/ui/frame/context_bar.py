"""The bar on top: which job, which device, whose; theme, language, who works."""

from __future__ import annotations

from typing import get_args

from PySide6.QtCore import QEvent, Qt, Signal
from PySide6.QtGui import QAction, QActionGroup
from PySide6.QtWidgets import QFrame, QHBoxLayout, QLabel, QMenu

from ahrs_lab.ui import icons
from ahrs_lab.ui.theme import CARD_MARGIN, STEP, ThemeMode, tokens
from ahrs_lab.ui.translation import language
from ahrs_lab.ui.widgets import ElidedLabel, IconButton, Label, Line, SegmentedSwitch
from ahrs_lab.ui.workspace import Workspace

HEIGHT = 48


class ContextBar(QFrame):
    """``theme_chosen`` and ``language_chosen`` tell what the person wants."""

    theme_chosen = Signal(str)
    language_chosen = Signal(str)

    def __init__(self, workspace: Workspace, theme: ThemeMode) -> None:
        super().__init__()
        self._workspace = workspace
        self.setObjectName("contextBar")
        self.setFixedHeight(HEIGHT)
        row = QHBoxLayout(self)
        row.setContentsMargins(5 * STEP, 0, CARD_MARGIN, 0)
        row.setSpacing(CARD_MARGIN)
        self._job = Label(role="strong")
        self._details = ElidedLabel(tone="muted")
        self._demonstration = Label(tone="warn", role="strong")
        row.addWidget(self._job)
        row.addWidget(self._details, 1)
        row.addWidget(self._demonstration)
        self._theme = IconButton("theme")
        self._theme.setMenu(self._theme_menu(theme))
        row.addWidget(self._theme)
        # Each language is named in itself, so that it is found from the other one.
        self.language = SegmentedSwitch([("zh", "中文"), ("en", "EN")], language())
        self.language.changed.connect(self.language_chosen)
        row.addWidget(self.language)
        line = Line(Qt.Orientation.Vertical)
        line.setFixedHeight(6 * STEP)
        row.addWidget(line)
        self._person_icon = QLabel()
        self._person = Label()
        row.addWidget(self._person_icon)
        row.addWidget(self._person)
        workspace.job_changed.connect(self.retranslate)
        workspace.worker_changed.connect(self.retranslate)
        self.retranslate()
        self._draw_icon()

    def _theme_menu(self, current: ThemeMode) -> QMenu:
        menu = QMenu(self)
        group = QActionGroup(menu)
        self._theme_actions: dict[str, QAction] = {}
        for mode in get_args(ThemeMode):
            action = menu.addAction("")
            action.setCheckable(True)
            action.setChecked(mode == current)
            action.triggered.connect(lambda _checked=False, mode=mode: self.theme_chosen.emit(mode))
            group.addAction(action)
            self._theme_actions[mode] = action
        return menu

    def person(self) -> str:
        """Who works, as it stands there."""
        return self._person.text()

    def theme_action(self, mode: str) -> QAction:
        """The menu's line for a theme."""
        return self._theme_actions[mode]

    def set_theme(self, mode: str) -> None:
        """The theme that is on."""
        self._theme_actions[mode].setChecked(True)

    def set_demonstration(self, demonstration: bool) -> None:
        """Say that nothing here is measured on a real bench."""
        self._demonstration.setProperty("shown", demonstration)
        self.retranslate()

    def retranslate(self) -> None:
        """Set every text."""
        job = self._workspace.job
        self._job.setText(
            self.tr("Job {number}").format(number=job.number) if job else self.tr("No job open")
        )
        parts: list[str] = []
        if job:
            english = language() == "en"
            device = (english and job.device_en) or job.device
            customer = (english and job.customer_en) or job.customer
            if device:
                parts.append(device)
            if job.serial_number:
                parts.append(self.tr("s/n {number}").format(number=job.serial_number))
            if customer:
                parts.append(customer)
        self._details.setText("  ·  ".join(parts))
        shown = bool(self._demonstration.property("shown"))
        self._demonstration.setText(self.tr("Simulated bench") if shown else "")
        self._demonstration.setVisible(shown)
        self._theme.set_hint(self.tr("Light or dark"))
        texts = {"light": self.tr("Light"), "dark": self.tr("Dark"), "system": self.tr("As the system")}
        for mode, action in self._theme_actions.items():
            action.setText(texts[mode])
        self.language.set_current(language())
        worker = self._workspace.worker
        if worker is None:
            self._person.setText(self.tr("Nobody signed in"))
        else:
            self._person.setText(worker.name_en if language() == "en" and worker.name_en else worker.name)

    def _draw_icon(self) -> None:
        self._person_icon.setPixmap(icons.pixmap("person", tokens().muted, 20, self.devicePixelRatioF()))

    def changeEvent(self, event: QEvent) -> None:
        if event.type() == QEvent.Type.LanguageChange:
            self.retranslate()
        elif event.type() == QEvent.Type.PaletteChange and hasattr(self, "_person_icon"):
            self._draw_icon()
        super().changeEvent(event)
