"""The result of a discrete IMU calibration: the matrices of gyros and accelerometers, the positions'
residuals, how the set is applied, warnings."""

from __future__ import annotations

from collections.abc import Sequence

from PySide6.QtCore import Signal
from PySide6.QtWidgets import QHBoxLayout, QStackedWidget, QVBoxLayout, QWidget

from ahrs_lab.metrology.imu_result import ImuResult
from ahrs_lab.ui.formatting import number
from ahrs_lab.ui.page import Translated
from ahrs_lab.ui.pages.results.findings_view import FindingsView
from ahrs_lab.ui.pages.results.imu_rows import AXES, Matrix, accel_matrices, gyro_matrices, residual_rows
from ahrs_lab.ui.pages.widgets.table import Cell, Column, TextTable
from ahrs_lab.ui.pages.widgets.tabs import Tabs
from ahrs_lab.ui.run.words import position
from ahrs_lab.ui.theme import CARD_MARGIN, GAP
from ahrs_lab.ui.widgets import Banner, Card, Label


class ImuView(Translated):
    """``certificate_wanted``: the person wants the sheet."""

    certificate_wanted = Signal()

    def __init__(self) -> None:
        super().__init__()
        self._result: ImuResult | None = None
        column = QVBoxLayout(self)
        column.setContentsMargins(0, 0, 0, 0)
        column.setSpacing(CARD_MARGIN)
        self.verdict = Banner("info", large=True)
        self.verdict.pressed.connect(self.certificate_wanted)
        column.addWidget(self.verdict)
        card = Card()
        self.tabs = Tabs()
        head = QHBoxLayout()
        head.addWidget(self.tabs)
        head.addStretch(1)
        card.add(head)
        self.gyros, self.accelerometers, self.positions = (
            TextTable(selectable=False, compact=True) for _ in range(3)
        )
        self.findings = FindingsView()
        self._formula = Label(wrap=True)
        self._condition = Label(tone="muted", wrap=True)
        self._views = QStackedWidget()
        for view in (self.gyros, self.accelerometers, self._beneath(self.positions), self.findings):
            self._views.addWidget(view)
        self.tabs.currentChanged.connect(self._views.setCurrentIndex)
        card.add(self._views, 1)
        card.add(self._formula)
        column.addWidget(card, 1)
        self.retranslate()

    def _beneath(self, table: TextTable) -> QWidget:
        whole = QWidget()
        column = QVBoxLayout(whole)
        column.setContentsMargins(0, 0, 0, 0)
        column.setSpacing(GAP)
        column.addWidget(table, 1)
        column.addWidget(self._condition)
        return whole

    def show_result(self, result: ImuResult | None) -> None:
        """Everything from one result; None: there is none."""
        self._result = result
        if result is None:
            return
        self._fill(self.gyros, gyro_matrices(result), self._gyro_names())
        self._fill(self.accelerometers, accel_matrices(result), self._accel_names())
        self._fill_positions(result)
        self.findings.show_result(result)
        self.verdict.set_content(
            "warn" if result.warnings else "good",
            self.tr("Calibrated from {count} positions").format(count=len(result.dwells)),
            self.tr("Each value with its U (k = 2). Warnings: {warnings}.").format(
                warnings=len(result.warnings)
            ),
            self.tr("To the certificate"),
        )

    def _fill(self, table: TextTable, matrices: Sequence[Matrix], names: dict[str, str]) -> None:
        """A line a channel and quantity: a vector's number stands in the column of its own axis."""
        columns = (
            Column(self.tr("Quantity"), stretch=True),
            Column(self.tr("Output channel")),
            *(Column(self.tr("Input axis {axis}").format(axis=axis.upper()), right=True) for axis in AXES),
            Column(self.tr("Unit")),
        )
        rows, keys = [], []
        for matrix in matrices:
            for i, axis in enumerate(AXES):
                texts = list(matrix.cells[i])
                if len(texts) == 1:
                    texts = [texts[0] if j == i else "" for j in range(3)]
                cells = [Cell(names[matrix.key] if i == 0 else ""), Cell(axis.upper(), "muted")]
                cells += [Cell(text, strong=text not in ("", "0")) for text in texts]
                rows.append((*cells, Cell(matrix.unit, "muted")))
                keys.append(f"{matrix.key}.{axis}")
        table.set_content(columns, rows, keys)

    def _fill_positions(self, result: ImuResult) -> None:
        columns = (
            Column(self.tr("Position"), stretch=True),
            Column(self.tr("X, Y, Z point")),
            *(Column(self.tr("Gyro {axis}, °/h").format(axis=a.upper()), right=True) for a in AXES),
            *(Column(self.tr("Accel. {axis}, mm/s²").format(axis=a.upper()), right=True) for a in AXES),
        )
        rows, keys = [], []
        for name, stood, texts in residual_rows(result):
            letters, _, rest = stood.partition(" ")
            rows.append((Cell(name), Cell(f"{position(letters)} {rest}".strip()), *map(Cell, texts)))
            keys.append(name)
        self.positions.set_content(columns, rows, keys)
        quality = result.calibration.quality
        self._condition.setText(
            ""
            if quality is None
            else self.tr(
                "Residuals of the fit. Condition numbers: positions {positions}, turns {turns}."
            ).format(positions=number(quality.accel_condition, 2), turns=number(quality.turns_condition, 2))
        )

    def _gyro_names(self) -> dict[str, str]:
        return {
            "E1": self.tr("Scale factor E1"),
            "B0": self.tr("Zero offset (constant drift) B0"),
            "Bf": self.tr("Specific-force coefficients Bf"),
            "E": self.tr("Misalignment E"),
        }

    def _accel_names(self) -> dict[str, str]:
        return {
            "K1": self.tr("Scale factor K1"),
            "K0": self.tr("Zero offset K0"),
            "K": self.tr("Misalignment K"),
        }

    def retranslate(self) -> None:
        self.tabs.set_texts(
            self.tr("Gyros"),
            self.tr("Accelerometers"),
            self.tr("Positions and residuals"),
            self.tr("Warnings and remarks"),
        )
        self._formula.setText(
            self.tr(
                "N = E1·[B0 + Bf·f + (I + E)·ω], N_A = K1·[K0 + (I + K)·f], channel by channel. "
                "To compensate: f = inv(I + K)·(N_A/K1 − K0), then ω = inv(I + E)·(N/E1 − B0 − Bf·f)."
            )
        )
        self.show_result(self._result)
