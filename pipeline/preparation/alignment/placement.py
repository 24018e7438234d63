"""An alignment from typed numbers: a translation in millimetres and a rotation by angles or a matrix."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from scipy.spatial.transform import Rotation

from contactbench.pipeline.errors import arg, message
from contactbench.pipeline.preparation.alignment.alignment import Alignment, AlignmentMethod
from contactbench.pipeline.preparation.alignment.errors import AlignmentError
from contactbench.pipeline.preparation.alignment.rigid import (
    check_numbers,
    check_transform,
    make_transform,
)

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    Floats = NDArray[np.float64]

_LARGEST_ANGLE = 360.0
# An eighth of a turn in radians: angles that are whole multiples of it are suspicious as degrees.
_EIGHTH, _TYPED = np.pi / 4, 2e-3


def from_angles(xyz_mm: ArrayLike, rxyz_deg: ArrayLike) -> Alignment:
    """
    Align by rotations about the fixed axes x, then y, then z of S: ``R_SP = Rz Ry Rx``.

    Parameters
    ----------
    xyz_mm : (3,) array_like
        Origin of P in S, mm.
    rxyz_deg : (3,) array_like
        Angles about x, y and z, degrees, each within ±360.

    Raises
    ------
    AlignmentError
        A number is not finite, an angle is beyond a full turn, or the translation is 10 m or longer.
    """
    angles = check_numbers(rxyz_deg, (3,), "rotation")
    if np.abs(angles).max() > _LARGEST_ANGLE:
        raise AlignmentError(
            f"rotation: {arg(angles.tolist())} goes beyond ±360: give degrees about the fixed axes x, y, z."
        )
    R_SP = Rotation.from_euler("xyz", angles, degrees=True).as_matrix()  # lower case: fixed axes
    x, y, z = angles
    warnings: tuple[str, ...] = ()
    turned = np.abs(angles[angles != 0])
    eighths = _EIGHTH * np.clip(np.round(turned / _EIGHTH), 1, 8)
    if len(turned) and (np.abs(turned - eighths) < _TYPED).all():
        sentence = message("The angles look like radians. If they are, convert them to degrees.")
        warnings = (sentence,)
    how = message(f"turned by {arg(x):g}°, {arg(y):g}° and {arg(z):g}° about the fixed axes x, y and z")
    return _typed(R_SP, xyz_mm, how, warnings)


def from_transform(T_SP: ArrayLike) -> Alignment:
    """
    Align by a whole transform (4, 4), its translation in metres.

    Raises
    ------
    AlignmentError
        Not rigid within 1e-6, mirroring, transposed, not finite, or 10 m away or further.
    """
    T = check_transform(T_SP)
    return _typed(T[:3, :3], 1e3 * T[:3, 3], message("turned by the matrix given"))


def _typed(R_SP: Floats, xyz_mm: ArrayLike, how: str, warnings: tuple[str, ...] = ()) -> Alignment:
    p = check_numbers(xyz_mm, (3,), "translation")
    x, y, z = p
    sentence = message(
        f"Typed: the mesh's origin at ({arg(x):g}, {arg(y):g}, {arg(z):g}) mm in the sensor frame, the mesh {arg(how)}."
    )
    return Alignment(make_transform(R_SP, p / 1e3), AlignmentMethod.TYPED, (sentence,), warnings)
