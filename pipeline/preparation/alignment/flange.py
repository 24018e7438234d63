"""An alignment from the mesh's mounting face, the plane that is screwed to the sensor, or from its principal axes."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
import scipy
from numpy.typing import ArrayLike

from contactbench.pipeline.errors import arg, message
from contactbench.pipeline.kernel import SurfaceIndex
from contactbench.pipeline.mesh import Probe
from contactbench.pipeline.mesh.arrays import Floats, Ints, Longs, Mask
from contactbench.pipeline.mesh.probe import connected
from contactbench.pipeline.preparation.alignment.alignment import (
    Alignment,
    AlignmentError,
    AlignmentMethod,
    across,
    apply,
    check_numbers,
    make_transform,
    turn_between,
)

# Spreads that differ by less than this share of the larger cannot be told apart on a real part.
_EQUAL = 0.05
# The origin is in the middle if both ends are equally far from it to this share of the length.
_MIDDLE = 0.05
# A turned surface that lies this near to itself, as a share of the size, is symmetric.
_SAME = 0.005
# The four proper rotations that keep the axes: signs of x, y, z.
_SIGNS = ((1.0, 1.0, 1.0), (-1.0, -1.0, 1.0), (1.0, -1.0, -1.0), (-1.0, 1.0, -1.0))
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


@dataclass(frozen=True, eq=False)
class AxesAlignment:
    """What the shape says of the mount."""

    alignment: Alignment  # by the rules; its `how` tells them
    # (4, 4, 4) T_SP of the four proper rotations that put the same axes on x, y, z; the chosen one
    # first. Each has the flange end at the same place.
    alternatives: Floats


def align_axes(probe_P: Probe, *, tip_P: ArrayLike | None = None, offset: float = 0.0) -> AxesAlignment:
    """
    Align by the principal axes: longest along z, middle along x, shortest along y.

    The handle points along -z. Which end is the tip: the one nearer to `tip_P`; without it, the one further
    from the mesh's origin. The sign of x: that with x of S towards +x of P, or towards +y or +z where x of P is
    across. The lowest point lies at ``z = offset``, the centroid on the z axis.

    Parameters
    ----------
    probe_P : Probe
        In P. An open mesh has no volume to weigh: its area is taken, with a warning.
    tip_P : (3,) array_like, optional
        A point picked near the tip, m.
    offset : float
        Where the flange end lies along z of S, m.

    Raises
    ------
    AlignmentError
        A tip or offset that is not finite.
    """
    closed, warnings = probe_P.health.watertight and probe_P.health.outward, []
    if not closed:
        warnings.append(
            message("The mesh is open or badly wound and has no volume, so its area was used instead.")
        )
    centroid, moment = _volume_moments(probe_P) if closed else _area_moments(probe_P)
    values, vectors = np.linalg.eigh(moment)
    spreads = np.sqrt(np.maximum(values, 0.0))[[1, 0, 2]]
    R = vectors[:, [1, 0, 2]].T  # rows: x, y, z of S in P
    R[2] *= _tip_sign(probe_P, R[2], centroid, tip_P, warnings)
    R[0] *= 1.0 if R[0, np.argmax(np.abs(R[0]) > 0.5)] > 0 else -1.0
    R[1] = np.cross(R[2], R[0])
    determined = _determined(spreads)
    warnings += _words(spreads, determined)
    chosen = [_transform(np.diag(signs) @ R, centroid, probe_P, offset) for signs in _SIGNS]
    warnings += _symmetries(probe_P, chosen, determined)
    tip = message("further from the mesh origin")
    if tip_P is not None:
        tip = message("nearer to the point picked")
    how = (
        message(
            f"Principal axes of the {arg('volume' if closed else 'area')}: the longest"
            f" (rms {arg(1e3 * spreads[2]):.1f} mm) along z, the middle ({arg(1e3 * spreads[0]):.1f}) along x, the"
            f" shortest ({arg(1e3 * spreads[1]):.1f})"
            f" along y; the lowest point at z = {arg(1e3 * offset):g} mm, the centroid on the axis."
        ),
        message(
            f"The tip is the end {arg(tip)}; x points towards +x of the mesh's frame, or +y or +z where that is"
            " across. Three other rotations have the same axes."
        ),
    )
    alignment = Alignment(chosen[0], AlignmentMethod.AXES, how, tuple(warnings))
    return AxesAlignment(alignment, np.stack(chosen))


def _volume_moments(probe: Probe) -> tuple[Floats, Floats]:
    """Return the centroid (3,) and the second moment (3, 3) per volume, m², by signed tetrahedra."""
    # From a point of the mesh: far from the origin the tetrahedra would cancel.
    base = probe.bounds.mean(axis=0)
    corners = probe.vertices[probe.faces] - base
    volume = np.einsum("fi,fi->f", corners[:, 0], np.cross(corners[:, 1], corners[:, 2])) / 6
    total = corners.sum(axis=1)
    centre = np.einsum("f,fi->i", volume, total) / (4 * volume.sum())
    second = np.einsum("f,fi,fj->ij", volume, total, total)
    second += np.einsum("f,fci,fcj->ij", volume, corners, corners)
    return base + centre, second / (20 * volume.sum()) - np.outer(centre, centre)


def _area_moments(probe: Probe) -> tuple[Floats, Floats]:
    base = probe.bounds.mean(axis=0)
    corners = probe.vertices[probe.faces] - base
    area = probe.areas
    total = corners.sum(axis=1)
    centre = np.einsum("f,fi->i", area, total) / (3 * area.sum())
    second = np.einsum("f,fi,fj->ij", area, total, total) + np.einsum("f,fci,fcj->ij", area, corners, corners)
    return base + centre, second / (12 * area.sum()) - np.outer(centre, centre)


def _tip_sign(
    probe: Probe, z_P: Floats, centroid: Floats, tip_P: ArrayLike | None, warnings: list[str]
) -> float:
    """Return 1 if z points to the tip, or -1."""
    if tip_P is not None:
        return 1.0 if (check_numbers(tip_P, (3,), "tip_P") - centroid) @ z_P >= 0 else -1.0
    heights = probe.vertices[np.unique(probe.faces)] @ z_P
    low, high = float(-heights.min()), float(heights.max())
    told = message(
        "The end farther from the mesh's origin was taken as the tip; many files have their origin at"
        " the lens."
    )
    if abs(high - low) < _MIDDLE * (high + low):
        told = message("The mesh's origin lies in its middle, so it cannot tell the tip from the handle.")
    warnings.append(message(f"{arg(told)} Pick a point on the tip to be sure."))
    return 1.0 if high >= low else -1.0


def _determined(spreads: Floats) -> Mask:
    pairs = ((1, 2), (0, 2), (0, 1))
    gaps = [abs(spreads[a] - spreads[b]) / max(spreads[a], spreads[b], 1e-12) for a, b in pairs]
    return np.array(gaps) >= _EQUAL


def _words(spreads: Floats, determined: Mask) -> Iterator[str]:
    for axis in np.flatnonzero(~determined):
        a, b = (other for other in range(3) if other != axis)
        yield message(
            f"The spreads along {arg('xyz'[a])} and {arg('xyz'[b])} are nearly equal"
            f" ({arg(1e3 * spreads[a]):.1f} and {arg(1e3 * spreads[b]):.1f} mm), so the turn about"
            f" {arg('xyz'[axis])} is not determined: fix it by a point or by touches."
        )


def _symmetries(probe: Probe, chosen: list[Floats], determined: Mask) -> Iterator[str]:
    """Say which half turns leave the surface where it was, about axes that are known."""
    surface = SurfaceIndex(np.ascontiguousarray(apply(chosen[0], probe.vertices)), probe.faces)
    some = probe.vertices[:: 1 + len(probe.vertices) // 20_000]
    for T, axis in zip(chosen[1:], (2, 0, 1), strict=True):
        distance, _, _ = surface.closest(np.ascontiguousarray(apply(T, some)))
        off = float(distance.max())
        if determined[axis] and off < _SAME * probe.size:
            yield message(
                f"Turned by 180° about {arg('xyz'[axis])}, the surface lies within {arg(1e3 * off):.2g} mm of itself,"
                " so its shape cannot tell the two apart: fix the turn by a point or by touches."
            )


def _transform(R_SP: Floats, centroid: Floats, probe: Probe, offset: float) -> Floats:
    heights = probe.vertices[np.unique(probe.faces)] @ R_SP[2]
    x, y, _ = R_SP @ centroid
    return make_transform(R_SP, np.array([-x, -y, offset - float(heights.min())]))
