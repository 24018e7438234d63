"""Editing the markers of the Verify page: each edit is one step that can be undone, and ends in the session."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from PySide6.QtCore import QObject
from PySide6.QtWidgets import QFileDialog

from contactbench.app.bench import Weight
from contactbench.app.pages.verify_undo import ChangeMarkers
from contactbench.pipeline.durable import write_durably
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.workbench.markers import Markers, grid, imported, keep, on_surface, spread

if TYPE_CHECKING:
    from collections.abc import Callable

    from contactbench.app.pages.verify import VerifyPage
    from contactbench.widgets.scene.scene import Pick

Point = tuple[float, float, float]


class MarkerEditing(QObject):
    """
    What the buttons of the markers' panel do.

    Attributes
    ----------
    pending : int
        Edits that the session does not have yet: what it has is old until then.
    """

    def __init__(self, page: VerifyPage) -> None:
        super().__init__(page)
        self._page, self._bench, self.pending = page, page.bench, 0

    def connect_panel(self) -> None:
        """Listen to the panel."""
        panel = self._page.panel_markers
        panel.spread_wanted.connect(self.spread)
        panel.grid_wanted.connect(self.grid)
        panel.typed.connect(self.add)
        panel.import_wanted.connect(self._ask_import)
        panel.export_wanted.connect(self._ask_export)
        panel.remove_wanted.connect(self.remove)
        panel.snap_wanted.connect(self.snap)
        panel.table.remove_wanted.connect(self.remove)
        panel.table.rename_wanted.connect(self.rename)
        panel.pick_toggled.connect(lambda on: self._bench.scene.set_tool("pick" if on else "turn"))

    # ---- one step --------------------------------------------------------------------------------

    def push(self, after: Markers, text: str) -> None:
        """Have other markers, as a step that can be undone."""
        if after != self._page.markers:
            self._bench.undo.push(ChangeMarkers(self._page.markers, after, self._use, text))

    def _use(self, markers: Markers, text: str) -> None:
        self.pending += 1
        self._page.show_markers(markers)
        self._bench.do(text, lambda session: keep(session, markers), self._kept, self._not_kept)

    def _kept(self, _: object) -> None:
        self.pending -= 1

    def _not_kept(self, error: BaseException) -> None:
        self.pending -= 1
        self._bench.tell(Weight.ERROR, str(error))
        self._page.read_again()

    def _try(self, edit: Callable[[], Markers], text: str) -> None:
        if self._page.work.going_on:
            return
        try:
            self.push(edit(), text)
        except InputError as error:
            self._bench.tell(Weight.WARNING, str(error))

    # ---- edits -----------------------------------------------------------------------------------

    def add(self, point: Point) -> None:
        """Add a marker at a point, m."""
        self._try(lambda: self._page.markers.added(point), self.tr("Add a marker"))

    def picked(self, pick: Pick) -> None:
        """Add a marker on the probe, or move the one that is selected there."""
        name, markers = self._page.panel_markers.table.current_name, self._page.markers
        if name is not None and name in markers.names:
            self._try(
                lambda: markers.moved(name, pick.point), self.tr("Move marker {name}").format(name=name)
            )
            self._page.panel_markers.table.clearSelection()
        else:
            self._try(lambda: markers.added(pick.point), self.tr("Add a marker"))

    def remove(self, names: list[str]) -> None:
        """Remove markers."""
        if names:
            self._try(lambda: self._page.markers.without(names), self.tr("Remove markers"))

    def rename(self, old: str, new: str) -> None:
        """Call a marker otherwise."""
        self._try(
            lambda: self._page.markers.renamed(old, new), self.tr("Rename marker {name}").format(name=old)
        )

    def spread(self, count: int, region: int | None) -> None:
        """Place markers, spread evenly, instead of those that are there."""
        tool = self._page.tool
        if tool is not None:
            self._work(self.tr("Place markers"), lambda: spread(tool.probe, count, region))

    def grid(self, pitch: float, region: int | None) -> None:
        """Place markers on a grid of a pitch, m, instead of those that are there."""
        tool = self._page.tool
        if tool is not None:
            self._work(self.tr("Place markers"), lambda: grid(tool.probe, pitch, region))

    def snap(self) -> None:
        """Move the markers onto the probe's surface."""
        tool, markers = self._page.tool, self._page.markers
        if tool is not None and len(markers):
            self._work(self.tr("Move markers onto the surface"), lambda: on_surface(markers, tool.probe)[0])

    def bring(self, file: Path) -> None:
        """Import a table of markers, instead of those that are there."""
        self._work(self.tr("Import markers"), lambda: imported(file))

    def write(self, file: Path) -> None:
        """Write the markers as a table."""
        data = self._page.markers.to_bytes()

        def work(_progress: object, _cancelled: object) -> None:
            try:
                write_durably(file, data)
            except OSError as error:
                raise InputError(
                    f"{file}: the markers cannot be written ({error}): choose another place."
                ) from error

        self._bench.jobs.start(
            self.tr("Saving the markers"),
            work,
            lambda _: self._bench.tell(Weight.GOOD, self.tr("The markers are in {file}.").format(file=file)),
            self._wrong,
        )

    def _work(self, text: str, make: Callable[[], Markers]) -> None:
        """Make markers in a worker, then have them."""
        if not self._page.work.going_on:
            self._bench.jobs.start(text, lambda *_: make(), lambda made: self.push(made, text), self._wrong)

    def _wrong(self, error: BaseException) -> None:
        if not isinstance(error, InputError):
            raise error
        self._bench.tell(Weight.WARNING, str(error))

    # ---- files -----------------------------------------------------------------------------------

    def _ask_import(self) -> None:
        name, _ = QFileDialog.getOpenFileName(
            self._page, self.tr("Import markers"), "", self.tr("Tables of markers (*.csv)")
        )
        if name:
            self.bring(Path(name))

    def _ask_export(self) -> None:
        name, _ = QFileDialog.getSaveFileName(
            self._page, self.tr("Save markers"), "markers.csv", self.tr("Tables of markers (*.csv)")
        )
        if name:
            self.write(Path(name))
