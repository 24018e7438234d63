"""Good, usable, or to be refused: the rule, and the words."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum
from typing import TYPE_CHECKING

import numpy as np

from pipeline.calibration.outliers import limit
from pipeline.calibration.wording import plain
from pipeline.errors import InputError

if TYPE_CHECKING:
    from pipeline.calibration.calibrate import Calibration

_CHECKED_FROM = 5  # poses: with fewer, none of them can be checked against the others
_RESTLESS = 50.0  # drift and hum make a mean several times worse than its samples promise, but not this much
_NEARLY, _DOUBTFUL = 2.0, 2  # limits, and poses: touches are rarely that gentle twice
_NAMED_FROM = 8  # poses: with fewer, leaving some out leaves little to be sure that it was the right ones


class Level(StrEnum):
    """How far a calibration can be trusted."""

    GOOD = "good"
    USABLE = "usable"
    REFUSE = "refuse"


@dataclass(frozen=True)
class Limits:
    """The rule behind the verdict.

    Attributes
    ----------
    good_error, usable_error : float
        Largest share of the calibration in the contact error, worst 1 sigma over the task, m. For comparison:
        noise of 0.05 N and 1.4 mN·m in the live wrench alone makes 0.5 mm on each axis at 10 N.
    """

    good_error: float = 0.0005
    usable_error: float = 0.0015

    def __post_init__(self) -> None:
        if not 0 < self.good_error <= self.usable_error < np.inf:
            raise InputError(
                f"Limits: give 0 < good_error <= usable_error, m, not {self.good_error} and {self.usable_error}"
            )


@dataclass(frozen=True)
class Verdict:
    """What to think of a calibration.

    Attributes
    ----------
    level : Level
    reasons : tuple of str
        Why it is not better, what weighs most first; for a good one, what makes it good.
    """

    level: Level
    reasons: tuple[str, ...]


def judge(calibration: Calibration, agree: bool, limits: Limits) -> Verdict:
    """Apply the rule.

    Refuse when the poses contradict one another, leave something undetermined that contact needs, say that
    gravity points up, or leave more than ``usable_error``. Usable when there is more than ``good_error``, or
    something that a technician should know. Good otherwise.

    Parameters
    ----------
    calibration : Calibration
        Complete but for its verdict.
    agree : bool
        Whether a majority of the poses agrees.
    limits : Limits
    """
    error = (
        f"The calibration adds up to {plain(1e3 * calibration.contact_error)} mm (1 sigma) to a contact point"
    )
    grave = _grave(calibration, agree, limits, error)
    if grave:
        return Verdict(Level.REFUSE, tuple(grave))
    slight = _slight(calibration, limits, error)
    if slight:
        return Verdict(Level.USABLE, tuple(slight))
    return Verdict(Level.GOOD, (f"{error}; {1e3 * limits.good_error:g} mm is the limit for good.",))


def _grave(calibration: Calibration, agree: bool, limits: Limits, error: str) -> list[str]:
    words = []
    if not agree:
        words.append(
            "No majority of the poses agrees with one gravity model. Either the orientations are in another"
            " convention than was said (contactbench diagnose tells), or most captures were disturbed."
        )
    if _restless(calibration):
        words.append(
            "The poses disagree by far more than the readings within each of them scatter. Either the"
            " orientations are in another convention than was said (contactbench diagnose tells), or captures"
            " were disturbed."
        )
    sight = calibration.observability
    if sight.force_rank < 6 or (sight.weighs and sight.torque_rank < 6):
        words.extend(sight.null_directions)
    elif sight.weighs and not sight.weak and _points_up(calibration):
        words.append(
            "Gravity comes out pointing up. The sensor reports the opposite sign, or the orientations are"
            " turned over: contactbench diagnose tells which."
        )
    if not words and calibration.contact_error > limits.usable_error:
        remedy = sight.weak or "Take more poses with tilts about two axes, or average each for longer."
        words.extend(sight.null_directions)
        words.append(f"{error}; more than {1e3 * limits.usable_error:g} mm is refused. {remedy}")
    return words


def _marginal(calibration: Calibration) -> int:
    """Count poses left out that a touch would have to be just strong enough for."""
    far = [max(rejection.force_sigmas, rejection.torque_sigmas) for rejection in calibration.rejected]
    return sum(deviate < _NEARLY * limit(len(calibration.poses)) for deviate in far)


def _restless(calibration: Calibration) -> bool:
    """Tell whether noise that was estimated between the poses is out of proportion to that within them."""
    noise = calibration.noise
    return noise.estimated and bool(
        (noise.least > 0).all() and (noise.sigmas > _RESTLESS * noise.least).any()
    )


def _points_up(calibration: Calibration) -> bool:
    up = calibration.gravity_W[2]
    return bool(up > 2 * np.sqrt(calibration.covariance[2, 2]))


def _slight(calibration: Calibration, limits: Limits, error: str) -> list[str]:
    words: list[str] = []
    kept, rejected = int(calibration.kept.sum()), calibration.rejected
    sight = calibration.observability
    if not sight.weighs:
        words.extend(sight.null_directions)
    if calibration.contact_error > limits.good_error:
        words.append(f"{error}; {1e3 * limits.good_error:g} mm would be good. One or two more poses help.")
    if sight.weak:
        words.append(sight.weak)
    if not calibration.plausible:
        words.append(
            f"The residuals are {np.sqrt(calibration.scatter):.1f} times what the noise given explains; every"
            " uncertainty has been widened by that. Drift, cable pull or a wrong noise figure do this."
        )
    if not calibration.noise.estimated and _marginal(calibration) >= _DOUBTFUL:
        words.append(
            f"{_marginal(calibration)} of the poses that were left out are only a little beyond the limit. If nothing"
            " touched them, the noise given is too small, and so is every uncertainty: leave it out, to have it"
            " estimated from the poses."
        )
    if kept < _CHECKED_FROM:
        words.append(
            f"With {kept} poses none can be checked against the others. Take at least {_CHECKED_FROM}."
        )
    if rejected and len(calibration.poses) < _NAMED_FROM:
        words.append(
            f"{len(rejected)} of only {len(calibration.poses)} poses had to be left out. Take them again, to"
            f" have {_NAMED_FROM} or more."
        )
    return words
