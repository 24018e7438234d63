"""The pieces that a shell is made with."""

import numpy as np
import pytest
from contact_cases import ball
from hypothesis import given, settings
from hypothesis import strategies as st
from mesh.shell.housings import box

from contactbench.pipeline import kernel
from contactbench.pipeline.mesh import MeshError
from contactbench.pipeline.mesh.shell import wrap
from contactbench.pipeline.mesh.shell.exposure import exposure
from contactbench.pipeline.mesh.shell.rim import (
    Closing,
    Opening,
    choose,
    crossings,
    describe,
    make_patch,
    resample,
    shoelace,
    without_loops,
)
from contactbench.pipeline.mesh.shell.wrap import settle
from contactbench.pipeline.mesh.soundness import check_soundness
from contactbench.pipeline.mesh.triangles import cross_products, directions, join, parts, twins


def opening_of(outline, height=lambda x, _y: 0 * x) -> Opening:
    """An opening whose rim has this outline, looking along +z, with a cavity 50 mm below."""
    x, y = np.asarray(outline, dtype=float).T
    rim = np.column_stack((x, y, height(x, y)))
    return describe(rim, np.array([[0.0, 0.0, -0.05]]))


def ellipse(length, width, count=120):
    angle = np.linspace(0, 2 * np.pi, count, endpoint=False)
    return np.column_stack((length / 2 * np.cos(angle), width / 2 * np.sin(angle)))


# ---- what sees the sky ---------------------------------------------------------------------------


def test_directions_are_even():
    spread = directions(2000)
    assert np.linalg.norm(spread, axis=1) == pytest.approx(np.ones(2000))
    assert np.linalg.norm(spread.mean(axis=0)) < 1e-3
    assert spread.T @ spread / 2000 == pytest.approx(np.eye(3) / 3, abs=1e-3)


def test_a_convex_body_sees_everything_and_its_inside_nothing():
    probe = ball(320)
    assert exposure(probe.vertices, probe.faces) == pytest.approx(np.ones(320))
    assert exposure(probe.vertices, np.ascontiguousarray(probe.faces[:, ::-1])).max() == 0


def test_the_inner_edge_of_a_right_angle_sees_half():
    # A floor in front of a wall without end: of the floor close by, half the sky is hidden.
    wall = np.array([[-50, 0, 0], [50, 0, 0], [50, 0, 50], [-50, 0, 50]], dtype=float)
    floor = np.array([[-0.01, 0.01, 0], [0.01, 0.01, 0], [0.0, 0.03, 0]])
    vertices = np.concatenate((floor, wall))
    faces = np.array([[0, 1, 2], [3, 4, 5], [3, 5, 6]], dtype=np.int32)
    assert exposure(vertices, faces, count=4000)[0] == pytest.approx(0.5, abs=0.02)


def test_told_how_far_it_is():
    told = []
    exposure(*box([0, 0, 0], [1, 1, 1]), count=16, tick=told.append)
    assert told == [(i + 1) / 16 for i in range(16)]


# ---- an opening in its frame ---------------------------------------------------------------------


def test_an_opening_is_measured():
    opening = opening_of(ellipse(0.06, 0.02)[::-1])  # clockwise: it is turned round
    assert opening.length == pytest.approx(0.06, rel=1e-3)
    assert opening.width == pytest.approx(0.02, rel=1e-2)
    assert opening.depth == pytest.approx(0.05)
    assert opening.area == pytest.approx(np.pi * 0.03 * 0.01, rel=1e-2)
    assert opening.axes @ opening.axes.T == pytest.approx(np.eye(3), abs=1e-12)
    assert opening.axes[2] == pytest.approx([0, 0, 1], abs=1e-12)
    assert shoelace(opening.to_plane(opening.rim)) > 0
    assert opening.from_plane(opening.to_plane(opening.rim)) == pytest.approx(opening.rim)
    assert opening.sentence.startswith("an opening of 60.0 x 20.0 mm, 50.0 mm deep")


# ---- rims ------------------------------------------------------------------------------------------


