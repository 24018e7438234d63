"""Which session the window shows: opening, making, closing, and what is asked on the way.

Qt's classes, made in the GUI thread before any worker names them.

PySide makes a class when it is first named, by code or by an event. A worker that imports a page names hundreds, and
where the window needs a class for an event at the same moment, the process crashes.
"""

from __future__ import annotations

import time
from functools import partial
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING

from PySide6 import QtCore, QtGui, QtOpenGL, QtOpenGLWidgets, QtSvg, QtWidgets
from PySide6.QtCore import QEvent, QObject, QStandardPaths, Qt
from PySide6.QtWidgets import (
    QDockWidget,
    QFileDialog,
    QLabel,
    QMainWindow,
    QSizePolicy,
    QStackedWidget,
    QTabBar,
    QToolBar,
    QWidget,
)

from contactbench.app.bench import Weight
from contactbench.app.errors import in_words
from contactbench.app.opening import (
    OpenedSession,
    OpeningProblem,
    adopt,
    free_folder,
    holds_session,
    new_session,
    open_session,
    opened_up_to_damage,
    problem_with,
    salvaged,
    unpacked,
    virtual_session,
)
from contactbench.app.start import session_name
from contactbench.pipeline.steps import Step
from contactbench.widgets.controls import PanelScroll
from contactbench.widgets.messages import translated
from contactbench.widgets.theme import Sign, icon

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from contactbench.app.bench import Bench
    from contactbench.app.window import MainWindow
    from contactbench.pipeline.session.remains import WaysIn
    from contactbench.pipeline.workbench.undo_history import UndoHistory

_NEEDED = (
    "contactbench.widgets.scene",
    "vtkmodules.vtkInteractionWidgets",  # of a scene that is made
    "vtkmodules.vtkViewsContext2D",
    "contactbench.widgets.strip_chart",
    "contactbench.pipeline.workbench.live",
    "contactbench.pipeline.session.why",
    "contactbench.app.trouble_watch",
    "contactbench.app.undo",
    *(f"contactbench.app.pages.{step}" for step in Step),
)

_MOST_NAMED = 8
# Of the mesh libraries: the window and the sensors come first where there are too few processors.
_NICENESS = 10


def _load() -> None:
    """Import VTK, scipy and whatever else a session needs; in a worker, so that the window answers meanwhile."""
    for name in _NEEDED:
        import_module(name)
    from contactbench.pipeline.devices.protocols.registry import drivers
    from contactbench.pipeline.mesh.engines.child import Child

    drivers()  # which are loaded one by one when they are asked for
    Child.niceness = _NICENESS


def _listed(names: Sequence[str]) -> str:
    more = "…" if len(names) > _MOST_NAMED else ""
    return ", ".join(names[:_MOST_NAMED]) + more


