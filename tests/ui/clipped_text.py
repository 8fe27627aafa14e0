"""Finds texts that do not fit where they stand: for every page, in both languages."""

from __future__ import annotations

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QAbstractButton, QLabel, QPushButton, QWidget

from ahrs_lab.ui.frame.navigation_rail import RailButton
from ahrs_lab.ui.widgets import ElidedLabel

_SLACK_PX = 1


def clipped_texts(window: QWidget) -> list[str]:
    """``class: text: needs …, has …`` of each visible label and button whose text is cut."""
    found = []
    for widget in window.findChildren(QWidget):
        if not widget.isVisibleTo(window) or not widget.visibleRegion().boundingRect().isValid():
            continue
        fault = _fault(widget)
        if fault:
            found.append(f"{type(widget).__name__}: {fault}")
    return found


def _fault(widget: QWidget) -> str:
    if isinstance(widget, ElidedLabel):
        return ""
    if isinstance(widget, QLabel) and widget.text() and widget.textFormat() != Qt.TextFormat.RichText:
        return _label_fault(widget)
    if isinstance(widget, QPushButton) and widget.text():
        return _too_small(widget.text(), widget.sizeHint().width(), widget.width())
    if isinstance(widget, RailButton):
        needed = widget.fontMetrics().horizontalAdvance(widget.text())
        return _too_small(widget.text(), needed, widget.width())
    return ""


def _label_fault(label: QLabel) -> str:
    if label.wordWrap():
        needed = label.heightForWidth(label.width())
        return _too_small(label.text(), needed, label.height(), "high")
    needed = max(label.fontMetrics().horizontalAdvance(line) for line in label.text().split("\n"))
    return _too_small(label.text(), needed, label.contentsRect().width())


def _too_small(text: str, needed: int, there: int, what: str = "wide") -> str:
    return "" if needed <= there + _SLACK_PX else f"{text!r} needs {needed} px {what}, has {there}"


def outside(window: QWidget) -> list[str]:
    """Buttons that are not wholly inside the window: an action nobody can reach."""
    found = []
    for button in window.findChildren(QAbstractButton):
        if not button.isVisibleTo(window):
            continue
        corner = button.mapTo(window, button.rect().bottomRight())
        origin = button.mapTo(window, button.rect().topLeft())
        if not (window.rect().contains(corner) and window.rect().contains(origin)):
            found.append(button.text() or button.toolTip())
    return found
