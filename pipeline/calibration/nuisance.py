"""Nuisance terms: what may be in the readings beside bias, weight and noise, as one list.

Drift and re-zeros change the bias with time; their columns are zero at the session's end, so that the bias beside
them is the one that the sensor has afterwards. A cable, a turned mount, a wrong channel and crosstalk depend on the
orientation.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import product

import numpy as np
from numpy.typing import NDArray

from contactbench.pipeline.calibration.model import CENTRE_OF_MASS, GRAVITY, Fit, Terms, cross_matrix, predict
from contactbench.pipeline.calibration.poses import Stack
from contactbench.pipeline.errors import message

PLAIN, NOISE, DRIFT, REZERO, CABLE, MOUNT = "plain", "noise", "drift", "rezero", "cable", "mount"
CHANNEL, CROSSTALK, CLIPPED, FILTER = "channel", "crosstalk", "clipped", "filter"

# The largest that is thought of: N and N·m.
_FORCE, _TORQUE = 20.0, 1.0
_CHANNELS = np.repeat([_FORCE, _TORQUE], 3)
# What a channel may make of the weight: a share of it, or m for a torque; of one channel, which may be dead, or of all.
_ALONE, _MIXED = np.repeat([1.0, 0.1], 3), np.repeat([0.25, 0.025], 3)
# A turn by more, rad, that leaves less than this share of the squares, is looked for from there.
_SLIGHT, _FAR_BETTER = 0.15, 0.5
_SAME_WRENCH = 1e-9  # N, N·m
_SHORT = 0.01  # m: a centre of mass that is nearer says nothing of a torque's gain
_BENT = 1 / 3  # a bend in the drift is one drift in three
# A re-zero needs so many poses on either side: a single one cannot be told from a bumped pose.
FEWEST_BESIDE = 2


@dataclass(frozen=True)
class Words:
    """How to speak of a cause."""

    title: str  # Beside others
    reading: str  # Completes "with ..."
    remedy: str  # What to do, a sentence
    telling: str  # What tells it from others that explain the poses as well, a sentence


_ADD_WEIGHT = message("Hang a known weight on the tool: only an error of the sensor grows with it.")
_AT_THE_END = message("Repeat the first pose at the end: only a bias that changes reads differently there.")
_WARM_UP = message("Let the sensor warm up, then retake the poses without a long pause.")
WORDS = {
    DRIFT: Words(message("drifting zero"), message("a bias that changes evenly"), _WARM_UP, _AT_THE_END),
    REZERO: Words(
        message("re-zero"),
        message("a new bias from there on"),
        message(
            "Calibrate with only the poses before it or only those after it, and stop the sensor"
            " from re-zeroing itself."
        ),
        _AT_THE_END,
    ),
    CABLE: Words(
        message("a pulling cable"),
        message("that pull taken off"),
        message("Loosen the cables and hoses, fix them to the flange, and retake the poses."),
        message("Retake the poses with the cables off: only a cable's part goes."),
    ),
    MOUNT: Words(
        message("a turned mount"),
        message("that rotation"),
        message("Calibrate with --estimate-mount, or correct the mounting."),
        message("Press along one axis of the flange: a turned mount shows in the force's direction."),
    ),
    CHANNEL: Words(
        message("one wrong channel"),
        message("that channel corrected"),
        message("Check this channel's plug and scale, and have the sensor recalibrated."),
        _ADD_WEIGHT,
    ),
    CROSSTALK: Words(
        message("crosstalk"),
        message("the crosstalk taken out"),
        message("Retake the poses with the cables off; if it stays, have the sensor recalibrated."),
        _ADD_WEIGHT,
    ),
    CLIPPED: Words(
        message("a channel at its limit"),
        message("the readings at the limit left open"),
        message("Choose a larger range, check this channel's offset, and retake the poses."),
        message("Press on this side: a channel at its limit reads no more."),
    ),
    FILTER: Words(
        message("a filter that has not settled"),
        message("that share of the pose before taken off"),
        message("Wait longer in each pose or set a faster filter, and retake the poses with the cables off."),
        message("Hold one pose for longer: only a filter's reading creeps."),
    ),
}


@dataclass(frozen=True, eq=False)
class Beside:
    """One thing that may be in the readings."""

    key: str
    share: float  # How often it is met on a bench
    terms: Terms
    moment: float = 0.0  # Of a re-zero
    channel: int = 0  # That is wrong, from 0
    # Logarithm of how much rarer readings that are alike to the last digit are by chance
    coincidence: float = 0.0

    def response(self, fit: Fit) -> NDArray[np.float64]:
        """Return what the sensor adds (6, 6) to a wrench: of a torque's own by its gain, of the rest by the forces."""
        C = np.zeros((6, 6))
        if self.key not in {CHANNEL, CROSSTALK}:
            return C
        # Columns are linear in the weight: what they are at the three unit weights.
        u = fit.R_SW @ fit.theta[GRAVITY]
        C[:, :3] = np.linalg.lstsq(u, fit.offsets, rcond=None)[0].T
        own = cross_matrix(fit.theta[CENTRE_OF_MASS])
        size = (own**2).sum(axis=1)
        gains = (C[3:, :3] * own).sum(axis=1) / np.maximum(size, _SHORT**2)
        C[3:, 3:] = np.diag(gains)
        C[3:, :3] -= gains[:, None] * own
        return C


