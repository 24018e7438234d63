"""Alignments from points that are known on the mesh and in the sensor frame."""

from collections.abc import Iterator
from itertools import permutations
from pathlib import Path
from typing import BinaryIO

import numpy as np
import scipy
from numpy.typing import ArrayLike

from contactbench.pipeline.errors import arg, message
from contactbench.pipeline.mesh.arrays import Floats
from contactbench.pipeline.preparation.alignment.alignment import (
    Alignment,
    AlignmentError,
    AlignmentMethod,
    apply,
    check_numbers,
    make_transform,
)
from contactbench.pipeline.tables import TableError, TableReader, Wording, read_table

# The points must spread across their line by this share of along it, and by so many times their accuracy.
_THIN, _CLEAR = 0.05, 5.0
# Distances in S and P that differ by more than this factor are in two units.
_SCALED = 1.2
_DOUBT, _LIKELY = 1e-3, 0.05
_EXACT = 1e-12  # m
# Other orders are tried of so many points; of more, a symmetric set is made on purpose.
_FEW = 6


def align_points(points_P: ArrayLike, points_S: ArrayLike, *, accuracy: float = 0.0002) -> Alignment:
    """
    Align three or more points of the mesh with their places in the sensor frame, by least squares.

    Kabsch's solution: the rotation comes from the singular value decomposition of the cross-covariance, without
    scale and without reflection.

    Parameters
    ----------
    points_P, points_S : (n, 3) array_like
        The same points in the same order, m.
    accuracy : float
        Standard deviation of a pair's disagreement along each axis, m.

    Returns
    -------
    Alignment
        With its covariance about the points' centroid, and the root mean square of the distances left.

    Raises
    ------
    AlignmentError
        Fewer than three points, unequal numbers, points on (nearly) one line, distances in S and P that differ by
        more than a factor of 1.2, or points that fit only mirrored.
    """
    a, b = check_numbers(points_P, (-1, 3), "points_P"), check_numbers(points_S, (-1, 3), "points_S")
    if not 0 < accuracy < 1:
        raise AlignmentError(
            f"accuracy: {arg(accuracy)} m is not above 0 and under 1: give one standard deviation."
        )
    if len(a) != len(b) or len(a) < 3:
        raise AlignmentError(
            f"{arg(len(a))} points in the mesh and {arg(len(b))} in the sensor frame: give three or more, one for one."
        )
    a0, b0 = a.mean(axis=0), b.mean(axis=0)
    _refuse_line(a - a0, accuracy)
    _refuse_scale(a - a0, b - b0)
    T_SP = _fit(a, b)
    left = _left(T_SP, a, b)
    rms = _rms(left)
    warnings = (*_mirrored(a, b, left, accuracy), *_warnings(a, b, left, accuracy))
    how = message(
        f"{arg(len(a))} points of the mesh fitted to their positions in the sensor frame by least"
        f" squares; residual {arg(1e3 * rms):.2g} mm rms."
    )
    covariance = _covariance(b - b0, accuracy) * max(1.0, _scatter(left, accuracy))
    return Alignment(T_SP, AlignmentMethod.POINTS, (how,), warnings, covariance, b0, rms)


