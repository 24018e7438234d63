"""The window in which a closed loop is watched."""

from __future__ import annotations

import tempfile
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from PySide6.QtCore import QEvent, QTimer
from PySide6.QtWidgets import QWidget

from contactbench.app.errors import in_words
from contactbench.app.help_book import HelpBook
from contactbench.app.jobs import Jobs
from contactbench.app.motion.controls import MotionControls, MotionPhase
from contactbench.pipeline.errors import join
from contactbench.widgets.controls import add_key, asked_file, beside, column
from contactbench.widgets.messages import filled
from contactbench.widgets.scene import Scene
from contactbench.widgets.scene.views import triple
from contactbench.widgets.strip_chart_pane import Curves, Pane
from contactbench.widgets.theme import is_dark

if TYPE_CHECKING:
    from collections.abc import Callable

    from PySide6.QtGui import QCloseEvent

    from contactbench.app.bench import Bench
    from contactbench.pipeline.config.runtime import RuntimeConfig
    from contactbench.pipeline.control.frames import Beginning, LoopFrame
    from contactbench.pipeline.mesh import Probe
    from contactbench.pipeline.session import Session
    from contactbench.pipeline.workbench.motion import Course, MotionRun

_TICK_MS = 40
_CHARTS_EVERY = 2  # ticks
_PATIENCE_S = 10.0


