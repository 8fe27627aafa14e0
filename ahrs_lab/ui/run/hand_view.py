"""At the right of the table's drawing while something is set by hand: what the device feels of it, what was
wrong, and the button."""

from __future__ import annotations

from PySide6.QtCore import Signal

from ahrs_lab.instruments.by_hand import Felt, HandRequest
from ahrs_lab.ui.formatting import number, unbroken
from ahrs_lab.ui.page import Translated
from ahrs_lab.ui.run import hand_words
from ahrs_lab.ui.run.model import RunModel
from ahrs_lab.ui.run.now_views import column_of
from ahrs_lab.ui.translation import said
from ahrs_lab.ui.widgets import BigNumber, Label, Panel, PrimaryButton, StateDot


class HandView(Translated):
    """``confirmed`` is the operator's word that it is done; it is checked before it counts."""

    confirmed = Signal()

    def __init__(self) -> None:
        super().__init__()
        self._model = RunModel()
        column = column_of(self)
        self.panel = Panel("plain")
        self.feels = BigNumber()
        self.holds = StateDot()
        self._note = Label(tone="muted", wrap=True)
        for widget in (self.feels, self.holds, self._note):
            self.panel.body.addWidget(widget)
        column.addWidget(self.panel)
        self.refusal = Panel("bad")
        self._why = Label(wrap=True)
        self.refusal.body.addWidget(self._why)
        column.addWidget(self.refusal)
        column.addStretch(1)
        self.button = PrimaryButton(large=True)
        self.button.clicked.connect(self.confirmed)
        column.addWidget(self.button)
        self.retranslate()

    def refresh(self, model: RunModel) -> None:
        """Look at the model."""
        self._model = model
        request = model.hand
        if request is None:
            return
        self._show_felt(request, model.felt)
        why = model.hand_refused
        self.refusal.setVisible(why is not None and not model.confirmed)
        self._why.setText(unbroken(said(why)) if why is not None else "")
        asked = model.state == "waiting"
        if model.confirmed and self.window().focusWidget() is self.button:
            # Else Qt hands the keyboard to the next button, and another press of the space bar presses that.
            self.button.clearFocus()
        self.button.setVisible(asked)
        self.button.setEnabled(not model.confirmed)
        if model.confirmed:
            self.button.set_caption(self.tr("Being checked …"))
        else:
            self.button.set_caption(hand_words.done(request), self.tr("Space"))

    def _show_felt(self, request: HandRequest, felt: Felt | None) -> None:
        told = felt is not None and felt.rate_dps is not None
        self.feels.setVisible(told)
        self.holds.setVisible(told)
        self._note.setVisible(not told)
        if felt is None or felt.rate_dps is None:
            self.panel.set_kind("plain")
            return
        travels = request.kind in ("angle", "turns")
        decimals = 1 if travels else 2
        value = felt.travel_deg if travels else felt.rate_dps
        self.feels.set_caption(self.tr("The device has felt") if travels else self.tr("The device feels"))
        self.feels.set_value(number(value, decimals, plus=True), "°" if travels else "°/s")
        self.panel.set_kind("good" if felt.holds else "warn")
        allowed = f"±{number(felt.allowed, 1)} {'°' if travels else '°/s'}"
        if felt.holds:
            self.holds.set_state("good", self.tr("as asked, within {allowed}").format(allowed=allowed))
        elif travels and abs(felt.rate_dps) > 1.0:
            self.holds.set_state("warn", self.tr("turning, {rate} °/s").format(rate=number(felt.rate_dps, 1)))
        else:
            self.holds.set_state("warn", self.tr("not yet within {allowed}").format(allowed=allowed))

    def retranslate(self) -> None:
        """Set every text."""
        self._note.setText(
            self.tr(
                "The device feels nothing of it now, so your word is taken: look twice before confirming."
            )
        )
        self.refresh(self._model)
