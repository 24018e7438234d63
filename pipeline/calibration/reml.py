"""How large the noise is: restricted maximum likelihood (REML) of its three sizes, from the poses themselves.

A pose's reading scatters for two reasons: the noise of the sensor's mean, and the error of the orientation, which
moves the weight in it. With G_i the change of reading i with a turn of the sensor,

    V_i = diag(f_F sigma_F², f_M sigma_M²) + s² G_i G_i'

Unknown are the two factors f, where the noise was not given or is doubted, and s, of which a good guess is known.
Restricted likelihood counts the residuals' degrees of freedom, which plain likelihood does not: with ten poses
that would make the noise a tenth too small. Steps use the average information (Gilmour, Thompson & Cullis 1995).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy.special import chdtrc, chdtri

from contactbench.pipeline.calibration.model import (
    ALL,
    Fit,
    PoseNoise,
    Terms,
    jacobian,
    maximise,
    nothing_beside,
    parameter_covariance,
    predict,
    turn_jacobian,
    two_stage,
    whitener,
)
from contactbench.pipeline.calibration.poses import PoseSample, Stack
from contactbench.pipeline.errors import InputError, arg
from contactbench.pipeline.settings import ORIENTATION_NOISE_DEG

USUAL_ORIENTATION = float(np.radians(ORIENTATION_NOISE_DEG["robot"]))
# Standard deviations of logarithms: of a guess, and of a figure that is doubted. Noise that is not known is guessed
# from what a plain fit leaves: without any guess, orientations can take all of the scatter of a few poses.
_GUESSED, _DOUBTED = np.log(3.0), np.log(2.0)
_NO_ORIENTATION = 0.5  # rad: beyond, the orientations say nothing
_WRONG = 0.1  # share of noise figures that are not right
# Below what any converter resolves; keeps noise-free data from dividing by zero.
LEAST = np.repeat([1e-6, 1e-8], 3)
_SLIGHTEST = 1e-4  # of the guess: orientations without any noise
_WORST = float(np.log(np.radians(20.0)))  # beyond, there is no orientation

_NEWTON_STEPS, _HALVINGS = 15, 6
_LONGEST_STEP = 1.5  # step, as a logarithm
_CONVERGED = 0.005  # of the log likelihood that a step may gain
_WHOLE = np.eye(6)
# Unknowns beside the twelve may be of any size: shares of their widths, each as likely as another.
_SIZES = 4.0 ** -np.arange(8.0)


@dataclass(frozen=True, eq=False)
class NoisePrior:
    """What is known of the noise before."""

    sigmas: NDArray[np.float64] | None  # (6,) of a pose's mean, N and N·m; None: nothing is known
    least: NDArray[np.float64]  # (6,) what the scatter within the poses says it is at least
    orientation: float  # 1 sigma of the poses' orientations, rad
    guessed: bool  # `orientation` is a guess, which may be wrong by a factor of three
    believed: bool = True  # What was given is right

    @classmethod
    def of(
        cls, poses: Sequence[PoseSample], noise: PoseNoise | None, orientation: float | None
    ) -> NoisePrior:
        """Return what a caller knows: noise and the orientations' sigma, rad, each None if nobody said."""
        if orientation is not None and not 0 <= orientation < _NO_ORIENTATION:
            raise InputError(
                f"orientation_sigma is {arg(orientation)} rad: give at least 0 and less than"
                f" {arg(_NO_ORIENTATION):g} rad, not degrees"
            )
        known = [
            np.concatenate([pose.force_sd, pose.torque_sd]) / np.sqrt(pose.count)
            for pose in poses
            if pose.force_sd is not None and pose.torque_sd is not None
        ]
        # The standard error of the poses' means if their samples were independent.
        least = np.median(known, axis=0) if known else np.zeros(6)
        given = None if noise is None or noise.estimated else np.maximum(noise.sigmas, LEAST)
        if noise is not None and noise.estimated:
            least = np.maximum(least, noise.least)
        guess = USUAL_ORIENTATION if orientation is None else orientation
        return cls(given, least, guess, orientation is None)

    @property
    def doubted(self) -> NoisePrior:
        """The same, with what was given taken for a guess."""
        return replace(self, believed=False)

    @property
    def _spreads(self) -> NDArray[np.float64]:
        """(3,) standard deviations of the logarithms of the three sizes: 0 if known."""
        doubt = 0.0 if self.believed else _DOUBTED
        noise = _GUESSED if self.sigmas is None else doubt
        return np.array([noise, noise, (_GUESSED if self.guessed else doubt) if self.orientation else 0.0])


