"""The window in which a closed loop is watched: what is run, what the controller does, and what has happened."""

from __future__ import annotations

import math
import tempfile
from enum import Enum, auto
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from PySide6.QtCore import QEvent, QTimer, Signal
from PySide6.QtWidgets import QFrame, QWidget

from contactbench.app.errors import in_words
from contactbench.app.help_book import HelpBook
from contactbench.app.jobs import Jobs
from contactbench.pipeline.errors import join
from contactbench.widgets.action_bar import ActionBar
from contactbench.widgets.controls import (
    STYLED,
    FoldRow,
    PanelScroll,
    accent,
    add_key,
    asked_file,
    beside,
    choice,
    column,
    form,
    named,
    panel,
    plain_label,
    push_button,
    row,
    sentence_label,
)
from contactbench.widgets.messages import NumberBox, filled, translated
from contactbench.widgets.scene import Scene
from contactbench.widgets.scene.views import triple
from contactbench.widgets.strip_chart_pane import Curves, Pane
from contactbench.widgets.theme import is_dark

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from PySide6.QtGui import QCloseEvent

    from contactbench.app.bench import Bench
    from contactbench.pipeline.config.runtime import RuntimeConfig
    from contactbench.pipeline.control.frames import Beginning, LoopFrame
    from contactbench.pipeline.mesh import Probe
    from contactbench.pipeline.session import Session
    from contactbench.pipeline.workbench.motion import Course, MotionChange, MotionChoice, MotionRun

_WIDTH_PX = (320, 420)
_PACE_PX = 34  # two lines
_DOES_PX = 40  # two lines
_REAL = 0.9  # of real time: what is less is seen
_PERIODS_S = (20.0, 10.0, 5.0, 2.0)
_SHOWN = 6  # changes
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


class MotionPhase(Enum):
    """How a closed loop stands: the one thing that decides what can be pressed, and what is said of it."""

    EMPTY = auto()  # no bundle is chosen
    OPENING = auto()  # a bundle is being made or read
    READY = auto()
    STARTING = auto()  # the virtual robot is being made
    RUNNING = auto()
    STOPPING = auto()  # it was asked to go back
    ENDED = auto()
    FAILED = auto()  # it ended without an outcome

    @property
    def going_on(self) -> bool:
        """Whether a robot is there."""
        return self in (MotionPhase.STARTING, MotionPhase.RUNNING, MotionPhase.STOPPING)


