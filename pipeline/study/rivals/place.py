"""Where a probe is touched: our solver beside Algorithm 1, ray tracers along the wrench axis, Levenberg-Marquardt."""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from time import perf_counter_ns
from typing import TYPE_CHECKING, Any, TypeVar

import numpy as np

from contactbench import assets
from contactbench.pipeline.contact import ContactSolver, WrenchNoise, methods
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.simulation import draw_touches
from contactbench.pipeline.simulation.marker_touches import model_of
from contactbench.pipeline.study.ablation.effects import NOISES
from contactbench.pipeline.study.ablation.location_choices import sigmas_of
from contactbench.pipeline.study.rivals.rays import TRACERS, bare_ray
from contactbench.pipeline.study.rivals.rows import (
    BATCH,
    COMPILED,
    FAMILY,
    OURS,
    RAY,
    SURE,
    WRENCH,
    Contender,
    Row,
    erred,
    known,
    missing,
    timed,
)
from contactbench.pipeline.timing import clock_overhead

if TYPE_CHECKING:
    from collections.abc import Callable, Hashable, Iterator, Mapping, Sequence

    from numpy.typing import NDArray

    from contactbench.pipeline.kernel import Batch
    from contactbench.pipeline.simulation import Touches

_QUIETEST = np.repeat([1e-6, 1e-8], 3)
_TOGETHER = 1_000
_ROUND_NS = 4_000_000  # of one contender: long beside a clock, short beside what a machine does meanwhile
_MOST_CALLS = 200
_FEW = 300  # wrenches of methods that take up to a millisecond each
_SLOW = ("Algorithm 1, C++", "Levenberg-Marquardt, SciPy", "closed form over all facets, C++")


_Key = TypeVar("_Key", bound="Hashable")


@dataclass(frozen=True, eq=False)
class _Built:
    contender: Contender
    locate: Callable[[Any], object]
    batch: Callable[[Any], Batch]
    engine: Any


def place_rows(probe: str, facets: int, touches: int, rounds: int, seed: int) -> Iterator[Row]:
    """
    Measure all contenders on one mesh of a bundled probe.

    Yields
    ------
    dict
        Versions and what is missing, errors at every noise, times in every mode.
    """
    rng = np.random.default_rng([seed, 21])
    truth = draw_touches(assets.surface(probe), touches, rng, above=0.02)
    drawn = rng.standard_normal(truth.wrenches.shape)
    for name, noise in NOISES.items():
        built, absent = _build(probe, facets, noise)
        if name == "filtered":
            yield from absent
            yield from (known(FAMILY, each.contender) for each in built)
        wrenches = truth.wrenches + sigmas_of(noise) * drawn
        yield from _errors(built, probe, facets, name, truth, wrenches)
        if name == "filtered":
            yield from _times(built, probe, facets, wrenches, rounds)


def _build(probe: str, facets: int, noise: float) -> tuple[list[_Built], list[Row]]:
    mesh = model_of(probe, facets)
    sigmas = np.maximum(sigmas_of(noise), _QUIETEST)
    told = WrenchNoise(sigmas[:3], sigmas[3:])
    solver = ContactSolver(mesh, told)
    made = [
        _Built(Contender(OURS), solver.locate, solver.locate_batch, solver),
        *(
            _Built(Contender(name), method.locate, method.locate_batch, method.engine)
            for name, method in (
                (_SLOW[2], methods.scan(mesh, told)),
                (_SLOW[0], methods.algorithm1(mesh, told)),
                ("Levenberg-Marquardt, C++", methods.iterative(mesh, told)),
                (_SLOW[1], methods.iterative(mesh, told, library="scipy")),
            )
        ),
    ]
    absent = []
    for contender, make in TRACERS.items():
        try:
            axis = make(solver)
        except (ImportError, InputError) as error:
            absent.append(missing(FAMILY, contender, error))
            continue
        made.append(_Built(contender, axis.locate, axis.locate_batch, axis))
    return made, absent


def _errors(
    built: list[_Built],
    probe: str,
    facets: int,
    noise: str,
    truth: Touches,
    wrenches: NDArray[np.float64],
) -> Iterator[Row]:
    first = built[0].batch(wrenches)
    ours = np.linalg.norm(first.points - truth.points, axis=1)
    sure = np.where(first.accepted, ours, np.nan)
    yield erred(FAMILY, SURE, probe, noise, sure, ours, facets=facets)
    for each in built:
        some = _FEW if each.contender.name == _SLOW[1] else len(wrenches)
        points = each.batch(wrenches[:some]).points
        error = np.linalg.norm(points - truth.points[:some], axis=1)
        yield erred(FAMILY, each.contender.name, probe, noise, error, ours[:some], facets=facets)


def _times(
    built: list[_Built], probe: str, facets: int, wrenches: NDArray[np.float64], rounds: int
) -> Iterator[Row]:
    calls: dict[tuple[str, str], tuple[Callable[[Any], object], Any]] = {}
    compiled = {}
    for each in built:
        name = each.contender.name
        rows = list(wrenches[: _FEW if name in _SLOW else _TOGETHER])
        calls[name, WRENCH] = (each.locate, rows)
        if name not in _SLOW:
            calls[name, BATCH] = (each.batch, [wrenches[:_TOGETHER]])
        if hasattr(each.engine, "time_each"):
            compiled[name] = partial(each.engine.time_each, wrenches[: _FEW if name in _SLOW else _TOGETHER])
        if each.contender in TRACERS:
            call, prepare = bare_ray(each.engine)
            origins, directions = each.engine.rays(wrenches[:_TOGETHER])
            rays = [prepare(origins[i : i + 1], directions[i : i + 1]) for i in range(len(origins))]
            calls[name, RAY] = (call, rays)
    for (name, mode), us in medians(calls, rounds).items():
        shared = min(_TOGETHER, len(wrenches)) if mode == BATCH else 1
        yield timed(FAMILY, name, probe, mode, [value / shared for value in us], facets=facets)
    own: dict[str, list[float]] = {name: [] for name in compiled}
    for _ in range(rounds):
        for name, time_each in compiled.items():
            own[name].append(float(np.median(time_each())) / 1e3)
    for name, us in own.items():
        yield timed(FAMILY, name, probe, COMPILED, us, facets=facets)


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
    return int(np.clip(_ROUND_NS // max(perf_counter_ns() - before, 1), 1, _MOST_CALLS))
