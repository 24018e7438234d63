"""Many trials in parallel processes, and what their reports draw with."""

import os
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context
from typing import Any

import numpy as np


def in_processes(function: Callable[..., Any], jobs: Sequence[Any], workers: int | None) -> Iterator[Any]:
    """Yield what the function makes of each job, in their order; one worker is this process itself."""
    count = min(workers or os.cpu_count() or 1, len(jobs))
    if count <= 1:
        yield from map(function, jobs)
        return
    with ProcessPoolExecutor(count, mp_context=get_context("spawn")) as pool:
        try:
            for job in [pool.submit(function, each) for each in jobs]:
                yield job.result()
        except BaseException:
            pool.shutdown(wait=False, cancel_futures=True)
            raise


def rms(values: Any) -> float:
    """Return the root mean square of the values that are there; NaN where there is none."""
    known = np.asarray(values)[np.isfinite(values)]
    return float(np.sqrt(np.mean(known**2))) if len(known) else float("nan")


def canvas(wide: float, high: float) -> Any:
    """Make an empty figure, inches."""
    from matplotlib.figure import Figure as Canvas

    return Canvas(figsize=(wide, high), dpi=100, layout="constrained")
