"""The live plots: the gyro's three axes and the table's rate over the last minute of bench time."""

from __future__ import annotations

from PySide6.QtCore import QEvent, Qt
from PySide6.QtGui import QKeySequence, QShortcut
from PySide6.QtWidgets import QHBoxLayout, QWidget

from ahrs_lab.recording.orientation import AXES
from ahrs_lab.ui.formatting import number
from ahrs_lab.ui.plots.live_plot import Channel, LivePlot, PanelSpec, Readout
from ahrs_lab.ui.run import words
from ahrs_lab.ui.run.bridge import RunBridge
from ahrs_lab.ui.theme import AXIS_COLOURS, AXIS_PENS, CARD_MARGIN, GAP
from ahrs_lab.ui.widgets import Card, Label, LineSwatch, QuietButton

_TABLE_COLOUR = "#8A63D2"
_TABLE_GAP_S = 30.0
"""The table is looked at five times a second of wall time: on a hurried bench these are many seconds."""
_DECIMALS = {"deg/s": 3, "rad/s": 5, "LSB": 0}


class LiveCard(Card):
    """Draws only while it is seen. H holds the picture; the cursor reads it."""

    def __init__(self, bridge: RunBridge) -> None:
        super().__init__()
        self._bridge = bridge
        self._readout: Readout | None = None
        self._legend = [_Entry(AXIS_COLOURS[axis], AXIS_PENS[axis]) for axis in AXES]
        self._legend.append(_Entry(_TABLE_COLOUR, Qt.PenStyle.SolidLine))
        for entry in self._legend:
            self.add_tool(entry)
        self.hold = QuietButton(icon="hold")
        self.hold.setCheckable(True)
        self.hold.toggled.connect(self._hold)
        self.add_tool(self.hold)
        data = bridge.data
        gyro = tuple(Channel(i, AXIS_COLOURS[axis], AXIS_PENS[axis]) for i, axis in enumerate(AXES))
        self.plot = LivePlot(
            [
                PanelSpec(data.gyro, gyro, smallest=0.02, stretch=3),
                PanelSpec(
                    data.table,
                    (Channel(0, _TABLE_COLOUR),),
                    smallest=2.0,
                    stretch=2,
                    gap_s=_TABLE_GAP_S,
                ),
            ]
        )
        self.plot.pointed.connect(self._pointed)
        self.add(self.plot, 1)
        key = QShortcut(QKeySequence(Qt.Key.Key_H), self)
        key.activated.connect(self.hold.toggle)
        self.retranslate()

    def begin(self) -> None:
        """Another run."""
        self.plot.set_rings([self._bridge.data.gyro, self._bridge.data.table])
        self.plot.set_running(True)
        self.hold.setChecked(False)
        self.retranslate()

    def end(self) -> None:
        """No data come any more."""
        self.plot.draw()
        self.plot.set_running(False)

    def _hold(self, held: bool) -> None:
        self.plot.set_hold(held)
        self.retranslate()

    def _pointed(self, readout: Readout | None) -> None:
        self._readout = readout
        self._write_legend()

    def _write_legend(self) -> None:
        names = [self.tr("gyro {axis}").format(axis=axis.upper()) for axis in AXES] + [self.tr("table")]
        readout = self._readout
        if readout is None:
            for entry, name in zip(self._legend, names, strict=True):
                entry.set_text(name)
            self.set_title(self.tr("Live, last minute"))
            return
        decimals = [_DECIMALS.get(self._bridge.rate_unit, 3)] * 3 + [3]
        values = [*readout.values[0], *readout.values[1]]
        for entry, name, value, places in zip(self._legend, names, values, decimals, strict=True):
            entry.set_text(f"{name[-1] if name != names[-1] else name}  {number(value, places)}")
        self.set_title(self.tr("At {time} s").format(time=number(readout.t_s, 1)))

    def retranslate(self) -> None:
        """Set every text."""
        self.hold.setText(self.tr("Held") if self.plot.held else self.tr("Hold"))
        self.hold.setToolTip(self.tr("Freeze the picture; recording goes on (H)"))
        unit = words.rate_unit(self._bridge.rate_unit)
        self.plot.set_captions(
            [self.tr("gyro, {unit}").format(unit=unit), self.tr("table, {unit}").format(unit="°/s")]
        )
        self._write_legend()

    def changeEvent(self, event: QEvent) -> None:
        if event.type() == QEvent.Type.LanguageChange:
            self.retranslate()
        super().changeEvent(event)


class _Entry(QWidget):
    """A piece of the line and its name."""

    def __init__(self, colour: str, style: Qt.PenStyle) -> None:
        super().__init__()
        row = QHBoxLayout(self)
        row.setContentsMargins(0, 0, CARD_MARGIN - GAP, 0)
        row.setSpacing(6)
        self._text = Label(tone="muted")
        row.addWidget(LineSwatch(colour, style))
        row.addWidget(self._text)

    def set_text(self, text: str) -> None:
        self._text.setText(text)
