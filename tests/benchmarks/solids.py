"""Closed solids of which every facet is known, and what goes wrong with them on the way to a file; millimetres."""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    import numpy.typing as npt

    Floats = npt.NDArray[np.float64]
    Ints = npt.NDArray[np.int32]
    Bools = npt.NDArray[np.bool_]


class Mesh(NamedTuple):
    """Triangles: (n, 3) vertices, mm, and (m, 3) vertex indices, counter-clockwise seen from outside."""

    vertices: Floats
    faces: Ints

    @property
    def corners(self) -> Floats:
        """(m, 3, 3) the corners of each facet, mm."""
        return self.vertices[self.faces]

    @property
    def crosses(self) -> Floats:
        """(m, 3) normals, each as long as twice its facet's area, mm²."""
        a, b, c = np.moveaxis(self.corners, 1, 0)
        return np.cross(b - a, c - a)

    @property
    def areas(self) -> Floats:
        """(m,) mm²."""
        return 0.5 * np.linalg.norm(self.crosses, axis=1)

    @property
    def volume(self) -> float:
        """Signed, mm³."""
        return float(np.einsum("ni,ni->", self.corners[:, 0], self.crosses) / 6)

    @property
    def size(self) -> float:
        """Largest extent, mm."""
        return float(np.ptp(self.vertices[self.faces].reshape(-1, 3), axis=0).max())

    def chosen(self, facets: Bools | Ints) -> Mesh:
        """Keep some facets."""
        return Mesh(self.vertices, self.faces[facets])

    def flipped(self) -> Mesh:
        """Turn every facet over."""
        return Mesh(self.vertices, np.ascontiguousarray(self.faces[:, ::-1]))

    def warped(self, by: Callable[[Floats], Floats]) -> Mesh:
        """Move the vertices."""
        return Mesh(single(by(self.vertices)), self.faces)

    def moved(self, *by: float) -> Mesh:
        """Move all by a vector, mm."""
        return self.warped(lambda p: p + by)

    def soup(self) -> Mesh:
        """Give every facet vertices of its own, as STL does."""
        return Mesh(
            self.corners.reshape(-1, 3), np.arange(3 * len(self.faces), dtype=np.int32).reshape(-1, 3)
        )


def single(points: npt.ArrayLike) -> Floats:
    """Round to what a 32-bit file holds, so that the file is the solid to the last digit."""
    return np.asarray(points, np.float32).astype(np.float64)


def joined(*meshes: Mesh) -> Mesh:
    """Put meshes into one file, none the wiser of the others."""
    starts = np.cumsum([0, *(len(mesh.vertices) for mesh in meshes)])
    faces = [mesh.faces + start for mesh, start in zip(meshes, starts, strict=False)]
    return Mesh(np.concatenate([mesh.vertices for mesh in meshes]), np.concatenate(faces).astype(np.int32))


def compact(mesh: Mesh) -> Mesh:
    """Leave out vertices that no facet uses."""
    used, faces = np.unique(mesh.faces, return_inverse=True)
    return Mesh(mesh.vertices[used], faces.reshape(-1, 3).astype(np.int32))


def levels(*stops: float, step: float = np.inf) -> Floats:
    """Go through all stops in steps of at most `step`."""
    parts = [
        np.linspace(a, b, max(1, int(np.ceil((b - a) / step - 1e-9))) + 1)[:-1] for a, b in pairwise(stops)
    ]
    return np.concatenate([*parts, [stops[-1]]])


