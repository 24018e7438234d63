"""What a calibration's uncertainty does to the contact point: the figure by which poses are chosen."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cache, cached_property
from typing import TYPE_CHECKING

import numpy as np
from scipy.spatial.transform import Rotation

from contactbench.pipeline.calibration.model import DOWN_W, cross_matrix, prediction_jacobian, upright
from contactbench.pipeline.errors import InputError, arg

if TYPE_CHECKING:
    from numpy.typing import NDArray

_RINGS = 2  # of tilts beside upright
_ROUND = 6  # tilts on a ring
_SIDES = 4  # directions in which friction may pull


def _default_point() -> NDArray[np.float64]:
    return np.array([0.0, 0.0, 0.1])


def _default_normal() -> NDArray[np.float64]:
    return np.array([0.0, 0.0, 1.0])


@dataclass(frozen=True, eq=False)
class ContactTask:
    """The touches whose error a calibration is judged by.

    The probe points down or is tilted from that by up to `tilt`; the tissue pushes at `point`, along the
    normal or up to `friction` beside it.

    Parameters
    ----------
    point : (3,)
        Where the probe is touched, S, m. Default: 100 mm along the sensor's z axis.
    normal : (3,)
        Outward normal there, S. Default: z.
    force : float
        Of the touch, N.
    tilt : float
        Largest angle between the normal and straight down, rad.
    friction : float
        Angle between the force and the normal at the sides, rad.
    down_W : (3,)
        Where gravity points in W: the probe points there.

    Raises
    ------
    InputError
        A value is not finite or outside its range.
    """

    point: NDArray[np.float64] = field(default_factory=_default_point)
    normal: NDArray[np.float64] = field(default_factory=_default_normal)
    force: float = 10.0
    tilt: float = np.radians(60.0)
    friction: float = np.radians(30.0)
    down_W: NDArray[np.float64] = field(default_factory=lambda: np.array(DOWN_W))

    def __post_init__(self) -> None:
        point, normal = (np.array(value, dtype=np.float64) for value in (self.point, self.normal))
        if point.shape != (3,) or not np.isfinite(point).all():
            raise InputError(f"ContactTask.point: give three finite numbers, m in S, not {arg(self.point)!r}")
        length = float(np.linalg.norm(normal)) if normal.shape == (3,) else np.nan
        if not np.isfinite(length) or length == 0:
            raise InputError(
                f"ContactTask.normal: give three numbers that are not all 0, not {arg(self.normal)!r}"
            )
        ranges = (("force", self.force, 1e4), ("tilt", self.tilt, np.pi), ("friction", self.friction, 1.4))
        for name, value, most in ranges:
            if not 0 <= value <= most or (name == "force" and value == 0):
                raise InputError(
                    f"ContactTask.{arg(name)}: {arg(value)} is not between 0 and {arg(most):.4g}"
                )
        object.__setattr__(self, "point", point)
        object.__setattr__(self, "normal", normal / length)

    @cached_property
    def orientations(self) -> NDArray[np.float64]:
        """(k, 3, 3) R_SW in which the probe is used: pointing down, and tilted in all directions."""
        orientations: NDArray[np.float64] = _cone(self.normal, self.tilt) @ upright(self.down_W)
        return orientations

    @cached_property
    def forces(self) -> NDArray[np.float64]:
        """(m, 3) forces on the probe, S, N: along the normal, and at the friction angle to all sides."""
        angles = np.concatenate([[0.0], np.full(_SIDES, self.friction)])
        return self.force * force_directions(self.normal, angles, np.arange(-1, _SIDES) * 2 * np.pi / _SIDES)

    @cached_property
    def _sensitivities(self) -> NDArray[np.float64]:
        """(m, 2, 6) shift of the contact point in the surface with the wrench, m/N and m/(N·m), by force."""
        in_surface: NDArray[np.float64] = np.array(_across(self.normal))
        return in_surface @ contact_sensitivity(self.point, self.normal, self.forces)

    def parameter_sensitivity(self, theta: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return how the contact point moves in the surface with the calibration's parameters (k m, 2, 12)."""
        J = prediction_jacobian(self.orientations, theta)  # the sign of a change does not matter here
        return (self._sensitivities.reshape(-1, 6) @ J).reshape(-1, 2, 12)

    def calibration_error(self, theta: NDArray[np.float64], covariance: NDArray[np.float64]) -> float:
        """Return the calibration's share of the contact error: the worst 1 sigma over all touches, m.

        Parameters
        ----------
        theta : (12,)
        covariance : (12, 12)
            Of the parameters.
        """
        return worst_sigma(self.parameter_sensitivity(theta), covariance)

    def wrench_error(self, wrenches: NDArray[np.float64]) -> float:
        """Return how far wrenches (n, 6), N and N·m, that are not taken off move a contact: rms, worst touch, m."""
        moved = np.einsum("mai,ni->mna", self._sensitivities, wrenches)
        return float(np.sqrt((moved**2).sum(axis=2).mean(axis=1).max()))

    def sensor_error(self, sigmas: NDArray[np.float64]) -> float:
        """Return what noise of sigmas (6,), N and N·m, in the live wrench adds: the worst 1 sigma, m."""
        return worst_sigma(self._sensitivities, np.diag(sigmas**2))


