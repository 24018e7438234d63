"""The mount that touches show: robust start, wrong touches named, what cannot be seen left as it was.

What a touch of a known point says about the mount.

A touch of the point p (in P) with outward normal n obeys ``p_S x F + k n_S = M`` with ``p_S = R p + t`` and
``n_S = R n`` (Cao et al. 2023, Eq. 4-6). The local torque k is unknown, so the two components of
``M - p_S x F`` across the normal must vanish, and nothing else is known. With two tangents T (2, 3) at p:

    r = T R^T (M - p_S x F) = 0
    cov(r) = B Sigma_w B^T + s^2 (F . n_S)^2 I,    B (dF, dM) = T R^T (dM - p_S x dF)

where s is how well the marker was hit, per direction in the surface. For fixed p the residual is linear in
the wrench's noise, so ``sum r^T inv(cov(r)) r`` is the likelihood itself once the unknown true forces are
eliminated, as long as cov(r) is taken where p is: it is differentiated with the rest.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import BinaryIO

import numpy as np
import scipy
from numpy.typing import ArrayLike, NDArray

from contactbench.pipeline.contact.wrench_csv import CHANNELS
from contactbench.pipeline.errors import arg, message
from contactbench.pipeline.kernel import SurfaceIndex
from contactbench.pipeline.mesh import Probe
from contactbench.pipeline.mesh.arrays import Floats, Mask
from contactbench.pipeline.preparation.alignment.alignment import (
    AlignmentError,
    across,
    apply,
    check_numbers,
    difference,
    step,
)
from contactbench.pipeline.tables import TableError, TableReader, Wording, read_table

_ALL = np.eye(6)
# A sound touch is left out once in so many sets.
_FALSE_ALARM = 0.01
_ROUNDS = 10
# Median of a chi-square of two. With sound noise the median of ten touches hardly ever is so many times that.
_MEDIAN, _RESTLESS = 2 * float(np.log(2.0)), 2.5
# Residuals this improbable say that the noise given is too small: every uncertainty is widened.
_DOUBT = 1e-3
# So many touches must stay, or what is left fits anything.
_FEWEST = 3


@dataclass(frozen=True, eq=False)
class MountFit:
    """What touches say of the mount."""

    T_SP: Floats  # (4, 4)
    start: Floats  # (4, 4) the mount that was started from; what the touches do not show is as it is there
    about_S: Floats  # (3,) what the unknowns are about: the touches' centroid under `start`, m
    # (6, 6) of shift (m) and rotation (rad) about `about_S`; along unseen directions that of the belief
    covariance: Floats
    information: Floats  # (6, 6) inverse covariance by the touches alone, in units of the belief
    # seen, unseen: (6, r) orthonormal directions in units of the belief, that the touches know better
    # or worse than it
    seen: Floats
    unseen: Floats
    kept: Mask  # (n,) touches that were used
    # (n,) how far each touch is from what the others say, in sigmas: sqrt of a chi-square of two
    deviates: Floats
    chi_square: float  # of the touches kept
    freedom: int
    scatter: float  # factor by which the covariance was widened, at least 1

    @property
    def rank(self) -> int:
        """How many of the six combinations of shift and rotation the touches show."""
        return int(self.seen.shape[1])


def fit_mount(model: MarkerModel, starts: Sequence[Floats], belief: MountBelief) -> MountFit:
    """
    Fit the mount by maximum likelihood; touches that the others deny are left out.

    Parameters
    ----------
    model : MarkerModel
    starts : sequence of (4, 4)
        Mounts to begin from; the one that explains the touches best is taken, and is what the belief is about.
    belief : MountBelief

    Returns
    -------
    MountFit
    """
    problem, T_SP = _best_start(model, starts, belief)
    kept = _sound(np.sqrt(problem.squares(T_SP))) & model.pressed(T_SP)
    if kept.sum() < _FEWEST:
        kept = np.ones(len(model), dtype=bool)
    for _ in range(_ROUNDS):
        part = replace(problem, model=model.chosen(kept))
        T_SP, seen, unseen = _fit_seen(part, T_SP)
        deviates = _deviates(problem, T_SP, seen, kept)
        sound = _sound(deviates) & model.pressed(T_SP)
        if (sound == kept).all() or sound.sum() < _FEWEST:
            break
        kept = sound
    else:  # the last choice was not fitted yet
        part = replace(problem, model=model.chosen(kept))
        T_SP, seen, unseen = _fit_seen(part, T_SP)
    return _summary(problem, part, T_SP, seen, unseen, kept)


def _best_start(
    model: MarkerModel, starts: Sequence[Floats], belief: MountBelief
) -> tuple[MountProblem, Floats]:
    found = []
    for start in starts:
        problem = MountProblem(model, start, apply(start, model.points_P).mean(axis=0), belief)
        T_SP = minimise(problem, start, _ALL, robust=True, believing=True)
        # The equations cannot tell a push from a pull; of flipped starts only one is pushed on.
        pulled = float((~model.pressed(T_SP)).sum())
        found.append((pulled, loss(problem, T_SP, robust=True, believing=True), problem, T_SP))
    _, _, problem, T_SP = min(found, key=lambda entry: entry[:2])
    return problem, T_SP


def _fit_seen(problem: MountProblem, T_SP: Floats) -> tuple[Floats, Floats, Floats]:
    """Return the mount, and what is seen and unseen, by touches that are all trusted."""
    seen, unseen = _sight(_information(problem, T_SP))
    if unseen.shape[1]:
        T_SP = minimise(problem, T_SP, _ALL, robust=False, believing=True)
        seen, unseen = _sight(_information(problem, T_SP))
    for _ in range(3):
        rank = seen.shape[1]
        if unseen.shape[1]:  # goes back to where it started, however far the belief let it move
            T_SP = problem.mount(seen @ (seen.T @ problem.unknowns(T_SP)))
        T_SP = minimise(problem, T_SP, seen, robust=False, believing=False)
        if not unseen.shape[1]:
            break
        seen, unseen = _sight(_information(problem, T_SP))
        if seen.shape[1] == rank:
            break
    return T_SP, seen, unseen


def _information(problem: MountProblem, T_SP: Floats) -> Floats:
    J = problem.jacobian(T_SP).reshape(-1, 6)
    information: Floats = J.T @ J
    return information


def _sight(information: Floats) -> tuple[Floats, Floats]:
    """Split directions (6, r) and (6, 6 - r) into those known better than the belief, and the others."""
    values, vectors = np.linalg.eigh(information)
    return vectors[:, values >= 1.0], vectors[:, values < 1.0]


def _deviates(problem: MountProblem, T_SP: Floats, seen: Floats, kept: Mask) -> Floats:
    """Return each touch's distance from what the touches kept, without it, predict."""
    r, J = problem.model.residuals(T_SP), problem.jacobian(T_SP) @ seen
    used = J[kept].reshape(-1, seen.shape[1])
    C = np.linalg.pinv(used.T @ used, hermitian=True)
    share = J @ C @ J.transpose(0, 2, 1)
    # The fit follows a touch that was used, and adds its own error to one that was not.
    spread = np.eye(2) + np.where(kept[:, None, None], -share, share)
    values, vectors = np.linalg.eigh(spread)
    turned = np.einsum("nji,nj->ni", vectors, r)
    # Where the fit follows a touch entirely, nothing checks it.
    checked = values > 1e-6
    deviates: Floats = np.sqrt((turned**2 / np.where(checked, values, np.inf)).sum(axis=1))
    return deviates


