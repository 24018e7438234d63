"""Counts and clocks of a device that run round in a few bits, made to run on."""

import math
from collections import deque

# A longer step is believed only when the next number continues from it. Real gaps are mostly short; numbers
# that no checksum covers, damaged on the line, mostly land far away.
_LONGEST_STEP = 64
# So many overtaken numbers in a row, each above the one before and seen already, are a count that began again.
_BEGUN_AGAIN = 3

# Device time may run ahead of arrival time by this, s: bytes wait in buffers and then come at once.
_SLACK = 1.0


class SequenceCounter:
    """
    A device's sample count, unwrapped.

    A number far from the expected one is taken for the expected one until the next number comes: that
    either continues the old count (the number was damaged) or the new one (a long gap, or a restart).

    Parameters
    ----------
    bits : int
        Width of the count on the wire.
    reorder : int
        How far back a number may lie and still be an overtaken datagram; 0 on a line that keeps its order.
    """

    def __init__(self, bits: int, *, reorder: int = 0) -> None:
        self._modulus = 1 << bits
        self._reorder = reorder
        self._last: int | None = None
        self._unwrapped = 0
        self._doubted: tuple[int, int] | None = None  # the number, and its step from the one before
        self._seen: deque[int] = deque(maxlen=reorder)
        self._run, self._overtaken = 0, 0
        self.lost = 0
        self.overtaken = 0
        self.wraps = 0
        self.restarts = 0
        self.bad_numbers = 0

    def counted(self) -> dict[str, int]:
        """Return what the numbers tell, by the names of `Counters`."""
        return {name: getattr(self, name) for name in ("lost", "wraps", "restarts", "bad_numbers")}

    def number(self, raw: int) -> int | None:
        """Return the unwrapped count for a number from the wire; None for an overtaken one."""
        number = self._number(raw)
        if self._reorder:
            self._seen.append(raw)
        return number

    def _number(self, raw: int) -> int | None:
        if self._last is None:
            self._last = self._unwrapped = raw
            return raw
        step = (raw - self._last) % self._modulus
        if 1 <= step <= _LONGEST_STEP:
            if self._doubted is not None:
                self.bad_numbers += 1
            self._advance(raw, step)
        elif self._reorder and -step % self._modulus <= self._reorder:
            if not self._begins_again(raw):
                self.overtaken += 1
                return None
            self.restarts += 1
            self._unwrapped += 1
            self._last, self._doubted, self._run = raw, None, 0
            self._seen.clear()
        elif self._doubted is not None and 1 <= (raw - self._doubted[0]) % self._modulus <= _LONGEST_STEP:
            self._believe(raw, *self._doubted)
        else:
            self._doubt(raw, step)
        return self._unwrapped

    def _advance(self, raw: int, step: int) -> None:
        if self._last is not None and raw < self._last:
            self.wraps += 1
        self.lost += step - 1
        self._unwrapped += step
        self._last = raw
        self._doubted = None
        self._run = 0

    def _begins_again(self, raw: int) -> bool:
        """Tell whether an overtaken number is one of a restarted count: those come in order, and a second time."""
        in_order = self._run and 1 <= (raw - self._overtaken) % self._modulus <= self._reorder
        self._run = (self._run if in_order else 0) + 1 if raw in self._seen else 0
        self._overtaken = raw
        return self._run >= _BEGUN_AGAIN

    def _doubt(self, raw: int, step: int) -> None:
        if self._doubted is not None:
            self.bad_numbers += 1
        self._doubted = (raw, step)
        if self._last is not None:
            self._last = (self._last + 1) % self._modulus
            self.wraps += self._last == 0
        self._unwrapped += 1

    def _believe(self, raw: int, doubted: int, step: int) -> None:
        """Go on from the doubted number: the one after it continues it."""
        # A gap may end anywhere, a restarted device begins near 0.
        if 1 < step < self._modulus // 2 and doubted > _LONGEST_STEP:
            # One of the step was already taken when the number was doubted.
            self.lost += step - 1
            self._unwrapped += step - 1
            self.wraps += doubted < step
        else:
            self.restarts += 1
        self._last = doubted
        self._advance(raw, (raw - doubted) % self._modulus)


class DeviceClock:
    """
    A device's clock, unwrapped to seconds.

    A reading that is further ahead than the host's clock allows is a jump (also one back, which looks like
    almost a whole turn ahead): device time then goes on by the host's measure.

    Parameters
    ----------
    bits : int
        Width of the reading on the wire.
    tick : float
        Its unit, s.
    """

    def __init__(self, bits: int, tick: float) -> None:
        self._modulus = 1 << bits
        self._tick = tick
        self._last: tuple[int, float] | None = None
        self._ticks = 0  # whole ticks add up without rounding
        self.step = 0.0
        self.wraps = 0
        self.jumps = 0

    def read(self, raw: int, time: float) -> float:
        """
        Return device time, s, for a reading that arrived at host time `time`, s.

        `step` holds the seconds since the reading before; 0 after a jump.
        """
        self.step = 0.0
        if self._last is None:
            self._ticks = raw
        else:
            self._go_on(raw, time, *self._last)
        self._last = (raw, time)
        return self._ticks * self._tick

    def _go_on(self, raw: int, time: float, last: int, last_time: float) -> None:
        ticks = (raw - last) % self._modulus
        elapsed = time - last_time
        elapsed = elapsed if math.isfinite(elapsed) and elapsed > 0 else 0.0
        if ticks * self._tick > elapsed + _SLACK:
            self.jumps += 1
            self._ticks += int(elapsed / self._tick)
            return
        self.wraps += raw < last
        self.step = ticks * self._tick
        self._ticks += ticks
