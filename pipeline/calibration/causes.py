"""What is found behind the residuals, in words."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np
from scipy.spatial.transform import Rotation

from contactbench.pipeline.calibration import nuisance
from contactbench.pipeline.calibration.comparison import NOISE, PLAIN, Candidate, CauseComparison
from contactbench.pipeline.calibration.diagnosis.diagnose import FEWEST_POSES, MOST_POSES, diagnose
from contactbench.pipeline.calibration.diagnosis.explain import NONE
from contactbench.pipeline.calibration.diagnosis.hypothesis import AS_DECLARED
from contactbench.pipeline.calibration.diagnosis.prior import Prior
from contactbench.pipeline.calibration.model import PoseNoise
from contactbench.pipeline.calibration.orientation import plain
from contactbench.pipeline.calibration.poses import named
from contactbench.pipeline.errors import arg, join, message

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from contactbench.pipeline.calibration.calibrate import Findings
    from contactbench.pipeline.calibration.diagnosis.diagnose import RawOrientations
    from contactbench.pipeline.calibration.poses import PoseSample, Stack
    from contactbench.pipeline.calibration.reml import NoisePrior

_TOLD = 0.01  # probability from which a cause is listed
_LIKELY = 0.95  # a mistake that overrules what the residuals say by themselves
_OFF = float(np.log(2.0))  # of the logarithm of a figure that is called wrong
_HOUR = 3600.0  # s


@dataclass(frozen=True)
class Cause:
    """What may be behind the residuals."""

    # plain, noise, drift, rezero, cable or mount; a convention that the diagnosis found; or none of those
    # known
    key: str
    odds: float  # Its probability among all causes that were compared, 0 to 1
    sentence: str  # What it would mean, with its size and the remedy
    believed: bool  # The evidence is strong: the calibration rests on it

    @property
    def diagnosed(self) -> bool:
        """Whether the diagnosis of conventions found it."""
        own = {PLAIN, NOISE, nuisance.DRIFT, nuisance.REZERO, nuisance.CABLE, nuisance.MOUNT}
        return self.key not in own


def causes(poses: Sequence[PoseSample], compared: CauseComparison, told: Candidate) -> tuple[Cause, ...]:
    """Return what the comparison found, the most probable first.

    Parameters
    ----------
    poses : sequence of PoseSample
    compared : CauseComparison
        Of the same.
    told : Candidate
        The cause that is believed; it is listed in any case.
    """
    shares: dict[str, float] = {}
    first: dict[str, Candidate] = {}
    for candidate, probability in zip(compared.candidates, compared.probabilities.tolist(), strict=True):
        key = _key(candidate)
        shares[key] = shares.get(key, 0.0) + probability
        first.setdefault(key, candidate)
    found = [
        Cause(key, min(share, 1.0), _sentence(first[key], poses, compared), key == _key(told))
        for key, share in shares.items()
        if share > _TOLD or key == _key(told)
    ]
    return tuple(sorted(found, key=lambda cause: -cause.odds))


def convention_cause(findings: Findings, prior: NoisePrior, raw: RawOrientations | None) -> Cause | None:
    """Return the mistaken convention that explains poses better than what they were said to be, if there is one.

    Parameters
    ----------
    findings : Findings
    prior : NoisePrior
        With the noise as it was given.
    raw : RawOrientations or None
        The numbers behind the orientations.
    """
    poses = findings.poses
    if not FEWEST_POSES <= len(poses) <= MOST_POSES:
        return None
    noise = None
    if prior.sigmas is not None:
        noise = PoseNoise(prior.sigmas[:3], prior.sigmas[3:], orientation=prior.orientation)
    known = Prior(down_W=(findings.down_W[0], findings.down_W[1], findings.down_W[2]))
    found = diagnose(poses, noise, prior=known, raw=raw)
    key = NONE if found.none_known else found.best.hypothesis
    told = {cause.key for cause in findings.causes if cause.believed}
    if found.consistent or key in {AS_DECLARED, *told} or (key == NONE and told - {PLAIN, NOISE}):
        return None
    odds = min(max(float(found.odds.get(key, 0.0)), 0.0), 1.0)
    return Cause(key, odds, found.sentence, odds >= _LIKELY)


def overruled(causes: tuple[Cause, ...], by: Cause) -> tuple[Cause, ...]:
    """Return causes with one more that speaks for the same residuals: what it leaves of them is theirs."""
    others = (
        replace(cause, odds=cause.odds * (1 - by.odds), believed=cause.believed and not by.believed)
        for cause in causes
    )
    return tuple(sorted((by, *others), key=lambda cause: -cause.odds))


def _key(candidate: Candidate) -> str:
    doubted = candidate.key == PLAIN and candidate.prior.sigmas is not None and not candidate.prior.believed
    return NOISE if doubted else candidate.key


def _sentence(candidate: Candidate, poses: Sequence[PoseSample], compared: CauseComparison) -> str:
    fit, arrays = candidate.noisy.fit, compared.poses
    match _key(candidate):
        case nuisance.DRIFT:
            return _drift(candidate, arrays)
        case nuisance.REZERO:
            return _rezero(candidate, poses, compared)
        case nuisance.CABLE:
            return message(
                f"A pull of up to {arg(_sizes(fit.offsets))} changes with the orientation, but not as a"
                " weight does: a cable or a hose, or a sensor whose axes differ in gain. Loosen"
                " the cables and hoses, fix them to the flange, and retake the poses."
            )
        case nuisance.MOUNT:
            turn = Rotation.from_matrix(fit.mount).as_rotvec()
            angle = float(np.linalg.norm(turn))
            axis = ", ".join(f"{value + 0.0:.1f}" for value in (turn / max(angle, 1e-12)).round(1))
            return message(
                f"The sensor seems to be turned by {arg(np.degrees(angle)):.2g}° about ({arg(axis)}) from"
                " its declared mounting: with that corrected, the force residuals fall from"
                f" {arg(plain(_left(compared.plain, arrays)))} to {arg(plain(_left(candidate, arrays)))} N."
                " Calibrate with --estimate-mount, or correct the mounting."
            )
        case "noise":
            given = candidate.prior.sigmas
            factors = (candidate.noisy.noise.sigmas / given)[[0, 3]] if given is not None else np.ones(2)
            scatter, said = candidate.noisy.noise.orientation, candidate.prior.orientation
            if said and not candidate.prior.guessed and abs(np.log(scatter / said)) > _OFF:
                return message(
                    f"The orientations scatter by {arg(np.degrees(scatter)):.2g}°, not by the specified"
                    f" {arg(np.degrees(said)):.2g}°. All uncertainties are computed from the scatter of"
                    " the poses."
                )
            return message(
                f"The residuals are {arg(plain(factors[0]))} times (forces) and {arg(plain(factors[1]))}"
                " times (torques) what the specified noise explains. All uncertainties are"
                " computed from the scatter of the poses."
            )
        case _:
            return message("Bias, weight and noise alone explain the poses.")


def _left(candidate: Candidate, arrays: Stack) -> float:
    """Return the root mean square of the forces' residuals, N."""
    left = candidate.noisy.fit.left(arrays, candidate.terms)
    return float(np.sqrt((left[:, :3] ** 2).sum(axis=1).mean()))


