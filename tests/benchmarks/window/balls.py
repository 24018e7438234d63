"""What the 3D view costs on this computer, measured in a real window."""

import time
from collections.abc import Callable

import numpy as np
from benchmarks.solids import globe
from benchmarks.window.driver import rest
from numpy.typing import NDArray
from PySide6.QtCore import QCoreApplication, QEventLoop, QPointF

from contactbench.pipeline.mesh import Probe
from contactbench.widgets.scene.probe_layer import ProbeLayer
from contactbench.widgets.scene.scene import Scene


def ball(facets: int, radius: float = 0.04) -> Probe:
    """Return a ball of about so many facets, radius in m: quick to make in any number."""
    mesh = globe(facets, lambda directions: 1e3 * radius * directions)
    return Probe.from_arrays(1e-3 * mesh.vertices, mesh.faces, name="ball")


def measure(facets: int, times: int) -> tuple[float, float]:
    """Return the time of painting over that of showing all facets anew, and that of a pick, ms."""
    probe, rng = ball(facets), np.random.default_rng(0)
    scene = Scene()
    scene.resize(900, 640)
    scene.show()
    frames: list[float] = []
    scene.drawn.connect(frames.append)

    def paint() -> None:
        faces = rng.choice(len(probe.faces), 500, replace=False).astype(np.int32)
        scene.paint(faces, np.full((500, 3), 90, np.uint8))

    def again() -> None:
        ProbeLayer.show(scene.probe_layer, probe, np.full((len(probe.faces), 3), 120, np.uint8))
        scene.stage.stir()

    def median(action: Callable[[], None]) -> float:
        _frame(scene, frames, action)
        return float(np.median([_frame(scene, frames, action) for _ in range(times)]))

    try:
        scene.show_probe(probe)
        _frame(scene, frames, scene.view.update)
        rest(1.0)
        return median(paint) / median(again), _pick_ms(scene)
    finally:
        scene.close_scene()
        scene.close()
        scene.deleteLater()


def _pick_ms(scene: Scene) -> float:
    places: NDArray[np.float64] = np.random.default_rng(1).uniform(0.3, 0.7, (200, 2))
    places = places * [scene.view.width(), scene.view.height()]
    scene.pick_at(QPointF(0, 0))
    begin = time.perf_counter()
    for x, y in places:
        scene.pick_at(QPointF(x, y))
    return (time.perf_counter() - begin) * 1e3 / len(places)


def _frame(scene: Scene, frames: list[float], action: Callable[[], None]) -> float:
    """Return the time from an action to its frame on screen, ms; the scene's own pause before it is left out."""
    count = len(frames)
    begin = time.perf_counter()
    action()
    scene.view.update()
    while len(frames) == count and time.perf_counter() - begin < 20.0:
        QCoreApplication.processEvents(QEventLoop.ProcessEventsFlag.AllEvents, 5)
    return (time.perf_counter() - begin) * 1e3