def _sound(deviates: Floats) -> Mask:
    """Return which touches (n,) agree; if most of them scatter more than they should, the limit is wider."""
    limit = float(scipy.special.chdtri(2, _FALSE_ALARM / len(deviates)))
    usual = float(np.median(deviates**2)) / _MEDIAN
    return np.asarray(deviates**2 <= limit * (usual if usual > _RESTLESS else 1.0))


def _summary(
    problem: MountProblem, part: MountProblem, T_SP: Floats, seen: Floats, unseen: Floats, kept: Mask
) -> MountFit:
    chi_square = float(part.squares(T_SP).sum())
    freedom = 2 * len(part.model) - seen.shape[1]
    doubtful = freedom > 0 and scipy.special.chdtrc(freedom, chi_square) < _DOUBT
    scatter = chi_square / freedom if doubtful else 1.0
    information = _information(part, T_SP)
    known = np.linalg.inv(seen.T @ information @ seen) if seen.shape[1] else np.zeros((0, 0))
    scaled = scatter * seen @ known @ seen.T + unseen @ unseen.T
    scales = problem.belief.scales
    return MountFit(
        T_SP=T_SP,
        start=problem.start,
        about_S=problem.about_S,
        covariance=scaled * np.outer(scales, scales),
        information=information,
        seen=seen,
        unseen=unseen,
        kept=kept,
        deviates=_deviates(problem, T_SP, seen, kept),
        chi_square=chi_square,
        freedom=freedom,
        scatter=scatter,
    )


