"""Where the layers put what they draw: what stands still below, what lives above, both turned with the tool."""

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray
from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData
from vtkmodules.vtkCommonMath import vtkMatrix4x4
from vtkmodules.vtkRenderingCore import vtkActor, vtkPolyDataMapper

from contactbench.widgets.theme import Colours, colours


class SceneStage:
    """
    What all layers share.

    Attributes
    ----------
    still, live : vtkRenderer
        The probe and what hardly ever changes, whose picture may be kept; and what changes with every sample.
    turn : (4, 4)
        Of the tool in the world; see `turn_to`.
    shapes : list of Shape
        All that stand on it.
    size : float
        Of the probe, m: what is drawn to be seen, and not to scale, is sized by it.
    version : int
        Grows when what stands still has changed.
    colours : Colours
    ratio : float
        Device pixels per pixel.
    """

    def __init__(self, still: Any, live: Any, redraw: Callable[[], None]) -> None:
        self.still, self.live, self.redraw = still, live, redraw
        self.turn: NDArray[np.float64] = np.eye(4)
        self.shapes: list[Shape] = []
        self.size = 0.1
        self.version = 0
        self.colours: Colours = colours(False)
        self.ratio = 1.0

    def turn_to(self, turn: NDArray[np.float64]) -> None:
        """Turn the tool, and with it every shape that stands in its frame."""
        self.turn = turn
        for shape in self.shapes:
            shape.place()

    def stir(self) -> None:
        """Say that what stands still has changed."""
        self.version += 1
        self.redraw()


class Shape:
    """
    One actor that stands in the tool's frame, or in the world's.

    Parameters
    ----------
    stage : SceneStage
    data : vtkPolyData
    live : bool
        Drawn above what stands still, with every redraw.
    turns : bool
        Turns with the tool.
    """

    def __init__(self, stage: SceneStage, data: Any, live: bool = True, turns: bool = True) -> None:
        self.stage, self.turns, self._live = stage, turns, live
        self.mapper = vtkPolyDataMapper()
        self.mapper.SetInputData(data)
        self.mapper.ScalarVisibilityOff()
        self.actor = vtkActor()
        self.actor.SetMapper(self.mapper)
        self.actor.PickableOff()
        self.look = self.actor.GetProperty()
        self._local: NDArray[np.float64] = np.eye(4)
        self._renderer = stage.live if live else stage.still
        self._renderer.AddActor(self.actor)
        stage.shapes.append(self)
        self.place()

    def place(self, local: NDArray[np.float64] | None = None) -> None:
        """Put it where `local` (4, 4) says in its frame; None: leave it there, the tool has turned."""
        if local is not None:
            self._local = local
        T = self.stage.turn @ self._local if self.turns else self._local
        self.actor.SetUserMatrix(matrix(T))

    def give(self, data: Any) -> None:
        """Show other geometry."""
        self.mapper.SetInputData(data)

    def show(self, shown: bool = True) -> None:
        """Show or hide it."""
        self.actor.SetVisibility(shown)

    @property
    def shown(self) -> bool:
        """Whether it is shown."""
        return bool(self.actor.GetVisibility())

    def colour(self, colour: str, opacity: float = 1.0) -> None:
        """Colour it, `#rrggbb`."""
        self.look.SetColor(*rgb(colour))
        self.look.SetOpacity(opacity)

    def plain(self) -> None:
        """Show its colour as it is, without shading: what is a sign and not a body."""
        self.look.LightingOff()

    def lift(self, amount: float = 1.0) -> None:
        """Draw it before the surface it lies on, by a share of the depth of all that is seen; 1: before everything."""
        lift(self.mapper, amount)

    def remove(self) -> None:
        """Take it off the stage."""
        self._renderer.RemoveActor(self.actor)
        self.stage.shapes.remove(self)


def lift(mapper: Any, amount: float = 1.0) -> None:
    """Have a mapper draw before what it lies on; see `Shape.lift`."""
    mapper.SetResolveCoincidentTopologyToPolygonOffset()
    mapper.SetRelativeCoincidentTopologyPolygonOffsetParameters(0.0, -60000.0 * amount)
    mapper.SetRelativeCoincidentTopologyLineOffsetParameters(0.0, -60000.0 * amount)


def rgb(colour: str) -> tuple[float, float, float]:
    """Return `#rrggbb` as shares of one."""
    return int(colour[1:3], 16) / 255, int(colour[3:5], 16) / 255, int(colour[5:7], 16) / 255


# ---- triangles, lines and solids for VTK, made of arrays -----------------------------------------


_CIRCLE = 64


def triangles(
    vertices: NDArray[np.float64], faces: NDArray[np.int32], normals: NDArray[np.float64] | None = None
) -> Any:
    """Return a surface (n, 3), (m, 3), with normals (n, 3) that it is shaded by; None: each facet is flat."""
    data = vtkPolyData()
    data.SetPoints(_points(vertices))
    data.SetPolys(_cells(np.asarray(faces), 3))
    if normals is not None:
        data.GetPointData().SetNormals(numpy_to_vtk(np.ascontiguousarray(normals, np.float32), deep=True))
    return data


def segments(points: NDArray[np.float64]) -> Any:
    """Return lines between points (2 k, 3), two by two."""
    data = vtkPolyData()
    data.SetPoints(_points(points))
    data.SetLines(_cells(np.arange(len(points)).reshape(-1, 2), 2))
    return data


