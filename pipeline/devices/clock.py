"""When samples were measured: one clock for all devices, from arrivals that are late by an unknown time."""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Sequence
from dataclasses import fields, replace
from enum import IntEnum
from itertools import chain, pairwise
from operator import attrgetter
from typing import TypeVar

from contactbench.pipeline.devices.sample import FlangeSample, Status, WrenchSample

Sample = TypeVar("Sample", WrenchSample, FlangeSample)
_Point = tuple[float, float]  # place and arrival, both since the line began

_BLOCK_S, _WINDOW_S = 0.25, 20.0
_SETTLE_S = 1.0  # before that the nominal period is better than one measured through jitter
_SETTLED_S = _SETTLE_S + 2 * _BLOCK_S
_YOUNG_S, _GAIN_S = 5.0, 5e-4  # a young line keeps its slope unless another is so much nearer to the points
_GUESSED_PERIOD_S = 1e-3  # spreads the first batch of a device whose rate is unknown

# No sample is measured after it arrives: one that seems to be was counted wrong, unless the line is still settling.
_AHEAD_S, _AHEAD_SETTLING_S = 0.03, 0.25
# A hold-up ends with a sample that is on time. If none is for so long, the count began anew.
_LATE_S, _LATE_FOR_S, _LATE_BATCHES = 0.1, 0.5, 3
_SILENCE_S, _SILENCE_UNCOUNTED_S = 1.0, 0.1  # without a count, what a gap held up looks like what it lost
_LEAPS, _LEAPS_WITHIN_S = 3, 10.0  # a clock or count that leaps so often is not used any more
_SHORTEST, _LONGEST = 1e-3, 1e6  # usual steps: beyond, a device's number is no step from the one before
_GUESS_S = 0.2

# Without a count, a lost sample makes all later ones seem a period late: believed after so many batches.
_LOST_BATCHES, _LOST_S, _LOST_PERIODS = 6, 0.08, 0.75
_SLOWEST = 0.5  # share of the rate at which times go on while they wait for a line that came down


class _Source(IntEnum):
    """Where the distance between samples is taken from; the best first."""

    CLOCK = 0
    COUNT = 1
    INDEX = 2


