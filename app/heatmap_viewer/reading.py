"""The part of the viewer's panel that asks how recordings are read."""

from __future__ import annotations

from PySide6.QtCore import Qt, QTimer, Signal
from PySide6.QtWidgets import QCheckBox, QDoubleSpinBox, QFormLayout, QGroupBox, QHBoxLayout, QWidget

from contactbench.app.heatmap_viewer.how import HowRead

_PATIENCE = 600  # ms without a change before recordings are read again


class ReadingBox(QGroupBox):
    """Asks for the mount of the sensor, the delay of its wrenches, and the force of a touch."""

    changed = Signal(object)  # HowRead, once nothing was changed for a moment

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setTitle(self.tr("Reading recordings"))
        self.own_mount = QCheckBox(self.tr("Mount of the sensor, degrees"))
        self.own_mount.setToolTip(
            self.tr("Off: as the session says, or not turned. On: about the flange's fixed axes x, y, z.")
        )
        self.own_mount.setMinimumHeight(36)
        self.mount = [
            self._field(
                -360.0, 360.0, f"{axis} ", "°", self.tr("Mount about {axis}, degrees").format(axis=axis)
            )
            for axis in "xyz"
        ]
        self.delay = self._field(
            -1000.0, 1000.0, "", " ms", self.tr("How much later a wrench is heard than its pose, ms")
        )
        self.least = self._field(0.0, 100.0, "", " N", self.tr("A touch is above this force, N"))
        self.least.setValue(HowRead().min_force)
        self._patience = QTimer(self, interval=_PATIENCE, singleShot=True)
        self._said = self.how()
        self._lay_out()
        self.own_mount.toggled.connect(self._show_mount)
        self.own_mount.toggled.connect(lambda _: self._patience.start())
        for field in (*self.mount, self.delay, self.least):
            field.valueChanged.connect(lambda _: self._patience.start())
        self._patience.timeout.connect(self._tell)
        self._show_mount(False)

    def _field(self, low: float, high: float, prefix: str, suffix: str, name: str) -> QDoubleSpinBox:
        field = QDoubleSpinBox()
        field.setRange(low, high)
        field.setDecimals(1)
        field.setPrefix(prefix)
        field.setSuffix(suffix)
        field.setMinimumSize(84, 36)
        field.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        field.setAccessibleName(name)
        field.setToolTip(name)
        return field

    def _lay_out(self) -> None:
        form = QFormLayout(self)
        form.setFieldGrowthPolicy(QFormLayout.FieldGrowthPolicy.AllNonFixedFieldsGrow)
        form.addRow(self.own_mount)
        row = QHBoxLayout()
        row.setSpacing(4)
        for field in self.mount:
            row.addWidget(field, 1)
        form.addRow(row)
        form.addRow(self.tr("Delay"), self.delay)
        form.addRow(self.tr("Touched above"), self.least)

    def how(self) -> HowRead:
        """Return what is chosen."""
        x, y, z = (field.value() for field in self.mount)
        own = self.own_mount.isChecked()
        return HowRead((x, y, z) if own else None, self.delay.value() / 1e3, self.least.value())

    def _show_mount(self, own: bool) -> None:
        for field in self.mount:
            field.setEnabled(own)

    def _tell(self) -> None:
        now = self.how()
        if now != self._said:
            self._said = now
            self.changed.emit(now)
