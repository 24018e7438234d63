"""Where the probe should be touched: markers with their names, and where each was found."""

from __future__ import annotations

import math
import time
from typing import TYPE_CHECKING, Any

import numpy as np
from vtkmodules.vtkCommonDataModel import vtkPolyData
from vtkmodules.vtkFiltersSources import vtkSphereSource

from contactbench.widgets.scene.label import Label
from contactbench.widgets.scene.shapes import cone, frame_on, segments
from contactbench.widgets.scene.stage import Shape

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from numpy.typing import NDArray

    from contactbench.widgets.scene.stage import SceneStage
    from contactbench.widgets.scene.views import Screen

_SIGNS = {"open": "", "done": " ✓", "failed": " ✗"}
_LONGER = 10.0  # how much longer than the error its arrow is


class MarkerLayer:
    """Draws markers."""

    def __init__(self, stage: SceneStage) -> None:
        self._stage = stage
        self._points: NDArray[np.float64] = np.zeros((0, 3))
        self._states: tuple[str, ...] = ()
        self._names: tuple[str, ...] = ()
        self._next: int | None = None
        self._balls: list[Shape] = []
        self._labels: list[Label] = []
        self._arrows: list[Shape] = []
        self._errors = Shape(stage, vtkPolyData())
        self._errors.plain()
        self._errors.show(False)

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
    ) -> None:
        """Show markers (k, 3), S, m."""
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
            ball.colour(colours.accent if first else tints.get(state, colours.stale))
            ball.look.SetAmbient(0.45)
            sign = "▸ " if first else ""
            label.offset = (10.0, 14.0) if first else (8.0, 0.0)
            label.write(f"{sign}{self._names[i]}{_SIGNS.get(state, '')}", colours.text, bold=first)
        self._errors.colour(colours.bad)
        for head in self._arrows:
            head.colour(colours.bad)
        self._errors.look.SetLineWidth(3.0 * self._stage.ratio)
        self.turn()

    def turn(self) -> None:
        """Follow the tool."""
        for i in range(len(self._balls)):
            self._place(i, 1.0)
        for arrow in (self._errors, *self._arrows):
            arrow.place()

    def pulse(self) -> None:
        """Draw the next marker as large as it is at this moment of its second."""
        if self._next is not None and self.pulses:
            self._place(self._next, 1.4 + 0.4 * math.sin(2.0 * math.pi * time.monotonic()))

    def _place(self, i: int, times: float) -> None:
        radius = 0.014 * self._stage.size * times
        T = np.diag([radius, radius, radius, 1.0])
        T[:3, 3] = self._points[i]
        self._balls[i].place(T)

    def label(self, screen: Screen, seen: Callable[[NDArray[np.float64]], bool]) -> None:
        """Put the names where the markers are on screen; of those behind the probe only the next one has its name."""
        if not len(self._points):
            return
        turn = self._stage.turn
        places = screen.project(self._points @ turn[:3, :3].T + turn[:3, 3])
        for i, label in enumerate(self._labels):
            visible = i == self._next or seen(self._points[i])
            label.put(places[i, 0], places[i, 1], visible, screen.height)

    def show_errors(self, starts: NDArray[np.float64], ends: NDArray[np.float64]) -> None:
        """Show where markers (k, 3) were found (k, 3), as arrows that are longer than the errors."""
        starts, ends = np.reshape(starts, (-1, 3)), np.reshape(ends, (-1, 3))
        good = np.isfinite(starts).all(axis=1) & np.isfinite(ends).all(axis=1)
        starts, along = starts[good], _LONGER * (ends - starts)[good]
        for arrow in self._arrows:
            arrow.remove()
        self._arrows = []
        self._errors.show(len(starts) > 0)
        self._errors.give(segments(np.stack([starts, starts + along], axis=1).reshape(-1, 3)))
        for start, step in zip(starts, along, strict=True):
            length = float(np.linalg.norm(step))
            if length > 0.0:
                head = min(0.025 * self._stage.size, 0.5 * length)
                arrow = Shape(self._stage, cone())
                arrow.place(frame_on(start + step, step) @ np.diag([0.4 * head, 0.4 * head, head, 1.0]))
                self._arrows.append(arrow)
        self.dress()


def _ball() -> Any:
    source = vtkSphereSource()
    source.SetRadius(1.0)
    source.SetThetaResolution(20)
    source.SetPhiResolution(14)
    source.Update()
    return source.GetOutput()