# ---- damped Gauss-Newton on the mount ------------------------------------------------------------


# Of a scaled unknown: central differences then err by about 1e-10 of the derivative.
_DIFFERENCE = 1e-5


@dataclass(frozen=True, eq=False)
class MarkerModel:
    """Touches, ready to be compared with a mount."""

    # points_P, normals_P: (n, 3) on the mesh, m; outward unit normals
    points_P: Floats
    normals_P: Floats
    wrenches: Floats  # (n, 6) in S, N and N·m
    covariance: Floats  # (6, 6) of a wrench's noise, independent from touch to touch
    placement: float  # standard deviation of where a marker is hit, in each direction of the surface, m

    def __len__(self) -> int:
        return len(self.points_P)

    @cached_property
    def tangents_P(self) -> Floats:
        """(n, 2, 3) two unit tangents per touch: they turn with the mesh, so the residual is smooth."""
        return across(self.normals_P)

    def chosen(self, rows: NDArray[np.intp] | Mask) -> MarkerModel:
        """Return some of the touches."""
        return MarkerModel(
            self.points_P[rows], self.normals_P[rows], self.wrenches[rows], self.covariance, self.placement
        )

    def pressed(self, T_SP: Floats) -> Mask:
        """Return which forces (n,) push on the surface; tissue cannot pull."""
        into = np.einsum("ij,ij->i", self.wrenches[:, :3], self.normals_P @ T_SP[:3, :3].T)
        return np.asarray(into < 0)

    def residuals(self, T_SP: Floats, bias: Floats | None = None) -> Floats:
        """
        Return the residuals (..., n, 2), each pair of unit covariance.

        Parameters
        ----------
        T_SP : (..., 4, 4)
            One mount or several.
        bias : (6,), optional
            A wrench error common to all touches, to be subtracted.
        """
        wrenches = self.wrenches if bias is None else self.wrenches - bias
        r, spread, _ = self._compare(T_SP, wrenches)
        return _whiten(spread, r)

    def sigmas(self, T_SP: Floats) -> Floats:
        """Return the smallest contact error (n, 2, 2) that the noise allows, as covariances in the surface, m²."""
        _, spread, into = self._compare(T_SP, self.wrenches)
        # The contact moves in the surface by u with T (u x F) = r, which is r turned by 90 deg over F.n.
        turn = np.array([[0.0, 1.0], [-1.0, 0.0]])
        covariances: Floats = turn @ spread @ turn.T / into[:, None, None] ** 2
        return covariances

    def plane_errors(self, T_SP: Floats) -> Floats:
        """Return how far (n,) each contact is from its marker in the marker's tangent plane, m."""
        r, _, into = self._compare(T_SP, self.wrenches)
        errors: Floats = np.linalg.norm(r, axis=1) / np.maximum(np.abs(into), 1e-12)
        return errors

    def jacobian(self, T_SP: Floats, about_S: Floats, scales: Floats) -> Floats:
        """Return the derivative (n, 2, 6) of the residuals by scaled steps of the mount about a point of S."""
        steps = _DIFFERENCE * np.diag(scales)
        r = self.residuals(step(T_SP, about_S, np.concatenate([steps, -steps])))
        return np.moveaxis((r[:6] - r[6:]) / (2 * _DIFFERENCE), 0, 2)

    def bias_jacobian(self, T_SP: Floats) -> Floats:
        """Return the derivative (n, 2, 6) of the residuals by a common wrench error, per N and per N·m."""
        steps = _DIFFERENCE * np.eye(6)
        r = np.stack([self.residuals(T_SP, -d) - self.residuals(T_SP, d) for d in steps])
        return np.moveaxis(r / (2 * _DIFFERENCE), 0, 2)

    def _compare(self, T_SP: Floats, wrenches: Floats) -> tuple[Floats, Floats, Floats]:
        """Return r (..., n, 2), cov(r) (..., n, 2, 2) and the force along the normal (..., n), N."""
        F, M = wrenches[:, :3], wrenches[:, 3:]
        R_PS = T_SP[..., :3, :3].swapaxes(-1, -2)
        p = self.points_P @ R_PS + T_SP[..., None, :3, 3]
        T_S = self.tangents_P @ R_PS[..., None, :, :]
        r = (T_S @ (M - _cross(p, F))[..., None])[..., 0]
        # Row i of B: a tangent e takes (dF, dM) to e.(dM - p x dF) = e.dM - (e x p).dF.
        B = np.concatenate([-_cross(T_S, p[..., None, :]), T_S], axis=-1)
        spread = B @ self.covariance @ B.swapaxes(-1, -2)
        into = ((self.normals_P @ R_PS) * F).sum(axis=-1)
        spread = spread + (self.placement * into)[..., None, None] ** 2 * np.eye(2)
        return r, spread, into


