"""Where the probe should be touched: markers with their names."""

from __future__ import annotations

import math
import time
from typing import TYPE_CHECKING, Any

import numpy as np
from vtkmodules.vtkFiltersSources import vtkSphereSource

from contactbench.widgets.scene.label_board import Label, LabelBoard
from contactbench.widgets.scene.stage import SceneStage, Shape, frame_on, rim

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from numpy.typing import NDArray

    from contactbench.pipeline.mesh import Probe
    from contactbench.widgets.scene.views import Pick, Screen

_SIGNS = {"open": "", "done": " ✓", "failed": " ✗"}
_RADIUS = 0.014  # of a marker's ball, of the probe's size


class MarkerLayer:
    """Draws markers."""

    def __init__(self, stage: SceneStage) -> None:
        self._stage = stage
        self._points: NDArray[np.float64] = np.zeros((0, 3))
        self._states: tuple[str, ...] = ()
        self._names: tuple[str, ...] = ()
        self._next: int | None = None
        self._worst: int | None = None
        self._tints: tuple[str, ...] = ()
        self._balls: list[Shape] = []
        self._labels: list[Label] = []

    @property
    def pulses(self) -> bool:
        """Whether there is a next one."""
        return self._next is not None and self._next < len(self._points)

    def show(
        self,
        points: NDArray[np.float64],
        names: Sequence[str],
        states: Sequence[str],
        next_one: int | None,
        tints: Sequence[str] = (),
        worst: int | None = None,
    ) -> None:
        """Show markers (k, 3), S, m, in the colours of their states, or in tints ``#rrggbb`` where these are given."""
        self._tints, self._worst = tuple(tints), worst
        self._points = np.array(points, float).reshape(-1, 3)
        count = len(self._points)
        self._names = (*names, *(str(i + 1) for i in range(len(names), count)))[:count]
        self._states = (*states, *("open" for _ in range(len(states), count)))[:count]
        self._next = next_one
        while len(self._balls) > count:
            self._balls.pop().remove()
            self._labels.pop().remove()
        while len(self._balls) < count:
            self._balls.append(Shape(self._stage, _ball()))
            self._labels.append(Label(self._stage))
        self.dress()

    def dress(self) -> None:
        """Take the theme's colours."""
        colours = self._stage.colours
        tints = {"open": colours.series[5], "done": colours.good, "failed": colours.bad}
        for i, (ball, label) in enumerate(zip(self._balls, self._labels, strict=True)):
            state = self._states[i]
            first = i == self._next
            tint = self._tints[i] if i < len(self._tints) else ""
            ball.colour(colours.accent if first else tint or tints.get(state, colours.stale))
            ball.look.SetAmbient(0.45)
            sign = "▸ " if first else ""
            words = f"{sign}{self._names[i]}{_SIGNS.get(state, '')}"
            label.write(words, colours.text, bold=first or i == self._worst)
            self._place(i, 1.0)

    def pulse(self) -> None:
        """Draw the next marker as large as it is at this moment of its second."""
        if self._next is not None and self.pulses:
            self._place(self._next, 1.4 + 0.4 * math.sin(2.0 * math.pi * time.monotonic()))

    def _place(self, i: int, times: float) -> None:
        radius = _RADIUS * self._stage.size * times
        T = np.diag([radius, radius, radius, 1.0])
        T[:3, 3] = self._points[i]
        self._balls[i].place(T)

    def label(self, screen: Screen, seen: Callable[[NDArray[np.float64]], bool], board: LabelBoard) -> None:
        """Put the names where the markers are on screen; of those behind the probe only the next one has its name."""
        if not len(self._points):
            return
        turn = self._stage.turn
        places = screen.project(self._points @ turn[:3, :3].T + turn[:3, 3])
        radius = _RADIUS * self._stage.size / screen.metres_per_pixel
        for i, label in enumerate(self._labels):
            x, y = places[i, :2]
            first = i in (self._next, self._worst)
            visible = first or seen(self._points[i])
            if visible:
                board.keep_free(x, y, radius * (1.8 if i == self._next else 1.0))
            board.want(label, x, y, visible, 0 if first else 3 if self._states[i] == "failed" else 4)


def _ball() -> Any:
    source = vtkSphereSource()
    source.SetRadius(1.0)
    source.SetThetaResolution(20)
    source.SetPhiResolution(14)
    source.Update()
    return source.GetOutput()


# ---- the brush's circle, which lies on the surface under the pointer -----------------------------


class BrushLayer:
    """Draws a white circle on a black one, which is seen on every colour."""

    def __init__(self, stage: SceneStage) -> None:
        self._stage = stage
        self._radius = 0.0
        self._rings = (Shape(stage, rim()), Shape(stage, rim()))
        for shape, colour, lift in zip(self._rings, ("#000000", "#ffffff"), (2.0, 2.5), strict=True):
            shape.plain()
            shape.lift(lift)
            shape.colour(colour)
            shape.show(False)
        self.dress()

    def dress(self) -> None:
        """Take the pixels' size."""
        for shape, width in zip(self._rings, (4.0, 1.6), strict=True):
            shape.look.SetLineWidth(width * self._stage.ratio)

    def set_radius(self, radius: float) -> None:
        """Choose its radius, m; 0: no circle."""
        self._radius = radius
        if radius <= 0.0:
            self.show(None, None)

    def show(self, pick: Pick | None, probe: Probe | None) -> None:
        """Lie on the surface at a place, or nowhere."""
        shown = pick is not None and probe is not None and self._radius > 0.0
        for shape in self._rings:
            shape.show(shown)
            if shown and pick is not None and probe is not None:
                shape.place(frame_on(pick.point, probe.normals[pick.face], self._radius))
