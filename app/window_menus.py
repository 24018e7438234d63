"""The menus and their shortcuts."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from PySide6.QtCore import QObject, Qt, QUrl
from PySide6.QtGui import QAction, QActionGroup, QDesktopServices, QKeySequence
from PySide6.QtWidgets import QFileDialog, QMenu, QWidget
from shiboken6 import isValid

import contactbench
from contactbench.app.bench import Weight
from contactbench.app.dialogs import CheatSheet, TextDialog
from contactbench.app.help_book import TUTORIAL, HelpBook
from contactbench.app.start import session_name
from contactbench.app.translation import LANGUAGES
from contactbench.app.window_docks import first_size
from contactbench.pipeline.steps import Step
from contactbench.widgets.messages import filled
from contactbench.widgets.theme import dress, icon

if TYPE_CHECKING:
    from collections.abc import Callable

    from contactbench.app.heatmap_viewer import HeatmapViewer
    from contactbench.app.motion import MotionWindow
    from contactbench.app.window import MainWindow

_KEY = QKeySequence.StandardKey


class Menus(QObject):
    """Every menu of a window."""

    def __init__(self, window: MainWindow) -> None:
        super().__init__(window)
        self._window = window
        self._only_open: list[QAction] = []
        self._viewers: list[QWidget] = []
        self._file()
        self._edit()
        self._view()
        self._steps()
        self._tools()
        self._help()

    def set_open(self, is_open: bool) -> None:
        """Allow what needs a session, or not."""
        for action in self._only_open:
            action.setEnabled(is_open)

    # ---- menus -------------------------------------------------------------------------------------

    def _file(self) -> None:
        window, menu = self._window, self._menu(self.tr("&File"))
        sessions = window.sessions
        self._add(menu, self.tr("&New session…"), sessions.ask_new, _KEY.New)
        self._add(menu, self.tr("Try the &virtual bench"), sessions.try_virtual)
        self._add(menu, self.tr("&Open session…"), sessions.ask_open, _KEY.Open)
        self._recent = menu.addMenu(self.tr("&Recent sessions"))
        self._recent.aboutToShow.connect(self._list_recent)
        self._add(menu, self.tr("&Reload session"), self.open_again, only_open=True)
        self._add(menu, self.tr("&Close session"), window.close_session, "Ctrl+W", only_open=True)
        menu.addSeparator()
        self._add(menu, self.tr("Save &diagnostics…"), self.ask_diagnostics)
        menu.addSeparator()
        quits = self._add(menu, self.tr("&Quit"), window.close, "Ctrl+Q")
        quits.setMenuRole(QAction.MenuRole.QuitRole)

    def _edit(self) -> None:
        menu = self._menu(self.tr("&Edit"))
        self.undo = self._window.undo.createUndoAction(self._window, self.tr("Undo"))
        self.redo = self._window.undo.createRedoAction(self._window, self.tr("Redo"))
        self.undo.setIcon(icon("undo"))
        self.redo.setIcon(icon("redo"))
        self.undo.setShortcut("Ctrl+Z")
        self.redo.setShortcuts([QKeySequence("Ctrl+Y"), QKeySequence("Ctrl+Shift+Z")])
        menu.addActions([self.undo, self.redo])
        menu.addSeparator()
        words = self.tr("&Copy the picture of the 3D view")
        self._add(menu, words, self.copy_picture, "Ctrl+Shift+C", only_open=True)

    def _view(self) -> None:
        window, menu = self._window, self._menu(self.tr("&View"))
        for dock in window.docks.all:
            action = dock.toggleViewAction()
            menu.addAction(action)
            self._only_open.append(action)
        self._add(menu, self.tr("&Reset layout"), window.reset_layout, only_open=True)
        menu.addSeparator()
        themes = (
            ("system", self.tr("Follow &system")),
            ("light", self.tr("&Light")),
            ("dark", self.tr("&Dark")),
        )
        self._choice(menu, self.tr("&Theme"), themes, window.settings.now.theme, window.set_theme)
        languages = (("", self.tr("Follow s&ystem")), *((code, name) for code, name in LANGUAGES.items()))
        self._choice(menu, self.tr("Lan&guage"), languages, window.settings.now.language, self._set_language)
        menu.addSeparator()
        self.bench_mode = self._add(
            menu, self.tr("&Bench mode"), window.bench_mode.toggle, "F11", only_open=True
        )
        self.bench_mode.setIcon(icon("full"))
        self.bench_mode.setToolTip(self.tr("Bench mode: readable from two metres, with three keys (F11)"))
        window.addAction(self.bench_mode)  # its key holds also while the menus are hidden
        self._add(menu, self.tr("&Full screen"), self._full_screen, "Shift+F11").setCheckable(True)

    def _steps(self) -> None:
        window, menu = self._window, self._menu(self.tr("&Steps"))
        for number, step in enumerate(Step, 1):
            name = window.steps.name_of(step)
            show = partial(window.show_step, step)
            self._add(menu, f"&{number} {name}", show, f"Ctrl+{number}", only_open=True)

    def _tools(self) -> None:
        menu = self._menu(self.tr("&Tools"))
        self._add(menu, self.tr("&Heatmap viewer"), self.show_heatmap_viewer, "Ctrl+H")
        self._add(menu, self.tr("&Motion control on the virtual bench"), self.show_motion, "Ctrl+M")

    def _help(self) -> None:
        menu = self._menu(self.tr("&Help"))
        self.help_here = self._add(menu, self.tr("&This page"), self.show_help, _KEY.HelpContents)
        self.help_here.setIcon(icon("help"))
        self.help_here.setShortcut("F1")
        self._add(menu, self.tr("&Tutorial"), partial(self.show_help_page, TUTORIAL))
        documentation = self._add(menu, self.tr("&Documentation"), self.show_documentation)
        documentation.setVisible(start_page() is not None)
        self._add(menu, self.tr("&Shortcuts"), self.show_shortcuts, "Ctrl+/")
        self._add(menu, self.tr("&Log"), self.show_log)
        about = self._add(menu, self.tr("&About contactbench"), self.show_about)
        about.setMenuRole(QAction.MenuRole.AboutRole)

    # ---- what they do ------------------------------------------------------------------------------

    def copy_picture(self) -> None:
        """Put the picture of the 3D view into the clipboard."""
        scene, bench = self._window.scene, self._window.bench
        if scene is not None and bench is not None:
            scene.copy_picture()
            bench.tell(Weight.INFO, self.tr("The picture of the 3D view is in the clipboard."))

    def open_again(self) -> None:
        """Close the session and open it: what is to be done after a disk that was full."""
        bench = self._window.bench
        if bench is not None:
            self._window.sessions.open(bench.desk.folder)

    def show_help(self) -> None:
        """Show the help on what is looked at."""
        step = self._window.pages.step
        name = "start" if step is None else step.value
        self.show_help_page(name)

    def show_help_page(self, name: str) -> None:
        """Show a page of the help beside the window."""
        HelpBook.beside(self._window, name)

    def show_documentation(self) -> None:
        """Open the documentation that came with this installation in the browser."""
        page = start_page()
        if page is not None:
            QDesktopServices.openUrl(QUrl.fromLocalFile(str(page)))

    def show_shortcuts(self) -> None:
        """Show all keys."""
        CheatSheet(self._window).open()

    def show_log(self) -> None:
        """Show the log."""
        log = self._window.log
        stalls = self._window.heartbeat.stalls()
        words = self.tr("Longest UI stall {:.0f} ms; 99th percentile {:.0f} ms.")
        head = filled(words, 1000 * stalls.longest, 1000 * stalls.p99)
        text = self.tr("Logging is off.") if log is None else f"{log.file}\n\n{log.read()}"
        dialog = TextDialog(self.tr("Log"), f"{head}\n{text}", self._window)
        dialog.view.moveCursor(dialog.view.textCursor().MoveOperation.End)
        dialog.open()

    def show_about(self) -> None:
        """Show the version, and the licences of the parts."""
        from contactbench.app.dialogs import AboutDialog

        AboutDialog(self._window).open()

    def show_heatmap_viewer(self) -> HeatmapViewer:
        """Show the heatmap viewer in a window of its own."""
        from contactbench.app.heatmap_viewer import HeatmapViewer

        bench = self._window.bench
        viewer = HeatmapViewer()
        self._show_beside(viewer, self.tr("Heatmap viewer"))
        if bench is not None:
            viewer.open([bench.desk.folder])
        return viewer

    def show_motion(self) -> MotionWindow:
        """Show a closed loop in a window of its own; with a session, on the bundle that it would give."""
        from contactbench.app.motion import MotionWindow

        motion = MotionWindow(lambda: self._window.bench)
        self._show_beside(motion, self.tr("Motion control on the virtual bench"))
        if self._window.bench is not None:
            motion.use_session()
        return motion

    def _show_beside(self, viewer: QWidget, title: str) -> None:
        viewer.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        viewer.setWindowTitle(title)
        dress(viewer)
        self._viewers = [each for each in self._viewers if isValid(each)] + [viewer]
        viewer.resize(first_size(viewer))
        viewer.show()

    def close_windows(self) -> None:
        """Close what was opened beside the window."""
        for viewer in self._viewers:
            if isValid(viewer):
                viewer.close()
        self._viewers.clear()

    def ask_diagnostics(self) -> None:
        """Ask where to save diagnostics."""
        dialog = QFileDialog(self._window, self.tr("Save diagnostics"))
        dialog.setAcceptMode(QFileDialog.AcceptMode.AcceptSave)
        dialog.setNameFilter(self.tr("Zip files (*.zip)"))
        dialog.setDefaultSuffix("zip")
        dialog.selectFile("contactbench-diagnostics.zip")
        dialog.fileSelected.connect(lambda name: self.save_diagnostics(Path(name)))
        dialog.finished.connect(dialog.deleteLater)
        dialog.open()

    def save_diagnostics(self, file: Path) -> None:
        """Save diagnostics, without names of people and places, and without data."""
        from contactbench.app.diagnostics import save_diagnostics

        window = self._window
        bench, log = window.bench, window.log
        folder = None if bench is None else bench.desk.folder
        settings, stalls = window.settings.now, window.heartbeat.stalls()
        window.jobs.start(
            self.tr("Saving diagnostics"),
            lambda _p, _c: save_diagnostics(
                file, folder, "" if log is None else log.read(), settings, stalls
            ),
            lambda _: window.tell(
                Weight.GOOD,
                self.tr("Diagnostics saved as {}. They contain no recordings, meshes or names.").format(file),
            ),
        )

    # ---- how they are made -------------------------------------------------------------------------

    def _menu(self, title: str) -> QMenu:
        return self._window.menuBar().addMenu(title)

    def _add(
        self,
        menu: QMenu,
        text: str,
        does: Callable[[], object],
        key: QKeySequence | QKeySequence.StandardKey | str = "",
        *,
        only_open: bool = False,
    ) -> QAction:
        action = QAction(text, self._window)
        action.triggered.connect(lambda _=False: does())
        if key:
            action.setShortcut(QKeySequence(key))
        if only_open:
            self._only_open.append(action)
        menu.addAction(action)
        return action

    def _choice(
        self,
        menu: QMenu,
        title: str,
        choices: tuple[tuple[str, str], ...],
        now: str,
        choose: Callable[[str], object],
    ) -> None:
        below, group = menu.addMenu(title), QActionGroup(self)
        for value, words in choices:
            action = self._add(below, words, partial(choose, value))
            action.setCheckable(True)
            action.setChecked(value == now)
            group.addAction(action)

    def _list_recent(self) -> None:
        self._recent.clear()
        for each in self._window.settings.now.recent:
            folder = Path(each.folder)
            action = self._recent.addAction(session_name(folder))
            action.setToolTip(each.folder)
            action.triggered.connect(lambda _=False, folder=folder: self._window.sessions.open(folder))
        if self._recent.isEmpty():
            self._recent.addAction(self.tr("None yet")).setEnabled(False)

    def _set_language(self, code: str) -> None:
        self._window.settings.change(language=code)
        self._window.tell(Weight.INFO, self.tr("The language changes after a restart of contactbench."))

    def _full_screen(self) -> None:
        self._window.setWindowState(self._window.windowState() ^ Qt.WindowState.WindowFullScreen)


# ---- where the built documentation is, if it came with this installation -------------------------


def start_page() -> Path | None:
    """Return the first page of the documentation; None where `packaging/run docs` never built it."""
    page = Path(contactbench.__file__).parent / "documentation" / "index.html"
    return page if page.is_file() else None
