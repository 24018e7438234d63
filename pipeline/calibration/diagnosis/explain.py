"""What the convention check found, in words."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from scipy.special import logsumexp

from contactbench.pipeline.calibration.diagnosis.hypotheses import SHIFTED
from contactbench.pipeline.calibration.diagnosis.hypothesis import Hypothesis
from contactbench.pipeline.calibration.diagnosis.prior import (
    DOWN,
    MASS,
    QUIET,
    REACH,
    SIDE,
    WEIGHED,
    Prior,
    angle_between,
)
from contactbench.pipeline.calibration.diagnosis.side_by_side import Evidence
from contactbench.pipeline.calibration.model import STANDARD_GRAVITY
from contactbench.pipeline.calibration.observability import observe
from contactbench.pipeline.calibration.poses import PoseSample, named
from contactbench.pipeline.errors import arg, capitalised, join, message

# Readings whose probabilities differ by less than a factor of exp(2) are called a tie.
TIE = 2.0
RESIDUALS, NOTHING = "residuals", "nothing"
FELT = 5.0  # standard deviations from zero at which a weight is felt

_SAME_ROTATION = 1e-6
_EQUAL = 0.02  # of a log likelihood
_STRANGE = -5.0  # logarithm: a load like this, or a base 13 degrees off level, is worth a word
_LISTED = 3
_SURE, _PROBABLE = 0.95, 0.75  # probabilities from which a cause is said as a fact, or as probable
_BOTH = np.arange(2)
_WORSE = 1.1  # times: residuals that rise by more are worse for a reading


@dataclass(frozen=True, eq=False)
class HypothesisCase:
    """One hypothesis and all that speaks for it."""

    hypothesis: Hypothesis
    evidence: Evidence
    priors: dict[str, float]  # Logarithms of what each piece of knowledge about loads says
    preference: float  # Logarithm of how rarely such a mistake is made; 0 for what was declared

    @property
    def key(self) -> str:
        """The hypothesis' key."""
        return self.hypothesis.key

    @cached_property
    def value(self) -> float:
        """What data and knowledge say, without the preference."""
        return self.evidence.log_likelihood + self.evidence.occam + sum(self.priors.values())

    @property
    def score(self) -> float:
        """What is ranked by."""
        return self.value + self.preference

    @property
    def mass(self) -> float:
        """Kg."""
        return float(np.linalg.norm(self.evidence.gravity_W)) / STANDARD_GRAVITY

    @property
    def weight_sigma(self) -> float:
        """Standard deviation of the worst known component of the weight, N."""
        return float(np.sqrt(np.linalg.eigvalsh(self.evidence.covariance[:3, :3])[-1]))

    @property
    def weighs(self) -> bool:
        """Whether the load's weight is felt."""
        g, C = self.evidence.gravity_W, self.evidence.covariance[:3, :3]
        return bool(g @ np.linalg.solve(C, g) > FELT**2)

    def same(self, other: HypothesisCase) -> bool:
        """Tell whether the data do not differ, read one way or the other; a turn that was found is no twin of none."""
        if self is other:
            return True
        a, b = self.hypothesis, other.hypothesis
        return bool(
            a.beside is b.beside is None
            and a.in_world == b.in_world
            and (a.factor == b.factor).all()
            and (a.channels == b.channels).all()
            and (np.abs(a.R_WS - b.R_WS) < _SAME_ROTATION).all()
        )


def decisive(best: HypothesisCase, rival: HypothesisCase) -> str:
    """Return what sets `best` apart from `rival`: RESIDUALS, NOTHING, or one of the priors."""
    if best.value - rival.value < TIE:
        return NOTHING
    if best.evidence.log_likelihood - rival.evidence.log_likelihood >= TIE:
        return RESIDUALS
    return max(best.priors, key=lambda part: best.priors[part] - rival.priors[part])


def decided_by(best: HypothesisCase, rivals: Sequence[HypothesisCase]) -> str:
    """Return what sets `best` apart from rivals that are not as good: priors where residuals would not do."""
    reasons = {decisive(best, rival) for rival in rivals}
    priors = [part for part in best.priors if part in reasons]
    return message(f"prior: {arg(join(', ', priors))}") if priors else RESIDUALS


