"""Paired timing: every call counts, blocks take turns, and the rows are gone through."""

import numpy as np
import pytest

from contactbench.pipeline.timing import Timing, time_batches, time_calls


def test_timing_counts_every_call() -> None:
    seen: list[int] = []
    timings = time_calls({"append": (seen.append, list(range(50)))}, rounds=3, block=10)
    assert len(seen) == 2 * 10 + 3 * 10
    assert isinstance(timings["append"], Timing)


def test_batches_take_turns_after_a_warm_up() -> None:
    calls: list[tuple[str, list[float]]] = []

    def timer(name: str):
        def time_each(rows):
            calls.append((name, rows.tolist()))
            return rows + 100.0

        return time_each

    rows = np.arange(5.0)
    rounds: list[int] = []
    timings = time_batches(
        {"a": (timer("a"), rows, 2), "b": (timer("b"), rows, 9)}, rounds=3, after_round=rounds.append
    )
    every = rows.tolist()
    assert calls == [
        *(("a", [0.0, 1.0]), ("b", every)),  # warm-up
        *(("a", [0.0, 1.0]), ("b", every)),
        *(("a", [2.0, 3.0]), ("b", every)),
        *(("a", [0.0, 1.0]), ("b", every)),
    ]
    assert rounds == [1, 2, 3]
    # The warm-up is not counted: 0 1 2 3 0 1 remain of a.
    assert timings["a"].median == pytest.approx(101.0)
    assert timings["b"] == Timing.of(np.tile(rows + 100.0, 3))


def test_what_a_round_raises_ends_the_timing() -> None:
    def stop(done: int) -> None:
        if done == 2:
            raise KeyboardInterrupt

    calls: list[int] = []

    def time_each(rows):
        calls.append(len(rows))
        return rows

    with pytest.raises(KeyboardInterrupt):
        time_batches({0: (time_each, np.ones(4), 4)}, rounds=50, after_round=stop)
    assert len(calls) == 1 + 2
