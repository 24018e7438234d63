"""What people look at, looked at by the program: all that is wrong with a stream while it streams."""

from bisect import bisect_right
from collections import deque
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from statistics import median

from contactbench.pipeline.devices.protocols import Counters
from contactbench.pipeline.devices.readings import Readings, RezeroDetector
from contactbench.pipeline.devices.sample import FlangeSample, WrenchSample
from contactbench.pipeline.errors import arg, message

# A silence is a fault after this, or after two frames of a slow device.
SILENCE_S = 0.12
_MOST_SUSPICIONS = 20


class Watch:
    """
    Looks at samples as they pass. It knows no clock but theirs; pace and leaps are judged by arrival.

    Parameters
    ----------
    rate : float
        Samples a second, Hz.
    rate_known : bool
        False: `rate` is a guess, and the device's own is taken from what comes first.
    limits : (force, torque) or None
        As for `Readings`.
    judged : bool
        False: there are no findings and no suspicions.
    """

    def __init__(
        self,
        rate: float,
        *,
        rate_known: bool = True,
        limits: tuple[float, float] | None = None,
        judged: bool = True,
    ) -> None:
        self._rate, self._judged = rate, judged
        self._pace = Pace(rate if rate_known else None)
        self._readings = Readings(limits)
        self._leap = Leap(rate)
        self._damage = Damage(rate)
        self._rezero = RezeroDetector()
        self._suspicions: tuple[str, ...] = ()
        self.samples = 0

    @property
    def patience(self) -> float:
        """Seconds without a sample after which the stream is silent."""
        return max(SILENCE_S, 2.0 / self._rate)

    @property
    def suspicions(self) -> tuple[str, ...]:
        """What may have happened, until `acknowledge`."""
        return self._suspicions if self._judged else ()

    def see(self, samples: Sequence[WrenchSample | FlangeSample]) -> None:
        """Take samples, oldest first."""
        for sample in samples:
            self._pace.see(sample.arrived)
            if self._leap.see(sample):
                self._damage.forgive()
            if isinstance(sample, WrenchSample):
                self._readings.see(sample)
                if (found := self._rezero.feed(sample)) and len(self._suspicions) < _MOST_SUSPICIONS:
                    self._suspicions = (*self._suspicions, str(found))
        self.samples += len(samples)

    def count(self, now: float, counters: Counters, received: int) -> None:
        """Take the parser's counters and the number of bytes so far; `now` in s."""
        self._damage.see(now, counters, received)

    @property
    def settled(self) -> bool:
        """Whether the counters may wait: none of them is being explained."""
        return not self._damage.forgiving

    def rest(self) -> None:
        """Begin to measure anew, after a silence; what damaged frames caused it is still told."""
        self._pace.forget()
        self._readings.forget()
        self._leap.forget()
        self._damage.forgive()

    def forget(self) -> None:
        """Begin to measure anew, after the line was lost."""
        self.rest()
        self._damage.forget()

    def acknowledge(self) -> None:
        """Drop what was suspected: somebody has read it. The temperature counts from now."""
        self._suspicions = ()
        self._readings.acknowledge()

    def rate(self) -> float | None:
        """Return the measured rate, Hz; None before there are enough samples."""
        return self._pace.rate()

    def jitter(self) -> float | None:
        """Return how unevenly samples arrive, s; None before there are enough."""
        return self._pace.jitter()

    def lateness(self) -> tuple[float, float] | None:
        """Return the 99th percentile and the largest lateness, s; None before there are enough samples."""
        return self._pace.lateness()

    def damage(self) -> dict[str, str]:
        """Return what is wrong with the bytes, by kind; also while no sample comes."""
        return self._damage.findings()

    def findings(self) -> dict[str, str]:
        """Return what is wrong, by kind, in sentences."""
        if not self._judged:
            return {}
        readings, pace, leap = self._readings.findings(), self._pace.findings(), self._leap.findings()
        return readings | pace | leap | self.damage()


# ---- how fast samples come, and how evenly -----------------------------------------------------

