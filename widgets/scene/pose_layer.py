"""The sensor's frame, how the tool stands in the world, the ghost of the next pose, and the phantom."""

from typing import Any

import numpy as np
from numpy.typing import NDArray
from PySide6.QtCore import QPointF
from vtkmodules.vtkCommonDataModel import vtkPolyData
from vtkmodules.vtkInteractionWidgets import vtkCoordinateFrameRepresentation
from vtkmodules.vtkRenderingCore import vtkPropCollection

from contactbench.widgets.scene.label_board import Label, LabelBoard
from contactbench.widgets.scene.stage import (
    SceneStage,
    Shape,
    cone,
    cylinder,
    disc,
    frame_on,
    homogeneous,
    lift,
    rgb,
    rim,
    segments,
    triangles,
)
from contactbench.widgets.scene.views import Screen

# Lighter on dark grounds: a pure blue letter is not read there.
_AXES = {False: ("#c62828", "#2e7d32", "#1554c0"), True: ("#ff7b72", "#5fd07a", "#7ab8ff")}
_GRID = 10  # fields of the floor
_SIDES = 32  # of what is round
_THROUGH = 60.0  # a lift that shows the axes through the probe: that of z lies inside it


class Arrow:
    """A straight arrow of a length along an axis of its frame's z."""

    def __init__(self, stage: SceneStage, turns: bool) -> None:
        self._stage = stage
        self.shapes = (Shape(stage, cylinder(12), turns=turns), Shape(stage, cone(16), turns=turns))

    def draw(self, begin: NDArray[np.float64], along: NDArray[np.float64], thick: float) -> None:
        """Draw it from a point along a vector, m."""
        tip, length = begin + along, float(np.linalg.norm(along))
        head = min(5.0 * thick, 0.5 * length)
        self.shapes[1].place(frame_on(tip, along) @ np.diag([0.4 * head, 0.4 * head, head, 1.0]))
        neck = tip - head * along / length
        self.shapes[0].place(frame_on(neck, along) @ np.diag([thick / 2, thick / 2, length - head, 1.0]))


class PlaceHandle:
    """
    VTK's frame of three axes, which the mouse moves by its ball and rolls by the heads of its arrows.

    The pale tip of an arrow locks its axis: it then turns only about it, and moves only across it.
    """

    def __init__(self, stage: SceneStage) -> None:
        self._stage, self.held = stage, False
        self._axes = vtkCoordinateFrameRepresentation()
        self._axes.SetRenderer(stage.live)
        self._axes.SetLengthFactor(0.02)  # of the view
        self._axes.VisibilityOff()
        stage.live.AddViewProp(self._axes)

    def dress(self, dark: bool) -> None:
        """Take the theme's colours: those of the sensor's axes."""
        for axis, shade in zip("XYZ", _AXES[dark], strict=True):
            for part in ("", "Unlocked", "Locked"):
                look = getattr(self._axes, f"Get{part}{axis}VectorProperty")()
                look.SetColor(*rgb(shade))

    def show(self, T: NDArray[np.float64] | None) -> None:
        """Stand at T (4, 4), S, m, unless the mouse has it; None: be hidden."""
        self._axes.SetVisibility(T is not None)
        if T is None or self.held:
            self.held = self.held and T is not None
            return
        self._axes.SetOrigin(*T[:3, 3])
        for axis, along in zip("XYZ", T[:3, :3].T, strict=True):
            getattr(self._axes, f"Set{axis}AxisVector")(*along)
        actors = vtkPropCollection()
        self._axes.GetActors(actors)
        for i in range(actors.GetNumberOfItems()):
            lift(actors.GetItemAsObject(i).GetMapper(), _THROUGH)

    def grab(self, place: QPointF) -> bool:
        """Take hold of what is at a place of the view, in pixels of Qt; return whether that is a part of it."""
        x, y = self._pixel(place)
        state = self._axes
        state.SetInteractionState(state.Moving)  # picks its parts, and not the origin alone
        found = state.ComputeInteractionState(round(x), round(y)) if state.GetVisibility() else state.Outside
        if (axis := found - state.ModifyingLockerXVector) in (0, 1, 2):
            state.SetLockedAxis(-1 if state.GetLockedAxis() == axis else axis)
        elif found != state.Outside:
            state.StartWidgetInteraction([x, y])
        self.held = found != state.Outside
        return self.held

    def drop(self) -> None:
        """Let go of it."""
        self._axes.SetRepresentationState(self._axes.Outside)
        self.held = False

    def _pixel(self, place: QPointF) -> list[float]:
        """Return a place of the view as VTK counts: device pixels from below."""
        ratio = self._stage.ratio
        return [ratio * place.x(), self._stage.live.GetSize()[1] - 1 - ratio * place.y()]

    def drag(self, place: QPointF) -> NDArray[np.float64]:
        """Follow the mouse to a place of the view; return where it stands then, (4, 4), S, m."""
        self._axes.WidgetInteraction(self._pixel(place))
        vectors = [getattr(self._axes, f"Get{axis}VectorNormal")() for axis in "XYZ"]
        return homogeneous(np.array(vectors).T, np.array(self._axes.GetOrigin()))


