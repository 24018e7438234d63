"""The window: steps on the left, one scene in the middle, the step's page on the right, charts and messages below."""

from __future__ import annotations

from contextlib import suppress
from functools import partial
from typing import TYPE_CHECKING

from PySide6.QtCore import QEvent, Qt, QTimer, Signal
from PySide6.QtGui import QUndoGroup
from PySide6.QtWidgets import QLabel, QMainWindow, QStackedWidget

from app.bench import Bench, Message, Weight
from app.errors import LOG, in_words
from app.garbage import Garbage
from app.heartbeat import Heartbeat
from app.jobs import Jobs
from app.opening import damage
from app.settings import Settings
from app.start import StartPage, dropped_folder
from app.window_disk import DiskWatch
from app.window_docks import Docks, geometry_text, restore_geometry
from app.window_header import Header
from app.window_live import LiveView
from app.window_menus import Menus
from app.window_pages import Pages
from app.window_probe import SessionProbe
from app.window_sessions import Sessions
from pipeline.workbench.steps import Step, StepState
from widgets.progress_strip import ProgressStrip
from widgets.theme import is_dark, use_theme

if TYPE_CHECKING:
    from PySide6.QtGui import QCloseEvent, QDragEnterEvent, QDropEvent

    from app.errors import Faults, LogFile
    from app.jobs import Job
    from app.opening import Opened
    from widgets.scene import Scene

_TICK_MS, _SLOW_MS = 33, 500
_CHECK_MS, _MOST_DAMAGE = 2000, 5  # the window is drawn first
_STATUS_PX = 40
_SMALLEST = (1024, 700)


