"""The window: steps on the left, one scene in the middle, the step's page on the right, charts and messages below."""

from __future__ import annotations

import json
import math
from functools import partial
from typing import TYPE_CHECKING

from PySide6.QtCore import QEvent, QObject, Qt, QTimer, Signal
from PySide6.QtGui import QCloseEvent, QDragEnterEvent, QDropEvent, QKeyEvent, QUndoGroup
from PySide6.QtOpenGLWidgets import QOpenGLWidget
from PySide6.QtWidgets import QMainWindow, QMessageBox, QPushButton, QStackedWidget, QWidget

from contactbench.app.bench import Bench, Weight
from contactbench.app.bench_mode import BenchMode
from contactbench.app.errors import Faults, LogFile, MessageRouter, in_words
from contactbench.app.heartbeat import Garbage, Heartbeat, Turns
from contactbench.app.jobs import Job, Jobs
from contactbench.app.settings import WindowSettings
from contactbench.app.start import StartPage, dropped_folder, thumbnail
from contactbench.app.window_docks import (
    SMALLEST,
    Docks,
    HeaderBar,
    LiveView,
    first_size,
    geometry_text,
    restore_geometry,
)
from contactbench.app.window_menus import Menus
from contactbench.app.window_pages import Pages
from contactbench.app.window_sessions import Sessions
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.steps import Step, StepState
from contactbench.widgets.controls import ElidedLabel, beside
from contactbench.widgets.message_list import NewestMessage
from contactbench.widgets.messages import translated
from contactbench.widgets.progress_strip import ProgressStrip
from contactbench.widgets.theme import dress, is_dark, use_theme

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from contactbench.app.opening import OpenedSession
    from contactbench.app.trouble_watch import TroubleWatch
    from contactbench.pipeline.mesh import Probe
    from contactbench.pipeline.mesh.regions.region import Region
    from contactbench.widgets.scene import Scene

_TICK_MS, _SLOW_MS = 33, 500
_STATUS_PX = 36
_SCENE_SHARE = 56  # of the window in bench mode, %


