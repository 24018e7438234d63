"""Brush strokes: what they cover, and that they are one step."""

from __future__ import annotations

import math

import numpy as np
import pytest

from contactbench.pipeline.mesh.regions import (
    Brush,
    FacetGraph,
    RegionError,
    RegionModel,
    RegionSet,
    flood,
)


def fresh(graph: FacetGraph, regions: int = 2) -> RegionModel:
    model = RegionModel(RegionSet.empty(graph.facet_count))
    for _ in range(regions):
        model.add()
    return model


def draw(model: RegionModel, graph: FacetGraph, brush: Brush, rank: int, points: np.ndarray) -> np.ndarray:
    faces, nearest = graph.pick(points)
    with model.stroke(graph, brush, rank) as stroke:
        for face, point in zip(faces.tolist(), nearest, strict=True):
            stroke.extend(face, point)
    return np.flatnonzero(model.labels == rank)


def test_a_dab_on_a_sphere_is_a_cap(ball: FacetGraph) -> None:
    covered = draw(fresh(ball), ball, Brush(0.02), 1, np.array([[0.0, 0.0, 0.05]]))
    polar = np.arccos(ball.centroids[:, 2] / np.linalg.norm(ball.centroids, axis=1)) * 0.05
    assert set(np.flatnonzero(polar < 0.0196)) <= set(covered) <= set(np.flatnonzero(polar < 0.0204))


def test_a_fast_stroke_leaves_no_gap_and_stays_on_the_surface(ball: FacetGraph) -> None:
    ends = 0.05 * np.array([[1.0, 0, 0], [0, 1.0, 0]])
    for brush in (Brush(0.005), Brush(0.005, geodesic=False)):
        covered = draw(fresh(ball), ball, brush, 1, ends)
        on = ball.centroids[covered]
        turn = np.degrees(np.arctan2(on[:, 1], on[:, 0]))
        assert np.abs(on[:, 2]).max() < 0.0055
        assert turn.min() < 0
        assert turn.max() > 90
        assert np.diff(np.sort(turn)).max() < 5  # facets are 4 to 5 degrees wide
        mask = np.zeros(ball.facet_count, dtype=bool)
        mask[covered] = True
        assert flood(ball, int(covered[0]), np.pi, within=mask)[covered].all()


def test_many_picks_cover_what_two_cover(ball: FacetGraph) -> None:
    angle = np.radians([0.0, 20, 40, 60])
    points = 0.05 * np.column_stack((np.cos(angle), np.sin(angle), np.zeros(4)))
    few = set(draw(fresh(ball), ball, Brush(0.01), 1, points[[0, -1]]))
    many = set(draw(fresh(ball), ball, Brush(0.01), 1, points))
    assert len(few ^ many) < 0.03 * len(few)


def test_picks_that_are_not_joined_leave_a_gap(ball: FacetGraph) -> None:
    faces, points = ball.pick(0.05 * np.array([[1.0, 0, 0], [0, 1.0, 0]]))
    model = fresh(ball)
    with model.stroke(ball, Brush(0.005), 1) as stroke:
        stroke.extend(int(faces[0]), points[0])
        stroke.extend(int(faces[1]), points[1], joined=False)
    on = ball.centroids[model.labels == 1]
    turn = np.degrees(np.arctan2(on[:, 1], on[:, 0]))
    assert not ((turn > 20) & (turn < 70)).any()


@pytest.mark.parametrize("geodesic", [True, False])
def test_the_far_side_of_a_thin_wall_stays_clean(plate: FacetGraph, geodesic: bool) -> None:
    covered = draw(fresh(plate), plate, Brush(0.01, geodesic=geodesic), 1, np.array([[0.0, 0.0, 0.0005]]))
    assert len(covered) > 200
    assert (plate.centroids[covered, 2] > 0).all()
    radius = np.linalg.norm(plate.centroids - [0, 0, 0.0005], axis=1)
    upper = plate.probe.normals[:, 2] > 0.9
    assert set(np.flatnonzero(upper & (radius < 0.0098))) <= set(covered)
    assert set(covered) <= set(np.flatnonzero(radius < 0.0102))


def test_a_large_facet_is_painted_by_a_small_brush(cube: FacetGraph) -> None:
    covered = draw(fresh(cube), cube, Brush(1e-5), 1, np.array([[0.003, 0.001, 0.02]]))
    assert covered.tolist() == cube.pick([[0.003, 0.001, 0.02]])[0].tolist()


def test_protect_and_erase(ball: FacetGraph) -> None:
    model = fresh(ball)
    top = np.array([[0.0, 0.0, 0.05]])
    first = draw(model, ball, Brush(0.01), 1, top)
    second = draw(model, ball, Brush(0.02, protect=True), 2, top)
    assert (model.labels[first] == 1).all()
    draw(model, ball, Brush(0.02, erase=True, protect=True), 1, top)
    assert (model.labels[first] == 0).all()
    assert (model.labels[second] == 2).all()
    draw(model, ball, Brush(0.02), 1, top)
    draw(model, ball, Brush(0.01, erase=True), 2, top)
    assert (model.labels[first] == 0).all()
    assert np.count_nonzero(model.labels == 1) > 0


