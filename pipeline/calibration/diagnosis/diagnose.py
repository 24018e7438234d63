"""The convention check: are poses as they were declared, or which single mistake explains them.

Each mistake that people make leaves a fingerprint. Every one is fitted and ranked by the likelihood of the
recorded numbers; where two readings leave the same residuals, what is known of any load decides (gravity points
down, the centre of mass is on the tool's side). "None of the known causes" competes as a reading of its own, and
every cause is said with its odds. Nothing is ever corrected silently.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any

import numpy as np
from scipy.special import chdtrc, logsumexp

from contactbench.pipeline.calibration.comparison import CHANNEL_NAMES, compare, fact, gain_error
from contactbench.pipeline.calibration.diagnosis.explain import (
    FELT,
    NONE,
    NOTHING,
    TIE,
    Context,
    HypothesisCase,
    Words,
    decided_by,
    odds,
)
from contactbench.pipeline.calibration.diagnosis.hypotheses import (
    WORLD,
    YAW,
    hypotheses,
    right_angle,
    settled,
    turned,
)
from contactbench.pipeline.calibration.diagnosis.hypothesis import AS_DECLARED, Hypothesis
from contactbench.pipeline.calibration.diagnosis.prior import QUIET, Prior, quiet
from contactbench.pipeline.calibration.diagnosis.rereadings import RawOrientations
from contactbench.pipeline.calibration.diagnosis.side_by_side import Evidence, HypothesisNoise, weigh
from contactbench.pipeline.calibration.model import CENTRE_OF_MASS, GRAVITY, STANDARD_GRAVITY, PoseNoise
from contactbench.pipeline.calibration.nuisance import CHANNEL, CLIPPED, MOUNT, PLAIN, REZERO, WORDS
from contactbench.pipeline.calibration.observability import observe
from contactbench.pipeline.calibration.poses import PoseError, PoseSample, stack
from contactbench.pipeline.calibration.reml import NoisePrior
from contactbench.pipeline.calibration.suggest import usual_task
from contactbench.pipeline.errors import InputError, arg, join, message
from contactbench.pipeline.settings import ORIENTATION_NOISE_DEG

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence

    from numpy.typing import NDArray

    from contactbench.pipeline.calibration.comparison import Candidate, CauseComparison

__all__ = ["ConventionFinding", "Diagnosis", "Prior", "RawOrientations", "diagnose"]

FEWEST_POSES, MOST_POSES = 4, 200
_FAR_TOO_LOUD, _REVERSED = 10.0, -1.5  # times the noise given; error of a gain
REZERO_BEFORE = "rezero_before_"  # And the number of the pose, from 1

# Noise that was given is often too small by half: drift, hysteresis, cables. Beyond this factor residuals are
# called unexplained, once chance makes them in one clean set out of a thousand. What is named as a mistake has to
# explain more: half of a cause is often explained by another, and most of it by a bias that changes.
_TOLERATED, _TOLERATED_OF_MISTAKES, _TOLERATED_OF_CHANGES, _CHANCE = 2.0, 1.6, 1.3, 1e-3
# Without noise: residuals are called noise up to this share of the weight, and of its torque at 0.1 m.
_NOISE_OF_WEIGHT, _LEVER = 0.2, 0.1
_ANY_NOISE = np.repeat([0.1, 0.003], 3)  # a unit to count in where the noise is not known
_LARGEST_ERROR = 1.5e-3  # m: what residuals of unknown origin may move a contact by
_HEAVIER = 1.2  # a load is not heavier than this many times what was weighed
_BETTER = 0.5  # other units explain the noise better: a logarithm
# Other units at least this probable, beside those that were declared, are not ruled out.
_UNTOLD = float(np.log(0.01))


@dataclass(frozen=True, eq=False)
class ConventionFinding:
    """What the poses say of one way to read them."""

    hypothesis: str  # Its key
    title: str  # For tables
    # Natural logarithms; score is their sum
    log_likelihood: float
    log_prior: float
    score: float
    margin: float  # Score over that of the data as declared
    # Root mean square of the residuals, in standard deviations: of the noise that was given, else of that
    # which the best reading leaves
    residual: float
    sentence: str
    evidence: float  # Likelihood and knowledge of the load, without the preference for what was declared
    priors: Mapping[str, float]  # Logarithms of what each piece of knowledge says
    gravity_W: NDArray[np.float64]  # (3,) weight of the load, W, N, so read
    centre_of_mass_S: NDArray[np.float64]  # (3,) S, m, so read
    left_out: tuple[int, ...]  # Indices of poses that were taken for bumped
    # (3, 3) what R_WS is multiplied by on the right if the sensor is turned on the flange
    turn: NDArray[np.float64] | None = None

    @property
    def mass(self) -> float:
        """Of the load, kg, so read."""
        return float(np.linalg.norm(self.gravity_W)) / STANDARD_GRAVITY


@dataclass(frozen=True, eq=False)
class Diagnosis:
    """What explains the poses."""

    ranking: tuple[ConventionFinding, ...]  # All readings, the most probable first
    # What sets the best reading apart from all others: "residuals"; "prior: " and which, where some others
    # leave the same residuals; or "nothing": then it stands for all that are `tied`
    decided_by: str
    # Keys of readings that explain the data as well as the best: within a factor of exp(2)
    tied: tuple[str, ...]
    consistent: bool  # The data are consistent as they are
    explained: bool  # The best reading leaves residuals that chance explains
    none_known: bool  # That it is none of the known causes is more probable than any of them
    odds: Mapping[str, float]  # Probability of each reading by its key, and of "none" of them
    sentence: str  # All of that for a technician, with what to do
    not_testable: tuple[str, ...]  # What these data do not tell, and what it would take
    _poses: tuple[PoseSample, ...] = field(repr=False)
    _cases: Mapping[str, HypothesisCase] = field(repr=False)

    @property
    def best(self) -> ConventionFinding:
        """The most probable reading."""
        return self.ranking[0]

    def finding(self, hypothesis: str) -> ConventionFinding:
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
        raise InputError(f"there is no hypothesis {arg(hypothesis)!r}. Tested: {arg(keys)}.")

    def corrected(self, hypothesis: str) -> tuple[PoseSample, ...]:
        """Return the poses as they are if a hypothesis holds.

        Parameters
        ----------
        hypothesis : str
            Key of a finding. After a re-zero the later poses get the bias of the earlier ones; a drift is
            taken off, to the bias of the last pose.

        Raises
        ------
        InputError
            There is none of that key.
        """
        self.finding(hypothesis)
        chosen = self._cases[hypothesis].hypothesis
        mended = []
        wrenches = chosen.wrenches(stack(self._poses).wrenches)
        for pose, R_WS, wrench in zip(self._poses, chosen.R_WS, wrenches, strict=True):
            pose = replace(pose, R_WS=R_WS, force=wrench[:3], torque=wrench[3:])
            if pose.force_sd is not None and pose.torque_sd is not None:
                sd = np.abs(np.concatenate([pose.force_sd, pose.torque_sd])[chosen.channels] * chosen.factor)
                pose = replace(pose, force_sd=sd[:3], torque_sd=sd[3:])
            mended.append(pose)
        return tuple(mended)

    def to_json(self) -> dict[str, Any]:
        """Return plain data for ``--json``; lengths in m, forces in N."""
        return {
            "sentence": self.sentence,
            "best": self.best.hypothesis,
            "consistent": self.consistent,
            "explained": self.explained,
            "none_known": self.none_known,
            "odds": dict(self.odds),
            "decided_by": self.decided_by,
            "tied": list(self.tied),
            "not_testable": list(self.not_testable),
            "ranking": [
                {
                    **vars(finding),
                    "priors": dict(finding.priors),
                    "gravity_W": finding.gravity_W.tolist(),
                    "centre_of_mass_S": finding.centre_of_mass_S.tolist(),
                    "left_out": list(finding.left_out),
                    "turn": None if finding.turn is None else finding.turn.tolist(),
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
    compared: CauseComparison | None = None,
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
        mass that they make. Orientations whose noise is not given are as good as a robot's.
    prior : Prior, optional
        What is known of the load.
    raw : RawOrientations, optional
        The numbers behind the orientations. Without them only mistakes that an earlier program may have made
        are tested, on angles recovered from R_WS.
    compared : CauseComparison, optional
        What may be in the readings of these poses beside the weight; left out: it is computed.

    Raises
    ------
    PoseError
        There are too few or too many poses.
    InputError
        `raw` are not the numbers behind the poses.
    """
    if not FEWEST_POSES <= len(poses) <= MOST_POSES:
        raise PoseError(
            f"{arg(len(poses))} poses: the convention check needs {arg(FEWEST_POSES)} to {arg(MOST_POSES)}. Take"
            " poses with different tilts about two axes; from a long recording, use only the"
            " parts where the sensor stood still."
        )
    prior = prior or Prior()
    known = noise is not None and not noise.estimated
    arrays = stack(poses)
    candidates, not_testable = hypotheses(arrays, raw, prior)
    context = Context(tuple(poses), noise.sigmas if noise is not None and known else _ANY_NOISE, known, prior)
    evidence = weigh(candidates, arrays, _noise(context, noise))
    if compared is None:
        orientation = noise.orientation if noise is not None and noise.orientation else None
        compared = compare(arrays, NoisePrior.of(poses, noise, orientation), np.array(prior.down_W))
    cases = _cases(candidates, evidence, context)
    declared = next(case for case in cases if case.key == AS_DECLARED)
    cases = sorted((*cases, *_beside(compared, declared, context)), key=lambda case: -case.score)
    return _diagnosis(cases, context, not_testable)


