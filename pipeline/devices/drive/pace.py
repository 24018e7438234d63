"""How fast samples come, and how evenly."""

from __future__ import annotations

from collections import deque
from itertools import pairwise
from statistics import median

_SHOWN = 400  # samples that the rate and jitter that people see are taken from
_ENOUGH = 50
_MOST = 4096
# Half the rate must show within 0.2 s; in so short a time a burst is worth a third of the samples.
_SHORT_S, _SHORT_SAMPLES, _SHORT_OFF = 0.17, 5, 0.4
# A small difference takes long to tell from a burst at either end.
_LONG_S, _LONG_OFF = 2.0, 0.1
# What waited in a buffer while nobody read comes at once: it says nothing of the rate.
_SETTLE_S = 0.1
# A backlog may come some time after the first sample, too: no rate is judged by less than this.
_FIRST_S = 0.5
# After one long gap what was held up may still be coming, and is not missing.
_GAP_S, _GAP_SAMPLES, _CATCH_UP_S = 0.04, 3, 0.02
_LEARN_S = 1.0


class Pace:
    """
    Measures rate and jitter by arrival.

    Parameters
    ----------
    rate : float or None
        That should come, Hz; None: the device has one of its own, and what comes in the first second is it.
    """

    def __init__(self, rate: float | None) -> None:
        self._expected = rate
        self._times: deque[float] = deque(maxlen=_MOST)
        self._first: float | None = None
        self._gapped = False
        self._gap = (0.0, 0.0)
        self._longest = 0.0

    def see(self, time: float) -> None:
        """Take the arrival of one sample, s."""
        if self._first is None:
            self._first = time
        if time < self._first + _SETTLE_S:
            return
        times = self._times
        if times:
            self._look_at_gap(times[-1], time)
            self._longest = max(self._longest, time - times[-1])
        times.append(time)
        while times[0] < time - _LONG_S:
            times.popleft()
        if self._expected is None and time - times[0] >= _LEARN_S:
            self._expected = _rate(list(times))

    def forget(self) -> None:
        """Begin anew, after a gap."""
        self._times.clear()
        self._first = None
        self._gapped = False
        self._longest = 0.0

    def rate(self) -> float | None:
        """Return the rate of the last samples, Hz; None before there are enough."""
        times = list(self._times)[-_SHOWN:]
        return _rate(times) if len(times) >= _ENOUGH else None

    def jitter(self) -> float | None:
        """Return how unevenly the last samples came, s; None before there are enough."""
        gaps = self._gaps()
        if not gaps:
            return None
        middle = median(gaps)
        return sorted(abs(gap - middle) for gap in gaps)[int(0.95 * len(gaps))]

    def lateness(self) -> tuple[float, float] | None:
        """Return the 99th percentile of the last samples and the largest since a gap, s; None before there are enough.

        Late is what comes later after the sample before than is usual.
        """
        gaps = self._gaps()
        if not gaps:
            return None
        usual = median(gaps)
        return max(sorted(gaps)[int(0.99 * len(gaps))] - usual, 0.0), max(self._longest - usual, 0.0)

    def _gaps(self) -> list[float]:
        times = list(self._times)[-_SHOWN:]
        return [b - a for a, b in pairwise(times)] if len(times) >= _ENOUGH else []

    def findings(self) -> dict[str, str]:
        """Return what is wrong, by kind."""
        wrong = self._wrong()
        if wrong is None or self._expected is None:
            return {}
        rates = f"{wrong:.0f} Hz instead of {self._expected:.0f} Hz"
        return {"rate": f"Samples come at {rates}: check the rate and the line's speed."}

    def _look_at_gap(self, last: float, time: float) -> None:
        gapped = time - last > max(_GAP_S, _GAP_SAMPLES / (self._expected or 1.0))
        if gapped and not self._gapped:
            self._gap = (last, time + _CATCH_UP_S)
        if time > last:  # what comes at once belongs to the gap before it
            self._gapped = gapped

    def _wrong(self) -> float | None:
        """Return the rate if it is wrong, Hz."""
        times, expected = self._times, self._expected
        if not times or expected is None or self._first is None:
            return None
        last = times[-1]
        if last - self._first < _FIRST_S:
            return None
        short = max(_SHORT_S, _SHORT_SAMPLES / expected)
        # A window that begins in the gap has what was held up, and not the time in which it should have come.
        begin, end = self._gap
        judged = last >= end and not begin <= last - short < end
        if judged and times[0] <= last - short:
            rate = _count_after(times, last - short) / short
            if abs(rate / expected - 1) > _SHORT_OFF:
                return rate
        if times[0] <= last - _LONG_S / 2 and len(times) >= _ENOUGH:
            rate = _rate(list(times)) or expected
            if abs(rate / expected - 1) > _LONG_OFF:
                return rate
        return None


def _rate(times: list[float]) -> float | None:
    return (len(times) - 1) / (times[-1] - times[0]) if len(times) > 1 and times[-1] > times[0] else None


def _count_after(times: deque[float], start: float) -> int:
    count = 0
    for time in reversed(times):
        if time <= start:
            break
        count += 1
    return count
