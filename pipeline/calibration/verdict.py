"""Good, usable, or to be refused: the rule, and the words."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum
from typing import TYPE_CHECKING

import numpy as np

from contactbench.pipeline.calibration.number_text import plain
from contactbench.pipeline.calibration.outliers import limit
from contactbench.pipeline.calibration.poses import named, stack
from contactbench.pipeline.errors import InputError, arg, join, message

if TYPE_CHECKING:
    from contactbench.pipeline.calibration.calibrate import Findings
    from contactbench.pipeline.calibration.causes import Cause

_CHECKED_FROM = 5  # poses: with fewer, none of them can be checked against the others
_RESTLESS = 50.0  # drift and hum make a mean several times worse than its samples promise, but not this much
_WORTH_A_WORD = 0.2  # probability from which a cause that is not believed is told
_LEVEL, _SURELY = 1.0, 4.0  # degrees to which bases are level, and standard deviations
_ABSURD = 5.0  # times the noise given: no wrong figure, but something that nobody knows
_HARDLY = 1.3  # times the noise given: nobody knows it better
_LEAN = np.radians(60.0)  # bases are mounted in multiples of 90 degrees
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
                f"Limits: give 0 < good_error <= usable_error, m, not {arg(self.good_error)} and"
                f" {arg(self.usable_error)}"
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


def judge(findings: Findings, agree: bool, limits: Limits) -> Verdict:
    """Apply the rule.

    Refuse when the poses contradict one another, leave something undetermined that contact needs, say that
    gravity points up, or leave more than ``usable_error``. Usable when there is more than ``good_error``, or
    something that a technician should know. Good otherwise.

    Parameters
    ----------
    findings : Findings
    agree : bool
        Whether a majority of the poses agrees.
    limits : Limits
    """
    error = message(
        f"The calibration adds up to {arg(plain(1e3 * findings.contact_error))} mm (1 sigma) to a contact point"
    )
    grave = _grave(findings, agree, limits, error)
    if grave:
        return Verdict(Level.REFUSE, (*_found(findings), *grave))
    slight = _slight(findings, limits, error)
    if slight:
        return Verdict(Level.USABLE, (*slight, *_possible(findings)))
    good = message(
        f"{arg(error)}; the limit for good is {arg(1e3 * limits.good_error):g} mm. No action needed."
    )
    return Verdict(Level.GOOD, (good, *_possible(findings)))


def _found(findings: Findings) -> list[str]:
    """Return the cause that is believed, beside plain noise and noise that is less than was given."""
    return [
        cause.sentence
        for cause in findings.causes
        if cause.believed and cause.key != "plain" and not _harmless(findings, cause)
    ]


def _harmless(findings: Findings, cause: Cause) -> bool:
    """Tell whether a figure was given that is merely careful: the noise is less, or hardly more."""
    return cause.key == "noise" and max(findings.noise_factor) < _HARDLY


def _possible(findings: Findings) -> list[str]:
    """Return causes that the evidence is too weak for, as what they are."""
    return [
        cause.sentence  # a diagnosis says itself how probable it is
        if cause.diagnosed
        else message(f"Possible, with a probability of {arg(100 * cause.odds):.0f} %: {arg(cause.sentence)}")
        for cause in findings.causes
        if not cause.believed and cause.key != "plain" and cause.odds > _WORTH_A_WORD
    ] + [
        *(cause.sentence for cause in findings.causes if cause.believed and _harmless(findings, cause)),
        *_tilted(findings),
    ]


def _tilted(findings: Findings) -> list[str]:
    """Say that gravity surely points aside: the sensor cannot tell a tilted base from a pull that never changes."""
    g, C, down = findings.gravity_W, findings.covariance[:3, :3], findings.down_W
    aside = g - (g @ down) * down
    size = float(np.linalg.norm(aside))
    angle = float(np.degrees(np.arctan2(size, g @ down)))
    sigma = float(np.sqrt(aside @ C @ aside)) / max(size, 1e-12)
    if angle < _LEVEL or size < _SURELY * sigma or not findings.observability.weighs:
        return []
    sentence = message(
        f"Gravity is {arg(angle):.1f}° off vertical: the base is not level, or something such as a"
        " cable pulls sideways all the time and counts as weight. Check the base and the cables."
    )
    return [sentence]


def _grave(findings: Findings, agree: bool, limits: Limits, error: str) -> list[str]:
    words = []
    told = any(cause.believed and cause.key not in {"plain", "noise"} for cause in findings.causes)
    if not agree:
        words.append(
            message(
                "No majority of the poses fits one gravity model. Either the orientations follow"
                " another convention than declared (run contactbench calibrate diagnose), or most"
                " captures were disturbed."
            )
        )
    if _restless(findings):
        words.append(
            message(
                "The poses disagree far more than the readings scatter within each of them. Either"
                " the orientations follow another convention than declared (run contactbench"
                " calibrate diagnose), or captures were disturbed."
            )
        )
    elif min(findings.noise_factor) > _ABSURD and not told:
        words.append(
            message(
                f"The residuals are {arg(max(findings.noise_factor)):.0f} times what the specified noise"
                " explains. Check the convention of the orientations (contactbench calibrate"
                " diagnose), and that nothing touched the tool."
            )
        )
    if same_readings(findings):
        words.append(
            message(
                "Every pose has exactly the same reading although the tool was turned: the sensor is"
                " not responding. Check its cable and its power."
            )
        )
    sight = findings.observability
    if sight.force_rank < 6 or (sight.weighs and sight.torque_rank < 6):
        words.extend(sight.null_directions)
    elif sight.weighs and not sight.weak and (off := _off_down(findings)):
        words.append(
            message(
                f"Gravity points {arg(off):.0f}° away from down. Either the sensor reports the opposite"
                " sign, the orientations are turned (run contactbench calibrate diagnose), or the"
                " robot is not mounted upright: then give the direction of down (--down)."
            )
        )
    if not words and findings.contact_error > limits.usable_error:
        remedy = sight.weak or message("Take more poses tilted about two axes, or average each for longer.")
        if findings.model_error > 0.5 * findings.contact_error:
            remedy = message("More poses will not help: the error is not noise.")
        words.extend(sight.null_directions)
        words.append(
            message(
                f"{arg(error)}; more than {arg(1e3 * limits.usable_error):g} mm is refused. {arg(remedy)}"
            )
        )
    return words


def same_readings(findings: Findings) -> bool:
    """Tell whether the sensor read the same in every pose, to the last digit, though it stood differently."""
    readings = np.array([[*pose.force, *pose.torque] for pose in findings.poses])
    return bool((np.ptp(readings, axis=0) == 0).all()) and findings.observability.force_rank == 6


def _restless(findings: Findings) -> bool:
    """Tell whether noise that was estimated between the poses is out of proportion to that within them."""
    noise = findings.noise
    return noise.estimated and bool(
        (noise.least > 0).all() and (noise.sigmas > _RESTLESS * noise.least).any()
    )


def _off_down(findings: Findings) -> float:
    """Return by how many degrees gravity surely points away from down; 0 if a tilted base explains it."""
    g, down = findings.gravity_W, findings.down_W
    sideways = np.eye(3) - np.outer(down, down)
    along = float(g @ down) + 2 * float(np.sqrt(down @ findings.covariance[:3, :3] @ down))
    angle = float(np.degrees(np.arctan2(np.linalg.norm(sideways @ g), g @ down)))
    return angle if along < np.linalg.norm(g) * np.cos(_LEAN) else 0.0


def _slight(findings: Findings, limits: Limits, error: str) -> list[str]:
    words: list[str] = []
    kept, rejected = int(findings.kept.sum()), findings.rejected
    sight = findings.observability
    if not sight.weighs:
        words.extend(sight.null_directions)
    if findings.contact_error > limits.good_error:
        helps = findings.model_error < 0.5 * findings.contact_error
        good = 1e3 * limits.good_error
        words.append(
            message(f"{arg(error)}; {arg(good):g} mm would be good. One or two more poses will help.")
            if helps
            else (
                message(
                    f"{arg(error)}; {arg(good):g} mm would be good. The error is not noise, so more poses"
                    " will not help."
                )
            )
        )
    latest = int(np.argmax(stack(findings.poses).moments))
    if findings.deviates[latest].max() >= limit(len(findings.poses)):
        words.append(
            message(
                f"{arg(named(findings.poses, latest).capitalize())}, the last one, disagrees: it was"
                " bumped, or the sensor's zero jumped before it and the bias is wrong. Take one or"
                " two more poses to find out which."
            )
        )
    if sight.weak:
        words.append(sight.weak)
    words.extend(_found(findings))
    if kept < _CHECKED_FROM:
        words.append(
            message(
                f"With {arg(kept)} poses, none can be checked against the others. Take at least {arg(_CHECKED_FROM)}."
            )
        )
    if rejected and len(findings.poses) < _NAMED_FROM:
        names = join(", ", (named(findings.poses, each.index) for each in rejected))
        again = message("Retake it") if len(rejected) == 1 else message("Retake them")
        words.append(
            message(f"Left out: {arg(names)}. {arg(again)}, to have {arg(_NAMED_FROM)} poses or more.")
        )
    return words