class MainWindow(QMainWindow):
    """
    One window with one session, or with the page that offers some.

    Parameters
    ----------
    settings : Settings, optional
    faults : Faults, optional
        What nobody caught; told in the message list.
    log : LogFile, optional

    Attributes
    ----------
    bench : Bench or None
        What is open.
    scene : Scene or None
        Made with the first session, and kept.
    """

    shown = Signal(object)  # Bench: a session is open, its page is there
    gone = Signal()  # no session is open any more

    def __init__(
        self, settings: Settings | None = None, faults: Faults | None = None, log: LogFile | None = None
    ) -> None:
        super().__init__()
        self.settings, self.log = settings or Settings(), log
        self.bench: Bench | None = None
        self.scene: Scene | None = None
        self.jobs, self.undo = Jobs(self), QUndoGroup(self)
        self.heartbeat, self.garbage = Heartbeat(self), Garbage(self)
        self.setWindowTitle("contactbench")
        self.setMinimumSize(*_SMALLEST)
        self.setAcceptDrops(True)
        self.setDockNestingEnabled(True)
        self.start, self._middle = StartPage(), QStackedWidget()
        self._middle.addWidget(self.start)
        self.setCentralWidget(self._middle)
        self.docks, self.header = Docks(self), Header()
        self.addToolBar(self.header)
        self.steps, self.messages = self.docks.steps, self.docks.messages
        self.pages, self.live = Pages(self.docks.pages, self), LiveView(self)
        self._probe = SessionProbe(self)
        self.pages.judged.connect(self.steps.show_statuses)
        self.pages.complete.connect(self.garbage.settle)
        self.gone.connect(
            self.garbage.clear, Qt.ConnectionType.QueuedConnection
        )  # when the pages are deleted
        self.sessions = Sessions(self.start, self.jobs, self.settings, self)
        self._make_status_bar()
        self.menus = Menus(self)
        self.header.add(self.menus.undo, self.menus.redo, self.menus.help_here)
        self._connect(faults)
        self._ending = self._ended = self._connected = False
        self._noted: set[str] = set()
        self._disk: DiskWatch | None = None
        self._tick = QTimer(self, interval=_TICK_MS)
        self._tick.timeout.connect(self._show_live)
        self._slow = QTimer(self, interval=_SLOW_MS)
        self._slow.timeout.connect(self._show_rates)
        if not restore_geometry(self, self.settings.now.geometry):
            self.resize(1280, 800)
        self._show_start()
        self.heartbeat.start()

    def _make_status_bar(self) -> None:
        self.strip = ProgressStrip(self._running)
        self._rates = QLabel()
        self._rates.setProperty("role", "muted")
        self._rates.setStyleSheet("padding-left: 8px;")
        self.statusBar().addWidget(self._rates)
        self.statusBar().addPermanentWidget(self.strip)
        self.statusBar().setSizeGripEnabled(False)
        self.statusBar().setFixedHeight(_STATUS_PX)  # as with a button in it: the scene never jumps

    def _connect(self, faults: Faults | None) -> None:
        self.steps.chosen.connect(self.show_step)
        self.sessions.opened.connect(self._show_session)
        self.sessions.wanted.connect(self._make_room)
        self.sessions.told.connect(self.tell)
        self._watch(self.jobs)
        self.heartbeat.stalled.connect(self._stalled)
        if faults is not None:
            faults.happened.connect(self._fault)

    # ---- messages ----------------------------------------------------------------------------------

    def tell(self, weight: str, text: str, details: str = "") -> None:
        """Put a message into the list; one that matters makes the list be seen."""
        LOG.info("%s: %s", weight, text)
        self.messages.add(str(weight), text, details)
        if weight in (Weight.WARNING, Weight.ERROR) and self.docks.message_dock.isHidden():
            self.docks.message_dock.show()

    def _told(self, message: Message) -> None:
        self.tell(message.weight, message.text, message.details)

    def _fault(self, sentence: str, details: str, expected: bool) -> None:
        if not expected:
            sentence = self.tr(
                "Something went wrong that should not: {}. What is in the session is safe. Try it again; if it comes"
                " again, save diagnostics (menu File) and send them to whoever looks after this program."
            ).format(sentence)
        self.tell(Weight.WARNING if expected else Weight.ERROR, sentence, details)
        if self.bench is not None and not self._ending and sentence not in self._noted:
            self._noted.add(sentence)  # once is enough for the journal
            with suppress(RuntimeError):  # the desk was closed meanwhile
                future = self.bench.desk.do(lambda session: session.note(sentence))
                future.add_done_callback(
                    lambda ended: ended.exception()
                )  # a full disk was told by what met it

    def _job_failed(self, job: Job, error: BaseException) -> None:
        sentence, details, expected = in_words(error)
        if expected or isinstance(error, OSError):
            self.tell(Weight.ERROR, self.tr("{}: {}").format(job.title, sentence), details)
        else:
            LOG.error("%s", details)
            self._fault(sentence, details, False)

    def _stalled(self, seconds: float) -> None:
        LOG.warning("the window stood still for %.0f ms", 1000 * seconds)

    # ---- work --------------------------------------------------------------------------------------

    def _running(self) -> tuple[Job, ...]:
        return (*self.jobs.running, *(self.bench.jobs.running if self.bench is not None else ()))

    def _watch(self, jobs: Jobs) -> None:
        jobs.started.connect(self.strip.watch)
        jobs.failed.connect(self._job_failed)

    # ---- a session ---------------------------------------------------------------------------------

    def _show_session(self, opened: Opened, step: Step | None) -> None:
        if self.scene is None:
            from widgets.scene import Scene  # brings VTK: only once it is needed

            self.scene = Scene()
            self.scene.set_dark(is_dark())
            self._middle.addWidget(self.scene)
        self._middle.setCurrentWidget(self.scene)
        bench = self.bench = Bench(opened.desk, self.scene, self)
        self._watch(bench.jobs)
        bench.told.connect(self._told)
        self._disk = DiskWatch(bench)
        bench.go_to.connect(self.show_step)
        self.undo.addStack(bench.undo)
        self.undo.setActiveStack(bench.undo)
        self.docks.restore(self.settings.now.docks)
        self.docks.set_charts(self.live.open(bench))
        self._connected = False
        self._probe.open(bench)
        self.pages.open(bench)
        bench.changed.connect(self.pages.read_statuses)
        self.menus.set_open(True)
        self.show_step(step or self.pages.first())
        self.live.reopen()
        for note in opened.desk.notes:
            self.tell(Weight.INFO, note)
        self._tick.start()
        self._slow.start()
        self._show_rates()
        QTimer.singleShot(_CHECK_MS, bench, lambda: self._check_files(bench))
        self.shown.emit(bench)

    def _check_files(self, bench: Bench) -> None:
        if bench is self.bench and not self._ending:
            folder = bench.desk.folder
            bench.jobs.start(
                self.tr("Checking the session's files"),
                lambda _progress, cancelled: damage(folder, cancelled),
                self._tell_damage,
            )

    def _tell_damage(self, problems: tuple[str, ...]) -> None:
        for problem in reversed(problems[:_MOST_DAMAGE]):
            self.tell(Weight.ERROR, problem)
        if problems:
            words = (
                self.tr(
                    "A file of this session is not as it was written, so nothing that rests on it counts."
                )
                if len(problems) == 1
                else self.tr(
                    "{} files of this session are not as they were written, so nothing that rests on them counts."
                    " `contactbench session verify` lists them all."
                )
            )
            self.tell(Weight.ERROR, words.format(len(problems)))

    def _show_start(self) -> None:
        self._middle.setCurrentWidget(self.start)
        self.docks.hide()
        self.menus.set_open(False)
        self.header.show_bench(None)
        self._rates.setText("")
        self.setWindowTitle("contactbench")
        self.sessions.list_recent()

    def _make_room(self) -> None:
        if self.bench is None:
            self.sessions.proceed()
        else:
            self.close_session()

    def close_session(self) -> None:
        """Close what is open, and show the first page; a recording that runs is kept."""
        if self.bench is None or self._ending:
            return
        bench, self._ending = self.bench, True
        self._remember(bench)
        self._tick.stop()
        self._slow.stop()
        self.setEnabled(False)  # nothing may be begun any more
        self.pages.close()
        bench.let_go()
        self.jobs.start(
            self.tr("Closing the session"),
            lambda _progress, _cancelled: self._end(bench),
            lambda _: self._session_closed(bench),
            partial(self._not_closed, bench),
        )

    def _end(self, bench: Bench) -> None:
        self.settings.write()
        bench.end()

    def _not_closed(self, bench: Bench, error: BaseException) -> None:
        sentence, details, _ = in_words(error)
        self.tell(Weight.ERROR, sentence, details)
        self._session_closed(bench)

    def _session_closed(self, bench: Bench) -> None:
        self.bench, self._disk, self._ending = None, None, False
        self.docks.set_charts(None)
        self.pages.forget()
        self.live.forget()
        self.undo.removeStack(bench.undo)
        bench.deleteLater()
        self.setEnabled(True)
        self._show_start()
        self.gone.emit()
        if self._ended:
            self.close()
        else:
            self.sessions.proceed()

    def _remember(self, bench: Bench) -> None:
        self.settings.change(docks=self.docks.layout_text(), geometry=geometry_text(self), write=False)
        self._remember_page(bench)

    def _remember_page(self, bench: Bench) -> None:
        step = self.pages.step
        done = [each for each, status in self.pages.statuses.items() if status.state is StepState.DONE]
        words = ", ".join(self.steps.name_of(each) for each in done)
        words = self.tr("done: {}").format(words) if words else self.tr("begun")
        self.settings.opened(bench.desk.folder, "" if step is None else step.value, words, write=False)

    # ---- steps -------------------------------------------------------------------------------------

    def show_step(self, step: Step) -> None:
        """Show the page of a step."""
        if self.bench is None or self._ending:
            return
        self.docks.page_dock.show()
        if step is self.pages.step:
            return
        self.pages.show(step)
        # At once: after a crash the window comes back to this page.
        self._remember_page(self.bench)
        self.jobs.start(self.tr("Remembering the page"), lambda _progress, _cancelled: self.settings.write())
        self.steps.show_step(step)
        self.docks.page_dock.setWindowTitle(
            self.tr("Step {} of {}").format(1 + list(Step).index(step), len(Step))
        )

    # ---- what is live ------------------------------------------------------------------------------

    def _show_live(self) -> None:
        self.pages.tick()
        if self.docks.charts_seen():
            self.live.tick()

    def _show_rates(self) -> None:
        bench = self.bench
        if bench is None:
            return
        self.header.show_bench(bench)
        self.setWindowTitle(f"{bench.desk.folder.name} · contactbench")
        self._rates.setText(self.live.rates())
        self.pages.watch()
        if self._disk is not None:
            self._disk.look()
        if self.live.connected != self._connected:
            self._connected = not self._connected
            self.pages.read_statuses()

    # ---- Qt ----------------------------------------------------------------------------------------

    def set_theme(self, choice: str) -> None:
        """Use the "system", the "light" or the "dark" theme, and remember it."""
        self.settings.change(theme=choice)
        use_theme(choice)

    def changeEvent(self, event: QEvent) -> None:
        """Follow the theme."""
        if event.type() == QEvent.Type.PaletteChange and getattr(self, "scene", None) is not None:
            self.scene.set_dark(is_dark())  # type: ignore[union-attr]
        super().changeEvent(event)

    def dragEnterEvent(self, event: QDragEnterEvent) -> None:
        """Take a session's folder."""
        if dropped_folder(event) is not None:
            event.acceptProposedAction()

    def dropEvent(self, event: QDropEvent) -> None:
        """Open it."""
        folder = dropped_folder(event)
        if folder is not None:
            event.acceptProposedAction()
            self.sessions.open(folder)

    def closeEvent(self, event: QCloseEvent) -> None:
        """Close the session first, in a worker; then the window. Nothing is asked: nothing can be lost."""
        self._ended = True
        if self.bench is not None:
            event.ignore()
            self.close_session()
            return
        self.sessions.close()
        self.menus.close_windows()
        self.settings.change(geometry=geometry_text(self))
        self.heartbeat.stop()
        for timer in (self._tick, self._slow):
            timer.stop()
        if self.scene is not None:
            self.scene.close_scene()
            self.scene = None
        event.accept()

    def reset_layout(self) -> None:
        """Lay the docks out as they are at first."""
        if self.bench is not None:
            self.docks.arrange()