def beside(poses: Stack, down_W: NDArray[np.float64], theta: NDArray[np.float64]) -> list[Beside]:
    """Return all that may be in the readings of poses with a load of about `theta` (12,)."""
    moments, g_W = rezero_moments(poses), theta[GRAVITY]
    return [
        Beside(DRIFT, 0.05 * (1 - _BENT), drift(poses)),
        Beside(DRIFT, 0.05 * _BENT, drift(poses, 2)),
        Beside(CABLE, 0.03, cable(poses, down_W)),
        turned_mount(poses),
        Beside(CROSSTALK, 0.02, crosstalk(poses, g_W)),
        *(Beside(CHANNEL, 0.01 / 6, channel(poses, g_W, k), channel=k) for k in range(6)),
        *(Beside(CHANNEL, 0.01 / 6, gain(poses, theta, k), channel=k) for k in range(6)),
        Beside(FILTER, 0.02, unsettled(poses)),
        *clipped(poses),
        *(Beside(REZERO, 0.03 / len(moments), rezero(poses, t), moment=t) for t in moments.tolist()),
    ]


def drift(poses: Stack, power: int = 1) -> Terms:
    """Return a drift of each channel: linear in time, or with a bend (`power` 2), as while a sensor warms up."""
    before = poses.moments - 1
    columns = [before[:, None, None] ** degree * np.eye(6) for degree in range(1, power + 1)]
    return Terms(np.concatenate(columns, axis=2), np.tile(_CHANNELS, power))


def rezero(poses: Stack, moment: float) -> Terms:
    """Return another bias in all poses before `moment`."""
    earlier = (poses.moments < moment).astype(np.float64)
    return Terms(earlier[:, None, None] * np.eye(6), _CHANNELS)


def rezero_moments(poses: Stack) -> NDArray[np.float64]:
    """Return the moments of the poses before which the sensor may have been re-zeroed."""
    moments = np.unique(poses.moments)
    return moments[FEWEST_BESIDE : max(len(moments) - FEWEST_BESIDE + 1, FEWEST_BESIDE)]


def cable(poses: Stack, down_W: NDArray[np.float64]) -> Terms:
    """Return the torque of a pull that stays in the room: ``p x R_SW c`` for horizontal c; its force is weight."""
    level = np.linalg.svd(down_W[None])[2][1:]
    columns = np.zeros((len(poses), 6, 6))
    columns[:, 3:] = np.concatenate([-cross_matrix(poses.R_SW @ axis_W) for axis_W in level], axis=2)
    return Terms(columns, np.full(6, _TORQUE))


def channel(poses: Stack, g_W: NDArray[np.float64], index: int) -> Terms:
    """Return a channel that shows the weight in a way of its own: a wrong gain, dead, or with others in it."""
    columns = np.zeros((len(poses), 6, 3))
    columns[:, index] = poses.R_SW @ g_W
    return Terms(columns, np.full(3, _ALONE[index]))


def gain(poses: Stack, theta: NDArray[np.float64], index: int) -> Terms:
    """Return a channel that shows another share of its own weight: the one wrong channel that one number tells."""
    columns = np.zeros((len(poses), 6, 1))
    columns[:, index, 0] = predict(poses.R_SW, np.where(np.arange(12) % 6 < 3, theta, 0.0))[:, index]
    return Terms(columns, np.ones(1))