class MotionControls(QWidget):
    """The panel on the right of the window."""

    asked_start = Signal()
    asked_stop = Signal()

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.robot = choice(
            ((self.tr("Elfin3 arm"), "virtual://arm"), (self.tr("stiff mount"), "virtual://platform")),
            self.tr("Robot"),
            tip=self.tr("Both are simulated; no real hardware moves."),
        )
        self.motion = choice(
            (
                (self.tr("rocks along the face"), "in-plane"),
                (self.tr("rocks across the face"), "out-of-plane"),
                (self.tr("moves up and down"), "vertical"),
                (self.tr("at rest"), "none"),
            ),
            self.tr("Phantom"),
            tip=self.tr("Motion of the soft phantom under the probe."),
        )
        self.period = choice(
            [(filled(self.tr("{seconds:g} s"), seconds=each), each) for each in _PERIODS_S],
            self.tr("Period"),
            tip=self.tr("Period T of the phantom's motion."),
        )
        self.period.setCurrentIndex(_PERIODS_S.index(10.0))
        self.variant = choice(
            (
                (self.tr("from the bundle"), None),
                (self.tr("predictive"), "aware"),
                (self.tr("basic"), "plain"),
            ),
            self.tr("Control"),
            tip=self.tr(
                "Predictive: estimates the phantom's motion and leads it. Basic: force and position only."
            ),
        )
        self.size_of = NumberBox(decimals=0, minimum=0.0, maximum=20.0, value=10.0)
        tip = self.tr("Amplitude of the phantom's motion to each side.")
        named(self.size_of, self.tr("Amplitude"), tip=tip)
        self.bar, self.bundle = ActionBar(), sentence_label(role="muted")
        self.state, self.does = plain_label("", "title"), sentence_label()
        self.does.setMinimumHeight(_DOES_PX)  # the panel must not jump
        self.force, self.angle = plain_label("", "number"), plain_label("", "number")
        self.happened = sentence_label(role="muted")
        self.state.setAccessibleName(self.tr("Controller state"))
        self.force.setAccessibleName(self.tr("Force"))
        self.angle.setAccessibleName(self.tr("Angle to the phantom"))
        self.pace = sentence_label(role="muted")  # in one line it would be wider than the panel
        self.pace.setMinimumHeight(_PACE_PX)
        tip = self.tr(
            "How fast its time goes, against the clock: 1.00 is real time. Measured over the last frames."
        )
        self.pace.setToolTip(tip)
        tip = self.tr("Use a bundle of the open session in its current state.")
        self.of_session = push_button(self.tr("Use session"), None, "folder", tip=tip)
        tip = self.tr("An exported folder or zip file.")
        self.other = push_button(self.tr("Open bundle"), None, "folder", tip=tip)
        self.start, self.stop = self.bar.primary, self.bar.second
        self._lay_out()
        self._connect()
        self.show_phase(MotionPhase.EMPTY)

    def _lay_out(self) -> None:
        rows = form(space=4)
        for box in (self.robot, self.motion, self.size_of, self.period, self.variant):
            rows.addRow(box.accessibleName(), box)
        title, bundles = plain_label(self.tr("Motion control"), "title"), _even(self.of_session, self.other)
        parts = (title, bundles, self.bundle, rows, self._card(), self.happened)
        column(self, (PanelScroll(panel(*parts, 1, margins=(12, 10, 12, 8))), 1), self.bar, space=0)
        self.setMinimumWidth(_WIDTH_PX[0])
        self.setMaximumWidth(_WIDTH_PX[1])

    def _card(self) -> QFrame:
        card = QFrame()
        card.setProperty("role", "card")
        numbers = _even(self.force, self.angle)
        captions = (
            plain_label(each, "muted") for each in (self.tr("force"), self.tr("angle to the phantom"))
        )
        column(card, self.state, self.does, numbers, _even(*captions), self.pace, margins=STYLED, space=2)
        return card

    def _connect(self) -> None:
        self.motion.currentIndexChanged.connect(lambda _index: self._show_size())
        self._show_size()

    def _show_size(self) -> None:
        motion = self.motion.currentData()
        self.size_of.setSuffix(self.tr(" mm") if motion == "vertical" else self.tr("°"))
        for box in (self.size_of, self.period):
            box.setEnabled(motion != "none" and self.motion.isEnabled())

    # ---- what is chosen ----------------------------------------------------------------------------

    def choice(self) -> MotionChoice:
        """Return what is chosen."""
        from contactbench.pipeline.workbench.motion import MotionChoice

        return MotionChoice(
            robot=self.robot.currentData(),
            motion=self.motion.currentData(),
            period=self.period.currentData(),
            size=self.size_of.value(),
            variant=self.variant.currentData(),
        )

    # ---- what is shown -----------------------------------------------------------------------------

    def show_phase(
        self, phase: MotionPhase, frame: LoopFrame | None = None, pace: float | None = None
    ) -> None:
        """Show how it stands; `frame`: the newest, of what runs or has ended."""
        name, does = self._words().get(self._key(phase, frame), ("", ""))
        self.state.setText(name)
        self.does.setText(does)
        live = frame is not None and phase in (MotionPhase.RUNNING, MotionPhase.STOPPING)
        self._show_numbers(frame if live else None, pace if live else None)
        for each in (self.robot, self.motion, self.variant, self.of_session, self.other):
            each.setEnabled(not phase.going_on and phase is not MotionPhase.OPENING)
        self._show_size()
        self.bar.offer(
            self.tr("Start"),
            self.asked_start.emit,
            enabled=phase in (MotionPhase.READY, MotionPhase.ENDED, MotionPhase.FAILED),
            accented=not phase.going_on,
            picture="play",
        )
        can_stop = phase in (MotionPhase.STARTING, MotionPhase.RUNNING)
        tip = self.tr("Retract the probe and stop (Esc).")
        self.bar.offer_second(self.tr("Stop"), self.asked_stop.emit, enabled=can_stop, tip=tip)
        accent(self.stop, phase.going_on, "stop")

    def _key(self, phase: MotionPhase, frame: LoopFrame | None) -> str:
        if phase is MotionPhase.RUNNING and frame is not None:
            return frame.state
        return phase.name

    def _show_numbers(self, frame: LoopFrame | None, pace: float | None) -> None:
        if frame is None:
            self.force.setText("–")
            self.angle.setText("–")
        else:
            largest = max(abs(math.degrees(each)) for each in frame.angles_rad)
            self.force.setText(filled(self.tr("{:z.1f} N"), frame.force_N))
            self.angle.setText(filled(self.tr("{:.1f}°"), largest))
        if pace is None:
            self.pace.setText(self.tr("Pace: –"))
            return
        words = self.tr("Pace: {pace:.2f} of real time")
        if pace <= _REAL:
            words = self.tr("Pace: {pace:.2f} of real time: this computer is too slow")
        self.pace.setText(filled(words, pace=pace))

    def show_changes(self, changes: Sequence[MotionChange]) -> None:
        """Show the newest changes of state, newest first."""
        names = {key: name for key, (name, _) in self._words().items()}
        lines = [
            filled(
                self.tr("{time:.1f} s  {state}: {why}"),
                time=each.time_s,
                state=names.get(each.state, each.state),
                why=translated(each.reason),
            )
            for each in reversed(changes[-_SHOWN:])
        ]
        self.happened.setText("\n".join(lines))

    def _words(self) -> dict[str, tuple[str, str]]:
        return {
            "approach": (self.tr("Approaching"), self.tr("The probe is slowly approaching the phantom.")),
            "contact": (self.tr("In contact"), self.tr("The force rises, then the stiffness is estimated.")),
            "track": (self.tr("Tracking"), self.tr("Keeps its force and stays perpendicular.")),
            "hold": (self.tr("Holding"), self.tr("Waiting until the readings are reliable again.")),
            "retract": (self.tr("Retracting"), self.tr("The probe is leaving the phantom.")),
            "safe": (self.tr("Stopped"), self.tr("Nothing moves any more; it is about to end.")),
            "EMPTY": (self.tr("No bundle"), self.tr("Choose the bundle that is to be run.")),
            "OPENING": (self.tr("Opening the bundle"), ""),
            "READY": (self.tr("Ready"), self.tr("Nothing moves until you press Start.")),
            "STARTING": (self.tr("Starting"), self.tr("The virtual robot is being made.")),
            "STOPPING": (self.tr("Stopping"), self.tr("The probe leaves the phantom, then stands still.")),
            "ENDED": (self.tr("Ended"), self.tr("The probe stands still; nothing moves any more.")),
            "FAILED": (self.tr("Failed"), self.tr("Nothing moves any more; the message says why.")),
        }


def _even(*widgets: QWidget) -> FoldRow:
    return row(*((each, 1) for each in widgets))
