"""Waiting for what happens elsewhere, in a thread, a process or a file: for a condition, never for a time."""

import threading
import time
from collections.abc import Callable
from typing import TypeVar

PATIENCE_S = 60.0
_Found = TypeVar("_Found")


def until(holds: Callable[[], _Found], seconds: float = PATIENCE_S) -> _Found:
    """Return what `holds` returns as soon as that is true; longer than `seconds` is a failure."""
    end = time.monotonic() + seconds
    while not (found := holds()):
        assert time.monotonic() < end, "it did not happen"
        threading.Event().wait(0.005)
    return found


def be_slow(seconds: float) -> None:
    """Take that long, as a slow disk or listener does: only where slowness is what is tested."""
    threading.Event().wait(seconds)


class JumpingClock:
    """The `time` of a module, which can be put forward as if the computer had been asleep."""

    def __init__(self) -> None:
        self.ahead = 0.0

    def __getattr__(self, name: str) -> object:
        return getattr(time, name)

    def monotonic(self) -> float:
        return time.monotonic() + self.ahead
