"""An alignment from the mesh's mounting face: the plane that is screwed to the sensor."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
import scipy
from numpy.typing import ArrayLike

from contactbench.pipeline.errors import arg, message
from contactbench.pipeline.mesh import Probe
from contactbench.pipeline.mesh.arrays import Floats, Ints, Longs, Mask
from contactbench.pipeline.mesh.health import connected
from contactbench.pipeline.preparation.alignment.alignment import (
    Alignment,
    AlignmentError,
    AlignmentMethod,
    across,
    check_numbers,
    make_transform,
    turn_between,
)

_STEPS = 20
_ROUND, _GAP = 0.02, float(np.radians(44.0))


@dataclass(frozen=True, eq=False)
class Rim:
    """The outer outline of a patch."""

    vertices: Longs  # (k,) vertex indices around it
    # circle_centre, area_centre: (3,) centre of the fitted circle, and of the area inside the outline,
    # on the plane, m
    circle_centre: Floats
    area_centre: Floats
    # radius, radius_rms: of the circle, and how far the outline's vertices are from it, m
    radius: float
    radius_rms: float
    largest_gap: float  # largest angle between neighbouring vertices, seen from the circle's centre, rad

    @property
    def round(self) -> bool:
        """Whether the vertices lie on the circle within 2 % of its radius, and all around it.

        The corners of every rectangle lie on a circle too: they are 45 degrees apart or more.
        """
        return self.radius_rms <= _ROUND * self.radius and self.largest_gap < _GAP


def find_rim(vertices: Floats, faces: Ints, middle: Floats, normal: Floats) -> Rim:
    """
    Find the longest outline of a patch.

    Parameters
    ----------
    vertices : (n, 3)
        In metres.
    faces : (m, 3)
        The facets of the patch.
    middle, normal : (3,)
        A point and the unit normal of the patch's plane.

    Raises
    ------
    AlignmentError
        The patch has no outline.
    """
    loops = _loops(faces)
    if not loops:
        raise AlignmentError("The patch has no rim: it is a closed surface. Pick a facet of a plane face.")
    axes = across(normal[None])[0]
    flat = [(vertices[loop] - middle) @ axes.T for loop in loops]
    longest = max(range(len(flat)), key=lambda row: _length(flat[row]))
    points = flat[longest]
    centre, radius, rms = _circle(points)
    angles = np.sort(np.arctan2(points[:, 1] - centre[1], points[:, 0] - centre[0]))
    gap = float(np.diff(angles, append=angles[0] + 2 * np.pi).max())
    area_centre = middle + _area_centre(points) @ axes
    return Rim(loops[longest], middle + centre @ axes, area_centre, radius, rms, gap)


def _loops(faces: Ints) -> list[Longs]:
    """Chain the edges that belong to one facet only."""
    edges = faces[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2).astype(np.int64)
    keys = np.sort(edges, axis=1)
    _, first, count = np.unique(keys, axis=0, return_index=True, return_counts=True)
    ahead: dict[int, list[int]] = {}
    for a, b in edges[first[count == 1]].tolist():
        ahead.setdefault(a, []).append(b)
    loops = []
    while ahead:
        start = next(iter(ahead))
        loop = [start]
        while loop[-1] in ahead:
            after = ahead[loop[-1]]
            vertex = after.pop()
            if not after:
                del ahead[loop[-1]]
            if vertex == start:
                break
            loop.append(vertex)
        if len(loop) > 2:
            loops.append(np.array(loop, dtype=np.int64))
    return loops


def _length(points: Floats) -> float:
    return float(np.linalg.norm(points - np.roll(points, 1, axis=0), axis=1).sum())


def _circle(points: Floats) -> tuple[Floats, float, float]:
    """Fit a circle to a closed outline (k, 2): first in squares (Kasa), then in distances."""
    # A vertex stands for half of each edge beside it, or unevenly meshed rims would pull the centre.
    sides = np.linalg.norm(np.roll(points, -1, axis=0) - points, axis=1)
    weight = np.sqrt(0.5 * (sides + np.roll(sides, 1)))
    design = np.column_stack([2 * points, np.ones(len(points))])
    square = (points**2).sum(axis=1)
    x, y, c = np.linalg.lstsq(design * weight[:, None], square * weight, rcond=None)[0]
    centre, radius = np.array([x, y]), float(np.sqrt(max(c + x * x + y * y, 0.0)))
    for _ in range(_STEPS):
        out = points - centre
        distance = np.maximum(np.linalg.norm(out, axis=1), 1e-12)
        J = np.column_stack([out / distance[:, None], np.ones(len(points))])
        dx, dy, dr = np.linalg.lstsq(J * weight[:, None], (distance - radius) * weight, rcond=None)[0]
        centre, radius = centre + (dx, dy), radius + float(dr)
    left = np.linalg.norm(points - centre, axis=1) - radius
    return centre, radius, float(np.sqrt(np.average(left**2, weights=weight**2)))


def _area_centre(points: Floats) -> Floats:
    following = np.roll(points, -1, axis=0)
    twice = points[:, 0] * following[:, 1] - points[:, 1] * following[:, 0]
    area = float(twice.sum())
    if abs(area) < 1e-15:
        return np.asarray(points.mean(axis=0))
    centre: Floats = ((points + following) * twice[:, None]).sum(axis=0) / (3 * area)
    return centre


_GROWINGS = 3
# Least absolute distances by reweighting; under a micrometre all distances count alike.
_REWEIGHTED, _FINE_M = 15, 1e-6
_UNEVEN_M = 0.0002
_SMALL_M = 0.005
_DOWN_S = np.array([0.0, 0.0, -1.0])
_NO_DIRECTION = 0.05


@dataclass(frozen=True, eq=False)
class MountingFace:
    """A plane patch of the mesh."""

    facets: Mask  # (m,) which facets of the mesh belong to it
    normal_P: Floats  # (3,) outward unit normal of the plane fitted to it
    # (3,) on the plane, m: of the circle if the rim is round, or else of the area inside the rim
    centre_P: Floats
    area_m2: float  # of its facets
    # planarity_rms, planarity_max: distances of its vertices from the plane, m
    planarity_rms: float
    planarity_max: float
    rim: Rim  # its outer outline, and the circle fitted to it

    @property
    def round(self) -> bool:
        """Whether the rim is a circle."""
        return self.rim.round


def find_mounting_face(
    probe_P: Probe, facet: int, *, angle_deg: float = 5.0, flatness: float = 0.0001
) -> MountingFace:
    """
    Grow the plane patch around a picked facet.

    Facets join while they are connected to the picked one and their normals are within `angle_deg` of the
    patch's mean normal: of the mean, not of the neighbour, so that it cannot creep round a smooth edge. Those
    that rise from the plane of the others by more than `flatness`, as the first facets of a rounded edge do,
    leave it again.

    Parameters
    ----------
    probe_P : Probe
        In P.
    facet : int
        Index of the picked facet.
    angle_deg : float
        Above 0, at most 45.
    flatness : float
        Largest distance of a vertex from the plane, m. A scanned face that is rougher is taken whole.

    Raises
    ------
    AlignmentError
        There is no such facet, the angle is out of range, or the patch has no outline, as a closed surface.
    """
    if not 0 <= facet < len(probe_P.faces):
        raise AlignmentError(
            f"facet: {arg(facet)} is not between 0 and {arg(len(probe_P.faces) - 1)}: pick a facet of the mesh."
        )
    if not 0 < angle_deg <= 45:
        raise AlignmentError(f"angle_deg: {arg(angle_deg)} is not above 0 and at most 45.")
    pairs = _neighbours(probe_P.faces)
    normal = probe_P.normals[facet]
    for _ in range(_GROWINGS):
        near = probe_P.normals @ normal >= np.cos(np.radians(angle_deg))
        if not near[facet]:
            break  # the picked facet is a bump on a larger face: keep what grew around it
        facets = _connected(pairs, near, facet)
        mean = (probe_P.normals[facets] * probe_P.areas[facets, None]).sum(axis=0)
        normal = mean / np.linalg.norm(mean)
    middle, plane = _plane(probe_P, facets, normal, robust=True)
    rise = np.abs((probe_P.vertices[probe_P.faces] - middle) @ plane).max(axis=1)
    flat = facets & (rise <= flatness)
    if flat[facet]:
        facets = _connected(pairs, flat, facet)
    return _measure(probe_P, facets, normal)


def align_flange(
    face: MountingFace, *, offset: float = 0.0, toward_P: ArrayLike | None = None, clock_deg: float = 0.0
) -> Alignment:
    """
    Put the mounting face on the sensor: its plane at ``z = offset``, its centre on the z axis.

    The face looks at the sensor, so its outward normal becomes -z of S and the probe extends along +z.

    Parameters
    ----------
    face : MountingFace
    offset : float
        Where the sensor's mounting plane lies along z of S, m.
    toward_P : (3,) array_like, optional
        A picked point, m: the direction to it from the centre is the clocking direction.
    clock_deg : float
        Angle of the clocking direction from +x of S about +z, degrees.

    Returns
    -------
    Alignment
        Its residual is the face's planarity.

    Raises
    ------
    AlignmentError
        The clocking direction points along the axis.
    """
    if not abs(clock_deg) <= 360:
        raise AlignmentError(f"clock_deg: {arg(clock_deg)} is not within ±360 degrees.")
    R_SP = turn_between(face.normal_P, _DOWN_S)
    warnings = list(_face_warnings(face))
    direction = _direction(face, toward_P)
    if direction is None:
        free = message(
            "No clocking direction was given, so the mesh is turned about the axis as little as"
            " possible. Pick a point or an edge to fix it."
        )
        warnings.append(free)
    else:
        x, y, _ = R_SP @ direction
        turn = np.radians(clock_deg) - np.arctan2(y, x)
        R_SP = scipy.spatial.transform.Rotation.from_rotvec([0.0, 0.0, turn]).as_matrix() @ R_SP
    p_SP_S = np.array([0.0, 0.0, offset]) - R_SP @ face.centre_P
    centre = message("the centre of the area inside its rim")
    if face.round:
        centre = message(
            f"the centre of its rim, a circle of {arg(2e3 * face.rim.radius):.2f} mm diameter to"
            f" {arg(_fine(face.rim.radius_rms))} mm rms"
        )
    how = message(
        f"The mounting face ({arg(int(face.facets.sum()))} facets, {arg(1e6 * face.area_m2):.0f} mm², plane to"
        f" {arg(_fine(face.planarity_rms))} mm rms, {arg(_fine(face.planarity_max))} at most) laid on z ="
        f" {arg(1e3 * offset):g} mm;"
        f" {arg(centre)}, on the axis."
    )
    T_SP, planarity = make_transform(R_SP, p_SP_S), face.planarity_rms
    return Alignment(T_SP, AlignmentMethod.FLANGE, (how,), tuple(warnings), residual_m=planarity)


def _fine(length: float) -> str:
    """Return a small length in mm."""
    return f"{1e3 * length:.2g}" if length >= 1e-6 else "under 0.001"


def _plane(probe: Probe, facets: Mask, normal: Floats, *, robust: bool) -> tuple[Floats, Floats]:
    """Fit a plane to a patch: a point of it (3,) and its normal (3,) on the side of `normal`."""
    corners = probe.vertices[probe.faces[facets]]
    weight = probe.areas[facets]
    for _ in range(_REWEIGHTED if robust else 1):
        middle = np.average(corners.mean(axis=1), axis=0, weights=weight)
        # Each facet's corners count alike, by its area: wide facets outweigh slivers.
        spread = np.einsum("f,fci,fcj->ij", weight, corners - middle, corners - middle)
        plane = np.linalg.eigh(spread)[1][:, 0]
        rise = np.abs((corners - middle) @ plane).max(axis=1)
        weight = probe.areas[facets] / np.maximum(rise, _FINE_M)
    return middle, plane if plane @ normal > 0 else -plane


def _measure(probe: Probe, facets: Mask, normal: Floats) -> MountingFace:
    middle, plane = _plane(probe, facets, normal, robust=False)
    used = np.unique(probe.faces[facets])
    distance = np.abs((probe.vertices[used] - middle) @ plane)
    rim = find_rim(probe.vertices, probe.faces[facets], middle, plane)
    centre = rim.circle_centre if rim.round else rim.area_centre
    return MountingFace(
        facets=facets,
        normal_P=plane,
        centre_P=centre,
        area_m2=float(probe.areas[facets].sum()),
        planarity_rms=float(np.sqrt((distance**2).mean())),
        planarity_max=float(distance.max()),
        rim=rim,
    )


def _neighbours(faces: Ints) -> Longs:
    """Return pairs (k, 2) of facets that share an edge."""
    edges = np.sort(faces[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1).astype(np.int64)
    keys = edges[:, 0] * (int(faces.max()) + 1) + edges[:, 1]
    order = np.argsort(keys, kind="stable")
    same = keys[order][1:] == keys[order][:-1]
    owner = order // 3
    return np.column_stack([owner[:-1][same], owner[1:][same]])


def _connected(pairs: Longs, among: Mask, facet: int) -> Mask:
    inside = pairs[among[pairs].all(axis=1)]
    labels = connected(len(among), *inside.T)
    return np.asarray(among & (labels == labels[facet]))


def _direction(face: MountingFace, toward: ArrayLike | None) -> Floats | None:
    """Return the clocking direction in P, or None without one."""
    if toward is None:
        return None
    given = check_numbers(toward, (3,), "toward_P") - face.centre_P
    flat: Floats = given - (given @ face.normal_P) * face.normal_P
    if np.linalg.norm(flat) <= _NO_DIRECTION * max(float(np.linalg.norm(given)), 1e-6):
        raise AlignmentError(
            "toward_P points along the axis, so it does not fix the turn about it: pick a point to the side."
        )
    return flat


def _face_warnings(face: MountingFace) -> Iterator[str]:
    if face.planarity_max > _UNEVEN_M:
        yield message(
            f"The face is {arg(1e3 * face.planarity_max):.2g} mm off a plane: a curved or noisy face is"
            " a poor datum. Pick another facet, or lower the angle."
        )
    if np.sqrt(face.area_m2) < _SMALL_M:
        yield message(
            f"The face has only {arg(1e6 * face.area_m2):.2g} mm², so a turn hardly shows. Check that"
            " the right facet was picked."
        )
    if not face.round:
        yield message(
            "The rim is not round, so the axis goes through the middle of the area inside it;"
            " screw holes and notches in the rim shift that. Check it against the drawing."
        )
