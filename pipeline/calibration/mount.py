"""Gravity calibration when nobody knows how the sensor is turned on the flange.

Observation model of pose i, with E_i = R_EW the known orientation of the flange and R_SE one unknown rotation:

    F_i = R_SE E_i g + F0,    M_i = L x (R_SE E_i g) + M0

Fifteen unknowns. With gravity along the vertical z of W, the forces less their mean are those verticals,
E_i z less their mean, turned and scaled: a Wahba problem with a closed solution (Kabsch 1976). From there
Gauss-Newton on all fifteen, with R_SE on SO(3): a small rotation vector d, in S, acts from the left,
``R_SE <- exp([d]x) R_SE``, and changes a force ``v = R_SE E_i g`` by ``-[v]x d``.

A tilt of the base and the mount's rotation do nearly the same to a force. Only poses that tilt far, about
two axes, tell them apart; a prior for the tilt of the base does too.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.linalg import block_diag
from scipy.spatial.transform import Rotation
from scipy.special import chdtrc, chdtri, fdtrc

from contactbench.pipeline.calibration.calibrate import Calibration, Findings, direction, facing, findings_of
from contactbench.pipeline.calibration.comparison import compare
from contactbench.pipeline.calibration.model import (
    ANY_TURN,
    CENTRE_OF_MASS,
    DOWN_W,
    FORCE_BIAS,
    GRAVITY,
    TORQUE_BIAS,
    UNKNOWN,
    Fit,
    GravityModel,
    PoseNoise,
    cross_matrix,
    parameter_covariance,
    prediction_jacobian,
    solve_with_offset,
    upright,
)
from contactbench.pipeline.calibration.observability import Observability, observe
from contactbench.pipeline.calibration.poses import PoseError, PoseSample, Stack, stack
from contactbench.pipeline.calibration.reml import LEAST, NoisePrior
from contactbench.pipeline.calibration.suggest import ContactTask, usual_task, worst_sigma
from contactbench.pipeline.calibration.verdict import LARGEST_SHARE, Level, Limits, Verdict, judge
from contactbench.pipeline.errors import arg, message


@dataclass(frozen=True, eq=False)
class MountCalibration:
    """What poses of the flange say of the sensor's mounting, and of bias, weight and centre of mass.

    Attributes
    ----------
    R_SE : (3, 3)
        Components in the flange frame E to components in the sensor frame S.
    calibration : Calibration
        As from known orientations: its poses have ``R_WS = R_WE @ R_SE.T``. Its covariance is what the
        parameters' becomes because R_SE is uncertain too; its contact error and its verdict include R_SE.
    joint_covariance : (15, 15)
        Of PARAMETERS, then of the rotation vector d in ``R_true = exp([d]x) @ R_SE``, in S, rad. What the
        poses do not show has a wide width, never a small one.
    mounting : str
        The simple mounting (a multiple of 45 degrees about the flange's z axis) that this may be, in words;
        empty when there is none near.
    """

    R_SE: NDArray[np.float64]
    calibration: Calibration
    joint_covariance: NDArray[np.float64]
    mounting: str

    @property
    def rotation_covariance(self) -> NDArray[np.float64]:
        """(3, 3) of the rotation vector, S, rad²; see `joint_covariance`."""
        return self.joint_covariance[ROTATION, ROTATION]

    @property
    def rotation_sigma_deg(self) -> float:
        """Standard deviation of R_SE about the axis on which least is known, degrees."""
        return float(np.degrees(largest_sigma(self.rotation_covariance)))


def estimate_mount(
    poses: Sequence[PoseSample],
    noise: PoseNoise | None = None,
    *,
    orientation_sigma: float | None = None,
    down_W: ArrayLike = DOWN_W,
    task: ContactTask | None = None,
    limits: Limits | None = None,
) -> MountCalibration:
    """Calibrate bias, weight and centre of mass together with the sensor's rotation on the flange.

    Poses that disagree with the rest are left out and named.

    Parameters
    ----------
    poses : sequence of PoseSample
        At least four; their `R_WS` holds the orientation of the *flange*, R_WE. Eight or more that tilt far
        about two axes let bumped ones be named with certainty.
    noise, orientation_sigma, down_W, task, limits
        As for `calibrate`.

    Returns
    -------
    MountCalibration
        Also for poses that are too few or too alike: then its calibration's verdict is to refuse it, in words.

    Raises
    ------
    PoseError
        There are fewer than four poses.
    InputError
        `orientation_sigma` or `down_W` is not finite, or the latter zero.
    """
    if len(poses) < 4:
        raise PoseError(
            f"{arg(len(poses))} poses are too few. Fifteen unknowns need at least four poses that tilt"
            " about two axes; checking them against one another needs six or more."
        )
    flange, down = stack(poses), direction(down_W)
    prior = NoisePrior.of(poses, noise, orientation_sigma)
    R_start = start_rotation(flange, prior, down)
    compared = compare(replace(flange, R_SW=R_start @ flange.R_SW), prior, down, mounted=False)
    told, chosen = compared.used()
    fit = chosen.noisy.fit
    wider = np.zeros_like(fit.covariance)
    wider[:15, :15] = compared.between(chosen)
    fit = replace(fit, covariance=(fit.covariance + wider)[:15, :15])
    R_SE = fit.mount @ R_start
    sight = see(flange, chosen.inside, fit, R_SE, chosen.noisy.noise)
    theta, joint = sight.fit.theta, sight.fit.covariance
    task = facing(task or usual_task(), down)
    noisy = replace(chosen.noisy, fit=replace(chosen.noisy.fit, theta=theta))
    findings = findings_of(
        [replace(pose, R_WS=pose.R_WS @ R_SE.T) for pose in poses],
        compared,
        told,
        replace(chosen, noisy=noisy),
        GravityModel.from_vector(theta, joint[:12, :12]),
        sight.parameters,
        task,
        _contact_error(task, theta, joint),
    )
    judged = verdict(findings, sight, chosen.agree, limits or Limits())
    mounting = "" if judged.level is Level.REFUSE else simple(R_SE, joint[ROTATION, ROTATION])
    return MountCalibration(R_SE, Calibration(**vars(findings), verdict=judged), joint, mounting)


def _contact_error(task: ContactTask, theta: NDArray[np.float64], joint: NDArray[np.float64]) -> float:
    """Return the worst 1 sigma of a contact point over the task, m, R_SE included."""
    A = task.parameter_sensitivity(theta)
    turned = -cross_matrix(task.orientations @ theta[GRAVITY])
    turned = np.repeat(turned, len(A) // len(turned), axis=0)
    # A turn of the mount changes force and torque as a change of the biases would.
    by_turn = (A[:, :, FORCE_BIAS] + A[:, :, TORQUE_BIAS] @ cross_matrix(theta[CENTRE_OF_MASS])) @ turned
    return worst_sigma(np.concatenate([A, by_turn], axis=2), joint)


ROTATION = slice(12, 15)  # behind PARAMETERS
ALL_UNKNOWN = np.append(UNKNOWN, np.full(3, ANY_TURN))


def turn(d: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return exp([d]x) (..., 3, 3) for rotation vectors d (..., 3), rad."""
    return Rotation.from_rotvec(d).as_matrix()


def unit(v: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return a vector at length 1."""
    return v / max(float(np.linalg.norm(v)), 1e-12)


def largest_sigma(covariance: NDArray[np.float64]) -> float:
    """Return the standard deviation in the worst direction."""
    return float(np.sqrt(np.linalg.eigvalsh(covariance)[-1]))


# Where gravity may point in W: down; else the sensor or the orientations are turned over, or W is.
DOWNS = np.array([[0.0, 0, -1], [0, 0, 1], [1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0]])
_ANOTHER = 20.0  # doubled log likelihood by which another direction must be better than down
_SETS, _REFINED, _FEWEST_POSES = 100, 10, 5
_MEDIAN = 2.366  # of the sum of three squared standard normal numbers
_REFINEMENTS, _RIDGE = 3, 1e-4


def start_rotation(flange: Stack, prior: NoisePrior, down_W: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return R_SE (3, 3) of the smallest trimmed sum of squares.

    From many sets of four poses, with gravity that points down; or, where that explains the poses far
    better, up or along a horizontal axis: a wrench of the opposite sign, or a base on a wall of which nobody spoke.
    """
    downs = DOWNS @ upright(down_W)
    n = len(flange)
    size = min(n, max(n - int(LARGEST_SHARE * n), _FEWEST_POSES))
    ways = np.repeat(np.arange(len(downs)), _SETS)
    sets = np.random.default_rng(0).random((len(ways), n)).argpartition(3, axis=1)[:, :4]
    variances = None if prior.sigmas is None else (prior.sigmas**2).reshape(2, 3).mean(axis=1)
    for leading in (_REFINED, _REFINED, 1):  # concentration: fit the majority, see who the majority is now
        R, theta = _start(flange.R_SW[sets], flange.wrenches[sets], downs[ways])
        squares = _squares(flange, R, theta)
        if variances is None:
            variances = np.maximum(np.median(squares, axis=1).min(axis=0) / _MEDIAN, LEAST[[0, 3]] ** 2)
        total = squares @ (1 / variances)
        sets = np.argsort(total, axis=1)[:, :size]
        trimmed = np.take_along_axis(total, sets, axis=1).sum(axis=1)
        order = np.lexsort((trimmed, ways)).reshape(len(downs), -1)[:, :leading].ravel()
        sets, ways, trimmed = sets[order], ways[order], trimmed[order]
    gain = (6 * size - 15) * np.log((trimmed[0] + 1) / (trimmed + 1))
    way = int(np.argmax(gain)) if gain.max() > _ANOTHER else 0
    R_SE: NDArray[np.float64] = R[order][way]
    return R_SE


def _start(
    E: NDArray[np.float64], wrenches: NDArray[np.float64], down_W: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return R_SE (k, 3, 3) and parameters (k, 12) of sets of poses, from forces, then torques.

    Parameters
    ----------
    E : (k, m, 3, 3)
        R_EW.
    wrenches : (k, m, 6)
    down_W : (k, 3)
        Where gravity points, roughly.
    """
    F, M = wrenches[..., :3], wrenches[..., 3:]
    dF = centred(F)
    u = centred((E @ down_W[:, None, :, None])[..., 0])
    U, s, Vt = np.linalg.svd(dF.swapaxes(1, 2) @ u)
    sign = np.linalg.det(U @ Vt)  # the nearest rotation, not the nearest mirror
    U[:, :, 2] *= sign[:, None]
    s[:, 2] *= sign
    R = U @ Vt
    weight = np.maximum(s.sum(axis=1) / np.maximum((u**2).sum(axis=(1, 2)), 1e-12), 1e-9)
    g = weight[:, None] * down_W
    for _ in range(_REFINEMENTS):  # of Gauss-Newton on gravity and rotation: the base may be tilted
        R_SW = R[:, None] @ E
        v = (R_SW @ g[:, None, :, None])[..., 0]
        rows = centred(np.concatenate([R_SW, -cross_matrix(v) / weight[:, None, None, None]], axis=3))
        rows = rows.reshape(len(E), -1, 6)
        square = rows.swapaxes(1, 2) @ rows
        ridge = _RIDGE * np.trace(square, axis1=1, axis2=2)[:, None, None] + 1e-30
        right = rows.swapaxes(1, 2) @ (dF - centred(v)).reshape(len(E), -1, 1)
        step = np.linalg.solve(square + ridge * np.eye(6), right)[..., 0]
        g, R = g + step[:, :3], turn(step[:, 3:] / weight[:, None]) @ R
    v = (R[:, None] @ E @ g[:, None, :, None])[..., 0]
    L, M0 = solve_with_offset(-cross_matrix(v), M)
    return R, np.concatenate([g, (F - v).mean(axis=1), L, M0], axis=1)


def centred(values: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return values (k, m, ...) less their means over the m poses: what is left when a bias is free."""
    centred: NDArray[np.float64] = values - values.mean(axis=1, keepdims=True)
    return centred


def _squares(flange: Stack, R: NDArray[np.float64], theta: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return |F - predicted|² and |M - predicted|² (k, n, 2) of every pose under every set of parameters."""
    v = np.einsum("kab,nbc,kc->kna", R, flange.R_SW, theta[:, GRAVITY], optimize=True)
    torque = np.cross(theta[:, None, CENTRE_OF_MASS], v)
    forces = flange.F - v - theta[:, None, FORCE_BIAS]
    torques = flange.M - torque - theta[:, None, TORQUE_BIAS]
    return np.stack([(forces**2).sum(axis=2), (torques**2).sum(axis=2)], axis=2)


# A mount that is known less well than this, 1 sigma, is of no use (the eye does better), and is more than a
# linear covariance can describe.
_UNSURE, _SURE = np.radians(10.0), np.radians(2.0)
# Orientations are off by some tenths of a degree, rad. Where the poses separate a turn of the mount from all
# else by less than _BLIND, as a sine, errors like that turn the mount by more than _UNSURE.
_ORIENTATION = 5e-3
_BLIND = _ORIENTATION / _UNSURE
# Forces that follow the orientations this improbably by chance are weight.
_FELT = 1e-5


@dataclass(frozen=True, eq=False)
class Sight:
    """What the poses show: the fit with honest widths, why R_SE is refused or weak, and the parameters'."""

    fit: Fit
    grave: tuple[str, ...]
    slight: tuple[str, ...]
    parameters: Observability


def see(
    flange: Stack, inside: NDArray[np.bool_], fit: Fit, R_SE: NDArray[np.float64], noise: PoseNoise
) -> Sight:
    """Widen what the poses inside do not show of the mount, and say why."""
    R_EW, poses = flange.R_SW[inside], flange.take(inside)
    R_SW = R_SE @ R_EW
    # A fit of poses that show nothing may put gravity anywhere, and then see all from there: ask level, too.
    found = [_sines(R_SW, down) for down in (unit(fit.theta[GRAVITY]), DOWNS[0])]
    sines, axes_S = min(found, key=lambda pair: float(pair[0].sum()))
    blind = axes_S[:, sines < _BLIND]
    felt = _felt(poses, fit, noise)
    weighs = felt or blind.shape[1] == 3  # what looks alike in every pose may well be weight
    if blind.shape[1] == 3:
        fit = replace(_biases(poses, R_SW, fit, noise), covariance=np.diag(ALL_UNKNOWN**2))
    else:
        fit = _widened(fit, blind) if felt else _biases(poses, R_SW, fit, noise)
    parameters = observe(R_SW, fit.theta[GRAVITY], weighs=weighs)
    values, vectors = np.linalg.eigh(fit.covariance[ROTATION, ROTATION])
    worst, axis = float(np.sqrt(values[-1])), named_axes(R_SE.T @ vectors[:, -1:])
    known = message(
        f"The mount's rotation about {arg(axis)} is known only to {arg(np.degrees(worst)):.1f}° (1 sigma)"
    )
    if blind.shape[1]:
        grave = blind_words(R_EW, R_SE.T @ blind)
    elif not felt:
        grave = message(
            "The weight is too small to show a rotation: the forces do not follow the"
            " orientations beyond their noise. Mount a heavier load, or average each pose for"
            " longer."
        )
    elif worst > _UNSURE:
        grave = message(
            f"{arg(known)}; more than {arg(np.degrees(_UNSURE)):.0f}° is refused. For this noise the weight"
            " is too small, or the tilts are: take more poses, tilted up to 90° about two axes,"
            " or mount a heavier load."
        )
    else:
        grave = ""
    slight = (message(f"{arg(known)}."),) if worst > _SURE else ()
    return Sight(fit, (grave,) if grave else (), slight, parameters)


def _felt(inside: Stack, fit: Fit, noise: PoseNoise) -> bool:
    """Tell whether forces follow the orientations by more than chance: six parameters more than a bias."""
    flat = centred(inside.F[None])[0] / noise.sigmas[:3]
    gain = max(float((flat**2).sum() - (fit.residuals[:, :3] ** 2).sum()), 0.0)
    if np.isfinite(noise.freedom[0]) and noise.estimated:
        return bool(fdtrc(6, noise.freedom[0], gain / 6) < _FELT)
    return bool(chdtrc(6, gain) < _FELT)


def _sines(
    R_SW: NDArray[np.float64], down_W: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return how far a turn of the mount is from all that gravity and bias can do to forces.

    For a load of 1 N, the part of the forces' change with a small turn that neither a tilt of the base, as far
    as it is free, nor another bias explains: root mean square over the poses, N/rad.

    Returns
    -------
    (3,), (3, 3)
        Ascending, and in the columns the axes of the turns, S.
    """
    n = len(R_SW)
    rows = centred(np.concatenate([R_SW, -cross_matrix(R_SW @ down_W)], axis=2)[None]).reshape(-1, 6)
    square = rows.T @ rows / n
    alike = np.linalg.pinv(square[:3, :3], rcond=1e-9, hermitian=True)
    values, axes = np.linalg.eigh(square[3:, 3:] - square[3:, :3] @ alike @ square[:3, 3:])
    return np.sqrt(np.maximum(values, 0.0)), axes


def _widened(fit: Fit, blind_S: NDArray[np.float64]) -> Fit:
    """Take away what is known of turns about axes (3, k); what was known given the rotation stays."""
    C = fit.covariance
    follow = ANY_TURN * C[:, ROTATION] @ np.linalg.solve(C[ROTATION, ROTATION], blind_S)
    return replace(fit, covariance=C + follow @ follow.T)


def _biases(inside: Stack, R_SW: NDArray[np.float64], fit: Fit, noise: PoseNoise) -> Fit:
    """Fit the biases alone; the weight may be up to what would have been felt, in any direction."""
    theta = np.zeros(12)
    theta[FORCE_BIAS], theta[TORQUE_BIAS] = inside.F.mean(axis=0), inside.M.mean(axis=0)
    C = parameter_covariance(prediction_jacobian(R_SW, theta) / noise.sigmas[:, None])
    C += 8 * C[:, GRAVITY] @ np.linalg.solve(C[GRAVITY, GRAVITY], C[GRAVITY])
    # A weight that small, on any lever, is in the torques' mean, too.
    C[TORQUE_BIAS, TORQUE_BIAS] += np.linalg.norm(C[GRAVITY, GRAVITY], 2) * UNKNOWN[6] ** 2 * np.eye(3)
    return replace(fit, theta=theta, covariance=block_diag(C, ANY_TURN**2 * np.eye(3)))


# Fifteen unknowns bend to a wrong convention once some poses may be left out: so many must stay.
_MOST_OUT, _FEWEST_IN = 0.25, 6
# Poses turn about one axis if they turn about others by this share of it.
_ONE_AXIS = 0.1
# Simple mountings are at multiples of so many degrees; within _NEAR_RAD, or 2 sigma, of one it is named.
_SIMPLE, _NEAR_RAD, _TWO_SIGMA = 45.0, np.radians(2.0), float(chdtri(3, 0.0455))


def blind_words(R_EW: NDArray[np.float64], axes_E: NDArray[np.float64]) -> str:
    """Say why turns of the mount about the flange's axes (3, k) cannot be seen, and what would show them."""
    turns = Rotation.from_matrix(R_EW @ R_EW[0].T).as_rotvec()
    spread = np.degrees(
        Rotation.from_matrix(np.einsum("iab,jcb->ijac", R_EW, R_EW).reshape(-1, 3, 3)).magnitude().max()
    )
    about = np.linalg.svd(turns, compute_uv=False)
    remedy = message("Tilt the wrist up to 90° about two axes")
    if axes_E.shape[1] == 3:
        return message(
            "Gravity has nearly the same direction in the flange in every pose, so the forces do"
            f" not show how the sensor is mounted. {arg(remedy)}."
        )
    if about[1] < _ONE_AXIS * about[0]:
        why = message("all poses rotate about one axis")
        remedy = message("Tilt the wrist about another axis too")
    else:
        why = message(f"the poses, all within {arg(spread):.0f}° of one another, are too similar")
        remedy += message(", and also turn it about the vertical")
    return message(
        f"The mount's rotation about {arg(named_axes(axes_E))} cannot be distinguished from a tilt of the"
        f" base: {arg(why)}. {arg(remedy)}."
    )


def named_axes(axes_E: NDArray[np.float64]) -> str:
    """Return words for axes (3, k) of the flange."""
    vectors = [axis if axis[np.argmax(np.abs(axis))] > 0 else -axis for axis in axes_E.T]
    return message(f"the flange's ax{arg('is' if len(vectors) == 1 else 'es')} ") + " and ".join(
        "({})".format(", ".join(f"{value + 0.0:.2f}" for value in np.round(axis, 2))) for axis in vectors
    )


def simple(R_SE: NDArray[np.float64], covariance: NDArray[np.float64]) -> str:
    """Name the multiple of 45 degrees about the flange's z axis that the mounting may be."""
    angles = np.arange(-135.0, 181.0, _SIMPLE)
    R_EN = turn(np.outer(np.radians(angles), [0.0, 0.0, 1.0]))
    off = Rotation.from_matrix((R_SE @ R_EN).swapaxes(1, 2)).as_rotvec()  # a turn of S that makes it so
    nearest = int(np.argmin(np.linalg.norm(off, axis=1)))
    e, angle = off[nearest], float(np.linalg.norm(off[nearest]))
    if angle > _NEAR_RAD and e @ np.linalg.solve(covariance, e) > _TWO_SIGMA:
        return ""
    how = message("in line with the flange")
    if angles[nearest]:
        how = message(f"turned by {arg(angles[nearest]):.0f}° about the flange's z axis")
    sigma = np.degrees(largest_sigma(covariance))
    return message(
        f"Within {arg(np.degrees(angle)):.1f}° (1 sigma {arg(sigma):.1f}°) of a sensor mounted {arg(how)}."
    )


def verdict(findings: Findings, sight: Sight, agree: bool, limits: Limits) -> Verdict:
    """Combine what the parameters and the mount deserve."""
    core = judge(findings, agree, limits)
    grave = list(sight.grave)
    kept, n = int(findings.kept.sum()), len(findings.poses)
    if kept < n and (kept < _FEWEST_IN or n - kept > _MOST_OUT * n):
        few = message(
            f"Only {arg(kept)} of {arg(n)} poses agree, which can be chance with fifteen unknowns. Either"
            " most captures were disturbed (retake them), or the orientations follow another"
            " convention than declared."
        )
        grave.append(few)
    if core.level is Level.REFUSE:
        grave += core.reasons
    if findings.gravity_W @ findings.down_W < 0 and core.level is Level.REFUSE:
        left_handed = message(
            "With an unknown mount, a left-handed sensor frame (one axis with the wrong sign)"
            " also looks like gravity that points up."
        )
        grave.append(left_handed)
    if grave:
        return Verdict(Level.REFUSE, tuple(grave))
    if sight.slight:
        return Verdict(Level.USABLE, sight.slight + (core.reasons if core.level is Level.USABLE else ()))
    return core
