"""How soon paint is seen under the brush, and how long it takes to find the facet under the pointer."""

from __future__ import annotations

import time
from typing import TYPE_CHECKING

import numpy as np
from benchmarks.window.balls import ball
from benchmarks.window.driver import load, loaded, opened, own_home, rest, shown_window, until
from PySide6.QtCore import QEvent, QPointF, Qt
from PySide6.QtGui import QMouseEvent
from PySide6.QtWidgets import QApplication, QWidget

from contactbench.pipeline.mesh.regions.region import RegionSet
from contactbench.pipeline.mesh.sidecar import ProbeFile, save_probe_file
from contactbench.pipeline.steps import Step
from contactbench.pipeline.study.report import Figure, StudyReport

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from contactbench.app.pages.regions import RegionsPage
    from contactbench.app.window import MainWindow

_FEEDBACK_MS, _PICK_MS = 33.0, 1.0
_EVENTS_HZ = 60.0
_BETWEEN_S = 1 / _EVENTS_HZ


def run(
    facets: int = 100_000, events: int = 200, *, progress: Callable[[str], None] = lambda _: None
) -> StudyReport:
    """Paint in the 3D view of the real window with mouse events, 60 a second, as a mouse gives them."""
    before = load()
    with own_home() as home, shown_window() as window:
        progress(f"making a session with a probe of {facets} facets")
        make_session(home / "session", facets)
        opened(window, lambda: window.sessions.open(home / "session"))
        until(lambda: window.pages.made, "the pages to be made")
        window.show_step(Step.REGIONS)
        page = _regions_page(window)
        until(lambda: page.work is not None, "the surface to be there")
        page.panel.regions.add_button.click()
        rest(1.0)
        progress(f"painting with {events} mouse events")
        waits, frames, spent = _stroke(window, events)
        picks = _picks(window, 500)
        painted = page.work is not None and bool(page.work.model.labels.any())
    figures = (
        Figure.of(f"{facets} facets", "mouse event to the frame that shows it", waits, "ms"),
        Figure(
            f"{facets} facets",
            "the same, 95 of 100",
            float(np.percentile(waits, 95)),
            "ms",
            most=_FEEDBACK_MS,
        ),
        Figure.of(f"{facets} facets", "a frame", frames, "ms"),
        Figure(f"{facets} facets", "work of the window itself for each frame", spent, "ms"),
        Figure.of(f"{facets} facets", "finding the facet under the pointer", picks, "ms"),
        Figure("picking", "99 of 100", float(np.percentile(picks, 99)), "ms", most=_PICK_MS),
        Figure("brush", "painted anything (1: yes)", float(painted), least=1),
    )
    return StudyReport("Brush", {"facets": facets, "events": events}, figures, (loaded(before),))


def make_session(folder: Path, facets: int) -> None:
    """Make a session whose mesh is a ball of so many facets in the sensor's frame."""
    from contactbench.pipeline.session import Session
    from contactbench.pipeline.session.recompute import compute, newest_inputs

    file = folder.with_name("ball.ply")
    probe = ball(facets)
    save_probe_file(ProbeFile(probe, RegionSet.empty(len(probe.faces)), "S"), file)
    with Session.create(folder) as session:
        session.add_input(file, "mesh")
        compute(session, "probe", "probe.ply", newest_inputs(session.state, "probe"), {"facets": facets})


def _stroke(window: MainWindow, events: int) -> tuple[list[float], list[float], float]:
    """Paint a spiral, and measure; all in ms."""
    scene = window.scene
    assert scene is not None
    view = scene.view
    frames: list[float] = []
    ends: list[float] = []
    scene.drawn.connect(frames.append)
    scene.drawn.connect(lambda _ms: ends.append(time.perf_counter()))
    middle, reach = QPointF(view.rect().center()), 0.22 * min(view.width(), view.height())
    sent: list[float] = []
    until(lambda: scene.mouse.tool == "brush" and scene.pick_at(middle) is not None, "the brush on the probe")
    rest(0.5)
    send_mouse(view, QEvent.Type.MouseButtonPress, middle)
    rest(0.1)
    frames.clear()
    spent = time.thread_time()
    for number in range(events):
        angle = 0.12 * number
        away = reach * (0.3 + 0.7 * number / events)
        sent.append(time.perf_counter())
        send_mouse(view, QEvent.Type.MouseMove, middle + away * QPointF(np.cos(angle), np.sin(angle)))
        rest(max(0.0, _BETWEEN_S - (time.perf_counter() - sent[-1])))
    rest(0.2)
    spent = time.thread_time() - spent
    send_mouse(view, QEvent.Type.MouseButtonRelease, middle)
    moments = np.array(ends)
    after = np.searchsorted(moments, sent)
    waits = [1e3 * float(moments[k] - at) for k, at in zip(after, sent, strict=True) if k < len(moments)]
    return waits, frames, 1e3 * spent / max(len(frames), 1)


def send_mouse(view: QWidget, kind: QEvent.Type, place: QPointF) -> None:
    """Send a mouse event with the left button to a widget."""
    left, none = Qt.MouseButton.LeftButton, Qt.MouseButton.NoButton
    held = none if kind is QEvent.Type.MouseButtonRelease else left
    pressed = none if kind is QEvent.Type.MouseMove else left
    there = view.mapToGlobal(place)
    event = QMouseEvent(kind, place, there, pressed, held, Qt.KeyboardModifier.NoModifier)
    QApplication.sendEvent(view, event)


def _picks(window: MainWindow, count: int) -> list[float]:
    scene = window.scene
    assert scene is not None
    places = np.random.default_rng(1).uniform(0.3, 0.7, (count, 2))
    took = []
    for x, y in places * [scene.view.width(), scene.view.height()]:
        began = time.perf_counter()
        scene.pick_at(QPointF(x, y))
        took.append(1e3 * (time.perf_counter() - began))
    return took


def _regions_page(window: MainWindow) -> RegionsPage:
    from contactbench.app.pages.regions import RegionsPage

    page = window.pages.current
    assert isinstance(page, RegionsPage)
    return page
