"""What people look at, looked at by the program: all that is wrong with a stream while it streams."""

from __future__ import annotations

from typing import TYPE_CHECKING

from contactbench.pipeline.devices.drive.damage import Damage
from contactbench.pipeline.devices.drive.leap import Leap
from contactbench.pipeline.devices.drive.pace import Pace
from contactbench.pipeline.devices.drive.readings import Readings
from contactbench.pipeline.devices.drive.rezero import RezeroDetector
from contactbench.pipeline.devices.sample import WrenchSample

if TYPE_CHECKING:
    from collections.abc import Sequence

    from contactbench.pipeline.devices.protocols import Counters
    from contactbench.pipeline.devices.sample import FlangeSample

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
    """

    def __init__(
        self, rate: float, *, rate_known: bool = True, limits: tuple[float, float] | None = None
    ) -> None:
        self._rate = rate
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
        return self._suspicions

    def see(self, samples: Sequence[WrenchSample] | Sequence[FlangeSample]) -> None:
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
        readings, pace, leap = self._readings.findings(), self._pace.findings(), self._leap.findings()
        return readings | pace | leap | self.damage()
