"""The markers of the Verify page: where they come from, the table of them, and edits that can be undone."""

from collections.abc import Callable
from pathlib import Path

from PySide6.QtCore import Signal
from PySide6.QtWidgets import QSpinBox, QWidget

from contactbench.app.bench import Bench, Weight
from contactbench.app.undo import Exchange
from contactbench.pipeline.durable import write_file
from contactbench.pipeline.errors import InputError, message
from contactbench.pipeline.workbench.markers import Markers, grid, imported, keep, on_surface, spread
from contactbench.pipeline.workbench.verify import VerifyWork
from contactbench.pipeline.workbench.verify_touches import TouchView
from contactbench.widgets.controls import (
    HIGH,
    FoldRow,
    asked_file,
    choice,
    column,
    named,
    plain_label,
    push_button,
    row,
    sentence_label,
    tool_button,
)
from contactbench.widgets.marker_table import MarkerTable
from contactbench.widgets.messages import NumberBox
from contactbench.widgets.scene.scene import Pick


class MarkersPanel(QWidget):
    """
    Makes and edits the markers of a verification; each edit is one step that can be undone, and ends in the session.

    Attributes
    ----------
    table : MarkerTable
    pending : int
        Edits that the session does not have yet: what it has is old until then.
    """

    changed = Signal()
    refused = Signal()  # the session could not keep them: what it has is to be read again

    def __init__(self, bench: Bench, work: VerifyWork, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._bench, self._work, self.pending = bench, work, 0
        self._shown: tuple[object, ...] = ()
        self.table = MarkerTable()
        self.table.setMinimumHeight(190)
        self.table.remove_wanted.connect(self.remove)
        self.table.rename_wanted.connect(self.rename)
        self._empty = sentence_label(
            self.tr(
                "No markers yet. Distribute some over the probe, click on it, or import measured positions."
            ),
            "muted",
        )
        column(
            self, *self._making(), self._empty, self.table, self._editing(), self._typing(),
            margins=(0, 8, 0, 0),
        ).setStretchFactor(self.table, 1)  # fmt: skip

    def _making(self) -> tuple[FoldRow, ...]:
        self.region = choice((), self.tr("Area for markers"), short=True)
        self.show_regions()
        self.count = named(QSpinBox(minimum=1, maximum=999, value=12), self.tr("Number of markers"))
        pitch = NumberBox(minimum=0.5, maximum=200.0, value=10.0, suffix=" mm")
        self.pitch = named(pitch, self.tr("Grid spacing, mm"))
        self.spread = push_button(self.tr("Distribute evenly"), self._spread, "add")
        self.grid = push_button(self.tr("Create grid"), self._grid, "add")
        label = plain_label(self.tr("Place on"), buddy=self.region)
        return (
            row(label, (self.region, 1)),
            row(self.count, (self.spread, 1)),
            row(self.pitch, (self.grid, 1)),
        )

    def _editing(self) -> FoldRow:
        tip = self.tr("Click the probe to add a marker; if a marker is selected, the click moves it")
        self.pick = push_button(self.tr("Click to place"), None, "add", tip=tip)
        self.pick.setCheckable(True)
        self.pick.toggled.connect(lambda on: self._bench.scene.set_tool("pick" if on else "turn"))
        remove = lambda: self.remove(self.table.selected_names)  # noqa: E731
        self.remove_button = push_button(self.tr("Remove"), remove, "remove")
        self.importing = push_button(self.tr("Import…"), self._ask_import, "folder")
        self.exporting = push_button(self.tr("Save as…"), self._ask_export, "export")
        tip = self.tr("Move every marker to the nearest point on the probe")
        self.snap_button = push_button(self.tr("Snap to surface"), self.snap, "down", tip=tip)
        buttons = (self.pick, self.remove_button, self.importing, self.exporting, self.snap_button)
        return row(*((each, 1) for each in buttons))

    def _typing(self) -> FoldRow:
        self.coordinates = []
        for axis in ("x", "y", "z"):
            name = self.tr("Marker {axis} in the sensor frame S, mm").format(axis=axis)
            field = NumberBox(minimum=-2000.0, maximum=2000.0, decimals=1, prefix=f"{axis} ")
            self.coordinates.append(named(field, name))
        name = self.tr("Add a marker at these coordinates")
        self.add_button = named(tool_button("add", name, self._type), name)
        self.add_button.setMinimumSize(HIGH, HIGH)
        return row(*((field, 1) for field in self.coordinates), self.add_button, space=4)

    # ---- what is shown -------------------------------------------------------------------------------

    def show_regions(self) -> None:
        """Offer the regions of the probe, the first of them chosen; without any the whole probe."""
        tool = self._work.tool
        ranks = [] if tool is None else sorted({int(rank) for rank in tool.probe.region.tolist()} - {0})
        wanted: list[tuple[str, int | None]] = [
            (self.tr("region {rank}").format(rank=rank), rank) for rank in ranks
        ]
        wanted.append((self.tr("whole probe"), None))
        if wanted != [(self.region.itemText(i), self.region.itemData(i)) for i in range(self.region.count())]:
            self.region.clear()
            for words, rank in wanted:
                self.region.addItem(words, rank)

    def show_touches(self, view: TouchView | None) -> None:
        """Show the table as the touches stand; None: nothing goes on."""
        work = self._work
        content = (work.markers, work.outcome if view is None else (view.rows, view.next_one))
        if content == self._shown:
            return
        self._shown = content
        # What was added meanwhile has no touches.
        rows = work.rows if view is None else (*view.rows, *work.rows[len(view.rows) :])
        self._empty.setVisible(not rows)
        self.exporting.setEnabled(bool(rows))
        self.table.show_rows(rows, None if view is None else view.next_one)

    def lock(self, locked: bool) -> None:
        """Allow no changes, as while they are touched."""
        for each in (
            self.spread, self.grid, self.pick, self.remove_button, self.importing, self.snap_button,
            self.add_button, self.region, self.count, self.pitch,
        ):  # fmt: skip
            each.setEnabled(not locked)
        if locked:
            self.pick.setChecked(False)

    # ---- one step ------------------------------------------------------------------------------------

    def push(self, after: Markers, text: str) -> None:
        """Have other markers, as a step that can be undone."""
        before = self._work.markers
        if after != before:
            put = lambda markers: self._use(markers, text)  # noqa: E731
            self._bench.undo.push(Exchange(self._bench, text, before, after, put))

    def _use(self, markers: Markers, text: str) -> None:
        self.pending += 1
        self._work.markers = markers
        self.changed.emit()
        self._bench.do(text, lambda session: keep(session, markers), self._kept, self._not_kept)

    def _kept(self, _: object) -> None:
        self.pending -= 1

    def _not_kept(self, error: BaseException) -> None:
        self.pending -= 1
        self._bench.tell(Weight.ERROR, str(error))
        self.refused.emit()

    def _try(self, edit: Callable[[], Markers], text: str) -> None:
        if self._work.going_on:
            return
        try:
            self.push(edit(), text)
        except InputError as error:
            self._bench.tell(Weight.WARNING, str(error))

    def _make(self, text: str, make: Callable[[], Markers]) -> None:
        """Make markers in a worker, then have them."""
        if not self._work.going_on:
            self._bench.jobs.start(text, lambda *_: make(), lambda made: self.push(made, text), self._wrong)

    def _wrong(self, error: BaseException) -> None:
        self._bench.tell_error(error, Weight.WARNING)

    # ---- edits ---------------------------------------------------------------------------------------

    def add(self, point: tuple[float, float, float]) -> None:
        """Add a marker at a point, m."""
        self._try(lambda: self._work.markers.added(point), self.tr("Add marker"))

    def _type(self) -> None:
        x, y, z = (1e-3 * field.value() for field in self.coordinates)
        self.add((x, y, z))

    def picked(self, pick: Pick) -> None:
        """Add a marker on the probe, or move the one that is selected there."""
        name, markers = self.table.current_name, self._work.markers
        if name is not None and name in markers.names:
            text = self.tr("Move marker {name}").format(name=name)
            self._try(lambda: markers.moved(name, pick.point), text)
            self.table.clearSelection()
        else:
            self._try(lambda: markers.added(pick.point), self.tr("Add marker"))

    def remove(self, names: list[str]) -> None:
        """Remove markers."""
        if names:
            self._try(lambda: self._work.markers.without(names), self.tr("Remove markers"))

    def rename(self, old: str, new: str) -> None:
        """Call a marker otherwise."""
        text = self.tr("Rename marker {name}").format(name=old)
        self._try(lambda: self._work.markers.renamed(old, new), text)

    def _spread(self) -> None:
        tool, count, region = self._work.tool, self.count.value(), self.region.currentData()
        if tool is not None:
            self._make(self.tr("Place markers"), lambda: spread(tool.probe, count, region))

    def _grid(self) -> None:
        tool, pitch, region = self._work.tool, 1e-3 * self.pitch.value(), self.region.currentData()
        if tool is not None:
            self._make(self.tr("Place markers"), lambda: grid(tool.probe, pitch, region))

    def snap(self) -> None:
        """Move the markers onto the probe's surface."""
        tool, markers = self._work.tool, self._work.markers
        if tool is not None and len(markers):
            self._make(self.tr("Snap markers to surface"), lambda: on_surface(markers, tool.probe)[0])

    # ---- files ---------------------------------------------------------------------------------------

    def bring(self, file: Path) -> None:
        """Import a table of markers, instead of those that are there."""
        self._make(self.tr("Import markers"), lambda: imported(file))

    def write(self, file: Path) -> None:
        """Write the markers as a table."""
        data = self._work.markers.to_bytes()
        self._bench.jobs.start(
            self.tr("Saving markers"),
            lambda *_: write_file(file, data, what=message("the markers cannot be written")),
            lambda _: self._bench.tell(Weight.GOOD, self.tr("Markers saved in {file}.").format(file=file)),
            self._wrong,
        )

    def _ask_import(self) -> None:
        kinds = self.tr("Marker tables (*.csv)")
        if file := asked_file(self, self.tr("Import markers"), kinds):
            self.bring(file)

    def _ask_export(self) -> None:
        kinds = self.tr("Marker tables (*.csv)")
        if file := asked_file(self, self.tr("Save markers"), kinds, "markers.csv", save=True):
            self.write(file)