_RECENT = 400  # samples that the rate and jitter that people see are taken from
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
_GAP_S, _GAP_SAMPLES, _CATCH_UP_S = 0.04, 3, 0.1
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
        self._owed = self._least = 0.0  # samples that time asks for and that did not come
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
            self._expected = _mean_rate(list(times))

    def forget(self) -> None:
        """Begin anew, after a gap."""
        self._times.clear()
        self._first = None
        self._gapped = False
        self._longest = 0.0

    def rate(self) -> float | None:
        """Return the rate of the last samples, Hz; None before there are enough."""
        times = list(self._times)[-_RECENT:]
        return _mean_rate(times) if len(times) >= _ENOUGH else None

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
        times = list(self._times)[-_RECENT:]
        return [b - a for a, b in pairwise(times)] if len(times) >= _ENOUGH else []

    def findings(self) -> dict[str, str]:
        """Return what is wrong, by kind."""
        wrong = self._wrong()
        if wrong is None or self._expected is None:
            return {}
        rates = message(f"{arg(wrong):.0f} Hz instead of {arg(self._expected):.0f} Hz")
        return {"rate": message(f"Samples arrive at {arg(rates)}: check the rate and the line speed.")}

    def _look_at_gap(self, last: float, time: float) -> None:
        expected = self._expected or 1.0
        gapped = time - last > max(_GAP_S, _GAP_SAMPLES / expected)
        self._owed = max(self._owed, 0.0) + (time - last) * expected - 1
        if gapped and not self._gapped:
            self._gap, self._least = (last, time + _CATCH_UP_S), self._owed
        elif _GAP_SAMPLES < self._owed < self._least - 1:  # still what was held up
            self._gap, self._least = (self._gap[0], time + _CATCH_UP_S), self._owed
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

        def judged(start: float) -> bool:
            return last >= end and not begin <= start < end

        if judged(last - short) and times[0] <= last - short:
            rate = (len(times) - bisect_right(times, last - short)) / short
            if abs(rate / expected - 1) > _SHORT_OFF:
                return rate
        if judged(times[0]) and times[0] <= last - _LONG_S / 2 and len(times) >= _ENOUGH:
            rate = _mean_rate(list(times)) or expected
            if abs(rate / expected - 1) > _LONG_OFF:
                return rate
        return None


def _mean_rate(times: list[float]) -> float | None:
    return (len(times) - 1) / (times[-1] - times[0]) if len(times) > 1 and times[-1] > times[0] else None


# ---- leaps of a device's clock or count that no gap in time explains ----------------------------

_LEAP_S = 0.25  # more than samples wait in buffers
_COMPARED = 5  # samples over which the two clocks are compared
_LEAP_SETTLE = 3  # after a gap: a parser believes a new count with the frame after it
_LEAP_SHOWN_S = 2.0


class Leap:
    """
    Compares the device's clock, or its count, with arrival.

    Parameters
    ----------
    rate : float
        Samples a second, to make a time of a count.
    """

    def __init__(self, rate: float) -> None:
        self._rate = rate
        self._pairs: deque[tuple[float, float]] = deque(maxlen=_COMPARED)
        self._settling = _LEAP_SETTLE
        self._now = 0.0
        self._size, self._at = 0.0, float("-inf")

    def see(self, sample: WrenchSample | FlangeSample) -> bool:
        """Take one sample; tell whether the clock leapt with it."""
        self._now = sample.arrived
        device = self._device(sample)
        if device is None:
            return False
        if self._settling:
            self._settling -= 1
            return False
        here = (sample.arrived, device)
        self._pairs.append(here)
        arrived, told = self._pairs[0]
        ahead = (device - told) - (sample.arrived - arrived)
        # Behind is no leap: what comes late comes late.
        if ahead <= _LEAP_S:
            return False
        self._size, self._at = ahead, sample.arrived
        self._pairs.clear()
        return True

    def forget(self) -> None:
        """Begin anew, after a gap."""
        self._pairs.clear()
        self._settling = _LEAP_SETTLE

    def findings(self) -> dict[str, str]:
        """Return what is wrong, by kind; a leap is shown for some seconds."""
        if self._now - self._at > _LEAP_SHOWN_S:
            return {}
        return {
            "leap": message(
                f"The device's clock or counter jumped ahead by {arg(self._size):.1f} s while samples kept"
                " coming: its clock was set, or its counter is wrong. The times of the next 0.2 s are"
                " estimates and are marked."
            )
        }

    def _device(self, sample: WrenchSample | FlangeSample) -> float | None:
        if sample.device_time is not None:
            return sample.device_time
        if isinstance(sample, WrenchSample) and sample.sequence is not None:
            return sample.sequence / self._rate
        return None


