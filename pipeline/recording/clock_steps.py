"""Clocks that are set while they are recorded."""

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from contactbench.pipeline.errors import arg, message

_BACK_S = 0.05  # less is a message that was overtaken
_JUMP_S, _STEADY_S = 0.1, 0.02
_MOST_TOLD = 5
_GAP_S = 1.0  # nothing is interpolated over so much
_PAUSE_S, _DAY_S = 60.0, 86_400.0  # a recording may pause for an hour, but not for days


def _round(seconds: float) -> float:
    return float(f"{seconds:.3g}")


_APART = message(
    "Not every topic shows that the clock was set, so from then on wrenches and poses do not belong together: cut the"
    " recording before the step. Of a bag, choose other times with --header-stamps."
)


def breaks(change: float | NDArray[np.float64]) -> bool | NDArray[np.bool_]:
    """Tell whether a change, s, from one time of a topic to its next may be a step of the clock, or a pause."""
    return (change < -_BACK_S) | (change > _PAUSE_S)


class ClockSteps:
    """
    Puts the times of several topics in order where the clock that they share was set back, or forward by days.

    What comes after the step is moved behind all that came before it, with a gap of a second between: no reading of one
    stretch meets a pose of the other. All topics are moved by the same time.

    Attributes
    ----------
    steps : list of (float, float)
        When the clock was set, in the times that are given out, and how far back, s; below 0: forward.
    pauses : list of (float, float)
        When nothing came for more than a minute, and for how long, s: the clock may have been set forward.
    jumps : list of (float, float)
        When it jumped against another clock, see `beside`, and by how much, s.
    """

    def __init__(self) -> None:
        self._last: dict[str, tuple[float, float]] = {}  # the topic's newest time, and the step before it
        self._stretch: dict[str, int] = {}
        self._shifts = [0.0]
        self.steps: list[tuple[float, float]] = []
        self.pauses: list[tuple[float, float]] = []
        self.jumps: list[tuple[float, float]] = []
        self._second, self._told, self._least = 0, 0, np.inf
        self._offsets: list[float] = []

    def begin(self, topic: str) -> None:
        """Say that a topic begins where the others did, though it is looked through after them."""
        self._stretch[topic] = 0

    def at(self, topic: str, time: float) -> float:
        """Return the time of a topic's next sample, s."""
        last, usual = self._last.get(topic, (time, 0.0))
        stretch = self._stretch.setdefault(topic, len(self._shifts) - 1)
        when = last + self._shifts[stretch]
        if not -_BACK_S <= time - last <= _DAY_S:
            stretch = self._stretch[topic] = stretch + 1
            if stretch == len(self._shifts):
                self.steps.append((when, last + usual - time))
                self._shifts.append(self._shifts[-1] + last - time + _GAP_S)
        elif time - last > _PAUSE_S and not any(abs(when - known) < _PAUSE_S for known, _ in self.pauses):
            self.pauses.append((when, time - last))
        self._last[topic] = time, time - last if time > last else usual
        return time + self._shifts[stretch]

    def all_at(self, topic: str, times: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return the times of a topic's next samples (n,), s."""
        last, _ = self._last.get(topic, (times[0], 0.0))
        changes = np.diff(times, prepend=last)
        if np.any(breaks(changes)):
            return np.array([self.at(topic, time) for time in times.tolist()])
        self.at(topic, float(times[0]))
        if len(times) > 1:
            self._last[topic] = float(times[-1]), max(float(changes[-1]), 0.0)
        shift = self._shifts[self._stretch[topic]]
        return times + shift if shift else times

    def told(self) -> tuple[str, ...]:
        """Return the first steps as sentences."""
        return tuple(self._sentences())

    def _sentences(self) -> Iterator[str]:
        back, forward = message("back"), message("forward")
        for when, size in self.steps[:_MOST_TOLD]:
            yield message(
                f"The clock was set {arg(back if size > 0 else forward)} by {arg(_round(abs(size))):,.12g} s at"
                f" {arg(when):.2f} s. What follows is placed {arg(_GAP_S):g} s later, and never paired with what"
                " came before."
            )
        for when, size in self.pauses[:_MOST_TOLD]:
            yield message(
                f"Nothing was recorded for {arg(_round(size)):,.12g} s after {arg(when):.2f} s, or the clock was"
                " set forward: nothing is paired across."
            )
        for when, size in self.jumps[:_MOST_TOLD]:
            yield message(
                f"At {arg(when):.0f} s the clock of the recording jumped by {arg(size):+.3g} s against that in the"
                " headers: one of the two was set. Nothing is interpolated over such a gap."
            )
        if self.apart():
            yield _APART

    def beside(self, time: float, other: float) -> None:
        """Take what another clock says at a time that was given out, s: a jump of one against the other is kept."""
        second = int(time)
        if self._told != len(self.steps):  # what was known is of before the step
            self._told, self._second, self._offsets, self._least = len(self.steps), second, [], np.inf
        if second != self._second:
            # The least of a second: what is held up on the way is late, and never early.
            *known, last = *self._offsets, self._least
            if len(known) > 1 and abs(known[1] - known[0]) < _STEADY_S and abs(last - known[1]) > _JUMP_S:
                self.jumps.append((self._second, last - known[1]))
            self._second, self._offsets, self._least = second, [*known[-1:], last], np.inf
        self._least = min(self._least, time - other)

    def apart(self) -> bool:
        """Tell whether a topic went on without a step that another took: then their clocks are not one."""
        return any(
            stretch < len(self.steps)
            and self._last[topic][0] + self._shifts[stretch] > self.steps[stretch][0] + _GAP_S
            for topic, stretch in self._stretch.items()
        )
