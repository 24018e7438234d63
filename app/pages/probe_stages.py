"""The stages from a mesh file to a probe in use: what is there, and what is begun when it is done."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

from PySide6.QtCore import QObject, QTimer, Signal

from contactbench.app.bench import Weight
from contactbench.app.pages.probe_view import ProbeView, Shown
from contactbench.app.pages.virtual_mesh import Housing, bench_address, take_housing
from contactbench.app.undo import SessionCommand
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.mesh.engines import Cancelled
from contactbench.pipeline.workbench.probe import Mesh, ProbePlan, ProbePreview, ProbeWork, commit
from contactbench.pipeline.workbench.probe_ladder import Trade, trade_of
from contactbench.pipeline.workbench.probe_shell import recipe_of, used_probe
from contactbench.pipeline.workbench.steps import Step

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from contactbench.app.bench import Bench
    from contactbench.app.jobs import Job
    from contactbench.pipeline.mesh import Probe
    from contactbench.pipeline.preparation.alignment import Alignment
    from contactbench.pipeline.preparation.ladder import Ladder
    from contactbench.pipeline.preparation.prepare import Dense
    from contactbench.pipeline.session import State
    from contactbench.widgets.action_bar import ActionBar

_SETTLE_MS = 350
TARGETS = ("facets", "max_deviation", "max_contact_error")


class ProbeWorker(QObject):
    """
    Runs what takes long, one thing at a time; beginning something else stops what ran before.

    Parameters
    ----------
    bench : Bench
    bar : ActionBar
        Says what runs, and how it ended.
    wrong : callable
        Gets the sentence of what went wrong.
    ended : callable
        Called after everything else, however it ended.
    """

    def __init__(
        self, bench: Bench, bar: ActionBar, wrong: Callable[[str], None], ended: Callable[[], None]
    ) -> None:
        super().__init__(bar)
        self._bench, self._bar, self._wrong, self._ended = bench, bar, wrong, ended
        self._job: Job | None = None

    @property
    def busy(self) -> bool:
        """Whether something runs."""
        return self._job is not None

    def start(self, title: str, work: Callable[..., Any], done: Callable[[Any], None]) -> None:
        """Begin something, as `Jobs.start`; nobody hears of its end once something else was begun."""
        self.stop()

        def finish(result: Any) -> None:
            if self._job is job:
                self._let_go()
                self._bar.say("")
                done(result)
                self._ended()

        def fail(error: BaseException) -> None:
            if self._job is job:
                self._let_go()
                self._failed(error)
                self._ended()

        job = self._job = self._bench.jobs.start(title, work, finish, fail)
        self._bar.say(title)
        self._bar.primary.setEnabled(False)
        self._bench.set_failed(Step.PROBE, "")
        self._bench.set_running(Step.PROBE, going_on=True)

    def stop(self) -> None:
        """Stop what runs."""
        job = self._job
        if job is not None:
            self._let_go()
            job.cancel()

    def _let_go(self) -> None:
        self._job = None
        self._bench.set_running(Step.PROBE, going_on=False)

    def _failed(self, error: BaseException) -> None:
        if isinstance(error, Cancelled):
            self._bar.say(self.tr("Stopped. Nothing was changed."))
            return
        self._bench.set_failed(Step.PROBE, str(error))
        words = self.tr("Something unexpected went wrong ({}). What there was is as it was; try again.")
        self._wrong(str(error) if isinstance(error, InputError) else words.format(error))


class ProbeStages(QObject):
    """
    What was chosen and what came of it; each stage begins by itself when the one before it is done.

    Parameters
    ----------
    bench : Bench
    bar : ActionBar
        Says what runs.

    Attributes
    ----------
    mesh : Mesh or None
    plan : ProbePlan
    dense : Dense or None
        The outer surface.
    trade : Trade or None
        What fewer facets cost.
    preview : ProbePreview or None
        The probe as it would be used.
    asked : bool
        Whether a person has to say the mesh's unit.
    in_use : bool
        Whether what is shown is what the session has.
    using : bool
        Whether it is just being put there.
    known : object
        Which of the session's probes is shown; see `key_of`.
    """

    changed = Signal()
    redraw = Signal(bool)  # whether the view is to be filled
    begun = Signal()  # with another mesh
    aligned = Signal(object, object)  # Alignment or None, notes
    ready = Signal()  # to be used, for the first time

    def __init__(self, bench: Bench, bar: ActionBar, parent: QObject) -> None:
        super().__init__(parent)
        self.bench, self.bar = bench, bar
        self.work = ProbeWork(bench.desk)
        self.mesh: Mesh | None = None
        self.plan = ProbePlan()
        self.dense: Dense | None = None
        self.trade: Trade | None = None
        self.preview: ProbePreview | None = None
        self.asked = self.in_use = self.using = False
        self.known: object = ()
        self.view = ProbeView(bench.scene, self.tr("deviation, mm"))
        self.worker = ProbeWorker(bench, bar, self.wrong, self.changed.emit)
        self._settle = QTimer(self, singleShot=True, interval=_SETTLE_MS)
        self._settle.timeout.connect(self._prepare)

    def wrong(self, sentence: str) -> None:
        """Say what went wrong, here and in the list."""
        self.bar.say(sentence, bad=True)
        self.bench.tell(Weight.ERROR, sentence)

    def close(self) -> None:
        """Stop what runs, and remove the copies of meshes."""
        self._settle.stop()
        self.worker.stop()
        self.work.close()

    # ---- the mesh --------------------------------------------------------------------------------

    def take(self, file: Path) -> None:
        """Take a mesh file; what is there stays until it is read."""
        self.worker.start(
            self.tr("Reading {}").format(file.name),
            lambda progress, cancelled: self.work.take(file, "auto", progress, cancelled),
            self._taken,
        )

    def take_housing(self) -> None:
        """Take the mesh of the probe on the virtual bench, and its mount."""
        address = bench_address(self.bench.desk.state)
        if address is not None:
            self.worker.start(
                self.tr("Making the housing of the virtual bench"),
                lambda progress, cancelled: take_housing(self.work, address, progress, cancelled),
                self._housing_taken,
            )

    def _taken(self, mesh: Mesh) -> None:
        self._begin(mesh, ProbePlan(), asked=mesh.unit_asked)
        if not mesh.unit_asked:
            self.make_surface()

    def _housing_taken(self, housing: Housing) -> None:
        plan = ProbePlan(units=housing.units, alpha=housing.alpha_mm, alignment=housing.alignment)
        self._begin(housing.mesh, plan, asked=False)
        self.make_surface()

    def _begin(self, mesh: Mesh, plan: ProbePlan, *, asked: bool) -> None:
        self.mesh, self.plan, self.asked = mesh, plan, asked
        self._drop(surface=True)
        self.view.used = None
        self.view.shown = Shown(mesh.original.probe)
        self.begun.emit()
        self.aligned.emit(plan.alignment, ())
        self.redraw.emit(True)
        self.changed.emit()

    def say_unit(self, unit: str) -> None:
        """Look at the mesh once more, in the unit that a person said."""
        mesh = self.mesh
        if mesh is not None:
            self.worker.start(
                self.tr("Looking at the mesh in its unit"),
                lambda progress, cancelled: self.work.again(mesh, unit, progress, cancelled),
                lambda seen: self._unit_said(seen, unit),
            )

    def _unit_said(self, mesh: Mesh, unit: str) -> None:
        self._begin(mesh, replace(self.plan, units=unit), asked=False)
        self.make_surface()

    # ---- the outer surface, and where it lies ------------------------------------------------------

    def close_by(self, close: tuple[str, ...], alpha: float | None) -> None:
        """Choose how the outer surface is made; `alpha` in mm."""
        self.worker.stop()
        self.plan = replace(self.plan, close=close, alpha=alpha)
        self._drop(surface=True)
        self.redraw.emit(False)
        self.changed.emit()

    def make_surface(self) -> None:
        """Make the outer surface."""
        mesh, plan = self.mesh, self.plan
        if mesh is None:
            return

        def work(progress: Callable[[float], None], cancelled: Callable[[], bool]) -> tuple[Dense, Shown]:
            dense = self.work.shell(mesh, plan, progress, cancelled)
            return dense, _shown(mesh, dense, plan.alignment)

        self.worker.start(self.tr("Making the outer surface"), work, self._surface_made)

    def _surface_made(self, made: tuple[Dense, Shown]) -> None:
        self.dense, self.view.shown = made
        self.redraw.emit(True)
        self._measure_if_placed()

    def put(self, alignment: Alignment, notes: tuple[str, ...] = ()) -> None:
        """Say where the mesh lies; what follows from it is computed again."""
        mesh, dense = self.mesh, self.dense
        self.plan = replace(self.plan, alignment=alignment)
        self._drop()
        self.aligned.emit(alignment, notes)
        if mesh is None:
            return
        self.worker.start(
            self.tr("Placing the mesh"),
            lambda _progress, _cancelled: _shown(mesh, dense, alignment),
            self._placed,
        )

    def _placed(self, shown: Shown) -> None:
        self.view.shown = shown
        self.redraw.emit(True)
        self._measure_if_placed()

    @property
    def in_sensor_frame(self) -> bool:
        """Whether it is known where the mesh lies."""
        base = self.mesh is not None and self.mesh.original.frame == "S"
        return base or self.plan.alignment is not None

    def _measure_if_placed(self) -> None:
        if self.dense is not None and self.in_sensor_frame:
            self.measure()
        else:
            self.changed.emit()

    # ---- how many facets ---------------------------------------------------------------------------

    def measure(self) -> None:
        """Measure what fewer facets cost and save; then prepare the probe."""
        mesh, plan = self.mesh, self.plan
        if mesh is not None:
            self.worker.start(
                self.tr("Comparing numbers of facets"),
                lambda progress, cancelled: self.work.ladder(mesh, plan, progress, cancelled),
                self._measured,
            )

    def _measured(self, ladder: Ladder) -> None:
        self.trade = trade_of(ladder)
        if all(getattr(self.plan, name) is None for name in TARGETS):
            self.plan = replace(self.plan, facets=self.trade.advised)
        self._prepare()

    def keep(self, facets: int) -> None:
        """Choose a number of facets."""
        self.aim(replace(self.plan, facets=facets, max_deviation=None, max_contact_error=None))

    def aim(self, plan: ProbePlan) -> None:
        """Choose another target, or another way to it."""
        if plan == self.plan:
            return
        self.plan = plan
        self._drop(ladder=False)
        self.changed.emit()
        if self.dense is not None and self.in_sensor_frame:
            self._settle.start()  # arrow keys may go on

    def _prepare(self) -> None:
        mesh, plan = self.mesh, self.plan
        if mesh is not None:
            self.worker.start(
                self.tr("Preparing the probe"),
                lambda progress, cancelled: self.work.preview(mesh, plan, progress, cancelled),
                self._prepared,
            )

    def _prepared(self, preview: ProbePreview) -> None:
        first = self.preview is None
        self.preview = self.view.preview = preview
        self.redraw.emit(False)
        self.changed.emit()
        if first:
            self.ready.emit()

    def use(self) -> None:
        """Put the probe into the session; can be undone."""
        preview = self.preview
        if preview is None:
            return
        self.using = True
        self.bench.undo.push(
            SessionCommand(
                self.bench,
                self.tr("use the probe"),
                lambda session: commit(session, preview),
                lambda _: self._used(preview),
                self._not_used,
                self.reload,
            )
        )
        self.changed.emit()

    def _used(self, preview: ProbePreview) -> None:
        self.using = False
        self.known = key_of(self.bench.desk.state)
        self.in_use = preview is self.preview
        count = len(preview.done.content.probe.faces)
        self.bench.tell(
            Weight.GOOD,
            self.tr("The probe of {:,} facets is in use. Next: regions, or verify.").format(count),
        )
        self.bench.set_failed(Step.PROBE, "")
        self.changed.emit()

    def _not_used(self, error: BaseException) -> None:
        self.using = False
        self.wrong(str(error))
        self.changed.emit()

    # ---- what the session has ------------------------------------------------------------------------

    def reload(self) -> None:
        """Show the session's probe, and how it was made."""
        self.known = key_of(self.bench.desk.state)

        def work(progress: Callable[[float], None], cancelled: Callable[[], bool]) -> Any:
            known = self.work.restore(progress, cancelled)
            # The original where it belongs: in its own frame it would seem misplaced.
            shown = Shown() if known is None else _shown(known[0], None, known[1].alignment)
            return known, shown, used_probe(self.bench.desk)

        self.worker.start(self.tr("Opening the probe"), work, self._restored)

    def _restored(self, found: tuple[tuple[Mesh, ProbePlan] | None, Shown, Probe | None]) -> None:
        known, shown, used = found
        if known is None:
            self.mesh, self.plan = None, ProbePlan()
            self._drop(surface=True)
        else:
            self._begin(*known, asked=False)
        self.view.shown = shown
        self.view.used, self.in_use = used, used is not None
        self.redraw.emit(True)
        self.changed.emit()

    # ---- what holds --------------------------------------------------------------------------------

    def _drop(self, *, surface: bool = False, ladder: bool = True) -> None:
        """Forget what does not hold any more."""
        self._settle.stop()
        self.in_use = False
        self.preview = self.view.preview = None
        if ladder or surface:
            self.trade = None
        if surface:
            self.dense = None
            self.view.shown = replace(self.view.shown, dense=None)


def _shown(mesh: Mesh, dense: Dense | None, alignment: Alignment | None) -> Shown:
    """Put what there is in its place; for a worker."""
    meshes = (mesh.original.probe, None if dense is None else dense.content.probe)
    if alignment is None:
        return Shown(*meshes)
    original, outer = (None if each is None else alignment.place(each) for each in meshes)
    return Shown(original, outer, alignment)


def key_of(state: State) -> object:
    """Return what tells one probe of the session from another."""
    recipe = recipe_of(state)
    return None if recipe is None else (recipe.inputs.get("mesh"), recipe.result and recipe.result.number)
