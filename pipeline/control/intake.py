"""From raw samples to what a controller may believe: one compensated wrench, where it acts, or why not."""

from __future__ import annotations

import math
from collections import deque
from dataclasses import dataclass
from enum import StrEnum
from typing import TYPE_CHECKING

import numpy as np

from contactbench.pipeline.contact.methods import make
from contactbench.pipeline.contact.solver import ContactSolver
from contactbench.pipeline.contact.touch_model import WrenchNoise
from contactbench.pipeline.control.contact_reason import Heed, SurePlace, heed
from contactbench.pipeline.devices.sample import Status, WrenchSample
from contactbench.pipeline.errors import message
from contactbench.pipeline.gates import Gates

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from contactbench.pipeline.calibration import GravityModel
    from contactbench.pipeline.contact.touch_model import TouchModel
    from contactbench.pipeline.kernel import Contact, Reason
    from contactbench.pipeline.mesh import Probe

_STUCK = 6  # equal readings; of a sensor with noise two are rare
_RECENT = 5
_FORGET_S = 0.25  # a press that was not looked at for longer is not followed
_SPIKE_N, _SPIKE_NM = 4.0, 0.4  # off the median of the last five: no tissue pushes so much harder within 5 ms
_UNUSABLE = Status.INVALID | Status.ERROR


class SensingFault(StrEnum):
    """Why there is nothing to believe."""

    STALE = "stale"
    STUCK = "stuck"
    SATURATED = "saturated"
    CLOCK = message("from a clock that went back")
    UNHEALTHY = "unhealthy"  # a method says so of its readings


@dataclass(frozen=True, eq=False)
class Sensed:
    """What is believed at one step."""

    time: float  # mean time of the samples, s; of the newest good one where there is none now
    wrench: NDArray[np.float64]  # (6,) compensated, on the probe, S, N and N·m; NaN without a fresh sample
    contact: (
        Contact | None
    )  # where it acts; None: too little force, no method says, or it is not to be turned by
    fault: SensingFault | None
    age: float  # s since the newest good sample
    count: int  # samples that the wrench is the mean of
    reason: Reason | None = None  # of the contact, also of one that is not to be turned by
    point: NDArray[np.float64] | None = None  # (3,) S, m: of a contact that is there

    @property
    def fresh(self) -> bool:
        """Whether there is a wrench to act on."""
        return self.fault is None and self.count > 0