def _beside(
    compared: CauseComparison, declared: HypothesisCase, context: Context
) -> Iterator[HypothesisCase]:
    """Yield what may be in the readings beside the weight: by how much it explains them better than nothing beside."""
    R_WS = declared.hypothesis.R_WS
    if observe(R_WS.swapaxes(1, 2), declared.evidence.gravity_W).force_rank < 6:
        return  # a weight and a bias are one
    groups: dict[str, list[Candidate]] = {}
    for candidate in compared.candidates:
        groups.setdefault(_key(candidate, compared), []).append(candidate)
    plain = logsumexp([each.log_odds for each in groups.pop(PLAIN)])
    for key, group in groups.items():
        best, fit = group[0], group[0].noisy.fit
        # What leaves far more than the noise explains nothing, and a channel that is reversed is a reading of its own.
        loud = context.known and (best.noisy.noise.sigmas > _FAR_TOO_LOUD * context.sigmas).any()
        if loud or (best.key == CHANNEL and gain_error(best)[0] < _REVERSED):
            continue
        words, change = WORDS[best.key], 0
        title, said, reading, remedy = words.title, fact(best), words.reading, words.remedy
        offsets = best.terms.columns @ fit.added
        if best.key == REZERO:
            change = int(key.removeprefix(REZERO_BEFORE)) - 1
            title = message(f"re-zero before pose {arg(change + 1)}")
            said = message(f"The sensor was re-zeroed between poses {arg(change)} and {arg(change + 1)}")
            offsets = offsets - offsets[0]
        if best.key == MOUNT:
            sigma = float(np.sqrt(np.diag(fit.covariance)[12:15].max()))
            if right_angle(fit.mount.T, sigma):  # which is a reading of its own
                continue
            title, said, reading, remedy = turned(fit.mount.T, sigma)
        hypothesis = Hypothesis(
            key,
            title,
            said,
            reading,
            remedy,
            R_WS @ fit.mount.T,
            change=change,
            beside=offsets,
            share=best.beside.share,
            telling=words.telling,
        )
        preference = float(np.log(best.beside.share / compared.plain.beside.share))
        gain = float(logsumexp([each.log_odds for each in group]) - plain) - preference
        likelihood = declared.evidence.log_likelihood + gain
        # One with more unknowns ties with none by chance: how rare it is counts here too.
        evidence = replace(_of(best, compared, context), log_likelihood=likelihood, occam=preference)
        yield HypothesisCase(hypothesis, evidence, _known(context.prior, evidence, context), 0.0)


