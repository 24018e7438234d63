"""What noise, calibration and marker placement do not explain of the errors, as an error of the wrench."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from contactbench.pipeline.calibration import GravityModel
from contactbench.pipeline.calibration.model import prediction_jacobian
from contactbench.pipeline.errors import arg, message
from contactbench.pipeline.preparation.alignment.alignment import across
from contactbench.pipeline.touch_settings import DEFAULT_FORCE_N, DEFAULT_TORQUE_NM
from contactbench.pipeline.verification.causes import TouchEvidence
from contactbench.pipeline.verification.figures import ModelError

Array = NDArray[np.float64]

FEWEST_MARKERS = 6
PLACEMENT_M = 0.0003  # in each direction of the surface: nobody hits a marker better by hand
# One verification is one day and one run of the cable: nobody knows that the next ones are better than this.
LEAST = 0.4  # times the default
_LARGE = 3.0  # times the default
# A bench that is believed to be better than it is answers wrongly, and says less than it is off; one that is believed
# to be worse tells a wider spread, in which a region's odds draw contacts further to it. So it is the upper end that is
# told, but not so far up that few markers make a good bench useless.
_SAFE, _BOUND = 0.8, 0.95
_DEFAULT = np.repeat([DEFAULT_FORCE_N, DEFAULT_TORQUE_NM], 3)
_RATIO_SIGMA = np.log(3.0)  # of torque over force: markers at one lever arm do not tell it
_TURN = 0.5 * _RATIO_SIGMA * np.repeat([-1.0, 1.0], 3)
_RATIOS = np.linspace(-2.0, 2.0, 7)  # standard deviations
_SMALLEST, _LARGEST = 0.02, 8.0  # times the default; times what the errors seem to say
_STEP, _FINE = 0.5, 33  # of the logarithm of the size; ratios that are interpolated


def measure_model_error(evidence: TouchEvidence, model: GravityModel) -> ModelError | None:
    """
    Estimate how far wrenches are off beyond what is known: the covariance diag(F² I, M² I) that the errors show.

    The wrench of a touch, compared with what its marker asks for, is off by ``J dW`` along the surface; the mesh has no
    part in that. dW is the sensor's noise, what the calibration leaves (twelve numbers, the same for all touches), the
    placement of the marker, and the model's error. How much of the last is the same in all touches (a cable), the same
    in those of a marker (a posture), or each touch's own is not known: all mixtures are weighed by their likelihood. So
    touches that are off alike count as the one draw that they are, and the bound widens.

    Every size is held to be as likely as any other beforehand, the ratio of torque to force to be within a factor of
    three of the default's.

    Parameters
    ----------
    evidence : TouchEvidence
        Accepted touches.
    model : GravityModel
        With the covariance of its parameters.

    Returns
    -------
    ModelError or None
        None: fewer than six markers were touched.
    """
    if len(np.unique(evidence.markers)) < FEWEST_MARKERS:
        return None
    touched = _Touched.of(evidence, model)
    force, torque, weights = _weighed(touched)
    (likely_F, safe_F, most_F), (likely_M, safe_M, most_M) = (
        _quantiles(each, weights.sum(axis=0), (0.5, _SAFE, _BOUND))
        for each in (force * DEFAULT_FORCE_N, torque * DEFAULT_TORQUE_NM)
    )
    draws = [touched.draws(mixture) for mixture in _MIXTURES]
    return ModelError(
        force_N=max(safe_F, LEAST * DEFAULT_FORCE_N),
        torque_Nm=max(safe_M, LEAST * DEFAULT_TORQUE_NM),
        likely_force_N=likely_F,
        likely_torque_Nm=likely_M,
        most_force_N=most_F,
        most_torque_Nm=most_M,
        draws=float(draws @ weights.sum(axis=(1, 2)) / weights.sum()),
    )


def model_error_words(found: ModelError | None) -> str:
    """Return what a model error means and what to do about it; None: it was not measured."""
    if found is None:
        return message(
            f"The model error was not measured; {arg(_size(DEFAULT_FORCE_N, DEFAULT_TORQUE_NM))} are"
            f" assumed. Touch at least {arg(FEWEST_MARKERS)} markers to measure it."
        )
    force, torque = found.force_N / DEFAULT_FORCE_N, found.torque_Nm / DEFAULT_TORQUE_NM
    draws = round(found.draws)
    # Where the least value is told, the bound may lie below it.
    most = _size(max(found.most_force_N, found.force_N), max(found.most_torque_Nm, found.torque_Nm))
    size = message(
        f"Model error: {arg(_size(found.force_N, found.torque_Nm))} (95 % upper limit {arg(most)}; the"
        f" touches count as {arg(draws)} independent one{arg('s' * (draws != 1))})."
    )
    meaning = message(
        "Drift, cable, hysteresis and mount change each wrench by about this much; the bundle allows for it."
    )
    remedy = message("No action needed.")
    if max(force, torque) > _LARGE:
        remedy = message(
            "This is large: contacts are located less precisely. Find what pulls on the probe or the"
            " sensor (cable, hose, cover), warm up the sensor and tighten the mount, then"
            " recalibrate and verify again."
        )
    return message(f"{arg(size)} {arg(meaning)} {arg(remedy)}")


def _size(force: float, torque: float) -> str:
    return f"{force:.2f} N, {1e3 * torque:.1f} mN·m"


@dataclass(frozen=True)
class _Mixture:
    """Shares of the variance: each touch's own, exp(-2 `steps` `_STEP`) or 0 of it, a marker's, and common to all."""

    steps: int | None
    marker: float
    common: float

    @classmethod
    def all(cls) -> tuple[_Mixture, ...]:
        found = [cls(0, 0.0, 0.0)]
        for steps in (1, 2, 3, 5, None):
            rest = 1.0 if steps is None else 1.0 - float(np.exp(-2 * steps * _STEP))
            found += [cls(steps, rest * (1 - part), rest * part) for part in (0.0, 0.5, 1.0)]
        return tuple(found)

    def own(self, count: int) -> NDArray[np.intp]:
        """Return (count,) which of the own errors 0, exp(0), exp(`_STEP`), ... belong to sizes exp(0), ..."""
        if self.steps is None:
            return np.zeros(count, dtype=np.intp)
        return np.maximum(np.arange(count) + 1 - self.steps, 0)


_MIXTURES = _Mixture.all()


@dataclass(frozen=True, eq=False)
class _Touched:
    """Touches, those of a marker together."""

    # (n, 2, 6) how the contact moves along the surface with its wrench, in units of the default error
    J: Array
    known: Array  # (n, 2, 2) covariance by noise and placement
    columns: Array  # (n, 2, 19) J, effects of what the calibration leaves, of unit variance, and the errors
    starts: NDArray[np.intp]  # (g,) first touch of each marker

    @classmethod
    def of(cls, evidence: TouchEvidence, model: GravityModel) -> _Touched:
        rows = evidence.only(np.argsort(evidence.markers, kind="stable"))
        J = across(rows.normals) @ rows.sensitivities
        F = rows.wrenches[:, :3]
        asked = np.hstack([F, np.cross(rows.points, F)])
        errors = J @ (rows.wrenches - asked)[:, :, None]
        values, vectors = np.linalg.eigh(model.covariance)
        root = vectors * np.sqrt(np.maximum(values, 0.0))
        left = J @ prediction_jacobian(rows.R_WS.transpose(0, 2, 1), model.vector) @ root
        known = J @ rows.noise @ J.transpose(0, 2, 1) + PLACEMENT_M**2 * np.eye(2)
        starts = np.flatnonzero(np.diff(rows.markers, prepend=-1))
        return cls(J * _DEFAULT, known, np.concatenate([J * _DEFAULT, left, errors], axis=2), starts)

    @property
    def size(self) -> float:
        """Times the default that the model's error would be if nothing else made the errors."""
        return float(np.sqrt((self.columns[:, :, 18] ** 2).sum() / (self.J**2).sum()))

    def draws(self, mixture: _Mixture) -> float:
        """Return as how many independent touches these count."""
        n = len(self.J)
        shares = np.diff(self.starts, append=n) / n
        own = 1 - mixture.common - mixture.marker
        return 1 / (mixture.common + mixture.marker * float((shares**2).sum()) + own / n)

    def products(self, scales: Array) -> tuple[Array, Array]:
        """Return (k, g, 19, 19) by marker, and (k,) log det, with own errors of `scales` (k, 6)."""
        S, log = [], []
        for scale in scales:
            own = self.J * scale
            V = self.known + own @ own.transpose(0, 2, 1)
            each = self.columns.transpose(0, 2, 1) @ np.linalg.inv(V) @ self.columns
            S.append(np.add.reduceat(each, self.starts))
            log.append(np.log(np.linalg.det(V)).sum())
        return np.array(S), np.array(log)


