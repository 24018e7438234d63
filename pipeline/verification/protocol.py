"""The touch protocol: what a touch is, and which in a stream of wrenches are accepted, or rejected and why."""

from dataclasses import dataclass, field, replace
from enum import StrEnum

import numpy as np
from numpy.typing import NDArray

from contactbench.pipeline.contact import WrenchNoise
from contactbench.pipeline.errors import InputError, arg, message
from contactbench.pipeline.kernel import Reason
from contactbench.pipeline.verification.markers import (
    MarkerMatch,
    TouchLocation,
    TouchLocator,
    memory,
    sample_noise,
)
from contactbench.pipeline.verification.source import TouchRecording

_CORRELATED = 2.0  # times the variance of a mean of white noise
_BLOCK_S, _STILL_N, _FEWEST_BLOCKS = 0.1, 0.1, 3
_RAMP_S, _FEWEST_SAMPLES = 0.05, 3  # s beside a press that are no rest; samples of a run


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


def measured_noise(
    recording: TouchRecording, protocol: ProtocolSettings, stated: tuple[float, float] | None
) -> tuple[WrenchNoise, float, list[str]]:
    """
    Return the noise of one sample, such that a mean of n has 1/n of its variance.

    Parameters
    ----------
    recording : TouchRecording
        Compensated.
    protocol : ProtocolSettings
    stated : (force, torque), optional
        Standard deviations of a sample, N and N·m; else between neighbours while the probe is pressed.

    Returns
    -------
    WrenchNoise
    float
        By what that variance is larger than half the mean square between neighbours; 1: white noise.
    list of str
        What to know of it.
    """
    runs, rests = _runs(recording, protocol)
    # A hand trembles, and a robot swings: only what is there both at rest and pressed is the sensor's.
    known = [found for part in (runs, rests) if (found := memory(part)) is not None]
    tau, neighbours = min(known, default=(1.0, 0.0))
    correlation = tau / (1 - min(neighbours, 0.999))
    if stated is not None:
        base, growth = WrenchNoise(*stated), tau
    else:
        base, growth = (sample_noise(runs) if runs else WrenchNoise()), correlation
    said = []
    if tau > _CORRELATED:
        alike = message(
            f"Neighbouring samples are correlated (the sensor filters): {arg(tau):.0f} samples count as"
            " one, and the noise of means is increased accordingly."
        )
        said.append(alike)
    root = np.sqrt(max(growth, 1.0))
    scaled = WrenchNoise(np.asarray(base.force) * root, np.asarray(base.torque) * root)
    return scaled, max(correlation, 1.0), said


