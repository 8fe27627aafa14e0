"""What the middle card shows at the right of the drawing: the mounting asked, the work going on, the
recording."""

from __future__ import annotations

import math

from PySide6.QtCore import QPoint, Qt, Signal
from PySide6.QtWidgets import QFrame, QGridLayout, QHBoxLayout, QVBoxLayout, QWidget

from ahrs_lab.recording.orientation import AXES, Orientation
from ahrs_lab.ui.formatting import DASH, duration, number
from ahrs_lab.ui.page import Translated
from ahrs_lab.ui.run import words
from ahrs_lab.ui.run.approach_plot import ApproachPlot
from ahrs_lab.ui.run.bridge import RunBridge
from ahrs_lab.ui.run.model import RunModel
from ahrs_lab.ui.theme import AXIS_COLOURS, CARD_MARGIN, GAP, STEP
from ahrs_lab.ui.translation import said
from ahrs_lab.ui.widgets import Label, LinkButton, Panel, PrimaryButton, ProgressBar, Swatch, ValueLabel

HELP_WIDTH = 380


def column_of(widget: QWidget) -> QVBoxLayout:
    """An empty column that fills the widget."""
    column = QVBoxLayout(widget)
    column.setContentsMargins(0, 0, 0, 0)
    column.setSpacing(GAP)
    return column


class MountView(Translated):
    """Where each axis has to point, what the sensor said, and the button."""

    confirmed = Signal()

    def __init__(self) -> None:
        super().__init__()
        self._model = RunModel()
        column = column_of(self)
        self._axes = _AxesTable()
        column.addWidget(self._axes)
        self.feels = FeelsPanel()
        column.addWidget(self.feels)
        column.addStretch(1)
        self._help = LinkButton(icon="help")
        self._help.clicked.connect(self.show_help)
        self.button = PrimaryButton(large=True)
        self.button.clicked.connect(self.confirmed)
        column.addWidget(self._help, 0, Qt.AlignmentFlag.AlignLeft)
        column.addWidget(self.button)
        self.retranslate()

    def refresh(self, model: RunModel) -> None:
        """Look at the model."""
        self._model = model
        if model.request is not None:
            self._axes.show_orientation(model.request.orientation)
        self.feels.refresh(model)
        if model.confirmed and self.window().focusWidget() is self.button:
            # Else Qt hands the keyboard to the next button, and another press of the space bar presses that.
            self.button.clearFocus()
        self.button.setEnabled(not model.confirmed)
        if model.confirmed:
            self.button.set_caption(self.tr("Noted, going on …"))
        else:
            self.button.set_caption(self.tr("Mounted"), self.tr("Space"))

    def retranslate(self) -> None:
        """Set every text."""
        self._help.setText(self.tr("What if it differs?"))
        self.refresh(self._model)

    def show_help(self) -> QFrame:
        """What happens when the mounting differs; returns the pop-up."""
        popup = QFrame(self, Qt.WindowType.Popup)
        popup.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        popup.setObjectName("card")
        text = Label(
            self.tr(
                "When power is back the sensor tells which axis it feels upward. If that is not "
                "the axis asked for, "
                "nothing is recorded: the drawing comes back with what the sensor feels. Check "
                "the axes printed on "
                "the case, not the outline; turn the case, tighten it, and say “Mounted” again.\n\n"
                "If it stands as drawn and the sensor still disagrees, the device's axes may be "
                "named differently: "
                "stop the run and correct the device in the job."
            ),
            wrap=True,
        )
        text.setFixedWidth(HELP_WIDTH)
        text.setFixedHeight(text.heightForWidth(HELP_WIDTH))
        column = QVBoxLayout(popup)
        column.setContentsMargins(CARD_MARGIN, CARD_MARGIN, CARD_MARGIN, CARD_MARGIN)
        column.addWidget(text)
        popup.adjustSize()
        corner = self._help.mapToGlobal(QPoint(0, -popup.height() - STEP))
        popup.move(corner)
        popup.show()
        return popup


class _AxesTable(QWidget):
    """X → up, Y → east, Z → north, each with its line."""

    def __init__(self) -> None:
        super().__init__()
        grid = QGridLayout(self)
        grid.setContentsMargins(0, 0, 0, 0)
        grid.setHorizontalSpacing(GAP)
        grid.setVerticalSpacing(2)
        self._names = {}
        self._where = {}
        for row, axis in enumerate(AXES):
            name = Label(axis.upper(), role="strong", tone=f"axis_{axis}")  # type: ignore[arg-type]
            where = Label()
            grid.addWidget(Swatch(axis), row, 0)
            grid.addWidget(name, row, 1)
            grid.addWidget(where, row, 2)
            self._names[axis], self._where[axis] = name, where
        grid.setColumnStretch(2, 1)

    def show_orientation(self, orientation: Orientation) -> None:
        for axis, letter in zip(AXES, orientation.letters, strict=True):
            self._where[axis].setText(words.direction(letter))


