"""Where the probe is touched: a disc as large as the doubt about it, and hollow rings where it could be as well."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from vtkmodules.vtkCommonDataModel import vtkPolyData

from contactbench.widgets.scene.label_board import Label
from contactbench.widgets.scene.shapes import cone, cylinder, disc, frame_on, rim, ring_segments, segments
from contactbench.widgets.scene.stage import Shape

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from contactbench.widgets.scene.label_board import LabelBoard
    from contactbench.widgets.scene.mouse import Picker
    from contactbench.widgets.scene.stage import SceneStage
    from contactbench.widgets.scene.views import Screen

CHI2_95 = 5.991  # of two degrees of freedom


class ContactLayer:
    """Draws the contact."""

    def __init__(self, stage: SceneStage) -> None:
        self._stage = stage
        self._disc = Shape(stage, disc())
        self._rim = Shape(stage, rim())
        self._dot = Shape(stage, disc())
        self._lost = Shape(stage, vtkPolyData())
        for shape, lift in ((self._disc, 1.0), (self._lost, 1.1), (self._rim, 1.2), (self._dot, 1.3)):
            shape.plain()
            shape.lift(lift)
            shape.show(False)
        self._caption, self._here = Label(stage), Label(stage)
        self._captions, self._second = ("", ""), np.full(3, np.nan)
        self._sure, self._point = "", np.full(3, np.nan)
        self.dress()

    def dress(self) -> None:
        """Take the theme's colours."""
        colours = self._stage.colours
        self._disc.colour(colours.series[3], 0.45)
        self._rim.colour("#000000")
        self._dot.colour("#000000")
        self._lost.colour("#202020")
        self._rim.look.SetLineWidth(2.5 * self._stage.ratio)
        self._lost.look.SetLineWidth(2.0 * self._stage.ratio)

    def turn(self) -> None:
        """Follow the tool."""
        for shape in (self._disc, self._rim, self._dot, self._lost):
            shape.place()

    def show(
        self,
        point: NDArray[np.float64] | None,
        covariance: NDArray[np.float64] | None,
        normal: NDArray[np.float64] | None,
        candidates: NDArray[np.float64] | None,
        captions: tuple[str, str],
        picker: Picker | None,
        normals: NDArray[np.float64] | None,
        sure: str = "",
    ) -> None:
        """
        Show a contact, or none; what the picker finds says how the surface lies where nobody told.

        How sure it is stands beside it.

        The first candidate has a caption: one for where it is seen, and one for where it is behind the probe.
        """
        for shape in (self._disc, self._rim, self._dot):
            shape.show(point is not None)
        self._sure, self._point = sure, np.full(3, np.nan) if point is None else np.asarray(point, float)
        if point is not None:
            up = surface_normal(point, picker, normals) if normal is None else np.asarray(normal, float)
            radius = 0.006 * self._stage.size
            self._dot.place(frame_on(point, up, radius))
            ellipse = (
                frame_on(point, up, 2.5 * radius)
                if covariance is None
                else ellipse_frame(np.asarray(point, float), np.asarray(covariance, float), up)
            )
            self._disc.place(ellipse)
            self._rim.place(ellipse)
        rows = np.zeros((0, 3)) if candidates is None else np.reshape(candidates, (-1, 3))
        self._lost.show(len(rows) > 0)
        self._captions, self._second = captions, rows[0] if len(rows) else np.full(3, np.nan)
        if len(rows):
            radius = 0.025 * self._stage.size
            frames = np.array([frame_on(row, surface_normal(row, picker, normals), radius) for row in rows])
            self._lost.give(segments(ring_segments(frames)))

    def label(self, screen: Screen, seen: Callable[[NDArray[np.float64]], bool], board: LabelBoard) -> None:
        """Put the words beside the contact, and beside the first candidate."""
        turn = self._stage.turn
        for label, place, words in (
            (self._here, self._point, (self._sure, self._sure)),
            (self._caption, self._second, self._captions),
        ):
            if not np.isfinite(place).all() or not any(words):
                label.hide()
                continue
            label.write(words[0 if seen(place) else 1], self._stage.colours.text)
            x, y = screen.project((turn[:3, :3] @ place + turn[:3, 3])[None])[0, :2]
            board.keep_free(x, y, 0.02 * self._stage.size / screen.metres_per_pixel)
            board.want(label, x, y, True, 1)


def ellipse_frame(
    point: NDArray[np.float64], covariance: NDArray[np.float64], normal: NDArray[np.float64]
) -> NDArray[np.float64]:
    """
    Return the frame (4, 4) that makes the unit circle the 95 % ellipse in the tangent plane.

    Parameters
    ----------
    point, normal : (3,)
        m; unit length is not needed.
    covariance : (3, 3)
        m².
    """
    T = frame_on(point, normal)
    tangents = T[:3, :2]
    values, vectors = np.linalg.eigh(tangents.T @ covariance @ tangents)
    half = np.sqrt(CHI2_95 * np.maximum(np.nan_to_num(values), 0.0))
    axes = tangents @ vectors
    if np.dot(np.cross(axes[:, 0], axes[:, 1]), T[:3, 2]) < 0.0:
        axes[:, 1] = -axes[:, 1]
    # an ellipse of no width cannot be turned back by VTK: a micrometre is no width to the eye
    T[:3, :2] = axes * np.maximum(half, 1e-6)
    return T


def surface_normal(
    point: NDArray[np.float64], picker: Picker | None, normals: NDArray[np.float64] | None
) -> NDArray[np.float64]:
    """Return the normal (3,) of the surface that is nearest to a point of S; z where there is none."""
    if picker is None or normals is None:
        return np.array([0.0, 0.0, 1.0])
    return np.asarray(normals[picker.nearest(np.asarray(point, float)).face])


# ---- the force as an arrow: so many millimetres per newton, its tip where it acts ----------------


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
