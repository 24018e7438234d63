"""The scene and the charts of a closed loop."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from PySide6.QtCore import QEvent
from PySide6.QtWidgets import QHBoxLayout, QVBoxLayout, QWidget

from contactbench.widgets.scene import Scene
from contactbench.widgets.strip_chart_pane import Curves, Pane
from contactbench.widgets.theme import is_dark

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from contactbench.pipeline.control.frames import Beginning, LoopFrame
    from contactbench.pipeline.mesh import Probe
    from contactbench.pipeline.workbench.motion import Course

_SPAN_S = 20.0
_CHARTS_PX = 90  # at the least
_MIDDLE, _NEARER = 0.45, 0.75  # of the probe's size, of the whole view


class Picture(QWidget):
    """Phantom, probe, contact and force in the world, and force and angle over time."""

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.scene = Scene(self)
        self.force = Pane(Curves(self.tr("Force"), (self.tr("force"), self.tr("target")), "N", 2, 1.0))
        names = (self.tr("angle along the face"), self.tr("across the face"))
        self.angle = Pane(Curves(self.tr("Angle to the phantom"), names, "°", 2, 2.0, 2))
        charts = QHBoxLayout()
        charts.setSpacing(4)
        charts.setContentsMargins(6, 4, 6, 4)
        for pane in (self.force, self.angle):
            pane.setMinimumHeight(_CHARTS_PX)
            charts.addWidget(pane, 1)
        column = QVBoxLayout(self)
        column.setContentsMargins(0, 0, 0, 0)
        column.setSpacing(0)
        column.addWidget(self.scene, 3)
        column.addLayout(charts, 1)  # of a large screen, they use their share

    @property
    def span_s(self) -> float:
        """How much of the course is shown, s."""
        return _SPAN_S

    def show_probe(self, probe: Probe) -> None:
        """Show a probe, pointing down as it is held."""
        self.scene.show_probe(probe)
        self._clear()
        self.scene.show_orientation(np.diag([1.0, -1.0, -1.0]))
        self.scene.look("fit")
        position, focal, up, (scale, perspective, _) = self.scene.camera()
        # The middle of the tool in the middle of the view, instead of the sensor that it hangs on.
        down = np.array([0.0, 0.0, -_MIDDLE * probe.size])
        nearer = (_NEARER * scale, perspective, 0.0)
        self.scene.set_camera((_three(position + down), _three(focal + down), up, nearer))

    def show_frame(self, beginning: Beginning, frame: LoopFrame) -> None:
        """Show a period."""
        from contactbench.pipeline.workbench.motion import placed

        where = placed(beginning, frame)
        self.scene.show_orientation(where.R_WS, where.p_WS_W)
        self.scene.show_phantom(where.phantom_S, where.normal_S)
        point = None if frame.point_S_m is None else np.array(frame.point_S_m)
        force = None if frame.force_S_N is None else np.array(frame.force_S_N)
        self.scene.show_contact(point)
        # Without a place the force is none: what a sensor reads in the air is noise.
        self.scene.show_force(None if point is None else force, point)

    def show_course(self, course: Course, wanted: float) -> None:
        """Show the charts."""
        newest = course.times[-1] if len(course.times) else 0.0
        times = course.times - newest
        forces = np.column_stack([course.forces, np.full(len(times), wanted)])
        self.force.show_data(times, forces, -_SPAN_S, 0.0)
        self.angle.show_data(times, course.angles, -_SPAN_S, 0.0)

    def _clear(self) -> None:
        self.scene.show_phantom(None)
        self.scene.show_contact(None)
        self.scene.show_force(None)
        nothing = np.empty(0)
        for pane in (self.force, self.angle):
            pane.show_data(nothing, np.empty((0, 2)), -_SPAN_S, 0.0)

    def changeEvent(self, event: QEvent) -> None:
        """Take the colours of another theme."""
        super().changeEvent(event)
        if event.type() == QEvent.Type.PaletteChange and hasattr(self, "angle"):
            self.scene.set_dark(is_dark())
            for pane in (self.force, self.angle):
                pane.dress()


def _three(values: NDArray[np.float64]) -> tuple[float, float, float]:
    x, y, z = (float(each) for each in values)
    return x, y, z
