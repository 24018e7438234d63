"""What stays when a window with its session is opened and closed again and again: nothing may."""

import gc
import os
import threading
from collections import Counter
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from benchmarks.live.reader import resident
from benchmarks.window.driver import load, loaded, opened, own_home, rest, shown_window, until
from PySide6.QtCore import QEvent
from PySide6.QtWidgets import QApplication

from contactbench.pipeline.steps import Step
from contactbench.pipeline.study.report import Figure, StudyReport

_WARM = 3  # the first ones fill caches: fonts, icons, modules
_MOST_MB = 1.0  # for each time
_FEW = 8  # times of which none is left out


@dataclass(frozen=True)
class Census:
    """What there is in this process."""

    windows: int
    widgets: int
    threads: int
    processes: int
    files: int
    vtk: Counter[str]  # Objects of VTK that Python knows, by class
    memory: float  # MB


def run(times: int = 50, *, progress: Callable[[str], None] = lambda _: None) -> StudyReport:
    """Open a window with a virtual bench, show all pages, and close it."""
    before = load()
    with own_home() as home:
        session = home / "session"
        for _ in range(_WARM):
            _once(session)
        first = census()
        memories = [first.memory]
        for number in range(times):
            progress(f"{number + 1} of {times}")
            _once(session)
            memories.append((resident() or 0) / 1e6)
        last = census()
    grown = {name: last.vtk[name] - first.vtk[name] for name in last.vtk if last.vtk[name] > first.vtk[name]}
    figures = tuple(
        Figure(f"{times} times", f"{name} more", getattr(last, name) - getattr(first, name), most=0)
        for name in ("windows", "widgets", "threads", "processes", "files")
    )
    memory = growth(memories)
    figures += (
        Figure(f"{times} times", "objects of VTK more", sum(grown.values()), most=0),
        Figure(f"{times} times", "memory more, each time", memory, "MB", most=_MOST_MB),
    )
    kinds = ", ".join(f"{count} {name}" for name, count in sorted(grown.items()))
    counted = (
        f"Counted after {_WARM} times that fill caches; memory from the slope of the later half, for what the"
        " allocator keeps free comes and goes."
    )
    notes = (counted, loaded(before))
    return StudyReport(
        "Open and close", {"times": times}, figures, (f"More of VTK: {kinds}.", *notes) if kinds else notes
    )


def growth(memories: Sequence[float]) -> float:
    """Return by how much each is larger than the one before, in the later half, by least squares."""
    later = np.asarray(memories[len(memories) // 2 :] if len(memories) > _FEW else memories)
    return float(np.polyfit(np.arange(len(later)), later, 1)[0])


def census() -> Census:
    """Count what there is, after everything that can go has gone."""
    from vtkmodules.vtkCommonCore import vtkObjectBase

    for _ in range(3):
        QApplication.sendPostedEvents(None, QEvent.Type.DeferredDelete)
        gc.unfreeze()
        gc.collect()
        rest(0.1)
    vtk = Counter(type(each).__name__ for each in gc.get_objects() if isinstance(each, vtkObjectBase))
    return Census(
        len(QApplication.topLevelWidgets()),
        len(QApplication.allWidgets()),
        _threads(),
        _children(),
        _files(),
        vtk,
        (resident() or 0) / 1e6,
    )


def _once(session: Path) -> None:
    with shown_window() as window:
        bench = opened(window, lambda: window.sessions.try_virtual(session))
        until(lambda: window.pages.made, "the pages to be made")
        until(lambda: bench.live.ring.count > 0, "samples to come")
        for step in Step:
            window.show_step(step)
            rest(0.05)
    window.deleteLater()
    QApplication.sendPostedEvents(None, QEvent.Type.DeferredDelete)


def _threads() -> int:
    tasks = Path("/proc/self/task")
    return len(list(tasks.iterdir())) if tasks.is_dir() else threading.active_count()


def _children() -> int:
    children = Path(f"/proc/self/task/{os.getpid()}/children")
    return len(children.read_text(encoding="utf-8").split()) if children.exists() else 0


def _files() -> int:
    files = Path("/proc/self/fd")
    return len(list(files.iterdir())) if files.is_dir() else 0
