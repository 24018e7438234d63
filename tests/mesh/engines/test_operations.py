"""Every operation does what it says, and wrong input is refused before it reaches a library."""

from __future__ import annotations

import numpy as np
import pytest
import trimesh

from contactbench.pipeline.mesh import MeshError, engines

Ball = tuple[np.ndarray, np.ndarray]


def _mesh(vertices: np.ndarray, faces: np.ndarray) -> trimesh.Trimesh:
    return trimesh.Trimesh(vertices, faces, process=False)


def test_alpha_wrap_takes_absolute_lengths(ball: Ball) -> None:
    open_ball = ball[1][50:]
    vertices, faces = engines.alpha_wrap(ball[0], open_ball, 20.0, 2.0)
    assert _mesh(vertices, faces).is_watertight
    radii = np.linalg.norm(vertices, axis=1)
    assert radii.max() == pytest.approx(52, abs=0.5)
    finer, _ = engines.alpha_wrap(ball[0], open_ball, 5.0, 2.0)
    assert len(finer) > 1.5 * len(vertices)


@pytest.mark.parametrize("lengths", [(0.0, 1.0), (1.0, -1.0), (float("nan"), 1.0), (1.0, float("inf"))])
def test_alpha_wrap_refuses_lengths_that_are_none(ball: Ball, lengths: tuple[float, float]) -> None:
    with pytest.raises(engines.EngineError, match="give a length above 0"):
        engines.alpha_wrap(*ball, *lengths)


def test_close_holes_closes_and_says_what_it_added(ball: Ball) -> None:
    centre = ball[0][ball[1]].mean(axis=1)
    left = ball[1][centre[:, 2] < 35]
    vertices, faces, added = engines.close_holes(ball[0], left)
    assert _mesh(vertices, faces).is_watertight
    assert np.count_nonzero(added) == len(faces) - len(left)
    assert vertices[faces[added]].mean(axis=1)[:, 2].min() > 25
    finer, finer_faces, finer_added = engines.close_holes(ball[0], left, edge=3.0)
    assert _mesh(finer, finer_faces).is_watertight
    assert np.count_nonzero(finer_added) > 2 * np.count_nonzero(added)


def test_a_hole_that_is_too_long_stays_open(ball: Ball) -> None:
    left = ball[1][ball[0][ball[1]].mean(axis=1)[:, 2] < 35]
    _, faces, added = engines.close_holes(ball[0], left, longest=4)
    assert len(faces) == len(left)
    assert not added.any()


def test_self_intersections_are_where_two_balls_meet(ball: Ball) -> None:
    vertices = np.vstack([ball[0], ball[0] + [60, 0, 0]])
    faces = np.vstack([ball[1], ball[1] + np.int32(len(ball[0]))])
    selected = engines.self_intersections(vertices, faces)
    assert selected.shape == (len(faces),)
    crossing = vertices[faces[selected]].mean(axis=1)
    assert len(crossing) > 20
    assert np.abs(crossing[:, 0] - 30).max() < 10
    assert not engines.self_intersections(*ball).any()


def test_orient_facets_makes_neighbours_agree(ball: Ball) -> None:
    mixed = ball[1].copy()
    mixed[::7] = mixed[::7, ::-1]
    assert not _mesh(ball[0], mixed).is_winding_consistent
    vertices, faces = engines.orient_facets(ball[0], mixed)
    assert _mesh(vertices, faces).is_winding_consistent
    assert np.array_equal(np.sort(faces, axis=1), np.sort(mixed, axis=1))


def test_a_refusal_is_told_and_leaves_the_engine_warm(ball: Ball) -> None:
    engines.orient_facets(*ball)
    pid = engines.engine_pid(engines.Library.MESHLAB)
    three_round_an_edge = np.vstack([ball[1], [ball[1][0, 0], ball[1][0, 1], 600]]).astype(np.int32)
    with pytest.raises(engines.EngineError, match=r"meshlab refused 'orient facets'.*manifold"):
        engines.orient_facets(ball[0], three_round_an_edge)
    assert engines.engine_pid(engines.Library.MESHLAB) == pid


@pytest.mark.parametrize("operation", [engines.orient_facets, engines.cut_along_crossings])
def test_what_would_crash_a_library_is_refused_at_the_door(ball: Ball, operation: object) -> None:
    with pytest.raises(MeshError, match="refers to vertex"):
        operation(ball[0], ball[1] + 1)
    holed = ball[0].copy()
    holed[5, 1] = np.nan
    with pytest.raises(MeshError, match="row 5"):
        operation(holed, ball[1])
