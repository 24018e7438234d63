"""The choosers of the Devices page: the sensor, and what tells its orientation."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from PySide6.QtCore import QSignalBlocker, Signal
from PySide6.QtWidgets import (
    QComboBox,
    QFileDialog,
    QGroupBox,
    QLineEdit,
    QPushButton,
    QVBoxLayout,
    QWidget,
)

from contactbench.assets import PROBE_NAMES
from contactbench.pipeline.devices.driver import Carrier
from contactbench.pipeline.devices.url import DeviceAddress, Protocol
from contactbench.pipeline.workbench import live_trial as devices
from contactbench.widgets.controls import HIGH, row, sentence_label
from contactbench.widgets.numbers import NumberBox, translated

if TYPE_CHECKING:
    from collections.abc import Sequence

    from contactbench.pipeline.devices.transport.ports import SerialPort

_PORT, _VIRTUAL, _REPLAY, _ADDRESS = "port", "virtual", "replay", "address"
_SAME, _STILL, _FILE, _NONE = "same", "still", "file", "none"


class FileField(QWidget):
    """The name of a file, and a button to choose it."""

    changed = Signal()

    def __init__(self, title: str, kinds: str, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._title, self._kinds = title, kinds
        self.edit = QLineEdit()
        self.edit.setPlaceholderText(title)
        self.edit.setAccessibleName(title)
        self.button = QPushButton(self.tr("Choose…"))
        both = row((self.edit, 1), self.button)
        both.setContentsMargins(0, 0, 0, 0)
        self.setLayout(both)
        self.edit.textChanged.connect(self.changed)
        self.button.clicked.connect(self._choose)

    @property
    def path(self) -> Path | None:
        """The file; None: none is named."""
        text = self.edit.text().strip()
        return Path(text).expanduser() if text else None

    def _choose(self) -> None:
        name, _ = QFileDialog.getOpenFileName(self, self._title, self.edit.text(), self._kinds)
        if name:
            self.edit.setText(name)


class DeviceChoice(QGroupBox):
    """
    A choice of kinds, what each needs beneath it, and what is wrong with it.

    Signals
    -------
    changed
        Something else is chosen.
    """

    changed = Signal()

    def __init__(self, title: str, parent: QWidget | None = None) -> None:
        super().__init__(title, parent)
        self.kind = QComboBox()
        self.kind.setMinimumHeight(HIGH)
        self.kind.setAccessibleName(title)
        self.kind.setSizeAdjustPolicy(QComboBox.SizeAdjustPolicy.AdjustToMinimumContentsLengthWithIcon)
        self._fields: list[QWidget] = []
        self._problem = sentence_label(role="bad")
        self._problem.setVisible(False)
        self._box = QVBoxLayout(self)
        self._box.addWidget(self.kind)
        self._box.addWidget(self._problem)
        self.kind.currentTextChanged.connect(self.kind.setToolTip)
        self.kind.currentIndexChanged.connect(self._show_fields)

    def _add(self, widget: QWidget) -> QWidget:
        self._fields.append(widget)
        self._box.insertWidget(self._box.count() - 1, widget)
        return widget

    def _show_fields(self) -> None:
        raise NotImplementedError

    def _show(self, widget: QWidget) -> None:
        for each in self._fields:
            each.setVisible(each is widget)

    def say(self, problem: str) -> None:
        """Show what is wrong; empty: nothing."""
        self._problem.setText(translated(problem))
        self._problem.setVisible(bool(problem))

    @property
    def problem(self) -> str:
        """What is shown as wrong."""
        return self._problem.text() if self._problem.isVisibleTo(self) else ""


class SensorSource(DeviceChoice):
    """Which force/torque sensor."""

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__("", parent)
        self.setTitle(self.tr("Force/torque sensor"))
        self.kind.setAccessibleName(self.title())
        self.protocol, self.probe = QComboBox(), QComboBox()
        for scheme, title in devices.serial_sensors().items():
            self.protocol.addItem(self.tr("Sensor made by {maker}").format(maker=title), scheme)
        for name in PROBE_NAMES:
            self.probe.addItem(self.tr("with the {name} probe").format(name=name), name)
        self.probe.setCurrentIndex(self.probe.findData("t-shape"))
        self.recording = FileField(self.tr("Recording"), self.tr("Recordings (*.mcap);;All files (*)"))
        self.address = QLineEdit()
        self.address.setPlaceholderText("sri+tcp://192.168.0.108")
        self.protocol.setAccessibleName(self.tr("Sensor manufacturer"))
        self.probe.setAccessibleName(self.tr("Virtual bench probe"))
        self.address.setAccessibleName(self.tr("Sensor address"))
        self.address.setToolTip(
            self.tr(
                "One of contactbench record devices, such as sri+tcp or line+udp, then :// and the device address"
            )
        )
        for widget in (self.protocol, self.probe, self.recording, self.address):
            self._add(widget)
        self.set_ports(())
        self.kind.setCurrentIndex(self.kind.findData(_VIRTUAL))
        self.protocol.activated.connect(self.changed)
        self.probe.activated.connect(self.changed)
        self.recording.changed.connect(self.changed)
        self.address.textChanged.connect(self.changed)

    def set_ports(self, ports: Sequence[SerialPort]) -> None:
        """Offer these serial ports; what is chosen stays chosen, also while its port is gone."""
        chosen, text = self.kind.currentData(), self.kind.currentText()
        entries = [(self._port_name(port), (_PORT, port.path, port.guess)) for port in ports]
        if isinstance(chosen, tuple) and all(chosen[1] != data[1] for _, data in entries):
            gone = self.tr(" (not plugged in)")
            entries.append((text.removesuffix(gone) + gone, chosen))
        fixed = [
            (self.tr("Virtual bench"), _VIRTUAL),
            (self.tr("Replay a recording"), _REPLAY),
            (self.tr("Enter address"), _ADDRESS),
        ]
        wanted = [*entries, *fixed]
        there = [(self.kind.itemText(i), self.kind.itemData(i)) for i in range(self.kind.count())]
        if wanted == there:
            return
        paths = [data[1] if isinstance(data, tuple) else data for _, data in wanted]
        key = chosen[1] if isinstance(chosen, tuple) else chosen
        with QSignalBlocker(self.kind):
            self.kind.clear()
            for name, data in wanted:
                self.kind.addItem(name, data)
            self.kind.setCurrentIndex(paths.index(key) if key in paths else paths.index(_VIRTUAL))
        self._show_fields()

    def _port_name(self, port: SerialPort) -> str:
        known = self.tr("{guess} sensor at {path}").format(guess=str(port.guess).upper(), path=port.path)
        return known if port.guess else f"{port.path} ({port.description})"

    def _show_fields(self) -> None:
        chosen = self.kind.currentData()
        if isinstance(chosen, tuple):
            if chosen[2] is not None:
                self.protocol.setCurrentIndex(self.protocol.findData(chosen[2]))
            self._show(self.protocol)
        else:
            self._show({_VIRTUAL: self.probe, _REPLAY: self.recording}.get(chosen, self.address))
        self.changed.emit()

    def address_now(self) -> str:
        """Return the address of what is chosen; empty: something is missing."""
        chosen = self.kind.currentData()
        if isinstance(chosen, tuple):
            return devices.serial_address(self.protocol.currentData(), chosen[1])
        if chosen == _VIRTUAL:
            return devices.virtual_address(self.probe.currentData())
        if chosen == _REPLAY:
            path = self.recording.path
            return "" if path is None else devices.replay_address(path)
        return self.address.text().strip()

    def choose(self, address: str) -> None:
        """Show a sensor that is set; what no other choice says as it is, is shown as a typed address."""
        if not address or devices.problem_of(address):
            self.address.setText(address)
            self.kind.setCurrentIndex(self.kind.findData(_ADDRESS if address else _VIRTUAL))
            return
        parsed = DeviceAddress.parse(address)
        self.address.setText(address)
        if parsed.protocol is Protocol.VIRTUAL and parsed.bench is not None:
            self.probe.setCurrentIndex(max(self.probe.findData(parsed.bench.probe), 0))
            self._take(_VIRTUAL, address)
        elif parsed.protocol is Protocol.REPLAY:
            self.recording.edit.setText(parsed.path)
            self._take(_REPLAY, address)
        elif parsed.carrier is Carrier.SERIAL:
            for index in range(self.kind.count()):
                data = self.kind.itemData(index)
                if isinstance(data, tuple) and data[1] == parsed.path:
                    self.kind.setCurrentIndex(index)
                    self.protocol.setCurrentIndex(self.protocol.findData(parsed.protocol))
                    return
            self.kind.setCurrentIndex(self.kind.findData(_ADDRESS))
        else:
            self.kind.setCurrentIndex(self.kind.findData(_ADDRESS))

    def _take(self, kind: str, address: str) -> None:
        self.kind.setCurrentIndex(self.kind.findData(kind))
        # Options that only an address has, such as a speed, must not get lost.
        if str(DeviceAddress.parse(self.address_now())) != str(DeviceAddress.parse(address)):
            self.kind.setCurrentIndex(self.kind.findData(_ADDRESS))


class PoseSource(DeviceChoice):
    """What tells the sensor's orientation."""

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__("", parent)
        self.setTitle(self.tr("Orientation"))
        self.kind.setAccessibleName(self.title())
        self.address = QLineEdit()
        self.address.setPlaceholderText("ur+tcp://192.168.0.10")
        self.address.setAccessibleName(self.tr("Robot address"))
        self.file = FileField(self.tr("Pose file"), self.tr("Poses (*.csv);;All files (*)"))
        self._hint = sentence_label(role="muted")
        self.angles = [angle_field(axis) for axis in "xyz"]
        for spin in self.angles:
            spin.setAccessibleName(self.tr("Flange rotation about {axis}").format(axis=spin.prefix()))
        still, angles = QWidget(), row(*self.angles)
        angles.setContentsMargins(0, 0, 0, 0)
        still.setLayout(angles)
        self._still = self._add(still)
        for widget in (self.address, self.file, self._hint):
            self._add(widget)
        for name, data in (
            (self.tr("From the sensor source"), _SAME),
            (self.tr("Robot"), _ADDRESS),
            (self.tr("Stationary"), _STILL),
            (self.tr("Pose file"), _FILE),
            (self.tr("None"), _NONE),
        ):
            self.kind.addItem(name, data)
        self.address.textChanged.connect(self.changed)
        self.file.changed.connect(self.changed)
        for spin in self.angles:
            spin.valueChanged.connect(self.changed)

    def _show_fields(self) -> None:
        chosen = self.kind.currentData()
        words = {
            _SAME: self.tr("A virtual bench and most recordings include the orientation."),
            _NONE: self.tr(
                "Gravity cannot be calibrated without an orientation. Only raw readings are shown."
            ),
        }
        self._hint.setText(words.get(chosen, ""))
        self._show({_ADDRESS: self.address, _STILL: self._still, _FILE: self.file}.get(chosen, self._hint))
        self.changed.emit()

    def address_now(self, sensor: str) -> str | None:
        """Return the address of what is chosen, beside a sensor's; None: nothing; empty: something is missing."""
        chosen = self.kind.currentData()
        if chosen == _NONE:
            return None
        if chosen == _SAME:
            return sensor
        if chosen == _STILL:
            return devices.still_address(*(spin.value() for spin in self.angles))
        if chosen == _FILE:
            path = self.file.path
            return "" if path is None else devices.poses_address(path)
        return self.address.text().strip()

    def problem_of(self, sensor: str) -> str:
        """Say what is wrong with what is chosen; empty: nothing."""
        address = self.address_now(sensor)
        if address is None:
            return ""
        if self.kind.currentData() == _SAME:
            if devices.gives_poses(sensor) or devices.problem_of(sensor):
                return ""
            return self.tr("This sensor does not report its orientation. Choose the robot that moves it.")
        if not address:
            return self.tr("Choose a pose file.")
        return devices.problem_of(address, poses=True)

    def choose(self, address: str | None, sensor: str) -> None:
        """Show a source that is set."""
        kind = _ADDRESS
        if address is None:
            kind = _NONE if sensor else _SAME
        elif address == sensor:
            kind = _SAME
        else:
            self.address.setText(address)
            parsed = None if devices.problem_of(address, poses=True) else DeviceAddress.parse(address)
            if parsed is not None and parsed.rpy_degrees is not None:
                for spin, angle in zip(self.angles, parsed.rpy_degrees, strict=True):
                    spin.setValue(angle)
                kind = _STILL
            elif parsed is not None and parsed.protocol is Protocol.POSES and parsed.robot is None:
                self.file.edit.setText(parsed.path)
                kind = _FILE
        self.kind.setCurrentIndex(self.kind.findData(kind))


def angle_field(axis: str) -> NumberBox:
    """Return a field for an angle about an axis, degrees."""
    field = NumberBox(decimals=1, minimum=-360.0, maximum=360.0, singleStep=90.0, suffix="°")
    field.setPrefix(f"{axis} ")
    field.setMinimumHeight(HIGH)
    return field
