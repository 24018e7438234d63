"""Step 1: which sensor, what tells its orientation, and whether they work."""

import time
from collections.abc import Mapping, Sequence
from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import replace
from pathlib import Path
from typing import ClassVar

from PySide6.QtCore import QSignalBlocker, Signal
from PySide6.QtWidgets import QGroupBox, QLineEdit, QPushButton, QWidget

from contactbench.app.bench import Bench, Page, Weight
from contactbench.app.undo import SetParameters
from contactbench.assets import PROBE_NAMES
from contactbench.pipeline.devices.driver import Carrier
from contactbench.pipeline.devices.transport.ports import SerialPort, list_ports
from contactbench.pipeline.devices.url import DeviceAddress, Protocol
from contactbench.pipeline.steps import Step, StepStatus
from contactbench.pipeline.workbench import live_trial as devices
from contactbench.pipeline.workbench.live_trial import Devices, due_problem, gives_poses, problem_of, trial_of
from contactbench.widgets.controls import (
    HIGH,
    PanelScroll,
    asked_file,
    called,
    choice,
    column,
    form,
    panel,
    plain_label,
    row,
    sentence_label,
    stacked,
)
from contactbench.widgets.device_trial import DeviceChannels, DeviceTrial
from contactbench.widgets.glance import Glance
from contactbench.widgets.messages import NumberBox, translated

_PORTS_EVERY_S, _TRIAL_EVERY_S = 2.0, 0.5


