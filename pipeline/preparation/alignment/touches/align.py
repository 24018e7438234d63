"""The mount from touches of marked points, checked on touches that the fit has not seen."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from contactbench.pipeline.contact import WrenchNoise
from contactbench.pipeline.errors import arg, message
from contactbench.pipeline.preparation.alignment.alignment import Alignment, AlignmentMethod
from contactbench.pipeline.preparation.alignment.errors import AlignmentError
from contactbench.pipeline.preparation.alignment.rigid import check_transform
from contactbench.pipeline.preparation.alignment.touches.crossval import (
    Advice,
    CrossValidation,
    advise,
    cross_validate,
    rms,
)
from contactbench.pipeline.preparation.alignment.touches.fit import MountFit, fit_mount
from contactbench.pipeline.preparation.alignment.touches.marker import MarkerTouches, put_on_mesh
from contactbench.pipeline.preparation.alignment.touches.model import MarkerModel
from contactbench.pipeline.preparation.alignment.touches.solve import MountBelief
from contactbench.pipeline.preparation.alignment.touches.words import (
    bias_effect,
    bias_sentence,
    fit_sentences,
    implausible_start,
    unseen_motions,
    unseen_sentences,
    weak_sentences,
)

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from numpy.typing import ArrayLike, NDArray

    from contactbench.pipeline.mesh import Probe

    Floats = NDArray[np.float64]

_PLACEMENT_M = 0.0003
_LARGEST_PLACEMENT_M = 0.05


@dataclass(frozen=True, eq=False)
class TouchAlignment:
    """What touches say of the mount, and whether to believe it."""

    fitted: Alignment  # by the touches, with its covariance about the touches' centroid
    # (4, 4) the mount it started from, T_SP; of several, the one that explained the touches best
    before: Floats
    advice: Advice  # whether `fitted` predicts touches that it has not seen clearly better than `before`
    reasons: tuple[str, ...]  # why
    check: CrossValidation
    # of six: how many combinations of shift and rotation the touches show. The others stayed at
    # `before`.
    rank: int
    unseen: tuple[str, ...]  # what they do not show, a few words for each
    names: tuple[str, ...]  # of the touches
    kept: NDArray[np.bool_]  # (n,) which touches were used; the others are named in the warnings
    deviates: Floats  # (n,) how far each touch is from what the others say, in sigmas
    scatter: float  # by how much the residuals widened the covariance; 1 if noise and placement explain them
    # (6, 6) motion of the mount (m, rad, about the centroid) per N and N·m of a wrench error in every
    # touch
    bias_effect: Floats

    @property
    def T_SP(self) -> Floats:
        """(4, 4) the mount to use: the fitted one if it is to be adopted, or else the first."""
        return self.fitted.T_SP if self.advice is Advice.ADOPT else self.before


def align_touches(
    probe_P: Probe,
    touches: MarkerTouches,
    mounts: ArrayLike | Sequence[ArrayLike],
    noise: WrenchNoise | None = None,
    *,
    placement: float = _PLACEMENT_M,
    belief: MountBelief | None = None,
    progress: Callable[[float], None] | None = None,
) -> TouchAlignment:
    """
    Find the mount by touches of marked points.

    Parameters
    ----------
    probe_P : Probe
        The mesh in its own frame P, m.
    touches : MarkerTouches
        Markers in P and compensated wrenches in S.
    mounts : (4, 4) or (k, 4, 4) array_like
        T_SP to start from: the present mount, or several candidates such as those of `align_axes`.
    noise : WrenchNoise, optional
        Of each wrench, independent from touch to touch.
    placement : float
        Standard deviation of where a marker is hit, in each direction of the surface, m.
    belief : MountBelief, optional
        How far the mounts may be off.
    progress : callable, optional
        Gets the share that is done.

    Returns
    -------
    TouchAlignment

    Raises
    ------
    AlignmentError
        Nothing is uncertain (no noise and no placement), a mount is not rigid, a marker is off the mesh, or
        most forces pull instead of push.
    """
    noise, belief = noise or WrenchNoise(), belief or MountBelief()
    starts = _starts(mounts)
    points_P, normals_P, off_mesh = put_on_mesh(touches, probe_P)
    _check_noise(noise, placement)
    model = MarkerModel(points_P, normals_P, touches.wrenches, noise.covariance, placement)
    fit = fit_mount(model, starts, belief)
    pressed = model.pressed(fit.T_SP)
    _refuse_pulling(pressed)
    check = cross_validate(probe_P, model, fit, belief, progress=progress)
    advice, reasons = advise(fit, check)
    effect, _ = bias_effect(fit, model, belief)
    shared = bias_sentence(fit, model, belief)
    warnings = (
        *off_mesh,
        *fit_sentences(fit, touches.names, pressed),
        *unseen_sentences(fit, belief),
        *weak_sentences(fit, belief),
        *implausible_start(fit, belief),
    )
    return TouchAlignment(
        fitted=_alignment(fit, (check.sentence, shared), check, warnings),
        before=fit.start,
        advice=advice,
        reasons=reasons,
        check=check,
        rank=fit.rank,
        unseen=tuple(unseen_motions(fit, belief)) if fit.unseen.shape[1] else (),
        names=touches.names,
        kept=fit.kept,
        deviates=fit.deviates,
        scatter=fit.scatter,
        bias_effect=effect,
    )


def _starts(mounts: ArrayLike | Sequence[ArrayLike]) -> list[Floats]:
    try:
        array = np.asarray(mounts, dtype=np.float64)
    except (ValueError, TypeError) as error:
        raise AlignmentError(f"mounts: these are not numbers ({arg(error)}): give T_SP (4, 4).") from error
    if array.shape == (4, 4):
        array = array[None]
    if array.ndim != 3 or not len(array):
        raise AlignmentError(
            f"mounts: the shape is {arg(array.shape)}: give one T_SP (4, 4), or several (k, 4, 4)."
        )
    return [check_transform(T, f"mount {row + 1}") for row, T in enumerate(array)]


def _check_noise(noise: WrenchNoise, placement: float) -> None:
    if not 0 <= placement <= _LARGEST_PLACEMENT_M:
        raise AlignmentError(
            f"placement: {arg(placement)} m is not between 0 and 0.05: give metres, such as 0.0003."
        )
    if placement == 0 and np.linalg.eigvalsh(noise.covariance[3:, 3:])[0] <= 0:
        raise AlignmentError(
            "Without torque noise and placement error every touch would be infinitely certain:"
            " give one of them."
        )


def _refuse_pulling(pressed: NDArray[np.bool_]) -> None:
    pulling = int((~pressed).sum())
    if 2 * pulling > len(pressed):
        raise AlignmentError(
            f"{arg(pulling)} of {arg(len(pressed))} forces pull on the surface. The wrenches must be the"
            " force of the tissue on the probe: negate them if the sensor reports the reaction."
            " Otherwise the mesh is inside out, or the first mount is turned over."
        )


def _alignment(
    fit: MountFit, told: tuple[str, ...], check: CrossValidation, warnings: tuple[str, ...]
) -> Alignment:
    # The covariance is about where the touches' centroid was with the first mount: it moves with the fit.
    centre = fit.T_SP[:3, :3] @ (fit.start[:3, :3].T @ (fit.about_S - fit.start[:3, 3])) + fit.T_SP[:3, 3]
    how = (
        message(
            f"Fitted to {arg(int(fit.kept.sum()))} of {arg(len(fit.kept))} touches of marked points; they"
            f" determine {arg(fit.rank)} of the six combinations of shift and rotation."
        ),
        *told,
    )
    covariance = _about(fit.covariance, centre - fit.about_S)
    return Alignment(
        fit.T_SP, AlignmentMethod.TOUCHES, how, warnings, covariance, centre, rms(check.out_of_sample)
    )


def _about(covariance: Floats, lever: Floats) -> Floats:
    """Return a covariance of shift and rotation about a point that is `lever` further."""
    x, y, z = lever
    A = np.eye(6)
    A[:3, 3:] = -np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])  # d' = d + w x lever
    moved: Floats = A @ covariance @ A.T
    return moved