class Sessions(QObject):
    """Opens and makes sessions, in workers; the window shows what comes."""

    def __init__(self, window: MainWindow) -> None:
        super().__init__(window)
        start = window.start
        self._window, self._why_read_only = window, ""
        self._history: UndoHistory | None = None
        window.shown.connect(self._go_on_in)
        self._start, self._jobs, self._settings = start, window.jobs, window.settings
        self._next: Callable[[], None] | None = None
        self._waiting: OpenedSession | None = None
        self._classes = QtClasses(self)
        start.virtual_button.clicked.connect(lambda: self.try_virtual())
        start.new_button.clicked.connect(self.ask_new)
        start.open_button.clicked.connect(self.ask_open)
        start.chosen.connect(self.open)

    def list_recent(self) -> None:
        """Show the recent sessions; whether they are still there is found out in a worker."""
        recent = self._settings.now.recent
        self._start.show_recent(recent)

        def look(_progress: object, _cancelled: object) -> set[str]:
            return {each.folder for each in recent if not holds_session(Path(each.folder))}

        self._jobs.start(
            self.tr("Finding recent sessions"),
            look,
            lambda missing: self._start.show_recent(self._settings.now.recent, missing),
        )

    # ---- what is asked for -------------------------------------------------------------------------

    def try_virtual(self, folder: Path | None = None) -> None:
        """Make a session on a virtual bench, or go on with it where there is one."""

        def work() -> OpenedSession:
            return virtual_session(folder or free_folder(self._settings.sessions, "virtual bench"))

        self._ask_for(self.tr("Preparing virtual bench"), work, Step.GRAVITY)

    def open(self, folder: Path, *, write: bool = True) -> None:
        """Open a session; `write`: False opens it read-only, also if it is damaged or open elsewhere."""
        page = self._settings.recent_of(folder).page
        step = Step(page) if page in set(Step) else None
        title = self.tr("Opening {}").format(session_name(folder))
        self._ask_for(title, lambda: open_session(folder, write=write), step, folder)

    def unpack(self, archive: Path) -> None:
        """Unpack a session archive into a new folder, and open that."""
        title = self.tr("Opening {}").format(archive.name)
        self._ask_for(title, lambda: unpacked(archive, self._settings.sessions))

    def salvage(self, folder: Path) -> None:
        """Copy all that is whole in a damaged session into a new one beside it, and open that."""
        title = self.tr("Salvaging a copy of {}").format(session_name(folder))
        self._ask_for(title, lambda: salvaged(folder, self._settings.sessions))

    def open_up_to_damage(self, folder: Path) -> None:
        """Go on with a damaged session from where it is still whole; its journal as it was is kept beside."""
        title = self.tr("Opening {} up to the damage").format(session_name(folder))
        self._ask_for(title, lambda: opened_up_to_damage(folder), folder=folder)

    def new(self, folder: Path) -> None:
        """Make a session."""
        title = self.tr("Creating {}").format(session_name(folder))
        self._ask_for(title, lambda: new_session(folder), Step.DEVICES, folder)

    def ask_new(self) -> None:
        """Ask for a place and make a session."""
        dialog = QFileDialog(self._start.window(), self.tr("Create a session in a new or empty folder"))
        dialog.setAcceptMode(QFileDialog.AcceptMode.AcceptSave)
        dialog.setOption(QFileDialog.Option.ShowDirsOnly)
        dialog.setLabelText(QFileDialog.DialogLabel.Accept, self.tr("Create session"))
        dialog.setDirectory(str(self._place()))
        dialog.selectFile(free_folder(self._settings.sessions, "session").name)
        dialog.fileSelected.connect(lambda name: self.new(Path(name)))
        dialog.finished.connect(dialog.deleteLater)
        dialog.open()

    def ask_open(self) -> None:
        """Ask for a folder and open it."""
        dialog = QFileDialog(self._start.window(), self.tr("Open session folder"))
        dialog.setFileMode(QFileDialog.FileMode.Directory)
        dialog.setOption(QFileDialog.Option.ShowDirsOnly)
        dialog.setDirectory(str(self._place()))
        dialog.fileSelected.connect(lambda name: self.open(Path(name)))
        dialog.finished.connect(dialog.deleteLater)
        dialog.open()

    def proceed(self) -> None:
        """Go on with what was asked for: no session is open now."""
        following, self._next = self._next, None
        if following is not None:
            following()

    def give_up(self) -> None:
        """Forget what was asked for: the session that is open stays."""
        self._next = None

    def close(self) -> None:
        """Give back a session that waits for an answer, and open none that was asked for just now."""
        self._classes.forget()
        waiting, self._waiting = self._waiting, None
        if waiting is not None:
            waiting.desk.close()

    # ---- what comes of it --------------------------------------------------------------------------

    def _ask_for(
        self,
        title: str,
        work: Callable[[], OpenedSession],
        step: Step | None = None,
        folder: Path | None = None,
    ) -> None:
        self._next = partial(self._begin, title, work, step, folder)
        self._window.make_room()

    def _begin(
        self, title: str, work: Callable[[], OpenedSession], step: Step | None, folder: Path | None
    ) -> None:
        self.close()
        self._start.question.clear()
        self._start.set_busy(True)

        def prepared(_progress: object, _cancelled: object) -> OpenedSession:
            opened = work()  # first: what cannot be opened is said at once
            try:
                _load()
            except BaseException:
                opened.desk.close()
                raise
            return opened

        def start() -> None:
            self._window.garbage.stop()  # until it came, or was refused
            self._jobs.start(
                title,
                prepared,
                lambda opened: self._came(opened, step),
                lambda error: self._refused(error, folder),
            )

        self._classes.when_made(start)

    def _came(self, opened: OpenedSession, step: Step | None) -> None:
        self._window.garbage.start()
        self._start.set_busy(False)
        self._why_read_only, self._history = opened.why_read_only, opened.history
        for sentence in opened.found:
            self._window.tell(Weight.WARNING, sentence)
        if not opened.unfinished:
            self._window.show_session(opened, step)
            return
        self._waiting = opened
        one = len(opened.unfinished) == 1
        sentence = (
            self.tr(
                "The last run on {} ended unexpectedly during a recording. Everything up to half a second"
                " before that is intact. Add the recording to the session?"
            )
            if one
            else self.tr(
                "The last run on {} ended unexpectedly during {} recordings. Everything up to half a"
                " second before that is intact. Add the recordings to the session?"
            )
        ).format(session_name(opened.desk.folder), len(opened.unfinished))
        self._start.question.ask(
            sentence,
            (
                (
                    self.tr("Add recording") if one else self.tr("Add recordings"),
                    lambda: self._adopt(opened, step),
                ),
                (
                    self.tr("Leave it for later") if one else self.tr("Leave them for later"),
                    lambda: self._go_on(opened, step),
                ),
                (self.tr("Choose another session"), self.close),
            ),
        )

    def _go_on_in(self, bench: Bench) -> None:
        """Have a session that is shown be as it was left, or say that nothing can be added to it."""
        if self._why_read_only:
            ReadOnlyView(bench, self._window, self._why_read_only)
        elif self._history is not None:
            from contactbench.app.undo import UndoMemory  # brings what results are computed with

            UndoMemory(bench, self._history)

    def _adopt(self, opened: OpenedSession, step: Step | None) -> None:
        self._start.set_busy(True)

        def adopted(what: tuple[tuple[str, ...], tuple[str, ...]]) -> None:
            self._start.set_busy(False)
            done, left = what
            self._go_on(opened, step)
            for sentence in done:
                self._window.tell(Weight.GOOD, sentence)
            for sentence in left:
                self._window.tell(Weight.WARNING, sentence)

        def failed(error: BaseException) -> None:
            self.close()
            self._refused(error, opened.desk.folder)

        self._jobs.follow(
            self.tr("Adding recordings"), opened.desk.do(lambda session: adopt(session)), adopted, failed
        )

    def _go_on(self, opened: OpenedSession, step: Step | None) -> None:
        self._waiting = None
        self._window.show_session(opened, step)

    def _refused(self, error: BaseException, folder: Path | None) -> None:
        self._window.garbage.start()
        self._start.set_busy(False)
        problem = problem_with(error)
        if problem is None:
            sentence, details, _ = in_words(error)
            problem = OpeningProblem(
                self.tr("Could not open the session: {}").format(translated(sentence)), False
            )
            self._window.tell(Weight.ERROR, problem.sentence, details)
        if folder is not None and problem.damaged:
            self._look_at_damage(problem, folder)
            return
        answers: list[tuple[str, Callable[[], None]]] = [(self.tr("Choose another session"), self.ask_open)]
        if folder is not None:
            if problem.readable:
                answers.insert(0, (self.tr("Open read-only"), lambda: self.open(folder, write=False)))
            answers.append((self.tr("Try again"), lambda: self.open(folder)))
        self._start.question.ask(problem.sentence, answers)

    # ---- a damaged one -----------------------------------------------------------------------------

    def _look_at_damage(self, problem: OpeningProblem, folder: Path) -> None:
        """Find out what is left of a session, and ask."""
        self._start.set_busy(True)

        def look(_progress: object, _cancelled: object) -> WaysIn | None:
            from contactbench.pipeline.session import SessionError
            from contactbench.pipeline.session.remains import ways_in

            try:
                return ways_in(folder)
            except SessionError:  # there is none: the problem says so itself
                return None

        def ask(ways: WaysIn | None) -> None:
            self._start.set_busy(False)
            self._ask_way_in(problem, folder, ways)

        self._jobs.start(
            self.tr("Looking at the damage of {}").format(session_name(folder)),
            look,
            ask,
            lambda _error: ask(None),
        )

    def _ask_way_in(self, problem: OpeningProblem, folder: Path, ways: WaysIn | None) -> None:
        others: list[tuple[str, Callable[[], None]]] = [
            (self.tr("Choose another session"), self.ask_open),
            (self.tr("Try again"), lambda: self.open(folder)),
        ]
        if ways is None:
            self._start.question.ask(problem.sentence, others)
            return
        offered = [
            (self.tr("Salvage a copy"), lambda: self.salvage(folder), self._cost_of_salvage(ways)),
            (
                self.tr("Open read-only"),
                lambda: self.open(folder, write=False),
                self.tr("Nothing is lost, and nothing can be added. All {} whole records are shown.").format(
                    ways.before + ways.after
                ),
            ),
        ]
        if ways.before:
            up_to = self.tr("Open up to the damage")
            offered.append((up_to, lambda: self.open_up_to_damage(folder), self._cost_of_cutting(ways)))
        answers = [(words, action) for words, action, _ in offered]
        self._start.question.ask(
            problem.sentence, [*answers, *others], costs=[cost for _, _, cost in offered]
        )

    def _cost_of_salvage(self, ways: WaysIn) -> str:
        words = self.tr(
            "All {} whole records go into a new session; this one stays as it is. What is lost: at least {}."
        ).format(ways.before + ways.after, self._counted(ways.gaps))
        if ways.doubtful:
            words += " " + self.tr("To be done again: {}.").format(_listed(ways.doubtful))
        if ways.files:
            words += " " + self.tr("Files: {}").format(" ".join(ways.files[:_MOST_NAMED]))
        return words

    def _cost_of_cutting(self, ways: WaysIn) -> str:
        words = self.tr(
            "The first {} records go on as this session; {} after them are set aside, and the journal as it was is"
            " kept beside."
        ).format(ways.before, self._counted(ways.after + ways.gaps))
        if ways.behind:
            words += " " + self.tr("What is lost: {}.").format(_listed(ways.behind))
        return words

    def _counted(self, records: int) -> str:
        return self.tr("1 record") if records == 1 else self.tr("{} records").format(records)

    def _place(self) -> Path:
        # The folder is not made before something is put into it.
        if self._settings.sessions.is_dir():
            return self._settings.sessions
        return Path(QStandardPaths.writableLocation(QStandardPaths.StandardLocation.DocumentsLocation))


