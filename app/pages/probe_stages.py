"""The stages from a mesh file to a probe in use: what is there, and what is begun when it is done."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import Any

from PySide6.QtCore import QObject, QTimer, Signal

from contactbench.app.bench import Bench, Weight
from contactbench.app.jobs import Job
from contactbench.app.pages.virtual_mesh import Housing, bench_address, take_housing
from contactbench.app.undo import SessionCommand
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.mesh import Probe
from contactbench.pipeline.mesh.engines import Cancelled, Monitor
from contactbench.pipeline.preparation.alignment.alignment import Alignment
from contactbench.pipeline.preparation.ladder.ladder import Ladder
from contactbench.pipeline.preparation.prepare import Dense
from contactbench.pipeline.session import State
from contactbench.pipeline.steps import Step
from contactbench.pipeline.workbench.probe import (
    DRAFT,
    Mesh,
    ProbePlan,
    ProbePreview,
    ProbeWork,
    Trade,
    draft_of,
    keep_draft,
    trade_of,
    use_draft,
)
from contactbench.pipeline.workbench.regions_session import recipe_of, used_probe
from contactbench.widgets.action_bar import ActionBar
from contactbench.widgets.messages import filled
from contactbench.widgets.scene import Scene


@dataclass(frozen=True, eq=False)
class Shown:
    """Meshes that can be shown, all in the same place."""

    original: Probe | None = None  # As the file has it
    dense: Probe | None = None  # The outer surface with all its facets
    alignment: Alignment | None = None  # What took them from the mesh's frame to where they are shown


class ProbeView:
    """
    Shows one mesh, perhaps with the original over it, or with the deviation as colours.

    Parameters
    ----------
    scene : Scene
    title : str
        Of the colours: what they are, with its unit.
    """

    def __init__(self, scene: Scene, title: str) -> None:
        self._scene, self._title = scene, title
        self.shown = Shown()
        self.preview: ProbePreview | None = None
        self.used: Probe | None = None  # the session's
        self.overlay = self.deviation = False
        self._main: Probe | None = None

    def draw(self, *, fit: bool = False) -> None:
        """Show it all; `fit`: so that it fills the view."""
        simplified = None if self.preview is None else self.preview.done.content.probe
        dense, field = self.shown.dense, None
        if self.deviation and self.preview is not None:
            dense, field = self.preview.placed.probe, 1e3 * self.preview.deviation
            main: Probe | None = dense
        else:
            main = simplified or dense or self.used or self.shown.original
        if main is not self._main:
            self._scene.show_field(None)  # it belongs to the mesh before
            self._scene.show_probe(main)
            self._main = main
        self._scene.show_field(field, self._title)
        self._scene.show_overlay(
            self.shown.original if self.overlay and main is not self.shown.original else None
        )
        if fit and main is not None:
            self._scene.look("fit")

    def forget(self) -> None:
        """Take away what only this page shows; another page may show another mesh."""
        self._scene.show_field(None)
        self._scene.show_overlay(None)
        self._main = None


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

    def start(self, title: str, work: Callable[[Monitor], Any], done: Callable[[Any], None]) -> None:
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

        job = self._job = self._bench.jobs.start(title, lambda *how: work(Monitor(*how)), finish, fail)
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
        words = self.tr("Unexpected error ({}). Nothing was changed. Try again.")
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
        self._writing = 0  # stages that are on their way into the session
        self._unkept = ""  # what was chosen since, in words; empty: nothing
        self._compared: tuple[object, Ladder] | None = None  # of what, and what fewer facets cost it
        self.view = ProbeView(bench.scene, self.tr("deviation, mm"))
        self.worker = ProbeWorker(bench, bar, self.wrong, self.changed.emit)
        self._settle = QTimer(self, singleShot=True, interval=_SETTLE_MS)
        self._settle.timeout.connect(self._settled)
        bench.mended.connect(self._keep_again)

    def wrong(self, sentence: str) -> None:
        """Say what went wrong, here and in the list."""
        self.bar.say(sentence, bad=True)
        self.bench.tell(Weight.ERROR, sentence)

    def close(self) -> None:
        """Keep what was chosen, stop what runs, and remove the copies of meshes."""
        self.keep_now()
        self.worker.stop()
        # In the desk's order: what is on its way into the session is read from them.
        self.bench.desk.do(lambda _session: self.work.close())

    # ---- in the session --------------------------------------------------------------------------

    @property
    def up_to_date(self) -> bool:
        """Whether what is shown is what the session says, or is on its way there."""
        return bool(self._writing or self._unkept) or self.known == key_of(self.bench.desk.state)

    def _keep(self, text: str) -> None:
        """Put this stage into the session, as a step that can be undone; `text` says what was done."""
        mesh, plan, self._unkept = self.mesh, self.plan, ""
        if mesh is None:
            return
        self._writing += 1
        self.bench.undo.push(
            SessionCommand(
                self.bench,
                text,
                lambda session: keep_draft(session, mesh, plan),
                lambda _: self._kept(),
                self._not_kept,
                self.reload,
            )
        )

    def _keep_quietly(self) -> None:
        """Put into the session what followed by itself: no step of its own."""
        mesh, plan = self.mesh, self.plan
        if mesh is None or self.in_use or self._unkept:
            return
        self._writing += 1
        self.bench.do(
            self.tr("keep the probe's draft"),
            lambda session: keep_draft(session, mesh, plan),
            lambda _: self._kept(),
            self._not_kept,
        )

    def _kept(self) -> None:
        self._writing -= 1
        if not self._writing:
            self.known = key_of(self.bench.desk.state)

    def _not_kept(self, error: BaseException) -> None:
        self._writing -= 1
        self._unkept = self.tr("keep the probe's draft")
        self.bench.set_failed(Step.PROBE, str(error))
        self.wrong(str(error))

    def _keep_again(self) -> None:
        """Keep what a disk refused that can be written again."""
        if self._unkept:
            self.bench.set_failed(Step.PROBE, "")
            self.keep_now()

    def keep_now(self) -> None:
        """Keep what was chosen a moment ago."""
        self._settle.stop()
        if self._unkept:
            self._keep(self._unkept)

    def _choose_soon(self, text: str) -> None:
        """Keep what was chosen as soon as nothing else follows: arrow keys may go on."""
        self._unkept = text
        self._settle.start()

    def _settled(self) -> None:
        self.keep_now()
        if self.dense is not None and self.in_sensor_frame and self.preview is None:
            self._prepare()

    # ---- the mesh --------------------------------------------------------------------------------

    def take(self, file: Path) -> None:
        """Take a mesh file; what is there stays until it is read."""
        title = self.tr("Reading {}").format(file.name)
        self.worker.start(title, partial(self.work.take, file, "auto"), self._taken)

    def take_housing(self) -> None:
        """Take the mesh of the probe on the virtual bench, and its mount."""
        address = bench_address(self.bench.desk.state)
        if address is not None:
            title = self.tr("Creating the virtual bench housing")
            self.worker.start(title, partial(take_housing, self.work, address), self._housing_taken)

    def _taken(self, mesh: Mesh) -> None:
        self._begin(mesh, ProbePlan(), asked=mesh.unit_asked)
        self._keep(self.tr("take the mesh {}").format(mesh.file.name))
        if not mesh.unit_asked:
            self.make_surface()

    def _housing_taken(self, housing: Housing) -> None:
        plan = ProbePlan(
            housing.units, close=housing.close, alpha=housing.alpha_mm, alignment=housing.alignment
        )
        self._begin(housing.mesh, plan, asked=False)
        self._keep(self.tr("take the mesh {}").format(housing.mesh.file.name))
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
        self._read_again(replace(self.plan, units=unit), self.tr("say the mesh's unit"))

    def say_tolerance(self, tolerance_mm: float) -> None:
        """Tessellate a STEP file once more, to another tolerance."""
        if self.mesh is not None and self.mesh.tessellated and tolerance_mm != self.plan.tolerance:
            self._read_again(
                replace(self.plan, tolerance=tolerance_mm), self.tr("choose the tolerance of the STEP file")
            )

    def _read_again(self, plan: ProbePlan, text: str) -> None:
        mesh = self.mesh
        if mesh is None:
            return

        def done(mesh: Mesh) -> None:
            self._begin(mesh, plan, asked=mesh.unit_asked)
            self._keep(text)
            if not mesh.unit_asked:
                self.make_surface()

        work = partial(self.work.take, mesh.file, plan.units, tolerance=plan.tolerance)
        self.worker.start(self.tr("Reading {}").format(mesh.file.name), work, done)

    # ---- the outer surface, and where it lies ------------------------------------------------------

    def close_by(self, close: tuple[str, ...], alpha: float | None) -> None:
        """Choose how the outer surface is made; `alpha` in mm."""
        self.worker.stop()
        self.plan = replace(self.plan, close=close, alpha=alpha)
        self._drop(surface=True)
        self._choose_soon(self.tr("choose how the outer surface is made"))
        self.redraw.emit(False)
        self.changed.emit()

    def make_surface(self) -> None:
        """Make the outer surface."""
        mesh, plan = self.mesh, self.plan
        if mesh is None:
            return

        def work(monitor: Monitor) -> tuple[Dense, Shown]:
            dense = self.work.shell(mesh, plan, monitor)
            return dense, _shown(mesh, dense, plan.alignment)

        self.worker.start(self.tr("Creating outer surface"), work, self._surface_made)

    def _surface_made(self, made: tuple[Dense, Shown]) -> None:
        self.dense, self.view.shown = made
        self.redraw.emit(True)
        self._measure_if_placed()

    def put(self, alignment: Alignment, notes: tuple[str, ...] = ()) -> None:
        """Say where the mesh lies; what follows from it is computed again."""
        mesh, dense = self.mesh, self.dense
        self.plan = replace(self.plan, alignment=alignment)
        self._drop()
        self._keep(self.tr("place the mesh"))
        self.aligned.emit(alignment, notes)
        if mesh is None:
            return
        self.worker.start(self.tr("Aligning mesh"), lambda _: _shown(mesh, dense, alignment), self._placed)

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
        if self.dense is None or not self.in_sensor_frame:
            self.changed.emit()
        elif self._compared is not None and self._compared[0] == self._surface:
            self._measured(self._compared[1])
        else:
            self.measure()

    @property
    def _surface(self) -> object:
        """What a comparison of numbers of facets rests on."""
        return (self.mesh, replace(self.plan, facets=None, max_deviation=None, max_contact_error=None))

    # ---- how many facets ---------------------------------------------------------------------------

    def measure(self) -> None:
        """Measure what fewer facets cost and save; then prepare the probe."""
        mesh, plan = self.mesh, self.plan
        if mesh is not None:
            title = self.tr("Comparing facet counts")
            self.worker.start(title, partial(self.work.ladder, mesh, plan), self._measured)

    def _measured(self, ladder: Ladder) -> None:
        self._compared = (self._surface, ladder)
        self.trade = trade_of(ladder)
        if all(getattr(self.plan, name) is None for name in TARGETS):
            self.plan = replace(self.plan, facets=self.trade.advised)
        self._keep_quietly()
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
        self._choose_soon(self.tr("choose the number of facets"))
        self.changed.emit()

    def _prepare(self) -> None:
        mesh, plan = self.mesh, self.plan
        if mesh is not None:
            title = self.tr("Preparing probe")
            self.worker.start(title, partial(self.work.preview, mesh, plan), self._prepared)

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
        self.keep_now()
        self.bench.undo.push(
            SessionCommand(
                self.bench,
                self.tr("use probe"),
                lambda session: use_draft(session, preview),
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
            filled(self.tr("The probe with {:,} facets is in use. Next: regions or verification."), count),
        )
        self.bench.set_failed(Step.PROBE, "")
        self.changed.emit()

    def _not_used(self, error: BaseException) -> None:
        self.using = False
        self.wrong(str(error))
        self.changed.emit()

    # ---- what the session has ------------------------------------------------------------------------

    def reload(self) -> None:
        """Show what is being prepared or, without a draft, the session's probe and how it was made."""
        self._settle.stop()
        self._unkept = ""
        state = self.bench.desk.state
        self.known = key_of(state)

        def work(monitor: Monitor) -> _Found:
            draft = draft_of(state)
            if draft is not None:
                mesh = self.work.kept(draft.mesh, draft.plan, monitor)
                return _Found((mesh, draft.plan), _shown(mesh, None, draft.plan.alignment), None)
            known = self.work.restore(monitor)
            # The original where it belongs: in its own frame it would seem misplaced.
            shown = Shown() if known is None else _shown(known[0], None, known[1].alignment)
            return _Found(known, shown, used_probe(self.bench.desk))

        self.worker.start(self.tr("Opening probe"), work, self._restored)

    def _restored(self, found: _Found) -> None:
        if found.known is None:
            self.mesh, self.plan, self.asked = None, ProbePlan(), False
            self._drop(surface=True)
        else:
            mesh, plan = found.known
            self._begin(mesh, plan, asked=mesh.unit_asked and found.used is None)
        self.view.shown = found.shown
        self.view.used, self.in_use = found.used, found.used is not None
        self.redraw.emit(True)
        self.changed.emit()
        if found.known is not None and not self.in_use and not self.asked:
            self.make_surface()  # and what follows from it: it goes on where it was left

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


@dataclass(frozen=True, eq=False)
class _Found:
    """What a session has."""

    known: tuple[Mesh, ProbePlan] | None
    shown: Shown
    used: Probe | None  # None: it is a draft, or there is none


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
    used = None if recipe is None else (recipe.inputs.get("mesh"), recipe.result and recipe.result.number)
    return used, state.setting(DRAFT)
