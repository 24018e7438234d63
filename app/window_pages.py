"""The pages of the open session: made when they are needed, told how their steps stand, ticked while shown."""

from __future__ import annotations

import sys
from importlib import import_module
from typing import TYPE_CHECKING

from PySide6.QtCore import QObject, Qt, QTimer, Signal
from PySide6.QtWidgets import QBoxLayout, QFrame, QLabel, QStackedWidget, QWidget

from contactbench.app.bench import Bench, Page
from contactbench.pipeline.steps import Step, StepState, StepStatus
from contactbench.widgets.controls import STYLED, beside, finish, guard_wheels, sentence_label
from contactbench.widgets.messages import translated
from contactbench.widgets.theme import Sign, state_icon

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from contactbench.pipeline.session.why import Facts

_PAUSE_MS = 150  # between pages that are made ahead: the window answers meanwhile


def page_class(step: Step) -> type[Page]:
    """Return what the page of a step is made of; imported only now, so that the window is there sooner."""
    found: type[Page] = getattr(
        import_module(f"contactbench.app.pages.{step}"), f"{step.value.capitalize()}Page"
    )
    return found


class Pages(QObject):
    """
    Six pages, one of them shown.

    Signals
    -------
    judged : Mapping of Step to StepStatus
        How the steps stand.
    complete
        All pages are made.
    """

    judged = Signal(object)
    complete = Signal()

    def __init__(self, stack: QStackedWidget, parent: QObject) -> None:
        super().__init__(parent)
        self._stack = stack
        self._bench: Bench | None = None
        self._pages: dict[Step, Page] = {}
        self._broken: set[Step] = set()
        self._facts: Facts | None = None
        self._read = -1  # after which action the facts were read
        self.step: Step | None = None
        self.statuses: Mapping[Step, StepStatus] = {}
        self._ahead = QTimer(self, interval=_PAUSE_MS, singleShot=True)
        self._ahead.timeout.connect(self._make_one_ahead)

    # ---- opened and closed -------------------------------------------------------------------------

    def open(self, bench: Bench) -> None:
        """Begin with a session."""
        self._bench, self._facts, self.step, self._read = bench, None, None, -1
        self.statuses = {}
        self.read_statuses()

    def close(self) -> None:
        """Have the pages end what they do, and keep what they were recording."""
        self._ahead.stop()
        if self.step is not None:
            self._guarded(self._pages[self.step], "leave")
        for page in self._pages.values():
            self._guarded(page, "close_page")

    def forget(self) -> None:
        """Give the pages back; their session is closed."""
        for page in self._pages.values():
            self._stack.removeWidget(page)
            page.deleteLater()
        self._pages.clear()
        self._broken.clear()
        self._bench, self.step = None, None

    # ---- shown -------------------------------------------------------------------------------------

    def first(self) -> Step:
        """Return the step with which to begin: the first that can be worked on and is not done."""
        for step, status in self.statuses.items():
            if status.state not in (StepState.DONE, StepState.LOCKED):
                return step
        return Step.DEVICES

    def make(self, step: Step) -> None:
        """Make the page of a step, and do not show it yet."""
        if self._bench is not None:
            self._page(step)

    def show(self, step: Step) -> None:
        """Show the page of a step; a locked one says what is missing."""
        if self._bench is None:
            return
        if self.step is not None and self.step is not step:
            self._guarded(self._pages[self.step], "leave")
        page = self._page(step)
        self._place(page)
        if self.step is not step:
            self.step = step
            self._broken.discard(step)
            self._stack.setCurrentWidget(page)
            self._guarded(page, "enter")
            guard_wheels(page)
            finish(page)
        self._tell_state(step)
        if not self.made:
            self._ahead.start()  # anew: never at once after a page was shown

    def tick(self) -> None:
        """Have the page that is shown show what is live."""
        if self.step is not None and self.step not in self._broken:
            page = self._pages[self.step]
            if not self._guarded(page, "tick"):  # not again 30 times a second, until it is shown anew
                self._broken.add(self.step)

    def watch(self) -> None:
        """Have all pages see what goes on, also those that are not shown."""
        for page in tuple(self._pages.values()):
            self._guarded(page, "watch")

    @property
    def current(self) -> Page | None:
        """The page that is shown."""
        return None if self.step is None else self._pages[self.step]

    @property
    def made(self) -> bool:
        """Whether all pages are there: none will be made ahead any more."""
        return len(self._pages) == len(Step) and not self._unplaced()

    # ---- how the steps stand -----------------------------------------------------------------------

    def read_statuses(self) -> None:
        """Find out how the steps stand: at once from what is known, and again when the results are read."""
        self._judge()
        bench = self._bench
        if bench is None:
            return

        from contactbench.pipeline.session.why import read_facts

        folder, state = bench.desk.folder, bench.desk.state
        if state.count == self._read:
            return
        self._read = state.count

        def came(facts: Facts) -> None:
            if self._bench is bench and self._read == state.count:
                self._facts = facts
                self._judge()

        bench.jobs.start(self.tr("Checking session"), lambda _p, _c: read_facts(folder, state), came)

    def _judge(self) -> None:
        bench = self._bench
        if bench is None:
            return

        from contactbench.pipeline.session.why import statuses

        desk = bench.desk
        self.statuses = statuses(
            desk.state, desk.stale, bench.running, bench.connected, bench.failed, self._facts, bench.trouble
        )
        self.judged.emit(self.statuses)
        if self.step is not None:
            self._tell_state(self.step)

    def _tell_state(self, step: Step) -> None:
        status = self.statuses.get(step)
        if status is not None and step in self._pages:
            page = self._pages[step]
            self._guarded(page, "show_state", status)
            show_trouble(page, status)

    # ---- made --------------------------------------------------------------------------------------

    def _page(self, step: Step) -> Page:
        if step not in self._pages:
            self._pages[step] = self._made(step)
        return self._pages[step]

    def _unplaced(self) -> list[Page]:
        return [page for page in self._pages.values() if self._stack.indexOf(page) < 0]

    def _place(self, page: Page) -> None:
        if self._stack.indexOf(page) < 0:
            self._stack.addWidget(page)
            guard_wheels(page)

    def _made(self, step: Step) -> Page:
        assert self._bench is not None  # noqa: S101 - only called while a session is open
        try:
            page = page_class(step)(self._bench)
        except Exception:  # noqa: BLE001 - one page that cannot be made leaves the other five
            sys.excepthook(*sys.exc_info())
            return _Missing(self._bench)
        return page

    def _make_one_ahead(self) -> None:
        # made in one turn, put into its place in the next: both at once are a window that hangs
        unplaced = self._unplaced()
        missing = [step for step in Step if step not in self._pages]
        if unplaced:
            self._place(unplaced[0])
        elif missing and self._bench is not None:
            self._page(missing[0])
            self._tell_state(missing[0])
        if self.made:
            self.complete.emit()
        else:
            self._ahead.start()  # a pause after each, however long it took

    def _guarded(self, page: Page, method: str, *arguments: object) -> bool:
        """Call a page; what it raises is told, and leaves the window alive."""
        call: Callable[..., None] = getattr(page, method)
        try:
            call(*arguments)
        except Exception:  # noqa: BLE001 - told by the hook, as what Qt calls itself
            sys.excepthook(*sys.exc_info())
            return False
        return True


