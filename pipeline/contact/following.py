"""The zero follows: what the sensor reads in moments without touch is taken off, as a runtime does it."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from contactbench.pipeline.gates import Gates
from contactbench.pipeline.kernel import ZeroFollow

if TYPE_CHECKING:
    from numpy.typing import NDArray


class FollowedZero:
    """One stream, with the usual least force."""

    def __init__(self) -> None:
        self._least = Gates().min_force
        self._zero = ZeroFollow(self._least)

    def followed(
        self, wrenches: NDArray[np.float64], R_WS: NDArray[np.float64], times: NDArray[np.float64]
    ) -> NDArray[np.float64]:
        """
        Return the next wrenches without what is read between touches, (n, 6).

        Parameters
        ----------
        wrenches : (n, 6)
            Compensated; S, N and N·m. NaN for a sample that is missing.
        R_WS : (n, 3, 3)
        times : (n,)
            s.
        """
        rows, turns, at = (np.ascontiguousarray(each, dtype=np.float64) for each in (wrenches, R_WS, times))
        return np.asarray(rows - self._zero.taken(rows, turns, at, self._least))