class MotionWindow(QWidget):
    """
    Runs the controller of a bundle on a virtual robot, and shows it.

    Parameters
    ----------
    bench : callable
        Returns the bench of the open session, or None.

    Attributes
    ----------
    controls : MotionControls
    picture : Picture
    run : MotionRun or None
        What runs, or has run.
    """

    def __init__(self, bench: Callable[[], Bench | None], parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._bench = bench
        self.jobs = Jobs(self)
        self.controls, self.picture = MotionControls(self), Picture(self)
        self.run: MotionRun | None = None
        self._bundle: Path | None = None
        self._unturned = False
        self._made = tempfile.TemporaryDirectory(prefix="contactbench-", ignore_cleanup_errors=True)
        self._busy = self._closed = self._stopping = False
        self._ticks = self._told = 0
        self._tick = QTimer(self, interval=_TICK_MS)
        beside(self, (self.picture, 1), self.controls, space=0)
        self._connect()
        self.controls.bar.say(
            self.tr("Choose a bundle, then press Start. Everything is simulated; no real hardware moves.")
        )

    def _connect(self) -> None:
        controls = self.controls
        controls.of_session.clicked.connect(self.use_session)
        controls.other.clicked.connect(self._ask)
        controls.asked_start.connect(self.begin)
        controls.asked_stop.connect(self.stop)
        self._tick.timeout.connect(self._show)
        self.picture.scene.dropped.connect(self.use_bundle)
        add_key(self, self.tr("Stop"), "Esc", self.stop)
        add_key(self, self.tr("This page"), "F1", self.show_help)

    @property
    def phase(self) -> MotionPhase:
        """How it stands."""
        run = self.run
        if run is not None and run.running:
            if self._stopping:
                return MotionPhase.STOPPING
            return MotionPhase.STARTING if run.newest is None else MotionPhase.RUNNING
        if self._busy:
            return MotionPhase.OPENING
        if self._bundle is None:
            return MotionPhase.EMPTY
        if run is None:
            return MotionPhase.READY
        return MotionPhase.FAILED if run.outcome is None else MotionPhase.ENDED

    def show_help(self) -> None:
        """Show the help on this window."""
        HelpBook.beside(self, "motion")

    def _show_phase(self) -> None:
        run = self.run
        self.controls.show_phase(
            self.phase, None if run is None else run.newest, None if run is None else run.pace
        )

    # ---- which bundle ------------------------------------------------------------------------------

    def use_session(self) -> None:
        """Take what the open session would export now."""
        bench = self._bench()
        if bench is None:
            self.controls.bar.say(self.tr("No session is open. Open one or choose a bundle."), bad=True)
            return
        place = Path(self._made.name) / "session.zip"

        def write(session: Session) -> Path:
            from contactbench.pipeline.workbench.export import built

            built(session, unverified=True).write(place)
            return place

        self._begin_work()
        future = bench.desk.do(write)
        self.jobs.follow(
            self.tr("Creating bundle"),
            future,
            lambda made: self._load(made, bench.desk.folder.name),
            self._failed,
        )

    def use_bundle(self, bundle: Path) -> None:
        """Take an exported bundle."""
        if self.run is None or not self.run.running:
            self._begin_work()
            self._load(bundle, bundle.name)

    def _load(self, bundle: Path, name: str) -> None:
        def work(_progress: Callable[[float], None], _cancelled: Callable[[], bool]) -> RuntimeConfig:
            from contactbench.pipeline.config.runtime import RuntimeConfig

            return RuntimeConfig.load(bundle)

        self.jobs.start(
            self.tr("Opening bundle"), work, lambda config: self._loaded(bundle, name, config), self._failed
        )

    def _loaded(self, bundle: Path, name: str, config: RuntimeConfig) -> None:
        self._bundle, self._busy = bundle, False
        self._forget_run()
        self._unturned = config.model.frames.quaternion_ES is None
        self.picture.show_probe(config.probe)
        self.controls.bundle.setText(self._words_on(config, name))
        self._show_phase()

    def _words_on(self, config: RuntimeConfig, name: str) -> str:
        model = config.model
        words = filled(self.tr("{name}: {facets:,} facets."), name=name, facets=model.probe.facets)
        if not model.verified:
            words += " " + self.tr("Not verified: for trials only.")
        if model.frames.quaternion_ES is None:
            words += " " + self.tr("The bundle does not state the sensor's mounting; no rotation is assumed.")
        if model.controller is None:
            return words + " " + self.tr("The bundle has no gains; the defaults for its probe are used.")
        gains = filled(self.tr("Contact force {force:g} N."), force=model.controller.desired_force_N)
        return f"{words} {gains}"

    def _ask(self) -> None:
        kinds = self.tr("Bundles (*.zip contactbench.json);;All files (*)")
        if chosen := asked_file(self, self.tr("Open bundle"), kinds):
            self.use_bundle(chosen.parent if chosen.name == "contactbench.json" else chosen)

    # ---- running -----------------------------------------------------------------------------------

    def begin(self) -> None:
        """Begin to run what is chosen."""
        from contactbench.pipeline.workbench.motion import MotionRun

        if self._bundle is None or self._busy or (self.run is not None and self.run.running):
            return
        self._forget_run()
        try:
            choice = self.controls.choice().model_copy(update={"unturned": self._unturned})
            self.run = MotionRun(self._bundle, choice)
        except ValueError as error:
            self.controls.bar.say(in_words(error)[0], bad=True)
            return
        self._ticks = self._told = 0
        self.controls.bar.say("")
        self._show_phase()
        self._tick.start()

    def _forget_run(self) -> None:
        """Forget what has run: nothing that is shown may be of it any more."""
        if self.run is not None:
            self.run.close()
        self.run, self._stopping = None, False
        self.controls.show_changes(())

    def stop(self) -> None:
        """Have the probe go back."""
        if self.run is not None and self.run.running:
            self._stopping = True
            self.run.stop()
            self._show_phase()

    def _show(self) -> None:
        run = self.run
        if run is None or self._closed:
            return
        over = not run.running  # first: what comes after it is seen below
        beginning, frame = run.beginning, run.newest
        if beginning is not None and frame is not None:
            self._ticks += 1
            self.picture.show_frame(beginning, frame)
            if not over:
                self._show_phase()
            changes = run.changes
            if len(changes) != self._told:
                self._told = len(changes)
                self.controls.show_changes(changes)
            if over or self._ticks % _CHARTS_EVERY == 1:
                self.picture.show_course(run.course(_SPAN_S), beginning.wanted_N)
        if over:
            self._over(run)

    def _over(self, run: MotionRun) -> None:
        self._tick.stop()
        self._show_phase()
        outcome = run.outcome
        if outcome is None:
            self.controls.bar.say(run.failure, bad=True)
        elif outcome["faults"]:
            self.controls.bar.say(join(" ", outcome["faults"]), bad=True)
        else:
            self.controls.bar.say(self._summary(outcome))

    def _summary(self, outcome: dict[str, Any]) -> str:
        low, high = outcome["force_N"]
        within, out = outcome["angle_error_deg"]
        return filled(
            self.tr(
                "Tracked for {seconds:.0f} s at {low:.1f} to {high:.1f} N; mean angle error {within:.1f}°"
                " along the face and {out:.1f}° across it."
            ),
            seconds=outcome["tracked_s"],
            low=low,
            high=high,
            within=within,
            out=out,
        )

    # ---- work and end ------------------------------------------------------------------------------

    def _begin_work(self) -> None:
        self._busy = True
        self.controls.bar.say("")
        self._show_phase()

    def _failed(self, error: BaseException) -> None:
        self._busy = False
        self.controls.bar.say(in_words(error)[0], bad=True)
        self._show_phase()

    def close_window(self) -> None:
        """End what runs and give the scene back; it is of no use afterwards."""
        if self._closed:
            return
        self._closed = True
        self._tick.stop()
        if self.run is not None:
            self.run.close()
        self.picture.scene.close_scene()
        self.jobs.let_go()
        self.jobs.wait(_PATIENCE_S)
        self._made.cleanup()

    def closeEvent(self, event: QCloseEvent) -> None:
        """Close for good."""
        self.close_window()
        super().closeEvent(event)


# ---- the scene and the charts of a closed loop ---------------------------------------------------


_SPAN_S = 20.0
_CHARTS_PX = 90  # at the least
_MIDDLE, _NEARER = 0.45, 0.75  # of the probe's size, of the whole view


class Picture(QWidget):
    """Phantom, probe, contact and force in the world, and force and angle over time."""

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.scene = Scene(self)
        self.force = Pane(Curves(self.tr("Force"), (self.tr("force"), self.tr("target")), "N", 2, 1.0))
        names = (self.tr("angle along the face"), self.tr("across the face"))
        self.angle = Pane(Curves(self.tr("Angle to the phantom"), names, "°", 2, 2.0, 2))
        for pane in (self.force, self.angle):
            pane.setMinimumHeight(_CHARTS_PX)
        charts = beside(None, (self.force, 1), (self.angle, 1), margins=(6, 4, 6, 4), space=4)
        column(self, (self.scene, 3), (charts, 1), space=0)  # of a large screen, they use their share

    def show_probe(self, probe: Probe) -> None:
        """Show a probe, pointing down as it is held."""
        self.scene.show_probe(probe)
        self._clear()
        self.scene.show_orientation(np.diag([1.0, -1.0, -1.0]))
        self.scene.look("fit")
        position, focal, up, (scale, perspective, _) = self.scene.camera()
        # The middle of the tool in the middle of the view, instead of the sensor that it hangs on.
        down = np.array([0.0, 0.0, -_MIDDLE * probe.size])
        nearer = (_NEARER * scale, perspective, 0.0)
        self.scene.set_camera((triple(position + down), triple(focal + down), up, nearer))

    def show_frame(self, beginning: Beginning, frame: LoopFrame) -> None:
        """Show a period."""
        from contactbench.pipeline.workbench.motion import placed

        where = placed(beginning, frame)
        self.scene.show_orientation(where.R_WS, where.p_WS_W)
        self.scene.show_phantom(where.phantom_S, where.normal_S)
        point = None if frame.point_S_m is None else np.array(frame.point_S_m)
        force = None if frame.force_S_N is None else np.array(frame.force_S_N)
        self.scene.show_contact(point)
        # Without a place the force is none: what a sensor reads in the air is noise.
        self.scene.show_force(None if point is None else force, point)

    def show_course(self, course: Course, wanted: float) -> None:
        """Show the charts."""
        newest = course.times[-1] if len(course.times) else 0.0
        times = course.times - newest
        forces = np.column_stack([course.forces, np.full(len(times), wanted)])
        self.force.show_data(times, forces, -_SPAN_S, 0.0)
        self.angle.show_data(times, course.angles, -_SPAN_S, 0.0)

    def _clear(self) -> None:
        self.scene.show_phantom(None)
        self.scene.show_contact(None)
        self.scene.show_force(None)
        nothing = np.empty(0)
        for pane in (self.force, self.angle):
            pane.show_data(nothing, np.empty((0, 2)), -_SPAN_S, 0.0)

    def changeEvent(self, event: QEvent) -> None:
        """Take the colours of another theme."""
        super().changeEvent(event)
        if event.type() == QEvent.Type.PaletteChange and hasattr(self, "angle"):
            self.scene.set_dark(is_dark())
            for pane in (self.force, self.angle):
                pane.dress()