def resting(recording: TouchRecording, protocol: ProtocolSettings, rate: float) -> str | None:
    """Return a sentence if the compensated sensor reads a force while nothing is touched."""
    n = max(4, round(_BLOCK_S * rate))
    forces = recording.wrenches[: len(recording.wrenches) // n * n, :3].reshape(-1, n, 3)
    half = n // 2
    steps = np.linalg.norm(forces[:, half:].mean(axis=1) - forces[:, :half].mean(axis=1), axis=1)
    means = forces.mean(axis=1)
    sizes = np.linalg.norm(means, axis=1)
    free = (steps < _STILL_N) & (sizes < 0.5 * min(low for low, _ in protocol.windows))
    if np.count_nonzero(free) < _FEWEST_BLOCKS:
        return None
    offset = float(np.median(sizes[free]))
    if offset <= protocol.release_N:
        return None
    return message(
        f"The sensor reads {arg(offset):.1f} N with nothing touching: recalibrate, or raise the forces"
        f" at which a touch begins and ends (now {arg(protocol.touch_N):g} and {arg(protocol.release_N):g}"
        " N)."
    )


def rate_of(times: NDArray[np.float64]) -> float | None:
    """Return the usual rate of samples at times (n,), Hz, to four digits; None: there is none."""
    steps = np.diff(times)
    steps = steps[np.isfinite(steps) & (steps > 0)]
    return float(f"{1 / np.median(steps):.4g}") if len(steps) else None


def _runs(
    recording: TouchRecording, protocol: ProtocolSettings
) -> tuple[list[NDArray[np.float64]], list[NDArray[np.float64]]]:
    """Return runs of samples (n, 6) with the probe pressed, and those at rest, without the ramps beside them."""
    forces = np.linalg.norm(recording.wrenches[:, :3], axis=1)
    # Some recordings hold nothing but presses, so a pause parts them too.
    paused = np.diff(recording.times) > protocol.gap_s

    def parted(chosen: NDArray[np.bool_], margin: int) -> list[NDArray[np.float64]]:
        parts = np.split(np.arange(len(forces)), np.flatnonzero(np.diff(chosen) | paused) + 1)
        runs = [recording.wrenches[part[margin:-margin]] for part in parts if len(part) and chosen[part[0]]]
        return [run for run in runs if len(run) > _FEWEST_SAMPLES and np.isfinite(run).all()]

    pressed = parted(forces >= min(low for low, _ in protocol.windows), 1)
    rate = rate_of(recording.times)
    ramp = 1 if rate is None else max(1, round(_RAMP_S * rate))
    return pressed, parted(forces < protocol.touch_N, ramp)


__all__ = ["UNRESOLVED", "ProtocolSettings", "ProtocolState", "Touch", "TouchEvent", "TouchProtocol", "Why"]

_FORGOTTEN = 1000  # samples
_NOWHERE = {Reason.LOW_FORCE: Why.TOO_LIGHT, Reason.TANGENTIAL: Why.TANGENTIAL}


class TouchProtocol:
    """
    Follow one stream; pure: the same samples give the same events, in whatever blocks they come.

    A press is decided once: when it is settled and its samples are taken, or when it ends before. Nothing is dropped
    without a word: every press gives an accepted or a rejected touch.

    Parameters
    ----------
    placing : TouchLocator
        Locates, and says which marker that is.
    settings : ProtocolSettings
    """

    def __init__(self, placing: TouchLocator, settings: ProtocolSettings | None = None) -> None:
        self.settings = settings or ProtocolSettings()
        unknown = set(self.settings.order) - set(placing.markers.names)
        if unknown:
            raise InputError(
                f"order: there are no markers {arg(', '.join(sorted(unknown)))}: correct the names."
            )
        self._placing = placing
        self._press: OngoingPress | None = None
        self._latest = -np.inf
        self._accepted = 0
        self._last = ProtocolState.ARMED

    @property
    def state(self) -> ProtocolState:
        """Where the stream is now; after a decision: until the probe is released."""
        press = self._press
        if press is None:
            return ProtocolState.ARMED
        if press.decided:
            return self._last
        return ProtocolState.SETTLED if press.settled_at >= 0 else ProtocolState.TOUCHING

    def feed(
        self,
        times: NDArray[np.float64],
        wrenches: NDArray[np.float64],
        R_WS: NDArray[np.float64],
        saturated: NDArray[np.bool_] | None = None,
    ) -> list[TouchEvent]:
        """
        Take samples and return what happened.

        Parameters
        ----------
        times : (n,)
            s; samples that are not later than all before are left out.
        wrenches : (n, 6)
            Compensated, S, N and N·m; rows that are not finite are left out.
        R_WS : (n, 3, 3)
        saturated : (n,), optional
            Whether a channel was at its limit.
        """
        events: list[TouchEvent] = []
        forces = np.linalg.norm(wrenches[:, :3], axis=1)
        usable = np.isfinite(wrenches).all(axis=1) & np.isfinite(times)
        flags = np.zeros(len(times), dtype=bool) if saturated is None else saturated
        row = 0
        while row < len(times):
            if self._press is None:  # far the most samples: none of them touches
                ahead = np.flatnonzero((forces[row:] >= self.settings.touch_N) | flags[row:])
                skipped = times[row : row + ahead[0]] if len(ahead) else times[row:]
                self._latest = float(np.fmax.reduce(skipped, initial=self._latest))
                if not len(ahead):
                    break
                row += int(ahead[0])
            if times[row] > self._latest and (usable[row] or flags[row]):
                sample = wrenches[row], R_WS[row]
                self._take(float(times[row]), float(forces[row]), sample, bool(flags[row]), events)
                self._latest = float(times[row])
            row += 1
        return events

    def finish(self) -> list[TouchEvent]:
        """End the stream: a press that goes on has ended."""
        events: list[TouchEvent] = []
        self._release(self._latest, events)
        return events

    # ---- one sample --------------------------------------------------------------------------

    def _take(
        self,
        time: float,
        force: float,
        sample: tuple[NDArray[np.float64], NDArray[np.float64]],
        saturated: bool,
        events: list[TouchEvent],
    ) -> None:
        paused = time - self._latest > self.settings.gap_s
        if self._press is not None and (paused or force < self.settings.release_N):
            self._release(self._latest if paused else time, events)
        if self._press is None:
            if force < self.settings.touch_N and not saturated:
                return
            self._press = OngoingPress(time)
            events.append(TouchEvent(time, ProtocolState.TOUCHING))
        press = self._press
        press.add(time, force, sample)
        press.saturated |= saturated
        if press.decided:
            self._held(press, press.decided, events)
        elif press.settled_at >= 0:
            self._sampled(press, events)
        elif self._steady(press):
            press.settled_at = len(press.times)
            events.append(TouchEvent(time, ProtocolState.SETTLED))

    def _steady(self, press: OngoingPress) -> bool:
        """Tell whether the force has been steady, in a window, for the time that is wanted."""
        settings = self.settings
        begin = int(np.searchsorted(press.times, press.times[-1] - settings.settle_s - 1e-9))
        # At least four, so that a mean has some meaning, and the whole time must lie in the press.
        if len(press.times) - begin < 4 or press.times[-1] - press.start < settings.settle_s:
            return False
        recent = np.array(press.forces[begin:])
        inside = settings.window_of(float(recent.mean())) is not None
        press.left_window |= press.been_in_window and not inside
        press.been_in_window |= inside
        if begin > _FORGOTTEN:
            press.forget(begin)
        # A slope that is small in a tenth of a second need not be over the time that the samples take.
        longer = max(1.0, settings.take_s / settings.settle_s)
        return inside and self._rests(recent, longer)

    def _rests(self, forces: NDArray[np.float64], times: float) -> bool:
        """Tell whether so many times the change of |F| between the halves is small, beside what is noise of it."""
        half = len(forces) // 2
        noise = float(np.diff(forces).std()) / np.sqrt(2) * 2 / np.sqrt(len(forces))
        change = abs(float(forces[half:].mean() - forces[:half].mean()))
        return bool(times * change <= self.settings.steady_N + 4 * times * noise)

    def _taken(self, times: list[float]) -> bool:
        """Tell whether samples are enough, and for long enough; each stands for the time to the next."""
        n = len(times)
        return (
            n >= self.settings.samples and (times[-1] - times[0]) * n / (n - 1) >= self.settings.take_s - 1e-9
        )

    def _sampled(self, press: OngoingPress, events: list[TouchEvent]) -> None:
        begin = press.settled_at
        if not self._taken(press.times[begin:]):
            return
        forces = np.array(press.forces[begin:])
        window = self.settings.window_of(float(forces.mean()))
        # A slow hand is no wrong touch: it may come back into the window, or to rest, until it lets go.
        if window is None or not (press.saturated or self._rests(forces, 1.0)):
            press.settled_at = -1
            press.left_window |= window is None
            press.retried = True
            events.append(TouchEvent(press.latest, ProtocolState.TOUCHING))
            return
        wrenches, R_WS = (np.array(each) for each in zip(*press.rows[begin:], strict=True))
        why, where, placed = self._judge(self._placing.locate(wrenches, R_WS))
        if press.saturated:
            why = Why.SATURATED
        span = (press.times[begin], press.times[-1])
        touch = Touch(press.start, span[1], why, float(forces.mean()), window, placed, where, span)
        self._decide(press, touch, events)

    def _judge(
        self, located: TouchLocation | Reason
    ) -> tuple[Why | None, TouchLocation | None, MarkerMatch | None]:
        if isinstance(located, Reason):
            return _NOWHERE.get(located, Why.MISSED), None, None
        expected = self._expected()
        placed = self._placing.place(located, expected)
        if located.implausible and (located.ambiguous or placed.rival or placed.far):
            return Why.IMPLAUSIBLE, None, None
        why: Why | None = None
        if located.drift > self.settings.slip_m + 3 * located.drift_sigma:
            why = Why.SLIPPED
        elif located.implausible:
            why = Why.IMPLAUSIBLE
        elif expected is None and placed.far:
            why = Why.FAR
        elif expected is None and (located.ambiguous or placed.rival):
            why = Why.AMBIGUOUS
        return why, located, placed

    def _expected(self) -> int | None:
        """Return the marker that the order wants next; None: any."""
        order = self.settings.order
        return self._placing.markers.names.index(order[self._accepted % len(order)]) if order else None

    def _held(self, press: OngoingPress, touch: Touch, events: list[TouchEvent]) -> None:
        """Withdraw a touch that was accepted if the probe goes on to another place before it is released."""
        if touch.why is not None or touch.located is None:
            press.forget(len(press.times))
            return
        if not self._taken(press.times):
            return
        forces, wrenches = np.array(press.forces), np.array([row for row, _ in press.rows])
        press.forget(len(press.times))
        # While the hand lets go the contact may roll: only what rests again with such a force is another place.
        if self.settings.window_of(float(forces.mean())) is None or not self._rests(forces, 1.0):
            return
        slip = self.settings.slip_m + 3 * touch.located.drift_sigma
        if self._placing.moved(touch.located, wrenches) <= slip:
            return
        self._accepted -= 1
        self._decide(press, replace(touch, time=press.latest, why=Why.MOVED), events)

    # ---- its end -----------------------------------------------------------------------------

    def _decide(self, press: OngoingPress, touch: Touch, events: list[TouchEvent]) -> None:
        press.decided = touch
        press.forget(len(press.times))
        self._last = ProtocolState.REJECTED if touch.why else ProtocolState.ACCEPTED
        self._accepted += touch.why is None
        events.append(TouchEvent(touch.time, self._last, touch))

    def _release(self, time: float, events: list[TouchEvent]) -> None:
        press = self._press
        if press is None:
            return
        if not press.decided:
            touch = Touch(press.start, time, self._ended_early(press), press.peak)
            self._decide(press, touch, events)
        self._press = None
        events.append(TouchEvent(time, ProtocolState.ARMED))

    def _ended_early(self, press: OngoingPress) -> Why:
        if press.saturated:
            return Why.SATURATED
        if press.settled_at >= 0:
            return Why.FORCE if press.left_window else Why.SHORT
        if press.latest - press.start < self.settings.settle_s:
            return Why.SHORT
        if press.left_window or not press.been_in_window:
            return Why.FORCE
        return Why.UNSETTLED
