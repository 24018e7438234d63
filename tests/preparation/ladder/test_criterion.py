"""The fewest facets under a contact error: under it, and not many more than needed."""

from __future__ import annotations

import math

import pytest
from contact_cases import ball, bundled

from contactbench.pipeline.mesh import MeshError, Probe
from contactbench.pipeline.mesh.engines import Cancelled
from contactbench.pipeline.mesh.simplify import Count, simplify
from contactbench.pipeline.preparation.ladder import ExpectedTouches, contact_error_criterion, fewest_facets

QUICK = ExpectedTouches(count=500)


def test_the_criterion_is_the_distance_that_contacts_move() -> None:
    full = bundled("convex", 5_000, regions=True)
    errors = {name: contact_error_criterion(full, QUICK, name) for name in ("mean", "p95", "max")}
    assert [error(full) for error in errors.values()] == [0, 0, 0]
    coarse = simplify(full, Count(300)).probe
    assert 0 < errors["mean"](coarse) < errors["p95"](coarse) < errors["max"](coarse) < 5e-3


def test_lost_touches_make_it_infinite() -> None:
    probe = ball(1280)
    away = Probe.from_arrays(probe.vertices + [0.5, 0, 0], probe.faces)
    assert contact_error_criterion(probe, QUICK)(away) == math.inf
    # Half the ball is left: what is settled on it is where it was, or at the rim, if noise may have put it beyond; but
    # half of the touches are lost.
    half = Probe.from_arrays(probe.vertices, probe.faces[probe.normals[:, 2] > 0])
    assert contact_error_criterion(probe, QUICK)(half) == math.inf
    assert contact_error_criterion(probe, QUICK, "mean", failed=1.0)(half) < 0.3e-3


def test_the_fewest_facets_keep_the_limit_and_a_tighter_one_needs_more() -> None:
    full = bundled("linear", 10_000, regions=True)
    found = [fewest_facets(full, limit, QUICK) for limit in (0.2e-3, 0.05e-3)]
    for one, limit in zip(found, (0.2e-3, 0.05e-3), strict=True):
        assert one.errors[0].part == "region"
        assert one.errors[0].noisy.p95 <= limit
        assert one.errors[0].noisy.failed_share <= 0.02
        # What is reported is what the criterion measures.
        assert contact_error_criterion(full, QUICK)(one.simplified.probe) == one.errors[0].noisy.p95
    assert 4 < found[0].simplified.count < found[1].simplified.count < 10_000
    fewer = simplify(full, Count(round(0.8 * found[1].simplified.count))).probe
    assert contact_error_criterion(full, QUICK)(fewer) > 0.02e-3


def test_a_limit_must_be_above_zero_and_the_work_can_be_cancelled() -> None:
    with pytest.raises(MeshError, match="above 0"):
        fewest_facets(ball(), 0.0, QUICK)
    with pytest.raises(Cancelled):
        fewest_facets(ball(), 1e-4, QUICK, cancelled=lambda: True)