class SampleIntake:
    """
    Takes raw samples, leaves out what is no measurement, and locates the rest.

    Left out are samples that the device calls invalid, numbers that are not finite, and single readings far off the
    median of the last five; two such in a row are believed. The same reading six times is a sensor that hangs.

    Parameters
    ----------
    noise : WrenchNoise, optional
        Of one reading.
    model : TouchModel, optional
        What is known of a touch beside the noise.
    method : str
        A name of `contactbench.pipeline.contact.methods.METHODS`.
    located_from : float
        N; with less, no place is asked for.
    stale : float
        s.

    Raises
    ------
    InputError
        There is no such method, or it cannot be used with this probe.
    """

    def __init__(
        self,
        probe: Probe,
        gravity: GravityModel,
        noise: WrenchNoise | None = None,
        gates: Gates | None = None,
        model: TouchModel | None = None,
        *,
        method: str = "contactbench",
        located_from: float = 1.0,
        stale: float = 0.06,
    ) -> None:
        noise, gates = noise or WrenchNoise(), gates or Gates()
        self._method = make(method, probe, noise, gates, model)
        variances = np.diag(noise.covariance)
        self._noise = float(np.sqrt(variances[:3].mean())), float(np.sqrt(variances[3:].mean()))
        self._ends = np.array(gates.saturation)
        self.gravity, self._from, self._stale = gravity, located_from, stale
        self._clock = -np.inf
        self._recent: deque[NDArray[np.float64]] = deque(maxlen=_RECENT)
        self._last: WrenchSample | None = None
        self._equal = 0
        self._outside = 0
        self._good = self._looked = -np.inf
        self._sure = SurePlace()

    def sigmas(self, count: int) -> tuple[float, float]:
        """Return the noise of a mean of so many readings: of a force, N, and of a torque, N·m."""
        share = max(count, 1) ** -0.5
        return self._noise[0] * share, self._noise[1] * share

    def take(
        self,
        now: float,
        samples: Sequence[WrenchSample],
        R_WS: NDArray[np.float64],
        added: NDArray[np.float64] | None = None,
    ) -> Sensed:
        """
        Take the samples that came since the step before.

        Parameters
        ----------
        now : float
            s, on the samples' clock.
        samples : sequence of WrenchSample
            Raw, oldest first; those that are not later than the ones before are left out.
        R_WS : (3, 3)
            How the sensor stands.
        added : (6,), optional
            What to add to what is left without weight and bias: for the tool's own acceleration, see `Inertia`, and
            for what was read in the air, see `Tare`.
        """
        rows: list[NDArray[np.float64]] = []
        times: list[float] = []
        saturated = False
        for sample in samples:
            late = self._last is not None and sample.time <= self._last.time
            if late or not math.isfinite(sample.time):
                continue
            row = np.array((*sample.force, *sample.torque))
            self._watch(sample)
            finite = bool(np.isfinite(row).all())
            saturated |= bool(sample.status & Status.OVERRANGE)
            saturated |= finite and bool((np.abs(row) >= self._ends).any())
            if sample.status & _UNUSABLE or not finite or self._spike(row):
                continue
            rows.append(row)
            times.append(sample.time)
        if rows and self._equal < _STUCK:
            self._good = times[-1]
        known = np.zeros(6) if added is None else added
        return self._sensed(now, rows, times, known - self.gravity.predict(R_WS), saturated)

    def _watch(self, sample: WrenchSample) -> None:
        last = self._last
        same = last is not None and last.force == sample.force and last.torque == sample.torque
        self._equal = self._equal + 1 if same else 0
        self._last = sample

    def _spike(self, row: NDArray[np.float64]) -> bool:
        """Tell whether a reading is alone with what it says."""
        spike = False
        if len(self._recent) == _RECENT:
            # The median; numpy's own takes five times as long for so few.
            off = np.abs(row - np.sort(np.array(self._recent), axis=0)[_RECENT // 2])
            spike = bool((off[:3] > _SPIKE_N).any() or (off[3:] > _SPIKE_NM).any())
        if spike and self._outside == 0:
            self._outside = 1
            return True
        self._outside = 0
        if spike:  # a second one: it is so, and what was before is over
            self._recent.clear()
        self._recent.append(row)
        return False

    def _sensed(
        self,
        now: float,
        rows: list[NDArray[np.float64]],
        times: list[float],
        added: NDArray[np.float64],
        saturated: bool,
    ) -> Sensed:
        back = not now >= self._clock  # NaN is no time either
        self._clock = self._clock if back else now
        age = max(self._clock - self._good, 0.0)
        fault = None
        if back:
            fault = SensingFault.CLOCK
        elif self._equal >= _STUCK - 1:
            fault = SensingFault.STUCK
        elif age > self._stale:
            fault = SensingFault.STALE
        elif saturated:
            fault = SensingFault.SATURATED
        if not rows or fault is not None:
            return Sensed(self._good, np.full(6, np.nan), None, fault, age, 0)
        wrench, time = np.add.reduce(rows) / len(rows) + added, sum(times) / len(times)
        contact = self._located(wrench, time)
        if contact is None:
            return Sensed(time, wrench, None, None, age, len(rows))
        what = heed(contact)
        if what in (Heed.HOLD, Heed.RETRACT):
            fault = SensingFault.SATURATED if what is Heed.RETRACT else SensingFault.UNHEALTHY
            return Sensed(time, np.full(6, np.nan), None, fault, age, 0, contact.reason)
        point = self._sure.take(contact, time)
        given = None if point is None else contact
        return Sensed(time, wrench, given, None, age, len(rows), contact.reason, point)

    def _located(self, wrench: NDArray[np.float64], time: float) -> Contact | None:
        """Return where it acts, or None; our own method follows a press, and learns its torsion meanwhile."""
        step, self._looked = time - self._looked, time
        touches, engine = float(wrench[:3] @ wrench[:3]) >= self._from**2, self._method.engine
        if not isinstance(engine, ContactSolver):
            return self._method.locate(wrench) if touches else None
        follows = touches and 0 < step <= _FORGET_S
        if not follows:
            engine.reset()
        return engine.track(wrench, 0.0, step if follows else 0.0) if touches else None