def cells(axes: Sequence[Floats], filled: Bools, *, around: bool = False) -> Mesh:
    """Skin the filled cells of a grid."""
    shape = filled.shape
    padded = np.zeros(np.add(shape, 2), bool)
    padded[1:-1, 1:-1, 1:-1] = filled
    if around:
        padded[0], padded[-1] = padded[-2], padded[1]
    quads = []
    for axis in range(3):
        inner = [slice(1, -1)] * 3
        before, after = list(inner), list(inner)
        before[axis], after[axis] = slice(0, -1), slice(1, None)
        low, high = padded[tuple(before)], padded[tuple(after)]
        for side, chosen in ((1, low & ~high), (-1, high & ~low)):
            at = np.argwhere(chosen)
            if around and axis == 0:
                at = at[at[:, 0] < shape[0]]
            u, v = np.eye(3, dtype=np.int64)[[(axis + 1) % 3, (axis + 2) % 3]]
            quads.append(np.stack([at, at + u, at + u + v, at + v], axis=1)[:, ::side])
    corners = np.concatenate(quads)
    counts = [len(axis) for axis in axes]
    if around:
        counts[0] -= 1
        corners[..., 0] %= counts[0]
    index = np.ravel_multi_index(tuple(np.moveaxis(corners, -1, 0)), counts)
    grid = np.stack(np.meshgrid(*(a[:n] for a, n in zip(axes, counts, strict=True)), indexing="ij"), -1)
    faces = np.concatenate([index[:, [0, 1, 2]], index[:, [0, 2, 3]]])
    mesh = compact(Mesh(grid.reshape(-1, 3), faces.astype(np.int32)))
    return Mesh(single(mesh.vertices), mesh.faces)


class Box(NamedTuple):
    """An axis-parallel box, mm; `air` is cut out of the boxes before it."""

    x: tuple[float, float]
    y: tuple[float, float]
    z: tuple[float, float]
    air: bool = False


def blocks(
    *boxes: Box, step: float = np.inf, steps: Sequence[float] | None = None, around: bool = False
) -> Mesh:
    """Add and cut boxes, in order, on the grid of all their sides; no step of it longer than `step`."""
    axes = [
        levels(*sorted({end for box in boxes for end in box[axis]}), step=steps[axis] if steps else step)
        for axis in range(3)
    ]
    middles = [0.5 * (a[1:] + a[:-1]) for a in axes]
    filled = np.zeros([len(m) for m in middles], bool)
    for box in boxes:
        inside = [(m > low) & (m < high) for m, (low, high) in zip(middles, box[:3], strict=True)]
        filled[np.ix_(*inside)] = not box.air
    return cells(axes, filled, around=around)


def box(x: tuple[float, float], y: tuple[float, float], z: tuple[float, float], step: float = np.inf) -> Mesh:
    """Make a box."""
    return blocks(Box(x, y, z), step=step)


def rolled(points: Floats) -> Floats:
    """Read x as degrees round z, y as the radius, z as the height; what was outside stays outside."""
    degrees, radius, height = points.T
    angle = np.radians(degrees)
    return np.column_stack([radius * np.sin(angle), radius * np.cos(angle), height])


def rolled_up(mesh: Mesh) -> Mesh:
    """Roll up blocks that go all round, and close what is left of them round the axis."""
    x, y, z = mesh.vertices.T
    mesh = mesh.warped(lambda _: rolled(np.column_stack([x, np.where(y == y.min(), 0.0, y), z])))
    points, index = np.unique(mesh.vertices, axis=0, return_inverse=True)
    faces = index.reshape(-1)[mesh.faces].astype(np.int32)
    whole = (faces != np.roll(faces, 1, axis=1)).all(axis=1)
    return compact(Mesh(points, faces[whole]))


def lathe(profile: Sequence[tuple[float, float]], sides: int = 72) -> Mesh:
    """Turn a closed outline round z."""
    points = np.asarray(profile, float)
    angles = 2 * np.pi * np.arange(sides) / sides
    rings = points[None, :, :].repeat(sides, 0)
    vertices = np.stack(
        [rings[..., 0] * np.cos(angles)[:, None], rings[..., 0] * np.sin(angles)[:, None], rings[..., 1]], -1
    )
    n = len(points)
    j, i = (g.ravel() for g in np.meshgrid(np.arange(n), np.arange(sides), indexing="ij"))
    after, right = (j + 1) % n, (i + 1) % sides
    quad = np.stack([i * n + j, right * n + j, right * n + after, i * n + after], 1)
    faces = np.concatenate([quad[:, [0, 1, 2]], quad[:, [0, 2, 3]]])
    # A point on the axis is one vertex, not one on every side.
    poles = np.arange(sides * n)
    on_axis = np.tile(points[:, 0] == 0, sides)
    poles[on_axis] = poles[on_axis] % n
    faces = poles[faces]
    whole = (faces != np.roll(faces, 1, axis=1)).all(axis=1)
    mesh = compact(Mesh(vertices.reshape(-1, 3), faces[whole].astype(np.int32)))
    return Mesh(single(mesh.vertices), mesh.faces)


