"""The mount from touches of marked points, checked on touches that the fit has not seen."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from enum import StrEnum

import numpy as np
import scipy
from numpy.typing import ArrayLike, NDArray

from contactbench.pipeline import contact
from contactbench.pipeline.contact import WrenchNoise
from contactbench.pipeline.errors import arg, join, message
from contactbench.pipeline.mesh import Probe
from contactbench.pipeline.mesh.arrays import Floats, Mask
from contactbench.pipeline.preparation.alignment.alignment import (
    Alignment,
    AlignmentError,
    AlignmentMethod,
    apply,
    check_transform,
)
from contactbench.pipeline.preparation.alignment.touches.fit import (
    MarkerModel,
    MarkerTouches,
    MountBelief,
    MountFit,
    fit_mount,
    put_on_mesh,
)

_ONE_BY_ONE = 20
_FOLDS = 10
# One-sided: the chance to prefer a mount that is no better.
_CHANCE = 0.05
_FEWEST = 6
_MOST_OUT = 0.25
# In N·mm torques are a thousand times those that the forces make, in N·cm a hundred times.
_LIKE_NMM, _LIKE_NCM = 300.0, 30.0


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
    kept: Mask  # (n,) touches that the fit to all of them used
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
        said = message("The touches reveal nothing about the mount.")
    elif n < _FEWEST:
        said = message(
            f"{arg(n)} touches cannot prove an improvement: touch at least {arg(_FEWEST)} markers, better 15."
        )
    elif kept < (1 - _MOST_OUT) * n:
        said = message(
            f"Only {arg(kept)} of {arg(n)} touches agree with one mount. Check the order of the markers,"
            " the sign of the wrenches and the mesh."
        )
    elif gain and check.p_value < _CHANCE:
        said = message(f"The fitted mount is better on held-out touches (p = {arg(check.p_value):.2g}).")
        return Advice.ADOPT, (said, check.sentence)
    else:
        why = (
            message(f"is not clearly better (p = {arg(check.p_value):.2g})")
            if gain
            else message("is no better")
        )
        return Advice.KEEP, (message(f"The fitted mount {arg(why)} on held-out touches."), check.sentence)
    return Advice.KEEP, (said,)


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
    kept: Mask  # (n,) which touches were used; the others are named in the warnings
    deviates: Floats  # (n,) how far each touch is from what the others say, in sigmas
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
        Nothing is uncertain (no noise and no placement), a mount is not rigid, a marker is off the mesh, the
        torques are in N·mm or N·cm, or most forces pull instead of push.
    """
    noise, belief = noise or WrenchNoise(), belief or MountBelief()
    starts = _starts(mounts)
    points_P, normals_P, off_mesh = put_on_mesh(touches, probe_P)
    _refuse_other_units(points_P, touches.wrenches, starts[0])
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


def _refuse_other_units(points_P: Floats, wrenches: Floats, T_SP: Floats) -> None:
    """Compare the torques with those that the forces make at the markers: a mount that is off changes that little."""
    made = np.linalg.norm(np.cross(apply(T_SP, points_P), wrenches[:, :3]), axis=1).sum()
    ratio = float(np.linalg.norm(wrenches[:, 3:], axis=1).sum() / made) if made else 1.0
    if ratio > _LIKE_NCM:
        unit, parts = ("N·mm", 1000) if ratio > _LIKE_NMM else ("N·cm", 100)
        raise AlignmentError(
            f"The torques are {arg(ratio):.0f} times what the forces make at the markers: they are in {arg(unit)}."
            f" Divide mx, my and mz by {arg(parts)}."
        )


def _refuse_pulling(pressed: Mask) -> None:
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
    centre = fit.T_SP[:3, :3] @ _home(fit) + fit.T_SP[:3, 3]
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


# ---- what touches show of the mount and what they do not, in sentences ---------------------------


# A block of the unseen space this near to containing a pure shift or a pure turn is said to contain it.
_PURE = 0.9
# This near to an axis of S, as a cosine, a direction is called by its name.
_AXIS = 0.97
# Known only to this share of the belief is worth a word.
_WEAK = 0.5
# A part of a motion under this share of it is not worth saying.
_SMALL = 0.2
# A wrench error taken for a mount error to this share cannot be told from one.
_ABSORBED = 0.9
_BIAS_N, _BIAS_NM = 0.1, 0.005


