"""The touch protocol: from a stream of compensated wrenches to touches that were accepted, or rejected and why."""

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from contactbench.pipeline.errors import InputError, arg
from contactbench.pipeline.kernel import Reason
from contactbench.pipeline.verification.press import (
    UNRESOLVED,
    OngoingPress,
    ProtocolSettings,
    ProtocolState,
    Touch,
    TouchEvent,
    Why,
)
from contactbench.pipeline.verification.touch_location import MarkerMatch, TouchLocation, TouchLocator

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
