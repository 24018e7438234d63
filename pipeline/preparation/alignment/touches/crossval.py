"""Whether the fitted mount is better than the first one, on touches that it has not seen."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum
from typing import TYPE_CHECKING

import numpy as np

from contactbench.pipeline import contact
from contactbench.pipeline.errors import arg, message
from contactbench.pipeline.preparation.alignment.touches.fit import fit_mount

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from numpy.typing import NDArray

    from contactbench.pipeline.mesh import Probe
    from contactbench.pipeline.preparation.alignment.touches.fit import MountFit
    from contactbench.pipeline.preparation.alignment.touches.model import MarkerModel
    from contactbench.pipeline.preparation.alignment.touches.solve import MountBelief

    Floats = NDArray[np.float64]

_ONE_BY_ONE = 20
_FOLDS = 10
# One-sided: the chance to prefer a mount that is no better.
_CHANCE = 0.05
_FEWEST = 6
_MOST_OUT = 0.25


class Advice(StrEnum):
    """What to do with the fitted mount."""

    ADOPT = "adopt"
    KEEP = "keep"


@dataclass(frozen=True, eq=False)
class CrossValidation:
    """
    Contact errors at the markers: as fitted, left out, and with the first mount.

    Each touch of a fold is left out, the mount fitted to the others, and the solver asked where the wrench
    that was left out touches the mesh with that mount. Where it has no answer, the marker's tangent plane
    stands in for the mesh, so that a bad mount cannot look good by missing the probe.
    """

    # in_sample, out_of_sample, before: (n,) distance from the marker, m: with the fit to all touches,
    # with the fit that did not see the touch, and with the first mount
    in_sample: Floats
    out_of_sample: Floats
    before: Floats
    bound: Floats  # (n,) root mean square distance that noise and placement alone make with the true mount, m
    kept: NDArray[np.bool_]  # (n,) touches that the fit to all of them used
    missed: int  # touches left out for which the solver had no answer
    folds: int
    # chance of so clear a gain over the first mount if there were none (Wilcoxon's signed ranks,
    # one-sided)
    p_value: float

    @property
    def ratio(self) -> float:
        """Out-of-sample error over what noise and placement alone make; root mean squares. 1 is perfect."""
        return rms(self.out_of_sample) / rms(self.bound)

    @property
    def sentence(self) -> str:
        """The figures, in one sentence."""
        before, after, inside = (
            message(f"{arg(1e3 * rms(e)):.2f} mm rms (median {arg(1e3 * float(np.median(e))):.2f})")
            for e in (self.before, self.out_of_sample, self.in_sample)
        )
        words = message(
            f"On held-out touches the fitted mount errs by {arg(after)}, the first mount by {arg(before)};"
            f" on its own touches the fit errs by {arg(inside)}; noise and placement alone give"
            f" {arg(1e3 * rms(self.bound)):.2f}."
        )
        if not self.kept.all():
            after, before = (f"{1e3 * rms(e[self.kept]):.2f}" for e in (self.out_of_sample, self.before))
            words += message(
                f" Without the left-out touches these are {arg(after)} and {arg(before)} mm rms."
            )
        return words


def cross_validate(
    probe_P: Probe,
    model: MarkerModel,
    fit: MountFit,
    belief: MountBelief,
    *,
    progress: Callable[[float], None] | None = None,
) -> CrossValidation:
    """
    Predict every touch by a mount fitted without it.

    Up to 20 touches are left out one by one, more in ten folds. Touches that the fit left out are judged like
    all others: what its own outlier test dislikes must not improve its score.

    Parameters
    ----------
    probe_P : Probe
        In P.
    model : MarkerModel
    fit : MountFit
        To all touches.
    belief : MountBelief
    progress : callable, optional
        Gets the share that is done.
    """
    judge = _Judge(probe_P, model, fit.start)
    n = len(model)
    folds = n if n <= _ONE_BY_ONE else _FOLDS
    out, missed = np.empty(n), 0
    for fold in range(folds):
        left = np.arange(fold, n, folds)  # neighbours in the file are often neighbours on the probe
        others = np.ones(n, dtype=bool)
        others[left] = False
        T_SP = fit_mount(model.chosen(others), [fit.start], belief).T_SP
        out[left], misses = judge.errors(T_SP, left)
        missed += misses
        if progress is not None:
            progress((fold + 1) / folds)
    every = np.arange(n)
    inside, _ = judge.errors(fit.T_SP, every)
    before, _ = judge.errors(fit.start, every)
    bound = np.sqrt(np.trace(model.sigmas(fit.T_SP), axis1=1, axis2=2))
    return CrossValidation(inside, out, before, bound, fit.kept, missed, folds, _chance(before - out))


def advise(fit: MountFit, check: CrossValidation) -> tuple[Advice, tuple[str, ...]]:
    """Say whether to adopt the fitted mount, and why."""
    n, kept = len(fit.kept), int(fit.kept.sum())
    # Ranks bear a touch of the wrong marker; the root mean square does not, and is taken without it.
    gain = rms(check.out_of_sample[fit.kept]) < rms(check.before[fit.kept])
    if fit.rank == 0:
        return Advice.KEEP, (message("The touches reveal nothing about the mount."),)
    if n < _FEWEST:
        return Advice.KEEP, (
            message(
                f"{arg(n)} touches cannot prove an improvement: touch at least {arg(_FEWEST)} markers, better 15."
            ),
        )
    if kept < (1 - _MOST_OUT) * n:
        return Advice.KEEP, (
            message(
                f"Only {arg(kept)} of {arg(n)} touches agree with one mount. Check the order of the markers,"
                " the sign of the wrenches and the mesh."
            ),
        )
    if not gain or check.p_value >= _CHANCE:
        why = (
            message(f"is not clearly better (p = {arg(check.p_value):.2g})")
            if gain
            else message("is no better")
        )
        return Advice.KEEP, (message(f"The fitted mount {arg(why)} on held-out touches."), check.sentence)
    return Advice.ADOPT, (
        message(f"The fitted mount is better on held-out touches (p = {arg(check.p_value):.2g})."),
        check.sentence,
    )


def rms(errors: Floats) -> float:
    """Return the root mean square."""
    return float(np.sqrt((errors**2).mean()))


class _Judge:
    """Contact errors at markers for any mount, by one solver."""

    def __init__(self, probe_P: Probe, model: MarkerModel, T_SP: Floats) -> None:
        # To move the wrench into P is the same as to move the mesh into S, and the solver is built once.
        # What is uncertain of a wrench is taken as it is with the first mount.
        W = wrench_transform(T_SP)
        noise, error = (
            contact.WrenchNoise(0.0, 0.0, W @ each @ W.T)
            for each in (model.covariance, contact.TouchModel().model_error.covariance)
        )
        self._solver = contact.ContactSolver(probe_P, noise, model=contact.TouchModel(model_error=error))
        self._model = model

    def errors(self, T_SP: Floats, rows: Sequence[int] | NDArray[np.intp]) -> tuple[Floats, int]:
        """Return the distance (k,) from the marker of each touch, m, and how many had no answer."""
        model = self._model.chosen(np.asarray(rows))
        wrenches_P = np.ascontiguousarray(model.wrenches @ wrench_transform(T_SP).T)
        batch = self._solver.locate_batch(wrenches_P)
        answered = np.array(batch.accepted)
        distance = np.linalg.norm(batch.points - self._model.points_P[rows], axis=1)
        errors: Floats = np.where(answered, distance, model.plane_errors(T_SP))
        return errors, int((~answered).sum())


def wrench_transform(T_SP: Floats) -> Floats:
    """Return the (6, 6) matrix that takes wrenches about S's origin in S to P's origin in P."""
    R_PS, p = T_SP[:3, :3].T, T_SP[:3, 3]
    cross = np.array([[0.0, -p[2], p[1]], [p[2], 0.0, -p[0]], [-p[1], p[0], 0.0]])
    W = np.zeros((6, 6))
    W[:3, :3] = W[3:, 3:] = R_PS
    W[3:, :3] = -R_PS @ cross
    return W


def _chance(gains: Floats) -> float:
    """Return the one-sided probability of gains so clear, if there were none."""
    from scipy.stats import wilcoxon

    gains = gains[gains != 0]
    if not len(gains):
        return 1.0
    return float(
        wilcoxon(gains, alternative="greater", method="exact" if len(gains) <= 50 else "approx").pvalue
    )
