"""How deep a probe must be pressed into tissue to be pressed with a wanted force."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from scipy.optimize import brentq
from scipy.spatial.transform import Rotation

from contactbench.pipeline.contact.footprint import FACE_DEPTH_M, spread
from contactbench.pipeline.errors import InputError, arg
from contactbench.pipeline.simulation.scenes.tissue import BALL_M, PLACES, Tissue

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from contactbench.pipeline.simulation.scenes.motion import Motion
    from contactbench.pipeline.simulation.scenes.physics import TrueSurface

_OVER_S, _TIMES = 60.0, 600


def depth_for(
    truth: TrueSurface,
    force: float,
    *,
    motion: Motion | None = None,
    tissue: Tissue | None = None,
    places: int = PLACES,
) -> float:
    """
    Return the depth at which tissue pushes with a force: give it to `hand_motion`.

    Parameters
    ----------
    truth : TrueSurface
    force : float
        Normal to the tissue, N; in the mean over a minute of the motion. A scene gives this within 5 %: friction comes
        on top, and the moved side yields a little.
    motion : Motion, optional
        Whose own depth does not count; held still when left out.
    tissue : Tissue, optional
    places : int
        As for `PressScene`.

    Returns
    -------
    float
        m.

    Raises
    ------
    InputError
        The phantom is curved; the force is not positive, or more than the tissue gives at 12 mm, where a probe's
        sides would touch.

    Examples
    --------
    >>> motion = hand_motion(3, depth=depth_for(truth, 7.0, motion=hand_motion(3)))  # doctest: +SKIP
    """
    if not (np.isfinite(force) and force > 0):
        raise InputError(f"depth for {arg(force)} N: give a positive force.")
    tissue = tissue or Tissue()
    if tissue.cylinder is not None:
        raise InputError("depth: only for a flat phantom: leave out its cylinder.")
    where, normals, area = spread(truth.probe, places)
    centres = where - BALL_M * normals - [0.0, 0.0, float(truth.probe.vertices[:, 2].max())]
    above, upright = _gaps(centres, motion)

    def missing(depth: float) -> float:
        depths = np.maximum(0.0, above + upright * depth)
        return float(tissue.modulus * area * depths.sum(axis=1).mean()) - force

    most = missing(FACE_DEPTH_M) + force
    if most <= force:
        raise InputError(
            f"depth for {arg(force):g} N: at {arg(1e3 * FACE_DEPTH_M):g} mm this tissue already pushes with"
            f" {arg(most):.1f} N: choose a smaller force, or a stiffer tissue."
        )
    if missing(0.0) >= 0:
        raise InputError(
            f"depth for {arg(force):g} N: the motion alone presses harder: reduce its heave or turn."
        )
    return float(brentq(missing, 0.0, FACE_DEPTH_M, xtol=1e-9))


def _gaps(
    centres: NDArray[np.float64], motion: Motion | None
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return how deep each place is with a depth of 0, (times, places), and what the depth adds to it, (times, 1)."""
    poses = np.zeros((1, 6))
    if motion is not None:
        poses = np.array([motion.at(time) - motion.offset for time in np.linspace(0, _OVER_S, _TIMES)])
        poses[:, 3:] += motion.offset[3:]
        poses[:, :2] += motion.offset[:2]
    up = Rotation.from_euler("XYZ", poses[:, 3:]).as_matrix()[:, :, 2]
    reach = up @ centres.T - np.einsum("nd,nd->n", up, poses[:, :3])[:, None]
    return reach + BALL_M, up[:, 2:]
