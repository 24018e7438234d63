"""Watches whether a tip that was told to press does."""

from __future__ import annotations

from typing import TYPE_CHECKING

from contactbench.pipeline.errors import message
from contactbench.pipeline.simulation.virtual.given import Slip

if TYPE_CHECKING:
    from contactbench.pipeline.simulation.virtual.given import Done

SLIPPED_S = 0.5
_SENTENCE = message(
    "The tip slid off the probe and presses nothing. Release it, and touch elsewhere or with less tilt."
)


class SlipWatch:
    """
    Finds touches that press nothing.

    Attributes
    ----------
    slips : list of Slip
        Found so far, each once as long as it lasts.
    """

    def __init__(self) -> None:
        self.slips: list[Slip] = []
        self._touch: Done | None = None
        self._pressed_at, self._slipped = 0.0, False

    def begin(self, touch: Done) -> None:
        """Watch a touch from now on."""
        self._touch, self._pressed_at, self._slipped = touch, touch.time, False

    def end(self) -> None:
        """Watch nothing: the tip is away."""
        self._touch, self._slipped = None, False

    def look(self, time: float, pressing: bool) -> None:
        """See how it is at a time of the bench's clock, s."""
        if self._touch is None:
            return
        if pressing:
            self._pressed_at, self._slipped = time, False
        elif not self._slipped and time > self._pressed_at + SLIPPED_S - 1e-9:
            self._slipped = True
            self.slips.append(Slip(time, self._touch))

    def findings(self) -> tuple[str, ...]:
        """Return what is wrong now, in sentences."""
        return (_SENTENCE,) if self._slipped else ()