def _cross(a: Floats, b: Floats) -> Floats:
    """Return cross products; NumPy's own spends ten times as long on moving axes."""
    product = a[..., [1, 2, 0]] * b[..., [2, 0, 1]]
    product -= a[..., [2, 0, 1]] * b[..., [1, 2, 0]]
    return product


def _whiten(spread: Floats, r: Floats) -> Floats:
    """Return inv(L) r for spread = L L^T, (..., n, 2)."""
    a = np.sqrt(spread[..., 0, 0])
    b = spread[..., 1, 0] / a
    c = np.sqrt(spread[..., 1, 1] - b * b)
    first = r[..., 0] / a
    return np.stack([first, (r[..., 1] - b * first) / c], axis=-1)


_STEPS = 60
_SETTLED = 1e-7  # of a scaled unknown: below a nanometre
_DAMPING = 1e-6
_HOPELESS = 1e12
# Cauchy's loss: a touch at this many sigmas (both directions together) counts half.
_HALF = 3.0


@dataclass(frozen=True)
class MountBelief:
    """
    How far the mount to start from may be off, 1 sigma per axis.

    Touches that know a combination of shift and rotation less well than this do not show it: it stays as it
    was. The ratio of the two is also the length by which rotations and shifts are compared: 95 mm by default.

    Raises
    ------
    AlignmentError
        Not above 0, or beyond 1 m or pi.
    """

    shift: float = 0.005  # of the touched points' centroid, m
    rotation: float = float(np.radians(3.0))  # in radians

    def __post_init__(self) -> None:
        for name, most in (("shift", 1.0), ("rotation", np.pi)):
            value = getattr(self, name)
            if not 0 < value <= most:
                raise AlignmentError(
                    f"MountBelief.{arg(name)}: {arg(value)} is not above 0 and at most {arg(most):.4g} (m, rad)."
                )

    @property
    def scales(self) -> Floats:
        """(6,) units of the scaled unknowns: m, m, m, rad, rad, rad."""
        return np.array([self.shift] * 3 + [self.rotation] * 3)