def test_resampling_keeps_the_curve_and_evens_the_steps():
    square = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], dtype=float)
    even = resample(square, 40)
    assert np.linalg.norm(np.diff(even, axis=0), axis=1) == pytest.approx(np.full(39, 0.1))
    assert even[10] == pytest.approx([1, 0, 0])


def test_crossings_of_a_bow_tie():
    bow = np.array([[0, 0], [1, 1], [1, 0], [0, 1]], dtype=float)
    assert crossings(bow).tolist() == [[0, 2]]
    assert len(crossings(ellipse(1, 0.5))) == 0


@settings(max_examples=50, deadline=None)
@given(st.integers(0, 2**32 - 1), st.floats(0.0, 0.004))
def test_a_rim_without_loops_does_not_cross_itself(seed, wobble):
    outline = ellipse(0.06, 0.02) + np.random.default_rng(seed).normal(0, wobble, (120, 2))
    opening = opening_of(ellipse(0.06, 0.02))
    rim = opening.from_plane(np.column_stack((outline, np.zeros(120))))
    left = without_loops(rim, opening)
    assert len(crossings(opening.to_plane(left))) == 0 or len(left) <= 8
    assert {tuple(point) for point in left} <= {tuple(point) for point in rim}


# ---- patches ---------------------------------------------------------------------------------------


@pytest.mark.parametrize("closing", [Closing.FAIR, Closing.RULED, Closing.HULL])
def test_a_flat_rim_gets_a_flat_patch_of_its_area(closing):
    opening = opening_of(ellipse(0.05, 0.02))
    vertices, faces = make_patch(opening, closing, 0.001)
    assert np.abs(vertices[:, 2]).max() < 1e-9
    cross = cross_products(vertices, faces)
    assert (cross[:, 2] > 0).all()
    assert cross[:, 2].sum() / 2 == pytest.approx(opening.area, rel=1e-9)
    assert vertices[: len(opening.rim)] == pytest.approx(opening.rim)


def test_long_rims_of_a_cylinder_are_joined_by_straight_lines():
    radius = 0.06
    outline = resample(
        np.array([[-0.03, -0.008, 0], [0.03, -0.008, 0], [0.03, 0.008, 0], [-0.03, 0.008, 0]]), 240
    )
    opening = opening_of(outline[:, :2], lambda x, _y: np.sqrt(radius**2 - x**2) - radius)
    assert choose(opening) is Closing.RULED
    for closing in (Closing.AUTO, Closing.HULL):
        vertices, _ = make_patch(opening, closing, 0.001)
        assert vertices[:, 2] == pytest.approx(np.sqrt(radius**2 - vertices[:, 0] ** 2) - radius, abs=1e-5)


def test_a_round_mouth_gets_a_fair_patch():
    opening = opening_of(ellipse(0.02, 0.02), lambda x, y: 30 * x * y)  # a saddle, 1.5 mm up and down
    assert choose(opening) is Closing.FAIR
    vertices, _ = make_patch(opening, Closing.AUTO, 0.001)
    inner = vertices[len(opening.rim) :]
    assert inner[:, 2] == pytest.approx(30 * inner[:, 0] * inner[:, 1], abs=3e-4)


def test_a_hull_has_no_dent():
    opening = opening_of(ellipse(0.03, 0.02), lambda x, _y: 40 * x * x)  # rises at both ends
    vertices, _ = make_patch(opening, Closing.HULL, 0.001)
    fair, _ = make_patch(opening, Closing.FAIR, 0.001)
    assert vertices[:, 2].min() >= opening.rim[:, 2].min() - 1e-12
    middle = (np.abs(vertices[:, :2]) < 0.001).all(axis=1)
    assert vertices[middle, 2].mean() == pytest.approx(40 * 0.015**2, rel=0.05)  # straight from end to end
    assert fair[middle, 2].mean() < 0.5 * vertices[middle, 2].mean()