def circle() -> NDArray[np.float64]:
    """Return the unit circle in x and y, (64, 3)."""
    angle = np.linspace(0.0, 2.0 * np.pi, _CIRCLE, endpoint=False)
    return np.column_stack([np.cos(angle), np.sin(angle), np.zeros(_CIRCLE)])


def rim() -> Any:
    """Return the unit circle as a line."""
    ends = circle()
    return segments(np.stack([ends, np.roll(ends, -1, axis=0)], axis=1).reshape(-1, 3))


def ring_segments(frames: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the unit circle in each of several frames (k, 4, 4), as segments (k * 128, 3)."""
    rim = circle()
    both = np.stack([rim, np.roll(rim, -1, axis=0)], axis=1).reshape(-1, 3)
    turned = np.einsum("kij,nj->kni", frames[:, :3, :3], both) + frames[:, None, :3, 3]
    return np.asarray(turned.reshape(-1, 3))


def disc() -> Any:
    """Return the filled unit circle."""
    rim = circle()
    faces = np.array([[0, i + 1, (i + 1) % _CIRCLE + 1] for i in range(_CIRCLE)])
    return triangles(np.vstack([np.zeros((1, 3)), rim]), faces)


def cone(sides: int = 24) -> Any:
    """Return a cone: unit radius at z = -1, its tip at the origin."""
    angle = np.linspace(0.0, 2.0 * np.pi, sides, endpoint=False)
    rim = np.column_stack([np.cos(angle), np.sin(angle), -np.ones(sides)])
    after = (np.arange(sides) + 1) % sides
    side = np.column_stack([np.zeros(sides, int), np.arange(sides) + 2, after + 2])
    base = np.column_stack([np.ones(sides, int), after + 2, np.arange(sides) + 2])
    return triangles(np.vstack([[[0.0, 0.0, 0.0], [0.0, 0.0, -1.0]], rim]), np.vstack([side, base]))


def cylinder(sides: int = 24) -> Any:
    """Return a cylinder: unit radius, from z = -1 to 0."""
    angle = np.linspace(0.0, 2.0 * np.pi, sides, endpoint=False)
    rim = np.column_stack([np.cos(angle), np.sin(angle)])
    low, high = np.insert(rim, 2, -1.0, axis=1), np.insert(rim, 2, 0.0, axis=1)
    here, after = np.arange(sides), (np.arange(sides) + 1) % sides
    wall = np.vstack(
        [np.column_stack([here, after, after + sides]), np.column_stack([here, after + sides, here + sides])]
    )
    cap = np.column_stack([np.full(sides, 2 * sides), after, here])
    return triangles(np.vstack([low, high, [[0.0, 0.0, -1.0]]]), np.vstack([wall, cap]))


def thinned(
    vertices: NDArray[np.float64], faces: NDArray[np.int32], steps: int = 56
) -> tuple[NDArray[np.float64], NDArray[np.int32], NDArray[np.int64]]:
    """
    Return a coarse likeness: vertices of one cell of a grid fall together.

    Returns
    -------
    (n, 3), (m, 3), (m,)
        Vertices, facets, and of which facet each is the likeness.
    """
    low = vertices.min(axis=0)
    width = max(float((vertices.max(axis=0) - low).max()) / steps, 1e-12)
    cell = ((vertices - low) / width).astype(np.int64)
    key = (cell[:, 0] * (steps + 2) + cell[:, 1]) * (steps + 2) + cell[:, 2]
    _, first, group = np.unique(key, return_index=True, return_inverse=True)
    few = group[faces]
    kept = np.flatnonzero((few[:, 0] != few[:, 1]) & (few[:, 1] != few[:, 2]) & (few[:, 2] != few[:, 0]))
    return vertices[first], few[kept].astype(np.int32), kept


def frame_on(point: ArrayLike, normal: ArrayLike, radius: float = 1.0) -> NDArray[np.float64]:
    """Return a frame (4, 4) at a point whose z is the normal, its x and y `radius` long."""
    z = np.asarray(normal, dtype=float)
    z = z / max(float(np.linalg.norm(z)), 1e-300)
    x = np.cross(z, [0.0, 0.0, 1.0] if abs(z[2]) < 0.9 else [1.0, 0.0, 0.0])
    x = x / np.linalg.norm(x)
    T = np.eye(4)
    T[:3, 0], T[:3, 1], T[:3, 2], T[:3, 3] = radius * x, radius * np.cross(z, x), z, point
    return T


def homogeneous(R: NDArray[np.float64] | None, p: NDArray[np.float64] | None = None) -> NDArray[np.float64]:
    """Return a rotation (3, 3) and a place (3,) as (4, 4); None is none."""
    T = np.eye(4)
    if R is not None:
        T[:3, :3] = R
    if p is not None:
        T[:3, 3] = p
    return T


def matrix(T: NDArray[np.float64]) -> Any:
    """Return (4, 4) for VTK."""
    result = vtkMatrix4x4()
    result.DeepCopy(tuple(float(value) for value in np.ravel(T)))
    return result


def _points(points: NDArray[np.float64]) -> Any:
    result = vtkPoints()
    result.SetData(numpy_to_vtk(np.ascontiguousarray(points, dtype=np.float32).reshape(-1, 3), deep=True))
    return result


def _cells(rows: NDArray[np.integer], width: int) -> Any:
    result = vtkCellArray()
    offsets = np.arange(0, rows.size + 1, width, dtype=np.int64)
    ids = np.ascontiguousarray(rows, dtype=np.int64).ravel()
    result.SetData(numpy_to_vtkIdTypeArray(offsets, deep=True), numpy_to_vtkIdTypeArray(ids, deep=True))
    return result