class SampleClock:
    """
    Gives each sample the time at which it was measured.

    That time is linear in the device's clock or count, or in a plain index where there is neither; the sample arrives
    later, by a delay that is never negative. So the line lies below all arrivals and as near to them as possible: it
    is the middle edge of their lower convex hull (Moon, Skelly and Towsley, INFOCOM 1999), over the last 20 s.
    Arrivals do not show the shortest delay itself: times are late by that much.

    Times increase strictly. None is later than its arrival, as long as the arrivals of batches increase. When the
    line comes down, times wait for it at half the rate.

    Parameters
    ----------
    rate : float or None
        Nominal, Hz. None: unknown, and measured.
    """

    def __init__(self, rate: float | None = None) -> None:
        self._nominal = 1.0 / rate if rate else None
        self._line: _Line | None = None
        self._anew = True
        self._source: _Source | None = None
        self._best = _Source.CLOCK  # of the sources that are still trusted
        self._mark = 0.0  # of the last sample: the source's own number
        self._step = 1.0  # that is usual
        self._place = 0.0  # the same made to run on: what the line is linear in
        self._arrived = self._time = self._anchored = -math.inf
        self._late, self._behind = _Stay(), _Stay()
        self._leaps: deque[float] = deque(maxlen=_LEAPS)

    @property
    def leapt(self) -> bool:
        """Whether times are a guess: the line began anew within the last 0.2 s, and not at the stream's start."""
        return self._arrived - self._anchored <= _GUESS_S

    def forget(self) -> None:
        """Begin anew with the next batch: the device was connected again."""
        self._anew = True

    def stamp(self, samples: Sequence[Sample]) -> list[Sample]:
        """
        Time samples that arrived together.

        Parameters
        ----------
        samples : sequence of WrenchSample or FlangeSample
            Oldest first, with one arrival.

        Returns
        -------
        list
            The same with `time` and `arrival`; wrenches after a leap have `Status.CLOCK` too.
        """
        if not samples:
            return []
        arrival = samples[0].arrived
        if arrival < self._arrived:  # another host clock: nothing holds that was learned from it
            self._time, self._anew = -math.inf, True
        places = self._advance(samples)
        line = self._follow(places, arrival)
        line.add(places[-1], arrival)
        times = self._times(line, places, arrival)
        self._arrived, self._time, self._place = arrival, times[-1], places[-1]
        return [_stamped(each, time, arrival, self.leapt) for each, time in zip(samples, times, strict=True)]

    def _advance(self, samples: Sequence[Sample]) -> list[float]:
        """Return the samples' places; where the device's own numbers do not go on, begin anew."""
        source, marks = _marks(samples, self._best)
        if source is not self._source:
            self._source, self._line, self._anew = source, None, True
            self._step = 1.0 if source is not _Source.CLOCK else self._nominal or _GUESSED_PERIOD_S
        mark = None if self._anew else self._mark
        place, places = self._place, []
        for each in marks:
            step = self._step if mark is None or source is _Source.INDEX else each - mark
            if not _SHORTEST * self._step < step < _LONGEST * self._step:
                self._leap(samples[0].arrived)
                step = self._step
            place, mark = place + step, each
            places.append(place)
        self._mark = marks[-1]
        return places

    def _follow(self, places: list[float], arrival: float) -> _Line:
        """Return the line, begun anew if the batch does not belong to it; without a count, lost samples are counted."""
        line = self._line
        if line is None or self._anew:
            return self._anchor(places[-1], arrival)
        delay, age = line.delay(places[-1], arrival), line.age(arrival)
        self._late.see(delay, _LATE_S, arrival)
        ahead = _AHEAD_S if age > _SETTLED_S else _AHEAD_SETTLING_S
        if (age > _GUESS_S and delay < -ahead) or (
            age > _SETTLED_S and self._late.lasts(_LATE_BATCHES, _LATE_FOR_S, arrival)
        ):
            self._leap(arrival)
        silence = _SILENCE_UNCOUNTED_S if self._source is _Source.INDEX else _SILENCE_S
        if self._anew or (delay > _LATE_S and arrival - self._arrived > silence):
            return self._anchor(places[-1], arrival)
        if self._source is _Source.INDEX and line.known:
            self._behind.see(delay, _LOST_PERIODS * line.period, arrival)
            if self._behind.lasts(_LOST_BATCHES, _LOST_S, arrival):
                lost = max(round(self._behind.least / line.period), 1)
                places[:] = [place + lost for place in places]
                self._behind = _Stay()
        return line

    def _leap(self, arrival: float) -> None:
        """Begin anew because the device's numbers are wrong; if that happens often, do without them."""
        self._anew = True
        self._leaps.append(arrival)
        often = len(self._leaps) == _LEAPS and arrival - self._leaps[0] < _LEAPS_WITHIN_S
        if often and self._source is not None and self._source is not _Source.INDEX:
            self._best = _Source(self._source + 1)
            self._leaps.clear()

    def _anchor(self, place: float, arrival: float) -> _Line:
        """Begin a line whose newest sample arrives without delay."""
        period = 1.0 if self._source is _Source.CLOCK else self._nominal
        if self._line is not None and self._line.known:
            period = self._line.period
        self._line = line = _Line(place, arrival, period)
        self._anchored = -math.inf if self._arrived == -math.inf else arrival
        self._anew, self._late, self._behind = False, _Stay(), _Stay()
        return line

    def _times(self, line: _Line, places: list[float], arrival: float) -> list[float]:
        """Return the line's times, slowed down where it came down below times that were given."""
        times, time, before, last = [], self._time, self._place, places[-1]
        for place in places:
            on_line = min(line.time(place), arrival)
            if time > -math.inf:
                step = place - before
                waiting = time + min(_SLOWEST * line.period * step, (arrival - time) * step / (last - before))
                on_line = max(on_line, waiting, math.nextafter(time, math.inf))
            times.append(on_line)
            time, before = on_line, place
        return times


class _Stay:
    """For how long, and how many batches, delays have stayed above a bound."""

    def __init__(self) -> None:
        self.least, self._count, self._since = math.inf, 0, 0.0

    def see(self, delay: float, bound: float, arrival: float) -> None:
        if delay <= bound:
            self.least, self._count = math.inf, 0
            return
        self._since = self._since if self._count else arrival
        self.least, self._count = min(self.least, delay), self._count + 1

    def lasts(self, batches: int, seconds: float, arrival: float) -> bool:
        return self._count >= batches and arrival - self._since >= seconds


