"""What the numbers themselves give away: flags, hanging, ends of range, warming."""

import math
from collections import deque
from collections.abc import Iterable
from dataclasses import dataclass

from contactbench.pipeline.devices.sample import FROZEN_CHANCE, Status, WrenchSample
from contactbench.pipeline.errors import arg, join, message
from contactbench.pipeline.kernel import FrozenDetector

# Of a channel at the end of its range: noise changes the last digit of any other in this time.
_STILL_S, _STILL_SAMPLES = 0.12, 10
# A flag of one sample must be seen by people too.
_HELD_S = 0.5
# A quiet channel of a coarse sensor may stand still for a while; at so much load none does.
_LOADED = (10.0,) * 3 + (0.5,) * 3  # N, N·m
_MOVED = 50  # changes of a channel before its largest value so far means anything
_WARMER_K = 3.0
_LEARN_S = 0.5
_CHANNELS = ("Fx", "Fy", "Fz", "Mx", "My", "Mz")
_UNITS = ("N",) * 3 + ("N·m",) * 3


class Readings:
    """
    Looks at the numbers of a force/torque sensor.

    A channel that is exactly constant at the largest value it ever had is taken to be at its end. Sensors
    that mix their gauges by a matrix may be at the end of a gauge without any such sign.

    Parameters
    ----------
    limits : (force, torque) or None
        Range of each channel, N and N·m, where the driver knows it.
    """

    def __init__(self, limits: tuple[float, float] | None = None) -> None:
        self._limits = None if limits is None else (limits[0],) * 3 + (limits[1],) * 3
        self._now = 0.0
        self._last: tuple[float, ...] | None = None
        self._detector, self._frozen = FrozenDetector(), False
        self._since = [0.0] * 6
        self._same = [0] * 6
        self._moved = [0] * 6
        self._largest = [0.0] * 6
        self._held: dict[Status, float] = {}
        self._beyond = float("-inf")
        self._temperature: float | None = None
        self._first_temperatures: list[tuple[float, float]] = []
        self._reference: float | None = None

    def see(self, sample: WrenchSample) -> None:
        """Take one sample."""
        self._now = sample.time
        values = (*sample.force, *sample.torque)
        self._frozen = self._detector.see(values, FROZEN_CHANCE)
        self._compare(values)
        self._last = values
        if sample.status:
            self._held.update({flag: sample.time for flag in _FLAGS if flag in sample.status})
        if self._limits and any(abs(v) >= limit for v, limit in zip(values, self._limits, strict=True)):
            self._beyond = sample.time
        if sample.temperature is not None:
            self._warm(sample.time, sample.temperature)

    def forget(self) -> None:
        """Begin anew, after a gap; the first temperature and the largest values stay."""
        self._last = None
        self._same = [0] * 6
        self._detector, self._frozen = FrozenDetector(), False

    def acknowledge(self) -> None:
        """Take the temperature of now as the one to compare with."""
        if self._temperature is not None:
            self._reference = self._temperature

    def findings(self) -> dict[str, str]:
        """Return what is wrong, by kind."""
        found = {
            flag.name or str(flag): _FLAGS[flag]
            for flag, time in self._held.items()
            if self._now - time <= _HELD_S
        }
        if Status.ERROR in self._held and "ERROR" in found:
            # With an error no reading is a measurement: the error is what can be mended.
            found.pop("INVALID", None)
        if self._now - self._beyond <= _HELD_S:
            found["range"] = message(
                "A channel is beyond the sensor's range: remove the load, and use less force."
            )
        at_end = [k for k in range(6) if self._at_end(k)]
        if at_end and self._last is not None:
            which = join(
                ", ",
                (
                    message(f"{arg(_CHANNELS[k])} at {arg(self._last[k]):.4g} {arg(_UNITS[k])}")
                    for k in at_end
                ),
            )
            found["end"] = message(
                f"{arg(which)}: exactly the same for {arg(min(self._same[k] for k in at_end))} samples, and"
                " farther than ever before: this looks like the end of the range. Remove the"
                " load, and use less force."
            )
        elif self._frozen:
            found["frozen"] = message(
                f"No channel has changed for {arg(min(self._same))} samples: the sensor hangs, or is"
                " disconnected from its box. Switch it off and on."
            )
        return found | self._warmed()

    def _compare(self, values: tuple[float, ...]) -> None:
        last = self._last
        for k, value in enumerate(values):
            if last is not None and value == last[k]:
                self._same[k] += 1
                continue
            if last is not None:
                if abs(last[k]) > self._largest[k]:
                    self._largest[k] = abs(last[k])
                self._moved[k] += 1
            self._same[k], self._since[k] = 0, self._now

    def _still(self, channel: int) -> bool:
        return self._same[channel] >= _STILL_SAMPLES and self._now - self._since[channel] >= _STILL_S

    def _at_end(self, channel: int) -> bool:
        if self._last is None or not self._still(channel) or self._moved[channel] < _MOVED:
            return False
        return abs(self._last[channel]) > max(self._largest[channel], _LOADED[channel])

    def _warm(self, time: float, temperature: float) -> None:
        self._temperature = temperature
        if self._reference is not None:
            return
        first = self._first_temperatures
        first.append((time, temperature))
        if time - first[0][0] >= _LEARN_S:
            ordered = sorted(each for _, each in first)
            self._reference = ordered[len(ordered) // 2]
            first.clear()

    def _warmed(self) -> dict[str, str]:
        if self._reference is None or self._temperature is None:
            return {}
        warmer = self._temperature - self._reference
        if abs(warmer) <= _WARMER_K:
            return {}
        return {
            "temperature": message(
                f"The sensor is {arg(abs(warmer)):.1f} K {arg('warmer' if warmer > 0 else 'colder')} than at the"
                " start, and its zero drifts with it: let it settle, then recalibrate."
            )
        }


_FLAGS = {
    Status.OVERRANGE: message("A channel is at the end of its range: remove the load, and use less force."),
    Status.INVALID: message("The sensor reports that its readings are invalid: switch it off and on."),
    Status.ERROR: message(
        "The sensor reports an error or overload: remove the load. If that does not help, check its"
        " own display or manual."
    ),
    Status.LATE: message("The sensor cannot keep its rate: choose a lower one."),
    Status.RAW: message("The readings are raw, not calibrated by the sensor: set it to engineering units."),
}


# ---- was the sensor zeroed in the middle of a stream? A suspicion, from the readings alone -------


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
        near = max(map(abs, sample.force)) <= _ZERO_N and max(map(abs, sample.torque)) <= _ZERO_NM
        if near and not self._zero_is_usual and self._rested():
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