def _drift(candidate: Candidate, arrays: Stack) -> str:
    fit = candidate.noisy.fit
    whole = candidate.terms.columns[np.argmin(arrays.moments)] @ fit.added
    rate = ""
    if arrays.duration is not None:
        F, M = (np.linalg.norm(half) for half in np.split(fit.added[:6] * _HOUR / arrays.duration, 2))
        rate = message(
            f", {arg(plain(float(F)))} N and {arg(plain(1e3 * float(M)))} mN·m per hour at the end"
        )
    return message(
        f"The bias drifts by {arg(_sizes(whole[None]))} from the first pose to the last{arg(rate)}. The"
        " drift has been removed, and the bias is that at the end of the session. Let the sensor"
        " warm up, and recalibrate before you rely on it."
    )


def _rezero(candidate: Candidate, poses: Sequence[PoseSample], compared: CauseComparison) -> str:
    moments = {
        each.moment: probability
        for each, probability in zip(compared.candidates, compared.probabilities.tolist(), strict=True)
        if each.key == nuisance.REZERO
    }
    total = sum(moments.values())
    likely = [moment for moment, share in moments.items() if share > 0.1 * total] or [candidate.moment]
    names = join(" or ", (named(poses, _at(compared.poses, moment)) for moment in sorted(likely)))
    return message(
        f"The sensor's zero jumped by {arg(_sizes(candidate.noisy.fit.added[None]))} before {arg(names)}, as"
        " after a re-zero. The bias is that of the poses since then. Do not zero the sensor while"
        " taking poses."
    )


def _at(arrays: Stack, moment: float) -> int:
    later = np.where(arrays.moments >= moment, arrays.moments, np.inf)
    return int(np.argmin(later))


def _sizes(wrenches: NDArray[np.float64]) -> str:
    F = float(np.linalg.norm(wrenches[:, :3], axis=1).max())
    M = float(np.linalg.norm(wrenches[:, 3:], axis=1).max())
    return message(f"{arg(plain(F))} N and {arg(plain(1e3 * M))} mN·m")