@dataclass(frozen=True, eq=False)
class Context:
    """What all cases share."""

    poses: tuple[PoseSample, ...]
    # (6,) noise, N and N·m, or the unit that residuals are counted in when it is not known
    sigmas: NDArray[np.float64]
    known: bool
    prior: Prior

    def residual(self, case: HypothesisCase, best: HypothesisCase, halves: NDArray[np.intp] = _BOTH) -> float:
        """Return the rms residual in standard deviations: of the noise given, or that which `best` leaves.

        Parameters
        ----------
        case, best : HypothesisCase
        halves : array of int
            Of forces (0), torques (1) or both.
        """
        squares = case.evidence.squares
        if not self.known:
            recorded = best.hypothesis.factor[[0, 3]] / case.hypothesis.factor[[0, 3]]
            squares = squares * (recorded / best.evidence.noise) ** 2
        return float(np.sqrt(squares[halves].sum() / case.evidence.freedom[halves].sum()))


class Words:
    """Sentences about a set of cases.

    Parameters
    ----------
    context : Context
    best, declared : HypothesisCase
    tied : sequence of HypothesisCase
        Those that explain the data as well as the best.
    odds : mapping of str to float
        Probability of each case, and of none.
    """

    def __init__(
        self,
        context: Context,
        best: HypothesisCase,
        declared: HypothesisCase,
        tied: Sequence[HypothesisCase],
        odds: Mapping[str, float],
    ) -> None:
        self._context, self._best, self._declared, self._tied = context, best, declared, tied
        self._odds = odds

    def sentence(self, *, none_known: bool, untold: str = "") -> str:
        """Return the whole finding.

        Parameters
        ----------
        none_known : bool
            None of the cases is as probable as an unknown cause.
        untold : str
            What keeps data that fit as they are from being called consistent.
        """
        return join(" ", [*self._finding(none_known, untold), *self._left_out(self._best)])

    def _finding(self, none_known: bool, untold: str) -> Iterator[str]:
        best = self._best
        if none_known:
            yield self._unexplained()
        elif self._blind():
            yield message("These poses show no inconsistency, but they cannot show much:")
            yield from self._blind()
        elif not best.weighs:
            yield message(
                "The sensor feels no weight, so no convention can be tested. Take the poses with the tool"
                " mounted, check the unit of the forces, and that the sensor does not re-zero itself."
            )
        elif best is self._declared:
            yield self._consistent()
            yield from self._second()
            yield from [untold] if untold else self._also()
        else:
            yield message(f"{arg(self._said())}: {arg(self._because(best))}. {arg(best.hypothesis.remedy)}")
            yield from self._second()
            yield from self._also()
            yield from self._rests_on_noise()

    def _said(self) -> str:
        """Return the fact of the best reading; as a possibility with its odds where it is not well supported."""
        probability, fact = self._odds[self._best.key], self._best.hypothesis.fact
        if probability > _SURE:
            return fact
        said = in_words(probability)
        if probability > _PROBABLE:
            return message(f"{arg(fact)} (probably, at odds of {arg(said)})")
        return message(f"{arg(fact)} (possibly, at odds of {arg(said)})")

    def _blind(self) -> tuple[str, ...]:
        """Return what the poses, as declared, are too much alike to show."""
        if self._best is not self._declared:
            return ()
        R_SW = self._best.hypothesis.R_WS.transpose(0, 2, 1)
        return observe(R_SW, self._best.evidence.gravity_W, weighs=self._best.weighs).null_directions

    def of(self, case: HypothesisCase) -> str:
        """Return a sentence about one case."""
        residual = self._size(case)
        if case is self._declared:
            return message(f"As declared, the residuals are {arg(residual)}.")
        margin = case.score - self._declared.score
        return message(
            f"{arg(capitalised(case.hypothesis.title))}: residuals {arg(residual)}, log odds"
            f" {arg(margin):+,.1f} against as declared."
        )

    def not_testable(self, cases: Sequence[HypothesisCase]) -> Iterator[str]:
        """Yield what these data do not tell."""
        same = [
            case.hypothesis.title
            for case in cases
            if case is not self._declared and case.same(self._declared) and case.hypothesis.prior is None
        ]
        if same:
            yield message(
                f"These poses fit equally well as declared and as {arg(_list(same))}, so they cannot"
                " decide between the two. Turn the wrist about more than one axis between poses."
            )
        if not self._context.known:
            weighed = self._context.prior.mass is not None
            mass = "" if weighed else message(", or the mass of the tool as weighed")
            yield message(
                "The noise was not given, so units can only be judged by the resulting mass and"
                f" centre of mass. Give the noise from the sensor's data sheet{arg(mass)}."
            )

    def _consistent(self) -> str:
        case = self._declared
        angle = _angle(case, self._context.prior)
        return message(
            f"The data are consistent as they are: residuals {arg(self._size(case))}, gravity"
            f" {arg(np.degrees(angle)):.1f}° from down, mass {arg(case.mass):.3g} kg."
        )

    def _second(self) -> Iterator[str]:
        """Say what is strange about the load even if the best reading is right."""
        best, prior = self._best, self._context.prior
        said = {
            DOWN: message(f"gravity points {arg(np.degrees(_angle(best, prior))):.0f}° away from down"),
            SIDE: message(f"the centre of mass lies {arg(_side(_height(best, prior)))} of the sensor"),
            REACH: message(f"the centre of mass lies {arg(_distance(best))} from the sensor"),
            WEIGHED: message(
                f"the mass comes out as {arg(best.mass):.2g} kg where {arg(prior.mass or 0):.2g} kg was weighed"
            ),
            MASS: message(f"the mass comes out as {arg(best.mass):.2g} kg"),
            QUIET: message(f"the noise comes out as {arg(self._noise(best))}"),
        }
        strange = [said[part] for part, weight in best.priors.items() if weight < _STRANGE]
        if strange and best is not self._declared:
            yield message(
                f"But then {arg(_list(strange))}. Correct this, then check again for a second mistake."
            )
        elif strange:
            yield message(
                f"But {arg(_list(strange))}. Check what was declared about the tool and the world's z axis."
            )

    def _also(self) -> Iterator[str]:
        if not self._tied:
            return
        changes = [case.hypothesis.change for case in self._tied]
        if self._best.hypothesis.change and all(changes):
            yield message(
                f"It may equally have been before pose {arg(_list([str(change + 1) for change in changes]))}."
            )
            return
        units = any(case.hypothesis.scales for case in (self._best, *self._tied))
        masses = [f" ({case.mass:.2g} kg)" if units else "" for case in self._tied]
        rivals = [case.hypothesis.title + mass for case, mass in zip(self._tied, masses, strict=True)]
        yield message(
            f"Cannot be distinguished from: {arg(join('; ', rivals[:_LISTED]))}. {arg(self._telling(units))}"
        )

    def _telling(self, units: bool) -> str:
        """Say what would tell the best reading from those that are as good."""
        told = [case.hypothesis.telling for case in (*self._tied, self._best) if case.hypothesis.telling]
        if told:
            return told[0]
        if all(case.same(self._best) for case in self._tied):
            return message("With these poses it makes no difference.")
        if units and self._context.prior.mass is None:
            return message("Weigh the tool and give its mass.")
        if units and not self._context.known:
            return message("Give the noise from the sensor's data sheet.")
        # No residual, of these or other poses, sets them apart.
        own = self._best.evidence.log_likelihood
        if all(abs(case.evidence.log_likelihood - own) < _EQUAL for case in self._tied):
            return message(
                "Press the tool with a finger, and check the directions of the forces and torques."
            )
        return message("Take more poses, tilted about two axes by up to 90°.")

    def _rests_on_noise(self) -> Iterator[str]:
        forces = np.abs(self._best.hypothesis.factor[0]) != 1
        if forces and self._context.known and decisive(self._best, self._declared) == RESIDUALS:
            times = 1 / self._declared.evidence.noise[0]
            yield message(
                f"Or the specified noise is {arg(times):.0f} times too large: weigh the tool to be sure."
            )

    def _because(self, case: HypothesisCase) -> str:
        if decisive(case, self._declared) in (RESIDUALS, NOTHING):
            halves = _BOTH
            if case.hypothesis.scales:
                halves = np.flatnonzero(np.abs(case.hypothesis.factor[[0, 3]]) != 1)
            before, after = (self._residual(each, halves) for each in (self._declared, case))
            sizes = self._size(self._declared, halves), self._size(case, halves)
            start = sizes[0].removesuffix(" sigma") if self._context.known else sizes[0]
            reading = case.hypothesis.reading
            if len(halves) == 2 and (apart := self._apart(case)):
                return message(f"with {arg(reading)} {arg(apart)}")
            if after > before:
                return message(
                    f"with {arg(reading)} the residuals rise to the noise's size, from {arg(start)} to {arg(sizes[1])}"
                )
            return message(f"with {arg(reading)} the residuals fall from {arg(start)} to {arg(sizes[1])}")
        part = decisive(case, self._declared)
        return message(
            f"the residuals, {arg(self._size(case))}, do not decide it, but as declared"
            f" {arg(self._strange(part, case))}"
        )

    def _apart(self, case: HypothesisCase) -> str:
        """Say what a reading does to forces and torques where it is better for the one and worse for the other."""
        each = [[self._residual(one, _BOTH[[half]]) for one in (self._declared, case)] for half in _BOTH]
        rises = [after > _WORSE * before for before, after in each]
        if all(rises) or not any(rises):
            return ""
        words = [message("rise") if rise else message("fall") for rise in rises]
        sizes = [[self._size(one, _BOTH[[half]]) for one in (self._declared, case)] for half in _BOTH]
        return message(
            f"the force residuals {arg(words[0])} from {arg(sizes[0][0])} to {arg(sizes[0][1])} and the torque"
            f" residuals {arg(words[1])} from {arg(sizes[1][0])} to {arg(sizes[1][1])}"
        )

    def _strange(self, part: str, case: HypothesisCase) -> str:
        """Say what would be strange about the load as declared."""
        declared, prior = self._declared, self._context.prior
        if part == DOWN and case.hypothesis.prior is not None:
            return message(
                f"gravity would point {arg(np.degrees(_angle(declared, prior))):.0f}° away from down"
            )
        if part == SIDE and case.hypothesis.prior is not None:
            return message(
                f"the centre of mass would lie {arg(_side(_height(declared, prior)))} of the sensor"
            )
        if part == DOWN:
            angles = [np.degrees(_angle(each, prior)) for each in (declared, case)]
            return message(
                f"gravity would point {arg(angles[0]):.0f}° away from down; read this way, {arg(angles[1]):.0f}°"
            )
        if part == SIDE:
            sides = [_side(_height(each, prior)) for each in (declared, case)]
            return message(
                f"the centre of mass would lie {arg(sides[0])} of the sensor; read this way, {arg(sides[1])}"
            )
        if part == REACH:
            return message(
                f"the centre of mass would lie {arg(_distance(declared))} from the sensor; read this way,"
                f" {arg(_distance(case))}"
            )
        if part == QUIET:
            return message(
                f"the noise would be {arg(self._noise(declared))}; read this way, {arg(self._noise(case))}"
            )
        weighed = message(f"; {arg(prior.mass):.3g} kg was weighed") if part == WEIGHED else ""
        return message(
            f"the mass would be {arg(declared.mass):.2g} kg; read this way, {arg(case.mass):.2g} kg{arg(weighed)}"
        )

    def _unexplained(self) -> str:
        best, noise = self._best, ""
        if best is self._declared:
            said = message(
                f"unchanged they leave {arg(self._size(best))}, and no other reading is more probable"
            )
            if self._context.known:
                noise = message("a specified noise that is too small, ")
        else:
            said = message(
                f"the likeliest, {arg(best.hypothesis.title)}, leaves {arg(self._size(best))}; unchanged"
                f" they leave {arg(self._size(self._declared))}"
            )
        return message(
            f"No single convention mistake explains the data: {arg(said)} (odds of another cause:"
            f" {arg(in_words(self._odds[NONE]))}). Look for two mistakes at once, a pulling cable,"
            f" drift, {arg(noise)}or poses in which something was touched."
        )

    def _left_out(self, case: HypothesisCase) -> Iterator[str]:
        out = np.flatnonzero(~case.evidence.kept).tolist()
        if not out:
            return
        names = [named(self._context.poses, index) for index in out]
        if len(out) > 1:
            yield message(f"{arg(capitalised(_list(names, len(names))))} look bumped and were left out.")
            return
        if case.key.startswith(SHIFTED):
            yield message(
                f"{arg(capitalised(names[0]))} then has no orientation of its own and was left out."
            )
            return
        ends = {0: message(" (or the sensor was re-zeroed after it)")}
        ends[len(self._context.poses) - 1] = message(" (or the sensor was re-zeroed before it)")
        yield message(
            f"{arg(capitalised(names[0]))} looks bumped{arg(ends.get(out[0], ''))} and was left out."
        )

    def _noise(self, case: HypothesisCase) -> str:
        force, torque = case.evidence.noise * self._context.sigmas[[0, 3]]
        return message(f"{arg(_force(force))} and {arg(_torque(torque))}")

    def _residual(self, case: HypothesisCase, halves: NDArray[np.intp]) -> float:
        return self._context.residual(case, self._best, halves)

    def _size(self, case: HypothesisCase, halves: NDArray[np.intp] = _BOTH) -> str:
        """Return how large the residuals of forces (0), torques (1) or both are, with their unit."""
        if self._context.known:
            return f"{_short(self._residual(case, halves))} sigma"
        rms = np.sqrt(case.evidence.squares / case.evidence.freedom) * self._context.sigmas[[0, 3]]
        return " and ".join([_force(rms[0]), _torque(rms[1])][half] for half in halves)


