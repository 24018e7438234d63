"""Live outputs: where contacts go while devices are open, their addresses, and how each is doing."""

from collections.abc import Callable
from functools import partial
from typing import Any

from PySide6.QtCore import QTimer
from PySide6.QtGui import QGuiApplication
from PySide6.QtWidgets import QCheckBox, QLabel, QLineEdit, QWidget

from contactbench.app.bench import Bench, Weight
from contactbench.app.undo import SetParameters
from contactbench.pipeline.calibration.payload import CAUTIONS
from contactbench.pipeline.config.runtime import RuntimeConfig
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.session import Session
from contactbench.pipeline.settings import PayloadSettings, RobotMaker
from contactbench.pipeline.workbench.export import PAYLOAD, payload_text, stored_payload
from contactbench.pipeline.workbench.live import OutputState
from contactbench.widgets.controls import (
    check_box,
    choice,
    column,
    form,
    named,
    push_button,
    row,
    sentence_label,
    show_quietly,
)
from contactbench.widgets.messages import NumberBox, filled, translated

_LOOK_MS = 100  # ten lines a second say that no sample comes
SETTING = "outputs.addresses"
"""Setting of the session: outputs that were started last, with their addresses."""


class LiveOutputsPanel(QWidget):
    """
    A row for each output, and a button that starts and stops them.

    Parameters
    ----------
    bench : Bench
    unverified : callable
        Tells whether a bundle that is not verified is wanted.
    """

    def __init__(self, bench: Bench, unverified: Callable[[], bool], parent: QWidget | None = None) -> None:
        super().__init__(parent)
        from contactbench.pipeline.runtime.outputs import OUTPUTS
        from contactbench.pipeline.workbench.live import LiveOutputs

        self._bench, self._unverified = bench, unverified
        self.outputs = LiveOutputs(bench.live)
        self._busy = self._was_running = False
        self.chosen: dict[str, QCheckBox] = {}
        self.addresses: dict[str, QLineEdit] = {}
        self.states: dict[str, QLabel] = {}
        parts: list[QWidget] = []
        for option, output in OUTPUTS.items():
            if not output.title:
                continue
            title = translated(output.title)
            self.chosen[option] = check_box(title)
            address = QLineEdit(output.usual, maxLength=300)
            self.addresses[option] = named(address, self.tr("Address of {output}").format(output=title))
            self.states[option] = sentence_label(role="muted")
            self.states[option].hide()
            parts += [self.chosen[option], address, self.states[option]]
        tip = self.tr("Contacts are neither encrypted nor signed")
        self.remote = check_box(self.tr("Allow other machines"), tip=tip)
        self.button = push_button("", self._toggle)
        column(
            self,
            sentence_label(self.tr("Send contacts while devices are open, as contactbench run does.")),
            *parts,
            self.remote,
            row((self.button, 1)),
        )
        self._timer = QTimer(self, interval=_LOOK_MS)
        self._timer.timeout.connect(self.look)
        self._show_running()

    def show_session(self) -> None:
        """Show what the session knows of the outputs."""
        setting = self._bench.desk.state.setting(SETTING)
        known = setting if isinstance(setting, dict) else {}
        for option, field in self.addresses.items():
            address = known.get(option)
            if isinstance(address, str) and not self.outputs.running:
                show_quietly(field, address[:300])
                show_quietly(self.chosen[option], True)

    def close_panel(self) -> None:
        """Stop them; the window goes."""
        self._timer.stop()
        self.outputs.stop()

    def look(self) -> None:
        """Show how the outputs are doing."""
        states = {state.option: state for state in self.outputs.look()}
        for option, label in self.states.items():
            state = states.get(option)
            label.setVisible(state is not None)
            if state is not None:
                label.setText(self._words(state))
        if self.outputs.running != self._was_running:
            self._show_running()

    def _words(self, state: OutputState) -> str:
        if state.error:
            return translated(state.error)
        if state.lost:
            words = self.tr(
                "{published:,} contacts sent, {lost:,} lost: the receiver is missing or too slow."
            )
            return filled(words, published=state.published, lost=state.lost)
        return filled(self.tr("{published:,} contacts sent."), published=state.published)

    def _show_running(self) -> None:
        running = self._was_running = self.outputs.running
        self.button.setText(self.tr("Stop outputs") if running else self.tr("Start outputs"))
        self.button.setEnabled(not self._busy)
        for widget in (*self.chosen.values(), *self.addresses.values(), self.remote):
            widget.setEnabled(not running and not self._busy)
        if not running:
            for label in self.states.values():
                label.hide()
        (self._timer.start if running else self._timer.stop)()

    def _toggle(self) -> None:
        if self.outputs.running:
            self._begin(self.tr("Stopping outputs"), lambda _: self.outputs.stop())
            return
        addresses = {
            option: self.addresses[option].text().strip()
            for option, box in self.chosen.items()
            if box.isChecked()
        }
        unverified, remote = self._unverified(), self.remote.isChecked()

        def start(session: Session) -> None:
            from contactbench.pipeline.workbench.export import built

            config = built(session, unverified=True)
            if session.state.setting(SETTING) != addresses:
                session.set_parameter(SETTING, addresses)
            self.outputs.start(config, addresses, unverified=unverified, remote=remote)

        self._begin(self.tr("Starting outputs"), start)

    def _begin(self, title: str, action: Callable[[Session], None]) -> None:
        self._busy = True
        self._show_running()

        def over(error: BaseException | None) -> None:
            self._busy = False
            self._show_running()
            if error is not None:
                self._bench.tell_error(error, Weight.WARNING)

        self._bench.do(title, action, lambda _: over(None), over)


