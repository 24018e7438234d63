"""What a touch is, what it must be like, and what is known of one that goes on."""

from dataclasses import dataclass, field
from enum import StrEnum

import numpy as np
from numpy.typing import NDArray

from contactbench.pipeline.errors import InputError, arg, message
from contactbench.pipeline.verification.touch_location import MarkerMatch, TouchLocation


class ProtocolState(StrEnum):
    """Where a touch is."""

    ARMED = "armed"
    TOUCHING = "touching"
    SETTLED = "settled"
    ACCEPTED = "accepted"
    REJECTED = "rejected"


class Why(StrEnum):
    """Why a touch is rejected."""

    SLIPPED = "slipped"
    FORCE = message("force out of window")
    SHORT = message("too short")
    UNSETTLED = message("not settled")
    MOVED = message("moved on without release")
    AMBIGUOUS = "ambiguous"
    IMPLAUSIBLE = message("no single touch explains it")
    FAR = message("far from every marker")
    MISSED = message("misses the probe")
    TANGENTIAL = message("along the surface")
    TOO_LIGHT = message("too little force to locate")
    SATURATED = "saturated"


# The touch was as it should be, and yet nobody can tell which marker it was: the point itself may be wrong.
UNRESOLVED = (Why.AMBIGUOUS, Why.IMPLAUSIBLE, Why.FAR, Why.MISSED, Why.TANGENTIAL, Why.TOO_LIGHT)


@dataclass(frozen=True)
class ProtocolSettings:
    """
    What a touch must be like.

    Parameters
    ----------
    windows : tuple of (low, high)
        Force windows, N.
    samples : int
        Taken once it has settled; more of them if `take_s` needs more.
    repeats : int
        Accepted touches wanted of each marker.
    touch_N, release_N : float
        |F| at which a touch begins, and at which it has ended.
    settle_s : float
        For so long the force must have been steady.
    steady_N : float
        Between the halves of the samples the mean of |F| changes at most by this, and they are only taken once its
        slope promises as much; noise is allowed for.
    slip_m : float
        Between the halves of the samples, and from them to the release, the point moves at most by this; noise is
        allowed for.
    gap_s : float
        Without samples for longer, a touch has ended.
    order : tuple of str
        Markers in the order in which they are touched: each settled touch is of the next of them, however far off it
        is. Empty: any order, and a touch is of the marker that it is near.
    take_s : float
        The samples last at least this long: at a kilohertz 50 of them would be over before a slip shows.

    Raises
    ------
    InputError
        A setting is out of its range.
    """

    windows: tuple[tuple[float, float], ...] = ((8.0, 10.0),)
    samples: int = 50
    repeats: int = 1
    touch_N: float = 2.0
    release_N: float = 1.0
    settle_s: float = 0.1
    steady_N: float = 0.3
    slip_m: float = 0.001
    gap_s: float = 0.5
    order: tuple[str, ...] = ()
    take_s: float = 0.25

    def __post_init__(self) -> None:
        for low, high in self.windows:
            if not self.touch_N < low < high < 1e4:
                raise InputError(
                    f"force window {arg(low):g} to {arg(high):g} N: the lower end must be above"
                    f" {arg(self.touch_N):g} N, where a touch begins, and below the upper end."
                )
        if not self.windows or not 4 <= self.samples <= 100_000 or not 1 <= self.repeats <= 1000:
            raise InputError(
                "touch protocol: give at least one force window, 4 to 100,000 samples and 1 to 1000 repeats."
            )
        if not 0 < self.release_N <= self.touch_N:
            raise InputError(
                f"release force {arg(self.release_N):g} N: give a value above 0 and up to {arg(self.touch_N):g} N."
            )
        for name in ("settle_s", "steady_N", "slip_m", "gap_s", "take_s"):
            if not 0 < getattr(self, name) < 1e3:
                raise InputError(
                    f"touch protocol: {arg(name)} {arg(getattr(self, name)):g}: give a positive number."
                )

    def window_of(self, force: float) -> tuple[float, float] | None:
        """Return the window that a force, N, is in."""
        return next((each for each in self.windows if each[0] <= force <= each[1]), None)


@dataclass(frozen=True, eq=False)
class Touch:
    """
    One press, from beginning to decision.

    Attributes
    ----------
    start, time : float
        When it began and when it was decided, s.
    why : Why or None
        None: accepted.
    force : float
        |F|, N: mean over the samples, or the largest if none were taken.
    window : (low, high) or None
    placed : MarkerMatch or None
        Which marker; None: unknown.
    located : TouchLocation or None
        Where; None: nowhere.
    span : (begin, end) or None
        Times of the first and the last of its samples, s; None: none were taken.
    """

    start: float
    time: float
    why: Why | None
    force: float
    window: tuple[float, float] | None = None
    placed: MarkerMatch | None = None
    located: TouchLocation | None = None
    span: tuple[float, float] | None = None


@dataclass(frozen=True, eq=False)
class TouchEvent:
    """
    A change of state; with the touch once it is decided.

    A touch that was accepted may be withdrawn before the probe is released: a second event, REJECTED, has a touch with
    the same `start` that stands in its place.
    """

    time: float
    state: ProtocolState
    touch: Touch | None = None


@dataclass
class OngoingPress:
    """What is known of the press that goes on."""

    start: float
    times: list[float] = field(default_factory=list)
    forces: list[float] = field(default_factory=list)
    rows: list[tuple[NDArray[np.float64], NDArray[np.float64]]] = field(default_factory=list)
    latest: float = -np.inf
    peak: float = 0.0
    saturated: bool = False
    been_in_window: bool = False
    left_window: bool = False
    settled_at: int = -1
    retried: bool = False
    decided: Touch | None = None

    def add(self, time: float, force: float, sample: tuple[NDArray[np.float64], NDArray[np.float64]]) -> None:
        """Keep a sample."""
        self.times.append(time)
        self.forces.append(force)
        self.rows.append(sample)
        self.latest, self.peak = time, max(self.peak, force)

    def forget(self, until: int) -> None:
        """Drop samples that no decision needs any more: a probe may lean on something for an hour."""
        del self.times[:until], self.forces[:until], self.rows[:until]
