"""Where the probe is touched: a disc as large as the doubt about it, and hollow rings where it could be as well."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from vtkmodules.util.numpy_support import numpy_to_vtk
from vtkmodules.vtkCommonDataModel import vtkPolyData

from contactbench.pipeline.colour_ramp import ColourScale, end_of_colours, round_length
from contactbench.widgets.scene.label_board import Label, LabelBoard
from contactbench.widgets.scene.stage import (
    SceneStage,
    Shape,
    cone,
    cylinder,
    disc,
    frame_on,
    rim,
    ring_segments,
    segments,
    triangles,
)
from contactbench.widgets.scene.views import Picker, Screen

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


# ---- how far touches were located from their markers ---------------------------------------------


_USUAL, _LONGEST_ARROW = (
    0.15,
    0.4,
)  # of the probe's size: nine of ten arrows, and the longest one, are no longer
_LARGEST_SCALE = 1000.0  # times: more shows nothing but rounding
_HEAD = 0.045  # of the probe's size: an arrow's head
_ABOVE = 0.02  # a lift: an arrow some millimetres below the surface is seen, one behind the probe is not
_SIDES = 12


@dataclass(frozen=True, eq=False)
class TouchErrors:
    """Touches of markers, and where they were located; all in S, m."""

    markers: NDArray[np.float64]  # (k, 3)
    points: NDArray[np.float64]  # (k, 3)
    covariances: NDArray[np.float64] | None = None  # (k, 3, 3) m²; NaN: not known
    rivals: NDArray[np.float64] | None = None  # (r, 3) where some of them could be as well

    @property
    def sizes(self) -> NDArray[np.float64]:
        """Lengths of the errors (k,), m."""
        return np.asarray(np.linalg.norm(self.points - self.markers, axis=1))

    @property
    def top(self) -> float:
        """Where the colours end, m."""
        return end_of_colours(self.sizes)


class ErrorLayer:
    """
    Draws errors.

    Attributes
    ----------
    touches : TouchErrors or None
    times : float
        By what all about a marker is larger than it is.
    """

    def __init__(self, stage: SceneStage) -> None:
        self._stage = stage
        self.touches: TouchErrors | None = None
        self.times = 1.0
        self._under, self._shafts = Shape(stage, vtkPolyData()), Shape(stage, vtkPolyData())
        self._heads, self._ellipses = Shape(stage, vtkPolyData()), Shape(stage, vtkPolyData())
        self._rivals = Shape(stage, vtkPolyData())
        for shape in self._all:
            shape.plain()
            shape.lift(_ABOVE)
        self._under.lift(0.9 * _ABOVE)
        for shape in (self._shafts, self._heads, self._ellipses):
            shape.mapper.SetScalarModeToUseCellData()
            shape.mapper.SetColorModeToDirectScalars()
            shape.mapper.ScalarVisibilityOn()
        self.show(None, None, None)
        self.dress()

    @property
    def _all(self) -> tuple[Shape, ...]:
        return self._under, self._shafts, self._heads, self._ellipses, self._rivals

    def dress(self) -> None:
        """Take the theme's colours."""
        # on a dark line a colour is seen on every ground
        self._under.colour("#20242a")
        self._rivals.colour("#202020")
        for shape, width in (
            (self._under, 4.0),
            (self._shafts, 2.0),
            (self._ellipses, 2.0),
            (self._rivals, 2.0),
        ):
            shape.look.SetLineWidth(width * self._stage.ratio)

    def show(
        self, touches: TouchErrors | None, picker: Picker | None, normals: NDArray[np.float64] | None
    ) -> None:
        """Show touches, or none; what the picker finds says how the surface lies there, for the ellipses."""
        self.touches = touches = None if touches is None or not len(touches.markers) else touches
        for shape in self._all:
            shape.show(touches is not None)
        if touches is None:
            return
        self.times = magnification(touches.sizes, self._stage.size)
        colours = np.rint(255 * ColourScale(touches.top).colours(touches.sizes)).astype(np.uint8)
        along = self.times * (touches.points - touches.markers)
        tips = touches.markers + along
        ends = np.stack([touches.markers, tips], axis=1).reshape(-1, 3)
        self._under.give(segments(ends))
        self._shafts.give(_coloured(segments(ends), colours))
        self._heads.give(_heads(tips, along, colours, _HEAD * self._stage.size))
        self._ellipses.give(self._rings(touches, tips, colours, picker, normals))
        rivals = np.zeros((0, 3)) if touches.rivals is None else touches.rivals
        frames = [
            frame_on(each, surface_normal(each, picker, normals), 0.02 * self._stage.size) for each in rivals
        ]
        self._rivals.give(segments(ring_segments(np.array(frames))) if frames else vtkPolyData())

    def label(self, screen: Screen, board: LabelBoard) -> None:
        """Have no word stand on an arrow's tip, nor halfway to it."""
        touches, turn = self.touches, self._stage.turn
        if touches is None:
            return
        for share in (0.5, 1.0):
            places = touches.markers + share * self.times * (touches.points - touches.markers)
            for x, y, _ in screen.project(places @ turn[:3, :3].T + turn[:3, 3]):
                board.keep_free(x, y, 4.0 * self._stage.ratio)

    @property
    def tips(self) -> NDArray[np.float64]:
        """Where the arrows end (k, 3), S, m."""
        touches = self.touches
        if touches is None:
            return np.zeros((0, 3))
        return np.asarray(touches.markers + self.times * (touches.points - touches.markers))

    def _rings(
        self,
        touches: TouchErrors,
        tips: NDArray[np.float64],
        colours: NDArray[np.uint8],
        picker: Picker | None,
        normals: NDArray[np.float64] | None,
    ) -> Any:
        if touches.covariances is None:
            return vtkPolyData()
        known = np.flatnonzero(np.isfinite(touches.covariances).all(axis=(1, 2)))
        frames = np.zeros((len(known), 4, 4))
        for row, i in enumerate(known):
            up = surface_normal(touches.points[i], picker, normals)
            frames[row] = ellipse_frame(tips[i], self.times**2 * touches.covariances[i], up)
        if not len(known):
            return vtkPolyData()
        lines = ring_segments(frames)
        return _coloured(segments(lines), np.repeat(colours[known], len(lines) // (2 * len(known)), axis=0))


def magnification(sizes: NDArray[np.float64], size: float) -> float:
    """
    Return by what errors (k,), m, are drawn longer on a probe of a size, m: 1, 2 or 5 times a power of ten.

    Nine of ten are then no longer than 15 % of the probe, and none than 40 %, unless an error itself is that long.
    """
    usual, longest = float(np.percentile(sizes, 90.0)), float(sizes.max(initial=0.0))
    most = min(_USUAL * size / max(usual, 1e-12), _LONGEST_ARROW * size / max(longest, 1e-12), _LARGEST_SCALE)
    return round_length(max(most, 1.0))


def _coloured(data: Any, colours: NDArray[np.uint8]) -> Any:
    data.GetCellData().SetScalars(numpy_to_vtk(np.ascontiguousarray(colours), deep=True))
    return data


def _heads(
    tips: NDArray[np.float64], along: NDArray[np.float64], colours: NDArray[np.uint8], size: float
) -> Any:
    """Return the arrows' heads, for VTK; that of a short arrow is as long as half of it."""
    solid = cone(_SIDES)
    points = np.array([solid.GetPoint(i) for i in range(solid.GetNumberOfPoints())])
    faces = np.array(
        [[solid.GetCell(i).GetPointId(k) for k in range(3)] for i in range(solid.GetNumberOfCells())]
    )
    length = np.linalg.norm(along, axis=1)
    some = length > 0.0  # an error of nothing has no direction
    tips, along, colours, length = tips[some], along[some], colours[some], length[some]
    if not len(tips):
        return vtkPolyData()
    made = [
        frame_on(tip, step) @ np.diag([0.4 * head, 0.4 * head, head, 1.0])
        for tip, step, head in zip(tips, along, np.maximum(np.minimum(size, 0.5 * length), 1e-9), strict=True)
    ]
    vertices = np.concatenate([points @ T[:3, :3].T + T[:3, 3] for T in made])
    shifts = len(points) * np.arange(len(made))
    cells = (faces[None] + shifts[:, None, None]).reshape(-1, 3).astype(np.int32)
    return _coloured(triangles(vertices, cells), np.repeat(colours, len(faces), axis=0))