@dataclass(frozen=True, eq=False)
class MountProblem:
    """What is minimised: the touches' residuals, plus the belief about the mount where it is asked for."""

    model: MarkerModel
    start: Floats  # (4, 4) T_SP to start from, which the belief is about
    about_S: Floats  # (3,) what steps turn about, m
    belief: MountBelief

    def mount(self, z: Floats) -> Floats:
        """Return T_SP for scaled unknowns (6,)."""
        return step(self.start, self.about_S, z * self.belief.scales)

    def unknowns(self, T_SP: Floats) -> Floats:
        """Return the scaled unknowns (6,) of a mount."""
        return difference(T_SP, self.start, self.about_S) / self.belief.scales

    def jacobian(self, T_SP: Floats) -> Floats:
        """Return the derivative (n, 2, 6) by scaled steps from a mount."""
        return self.model.jacobian(T_SP, self.about_S, self.belief.scales)

    def squares(self, T_SP: Floats) -> Floats:
        """Return the squared distance (n,) of each touch in sigmas, of two degrees of freedom each."""
        return np.asarray((self.model.residuals(T_SP) ** 2).sum(axis=1))


def minimise(problem: MountProblem, T_SP: Floats, free: Floats, *, robust: bool, believing: bool) -> Floats:
    """
    Descend from a mount to the nearest minimum.

    Parameters
    ----------
    problem : MountProblem
    T_SP : (4, 4)
        Where to begin.
    free : (6, r)
        Orthonormal directions of scaled steps that may be taken.
    robust : bool
        Weigh touches by Cauchy's loss instead of squares.
    believing : bool
        Add the square of the scaled distance from the problem's start.

    Returns
    -------
    (4, 4) T_SP
    """
    damping = _DAMPING
    cost = loss(problem, T_SP, robust=robust, believing=believing)
    gradient, square = _normal(problem, T_SP, free, robust=robust, believing=believing)
    for _ in range(_STEPS):
        z = free @ np.linalg.solve(
            square + damping * (np.diag(np.diag(square)) + np.eye(len(square))), gradient
        )
        moved = step(T_SP, problem.about_S, -z * problem.belief.scales)
        new = loss(problem, moved, robust=robust, believing=believing)
        if new <= cost:
            T_SP, cost, damping = moved, new, max(damping / 10, 1e-12)
            if np.abs(z).max() < _SETTLED:
                break
            gradient, square = _normal(problem, T_SP, free, robust=robust, believing=believing)
        else:
            damping *= 10
            if np.abs(z).max() < _SETTLED or damping > _HOPELESS:
                break  # rounding leaves nothing to gain
    return T_SP


def loss(problem: MountProblem, T_SP: Floats, *, robust: bool, believing: bool) -> float:
    """Return what `minimise` lowers."""
    squares = problem.squares(T_SP)
    total = float((_HALF**2 * np.log1p(squares / _HALF**2) if robust else squares).sum())
    return total + (float((problem.unknowns(T_SP) ** 2).sum()) if believing else 0.0)


def _normal(
    problem: MountProblem, T_SP: Floats, free: Floats, *, robust: bool, believing: bool
) -> tuple[Floats, Floats]:
    """Return the gradient (r,) and the normal matrix (r, r) along the free directions."""
    r, J = problem.model.residuals(T_SP), problem.jacobian(T_SP)
    if robust:
        root = 1 / np.sqrt(1 + (r**2).sum(axis=1) / _HALF**2)
        r, J = r * root[:, None], J * root[:, None, None]
    r, J = r.ravel(), J.reshape(-1, 6) @ free
    if believing:  # the belief's own derivative is the identity but for second order
        r, J = np.concatenate([r, problem.unknowns(T_SP)]), np.concatenate([J, free])
    return J.T @ r, J.T @ J


# ---- touches of marked points: where the mesh says they are, and what the sensor felt ------------


