"""Leaps of a device's clock or count that no gap in time explains."""

from __future__ import annotations

from collections import deque
from typing import TYPE_CHECKING

from contactbench.pipeline.devices.sample import WrenchSample

if TYPE_CHECKING:
    from contactbench.pipeline.devices.sample import FlangeSample

_LEAP_S = 0.25  # more than samples wait in buffers
_BACK = 5  # samples over which the two clocks are compared
_SETTLE = 3  # after a gap: a parser believes a new count with the frame after it
_SHOWN_S = 2.0


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
        self._pairs: deque[tuple[float, float]] = deque(maxlen=_BACK)
        self._settling = _SETTLE
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
        self._settling = _SETTLE

    def findings(self) -> dict[str, str]:
        """Return what is wrong, by kind; a leap is shown for some seconds."""
        if self._now - self._at > _SHOWN_S:
            return {}
        return {
            "leap": f"The device's clock or count leapt ahead by {self._size:.1f} s while samples came on: its clock"
            " was set, or its count is wrong. The times of the next 0.2 s are estimates and are marked."
        }

    def _device(self, sample: WrenchSample | FlangeSample) -> float | None:
        if sample.device_time is not None:
            return sample.device_time
        if isinstance(sample, WrenchSample) and sample.sequence is not None:
            return sample.sequence / self._rate
        return None
