"""The recommendation: the fewest facets that keep the goal, and the reason in words."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from contact_cases import ball

from contactbench.pipeline.preparation.ladder import (
    ContactDifference,
    Goal,
    LadderError,
    PartErrors,
    Rung,
    recommend,
)
from contactbench.pipeline.preparation.ladder.ladder import Speed
from contactbench.pipeline.timing import Timing

BOUND = 1e-3


def _errors(p95: float, *, growth: float = 0.0, failed: int = 0, bound: float = BOUND) -> PartErrors:
    difference = ContactDifference(1_000, 1_000 - failed, p95 / 2, p95, 3 * p95, failed, 0, 0, failed, 0)
    return PartErrors("all", 1_000, difference, difference, bound, growth)


def _rungs(*errors: PartErrors, bound: float = BOUND) -> list[Rung]:
    speed = Speed(Timing(50_000.0, 1.0), Timing(1_000.0, 1.0))
    rungs = []
    for facets, each in zip((320, 1280, 5120), (*errors, _errors(0.0, bound=bound)), strict=True):
        rungs.append(Rung(ball(facets), facets, "none", 0.0, 0.0, 1, (each,), speed))
    return rungs


def test_the_fewest_facets_within_the_noise_are_taken() -> None:
    found = recommend(_rungs(_errors(0.5e-3), _errors(0.2e-3, growth=0.021)), Goal())
    assert found.facets == 1280
    assert found.limit == pytest.approx(np.sqrt(1.05**2 - 1) * BOUND)
    assert "1,280 facets, the fewest measured that suffice: the 95th percentile" in found.reason
    assert "0.2 mm, 0.2 of the noise's 1 mm, and the total error changes by +2.1 %" in found.reason
    assert "With 320 the 95th percentile is 0.5 mm, over the limit of 0.32 mm." in found.reason
    assert "1 µs a solve (1 on the full mesh), the paper's loop 50 µs (50)" in found.reason


def test_what_the_rest_of_the_probe_pays_is_told_and_does_not_decide() -> None:
    rungs = [
        replace(rung, errors=(rung.judged, replace(_errors(0.7e-3), part="rest")))
        for rung in _rungs(_errors(0.1e-3), _errors(0.1e-3))
    ]
    found = recommend(rungs, Goal())
    assert found.facets == 320
    assert (
        "Outside the regions, which does not count for the choice, the 95th percentile is 0.7 mm"
        in found.reason
    )


def test_the_coarsest_rung_that_will_do_is_taken_even_when_a_finer_one_fails() -> None:
    found = recommend(_rungs(_errors(0.1e-3), _errors(0.5e-3)), Goal())
    assert found.facets == 320
    assert "With" not in found.reason


def test_a_limit_in_metres_goes_before_the_noise() -> None:
    rungs = _rungs(_errors(0.5e-3, growth=0.2), _errors(0.2e-3))
    assert recommend(rungs, Goal(limit_m=0.6e-3)).facets == 320
    assert recommend(rungs, Goal(limit_m=0.7e-3, statistic="max")).facets == 1280
    assert recommend(rungs, Goal(limit_m=0.6e-3, statistic="mean")).facets == 320
    found = recommend(rungs, Goal(limit_m=0.1e-3))
    assert found.facets is None
    assert found.limit == 0.1e-3
    assert "Keep the full mesh of 5,120 facets: no simplified mesh suffices." in found.reason
    assert "Even with 1,280 the 95th percentile is 0.2 mm, over the limit of 0.1 mm" in found.reason


def test_few_large_errors_that_the_percentile_misses_are_seen_in_the_growth() -> None:
    found = recommend(_rungs(_errors(0.1e-3, growth=0.08), _errors(0.1e-3, growth=0.04)), Goal())
    assert found.facets == 1280
    assert "With 320 the total error grows by 8.0 %, more than 5 %." in found.reason


def test_a_mesh_that_loses_touches_will_not_do() -> None:
    found = recommend(_rungs(_errors(0.1e-3, failed=30), _errors(0.1e-3, failed=20)), Goal())
    assert found.facets == 1280
    assert "With 320 3 % of the settled touches are lost, doubtful or jump, more than 2 %." in found.reason
    assert recommend(_rungs(_errors(1e-4, failed=30), _errors(1e-4)), Goal(failed=0.03)).facets == 320


def test_nothing_settled_is_told() -> None:
    nothing = ContactDifference(1_000, 0, None, None, None, 1_000, 0, 0, 1_000, 0)
    errors = replace(_errors(0.0), noisy=nothing, growth=None)
    found = recommend(_rungs(errors, errors), Goal())
    assert found.facets is None
    assert "Even with 1,280 no touch is settled." in found.reason


def test_without_noise_a_length_is_asked_for() -> None:
    noiseless = _errors(1e-4, bound=0.0)
    found = recommend(_rungs(noiseless, noiseless, bound=0.0), Goal())
    assert found.facets is None
    assert "Give a limit as a length." in found.reason
    assert recommend(_rungs(noiseless, noiseless, bound=0.0), Goal(limit_m=2e-4)).facets == 320


def test_a_full_mesh_alone_is_kept() -> None:
    found = recommend(_rungs(_errors(0.0), _errors(0.0))[-1:], Goal())
    assert found.facets is None
    assert "no simplified one was measured" in found.reason


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        ({"limit_m": 0.0}, "length above 0"),
        ({"limit_m": np.nan}, "length above 0"),
        ({"growth": 0.0}, "above 0"),
        ({"failed": 1.1}, "0 to 1"),
        ({"statistic": "median"}, "choose one of mean, p95, max"),
    ],
)
def test_wrong_goals_are_named(arguments: dict[str, object], said: str) -> None:
    with pytest.raises(LadderError, match=said):
        Goal(**arguments)  # type: ignore[arg-type]
