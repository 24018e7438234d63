"""What speaks against a verification, in sentences."""

from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np

from contactbench.pipeline.errors import arg, join, message
from contactbench.pipeline.verification.figures import (
    Interval,
    Summary,
    Times,
    TouchFigure,
    Unresolved,
    VerificationLimits,
    VerificationVerdict,
)
from contactbench.pipeline.verification.markers import MarkerSet
from contactbench.pipeline.verification.protocol import UNRESOLVED, Why

MOST_UNRESOLVED = 0.05
FEWEST_MARKERS = 6
_ROOM = 0.002  # m between what two neighbours may both be off
_LISTED = 10


@dataclass(frozen=True)
class VerdictCase:
    """What a verdict is about."""

    overall: Summary | None
    unresolved: Unresolved | None
    missing: tuple[str, ...]
    markers: int  # With an accepted touch
    limits: VerificationLimits
    faults: tuple[str, ...]  # What is wrong with the inputs, in sentences
    rejected: dict[str, int]
    left_out: Mapping[str, str] = field(default_factory=dict)  # Marker -> why nobody need touch it

    def judged(self, times: Times | None) -> VerificationVerdict:
        """Return the verdict; times that were not measured are a note."""
        reasons = [*self.errors(), *self._unclear(), *self._slow(times)]
        if self.missing:
            left = len(self.missing) - _LISTED
            more = message(f" and {arg(left)} more") if left > 0 else ""
            reasons.append(
                message(f"too few accepted touches of {arg(join(', ', self.missing[:_LISTED]))}{arg(more)}")
            )
        reasons += self.faults
        notes = [] if times is not None else [message("time: not measured")]
        if self.left_out:
            said = ", ".join(f"{name} ({why})" for name, why in self.left_out.items())
            notes.append(message(f"skipped on purpose: {arg(said)}: contacts there are not verified"))
        if self.markers < FEWEST_MARKERS:
            many = message("1 marker was")
            if self.markers != 1:
                many = message(f"{arg(self.markers)} markers were")
            few = message(
                f"too few to judge the whole probe: {arg(many)} touched, at least {arg(FEWEST_MARKERS)} are needed"
            )
            notes.append(few)
        return VerificationVerdict(not reasons, tuple(reasons), tuple(notes))

    def errors(self) -> Iterator[str]:
        """Yield what errors do not keep their limits."""
        if self.overall is None:
            yield message("no touch was accepted")
            return
        for name, size, limit in (
            ("mean", self.overall.mean_mm, self.limits.mean_m),
            ("largest", self.overall.max_mm, self.limits.max_m),
        ):
            if size > 1e3 * limit:
                yield message(f"the {arg(name)} error is {arg(size):.2f} mm, over {arg(1e3 * limit):g} mm")

    def _unclear(self) -> Iterator[str]:
        found = self.unresolved
        if found is not None and found.share > MOST_UNRESOLVED:
            kinds = ", ".join(f"{self.rejected[why]} {why}" for why in UNRESOLVED if self.rejected.get(why))
            yield message(
                f"{arg(found.touches)} of {arg(found.settled)} settled touches match no marker ({arg(kinds)}): their"
                " points may be wrong"
            )

    def _slow(self, times: Times | None) -> Iterator[str]:
        if times is not None and times.p99_s > self.limits.p99_s:
            took, most = 1e3 * times.p99_s, 1e3 * self.limits.p99_s
            yield message(f"99 % of solves take up to {arg(took):.3g} ms, more than {arg(most):g} ms")


def unresolved(figures: Sequence[TouchFigure], limits: VerificationLimits) -> Unresolved | None:
    """
    Count settled touches that no marker could be given to; None: nothing settled.

    One that was called ambiguous while its first answer keeps the limit at a marker is none of them: the program
    warned, and the answer was right.
    """
    count = sum(
        figure.reason in UNRESOLVED
        and not (
            figure.reason == Why.AMBIGUOUS
            and figure.distance_mm is not None
            and figure.distance_mm <= 1e3 * limits.max_m
        )
        for figure in figures
    )
    settled = count + sum(figure.accepted for figure in figures)
    return Unresolved(count, settled, count / settled) if settled else None


def missing(
    figures: Sequence[TouchFigure], names: Sequence[str], windows: Sequence[Interval], wanted: int
) -> tuple[str, ...]:
    """Return markers with fewer accepted touches than wanted in each window."""
    counts = Counter((figure.marker, figure.window_N) for figure in figures if figure.accepted)
    short = [(name, window) for name in names for window in windows if counts[name, window] < wanted]
    several = len(windows) > 1
    return tuple(
        message(f"{arg(name)} ({arg(low):g} to {arg(high):g} N)") if several else name
        for name, (low, high) in short
    )


def crowded(markers: MarkerSet, limits: VerificationLimits) -> tuple[str | None, bool]:
    """
    Tell whether markers are so close that a wrong contact may be taken for the neighbour's.

    Returns
    -------
    str or None
        The sentence; None: they are far enough apart.
    bool
        It cannot be told at all: two contacts within the limits may swap.
    """
    if len(markers) < 2:
        return None, False
    from scipy.spatial import cKDTree

    found = cKDTree(markers.points).query(markers.points, k=2)
    away, other = np.asarray(found[0]), np.asarray(found[1])
    closest = int(np.argmin(away[:, 1]))
    pitch, needed = float(away[closest, 1]), 2 * limits.max_m + _ROOM
    if pitch >= needed:
        return None, False
    a, b = markers[closest].name, markers[int(other[closest, 1])].name
    said = message(
        f"markers {arg(a)} and {arg(b)} are {arg(1e3 * pitch):.1f} mm apart; {arg(1e3 * needed):g} mm are needed to"
        " tell a wrong contact from a touch of the neighbour. Give the order of the touches, or"
        " skip markers"
    )
    return said, pitch < 2 * limits.max_m


_CHECKS = {
    Why.MISSED: message(
        "miss the probe: check the units (N, N·m, mm), the signs and the mount of the sensor, and the alignment"
        " of the probe."
    ),
    Why.IMPLAUSIBLE: message(
        "leave a torque that no single touch explains: press with a freely turning tip, and make sure"
        " nothing else touches the probe."
    ),
}


def checks(figures: Sequence[TouchFigure]) -> list[str]:
    """Return what to check if most settled touches miss the probe, or are none."""
    settled = sum(figure.accepted or figure.reason in UNRESOLVED for figure in figures)
    counts = Counter(figure.reason for figure in figures)
    return [
        message(f"{arg(counts[why])} of {arg(settled)} settled touches {arg(words)}")
        for why, words in _CHECKS.items()
        if 2 * counts[why] > settled
    ]