def _known(prior: Prior, evidence: Evidence, context: Context) -> dict[str, float]:
    """Return the logarithms of what each piece of knowledge says of a reading."""
    parts = prior.log_densities(evidence.gravity_W, evidence.centre_of_mass_S, evidence.covariance)
    if not context.known:
        parts[QUIET] = quiet(evidence.noise * context.sigmas[[0, 3]])
    return parts


def _key(candidate: Candidate, compared: CauseComparison) -> str:
    if candidate.key in {CHANNEL, CLIPPED}:
        return f"{candidate.key}_{CHANNEL_NAMES[candidate.beside.channel]}"
    if candidate.key != REZERO:
        return candidate.key
    return f"{REZERO_BEFORE}{compared.poses.first_from(candidate.beside.moment) + 1}"


def _of(candidate: Candidate, compared: CauseComparison, context: Context) -> Evidence:
    """Return what a fitted cause says of the load, in the words of a reading."""
    fit, inside = candidate.noisy.fit, candidate.inside
    left = fit.left(compared.poses, candidate.terms)[inside] / context.sigmas
    g_and_L = [*range(3), *range(6, 9)]
    lost = len(fit.covariance) / 2
    return Evidence(
        log_likelihood=0.0,
        gravity_W=fit.theta[GRAVITY],
        centre_of_mass_S=fit.theta[CENTRE_OF_MASS],
        covariance=fit.covariance[np.ix_(g_and_L, g_and_L)],
        squares=(left**2).reshape(-1, 2, 3).sum(axis=(0, 2)),
        freedom=np.full(2, max(3.0 * inside.sum() - lost, 1.0)),
        noise=candidate.noisy.noise.sigmas[[0, 3]] / context.sigmas[[0, 3]],
        kept=inside,
        excess=0.0,
    )


