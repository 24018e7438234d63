"""What the 3D view costs on this computer, measured in a real window."""

from __future__ import annotations

import time
from typing import TYPE_CHECKING

import numpy as np
from PySide6.QtCore import QCoreApplication, QEventLoop, QPointF

from contactbench.pipeline.mesh import Probe
from contactbench.widgets.scene.probe_layer import ProbeLayer
from contactbench.widgets.scene.scene import Scene
from contactbench.widgets.scene.views import turned

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray


def ball(facets: int, radius: float = 0.04) -> Probe:
    """Return a ball of about so many facets, radius in m: quick to make in any number."""
    around = max(6, round((facets / 2) ** 0.5))
    rows = max(3, around)
    u = np.linspace(0.0, 2.0 * np.pi, around, endpoint=False)
    v = np.linspace(0.0, np.pi, rows + 1)[1:-1]
    x, y = np.outer(np.sin(v), np.cos(u)), np.outer(np.sin(v), np.sin(u))
    z = np.repeat(np.cos(v)[:, None], around, axis=1)
    vertices = radius * np.vstack([np.stack([x, y, z], axis=-1).reshape(-1, 3), [[0, 0, 1], [0, 0, -1]]])
    i, j = np.meshgrid(np.arange(len(v) - 1), np.arange(around), indexing="ij")
    a, b = i * around + j, i * around + (j + 1) % around
    c, d = a + around, b + around
    walls = np.stack([np.stack([a, c, b], -1), np.stack([b, c, d], -1)], axis=2).reshape(-1, 3)
    k, after, last = np.arange(around), (np.arange(around) + 1) % around, (len(v) - 1) * around
    north = np.column_stack([np.full(around, len(vertices) - 2), k, after])
    south = np.column_stack([np.full(around, len(vertices) - 1), last + after, last + k])
    return Probe.from_arrays(vertices, np.vstack([walls, north, south]).astype(np.int32), name="ball")


def measure(facets: int = 100_000, times: int = 15) -> dict[str, float]:
    """Measure a scene of its own."""
    probe = ball(facets)
    scene = Scene()
    scene.resize(900, 640)
    scene.show()
    frames: list[float] = []
    scene.drawn.connect(frames.append)
    try:
        _frame(scene, frames, lambda: None)
        result = {"facets": float(len(probe.faces)), "software": float(scene.view.software)}
        begin = time.perf_counter()
        scene.show_probe(probe)
        result["show_probe_ms"] = (time.perf_counter() - begin) * 1e3
        result["first_frame_ms"] = _frame(scene, frames, scene.view.update)
        _rest(400)
        result |= _parts(scene, probe, frames, times)
    finally:
        scene.close_scene()
        scene.close()
        scene.deleteLater()
    result["paint_share"] = result["paint_ms"] / result["add_again_ms"]
    return result


def _parts(scene: Scene, probe: Probe, frames: list[float], times: int) -> dict[str, float]:
    rng = np.random.default_rng(0)

    def paint() -> None:
        faces = rng.choice(len(probe.faces), 500, replace=False).astype(np.int32)
        scene.paint(faces, np.full((500, 3), 90, np.uint8))

    def again() -> None:
        ProbeLayer.show(scene.probe_layer, probe, np.full((len(probe.faces), 3), 120, np.uint8))
        scene.stage.stir()

    def live() -> None:
        point = probe.vertices[0] + rng.normal(0.0, 1e-3, 3)
        scene.show_force(rng.normal(0.0, 3.0, 3), point)
        scene.show_contact(point, np.eye(3) * 1e-6, point)

    def turn() -> None:
        position, focal, up, rest = scene.camera()
        angle = np.radians(7.0)
        R = np.array(
            [[np.cos(angle), -np.sin(angle), 0.0], [np.sin(angle), np.cos(angle), 0.0], [0.0, 0.0, 1.0]]
        )
        x, y, z = (float(value) for value in R @ np.array(position))
        scene.set_camera(((x, y, z), focal, up, rest))

    def median(action: Callable[[], None]) -> float:
        _frame(scene, frames, action)
        return float(np.median([_frame(scene, frames, action) for _ in range(times)]))

    def drag() -> None:
        scene.move_camera(turned(scene.projection().look, 0.1, 0.02))

    result = {"drag_ms": median(drag)}
    _rest(600)
    result |= {"turn_ms": median(turn), "paint_ms": median(paint), "live_ms": median(live)}
    result["pick_ms"] = _pick_ms(scene)
    result["add_again_ms"] = median(again)
    return result


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


def _rest(milliseconds: int) -> None:
    begin = time.perf_counter()
    while (time.perf_counter() - begin) * 1e3 < milliseconds:
        QCoreApplication.processEvents(QEventLoop.ProcessEventsFlag.AllEvents, 5)