@cache
def usual_task() -> ContactTask:
    """Return the task that is assumed when nobody says another; made once, because it takes a while."""
    return ContactTask()


def contact_sensitivity(
    point: NDArray[np.float64], normal: NDArray[np.float64], forces: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Return how the contact point moves with the wrench.

    Differentiating ``p x F + k n = M`` and ``n . dp = 0`` at a point p of a surface with normal n (Cao et al.
    2023, Eq. 3-4) gives, with ``m = dM - p x dF``, ``dk = F.m / F.n`` and
    ``dp = F x (m - dk n) / |F|²`` plus the multiple of F that stays in the surface.

    Parameters
    ----------
    point, normal : (3,)
        S, m; of length 1.
    forces : (m, 3)
        On the probe, S, N; not along the surface.

    Returns
    -------
    (m, 3, 6)
        Columns Fx Fy Fz Mx My Mz.
    """
    moment = np.concatenate([-cross_matrix(point), np.eye(3)], axis=1)  # m = moment @ (dF, dM)
    into = forces @ normal
    without_k = np.eye(3) - normal[:, None] * (forces / into[:, None])[:, None, :]
    across = cross_matrix(forces) @ without_k / (forces**2).sum(axis=1)[:, None, None]
    in_surface = np.eye(3) - forces[:, :, None] * normal / into[:, None, None]
    sensitivity: NDArray[np.float64] = in_surface @ across @ moment
    return sensitivity


def force_directions(
    normal: NDArray[np.float64], angles: NDArray[np.float64], around: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Return unit forces (m, 3) that push on a surface: at `angles` from -normal, turned `around` it, rad."""
    first, second = _across(normal)
    side = np.cos(around)[:, None] * first + np.sin(around)[:, None] * second
    directions: NDArray[np.float64] = np.sin(angles)[:, None] * side - np.cos(angles)[:, None] * normal
    return directions


def worst_sigma(A: NDArray[np.float64], covariance: NDArray[np.float64]) -> float:
    """Return the largest 1 sigma in any direction of any ``A[k] covariance A[k]'``, for A (k, 2, m)."""
    AC = (A.reshape(-1, A.shape[-1]) @ covariance).reshape(A.shape)  # one product instead of k
    return float(np.sqrt(largest_eigenvalue(AC @ A.swapaxes(1, 2)).max()))


def largest_eigenvalue(C: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the largest eigenvalue (...) of covariances (..., 2, 2), at least 0."""
    a, b, c = C[..., 0, 0], C[..., 0, 1], C[..., 1, 1]
    largest: NDArray[np.float64] = 0.5 * (a + c) + np.hypot(0.5 * (a - c), b)
    return np.maximum(largest, 0.0)


def _cone(normal_S: NDArray[np.float64], tilt: float) -> NDArray[np.float64]:
    """Return R_SW (k, 3, 3) in which `normal_S` points down, and is tilted from that by up to `tilt`."""
    first, second = _across(normal_S)
    # Columns: where x, y, z of an upright tool frame lie in S; its z axis points to the sky.
    R_ST = np.column_stack([first, -second, -normal_S])
    tilts = [(0.0, 0.0)] + [
        (tilt * ring / _RINGS, 2 * np.pi * step / _ROUND)
        for ring in range(1, _RINGS + 1)
        for step in range(_ROUND)
    ]
    turn = Rotation.from_rotvec
    # Yaw matters only for the little that gravity is off the vertical: it alternates from tilt to tilt.
    rotations = [
        R_ST
        @ (turn([a * np.cos(b), a * np.sin(b), 0.0]) * turn([0.0, 0.0, np.pi / 2 * (number % 2)])).as_matrix()
        for number, (a, b) in enumerate(tilts)
    ]
    return np.array(rotations)


def _across(normal: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return two unit vectors that with `normal` form a right-handed frame."""
    helper = np.eye(3)[np.argmin(np.abs(normal))]
    first = np.cross(helper, normal)
    first /= np.linalg.norm(first)
    return first, np.cross(normal, first)
