"""A finished mesh seen by somebody who trusts nobody: closed, whole, outward, nothing crossing, in exact arithmetic."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from itertools import pairwise
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree

from .solids import Mesh

if TYPE_CHECKING:
    from pathlib import Path

    import numpy.typing as npt

    Floats = npt.NDArray[np.float64]
    Longs = npt.NDArray[np.int64]
    Point = tuple[int, int, int]

_LEAF = 8
_MOST_PARTS = 200


class Prepared(NamedTuple):
    """A mesh that was written by `contactbench probe`: in mm, and which of its facets were invented."""

    mesh: Mesh
    invented: npt.NDArray[np.bool_]


def read_prepared(path: Path) -> Prepared:
    """Read the PLY file of a prepared probe without any code of the project's."""
    content = path.read_bytes()
    end = content.index(b"end_header\n") + len(b"end_header\n")
    kinds = {"double": "<f8", "float": "<f4", "int": "<i4", "uint": "<u4", "short": "<i2", "uchar": "u1"}
    elements: list[tuple[str, int, list[tuple[str, str]]]] = []
    for line in content[:end].decode().splitlines():
        words = line.split()
        if words[0] == "element":
            elements.append((words[1], int(words[2]), []))
        elif words[:2] == ["property", "list"]:
            # Every facet that contactbench writes is a triangle.
            elements[-1][2].extend([("corners", kinds[words[2]]), ("index", "3" + kinds[words[3]])])
        elif words[0] == "property":
            elements[-1][2].append((words[2], kinds[words[1]]))
    tables = {}
    for name, count, fields in elements:
        kind = np.dtype(
            [(f, k) if k[0] != "3" else (f, k[1:], 3) for f, k in fields]  # type: ignore[misc]
        )
        tables[name] = np.frombuffer(content, kind, count, end)
        end += count * kind.itemsize
    points, facets = tables["vertex"], tables["face"]
    if not (facets["corners"] == 3).all():
        raise ValueError(f"{path}: a facet is no triangle")
    vertices = 1e3 * np.column_stack([points["x"], points["y"], points["z"]])
    return Prepared(Mesh(vertices, facets["index"].astype(np.int32)), facets["invented"].astype(bool))


@dataclass(frozen=True)
class Seen:
    """What is wrong with a mesh; all 0 of one that is sound, except `parts` and `touching`."""

    open_edges: int  # With one facet only
    bad_edges: int  # With more than two facets, or with two that run the same way
    bad_vertices: int  # Whose facets are more than one fan
    parts: int
    inward: int  # Parts of no volume above 0
    buried: int  # Parts inside another
    crossing: int  # Pairs of facets that pass through or lie on each other
    touching: int  # Pairs that only touch beyond what they share

    @property
    def sound(self) -> bool:
        """Whether it is closed, 2-manifold, outward and crosses nowhere."""
        wrong = self.open_edges, self.bad_edges, self.bad_vertices, self.inward, self.buried, self.crossing
        return not any(wrong)

    def words(self) -> str:
        """Name what is wrong."""
        found = {
            "open edges": self.open_edges,
            "edges not of two": self.bad_edges,
            "split vertices": self.bad_vertices,
            "parts inward": self.inward,
            "parts inside others": self.buried,
            "crossing": self.crossing,
            "touching": self.touching,
        }
        return ", ".join(f"{count} {name}" for name, count in found.items() if count)


def look(mesh: Mesh) -> Seen:
    """Examine a mesh."""
    faces = mesh.faces.astype(np.int64)
    n = len(mesh.vertices)
    start, end = faces.ravel(), np.roll(faces, -1, axis=1).ravel()
    low, high = np.minimum(start, end), np.maximum(start, end)
    _, edge, count = np.unique(low * n + high, return_inverse=True, return_counts=True)
    ways = np.bincount(edge, weights=np.where(start < end, 1, -1))
    crossing, touching = crossings(mesh)
    label = _parts(mesh, edge)
    volumes = np.bincount(label, weights=np.einsum("ni,ni->n", mesh.corners[:, 0], mesh.crosses))
    return Seen(
        open_edges=int((count == 1).sum()),
        bad_edges=int(((count > 2) | ((count == 2) & (ways != 0))).sum()),
        bad_vertices=_split_vertices(faces, edge),
        parts=int(label.max(initial=-1)) + 1,
        inward=int((volumes <= 0).sum()),
        buried=_buried(mesh, label),
        crossing=len(crossing),
        touching=len(touching),
    )


