"""Whether the strip charts keep their rate, and the window its memory, however long it runs."""

from __future__ import annotations

import time
from contextlib import ExitStack
from typing import TYPE_CHECKING

import numpy as np
from benchmarks.live.reader import resident
from benchmarks.live.trial import sensor_process
from benchmarks.window.driver import load, loaded, opened, own_home, rest, shown_window, until

from contactbench.pipeline.study.report import Figure, StudyReport

if TYPE_CHECKING:
    from collections.abc import Callable

    from contactbench.app.window import MainWindow

_RATE_HZ = 1000.0
_LEAST_HZ = 29.0  # of 30: a timer of 33 ms, and now and then one that is late
_MOST_GROWTH_MB = 10.0  # in 30 minutes
_HALF_HOUR_S = 1800.0
_LOOK_S = 0.5
_WARM = 0.25  # the share of the time in which buffers fill


def run(seconds: float = 60.0, *, progress: Callable[[str], None] = lambda _: None) -> StudyReport:
    """
    Let the charts of the real window show a sensor of 1 kHz, and count what they draw and what it takes.
    """
    before = load()
    with own_home() as home, ExitStack() as stack:
        url = stack.enter_context(sensor_process(home / "sent.bin", _RATE_HZ))
        window = stack.enter_context(shown_window())
        bench = opened(window, lambda: window.sessions.new(home / "session"))
        until(lambda: window.pages.made, "the pages to be made")
        bench.jobs.start("open", lambda _p, _c: bench.live.open(url, "still://?rpy=0,0,0"))
        until(lambda: bench.live.ring.count > 0, "samples to come")
        until(window.docks.charts_seen, "the charts to be seen")
        progress(f"showing the charts for {seconds:g} s")
        drawn, times, memory = _watched(window, seconds)
    gaps = 1e3 * np.diff(drawn)
    growth = _growth(times, memory) * _HALF_HOUR_S
    rate = (len(drawn) - 1) / (drawn[-1] - drawn[0])
    figures = (
        Figure("charts", "pictures a second", float(rate), "Hz", least=_LEAST_HZ),
        Figure.of("charts", "between two pictures", gaps, "ms"),
        Figure("memory", "growth in 30 minutes, from the slope", growth, "MB", most=_MOST_GROWTH_MB),
        Figure("memory", "at the end", float(memory[-1]), "MB"),
    )
    notes = (
        loaded(before),
        f"The slope leaves out the first {_WARM:.0%} of the time, in which buffers fill.",
    )
    return StudyReport("Strip charts", {"seconds": seconds, "rate": f"{_RATE_HZ:g} Hz"}, figures, notes)


def _watched(window: MainWindow, seconds: float) -> tuple[list[float], list[float], list[float]]:
    """Return when the charts were painted, when memory was looked at, and how much it was, MB."""
    from PySide6.QtCore import QEvent, QObject

    drawn: list[float] = []

    class Watch(QObject):
        def eventFilter(self, watched: QObject, event: QEvent) -> bool:
            if event.type() == QEvent.Type.Paint:
                drawn.append(time.monotonic())
            return super().eventFilter(watched, event)

    charts = window.live.charts
    assert charts is not None
    watch = Watch(window)
    charts.panes[0]._plot.viewport().installEventFilter(watch)
    times, memory = [], []
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        rest(_LOOK_S)
        times.append(time.monotonic())
        memory.append((resident() or 0) / 1e6)
    return drawn, times, memory


def _growth(times: list[float], memory: list[float]) -> float:
    """Return the slope of memory by Theil and Sen, MB/s: one step, as of a buffer that doubles, does not sway it."""
    first = int(_WARM * len(times))
    t, m = np.array(times[first:]), np.array(memory[first:])
    i, j = np.triu_indices(len(t), 1)
    return float(np.median((m[j] - m[i]) / (t[j] - t[i]))) if len(i) else 0.0