def _weighed(touched: _Touched) -> tuple[Array, Array, Array]:
    """
    Return what sizes of a model error are worth.

    Returns
    -------
    force, torque : (r, k)
        Times their defaults.
    weights : (mixtures, r, k)
    """
    from scipy.interpolate import RectBivariateSpline

    first, last = np.log(_SMALLEST), np.log(_LARGEST * max(touched.size, _SMALLEST))
    coarse = np.arange(first, last + _STEP, _STEP)
    logs = np.empty((len(_MIXTURES), len(_RATIOS), len(coarse)))
    for column, ratio in enumerate(_RATIOS):
        scales = np.exp(coarse[:, None] + _TURN * ratio)
        S, log_det = touched.products(np.vstack([np.zeros(6), scales]))
        for row, mixture in enumerate(_MIXTURES):
            own = mixture.own(len(coarse))
            logs[row, column] = _shared(S[own], scales, mixture) - 0.5 * log_det[own]
    # Smooth in the logarithms of size and ratio: few of them tell it everywhere.
    ratios, sizes = np.linspace(_RATIOS[0], _RATIOS[-1], _FINE), np.linspace(coarse[0], coarse[-1], 4 * _FINE)
    fine = np.array([RectBivariateSpline(_RATIOS, coarse, each)(ratios, sizes) for each in logs])
    fine += sizes - 0.5 * ratios[:, None] ** 2  # what is even in the size grows with it in its logarithm
    skew = 0.5 * _RATIO_SIGMA * ratios[:, None]
    return np.exp(sizes - skew), np.exp(sizes + skew), np.exp(fine - fine.max())


