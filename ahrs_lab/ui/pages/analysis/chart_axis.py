"""An axis whose numbers are those of the PDF: true minus, raised powers of ten, decades on a logarithmic
one."""

from __future__ import annotations

import math
from collections.abc import Sequence

import pyqtgraph as pg
from PySide6.QtCore import QRectF, Qt
from PySide6.QtGui import QPainter

from ahrs_lab.certificates.axis_scale import axis_ticks
from ahrs_lab.ui.theme import font, tokens
from ahrs_lab.ui.widgets import rich_text

_ROOM_PX = {"left": 34, "bottom": 64}
"""For one number."""
_MOST_DECADES = 300
_BEYOND_PX = 16


class ChartAxis(pg.AxisItem):  # type: ignore[misc]
    """On a logarithmic axis the view's coordinates are logarithms to the base of ten."""

    def __init__(self, side: str) -> None:
        super().__init__(side)
        self._log = False
        self._texts: dict[float, str] = {}
        self.enableAutoSIPrefix(False)
        self.setStyle(tickLength=0, maxTextLevel=0, tickTextOffset=6, hideOverlappingLabels=False)

    def set_log(self, on: bool) -> None:
        """Logarithmic or linear."""
        self._log = on
        self.picture = None
        self.update()

    def restyle(self) -> None:
        """The colours of the theme that is on."""
        look = tokens()
        self.setPen(pg.mkPen(look.line))
        self.setTextPen(pg.mkPen(look.muted))
        self.setTickFont(font())

    def tickValues(self, minVal: float, maxVal: float, size: float) -> list[tuple[float, list[float]]]:
        low, high = min(minVal, maxVal), max(minVal, maxVal)
        most = max(2, int(size / _ROOM_PX[self.orientation]))
        if self._log:
            if high - low > _MOST_DECADES or abs(low) > _MOST_DECADES or abs(high) > _MOST_DECADES:
                return []
            ticks = axis_ticks(10.0**low, 10.0**high, most, log=True)
            places = [math.log10(value) for value in ticks.values if value > 0.0]
            minor = [math.log10(value) for value in ticks.minor if value > 0.0]
        else:
            ticks = axis_ticks(low, high, most)
            places, minor = list(ticks.values), []
        self._texts = dict(zip(places, ticks.texts, strict=False))
        return [(1.0, places), (0.1, minor)]

    def tickStrings(self, values: Sequence[float], scale: float, spacing: float) -> list[str]:
        del scale, spacing
        return [self._texts.get(value, "") for value in values]

    def boundingRect(self) -> QRectF:
        # With a grid pyqtgraph leaves out what reaches beyond the plot: the number at its very edge.
        wide, high = (0, _BEYOND_PX) if self.orientation == "left" else (_BEYOND_PX, 0)
        return QRectF(super().boundingRect()).adjusted(-wide, -high, wide, high)

    def drawPicture(
        self,
        p: QPainter,
        axisSpec: object,
        tickSpecs: object,
        textSpecs: Sequence[tuple[QRectF, int, str]],
    ) -> None:
        super().drawPicture(p, axisSpec, tickSpecs, [])
        p.setPen(self.textPen())
        p.setRenderHint(QPainter.RenderHint.TextAntialiasing)
        for area, _flags, text in textSpecs:
            if self.orientation == "left":
                side = Qt.AlignmentFlag.AlignRight
            else:
                side = Qt.AlignmentFlag.AlignHCenter
            rich_text.draw(p, QRectF(area), side, text, font())