def _parts(mesh: Mesh, edge: Longs) -> Longs:
    facet = np.arange(3 * len(mesh.faces)) // 3
    order = np.argsort(edge, kind="stable")
    same = edge[order][1:] == edge[order][:-1]
    a, b = facet[order][:-1][same], facet[order][1:][same]
    graph = coo_matrix((np.ones(len(a)), (a, b)), shape=(len(mesh.faces),) * 2)
    return np.asarray(connected_components(graph, directed=False)[1])


def _buried(mesh: Mesh, label: Longs) -> int:
    """Count parts whose first point is inside another part, by the solid angle that it fills from there."""
    count = int(label.max(initial=-1)) + 1
    if count > _MOST_PARTS:
        return 0
    found = 0
    for part in range(count):
        point = mesh.corners[label == part][0].mean(axis=0)
        rest = mesh.corners[label != part] - point
        a, b, c = np.moveaxis(rest, 1, 0)
        x, y, z = (np.linalg.norm(v, axis=1) for v in (a, b, c))
        dots = [np.einsum("ni,ni->n", v, w) for v, w in ((a, b), (b, c), (c, a))]
        solid = np.arctan2(
            np.einsum("ni,ni->n", a, np.cross(b, c)), x * y * z + dots[0] * z + dots[1] * x + dots[2] * y
        )
        others = np.bincount(label[label != part], weights=2 * solid, minlength=count)
        found += bool((np.abs(others) > 2 * np.pi).any())
    return found


def _split_vertices(faces: Longs, edge: Longs) -> int:
    """Count vertices whose corners do not all hang together through edges at that vertex."""
    corners = np.arange(faces.size)
    facet = corners // 3
    # The corners at both ends of each half-edge, joined with those of the facet on its other side.
    starts, ends = corners, 3 * facet + (corners + 1) % 3
    order = np.argsort(edge, kind="stable")
    same = edge[order][1:] == edge[order][:-1]
    one, other = order[:-1][same], order[1:][same]
    vertex = faces.ravel()
    joins = []
    for a in (starts[one], ends[one]):
        for b in (starts[other], ends[other]):
            fits = vertex[a] == vertex[b]
            joins.append(np.stack([a[fits], b[fits]]))
    a, b = np.concatenate(joins, axis=1)
    graph = coo_matrix((np.ones(len(a)), (a, b)), shape=(len(corners),) * 2)
    _, fan = connected_components(graph, directed=False)
    pairs = np.unique(np.stack([vertex, fan], 1), axis=0)
    return int((np.bincount(pairs[:, 0]) > 1).sum())


# --- exact crossings --------------------------------------------------------------------------------------------------


def crossings(mesh: Mesh) -> tuple[Longs, Longs]:
    """Find facets that share more than they should, with no rounding anywhere."""
    pairs = _near(mesh)
    pairs = pairs[~_surely_apart(mesh, pairs)]
    points = _whole(mesh.vertices)
    faces = mesh.faces.tolist()
    kinds = np.array([_meet(points, faces[i], faces[j]) for i, j in pairs.tolist()], np.int64)
    return pairs[kinds == 2], pairs[kinds == 1]


