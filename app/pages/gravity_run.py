"""A gravity calibration from start to result, and what is changed of it: what the page's buttons do."""

from collections.abc import Callable, Sequence
from enum import StrEnum
from typing import Any

import numpy as np
from PySide6.QtCore import QObject, Signal

from contactbench.app.bench import Bench, Weight
from contactbench.app.undo import Exchange, push_done
from contactbench.pipeline.calibration import Level, PoseSample
from contactbench.pipeline.calibration.verify import StillVerification
from contactbench.pipeline.errors import InputError, join
from contactbench.pipeline.session import Session
from contactbench.pipeline.steps import Step
from contactbench.pipeline.workbench import gravity_fit as results
from contactbench.pipeline.workbench.gravity import GravityCheck, GravityWork
from contactbench.pipeline.workbench.gravity_fit import (
    DOWN,
    INVERSE,
    MOUNT,
    ORIENTATION_NOISE,
    TILT,
    GravityFinding,
    GravityOutcome,
    GravitySettings,
    PoseRow,
    PoseState,
    gravity_settings,
)
from contactbench.pipeline.workbench.live import follows
from contactbench.pipeline.workbench.tape import SessionTape
from contactbench.pipeline.workbench.undo_history import Deed
from contactbench.widgets.messages import translated

_BEFORE: dict[str, Any] = {  # where nothing was set
    MOUNT: [0.0, 0.0, 0.0],
    INVERSE: False,
    TILT: 180.0,
    DOWN: [0.0, 0.0, -1.0],
    ORIENTATION_NOISE: None,
}


class Phase(StrEnum):
    """What goes on."""

    IDLE = "idle"
    STARTING = "starting"
    CAPTURING = "capturing"
    FINISHING = "finishing"
    CHECKING = "checking"