def _angle(case: HypothesisCase, prior: Prior) -> float:
    return angle_between(case.evidence.gravity_W, np.array(prior.down_W))


def _height(case: HypothesisCase, prior: Prior) -> float:
    return float(np.array(prior.tool_axis_S) @ case.evidence.centre_of_mass_S)


def _digits(number: float) -> str:
    return f"{float(f'{number:.2g}'):,g}"


def _force(newtons: float) -> str:
    return f"{_digits(newtons)} N" if newtons >= 0.01 else f"{_digits(1e3 * newtons)} mN"


def _torque(newton_metres: float) -> str:
    return f"{_digits(newton_metres)} N·m" if newton_metres >= 1 else f"{_digits(1e3 * newton_metres)} mN·m"


def _distance(case: HypothesisCase) -> str:
    return _length(float(np.linalg.norm(case.evidence.centre_of_mass_S)))


def _short(number: float) -> str:
    if number >= 10:
        return f"{number:,.0f}"
    return f"{number:.1f}" if number >= 0.95 else f"{number:.1g}"


def _side(height: float) -> str:
    side = message("the other side") if height < 0 else message("the tool's side")
    return message(f"{arg(_length(abs(height)))} on {arg(side)}")


def _length(metres: float) -> str:
    if metres >= 1:
        return f"{_digits(metres)} m"
    return f"{1e3 * metres:.0f} mm" if metres >= 0.001 else f"{1e3 * metres:.1g} mm"


