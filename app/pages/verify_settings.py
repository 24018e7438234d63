"""How touches must be: force, repeats, order, limits."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtCore import Signal
from PySide6.QtWidgets import QLabel, QSpinBox, QWidget

from contactbench.widgets.controls import choice, form, named, row, show_quietly
from contactbench.widgets.numbers import NumberBox

if TYPE_CHECKING:
    from contactbench.pipeline.verification.result import VerificationParameters


class VerifySettingsPanel(QWidget):
    """Asks for the settings of a verification, as its parameters have them."""

    changed = Signal(dict, str)  # parameter -> JSON value; what was done, in words

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._others: tuple[tuple[float, float], ...] = ()
        self.low = self._number(0.2, 500.0, " N", self.tr("Lower force limit, N"))
        self.high = self._number(0.3, 500.0, " N", self.tr("Upper force limit, N"))
        self.repeats = QSpinBox(minimum=1, maximum=100, suffix=" ×")
        named(self.repeats, self.tr("Accepted touches required per marker"))
        self.samples = QSpinBox(minimum=4, maximum=10_000)
        named(self.samples, self.tr("Samples per touch after settling"))
        self.order = choice(
            ((self.tr("any order"), False), (self.tr("table order"), True)),
            self.tr("Order in which to touch the markers"),
            tip=self.tr(
                "Any order: a touch counts for the nearest marker. Table order: it counts for the next"
                " marker."
            ),
        )
        self.mean = self._number(0.05, 50.0, " mm", self.tr("Largest permitted mean error, mm"))
        self.most = self._number(0.05, 50.0, " mm", self.tr("Largest permitted error, mm"))
        layout = form(self, top=8)
        layout.addRow(self.tr("Press with"), row((self.low, 1), QLabel(self.tr("to")), (self.high, 1)))
        layout.addRow(self.tr("Per marker"), self.repeats)
        layout.addRow(self.tr("Samples"), self.samples)
        layout.addRow(self.tr("Touch order"), self.order)
        layout.addRow(self.tr("Mean error up to"), self.mean)
        layout.addRow(self.tr("Single error up to"), self.most)
        for end in (self.low, self.high):
            end.valueChanged.connect(self._set_window)
        self.order.currentIndexChanged.connect(
            lambda _: self.changed.emit({"order": self.order.currentData()}, self.tr("Order of touches"))
        )
        for field, name, words in (
            (self.repeats, "repeats", self.tr("Touches per marker")),
            (self.samples, "samples", self.tr("Samples per touch")),
            (self.mean, "mean_limit_mm", self.tr("Mean error limit")),
            (self.most, "max_limit_mm", self.tr("Single error limit")),
        ):
            field.valueChanged.connect(
                lambda value, name=name, words=words: self.changed.emit({name: value}, words)
            )

    def _number(self, low: float, high: float, unit: str, name: str) -> NumberBox:
        field = NumberBox(decimals=2, minimum=low, maximum=high, singleStep=0.5, suffix=unit)
        return named(field, name)

    def _set_window(self) -> None:
        if self.low.value() >= self.high.value():
            return  # until the other end follows
        window = [self.low.value(), self.high.value()]
        self.changed.emit({"windows": [window, *map(list, self._others)]}, self.tr("Force window"))

    def show_parameters(self, given: VerificationParameters) -> None:
        """Show what holds."""
        (low, high), *others = given.windows
        self._others = tuple(others)
        for field, value in (
            (self.low, low),
            (self.high, high),
            (self.repeats, given.repeats),
            (self.samples, given.samples),
            (self.mean, given.mean_limit_mm),
            (self.most, given.max_limit_mm),
            (self.order, 1 if given.order else 0),
        ):
            show_quietly(field, value)
