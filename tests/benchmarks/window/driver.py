"""What the studies of the window share: a home of their own, a window in it, waiting, and the machine's load."""

from __future__ import annotations

import os
import tempfile
import time
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

from PySide6.QtCore import QEventLoop, QTimer

from contactbench.app.application import prepared
from contactbench.app.errors import Faults
from contactbench.app.settings import WindowSettings
from contactbench.app.window import MainWindow
from contactbench.pipeline.errors import InputError
from contactbench.widgets.theme import use_theme

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from contactbench.app.bench import Bench

_POLL_MS = 5
_PATIENCE_S = 60.0
_SIZE = (1280, 800)
_HOME = "CONTACTBENCH_HOME"


@contextmanager
def own_home() -> Iterator[Path]:
    """Give a folder for settings, logs and sessions that is removed afterwards: nobody's own are touched."""
    before = os.environ.get(_HOME)
    with tempfile.TemporaryDirectory(prefix="contactbench-", ignore_cleanup_errors=True) as name:
        os.environ[_HOME] = str(Path(name) / "home")
        try:
            yield Path(name)
        finally:
            if before is None:
                del os.environ[_HOME]
            else:
                os.environ[_HOME] = before


@contextmanager
def shown_window() -> Iterator[MainWindow]:
    """Show a window as ``contactbench gui`` does; closed afterwards, with its session."""
    prepared()
    settings, faults = WindowSettings(), Faults()
    use_theme("light")
    window = MainWindow(settings, faults)
    faults.install()
    told: list[str] = []
    faults.happened.connect(lambda sentence, details, _expected: told.append(f"{sentence} {details}"))
    window.resize(*_SIZE)
    window.show()
    try:
        yield window
    finally:
        closed(window)
        faults.uninstall()
    if told:
        raise InputError(f"the window met a fault while it was measured: {told[0]}")


def closed(window: MainWindow) -> None:
    """Close a window, and wait until it and its session are; what goes on is stopped."""
    window.close()
    if window.departure.stop is not None:
        window.departure.stop.click()
    until(lambda: not window.isVisible() and window.bench is None, "the window to be closed")


def opened(window: MainWindow, begin: Callable[[], None]) -> Bench:
    """Begin to open a session; return it when its page is there."""
    before = window.bench
    begin()
    until(lambda: window.bench is not None and window.bench is not before, "the session to be opened")
    bench = window.bench
    assert bench is not None
    return bench


def until(condition: Callable[[], bool], what: str, seconds: float = _PATIENCE_S) -> None:
    """Run the event loop until something is so. InputError: it does not become so."""
    end = time.monotonic() + seconds
    while not condition():
        if time.monotonic() > end:
            raise InputError(f"waited {seconds:.0f} s for {what}: the window, or the machine, is stuck.")
        rest(_POLL_MS / 1000)


def rest(seconds: float) -> None:
    """Run the event loop for a time, s."""
    loop = QEventLoop()
    QTimer.singleShot(round(1000 * seconds), loop.quit)
    loop.exec()


def load() -> tuple[float, int]:
    """Return how many processes wanted to run in the last minute, and how many can at once."""
    return (os.getloadavg()[0] if hasattr(os, "getloadavg") else float("nan")), os.cpu_count() or 1


def loaded(before: tuple[float, int]) -> str:
    """Say how loaded the machine was: what every figure depends on."""
    return f"Load {before[0]:.1f} at the beginning and {load()[0]:.1f} at the end, on {before[1]} processors."
