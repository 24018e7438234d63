"""The Export page: what a bundle rests on, what will be in it (the session's settings ``config.*``), and writing it."""

from functools import partial
from pathlib import Path
from typing import Any, ClassVar

from PySide6.QtCore import Qt, QUrl, Signal
from PySide6.QtGui import QDesktopServices
from PySide6.QtWidgets import QGroupBox, QLabel, QLineEdit, QPushButton, QSizePolicy, QWidget

from contactbench.app.bench import Bench, Page, Weight
from contactbench.app.pages.export_outputs import LiveOutputsPanel, PayloadPanel
from contactbench.app.undo import SetParameters
from contactbench.pipeline.config.runtime.options import ExportOptions
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.export_knobs import ExportKnobs
from contactbench.pipeline.steps import Step, StepStatus
from contactbench.pipeline.workbench.export import ExportedBundle, ExportPreview, ExportView, export, survey
from contactbench.widgets.checklist import Checklist
from contactbench.widgets.controls import (
    PanelScroll,
    asked_file,
    called,
    check_box,
    finish,
    form,
    named,
    panel,
    plain_label,
    push_button,
    row,
    sentence_label,
    show_quietly,
    stacked,
    tool_button,
)
from contactbench.widgets.messages import filled, translated
from contactbench.widgets.settings_rows import rows_of
from contactbench.widgets.theme import Sign, icon

_BELOW = {"rate": "smooth", "cutoff": "region_only"}  # boxes to tick, by the number that they stand below
_ICON = 30


