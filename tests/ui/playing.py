"""The operator's eyes and fingers: reads what stands on the screen, clicks what is in sight, types, waits.

A click is put at a place in the window, as the mouse would: whatever lies there gets it. So a button that is
covered, outside the window, disabled or behind a dialog cannot be pressed here either.
"""

from __future__ import annotations

import os
import re
import time
from collections.abc import Callable, Iterator
from pathlib import Path

from PySide6.QtCore import QPoint, QRect, Qt, QTimer
from PySide6.QtGui import QInputMethodEvent
from PySide6.QtTest import QTest
from PySide6.QtWidgets import (
    QAbstractButton,
    QApplication,
    QComboBox,
    QDialog,
    QLabel,
    QLineEdit,
    QMenu,
    QTabBar,
    QTableView,
    QWidget,
)

from ahrs_lab.ui.run.steps_card import StepsList

PICTURES = "AHRS_LAB_PICTURES"
"""Names a folder: then each phase is kept there as a picture, to be looked at by a person."""
DEADLINE_S = 60.0
_LOOK_MS = 10

_LATIN_WORD = re.compile(r"s/n|[A-Za-z][A-Za-z_.]+[A-Za-z]")
_HAN = re.compile(r"[\u3400-\u9fff]+")


class Hands:
    """One person before ``window``. All methods raise AssertionError where a person would be stuck."""

    def __init__(self, window: QWidget, pictures: str = "") -> None:
        self.window = window
        folder = os.environ.get(PICTURES)
        self._pictures = Path(folder) if folder else None
        self._prefix = pictures
        self._count = 0

    @property
    def front(self) -> QWidget:
        """What can be used now: the dialog that is open, else the window."""
        return QApplication.activeModalWidget() or self.window

    # eyes ───────────────────────────────────────────────────────────────────────────────────────────────

    def until(self, condition: Callable[[], bool], what: str, deadline_s: float = DEADLINE_S) -> None:
        """Wait; AssertionError with ``what`` and the texts on the screen after the deadline."""
        end = time.monotonic() + deadline_s
        while not condition():
            if time.monotonic() > end:
                raise AssertionError(f"waited {deadline_s:g} s for: {what}\n" + "\n".join(self.texts()))
            pass_time()

    def texts(self, within: QWidget | None = None) -> list[str]:
        """Every text that can be read now, the tool tips of what has no other text too."""
        whole = within or self.front
        found: list[str] = [] if within else [whole.windowTitle()]
        for widget in [whole, *whole.findChildren(QWidget)]:
            if in_sight(widget):
                found += _texts_of(widget)
        return [text for text in found if text.strip()]

    def sees(self, text: str) -> bool:
        """Whether it stands somewhere, by itself or in a longer text."""
        return any(text in shown for shown in self.texts())

    def wait_for(self, text: str, deadline_s: float = DEADLINE_S) -> None:
        """Until it stands on the screen."""
        self.until(lambda: self.sees(text), f"“{text}” on the screen", deadline_s)

    def foreign(self, language: str, known: frozenset[str]) -> list[str]:
        """Texts with words of the other language: Latin words of three letters and more on a Chinese screen
        that are not ``known`` (names, units, keys), Chinese characters on an English one that are not."""
        pattern = _LATIN_WORD if language == "zh" else _HAN
        return [text for text in self.texts() if any(word not in known for word in pattern.findall(text))]

    def picture(self, name: str) -> None:
        """Keep the window (and the dialog before it) as a picture where somebody wants to look."""
        if self._pictures is None:
            return
        self._pictures.mkdir(parents=True, exist_ok=True)
        self._count += 1
        QApplication.processEvents()
        for number, widget in enumerate(dict.fromkeys((self.window, self.front))):
            end = "-dialog" if number else ""
            widget.grab().save(str(self._pictures / f"{self._prefix}{self._count:02d}-{name}{end}.png"))

    # fingers ────────────────────────────────────────────────────────────────────────────────────────────

    def press(self, text: str, *, beside: str = "") -> None:
        """Click the button of this text (or hint, where it has only an icon). ``beside`` names a text near it
        where there are several."""
        self.click(self.button(text, beside=beside))

    def button(self, text: str, *, beside: str = "") -> QAbstractButton:
        """The one button of this text that is in sight and enabled."""
        found = [b for b in self.front.findChildren(QAbstractButton) if in_sight(b) and _says(b, text)]
        if beside:
            found = _nearest(found, beside)
        if len(found) != 1:
            raise AssertionError(
                f"{len(found)} buttons “{text}”{f' beside “{beside}”' if beside else ''} in sight:\n"
                + "\n".join(self.texts())
            )
        assert found[0].isEnabled(), f"the button “{text}” cannot be pressed now"
        return found[0]

    def has_button(self, text: str) -> bool:
        """Whether one of this text is in sight and enabled."""
        return any(
            in_sight(b) and b.isEnabled() and _says(b, text) for b in self.front.findChildren(QAbstractButton)
        )

    def click(self, widget: QWidget, place: QPoint | None = None) -> None:
        """Click its middle, or ``place`` in it; it has to be in sight, in the window and not covered."""
        window = widget.window()
        assert window is self.front, f"a dialog is open before {_name(widget)}"
        point = widget.mapTo(window, place if place is not None else widget.rect().center())
        assert window.rect().contains(QRect(widget.mapTo(window, QPoint()), widget.size())) or place, (
            f"{_name(widget)} is not wholly inside the window"
        )
        hit = window.childAt(point)
        assert hit is not None, f"nothing takes a click on {_name(widget)}"
        assert hit is widget or widget.isAncestorOf(hit), f"{_name(widget)} is covered by {_name(hit)}"
        QTest.mouseClick(
            window.windowHandle(), Qt.MouseButton.LeftButton, Qt.KeyboardModifier.NoModifier, point
        )
        QApplication.processEvents()

    def key(self, key: Qt.Key) -> None:
        """Press a key; it goes to whatever has the keyboard."""
        self._have_keyboard()
        QTest.keyClick(self.front.windowHandle(), key)
        QApplication.processEvents()

    def _have_keyboard(self) -> None:
        """A window system gives the keyboard back when a menu or a list closes; the offscreen one does not
        always."""
        self.front.activateWindow()
        self.until(self.front.isActiveWindow, "the keyboard")

    def type_into(self, name: str, text: str) -> None:
        """Click the field of this name and type; what no key of the keyboard gives comes as from an input
        method."""
        fields = [
            f
            for f in self.front.findChildren(QLineEdit)
            if in_sight(f) and name in (f.accessibleName(), f.placeholderText())
        ]
        assert len(fields) == 1, f"{len(fields)} fields “{name}”:\n" + "\n".join(self.texts())
        self._have_keyboard()
        self.click(fields[0])
        assert fields[0].hasFocus(), f"the field “{name}” does not take the keyboard"
        if text.isascii():
            for letter in text:
                QTest.keyClick(self.front.windowHandle(), Qt.Key(ord(letter.upper())))
        else:
            event = QInputMethodEvent()
            event.setCommitString(text)
            QApplication.sendEvent(fields[0], event)
        QApplication.processEvents()
        assert fields[0].text() == text

    def choose(self, combo: QComboBox, text: str) -> None:
        """Open a list of choices and click the one that contains ``text``."""
        self.click(combo)
        view = combo.view()
        self.until(view.isVisible, "the list of choices")
        rows = [row for row in range(combo.count()) if text in combo.itemText(row)]
        assert len(rows) == 1, f"{len(rows)} choices “{text}”"
        # By the keyboard: for half a second the list takes a click for the end of the one that opened it.
        way = Qt.Key.Key_Down if rows[0] > combo.currentIndex() else Qt.Key.Key_Up
        for _ in range(abs(rows[0] - combo.currentIndex())):
            QTest.keyClick(view, way)
        QTest.keyClick(view, Qt.Key.Key_Return)
        self.until(lambda: not view.isVisible(), "the list of choices to close")
        assert text in combo.currentText()

    def turn_to(self, tab: str) -> None:
        """Click a tab."""
        for bar in self.front.findChildren(QTabBar):
            for number in range(bar.count()):
                if in_sight(bar) and bar.tabText(number) == tab:
                    self.click(bar, bar.tabRect(number).center())
                    assert bar.currentIndex() == number
                    return
        raise AssertionError(f"no tab “{tab}”:\n" + "\n".join(self.texts()))

    def in_dialog(self, opening: Callable[[], None], play: Callable[[], None]) -> None:
        """``opening`` brings up a dialog that holds the program until it is closed; ``play`` is what the
        fingers do in it, the click that closes it included."""
        failures: list[BaseException] = []
        dialogs: list[QWidget] = []

        def look() -> None:
            dialog = QApplication.activeModalWidget()
            if dialog is None:
                return
            timer.stop()
            dialogs.append(dialog)
            try:
                play()
                self.until(lambda: not dialog.isVisible(), "the dialog to close")
            except BaseException as failure:
                failures.append(failure)
                if isinstance(dialog, QDialog):
                    dialog.reject()

        timer = QTimer()
        timer.setInterval(_LOOK_MS)
        timer.timeout.connect(look)
        timer.start()
        try:
            opening()
        finally:
            timer.stop()
        if failures:
            raise failures[0]
        assert dialogs, "no dialog came up"

    def choose_in_menu(self, opening: Callable[[], None], text: str) -> None:
        """``opening`` brings up a menu; its entry ``text`` is clicked."""
        chosen: list[str] = []

        def look() -> None:
            menu = QApplication.activePopupWidget()
            if not isinstance(menu, QMenu):
                return
            timer.stop()
            for action in menu.actions():
                if action.text() == text:
                    chosen.append(text)
                    place = menu.actionGeometry(action).center()
                    QTest.mouseClick(menu, Qt.MouseButton.LeftButton, Qt.KeyboardModifier.NoModifier, place)
                    return
            menu.close()

        timer = QTimer()
        timer.setInterval(_LOOK_MS)
        timer.timeout.connect(look)
        timer.start()
        opening()
        self.until(lambda: bool(chosen) or not timer.isActive(), "the menu")
        timer.stop()
        assert chosen, f"the menu has no entry “{text}”"
        QApplication.processEvents()


