"""Every method on the same filtered wrenches of the same touches."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from benchmarks.reproduce.statistics import Errors, Located, bounds_m, errors_of

from contactbench import assets
from contactbench.pipeline.contact import WrenchNoise
from contactbench.pipeline.contact.methods import METHODS, make
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.study.marker_touches import ANGLES, model_of
from contactbench.pipeline.study.paper_setup import read_touches

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from contactbench.pipeline.contact.methods import Method
    from contactbench.pipeline.study.marker_touches import Touched
    from contactbench.pipeline.study.paper_setup import Bench

OURS, LITERAL = "contactbench", "algorithm1"


@dataclass(frozen=True, eq=False)
class ProbeResult:
    """All methods on one probe."""

    name: str
    touched: Touched
    bounds: NDArray[np.float64]  # (n,). m.
    located: dict[str, Located]  # By method
    errors: dict[tuple[str, str], Errors]  # dict of (angle, method) to Errors
    # dict of str to (n,). Compiled time of each solve, by method; without those that have none.
    times_us: dict[str, NDArray[np.float64]]
    notes: tuple[str, ...]  # Methods that are left out


def solver_for(method: str, name: str, facets: int, bench: Bench, R_WS: NDArray[np.float64]) -> Method:
    """Build a method that knows the filtered noise and what the calibration leaves, averaged over the touches."""
    extra = bench.calibration.model.wrench_covariance(R_WS).mean(axis=0)
    left = bench.filtered_noise
    return make(method, model_of(name, facets), WrenchNoise(left.force, left.torque, extra))


def key_of(name: str) -> int:
    """Return the key of a probe's noise: its own, whichever others are asked for."""
    return assets.PROBE_NAMES.index(name)


def locate_all(name: str, facets: int, touched: Touched, benches: Sequence[Bench]) -> ProbeResult:
    """Read, compensate and filter every touch with the bench of its seed, and locate it with every method."""
    parts: dict[str, list[Located]] = {method: [] for method in METHODS}
    times: dict[str, list[NDArray[np.float64]]] = {method: [] for method in METHODS}
    bounds, notes = [], {}
    for bench in benches:
        mine = touched.where(touched.seeds == bench.seed)
        wrenches = read_touches(bench, mine.contacts, mine.R_WS, key_of(name))
        bounds.append(bounds_m(mine, bench))
        for method in METHODS:
            try:
                built = solver_for(method, name, facets, bench, mine.R_WS)
            except InputError as error:
                notes[method] = f"{method} is left out: {error}."
                continue
            parts[method].append(Located.of(built.locate_batch(wrenches)))
            engine: Any = built.engine
            if hasattr(engine, "time_each"):
                times[method].append(np.asarray(engine.time_each(wrenches)) / 1e3)
    located = {method: Located.joined(each) for method, each in parts.items() if each}
    limit = np.concatenate(bounds)
    # Every method is also judged on the same touches: to answer only the easy ones must not look better.
    common = np.all([each.answered for each in located.values()], axis=0)
    errors = {
        (angle, method): _errors(answers, touched, limit, common, touched.angles == index)
        for index, angle in enumerate(ANGLES)
        for method, answers in located.items()
    }
    timed = {method: np.concatenate(each) for method, each in times.items() if each}
    return ProbeResult(name, touched, limit, located, errors, timed, tuple(notes.values()))


def _errors(
    located: Located,
    touched: Touched,
    bounds: NDArray[np.float64],
    common: NDArray[np.bool_],
    rows: NDArray[np.bool_],
) -> Errors:
    return errors_of(located.where(rows), touched.where(rows), bounds[rows], common[rows])
