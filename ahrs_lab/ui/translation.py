"""The language of the screen: switched while the application runs.

Texts of widgets come from Qt's translations (``resources/translations/ahrs_lab_zh.qm``, compiled from the
``.ts`` beside it), texts of the core from their :class:`~ahrs_lab.messages.Message`; both follow
:func:`language`.
"""

from __future__ import annotations

from typing import Literal, get_args

from PySide6.QtCore import QCoreApplication, QLibraryInfo, QLocale, QObject, QTranslator, Signal
from PySide6.QtWidgets import QApplication

from ahrs_lab.errors import MachineError
from ahrs_lab.messages import Message
from ahrs_lab.resource_files import resource_path

Language = Literal["en", "zh"]
SCREEN_LANGUAGES: tuple[Language, ...] = get_args(Language)

COMPILED = "translations/ahrs_lab_zh.qm"


def language() -> Language:
    """The language that is on: what the installed translation says of itself."""
    return "zh" if QCoreApplication.translate("Language", "en") == "zh" else "en"


def said(what: Message | str) -> str:
    """A text of the core in the language of the screen."""
    return what.text(language()) if isinstance(what, Message) else what


class LanguageSwitch(QObject):
    """Installs the translation. One per application."""

    changed = Signal(str)

    def __init__(self, app: QApplication, chosen: Language) -> None:
        super().__init__(app)
        self._app = app
        self._own = QTranslator(self)
        self._qt = QTranslator(self)
        self.set_language(chosen)

    def set_language(self, chosen: Language) -> None:
        """Switch now; every widget is told by a LanguageChange event. Raises MachineError where the compiled
        translation is missing."""
        if chosen == language():
            return
        if chosen == "zh":
            path = resource_path(COMPILED)
            if not self._own.load(str(path)):
                raise MachineError(
                    "The Chinese texts are missing: {path} cannot be read. "
                    "Run python3 packaging/translations.py, or install the application again.",
                    path=str(path),
                )
            # Qt's own dialogs; not every Qt comes with its translations, and ours do without.
            if self._qt.load(
                QLocale("zh_CN"), "qtbase", "_", QLibraryInfo.path(QLibraryInfo.LibraryPath.TranslationsPath)
            ):
                self._app.installTranslator(self._qt)
            self._app.installTranslator(self._own)
        else:
            self._app.removeTranslator(self._own)
            self._app.removeTranslator(self._qt)
        self.changed.emit(chosen)
