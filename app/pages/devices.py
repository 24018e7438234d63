"""Step 1: which sensor, what tells its orientation, and whether they work."""

from __future__ import annotations

import time
from concurrent.futures import Future, ThreadPoolExecutor
from typing import TYPE_CHECKING, ClassVar

from PySide6.QtWidgets import QGroupBox, QLineEdit, QWidget

from contactbench.app.page import Page
from contactbench.app.pages.devices_sources import PoseSource, SensorSource, angle_field
from contactbench.app.undo import SetParameters, Weight
from contactbench.pipeline.devices.transport.ports import SerialPort, list_ports
from contactbench.pipeline.steps import Step
from contactbench.pipeline.workbench.live_trial import Devices, due_problem, gives_poses, problem_of, trial_of
from contactbench.widgets.controls import PanelScroll, column, form, plain_label, row, sentence_label
from contactbench.widgets.device_trial import DeviceChannels, DeviceTrial
from contactbench.widgets.numbers import translated

if TYPE_CHECKING:
    from contactbench.app.undo import Bench
    from contactbench.pipeline.steps import StepStatus

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
        self.serial = QLineEdit()
        self.serial.setPlaceholderText(self.tr("see the sensor's label"))
        self.serial.setAccessibleName(self.tr("Sensor serial number"))
        self.certificate, self.due = QLineEdit(maxLength=200), QLineEdit(maxLength=10)
        self.certificate.setPlaceholderText(self.tr("for the report"))
        self.certificate.setAccessibleName(self.tr("Number of the sensor's calibration certificate"))
        self.due.setPlaceholderText(self.tr("YYYY-MM-DD"))
        self.due.setAccessibleName(self.tr("Date until which the certificate is valid, YYYY-MM-DD"))
        self.mount = [angle_field(axis) for axis in "xyz"]
        for spin in self.mount:
            spin.setAccessibleName(self.tr("Mounting angle about {axis}").format(axis=spin.prefix()))
            spin.setToolTip(
                self.tr(
                    "Rotation of the sensor on the flange about the flange's fixed axes, in the order x, y, z"
                )
            )
        self.use_button, self.try_button = self.bar.primary, self.bar.second
        self.trial, self.channels = DeviceTrial(), DeviceChannels()
        mounting, papers = QGroupBox(self.tr("Mounting")), QGroupBox(self.tr("Identification"))
        column(
            mounting, plain_label(self.tr("Sensor on the flange")), row(*((each, 1) for each in self.mount)),
            margins=(9, 9, 9, 9),
        )  # fmt: skip
        lines = form(papers)
        lines.setContentsMargins(9, 9, 9, 9)
        for words, field in (
            (self.tr("Serial number"), self.serial),
            (self.tr("Certificate"), self.certificate),
            (self.tr("Valid until"), self.due),
        ):
            lines.addRow(words, field)
        measured, inside = QGroupBox(self.tr("Measured")), QWidget()
        column(measured, self.channels, margins=(2, 2, 2, 2))
        column(
            inside, plain_label(self.tr("Devices"), "title"), self._status, self.trial, self.sensor, self.poses,
            mounting, papers, measured, margins=(6, 8, 6, 8), space=6,
        ).addStretch(1)  # fmt: skip
        self.fill(PanelScroll(inside))
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
            self.bar.offer_second(test, self.test, enabled=free)
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
        if devices == self._known:
            return
        before, self._known = self._known, devices
        if devices != self.devices():
            self._show_devices(devices)
        live, wanted = self.bench.live, (devices.sensor, devices.poses)
        moved = wanted != (before.sensor, before.poses) and wanted != live.addresses
        busy = {Step.GRAVITY, Step.VERIFY} & self.bench.running
        if self._opening or busy or not moved or live.pair is None:
            return
        if devices.sensor:
            self._open(devices, self.tr("Opening devices"))
        else:
            self.bench.jobs.start(self.tr("Closing devices"), lambda _progress, _cancelled: live.close())

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