class FeelsPanel(Panel):
    """What the sensor said of the mounting, or when it will be asked."""

    def __init__(self) -> None:
        super().__init__("plain")
        self._caption = Label(tone="muted")
        self._felt = Label(role="title")
        self._text = Label(wrap=True)
        for label in (self._caption, self._felt, self._text):
            self.body.addWidget(label)

    def refresh(self, model: RunModel) -> None:
        """Look at the model."""
        check = model.check
        self._caption.setText(self.tr("The sensor feels"))
        if check is None:
            self.set_kind("plain")
            self._felt.setVisible(False)
            self._text.setText(
                self.tr("It is asked after you say so.")
                if model.powered
                else self.tr("Power is off. It is asked when power is back.")
            )
            return
        tone = "good" if check.accepted else "bad"
        self.set_kind(tone)  # type: ignore[arg-type]
        self._felt.setVisible(bool(check.feels))
        self._felt.setText(words.face(check.feels) if check.feels else "")
        self._felt.set_tone(tone)  # type: ignore[arg-type]
        if check.accepted and math.isfinite(check.tilt_deg):
            self._text.setText(self.tr("{tilt}° off level, still").format(tilt=number(check.tilt_deg, 2)))
        else:
            self._text.setText(said(check.message))


class WorkView(Translated):
    """Something is under way that is not a recording: how far it is."""

    def __init__(self) -> None:
        super().__init__()
        self._model = RunModel()
        column = column_of(self)
        self.feels = FeelsPanel()
        column.addWidget(self.feels)
        column.addStretch(1)
        self._bar = ProgressBar(height=6)
        self._left = Label(tone="muted")
        column.addWidget(self._bar)
        column.addWidget(self._left)
        self.retranslate()

    def refresh(self, model: RunModel) -> None:
        """Look at the model."""
        self._model = model
        self.feels.setVisible(model.check is not None)
        self.feels.refresh(model)
        activity = model.activity
        self._bar.set_value(activity.progress if activity is not None else None)
        remaining = activity.remaining_s if activity is not None else None
        self._left.setText(self.tr("{time} left").format(time=duration(remaining)) if remaining else "")

    def retranslate(self) -> None:
        """Set every text."""
        self.refresh(self._model)


class RecordView(Translated):
    """A recording: running mean ± standard error, how it got there, how long it still takes."""

    def __init__(self, bridge: RunBridge) -> None:
        super().__init__()
        self._bridge = bridge
        column = column_of(self)
        self._caption = Label(tone="muted")
        column.addWidget(self._caption)
        row = QHBoxLayout()
        row.setSpacing(STEP)
        self.mean = ValueLabel(role="title")
        row.addWidget(self.mean)
        column.addLayout(row)
        self.error = ValueLabel()
        column.addWidget(self.error)
        self.plot = ApproachPlot()
        column.addWidget(self.plot, 1)
        self._bar = ProgressBar(height=6)
        self._left = Label(tone="muted")
        column.addWidget(self._bar)
        column.addWidget(self._left)
        self.retranslate()

    def refresh(self, model: RunModel) -> None:
        """Look at the model."""
        segment = model.segment
        if segment is None:
            return
        running = self._bridge.data.running.look()
        unit = words.rate_unit(self._bridge.rate_unit)
        axis = segment.segment.axis
        known = math.isfinite(running.error) and running.error > 0
        places = max(0, min(7, 1 - math.floor(math.log10(running.error)))) if known else 4
        self._caption.setText(self.tr("Mean of gyro {axis} so far").format(axis=axis.upper()))
        self.mean.set_value(number(running.mean, places), unit)
        self.error.set_value(
            self.tr("± {error} standard error").format(error=number(running.error, places) if known else DASH)
        )
        self.error.set_tone("muted")
        self.plot.show_mean(running, segment.duration_s, AXIS_COLOURS[axis])
        self._bar.set_value(model.segment_progress)
        self._left.setText(
            self.tr("{left} left of {whole}").format(
                left=duration(model.step_left_s), whole=duration(segment.duration_s)
            )
        )

    def retranslate(self) -> None:
        """Set every text."""
        self.refresh(self._bridge.model)
