"""The newest moment of a live stream: filtered, compensated, and where the probe is touched."""

from __future__ import annotations

import threading
from collections import deque
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from contactbench.pipeline.filtering import KalmanFilter
from contactbench.pipeline.kernel import Reason

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from contactbench.pipeline.calibration import GravityModel
    from contactbench.pipeline.contact import ContactSolver
    from contactbench.pipeline.kernel import Contact

_CONTACTS = 4096  # at 30 a second, two minutes of them
_GAP_S = 1.0  # after a longer silence the filter begins anew: what was before says nothing
_NO_TOUCH = (Reason.LOW_FORCE, Reason.STALE, Reason.NOT_FINITE)
_FORGET_S = 0.25  # a contact that was not looked at for longer is not followed


@dataclass(frozen=True, eq=False)
class Reading:
    """
    The newest moment.

    Attributes
    ----------
    time : float
        s.
    raw, compensated : (6,)
        N and N·m; filtered; NaN without a calibration.
    R_WS : (3, 3)
        NaN where no pose is known.
    contact : Contact or None
        None: nothing touches, or there is no probe or no calibration.
    on : str or None
        What the contact lies on, one of `contactbench.pipeline.contact.facet_marks.MARKS`; None: there is none.
    """

    time: float
    raw: NDArray[np.float64]
    compensated: NDArray[np.float64]
    R_WS: NDArray[np.float64]
    contact: Contact | None
    on: str | None = None


class Moment:
    """
    What the filter says now; the contact is looked for when it is asked for, once for each sample.

    Parameters
    ----------
    rate : float
        Samples a second that the filter is made for, Hz.
    """

    def __init__(self, rate: float) -> None:
        self._filter = KalmanFilter(rate)
        self._time = -np.inf
        self._raw: NDArray[np.float64] | None = None
        self._R_WS = np.full((3, 3), np.nan)
        self._told: tuple[tuple[object, ...], Reading] | None = None
        self._looked = -np.inf
        self._contacts: deque[tuple[float, NDArray[np.float64]]] = deque(maxlen=_CONTACTS)
        self._lock = threading.Lock()
        self._asking = threading.Lock()

    def add(self, times: NDArray[np.float64], raw: NDArray[np.float64], R_WS: NDArray[np.float64]) -> None:
        """Take samples: times (n,), raw wrenches (n, 6), orientations (n, 3, 3)."""
        steps = np.diff(times, prepend=self._time)
        if not 0 < steps[0] <= _GAP_S:
            self._filter.reset()
            steps[0] = 1 / self._filter.rate
        # Times that repeat, as of a batch that came at once, are no reason to stop.
        state = self._filter.update_block(raw, np.maximum(steps, 1e-6))[-1]
        with self._lock:
            self._time, self._raw, self._R_WS = float(times[-1]), state, R_WS[-1]

    def reading(self, model: GravityModel | None, solver: ContactSolver | None) -> Reading | None:
        """Return the newest moment; None before the first sample."""
        with self._asking:
            with self._lock:
                time, raw, R_WS = self._time, self._raw, self._R_WS
            if raw is None:
                return None
            key = (time, model, solver)
            if self._told is None or self._told[0] != key:
                self._told = key, self._look(time, raw, R_WS, model, solver)
            return self._told[1]

    def contacts(self, seconds: float) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Return times (n,) and points (n, 3), S, m, of the last seconds of what was asked for; NaN: no contact."""
        with self._asking:
            kept = [each for each in self._contacts if each[0] >= self._time - seconds]
        times = np.array([time for time, _ in kept])
        return times, np.array([point for _, point in kept]).reshape(-1, 3)

    def _look(
        self,
        time: float,
        raw: NDArray[np.float64],
        R_WS: NDArray[np.float64],
        model: GravityModel | None,
        solver: ContactSolver | None,
    ) -> Reading:
        compensated = np.full(6, np.nan) if model is None else model.compensate(R_WS, raw)
        contact, on = None, None
        if solver is not None and np.isfinite(compensated).all():
            contact = self._follow(time, compensated, solver)
            on = None if contact is None else solver.on(contact)
        point = None if contact is None else contact.point
        if (
            self._contacts and self._contacts[-1][0] == time
        ):  # looked for anew, with another calibration or probe
            self._contacts.pop()
        self._contacts.append((time, np.full(3, np.nan) if point is None else point))
        return Reading(time, raw, compensated, R_WS, contact, on)

    def _follow(self, time: float, compensated: NDArray[np.float64], solver: ContactSolver) -> Contact | None:
        """Return the contact, followed as long as the press lasts: so a second touch that joins it is told apart."""
        if not 0 <= time - self._looked <= _FORGET_S:
            solver.reset()
        self._looked = time
        found = solver.track(compensated)
        if found.reason in _NO_TOUCH:
            solver.reset()  # the next press may be anywhere
            return None
        return found