def _noise(context: Context, given: PoseNoise | None) -> HypothesisNoise:
    prior = context.prior
    orientation = given.orientation if given is not None else 0.0
    heaviest = prior.mass_range[1] if prior.mass is None else _HEAVIER * prior.mass
    return HypothesisNoise(
        context.sigmas,
        float(np.log(prior.noise_factor)) if context.known else np.inf,
        orientation or float(np.radians(ORIENTATION_NOISE_DEG["robot"])),
        heaviest * STANDARD_GRAVITY,
        prior.tool_length,
    )


def _cases(
    candidates: Sequence[Hypothesis], evidence: Sequence[Evidence], context: Context
) -> list[HypothesisCase]:
    """Return the hypotheses, the most probable first."""
    cases = []
    for untold, weight in zip(candidates, evidence, strict=True):
        hypothesis = settled(untold, weight, context.prior)
        prior = hypothesis.prior or context.prior
        parts = _known(prior, weight, context)
        occam = weight.occam - float(np.log(hypothesis.variants))
        if hypothesis.key == WORLD:
            occam += float(np.log(prior.tilt**2 / 2))  # any direction, where `tilt` about one is expected
        preference = 0.0
        if hypothesis.key != AS_DECLARED:
            preference = float(np.log(context.prior.mistake * hypothesis.share))
        cases.append(HypothesisCase(hypothesis, replace(weight, occam=occam), parts, preference))
    return sorted(cases, key=lambda case: -case.score)


def _shown(cases: Sequence[HypothesisCase]) -> list[HypothesisCase]:
    """Leave out all but the best moments for a re-zero."""
    changes = [case for case in cases if case.hypothesis.change]
    late = [case for case in changes if case.score < changes[0].score - TIE]
    return [case for case in cases if case not in late]