def crosstalk(poses: Stack, g_W: NDArray[np.float64]) -> Terms:
    """Return all that is linear in the weight u in S but no weight: with a symmetric or antisymmetric matrix times u.

    In the forces a multiple of u is weight, in the torques an antisymmetric matrix is the centre of mass. A cable
    that follows the wrist does the same.
    """
    u = poses.R_SW @ g_W
    symmetric = _symmetric(u)
    columns = np.zeros((len(u), 6, 8 + 6))
    columns[:, :3, :8] = np.concatenate([symmetric[:, :, :5], cross_matrix(u)], axis=2)
    columns[:, 3:, 8:] = symmetric
    return Terms(columns, np.repeat(_MIXED[[0, 3]], [8, 6]))


def unsettled(poses: Stack) -> Terms:
    """Return a share of the pose before that is still in a reading."""
    order = np.argsort(poses.moments)
    before = order[np.maximum(np.argsort(order) - 1, 0)]
    return Terms((poses.wrenches[before] - poses.wrenches)[:, :, None], np.array([0.5]))


def clipped(poses: Stack) -> Iterator[Beside]:
    """Yield channels whose largest or smallest reading stands in several poses: what they should read is open there."""
    for channel, sign in product(range(6), (1, -1)):
        w = sign * poses.wrenches[:, channel]
        values = np.unique(w)
        at_limit = np.flatnonzero(w == values[-1])
        if not 2 <= len(at_limit) <= len(w) / 2:
            continue
        columns = np.zeros((len(w), 6, len(at_limit)))
        columns[at_limit, channel, range(len(at_limit))] = 1.0
        alike = (len(at_limit) - 1) * float(np.log(np.ptp(w) / np.diff(values).min()))
        terms = Terms(columns, np.full(len(at_limit), _CHANNELS[channel]))
        yield Beside(CLIPPED, 0.01 / 12, terms, channel=channel, coincidence=alike)


def _symmetric(u: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return S_k u (n, 3, 6) for a basis S_k of the symmetric matrices; the last is a multiple of 1."""
    x, y, z = u.T
    nought = np.zeros_like(x)
    columns = [(y, x, nought), (z, nought, x), (nought, z, y), (x, -y, nought), (x, y, -2 * z), (x, y, z)]
    return np.stack([np.stack(column, axis=1) for column in columns], axis=2)


def turned_mount(poses: Stack) -> Beside:
    """Return a turn of the sensor on its mount."""
    return Beside(MOUNT, 0.03, Terms(np.zeros((len(poses), 6, 0)), np.zeros(0), turns=True))


def straight(poses: Stack, down_W: NDArray[np.float64]) -> NDArray[np.float64] | None:
    """Return the turn (3, 3) of the sensor with which forces follow gravity far better, if that is not near none.

    The rotation between two sets of vectors is that of Kabsch (1976).
    """
    F, u = (each - each.mean(axis=0) for each in (poses.F, poses.R_SW @ down_W))
    U, _, Vt = np.linalg.svd(F.T @ u)
    U[:, 2] *= np.linalg.det(U @ Vt)
    turn = U @ Vt
    weight = float((F * u).sum()), float((F * (u @ turn.T)).sum())
    size = max(float((u**2).sum()), 1e-12)
    without, with_turn = (float((F**2).sum()) - max(each, 0.0) ** 2 / size for each in weight)
    far = np.arccos(np.clip((np.trace(turn) - 1) / 2, -1, 1)) > _SLIGHT
    return turn if far and with_turn < _FAR_BETTER * without else None


def taken_off(offsets: NDArray[np.float64]) -> str:
    """
    Return what was taken off the poses' readings: DRIFT or REZERO, or nothing.

    After a re-zero there are two biases, in a drift one for each pose.

    Parameters
    ----------
    offsets : (n, 6)
        As `Findings.offsets`.
    """
    if not offsets.any():
        return ""
    first = offsets[np.argmax(np.abs(offsets).sum(axis=1))]
    two = [np.abs(offsets - one).max(axis=1) < _SAME_WRENCH for one in (first, np.zeros(6))]
    return REZERO if np.logical_or(*two).all() else DRIFT
