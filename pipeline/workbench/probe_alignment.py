"""The ways to say where the mesh lies, as a window offers them: places on what is shown, and numbers in mm."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from scipy.spatial.transform import Rotation

from contactbench.pipeline.errors import InputError, arg
from contactbench.pipeline.preparation.alignment import (
    align_axes,
    align_flange,
    align_points,
    align_touches,
    find_mounting_face,
    from_json,
    read_touches,
)

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence
    from pathlib import Path

    from numpy.typing import ArrayLike, NDArray

    from contactbench.pipeline.mesh import Probe
    from contactbench.pipeline.preparation.alignment import Alignment

FEWEST_PAIRS = 3
_LARGEST_FILE = 2**20


def back_to_mesh(points_S: ArrayLike, alignment: Alignment | None) -> NDArray[np.float64]:
    """Return places on what is shown (n, 3) or (3,), m, in the mesh's own frame P."""
    points = np.asarray(points_S, dtype=np.float64)
    if alignment is None:
        return points
    moved: NDArray[np.float64] = (points - alignment.p_SP_S) @ alignment.R_SP
    return moved


def by_points(pairs: Sequence[tuple[NDArray[np.float64], NDArray[np.float64]]]) -> Alignment:
    """
    Align by places picked on the mesh; as ``contactbench probe align --points``.

    Parameters
    ----------
    pairs : sequence of ((3,), (3,))
        A place in the mesh's frame, and where it lies in the sensor frame, m.
    """
    if len(pairs) < FEWEST_PAIRS:
        raise InputError(
            f"{arg(len(pairs))} points are picked, but {arg(FEWEST_PAIRS)} are needed: pick another one, far"
            " from these."
        )
    return align_points([point_P for point_P, _ in pairs], [point_S for _, point_S in pairs])


def by_flange(
    probe_P: Probe, facet: int, toward_P: NDArray[np.float64] | None, clock_deg: float, offset_mm: float
) -> Alignment:
    """Align by the face that sits on the sensor; as ``contactbench probe align --flange-face``."""
    face = find_mounting_face(probe_P, facet)
    return align_flange(face, offset=offset_mm / 1e3, toward_P=toward_P, clock_deg=clock_deg)


def by_axes(probe_P: Probe, offset_mm: float) -> Alignment:
    """Align by the shape; as ``contactbench probe align --axes``."""
    return align_axes(probe_P, offset=offset_mm / 1e3).alignment


def by_touches(
    probe_P: Probe,
    file: Path,
    mount: Alignment | None,
    progress: Callable[[float], None] | None = None,
) -> tuple[Alignment, tuple[str, ...]]:
    """
    Align by touches of marked points; as ``contactbench probe align --touches``.

    Parameters
    ----------
    probe_P : Probe
    file : path
        CSV; see `read_touches`.
    mount : Alignment or None
        Where the mesh lies by now; None: any of the four places that its shape suggests.
    progress : callable, optional

    Returns
    -------
    Alignment
    tuple of str
        Why to take it, or rather not.
    """
    starts = align_axes(probe_P).alternatives if mount is None else mount.T_SP
    found = align_touches(probe_P, read_touches(file), starts, progress=progress)
    return found.fitted, tuple(found.reasons)


def by_file(file: Path) -> Alignment:
    """Read an alignment that was saved; as ``contactbench probe align --alignment``."""
    try:
        with file.open("rb") as stream:
            data = stream.read(_LARGEST_FILE + 1)
    except OSError as error:
        raise InputError(f"{arg(file)}: it cannot be read ({arg(error)}): check the path.") from error
    return from_json(data, file.name)


def numbers_of(alignment: Alignment | None) -> tuple[float, ...]:
    """Return x, y, z in mm and the angles about the fixed axes x, y, z in degrees; zeros for none."""
    if alignment is None:
        return (0.0,) * 6
    angles = Rotation.from_matrix(alignment.R_SP).as_euler("xyz", degrees=True)
    return (*(float(v) for v in 1e3 * alignment.p_SP_S), *(float(v) for v in angles))
