"""Facets chosen by where they lie, which way they face, or what they hang together with: (m,) bool each."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from contactbench.pipeline.errors import arg, message
from contactbench.pipeline.mesh.regions.region import RegionError

if TYPE_CHECKING:
    import numpy.typing as npt

    from contactbench.pipeline.mesh.regions.facet_graph import FacetGraph, Mask


def in_box(
    graph: FacetGraph,
    low: npt.ArrayLike,
    high: npt.ArrayLike,
    *,
    R_SB: npt.ArrayLike | None = None,
    p_SB_S: npt.ArrayLike | None = None,
) -> Mask:
    """
    Facets whose centroid lies in a box.

    Parameters
    ----------
    graph : FacetGraph
    low, high : (3,) array_like
        Corners in the box's frame B, m; infinite where the box has no end.
    R_SB : (3, 3) array_like, optional
        Orientation of B in S; B is parallel to S when left out.
    p_SB_S : (3,) array_like, optional
        Origin of B in S, m; that of S when left out.

    Raises
    ------
    RegionError
        Not three numbers, NaN, a low corner that is not below the high one, or no rotation.
    """
    lower, upper = (vector(value, name, finite=False) for value, name in ((low, "low"), (high, "high")))
    if not (lower < upper).all():
        raise RegionError(
            f"the box goes from {arg(lower.tolist())} to {arg(upper.tolist())} m: each low value must be"
            " below the high one."
        )
    points = (
        graph.centroids if p_SB_S is None else graph.centroids - vector(p_SB_S, message("origin of the box"))
    )
    if R_SB is not None:
        points = points @ _rotation(R_SB)
    inside: Mask = np.all((points >= lower) & (points <= upper), axis=1)
    return inside


def half_space(graph: FacetGraph, point: npt.ArrayLike, normal: npt.ArrayLike) -> Mask:
    """
    Facets whose centroid lies on a plane or on the side that its normal points to.

    Parameters
    ----------
    graph : FacetGraph
    point : (3,) array_like
        On the plane, S, m.
    normal : (3,) array_like
        S, of any length but 0.

    Raises
    ------
    RegionError
        Not three finite numbers, or a normal without direction.
    """
    side: Mask = (graph.centroids - vector(point, "point")) @ unit(normal, "normal") >= 0
    return side


def facing(graph: FacetGraph, direction: npt.ArrayLike, angle: float) -> Mask:
    """
    Facets whose outward normal is within an angle of a direction.

    Parameters
    ----------
    graph : FacetGraph
    direction : (3,) array_like
        S, of any length but 0.
    angle : float
        Half-angle of the cone, rad, from 0 to pi.

    Raises
    ------
    RegionError
        No direction, or no such angle.
    """
    _check_angle(angle)
    cone: Mask = graph.probe.normals @ unit(direction, "direction") >= math.cos(angle) - 1e-12
    return cone


def flood(graph: FacetGraph, face: int, crease: float, *, within: Mask | None = None) -> Mask:
    """
    Facets that can be reached from one without crossing a crease.

    Parameters
    ----------
    graph : FacetGraph
    face : int
        Where to begin.
    crease : float
        Edges whose facets differ by more than this are not crossed, rad, from 0 to pi.
    within : (m,) bool, optional
        Only these facets are entered, such as those of no region; the first one counts in any case.

    Raises
    ------
    RegionError
        No such facet or angle.
    """
    _check_angle(crease)
    graph.check_face(face)
    crossed = graph.creases <= crease
    if within is not None:
        entered = within.copy()
        entered[face] = True
        crossed &= entered[graph.pairs].all(axis=1)
    return _hanging_together(graph, graph.pairs[crossed], face)


def component(graph: FacetGraph, face: int, *, within: Mask | None = None) -> Mask:
    """Facets that hang together with one over edges, `within` (m,) bool if that is given; see `flood`."""
    return flood(graph, face, math.pi, within=within)


def _hanging_together(graph: FacetGraph, pairs: npt.NDArray[np.int64], face: int) -> Mask:
    label = component_labels(graph.facet_count, pairs)
    same: Mask = label == label[face]
    return same


def component_labels(count: int, pairs: npt.NDArray[np.int64]) -> npt.NDArray[np.int32]:
    """Return the number of its part, (count,), for each node of a graph that the pairs (k, 2) join."""
    links = coo_array((np.ones(len(pairs), dtype=np.int8), (pairs[:, 0], pairs[:, 1])), shape=(count, count))
    label: npt.NDArray[np.int32] = connected_components(links, directed=False)[1]
    return label


def unit(values: npt.ArrayLike, name: str) -> npt.NDArray[np.float64]:
    """Return a direction (3,) of length 1; RegionError if it has none."""
    v = vector(values, name)
    length = float(np.linalg.norm(v))
    if not 1e-100 < length < 1e100:
        raise RegionError(f"{arg(name)} {arg(v.tolist())} has no direction: give a vector that is not zero.")
    return v / length


def vector(values: npt.ArrayLike, name: str, *, finite: bool = True) -> npt.NDArray[np.float64]:
    """Return (3,) numbers, none of them NaN and, if asked for, all finite; RegionError otherwise."""
    try:
        v = np.asarray(values, dtype=np.float64)
    except (ValueError, TypeError) as error:
        raise RegionError(f"{arg(name)} is not three numbers ({arg(error)}): give x, y and z.") from error
    bad = ~np.isfinite(v) if finite else np.isnan(v)
    if v.shape != (3,) or bad.any():
        raise RegionError(
            f"{arg(name)} is {arg(np.array2string(v, threshold=9))}: give three numbers x, y and z."
        )
    return v


def _rotation(values: npt.ArrayLike) -> npt.NDArray[np.float64]:
    R = np.asarray(values, dtype=np.float64)
    if R.shape != (3, 3) or not np.allclose(R.T @ R, np.eye(3), atol=1e-6) or np.linalg.det(R) < 0:
        raise RegionError("the box's orientation is not a rotation: give a 3 x 3 matrix R_SB.")
    return R


def _check_angle(angle: float) -> None:
    if not 0 <= angle <= math.pi:
        raise RegionError(f"{arg(angle)} rad is not an angle between two directions: give 0 to 180 degrees.")
