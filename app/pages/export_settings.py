"""What goes into a bundle beside calibration and probe: settings ``config.*`` of the session."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

from PySide6.QtCore import QSignalBlocker, Qt, Signal
from PySide6.QtWidgets import (
    QCheckBox,
    QDoubleSpinBox,
    QFileDialog,
    QFormLayout,
    QHBoxLayout,
    QLineEdit,
    QPushButton,
    QSizePolicy,
    QToolButton,
    QWidget,
)

from contactbench.widgets.icons import icon

if TYPE_CHECKING:
    from contactbench.pipeline.config.runtime.options import ExportOptions

_TALL = 36


class ExportSettingsPanel(QWidget):
    """Asks for the options of an export; null means: what the session knows."""

    changed = Signal(dict, str)  # option -> JSON value; what was done, in words
    failed = Signal(str)  # why something that was chosen is not taken

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        form = QFormLayout(self)
        form.setContentsMargins(0, 4, 0, 0)
        form.setRowWrapPolicy(QFormLayout.RowWrapPolicy.DontWrapRows)
        form.setFieldGrowthPolicy(QFormLayout.FieldGrowthPolicy.AllNonFixedFieldsGrow)
        self.sensor = self._text(self.tr("Model of the sensor"), self.tr("unknown"), "sensor")
        form.addRow(self.tr("Sensor"), self.sensor)
        self.serial = self._text(
            self.tr("Serial number of the sensor"), self.tr("as the session knows it"), "serial"
        )
        form.addRow(self.tr("Serial number"), self.serial)
        self.sensor_name = self._text(
            self.tr("Name of the sensor in the robot description, for ros2.yaml"),
            self.tr("to be filled in later"),
            "sensor_name",
        )
        form.addRow(self.tr("Name in ROS"), self.sensor_name)
        self.operator = self._text(
            self.tr("Who is answerable"), self.tr("who made the newest result"), "operator"
        )
        form.addRow(self.tr("Operator"), self.operator)
        self.rate = self._number(
            10e3, " Hz", self.tr("Readings a second, Hz"), self.tr("as verified"), "rate"
        )
        form.addRow(self.tr("Readings"), self.rate)
        self.smooth = QCheckBox(self.tr("Filter the wrench"))
        self.smooth.setToolTip(self.tr("A Kalman filter: less noise, a little lag"))
        self.smooth.setMinimumHeight(_TALL)
        self.smooth.toggled.connect(lambda on: self._say("no_filter", not on, self.smooth.text()))
        form.addRow(self.smooth)
        self.cutoff = self._number(
            5e3, " Hz", self.tr("Low-pass of the contact point, Hz"), self.tr("none"), "cutoff"
        )
        form.addRow(self.tr("Low-pass"), self.cutoff)
        self.region_only = QCheckBox(self.tr("Only contacts on a region"))
        self.region_only.setToolTip(self.tr("The runtime refuses contacts outside every painted region"))
        self.region_only.setMinimumHeight(_TALL)
        self.region_only.toggled.connect(lambda on: self._say("region_only", on, self.region_only.text()))
        form.addRow(self.region_only)
        self.force = self._number(
            1e3, " N", self.tr("What a controller must never exceed, N"), "", "max_force"
        )
        form.addRow(self.tr("Largest force"), self.force)
        self.torque = self._number(
            100.0, " N·m", self.tr("What a controller must never exceed, N·m"), "", "max_torque"
        )
        form.addRow(self.tr("Largest torque"), self.torque)
        self.gains, self.no_gains = QPushButton(icon("folder"), ""), QToolButton()
        self.gains.setSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Fixed)
        self.gains.setMinimumHeight(_TALL)
        self.gains.setAccessibleName(self.tr("Gains of the controller"))
        self.gains.setToolTip(
            self.tr("How a robot presses and follows: gains.json of contactbench bench control tune")
        )
        self.gains.clicked.connect(self._ask_gains)
        self.no_gains.setIcon(icon("cross"))
        self.no_gains.setAccessibleName(self.tr("Leave the gains out"))
        self.no_gains.setToolTip(self.no_gains.accessibleName())
        self.no_gains.clicked.connect(lambda: self._say("controller", None, self.no_gains.toolTip()))
        both = QHBoxLayout()
        both.addWidget(self.gains, 1)
        both.addWidget(self.no_gains)
        form.addRow(self.tr("Gains"), both)

    def _ask_gains(self) -> None:
        name, _ = QFileDialog.getOpenFileName(self, self.tr("Open gains"), "", self.tr("Gains (*.json)"))
        if name:
            self.read_gains(Path(name))

    def read_gains(self, file: Path) -> None:
        """Take the gains of a file."""
        from contactbench.pipeline.config.runtime.settings_file import controller_in
        from contactbench.pipeline.errors import InputError

        try:
            controller = controller_in(file.read_bytes(), file.name)
        except (InputError, OSError) as error:
            self.failed.emit(str(error))
            return
        self._say("controller", controller.model_dump(mode="json"), self.gains.accessibleName())

    def _say(self, name: str, value: Any, text: str) -> None:
        self.changed.emit({name: value}, text)

    def _text(self, name: str, otherwise: str, option: str) -> QLineEdit:
        field = QLineEdit()
        field.setPlaceholderText(otherwise)
        field.setMaxLength(200)
        field.setMinimumHeight(_TALL)
        field.setAccessibleName(name)
        field.setToolTip(name)
        field.editingFinished.connect(lambda: self._say(option, field.text().strip() or None, name))
        return field

    def _number(self, most: float, unit: str, name: str, otherwise: str, option: str) -> QDoubleSpinBox:
        field = QDoubleSpinBox()
        field.setRange(0.0 if otherwise else 0.1, most)
        field.setDecimals(1)
        field.setSuffix(unit)
        field.setSpecialValueText(otherwise)
        field.setKeyboardTracking(False)
        field.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        field.setMinimumSize(90, _TALL)
        field.setSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Fixed)
        field.setAccessibleName(name)
        field.setToolTip(name)
        field.valueChanged.connect(
            lambda value: self._say(option, None if otherwise and value == 0.0 else value, name)
        )
        return field

    def show_options(self, options: ExportOptions, known_serial: str = "") -> None:
        """Show what holds."""
        texts = (
            (self.sensor, "" if options.sensor == "unknown" else options.sensor),
            (self.serial, options.serial or ""),
            (self.sensor_name, options.sensor_name or ""),
            (self.operator, options.operator or ""),
        )
        for field, text in texts:
            with QSignalBlocker(field):
                if field.text() != text:
                    field.setText(text)
        if known_serial:
            self.serial.setPlaceholderText(known_serial)
        numbers = (
            (self.rate, options.rate or 0.0),
            (self.cutoff, options.cutoff or 0.0),
            (self.force, options.max_force),
            (self.torque, options.max_torque),
        )
        for spin, value in numbers:
            with QSignalBlocker(spin):
                spin.setValue(value)
        part = options.controller
        self.gains.setText(
            self.tr("left out")
            if part is None
            else self.tr("{force:g} N, {variant}").format(
                force=part.desired_force_N,
                variant=self.tr("aware") if part.variant == "aware" else self.tr("plain"),
            )
        )
        self.no_gains.setVisible(part is not None)
        for box, on in ((self.smooth, not options.no_filter), (self.region_only, options.region_only)):
            with QSignalBlocker(box):
                box.setChecked(on)