def pass_time(seconds: float = _LOOK_MS / 1000.0) -> None:
    """Let the program go on. Not ``QTest.qWait``, which keeps Python's other threads waiting too."""
    end = time.monotonic() + seconds
    while True:
        QApplication.processEvents()
        left = end - time.monotonic()
        if left <= 0.0:
            return
        time.sleep(min(left, _LOOK_MS / 1000.0))


def in_sight(widget: QWidget) -> bool:
    """Visible, and not scrolled or pushed out of what can be seen."""
    return widget.isVisible() and not widget.visibleRegion().isEmpty()


def _says(button: QAbstractButton, text: str) -> bool:
    """Its words are these; behind them may stand the key that does the same."""
    words = button.text() or button.accessibleName() or button.toolTip()
    return words == text or words.startswith(text + "  ")


def _nearest(buttons: list[QAbstractButton], text: str) -> list[QAbstractButton]:
    """Those in the smallest box that holds a button and ``text``."""
    ways = [(_steps_to(button, text), button) for button in buttons]
    least = min((steps for steps, _ in ways), default=0)
    return [button for steps, button in ways if steps == least]


def _steps_to(button: QAbstractButton, text: str) -> int:
    box: QWidget | None = button
    steps = 0
    while box is not None:
        if any(text in label.text() for label in box.findChildren(QLabel) if in_sight(label)):
            return steps
        box, steps = box.parentWidget(), steps + 1
    return steps


def _texts_of(widget: QWidget) -> Iterator[str]:
    if isinstance(widget, QLabel):
        yield widget.text()
    elif isinstance(widget, QAbstractButton):
        yield widget.text() or widget.accessibleName() or widget.toolTip()
    elif isinstance(widget, QLineEdit):
        yield (
            widget.text() if widget.echoMode() == QLineEdit.EchoMode.Normal else ""
        ) or widget.placeholderText()
    elif isinstance(widget, QComboBox):
        yield widget.currentText()
    elif isinstance(widget, QTabBar):
        yield from (widget.tabText(number) for number in range(widget.count()))
    elif isinstance(widget, StepsList):
        yield from widget.row_texts()
    elif isinstance(widget, QTableView):
        model = widget.model()
        for column in range(model.columnCount()):
            yield str(model.headerData(column, Qt.Orientation.Horizontal) or "")
            for row in range(model.rowCount()):
                yield str(model.index(row, column).data() or "")


def _name(widget: QWidget) -> str:
    words = next(_texts_of(widget), "") or widget.accessibleName()
    return f"{type(widget).__name__} “{words}”"