class PoseLayer:
    """Draws frames and poses."""

    def __init__(self, stage: SceneStage) -> None:
        self._stage = stage
        self._frame = [Arrow(stage, turns=True) for _ in range(3)]
        self._letters = [Label(stage, plain=True) for _ in range(3)]
        self._ends: NDArray[np.float64] = np.zeros((3, 3))
        self._ghost = Shape(stage, vtkPolyData(), turns=False)
        self._ghost_T: NDArray[np.float64] = np.eye(4)
        self._stand_in = Shape(stage, vtkPolyData(), turns=True)
        self._alone = True  # there is no probe: something stands in for it
        self._down = Arrow(stage, turns=False)
        self._down_word = Label(stage)
        self._floor = Shape(stage, vtkPolyData(), live=False, turns=False)
        self._phantom, self._phantom_rim = Shape(stage, disc()), Shape(stage, rim())
        self.dark = self.in_world = False
        self._ghost.look.BackfaceCullingOn()
        for arrow in self._frame:
            for shape in arrow.shapes:
                shape.lift(_THROUGH)
        for shape in (self._floor, self._phantom, self._phantom_rim):
            shape.plain()
        self.show_orientation(False, "")
        self.show_ghost(None, vtkPolyData())
        self.show_phantom(None, None)
        self.size()

    @property
    def still(self) -> tuple[Any, ...]:
        """Actors of what stands still."""
        return (self._floor.actor,)

    @property
    def ends(self) -> NDArray[np.float64]:
        """Where the axes of S end, with room for their letters (3, 3), S, m."""
        return 1.1 * self._ends

    @property
    def reach(self) -> float:
        """How far from the origin what stands in for a probe reaches, m; 0: there is a probe."""
        return float(self._stage.size) if self._alone else 0.0

    def size(self) -> None:
        """Be as large as suits the probe."""
        size = self._stage.size
        for i, arrow in enumerate(self._frame):
            self._ends[i] = 0.42 * size * np.eye(3)[i]
            arrow.draw(np.zeros(3), 0.4 * size * np.eye(3)[i], 0.008 * size)
        self._reach = 1.35 * size
        steps = np.linspace(-1.0, 1.0, _GRID + 1)
        lines = np.array([[[-1.0, s], [1.0, s]] for s in steps] + [[[s, -1.0], [s, 1.0]] for s in steps])
        flat = self._reach * np.insert(lines.reshape(-1, 2), 2, 0.0, axis=1)
        flat[:, 2] = -1.1 * size
        self._floor.give(segments(flat))
        self._stand_in.give(_tool(size))
        self._down.draw(
            np.array([-1.15 * size, 0.0, 0.1 * size]), np.array([0.0, 0.0, -0.5 * size]), 0.012 * size
        )
        self._place_ghost()

    def dress(self) -> None:
        """Take the theme's colours."""
        colours = self._stage.colours
        shades = _AXES[self.dark]
        for arrow, shade in zip(self._frame, shades, strict=True):
            for shape in arrow.shapes:
                shape.colour(shade)
                shape.look.SetAmbient(0.5)
        for letter, label, shade in zip("xyz", self._letters, shades, strict=True):
            label.write(letter, shade)
        self._ghost.colour(colours.accent, 0.3)
        self._stand_in.colour(colours.stale, 0.55)
        self._ghost.look.SetAmbient(0.4)
        for shape in self._down.shapes:
            shape.colour(colours.muted)
        self._floor.colour(colours.line)
        self._phantom.colour(colours.series[4], 0.28)
        self._phantom_rim.colour(colours.series[4])
        self._phantom_rim.look.SetLineWidth(2.0 * self._stage.ratio)

    def show_stand_in(self, alone: bool) -> None:
        """Say whether there is no probe: a plain tool is then shown as it is held."""
        self._alone = alone
        self._stand_in.show(alone and self.in_world)

    def show_orientation(self, shown: bool, word: str) -> None:
        """Show the world the tool stands in, or not."""
        self.in_world = shown
        self._floor.show(shown)
        for shape in self._down.shapes:
            shape.show(shown)
        self._down_word.wanted = shown
        self.show_stand_in(self._alone)
        if word:
            self._down_word.write(word, self._stage.colours.text)

    def show_ghost(self, T: NDArray[np.float64] | None, likeness: Any) -> None:
        """Show a likeness of the tool see-through, moved by T (4, 4) from where it is made."""
        self._ghost.show(T is not None)
        if T is not None:
            self._ghost_T = T
            plain = vtkPolyData()
            plain.ShallowCopy(_tool(self._stage.size) if self._alone else likeness)
            plain.GetCellData().SetScalars(None)
            self._ghost.give(plain)
            self._place_ghost()

    def _place_ghost(self) -> None:
        self._ghost.place(self._ghost_T)

    def show_phantom(self, point: NDArray[np.float64] | None, normal: NDArray[np.float64] | None) -> None:
        """Show a plane, S, m."""
        self._phantom.show(point is not None)
        self._phantom_rim.show(point is not None)
        if point is not None:
            up = np.array([0.0, 0.0, -1.0]) if normal is None else normal
            T = frame_on(point, up, 0.6 * self._stage.size)
            self._phantom.place(T)
            self._phantom_rim.place(T)

    def label(self, screen: Screen, board: LabelBoard) -> None:
        """Put the letters where the axes end."""
        turn = self._stage.turn
        ends = np.vstack(
            [
                self._ends @ turn[:3, :3].T + turn[:3, 3],
                [[-1.15 * self._stage.size, 0.0, -0.15 * self._stage.size]],
            ]
        )
        places = screen.project(ends)
        for place, label in zip(places, (*self._letters, self._down_word), strict=True):
            board.want(label, place[0], place[1], True, 2)


def _tool(size: float) -> Any:
    """Return a handle with a head, as long as `size`, m, about z."""
    profile = size * np.array(
        [
            (0.0, 0.0),
            (0.17, 0.0),
            (0.17, 0.05),
            (0.09, 0.08),
            (0.11, 0.55),
            (0.16, 0.7),
            (0.16, 0.97),
            (0.0, 1.0),
        ]
    )
    around = np.linspace(0.0, 2.0 * np.pi, _SIDES, endpoint=False)
    ring = np.stack([np.cos(around), np.sin(around)], axis=1)
    vertices = np.array([(*(radius * unit), z) for radius, z in profile for unit in ring])
    low, here = _SIDES * np.arange(len(profile) - 1)[:, None], np.arange(_SIDES)[None, :]
    then = (here + 1) % _SIDES
    corners = [
        low + here,
        low + then,
        low + _SIDES + then,
        low + here,
        low + _SIDES + then,
        low + _SIDES + here,
    ]
    return triangles(vertices, np.stack(np.broadcast_arrays(*corners), axis=-1).reshape(-1, 3))