class GravityRun(QObject):
    """
    The run of a bench's gravity step; everything in it happens in the GUI thread but what is handed to jobs.

    Attributes
    ----------
    phase : Phase
    work : GravityWork or None
        While captures are made.
    check : GravityCheck or None
        While the held-out pose is waited for.
    outcome : GravityOutcome or None
        What the session has.
    checked : StillVerification or None
        Of the outcome.
    problem : str
        Why the last thing did not work, in words.
    """

    changed = Signal()

    def __init__(self, bench: Bench, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self.bench = bench
        self.phase = Phase.IDLE
        self.work: GravityWork | None = None
        self.check: GravityCheck | None = None
        self.outcome: GravityOutcome | None = None
        self.checked: StillVerification | None = None
        self.problem = ""
        self.automatic = True
        self._tape: SessionTape | None = None
        self._earlier: str | None = None
        self._compared: tuple[PoseSample, ...] = ()
        self._end_following: Callable[[], None] = lambda: None
        self._read = (-1, 0)
        self._wanted: str | None = None  # to begin once there are devices; as in `start`
        self._said: tuple[str, ...] = ()
        self._found: set[str] = set()  # of this run: told once

    # ---- what the session has ----------------------------------------------------------------------

    def settings(self) -> GravitySettings | None:
        """Return how this session calibrates; None, and a message: its parameters make no sense."""
        try:
            return gravity_settings(self.bench.desk.state)
        except InputError as error:
            self.fail(error)
            return None

    def reload(self) -> None:
        """Read the session's calibration, if it changed."""
        state, key = self.bench.desk.state, self._known()
        if key == self._read or self.phase is Phase.FINISHING:
            return
        self._read = key
        folder = self.bench.desk.folder

        def came(outcome: GravityOutcome | None) -> None:
            if self._known() == key:
                self.set_outcome(outcome)
            else:  # something was done or undone while it was read
                self._read = (-1, 0)
                self.reload()

        self.bench.jobs.start(
            self.tr("Loading calibration"), lambda *_: results.outcome_of(folder, state), came, self.fail
        )

    def _known(self) -> tuple[int, int]:
        """Return what tells one state of the session's calibrations from another."""
        found = [each for each in self.bench.desk.state.results if each.action.kind == "calibration"]
        return max((each.number for each in found), default=0), sum(len(each.marks) for each in found)

    def set_outcome(self, outcome: GravityOutcome | None) -> None:
        """Take what the session has now."""
        self.outcome, self.checked, self._compared = outcome, None, ()
        self._tell_found(() if outcome is None else outcome.findings)
        self._read = self._known()
        model = (
            None
            if outcome is None or outcome.calibration.verdict.level is Level.REFUSE
            else outcome.calibration.model
        )
        follow = follows(self.bench.desk.state)
        self.bench.jobs.start(
            self.tr("Compensating readings"), lambda *_: self.bench.live.set_model(model, follow=follow)
        )
        self.changed.emit()

    @property
    def left_behind(self) -> str:
        """Name of a recording that can be gone on from; empty: none."""
        found = results.interrupted(self.bench.desk.state)
        return "" if found is None or self.phase is not Phase.IDLE else found.name

    # ---- captures ----------------------------------------------------------------------------------

    def start(self, earlier: str = "") -> None:
        """Begin to capture; `earlier`: go on from the poses of that recording."""
        settings = self.settings()
        if self.phase is not Phase.IDLE or settings is None or self._waits(earlier) or not self._ready():
            return
        self.set_phase(Phase.STARTING)
        desk, live = self.bench.desk, self.bench.live
        name = results.next_name(desk.state, desk.folder)

        def begin(
            _progress: object, _cancelled: object
        ) -> tuple[SessionTape, tuple[str, tuple[PoseSample, ...]]]:
            before: tuple[str, tuple[PoseSample, ...]] = ("", ())
            if earlier:
                before = desk.do(lambda session: results.take_up(session, earlier)).result()
            return SessionTape.start(desk, live, name).result(), before

        def begun(made: tuple[SessionTape, tuple[str, tuple[PoseSample, ...]]]) -> None:
            tape, (part, poses) = made
            self._tape, self._earlier = tape, part or None
            self.work = GravityWork(settings, live_R_ES=live.R_ES, earlier=poses, automatic=self.automatic)
            self._end_following = live.follow(self.work.feed)
            self.set_phase(Phase.CAPTURING)

        self.bench.jobs.start(self.tr("Starting recording"), begin, begun, self.idle_again)

    def _waits(self, earlier: str) -> bool:
        """Tell whether the devices are still being opened; then it begins once they are."""
        waits = self.bench.live.pair is None and self.bench.live.opening
        self._wanted = earlier if waits else None
        if waits:
            self.problem = ""
            self.bench.tell(
                Weight.INFO, self.tr("Opening devices. The first pose can be captured afterwards.")
            )
        return waits

    def _ready(self) -> bool:
        """Tell whether there is something to record from; a message says what is missing."""
        pair = self.bench.live.pair
        if pair is None:
            self.problem = self.tr("No device is open. Choose and open a sensor under Devices first.")
        elif pair.poses is None:
            self.problem = self.tr(
                "No pose source. The sensor's orientation is needed to separate the weight from the"
                " sensor offset. Choose a robot, a pose file or the virtual bench under Devices."
            )
        else:
            self.problem = ""
            return True
        self.bench.tell(Weight.WARNING, self.problem)
        self.changed.emit()
        return False

    def set_automatic(self, automatic: bool) -> None:
        """Choose whether each still pose is taken."""
        self.automatic = automatic
        if self.work is not None:
            self.work.set_automatic(automatic)
        self.changed.emit()

    def take(self) -> str:
        """Take the present pose; returns what that means."""
        return self.work.take() if self.work is not None else ""

    def finish(self) -> None:
        """End the captures, and have the session compute from its recording."""
        work, tape, earlier = self.work, self._tape, self._earlier
        if self.phase is not Phase.CAPTURING or work is None or tape is None:
            return
        self._end_following()
        self.set_phase(Phase.FINISHING)
        desk, deed = self.bench.desk, Deed(self.tr("calibrate gravity"))

        def compute(_progress: object, _cancelled: object) -> GravityOutcome:
            tape.keep().result()
            work.finish()
            left = work.left_out
            return desk.do(
                deed.around(lambda session: results.finish(session, tape.name, left, earlier))
            ).result()

        def done(outcome: GravityOutcome) -> None:
            self._end_work()
            self.set_phase(Phase.IDLE)
            self.set_outcome(outcome)
            push_done(self.bench, deed)
            verdict = outcome.calibration.verdict
            weight = {Level.GOOD: Weight.GOOD, Level.USABLE: Weight.WARNING, Level.REFUSE: Weight.ERROR}
            self.bench.tell(
                weight[verdict.level], self.tr("Gravity: {why}").format(why=translated(verdict.reasons[0]))
            )
            self.reopen()

        self.bench.jobs.start(self.tr("Computing calibration"), compute, done, self.idle_again)

    def stop(self) -> None:
        """End the captures; what was recorded stays in the session, and can be gone on from."""
        tape = self._tape
        if self.phase not in {Phase.CAPTURING, Phase.CHECKING} or tape is None:
            return
        self._end_following()
        self.set_phase(Phase.FINISHING)
        self.bench.jobs.start(
            self.tr("Saving recording"),
            lambda *_: tape.keep().result(),
            lambda _record: self.idle_again(None),
            self.idle_again,
        )

    def _end_work(self) -> None:
        self._end_following()
        self._end_following = lambda: None
        work, self.work, self.check, self._tape = self.work, None, None, None
        if work is not None:
            work.close()

    def idle_again(self, error: BaseException | None) -> None:
        """Be done, well or not."""
        self._end_work()
        self.set_phase(Phase.IDLE)
        if error is not None:
            self.fail(error)
        self.reload()

    # ---- the held-out pose -------------------------------------------------------------------------

    def begin_check(self) -> None:
        """Wait for one more pose that the calibration has not seen."""
        settings, outcome = self.settings(), self.outcome
        if self.phase is not Phase.IDLE or settings is None or outcome is None or not self._ready():
            return
        self.set_phase(Phase.STARTING)
        desk, live = self.bench.desk, self.bench.live
        name = results.next_name(desk.state, desk.folder, check=True)

        def begun(tape: SessionTape) -> None:
            self._tape = tape
            self.check = GravityCheck(
                outcome.calibration, settings, live_R_ES=live.R_ES, before=self._compared
            )
            self._end_following = live.follow(self.check.feed)
            self.set_phase(Phase.CHECKING)

        self.bench.jobs.start(
            self.tr("Starting recording"),
            lambda *_: SessionTape.start(desk, live, name).result(),
            begun,
            self.idle_again,
        )

    def poll(self) -> None:
        """See what came meanwhile; called at each tick, and twice a second while another page is shown."""
        if self._wanted is not None and not self.bench.live.opening:
            self.start(self._wanted)
        if self._tape is not None and self.phase in {Phase.CAPTURING, Phase.CHECKING}:
            self._said = self.bench.tell_findings(self._said, self._tape.findings, recorded=True)
            if self._tape.error:
                self._cut_short(self._tape.error)
        if self.work is not None:
            self._tell_found(self.work.solved.findings)
        if self.phase is Phase.CHECKING and self.check is not None and self.check.found is not None:
            self._set_checked(self.check.found)

    def _cut_short(self, why: str) -> None:
        """Take no more poses: what is not recorded does not count, and must not look as if it did."""
        if self.problem != why:
            self._end_following()
            self.problem = why
            self.bench.set_failed(Step.GRAVITY, why)
            self.changed.emit()

    def _tell_found(self, found: Sequence[GravityFinding]) -> None:
        """Tell of poses and conventions that are wrong: once in a run, and not by how many poses there are."""
        for finding in found:
            if finding.key not in self._found:
                self._found.add(finding.key)
                self.bench.tell(Weight.WARNING, finding.sentence)

    def _set_checked(self, found: StillVerification) -> None:
        self._end_following()
        tape = self._tape
        self.set_phase(Phase.FINISHING)
        level, compared = found.verdict.level, self.check.poses if self.check is not None else ()
        words = (
            f"The calibration was checked in a pose that it had not seen"
            f"{'' if tape is None else f' ({tape.name})'}: {level.value}. {' '.join(found.verdict.reasons)}"
        )

        def keep(_progress: object, _cancelled: object) -> None:
            if tape is not None:
                tape.keep().result()
            self.bench.desk.do(lambda session: session.note(words)).result()

        def done(_: object) -> None:
            self._compared = compared
            self.idle_again(None)
            self.checked = found
            said = {
                Level.GOOD: self.tr("The calibration was checked with a new pose and is good."),
                Level.USABLE: self.tr("The calibration was checked with a new pose and is usable."),
                Level.REFUSE: self.tr("The calibration failed the check with a new pose. Do not use it."),
            }[level]
            weight = Weight.GOOD if found.passed else Weight.ERROR
            self.bench.tell(weight, join(" ", (said, *found.verdict.reasons)))
            self.changed.emit()

        self.bench.jobs.start(self.tr("Saving check"), keep, done, self.idle_again)

    # ---- poses left out ----------------------------------------------------------------------------

    def leave_out(self, rows: Sequence[PoseRow], left_out: bool) -> None:
        """Leave poses out or take them back; can be undone."""
        moments = [row.time for row in rows if row.changeable]
        if not moments:
            return
        names = ", ".join(translated(row.name) for row in rows)
        text = self.tr("leave out {poses}") if left_out else self.tr("restore {poses}")
        before, after = ((moments, each) for each in (not left_out, left_out))
        self.bench.undo.push(
            Exchange(self.bench, text.format(poses=names), before, after, self._put_left_out)
        )

    def _put_left_out(self, wanted: tuple[Sequence[float], bool]) -> None:
        moments, left_out = wanted
        if self.busy:
            self.bench.tell(
                Weight.WARNING,
                self.tr(
                    "No pose was changed because the calibration is still being computed. Try again in a"
                    " moment."
                ),
            )
            return
        if self.work is not None:
            self.work.set_left_out(moments, left_out)
        elif self.phase is Phase.IDLE and self.outcome is not None and self.outcome.changeable:
            before = set(self.outcome.leave_out)
            after = before | set(moments) if left_out else before - set(moments)
            self._recompute(lambda session: results.change(session, sorted(after)))
        self.changed.emit()

    def _recompute(self, action: Callable[[Session], GravityOutcome]) -> None:
        self.set_phase(Phase.FINISHING)

        def done(outcome: GravityOutcome) -> None:
            self.set_phase(Phase.IDLE)
            self.set_outcome(outcome)

        self.bench.do(self.tr("Computing calibration"), action, done, self.idle_again)

    # ---- findings ----------------------------------------------------------------------------------

    def confirm(self, finding: GravityFinding) -> None:
        """Do what mends a finding; can be undone."""
        if finding.leave_out:
            rows = self.work.view().rows if self.work is not None else self._rows()
            self.leave_out(self._at(rows, finding.leave_out), True)
        if finding.settings:
            self.set_parameters(finding.remedy, finding.settings)

    def _at(self, rows: Sequence[PoseRow], indices: Sequence[int]) -> list[PoseRow]:
        """Return the rows of those poses that a calibration was given, in its order."""
        counted = [row for row in rows if row.state is not PoseState.LEFT_OUT and row.R_WS is not None]
        return [counted[index] for index in indices if index < len(counted)]

    def _rows(self) -> tuple[PoseRow, ...]:
        return () if self.outcome is None else self.outcome.rows

    def set_parameters(self, text: str, new: Sequence[tuple[str, Any]]) -> None:
        """Set parameters of the session, and compute anew; can be undone."""
        known = self.bench.desk.state.settings
        old = [(key, known[key].value if key in known else _BEFORE[key]) for key, _ in new]
        self.bench.undo.push(Exchange(self.bench, text, old, new, self._put_parameters))

    def _put_parameters(self, values: Sequence[tuple[str, Any]]) -> None:
        again = self.phase is Phase.IDLE and self.outcome is not None and self.outcome.changeable
        leave_out = () if self.outcome is None else self.outcome.leave_out

        def put(session: Session) -> GravityOutcome | None:
            for key, value in values:
                session.set_parameter(key, value)
            computed = again and any(key != TILT for key, _ in values)
            return results.change(session, leave_out) if computed else None

        def done(outcome: GravityOutcome | None) -> None:
            settings = self.settings()
            if self.work is not None and settings is not None:
                self.work.apply(settings)
            if outcome is not None:
                self.set_outcome(outcome)
            if self.work is None:
                self.reopen()
            self.changed.emit()

        self.bench.do(self.tr("Saving settings"), put, done, self.fail)

    def reopen(self) -> None:
        """Open the devices with the mount that the session has now, if they have another."""
        settings, live, pair = self.settings(), self.bench.live, self.bench.live.pair
        if settings is None or pair is None or np.allclose(live.R_ES, settings.R_ES):
            return
        sensor = str(pair.sensor.address)
        poses = None if pair.poses is None else str(pair.poses.address)
        self.bench.jobs.start(
            self.tr("Reopening devices with the new mount"),
            lambda *_: live.open(sensor, poses, settings.R_ES),
            None,
            self.fail,
        )

    # ---- of all ------------------------------------------------------------------------------------

    @property
    def busy(self) -> bool:
        """Whether something runs that must not be begun twice."""
        return self.phase in {Phase.STARTING, Phase.FINISHING}

    def close(self) -> None:
        """End it: the recording that runs is kept."""
        tape = self._tape
        running = self.phase in {Phase.CAPTURING, Phase.CHECKING}
        self._end_work()
        if running and tape is not None:
            tape.keep()  # in the desk's order: it is done before the session is closed

    def set_phase(self, phase: Phase) -> None:
        """Go over to a phase."""
        self.phase = phase
        if phase in {Phase.STARTING, Phase.IDLE}:
            self._said = self.bench.tell_findings(self._said, ())
        if phase is Phase.STARTING:
            self.problem, self._found = "", set()
        self.bench.set_running(Step.GRAVITY, phase is not Phase.IDLE)
        self.changed.emit()

    def fail(self, error: BaseException) -> None:
        """Say what did not work."""
        self.problem = str(error) if isinstance(error, InputError) else f"{type(error).__name__}: {error}"
        self.bench.tell(Weight.ERROR, self.problem)
        self.changed.emit()
