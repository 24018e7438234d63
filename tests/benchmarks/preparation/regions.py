"""Painting regions: strokes beside other ways to measure distances on a surface, undo, and exactness."""

from __future__ import annotations

import hashlib
import time
from typing import TYPE_CHECKING, Any

import numpy as np
from benchmarks.preparation import shapes
from benchmarks.preparation.shapes import bundled

from contactbench import assets
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.kernel import Geodesic
from contactbench.pipeline.mesh.regions.facet_graph import FacetGraph
from contactbench.pipeline.mesh.regions.model import RegionModel
from contactbench.pipeline.mesh.regions.region import RegionSet
from contactbench.pipeline.mesh.regions.selections import Brush
from contactbench.pipeline.study.report import Figure, StudyReport

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    import numpy.typing as npt

    Floats = npt.NDArray[np.float64]
    Distance = Callable[[Floats, Floats], Floats]
    from scipy.sparse import csr_array
    from scipy.spatial import cKDTree

    from contactbench.pipeline.mesh import Probe

# Nearer than this many edge lengths the surface is not yet resolved.
_EDGES = 5
_SOURCES = 10


def distance_errors(rng: np.random.Generator, facets: int = 8_000) -> Iterator[tuple[str, Floats]]:
    """Compare geodesic distances with exact ones, at least five edge lengths away."""
    yield "plane, random", _errors(*shapes.plane(facets, rng), _straight, 0.5, rng)
    yield "sphere, even", _errors(*shapes.sphere(facets), _great_circle, 2.0, rng)
    yield "sphere, random", _errors(*shapes.sphere(facets, rng), _great_circle, 2.0, rng)
    # Far from the open ends, where no shortest way leads around the edge of the mesh.
    yield "cylinder, random", _errors(*shapes.cylinder(facets, rng), _helix, 1.2, rng)


def _errors(
    vertices: Floats, faces: npt.NDArray[np.int32], exact: Distance, limit: float, rng: np.random.Generator
) -> Floats:
    geodesic = Geodesic(np.ascontiguousarray(vertices), np.ascontiguousarray(faces))
    edge = float(np.mean(np.linalg.norm(vertices[faces] - vertices[np.roll(faces, 1, axis=1)], axis=2)))
    centres = vertices[faces].mean(axis=1)
    middle = np.flatnonzero((np.abs(centres) < [1.1, 1.1, 0.7]).all(axis=1))
    if np.ptp(vertices[:, 2]) == 0:
        middle = middle[(np.abs(centres[middle]) < 0.4).all(axis=1)]
    sources = rng.choice(middle, _SOURCES, replace=False).astype(np.int32)
    first, vertex, distance = geodesic.around(sources, centres[sources], limit)
    found = []
    for face, begin, end in zip(sources.tolist(), first, first[1:], strict=False):
        true = exact(centres[face], vertices[vertex[begin:end]])
        far = true >= _EDGES * edge
        found.append(np.abs(distance[begin:end][far] / true[far] - 1))
    return np.concatenate(found)


def _straight(source: Floats, points: Floats) -> Floats:
    return np.asarray(np.linalg.norm(points - source, axis=1))


def _great_circle(source: Floats, points: Floats) -> Floats:
    pole = source / np.linalg.norm(source)
    sine = np.linalg.norm(np.cross(points, pole), axis=1)
    return np.asarray(np.arctan2(sine, points @ pole))


def _helix(source: Floats, points: Floats) -> Floats:
    turn = np.arctan2(points[:, 1], points[:, 0]) - np.arctan2(source[1], source[0])
    around = np.abs((turn + np.pi) % (2 * np.pi) - np.pi)
    return np.asarray(np.hypot(around, points[:, 2] - source[2]))


_RADIUS, _STEP, _EVENTS = 0.005, 0.005, 20
_LONGEST_MS, _BUILD_S = 10.0, 0.5
_OFF = 0.02


