"""The force as an arrow: so many millimetres per newton, its tip where it acts."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from contactbench.widgets.scene.shapes import cone, cylinder, frame_on
from contactbench.widgets.scene.stage import Shape

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from contactbench.widgets.scene.stage import SceneStage

_METRES_PER_NEWTON = 0.005
_LEAST = 1e-4  # m: a shorter arrow is none


class ForceLayer:
    """Draws the force."""

    def __init__(self, stage: SceneStage) -> None:
        self._stage = stage
        self._shaft, self._head = Shape(stage, cylinder()), Shape(stage, cone())
        self.show(None, None)
        self.dress()

    def dress(self) -> None:
        """Take the theme's colours."""
        for shape in (self._shaft, self._head):
            shape.colour(self._stage.colours.series[1])
            shape.look.SetAmbient(0.35)

    def turn(self) -> None:
        """Follow the tool."""
        self._shaft.place()
        self._head.place()

    def show(self, force: NDArray[np.float64] | None, at: NDArray[np.float64] | None) -> None:
        """Show a force (3,), N, with its tip at a point (3,), m."""
        length = 0.0 if force is None else float(np.linalg.norm(force)) * _METRES_PER_NEWTON
        shown = bool(np.isfinite(length)) and length > _LEAST
        self._shaft.show(shown)
        self._head.show(shown)
        if force is None or not shown:
            return
        tip = np.zeros(3) if at is None else np.asarray(at, float)
        thick = 0.011 * self._stage.size
        head = min(4.0 * thick, 0.6 * length)
        self._head.place(frame_on(tip, force) @ np.diag([0.45 * head, 0.45 * head, head, 1.0]))
        base = tip - head * np.asarray(force) / np.linalg.norm(force)
        width = min(0.5 * thick, 0.18 * head)
        self._shaft.place(frame_on(base, force) @ np.diag([width, width, length - head, 1.0]))
