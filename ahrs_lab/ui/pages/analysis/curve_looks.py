"""Colour and dash of a chart's curves: an axis of the unit looks everywhere the same, others take the next of
the chart's own. No pyqtgraph here."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from PySide6.QtCore import Qt

from ahrs_lab.analysis.report import Curve
from ahrs_lab.ui.theme import AXIS_COLOURS, AXIS_PENS, tokens

_OWN = ("#CC79A7", "#E69F00", "#56B4E9")
"""Told apart by the colour-blind, and none of the axes'."""
_CURVE_PX, _DENSE_PX = 1.6, 1.0
_DENSE = 3000
"""Points from which a curve is a filled ribbon anyway, and a wider pen only costs time."""


@dataclass(frozen=True)
class CurveLook:
    """How one curve is drawn; ``points``: as dots."""

    colour: str
    pen: Qt.PenStyle
    points: bool
    width: float


def curve_looks(curves: Sequence[Curve]) -> tuple[CurveLook, ...]:
    """In the order of ``curves``, in the colours of the theme that is on.

    What is ``dashed`` (a model, a reference) differs in dash from every axis.
    """
    look = tokens()
    own = (*_OWN, look.text) if any(curve.axis for curve in curves) else (look.accent, *_OWN, look.text)
    found: list[CurveLook] = []
    count = 0
    for curve in curves:
        dense = len(curve.x) > _DENSE
        if curve.axis:
            colour, pen = AXIS_COLOURS[curve.axis], AXIS_PENS[curve.axis]
            if curve.style == "dashed":
                pen = Qt.PenStyle.DashDotLine
        else:
            colour = own[count % len(own)]
            pen = Qt.PenStyle.DashLine if curve.style == "dashed" else Qt.PenStyle.SolidLine
            count += 1
        found.append(CurveLook(colour, pen, curve.style == "points", _DENSE_PX if dense else _CURVE_PX))
    return tuple(found)