class DevicesPage(Page):
    """Choose devices, try them, use them."""

    step: ClassVar[Step] = Step.DEVICES

    def __init__(self, bench: Bench, parent: QWidget | None = None) -> None:
        super().__init__(bench, parent)
        self._worker = ThreadPoolExecutor(1, "serial ports")
        self._ports: Future[list[SerialPort]] | None = None
        self._ports_at = self._trial_at = 0.0
        self._opening = False
        self._refused = ("", "")  # the address that could not be opened, and why
        self._known = Devices.of(bench.desk.state)
        self._build()
        self._show_devices(self._known)
        bench.changed.connect(self._follow_session)

    # ---- what is there -----------------------------------------------------------------------------

    def _build(self) -> None:
        self._status = sentence_label()
        self.sensor, self.poses = SensorSource(), PoseSource()
        label, number = self.tr("see the sensor's label"), self.tr("Sensor serial number")
        self.serial = called(QLineEdit(placeholderText=label), number)
        number = self.tr("Number of the sensor's calibration certificate")
        self.certificate = called(QLineEdit(maxLength=200, placeholderText=self.tr("for the report")), number)
        date = self.tr("Date until which the certificate is valid, YYYY-MM-DD")
        self.due = called(QLineEdit(maxLength=10, placeholderText=self.tr("YYYY-MM-DD")), date)
        self.mount = [angle_field(axis) for axis in "xyz"]
        tip = self.tr(
            "Rotation of the sensor on the flange about the flange's fixed axes, in the order x, y, z"
        )
        for spin in self.mount:
            called(spin, self.tr("Mounting angle about {axis}").format(axis=spin.prefix()), tip)
        self.use_button, self.try_button = self.bar.primary, self.bar.second
        self.trial, self.channels = DeviceTrial(), DeviceChannels()
        mounting, papers = QGroupBox(self.tr("Mounting")), QGroupBox(self.tr("Identification"))
        column(
            mounting, plain_label(self.tr("Sensor on the flange")), row(*((each, 1) for each in self.mount)),
            margins=(9, 9, 9, 9),
        )  # fmt: skip
        lines = form(papers)
        lines.setContentsMargins(9, 9, 9, 9)
        lines.addRow(self.tr("Serial number"), self.serial)
        lines.addRow(self.tr("Certificate"), self.certificate)
        lines.addRow(self.tr("Valid until"), self.due)
        self._measured, title = QGroupBox(self.tr("Measured")), plain_label(self.tr("Devices"), "title")
        column(self._measured, self.channels, margins=(2, 2, 2, 2))
        self._measured.hide()  # until there is something in it
        parts = (self._status, self.trial, self.sensor, self.poses, mounting, papers, self._measured)
        self.fill(PanelScroll(panel(title, *parts, 1, margins=(6, 8, 6, 8), space=6)))
        self.sensor.changed.connect(self._edited)
        self.poses.changed.connect(self._edited)
        for field in (self.serial, self.certificate, self.due):
            field.textChanged.connect(self._edited)
        for spin in self.mount:
            spin.valueChanged.connect(self._edited)

    # ---- what is chosen ----------------------------------------------------------------------------

    def devices(self) -> Devices:
        """Return what is chosen on the page."""
        sensor = self.sensor.address_now()
        x, y, z = (spin.value() for spin in self.mount)
        serial, certificate, due = (each.text().strip() for each in (self.serial, self.certificate, self.due))
        return Devices(sensor, self.poses.address_now(sensor), (x, y, z), serial, certificate, due)

    def _show_devices(self, devices: Devices) -> None:
        self.sensor.choose(devices.sensor)
        self.poses.choose(devices.poses, devices.sensor)
        for spin, angle in zip(self.mount, devices.mount, strict=True):
            spin.setValue(angle)
        self.serial.setText(devices.serial)
        self.certificate.setText(devices.certificate)
        self.due.setText(devices.due)
        self._edited()

    def _edited(self) -> None:
        sensor = self.sensor.address_now()
        same = gives_poses(sensor)
        poses = self.poses.address_now(sensor) or ""
        for each, address in ((self.sensor, sensor), (self.poses, "" if poses == sensor else poses)):
            words = self.tr("Address for commands: {}").format(address) if address else ""
            each.setToolTip(words)
            each.address_line.setText(words)
            each.address_line.setVisible(bool(words) and each.kind.currentData() != _ADDRESS)
        # An empty field is no mistake yet: the button says what is missing.
        refused = self._refused[1] if self._refused[0] == sensor else ""
        self.sensor.say((problem_of(sensor) or refused) if sensor else "")
        self.poses.say(self.poses.problem_of(sensor) if sensor or not same else "")
        self._allow()

    def _problem(self) -> str:
        sensor = self.sensor.address_now()
        return problem_of(sensor) or self.poses.problem_of(sensor) or due_problem(self.due.text().strip())

    def _allow(self) -> None:
        recording = {Step.GRAVITY, Step.VERIFY} & self.bench.running
        problem = self._problem()
        free = not (recording or problem or self._opening)
        chosen = self.devices()
        used = chosen == Devices.of(self.bench.desk.state) and self.bench.connected
        test = self.tr("Test connection")
        if used and not self._opening:
            self.bar.offer(self.tr("Next: Gravity"), lambda: self.bench.go_to.emit(Step.GRAVITY))
        else:
            self.bar.offer(self.tr("Use these devices"), self.use, enabled=free)
        self.bar.offer_second(test, self.test, enabled=free)
        note = translated(problem)
        if note in (self.sensor.problem, self.poses.problem):
            note = ""
        if recording:
            note = self.tr("These devices are recording. Stop the recording before you change them.")
        elif self._opening:
            note = self.tr("Opening devices…")
        self.bar.say(note)

    # ---- trying and using --------------------------------------------------------------------------

    def test(self) -> None:
        """Open what is chosen and show how good it is; the session is not changed."""
        self._open(self.devices(), self.tr("Testing connection"))

    def use(self) -> None:
        """Write what is chosen into the session, and open it; can be undone."""
        devices = self.devices()
        self.bench.undo.push(
            SetParameters(self.bench, devices.settings, self.tr("choose devices"), failed=self._not_set)
        )
        self._open(devices, self.tr("Opening devices"))

    def _open(self, devices: Devices, title: str) -> None:
        if self._opening:
            return
        self._opening = True
        self._allow()
        live = self.bench.live

        def work(_progress: object, _cancelled: object) -> None:
            live.ensure(devices.sensor, devices.poses, devices.R_ES)

        self.bench.jobs.start(title, work, self._opened, self._not_opened)

    def _opened(self, _: object) -> None:
        self._opening, self._refused = False, ("", "")
        self.bench.set_failed(Step.DEVICES, "")
        self._allow()
        self.bench.changed.emit()  # whether they are connected is no part of the session

    def _not_opened(self, error: BaseException) -> None:
        self._opening, self._refused = False, (self.sensor.address_now(), str(error))
        self._allow()
        words = self.tr("Could not open the devices: {why}").format(why=translated(error))
        self.sensor.say(str(error))
        self.bench.tell(Weight.ERROR, words)
        self.bench.set_failed(Step.DEVICES, words)

    def _not_set(self, error: BaseException) -> None:
        self.bench.tell(
            Weight.ERROR, self.tr("Could not save the device settings: {why}").format(why=translated(error))
        )

    def _follow_session(self) -> None:
        """Show, and open, what the session says now, such as after an undo."""
        self._allow()
        devices = Devices.of(self.bench.desk.state)
        if devices == self._known or self._opening:  # then once they are open
            return
        before, self._known = self._known, devices
        if devices != self.devices():
            self._show_devices(devices)
        live, wanted = self.bench.live, (devices.sensor, devices.poses)
        moved = wanted != (before.sensor, before.poses) and wanted != live.addresses
        busy = {Step.GRAVITY, Step.VERIFY} & self.bench.running
        if busy or not moved or live.pair is None:
            return
        if devices.sensor:
            self._open(devices, self.tr("Opening devices"))
        else:
            self.bench.jobs.start(self.tr("Closing devices"), lambda *_: live.close())

    # ---- the page ----------------------------------------------------------------------------------

    def enter(self) -> None:
        """Be shown: look for serial ports, and measure."""
        self._ports_at = self._trial_at = 0.0

    def leave(self) -> None:
        """Be hidden: what was only tried gives way to what the session says."""
        devices = Devices.of(self.bench.desk.state)
        live = self.bench.live
        known = (devices.sensor, devices.poses)
        if devices.sensor and live.pair is not None and live.addresses != known and not self._opening:
            self._open(devices, self.tr("Opening devices"))

    def show_state(self, status: StepStatus) -> None:
        """Show how the step stands."""
        self._status.setText(translated(status.sentence))
        self._allow()

    def tick(self) -> None:
        """Show what is plugged in and how good the connection is."""
        now = time.monotonic()
        self._look_for_ports(now)
        if now - self._trial_at >= _TRIAL_EVERY_S:
            self._trial_at = now
            trial = trial_of(self.bench.live)
            self.trial.show_trial(trial)
            self.channels.show_trial(trial)
            if self.bench.live.rate:
                self._measured.show()

    def glance(self, status: StepStatus) -> Glance:
        """Return how fast samples come."""
        found, rate = super().glance(status), self.bench.live.rate
        words = self.tr("{} Hz").format(round(rate or 0))
        return replace(found, number=words, of=self.tr("samples")) if rate else found

    def close_page(self) -> None:
        """End the look-out for ports."""
        self.bench.changed.disconnect(self._follow_session)
        self._worker.shutdown(wait=False, cancel_futures=True)

    def _look_for_ports(self, now: float) -> None:
        if self._ports is not None:
            if self._ports.done():
                found, self._ports = self._ports, None
                if found.exception() is None:
                    self.sensor.set_ports(found.result())
        elif now - self._ports_at >= _PORTS_EVERY_S:
            self._ports_at = now
            self._ports = self._worker.submit(list_ports)


