"""What the two buttons of the gravity page do, by how its run stands."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from PySide6.QtCore import QObject

from contactbench.app.pages.gravity_run import GravityRun, Phase
from contactbench.pipeline.calibration import Level
from contactbench.pipeline.workbench.steps import Step

if TYPE_CHECKING:
    from collections.abc import Callable


class Choice(NamedTuple):
    """A button's text, and what it does."""

    text: str
    do: Callable[[], None]


class GravityChoices(QObject):
    """
    Says what can be done now.

    Parameters
    ----------
    run : GravityRun
    """

    def __init__(self, run: GravityRun) -> None:
        super().__init__(run)
        self._run = run

    def now(self) -> tuple[Choice, Choice | None]:
        """Return the primary choice, and another if there is one."""
        run = self._run
        stop = Choice(self.tr("Stop"), run.stop)
        match run.phase:
            case Phase.STARTING:
                return Choice(self.tr("Beginning..."), lambda: None), None
            case Phase.CAPTURING:
                return Choice(self.tr("Finish"), run.finish), stop
            case Phase.FINISHING:
                return Choice(self.tr("Computing..."), lambda: None), None
            case Phase.CHECKING:
                return Choice(self.tr("Waiting for a still pose..."), lambda: None), stop
            case _:
                return self._idle()

    def _idle(self) -> tuple[Choice, Choice | None]:
        run, outcome = self._run, self._run.outcome
        anew = Choice(self.tr("Start anew"), lambda: run.start(""))
        if left := run.left_behind:
            return Choice(
                self.tr("Go on with {recording}").format(recording=left), lambda: run.start(left)
            ), anew
        if outcome is None:
            return Choice(self.tr("Start"), lambda: run.start("")), None
        add = (
            Choice(self.tr("Add poses"), lambda: run.start(outcome.recording)) if outcome.changeable else anew
        )
        if outcome.calibration.verdict.level is Level.REFUSE:
            return add, anew if outcome.changeable else None
        check = Choice(self.tr("Check one more pose"), run.begin_check)
        if run.checked is not None and run.checked.passed:
            go_on = Choice(self.tr("Go on: Probe"), lambda: run.bench.go_to.emit(Step.PROBE))
            return go_on, add if outcome.calibration.verdict.level is Level.USABLE else check
        return check, add
