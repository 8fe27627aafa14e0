"""Pages of a document below each other on the desk, scaled to the width or by the person."""

from __future__ import annotations

from PySide6.QtCore import QPointF, QRectF, QSize, Qt, Signal
from PySide6.QtGui import QImage, QPainter, QPaintEvent, QResizeEvent
from PySide6.QtWidgets import QScrollArea, QSizePolicy, QWidget

from ahrs_lab.ui.theme import CARD_MARGIN, tokens

_GAP = CARD_MARGIN
_ZOOMS = (0.5, 0.67, 0.8, 1.0, 1.25, 1.5, 2.0, 3.0)


class PdfView(QScrollArea):
    """``page_changed`` tells which page (from 1) is in the middle of the view."""

    page_changed = Signal(int)

    def __init__(self) -> None:
        super().__init__()
        self._paper = _Paper()
        self.setWidget(self._paper)
        self.setWidgetResizable(False)
        self.setAlignment(Qt.AlignmentFlag.AlignHCenter)
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        self._zoom = 1.0
        self._page = 0
        self.verticalScrollBar().valueChanged.connect(self._scrolled)

    def show_pages(self, pages: tuple[QImage, ...], *, keep_place: bool) -> None:
        """``keep_place``: the same document drawn anew."""
        place = self.verticalScrollBar().value() if keep_place else 0
        self._paper.set_pages(pages)
        self._fit()
        self.verticalScrollBar().setValue(place)
        self._page = 0
        self._scrolled()

    def count(self) -> int:
        """How many pages there are."""
        return self._paper.count()

    def current_page(self) -> int:
        """The page in the middle of the view, from 1; 0 where there is none."""
        return self._page

    def zoom(self, step: int) -> None:
        """+1 larger, −1 smaller, 0 the width again."""
        if step == 0:
            self._zoom = 1.0
        else:
            nearest = min(range(len(_ZOOMS)), key=lambda i: abs(_ZOOMS[i] - self._zoom))
            self._zoom = _ZOOMS[min(max(nearest + step, 0), len(_ZOOMS) - 1)]
        self._fit()

    def show_page(self, number: int) -> None:
        """Scroll to the top of a page, from 1."""
        self.verticalScrollBar().setValue(round(self._paper.top_of(number - 1)))

    def wanted_width(self) -> int:
        """Device pixels a page should be drawn wide to be sharp."""
        return round((self.viewport().width() - 2 * _GAP) * self._zoom * self.devicePixelRatioF())

    def resizeEvent(self, event: QResizeEvent) -> None:
        super().resizeEvent(event)
        self._fit()

    def _fit(self) -> None:
        self._paper.set_width(round((self.viewport().width() - 2 * _GAP) * self._zoom) + 2 * _GAP)

    def _scrolled(self) -> None:
        middle = self.verticalScrollBar().value() + self.viewport().height() / 2
        page = self._paper.page_at(middle)
        if page != self._page:
            self._page = page
            self.page_changed.emit(page)


class _Paper(QWidget):
    def __init__(self) -> None:
        super().__init__()
        self.setObjectName("scrolled")
        self.setSizePolicy(QSizePolicy.Policy.Fixed, QSizePolicy.Policy.Fixed)
        self._pages: tuple[QImage, ...] = ()
        self._width = 400

    def set_pages(self, pages: tuple[QImage, ...]) -> None:
        self._pages = pages
        self._resize()

    def set_width(self, width: int) -> None:
        self._width = max(width, 120)
        self._resize()

    def count(self) -> int:
        return len(self._pages)

    def _resize(self) -> None:
        self.setFixedSize(self.sizeHint())
        self.update()

    def _heights(self) -> list[float]:
        wide = self._width - 2 * _GAP
        return [wide * page.height() / max(page.width(), 1) for page in self._pages]

    def top_of(self, index: int) -> float:
        return sum(self._heights()[:index]) + _GAP * index

    def page_at(self, y: float) -> int:
        found = 0
        for index in range(len(self._pages)):
            if self.top_of(index) <= y:
                found = index + 1
        return found

    def sizeHint(self) -> QSize:
        return QSize(self._width, round(sum(self._heights()) + _GAP * (len(self._pages) + 1)))

    def paintEvent(self, event: QPaintEvent) -> None:
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.SmoothPixmapTransform)
        y = float(_GAP)
        for page, height in zip(self._pages, self._heights(), strict=True):
            place = QRectF(_GAP, y, self._width - 2 * _GAP, height)
            if place.intersects(QRectF(event.rect())):
                painter.drawImage(place, page)
                painter.setPen(tokens().colour("line"))
                painter.drawRect(place.translated(QPointF(-0.5, -0.5)))
            y += height + _GAP
