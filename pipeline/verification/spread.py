"""Markers placed by the program: spread evenly, or on a grid."""

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import KDTree

from contactbench.pipeline.contact import ContactSolver
from contactbench.pipeline.errors import arg
from contactbench.pipeline.kernel import SurfaceIndex
from contactbench.pipeline.mesh import Probe
from contactbench.pipeline.verification.markers import MarkerError, MarkerSet, make_markers, snap

_DRAWN = 20_000
_MOST_MARKERS = 1_000
_FORCE, _LEAN = 9.0, 0.25  # N; tangent of the angle by which a press may lean
_OFF = 0.002  # m: farther off, a press is not told from another
_ROOM = 0.05  # m: that a tip needs in front of the plane z = 0, where the sensor is
_FINEST = 0.0005  # m: closer together no tip tells them apart


def spread_markers(probe: Probe, count: int = 17, region: int | None = None) -> MarkerSet:
    """
    Return markers as far from each other as they get: each new one is farthest from those before it.

    They lie where presses can be told from presses elsewhere, and not on what looks at the sensor near by, as long as
    there are enough such places: a touch that might be two never counts.

    Parameters
    ----------
    probe : Probe
    count : int
        1 to 1000.
    region : int, optional
        Only on the facets of this rank; left out: anywhere.

    Returns
    -------
    MarkerSet
        On the surface, with normals; the same on every call.

    Raises
    ------
    MarkerError
        The count is out of range, or the region has no facets.
    """
    if not 1 <= count <= _MOST_MARKERS:
        raise MarkerError(f"{arg(count)} markers: give a number from 1 to {arg(_MOST_MARKERS)}.")
    points = _drawn(probe, _chosen(probe, region), count)
    centre = points.mean(axis=0)
    # The middle first, so that a set of one marker is a useful one.
    places = [int(np.argmin(np.linalg.norm(points - centre, axis=1)))]
    nearest = np.linalg.norm(points - points[places[0]], axis=1)
    while len(places) < count:
        places.append(int(np.argmax(nearest)))
        nearest = np.minimum(nearest, np.linalg.norm(points - points[places[-1]], axis=1))
    return snap(make_markers(points[places]), probe).markers


def grid_markers(probe: Probe, pitch: float, region: int | None = None) -> MarkerSet:
    """
    Return the markers of a square grid in S's x and y, seen from the side that the facets look to most.

    Parameters
    ----------
    probe : Probe
    pitch : float
        Distance of its lines, m.
    region : int, optional
        As in `spread_markers`.

    Raises
    ------
    MarkerError
        The pitch is out of range, or no point of the grid, or more than 1000, meet the facets.
    """
    if not pitch >= _FINEST:
        raise MarkerError(
            f"a grid of {arg(1e3 * pitch):g} mm is too fine: give {arg(1e3 * _FINEST):g} mm or more."
        )
    chosen = _chosen(probe, region)
    up = np.sign((probe.normals[chosen, 2] * probe.areas[chosen]).sum()) or 1.0
    corners = probe.vertices[probe.faces[chosen]].reshape(-1, 3)
    low, high = corners.min(axis=0), corners.max(axis=0)
    axes = [_lines(low[axis], high[axis], pitch) for axis in (0, 1)]
    if len(axes[0]) * len(axes[1]) > 100 * _MOST_MARKERS:
        raise MarkerError(
            f"a grid of {arg(1e3 * pitch):g} mm is too fine for this probe: choose a wider one."
        )
    x, y = (each.ravel() for each in np.meshgrid(*axes, indexing="ij"))
    outside = (high[2] if up > 0 else low[2]) + up * probe.size
    origins = np.column_stack([x, y, np.full(len(x), outside)])
    directions = np.tile([0.0, 0.0, -up], (len(x), 1))
    distances, faces = SurfaceIndex(probe.vertices, probe.faces).first_hit(origins, directions)
    hit = (faces >= 0) & np.isin(faces, chosen)
    if not 1 <= np.count_nonzero(hit) <= _MOST_MARKERS:
        raise MarkerError(
            f"a grid of {arg(1e3 * pitch):g} mm has {arg(np.count_nonzero(hit))} points on these facets, but"
            f" 1 to {arg(_MOST_MARKERS)} are allowed: choose another pitch."
        )
    points = origins[hit] + distances[hit, None] * directions[hit]
    return snap(make_markers(points), probe).markers


def _lines(low: float, high: float, pitch: float) -> NDArray[np.float64]:
    """Return coordinates between two bounds, symmetric about their middle."""
    count = int((high - low) / pitch) + 1
    return np.asarray(0.5 * (low + high) + pitch * (np.arange(count) - 0.5 * (count - 1)), dtype=np.float64)


def _chosen(probe: Probe, region: int | None) -> NDArray[np.intp]:
    touchable = ~np.isin(probe.region, probe.untouchable)
    chosen = np.flatnonzero(touchable if region is None else touchable & (probe.region == region))
    if region is None and not len(chosen):
        raise MarkerError("the whole probe is marked untouchable: correct the regions.")
    if not len(chosen) or (region is not None and region < 1):
        known = ", ".join(map(str, np.unique(probe.region[touchable & (probe.region > 0)]))) or "none"
        raise MarkerError(
            f"there is no touchable region {arg(region)}; the probe has {arg(known)}: choose one, or --all."
        )
    return chosen


def _drawn(probe: Probe, chosen: NDArray[np.intp], count: int) -> NDArray[np.float64]:
    rng = np.random.default_rng(0)
    areas = probe.areas[chosen]
    facets = chosen[rng.choice(len(chosen), _DRAWN, p=areas / areas.sum())]
    shares = rng.dirichlet(np.ones(3), _DRAWN)
    points = np.asarray(np.einsum("nk,nkd->nd", shares, probe.vertices[probe.faces[facets]]))
    told = _told(probe, points, facets) & _free(points, probe.normals[facets])
    if not told.all():  # beyond an edge a press comes from another side
        told &= KDTree(points[~told]).query(points)[0] > _OFF
    return points[told] if np.count_nonzero(told) >= max(count, _DRAWN // 10) else points


def _free(points: NDArray[np.float64], normals: NDArray[np.float64]) -> NDArray[np.bool_]:
    """Tell where the sensor, at z = 0, leaves room for a tip."""
    down = np.minimum(normals[:, 2], -1e-9)
    return np.asarray((points[:, 2] < 0) | (points[:, 2] / -down > _ROOM))


def _told(probe: Probe, points: NDArray[np.float64], facets: NDArray[np.intp]) -> NDArray[np.bool_]:
    """Tell where presses, straight or leaning a little, are located there and nowhere else."""
    inward = -probe.normals[facets]
    across = np.cross(inward, np.eye(3)[np.argmin(np.abs(inward), axis=1)])
    across /= np.linalg.norm(across, axis=1, keepdims=True)
    solver, told = ContactSolver(probe), ~probe.invented[facets]
    for lean in (0.0 * across, across, -across, np.cross(inward, across), np.cross(across, inward)):
        forces = _FORCE * (inward + _LEAN * lean)
        found = solver.locate_batch(np.hstack([forces, np.cross(points, forces)]))
        off = np.linalg.norm(np.array(found.points) - points, axis=1)
        told &= np.array(found.accepted) & (off < _OFF)
    return np.asarray(told)