def unseen_sentences(fit: MountFit, belief: MountBelief) -> Iterator[str]:
    """Say which shifts and turns the touches do not show, why they stay, and what would show them."""
    if not fit.unseen.shape[1]:
        return
    things = unseen_motions(fit, belief)
    yield message(
        f"The touches cannot determine {arg(_listed(things))} better than the"
        f" {arg(1e3 * belief.shift):g} mm and {arg(np.degrees(belief.rotation)):g}° that the mount may"
        " be off, so it stays unchanged there. Touch markers whose normals point in other"
        " directions, or drag a little so that the forces differ in direction."
    )


def unseen_motions(fit: MountFit, belief: MountBelief) -> list[str]:
    """
    Name the motions that the touches do not show, in S, one name per motion.

    The unseen space is cut with the pure shifts and the pure turns about the touches' centroid; what is left
    of it is said as shifts combined with turns.
    """
    U = fit.unseen
    shifts, turns = _within(U, slice(0, 3)), _within(U, slice(3, 6))
    things = [message(f"a shift along {arg(axis_name(v))}") for v in shifts.T]
    things += [message(f"a turn about {arg(axis_name(v))}") for v in turns.T]
    pure = np.zeros((6, shifts.shape[1] + turns.shape[1]))
    pure[:3, : shifts.shape[1]], pure[3:, shifts.shape[1] :] = shifts, turns
    rest = U - pure @ (pure.T @ U)
    left = np.linalg.svd(rest)[0][:, : U.shape[1] - pure.shape[1]]
    things += [_mixture(v, belief) for v in left.T]
    return things


def axis_name(v: Floats) -> str:
    """Name a direction of S."""
    v = v / np.linalg.norm(v)
    k = int(np.argmax(np.abs(v)))
    if abs(v[k]) > _AXIS:
        return "xyz"[k]
    v = v if v[k] > 0 else -v
    return "({})".format(", ".join(f"{value + 0.0:.2f}" for value in np.round(v, 2)))


def weak_sentences(fit: MountFit, belief: MountBelief) -> Iterator[str]:
    """Say which combination is known worst, if it is known hardly better than before."""
    if not fit.rank:
        return
    values, vectors = np.linalg.eigh(fit.seen.T @ fit.information @ fit.seen)
    sigma = float(np.sqrt(fit.scatter / values[0]))
    if sigma < _WEAK:
        return
    motion = _mixture(sigma * (fit.seen @ vectors[:, 0]), belief)
    yield message(
        f"Weakly determined: {arg(motion)} (1 sigma), little better than before. More touches, or"
        " touches on other sides, will help."
    )


def fit_sentences(fit: MountFit, names: Sequence[str], pressed: Mask) -> Iterator[str]:
    """Name the touches that were left out, and say whether the noise given explains the others."""
    for row in np.flatnonzero(~fit.kept):
        why = message("its force pulls on the surface instead of pushing")
        if pressed[row]:
            why = message(f"it is {arg(fit.deviates[row]):.1f} sigma from where the others put it")
        yield message(
            f"{arg(names[int(row)])} was left out: {arg(why)}. Check whether another marker was touched, or the"
            " tip slipped."
        )
    if fit.scatter > 1:
        yield message(
            f"The touches scatter {arg(np.sqrt(fit.scatter)):.1f} times as much as noise and placement"
            " explain; all uncertainties have been widened accordingly. Check the compensation,"
            " the specified noise and the mesh."
        )


def bias_sentence(fit: MountFit, model: MarkerModel, belief: MountBelief) -> str:
    """Say how far an error of the calibration, common to all touches, shifts the mount."""
    shift, absorbed = bias_effect(fit, model, belief)
    parts = []
    for columns, size, what in (
        (slice(0, 3), _BIAS_N, message("a force of 0.1 N")),
        (slice(3, 6), _BIAS_NM, message("a torque of 5 mN·m")),
    ):
        moved = 1e3 * size * np.linalg.norm(shift[:3, columns], axis=0)
        worst = int(np.argmax(moved))
        unseen = ""
        if absorbed[columns][worst] > _ABSORBED:
            unseen = message(" (and would not show in the residuals)")
        millimetres = f"{moved[worst]:.2g}"
        parts.append(message(f"{arg(what)} along {arg('xyz'[worst])} by {arg(millimetres)} mm{arg(unseen)}"))
    return message(
        f"A compensation error common to all touches looks like a mount error: {arg(parts[0])},"
        f" {arg(parts[1])}. The mount cannot be better than its calibration."
    )


