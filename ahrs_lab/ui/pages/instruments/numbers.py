"""A field for one number."""

from __future__ import annotations

import math

from ahrs_lab.ui.formatting import signed_rate
from ahrs_lab.ui.pages.widgets.form import TextField


class NumberField(TextField):
    """Empty is None; what is no number is marked and is None too."""

    def __init__(self, value: float | None = None) -> None:
        super().__init__()
        self.set_value(value)
        self.edited.connect(self.value)

    def set_value(self, value: float | None) -> None:
        """Does not tell ``edited``."""
        self.set_text("" if value is None else signed_rate(value))

    def value(self) -> float | None:
        """What stands there."""
        text = self.text().replace("\u2212", "-").replace(",", ".")
        try:
            value = float(text) if text else None
        except ValueError:
            value = math.nan
        good = value is None or math.isfinite(value)
        if bool(self.error()) == good:
            self.set_error("" if good else self.tr("a number, please"))
        return value if good else None
