"""Who is asked: the solver, and ray tracers along the wrench axis, each as its own documentation calls it."""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from importlib import import_module
from typing import TYPE_CHECKING, Any

import numpy as np
from benchmarks.rays.compiled import CompiledHits, CompiledTouches, compile_hits, compile_touches

from contactbench.pipeline.contact.methods import EmbreeAxis, WrenchAxis
from contactbench.pipeline.errors import InputError

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator
    from pathlib import Path

    from numpy.typing import NDArray

    from contactbench.pipeline.contact import ContactSolver

    Float = NDArray[np.float64]
    Single = NDArray[np.float32]
    Ready = Callable[[slice], Callable[[], object]]

SINGLE, BATCH, PAIR = "one at a time", "batch, one thread", "batch, two threads"
OURS, TRACKING, COVARIANCE = "contactbench", "contactbench, tracking", "contactbench, covariance too"
HEADERS, HEADERS_TRACKING = "contactbench, C++", "contactbench, C++, tracking"
OPEN3D, EMBREEX, TRIMESH, BVH, FCPW = "Open3D", "embreex", "trimesh.ray", "madmann91/bvh, C++", "FCPW"
FIRST, ALL = "first hit", "all hits"
_NO_FACET = np.iinfo(np.uint32).max
_PAST_M, _MISSED = 1e-6, 1e30  # behind a hit the next ray begins; Embree's distance of none is 1e37

# What an answer holds.
_TOUCH = "point, normal, facet, torsion, reason, confidence, number of rivals"
ANSWERS = {
    (OURS, ""): f"{_TOUCH}; one at a time: the rivals themselves",
    (TRACKING, ""): f"{_TOUCH}; a second touch that joins",
    (COVARIANCE, ""): f"{_TOUCH}; covariance of the point",
    (HEADERS, ""): f"{_TOUCH}, the rivals themselves",
    (HEADERS_TRACKING, ""): f"{_TOUCH}, the rivals themselves; a second touch that joins",
    (OPEN3D, FIRST): "distance, facet, place in it, normal",
    (OPEN3D, ALL): "of each hit: distance, facet, place in it",
    (EMBREEX, FIRST): "facet",
    (EMBREEX, ALL): "of each hit: distance; asked again from behind each",
    (TRIMESH, FIRST): "facet",
    (TRIMESH, ALL): "of each hit: facet",
    (BVH, FIRST): "distance, facet",
    (BVH, ALL): "of each hit: distance, facet",
    (FCPW, FIRST): "distance, facet, place in it, point, normal",
    (FCPW, ALL): "of each hit: distance, facet, place in it, point, normal",
}


@dataclass(frozen=True, eq=False)
class Contender:
    """One call of one library."""

    name: str
    query: str  # FIRST, ALL, or nothing: a touch
    calls: str  # SINGLE, BATCH or PAIR
    ready: Ready  # what answers these rows; only calling it is timed
    stream: bool = False  # it answers the stream, not touches here and there
    own_threads: bool = False  # it takes as many as it likes: the time of the whole process counts

    @property
    def key(self) -> tuple[str, str, str]:
        """What tells it from all others."""
        return self.name, self.query, self.calls


class _Untraced(WrenchAxis):
    @property
    def mesh(self) -> tuple[Single, NDArray[np.int32]]:
        """The mesh as ray tracers get it: about its middle, m."""
        return self._single

    @property
    def centre(self) -> Float:
        """Its middle (3,), S, m."""
        return np.asarray(self._centre)

    def trace(self, origins: Single, directions: Single) -> NDArray[np.int32]:
        """See `WrenchAxis`."""
        raise NotImplementedError


class Open3DAxis(WrenchAxis):
    """The wrench axis traced by Open3D's RaycastingScene; ImportError where it cannot be had."""

    def __init__(self, solver: ContactSolver) -> None:
        self._open3d: Any = import_module("open3d")
        super().__init__(solver)
        vertices, faces = self._single
        core = self._open3d.core
        self.scene = self._open3d.t.geometry.RaycastingScene()
        self.scene.add_triangles(core.Tensor(vertices), core.Tensor(faces.astype(np.uint32)))

    def prepared(self, origins: Single, directions: Single) -> Any:
        """Return rays as the library wants them."""
        return self._open3d.core.Tensor(np.hstack([origins, directions]))

    def trace(self, origins: Single, directions: Single) -> NDArray[np.int32]:
        """Return the first facet that each ray enters; see `WrenchAxis`."""
        hits = self.scene.cast_rays(self.prepared(origins, directions))["primitive_ids"].numpy()
        return np.where(hits == _NO_FACET, -1, hits.astype(np.int64)).astype(np.int32)