def run(
    facets: int = 300_000,
    *,
    strokes: int = 200,
    undone: int = 1_000,
    seed: int = 0,
    progress: Callable[[str], None] = lambda _: None,
) -> StudyReport:
    """Measure every figure."""
    if strokes < 2 or undone < 1:
        raise InputError(f"{strokes} strokes, {undone} undone: give at least 2, and at least 1 to undo")
    figures: list[Figure] = []
    for number, name in enumerate(assets.PROBE_NAMES):
        progress(f"{name}: strokes")
        probe, rng = bundled(name, facets), np.random.default_rng([seed, number])
        began = time.perf_counter()
        graph = FacetGraph(probe)
        figures.append(Figure(name, "made ready to paint", time.perf_counter() - began, "s", most=_BUILD_S))
        figures += _strokes(graph, strokes, rng)
    progress(f"{undone:,} strokes undone and done again")
    figures.append(_undo(graph, undone, rng))
    progress("distances along surfaces")
    figures += [
        Figure.of(of, "geodesic distance, error relative", errors, most=_OFF, judged="worst")
        for of, errors in distance_errors(np.random.default_rng([seed, 99]))
    ]
    note = (
        "A rival answers every mouse event of the same stroke with the facets or vertices in reach, and neither fills"
        " the gaps in between nor keeps what it changed. Processor: what the stroke itself took, without waiting."
    )
    settings = {"facets": f"{facets:,}", "strokes": strokes, "seed": seed}
    return StudyReport("Painting regions", settings, tuple(figures), (note,))


class Rivals:
    """What scipy offers for the same question: Dijkstra on the edges, and a k-d tree of centroids."""

    def __init__(self, probe: Probe) -> None:
        from scipy.spatial import cKDTree

        self._probe = probe
        self._edges = _edge_graph(probe)
        self._tree: cKDTree[None] = cKDTree(probe.vertices[probe.faces].mean(axis=1))

    def geodesic(self, faces: npt.NDArray[np.int32], _points: Floats) -> None:
        """Vertices within reach of each picked facet (k,), along edges."""
        from scipy.sparse.csgraph import dijkstra

        for face in faces.tolist():
            start = int(self._probe.faces[face, 0])
            dijkstra(self._edges, directed=False, indices=[start], limit=_RADIUS)

    def euclidean(self, _faces: npt.NDArray[np.int32], points: Floats) -> None:
        """Facets within reach of each picked point (k, 3), through space."""
        for point in points:
            self._tree.query_ball_point(point, _RADIUS)


def _strokes(graph: FacetGraph, strokes: int, rng: np.random.Generator) -> list[Figure]:
    rivals = Rivals(graph.probe)
    drawn = [wander(graph, rng) for _ in range(strokes)]
    figures: list[Figure] = []
    kinds = (
        ("geodesic", True, rivals.geodesic, "Dijkstra on the edges, scipy"),
        ("Euclidean", False, rivals.euclidean, "query_ball_point of centroids, scipy"),
    )
    for kind, geodesic, rival, rival_name in kinds:
        ours, own_cpu, theirs = [], [], []
        for number, (faces, points) in enumerate(drawn):
            model = RegionModel(RegionSet.empty(graph.facet_count))  # a stroke cuts facets
            model.add()
            # Which goes first changes, so that neither always finds the other's leftovers in the cache.
            if number % 2 == 0:
                theirs.append(_timed(rival, faces, points)[0])
            wall, cpu = _timed(paint, model, graph, Brush(_RADIUS, geodesic), faces, points)
            ours.append(wall)
            own_cpu.append(cpu)
            if number % 2 == 1:
                theirs.append(_timed(rival, faces, points)[0])
        name, of = graph.probe.name, f"{kind} stroke"
        figures += _stroke_figures(of, name, ours, own_cpu)
        figures.append(Figure.of(name, f"{of} over {rival_name}", np.array(ours) / np.array(theirs)))
        covered = np.array([_covered(graph, geodesic, *picks) for picks in drawn])
        figures.append(Figure.of(name, f"{of}, facets covered", covered))
        figures.append(Figure.of(name, f"{of}, processor per facet", 1e9 * np.array(own_cpu) / covered, "ns"))
    return figures


