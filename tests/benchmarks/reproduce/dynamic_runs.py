"""Many runs of the closed loop in parallel processes, those that are kept left out."""

from __future__ import annotations

from concurrent.futures import ProcessPoolExecutor, as_completed
from multiprocessing import get_context
from typing import TYPE_CHECKING

from benchmarks.reproduce.dynamic_cells import Cell, run_cell

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from benchmarks.reproduce.dynamic_cells import Outcome
    from benchmarks.reproduce.dynamic_store import Store

    from contactbench.pipeline.control.settings import ControlSettings
    from contactbench.pipeline.control.trace import Trace


def run_cells(
    cells: Sequence[Cell],
    traced: Callable[[Cell], bool],
    *,
    workers: int,
    progress: Callable[[int, int], None] = lambda _done, _total: None,
    settings: ControlSettings | None = None,
    store: Store | None = None,
) -> tuple[list[Outcome], dict[Cell, Trace]]:
    """Run many, the first seeds first: the results do not depend on how many processes share them."""
    outcomes: dict[Cell, Outcome] = {}
    traces: dict[Cell, Trace] = {}

    def take(outcome: Outcome, trace: Trace | None) -> None:
        outcomes[outcome.cell] = outcome
        if trace is not None:
            traces[outcome.cell] = trace
        progress(len(outcomes), len(cells))

    def done(outcome: Outcome, trace: Trace | None) -> None:
        if store is not None:
            store.keep(outcome, trace)
        take(outcome, trace)

    for cell in cells:
        found = None if store is None else store.take(cell, traced=traced(cell))
        if found is not None:
            take(*found)
    # Seed by seed: what is stopped early is a whole table of fewer seeds.
    left = sorted((cell for cell in cells if cell not in outcomes), key=lambda cell: cell.seed)
    if workers == 1:
        for cell in left:
            done(*_run(cell, traced(cell), settings))
    elif left:
        with ProcessPoolExecutor(min(workers, len(left)), mp_context=get_context("spawn")) as pool:
            try:
                jobs = [pool.submit(_run, cell, traced(cell), settings) for cell in left]
                for job in as_completed(jobs):
                    done(*job.result())
            except BaseException:
                pool.shutdown(wait=False, cancel_futures=True)
                raise
    return [outcomes[cell] for cell in cells], traces


def _run(cell: Cell, traced: bool, settings: ControlSettings | None) -> tuple[Outcome, Trace | None]:
    outcome, trace = run_cell(cell, settings)
    return outcome, trace if traced else None
