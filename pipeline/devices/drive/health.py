"""How a stream is: what people look at, and what an operator is told."""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass
from enum import StrEnum
from itertools import pairwise
from statistics import median
from typing import TYPE_CHECKING

from pipeline.devices.protocols import Counters
from pipeline.devices.sample import Status, WrenchSample

if TYPE_CHECKING:
    from collections.abc import Sequence

    from pipeline.devices.sample import FlangeSample

# A silence is a fault after this, or after two frames of a slow device.
SILENCE_S = 0.15
_WINDOW = 400  # samples that rate and jitter are taken from
_FROZEN_S = 0.15  # noise changes the last digit of one channel in this time
_FROZEN_SAMPLES = 20
_RATE_OFF = 0.1
_ENOUGH = 50


class State(StrEnum):
    """Where a stream is."""

    CLOSED = "closed"
    CONNECTING = "connecting"
    STREAMING = "streaming"
    SILENT = "silent"
    LOST = "lost"


@dataclass(frozen=True)
class Health:
    """
    A stream at one moment.

    Attributes
    ----------
    state : State
    findings : tuple of str
        What is wrong, in sentences; empty when nothing is.
    samples : int
        Given since the stream was opened.
    rate : float or None
        Measured over the last samples, Hz.
    jitter : float or None
        How unevenly they arrive: the 95th percentile of how far an interval is from the median one, s.
    counters : Counters
        Of the parser.
    reconnected : int
        Times the line was opened again.
    """

    state: State
    findings: tuple[str, ...]
    samples: int
    rate: float | None
    jitter: float | None
    counters: Counters
    reconnected: int

    @property
    def well(self) -> bool:
        """Whether samples come and nothing is wrong with them."""
        return self.state is State.STREAMING and not self.findings


class Watch:
    """Looks at samples as they pass.

    Parameters
    ----------
    rate : float
        That was asked for, Hz.
    """

    def __init__(self, rate: float) -> None:
        self._rate = rate
        self._times: deque[float] = deque(maxlen=_WINDOW)
        self._last: WrenchSample | FlangeSample | None = None
        self._same = 0
        self._same_since = 0.0
        self.samples = 0

    @property
    def patience(self) -> float:
        """Seconds without a sample after which the stream is silent."""
        return max(SILENCE_S, 2.0 / self._rate)

    def see(self, samples: Sequence[WrenchSample] | Sequence[FlangeSample]) -> None:
        """Take samples, oldest first."""
        for sample in samples:
            if _same(sample, self._last):
                self._same += 1
            else:
                self._same, self._same_since = 0, sample.time
            self._last = sample
            self._times.append(sample.time)
        self.samples += len(samples)

    def forget(self) -> None:
        """Start the measured rate anew, after a gap."""
        self._times.clear()
        self._same = 0
        self._last = None

    def rate(self) -> float | None:
        """Return the measured rate, Hz; None before there are enough samples."""
        if len(self._times) < _ENOUGH or self._times[-1] <= self._times[0]:
            return None
        return (len(self._times) - 1) / (self._times[-1] - self._times[0])

    def jitter(self) -> float | None:
        """Return how unevenly samples arrive, s; None before there are enough."""
        if len(self._times) < _ENOUGH:
            return None
        gaps = [b - a for a, b in pairwise(self._times)]
        middle = median(gaps)
        return sorted(abs(gap - middle) for gap in gaps)[int(0.95 * len(gaps))]

    def findings(self) -> tuple[str, ...]:
        """Return what is wrong with the last samples."""
        found = []
        last = self._last
        if isinstance(last, WrenchSample):
            found += [words for flag, words in _FLAGS.items() if flag in last.status]
            if self._same >= _FROZEN_SAMPLES and last.time - self._same_since >= _FROZEN_S:
                found.append(
                    f"The readings have not changed in any channel for {self._same} samples: the sensor hangs, or is"
                    " not connected to its box. Switch it off and on."
                )
        rate = self.rate()
        if rate is not None and abs(rate / self._rate - 1) > _RATE_OFF:
            found.append(
                f"Samples come at {rate:.0f} Hz instead of {self._rate:.0f} Hz: check the rate and the line's speed."
            )
        return tuple(found)


def _same(one: WrenchSample | FlangeSample, two: WrenchSample | FlangeSample | None) -> bool:
    """Tell whether two readings are equal in every channel; a robot may well stand still."""
    if not (isinstance(one, WrenchSample) and isinstance(two, WrenchSample)):
        return False
    return one.force == two.force and one.torque == two.torque


_FLAGS = {
    Status.OVERRANGE: "A channel is at the end of its range: take the load off, and use less force.",
    Status.INVALID: "The sensor says that its readings are not measurements: switch it off and on.",
    Status.ERROR: "The sensor reports an error: see its own display or manual.",
    Status.LATE: "The sensor cannot keep its rate: ask for a lower one.",
    Status.RAW: "The readings are raw, not calibrated by the sensor: set it to engineering units.",
}