def _covered(graph: FacetGraph, geodesic: bool, faces: npt.NDArray[np.int32], points: Floats) -> int:
    """How many facets a stroke reaches, changed or not."""
    graph.geodesic.begin(_RADIUS, geodesic)
    each = zip(faces.tolist(), points, strict=True)
    return sum(len(graph.geodesic.extend(face, point, joined=True)) for face, point in each)


def _timed(call: Callable[..., None], *arguments: Any) -> tuple[float, float]:
    """Call, and give seconds by the clock and of the processor."""
    began, worked = time.perf_counter(), time.thread_time()
    call(*arguments)
    return time.perf_counter() - began, time.thread_time() - worked


def _stroke_figures(of: str, name: str, wall: list[float], cpu: list[float]) -> list[Figure]:
    milliseconds = 1e3 * np.array(wall)
    return [
        Figure(name, f"{of}, the first", float(milliseconds[0]), "ms", most=_LONGEST_MS),
        Figure.of(name, of, milliseconds, "ms", most=_LONGEST_MS, judged="worst"),
        Figure(name, f"{of}, 99 %", float(np.percentile(milliseconds, 99)), "ms", most=_LONGEST_MS),
        Figure.of(name, f"{of}, processor", 1e3 * np.array(cpu), "ms"),
    ]


def wander(graph: FacetGraph, rng: np.random.Generator) -> tuple[npt.NDArray[np.int32], Floats]:
    """Draw the picks of a stroke that wanders smoothly over the surface."""
    where = graph.probe.vertices[graph.probe.faces[int(rng.integers(graph.facet_count))]].mean(axis=0)
    heading = rng.standard_normal(3)
    faces, points = [], []
    for _ in range(_EVENTS):
        face, point = graph.pick(where)
        normal = graph.probe.normals[face[0]]
        heading = heading - normal * (heading @ normal)
        heading /= np.linalg.norm(heading) + 1e-12
        faces.append(int(face[0]))
        points.append(point[0])
        where = point[0] + _STEP * heading
    return np.array(faces, dtype=np.int32), np.array(points)


def paint(
    model: RegionModel, graph: FacetGraph, brush: Brush, faces: npt.NDArray[np.int32], points: Floats
) -> None:
    """Draw one stroke of the first region through picks (k,), (k, 3)."""
    with model.stroke(graph, brush, 1) as stroke:
        for face, point in zip(faces.tolist(), points, strict=True):
            stroke.extend(face, point)


def _undo(graph: FacetGraph, count: int, rng: np.random.Generator) -> Figure:
    """Undo and redo strokes; every state on the way back and forth must have the bytes that it had."""
    model = RegionModel(RegionSet.empty(graph.facet_count))
    for _ in range(3):
        model.add()
    states, here = [_digest(model)], [graph]
    model.subscribe(lambda it: it.cut and here.append(FacetGraph(it.cut.put_on(here[-1].probe))))
    for number in range(count):
        faces, points = wander(graph := here[-1], rng)
        brush = Brush(_RADIUS, geodesic=number % 3 > 0, erase=number % 5 == 4)
        with model.stroke(graph, brush, 1 + number % 3) as stroke:
            # A short stroke does: what is undone is any set of facets.
            for face, point in zip(faces[:3].tolist(), points[:3], strict=True):
                stroke.extend(face, point)
        if _digest(model) != states[-1]:
            states.append(_digest(model))
    wrong = 0
    for state in reversed(states[:-1]):
        wrong += not model.undo() or _digest(model) != state
    for state in states[1:]:
        wrong += not model.redo() or _digest(model) != state
    return Figure(
        graph.probe.name, f"{count:,} strokes undone and redone: states that differ", float(wrong), most=0.0
    )


def _digest(model: RegionModel) -> bytes:
    return hashlib.sha256(model.labels.tobytes()).digest()


def _edge_graph(probe: Probe) -> csr_array[np.float64]:
    from scipy.sparse import csr_array

    edges = np.unique(np.sort(probe.faces[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1), axis=0)
    lengths = np.linalg.norm(np.diff(probe.vertices[edges], axis=1)[:, 0], axis=1)
    count = len(probe.vertices)
    both = np.concatenate((edges, edges[:, ::-1]))
    return csr_array((np.tile(lengths, 2), (both[:, 0], both[:, 1])), shape=(count, count))
