"""The fewest facets under a contact error: under it, and not many more than needed."""

from __future__ import annotations

import math

from contact_cases import ball, bundled

from contactbench.pipeline.mesh import Probe
from contactbench.pipeline.mesh.simplify import Count, simplify
from contactbench.pipeline.preparation.ladder import ExpectedTouches
from contactbench.pipeline.preparation.prepare import contact_error_criterion, contact_target

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
    measure = contact_error_criterion(full, QUICK)
    found = [simplify(full, contact_target(full, limit, QUICK)[0]) for limit in (0.2e-3, 0.05e-3)]
    assert [measure(one.probe) <= limit for one, limit in zip(found, (0.2e-3, 0.05e-3), strict=True)] == [
        True
    ] * 2
    assert 4 < found[0].count < found[1].count < 10_000
    fewer = simplify(full, Count(round(0.8 * found[1].count))).probe
    assert measure(fewer) > 0.02e-3
