"""Rigid transforms: checked at the door, moved by small steps, and applied."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from scipy.spatial.transform import Rotation

from contactbench.pipeline.errors import arg, message
from contactbench.pipeline.preparation.alignment.errors import AlignmentError

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    Floats = NDArray[np.float64]

_TOLERANCE, _ROUNDING = 1e-6, 1e-14
# Numbers beyond this overflow when squared, and are no rotation.
_ABSURD = 1e3
FARTHEST_M = 10.0


def check_transform(values: ArrayLike, name: str = "T_SP") -> Floats:
    """
    Copy a rigid transform to (4, 4) float64, or say why it is none.

    Parameters
    ----------
    values : (4, 4) array_like
        Rotation and translation in metres; the last row is 0 0 0 1.
    name : str
        What messages call it.

    Returns
    -------
    (4, 4) float64
        Read-only, its rotation made orthogonal to rounding.

    Raises
    ------
    AlignmentError
        Wrong shape, not finite, transposed, scaling, shearing, mirroring, or 10 m away or further.
    """
    T = check_numbers(values, (4, 4), name)
    if np.abs(T[3] - (0, 0, 0, 1)).max() > _TOLERANCE:
        transposed = message(" It looks transposed.") if np.abs(T[:3, 3]).max() == 0 else ""
        raise AlignmentError(
            f"{arg(name)}: the last row is {arg(T[3].tolist())}, not [0, 0, 0, 1].{arg(transposed)} Write"
            " the translation in the last column."
        )
    return make_transform(check_rotation(T[:3, :3], name), T[:3, 3], name)


def check_rotation(values: ArrayLike, name: str = "R_SP") -> Floats:
    """
    Copy a rotation matrix to (3, 3) float64, or say why it is none.

    Raises
    ------
    AlignmentError
        Wrong shape, not finite, scaling, shearing or mirroring.
    """
    R = check_numbers(values, (3, 3), name)
    off = np.inf if np.abs(R).max() > _ABSURD else float(np.abs(R.T @ R - np.eye(3)).max())
    if off > _TOLERANCE:
        raise AlignmentError(
            f"{arg(name)}: the 3 x 3 part is not a rotation within 1e-6: it scales or shears. Convert lengths when the"
            " mesh is read, and write rotations with at least seven digits."
        )
    if np.linalg.det(R) < 0:
        raise AlignmentError(
            f"{arg(name)}: the 3 x 3 part mirrors (determinant -1): one axis has the wrong sign, or the frame is"
            " left-handed."
        )
    # What is a rotation to rounding keeps its bits: a file that is read and written stays the same.
    return R if off <= _ROUNDING else nearest_rotation(R)


def make_transform(R_SP: ArrayLike, p_SP_S: ArrayLike, name: str = "T_SP") -> Floats:
    """
    Join a rotation and a translation in metres to (4, 4), read-only.

    Raises
    ------
    AlignmentError
        The translation is not finite, or 10 m long or longer.
    """
    p = check_numbers(p_SP_S, (3,), f"{name}, translation")
    if np.abs(p).max() >= FARTHEST_M or np.linalg.norm(p) >= FARTHEST_M:
        millimetres = ", ".join(f"{1e3 * value:.6g}" for value in p)
        raise AlignmentError(
            f"{arg(name)}: the translation ({arg(millimetres)}) mm is {arg(FARTHEST_M):g} m or longer, too long"
            " for a mount. Check its unit."
        )
    T = np.eye(4)
    T[:3, :3], T[:3, 3] = R_SP, p
    T.flags.writeable = False
    return T


def check_numbers(values: ArrayLike, shape: tuple[int, ...], name: str) -> Floats:
    """
    Copy numbers to a float64 array of a shape; -1 stands for any length of at least one.

    Raises
    ------
    AlignmentError
        Not numbers, another shape, or not finite.
    """
    try:
        array = np.array(values, dtype=np.float64)
    except (ValueError, TypeError) as error:
        raise AlignmentError(
            f"{arg(name)}: these are not numbers ({arg(error)}): give shape {arg(shape)}."
        ) from error
    fits = array.ndim == len(shape) and all(
        found == wanted or (wanted == -1 and found > 0)
        for found, wanted in zip(array.shape, shape, strict=True)
    )
    if not fits:
        wanted_shape = str(shape).replace("-1", "n")
        raise AlignmentError(
            f"{arg(name)}: the shape is {arg(array.shape)}: give {arg(wanted_shape)} numbers."
        )
    if not np.isfinite(array).all():
        row = np.argwhere(~np.isfinite(array))[0].tolist()
        raise AlignmentError(f"{arg(name)}: the value at {arg(row)} is not finite: correct or remove it.")
    return array


def nearest_rotation(matrix: Floats) -> Floats:
    """Return the rotation (3, 3) nearest to a matrix of positive determinant."""
    u, _, vt = np.linalg.svd(matrix)
    R: Floats = u @ vt
    return R


def apply(T: Floats, points: Floats) -> Floats:
    """Return points (n, 3) moved by T (4, 4)."""
    moved: Floats = points @ T[:3, :3].T + T[:3, 3]
    return moved


def step(T: Floats, about: Floats, delta: Floats) -> Floats:
    """
    Move a transform by a small rigid motion: ``p' = c + exp([w]x)(p - c) + d``.

    Parameters
    ----------
    T : (4, 4)
    about : (3,)
        The point c that the motion turns about, in T's target frame, m.
    delta : (..., 6)
        Shift d, m, then rotation vector w, rad, in the target frame; one step or several.

    Returns
    -------
    (..., 4, 4)
    """
    R = Rotation.from_rotvec(delta[..., 3:]).as_matrix()
    moved = np.zeros((*delta.shape[:-1], 4, 4))
    moved[..., :3, :3] = R @ T[:3, :3]
    moved[..., :3, 3] = about + R @ (T[:3, 3] - about) + delta[..., :3]
    moved[..., 3, 3] = 1.0
    return moved


def difference(T: Floats, T_from: Floats, about: Floats) -> Floats:
    """Return the (6,) motion with ``step(T_from, about, motion) == T``."""
    R = T[:3, :3] @ T_from[:3, :3].T
    shift = T[:3, 3] - about - R @ (T_from[:3, 3] - about)
    return np.concatenate([shift, Rotation.from_matrix(R).as_rotvec()])


def across(normals: Floats) -> Floats:
    """Return two unit tangents (n, 2, 3) for each unit normal (n, 3); right-handed with it."""
    helper = np.eye(3)[np.argmin(np.abs(normals), axis=1)]
    first = np.cross(helper, normals)
    first /= np.linalg.norm(first, axis=1, keepdims=True)
    return np.stack([first, np.cross(normals, first)], axis=1)


def turn_between(a: Floats, b: Floats) -> Floats:
    """Return the smallest rotation (3, 3) that takes unit vector a to unit vector b."""
    axis, cosine = np.cross(a, b), float(a @ b)
    sine = float(np.linalg.norm(axis))
    if sine < 1e-12:
        if cosine > 0:
            return np.eye(3)
        return np.asarray(Rotation.from_rotvec(np.pi * across(a[None])[0, 0]).as_matrix())
    return np.asarray(Rotation.from_rotvec(axis * (np.arctan2(sine, cosine) / sine)).as_matrix())
