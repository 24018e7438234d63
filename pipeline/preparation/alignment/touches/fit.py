"""The mount that touches show: robust start, wrong touches named, what cannot be seen left as it was."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np
from scipy.special import chdtrc, chdtri

from contactbench.pipeline.preparation.alignment.rigid import apply
from contactbench.pipeline.preparation.alignment.touches.solve import MountProblem, loss, minimise

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from contactbench.pipeline.preparation.alignment.touches.model import MarkerModel
    from contactbench.pipeline.preparation.alignment.touches.solve import MountBelief

    Floats = NDArray[np.float64]

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
    kept: NDArray[np.bool_]  # (n,) touches that were used
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


def _deviates(problem: MountProblem, T_SP: Floats, seen: Floats, kept: NDArray[np.bool_]) -> Floats:
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


def _sound(deviates: Floats) -> NDArray[np.bool_]:
    """Return which touches (n,) agree; if most of them scatter more than they should, the limit is wider."""
    limit = float(chdtri(2, _FALSE_ALARM / len(deviates)))
    usual = float(np.median(deviates**2)) / _MEDIAN
    return np.asarray(deviates**2 <= limit * (usual if usual > _RESTLESS else 1.0))


def _summary(
    problem: MountProblem,
    part: MountProblem,
    T_SP: Floats,
    seen: Floats,
    unseen: Floats,
    kept: NDArray[np.bool_],
) -> MountFit:
    chi_square = float(part.squares(T_SP).sum())
    freedom = 2 * len(part.model) - seen.shape[1]
    doubtful = freedom > 0 and chdtrc(freedom, chi_square) < _DOUBT
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
