"""How the running mean approaches its value while a dwell lasts: the mean, and a band of ± its standard
error."""

from __future__ import annotations

import numpy as np
from PySide6.QtCore import QPointF, QRectF, QSize, Qt
from PySide6.QtGui import QColor, QPainter, QPaintEvent, QPen, QPolygonF
from PySide6.QtWidgets import QSizePolicy, QWidget

from ahrs_lab.ui.formatting import duration
from ahrs_lab.ui.plots.running_mean import RunningMean
from ahrs_lab.ui.theme import font, tokens

_ERRORS_SHOWN = 5.0
_FOOT_PX = 20


class ApproachPlot(QWidget):
    """Centred on the mean of now; as high as a few of its present standard errors, so that the way in is
    seen."""

    def __init__(self) -> None:
        super().__init__()
        self._mean: RunningMean | None = None
        self._duration_s = 0.0
        self._colour = "#000000"
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Expanding)
        self.setMinimumHeight(56)

    def sizeHint(self) -> QSize:
        return QSize(220, 90)

    def show_mean(self, mean: RunningMean, duration_s: float, colour: str) -> None:
        """What there is so far, of a recording that lasts ``duration_s``."""
        self._mean, self._duration_s, self._colour = mean, duration_s, colour
        self.update()

    def paintEvent(self, _event: QPaintEvent) -> None:
        look = tokens()
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        area = QRectF(self.rect()).adjusted(0.5, 4.5, -0.5, -_FOOT_PX)
        painter.setPen(QPen(look.colour("line"), 1))
        painter.drawLine(area.bottomLeft(), area.bottomRight())
        centre = QPen(look.colour("faint"), 1, Qt.PenStyle.DotLine)
        painter.setPen(centre)
        painter.drawLine(QPointF(area.left(), area.center().y()), QPointF(area.right(), area.center().y()))
        painter.setFont(font())
        painter.setPen(look.colour("muted"))
        foot = QRectF(area.left(), area.bottom() + 1, area.width(), _FOOT_PX)
        painter.drawText(foot, Qt.AlignmentFlag.AlignLeft | Qt.AlignmentFlag.AlignVCenter, "0 s")
        painter.drawText(
            foot, Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter, duration(self._duration_s)
        )
        if self._mean is not None and len(self._mean.history_s) > 1 and self._duration_s > 0:
            self._paint_way(painter, area, self._mean)

    def _paint_way(self, painter: QPainter, area: QRectF, mean: RunningMean) -> None:
        known = np.isfinite(mean.errors)
        if not known.any():
            return
        t_s, means, errors = mean.history_s[known], mean.means[known], mean.errors[known]
        half = _ERRORS_SHOWN * max(float(errors[-1]), 1e-12)
        x = area.left() + area.width() * np.clip(t_s / self._duration_s, 0.0, 1.0)

        def height(values: np.typing.NDArray[np.float64]) -> np.typing.NDArray[np.float64]:
            return np.asarray(area.center().y() - (values - means[-1]) / half * area.height() / 2)

        painter.setClipRect(area)
        upper, lower, middle = height(means + errors), height(means - errors), height(means)
        band = [QPointF(*point) for point in zip(x, upper, strict=True)]
        band += [QPointF(*point) for point in zip(x[::-1], lower[::-1], strict=True)]
        fill = QColor(self._colour)
        fill.setAlpha(48)
        painter.setPen(Qt.PenStyle.NoPen)
        painter.setBrush(fill)
        painter.drawPolygon(QPolygonF(band))
        painter.setPen(QPen(QColor(self._colour), 1.6))
        painter.setBrush(Qt.BrushStyle.NoBrush)
        painter.drawPolyline(QPolygonF([QPointF(*point) for point in zip(x, middle, strict=True)]))