def _near(mesh: Mesh) -> Longs:
    """Pairs of facets whose boxes meet, by a tree of boxes that is gone down level by level."""
    corners = mesh.corners
    low, high = corners.min(axis=1), corners.max(axis=1)
    middles = 0.5 * (low + high)
    blocks = [np.arange(len(middles))]
    while len(blocks[0]) > _LEAF:
        halves = []
        for block in blocks:
            axis = np.ptp(middles[block], axis=0).argmax()
            order = block[np.argsort(middles[block, axis], kind="stable")]
            halves += [order[: len(order) // 2], order[len(order) // 2 :]]
        blocks = halves
    levels = [
        (np.array([low[b].min(axis=0) for b in blocks]), np.array([high[b].max(axis=0) for b in blocks]))
    ]
    while len(levels[-1][0]) > 1:
        a, b = levels[-1]
        levels.append((a.reshape(-1, 2, 3).min(axis=1), b.reshape(-1, 2, 3).max(axis=1)))
    i = j = np.zeros(1, np.int64)
    for lows, highs in levels[-2::-1]:
        i, j = (
            np.concatenate([2 * k + a for a in (0, 1) for b in (0, 1)])
            if k is i
            else np.concatenate([2 * k + b for a in (0, 1) for b in (0, 1)])
            for k in (i, j.copy())
        )
        keep = (i <= j) & (lows[i] <= highs[j]).all(axis=1) & (lows[j] <= highs[i]).all(axis=1)
        i, j = i[keep], j[keep]
    found = []
    for a, b in zip(i.tolist(), j.tolist(), strict=True):
        p, q = (x.ravel() for x in np.meshgrid(blocks[a], blocks[b], indexing="ij"))
        keep = (p < q) if a == b else np.ones(len(p), bool)
        keep &= (low[p] <= high[q]).all(axis=1) & (low[q] <= high[p]).all(axis=1)
        found.append(np.stack([p[keep], q[keep]], 1))
    return np.concatenate(found)


def _surely_apart(mesh: Mesh, pairs: Longs) -> npt.NDArray[np.bool_]:
    """Pairs of which one lies on one side of the other's plane, apart from what they share, beyond all rounding."""
    apart = np.zeros(len(pairs), bool)
    v = mesh.vertices
    size = np.abs(v).max()
    for one, other in (pairs.T, pairs.T[::-1]):
        a, b, c = (v[mesh.faces[one, k]] for k in range(3))
        normal = np.cross(b - a, c - a)
        # Of a determinant of differences of coordinates up to `size`, evaluated in double precision.
        error = (
            64 * np.finfo(float).eps * size * (np.abs(b - a).max(axis=1) * np.abs(c - a).max(axis=1) + 1e-300)
        )
        shared = (mesh.faces[other][:, :, None] == mesh.faces[one][:, None, :]).any(axis=2)
        heights = np.einsum("nij,nj->ni", v[mesh.faces[other]] - a[:, None], normal)
        above = (shared | (heights > error[:, None])).all(axis=1)
        below = (shared | (heights < -error[:, None])).all(axis=1)
        apart |= (above | below) & (shared.sum(axis=1) < 3)
    return apart


def _whole(vertices: Floats) -> list[Point]:
    """Scale coordinates by one power of two, so that all of them are whole numbers, exactly."""
    fractions, exponents = np.frexp(vertices)
    used = exponents[vertices != 0]
    shift = 53 - int(used.min(initial=0))
    numbers = [
        [(int(f * 2.0**53) << (e + shift - 53)) for f, e in zip(fs, es, strict=True)]
        for fs, es in zip(fractions.tolist(), exponents.tolist(), strict=True)
    ]
    return [(x, y, z) for x, y, z in numbers]


def _height(a: Point, b: Point, c: Point, d: Point) -> int:
    """Return how high the point d lies over the plane a b c, times twice the area of the three."""
    x, y, z = d
    ax, ay, az = a[0] - x, a[1] - y, a[2] - z
    bx, by, bz = b[0] - x, b[1] - y, b[2] - z
    cx, cy, cz = c[0] - x, c[1] - y, c[2] - z
    return -(ax * (by * cz - bz * cy) - ay * (bx * cz - bz * cx) + az * (bx * cy - by * cx))


def _side(a: Point, b: Point, c: Point, d: Point) -> int:
    height = _height(a, b, c, d)
    return (height > 0) - (height < 0)


def _meet(points: list[Point], one: list[int], other: list[int]) -> int:
    """Tell how two facets meet beyond what they share: 2 they cross or overlap, 1 they touch, 0 they do not."""
    shared = [i for i in one if i in other]
    if len(shared) == 3:
        return 2
    p, q = [points[i] for i in one], [points[i] for i in other]
    # Edges without a shared vertex: only they can meet the other facet beyond what is shared.
    free = [
        [(k - 1, k) for k in range(3) if not {face[k - 1], face[k]} & set(shared)] for face in (one, other)
    ]
    if not any(_side(*p, x) for x in q):
        flat = _flatten([*p, *q])
        return _meet_in_plane(flat[:3], flat[3:], free)
    meet = any(_pierces(p[i], p[k], q) for i, k in free[0]) or any(
        _pierces(q[i], q[k], p) for i, k in free[1]
    )
    return 1 + _pass_through(p, q) if meet else 0


def _pass_through(p: list[Point], q: list[Point]) -> bool:
    """Tell whether the insides of two facets meet, not only their rims: each is on both sides of the other there."""
    spans = []
    # Both facets cut the line that their planes share, which is counted along its longest axis.
    way = _crossed(_crossed_edges(p), _crossed_edges(q))
    axis = max(range(3), key=lambda k: abs(way[k]))
    for facet, other in ((p, q), (q, p)):
        heights = [_height(*other, x) for x in facet]
        if min(heights) >= 0 or max(heights) <= 0:
            return False
        cuts = [Fraction(x[axis]) for x, h in zip(facet, heights, strict=True) if h == 0]
        for k in range(3):
            g, h = heights[k - 1], heights[k]
            if g * h < 0:
                a, b = facet[k - 1][axis], facet[k][axis]
                cuts.append(a + Fraction((b - a) * g, g - h))
        spans.append((min(cuts), max(cuts)))
    return max(low for low, _ in spans) < min(high for _, high in spans)


def _crossed(u: Point, v: Point) -> Point:
    return (u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0])


def _crossed_edges(facet: list[Point]) -> Point:
    a, b, c = facet
    return _crossed((b[0] - a[0], b[1] - a[1], b[2] - a[2]), (c[0] - a[0], c[1] - a[1], c[2] - a[2]))


def _pierces(p: Point, q: Point, triangle: list[Point]) -> bool:
    """Tell whether a closed edge and a closed facet share a point."""
    a, b, c = triangle
    sp, sq = _side(a, b, c, p), _side(a, b, c, q)
    if sp * sq > 0:
        return False
    if sp == 0 and sq == 0:
        flat = _flatten([a, b, c, p, q])
        return _edge_meets(flat[3], flat[4], flat[:3])
    return not {1, -1} <= {_side(p, q, a, b), _side(p, q, b, c), _side(p, q, c, a)}


def _flatten(points: list[Point]) -> list[tuple[int, int]]:
    """Drop the axis that the plane of the first three points is steepest along."""
    a, b, c = points[:3]
    u, v = [b[i] - a[i] for i in range(3)], [c[i] - a[i] for i in range(3)]
    normal = [abs(u[(i + 1) % 3] * v[(i + 2) % 3] - u[(i + 2) % 3] * v[(i + 1) % 3]) for i in range(3)]
    axis = normal.index(max(normal))
    return [(p[(axis + 1) % 3], p[(axis + 2) % 3]) for p in points]


def _turn(a: tuple[int, int], b: tuple[int, int], c: tuple[int, int]) -> int:
    area = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
    return (area > 0) - (area < 0)


def _edge_meets(p: tuple[int, int], q: tuple[int, int], triangle: list[tuple[int, int]]) -> bool:
    """Tell whether a closed edge and a closed triangle of one plane share a point: nothing separates them."""
    way = _turn(*triangle)
    for a, b in pairwise([*triangle, triangle[0]]):
        if all(way * _turn(a, b, x) < 0 for x in (p, q)):
            return False
    sides = {_turn(p, q, x) for x in triangle}
    return sides not in ({1}, {-1})


def _meet_in_plane(
    one: list[tuple[int, int]], other: list[tuple[int, int]], free: list[list[tuple[int, int]]]
) -> int:
    """Tell how two facets of one plane meet: they overlap unless a side of one of them separates them."""
    for triangle, against in ((one, other), (other, one)):
        way = _turn(*triangle)
        for a, b in pairwise([*triangle, triangle[0]]):
            if all(way * _turn(a, b, x) <= 0 for x in against):
                touch = [_edge_meets(one[i], one[k], other) for i, k in free[0]]
                touch += [_edge_meets(other[i], other[k], one) for i, k in free[1]]
                return int(any(touch))
    return 2


# --- against the original ---------------------------------------------------------------------------------------------


def sample(mesh: Mesh, count: int, rng: np.random.Generator) -> tuple[Floats, Longs]:
    """Draw points (count, 3), evenly by area, and the facets that they are on."""
    areas = np.cumsum(mesh.areas)
    facet = np.minimum(np.searchsorted(areas, rng.random(count) * areas[-1], side="right"), len(areas) - 1)
    return np.einsum("ni,nij->nj", rng.dirichlet([1.0, 1.0, 1.0], count), mesh.corners[facet]), facet


def normal_deviations(result: Mesh, original: Mesh, *, points: int = 300_000) -> Floats:
    """
    Compare each facet's normal with the best of the original's own normals near it.

    Near is three times as far as the nearest of them, and a thousandth of the size at least: at a sharp edge both its
    sides count, so only what is turned against all of them stands out.
    """
    drawn, facet = sample(original, points, np.random.default_rng(0))
    at = np.concatenate([drawn, original.corners.mean(axis=1)])
    normals = original.crosses[np.concatenate([facet, np.arange(len(original.faces))])]
    normals = normals / np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-300)
    tree = cKDTree(at)
    spacing = np.sqrt(original.areas.sum() / len(at))
    crosses = result.crosses
    ours = crosses / np.maximum(np.linalg.norm(crosses, axis=1, keepdims=True), 1e-300)
    # The middle and a point near each corner: the best that any of them finds is what the facet was made of.
    spots = np.array([[1, 1, 1], [8, 1, 1], [1, 8, 1], [1, 1, 8]], float)
    spots /= spots.sum(axis=1, keepdims=True)
    best = np.full(len(ours), -1.0)
    for weights in spots:
        places = np.einsum("i,nij->nj", weights, result.corners)
        nearest, _ = tree.query(places)
        radius = np.maximum(3 * nearest, max(1e-3 * original.size, 3 * spacing))
        for k, found in enumerate(tree.query_ball_point(places, radius)):
            best[k] = max(best[k], float((normals[found] @ ours[k]).max(initial=-1.0)))
    return np.asarray(np.degrees(np.arccos(np.clip(best, -1, 1))))