def test_a_stroke_is_told_as_it_grows_and_is_one_step(ball: FacetGraph) -> None:
    model = fresh(ball)
    told: list[np.ndarray] = []
    model.subscribe(lambda change: told.append(change.faces))
    angle = np.radians([0.0, 10, 20])
    covered = draw(
        model, ball, Brush(0.01), 1, 0.05 * np.column_stack((np.cos(angle), np.sin(angle), np.zeros(3)))
    )
    assert len(told) == 3
    assert np.sort(np.concatenate(told)).tolist() == covered.tolist()
    assert model.undo_text == "paint Region 1"
    model.undo()
    assert not model.labels.any()
    model.redo()
    assert np.flatnonzero(model.labels).tolist() == covered.tolist()


def test_an_aborted_stroke_was_never_there(ball: FacetGraph) -> None:
    model = fresh(ball)
    draw(model, ball, Brush(0.02), 2, np.array([[0.0, 0.01, 0.05]]))
    before, text = model.labels.tobytes(), model.undo_text
    stroke = model.stroke(ball, Brush(0.03), 1)
    stroke.extend(0, ball.centroids[0])
    far, point = ball.pick([[0.0, 0.0, 0.05]])
    stroke.extend(int(far[0]), point[0])
    assert model.labels.tobytes() != before
    stroke.abort()
    assert model.labels.tobytes() == before
    assert model.undo_text == text
    broken = pytest.raises(RegionError, match="facet -5")
    with broken, model.stroke(ball, Brush(0.03), 1) as other:
        for face in (0, -5):
            other.extend(face, ball.centroids[0])
    assert model.labels.tobytes() == before


def test_nothing_else_during_a_stroke(ball: FacetGraph) -> None:
    model = fresh(ball)
    stroke = model.stroke(ball, Brush(0.01), 1)
    stroke.extend(0, ball.centroids[0])
    for edit in (model.undo, model.redo, model.add, lambda: model.assign([1], 1), lambda: model.remove(1)):
        with pytest.raises(RegionError, match="a stroke is in progress"):
            edit()
    with pytest.raises(RegionError, match="a stroke is in progress"):
        model.stroke(ball, Brush(0.01), 1)
    stroke.finish()
    for late in (stroke.finish, stroke.abort, lambda: stroke.extend(0, ball.centroids[0])):
        with pytest.raises(RegionError, match="has ended"):
            late()
    model.add()


def test_a_stroke_of_nothing_is_no_step(ball: FacetGraph) -> None:
    model = fresh(ball)
    text = model.undo_text
    model.stroke(ball, Brush(0.01), 1).finish()
    with model.stroke(ball, Brush(0.01, erase=True), 1) as stroke:
        stroke.extend(0, ball.centroids[0])
    assert model.undo_text == text
    model.add()


def test_a_thousand_strokes_undone_and_redone_give_identical_bytes(
    cube: FacetGraph, rng: np.random.Generator
) -> None:
    model = fresh(cube, 3)
    start = (model.regions, model.labels.tobytes())
    states = []
    for number in range(1000):
        points = rng.uniform(-0.02, 0.02, (3, 3))
        brush = Brush(
            rng.uniform(0.001, 0.015),
            bool(rng.integers(2)),
            erase=number % 4 == 3,
            protect=bool(rng.integers(2)),
        )
        steps = model.undo_text, model.labels.tobytes()
        draw(model, cube, brush, int(rng.integers(1, 4)), points)
        if model.labels.tobytes() != steps[1]:
            states.append(model.labels.tobytes())
    assert len(states) > 700
    for state in reversed(states):
        assert model.labels.tobytes() == state
        assert model.undo()
    assert (model.regions, model.labels.tobytes()) == start
    for state in states:
        assert model.redo()
        assert model.labels.tobytes() == state
    assert not model.redo()


@pytest.mark.parametrize("radius", [0.0, -1.0, math.nan, math.inf])
def test_a_brush_has_a_radius(radius: float) -> None:
    with pytest.raises(RegionError, match="radius"):
        Brush(radius)


def test_wrong_picks_are_refused(ball: FacetGraph, cube: FacetGraph) -> None:
    model = fresh(ball)
    with pytest.raises(RegionError, match="facets, but the regions"):
        model.stroke(cube, Brush(0.01), 1)
    with pytest.raises(RegionError, match="no region of rank 9"):
        model.stroke(ball, Brush(0.01), 9)
    with model.stroke(ball, Brush(0.01), 1) as stroke:
        for face in (-1, ball.facet_count):
            with pytest.raises(RegionError, match="does not exist"):
                stroke.extend(face, [0, 0, 0])
        for point in ([0, 0], [0, 0, math.nan]):
            with pytest.raises(RegionError, match="not a point"):
                stroke.extend(0, point)