# ---- the robot's payload -------------------------------------------------------------------------


_NAMES = {
    RobotMaker.UR: "Universal Robots",
    RobotMaker.FRANKA: "Franka",
    RobotMaker.KUKA: "KUKA",
    RobotMaker.ABB: "ABB",
    RobotMaker.DOOSAN: "Doosan",
}


class PayloadPanel(QWidget):
    """Asks whose robot it is and where the sensor sits on it, and shows the line to copy."""

    def __init__(self, bench: Bench, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._bench = bench
        self._config: RuntimeConfig | None = None
        self.robot = choice(((name, str(maker)) for maker, name in _NAMES.items()), self.tr("Robot"))
        self.at = [_length(axis, self.tr("Sensor origin on the flange, {axis}")) for axis in "xyz"]
        mass = NumberBox(decimals=3, minimum=0.0, maximum=100.0, singleStep=0.05, suffix=" kg")
        tip = self.tr("With its adapters; the sensor does not feel its own weight")
        self.mass = named(mass, self.tr("Mass of the sensor"), tip=tip)
        self.centre = [_length(axis, self.tr("Centre of mass of the sensor, {axis}")) for axis in "xyz"]
        self.line, self.note = sentence_label(), sentence_label(role="muted")
        self.line.setAccessibleName(self.tr("Payload for the robot's controller"))
        self.copy = push_button(self.tr("Copy payload"), self._copy)
        fields = QWidget()
        lines = form(fields)
        lines.addRow(self.tr("Robot"), self.robot)
        lines.addRow(self.tr("Sensor at"), row(*((each, 1) for each in self.at)))
        lines.addRow(self.tr("Sensor mass"), self.mass)
        lines.addRow(self.tr("Its centre"), row(*((each, 1) for each in self.centre)))
        column(self, fields, self.line, self.note, row((self.copy, 1)))
        self.robot.activated.connect(lambda _: self._set("robot", self.robot.currentData(), self.tr("Robot")))
        for field in self.at:
            field.valueChanged.connect(partial(self._values, "sensor_at", self.at))
        for field in (self.mass, *self.centre):
            field.valueChanged.connect(partial(self._values, "sensor_body", [self.mass, *self.centre]))

    def show_config(self, config: RuntimeConfig | None) -> None:
        """Show the payload of the bundle that would be written; None: there is none."""
        self._config = config
        try:
            settings = stored_payload(self._bench.desk.state)
        except InputError as error:
            self._say("", translated(str(error)))
            return
        show_quietly(self.robot, self.robot.findData(str(settings.robot)))
        for fields, values in (
            (self.at, settings.sensor_at),
            ([self.mass, *self.centre], settings.sensor_body),
        ):
            for field, value in zip(fields, values, strict=True):
                show_quietly(field, value)
        if config is None:
            self._say("", self.tr("Calibrate first."))
            return
        self._show(config, settings)

    def _show(self, config: RuntimeConfig, settings: PayloadSettings) -> None:
        try:
            found = payload_text(config, settings)
        except InputError as error:
            self._say("", translated(str(error)))
            return
        made = found.payload
        if not made.is_known:
            self._say("", self.tr("Too unsure to tell a robot: calibrate with poses that tilt farther."))
            return
        spread = 1e3 * float(max(made.centre_sigma_E))
        sigmas = self.tr("Standard deviation {mass:.1f} g and at most {centre:.1f} mm.")
        words = [filled(sigmas, mass=1e3 * made.mass_sigma, centre=spread)]
        if settings.sensor_body[0] == 0:
            words.append(self.tr("The sensor's own mass is not included."))
        if not found.mount_known:
            words.append(self.tr("The sensor is taken as not turned on the flange."))
        if caution := CAUTIONS.get(settings.robot):
            words.append(translated(caution))
        self._say(found.line, " ".join(words))

    def _say(self, line: str, note: str) -> None:
        self.line.setText(line)
        self.line.setVisible(bool(line))
        self.note.setText(note)
        self.copy.setEnabled(bool(line))

    def _copy(self) -> None:
        QGuiApplication.clipboard().setText(self.line.text())
        self._bench.tell(Weight.GOOD, self.tr("The payload is in the clipboard."))

    def _values(self, name: str, fields: list[NumberBox], _: float) -> None:
        self._set(name, [field.value() for field in fields], self.tr("Payload"))

    def _set(self, name: str, value: Any, words: str) -> None:
        self._bench.undo.push(SetParameters(self._bench, {f"{PAYLOAD}.{name}": value}, words))


def _length(axis: str, words: str) -> NumberBox:
    field = NumberBox(decimals=1, minimum=-1000.0, maximum=1000.0, prefix=f"{axis} ", suffix=" mm")
    return named(field, words.format(axis=axis))
