"""What the main window knows of a page: a key, an icon, a title; and how a page hears of language and job.

A page is made with the :class:`~ahrs_lab.ui.workspace.Workspace` and registers itself by being given to
:meth:`ahrs_lab.ui.main_window.MainWindow.add_page`.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from PySide6.QtCore import QCoreApplication, QEvent, Qt
from PySide6.QtWidgets import QVBoxLayout, QWidget

from ahrs_lab.ui.theme import CARD_MARGIN
from ahrs_lab.ui.workspace import Workspace


class Translated(QWidget):
    """A widget that sets its texts in :meth:`retranslate`, which is called again when the language changes.

    A subclass calls ``self.retranslate()`` at the end of its ``__init__``.
    """

    def retranslate(self) -> None:
        """Set every text a person reads, from ``self.tr(...)``."""

    def changeEvent(self, event: QEvent) -> None:
        if event.type() == QEvent.Type.LanguageChange:
            self.retranslate()
        super().changeEvent(event)


def page_title(key: str) -> str:
    """What stands under the icon of the page ``key``, in the language that is on."""
    translate = QCoreApplication.translate
    titles = {
        "start": translate("Page", "Start"),
        "jobs": translate("Page", "Jobs"),
        "run": translate("Page", "Run"),
        "results": translate("Page", "Results"),
        "certificate": translate("Page", "Certificate"),
        "analyse": translate("Page", "Analyse"),
        "bench": translate("Page", "Bench"),
        "instruments": translate("Page", "Instruments"),
        "setup": translate("Page", "Set-up"),
    }
    return titles.get(key, "")


@dataclass(frozen=True)
class PageEntry:
    """A page on the rail that is made when it is first needed: the window is there before its pages are."""

    key: str
    make: Callable[[], Page]


class Page(Translated):
    """One page of the main window. Subclasses set ``key``; their title is :func:`page_title`'s.

    ``key`` is what :meth:`Workspace.go_to` takes, and the name of its icon in :mod:`ahrs_lab.ui.icons`.
    """

    key = ""

    def __init__(self, workspace: Workspace) -> None:
        super().__init__()
        self.workspace = workspace
        self.outer = QVBoxLayout(self)
        self.outer.setContentsMargins(CARD_MARGIN, CARD_MARGIN, CARD_MARGIN, CARD_MARGIN)
        self.outer.setSpacing(CARD_MARGIN)
        # So that no button has the focus before a person gives it one.
        self.setFocusPolicy(Qt.FocusPolicy.ClickFocus)
        workspace.job_changed.connect(self.job_changed)

    def job_changed(self) -> None:
        """Another job was chosen, or the chosen one changed: look at ``self.workspace``."""

    def entered(self) -> None:
        """The page comes to the front."""