# ---- A session that is open read-only ------------------------------------------------------------


_ICON_PX = 20
_DIRECT = Qt.FindChildOption.FindDirectChildrenOnly


class ReadOnlyView(QObject):
    """
    A line on top of the window, and pages that can only be looked at; belongs to its bench, and goes with it.

    Parameters
    ----------
    bench : Bench
    window : QMainWindow
    why : str
        See `Opened`.
    """

    def __init__(self, bench: Bench, window: QMainWindow, why: str) -> None:
        super().__init__(bench)
        self._line = QToolBar(self.tr("Read-only"))
        self._line.setObjectName("read-only")
        self._line.setMovable(False)
        self._line.setContextMenuPolicy(Qt.ContextMenuPolicy.PreventContextMenu)
        sign, words = Sign(_ICON_PX), QLabel(self._sentence(why), wordWrap=True)
        sign.show_icon(icon("warning", "warning"))
        words.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Preferred)
        words.setStyleSheet("font-weight: 600; padding: 4px 6px;")
        self._line.addWidget(sign)
        self._line.addWidget(words)
        window.addToolBarBreak()
        window.addToolBar(self._line)
        bench.destroyed.connect(self._line.deleteLater)
        dock = window.findChild(QDockWidget, "page")
        stack = dock.widget() if dock is not None else None
        if isinstance(stack, QStackedWidget):
            self._stack = stack
            stack.currentChanged.connect(self._lock)
            self._lock()

    def _sentence(self, why: str) -> str:
        if why == "damaged":
            return self.tr(
                "Read-only: this session is damaged. To continue working, close it, open it again and"
                " salvage a copy."
            )
        if why == "elsewhere":
            return self.tr(
                "Read-only: another program is using this session. It is shown as it was when opened."
            )
        return self.tr(
            "Read-only: the session folder is not writable. To continue working, make it writable or copy it."
        )

    def _lock(self) -> None:
        page = self._stack.currentWidget()
        if page is not None:
            self._lock_in(page)

    def _lock_in(self, widget: QWidget) -> None:
        """Lock a widget, but leave what is needed to scroll and to turn to another tab."""
        if isinstance(widget, QTabBar):
            return
        if widget.findChild(PanelScroll) is None and not isinstance(widget, PanelScroll):
            widget.setEnabled(False)
            widget.installEventFilter(self)
            return
        inside = widget.widget() if isinstance(widget, PanelScroll) else None
        for child in [inside] if inside is not None else widget.findChildren(QWidget, options=_DIRECT):
            self._lock_in(child)

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        """Lock again what a page unlocks when its step's state changes."""
        if event.type() == QEvent.Type.EnabledChange and isinstance(watched, QWidget) and watched.isEnabled():
            watched.setEnabled(False)
        return False