def align_frame(
    origin_P: ArrayLike,
    axis_P: ArrayLike,
    plane_P: ArrayLike,
    *,
    origin_S: ArrayLike = (0.0, 0.0, 0.0),
    accuracy: float = 0.0002,
) -> Alignment:
    """
    Align by three points that span a frame: nothing is left over, so nothing is checked.

    Parameters
    ----------
    origin_P : (3,) array_like
        The point that lies at `origin_S`, m.
    axis_P : (3,) array_like
        A point on the line through it along +z of S, m.
    plane_P : (3,) array_like
        A point of the half plane towards +x of S, m.
    origin_S : (3,) array_like
        Where the origin lies in S, m.
    accuracy : float
        Standard deviation of each point along each axis, m.

    Returns
    -------
    Alignment
        With its covariance about the origin.

    Raises
    ------
    AlignmentError
        The points are (nearly) on one line.
    """
    o, z, x = (
        check_numbers(values, (3,), name)
        for values, name in ((origin_P, "origin_P"), (axis_P, "axis_P"), (plane_P, "plane_P"))
    )
    origin = check_numbers(origin_S, (3,), "origin_S")
    if not 0 < accuracy < 1:
        raise AlignmentError(
            f"accuracy: {arg(accuracy)} m is not above 0 and under 1: give one standard deviation."
        )
    points = np.array([o, z, x])
    _refuse_line(points - points.mean(axis=0), accuracy)
    along = np.linalg.norm(z - o)
    if along < _CLEAR * accuracy:
        raise AlignmentError("axis_P coincides with origin_P: pick it farther along the axis.")
    ez = (z - o) / along
    side = (x - o) - ((x - o) @ ez) * ez
    beside = np.linalg.norm(side)
    if beside < max(_CLEAR * accuracy, _THIN * float(np.linalg.norm(x - o))):
        raise AlignmentError("plane_P lies on the axis: pick it to the side, towards +x of S.")
    ex = side / beside
    R_SP = np.array([ex, np.cross(ez, ex), ez])
    # The axis point turns about x and y, the plane point about z; the origin moves both ends of each lever.
    level = float((x - o) @ ez)
    J = np.zeros((6, 9))
    J[:3, :3] = np.eye(3)
    J[3, [1, 4]] = np.array([1, -1]) / along
    J[4, [0, 3]] = np.array([-1, 1]) / along
    J[5, 7], J[5, 1] = 1 / beside, -1 / beside
    J[5, [1, 4]] += np.array([1, -1]) * level / (along * beside)
    how = message(
        "The mesh's origin point was placed on its position, its axis point on +z, its plane point"
        " towards +x."
    )
    warnings = (message("Three points define a frame exactly, so a wrong pick does not show."),)
    covariance = accuracy**2 * J @ J.T
    T_SP = make_transform(R_SP, origin - R_SP @ o)
    return Alignment(T_SP, AlignmentMethod.FRAME, (how,), warnings, covariance, origin)


def _fit(a: Floats, b: Floats) -> Floats:
    """Return the rigid transform (4, 4) that takes points a nearest to points b."""
    a0, b0 = a.mean(axis=0), b.mean(axis=0)
    u, _, vt = np.linalg.svd((b - b0).T @ (a - a0))
    proper = float(np.sign(np.linalg.det(u) * np.linalg.det(vt)))
    R = u @ np.diag([1.0, 1.0, proper]) @ vt
    return make_transform(R, b0 - R @ a0)


def _left(T: Floats, a: Floats, b: Floats) -> Floats:
    """Return the distances (n,) that a transform leaves, m."""
    return np.asarray(np.linalg.norm(b - apply(T, a), axis=1))


def _refuse_line(centred: Floats, accuracy: float) -> None:
    spread = np.linalg.svd(centred, compute_uv=False) / np.sqrt(len(centred))
    if spread[0] < _CLEAR * accuracy:
        raise AlignmentError("The points are all in one place: pick points far apart.")
    if spread[1] < max(_THIN * spread[0], _CLEAR * accuracy):
        raise AlignmentError(
            f"The points lie nearly on one line ({arg(1e3 * spread[1]):.2g} mm off it,"
            f" {arg(1e3 * spread[0]):.2g} mm along it, rms), so a turn about it is not determined: pick"
            " one well to the side."
        )


def _refuse_scale(a: Floats, b: Floats) -> None:
    scale = float(np.sqrt((b**2).sum() / (a**2).sum()))
    if not 1 / _SCALED < scale < _SCALED:
        raise AlignmentError(
            f"Distances between the points in the sensor frame are {arg(scale):.4g} times those in the mesh:"
            " give both in the same unit, and the points in the same order."
        )


def _scatter(left: Floats, accuracy: float) -> float:
    """Return by how much residuals widen the covariance: 1 unless chance cannot explain them."""
    freedom = 3 * len(left) - 6
    square = float((left**2).sum()) / accuracy**2
    return square / freedom if scipy.special.chdtrc(freedom, square) < _DOUBT else 1.0


def _warnings(a: Floats, b: Floats, left: Floats, accuracy: float) -> Iterator[str]:
    agree = _scatter(left, accuracy) == 1
    if not agree:
        yield message(
            f"The points disagree by up to {arg(1e3 * left.max()):.2g} mm, more than an accuracy of"
            f" {arg(1e3 * accuracy):g} mm explains. The uncertainty has been widened accordingly."
        )
    if len(a) == 3:
        yield message(
            "Three points check one another only by their distances: a fourth, off their plane, would reveal a"
            " wrong one or a mirrored frame."
        )
    elif np.linalg.svd(a - a.mean(axis=0), compute_uv=False)[2] < _CLEAR * accuracy * np.sqrt(len(a)):
        yield message(
            "The points lie in one plane, so a mirrored frame would not show: add a point well off it."
        )
    yield from _other_order(a, b, accuracy)
    if agree or len(a) == 3:
        return
    # The point without which the others agree best: the largest distance left may be another's.
    others = [np.delete(np.arange(len(a)), row) for row in range(len(a))]
    without = [_rms(_left(_fit(a[o], b[o]), a[o], b[o])) for o in others]
    worst = int(np.argmin(without))
    yield message(
        f"Without point {arg(worst + 1)} the others agree within {arg(1e3 * without[worst]):.2g} mm rms:"
        " check its position."
    )


