"""The Regions page: painting the parts of the probe that are meant to be touched, in order of priority."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, ClassVar

import numpy as np
from PySide6.QtCore import QEvent
from PySide6.QtGui import QAction, QKeySequence
from PySide6.QtWidgets import QFileDialog, QVBoxLayout, QWidget

from contactbench.app.bench import Weight
from contactbench.app.page import Page
from contactbench.app.pages.regions_doing import Doing
from contactbench.app.pages.regions_files import read_regions, write_regions
from contactbench.app.pages.regions_keeping import Keeper
from contactbench.app.pages.regions_panel import Mode, RegionsPanel, View
from contactbench.app.pages.regions_tools import BOX, BRUSH, ERASER, FILL, LOOK, PLANE
from contactbench.app.pages.regions_undo import RegionStep
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.mesh.engines import Cancelled
from contactbench.pipeline.workbench.regions_session import open_work, standing, surface_key
from contactbench.pipeline.workbench.steps import Step
from contactbench.widgets.region_brush import STEP, RegionBrush

if TYPE_CHECKING:
    from collections.abc import Callable

    from contactbench.app.bench import Bench
    from contactbench.app.jobs import Job
    from contactbench.pipeline.mesh.regions import RegionChange, RegionModel
    from contactbench.pipeline.workbench.regions import RegionsWork
    from contactbench.pipeline.workbench.steps import StepStatus
    from contactbench.widgets.scene.scene import Pick


class RegionsPage(Page):
    """
    Regions of the session's probe.

    Attributes
    ----------
    work : RegionsWork or None
        What is painted on; None while it is not there yet.
    shown : bool
        Whether the page is.
    """

    step: ClassVar[Step] = Step.REGIONS

    def __init__(self, bench: Bench, parent: QWidget | None = None) -> None:
        super().__init__(bench, parent)
        self.work: RegionsWork | None = None
        self._key: object = None
        self._crossed = np.empty(0, dtype=np.int32)
        self._loading: Job | None = None
        self.shown = self._listed = False
        self._failure = self._unkept = ""
        self._ends: list[Callable[[], None]] = []
        self.brush = RegionBrush(bench.scene, self)
        self.keeper = Keeper(bench, self)
        self.panel = RegionsPanel(self)
        self.doing = Doing(self)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.addWidget(self.panel)
        self._connect()
        self._add_keys()
        self.show_all()

    def _connect(self) -> None:
        panel, bench = self.panel, self.bench
        self.brush.drawn.connect(self.push)
        self.brush.resized.connect(panel.tools.show_radius)
        self.brush.refused.connect(lambda text: bench.tell(Weight.WARNING, text))
        self.keeper.kept.connect(self._kept)
        self.keeper.failed.connect(self._not_kept)
        bench.scene.picked.connect(self._picked)
        listed = panel.regions
        listed.chosen.connect(self._choose)
        listed.renamed.connect(lambda rank, name: self.edit(lambda model: model.rename(rank, name)))
        listed.recoloured.connect(lambda rank, colour: self.edit(lambda model: model.recolour(rank, colour)))
        listed.marked.connect(lambda rank, on: self.edit(lambda model: model.set_untouchable(rank, on)))
        listed.moved.connect(lambda rank, to: self.edit(lambda model: model.move(rank, to), to))
        listed.add_asked.connect(self.add_region)
        listed.remove_asked.connect(lambda rank: self.edit(lambda model: model.remove(rank)))
        panel.tools.tool_changed.connect(lambda _: self.use_tool())
        panel.tools.radius_changed.connect(self.brush.resize)
        panel.tools.protect_changed.connect(lambda on: setattr(self.brush, "protect", on))
        panel.tools.asked.connect(self.doing.use)
        panel.tools.planned.connect(self.doing.show_plan)
        panel.shape.asked.connect(self.doing.use)
        panel.apply_button.clicked.connect(lambda _=False: self.doing.apply())
        panel.import_button.clicked.connect(lambda _=False: self._ask_import())
        panel.export_button.clicked.connect(lambda _=False: self._ask_export())
        panel.go_button.clicked.connect(lambda _=False: bench.go_to.emit(Step.PROBE))
        panel.next_button.clicked.connect(lambda _=False: bench.go_to.emit(Step.VERIFY))
        panel.cancel_button.clicked.connect(lambda _=False: self._cancel())

    def _add_keys(self) -> None:
        for text, key, action in (
            (self.tr("Smaller brush"), "[", lambda: self.brush.resize(self.brush.radius / STEP)),
            (self.tr("Larger brush"), "]", lambda: self.brush.resize(self.brush.radius * STEP)),
            (self.tr("Take the stroke back, or look only"), "Esc", self._escape),
        ):
            made = QAction(text, self)
            made.setShortcut(QKeySequence(key))
            made.triggered.connect(lambda _=False, action=action: action())
            self.addAction(made)

    # ---- the page ----------------------------------------------------------------------------

    def enter(self) -> None:
        """Show the surface that is painted on."""
        self.shown = True
        if self._failure:
            self._key = None  # once more
        self._open()
        self._show_scene()

    def leave(self) -> None:
        """Keep what was painted, and give the scene's tool back."""
        self.shown = False
        self.stop_tool()
        self.keeper.keep_now()

    def show_state(self, status: StepStatus) -> None:  # noqa: ARG002 - what it says is seen in the steps
        """Show how the step stands; another probe is opened."""
        if self.shown:
            self._open()
        self.show_all()

    def tick(self) -> None:
        """Show the areas, which change with every piece of a stroke."""
        if self._listed:
            self._show_list()

    def close_page(self) -> None:
        """Keep what was painted."""
        self.leave()
        for job in (self._loading, self.doing.job):
            if job is not None:
                job.cancel()
        self._watch(None)

    def changeEvent(self, event: QEvent) -> None:
        """Follow the theme."""
        super().changeEvent(event)
        if event.type() == QEvent.Type.PaletteChange and hasattr(self, "panel"):
            self.show_all()

    def show_all(self) -> None:
        """Show what can be done now, and how what was done stands."""
        state, work = self.bench.desk.state, self.work
        self.panel.show_view(
            View(
                self._mode(),
                self._failure
                or self.tr("There is no probe yet. Regions are painted on it: prepare it first."),
                regions=0 if work is None else len(work.model.regions),
                chosen=work is not None and self.panel.regions.rank > 0,
                painted=work is not None and bool(work.model.labels.any()),
                standing=standing(state),
                dirty=self.keeper.dirty,
                busy=self.doing.job is not None,
                unkept=self._unkept,
            )
        )

    def _mode(self) -> Mode:
        if self.work is not None:
            return Mode.READY
        if self._failure:
            return Mode.FAILED
        return Mode.LOCKED if surface_key(self.bench.desk.state) is None else Mode.OPENING

    def _kept(self) -> None:
        self._unkept = ""
        self.show_all()

    def _not_kept(self, why: str) -> None:
        self._unkept = why
        self.bench.tell(Weight.ERROR, why)
        self.show_all()

    # ---- opening -----------------------------------------------------------------------------

    def _open(self) -> None:
        key = surface_key(self.bench.desk.state)
        if key == self._key:
            return
        self._key, self._failure = key, ""
        if self._loading is not None:
            self._loading.cancel()
            self._loading = None
        self._watch(None)
        if key is None:
            return
        desk = self.bench.desk

        def make(progress: Callable[[float], None], cancelled: Callable[[], bool]) -> RegionsWork:
            desk.do(lambda _session: None).result()  # what was painted before is in the session now
            return open_work(desk, progress, cancelled)

        def opened(work: RegionsWork) -> None:
            if self._key == key:
                self._loading = None
                self._watch(work)
                for note in work.notes:
                    self.bench.tell(Weight.WARNING, note)

        def failed(error: BaseException) -> None:
            if self._key == key:
                self._loading = None
                self._failure = self.tr("It was cancelled.") if isinstance(error, Cancelled) else str(error)
                self.show_all()

        self._loading = self.bench.jobs.start(
            self.tr("Making the surface to paint on"),
            make,
            opened,
            failed,
        )
        self._loading.progressed.connect(self.panel.show_share)

    def _watch(self, work: RegionsWork | None) -> None:
        self.brush.release()
        while self._ends:
            self._ends.pop()()
        self.work = work
        self.keeper.watch(work)
        if work is not None:
            self._ends.append(work.subscribe(self._changed))
            self.panel.regions.show_rows(work.rows(), 1)
            if self.shown:
                self._show_scene()
        self.show_all()

    def _show_scene(self) -> None:
        if self.work is not None:
            self.bench.scene.show_field(None)
            self.bench.scene.show_probe(self.work.probe, self.work.colours)
            self._crossed = self.work.untouchable()
            self.bench.scene.show_untouchable(self._crossed)
            self.use_tool()

    # ---- changes -----------------------------------------------------------------------------

    def _changed(self, change: RegionChange, drawing: bool) -> None:
        work = self.work
        if work is None:
            return
        self._listed = True
        if self.shown:
            if change.faces is None:
                self.bench.scene.paint(None, work.colours)
            elif len(change.faces):
                self.bench.scene.paint(change.faces, work.colours[change.faces])
            if not drawing:
                self._cross()
        if not drawing:
            self.keeper.changed()
            self._show_list()
            self.show_all()

    def _cross(self) -> None:
        """Cross out what nothing can touch, if that is not what is crossed out already."""
        if self.work is None:
            return
        hidden = self.work.untouchable()
        if not np.array_equal(hidden, self._crossed):
            self._crossed = hidden
            self.bench.scene.show_untouchable(hidden)

    def _show_list(self, rank: int | None = None) -> None:
        self._listed = False
        if self.work is not None:
            self.panel.regions.show_rows(self.work.rows(), rank)

    def edit(self, action: Callable[[RegionModel], object], rank: int | None = None) -> None:
        """Edit the model as one step that can be undone, and choose the region of a rank."""
        if self.work is None:
            return
        try:
            text = self.work.step(action)
        except InputError as error:
            self.bench.tell(Weight.WARNING, str(error))
            self._show_list()
            return
        if rank is not None:
            self._show_list(rank)
        self.push(text)

    def push(self, text: str | None) -> None:
        """Let the window undo a step that was made; None: none was."""
        if text is not None and self.work is not None:
            self.bench.undo.push(RegionStep(text, self.work, self._bring_up))

    def _bring_up(self, work: RegionsWork) -> bool:
        if work is not self.work:
            return False
        if not self.shown:
            self.bench.go_to.emit(Step.REGIONS)
        return work is self.work  # entering the page may have found another probe

    def add_region(self) -> None:
        """Add a region with the next free name and colour, and choose it."""
        if self.work is None:
            return
        self.edit(lambda model: model.add(), len(self.work.model.regions) + 1)
        if self.panel.tools.tool == LOOK:
            self.panel.tools.choose(BRUSH)

    def _choose(self, rank: int) -> None:
        self.brush.rank = rank
        self.panel.tools.plan()
        self.show_all()

    # ---- tools -------------------------------------------------------------------------------

    def use_tool(self) -> None:
        """Let the scene's left button do what the chosen tool does."""
        tool = self.panel.tools.tool
        self.brush.erase = tool == ERASER
        if not self.shown or self.work is None or self.doing.job is not None:
            return
        if tool in (BRUSH, ERASER):
            self.brush.take(self.work)
        else:
            self.brush.release()
            self.bench.scene.set_tool("pick" if tool in (FILL, BOX, PLANE) else "turn")

    def stop_tool(self) -> None:
        """Let the left button turn the view only."""
        self.brush.release()
        self.bench.scene.set_tool("turn")

    def _escape(self) -> None:
        if not self.brush.abort():
            self.panel.tools.choose(LOOK)

    def _picked(self, pick: Pick) -> None:
        if self.shown and self.work is not None:
            self.panel.tools.picked(pick)

    # ---- files and the probe -----------------------------------------------------------------

    def _cancel(self) -> None:
        for job in (self.doing.job, self._loading):
            if job is not None:
                job.cancel()

    def _ask_import(self) -> None:
        name, _ = QFileDialog.getOpenFileName(
            self, self.tr("Import regions"), "", self.tr("Regions (*.json *.csv)")
        )
        if name:
            read_regions(self, Path(name))

    def _ask_export(self) -> None:
        name, _ = QFileDialog.getSaveFileName(
            self, self.tr("Export regions"), "regions.json", self.tr("Regions (*.json *.csv)")
        )
        if name:
            write_regions(self, Path(name))
