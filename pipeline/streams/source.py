"""What sources that are no devices have in common: no line and no bytes, but an end."""

from __future__ import annotations

import threading
from typing import TYPE_CHECKING

from contactbench.pipeline.devices.drive import Health, State, Watch
from contactbench.pipeline.devices.protocols import Counters

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from contactbench.pipeline.devices.sample import FlangeSample, WrenchSample
    from contactbench.pipeline.devices.url import DeviceAddress


_GUESSED_HZ = 100.0


class Pulse:
    """
    Watches the samples of a source, and tells when its state, a finding or a suspicion changes.

    Parameters
    ----------
    on_change : callable, optional
        Gets the health.
    rate : float or None
        That the samples should have, Hz; None: what comes first is right.
    judged : bool
        False: nothing is found about the samples, such as poses of which nobody promised a rate.
    """

    def __init__(
        self, on_change: Callable[[Health], None] | None, rate: float | None = None, *, judged: bool = True
    ) -> None:
        self._on_change, self._judged = on_change, judged
        self._watch = Watch(rate or _GUESSED_HZ, rate_known=rate is not None)
        self._state = State.CLOSED
        self._findings: dict[str, str] = {}
        self._told = self._kinds()
        self._lock = threading.Lock()

    @property
    def health(self) -> Health:
        """How the source is now."""
        with self._lock:
            watch = self._watch
            findings = tuple(self._findings.values())
            suspicions = watch.suspicions if self._judged else ()
            rate, jitter = watch.rate(), watch.jitter()
            return Health(self._state, findings, watch.samples, rate, jitter, Counters(), 0, suspicions)

    def beat(
        self, samples: Sequence[WrenchSample] | Sequence[FlangeSample], findings: tuple[str, ...] = ()
    ) -> None:
        """Take samples that were given; `findings` are what the source itself found."""
        with self._lock:
            self._watch.see(samples)
            seen = self._watch.findings() if self._judged else {}
        self._become(State.STREAMING, seen | dict(zip(findings, findings, strict=True)))

    def become(self, state: State, findings: tuple[str, ...] = ()) -> None:
        """Be in a state, with what is wrong."""
        self._become(state, dict(zip(findings, findings, strict=True)))

    def acknowledge(self) -> None:
        """Drop the suspicions: somebody has read them."""
        with self._lock:
            self._watch.acknowledge()

    def _become(self, state: State, findings: dict[str, str]) -> None:
        with self._lock:
            self._state, self._findings = state, findings
            now = self._kinds()
            if now == self._told:
                return
            self._told = now
        if self._on_change is not None:
            self._on_change(self.health)

    def _kinds(self) -> tuple[State, tuple[str, ...], tuple[str, ...]]:
        # A number within a finding that goes on is no change.
        return self._state, tuple(self._findings), self._watch.suspicions if self._judged else ()


class Ending:
    """The part of a `Stream` that every source has: an address, a pulse, an end.

    Parameters
    ----------
    address : DeviceAddress
    pulse : Pulse
    """

    def __init__(self, address: DeviceAddress, pulse: Pulse) -> None:
        self.address = address
        self.done = threading.Event()
        self._pulse = pulse

    @property
    def health(self) -> Health:
        """How the source is now."""
        return self._pulse.health

    def acknowledge(self) -> None:
        """Drop the suspicions: somebody has read them."""
        self._pulse.acknowledge()