class MainWindow(QMainWindow):
    """
    One window with one session, or with the page that offers some.

    Parameters
    ----------
    settings : WindowSettings, optional
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
        self, settings: WindowSettings | None = None, faults: Faults | None = None, log: LogFile | None = None
    ) -> None:
        super().__init__()
        self.settings, self.log = settings or WindowSettings(), log
        self.bench: Bench | None = None
        self.scene: Scene | None = None
        self._ending = self._ended = self._connected = self._waits = self._opening = False
        # With which a session begins that is being opened; None: as it stands.
        self._first: Step | None = None
        self.jobs, self.undo, self._turns = Jobs(self), QUndoGroup(self), Turns(self)
        self.heartbeat, self.garbage = Heartbeat(self), Garbage(self)
        self.setWindowTitle("contactbench")
        self.setMinimumSize(*SMALLEST)
        self.setAcceptDrops(True)
        self.setDockNestingEnabled(True)
        self.start, self._middle = StartPage(self.settings.picture_of), QStackedWidget()
        self._middle.addWidget(self.start)
        # Never shown: with it Qt makes the window for OpenGL at once. Else it makes it anew for the first 3D view,
        # which blinks, stands still, and has crashed.
        QOpenGLWidget(self._middle).hide()
        self.bench_mode, middle = BenchMode(self), QWidget()
        beside(middle, (self._middle, _SCENE_SHARE), (self.bench_mode.view, 100 - _SCENE_SHARE), space=0)
        self.setCentralWidget(middle)
        self.docks, self.header = Docks(self), HeaderBar()
        self.addToolBar(self.header)
        self.steps, self.messages = self.docks.steps, self.docks.messages
        self._router = MessageRouter(self.docks, lambda: None if self._ending else self.bench, self)
        self.pages, self.live = Pages(self.docks.pages, self), LiveView(self)
        self._probe, self._camera = SessionProbe(self), SceneMemory(self, self._remember_now)
        self.pages.judged.connect(self.steps.show_statuses)
        self.pages.complete.connect(self.garbage.settle)
        # When the pages are deleted.
        self.gone.connect(self.garbage.clear, Qt.ConnectionType.QueuedConnection)
        self.sessions = Sessions(self)
        self.departure = Departure(self)
        self._make_status_bar()
        self.menus = Menus(self)
        self.header.add(self.menus.bench_mode, self.menus.undo, self.menus.redo, self.menus.help_here)
        self._connect(faults)
        self._turns.failed.connect(self._not_shown)
        self._trouble: TroubleWatch | None = None
        self._arriving: OpenedSession | None = None
        self._tick = QTimer(self, interval=_TICK_MS)
        self._tick.timeout.connect(self._show_live)
        self._slow = QTimer(self, interval=_SLOW_MS)
        self._slow.timeout.connect(self._show_rates)
        dress(self)
        if not restore_geometry(self, self.settings.now.geometry):
            self.resize(first_size(self))
        self._show_start()
        self.garbage.settle()
        self.heartbeat.start()

    def _make_status_bar(self) -> None:
        self.strip = ProgressStrip(self._running)
        self._rates = ElidedLabel(role="muted")
        self._rates.setContentsMargins(8, 0, 0, 0)
        self._newest = NewestMessage(self.docks.show_messages)
        self._router.told.connect(self._show_newest)
        self.statusBar().addWidget(self._rates)
        self.statusBar().addWidget(self._newest, 1)
        self.statusBar().addPermanentWidget(self.strip)
        self.statusBar().setSizeGripEnabled(False)
        self.statusBar().setFixedHeight(_STATUS_PX)  # as with a button in it: the scene never jumps

    def _connect(self, faults: Faults | None) -> None:
        self.steps.chosen.connect(self.show_step)
        self._watch(self.jobs)
        self.heartbeat.stalled.connect(self._router.stalled)
        if faults is not None:
            faults.happened.connect(self._router.fault)

    # ---- messages ----------------------------------------------------------------------------------

    def _show_newest(self, weight: str, text: str) -> None:
        """Show a message below, unless the foot of the page says it."""
        page = self.pages.current
        if page is None or page.bar.words != translated(text):
            self._newest.show_message(weight, text)

    def tell(self, weight: str, text: str, details: str = "") -> None:
        """Put a message into the list; one that matters makes the list be seen."""
        self._router.tell(weight, text, details)

    # ---- work --------------------------------------------------------------------------------------

    @property
    def ending(self) -> bool:
        """Whether the session is being closed: nothing may be begun any more."""
        return self._ending

    def _running(self) -> tuple[Job, ...]:
        return (*self.jobs.running, *(self.bench.jobs.running if self.bench is not None else ()))

    def _watch(self, jobs: Jobs) -> None:
        jobs.started.connect(self.strip.watch)
        jobs.failed.connect(self._router.job_failed)

    # ---- a session ---------------------------------------------------------------------------------

    def show_session(self, opened: OpenedSession, step: Step | None) -> None:
        """Make room for a session, and show it: in turns, for all of it at once is a window that hangs."""
        self._arriving, self._opening, self._first = opened, True, step
        self.start.set_busy(True)
        self.garbage.settle()  # the modules that a worker has just imported
        self._turns.run(
            self._make_scene,
            self._show_scene,
            None,  # its first frame is drawn in two halves
            self.live.make_charts,
            lambda: self.docks.set_charts(self.live.charts),
            # Laid out in one turn, painted in the next: both at once are felt.
            lambda: self.setUpdatesEnabled(False),
            lambda: self.docks.restore(self.settings.now.docks),
            lambda: self.setUpdatesEnabled(True),
            partial(self._begin, opened),
            lambda: self.pages.make(self._first or self.pages.first()),
            partial(self._show_first, opened.desk.notes),
        )

    def _make_scene(self) -> None:
        if self.scene is None:
            from contactbench.widgets.scene import Scene  # brings VTK: only once it is needed

            self.scene = Scene()
            self.scene.set_dark(is_dark())
            self._middle.addWidget(self.scene)
            self._camera.watch(self.scene)

    def _show_scene(self) -> None:
        assert self.scene is not None  # noqa: S101 - just made
        self._middle.setCurrentWidget(self.scene)

    def _begin(self, opened: OpenedSession) -> None:
        assert self.scene is not None  # noqa: S101 - just made
        self._arriving = None
        bench = self.bench = Bench(opened.desk, self.scene, self)
        self._watch(bench.jobs)
        bench.told.connect(self._router.message)
        bench.over.connect(self._newest.forget_if)
        bench.go_to.connect(self.show_step)
        bench.page_wanted.connect(lambda: self.bench_mode.set_on(False))
        self.undo.addStack(bench.undo)
        self.undo.setActiveStack(bench.undo)
        self.live.open(bench)
        from contactbench.app.trouble_watch import TroubleWatch  # brings half of scipy

        self._connected, self._trouble = False, TroubleWatch(bench)
        self._probe.open(bench)
        self.pages.open(bench)
        bench.changed.connect(self.pages.read_statuses)
        self.menus.set_open(True)

    def _show_first(self, notes: tuple[str, ...]) -> None:
        bench, self._opening = self.bench, False
        if bench is None:
            return
        self.start.set_busy(False)
        camera = self.settings.recent_of(bench.desk.folder).camera
        self.show_step(self._first or self.pages.first())
        self._camera.restore(camera)
        self.live.reopen()
        for note in notes:
            self.tell(Weight.INFO, note)
        self._tick.start()
        self._slow.start()
        self._show_rates()
        self.shown.emit(bench)
        if self._ended:
            QTimer.singleShot(0, self, self.close)
        elif self._waits:
            self._waits = False
            QTimer.singleShot(0, self, self.close_session)

    def _not_shown(self) -> None:
        """Give a session back that could not be shown: its desk must not keep the lock."""
        opened, self._arriving, self._opening = self._arriving, None, False
        self.setUpdatesEnabled(True)
        self.start.set_busy(False)
        if opened is not None:
            self.jobs.start(self.tr("Closing session"), lambda *_: opened.desk.close())
            self._show_start()
        else:
            self.close_session()
        if self._ended:
            self.close()

    def _show_start(self) -> None:
        self._middle.setCurrentWidget(self.start)
        self.docks.hide()
        self.menus.set_open(False)
        self.header.show_bench(None)
        self._rates.setText("")
        self.setWindowTitle("contactbench")
        self.sessions.list_recent()

    def make_room(self) -> None:
        """Let another session be opened: at once, or once the one that is open is closed."""
        if self._turns.going_on:
            self._waits = True  # as soon as this one is there
        elif self.bench is None:
            self.sessions.proceed()
        else:
            self.close_session()

    def close_session(self) -> None:
        """Close what is open, and show the first page; a recording that runs is kept."""
        if self.bench is None or self._ending or self._turns.going_on:
            return
        if self.departure.holds(self.close_session, self._stay):
            return
        self.bench_mode.set_on(False)
        bench, self._ending = self.bench, True
        png = b"" if self.scene is None else thumbnail(self.scene.photo())
        self._remember(bench)
        self._camera.stop()
        self._camera.release()
        self._tick.stop()
        self._slow.stop()
        self.setEnabled(False)  # nothing may be begun any more
        self.pages.close()
        bench.let_go()
        self.jobs.start(
            self.tr("Closing session"),
            lambda *_: self._end(bench, png),
            lambda _: self._session_closed(bench),
            partial(self._not_closed, bench),
        )

    def _stay(self) -> None:
        """Go on with this session: nobody wants it closed any more, nor another one opened."""
        self._ended = False
        self.sessions.give_up()

    def _end(self, bench: Bench, png: bytes) -> None:
        self.settings.write()
        self.settings.keep_picture(bench.desk.folder, png)
        bench.end()

    def _not_closed(self, bench: Bench, error: BaseException) -> None:
        sentence, details, _ = in_words(error)
        self.tell(Weight.ERROR, sentence, details)
        self._session_closed(bench)

    def _session_closed(self, bench: Bench) -> None:
        self.bench, self._trouble, self._ending = None, None, False
        self.docks.set_charts(None)
        self.pages.forget()
        self.live.forget()
        self.undo.removeStack(bench.undo)
        bench.forget()
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
        words = self.tr("done: {}").format(words) if words else self.tr("started")
        page = "" if step is None else step.value
        self.settings.opened(bench.desk.folder, page, words, self._camera.text(), write=False)

    def _remember_now(self) -> None:
        """Remember the page and how the scene is looked at, at once: after a crash the window comes back to it."""
        if self.bench is not None and not self._ending:
            self._remember_page(self.bench)
            self.jobs.start(self.tr("Saving the current page"), lambda *_: self.settings.write())

    # ---- steps -------------------------------------------------------------------------------------

    def show_step(self, step: Step) -> None:
        """Show the page of a step; while a session is being opened, it is the one to begin with."""
        if self._opening:
            self._first = step
        if self.bench is None or self._ending or self._opening:
            return
        self.docks.page_dock.setVisible(not self.bench_mode.on)
        if step is self.pages.step:
            return
        self._camera.release()
        self.pages.show(step)
        self._remember_now()
        self.steps.show_step(step)
        self.docks.page_dock.setWindowTitle(
            self.tr("Step {} of {}: {}").format(
                1 + list(Step).index(step), len(Step), self.steps.name_of(step)
            )
        )

    # ---- what is live ------------------------------------------------------------------------------

    def _show_live(self) -> None:
        self.pages.tick()
        self.bench_mode.tick()
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
        self.departure.look()
        if self._trouble is not None:
            self._trouble.look()
        if not bench.jobs.running:
            self._camera.release()
        if bench.connected != self._connected:
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

    def keyPressEvent(self, event: QKeyEvent) -> None:
        """Take the keys that nothing below took."""
        if not self.bench_mode.took(event):
            super().keyPressEvent(event)

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
        """Close the session first, in a worker; then the window. Only about work that is going on it is asked."""
        if self.bench is not None and not self._ending and self.departure.holds(self.close, self._stay):
            event.ignore()
            return
        self._ended = True
        if self._turns.going_on:  # closed as soon as the session is there
            event.ignore()
            return
        if self.bench is not None:
            event.ignore()
            self.close_session()
            return
        self.sessions.close()
        self.menus.close_windows()
        self.settings.change(geometry=geometry_text(self))
        self.heartbeat.stop()
        self.garbage.stop()
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


# ---- how the scene is looked at ------------------------------------------------------------------


_REST_MS = 700
_FARTHEST_M = 1e3


class SceneMemory(QObject):
    """
    Remembers the camera of the scene.

    Parameters
    ----------
    parent : QObject
    remember : callable
        Called when the camera rests after it was moved.
    """

    def __init__(self, parent: QObject, remember: Callable[[], None]) -> None:
        super().__init__(parent)
        self._scene: Scene | None = None
        self._restored = False
        self._timer = QTimer(self, interval=_REST_MS, singleShot=True)
        self._timer.timeout.connect(remember)

    def watch(self, scene: Scene) -> None:
        """Begin with a scene."""
        self._scene = scene
        scene.camera_moved.connect(self._timer.start)

    def text(self) -> str:
        """Return how the scene is looked at now."""
        return "" if self._scene is None else json.dumps(self._scene.camera())

    def restore(self, text: str) -> None:
        """Look as `text` says, also while the page and the probe are being loaded."""
        camera = _camera(text)
        self._restored = self._scene is not None and bool(camera)
        if self._scene is not None and camera:
            self._scene.hold(camera)
            self._timer.start()  # it is what a crash would come back to

    def release(self) -> None:
        """Let pages choose the view again: all is loaded, or another page is shown."""
        if self._restored and self._scene is not None:
            self._restored = False
            self._scene.release()

    def stop(self) -> None:
        """Remember nothing more: the session is being closed."""
        self._timer.stop()


def _camera(text: str) -> tuple[tuple[float, float, float], ...]:
    """Return a camera of a text; empty: it is none."""
    try:
        rows = tuple((float(x), float(y), float(z)) for x, y, z in json.loads(text))
    except (ValueError, TypeError):
        return ()
    numbers = [each for row in rows for each in row]
    well = all(math.isfinite(each) and abs(each) < _FARTHEST_M for each in numbers)
    apart = len(rows) == 4 and rows[0] != rows[1] and any(rows[2]) and rows[3][0] > 0
    return rows if well and apart else ()


# ---- the session's probe in the scene, also on pages that have no other mesh to show -------------


class SessionProbe(QObject):
    """Shows the newest probe of a session from its opening on, until a page shows one itself."""

    def open(self, bench: Bench) -> None:
        """Begin with a session: the scene is emptied, and shows its probe when it is read."""
        scene, folder, state = bench.scene, bench.desk.folder, bench.desk.state
        scene.show_field(None)
        scene.show_probe(None)
        found = state.newest("probe")
        if found is None:
            return

        def read(_progress: object, _cancelled: object) -> tuple[Probe, Sequence[Region]] | None:
            from contactbench.pipeline.mesh.sidecar import load_probe_file
            from contactbench.pipeline.session.recompute import inputs_of
            from contactbench.pipeline.verification.result import load_surface

            try:
                files = inputs_of(folder, state, {"probe": found.content})
                probe = load_surface(files["probe"])
                named = probe.region.any()
                return probe, load_probe_file(files["probe"]).regions.regions if named else ()
            except (InputError, OSError, LookupError):
                return None  # the page that needs it says why

        def came(found: tuple[Probe, Sequence[Region]] | None) -> None:
            if found is not None and scene.probe_layer.probe is None:
                scene.show_probe(found[0], regions=found[1])
                scene.look("fit")

        bench.jobs.start(self.tr("Loading probe"), read, came)


# ---- leaving a session in which work is going on -------------------------------------------------


class Departure(QObject):
    """
    Holds a session back from being closed while work is going on, until somebody has said what to do.

    Parameters
    ----------
    window : MainWindow

    Attributes
    ----------
    question : QMessageBox or None
        What is asked just now.
    wait, stop, stay : QPushButton
        Its answers; `wait` is left out where what goes on, such as a recording, does not end by itself.
    """

    def __init__(self, window: MainWindow) -> None:
        super().__init__(window)
        self._window = window
        self._settled = False
        self._go: Callable[[], object] | None = None  # to be done as soon as nothing goes on
        self.question: QMessageBox | None = None
        self.wait: QPushButton | None = None
        self.stop: QPushButton | None = None
        self.stay: QPushButton | None = None
        window.gone.connect(self._forget)

    def holds(self, go: Callable[[], object], stay: Callable[[], object] = lambda: None) -> bool:
        """
        Whether the session stays open for now; then somebody is asked, and `go` or `stay` follows the answer.

        A second time while it is asked, the question is only brought up.
        """
        if self._settled or not self._going_on():
            return False
        self._go = None
        if self.question is None:
            self._ask(go, stay)
        else:
            self.question.raise_()
        return True

    @property
    def waiting(self) -> bool:
        """Whether the session is closed as soon as nothing goes on."""
        return self._go is not None

    def look(self) -> None:
        """See whether what was waited for is done; called twice a second."""
        if self._go is not None and not self._going_on():
            go, self._go = self._go, None
            go()

    def _going_on(self) -> tuple[str, ...]:
        """Return what goes on, in sentences."""
        bench = self._window.bench
        if bench is None or bench.ending:
            return ()
        from contactbench.pipeline.session.why import GOING_ON  # it is there, for a session is open

        return tuple(translated(words) for step, words in GOING_ON.items() if step in bench.running)

    def _ask(self, go: Callable[[], object], stay: Callable[[], object]) -> None:
        bench = self._window.bench
        box = self.question = QMessageBox(self._window)
        box.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        box.setIcon(QMessageBox.Icon.Question)
        box.setWindowTitle(self.tr("Work in progress"))
        box.setText(" ".join(self._going_on()))
        role = QMessageBox.ButtonRole
        ends = bench is not None and not bench.live.taped
        box.setInformativeText(
            self.tr(
                "Stopping keeps all settings and recordings. The computation starts again when you reopen the"
                " session."
            )
            if ends
            else self.tr("Stopping keeps everything recorded so far. You can continue from there next time.")
        )
        self.wait = box.addButton(self.tr("Wait until done"), role.AcceptRole) if ends else None
        self.stop = box.addButton(self.tr("Stop and keep results"), role.DestructiveRole)
        self.stay = box.addButton(self.tr("Cancel"), role.RejectRole)
        box.setDefaultButton(self.wait or self.stay)
        box.setEscapeButton(self.stay)
        box.buttonClicked.connect(lambda button: self._answered(button, go, stay))
        box.open()

    def _answered(self, button: object, go: Callable[[], object], stay: Callable[[], object]) -> None:
        wait, stop = self.wait, self.stop
        self.question = self.wait = self.stop = self.stay = None
        if button is stop:
            self._settled = True
            go()
        elif wait is not None and button is wait:
            self._go = go
            self._window.tell(
                Weight.INFO,
                self.tr("The session closes as soon as the work is done. You can keep working until then."),
            )
            self.look()
        else:
            stay()

    def _forget(self) -> None:
        self._settled, self._go = False, None
