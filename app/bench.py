"""What every page works with: a session, its devices, the scene, and long work."""

from __future__ import annotations

import re
from dataclasses import dataclass
from enum import StrEnum
from typing import TYPE_CHECKING, Any, ClassVar

from PySide6.QtCore import QObject, Signal
from PySide6.QtGui import QUndoStack
from PySide6.QtWidgets import QWidget

from contactbench.app.jobs import Jobs
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.steps import Step, StepStatus
from contactbench.widgets.action_bar import ActionBar
from contactbench.widgets.controls import column
from contactbench.widgets.glance import Glance
from contactbench.widgets.messages import translated
from contactbench.widgets.theme import state_colour

if TYPE_CHECKING:
    from collections.abc import Callable

    from contactbench.pipeline.session import Session
    from contactbench.pipeline.workbench.desk import Desk
    from contactbench.widgets.scene import Scene

# ---- what every page works with ------------------------------------------------------------------


_PATIENCE_S = 30.0
_DIGITS = re.compile(r"\d+")


class Weight(StrEnum):
    """How much a message matters."""

    INFO = "info"
    GOOD = "good"
    WARNING = "warning"
    ERROR = "error"


@dataclass(frozen=True)
class Notice:
    """Something to tell."""

    weight: Weight
    text: str  # What happened, why it matters, what to do
    details: str = ""  # For who asks, such as a stack trace
    over: bool = False  # Whether what was told before is over: it is seen in the place of that


class Bench(QObject):
    """
    One session in a window.

    Attributes
    ----------
    desk : Desk
    live : Live
    scene : Scene
    jobs : Jobs
    undo : QUndoStack
        Everything that can be undone goes through it.
    running : set of Step
        Steps in which something goes on.
    failed : dict of Step to str
        Steps whose last work failed, and why; see `set_failed`.
    trouble : SessionTrouble
        What is wrong with the session just now.
    ending : bool
        It is being closed: nothing may be begun any more.
    """

    changed = Signal()  # the session's state; in the GUI thread
    told = Signal(object)  # Message
    over = Signal(str)  # Why a step failed, once it is tried again or went well
    go_to = Signal(object)  # Step that a page wants to be shown
    paint_asked = Signal(object)  # PaintRequest, for the page with the regions
    page_wanted = Signal()  # something must be typed: the page itself has to be seen
    mended = Signal()  # the disk takes writes again: what is not kept yet can be
    _stirred = Signal()

    def __init__(self, desk: Desk, scene: Scene, parent: QObject | None = None) -> None:
        super().__init__(parent)
        # Here, not above: it brings half of scipy, for which a window without a session need not wait.
        from contactbench.pipeline.session.why import NO_TROUBLE
        from contactbench.pipeline.workbench.live import Live

        self.desk, self.scene = desk, scene
        self.live = Live()
        self.jobs = Jobs(self)
        self.undo = QUndoStack(self)
        self.running: set[Step] = set()
        self.failed: dict[Step, str] = {}
        self.trouble = NO_TROUBLE
        self._stirred.connect(self.changed)  # from the desk's thread into this one
        self._end = desk.subscribe(self._stirred.emit)
        self.ending = False

    def tell(self, weight: Weight, text: str, details: str = "") -> None:
        """Put a message into the list."""
        self.told.emit(Notice(weight, text, details))

    def tell_over(self, text: str) -> None:
        """Put into the list that what was wrong is well again."""
        self.told.emit(Notice(Weight.GOOD, text, over=True))

    def tell_findings(
        self, before: tuple[str, ...], now: tuple[str, ...], *, recorded: bool = False
    ) -> tuple[str, ...]:
        """
        Tell what is wrong with devices and disk now, and what is not any more; returns the former as it was told.

        Another rate is no other finding: the sentence that was told stands until it ends.
        """
        told = {_DIGITS.sub("", each): each for each in before}
        stand = [told.get(_DIGITS.sub("", each), each) for each in now]
        for sentence in stand:
            if sentence not in before:
                self.tell(Weight.WARNING, sentence)
        for sentence in before:
            if sentence not in stand:
                self.over.emit(sentence)
        if before and not now and recorded:
            self.tell_over(self.tr("All devices are sending samples again. Recording continues."))
        return tuple(stand)

    def tell_error(self, error: BaseException, weight: Weight = Weight.ERROR) -> None:
        """Put into the list why something was refused; what nobody expected is raised, for the hook."""
        if not isinstance(error, InputError):
            raise error
        self.tell(weight, str(error))

    def do(
        self,
        title: str,
        action: Callable[[Session], Any],
        done: Callable[[Any], None] | None = None,
        failed: Callable[[BaseException], None] | None = None,
    ) -> None:
        """Have something done with the session; as `Jobs.start`, but in the desk's order."""
        self.jobs.follow(title, self.desk.do(action), done, failed)

    def set_running(self, step: Step, going_on: bool) -> None:
        """Say whether something goes on in a step."""
        before = set(self.running)
        if going_on and step not in before:
            self.set_failed(step, "")
        (self.running.add if going_on else self.running.discard)(step)
        if self.running != before:
            self.changed.emit()

    def set_failed(self, step: Step, sentence: str) -> None:
        """Say that the last work of a step failed, and why; an empty sentence: it did not."""
        before = self.failed.pop(step, "")
        if sentence:
            self.failed[step] = sentence
        if sentence != before:
            self.over.emit(before)
            self.changed.emit()

    @property
    def connected(self) -> bool:
        """Whether samples come."""
        from contactbench.pipeline.devices.stream import StreamState

        health = self.live.health
        return health is not None and health[0].state is StreamState.STREAMING

    def let_go(self) -> None:
        """Begin to end it all: nothing is told any more, and what can be stopped is asked to."""
        if not self.ending:
            self._end()
        self.ending = True
        self.jobs.let_go()

    def end(self) -> None:
        """End it all; waits for devices, workers and the disk, so call it in a worker, after `let_go`."""
        self.live.close()
        self.jobs.wait(_PATIENCE_S)
        self.desk.close()

    def close(self) -> None:
        """End it all, and wait for it."""
        self.let_go()
        self.end()
        self.forget()

    def forget(self) -> None:
        """Let go of what could be undone: a collector that finds stack and commands as garbage may end both twice."""
        self.undo.clear()