# ---- what a parser had to throw away in the last second, and what never came --------------------

_WINDOW_S = 1.0
_SHARE = 0.01  # of frames or bytes: less is shown by the counters only
_STEP_S = 0.02
# A leap of a count is believed by a parser with the frame after it, so these few tell nothing of loss.
_SETTLE_FRAMES = 3
_NO_FRAME_BYTES = 64  # two of the longest sensor frames


@dataclass(frozen=True, slots=True)
class _Mark:
    time: float
    frames: int
    damaged: int
    skipped: int
    received: int
    lost: int
    restarts: int


class Damage:
    """
    Judges a parser's counters over the last second.

    Text that a device answers before it streams belongs to no frame either: judging begins with the first
    frames.

    Parameters
    ----------
    rate : float
        Frames a second that should come.
    """

    def __init__(self, rate: float) -> None:
        self._least = max(1.0, _SHARE * rate * _WINDOW_S)
        self._last = Counters()
        self._marks: deque[_Mark] = deque()
        self._lost = self._restarts = 0
        self.forgiving = 0  # until there are so many frames; -1: until some are counted
        self._since: int | None = None  # frames when the line was opened; None: judging has begun
        self.forget()

    def see(self, now: float, counters: Counters, received: int) -> None:
        """
        Take the counters as they are.

        Parameters
        ----------
        now : float
            s.
        counters : Counters
        received : int
            Bytes since the stream was made.
        """
        if self.forgiving < 0:
            self.forgiving = counters.frames + _SETTLE_FRAMES - 1
        if counters.frames >= self.forgiving:
            if not self.forgiving:
                self._lost += counters.lost - self._last.lost
                self._restarts += counters.restarts - self._last.restarts
            self.forgiving = 0
        self._last = counters
        if self._since is not None and counters.frames >= self._since + _SETTLE_FRAMES:
            self._since = None
            self._marks.clear()
        self._mark(now, received)

    def forgive(self) -> None:
        """Take the next step of the device's count for explained, by a silence or a leap that was shown."""
        self.forgiving = -1

    def forget(self) -> None:
        """Begin anew with the next frames: the line was lost."""
        self._marks.clear()
        self._since = self._last.frames
        self.forgive()

    def findings(self) -> dict[str, str]:
        """Return what is wrong, by kind."""
        if len(self._marks) < 2:
            return {}
        first, last = self._marks[0], self._marks[-1]
        if self._since is not None:
            return _without(first, last, self._since)
        found = {}
        damaged, frames = last.damaged - first.damaged, last.frames - first.frames
        skipped, received = last.skipped - first.skipped, last.received - first.received
        if damaged >= self._least:
            found["damaged"] = message(
                f"{arg(damaged)} of the last {arg(damaged + frames)} frames were damaged: check cable,"
                " shield and line speed."
            )
        elif skipped > 0 and skipped >= _SHARE * received:
            found["skipped"] = message(
                f"{arg(skipped)} of the last {arg(received)} bytes belong to no frame: check cable, shield"
                " and line speed, and that no other program uses the line."
            )
        if (lost := last.lost - first.lost) >= self._least:
            found["lost"] = message(
                f"{arg(lost)} of the last {arg(lost + frames)} samples were lost according to the device's"
                " own counter: check the line, or choose a lower rate."
            )
        if last.restarts > first.restarts:
            found["restarted"] = message(
                "The device's counter or clock restarted: it was switched off and on, or its"
                " clock was set. The times of the next 0.2 s are estimates and are marked."
            )
        return found

    def _mark(self, now: float, received: int) -> None:
        marks, c = self._marks, self._last
        mark = _Mark(now, c.frames, c.bad_checksums, c.skipped_bytes, received, self._lost, self._restarts)
        if len(marks) > 1 and now - marks[-2].time < _STEP_S:
            marks[-1] = mark
        else:
            marks.append(mark)
        while len(marks) > 2 and marks[1].time <= now - _WINDOW_S:
            marks.popleft()


def _without(first: _Mark, last: _Mark, since: int) -> dict[str, str]:
    received = last.received - first.received
    if last.frames > since or received < _NO_FRAME_BYTES:
        return {}
    return {
        "no frame": message(
            f"{arg(received)} bytes received, but no frame in them: check the device type and the line speed."
        )
    }
