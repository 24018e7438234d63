"""What goes into a bundle beside calibration and probe: settings ``config.*`` of the session."""

from pathlib import Path
from typing import Any

from PySide6.QtCore import Signal
from PySide6.QtWidgets import QLineEdit, QWidget

from contactbench.pipeline.config.runtime.options import ExportOptions
from contactbench.pipeline.export_knobs import ExportKnobs
from contactbench.widgets.controls import (
    asked_file,
    called,
    check_box,
    form,
    named,
    push_button,
    row,
    show_quietly,
    tool_button,
)
from contactbench.widgets.numbers import filled
from contactbench.widgets.settings_rows import rows_of

_BELOW = {"rate": "smooth", "cutoff": "region_only"}  # boxes to tick, by the number that they stand below


class ExportSettingsPanel(QWidget):
    """Asks for the options of an export; null means: what the session knows."""

    changed = Signal(dict, str)  # option -> JSON value; what was done, in words
    failed = Signal(object)  # why something that was chosen is not taken

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.texts: dict[str, QLineEdit] = {}
        layout = form(self, top=4)
        for option, words, name, otherwise in (
            ("sensor", self.tr("Sensor"), self.tr("Sensor model"), self.tr("unknown")),
            (
                "serial",
                self.tr("Serial number"),
                self.tr("Sensor serial number"),
                self.tr("from the session"),
            ),
            (
                "sensor_name",
                self.tr("ROS name"),
                self.tr("Sensor name in the robot description, for ros2.yaml"),
                self.tr("enter later"),
            ),
            (
                "operator",
                self.tr("Operator"),
                self.tr("Person responsible"),
                self.tr("author of the latest result"),
            ),
        ):
            self.texts[option] = self._text(name, otherwise, option)
            layout.addRow(words, self.texts[option])
        self.rows = rows_of(ExportKnobs)
        for option, each in self.rows.items():
            each.changed.connect(lambda _, option=option, row=each: self._say(option, row.value, row.name))
        tip = self.tr("Kalman filter: less noise; follows changes at once")
        self.smooth = check_box(self.tr("Filter wrench"), tip=tip)
        self.smooth.toggled.connect(lambda on: self._say("no_filter", not on, self.smooth.text()))
        tip = self.tr("The runtime rejects contacts outside all painted regions")
        self.region_only = check_box(self.tr("Accept contacts on regions only"), tip=tip)
        self.region_only.toggled.connect(lambda on: self._say("region_only", on, self.region_only.text()))
        tip = self.tr(
            "Controller gains for pressing and following: gains.json from contactbench bench control tune"
        )
        self.gains = called(push_button("", self._ask_gains, "folder", tip=tip), self.tr("Controller gains"))
        name = self.tr("Remove gains")
        self.no_gains = tool_button("cross", name, lambda: self._say("controller", None, name))
        for option, each in self.rows.items():
            layout.addRow(each.title, each.field)
            if option in _BELOW:
                layout.addRow(getattr(self, _BELOW[option]))
        layout.addRow(self.tr("Gains"), row((self.gains, 1), self.no_gains))

    def _ask_gains(self) -> None:
        if file := asked_file(self, self.tr("Open gains"), self.tr("Gains (*.json)")):
            self.read_gains(file)

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
        tip = self.tr("{name}; left empty: {otherwise}").format(name=name, otherwise=otherwise)
        field = named(QLineEdit(maxLength=200, placeholderText=otherwise), name, tip=tip)
        field.editingFinished.connect(lambda: self._say(option, field.text().strip() or None, name))
        return field

    def show_options(self, options: ExportOptions, known_serial: str = "") -> None:
        """Show what holds."""
        for option, field in self.texts.items():
            known = getattr(options, option) or ""
            show_quietly(field, "" if (option, known) == ("sensor", "unknown") else known)
        if known_serial:
            self.texts["serial"].setPlaceholderText(known_serial)
        for option, each in self.rows.items():
            each.show(getattr(options, option))
        show_quietly(self.smooth, not options.no_filter)
        show_quietly(self.region_only, options.region_only)
        part = options.controller
        words = self.tr("left out")
        if part is not None:
            variant = self.tr("predictive") if part.variant == "aware" else self.tr("basic")
            words = filled(self.tr("{force:g} N, {variant}"), force=part.desired_force_N, variant=variant)
        self.gains.setText(words)
        self.no_gains.setVisible(part is not None)
