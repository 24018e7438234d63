"""
Walks through every page of the real window, in both languages and at several sizes, and prints what is wrong, as JSON.

A process of its own, for Qt takes its scale (QT_SCALE_FACTOR) from the environment when it starts:
``python -m benchmarks.window.walk SESSION [--pictures FOLDER]``.
"""

import argparse
import json
import os
import sys
import time
from pathlib import Path

from benchmarks.window.driver import rest, until
from benchmarks.window.layout_faults import access_faults, layout_faults, pale
from PySide6.QtCore import QEvent, QPoint
from PySide6.QtWidgets import QApplication, QDialog, QTabWidget

from contactbench.app.application import prepared
from contactbench.app.settings import WindowSettings
from contactbench.app.translation import LANGUAGES, load
from contactbench.app.window import MainWindow
from contactbench.pipeline.steps import Step
from contactbench.widgets.theme import use_theme

SIZES = ((640, 340), (1024, 700), (1366, 728), (1920, 1040))
_LOOKS, _PAUSE_S, _PATIENCE_S = 10, 0.03, 180.0


def settled() -> None:
    """Have everything laid out that waits for it."""
    for _ in range(3):
        QApplication.sendPostedEvents(None, QEvent.Type.LayoutRequest)
        QApplication.processEvents()


