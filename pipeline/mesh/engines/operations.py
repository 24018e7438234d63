"""The operations as functions: they check the mesh on the way in and what the library made of it on the way out."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, TypedDict

import numpy as np

from pipeline.mesh.engines.errors import EngineError
from pipeline.mesh.engines.operation import Operation
from pipeline.mesh.engines.run import run
from pipeline.mesh.probe import check_faces, check_vertices

if TYPE_CHECKING:
    from collections.abc import Callable
    from typing import Unpack

    import numpy.typing as npt

    Mesh = tuple[npt.NDArray[np.float64], npt.NDArray[np.int32]]


class Control(TypedDict, total=False):
    """`progress`, `cancelled` and `timeout_s` of `run`; every operation takes them."""

    progress: Callable[[float], None] | None
    cancelled: Callable[[], bool] | None
    timeout_s: float | None


def alpha_wrap(
    vertices: npt.ArrayLike,
    faces: npt.ArrayLike,
    alpha: float,
    offset: float,
    **control: Unpack[Control],
) -> Mesh:
    """
    Wrap a mesh, however broken, in a closed, orientable, manifold surface (Portaneri et al. 2022, CGAL).

    Parameters
    ----------
    vertices : (n, 3) array_like
        Any length unit.
    faces : (m, 3) array_like
        Vertex indices.
    alpha : float
        Gaps narrower than this are bridged, in the vertices' unit; above 0. The result's facets are of
        about this size, so the time grows with its inverse square.
    offset : float
        How far outside the mesh the wrap lies, in the same unit; above 0.
    **control
        See `run`.

    Returns
    -------
    vertices : (k, 3) float64
    faces : (l, 3) int32

    Raises
    ------
    MeshError
        The arrays are no mesh.
    EngineError, Cancelled
        See `run`; also for lengths that are not above 0.
    """
    _refuse_unless_positive(alpha=alpha, offset=offset)
    result = run(
        Operation.ALPHA_WRAP, _checked(vertices, faces), {"alpha": alpha, "offset": offset}, **control
    )
    return _mesh(Operation.ALPHA_WRAP, result)


def close_holes(
    vertices: npt.ArrayLike,
    faces: npt.ArrayLike,
    *,
    longest: int = 100,
    edge: float = 0.0,
    avoid_self_intersections: bool = True,
    **control: Unpack[Control],
) -> tuple[npt.NDArray[np.float64], npt.NDArray[np.int32], npt.NDArray[np.bool_]]:
    """
    Close holes with new facets.

    Parameters
    ----------
    vertices : (n, 3) array_like
        Any length unit.
    faces : (m, 3) array_like
        Vertex indices; no edge with more than two facets, or the library refuses.
    longest : int
        Holes with more edges than this stay open.
    edge : float
        Refine the new facets to about this edge length, in the vertices' unit; 0 leaves them as they are.
    avoid_self_intersections : bool
        Leave out fillings that would cut through the surface.
    **control
        See `run`.

    Returns
    -------
    vertices : (k, 3) float64
    faces : (l, 3) int32
    added : (l,) bool
        Facets that fill a hole.

    Raises
    ------
    MeshError
        The arrays are no mesh.
    EngineError, Cancelled
        See `run`.
    """
    parameters = {"longest": longest, "edge": edge, "avoid_self_intersections": avoid_self_intersections}
    result = run(Operation.CLOSE_HOLES, _checked(vertices, faces), parameters, **control)
    new_vertices, new_faces = _mesh(Operation.CLOSE_HOLES, result)
    return new_vertices, new_faces, _mask(Operation.CLOSE_HOLES, result, "added", len(new_faces))


def self_intersections(
    vertices: npt.ArrayLike, faces: npt.ArrayLike, **control: Unpack[Control]
) -> npt.NDArray[np.bool_]:
    """
    Find the facets that cut through others.

    Parameters
    ----------
    vertices : (n, 3) array_like
        Any length unit.
    faces : (m, 3) array_like
        Vertex indices.
    **control
        See `run`.

    Returns
    -------
    (m,) bool
        True where the facet crosses one that it does not share a vertex with.

    Raises
    ------
    MeshError
        The arrays are no mesh.
    EngineError, Cancelled
        See `run`.
    """
    arrays = _checked(vertices, faces)
    result = run(Operation.SELF_INTERSECTIONS, arrays, {}, **control)
    return _mask(Operation.SELF_INTERSECTIONS, result, "selected", len(arrays["faces"]))


def orient_facets(vertices: npt.ArrayLike, faces: npt.ArrayLike, **control: Unpack[Control]) -> Mesh:
    """
    Turn facets so that neighbours agree about which side is outside; which side it is may still be wrong.

    Parameters
    ----------
    vertices : (n, 3) array_like
        Any length unit.
    faces : (m, 3) array_like
        Vertex indices.
    **control
        See `run`.

    Returns
    -------
    vertices : (n, 3) float64
    faces : (m, 3) int32

    Raises
    ------
    MeshError
        The arrays are no mesh.
    EngineError, Cancelled
        See `run`; the library refuses meshes that are not two-manifold.
    """
    return _mesh(Operation.ORIENT, run(Operation.ORIENT, _checked(vertices, faces), {}, **control))


def quadric(
    vertices: npt.ArrayLike,
    faces: npt.ArrayLike,
    count: int,
    *,
    quality: npt.ArrayLike | None = None,
    shape: float = 0.3,
    planar: bool = False,
    keep_normals: bool = False,
    keep_topology: bool = False,
    **control: Unpack[Control],
) -> Mesh:
    """
    Collapse edges in the order of their quadric error (Garland & Heckbert 1997), by MeshLab.

    Degenerate and duplicate facets crash the library: leave them out first.

    Parameters
    ----------
    vertices : (n, 3) array_like
        Scaled to about 100: the library's thresholds are absolute.
    faces : (m, 3) array_like
        Vertex indices.
    count : int
        Facets to reach.
    quality : (n,) array_like, optional
        Weight of each vertex's error; the library maps it so that larger means simplified less.
    shape : float
        0 to 1: how much slender facets are avoided.
    planar : bool
        Keep vertices in flat parts evenly spaced.
    keep_normals : bool
        Refuse collapses that would flip a facet.
    keep_topology : bool
        Refuse collapses that would change the number of handles and parts.
    **control
        See `run`.

    Returns
    -------
    vertices : (k, 3) float64
    faces : (l, 3) int32
        Not always `count` of them: look.

    Raises
    ------
    MeshError
        The arrays are no mesh.
    EngineError, Cancelled
        See `run`.
    """
    arrays = _checked(vertices, faces)
    if quality is not None:
        weights = np.array(quality, dtype=np.float64)
        if weights.shape != (len(arrays["vertices"]),) or not np.isfinite(weights).all():
            raise EngineError("quality: give one finite number per vertex.")
        arrays["quality"] = weights
    parameters = {
        "count": count,
        "shape": shape,
        "planar": planar,
        "keep_normals": keep_normals,
        "keep_topology": keep_topology,
    }
    return _mesh(Operation.QUADRIC, run(Operation.QUADRIC, arrays, parameters, **control))


def fast_quadric(
    vertices: npt.ArrayLike,
    faces: npt.ArrayLike,
    count: int,
    *,
    aggression: float = 7.0,
    keep_border: bool = False,
    **control: Unpack[Control],
) -> Mesh:
    """
    Collapse edges whose quadric error is below a rising threshold, by fast-simplification.

    Parameters
    ----------
    vertices : (n, 3) array_like
        Scaled to about 100: the library's thresholds are absolute.
    faces : (m, 3) array_like
        Vertex indices.
    count : int
        Facets to reach, at most as many as there are.
    aggression : float
        How fast the threshold rises: less is slower and finer, and may stop short of the count.
    keep_border : bool
        Leave every vertex on the rim of an open mesh where it is, bit for bit.
    **control
        See `run`.

    Returns
    -------
    vertices : (k, 3) float64
    faces : (l, 3) int32
        Not always `count` of them: look.

    Raises
    ------
    MeshError
        The arrays are no mesh.
    EngineError, Cancelled
        See `run`.
    """
    parameters = {"count": count, "aggression": aggression, "keep_border": keep_border}
    result = run(Operation.FAST_QUADRIC, _checked(vertices, faces), parameters, **control)
    return _mesh(Operation.FAST_QUADRIC, result)


def _checked(vertices: npt.ArrayLike, faces: npt.ArrayLike) -> dict[str, npt.NDArray[Any]]:
    points = check_vertices(vertices)
    return {"vertices": points, "faces": check_faces(faces, len(points))}


def _refuse_unless_positive(**lengths: float) -> None:
    for name, value in lengths.items():
        # not >, so that NaN is refused too.
        if not 0 < value < float("inf"):
            raise EngineError(f"{name} is {value:g}: give a length above 0.")


def _mesh(operation: Operation, result: dict[str, npt.NDArray[Any]]) -> Mesh:
    """Believe nothing: the libraries pass NaN on, and a heap they damaged may hold anything."""
    vertices, faces = result.get("vertices"), result.get("faces")
    match vertices, faces:
        case np.ndarray(ndim=2, shape=(_, 3)) as points, np.ndarray(ndim=2, shape=(count, 3)) as triangles:
            right = (
                points.dtype == np.float64 and triangles.dtype == np.int32 and bool(np.isfinite(points).all())
            )
            if right and count and triangles.min() >= 0 and triangles.max() < len(points):
                return points, triangles
    raise EngineError(
        f"{operation.library} made no usable mesh of '{operation}': repair the mesh first, or use another engine."
    )


def _mask(
    operation: Operation, result: dict[str, npt.NDArray[Any]], name: str, count: int
) -> npt.NDArray[np.bool_]:
    mask = result.get(name)
    if mask is None or mask.dtype != np.bool_ or mask.shape != (count,):
        raise EngineError(f"{operation.library} gave no answer per facet to '{operation}': use another mesh.")
    return mask
