"""Clocks that are set back while they are recorded."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from contactbench.pipeline.errors import arg, message

if TYPE_CHECKING:
    from numpy.typing import NDArray

_BACK_S = 0.05  # less is a message that was overtaken
_JUMP_S, _STEADY_S = 0.1, 0.02
_MOST_TOLD = 5
_GAP_S = 1.0  # nothing is interpolated over so much


class ClockSteps:
    """
    Puts the times of several topics in order where the clock that they share was set back.

    What comes after the step is moved behind all that came before it, with a gap of a second between: no reading of one
    stretch meets a pose of the other. All topics are moved by the same time.

    Attributes
    ----------
    steps : list of (float, float)
        When the clock was set back, in the times that are given out, and by how much, s.
    jumps : list of (float, float)
        When it jumped against another clock, see `beside`, and by how much, s.
    """

    def __init__(self) -> None:
        self._last: dict[str, tuple[float, float]] = {}  # the topic's newest time, and the step before it
        self._stretch: dict[str, int] = {}
        self._shifts = [0.0]
        self.steps: list[tuple[float, float]] = []
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
        if time < last - _BACK_S:
            stretch = self._stretch[topic] = stretch + 1
            if stretch == len(self._shifts):
                self.steps.append((last + self._shifts[-1], last + usual - time))
                self._shifts.append(self._shifts[-1] + last - time + _GAP_S)
        self._last[topic] = time, time - last if time > last else usual
        return time + self._shifts[stretch]

    def all_at(self, topic: str, times: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return the times of a topic's next samples (n,), s."""
        last, _ = self._last.get(topic, (times[0], 0.0))
        if (np.diff(times, prepend=last) < -_BACK_S).any():
            return np.array([self.at(topic, time) for time in times.tolist()])
        for time in (times[0], *times[-2:]):
            self.at(topic, float(time))
        shift = self._shifts[self._stretch[topic]]
        return times + shift if shift else times

    def told(self) -> tuple[str, ...]:
        """Return the first steps as sentences."""
        return (
            *(
                message(
                    f"The clock was set back by {arg(size):.3g} s at {arg(when):.2f} s. What follows is placed"
                    f" {arg(_GAP_S):g} s later, and never paired with what came before."
                )
                for when, size in self.steps[:_MOST_TOLD]
            ),
            *(
                message(
                    f"At {arg(when):.0f} s the clock of the recording jumped by {arg(size):+.3g} s against that in the"
                    " headers: one of the two was set. Nothing is interpolated over such a gap."
                )
                for when, size in self.jumps[:_MOST_TOLD]
            ),
        )

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