@dataclass(frozen=True, eq=False)
class NoisyFit:
    """A fit with its noise."""

    fit: Fit
    noise: PoseNoise
    V: NDArray[np.float64]  # (n, 6, 6) covariance of each pose's reading
    # Logarithm of the likelihood of the readings, over all sizes of the noise and of the unknowns
    log_evidence: float


class _Sizes:
    """The three sizes, as logarithms: of the factors on force and torque, and of the orientations' noise."""

    def __init__(self, prior: NoisePrior, base: NDArray[np.float64]) -> None:
        self._prior, self._base = prior, base
        self.spreads = prior._spreads
        self.free = self.spreads > 0
        self.middle = np.array([0.0, 0.0, np.log(max(prior.orientation, 1e-300))])
        self.values = self.middle.copy()

    def begin(self, noise: PoseNoise) -> None:
        """Start where another fit ended."""
        there = np.log(np.append((noise.sigmas / self._base)[[0, 3]], max(noise.orientation, 1e-300)))
        self.values = np.where(self.free, there, self.values)

    def sigmas(self, values: NDArray[np.float64]) -> NDArray[np.float64]:
        sigmas = self._base * np.repeat(np.exp(values[:2]), 3)
        return np.asarray(np.maximum(sigmas, self._least), dtype=np.float64)

    @property
    def _least(self) -> NDArray[np.float64]:
        known = self._prior.sigmas is not None
        return np.zeros(6) if known else np.maximum(self._prior.least, LEAST)

    def at_least(self, values: NDArray[np.float64]) -> NDArray[np.bool_]:
        """(2,) whether the noise of forces, and of torques, stands at its lower bound."""
        lowest = self.sigmas(values) <= self._least * (1 + 1e-9)
        return np.asarray(lowest.reshape(2, 3).all(axis=1), dtype=np.bool_)

    def orientation(self, values: NDArray[np.float64]) -> float:
        return float(np.exp(values[2])) if self._prior.orientation else 0.0

    def covariances(self, values: NDArray[np.float64], GG: NDArray[np.float64]) -> NDArray[np.float64]:
        V: NDArray[np.float64] = self.orientation(values) ** 2 * GG
        V[:, range(6), range(6)] += self.sigmas(values) ** 2
        return V

    def changes(self, values: NDArray[np.float64], GG: NDArray[np.float64]) -> NDArray[np.float64]:
        """(k, n, 6, 6) change of the covariances with each free size."""
        sigmas = self.sigmas(values)
        changed = np.zeros((3, len(GG), 6, 6))
        alive = 2 * sigmas**2 * (sigmas > self._least * (1 + 1e-9))
        changed[0, :, range(3), range(3)] = alive[:3, None]
        changed[1, :, range(3, 6), range(3, 6)] = alive[3:, None]
        changed[2] = 2 * self.orientation(values) ** 2 * GG
        return changed[self.free]

    @property
    def pull(self) -> NDArray[np.float64]:
        """(k,) information of what is known before on each free size."""
        return np.asarray(self.spreads[self.free] ** -2.0, dtype=np.float64)

    def log_prior(self, values: NDArray[np.float64]) -> float:
        off = (values - self.middle)[self.free] / self.spreads[self.free]
        return float(-0.5 * (off**2 + np.log(2 * np.pi * self.spreads[self.free] ** 2)).sum())


def fit_with_noise(
    poses: Stack,
    prior: NoisePrior,
    terms: Terms | None = None,
    *,
    free: NDArray[np.bool_] = ALL,
    start: NoisyFit | None = None,
    kept: float = 1.0,
) -> NoisyFit:
    """Fit poses together with the size of their noise.

    Parameters
    ----------
    poses : Stack
    prior : NoisePrior
    terms : Terms, optional
        What else may be in the readings.
    free : (12,) bool
        Parameters that are fitted; the others are zero.
    start : NoisyFit, optional
        Where to begin: a fit with the same terms, of some of the poses.
    kept : float
        Share of all poses that these are, if they were kept for having small residuals: their scatter then
        says less than the whole noise, by a factor that is known for Gaussian noise.
    """
    terms = terms or nothing_beside(len(poses))
    if start is None:
        theta, added, mount = np.where(free, two_stage(poses), 0.0), np.zeros(len(terms.widths)), np.eye(3)
        sizes = _Sizes(prior, _base(poses, prior, theta, terms))
    else:
        theta, added, mount = np.where(free, start.fit.theta, 0.0), start.fit.added, start.fit.mount
        sizes = _Sizes(prior, start.noise.sigmas if prior.sigmas is None else prior.sigmas)
        sizes.begin(start.noise)
    for _ in range(_NEWTON_STEPS):
        G = turn_jacobian(mount @ poses.R_SW, theta)
        V = sizes.covariances(sizes.values, G @ G.swapaxes(1, 2))
        fit = maximise(poses, V, theta, free, terms, added, mount)
        theta, added, mount = fit.theta, fit.added, fit.mount
        if not sizes.free.any():
            break
        sizes.values, gain = _improved(sizes, _Left.of(poses, fit, kept))
        if gain < _CONVERGED:
            break
    return _result(poses, prior, sizes, fit)