def every_hit(
    axis: EmbreeAxis, origins: Single, directions: Single
) -> tuple[NDArray[np.intp], NDArray[np.float32]]:
    """
    Return all places where rays (n, 3), (n, 3) meet the mesh: which ray (k,), and how far along it (k,), m.

    Embree is asked again from behind each hit, all rays that are left in one call.
    """
    left, begun = np.arange(len(origins)), np.zeros(len(origins), np.float32)
    rays, distances = [], []
    while len(left):
        start = origins[left] + begun[left, None] * directions[left]
        met = axis.scene.run(start, directions[left], query="DISTANCE")
        hit = met < _MISSED
        left = left[hit]
        begun[left] += met[hit] + np.float32(_PAST_M)
        rays.append(left)
        distances.append(begun[left])
    return np.concatenate(rays), np.concatenate(distances)


@dataclass(frozen=True, eq=False)
class Questions:
    """What all are asked: each wrench, or its axis as a ray from outside along the force."""

    solver: ContactSolver
    wrenches: Float  # (n, 6) touches here and there; N and N·m, S
    stream: Float  # (n, 6) samples of a contact that slides
    axis: _Untraced
    rays: tuple[Single, Single]  # origins and directions (n, 3), about the middle of the mesh, m

    @property
    def single_rays(self) -> tuple[Single, Single]:
        """The same for one at a time: rows are (1, 3)."""
        origins, directions = self.rays
        return origins[:, None], directions[:, None]

    @classmethod
    def of(cls, solver: ContactSolver, wrenches: Float, stream: Float) -> Questions:
        """Turn wrenches into rays, too."""
        axis = _Untraced(solver)
        return cls(solver, wrenches, stream, axis, axis.rays(wrenches))


class Field:
    """
    Everybody who is there.

    Parameters
    ----------
    folder : Path
        For what is compiled.
    bvh : Path, optional
        Checkout of madmann91/bvh, version 2.
    """

    def __init__(self, folder: Path, bvh: Path | None) -> None:
        self.absent: dict[str, str] = {}  # name -> why
        self._headers = self._made(HEADERS, lambda: compile_touches(folder))
        self._hits = None
        if bvh is None:
            self.absent[BVH] = "no checkout was given: --bvh DIR"
        else:
            self._hits = self._made(BVH, lambda: compile_hits(folder, bvh))

    def contenders(self, asked: Questions) -> Iterator[Contender]:
        """Build everybody on one mesh."""
        yield from _ours(asked)
        if self._headers is not None:
            yield from _headers(asked, CompiledTouches(self._headers, asked.solver))
        for name, make in ((OPEN3D, _open3d), (EMBREEX, _embreex), (TRIMESH, _trimesh), (FCPW, _fcpw)):
            yield from self._made(name, lambda make=make: make(asked)) or []
        if self._hits is not None:
            yield from _bvh(asked, CompiledHits(self._hits, *asked.axis.mesh))

    def _made(self, name: str, make: Callable[[], Any]) -> Any:
        try:
            return make()
        except (ImportError, OSError, InputError) as error:
            self.absent[name] = str(error).splitlines()[0]
            return None


def _ours(asked: Questions) -> Iterator[Contender]:
    solver, wrenches, stream = asked.solver, asked.wrenches, asked.stream
    yield Contender(OURS, "", SINGLE, _one_by_one(solver.locate, wrenches))
    yield Contender(TRACKING, "", SINGLE, _one_by_one(solver.track, stream), stream=True)
    for calls, threads in ((BATCH, 1), (PAIR, 2)):
        yield Contender(OURS, "", calls, _together(partial(solver.locate_batch, threads=threads), wrenches))
    located = _together(lambda rows: solver.locate_batch(rows).covariances, wrenches)
    yield Contender(COVARIANCE, "", BATCH, located)
    yield Contender(TRACKING, "", BATCH, _together(solver.track_batch, stream), stream=True)


def _headers(asked: Questions, compiled: CompiledTouches) -> Iterator[Contender]:
    for calls, threads in ((BATCH, 1), (PAIR, 2)):
        locate = partial(compiled.locate, threads=threads)
        yield Contender(HEADERS, "", calls, _together(locate, asked.wrenches))
    yield Contender(HEADERS_TRACKING, "", BATCH, _together(compiled.track, asked.stream), stream=True)


