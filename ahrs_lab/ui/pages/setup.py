"""The page Set-up: the laboratory, its people, its standards, and the look of the screen."""

from __future__ import annotations

from PySide6.QtCore import Signal
from PySide6.QtWidgets import QHBoxLayout, QStackedWidget, QVBoxLayout, QWidget

from ahrs_lab.ui.page import Page
from ahrs_lab.ui.pages.desk import Desk
from ahrs_lab.ui.pages.setup_people import PeoplePanel
from ahrs_lab.ui.pages.setup_profile import ProfilePanel
from ahrs_lab.ui.pages.setup_standards import StandardsPanel
from ahrs_lab.ui.pages.widgets.tabs import Tabs
from ahrs_lab.ui.theme import CARD_MARGIN, GAP
from ahrs_lab.ui.translation import language
from ahrs_lab.ui.widgets import Card, Label, SegmentedSwitch


class SetupPage(Page):
    """``language_chosen`` and ``theme_chosen`` ask the application for another look."""

    key = "setup"
    language_chosen = Signal(str)
    theme_chosen = Signal(str)

    def __init__(self, desk: Desk) -> None:
        super().__init__(desk.workspace)
        self._desk = desk
        self._title = Label(role="title")
        self.outer.addWidget(self._title)
        card = Card()
        self.tabs = Tabs()
        self._stack = QStackedWidget()
        self.profile, self.people, self.standards = (
            ProfilePanel(desk),
            PeoplePanel(desk),
            StandardsPanel(desk),
        )
        for panel in (self.standards, self.people, self.profile, self._make_screen()):
            self._stack.addWidget(panel)
        self.tabs.currentChanged.connect(self._stack.setCurrentIndex)
        card.add(self.tabs)
        card.add(self._stack, 1)
        self.outer.addWidget(card, 1)
        desk.actor_changed.connect(self.entered)
        self.retranslate()

    def _make_screen(self) -> QWidget:
        whole = QWidget()
        column = QVBoxLayout(whole)
        column.setContentsMargins(0, CARD_MARGIN, 0, 0)
        column.setSpacing(CARD_MARGIN)
        self._language_name, self._theme_name = Label(tone="muted"), Label(tone="muted")
        # Each language is named in itself, so that it is found from the other one.
        self.language = SegmentedSwitch([("zh", "中文"), ("en", "English")], language())
        self.language.changed.connect(self.language_chosen)
        self.language_chosen.connect(self.workspace.language_chosen)
        self.theme_chosen.connect(self.workspace.theme_chosen)
        self.theme = SegmentedSwitch([("light", ""), ("dark", ""), ("system", "")], "system")
        self.theme.changed.connect(self.theme_chosen)
        for name, switch in ((self._language_name, self.language), (self._theme_name, self.theme)):
            row = QHBoxLayout()
            row.setSpacing(GAP)
            name.setFixedWidth(160)
            row.addWidget(name)
            row.addWidget(switch)
            row.addStretch(1)
            column.addLayout(row)
        column.addStretch(1)
        return whole

    def entered(self) -> None:
        for panel in (self.profile, self.people, self.standards):
            panel.refresh()
        self.theme.set_current(self._desk.laboratory.settings.theme)

    def retranslate(self) -> None:
        self._title.setText(self.tr("Set-up"))
        self.tabs.set_texts(self.tr("Standards"), self.tr("People"), self.tr("Laboratory"), self.tr("Screen"))
        self._language_name.setText(self.tr("Language"))
        self._theme_name.setText(self.tr("Appearance"))
        self.theme.set_texts(
            [("light", self.tr("Light")), ("dark", self.tr("Dark")), ("system", self.tr("As the system"))]
        )
        self.language.set_current(language())
