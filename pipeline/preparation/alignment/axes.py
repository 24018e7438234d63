"""An alignment from the shape alone: principal axes, with the signs by stated rules and the others listed."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from contactbench.pipeline.errors import arg, message
from contactbench.pipeline.kernel import SurfaceIndex
from contactbench.pipeline.mesh import Probe
from contactbench.pipeline.mesh.arrays import Floats, Mask
from contactbench.pipeline.preparation.alignment.alignment import (
    Alignment,
    AlignmentMethod,
    apply,
    check_numbers,
    make_transform,
)

# Spreads that differ by less than this share of the larger cannot be told apart on a real part.
_EQUAL = 0.05
# The origin is in the middle if both ends are equally far from it to this share of the length.
_MIDDLE = 0.05
# A turned surface that lies this near to itself, as a share of the size, is symmetric.
_SAME = 0.005
# The four proper rotations that keep the axes: signs of x, y, z.
_SIGNS = ((1.0, 1.0, 1.0), (-1.0, -1.0, 1.0), (1.0, -1.0, -1.0), (-1.0, 1.0, -1.0))


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
