"""The window: rail, context, the page in front, health, STOP. It knows pages only as
:class:`~ahrs_lab.ui.page.Page`."""

from __future__ import annotations

import sys

from PySide6.QtCore import QEvent, QRectF, Qt, QTimer
from PySide6.QtGui import QCloseEvent, QIcon, QKeySequence, QPainter, QPixmap, QShortcut
from PySide6.QtWidgets import QHBoxLayout, QMessageBox, QStackedWidget, QVBoxLayout, QWidget

from ahrs_lab.messages import Message
from ahrs_lab.ui.frame.context_bar import ContextBar
from ahrs_lab.ui.frame.health_strip import HealthStrip
from ahrs_lab.ui.frame.navigation_rail import NavigationRail, paint_emblem
from ahrs_lab.ui.frame.stop_bar import StopBar
from ahrs_lab.ui.page import Page, PageEntry, page_title
from ahrs_lab.ui.theme import CARD_MARGIN, ThemeMode
from ahrs_lab.ui.translation import said
from ahrs_lab.ui.widgets import Banner
from ahrs_lab.ui.workspace import Workspace

SMALLEST = (1024, 680)
FIRST_SIZE = (1366, 768)
IDLE_MS = 150


class MainWindow(QWidget):
    """Pages in the order in which they are added. ``pages`` holds those that are made already."""

    def __init__(self, workspace: Workspace, *, theme: ThemeMode = "system") -> None:
        super().__init__()
        self.workspace = workspace
        self.setWindowIcon(_icon())
        self.setMinimumSize(*SMALLEST)
        self.resize(*FIRST_SIZE)
        self.pages: dict[str, Page] = {}
        self._entries: dict[str, PageEntry] = {}
        self._failed: set[str] = set()
        """Pages whose making raised: made again only when somebody asks for them."""
        self._idle = QTimer(self, interval=IDLE_MS)
        self._idle.timeout.connect(self._make_idly)
        self.rail = NavigationRail()
        self.context = ContextBar(workspace, theme)
        self.notice = Banner(closable=True)
        self.notice.setVisible(False)
        self._notice_kind = ""
        self.stack = QStackedWidget()
        self.health = HealthStrip(workspace)
        self.stop_bar = StopBar(workspace)
        self._lay_out()
        self.rail.chosen.connect(self.show_page)
        workspace.page_requested.connect(self.show_page)
        workspace.noticed.connect(self._show_notice)
        workspace.run_starting.connect(self.make_all_pages)
        for signal in (workspace.run.started, workspace.run.ended):
            signal.connect(self._mark_run)
        escape = QShortcut(QKeySequence(Qt.Key.Key_Escape), self)
        escape.activated.connect(self.stop_bar.stop)
        self.retranslate()

    def _lay_out(self) -> None:
        row = QHBoxLayout(self)
        row.setContentsMargins(0, 0, 0, 0)
        row.setSpacing(0)
        column = QVBoxLayout()
        column.setSpacing(0)
        row.addWidget(self.rail)
        row.addLayout(column, 1)
        banner = QVBoxLayout()
        banner.setContentsMargins(CARD_MARGIN, CARD_MARGIN, CARD_MARGIN, 0)
        banner.addWidget(self.notice)
        self._notice_room = QWidget()
        self._notice_room.setLayout(banner)
        self._notice_room.setVisible(False)
        self.notice.closed.connect(self._close_notice)
        column.addWidget(self.context)
        column.addWidget(self._notice_room)
        column.addWidget(self.stack, 1)
        column.addWidget(self.health)
        column.addWidget(self.stop_bar)

    def add_page(self, page: Page) -> None:
        """Register a page that is made; the first one is in front."""
        self.add_entry(PageEntry(page.key, lambda: page))
        self._make(page.key)

    def add_entry(self, entry: PageEntry) -> None:
        """Register a page; the first one is made and in front."""
        self._entries[entry.key] = entry
        self.rail.add(entry.key)
        self.retranslate()
        if len(self._entries) == 1:
            self.show_page(entry.key)

    def make_next_page(self) -> bool:
        """Make one page that is not made yet; False where none is left to make."""
        left = [key for key in self._entries if key not in self.pages and key not in self._failed]
        if not left:
            return False
        self._make(left[0])
        return True

    def make_pages_when_idle(self) -> None:
        """One page after another while the person looks at the first."""
        self._idle.start()

    def _make_idly(self) -> None:
        if not self.make_next_page():
            self._idle.stop()

    def make_all_pages(self) -> None:
        """Before a run: each page hears of it from its beginning. One that cannot be made is told, and
        keeps no other from being made."""
        while True:
            try:
                if not self.make_next_page():
                    return
            except Exception as error:
                sys.excepthook(type(error), error, error.__traceback__)

    def _make(self, key: str) -> Page | None:
        if key not in self.pages and key in self._entries:
            self._failed.add(key)
            page = self._entries[key].make()
            self._failed.discard(key)
            self.pages[key] = page
            self.stack.addWidget(page)
            page.job_changed()
        return self.pages.get(key)

    def show_page(self, key: str) -> None:
        """Bring it to the front; a key that nobody registered is left alone."""
        page = self._make(key)
        if page is None:
            return
        if page is not self.stack.currentWidget() and self._notice_kind in ("good", "info"):
            # Good news is read once; what went wrong stays until it is closed.
            self._close_notice()
        self.stack.setCurrentWidget(page)
        self.rail.set_current(key)
        page.setFocus()
        page.entered()

    def current_page(self) -> str:
        """The key of the page in front."""
        page = self.stack.currentWidget()
        return page.key if isinstance(page, Page) else ""

    def retranslate(self) -> None:
        """Set the window's own texts."""
        self.setWindowTitle(self.tr("AHRS Lab: calibration to JJF 1536-2015"))
        for key, button in self.rail.buttons.items():
            button.setText(page_title(key))

    def changeEvent(self, event: QEvent) -> None:
        if event.type() == QEvent.Type.LanguageChange:
            self.retranslate()
        super().changeEvent(event)

    def _close_notice(self) -> None:
        self._notice_kind = ""
        self.notice.setVisible(False)
        self._notice_room.setVisible(False)

    def _show_notice(self, kind: str, what: Message | str) -> None:
        self._notice_kind = kind
        self.notice.set_content(kind, "", said(what))  # type: ignore[arg-type]
        self.notice.setVisible(True)
        self._notice_room.setVisible(True)

    def _mark_run(self) -> None:
        if "run" in self.rail.buttons:
            self.rail.buttons["run"].set_marked(self.workspace.run.live)

    def closeEvent(self, event: QCloseEvent) -> None:
        """While a run is going on: ask, then bring the bench to a safe state before the window goes."""
        if self.workspace.run.live and not self._stop_to_close():
            event.ignore()
            return
        self._idle.stop()
        self.workspace.run.close(0.0)
        super().closeEvent(event)

    def _stop_to_close(self) -> bool:
        box = QMessageBox(self)
        box.setIcon(QMessageBox.Icon.Warning)
        box.setWindowTitle(self.tr("A run is going on"))
        box.setText(self.tr("A run is going on."))
        box.setInformativeText(
            self.tr(
                "Closing stops the table and switches the supply off. What is recorded is kept, "
                "and the run can be resumed later."
            )
        )
        stop = box.addButton(self.tr("Stop the bench and close"), QMessageBox.ButtonRole.DestructiveRole)
        stay = box.addButton(self.tr("Go on with the run"), QMessageBox.ButtonRole.RejectRole)
        box.setDefaultButton(stay)
        box.exec()
        if box.clickedButton() is not stop:
            return False
        if self.workspace.run.close():
            return True
        self._show_notice(
            "bad",
            self.tr(
                "The bench has not come to rest yet. Use the hardware emergency stop if the "
                "table still turns."
            ),
        )
        return False


def _icon() -> QIcon:
    picture = QPixmap(64, 64)
    picture.fill(Qt.GlobalColor.transparent)
    painter = QPainter(picture)
    paint_emblem(painter, QRectF(2, 2, 60, 60))
    painter.end()
    return QIcon(picture)