def _mirrored(a: Floats, b: Floats, left: Floats, accuracy: float) -> Iterator[str]:
    """Say that points fit better mirrored; AlignmentError where chance cannot explain by how much."""
    if _scatter(left, accuracy) == 1:
        return
    flipped = a * [1.0, 1.0, -1.0]
    other = _left(_fit(flipped, b), flipped, b)
    mirrored, rms, freedom = _rms(other), _rms(left), 3 * len(a) - 6
    # Of two residuals of the same noise, whatever its size.
    chance = scipy.special.fdtrc(freedom, freedom, (rms / max(mirrored, _EXACT)) ** 2)
    if chance < _DOUBT or (_scatter(other, accuracy) == 1 and chance < _LIKELY):
        raise AlignmentError(
            f"The points fit only mirrored (within {arg(1e3 * mirrored):.2g} mm rms, else {arg(1e3 * rms):.2g} mm):"
            " one of the frames is left-handed, or two points are swapped. Check the signs of the axes and the order."
        )
    if chance < _LIKELY:
        yield message(
            f"The points fit better mirrored (within {arg(1e3 * mirrored):.2g} mm rms, else {arg(1e3 * rms):.2g} mm):"
            " check the signs of the axes and the order of the points."
        )


def _other_order(a: Floats, b: Floats, accuracy: float) -> Iterator[str]:
    """Say in which other order the points fit as well, and how the mesh would then lie."""
    if len(a) > _FEW:
        return
    T = _fit(a, b)
    orders, found = np.array(list(permutations(range(len(a))))), []
    apart_P, apart_S = (np.linalg.norm(each[:, None] - each, axis=2) for each in (a, b))
    alike = np.abs(apart_P[orders[:, :, None], orders[:, None, :]] - apart_S).max(axis=(1, 2))
    for order in orders[alike < 4 * _CLEAR * accuracy]:  # which few are, before any is fitted
        other = _fit(a[order], b)
        turn = float(np.degrees(np.arccos(np.clip((np.trace(other[:3, :3] @ T[:3, :3].T) - 1) / 2, -1, 1))))
        if turn > 5 and _rms(_left(other, a[order], b)) < _CLEAR * accuracy:
            found.append((turn, order.tolist()))
    if found:
        turn, order = max(found)
        yield message(
            f"The points are symmetric: in the order {arg(', '.join(str(each + 1) for each in order))} they fit as"
            f" well, with the mesh turned by {arg(turn):.0f}°, so a mix-up would not show. Add a point that breaks the"
            " symmetry."
        )


def _rms(left: Floats) -> float:
    return float(np.sqrt((left**2).mean()))


def _covariance(b: Floats, accuracy: float) -> Floats:
    """Return the covariance (6, 6) of shift and rotation about the centroid."""
    C = np.zeros((6, 6))
    C[:3, :3] = np.eye(3) / len(b)
    C[3:, 3:] = np.linalg.inv((b**2).sum() * np.eye(3) - b.T @ b)
    covariance: Floats = accuracy**2 * C
    return covariance


# ---- matching points from CSV --------------------------------------------------------------------


COLUMNS = ("px", "py", "pz", "sx", "sy", "sz")
_MOST = 10_000


class PointFileError(TableError, AlignmentError):
    """A file of points that cannot be used: names the file, the line, and the remedy."""


_WORDING = Wording(
    header=",".join(COLUMNS),
    rows="points",
    meaning=message("a point in the mesh's frame and the same point in the sensor frame S, mm"),
    not_finite=message("remove the row, or measure the point again."),
    error=PointFileError,
)


def read_points(source: Path | BinaryIO) -> tuple[Floats, Floats]:
    """
    Read matching points.

    Parameters
    ----------
    source : path or binary file
        CSV with the columns px,py,pz (mm, in P) and sx,sy,sz (mm, in S), in any order; others are ignored.

    Returns
    -------
    points_P, points_S : (n, 3) float64
        Metres.

    Raises
    ------
    PointFileError
        The file is missing, too long, not a table, or holds numbers that are not finite.
    """

    def select(reader: TableReader) -> None:
        reader.select(COLUMNS)

    rows = read_table(source, select, _WORDING, row_limit=_MOST)
    return rows.numbers[:, :3] / 1e3, rows.numbers[:, 3:6] / 1e3
