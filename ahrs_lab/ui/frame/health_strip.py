"""The strip above STOP: is the bench well? Quiet while it is."""

from __future__ import annotations

from PySide6.QtCore import QEvent
from PySide6.QtWidgets import QFrame, QHBoxLayout

from ahrs_lab.metrology.conditions import RoomLimits
from ahrs_lab.procedures.events import BenchReading
from ahrs_lab.ui.formatting import count, number
from ahrs_lab.ui.theme import STEP
from ahrs_lab.ui.widgets import StateDot
from ahrs_lab.ui.workspace import Workspace

HEIGHT = 30


class HealthStrip(QFrame):
    """Table, AHRS, supply, room, as the last look at the bench found them."""

    def __init__(self, workspace: Workspace) -> None:
        super().__init__()
        self._workspace = workspace
        self._limits = RoomLimits()
        self.setObjectName("healthStrip")
        self.setFixedHeight(HEIGHT)
        row = QHBoxLayout(self)
        row.setContentsMargins(5 * STEP, 0, 5 * STEP, 0)
        row.setSpacing(5 * STEP)
        self.dots = {name: StateDot() for name in ("idle", "table", "ahrs", "supply", "room", "record")}
        for dot in self.dots.values():
            row.addWidget(dot)
        row.addStretch(1)
        for signal in (workspace.run.started, workspace.run.changed, workspace.run.ended):
            signal.connect(self.refresh)
        self.refresh()

    def refresh(self) -> None:
        """Look at the run."""
        model = self._workspace.run.model
        reading = model.seen
        for name, dot in self.dots.items():
            dot.setVisible((reading is None) == (name == "idle"))
        if reading is None:
            self.dots["idle"].set_state("unknown", self.tr("The bench is watched while a run is going on."))
        else:
            self._show(reading)
        row = self.layout()
        if row is not None:
            row.activate()

    def _show(self, reading: BenchReading) -> None:
        model = self._workspace.run.model
        self._table(reading)
        self._ahrs()
        self._supply(reading)
        self._room(reading)
        self.dots["record"].set_state(
            "good", self.tr("segments on disk: {n}").format(n=count(len(model.on_disk)))
        )

    def _table(self, reading: BenchReading) -> None:
        table, dot = reading.table, self.dots["table"]
        if table.fault:
            dot.set_state("bad", self.tr("table: {fault}").format(fault=table.fault))
        elif not table.enabled:
            dot.set_state("unknown", self.tr("table disabled"))
        elif table.moving:
            dot.set_state("good", self.tr("table turning"))
        else:
            dot.set_state("good", self.tr("table ready"))

    def _ahrs(self) -> None:
        model, data, dot = self._workspace.run.model, self._workspace.run.data, self.dots["ahrs"]
        lost = model.lost + data.lost
        if not model.powered:
            dot.set_state("unknown", self.tr("AHRS without power"))
            return
        rate = self.tr("AHRS {rate} Hz").format(rate=number(data.rate_hz, 1))
        if lost:
            dot.set_state("warn", self.tr("{rate}, {n} samples lost").format(rate=rate, n=count(lost)))
        else:
            dot.set_state("good", self.tr("{rate}, 0 lost").format(rate=rate))

    def _supply(self, reading: BenchReading) -> None:
        supply = reading.supply
        if not self._workspace.run.model.powered:
            self.dots["supply"].set_state("unknown", self.tr("supply off"))
        else:
            text = self.tr("supply {voltage} V  {current} A")
            self.dots["supply"].set_state(
                "good",
                text.format(voltage=number(supply.voltage_v, 2), current=number(supply.current_a, 3)),
            )

    def _room(self, reading: BenchReading) -> None:
        room, limits = reading.room, self._limits
        text = f"{number(room.temperature_c, 1)} °C  {number(room.humidity_percent, 0)} %RH"
        inside = (
            limits.temperature_c[0] <= room.temperature_c <= limits.temperature_c[1]
            and limits.humidity_percent[0] <= room.humidity_percent <= limits.humidity_percent[1]
        )
        if inside:
            self.dots["room"].set_state("good", text)
        else:
            self.dots["room"].set_state("warn", self.tr("{room}: outside clause 6").format(room=text))

    def changeEvent(self, event: QEvent) -> None:
        if event.type() == QEvent.Type.LanguageChange:
            self.refresh()
        super().changeEvent(event)