def test_a_rim_that_crosses_itself_is_refused():
    bow = np.array([[-0.02, -0.01], [0.02, 0.01], [0.02, -0.01], [-0.02, 0.015]])
    with pytest.raises(MeshError, match="crosses itself"):
        make_patch(opening_of(bow), Closing.FAIR, 0.001)


# ---- taking the offset off -------------------------------------------------------------------------


def test_settling_reaches_the_targets_where_nothing_folds():
    probe = ball(320)
    centre = probe.vertices.mean(axis=0)
    targets = centre + 0.9 * (probe.vertices - centre)
    moved, share = settle(probe.vertices, probe.faces, targets)
    assert np.array_equal(moved, targets)
    assert (share == 1).all()


def test_settling_stops_short_of_a_fold():
    probe = ball(320)
    targets = probe.vertices.copy()
    targets[0] = 2 * probe.vertices.mean(axis=0) - targets[0]  # to the far side
    moved, share = settle(probe.vertices, probe.faces, targets)
    before, after = cross_products(probe.vertices, probe.faces), cross_products(moved, probe.faces)
    assert (np.einsum("ij,ij->i", before, after) > 0).all()
    assert share[0] < 0.5
    assert (share[1:] <= 1).all()
    assert np.array_equal(moved[share == 1][1:], targets[share == 1][1:])


def test_what_crosses_or_folds_is_put_back():
    probe = ball(320)
    settled, share = probe.vertices.copy(), np.ones(len(probe.vertices))
    corner = probe.faces[7, 0]
    settled[corner] = -1.5 * settled[corner] + 2.5 * probe.vertices.mean(axis=0)  # through the far side
    original, none = (probe.vertices, probe.faces), np.zeros(len(probe.faces), dtype=bool)
    mended, share = wrap._mended(probe.vertices, settled, probe.faces, share, original, none)
    assert not kernel.crossings(mended, probe.faces)[2].any()
    assert share[corner] == 0
    assert np.array_equal(mended[share == 0], probe.vertices[share == 0])
    assert np.count_nonzero(share == 0) < 100


def test_a_step_in_a_groove_is_evened_out():
    """What the wrap itself has across the surface cannot be put back."""
    x, y = np.meshgrid(np.arange(12.0), np.arange(12.0), indexing="ij")
    flat = np.stack((x, y, 0 * x), axis=-1).reshape(-1, 3)
    at = np.arange(144).reshape(12, 12)
    a, b, c, d = at[:-1, :-1].ravel(), at[1:, :-1].ravel(), at[1:, 1:].ravel(), at[:-1, 1:].ravel()
    faces = np.concatenate((np.stack((a, b, c), axis=1), np.stack((a, c, d), axis=1))).astype(np.int32)
    stepped = flat.copy()
    stepped[at[6, 6], 2] = 4.0
    assert len(check_soundness(stepped, faces, (flat, faces)).folded_facets) == 6
    none = np.zeros(len(faces), dtype=bool)
    mended, share = wrap._mended(stepped, stepped.copy(), faces, np.ones(144), (flat, faces), none)
    assert len(check_soundness(mended, faces, (flat, faces)).folded_facets) == 0
    assert np.array_equal(mended[share == 1], stepped[share == 1])
    assert np.count_nonzero(share == 0) < 60


# ---- connectivity ----------------------------------------------------------------------------------


def test_twins_and_parts():
    vertices, faces = join([box([0, 0, 0], [1, 1, 1]), box([2, 0, 0], [3, 1, 1])])
    twin = twins(faces)
    assert (twin >= 0).all()
    assert np.array_equal(twin[twin], np.arange(len(twin)))
    label = parts(faces, np.ones(len(faces), dtype=bool), twin)
    assert np.bincount(label).tolist() == [12, 12]
    only = np.arange(len(faces)) < 4
    assert (parts(faces, only, twin)[~only] == -1).all()
    assert len(vertices) == 16


def test_an_edge_with_three_facets_has_no_twins():
    fan = np.array([[0, 1, 2], [1, 0, 3], [1, 0, 4]], dtype=np.int32)
    assert (twins(fan) == -1).all()
