"""The numbers of the bench, large where they matter, and until when the operator is free."""

from __future__ import annotations

from datetime import datetime

from PySide6.QtCore import QEvent

from ahrs_lab.ui.formatting import DASH, count, duration, number, wall_time_left
from ahrs_lab.ui.run import words
from ahrs_lab.ui.run.bridge import RunBridge
from ahrs_lab.ui.run.model import RunModel
from ahrs_lab.ui.theme import NUMBER_PX
from ahrs_lab.ui.widgets import BigNumber, Card, KeyValueTable, Label, Line, Panel

_BENCH = ("angle", "samples", "lost", "supply", "room")
_TIMES = ("step", "mounting", "run")


class ReadingsCard(Card):
    """``speed`` is bench time over wall time, None: as fast as it goes."""

    def __init__(self, bridge: RunBridge, speed: float | None) -> None:
        super().__init__()
        self._bridge = bridge
        self._speed = speed
        self.demanded = BigNumber(unit="°/s")
        self.actual = BigNumber(unit="°/s")
        self.gyro = BigNumber()
        for big in (self.demanded, self.actual, self.gyro):
            self.add(big)
        self.add(Line())
        self.bench = KeyValueTable(_BENCH, row_gap=5)
        self.add(self.bench)
        self.add(Line())
        self.times = KeyValueTable(_TIMES, row_gap=5)
        self.add(self.times)
        self.body.addStretch(1)
        self.free = Panel("accent")
        self._free_caption = Label(tone="muted")
        self._free_time = Label(role="number", tone="accent")
        self._free_next = Label(tone="muted")
        self._free_time.setFixedHeight(round(1.2 * NUMBER_PX))
        for label in (self._free_caption, self._free_time, self._free_next):
            self.free.body.addWidget(label)
        self.add(self.free)
        self.retranslate()

    def refresh(self) -> None:
        """Look at the run."""
        model, data = self._bridge.model, self._bridge.data
        reading = model.seen
        self.demanded.set_value(number(reading.table.demanded_rate_dps, 3) if reading else DASH)
        self.actual.set_value(number(reading.table.rate_dps, 4) if reading else DASH)
        self._refresh_gyro(model)
        self.bench.set_value("angle", f"{number(reading.table.angle_deg, 4)}°" if reading else DASH)
        self.bench.set_value("samples", count(data.samples))
        self.bench.set_value("lost", count(data.lost), "warn" if data.lost else "text")
        if reading is None:
            self.bench.set_value("supply", DASH)
            self.bench.set_value("room", DASH)
        else:
            supply, room = reading.supply, reading.room
            off = self.tr("off")
            on = f"{number(supply.voltage_v, 2)} V  {number(supply.current_a, 3)} A"
            self.bench.set_value("supply", on if model.powered else off)
            self.bench.set_value(
                "room", f"{number(room.temperature_c, 1)} °C  {number(room.humidity_percent, 0)} %RH"
            )
        self._refresh_times(model)

    def _refresh_gyro(self, model: RunModel) -> None:
        axis = model.axis
        unit = words.rate_unit(self._bridge.rate_unit)
        decimals = {"deg/s": 4, "rad/s": 6, "LSB": 1}.get(self._bridge.rate_unit, 4)
        self.gyro.set_caption(self.tr("Gyro {axis}, mean of 1 s").format(axis=axis.upper()))
        self.gyro.set_value(number(self._bridge.data.gyro_now(axis) if model.live else None, decimals), unit)
        self.gyro.set_tone(f"axis_{axis}")  # type: ignore[arg-type]

    def _refresh_times(self, model: RunModel) -> None:
        reading, free_s = model.seen, model.free_s
        self.times.set_value("step", duration(model.step_left_s) if model.live else DASH)
        asked = model.state == "waiting" and model.phase in ("mount", "hand") and not model.confirmed
        if asked:
            self.times.set_value("mounting", self.tr("now"), "accent")
        else:
            self.times.set_value("mounting", duration(free_s))
        self.times.set_value("run", duration(reading.remaining_s) if reading else DASH)
        self.free.setVisible(free_s is not None)
        if free_s is None:
            return
        self._free_caption.setText(self._free_words(model))
        self._free_time.setText(self._moment(free_s))
        following = model.next_mounting
        self._free_next.setText(
            self.tr("next: turn to {face}").format(face=words.face(following))
            if following
            else self.tr("no other mounting follows")
        )

    def _free_words(self, model: RunModel) -> str:
        last = model.next_mounting is None
        if wall_time_left(0.0, self._speed) is None:
            # As fast as it goes there is no time of day to come back at.
            return self.tr("Bench time to the end") if last else self.tr("Bench time to the next mounting")
        if model.phase == "mount":
            return self.tr("After this you are free until")
        return self.tr("The run ends at") if last else self.tr("You are free until")

    def _moment(self, bench_seconds: float) -> str:
        left = wall_time_left(bench_seconds, self._speed)
        if left is None:
            return duration(bench_seconds)
        moment = datetime.now().astimezone() + left
        return f"{moment:%H:%M}" if left.total_seconds() >= 120 else f"{moment:%H:%M:%S}"

    def retranslate(self) -> None:
        """Set every text."""
        self.set_title(self.tr("Readings"))
        self.demanded.set_caption(self.tr("Table rate, demanded"))
        self.actual.set_caption(self.tr("Table rate, actual"))
        for key, text in {
            "angle": self.tr("Table angle"),
            "samples": self.tr("Samples, this segment"),
            "lost": self.tr("Lost"),
            "supply": self.tr("Supply"),
            "room": self.tr("Room"),
        }.items():
            self.bench.set_name(key, text)
        for key, text in {
            "step": self.tr("This step"),
            "mounting": self.tr("Until you are needed"),
            "run": self.tr("Whole run"),
        }.items():
            self.times.set_name(key, text)
        self.refresh()

    def changeEvent(self, event: QEvent) -> None:
        if event.type() == QEvent.Type.LanguageChange:
            self.retranslate()
        super().changeEvent(event)