class ExportPage(Page):
    """
    Checklist, settings, preview, and the button.

    Attributes
    ----------
    view : ExportView or None
        What was found last.
    """

    step: ClassVar[Step] = Step.EXPORT

    def __init__(self, bench: Bench, parent: QWidget | None = None) -> None:
        super().__init__(bench, parent)
        self.view: ExportView | None = None
        self.exported: ExportedBundle | None = None
        self._busy = self._shown = False
        self._read_at: tuple[int, object] = (-1, None)
        self._looking = False
        self._build()
        self._allow()

    # ---- how it looks ----------------------------------------------------------------------------

    def _build(self) -> None:
        self.sign, self.standing = Sign(_ICON), self._label()
        self.checklist = Checklist()
        self.checklist.wanted.connect(self.bench.go_to)
        tip = self.tr("For trials only: the bundle is marked as not verified")
        self.unverified = check_box(self.tr("Export without verification"), tip=tip)
        self.unverified.toggled.connect(lambda _: self._allow())
        self.zip, self.folder = self.bar.primary, self.bar.second
        self.report = push_button(self.tr("Open report"), lambda: self._open(self._report_file()), "info")
        self.show_folder = push_button(self.tr("Show in folder"), lambda: self._open(self._place()), "folder")
        for button in (self.report, self.show_folder):
            button.hide()
        self.figures, self.files, self.changes = self._label(), self._label("muted"), self._label()
        self.settings = ExportSettingsPanel()
        self.settings.changed.connect(self._set)
        self.settings.failed.connect(partial(self.bench.tell, Weight.WARNING))
        self.outputs = LiveOutputsPanel(
            self.bench, lambda: self.unverified.isVisible() and self.unverified.isChecked()
        )
        self.payload = PayloadPanel(self.bench)
        standing = row((self.sign, 0, Qt.AlignmentFlag.AlignTop), (self.standing, 1), space=8)
        inside = panel(
            plain_label(self.tr("Export"), "title"), standing, self.checklist, self.unverified,
            row((self.report, 1), (self.show_folder, 1)),
            *self._folds(), 1, margins=(10, 8, 10, 8),
        )  # fmt: skip
        self.fill(PanelScroll(inside))

    def _folds(self) -> list[QWidget]:
        """Return what only some ask for: a button each, which shows it and hides it."""
        self.folds: dict[str, QPushButton] = {}
        shown: list[QWidget] = []
        for name, title, *inside in (
            ("contents", self.tr("Contents"), self.figures, self.files, self.changes),
            ("settings", self.tr("Settings"), self.settings),
            ("payload", self.tr("Robot payload"), self.payload),
            ("outputs", self.tr("Live outputs"), self.outputs),
        ):
            button, box = push_button(title), QGroupBox()
            stacked(box, *inside)
            box.hide()
            button.setCheckable(True)
            button.toggled.connect(box.setVisible)
            self.folds[name] = button
            shown += [button, box]
        return shown

    def _label(self, role: str = "") -> QLabel:
        label = sentence_label(role=role)
        label.setSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Minimum)
        return label

    # ---- shown -----------------------------------------------------------------------------------

    def enter(self) -> None:
        """Look at the session anew."""
        self._shown = True
        self.outputs.show_session()
        self._look()

    def leave(self) -> None:
        """Look no more."""
        self._shown = False

    def close_page(self) -> None:
        """Show nothing any more; what is being written is written."""
        self.outputs.close_panel()

    def show_state(self, status: StepStatus) -> None:  # noqa: ARG002 - the checklist says it line by line
        """Show how the step stands."""
        self._look()

    def _look(self) -> None:
        """Have the checklist and a bundle in memory made, if the session changed, while the page is shown."""
        state, trouble = self.bench.desk.state, self.bench.trouble
        key = (state.count, trouble)
        if self.bench.ending or not self._shown or self._looking or key == self._read_at:
            return
        try:
            self.settings.show_options(ExportOptions.stored(state.settings), self._setting("devices.serial"))
        except InputError as error:
            self.bench.tell(Weight.WARNING, str(error))
        self._looking = True

        def came(view: ExportView) -> None:
            self._looking, self._read_at, self.view = False, key, view
            self._show(view)
            self._look()  # it may have changed meanwhile

        def wrong(error: BaseException) -> None:
            self._looking, self._read_at = False, key
            self._said(error)

        self.bench.do(self.tr("Checking the bundle"), lambda session: survey(session, trouble), came, wrong)

    def _setting(self, key: str) -> str:
        setting = self.bench.desk.state.settings.get(key)
        return setting.value if setting is not None and isinstance(setting.value, str) else ""

    def _show(self, view: ExportView) -> None:
        self.checklist.show_items(view.items)
        finish(self)  # its buttons are new: the tabulator key comes to them where they are
        preview = view.preview
        self.payload.show_config(None if preview is None else preview.config)
        if preview is None:
            self._stand("failed", "bad", self._problem(view))
            for label in (self.figures, self.files, self.changes):
                label.setText("")
            if view.lacks == "rate":  # it is to be entered there
                self.folds["settings"].setChecked(True)
        else:
            self._show_preview(preview)
        self._allow()

    def _problem(self, view: ExportView) -> str:
        """Return why there is no bundle; what is only missing, by the name of its field."""
        if view.lacks != "rate":
            return translated(view.problem)
        return self.tr(
            "The sensor rate is unknown because nothing has been verified. Verify in step 5, or enter"
            " Readings under Settings to match the sensor."
        )

    def _show_preview(self, preview: ExportPreview) -> None:
        figures = (f"{translated(what)}: {translated(value)}" for what, value in preview.figures)
        self.figures.setText("\n".join(figures))
        size, digest = _size(sum(size for _, size in preview.files)), preview.sha256[:12]
        total = self.tr("total {size}, SHA-256 {sha256}…").format(size=size, sha256=digest)
        self.files.setText("\n".join((*(f"{name}  {_size(size)}" for name, size in preview.files), total)))
        words = self.tr("Nothing has been exported from this session yet.")
        if preview.changes is not None:
            changes = (f"• {translated(each)}" for each in preview.changes)
            words = "\n".join((self.tr("Changes since the last export:"), *changes))
        self.changes.setText(words)
        if preview.reasons:
            why = "".join(f"\n• {translated(reason)}" for reason in preview.reasons)
            self._stand("warning", "warning", self.tr("Not verified: {why}").format(why=why))
        else:
            words = self.tr("Verified and ready to export.")
            if self._setting("export.sha256") == preview.sha256:
                words = self.tr("Verified and exported.")
            sign = ("warning", "warning") if preview.unchecked else ("done", "good")
            self._stand(*sign, f"{words} {translated(preview.unchecked)}".strip())

    def _stand(self, name: str, colour: str, words: str) -> None:
        self.sign.show_icon(icon(name, colour))
        self.standing.setText(words)

    def _allow(self) -> None:
        preview = None if self.view is None else self.view.preview
        doubtful = preview is not None and bool(preview.reasons)
        self.unverified.setVisible(doubtful)
        ready = preview is not None and not self._busy and (not doubtful or self.unverified.isChecked())
        tip = self.tr("One zip file that a robot's runtime loads directly")
        self.bar.offer(self.tr("Export file…"), self._choose_file, enabled=ready, tip=tip, picture="export")
        self.bar.offer_second(self.tr("Export folder…"), self._choose_folder, enabled=ready)
        self.report.setVisible(self._report_file() is not None)
        place = self._place()
        self.show_folder.setVisible(place is not None)
        self.show_folder.setToolTip(str(place or ""))

    # ---- settings --------------------------------------------------------------------------------

    def _set(self, values: dict[str, object], text: str) -> None:
        settings = self.bench.desk.state.settings
        try:
            before = ExportOptions.stored(settings)
            given = {name: value for name, value in values.items() if value is not None}
            ExportOptions.stored(settings, given)
        except InputError as error:
            self.bench.tell(Weight.WARNING, str(error))
            self._read_at = (-1, None)
            self._look()
            return
        plain, usual = before.model_dump(mode="json"), ExportOptions().model_dump(mode="json")
        if all(plain[name] == (usual[name] if value is None else value) for name, value in values.items()):
            return
        now = {f"config.{name}": value for name, value in values.items()}
        self.bench.undo.push(SetParameters(self.bench, now, text))

    # ---- writing ---------------------------------------------------------------------------------

    def _choose_file(self) -> None:
        beside, kinds = str(self._beside("runtime.zip")), self.tr("Bundles (*.zip)")
        if place := asked_file(self, self.tr("Export file"), kinds, beside, save=True):
            self.write(place if place.suffix.lower() == ".zip" else place.with_name(f"{place.name}.zip"))

    def _choose_folder(self) -> None:
        title = self.tr("Export folder: enter a name")
        if place := asked_file(self, title, "", str(self._beside("runtime")), save=True):
            self.write(place)

    def _beside(self, name: str) -> Path:
        place = self._place()
        return (self.bench.desk.folder.parent if place is None else place.parent) / name

    def write(self, place: Path) -> None:
        """Write the bundle, check what was written, and say so."""
        if self._busy:
            return
        preview = None if self.view is None else self.view.preview
        self._busy, unverified = True, self.unverified.isVisible() and self.unverified.isChecked()
        self._allow()
        self.bar.say("")

        def done(found: ExportedBundle) -> None:
            self._busy, self.exported = False, found
            self.bar.say(found.sentence, bad=not found.verified)
            well = found.verified and not (preview is not None and preview.unchecked)
            self.bench.tell(Weight.GOOD if well else Weight.WARNING, found.sentence)
            self._allow()

        def wrong(error: BaseException) -> None:
            self._busy = False
            self._said(error)
            self._allow()

        self.bench.do(
            self.tr("Exporting"), lambda session: export(session, place, unverified=unverified), done, wrong
        )

    def _said(self, error: BaseException) -> None:
        self.bench.tell_error(error)
        self.bar.say(str(error), bad=True)

    def _place(self) -> Path | None:
        place = self._setting("export.place")
        return Path(place) if place else None

    def _report_file(self) -> Path | None:
        found = self.bench.desk.state.newest("report")
        return None if found is None else self.bench.desk.folder / found.file.path

    def _open(self, place: Path | None) -> None:
        if place is not None:
            target = place.parent if place.suffix.lower() == ".zip" else place
            QDesktopServices.openUrl(QUrl.fromLocalFile(str(target)))


def _size(count: int) -> str:
    if count < 1_000:
        return f"{count} B"
    return filled("{:.0f} kB", count / 1e3) if count < 1e6 else filled("{:.1f} MB", count / 1e6)


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
        from contactbench.pipeline.config.runtime.options import controller_in
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