def arc(
    radius: float, centre: tuple[float, float], start: float, end: float, count: int
) -> list[tuple[float, float]]:
    """Give points of a circle for a profile, from one angle to another, degrees from the radius to the height."""
    angle = np.radians(np.linspace(start, end, count))
    r, z = centre[0] + radius * np.cos(angle), centre[1] + radius * np.sin(angle)
    r[np.abs(r) < 1e-12] = 0.0
    return list(zip(r.tolist(), z.tolist(), strict=True))


def capsule(radius: float, length: float, sides: int = 48) -> Mesh:
    """Make a round bar along z with round ends, from -radius to length + radius."""
    quarter = sides // 4 + 1
    straight = [(radius, z) for z in np.linspace(0, length, max(2, int(length / radius) + 1))[1:-1].tolist()]
    lower, upper = arc(radius, (0, 0), -90, 0, quarter), arc(radius, (0, length), 0, 90, quarter)
    return lathe([*lower, *straight, *upper], sides)


def torus(large: float, small: float, sides: int = 96) -> Mesh:
    """Make a ring about z."""
    return lathe(arc(small, (large, 0), 0, 360, sides // 3 + 1)[:-1], sides)


def globe(facets: int, shape: Callable[[Floats], Floats]) -> Mesh:
    """Make a ball of rings, then `shape` its (n, 3) directions into points, mm."""
    rings = max(4, int(np.sqrt(facets / 4)))
    profile = arc(1.0, (0.0, 0.0), -90, 90, rings + 1)
    return lathe(profile, 2 * rings).warped(lambda p: shape(p / np.linalg.norm(p, axis=1, keepdims=True)))


def split_long(mesh: Mesh, longest: float) -> Mesh:
    """Halve edges, on both their facets, until none is longer, mm."""
    vertices, faces = mesh
    while True:
        edges = np.sort(np.stack([faces, np.roll(faces, -1, 1)], 2).reshape(-1, 2), axis=1)
        unique, where = np.unique(edges, axis=0, return_inverse=True)
        where = where.reshape(-1, 3)
        lengths = np.linalg.norm(vertices[unique[:, 0]] - vertices[unique[:, 1]], axis=1)
        # An edge is halved when it is the longest of all its facets: no facet gets two new points at once.
        facet_longest = where[np.arange(len(faces)), lengths[where].argmax(axis=1)]
        votes = np.bincount(facet_longest, minlength=len(unique))
        chosen = (lengths > longest) & (votes == np.bincount(where.ravel(), minlength=len(unique)))
        if not chosen.any():
            return Mesh(vertices, faces.astype(np.int32))
        number = np.full(len(unique), -1)
        number[chosen] = len(vertices) + np.arange(chosen.sum())
        middles = single(0.5 * (vertices[unique[chosen, 0]] + vertices[unique[chosen, 1]]))
        vertices = np.concatenate([vertices, middles])
        hit = number[where]
        halved = (hit >= 0).any(axis=1)
        side = hit[halved].argmax(axis=1)
        rows = np.arange(len(side))
        turned = faces[halved][rows[:, None], (side[:, None] + np.arange(3)) % 3]
        new = hit[halved][rows, side]
        a, b, c = turned.T
        faces = np.concatenate([faces[~halved], np.stack([a, new, c], 1), np.stack([new, b, c], 1)])
