"""The Regions page: painting the parts of the probe that are meant to be touched, in order of priority."""

from collections.abc import Callable
from pathlib import Path
from typing import ClassVar

import numpy as np
from PySide6.QtCore import QEvent, QObject, QTimer, Signal
from PySide6.QtWidgets import QWidget

from contactbench.app.bench import Bench, Page, Weight
from contactbench.app.jobs import Job
from contactbench.app.pages.region_tools import (
    BOX,
    BRUSH,
    ERASER,
    FILL,
    LOOK,
    PLANE,
    Mode,
    RegionsPanel,
    RegionsView,
)
from contactbench.app.undo import PaintRequest, SessionCommand, push_painted
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.mesh.engines import Cancelled, Monitor
from contactbench.pipeline.mesh.regions.exchange import load_regions, save_regions
from contactbench.pipeline.mesh.regions.facet_graph import MeshEdit
from contactbench.pipeline.mesh.regions.model import RegionChange, RegionModel
from contactbench.pipeline.mesh.regions.region import RegionSet
from contactbench.pipeline.session import Session
from contactbench.pipeline.session.actions import Record
from contactbench.pipeline.session.why import regions_state
from contactbench.pipeline.steps import Step, StepStatus
from contactbench.pipeline.workbench.regions import Clear, FoundFacets, RegionsWork, Tool
from contactbench.pipeline.workbench.regions_session import (
    apply,
    keep_with_steps,
    open_work,
    surface_key,
    unlike_painted,
)
from contactbench.pipeline.workbench.undo_history import PaintedStep
from contactbench.widgets.controls import add_key, asked_file
from contactbench.widgets.messages import filled
from contactbench.widgets.region_brush import STEP, RegionBrush
from contactbench.widgets.scene.scene import Pick

Progress = Callable[[float], None]
Stop = Callable[[], bool]


