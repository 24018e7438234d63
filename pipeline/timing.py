"""Paired timing: every rival in the same run, a block each in turn."""

from __future__ import annotations

from collections.abc import Callable, Hashable, Mapping, Sequence
from dataclasses import dataclass
from time import perf_counter_ns
from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray

_Key = TypeVar("_Key", bound="Hashable")


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
    def of(cls, ns: NDArray[np.float64], overhead: float = 0.0) -> Timing:
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


def time_batches(
    timers: Mapping[
        _Key, tuple[Callable[[NDArray[np.float64]], NDArray[np.float64]], NDArray[np.float64], int]
    ],
    *,
    rounds: int = 20,
    after_round: Callable[[int], None] = lambda _: None,
) -> dict[_Key, Timing]:
    """Time compiled calls that measure themselves, in interleaved blocks.

    Parameters
    ----------
    timers : mapping
        Key -> (timer, rows, block). The timer takes some of the rows (n, ...) and returns the nanoseconds of
        each; a block is how many it gets at a time, at most all of them.
    rounds : int
        How many blocks of each; the rows are gone through in turn, and again from the start.
    after_round : callable
        Told how many rounds are done; what it raises ends the timing.

    Returns
    -------
    dict
        Key -> Timing; the clock's own time is left in.
    """
    taken: dict[_Key, list[NDArray[np.float64]]] = {key: [] for key in timers}
    for timer, rows, block in timers.values():  # warm-up
        timer(rows[:block])
    for done in range(rounds):
        for key, (timer, rows, block) in timers.items():
            start = done * block % max(1, len(rows) - block + 1)
            taken[key].append(timer(rows[start : start + block]))
        after_round(done + 1)
    return {key: Timing.of(np.concatenate(ns)) for key, ns in taken.items()}


def clock_overhead() -> float:
    """Return the median time between two readings of the clock, ns."""
    readings = [perf_counter_ns() for _ in range(20_001)]
    return float(np.median(np.diff(readings)))
