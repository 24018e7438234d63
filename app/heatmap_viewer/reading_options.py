"""How recordings are read, beside the files that are given, and the part of the viewer's panel that asks."""

from PySide6.QtCore import QTimer, Signal
from PySide6.QtWidgets import QGroupBox, QWidget

from contactbench.pipeline.settings import ReadingSettings
from contactbench.widgets.controls import HIGH, check_box, form, named, row
from contactbench.widgets.messages import NumberBox
from contactbench.widgets.settings_rows import rows_of

_PATIENCE = 600  # ms without a change before recordings are read again


class ReadingBox(QGroupBox):
    """Asks for the mount of the sensor, the delay of its wrenches, and the force of a touch."""

    changed = Signal(object)  # ReadingSettings, once nothing was changed for a moment

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setTitle(self.tr("Reading recordings"))
        tip = self.tr(
            "Off: mounting from the session, or no rotation. On: rotation about the flange's fixed axes x, y, z."
        )
        self.own_mount = check_box(self.tr("Sensor mount, degrees"), tip=tip)
        self.mount = [
            self._field(
                -360.0, 360.0, f"{axis} ", "°", self.tr("Mount about {axis}, degrees").format(axis=axis)
            )
            for axis in "xyz"
        ]
        self.delay = self._field(
            -1000.0, 1000.0, "", " ms", self.tr("Delay of the wrench relative to its pose, ms")
        )
        self.limits = rows_of(ReadingSettings)
        for name, each in self.limits.items():
            each.show(getattr(ReadingSettings(), name))
        self._patience = QTimer(self, interval=_PATIENCE, singleShot=True)
        self._said = self.how()
        self._lay_out()
        self.own_mount.toggled.connect(self._show_mount)
        self.own_mount.toggled.connect(lambda _: self._patience.start())
        for field in (*self.mount, self.delay, *(each.field for each in self.limits.values())):
            field.valueChanged.connect(lambda _: self._patience.start())
        self._patience.timeout.connect(self._tell)
        self._show_mount(False)

    def _field(self, low: float, high: float, prefix: str, suffix: str, name: str) -> NumberBox:
        field = NumberBox(decimals=1, minimum=low, maximum=high, prefix=prefix, suffix=suffix)
        named(field, name).setMinimumSize(84, HIGH)
        return field

    def _lay_out(self) -> None:
        rows = form(self)
        rows.setContentsMargins(9, 9, 9, 9)
        rows.addRow(self.own_mount)
        rows.addRow(row(*((field, 1) for field in self.mount), space=4))
        rows.addRow(self.tr("Delay"), self.delay)
        for each in self.limits.values():
            rows.addRow(each.title, each.field)

    def how(self) -> ReadingSettings:
        """Return what is chosen."""
        x, y, z = (field.value() for field in self.mount)
        own = self.own_mount.isChecked()
        limits = {name: each.value for name, each in self.limits.items()}
        mount = (x, y, z) if own else None
        return ReadingSettings.checked({"mount": mount, "delay": self.delay.value() / 1e3, **limits})

    def _show_mount(self, own: bool) -> None:
        for field in self.mount:
            field.setEnabled(own)

    def _tell(self) -> None:
        now = self.how()
        if now != self._said:
            self._said = now
            self.changed.emit(now)