class _Missing(Page):
    """Stands in for a page that could not be made."""

    step = Step.DEVICES

    def __init__(self, bench: Bench, parent: QWidget | None = None) -> None:
        super().__init__(bench, parent)
        words = self.tr(
            "This page could not be created. See Messages for details. The other steps still work."
        )
        self.bar.hide()
        self.fill(QLabel(words, wordWrap=True))


# ---- what is wrong with the session, on top of the page that rests on it -------------------------


_ICON_PX = 22


class TroubleNotice(QFrame):
    """A sign and a sentence: the same sentence that the list of steps and the export have."""

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setObjectName("trouble")
        self.setProperty("role", "card")
        self._sign, self.words = Sign(_ICON_PX), sentence_label(role="bad")
        self._sign.show_icon(state_icon(StepState.FAILED))
        beside(self, (self._sign, 0, Qt.AlignmentFlag.AlignTop), (self.words, 1), margins=STYLED)
        self.hide()

    def say(self, sentence: str) -> None:
        """Show a sentence; empty: nothing is wrong."""
        if sentence != self.words.text():
            self.words.setText(sentence)
            self.setAccessibleName(sentence)
        self.setVisible(bool(sentence))


def show_trouble(page: QWidget, status: StepStatus) -> None:
    """Have a page say what is wrong with what it rests on, while something is."""
    notice = page.findChild(TroubleNotice, "trouble", Qt.FindChildOption.FindDirectChildrenOnly)
    layout = page.layout()
    if notice is None:
        if not status.broken or not isinstance(layout, QBoxLayout):
            return
        notice = TroubleNotice(page)
        layout.insertWidget(0, notice)
    notice.say(translated(status.sentence) if status.broken else "")