class RegionsPage(Page):
    """
    Regions of the session's probe.

    Attributes
    ----------
    work : RegionsWork or None
        What is painted on; None while it is not there yet.
    shown : bool
        Whether the page is.
    job : Job or None
        What takes long and is being done, one thing at a time; meanwhile nothing is painted.
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
        self._unlike: dict[str, str] = {}
        self._ends: list[Callable[[], None]] = []
        self.brush = RegionBrush(bench.scene, self)
        self.job: Job | None = None
        self._planned: Tool | None = None
        self._asked: list[PaintRequest] = []  # before the regions were there
        self.keeper, self.panel = RegionAutosave(bench, self), RegionsPanel(self.bar)
        self.fill(self.panel)
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
        bench.paint_asked.connect(self._put)
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
        panel.tools.protect.toggled.connect(lambda on: setattr(self.brush, "protect", on))
        panel.tools.asked.connect(self._use)
        panel.tools.planned.connect(self._show_plan)
        panel.shape.asked.connect(self._use)
        panel.apply_asked.connect(self._apply)
        panel.import_button.clicked.connect(self._ask_import)
        panel.export_button.clicked.connect(self._ask_export)
        panel.go_asked.connect(bench.go_to)
        panel.page_asked.connect(bench.page_wanted)

    def _add_keys(self) -> None:
        brush = self.brush
        add_key(self, self.tr("Smaller brush"), "[", lambda: brush.resize(brush.radius / STEP))
        add_key(self, self.tr("Larger brush"), "]", lambda: brush.resize(brush.radius * STEP))
        add_key(self, self.tr("Cancel the stroke, or navigate"), "Esc", self._escape)

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
        self._watch(None)

    def changeEvent(self, event: QEvent) -> None:
        """Follow the theme."""
        super().changeEvent(event)
        if event.type() == QEvent.Type.PaletteChange and hasattr(self, "panel"):
            self.show_all()

    def show_all(self) -> None:
        """Show what can be done now, and how what was done stands."""
        state, work = self.bench.desk.state, self.work
        made = state.made("probe")
        self.panel.show_view(
            RegionsView(
                self._mode(),
                self._failure or self.tr("No probe yet. Prepare it first, then paint regions on it."),
                regions=0 if work is None else len(work.model.regions),
                chosen=work is not None and self.panel.regions.rank > 0,
                painted=work is not None and bool(work.model.labels.any()),
                standing=regions_state(state),
                dirty=self.keeper.dirty,
                busy=self.job is not None,
                unkept=self._unkept,
                unlike=None if made is None else self._unlike.get(made.content),
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

        def make(
            progress: Callable[[float], None], cancelled: Callable[[], bool]
        ) -> tuple[RegionsWork, dict[str, str]]:
            desk.do(lambda _session: None).result()  # what was painted before is in the session now
            return open_work(desk, Monitor(progress, cancelled)), unlike_painted(desk)

        def opened(found: tuple[RegionsWork, dict[str, str]]) -> None:
            if self._key == key:
                work, unlike = found
                self._loading = None
                self._unlike.update(unlike)
                self._watch(work)
                self._put_asked()
                for note in work.notes:
                    self.bench.tell(Weight.WARNING, note)

        def failed(error: BaseException) -> None:
            if self._key == key:
                self._loading = None
                self._failure = self.tr("Cancelled.") if isinstance(error, Cancelled) else str(error)
                self._put_asked()
                self.show_all()

        self._loading = self.bench.jobs.start(
            self.tr("Preparing the surface for painting"), make, opened, failed
        )

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
            self._show_mesh()
            self.use_tool()

    def _show_mesh(self) -> None:
        if self.work is not None:
            self.bench.scene.show_probe(self.work.probe, self.work.colours)
            self._crossed = self.work.untouchable()
            self.bench.scene.show_untouchable(self._crossed)

    # ---- changes -----------------------------------------------------------------------------

    def _changed(self, change: RegionChange, drawing: bool) -> None:
        work = self.work
        if work is None:
            return
        self._listed = True
        if self.shown:
            if change.cut is not None:
                self._show_mesh()
            elif change.faces is None:
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
        work = self.work
        if work is not None:
            self._edit(lambda: work.step(action), rank)

    def _edit(self, action: Callable[[], str | None], rank: int | None) -> None:
        try:
            text = action()
        except InputError as error:
            self.bench.tell(Weight.WARNING, str(error))
            self._show_list()
            return
        if rank is not None:
            self._show_list(rank)
        self.push(text)

    def push(self, text: str | None) -> None:
        """Let the window undo a step that was made; None: none was."""
        key = None if self.work is None else self.work.model.undo_key
        if text is not None and key is not None:
            push_painted(self.bench, PaintedStep(text, key))

    def _put(self, request: PaintRequest) -> None:
        """Take a step back or do it again, if it is the next one; as soon as the regions are there."""
        if self._loading is not None:
            self._asked.append(request)
            return
        work = self.work
        if work is None:
            request.refused = True
        elif request.way == "undo":
            request.refused = work.model.undo_key != request.key or not work.undo()
        else:
            request.refused = work.model.redo_key != request.key or not work.redo()

    def _put_asked(self) -> None:
        """Do what was asked for before the regions were there."""
        asked, self._asked = self._asked, []
        for request in asked:
            self._put(request)
        if any(request.refused for request in asked):
            words = self.tr("What was painted cannot be undone any more: the probe's surface has changed.")
            self.bench.tell(Weight.WARNING, words)

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
        if not self.shown or self.work is None or self.job is not None:
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

    # ---- what takes long -------------------------------------------------------------------------

    def _begin(
        self,
        title: str,
        work: Callable[[Progress, Stop], object],
        done: Callable[..., None],
        wrong: Callable[[BaseException], None] | None = None,
    ) -> None:
        """Do something in a worker, during which nothing is painted; without `wrong`, an error is told."""
        if self.job is not None:
            return

        def over() -> None:
            self.job = None
            self.bench.set_running(Step.REGIONS, False)
            self.use_tool()
            self.show_all()

        def finished(result: object) -> None:
            over()
            done(result)

        def failed(error: BaseException) -> None:
            over()
            if isinstance(error, Cancelled):
                return
            if wrong is not None:
                wrong(error)
            else:
                self.bench.tell(Weight.ERROR, str(error))

        self.stop_tool()
        self.job = self.bench.jobs.start(title, work, finished, failed)
        self.show_all()

    def _show_plan(self, tool: Tool | None) -> None:
        """Show what a box or plane would take, in words and half painted."""
        work, before, self._planned = self.work, self._planned, tool
        if work is None or not self.shown or not (rank := self.panel.regions.rank):
            return
        if tool is None:
            if before is not None:
                self.bench.scene.paint(None, work.colours)
            return
        found = work.finder(tool, rank)()
        text = filled(
            self.tr("Facets: {0:,}; area: {1:.2f} cm²"),
            int(found.selection.mask.sum()),
            1e4 * found.selection.area,
        )
        self.panel.tools.show_plan(text)
        self.bench.scene.paint(None, work.planned(found))

    def _use(self, tool: Tool, erase: bool = False) -> None:
        """Use a tool on the chosen region: look for its facets in a worker, then make it one step."""
        work = self.work
        if work is None or self.job is not None:
            return
        work.abort()
        try:
            finder = work.finder(tool, self.panel.regions.rank)
        except InputError as error:
            self.bench.tell(Weight.WARNING, str(error))
            return
        if isinstance(tool, Clear):
            self._found(work, finder(), erase)
            return
        self._begin(
            self.tr("Finding facets"), lambda *_: finder(), lambda found: self._found(work, found, erase)
        )

    def _found(self, work: RegionsWork, found: FoundFacets, erase: bool) -> None:
        if work is not self.work:
            return
        if self._planned is not None:
            self.bench.scene.paint(None, work.colours)
        try:
            text = work.give(found, protect=self.panel.tools.protect.isChecked(), erase=erase)
        except InputError as error:
            self.bench.tell(Weight.WARNING, str(error))
            return
        if found.selection.sentence:
            self.bench.tell(Weight.INFO, found.selection.sentence)
        self.push(text)
        if text is None:
            self.bench.tell(Weight.INFO, self.tr("No change: the region already has this shape."))

    def _apply(self) -> None:
        """Compute the probe again with these regions."""
        bench, desk = self.bench, self.bench.desk
        if self.job is not None:
            return
        self.keeper.keep_now()
        text = self.tr("apply regions to probe")

        def work(progress: Progress, cancelled: Stop) -> Callable[[Session], Record]:
            desk.do(lambda _session: None).result()  # what was just painted is in the session now
            return apply(desk, Monitor(progress, cancelled))

        def recorded(_: object) -> None:
            bench.set_failed(Step.REGIONS, "")
            unlike = unlike_painted(desk)
            self._unlike.update(unlike)
            for told in filter(None, unlike.values()):
                bench.tell(Weight.WARNING, told)
            if not any(unlike.values()):
                bench.tell(Weight.GOOD, self.tr("Regions applied to the probe."))
            self.show_all()

        def wrong(error: BaseException) -> None:
            bench.set_failed(Step.REGIONS, str(error))
            bench.tell(Weight.ERROR, str(error))

        def computed(record: Callable[[Session], Record]) -> None:
            bench.undo.push(SessionCommand(bench, text, record, recorded, wrong))

        bench.set_running(Step.REGIONS, True)
        self._begin(self.tr("Applying regions"), work, computed, wrong)

    # ---- files -----------------------------------------------------------------------------------

    def _ask_import(self) -> None:
        kinds = self.tr("Regions (*.json *.csv)")
        if file := asked_file(self, self.tr("Import regions"), kinds):
            self.read(file)

    def _ask_export(self) -> None:
        kinds = self.tr("Regions (*.json *.csv)")
        if file := asked_file(self, self.tr("Export regions"), kinds, "regions.json", save=True):
            self.write(file)

    def read(self, file: Path) -> None:
        """Replace all regions by those of a file, as one step; names and colours stay where the file has none."""
        work = self.work
        if work is None:
            return

        def done(found: RegionSet) -> None:
            if work is not self.work:
                return
            regions = found
            if file.suffix.lower() == ".csv":
                cut = MeshEdit.between(work.shell.probe, work.probe)
                regions = RegionSet(
                    RegionSet.from_labels(found.labels, work.model.regions).regions, found.labels, cut
                )
            self._edit(lambda: work.replace(regions), 1)

        # A table says which facet, of the mesh as it is now.
        mesh = work.probe if file.suffix.lower() == ".csv" else work.shell.probe
        self._begin(self.tr("Reading regions"), lambda *_: load_regions(file, mesh), done)

    def write(self, file: Path) -> None:
        """Write all regions to a file."""
        work = self.work
        if work is None:
            return
        regions = work.kept()
        self._begin(
            self.tr("Writing regions"),
            lambda *_: save_regions(regions, work.shell.probe, file),
            lambda _: self.bench.tell(Weight.GOOD, self.tr("Regions saved to {0}.").format(file)),
        )


# ---- regions are kept in the session by themselves -----------------------------------------------


PAUSE = 1500  # ms after the last change


class RegionAutosave(QObject):
    """
    Saves the regions of one page.

    Attributes
    ----------
    dirty : bool
        There are changes that the session does not have.
    """

    kept = Signal()  # nothing is left to be kept
    failed = Signal(object)  # why it could not be; the next change tries again

    def __init__(self, bench: Bench, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._bench = bench
        self._work: RegionsWork | None = None
        self._kept_at = 0
        self._timer = QTimer(self, singleShot=True, interval=PAUSE)
        self._timer.timeout.connect(self._keep_or_wait)
        bench.mended.connect(self.changed)

    @property
    def dirty(self) -> bool:
        """See the class."""
        return self._work is not None and self._work.revision != self._kept_at

    def watch(self, work: RegionsWork | None) -> None:
        """Keep these from now on, after those before."""
        self.keep_now()
        self._work = work
        self._kept_at = 0 if work is None else work.revision

    def changed(self) -> None:
        """Keep them soon."""
        if self.dirty:
            self._timer.start()

    def _keep_or_wait(self) -> None:
        """Keep them, but not amid a stroke: that would be lost, and its end comes soon."""
        if self._work is not None and self._work.drawing:
            self._timer.start()
        else:
            self.keep_now()

    def keep_now(self) -> None:
        """Keep them at once, in the desk's thread; a stroke that is being drawn is given up."""
        self._timer.stop()
        work = self._work
        if work is None or not self.dirty:
            return
        work.abort()
        revision, regions, shell, steps = work.revision, work.kept(), work.shell, work.model.steps
        self._kept_at = revision
        bench, title = self._bench, self.tr("Saving regions")

        def done(_record: object) -> None:
            # Something else may be watched by now, or the page be closed and this object be gone.
            if self._work is work and not self.dirty:
                self.kept.emit()

        def wrong(error: BaseException) -> None:
            if self._work is work:
                self._kept_at = -1
                self.failed.emit(str(error))
            else:
                bench.tell(Weight.ERROR, str(error))

        bench.do(title, lambda session: keep_with_steps(session, regions, shell, steps), done, wrong)
