"""What a sweep will take, before it is begun: measured on a few of its cells."""

from __future__ import annotations

import json
import sys
from dataclasses import asdict, dataclass, replace
from itertools import groupby
from time import process_time
from typing import TYPE_CHECKING, Any, TypeVar

from contactbench.pipeline.study.pages import cores
from contactbench.pipeline.study.sweep import cell as cells_module
from contactbench.pipeline.study.sweep.run import distinct, tasks_of

if TYPE_CHECKING:
    from collections.abc import Callable

    from contactbench.pipeline.study.sweep.plan import Cell, SweepPlan

    Kind = tuple[str, str, int]  # method, probe, facets: what cells are alike in that cost the same

_T = TypeVar("_T")
_MOST, _FEWER = 1_000, 4  # touches that a cell is measured with, and with a quarter of them
_TOUCH_BYTES = 2_000  # of memory, for each touch of a cell: wrenches, answers and what they are judged by


@dataclass(frozen=True)
class Estimate:
    """What a sweep takes."""

    cells: int
    touches: int  # of all cells
    tasks: int
    measured: int  # cells that were tried
    core_hours: float  # processor time
    workers: int
    hours: float  # on so many cores that do nothing else
    worker_MB: float | None  # memory of each; None: this system does not say
    results_MB: float  # on the disk, while it is computed

    def to_json(self) -> dict[str, Any]:
        """Return plain data for ``--json``."""
        return asdict(self)


def estimate(
    plan: SweepPlan,
    *,
    workers: int | None = None,
    progress: Callable[[int, int], None] | None = None,
    clock: Callable[[], float] = process_time,
) -> Estimate:
    """
    Estimate what a plan takes: of each method on each mesh one cell is computed, with few touches.

    Parameters
    ----------
    workers : int, optional
        Cores, on one machine or on many; left out, those of this one.
    progress : callable, optional
        Gets the number of cells that are measured, and of all that will be.
    clock : callable
        Processor time, s.

    Raises
    ------
    InputError
        A probe of the plan cannot be read.
    """
    cells, _ = distinct(plan)
    count = workers or cores()
    tasks = tasks_of(cells, count)
    some = {_kind(cell): cell for cell in reversed(cells)}  # of each kind the first
    most = min(plan.touches, _MOST)
    making: dict[Kind, float] = {}
    costs: dict[Kind, float] = {}
    drawing: dict[str, float] = {}  # of all touches of a cell, for each probe
    line = 0
    for number, (kind, cell) in enumerate(sorted(some.items(), key=lambda each: cells.index(each[1])), 1):
        few, many = (replace(cell, touches=touches) for touches in (max(most // _FEWER, 10), most))
        cells_module.touches_of(few)  # drawn before, as by the method that had its turn before
        first, _ = _seconds(cells_module.run_cell, few, clock)
        again, _ = _seconds(cells_module.run_cell, few, clock)
        drawn, _ = _seconds(cells_module.touches_of, many, clock)
        full, row = _seconds(cells_module.run_cell, many, clock)
        drawing[cell.probe] = drawn * plan.touches / most
        each = max(full - again, 0.0) / max(most - few.touches, 1)
        making[kind] = max(first - again, 0.0)
        costs[kind] = full + each * (plan.touches - most)
        line = max(line, len(json.dumps(row)))
        if progress is not None:
            progress(number, len(some))
    cells_module.forget()

    def taken(task: list[Cell]) -> float:
        # Methods take turns on the same touches.
        drawn = [probe for (probe, _), _ in groupby(task, lambda cell: (cell.probe, cell.touch_seed))]
        made = sum(making[kind] for kind in set(map(_kind, task)))
        return made + sum(costs[_kind(cell)] for cell in task) + sum(drawing[probe] for probe in drawn)

    by_task = [taken(task) for task in tasks]
    # Nobody ends before the longest task does.
    seconds = max(sum(by_task) / count, max(by_task, default=0.0))
    peak = _peak_bytes()
    return Estimate(
        cells=len(cells),
        touches=len(cells) * plan.touches,
        tasks=len(tasks),
        measured=len(some),
        core_hours=sum(by_task) / 3600,
        workers=count,
        hours=seconds / 3600,
        worker_MB=None if peak is None else (peak + _TOUCH_BYTES * plan.touches) / 1e6,
        results_MB=line * len(cells) / 1e6,
    )


def _kind(cell: Cell) -> Kind:
    return cell.method, cell.probe, cell.facets


def _seconds(work: Callable[[Cell], _T], cell: Cell, clock: Callable[[], float]) -> tuple[float, _T]:
    begin = clock()
    made = work(cell)
    return clock() - begin, made


def _peak_bytes() -> int | None:
    """Return the most memory that this process has had."""
    try:
        import resource
    except ImportError:  # Windows
        return None
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    return peak if sys.platform == "darwin" else 1024 * peak