def _open3d(asked: Questions) -> list[Contender]:
    axis = Open3DAxis(asked.solver)
    made = []
    for query, ask in ((FIRST, axis.scene.cast_rays), (ALL, axis.scene.list_intersections)):
        one, two = (partial(ask, nthreads=threads) for threads in (1, 2))
        made += [
            Contender(OPEN3D, query, SINGLE, _one_by_one(one, *asked.single_rays, prepared=axis.prepared)),
            Contender(OPEN3D, query, BATCH, _together(one, *asked.rays, prepared=axis.prepared)),
            Contender(OPEN3D, query, PAIR, _together(two, *asked.rays, prepared=axis.prepared)),
        ]
    return made


def _embreex(asked: Questions) -> list[Contender]:
    axis = EmbreeAxis(asked.solver)
    first, every = partial(axis.scene.run, query="INTERSECT"), partial(every_hit, axis)
    return _both_ways(EMBREEX, asked, first, every)


def _trimesh(asked: Questions) -> list[Contender]:
    import_module("embreex")  # without it trimesh traces in Python, which nobody would compare with
    trimesh, tracers = import_module("trimesh"), import_module("trimesh.ray.ray_pyembree")
    tracer = tracers.RayMeshIntersector(trimesh.Trimesh(*asked.axis.mesh, process=False))
    return _both_ways(
        TRIMESH, asked, tracer.intersects_first, partial(tracer.intersects_id, multiple_hits=True)
    )


def _both_ways(
    name: str, asked: Questions, first: Callable[..., object], every: Callable[..., object]
) -> list[Contender]:
    made = []
    for query, ask in ((FIRST, first), (ALL, every)):
        made.append(Contender(name, query, SINGLE, _one_by_one(ask, *asked.single_rays)))
        made.append(Contender(name, query, BATCH, _together(ask, *asked.rays)))
    return made


def _fcpw(asked: Questions) -> list[Contender]:
    fcpw = import_module("fcpw")
    vertices, faces = (np.asfortranarray(array) for array in asked.axis.mesh)
    scene = fcpw.scene_3D()
    scene.set_object_count(1)
    scene.set_object_vertices(vertices, 0)
    scene.set_object_triangles(faces, 0)
    scene.build(fcpw.aggregate_type.bvh_surface_area, vectorize=True)
    far = np.finfo(np.float32).max

    def first(origin: Single, direction: Single) -> object:
        met = fcpw.interaction_3D()
        scene.intersect(fcpw.ray_3D(origin[0], direction[0]), met)
        return met

    def every(origin: Single, direction: Single) -> object:
        met = fcpw.interaction_3D_list()
        scene.intersect(fcpw.ray_3D(origin[0], direction[0]), met, False, True)
        return met

    def prepared(origins: Single, directions: Single) -> tuple[Any, ...]:
        return np.asfortranarray(origins), np.asfortranarray(directions), np.full(len(origins), far)

    def together(rays: tuple[Any, ...]) -> object:
        met = fcpw.interaction_3D_list()
        scene.intersect(*rays, met)
        return met

    return [
        Contender(FCPW, FIRST, SINGLE, _one_by_one(first, *asked.single_rays)),
        Contender(FCPW, ALL, SINGLE, _one_by_one(every, *asked.single_rays)),
        Contender(FCPW, FIRST, BATCH, _together(together, *asked.rays, prepared=prepared), own_threads=True),
    ]


def _bvh(asked: Questions, compiled: CompiledHits) -> Iterator[Contender]:
    for query, ask in ((FIRST, compiled.first), (ALL, compiled.all)):
        for calls, threads in ((BATCH, 1), (PAIR, 2)):
            yield Contender(BVH, query, calls, _together(partial(ask, threads=threads), *asked.rays))


def _one_by_one(
    ask: Callable[..., object], *given: NDArray[Any], prepared: Callable[..., object] | None = None
) -> Ready:
    """Ask for each row in turn; `prepared` turns one row of each array into the one argument that is wanted."""

    def ready(rows: slice) -> Callable[[], object]:
        each: list[tuple[object, ...]] = list(zip(*(array[rows] for array in given), strict=True))
        if prepared is not None:
            each = [(prepared(*one),) for one in each]
        return lambda: [ask(*one) for one in each]

    return ready


def _together(
    ask: Callable[..., object], *given: NDArray[Any], prepared: Callable[..., object] | None = None
) -> Ready:
    """Ask for all rows in one call."""

    def ready(rows: slice) -> Callable[[], object]:
        these = [array[rows] for array in given]
        return partial(ask, *these) if prepared is None else partial(ask, prepared(*these))

    return ready
