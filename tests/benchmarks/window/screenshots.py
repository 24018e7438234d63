"""Pictures of the real window, for the README: of each page, the first one, a closed loop, and the heatmap viewer."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from benchmarks.window.driver import own_home, rest, until
from benchmarks.window.screenshots_session import go_on, make_session, press, turn
from PySide6.QtCore import QBuffer, QIODevice, QPoint
from PySide6.QtWidgets import QWidget

from contactbench.app.application import prepared
from contactbench.app.heatmap_viewer import HeatmapViewer
from contactbench.app.settings import WindowSettings
from contactbench.app.translation import load
from contactbench.app.window import MainWindow
from contactbench.pipeline.durable import write_durably
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.steps import Step
from contactbench.widgets.theme import dress, use_theme

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from PySide6.QtGui import QPixmap

START, MOTION, HEATMAP = "start", "motion", "heatmap"
PAGES = (START, *(step.value for step in Step), MOTION, HEATMAP)
THEMES = ("light", "dark")
_PATIENCE_S, _SETTLED_S = 180.0, 0.4
_WATCHED_S = 9.0  # of a closed loop: by then it tracks, and the phantom moves
_TILT = 0.35  # rad, about y: how the tool stands in the pictures


def run(
    out: Path,
    themes: Sequence[str] = ("light",),
    size: tuple[int, int] = (1280, 800),
    pages: Sequence[str] = PAGES,
    language: str = "en",
) -> int:
    """
    Drive the real window on a virtual bench and write a PNG of each page, ``PAGE.png`` or ``PAGE-dark.png``.
    """
    _check(themes, pages)
    application = prepared()
    load(application, language)
    room = application.primaryScreen().geometry()
    if room.width() < size[0] or room.height() < size[1]:
        raise InputError(
            f"a window of {size[0]}x{size[1]} px does not fit on this screen ({room.width()}x{room.height()} px): give"
            " a smaller --size."
        )
    out.mkdir(parents=True, exist_ok=True)
    with own_home() as home:  # nothing of the person who makes them is seen, or changed
        session = home / "home" / "sessions" / "t-shape probe"
        session.parent.mkdir(parents=True)
        if set(pages) - {START}:
            make_session(session, lambda what: print(f"preparing: {what}"))  # noqa: T201
        for theme in themes:
            use_theme(theme)
            for name, picture in _Tour(session, size, pages).pictures():
                file = out / f"{name}{'' if theme == 'light' else f'-{theme}'}.png"
                write_durably(file, _png(picture))
                print(file)  # noqa: T201
    return 0


def _check(themes: Sequence[str], pages: Sequence[str]) -> None:
    for given, known, what in ((themes, THEMES, "theme"), (pages, PAGES, "page")):
        for each in given:
            if each not in known:
                raise InputError(f"there is no {what} {each!r}: choose of {', '.join(known)}.")


class _Tour:
    """The window, led from page to page."""

    def __init__(self, session: Path, size: tuple[int, int], pages: Sequence[str]) -> None:
        self._session, self._size, self._wanted = session, size, pages
        self._window: MainWindow | None = None

    def pictures(self) -> list[tuple[str, QPixmap]]:
        """Return the pictures that are wanted, by name."""
        made: list[tuple[str, QPixmap]] = []
        if set(self._wanted) - {HEATMAP}:
            self._window = window = MainWindow(WindowSettings())
            self._place(window)
            if START in self._wanted:
                made.append((START, self._taken(window)))
            steps = [step for step in Step if step.value in self._wanted]
            if steps or MOTION in self._wanted:
                self._open(window)
            made += [(step.value, self._step(window, step)) for step in steps]
            if MOTION in self._wanted:
                made.append((MOTION, self._motion(window)))
            self._close(window)
        if HEATMAP in self._wanted:
            made.append((HEATMAP, self._heatmap()))
        return made

    def _place(self, window: QWidget) -> None:
        window.show()
        window.setGeometry(0, 0, *self._size)
        window.raise_()
        window.activateWindow()

    def _open(self, window: MainWindow) -> None:
        window.sessions.open(self._session)
        self._until(lambda: window.bench is not None and window.bench.live.pair is not None)
        assert window.bench is not None
        c, s = np.cos(_TILT), np.sin(_TILT)
        turn(window.bench.live, np.array([[c, 0, s], [0, 1, 0], [-s, 0, c]]), 6.0)
        self._idle(window)
        window.messages.clear()

    def _step(self, window: MainWindow, step: Step) -> QPixmap:
        bench = window.bench
        assert bench is not None
        window.show_step(step)
        go_on(bench.live, 1.0)
        self._idle(window)
        bench.scene.look("fit")
        if step is Step.VERIFY:
            return self._touching(window)
        return self._taken(window)

    def _touching(self, window: MainWindow) -> QPixmap:
        """Touch some markers, and take the picture while the next one is pressed."""
        page, bench = window.pages.current, window.bench
        assert bench is not None
        from contactbench.app.pages.verify import VerifyPage

        assert isinstance(page, VerifyPage)
        self._until(lambda: page.work.tool is not None and len(page.work.markers) > 0)
        page.start()
        self._until(lambda: page.work.touches is not None)
        touches = page.work.touches
        assert touches is not None
        for index in (1, 2, 3, 0):  # the first is on the shaft: its arrow fits into the view
            press(bench.live, touches.markers[index].point_S, after=-0.25 if index == 0 else 0.3)
            rest(0.2)
        picture = self._taken(window)
        go_on(bench.live, 1.0)
        page.discard()
        self._until(lambda: not page.work.going_on)
        return picture

    def _motion(self, window: MainWindow) -> QPixmap:
        """Run the session's bundle, and take the picture while it tracks."""
        motion = window.menus.show_motion()
        self._place(motion)
        self._until(motion.controls.start.isEnabled)
        motion.begin()
        run = motion.run
        assert run is not None
        self._until(lambda: not run.running or (run.newest is not None and run.newest.time_s > _WATCHED_S))
        picture = self._taken(motion)
        motion.close()
        return picture

    def _heatmap(self) -> QPixmap:
        viewer = HeatmapViewer()
        dress(viewer)
        self._place(viewer)
        viewer.open([self._session])
        self._until(lambda: not viewer.jobs.running)
        picture = self._taken(viewer)
        viewer.close_viewer()
        viewer.deleteLater()
        return picture

    def _close(self, window: MainWindow) -> None:
        window.close()
        self._until(lambda: not window.isVisible())
        window.deleteLater()
        rest(0.1)

    # ---- waiting -----------------------------------------------------------------------------------

    def _idle(self, window: MainWindow) -> None:
        """Wait until nothing is computed any more."""
        bench = window.bench
        rest(_SETTLED_S)
        self._until(lambda: not window.jobs.running and (bench is None or not bench.jobs.running))
        rest(_SETTLED_S)

    def _taken(self, window: QWidget) -> QPixmap:
        """Take the picture from the screen: what OpenGL draws is only there; no part of it has the focus."""
        if (focused := window.focusWidget()) is not None:
            focused.clearFocus()
        rest(_SETTLED_S)
        corner = window.mapToGlobal(QPoint(0, 0))
        return window.screen().grabWindow(0, corner.x(), corner.y(), window.width(), window.height())

    @staticmethod
    def _until(condition: Callable[[], bool]) -> None:
        until(condition, "the next picture", _PATIENCE_S)


def _png(picture: QPixmap) -> bytes:
    buffer = QBuffer()
    buffer.open(QIODevice.OpenModeFlag.WriteOnly)
    picture.save(buffer, "PNG")
    return bytes(buffer.data().data())
