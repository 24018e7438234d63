"""How touches must be: force, repeats, order, limits."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtCore import Signal
from PySide6.QtWidgets import QLabel, QWidget

from contactbench.pipeline.settings import VerificationSettings
from contactbench.widgets.controls import choice, form, named, row, show_quietly
from contactbench.widgets.numbers import NumberBox
from contactbench.widgets.settings_rows import rows_of

if TYPE_CHECKING:
    from contactbench.pipeline.verification.result import VerificationParameters


_FIRST_LIMIT = "mean_limit_mm"  # above the limits stands what is asked of a touch


class VerifySettingsPanel(QWidget):
    """Asks for the settings of a verification, as its parameters have them."""

    changed = Signal(dict, str)  # parameter -> JSON value; what was done, in words

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._others: tuple[tuple[float, float], ...] = ()
        self.low = self._number(0.2, 500.0, " N", self.tr("Lower force limit, N"))
        self.high = self._number(0.3, 500.0, " N", self.tr("Upper force limit, N"))
        self.order = choice(
            ((self.tr("any order"), False), (self.tr("table order"), True)),
            self.tr("Order in which to touch the markers"),
            tip=self.tr(
                "Any order: a touch counts for the nearest marker. Table order: it counts for the next"
                " marker."
            ),
        )
        self.rows = rows_of(VerificationSettings)
        layout = form(self, top=8)
        layout.addRow(self.tr("Press with"), row((self.low, 1), QLabel(self.tr("to")), (self.high, 1)))
        for name, each in self.rows.items():
            if name == _FIRST_LIMIT:
                layout.addRow(self.tr("Touch order"), self.order)
            layout.addRow(each.title, each.field)
            each.changed.connect(
                lambda _, name=name, row=each: self.changed.emit({name: row.value}, row.name)
            )
        for end in (self.low, self.high):
            end.valueChanged.connect(self._set_window)
        self.order.currentIndexChanged.connect(
            lambda _: self.changed.emit({"order": self.order.currentData()}, self.tr("Order of touches"))
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
        for field, value in ((self.low, low), (self.high, high), (self.order, 1 if given.order else 0)):
            show_quietly(field, value)
        for name, each in self.rows.items():
            each.show(getattr(given, name))
