"""First-order theory agrees with differences, and the truth in long double with a contact by hand."""

from __future__ import annotations

import numpy as np
import pytest

from contactbench.pipeline.study import hard_meshes as hm

from . import theory


@pytest.fixture
def rng() -> np.random.Generator:
    return np.random.default_rng(0)


def test_the_truth_is_where_the_box_is_pressed() -> None:
    body = hm.box()
    top = int(np.flatnonzero(body.normals[:, 2] > 0.5)[0])
    point, force = np.array([1 / 60, 1 / 33, 1 / 16]), np.array([1.0, -2.0, -8.0])
    wrench = np.hstack([force, np.cross(point, force) + [0.0, 0.0, 0.01]])[None]
    found = theory.answers_on(body, np.array([top]), wrench)
    assert found.astype(float) == pytest.approx(point[None], abs=1e-17)


def test_touches_lie_on_their_facets_and_keep_away_from_edges(rng: np.random.Generator) -> None:
    body = hm.ellipsoid(2)
    touches = theory.touch(body, 100, rng)
    shares = hm.areal(body, touches.faces, touches.points.astype(np.longdouble))
    assert shares.min() > 0.099
    truth = theory.answers_on(body, touches.faces, touches.wrenches).astype(float)
    assert truth == pytest.approx(touches.points, abs=1e-15)
    some = touches.take(np.array([3, 5]))
    assert len(some) == 2
    assert some.faces.tolist() == touches.faces[[3, 5]].tolist()


def test_points_move_as_predicted(rng: np.random.Generator) -> None:
    body = hm.ellipsoid(2)
    touches = theory.touch(body, 50, rng)
    change = theory.nudge(touches.wrenches, np.full(50, 1e-9), rng)
    normals = body.normals[touches.faces].astype(float)
    before, after = (
        theory.answers_on(body, touches.faces, w) for w in (touches.wrenches, touches.wrenches + change)
    )
    predicted = theory.moved(normals, touches.points, touches.wrenches, change)
    assert (after - before).astype(float) == pytest.approx(predicted, rel=1e-5, abs=1e-16)
    # A change of the torque alone, along the normal, is local torque: the point stays.
    twist = np.hstack([np.zeros((50, 3)), normals])
    assert theory.moved(normals, touches.points, touches.wrenches, twist) == pytest.approx(0.0, abs=1e-15)


def test_no_change_exceeds_the_condition_and_some_come_near(rng: np.random.Generator) -> None:
    touches = theory.touch(hm.ellipsoid(2), 5, rng)
    normals = hm.ellipsoid(2).normals[touches.faces].astype(float)
    bound = theory.condition(normals, touches.points, touches.wrenches)
    largest = np.zeros(5)
    for _ in range(4000):
        change = theory.nudge(touches.wrenches, np.ones(5), rng)
        length = np.linalg.norm(theory.moved(normals, touches.points, touches.wrenches, change), axis=1)
        largest = np.maximum(largest, length)
    assert (largest <= bound * (1 + 1e-12)).all()
    assert (largest > 0.9 * bound).all()


def test_nudges_have_the_size_that_is_asked_for(rng: np.random.Generator) -> None:
    wrenches = theory.touch(hm.ellipsoid(2), 20, rng).wrenches
    change = theory.nudge(wrenches, np.full(20, 1e-3), rng)
    for part in (slice(0, 3), slice(3, 6)):
        ratio = np.linalg.norm(change[:, part], axis=1) / np.linalg.norm(wrenches[:, part], axis=1)
        assert ratio == pytest.approx(1e-3)


def test_errors_are_against_the_facet_or_vertex_that_is_named(rng: np.random.Generator) -> None:
    body = hm.ellipsoid(2)
    touches = theory.touch(body, 4, rng)
    points = touches.points + [[0.0, 0.0, 0.0], [3e-3, 0.0, 4e-3], [0.0, 0.0, 0.0], [0.0, 0.0, 0.0]]
    points[2] = np.nan
    points[3] = body.vertices[7] + [0.0, 1e-3, 0.0]
    vertices = np.array([-1, -1, -1, 7])
    off = theory.errors(body, points, touches.faces, vertices, touches.wrenches)
    assert off[:2] == pytest.approx([0.0, 5e-3], abs=1e-15)
    assert np.isnan(off[2])
    assert off[3] == pytest.approx(1e-3)