_SMALLEST_FORCE_N = 0.5
_LARGEST_M = 10.0
# Further from the surface, a marker is not on this mesh, or not in its unit; nearer, it is worth a word.
_OFF_MESH_M, _NEAR_MESH_M = 0.010, 0.001
_NORMAL_AGREES = np.cos(np.radians(60.0))


@dataclass(frozen=True, eq=False)
class MarkerTouches:
    """
    Touches of points that are known on the mesh.

    Raises
    ------
    AlignmentError
        Fewer than three touches, a wrong shape, a number that is not finite, a force under 0.5 N, a
        normal without length.
    """

    points_P: Floats  # (n, 3) the markers in the mesh's frame, m
    # (n, 6) Fx Fy Fz Mx My Mz in S, N and N·m about the sensor origin: what the tissue does to the
    # probe, compensated for gravity and bias
    wrenches: Floats
    normals_P: Floats | None = None  # (n, 3) outward unit normals there; None: those of the mesh
    names: tuple[str, ...] = ()  # for people; numbered from 1 when left out

    def __post_init__(self) -> None:
        points = check_numbers(self.points_P, (-1, 3), "points_P")
        wrenches = check_numbers(self.wrenches, (-1, 6), "wrenches")
        names = tuple(self.names) or tuple(f"touch {row + 1}" for row in range(len(points)))
        if len({len(points), len(wrenches), len(names)}) > 1:
            raise AlignmentError(
                f"{arg(len(points))} points, {arg(len(wrenches))} wrenches and {arg(len(names))} names: give"
                " one of each per touch."
            )
        if len(points) < 3:
            raise AlignmentError(
                f"{arg(len(points))} touches cannot show a mount: touch at least three markers."
            )
        _check_sizes(points, wrenches, names)
        object.__setattr__(self, "points_P", points)
        object.__setattr__(self, "wrenches", wrenches)
        object.__setattr__(self, "names", names)
        if self.normals_P is not None:
            object.__setattr__(self, "normals_P", _unit(self.normals_P, names))

    def __len__(self) -> int:
        return len(self.points_P)


def put_on_mesh(touches: MarkerTouches, probe_P: Probe) -> tuple[Floats, Floats, tuple[str, ...]]:
    """
    Move each marker to the nearest point of the mesh, and take the normal there if none was given.

    Returns
    -------
    points, normals : (n, 3) float64
        The nearest points of the surface, m, and the outward unit normals there.
    warnings : tuple of str
        About markers that lie off the surface, or whose normal disagrees with it.

    Raises
    ------
    AlignmentError
        A marker is over 10 mm from the surface: another mesh, frame or unit.
    """
    index = SurfaceIndex(probe_P.vertices, probe_P.faces)
    distance, face, foot = index.closest(np.ascontiguousarray(touches.points_P))
    worst = int(np.argmax(distance))
    if distance[worst] > _OFF_MESH_M:
        raise AlignmentError(
            f"{arg(touches.names[worst])}: the marker is {arg(1e3 * distance[worst]):.1f} mm from the mesh."
            " Give the markers in millimetres in the mesh's own frame, and the mesh they were"
            " measured on."
        )
    warnings = [
        message(
            f"{arg(name)}: the marker is {arg(1e3 * d):.1f} mm from the mesh; the nearest point of the mesh is used."
        )
        for name, d in zip(touches.names, distance, strict=True)
        if d > _NEAR_MESH_M
    ]
    normals: Floats = probe_P.normals[face]
    if touches.normals_P is not None:
        agree = np.einsum("ij,ij->i", normals, touches.normals_P)
        warnings += [
            message(
                f"{arg(name)}: the given normal is {arg(np.degrees(np.arccos(np.clip(a, -1, 1)))):.0f}° from the"
                " mesh normal there. Check its sign and the marker."
            )
            for name, a in zip(touches.names, agree, strict=True)
            if a < _NORMAL_AGREES
        ]
        normals = touches.normals_P
    return np.asarray(foot), normals, tuple(warnings)


