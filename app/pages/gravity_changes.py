"""What is changed of a gravity calibration: poses left out, parameters that mend a finding; all can be undone."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from PySide6.QtCore import QObject

from contactbench.app.bench import Weight
from contactbench.app.pages.gravity_run import GravityRun, Phase
from contactbench.app.pages.gravity_undo import Confirm, LeaveOut
from contactbench.pipeline.workbench import gravity_results as results
from contactbench.pipeline.workbench.gravity_fit import DOWN, INVERSE, MOUNT, ORIENTATION_NOISE, TILT
from contactbench.pipeline.workbench.gravity_poses import PoseState

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from contactbench.pipeline.session import Session
    from contactbench.pipeline.workbench.gravity_fit import Finding
    from contactbench.pipeline.workbench.gravity_poses import PoseRow
    from contactbench.pipeline.workbench.gravity_results import Outcome

_BEFORE: dict[str, Any] = {  # where nothing was set
    MOUNT: [0.0, 0.0, 0.0],
    INVERSE: False,
    TILT: 180.0,
    DOWN: [0.0, 0.0, -1.0],
    ORIENTATION_NOISE: None,
}


class GravityChanges(QObject):
    """
    Changes of a run, or of its result.

    Parameters
    ----------
    run : GravityRun
    """

    def __init__(self, run: GravityRun) -> None:
        super().__init__(run)
        self._run = run
        run.finished.connect(self.reopen)

    # ---- poses left out ----------------------------------------------------------------------------

    def leave_out(self, rows: Sequence[PoseRow], left_out: bool) -> None:
        """Leave poses out or take them back; can be undone."""
        moments = [row.time for row in rows if row.changeable]
        if not moments:
            return
        names = ", ".join(row.name for row in rows)
        text = self.tr("leave out {poses}") if left_out else self.tr("take back {poses}")
        self._run.bench.undo.push(LeaveOut(text.format(poses=names), moments, left_out, self._put_left_out))

    def _put_left_out(self, moments: Sequence[float], left_out: bool) -> None:
        if self._run.busy:
            self._run.bench.tell(
                Weight.WARNING,
                self.tr(
                    "The calibration is being computed, so no pose was changed. Do it again in a moment."
                ),
            )
            return
        if self._run.work is not None:
            self._run.work.set_left_out_at(moments, left_out)
        elif self._run.phase is Phase.IDLE and self._run.outcome is not None and self._run.outcome.changeable:
            before = set(self._run.outcome.leave_out)
            after = before | set(moments) if left_out else before - set(moments)
            self._recompute(lambda session: results.change(session, sorted(after)))
        self._run.changed.emit()

    def _recompute(self, action: Callable[[Session], Outcome]) -> None:
        self._run.be(Phase.FINISHING)

        def done(outcome: Outcome) -> None:
            self._run.be(Phase.IDLE)
            self._run.have(outcome)

        self._run.bench.do(self.tr("Computing the calibration"), action, done, self._run.idle_again)

    # ---- findings ----------------------------------------------------------------------------------

    def confirm(self, finding: Finding) -> None:
        """Do what mends a finding; can be undone."""
        if finding.leave_out:
            rows = self._run.work.view().rows if self._run.work is not None else self._rows()
            self.leave_out(self._at(rows, finding.leave_out), True)
        if finding.settings:
            self.set_parameters(finding.remedy, finding.settings)

    def _at(self, rows: Sequence[PoseRow], indices: Sequence[int]) -> list[PoseRow]:
        """Return the rows of those poses that a calibration was given, in its order."""
        counted = [row for row in rows if row.state is not PoseState.LEFT_OUT and row.R_WS is not None]
        return [counted[index] for index in indices if index < len(counted)]

    def _rows(self) -> tuple[PoseRow, ...]:
        return () if self._run.outcome is None else self._run.outcome.rows

    def set_parameters(self, text: str, new: Sequence[tuple[str, Any]]) -> None:
        """Set parameters of the session, and compute anew; can be undone."""
        known = self._run.bench.desk.state.settings
        old = [(key, known[key].value if key in known else _BEFORE[key]) for key, _ in new]
        self._run.bench.undo.push(Confirm(text, new, old, self._put_parameters))

    def _put_parameters(self, values: Sequence[tuple[str, Any]]) -> None:
        again = (
            self._run.phase is Phase.IDLE and self._run.outcome is not None and self._run.outcome.changeable
        )
        leave_out = () if self._run.outcome is None else self._run.outcome.leave_out

        def put(session: Session) -> Outcome | None:
            for key, value in values:
                session.set_parameter(key, value)
            computed = again and any(key != TILT for key, _ in values)
            return results.change(session, leave_out) if computed else None

        def done(outcome: Outcome | None) -> None:
            settings = self._run.settings()
            if self._run.work is not None and settings is not None:
                self._run.work.apply(settings)
            if outcome is not None:
                self._run.have(outcome)
            if self._run.work is None:
                self.reopen()
            self._run.changed.emit()

        self._run.bench.do(self.tr("Setting the parameters"), put, done, self._run.fail)

    def reopen(self) -> None:
        """Open the devices with the mount that the session has now, if they have another."""
        settings, live, pair = self._run.settings(), self._run.bench.live, self._run.bench.live.pair
        if settings is None or pair is None or np.allclose(live.R_ES, settings.R_ES):
            return
        sensor = str(pair.sensor.address)
        poses = None if pair.poses is None else str(pair.poses.address)
        self._run.bench.jobs.start(
            self.tr("Opening the devices with the new mount"),
            lambda _progress, _cancelled: live.open(sensor, poses, settings.R_ES),
            None,
            self._run.fail,
        )