def _diagnosis(every: Sequence[HypothesisCase], context: Context, not_testable: tuple[str, ...]) -> Diagnosis:
    cases, best = _shown(every), every[0]
    explained = _explains(best, context)
    probable = odds(every, context.prior.mistake, explained=explained)
    declared = next(case for case in cases if case.key == AS_DECLARED)
    rivals = [case for case in cases if not case.same(best)]
    tied = [case for case in cases[1:] if case.value > best.value - TIE]
    if best is declared:
        tied = [case for case in tied if not case.same(best)]
    none_known = not explained or probable[NONE] > probable[best.key]
    words = Words(context, best, declared, tied, probable)
    untold = _untold(cases, declared, tied, context)
    return Diagnosis(
        ranking=tuple(_finding(case, best, declared, context, words) for case in cases),
        decided_by=NOTHING if tied else decided_by(best, rivals),
        tied=tuple(case.key for case in tied),
        consistent=best is declared and not none_known and not untold,
        explained=explained,
        none_known=none_known,
        odds=probable,
        sentence=words.sentence(none_known=none_known, untold=untold),
        not_testable=(*not_testable, *words.not_testable(cases)),
        _poses=context.poses,
        _cases={case.key: case for case in cases},
    )


def _untold(
    cases: Sequence[HypothesisCase],
    declared: HypothesisCase,
    tied: Sequence[HypothesisCase],
    context: Context,
) -> str:
    """Return what keeps data that fit as they are from being called consistent."""
    if context.known:
        least = declared.evidence.log_likelihood + _BETTER
        likely = [case.hypothesis for case in tied if case.evidence.log_likelihood > least]
        units = join(message(" or "), (each.title for each in likely if each.scales))
        return (
            message(f"But {arg(units)} would fit equally well. Press one known point and compare.")
            if units
            else ""
        )
    noise = np.repeat(declared.evidence.noise, 3) * context.sigmas
    error = usual_task().sensor_error(noise)
    if error > _LARGEST_ERROR:
        return message(
            f"But residuals of this size move a contact by {arg(1e3 * error):.1f} mm, and nothing shows"
            " whether they are noise. Give the noise from the sensor's data sheet."
        )
    scales = [case for case in cases if case.hypothesis.scales and case.value > declared.value + _UNTOLD]
    if scales and context.prior.mass is None:
        masses = [message(f"{arg(case.hypothesis.title)} ({arg(case.mass):.2g} kg)") for case in scales[:3]]
        return message(
            f"But the units cannot be determined without the tool's mass: {arg(declared.mass):.2g} kg"
            f" as declared, or {arg(join(message(' or '), masses))}. Weigh the tool and give its mass."
        )
    return ""


def _finding(
    case: HypothesisCase, best: HypothesisCase, declared: HypothesisCase, context: Context, words: Words
) -> ConventionFinding:
    return ConventionFinding(
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
        turn=declared.hypothesis.R_WS[0].T @ case.hypothesis.R_WS[0]
        if case.key == MOUNT or case.key.startswith(YAW)
        else None,
    )


def _explains(case: HypothesisCase, context: Context) -> bool:
    """Tell whether chance explains the residuals of a case."""
    evidence = case.evidence
    if context.known:
        tolerated = _TOLERATED if case.key == AS_DECLARED else _TOLERATED_OF_MISTAKES
        if case.hypothesis.beside is not None:
            tolerated = _TOLERATED_OF_CHANGES
        chance = chdtrc(evidence.freedom, evidence.squares / tolerated**2)
        return bool((chance > _CHANCE / 2).all())
    noise = evidence.noise * context.sigmas[[0, 3]]
    weight = max(float(np.linalg.norm(evidence.gravity_W)), FELT * case.weight_sigma)
    return bool((noise < _NOISE_OF_WEIGHT * weight * np.array([1.0, _LEVER])).all())