class _Line:
    """
    A line below points (place, arrival), as near to those of the last 20 s as possible.

    Parameters
    ----------
    place, arrival : float
        First point.
    period : float or None
        Slope, s per unit of place, until it can be measured; None: the first points show it.
    """

    def __init__(self, place: float, arrival: float, period: float | None) -> None:
        self._place, self._arrival = place, arrival
        self.period = period or _GUESSED_PERIOD_S
        self.known = period is not None
        self._offset = 0.0
        self._blocks: deque[list[_Point]] = deque()  # the lower hull of each
        self._block_end = 0.0

    def time(self, place: float) -> float:
        """Return when the sample of a place was measured, s."""
        return self._arrival + self._offset + self.period * (place - self._place)

    def delay(self, place: float, arrival: float) -> float:
        """Return how much later than that it arrived, s."""
        return arrival - self.time(place)

    def age(self, arrival: float) -> float:
        """Return the time since the first point, s."""
        return arrival - self._arrival

    def add(self, place: float, arrival: float) -> None:
        """Take a point right of all others."""
        point = place - self._place, arrival - self._arrival
        new = not self._blocks or point[1] >= self._block_end
        if new:
            self._blocks.append([])
            self._block_end = point[1] + _BLOCK_S
        _append(self._blocks[-1], point)
        while self._blocks[0][-1][1] < point[1] - _WINDOW_S:
            self._blocks.popleft()
        if point[1] < _SETTLE_S and not self.known:
            if point[1] > 0:
                self._turn(point[1] / point[0])
        elif new and point[1] - self._blocks[0][0][1] >= _SETTLE_S:
            self._fit()
        self._offset += min(self.delay(place, arrival), 0.0)

    def _fit(self) -> None:
        hull: list[_Point] = []
        for point in chain.from_iterable(self._blocks):
            _append(hull, point)
        span = hull[-1][1] - hull[0][1]
        # The middle of the time, not of the points: what had waited unread comes all at once.
        middle = hull[0][1] + span / 2
        left, right = next(edge for edge in pairwise(hull) if edge[1][1] >= middle)
        period = (right[1] - left[1]) / (right[0] - left[0])
        place = left[0] + (middle - left[1]) / period
        gain = middle - min(v + self.period * (place - u) for u, v in hull)
        self._turn(self.period if self.known and span < _YOUNG_S and gain < _GAIN_S else period)
        self.known = True

    def _turn(self, period: float) -> None:
        """Take a slope, and go up to the points again."""
        self.period = period
        self._offset = min(v - period * u for u, v in chain.from_iterable(self._blocks))


def _append(hull: list[_Point], point: _Point) -> None:
    """Add a point on the right to a lower convex hull."""
    while len(hull) > 1:
        (u0, v0), (u1, v1), (u, v) = hull[-2], hull[-1], point
        if (u1 - u0) * (v - v0) > (v1 - v0) * (u - u0):
            break
        hull.pop()
    hull.append(point)


def _marks(samples: Sequence[WrenchSample | FlangeSample], best: _Source) -> tuple[_Source, list[float]]:
    """Return the best source that all samples have, and its numbers."""
    if best is _Source.CLOCK:
        clock = [each.device_time for each in samples if each.device_time is not None]
        if len(clock) == len(samples) and all(map(math.isfinite, clock)):
            return _Source.CLOCK, clock
    if best is not _Source.INDEX:
        wrenches = [each for each in samples if isinstance(each, WrenchSample)]
        counts: list[float] = [each.sequence for each in wrenches if each.sequence is not None]
        if len(counts) == len(samples):
            return _Source.COUNT, counts
    return _Source.INDEX, [0.0] * len(samples)


# As `dataclasses.replace`, a thousand times a second.
_fields_of = attrgetter(*(field.name for field in fields(WrenchSample)))


def _stamped(sample: Sample, time: float, arrival: float, leapt: bool) -> Sample:
    if isinstance(sample, WrenchSample):
        status = sample.status | Status.CLOCK if leapt else sample.status
        _, force, torque, count, _, device_time, temperature, _ = _fields_of(sample)
        return WrenchSample(time, force, torque, count, status, device_time, temperature, arrival)
    return replace(sample, time=time, arrival=arrival)