# ---- what every step's page is -------------------------------------------------------------------


class Page(QWidget):
    """
    The controls of one step, on the right of the window: what `fill` put there, above what to do next.

    Attributes
    ----------
    step : Step
        Of the class.
    bar : ActionBar
        At the foot, at the same place on every page.
    """

    step: ClassVar[Step]

    def __init__(self, bench: Bench, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.bench = bench
        self.bar = ActionBar()
        self._foot = column(self, 0, self.bar, space=0)

    def fill(self, body: QWidget) -> None:
        """Put what the page is made of above its foot."""
        self._foot.takeAt(0)
        self._foot.insertWidget(0, body, 1)

    def enter(self) -> None:
        """Be shown: set the scene up as this step needs it, and begin to follow what is live."""

    def leave(self) -> None:
        """Be hidden: end what only this page needs; what runs goes on."""

    def show_state(self, status: StepStatus) -> None:
        """Show how the step stands; called whenever the session or that changed."""

    def glance(self, status: StepStatus) -> Glance:
        """Return what matters just now, for bench mode; `status`: how the step stands."""
        words = self.bar.words or translated(status.sentence)
        return Glance(translated(status.state), words, role=state_colour(status.state))

    def tick(self) -> None:
        """Show the newest of what is live; called 30 times a second while the page is shown."""

    def watch(self) -> None:
        """See what goes on, and tell what somebody should know; called twice a second, shown or not."""

    def close_page(self) -> None:
        """End everything: the session is being closed."""
