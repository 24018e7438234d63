"""Was the sensor zeroed in the middle of a stream? A suspicion, from the readings alone."""

from __future__ import annotations

import math
from collections import deque
from dataclasses import dataclass
from typing import TYPE_CHECKING

from contactbench.pipeline.errors import arg, message

if TYPE_CHECKING:
    from collections.abc import Iterable

    from contactbench.pipeline.devices.sample import WrenchSample

_LOOK_S = 0.1  # of rest before the step and of rest after it
_FEWEST = 8
# A smaller step does no harm that a calibration check would not find, and touches make many of them.
_STEP_N, _STEP_NM = 1.5, 0.1
# How near zero is, beside the noise: a sensor takes the mean of a few readings for its zero.
_ZERO_N, _ZERO_NM = 0.3, 0.02
# Somebody who zeroes a sensor does not move it meanwhile; what rings or slides was a load.
_REST_N, _REST_NM = 1.0, 0.05
_NOISIER = 2.0
_GAP_S = 1.0


@dataclass(frozen=True)
class ZeroStep:
    """A step to zero that no load explains."""

    time: float  # of the first reading after it, s
    # Size of the step, N and N·m.
    force: float
    torque: float

    def __str__(self) -> str:
        """Return what an operator is told."""
        return message(
            f"The reading jumped by {arg(self.force):.1f} N and {arg(self.torque):.2f} N·m within one"
            " sample, to nearly zero in all six channels, and stayed there: the sensor may have"
            " been re-zeroed. If so, recalibrate."
        )


class RezeroDetector:
    """
    Looks for a step from rest to rest at zero, between two samples.

    Loads come and go over several samples, ring, or leave the weight of the tool behind. A sensor that was
    at zero before may well return there within a sample, when a touch ends: after rest at zero nothing is
    suspected any more. So a second re-zero, one below 1.5 N and 0.1 N·m, and one during motion are missed.
    """

    def __init__(self) -> None:
        self._before: deque[WrenchSample] = deque()
        self._after: list[WrenchSample] = []
        self._zero_is_usual = False

    def feed(self, sample: WrenchSample) -> ZeroStep | None:
        """Take the next sample; return what is suspected since a tenth of a second."""
        last = self._after[-1] if self._after else self._before[-1] if self._before else None
        if last is None or sample.time - last.time > _GAP_S or not _finite(sample):
            self._restart(sample)
        elif self._after:
            return self._confirm(sample)
        elif not self._zero_is_usual and _stepped(last, sample) and self._rested():
            self._after = [sample]
        else:
            self._keep(sample)
        return None

    def _keep(self, sample: WrenchSample) -> None:
        before = self._before
        before.append(sample)
        while len(before) > _FEWEST and before[1].time <= sample.time - _LOOK_S:
            before.popleft()
        if not self._zero_is_usual and _near_zero([sample], 0.0, 0.0) and self._rested():
            self._zero_is_usual = _near_zero(before, 0.0, 0.0)

    def _confirm(self, sample: WrenchSample) -> ZeroStep | None:
        """Judge the step once there was rest after it, or had none."""
        self._after.append(sample)
        after, first = self._after, self._after[0]
        forces, torques = _spreads(self._before)
        if not _resting(after, max(_NOISIER * forces, _ZERO_N), max(_NOISIER * torques, _ZERO_NM)):
            self._give_up()
            return None
        if sample.time - first.time < _LOOK_S or len(after) < _FEWEST:
            return None
        found = self._judged(forces, torques)
        self._give_up()
        return found

    def _judged(self, force_noise: float, torque_noise: float) -> ZeroStep | None:
        before, after = _mean(self._before), _mean(self._after)
        force = math.dist(before[:3], after[:3])
        torque = math.dist(before[3:], after[3:])
        # The first reading after the step is already there: nothing in between.
        at_once = _near_zero(self._after[:1], force_noise, torque_noise)
        if not at_once or not _near_zero(self._after, 0.25 * force_noise, 0.25 * torque_noise):
            return None
        if force < _STEP_N and torque < _STEP_NM:
            return None
        return ZeroStep(self._after[0].time, force, torque)

    def _give_up(self) -> None:
        """Go on as if there had been no step."""
        after, self._after = self._after, []
        for sample in after:
            self._keep(sample)

    def _restart(self, sample: WrenchSample) -> None:
        self._before.clear()
        self._after = []
        if _finite(sample):
            self._before.append(sample)

    def _rested(self) -> bool:
        before = self._before
        enough = len(before) >= _FEWEST and before[-1].time - before[0].time >= 0.7 * _LOOK_S
        return enough and _resting(before, _REST_N, _REST_NM)


def _finite(sample: WrenchSample) -> bool:
    return all(map(math.isfinite, (*sample.force, *sample.torque)))


def _stepped(one: WrenchSample, two: WrenchSample) -> bool:
    return (
        math.dist(one.force, two.force) >= _STEP_N - _ZERO_N
        or math.dist(one.torque, two.torque) >= _STEP_NM - _ZERO_NM
    )


def _mean(samples: Iterable[WrenchSample]) -> tuple[float, ...]:
    rows = [(*sample.force, *sample.torque) for sample in samples]
    return tuple(sum(column) / len(rows) for column in zip(*rows, strict=True))


def _near_zero(samples: Iterable[WrenchSample], force: float, torque: float) -> bool:
    """Tell whether the mean of all channels is near zero, with so much more allowed, N and N·m."""
    mean = _mean(samples)
    return all(abs(v) <= _ZERO_N + force for v in mean[:3]) and all(
        abs(v) <= _ZERO_NM + torque for v in mean[3:]
    )


def _spreads(samples: Iterable[WrenchSample]) -> tuple[float, float]:
    """Return the widest range of a force, N, and of a torque, N·m."""
    rows = [(*sample.force, *sample.torque) for sample in samples]
    ranges = [max(column) - min(column) for column in zip(*rows, strict=True)]
    return max(ranges[:3]), max(ranges[3:])


def _resting(samples: Iterable[WrenchSample], force: float, torque: float) -> bool:
    forces, torques = _spreads(samples)
    return forces <= force and torques <= torque
