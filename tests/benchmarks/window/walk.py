"""
Walks through every page of the real window, in both languages and at several sizes, and prints what is wrong, as JSON.

A process of its own, for Qt takes its scale (QT_SCALE_FACTOR) from the environment when it starts:
``python -m benchmarks.window.walk SESSION [--pictures FOLDER]``.
"""

from __future__ import annotations

import argparse
import json
import os
import sys
import time
from pathlib import Path

from benchmarks.window.layout_faults import layout_faults
from PySide6.QtCore import QEvent, QEventLoop, QTimer
from PySide6.QtWidgets import QApplication, QTabWidget

from contactbench.app.application import prepared
from contactbench.app.settings import WindowSettings
from contactbench.app.translation import LANGUAGES, load
from contactbench.app.window import MainWindow
from contactbench.pipeline.workbench.steps import Step
from contactbench.widgets.theme import use_theme

SIZES = ((640, 340), (1024, 700), (1366, 728), (1920, 1040))
_LOOKS, _PAUSE_MS, _PATIENCE_S = 10, 30, 60.0


def rest(ms: int) -> None:
    loop = QEventLoop()
    QTimer.singleShot(ms, loop.quit)
    loop.exec()


def until(condition, what=str, patience=_PATIENCE_S) -> None:
    end = time.monotonic() + patience
    while not condition():
        if time.monotonic() > end:
            raise TimeoutError(what())
        rest(10)


def settled() -> None:
    """Have everything laid out that waits for it."""
    for _ in range(3):
        QApplication.sendPostedEvents(None, QEvent.Type.LayoutRequest)
        QApplication.processEvents()


class Walk:
    """One window, led from page to page."""

    def __init__(self, session: Path, mesh: Path, pictures: Path | None, theme: str) -> None:
        self.found: dict[str, list[str]] = {}
        self._session, self._mesh, self._pictures, self._theme = session, mesh, pictures, theme

    def go(self, language: str, sizes) -> None:
        self._language = language
        load(QApplication.instance(), language)
        window = self.window = MainWindow(WindowSettings())
        window.show()
        self._everywhere("start", sizes)
        window.sessions.open(self._session)
        until(lambda: window.bench is not None and window.bench.connected)
        if self._pictures is None:
            window.scene.setUpdatesEnabled(False)
        self._idle()
        for step in Step:
            window.show_step(step)
            self._idle()
            tabs = window.pages.current.findChild(QTabWidget)
            for index in range(tabs.count() if tabs is not None else 1):
                if tabs is not None:
                    tabs.setCurrentIndex(index)
                self._everywhere(f"{step}{index or ''}", sizes)
            if step is Step.PROBE:
                self._take_mesh(window.pages.current.stages)
                self._everywhere("mesh", sizes)
        window.close()
        until(lambda: not window.isVisible())
        window.deleteLater()
        rest(10)

    def _take_mesh(self, stages) -> None:
        """Take another mesh, and stop before its surface is made: that takes long."""
        stages.take(self._mesh)
        until(lambda: stages.mesh is not None and stages.mesh.file.name == self._mesh.name)
        stages.worker.stop()
        stages.changed.emit()
        self._idle()

    def _idle(self) -> None:
        settled()
        until(lambda: not self.window._running(), lambda: [each.title for each in self.window._running()])

    def _everywhere(self, page: str, sizes) -> None:
        for size in sizes:
            self.window.resize(*size)
            if self.window.bench is not None:
                self.window.docks.arrange()
            found = self._lasting()
            if self.window.size().toTuple() != size:
                found.append(f"asks for more room: {self.window.size().toTuple()} instead of {size}")
            for each in found:
                self.found.setdefault(f"{page}: {each}", []).append(f"{self._language} {size[0]}x{size[1]}")
            if self._pictures is not None:
                rest(400)
                name = f"{page}-{self._language}-{self._theme}-{size[0]}x{size[1]}.png"
                pic = self.window.screen().grabWindow(self.window.winId())
                pic.save(str(self._pictures / name))

    def _lasting(self) -> list[str]:
        """Return the faults that are still there when everything has found its place."""
        found: list[str] = []
        for _ in range(_LOOKS):
            settled()
            found = layout_faults(self.window)
            if not found:
                break
            rest(_PAUSE_MS)
        return found


def main() -> int:
    parser = argparse.ArgumentParser()
    parser.add_argument("session", type=Path)
    parser.add_argument("mesh", type=Path)
    parser.add_argument("--pictures", type=Path)
    parser.add_argument("--theme", default="light")
    parser.add_argument("--languages", default=",".join(LANGUAGES))
    options = parser.parse_args()
    prepared()
    use_theme(options.theme)
    walk = Walk(options.session, options.mesh, options.pictures, options.theme)
    for language in options.languages.split(","):
        walk.go(language, SIZES)
    json.dump({"found": walk.found, "cpu": time.process_time()}, sys.stdout, indent=1)
    sys.stdout.flush()
    os._exit(0)


if __name__ == "__main__":
    main()
