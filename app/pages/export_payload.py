"""The robot's payload: the line that its controller takes, of the calibration and what somebody says of the sensor."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, Any

from PySide6.QtGui import QGuiApplication
from PySide6.QtWidgets import QComboBox, QWidget

from contactbench.app.undo import SetParameters, Weight
from contactbench.pipeline.calibration.payload import CAUTIONS
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.settings import PayloadSettings, RobotMaker
from contactbench.pipeline.workbench.export import PAYLOAD, payload_text, stored_payload
from contactbench.widgets.controls import (
    column,
    form,
    named,
    push_button,
    row,
    sentence_label,
    show_quietly,
)
from contactbench.widgets.numbers import NumberBox, filled, translated

if TYPE_CHECKING:
    from contactbench.app.undo import Bench
    from contactbench.pipeline.config.runtime import RuntimeConfig

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
        self.robot = named(QComboBox(), self.tr("Robot"))
        for maker, name in _NAMES.items():
            self.robot.addItem(name, str(maker))
        self.at = [_length(axis, self.tr("Sensor origin on the flange, {axis}")) for axis in "xyz"]
        self.mass = named(
            NumberBox(decimals=3, minimum=0.0, maximum=100.0, singleStep=0.05, suffix=" kg"),
            self.tr("Mass of the sensor"),
            tip=self.tr("With its adapters; the sensor does not feel its own weight"),
        )
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
        words = [
            filled(
                self.tr("Standard deviation {mass:.1f} g and at most {centre:.1f} mm."),
                mass=1e3 * made.mass_sigma,
                centre=spread,
            )
        ]
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
    field = NumberBox(decimals=1, minimum=-1000.0, maximum=1000.0, suffix=" mm")
    field.setPrefix(f"{axis} ")
    return named(field, words.format(axis=axis))