class Walk:
    """One window, led from page to page in one language."""

    def __init__(self, session: Path, mesh: Path, pictures: Path | None, theme: str) -> None:
        self.found: dict[str, list[str]] = {}
        self._session, self._mesh, self._pictures, self._theme = session, mesh, pictures, theme
        self._loud = pictures is not None
        self._bars: dict[tuple[int, int], tuple[int, ...]] = {}

    def go(self, language: str, sizes, access: bool) -> None:
        self._language, self._sizes, self._access = language, sizes, access
        self._bars.clear()
        load(QApplication.instance(), language)
        window = self.window = self._shown = MainWindow(WindowSettings())
        window.show()
        self._everywhere("start")
        window.sessions.open(self._session)
        until(
            lambda: window.bench is not None and window.bench.connected,
            "the session to be opened",
            _PATIENCE_S,
        )
        self._still(window.scene)
        for step in Step:
            window.show_step(step)
            self._idle()
            tabs = window.pages.current.findChild(QTabWidget)
            for index in range(tabs.count() if tabs is not None else 1):
                if tabs is not None:
                    tabs.setCurrentIndex(index)
                self._everywhere(f"{step}{index or ''}")
            if step is Step.PROBE:
                self._take_mesh(window.pages.current.stages)
                self._everywhere("mesh")
        if access:
            self._read()
        self._motion()
        self._heatmap()
        self._dialogs()
        window.close()
        until(lambda: not window.isVisible(), "the window to be closed", _PATIENCE_S)
        window.deleteLater()
        rest(0.01)

    def _motion(self) -> None:
        motion = self._shown = self.window.menus.show_motion()
        self._still(motion.picture.scene)
        until(motion.controls.start.isEnabled, "a motion to be possible", _PATIENCE_S)
        self._everywhere("motion")
        motion.close()

    def _heatmap(self) -> None:
        viewer = self._shown = self.window.menus.show_heatmap_viewer()
        self._still(viewer.sides[0].scene)
        until(lambda: viewer.sides[0].frame is not None, "the heatmap", _PATIENCE_S)
        self._everywhere("heatmap")
        viewer.close()

    def _dialogs(self) -> None:
        """Look at what opens over the window, as large as it opens in the smallest window."""
        window, departure = self.window, self.window.departure
        window.resize(*self._sizes[0])
        window.bench.set_running(Step.PROBE, going_on=True)
        for name, show in {
            "shortcuts": window.menus.show_shortcuts,
            "log": window.menus.show_log,
            "about": window.menus.show_about,
            "question": window.close,
        }.items():
            show()
            settled()
            (dialog,) = [each for each in window.findChildren(QDialog) if each.isVisible()]
            self._shown = dialog
            for each in self._lasting():
                self.found.setdefault(f"{name}: {each}", []).append(self._language)
            self._take_picture(name, dialog.size().toTuple())
            (departure.stay.click if name == "question" else dialog.close)()
            settled()
        window.bench.set_running(Step.PROBE, going_on=False)

    def _still(self, scene) -> None:
        if self._pictures is None:
            scene.setUpdatesEnabled(False)  # nobody looks at it, and without a graphics card it takes long

    def _take_mesh(self, stages) -> None:
        """Take another mesh, and stop before its surface is made: that takes long."""
        stages.take(self._mesh)
        until(
            lambda: stages.mesh is not None and stages.mesh.file.name == self._mesh.name,
            "the mesh",
            _PATIENCE_S,
        )
        stages.worker.stop()
        stages.changed.emit()
        self._idle()

    def _idle(self) -> None:
        settled()
        until(lambda: not self.window._running(), "all work to end", _PATIENCE_S)

    def _everywhere(self, page: str) -> None:
        for size in self._sizes:
            self._shown.resize(*size)
            if self._shown is self.window and self.window.bench is not None:
                self.window.docks.arrange()
            found = self._lasting()
            if self._shown.size().toTuple() != size:
                found.append(f"asks for more room: {self._shown.size().toTuple()} instead of {size}")
            found += self._moved(size)
            if self._access and size == self._sizes[-1]:
                found += self._hidden_from_some()
            if self._loud:
                print(f"{time.process_time():.1f} s: {page} {size} {found}", file=sys.stderr)  # noqa: T201
            for each in found:
                self.found.setdefault(f"{page}: {each}", []).append(f"{self._language} {size[0]}x{size[1]}")
            self._take_picture(page, size)

    def _take_picture(self, page: str, size) -> None:
        if self._pictures is not None:
            rest(0.3)
            name = f"{page}-{self._language}-{self._theme}-{size[0]}x{size[1]}.png"
            self._shown.screen().grabWindow(self._shown.winId()).save(str(self._pictures / name))

    def _lasting(self) -> list[str]:
        """Return the faults that are still there when everything has found its place."""
        found: list[str] = []
        for _ in range(_LOOKS):
            settled()
            found = layout_faults(self._shown)
            if not found:
                break
            rest(_PAUSE_S)
        return found

    def _moved(self, size) -> list[str]:
        """Return what is wrong with where the buttons of the foot are: the same on every page, whatever is said."""
        if self._shown is not self.window or self.window.bench is None:
            return []
        page, found = self.window.pages.current, []
        before = self._places()
        if before != self._bars.setdefault(size, before):
            found.append(f"the buttons are elsewhere: {before}, not {self._bars[size]}")
        kept, longest = page.bar.words, "A message that goes on and on, " * 12
        page.bar.say(longest)
        self.window.tell("warning", longest)
        self.window.strip.watch()
        settled()
        if self._places() != before:
            found.append(f"a message moves the buttons: {self._places()}, not {before}")
        page.bar.say(kept)
        return found

    def _places(self) -> tuple[int, ...]:
        page = self.window.pages.current
        places = []
        for each in (page.bar.primary, page.bar.second, self.window.scene):
            corner = each.mapTo(self.window, QPoint(0, 0))
            places += [corner.x(), corner.y(), each.width(), each.height()]
        return tuple(places)

    def _hidden_from_some(self) -> list[str]:
        window = self._shown
        if window is not self.window:
            page = window.controls
        else:
            page = window.start if window.bench is None else window.pages.current
        window.activateWindow()
        until(window.isActiveWindow, "the window to be active", _PATIENCE_S)
        return access_faults(window, page)

    def _read(self) -> None:
        """Look at all pages in both themes."""
        for theme in ("light", "dark"):
            use_theme(theme)
            for step in Step:
                self.window.show_step(step)
                settled()
                for each in pale(self.window):
                    self.found.setdefault(f"{step}: {each}", []).append(theme)
        use_theme(self._theme)


def main() -> int:
    parser = argparse.ArgumentParser()
    parser.add_argument("session", type=Path)
    parser.add_argument("mesh", type=Path)
    parser.add_argument("--pictures", type=Path)
    parser.add_argument("--theme", default="light")
    parser.add_argument("--sizes", help="such as 640x340,1366x728")
    parser.add_argument("--languages", default=",".join(LANGUAGES))
    parser.add_argument("--access", action="store_true", help="names, keys, focus and contrast, in English")
    options = parser.parse_args()
    sizes = SIZES
    if options.sizes:
        sizes = tuple(tuple(map(int, each.split("x"))) for each in options.sizes.split(","))
    prepared()
    use_theme(options.theme)
    walk = Walk(options.session, options.mesh, options.pictures, options.theme)
    for language in options.languages.split(","):
        walk.go(language, sizes, options.access and language == "en")
    json.dump({"found": walk.found, "cpu": time.process_time()}, sys.stdout, indent=1)
    sys.stdout.flush()
    os._exit(0)


if __name__ == "__main__":
    main()