def _shared(S: Array, scales: Array, mixture: _Mixture) -> Array:
    """Return the log likelihood (k,) of errors of `scales` (k, 6), without log det of the touches' own part."""
    # What the touches of a marker share is integrated out, six numbers for each; then what all share, eighteen.
    log_det = np.zeros(len(S))
    if mixture.marker:
        S, by_marker = _integrated(S, scales[:, None] * np.sqrt(mixture.marker))
        log_det += by_marker.sum(axis=1)
    sigmas = np.hstack([scales * np.sqrt(mixture.common), np.ones((len(S), 12))])
    S, by_all = _integrated(S.sum(axis=1), sigmas)
    return -0.5 * np.asarray(log_det + by_all + S[:, 18, 18])


def _integrated(S: Array, sigmas: Array) -> tuple[Array, Array]:
    """Return what is left of products (..., 19, 19) without the first unknowns ~ N(0, sigmas²), and a log det."""
    count = sigmas.shape[-1]
    A = S[..., :count] * sigmas[..., None, :]
    inner = np.eye(count) + A[..., :count, :] * sigmas[..., :, None]
    return S - A @ np.linalg.solve(inner, A.swapaxes(-1, -2)), np.linalg.slogdet(inner)[1]


def _quantiles(values: Array, weights: Array, levels: tuple[float, ...]) -> list[float]:
    order = np.argsort(values, axis=None)
    whole = weights.ravel()[order]
    below = np.cumsum(whole) - 0.5 * whole
    return [float(each) for each in np.interp(levels, below / whole.sum(), values.ravel()[order])]