def _list(words: Sequence[str], most: int = _LISTED) -> str:
    shown = list(words[:most])
    if len(words) > most:
        shown.append(message(f"{arg(len(words) - most)} more"))
    return shown[0] if len(shown) == 1 else message(f"{arg(join(', ', shown[:-1]))} and {arg(shown[-1])}")


NONE = "none"
# An unknown cause leaves residuals of any size: forces and torques by a factor of up to 3,000 each, where those of
# a known cause are those of the noise.
_ANY_SIZE = 2 * float(np.log(np.log(3e3)))

# That an unknown cause is more probable than any whose residuals chance refutes.
_LEFT_OVER = float(np.log(19.0))


def odds(cases: Sequence[HypothesisCase], mistake: float, *, explained: bool) -> Mapping[str, float]:
    """Return the probability of each case by its key, and of NONE.

    None of the known causes is a reading of its own: its likelihood is that of the best known reading with
    residuals of any size, so it wins where even the best leaves more than the noise explains.

    Parameters
    ----------
    cases : sequence of HypothesisCase
    mistake : float
        Share of recordings with a mistake of any one family.
    explained : bool
        Chance explains the residuals of the best case; else hardly any case can be true.
    """
    unknown = max(_unexplained(case) for case in cases) + np.log(mistake) - _ANY_SIZE
    if not explained:
        unknown = max(unknown, max(case.score for case in cases) + _LEFT_OVER)
    scores = np.array([*(case.score for case in cases), unknown])
    shares = np.exp(scores - logsumexp(scores))
    return dict(zip([*(case.key for case in cases), NONE], shares.tolist(), strict=True))


def _unexplained(case: HypothesisCase) -> float:
    """Return the logarithm of the likelihood if the size of the residuals means nothing."""
    rare = float(np.log(case.hypothesis.share))
    return case.value + case.evidence.excess - case.priors.get(QUIET, 0.0) + rare


def in_words(probability: float) -> str:
    """Return odds such as "8 to 1"."""
    ratio = probability / max(1 - probability, 1e-9)
    if ratio > 1000:
        return message("over 1000 to 1")
    whole = round(max(ratio, 1 / ratio)) if ratio > 0 else 1000
    return message(f"{arg(whole)} to 1") if ratio >= 1 else message(f"1 to {arg(whole)}")
