"""The convention check: are poses as they were declared, or which single mistake explains them.

Each mistake that people make leaves a fingerprint. Every one is fitted and ranked by the likelihood of the
recorded numbers; where two readings leave the same residuals, what is known of any load decides (gravity points
down, the centre of mass is on the tool's side). Nothing is ever corrected silently.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any

import numpy as np
from scipy.special import chdtrc

from pipeline.calibration.diagnosis.evidence import Evidence, weigh
from pipeline.calibration.diagnosis.explain import FELT, NOTHING, TIE, Case, Context, Words, decided_by
from pipeline.calibration.diagnosis.hypotheses import AS_DECLARED, Hypothesis, RawOrientations, hypotheses
from pipeline.calibration.diagnosis.prior import Prior
from pipeline.calibration.model import STANDARD_GRAVITY
from pipeline.calibration.poses import PoseError, PoseSample, stack
from pipeline.errors import InputError

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    from numpy.typing import NDArray

    from pipeline.calibration.fit import PoseNoise

__all__ = ["Diagnosis", "Finding", "Prior", "RawOrientations", "diagnose"]

FEWEST_POSES, MOST_POSES = 4, 200

# Noise that was given is often too small by half: drift, hysteresis, cables. Beyond this factor residuals are
# called unexplained, once chance makes them in one clean set out of a thousand.
_TOLERATED, _CHANCE = 2.0, 1e-3
# Without noise: residuals are called noise up to this share of the weight, and of its torque at 0.1 m.
_SHARE, _LEVER = 0.2, 0.1
_ANY_NOISE = np.repeat([0.1, 0.003], 3)  # a unit to count in where the noise is not known


@dataclass(frozen=True, eq=False)
class Finding:
    """What the poses say of one way to read them.

    Attributes
    ----------
    hypothesis : str
        Its key.
    title : str
        For tables.
    log_likelihood, log_prior, score : float
        Natural logarithms; score is their sum.
    margin : float
        Score over that of the data as declared.
    residual : float
        Root mean square of the residuals, in standard deviations: of the noise that was given, else of that
        which the best reading leaves.
    sentence : str
    evidence : float
        Likelihood and knowledge of the load, without the preference for what was declared.
    priors : mapping of str to float
        Logarithms of what each piece of knowledge says.
    gravity_W : (3,)
        Weight of the load, W, N, so read.
    centre_of_mass_S : (3,)
        S, m, so read.
    left_out : tuple of int
        Indices of poses that were taken for bumped.
    """

    hypothesis: str
    title: str
    log_likelihood: float
    log_prior: float
    score: float
    margin: float
    residual: float
    sentence: str
    evidence: float
    priors: Mapping[str, float]
    gravity_W: NDArray[np.float64]
    centre_of_mass_S: NDArray[np.float64]
    left_out: tuple[int, ...]

    @property
    def mass(self) -> float:
        """Of the load, kg, so read."""
        return float(np.linalg.norm(self.gravity_W)) / STANDARD_GRAVITY


@dataclass(frozen=True, eq=False)
class Diagnosis:
    """What explains the poses.

    Attributes
    ----------
    ranking : tuple of Finding
        All readings, the most probable first.
    decided_by : str
        What sets the best reading apart from all others: "residuals"; "prior: " and which, where some others
        leave the same residuals; or "nothing": then it stands for all that are `tied`.
    tied : tuple of str
        Keys of readings that explain the data as well as the best: within a factor of exp(2).
    consistent : bool
        The data are consistent as they are.
    explained : bool
        The best reading leaves residuals that chance explains.
    sentence : str
        All of that for a technician, with what to do.
    not_testable : tuple of str
        What these data do not tell, and what it would take.
    """

    ranking: tuple[Finding, ...]
    decided_by: str
    tied: tuple[str, ...]
    consistent: bool
    explained: bool
    sentence: str
    not_testable: tuple[str, ...]
    _poses: tuple[PoseSample, ...] = field(repr=False)
    _hypotheses: Mapping[str, Hypothesis] = field(repr=False)
    _jumps: Mapping[str, NDArray[np.float64]] = field(repr=False)

    @property
    def best(self) -> Finding:
        """The most probable reading."""
        return self.ranking[0]

    def finding(self, hypothesis: str) -> Finding:
        """Return what was found of one reading.

        Raises
        ------
        InputError
            There is none of that key.
        """
        for finding in self.ranking:
            if finding.hypothesis == hypothesis:
                return finding
        keys = ", ".join(finding.hypothesis for finding in self.ranking)
        raise InputError(f"there is no hypothesis {hypothesis!r}; those that were tested: {keys}.")

    def corrected(self, hypothesis: str) -> tuple[PoseSample, ...]:
        """Return the poses as they are if a hypothesis holds.

        Parameters
        ----------
        hypothesis : str
            Key of a finding. After a re-zero the later poses get the bias of the earlier ones.

        Raises
        ------
        InputError
            There is none of that key.
        """
        self.finding(hypothesis)
        chosen, jump = self._hypotheses[hypothesis], self._jumps[hypothesis]
        force, torque = chosen.factor[:3], chosen.factor[3:]
        return tuple(
            replace(
                pose,
                R_WS=chosen.R_WS[index],
                force=pose.force * force - later * jump[:3],
                torque=pose.torque * torque - later * jump[3:],
                force_sd=None if pose.force_sd is None else pose.force_sd * np.abs(force),
                torque_sd=None if pose.torque_sd is None else pose.torque_sd * np.abs(torque),
            )
            for index, pose in enumerate(self._poses)
            for later in [float(0 < chosen.change <= index)]
        )

    def to_json(self) -> dict[str, Any]:
        """Return plain data for ``--json``; lengths in m, forces in N."""
        return {
            "sentence": self.sentence,
            "best": self.best.hypothesis,
            "consistent": self.consistent,
            "explained": self.explained,
            "decided_by": self.decided_by,
            "tied": list(self.tied),
            "not_testable": list(self.not_testable),
            "ranking": [
                {
                    **{key: value for key, value in vars(finding).items() if key != "priors"},
                    "priors": dict(finding.priors),
                    "gravity_W": finding.gravity_W.tolist(),
                    "centre_of_mass_S": finding.centre_of_mass_S.tolist(),
                    "left_out": list(finding.left_out),
                    "mass": finding.mass,
                }
                for finding in self.ranking
            ],
        }


def diagnose(
    poses: Sequence[PoseSample],
    noise: PoseNoise | None = None,
    *,
    prior: Prior | None = None,
    raw: RawOrientations | None = None,
    progress: Callable[[int, int], None] | None = None,
) -> Diagnosis:
    """Tell whether still, contact-free poses are as declared, or which single convention mistake explains them.

    Parameters
    ----------
    poses : sequence of PoseSample
        Four or more, as declared; eight or more let bumped ones be told from mistakes. With tilts about two
        axes.
    noise : PoseNoise, optional
        Of a pose's mean in true N and N·m, from the sensor's data sheet or an earlier session: noise taken
        from these very recordings would be in their units, right or wrong. Left out, or estimated: each
        reading is granted the noise that suits it, and units can only be told by the mass and the centre of
        mass that they make.
    prior : Prior, optional
        What is known of the load.
    raw : RawOrientations, optional
        The numbers behind the orientations. Without them only mistakes that an earlier program may have made
        are tested, on angles recovered from R_WS.
    progress : callable, optional
        Called with steps done and steps in all.

    Raises
    ------
    PoseError
        There are too few or too many poses.
    InputError
        `raw` are not the numbers behind the poses.
    """
    if not FEWEST_POSES <= len(poses) <= MOST_POSES:
        raise PoseError(
            f"{len(poses)} poses: the convention check needs {FEWEST_POSES} to {MOST_POSES}. Take some with"
            " different tilts, about two axes; of a long recording, give only where the sensor stood still."
        )
    prior = prior or Prior()
    known = noise is not None and not noise.estimated
    sigmas = noise.sigmas if noise is not None and known else _ANY_NOISE
    arrays = stack(poses)
    candidates, not_testable = hypotheses(arrays.R_SW.transpose(0, 2, 1), raw)
    doubt = float(np.log(prior.noise_factor)) if known else np.inf
    evidence = weigh(candidates, arrays, sigmas, doubt, progress)
    context = Context(tuple(poses), sigmas, known, prior)
    return _diagnosis(_cases(candidates, evidence, context), context, not_testable)


def _cases(candidates: Sequence[Hypothesis], evidence: Sequence[Evidence], context: Context) -> list[Case]:
    """Return the hypotheses, the most probable first; of all moments for a re-zero, the best."""
    prior = context.prior
    cases = []
    for hypothesis, weight in zip(candidates, evidence, strict=True):
        parts = prior.log_densities(weight.gravity_W, weight.centre_of_mass_S, weight.covariance)
        preference = 0.0 if hypothesis.key == AS_DECLARED else float(np.log(prior.mistake))
        cases.append(Case(hypothesis, weight, parts, preference))
    cases.sort(key=lambda case: -case.score)
    changes = [case for case in cases if case.hypothesis.change]
    late = [case for case in changes if case.score < changes[0].score - TIE]
    return [case for case in cases if case not in late]


def _diagnosis(cases: Sequence[Case], context: Context, not_testable: tuple[str, ...]) -> Diagnosis:
    best = cases[0]
    declared = next(case for case in cases if case.key == AS_DECLARED)
    rivals = [case for case in cases if not case.same(best)]
    tied = [case for case in cases[1:] if case.value > best.value - TIE]
    if best is declared:
        tied = [case for case in tied if not case.same(best)]
    explained = _explains(best, context)
    words = Words(context, best, declared, tied)
    return Diagnosis(
        ranking=tuple(_finding(case, best, declared, context, words) for case in cases),
        decided_by=NOTHING if tied else decided_by(best, rivals),
        tied=tuple(case.key for case in tied),
        consistent=explained and best is declared,
        explained=explained,
        sentence=words.sentence(explained=explained),
        not_testable=(*not_testable, *words.not_testable(cases)),
        _poses=context.poses,
        _hypotheses={case.key: case.hypothesis for case in cases},
        _jumps={case.key: _jump(case) for case in cases},
    )


def _finding(case: Case, best: Case, declared: Case, context: Context, words: Words) -> Finding:
    return Finding(
        hypothesis=case.key,
        title=case.hypothesis.title,
        log_likelihood=case.evidence.log_likelihood,
        log_prior=case.score - case.evidence.log_likelihood,
        score=case.score,
        margin=case.score - declared.score,
        residual=context.residual(case, best),
        sentence=words.of(case),
        evidence=case.value,
        priors=case.priors,
        gravity_W=case.evidence.gravity_W,
        centre_of_mass_S=case.evidence.centre_of_mass_S,
        left_out=tuple(np.flatnonzero(~case.evidence.kept).tolist()),
    )


def _jump(case: Case) -> NDArray[np.float64]:
    """Return how much larger the bias (6,) is after a re-zero, N and N·m."""
    later = case.evidence.kept & (np.arange(len(case.evidence.kept)) >= case.hypothesis.change)
    return case.evidence.residuals[later].mean(axis=0) if case.hypothesis.change else np.zeros(6)


def _explains(case: Case, context: Context) -> bool:
    """Tell whether chance explains the residuals of a case."""
    evidence = case.evidence
    if context.known:
        chance = chdtrc(evidence.freedom, evidence.squares / _TOLERATED**2)
        return bool((chance > _CHANCE / 2).all())
    noise = evidence.noise * context.sigmas[[0, 3]]
    weight = max(float(np.linalg.norm(evidence.gravity_W)), FELT * case.weight_sigma)
    return bool((noise < _SHARE * weight * np.array([1.0, _LEVER])).all())