def _base(poses: Stack, prior: NoisePrior, theta: NDArray[np.float64], terms: Terms) -> NDArray[np.float64]:
    """Return the noise (6,) that factors are counted in: as given, or roughly what is left."""
    if prior.sigmas is not None:
        return prior.sigmas
    freedom = max(3.0 * len(poses) - 6.0, 1.0)
    squares = (poses.wrenches - predict(poses.R_SW, theta)) ** 2
    rough = np.repeat(np.sqrt(squares.reshape(-1, 2, 3).sum(axis=(0, 2)) / freedom), 3)
    rough = np.maximum(rough, np.maximum(prior.least, LEAST))
    if len(terms.scale) > len(theta):
        fit = maximise(poses, rough, theta, ALL, terms)
        squares = fit.left(poses, terms) ** 2
        rough = np.repeat(np.sqrt(squares.reshape(-1, 2, 3).sum(axis=(0, 2)) / freedom), 3)
    at_least: NDArray[np.float64] = np.maximum(rough, np.maximum(prior.least, LEAST))
    return at_least


@dataclass(frozen=True, eq=False)
class _Left:
    """What a fit leaves, before it is weighed: all that the likelihood of the noise needs."""

    raw: NDArray[np.float64]  # (n, 6) residuals, N and N·m
    J: NDArray[np.float64]  # (n, 6, p), per unit of the parameters' widths
    GG: NDArray[np.float64]  # (n, 6, 6)

    @classmethod
    def of(cls, poses: Stack, fit: Fit, kept: float) -> _Left:
        raw = fit.left(poses, fit.terms)
        G = turn_jacobian(fit.R_SW, fit.theta)
        J = jacobian(fit.R_SW, fit.theta, fit.free, fit.terms) * fit.terms.scale
        return cls(raw / np.sqrt(truncation(kept)), J, G @ G.swapaxes(1, 2))

    def whitened(
        self, W: NDArray[np.float64]
    ) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
        """Return residuals (n, 6), Jacobian (n, 6, p) and the parameters' information (p, p)."""
        r, J = (W @ self.raw[..., None])[..., 0], W @ self.J
        flat = J.reshape(-1, J.shape[2])
        return r, J, flat.T @ flat

    def value(self, sizes: _Sizes, values: NDArray[np.float64]) -> float:
        """Return the restricted log likelihood, up to a constant."""
        W = whitener(sizes.covariances(values, self.GG))
        r, _, information = self.whitened(W)
        seen = np.maximum(np.linalg.eigvalsh(information), 1.0)
        whole = np.log(W[:, range(6), range(6)]).sum() - 0.5 * (np.vdot(r, r) + np.log(seen).sum())
        return float(whole) + sizes.log_prior(values)

    def slope(
        self, sizes: _Sizes, values: NDArray[np.float64]
    ) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Return gradient (k,) and average information (k, k) of the free sizes."""
        W = whitener(sizes.covariances(values, self.GG))
        r, J, information = self.whitened(W)
        C = parameter_covariance(J, np.ones(len(information)))
        changed = W @ sizes.changes(values, self.GG) @ W.swapaxes(1, 2)
        z = (changed @ r[..., None])[..., 0]  # (k, n, 6)
        free = _WHOLE - J @ C @ J.swapaxes(1, 2)  # (n, 6, 6) what the parameters leave of each pose
        trace = (changed * free).sum(axis=(1, 2, 3))
        flat = z.reshape(len(z), -1)
        gradient = 0.5 * (flat @ r.ravel() - trace) - sizes.pull * (values - sizes.middle)[sizes.free]
        Jz = flat @ J.reshape(-1, J.shape[2])
        average = 0.5 * (flat @ flat.T - Jz @ C @ Jz.T)
        return gradient, average + np.diag(sizes.pull)


def _improved(sizes: _Sizes, left: _Left) -> tuple[NDArray[np.float64], float]:
    """Return the three sizes (3,) after a step uphill, and how much of the log likelihood there is to gain."""
    values, before = sizes.values, left.value(sizes, sizes.values)
    gradient, information = left.slope(sizes, values)
    free = np.linalg.solve(information + 1e-9 * np.eye(len(gradient)), gradient)
    gain = 0.5 * float(free @ gradient)
    step = np.zeros(3)
    step[sizes.free] = np.clip(free, -_LONGEST_STEP, _LONGEST_STEP)
    for halving in range(_HALVINGS):
        there = values + 0.5**halving * step
        there[2] = np.clip(there[2], sizes.middle[2] + np.log(_SLIGHTEST), max(_WORST, sizes.middle[2]))
        if left.value(sizes, there) > before:
            return there, gain
    return values, 0.0


def _result(poses: Stack, prior: NoisePrior, sizes: _Sizes, fit: Fit) -> NoisyFit:
    left = _Left.of(poses, fit, 1.0)
    values = sizes.values
    V = sizes.covariances(values, left.GG)
    _, _, information = left.whitened(whitener(V))
    freedom, spread = (np.inf, np.inf), 0.0
    if sizes.free.any():
        _, average = left.slope(sizes, values)
        values_of, axes = np.linalg.eigh(average)
        of_sizes = axes / np.maximum(values_of, sizes.pull.min()) @ axes.T  # no less than was known before
        both = np.full(3, np.inf)
        # Where the orientations make most of the scatter, what acts along gravity is the noise's alone.
        both[sizes.free] = np.maximum(0.5 / np.diag(of_sizes), len(poses) - 4.0)
        both[:2][sizes.at_least(values)] = np.inf  # what the samples within the poses say is known
        freedom = (float(both[0]), float(both[1]))
        spread = 0.5 * float(np.linalg.slogdet(2 * np.pi * of_sizes)[1])
    sigmas = sizes.sigmas(values)
    noise = PoseNoise(
        sigmas[:3],
        sigmas[3:],
        estimated=prior.sigmas is None,
        freedom=freedom,
        least=prior.least,
        orientation=sizes.orientation(values),
    )
    # Over the sizes of the noise the likelihood is nearly Gaussian; over the unknowns it is exactly so.
    whole = left.value(sizes, values) + 0.5 * np.log(np.maximum(np.linalg.eigvalsh(information), 1.0)).sum()
    evidence = whole + spread + _of_parameters(fit, information) - 3 * len(poses) * np.log(2 * np.pi)
    # Noise figures are wrong in a known share of all cases.
    log_share = np.log(1 - _WRONG if prior.believed else _WRONG)
    return NoisyFit(fit, noise, V, float(evidence + log_share))


def _of_parameters(fit: Fit, information: NDArray[np.float64]) -> float:
    """Return the log likelihood over all parameters, less that at its maximum."""
    k = len(information) - 12
    own = information[:12, :12]
    of_twelve = -0.5 * float(np.log(np.maximum(np.linalg.eigvalsh(own), 1.0)).sum())
    if not k:
        return of_twelve
    across = information[12:, :12]
    known = information[12:, 12:] - across @ np.linalg.pinv(own, rcond=1e-12, hermitian=True) @ across.T
    return of_twelve + over_unknowns(fit.beside / fit.terms.scale[12:], known)


def over_unknowns(found: NDArray[np.float64], known: NDArray[np.float64]) -> float:
    """Return the log of the mean of exp(-(x - found)' known (x - found) / 2) over unknowns x of any size.

    Parameters
    ----------
    found : (k,)
        In units of their widths.
    known : (k, k)
        Information on them, in the same unit.
    """
    values, axes = np.linalg.eigh(known)
    values = np.maximum(values, 0.0)
    wide = 1 + _SIZES[:, None] ** 2 * values
    each = -0.5 * (values * (found @ axes) ** 2 / wide + np.log(wide)).sum(axis=1)
    top = float(each.max())
    return top + float(np.log(np.exp(each - top).mean()))


def truncation(kept: float) -> float:
    """Return the variance of the nearest share `kept` of Gaussian six-vectors, over that of all of them."""
    radius = chdtri(6, 1 - kept)
    return float(1 - chdtrc(8, radius)) / kept
