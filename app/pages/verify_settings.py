"""How touches must be: force, repeats, order, limits."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from PySide6.QtCore import QSignalBlocker, Qt, Signal
from PySide6.QtWidgets import QComboBox, QDoubleSpinBox, QFormLayout, QHBoxLayout, QLabel, QSpinBox, QWidget

from contactbench.app.pages.verify_markers import narrow

if TYPE_CHECKING:
    from contactbench.pipeline.verification.result import VerificationParameters

_TALL = 36


class SettingsPanel(QWidget):
    """Asks for the settings of a verification, as its parameters have them."""

    changed = Signal(dict, str)  # parameter -> JSON value; what was done, in words

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._others: tuple[tuple[float, float], ...] = ()
        form = QFormLayout(self)
        form.setContentsMargins(0, 8, 0, 0)
        form.setRowWrapPolicy(QFormLayout.RowWrapPolicy.DontWrapRows)
        form.setFieldGrowthPolicy(QFormLayout.FieldGrowthPolicy.AllNonFixedFieldsGrow)
        self.low = self._number(0.2, 500.0, " N", self.tr("Lower end of the force window, N"))
        self.high = self._number(0.3, 500.0, " N", self.tr("Upper end of the force window, N"))
        pair = QHBoxLayout()
        pair.setSpacing(6)
        pair.addWidget(self.low, 1)
        pair.addWidget(QLabel(self.tr("to")))
        pair.addWidget(self.high, 1)
        form.addRow(self.tr("Press with"), pair)
        self.repeats = QSpinBox()
        self.repeats.setRange(1, 100)
        self.repeats.setSuffix(" ×")
        self._dress(self.repeats, self.tr("Accepted touches wanted of each marker"))
        form.addRow(self.tr("Each marker"), self.repeats)
        self.samples = QSpinBox()
        self.samples.setRange(4, 10_000)
        self._dress(self.samples, self.tr("Samples taken of each touch, once it has settled"))
        form.addRow(self.tr("Samples"), self.samples)
        self.order = QComboBox()
        self.order.addItem(self.tr("any order"), False)
        self.order.addItem(self.tr("as in the table"), True)
        self._dress(self.order, self.tr("In which order markers are touched"))
        self.order.setToolTip(
            self.tr(
                "In any order a touch is of the marker that it is near; in the table's order, of the next one."
            )
        )
        form.addRow(self.tr("Touch in"), self.order)
        self.mean = self._number(0.05, 50.0, " mm", self.tr("Largest mean error that passes, mm"))
        self.most = self._number(0.05, 50.0, " mm", self.tr("Largest error that passes, mm"))
        form.addRow(self.tr("Mean error up to"), self.mean)
        form.addRow(self.tr("Any error up to"), self.most)
        self.low.valueChanged.connect(self._windows)
        self.high.valueChanged.connect(self._windows)
        self.repeats.valueChanged.connect(
            lambda n: self.changed.emit({"repeats": n}, self.tr("Touches of each marker"))
        )
        self.samples.valueChanged.connect(
            lambda n: self.changed.emit({"samples": n}, self.tr("Samples of each touch"))
        )
        self.order.currentIndexChanged.connect(self._ordered)
        self.mean.valueChanged.connect(
            lambda x: self.changed.emit({"mean_limit_mm": x}, self.tr("Limit of the mean error"))
        )
        self.most.valueChanged.connect(
            lambda x: self.changed.emit({"max_limit_mm": x}, self.tr("Limit of any error"))
        )

    def _number(self, low: float, high: float, unit: str, name: str) -> QDoubleSpinBox:
        field = QDoubleSpinBox()
        field.setRange(low, high)
        field.setDecimals(2)
        field.setSingleStep(0.5)
        field.setSuffix(unit)
        self._dress(field, name)
        return field

    def _dress(self, field: QWidget, name: str) -> None:
        field.setMinimumHeight(_TALL)
        narrow(field, 70)
        field.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        field.setAccessibleName(name)
        field.setToolTip(name)
        if isinstance(field, QSpinBox | QDoubleSpinBox):
            field.setKeyboardTracking(False)

    def _windows(self) -> None:
        if self.low.value() >= self.high.value():
            return  # until the other end follows
        window = [self.low.value(), self.high.value()]
        self.changed.emit({"windows": [window, *map(list, self._others)]}, self.tr("Force window"))

    def _ordered(self) -> None:
        self.changed.emit({"order": self.order.currentData()}, self.tr("Order of touches"))

    def show_parameters(self, given: VerificationParameters) -> None:
        """Show what holds."""
        self._others = given.windows[1:]
        values: tuple[tuple[Any, Any], ...] = (
            (self.low, given.windows[0][0]),
            (self.high, given.windows[0][1]),
            (self.repeats, given.repeats),
            (self.samples, given.samples),
            (self.mean, given.mean_limit_mm),
            (self.most, given.max_limit_mm),
        )
        for field, value in values:
            with QSignalBlocker(field):
                field.setValue(value)
        with QSignalBlocker(self.order):
            self.order.setCurrentIndex(1 if given.order else 0)
