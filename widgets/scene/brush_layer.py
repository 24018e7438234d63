"""The brush's circle, which lies on the surface under the pointer."""

from __future__ import annotations

from typing import TYPE_CHECKING

from contactbench.widgets.scene.shapes import frame_on, rim
from contactbench.widgets.scene.stage import Shape

if TYPE_CHECKING:
    from contactbench.pipeline.mesh import Probe
    from contactbench.widgets.scene.picker import Pick
    from contactbench.widgets.scene.stage import SceneStage


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

    def turn(self) -> None:
        """Follow the tool."""
        for shape in self._rings:
            shape.place()

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
