"""Timing of calls that take from a microsecond to seconds, in turn, with the spread between rounds."""

from __future__ import annotations

from time import perf_counter_ns
from typing import TYPE_CHECKING, Any, TypeVar

import numpy as np

from contactbench.pipeline.timing import clock_overhead

if TYPE_CHECKING:
    from collections.abc import Callable, Hashable, Mapping, Sequence

_Key = TypeVar("_Key", bound="Hashable")
_ROUND_NS = 4_000_000  # of one contender: long beside a clock, short beside what a machine does meanwhile
_MOST = 200


def medians(
    calls: Mapping[_Key, tuple[Callable[[Any], object], Sequence[Any]]], rounds: int
) -> dict[_Key, list[float]]:
    """
    Time each callable in every round, one call at a time; a contender's round follows the others'.

    Parameters
    ----------
    calls : mapping
        Key -> (function, arguments it is called with in turn).

    Returns
    -------
    dict
        Key -> the median of each round, µs.
    """
    overhead = clock_overhead()
    counts = {key: _count(function, arguments) for key, (function, arguments) in calls.items()}
    found: dict[_Key, list[float]] = {key: [] for key in calls}
    for number in range(rounds):
        for key, (function, arguments) in calls.items():
            taken = np.empty(counts[key])
            for i in range(len(taken)):
                argument = arguments[(number * len(taken) + i) % len(arguments)]
                before = perf_counter_ns()
                function(argument)
                taken[i] = perf_counter_ns() - before
            found[key].append((float(np.median(taken)) - overhead) / 1e3)
    return found


def _count(function: Callable[[Any], object], arguments: Sequence[Any]) -> int:
    """Warm up, and return how many calls make a round."""
    function(arguments[0])
    before = perf_counter_ns()
    function(arguments[-1])
    return int(np.clip(_ROUND_NS // max(perf_counter_ns() - before, 1), 1, _MOST))
