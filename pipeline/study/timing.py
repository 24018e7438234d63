"""Paired timing of Python calls: every rival in the same run, a block each in turn."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from time import perf_counter_ns
from typing import Any

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True)
class Timing:
    """Nanoseconds of one call.

    Attributes
    ----------
    median, p99 : float
        Over all calls, clock overhead taken off.
    """

    median: float
    p99: float

    @classmethod
    def of(cls, ns: NDArray[np.float64], overhead: float = 0.0) -> "Timing":
        """Summarise calls that took `ns` (n,) each, of which `overhead` is the clock's."""
        return cls(float(np.median(ns)) - overhead, float(np.percentile(ns, 99)) - overhead)


def time_calls(
    calls: Mapping[str, tuple[Callable[[Any], object], Sequence[Any]]], *, rounds: int = 40, block: int = 250
) -> dict[str, Timing]:
    """Time each callable over its arguments, one call at a time, in interleaved blocks.

    Parameters
    ----------
    calls : mapping
        Name -> (function, arguments it is called with in turn). Machines drift: because a block of each
        follows a block of the others, a drift slows them all.
    rounds, block : int
        How many blocks, and calls in each.
    """
    overhead = clock_overhead()
    taken: dict[str, list[int]] = {name: [] for name in calls}
    for _ in range(2):  # warm-up
        for function, arguments in calls.values():
            for argument in arguments[:block]:
                function(argument)
    for r in range(rounds):
        for name, (function, arguments) in calls.items():
            times = taken[name]
            start = r * block % max(1, len(arguments) - block)
            for argument in arguments[start : start + block]:
                before = perf_counter_ns()
                function(argument)
                times.append(perf_counter_ns() - before)
    return {name: Timing.of(np.array(times, dtype=np.float64), overhead) for name, times in taken.items()}


def clock_overhead() -> float:
    """Return the median time between two readings of the clock, ns."""
    readings = [perf_counter_ns() for _ in range(20_001)]
    return float(np.median(np.diff(readings)))
