"""What a parser had to throw away in the last second, and what never came."""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass

from contactbench.pipeline.devices.protocols import Counters

_WINDOW_S = 1.0
_SHARE = 0.01  # of frames or bytes: less is shown by the counters only
_STEP_S = 0.02
# A leap of a count is believed by a parser with the frame after it, so these few tell nothing of loss.
_SETTLE_FRAMES = 3
_NO_FRAME_BYTES = 64  # two of the longest sensor frames


@dataclass(frozen=True, slots=True)
class _Mark:
    time: float
    frames: int
    damaged: int
    skipped: int
    received: int
    lost: int
    restarts: int


class Damage:
    """
    Judges a parser's counters over the last second.

    Text that a device answers before it streams belongs to no frame either: judging begins with the first
    frames.

    Parameters
    ----------
    rate : float
        Frames a second that should come.
    """

    def __init__(self, rate: float) -> None:
        self._least = max(1.0, _SHARE * rate * _WINDOW_S)
        self._last = Counters()
        self._marks: deque[_Mark] = deque()
        self._lost = self._restarts = 0
        self._forgiving = 0  # until there are so many frames
        self._since: int | None = None  # frames when the line was opened; None: judging has begun
        self.forget()

    def see(self, now: float, counters: Counters, received: int) -> None:
        """
        Take the counters as they are.

        Parameters
        ----------
        now : float
            s.
        counters : Counters
        received : int
            Bytes since the stream was made.
        """
        if counters.frames >= self._forgiving:
            if not self._forgiving:
                self._lost += counters.lost - self._last.lost
                self._restarts += counters.restarts - self._last.restarts
            self._forgiving = 0
        self._last = counters
        if self._since is not None and counters.frames >= self._since + _SETTLE_FRAMES:
            self._since = None
            self._marks.clear()
        self._mark(now, received)

    def forgive(self) -> None:
        """Take the next step of the device's count for explained, by a silence or a leap that was shown."""
        self._forgiving = self._last.frames + _SETTLE_FRAMES

    def forget(self) -> None:
        """Begin anew with the next frames: the line was lost."""
        self._marks.clear()
        self._since = self._last.frames
        self.forgive()

    def findings(self) -> dict[str, str]:
        """Return what is wrong, by kind."""
        if len(self._marks) < 2:
            return {}
        first, last = self._marks[0], self._marks[-1]
        if self._since is not None:
            return _without(first, last, self._since)
        found = {}
        damaged, frames = last.damaged - first.damaged, last.frames - first.frames
        skipped, received = last.skipped - first.skipped, last.received - first.received
        if damaged >= self._least:
            found["damaged"] = (
                f"{damaged} of the last {damaged + frames} frames were damaged: check cable, shield and speed of"
                " the line."
            )
        elif skipped > 0 and skipped >= _SHARE * received:
            found["skipped"] = (
                f"{skipped} of the last {received} bytes belong to no frame: check cable, shield and speed of the line,"
                " and that nothing else uses it."
            )
        if (lost := last.lost - first.lost) >= self._least:
            found["lost"] = (
                f"{lost} of the last {lost + frames} samples were lost, by the device's own count: check the line, or"
                " ask for a lower rate."
            )
        if last.restarts > first.restarts:
            found["restarted"] = (
                "The device's count or clock began anew: it was switched off and on, or its clock was set. The times of"
                " the next 0.2 s are estimates and are marked."
            )
        return found

    def _mark(self, now: float, received: int) -> None:
        marks, c = self._marks, self._last
        mark = _Mark(now, c.frames, c.bad_checksums, c.skipped_bytes, received, self._lost, self._restarts)
        if len(marks) > 1 and now - marks[-2].time < _STEP_S:
            marks[-1] = mark
        else:
            marks.append(mark)
        while len(marks) > 2 and marks[1].time <= now - _WINDOW_S:
            marks.popleft()


def _without(first: _Mark, last: _Mark, since: int) -> dict[str, str]:
    received = last.received - first.received
    if last.frames > since or received < _NO_FRAME_BYTES:
        return {}
    return {
        "no frame": f"{received} bytes came, and no frame in them: check the kind of device and the speed of the line."
    }