def _check_sizes(points: Floats, wrenches: Floats, names: tuple[str, ...]) -> None:
    force = np.linalg.norm(wrenches[:, :3], axis=1)
    weak = int(np.argmin(force))
    if force[weak] < _SMALLEST_FORCE_N:
        raise AlignmentError(
            f"{arg(names[weak])}: the force is {arg(force[weak]):.3g} N, below {arg(_SMALLEST_FORCE_N):g} N, so"
            " it is not a touch. Remove the row, or press with 8 to 10 N."
        )
    far = int(np.argmax(np.abs(points).max(axis=1)))
    if np.abs(points[far]).max() > _LARGEST_M:
        raise AlignmentError(
            f"{arg(names[far])}: the marker is over 10 m away: give metres in the mesh's frame."
        )


def _unit(values: ArrayLike, names: tuple[str, ...]) -> Floats:
    normals = check_numbers(values, (len(names), 3), "normals_P")
    length = np.linalg.norm(normals, axis=1)
    short = int(np.argmin(length))
    if length[short] < 1e-9:
        raise AlignmentError(
            f"{arg(names[short])}: the normal has zero length: leave out all normals, or correct it."
        )
    unit: Floats = normals / length[:, None]
    return unit


# ---- touches of marked points from CSV -----------------------------------------------------------


POINT = ("px", "py", "pz")
NORMAL = ("nx", "ny", "nz")
NAME = "marker"
_MOST = 10_000


class TouchFileError(TableError, AlignmentError):
    """A file of touches that cannot be used: names the file, the line, and the remedy."""


_WORDING = Wording(
    header=",".join((*POINT, *CHANNELS)),
    rows="touches",
    meaning=message(
        "markers in mm in the mesh's frame, forces in N and torques in N·m in the sensor frame S; nx,ny,nz (the"
        " outward normal) and marker (a name) may be added"
    ),
    not_finite=message("remove the row, or touch the marker again."),
    text=message("the name of a marker"),
    error=TouchFileError,
)


def read_touches(source: Path | BinaryIO) -> MarkerTouches:
    """
    Read touches of marked points.

    Parameters
    ----------
    source : path or binary file
        CSV with the columns px,py,pz (mm, in P) and fx,fy,fz,mx,my,mz (N and N·m, in S, compensated), and
        optionally nx,ny,nz (in P) and marker. Other columns are ignored.

    Returns
    -------
    MarkerTouches
        In metres; named by the marker, or by the line of the file.

    Raises
    ------
    TouchFileError
        The file is missing, too long, not a table, has some of nx,ny,nz only, or holds touches that cannot be
        used.
    """
    readers: list[TableReader] = []

    def select(reader: TableReader) -> None:
        some = [column for column in NORMAL if column in reader.names]
        if some and len(some) < 3:
            raise reader.error(
                message(f"only {arg(', '.join(some))} of nx,ny,nz is given: give all three, or none."), 1
            )
        reader.select((*POINT, *CHANNELS), optional=NORMAL, text=NAME if NAME in reader.names else None)
        readers.append(reader)

    rows = read_table(source, select, _WORDING, row_limit=_MOST)
    lines = rows.lines.tolist()
    cells = [""] * len(lines) if rows.text is None else [_name(cell) for cell in rows.text.tolist()]
    names = [
        f"{cell} (line {line})" if cell else f"line {line}" for cell, line in zip(cells, lines, strict=True)
    ]
    normals = rows.numbers[:, 9:12] if len(rows.columns) == 12 else None
    try:
        return MarkerTouches(rows.numbers[:, :3] / 1e3, rows.numbers[:, 3:9], normals, tuple(names))
    except AlignmentError as error:
        raise readers[0].error(str(error)) from error


def _name(cell: bytes) -> str:
    """Return a name without quotes and control characters."""
    text = cell.decode(errors="replace").strip().strip('"').strip()
    return "".join(letter for letter in text if letter.isprintable())