def bias_effect(fit: MountFit, model: MarkerModel, belief: MountBelief) -> tuple[Floats, Floats]:
    """
    Return what a wrench error common to all touches does to the mount.

    Returns
    -------
    (6, 6)
        Motion of the mount about `about_S` (m, rad) per N and N·m of error.
    (6,)
        Share of the error's square that the fit takes for mount, 0 to 1, by channel.
    """
    used = model.chosen(fit.kept)
    J = used.jacobian(fit.T_SP, fit.about_S, belief.scales).reshape(-1, 6) @ fit.seen
    B = used.bias_jacobian(fit.T_SP).reshape(-1, 6)
    y = -np.linalg.lstsq(J, B, rcond=None)[0]
    left = ((B + J @ y) ** 2).sum(axis=0)
    whole = (B**2).sum(axis=0)
    absorbed = 1 - left / np.where(whole > 0, whole, 1.0)
    return belief.scales[:, None] * (fit.seen @ y), absorbed


def implausible_start(fit: MountFit, belief: MountBelief) -> Iterator[str]:
    """Warn when the mount moved further than the belief about it makes likely."""
    moved = np.linalg.norm(fit.T_SP @ np.append(_home(fit), 1.0) - np.append(fit.about_S, 1.0))
    R = fit.T_SP[:3, :3] @ fit.start[:3, :3].T
    turn = float(np.arccos(np.clip((np.trace(R) - 1) / 2, -1, 1)))
    furthest = max(float(moved) / belief.shift, turn / belief.rotation)
    if scipy.special.chdtrc(3, furthest**2) >= 1e-3:
        return
    yield message(
        f"The touches move the mount by {arg(1e3 * moved):.1f} mm and {arg(np.degrees(turn)):.1f}°, more"
        " than its declared uncertainty. Check the first mount, the order of the markers, and"
        " the sign of the wrenches."
    )


def _home(fit: MountFit) -> Floats:
    """Return the point of P that the start puts at `about_S`."""
    home: Floats = fit.start[:3, :3].T @ (fit.about_S - fit.start[:3, 3])
    return home


def _within(U: Floats, block: slice) -> Floats:
    """Return the directions (3, k) of a block of unknowns that lie in the space U (6, m)."""
    values, vectors = np.linalg.eigh(U[block] @ U[block].T)
    return _near_axes(vectors[:, values > _PURE])


def _near_axes(space: Floats) -> Floats:
    """Return the orthonormal basis (3, k) of a space that lies nearest to the axes: easiest to say."""
    chosen: list[Floats] = []
    while len(chosen) < space.shape[1]:
        shadow = space @ space.T  # its columns: the axes' shadows on what is left of the space
        v = shadow[:, int(np.argmax(np.linalg.norm(shadow, axis=0)))]
        chosen.append(v / np.linalg.norm(v))
        left = space - np.outer(chosen[-1], chosen[-1] @ space)
        u, s, _ = np.linalg.svd(left, full_matrices=False)
        space = u * (s > 0.5)  # keeps its width, so that the loop knows how many there are
    return np.column_stack(chosen) if chosen else np.zeros((3, 0))


def _mixture(z: Floats, belief: MountBelief) -> str:
    """Say a motion about the centroid, scaled (6,), without what is small in it."""
    shift, turn = z[:3] * belief.shift, z[3:] * belief.rotation
    small = _SMALL * float(np.linalg.norm(z))
    parts = []
    if np.linalg.norm(z[:3]) > small:
        size = 1e3 * float(np.linalg.norm(shift))
        parts.append(message(f"a shift of {arg(size):.2g} mm along {arg(axis_name(shift))}"))
    if np.linalg.norm(z[3:]) > small:
        size = np.degrees(float(np.linalg.norm(turn)))
        parts.append(message(f"a turn of {arg(size):.2g}° about {arg(axis_name(turn))}"))
    return join(message(" together with "), parts)


def _listed(things: Sequence[str]) -> str:
    return things[0] if len(things) == 1 else join(message(" or "), (join(", ", things[:-1]), things[-1]))