# ---- qt's classes, made in the GUI thread before any worker names them ---------------------------


_MODULES = (QtCore, QtGui, QtWidgets, QtOpenGL, QtOpenGLWidgets, QtSvg)
_PIECE_S = 0.005


class QtClasses(QtCore.QObject):
    """Makes them a few at a time, so that the window answers meanwhile."""

    def __init__(self, parent: QtCore.QObject | None = None) -> None:
        super().__init__(parent)
        self._left = iter([(module, name) for module in _MODULES for name in dir(module)])
        self._then: Callable[[], object] | None = None
        self._timer = QtCore.QTimer(self, interval=0)
        self._timer.timeout.connect(self._make_some)
        self._timer.start()
        self._make_some()  # all of them, where another window has made them before

    def when_made(self, then: Callable[[], object]) -> None:
        """Call `then` as soon as all are made, at once if they are; another call before that takes its place."""
        if self._timer.isActive():
            self._then = then
        else:
            then()

    def forget(self) -> None:
        """Do not call what waits."""
        self._then = None

    def _make_some(self) -> None:
        end = time.perf_counter() + _PIECE_S
        for module, name in self._left:
            getattr(module, name, None)
            if time.perf_counter() > end:
                return
        self._timer.stop()
        then, self._then = self._then, None
        if then is not None:
            then()
