"""The zero follows: what the sensor reads in moments without touch is taken off, as a runtime does it."""

import numpy as np
from numpy.typing import NDArray

from contactbench.pipeline.errors import arg, message
from contactbench.pipeline.gates import Gates
from contactbench.pipeline.kernel import Zero, ZeroFollow


class FollowedZero:
    """One stream, with the usual least force."""

    def __init__(self) -> None:
        self._least = Gates().min_force
        self._zero = ZeroFollow(self._least)

    def taken(
        self, wrenches: NDArray[np.float64], R_WS: NDArray[np.float64], times: NDArray[np.float64]
    ) -> NDArray[np.float64]:
        """
        Return what to take off the next wrenches, because it is read between touches: (n, 6).

        Parameters
        ----------
        wrenches : (n, 6)
            Compensated; S, N and N·m. NaN for a sample that is missing.
        R_WS : (n, 3, 3)
        times : (n,)
            s.
        """
        rows, turns, at = (np.ascontiguousarray(each, dtype=np.float64) for each in (wrenches, R_WS, times))
        return self._zero.taken(rows, turns, at, self._least)

    def at(self, now: float) -> Zero:
        """Say what is taken off, and how long ago it was seen; `now` in s of the samples' clock."""
        return self._zero.at(now)


def follow_words(zero: Zero) -> str:
    """Say what is taken off because the zero follows, with its uncertainty and age; empty: it does not follow."""
    if zero.follows == "off":
        return ""
    if (taken := zero.taken) is None or (sigma := zero.taken_sigma) is None:
        return message("Zero follows: nothing subtracted yet. Lift the probe clear for half a second.")
    sizes = []
    for part, scale, unit in ((slice(3), 1.0, "N"), (slice(3, 6), 1e3, "mN·m")):
        size = scale * float(np.linalg.norm(taken[part]))
        sizes.append(f"{size:.2g} ± {scale * float(sigma[part].max()):.1g} {unit}")
    off, seen = message(f"{arg(sizes[0])}, {arg(sizes[1])}"), zero.seen
    if zero.follows == "stopped":
        return message(
            f"Zero has stopped following at {arg(off)}, last seen {arg(seen):.0f} s ago: something leans on the"
            " probe, or the zero is too far off. Lift the probe clear, or recalibrate."
        )
    return message(f"Zero follows: {arg(off)}, last seen {arg(seen):.0f} s ago.")
