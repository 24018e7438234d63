"""The studies of the window, each in its short version: that they measure, and that they can fail."""

import gc
import json
import os
import subprocess
import sys
from typing import ClassVar

import pytest
from benchmarks.window import charts as study_charts
from benchmarks.window import stalls as study_stalls
from benchmarks.window.driver import loaded
from benchmarks.window.leaks import growth
from PySide6.QtCore import QCoreApplication, QEvent, QObject, QThread

from contactbench.app.heartbeat import Garbage
from contactbench.pipeline.study.report import Figure, StudyReport

pytestmark = [
    pytest.mark.window,
    pytest.mark.skipif(not sys.platform.startswith("linux"), reason="windows on a screen of X"),
]

TIMEOUT_S = 240


def study(*arguments):
    """Run a benchmark as a command; return its report, with its figures by subject and name."""
    command = [sys.executable, "-m", "benchmarks", f"window-{arguments[0]}", *arguments[1:], "--json"]
    done = subprocess.run(
        command, capture_output=True, text=True, timeout=TIMEOUT_S, check=False, env=os.environ
    )
    assert done.returncode in (0, 1), done.stderr[-2000:]
    report = json.loads(done.stdout)
    assert (done.returncode == 0) == report["passed"]
    return {(figure["subject"], figure["name"]): figure for figure in report["figures"]}


def test_the_start_is_measured_in_pairs():
    figures = list(study("startup", "--repeats", "1").values())
    assert [figure["unit"] for figure in figures] == ["s", "s", ""]
    assert figures[2]["most"] == 1.5
    assert figures[2]["measured"] == pytest.approx(figures[1]["measured"] / figures[0]["measured"])


def test_stalls_are_measured_while_everything_happens():
    figures = study("stalls", "--seconds", "4", "--facets", "4000")
    busy = "simplifying, turning, three streams"
    assert figures[busy, "meshes begun"]["measured"] >= 1
    assert figures[busy, "longest stall"]["most"] == 100.0
    assert figures[busy, "samples a second, slowest stream"]["measured"] > 100


def test_charts_are_counted_and_memory_is_watched():
    figures = study("charts", "--seconds", "6")
    assert figures["charts", "pictures a second"]["measured"] > 1
    assert figures["memory", "at the end"]["measured"] > 50


def test_the_brush_is_timed_by_what_it_paints():
    figures = study("brush", "--facets", "5000", "--events", "20")
    assert figures["brush", "painted anything (1: yes)"]["measured"] == 1
    assert figures["5000 facets", "mouse event to the frame that shows it"]["measured"] > 0


def test_nothing_stays_of_a_window_that_was_closed():
    figures = study("leaks", "--times", "2")
    for name in ("windows", "widgets", "processes", "objects of VTK"):
        assert figures["2 times", f"{name} more"]["measured"] <= 0


@pytest.mark.parametrize("page", ["gravity", "verify"])
def test_nothing_is_lost_by_an_end_without_warning(page):
    assert all(figure["passed"] for figure in study("kill", "--steps", page).values())


def test_a_page_that_there_is_not_is_refused_in_words():
    command = [sys.executable, "-m", "benchmarks", "window-kill", "--steps", "lunch"]
    done = subprocess.run(command, capture_output=True, text=True, timeout=60, check=False)
    assert done.returncode == 2
    assert "lunch" in done.stderr
    assert "gravity" in done.stderr


def test_memory_that_grows_misses_its_target():
    times = [float(second) for second in range(60)]
    assert study_charts._growth(times, [500.0] * 60) == 0.0
    grows = study_charts._growth(times, [500.0 + 0.1 * second for second in times])
    assert grows == pytest.approx(0.1)
    assert not StudyReport("", {}, (Figure("", "", grows * 1800, most=10.0),)).passed


def test_a_sink_keeps_what_streams_give():
    class Sample:
        time, force, torque = 1.0, (1.0, 2.0, 3.0), (0.0, 0.0, 0.0)

    sink = study_stalls.Sink()
    sink([Sample(), Sample()])
    assert sink.count == 2


def test_memory_grows_by_its_slope_and_not_by_one_jump():
    assert growth([100.0, 103.0]) == pytest.approx(3.0)
    assert growth([100.0, *(180.0 for _ in range(20))]) == pytest.approx(0.0, abs=1e-9)
    assert growth([100.0 + 2.0 * k + (-1) ** k for k in range(41)]) == pytest.approx(2.0, abs=0.05)


def test_the_load_is_said():
    assert loaded((1.5, 2)).startswith("Load 1.5 at the beginning and ")


def test_garbage_is_collected_in_the_thread_of_the_window_only(qtbot):
    class Cyclic(QObject):
        threads: ClassVar[list] = []

        def __init__(self):
            super().__init__()
            self.me = Watched(self)

    class Watched:
        def __init__(self, owner):
            self.owner = owner

        def __del__(self):
            Cyclic.threads.append(QThread.currentThread())

    garbage = Garbage()
    try:
        Cyclic()
        assert not gc.isenabled()
        garbage.clear()
        qtbot.waitUntil(lambda: Cyclic.threads != [], timeout=10_000)
    finally:
        garbage.deleteLater()
        QCoreApplication.sendPostedEvents(garbage, QEvent.Type.DeferredDelete)
    assert gc.isenabled() == (Garbage._there == 0)
    assert Cyclic.threads == [QThread.currentThread()]