# ---- the choosers of the Devices page: the sensor, and what tells its orientation ----------------


_PORT, _VIRTUAL, _REPLAY, _NETWORK, _ADDRESS = "port", "virtual", "replay", "network", "address"
_SAME, _STILL, _FILE, _NONE = "same", "still", "file", "none"


class FileField(QWidget):
    """The name of a file, and a button to choose it."""

    changed = Signal()

    def __init__(self, title: str, kinds: str, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._title, self._kinds = title, kinds
        self.edit = called(QLineEdit(placeholderText=title), title)
        self.button = QPushButton(self.tr("Choose…"))
        self.setLayout(row((self.edit, 1), self.button))
        self.edit.textChanged.connect(self.changed)
        self.button.clicked.connect(self._choose)

    @property
    def path(self) -> Path | None:
        """The file; None: none is named."""
        text = self.edit.text().strip()
        return Path(text).expanduser() if text else None

    def _choose(self) -> None:
        if file := asked_file(self, self._title, self._kinds, self.edit.text()):
            self.edit.setText(str(file))


class NetworkField(QWidget):
    """
    A device at a network address: which make, and its host.

    Parameters
    ----------
    title : str
        What is chosen here.
    made : mapping of str to str
        What people call each, by what its addresses begin with.
    """

    changed = Signal()

    def __init__(self, title: str, made: Mapping[str, str], parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.make = choice(
            ((translated(words), begin) for begin, words in made.items()), title, tip="", short=True
        )
        self.host = called(QLineEdit(placeholderText="192.168.0.10"), self.tr("Host name or IP address"))
        column(self, self.make, self.host, margins=(0, 0, 0, 0))
        self.make.activated.connect(self.changed)
        self.host.textChanged.connect(self.changed)

    @property
    def address(self) -> str:
        """The whole address; empty: no host is named."""
        host = self.host.text().strip()
        return f"{self.make.currentData()}{host}" if host else ""

    def shows(self, address: str) -> bool:
        """Show an address if it is one of these, and return whether it is."""
        for index in range(self.make.count()):
            begin = self.make.itemData(index)
            if address.startswith(begin) and "?" not in address:
                self.make.setCurrentIndex(index)
                self.host.setText(address.removeprefix(begin))
                return True
        return False


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
        self.kind = choice((), title, short=True, tip="")
        self._fields: list[QWidget] = []
        self._problem = sentence_label(role="bad")
        self._problem.setVisible(False)
        self.address_line = sentence_label(role="muted")
        self._box = stacked(self, self.kind, self.address_line, self._problem)
        self.kind.currentIndexChanged.connect(self._show_fields)

    def _add(self, widget: QWidget) -> QWidget:
        self._fields.append(widget)
        self._box.insertWidget(self._box.count() - 2, widget)
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
        made, probe = self.tr("Sensor made by {maker}"), self.tr("with the {name} probe")
        makers = ((made.format(maker=title), scheme) for scheme, title in devices.serial_sensors().items())
        self.protocol = choice(makers, self.tr("Sensor manufacturer"), tip="")
        probes = ((probe.format(name=name), name) for name in PROBE_NAMES)
        self.probe = choice(probes, self.tr("Virtual bench probe"), tip="")
        self.probe.setCurrentIndex(self.probe.findData("t-shape"))
        self.recording = FileField(self.tr("Recording"), self.tr("Recordings (*.mcap);;All files (*)"))
        self.address = QLineEdit(placeholderText="sri+tcp://192.168.0.108")
        tip = self.tr(
            "One of contactbench record devices, such as sri+tcp or line+udp, then :// and the device address"
        )
        called(self.address, self.tr("Sensor address"), tip)
        self.network = NetworkField(self.tr("Sensor on the network"), devices.network_devices())
        self.network.changed.connect(self.changed)
        for widget in (self.protocol, self.probe, self.recording, self.network, self.address):
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
            (self.tr("Sensor on the network"), _NETWORK),
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
            fields = {_VIRTUAL: self.probe, _REPLAY: self.recording, _NETWORK: self.network}
            self._show(fields.get(chosen, self.address))
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
        return self.network.address if chosen == _NETWORK else self.address.text().strip()

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
            named = self.network.shows(address)
            self.kind.setCurrentIndex(self.kind.findData(_NETWORK if named else _ADDRESS))

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
        self.address = called(QLineEdit(placeholderText="ur+tcp://192.168.0.10"), self.tr("Robot address"))
        self.file = FileField(self.tr("Pose file"), self.tr("Poses (*.csv);;All files (*)"))
        self._hint = sentence_label(role="muted")
        self.angles = [angle_field(axis) for axis in "xyz"]
        for spin in self.angles:
            spin.setAccessibleName(self.tr("Flange rotation about {axis}").format(axis=spin.prefix()))
        self._still = self._add(panel(row(*self.angles)))
        self.network = NetworkField(self.tr("Robot"), devices.network_devices(poses=True))
        self.network.changed.connect(self.changed)
        for widget in (self.network, self.address, self.file, self._hint):
            self._add(widget)
        for name, data in (
            (self.tr("From the sensor source"), _SAME),
            (self.tr("Robot"), _NETWORK),
            (self.tr("Stationary"), _STILL),
            (self.tr("Pose file"), _FILE),
            (self.tr("Enter address"), _ADDRESS),
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
        fields = {_ADDRESS: self.address, _NETWORK: self.network, _STILL: self._still, _FILE: self.file}
        self._show(fields.get(chosen, self._hint))
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
        return self.network.address if chosen == _NETWORK else self.address.text().strip()

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
            elif parsed is not None and self.network.shows(address):
                kind = _NETWORK
        self.kind.setCurrentIndex(self.kind.findData(kind))


def angle_field(axis: str) -> NumberBox:
    """Return a field for an angle about an axis, degrees."""
    field = NumberBox(decimals=1, minimum=-360.0, maximum=360.0, singleStep=90.0, suffix="°")
    field.setPrefix(f"{axis} ")
    field.setMinimumHeight(HIGH)
    return field
