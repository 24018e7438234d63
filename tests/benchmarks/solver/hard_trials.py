"""How a hard case is tried and judged: wrenches with known contacts, both methods, one rule in words."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

import numpy as np
from benchmarks.solver import hard_meshes as hm

from contactbench.pipeline.contact import (
    Batch,
    ContactSolver,
    Gates,
    Reason,
    TouchModel,
    WrenchNoise,
    methods,
)
from contactbench.pipeline.mesh import Probe
from contactbench.pipeline.study.stability import EXACT, Bools, Drawn, Float, SolidBody

if TYPE_CHECKING:
    from contactbench.pipeline.study.report import Cell


@dataclass(frozen=True)
class HardOutcome:
    """What one method made of a case."""

    answered: float  # share of tries that got a point, `ambiguous` ones included
    # mean_mm, max_mm: error of the points; None where there is no point, or no place it should be
    mean_mm: float | None
    max_mm: float | None
    reasons: dict[str, int]  # reason code -> tries
    # share of tries with an error beyond the case's tolerance under an accepted reason
    wrong_unflagged: float
    wrong: float = 0.0  # share of tries with an error beyond the tolerance, whatever the reason
    broken: int = 0  # tries that break the case's own check


@dataclass(frozen=True)
class Rule:
    """What an outcome must be to pass."""

    words: str  # the rule, in words
    answered: tuple[float, float] = (1.0, 1.0)  # (low, high) bounds of the answered share
    # unflagged, wrong: most that the shares of the same names may be
    unflagged: float = 0.0
    wrong: float = 1.0
    reasons: tuple[Reason, ...] | None = None  # the only reasons allowed
    tolerance_mm: float = 10.0  # a larger error is wrong

    def faults(self, outcome: HardOutcome) -> tuple[str, ...]:
        """Return what is wrong with an outcome, in words; nothing when it passes."""
        low, high = self.answered
        allowed = None if self.reasons is None else {r.name for r in self.reasons}
        stray = {} if allowed is None else {r: n for r, n in outcome.reasons.items() if r not in allowed}
        found = [
            (
                not low <= outcome.answered <= high,
                f"answered {outcome.answered:.3%}, not {low:.1%} to {high:.1%}",
            ),
            (
                not outcome.wrong_unflagged <= self.unflagged,
                f"wrong and not flagged: {outcome.wrong_unflagged:.3%}",
            ),
            (not outcome.wrong <= self.wrong, f"wrong: {outcome.wrong:.3%}"),
            (bool(stray), f"reasons that do not belong: {stray}"),
            (outcome.broken != 0, f"tries that fail the case's own check: {outcome.broken}"),
        ]
        return tuple(words for bad, words in found if bad)


@dataclass(frozen=True)
class HardCase:
    """One hard case, as it went."""

    # name, what, expectation: in words
    name: str
    what: str
    tries: int  # wrenches
    expectation: str
    contactbench: HardOutcome
    algorithm1: HardOutcome
    # whether contactbench kept the rule. Algorithm 1 is shown, not judged.
    passed: bool
    faults: tuple[str, ...] = ()  # what was wrong

    @property
    def row(self) -> tuple[Cell, ...]:
        """It as a row of `COLUMNS`."""
        figures = [
            (100 * o.answered, o.max_mm, 100 * o.wrong_unflagged)
            for o in (self.contactbench, self.algorithm1)
        ]
        both = [figure for pair in zip(*figures, strict=True) for figure in pair]
        return self.name, self.tries, *both, "; ".join(self.faults) or "passed"


COLUMNS = (
    "case", "tries", "answered, %", "by Algorithm 1, %", "largest error, mm", "of Algorithm 1, mm",
    "wrong, not flagged, %", "of Algorithm 1, %", "verdict",
)  # fmt: skip
_SAME_TOUCH, _SAME_M, _ROUNDING_M, _TIED = 4.5, 0.005, 1e-9, 1e-9
# As `EXACT`, but the mesh stands for a curved body: facets then answer for the gaps between their normals, too.
CURVED = replace(EXACT, mesh_curved=True)

Check = Callable[[Batch], Bools]


@dataclass(frozen=True, eq=False)
class HardTrial:
    """A case before it is tried."""

    name: str
    what: str
    rule: Rule
    probe: Probe
    drawn: Drawn  # the wrenches, and where each should be found; NaN where nowhere in particular
    # noise, gates, model: what the solver is told
    noise: WrenchNoise = field(default_factory=lambda: WrenchNoise(0.0, 0.0))
    gates: Gates = field(default_factory=Gates)
    model: TouchModel = field(default_factory=lambda: EXACT)
    check: Check | None = None  # gives (n,) bool: tries that break a rule of the case's own
    # facets were turned over on purpose: an answer counts as flagged when the mesh's health says so
    known_bad_mesh: bool = False

    def run(self) -> HardCase:
        """Try both methods and judge."""
        wrenches = self.drawn.wrenches
        literal = methods.algorithm1(self.probe, self.noise, self.gates)
        ours = self._outcome(self.solver().locate_batch(wrenches), self.check)
        theirs = self._outcome(literal.locate_batch(wrenches), None)
        faults = self.rule.faults(ours) if len(wrenches) else ("no wrench fits the case: give more samples",)
        return HardCase(
            self.name, self.what, len(wrenches), self.rule.words, ours, theirs, not faults, faults
        )

    def solver(self) -> ContactSolver:
        """Return what is tried."""
        return ContactSolver(self.probe, self.noise, self.gates, self.model)

    def _outcome(self, batch: Batch, check: Check | None) -> HardOutcome:
        error = 1e3 * np.linalg.norm(batch.points - self.drawn.points, axis=1)
        far = error > self.rule.tolerance_mm
        health = self.probe.health
        told = self.known_bad_mesh and (health.outward is False or not health.winding_consistent)
        unflagged = far & (batch.reasons <= Reason.VERTEX) & (not told)
        codes, counts = np.unique(batch.reasons, return_counts=True)
        known = error[np.isfinite(error)]
        tries = max(1, len(self.drawn))
        return HardOutcome(
            float(np.isfinite(batch.points[:, 0]).sum() / tries),
            float(known.mean()) if len(known) else None,
            float(known.max()) if len(known) else None,
            {Reason(code).name: int(n) for code, n in zip(codes, counts, strict=True)},
            float(unflagged.sum() / tries),
            float(far.sum() / tries),
            int(check(batch).sum()) if check else 0,
        )


def exact(tolerance: str) -> Rule:
    """Return the rule that every point is there and right, to so much: a number and ``m``."""
    words = f"every wrench answered, every point right to {tolerance}"
    return Rule(words, wrong=0.0, tolerance_mm=1e3 * float(tolerance.split()[0]))


def refused(*reasons: Reason) -> Rule:
    """Return the rule that there is no point, for these reasons."""
    return Rule(
        f"no point, and the reason is {' or '.join(r.name.lower() for r in reasons)}",
        (0.0, 0.0),
        reasons=reasons,
    )


def certified(body: SolidBody, wrenches: Float) -> Check:
    """Refuse points that are not the exact solution where they say (a convex body has only one)."""

    def check(batch: Batch) -> Bools:
        off, false = hm.certify(body, wrenches, batch)
        return np.asarray(false | (off > 1e-9 * body.size))

    return check


def complete(drawn: Drawn) -> Check:
    """Refuse answers that have the truth neither as point nor as candidate."""

    def check(batch: Batch) -> Bools:
        broken = np.zeros(len(drawn), dtype=bool)
        for i, truth in enumerate(drawn.points):
            found = batch[i]
            points = [c.point for c in found.candidates] + ([] if found.point is None else [found.point])
            off = np.linalg.norm(np.reshape(points, (-1, 3)) - truth, axis=1)
            # What is nearer to a candidate is the same touch.
            broken[i] = off.min(initial=np.inf) > _SAME_M
        return broken

    return check


def within(drawn: Drawn) -> Check:
    """Refuse points that are further from the truth than they say: 4.5 standard deviations."""

    def check(batch: Batch) -> Bools:
        off = np.linalg.norm(batch.points - drawn.points, axis=1)
        return np.asarray(off > np.maximum(_ROUNDING_M, _SAME_TOUCH * batch.sigma_max))

    return check


def like(base: HardTrial, move: Callable[[Float], Float], size: float) -> Check:
    """Refuse answers that are not those of another trial, moved, to 1e-9 of the body's size."""

    def check(batch: Batch) -> Bools:
        before = base.solver().locate_batch(base.drawn.wrenches)
        off = np.linalg.norm(batch.points - move(before.points), axis=1)
        # Of places that explain a wrench equally well, rounding chooses: one of them it must be.
        for i in np.flatnonzero((before.confidences < 0.5 + _TIED) & np.isfinite(batch.points[:, 0])):
            tied = [c.point for c in before[i].candidates if c.delta < _TIED]
            others = np.linalg.norm(move(np.reshape(tied, (-1, 3))) - batch.points[i], axis=1)
            off[i] = min(off[i], others.min(initial=np.inf))
        return np.asarray((batch.reasons != before.reasons) | (off > 1e-9 * size))

    return check
