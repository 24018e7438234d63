"""The added contact error: exact where it can be worked out, and nothing that went wrong is left out."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from contact_cases import ball, bundled
from hypothesis import given
from hypothesis import strategies as st

from contactbench.pipeline.contact import Reason, WrenchNoise
from contactbench.pipeline.kernel import SurfaceIndex
from contactbench.pipeline.mesh import Probe
from contactbench.pipeline.preparation.ladder.compare import (
    ContactDifference,
    ContactReference,
    ExpectedTouches,
    LadderError,
    PartErrors,
    _difference,
    _growth,
    draw_parts,
)
from contactbench.pipeline.preparation.ladder.ladder import Goal, Rung, Speed, recommend
from contactbench.pipeline.timing import Timing

SQUARE = ExpectedTouches(friction_angle=(0.0, 0.0), torsion_arm=0.0, count=300)


def _inflated(probe: Probe, factor: float) -> Probe:
    centre = probe.bounds.mean(axis=0)
    return Probe.from_arrays(centre + factor * (probe.vertices - centre), probe.faces)


def test_the_same_mesh_adds_nothing() -> None:
    probe = bundled("t-shape", 2_000, regions=True)
    for errors in ContactReference(probe, ExpectedTouches(count=500)).compare(probe):
        for difference in (errors.noisy, errors.noise_free):
            assert difference.compared == difference.settled > 400
            assert difference.mean == difference.p95 == difference.largest == 0
            assert difference.lost == difference.doubtful == difference.gained == difference.changed == 0
        assert errors.growth == 0


def test_a_larger_ball_moves_a_perpendicular_touch_by_the_difference_of_the_radii() -> None:
    small = ball(5120)
    [errors] = ContactReference(small, SQUARE).compare(_inflated(small, 1.01))
    # A facet's plane is up to 0.05 % nearer than the radius of 30 mm.
    assert errors.part == "all"
    assert errors.noise_free.mean == pytest.approx(0.3e-3, rel=2e-3)
    assert errors.noise_free.largest == pytest.approx(0.3e-3, rel=2e-3)
    assert errors.noise_free.compared == errors.touches == 300


def test_the_bound_is_what_the_noise_does_and_the_growth_what_the_shape_adds() -> None:
    small = ball(5120)
    # Torque noise alone on a perpendicular touch: each direction across the force errs by sigma / |F|.
    expected = ExpectedTouches(
        WrenchNoise(0.0, 0.002), (10.0, 10.0), (0.0, 0.0), torsion_arm=0.0, count=4_000
    )
    [errors] = ContactReference(small, expected).compare(_inflated(small, 1.01))
    assert errors.bound == pytest.approx(np.sqrt(2) * 0.002 / 10, rel=0.01)
    # The added error stands along the force, the noise across it: the squares add up.
    grown = np.sqrt(errors.bound**2 + 0.3e-3**2) / errors.bound - 1
    assert errors.growth == pytest.approx(grown, rel=0.05)


def test_a_mesh_elsewhere_loses_every_touch_and_says_so() -> None:
    probe = ball(1280)
    away = Probe.from_arrays(probe.vertices + [5.0, 0, 0], probe.faces)  # where no line of force leads
    [errors] = ContactReference(probe, SQUARE).compare(away)
    noisy = errors.noisy
    assert (noisy.compared, noisy.lost, noisy.changed) == (0, noisy.settled, 300)
    assert noisy.mean is noisy.p95 is noisy.largest is errors.growth is None
    assert errors.over_bound("p95") is None
    assert noisy.failed_share == 1


def test_touches_are_spread_over_the_regions_and_over_the_rest() -> None:
    probe = bundled("convex", 2_000, regions=True)
    index = SurfaceIndex(probe.vertices, probe.faces)
    parts = draw_parts(probe, ExpectedTouches(count=2_000))
    assert [drawn.part for drawn in parts] == ["region", "rest"]
    for drawn, inside in zip(parts, (True, False), strict=True):
        distance, facet, _ = index.closest(drawn.truth.points)
        assert distance.max() < 1e-9
        # A point near an edge may be told to be on either facet.
        assert np.mean((probe.region[facet] > 0) == inside) > 0.995
        # By area: as many on the larger half of the facets as their area says.
        mask = (probe.region > 0) == inside
        large = mask & (probe.areas > np.median(probe.areas[mask]))
        share = probe.areas[large].sum() / probe.areas[mask].sum()
        assert np.mean(large[facet]) == pytest.approx(share, abs=0.04)


def test_no_touch_is_expected_where_nothing_can_touch() -> None:
    probe = bundled("convex", 2_000, regions=True)
    inside = probe.region > 0
    away = probe.bounds[0, 2] + 0.5 * np.ptp(probe.bounds[:, 2])
    behind = probe.vertices[probe.faces, 2].mean(axis=1) < away
    labels = np.where(inside, 1, np.where(behind, 2, 0)).astype(np.int32)
    parts = draw_parts(probe.with_region(labels, (2,)), ExpectedTouches(count=500))
    assert [drawn.part for drawn in parts] == ["region", "rest"]
    index = SurfaceIndex(probe.vertices, probe.faces)
    for drawn, label in zip(parts, (1, 0), strict=True):
        assert np.mean(labels[index.closest(drawn.truth.points)[1]] == label) > 0.99
    alone = probe.with_region(np.ones(len(probe.faces), dtype=np.int32), (1,))
    with pytest.raises(LadderError, match="untouchable"):
        draw_parts(alone, ExpectedTouches(count=500))


def test_forces_and_angles_are_those_asked_for() -> None:
    expected = ExpectedTouches(force=(2.0, 3.0), friction_angle=(10.0, 20.0), count=1_000)
    [drawn] = draw_parts(ball(), expected)
    force = np.linalg.norm(drawn.truth.wrenches[:, :3], axis=1)
    assert 2 <= force.min() < 2.02
    assert 2.98 < force.max() <= 3
    cosine = -np.sum(drawn.truth.wrenches[:, :3] * drawn.truth.normals, axis=1) / force
    angle = np.degrees(np.arccos(cosine))
    assert angle.min() + 1e-9 >= 10
    assert angle.max() <= 20 + 1e-9


def test_a_seed_is_a_set_of_touches() -> None:
    first, again, other = (
        draw_parts(ball(), ExpectedTouches(count=100, seed=seed))[0].noisy for seed in (1, 1, 2)
    )
    np.testing.assert_array_equal(first, again)
    assert not np.isclose(first, other).all(axis=1).any()


ACCEPTED = (Reason.OK, Reason.VERTEX, Reason.BY_REGION)
WITH_POINT = (*ACCEPTED, Reason.AMBIGUOUS, Reason.TWO_TOUCHES)


def _batch(reasons: list[Reason], offsets: list[float]) -> SimpleNamespace:
    points = np.zeros((len(reasons), 3))
    points[:, 0] = offsets
    return SimpleNamespace(
        reasons=np.array(reasons, dtype=np.uint8),
        points=points,
        sigma_max=np.full(len(reasons), 1e-3),
        accepted=np.isin(reasons, ACCEPTED),
    )


def test_every_way_to_differ_is_counted() -> None:
    nan = np.nan
    ok, vertex, doubt, off = Reason.OK, Reason.VERTEX, Reason.AMBIGUOUS, Reason.OFF_SURFACE
    by_region = Reason.BY_REGION
    full = _batch([ok, ok, ok, ok, ok, off, doubt, off, ok], [0, 0, 0, 0, 0, nan, 0, nan, 0])
    other = _batch(
        [ok, vertex, doubt, off, ok, ok, ok, doubt, by_region], [1e-3, 2e-3, 0.04, nan, 0.03, 0, 0, 0, 3e-3]
    )
    found = _difference(full, other, 0.005)  # type: ignore[arg-type]
    assert (found.settled, found.compared) == (6, 4)
    assert (found.lost, found.doubtful, found.gained, found.jumped) == (1, 1, 2, 1)
    # Rows 2, 3, 5, 6 and 7; a vertex for a facet, or an answer that the regions decide, is no change.
    assert found.changed == 5
    assert found.largest == pytest.approx(0.03)
    assert found.mean == pytest.approx(0.009)
    assert found.failed_share == pytest.approx(3 / 6)


@given(st.lists(st.tuples(*[st.sampled_from(list(Reason))] * 2), min_size=1, max_size=40))
def test_the_counts_add_up(pairs: list[tuple[Reason, Reason]]) -> None:
    def offsets(reasons: list[Reason]) -> list[float]:
        return [0.0 if reason in WITH_POINT else np.nan for reason in reasons]

    before, after = ([pair[side] for pair in pairs] for side in (0, 1))
    found = _difference(_batch(before, offsets(before)), _batch(after, offsets(after)), 0.005)  # type: ignore[arg-type]
    assert found.compared + found.lost + found.doubtful == found.settled
    assert found.changed >= found.lost + found.doubtful + found.gained
    assert sum(reason in ACCEPTED for reason in after) == found.compared + found.gained


def test_a_jump_or_a_touch_that_the_noise_misplaced_does_not_hide_the_growth() -> None:
    ok = [Reason.OK] * 4
    full = _batch(ok, [1e-3, 1e-3, 0.05, 1e-3])
    other = _batch(ok, [2e-3, 2e-3, 0.05, 0.09])
    growth = _growth(full, other, np.zeros((4, 3)), 0.005)  # type: ignore[arg-type]
    assert growth == pytest.approx(1.0)


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        ({"force": (0.0, 5.0)}, "above 0"),
        ({"force": (5.0, 2.0)}, "smaller first"),
        ({"force": (1.0, np.nan)}, "force range"),
        ({"friction_angle": (0.0, 90.0)}, "below 90"),
        ({"friction_angle": (20.0, 10.0)}, "smaller first"),
        ({"torsion_arm": -1e-3}, "0 or more"),
        ({"count": 99}, "at least 100"),
        ({"seed": -1}, "at least 0"),
    ],
)
def test_wrong_expectations_are_named(arguments: dict[str, object], said: str) -> None:
    with pytest.raises(LadderError, match=said):
        ExpectedTouches(**arguments)  # type: ignore[arg-type]


def test_a_mesh_that_settles_nothing_is_refused_with_the_reasons() -> None:
    with pytest.raises(LadderError, match=r"only 0 of 100 touches \(low_force 100\)"):
        ContactReference(ball(), ExpectedTouches(WrenchNoise(1e-4, 1e-5), (0.1, 0.2), (0.0, 0.0), count=100))


# ---- the recommendation: the fewest facets that keep the goal, and the reason in words -----------


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
    found = recommend(_rungs(_errors(0.1e-3, failed=11), _errors(0.1e-3, failed=10)), Goal())
    assert found.facets == 1280
    assert "With 320 1.1 % of the settled touches are lost, doubtful or jump, more than 1 %." in found.reason
    assert recommend(_rungs(_errors(1e-4, failed=11), _errors(1e-4)), Goal(failed=0.011)).facets == 320


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
