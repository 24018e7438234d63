"""Points known in both frames: the mount, its covariance, and the picks that cannot show it."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation
from scipy.special import chdtri

from contactbench.pipeline.preparation.alignment import AlignmentError, align_frame, align_points
from contactbench.pipeline.preparation.alignment.rigid import difference

SPREAD = np.array([[0, 0, 0], [0.05, 0, 0], [0, 0.02, 0.01], [0.01, 0.0, 0.12]])


def pose(seed):
    rng = np.random.default_rng(seed)
    T = np.eye(4)
    T[:3, :3] = Rotation.random(random_state=rng).as_matrix()
    T[:3, 3] = rng.normal(size=3) * 0.2
    return T, rng


@given(st.integers(0, 10_000), st.integers(3, 8))
def test_exact_points_give_the_exact_mount(seed, count):
    T, rng = pose(seed)
    points = np.vstack([SPREAD[:3], rng.normal(size=(count - 3, 3)) * 0.05])
    found = align_points(points, points @ T[:3, :3].T + T[:3, 3])
    assert np.allclose(found.T_SP, T, atol=1e-12)
    assert found.residual_m < 1e-12
    assert np.linalg.det(found.R_SP) > 0


def test_the_covariance_is_that_of_the_error():
    accuracy, inside = 0.0005, 0
    squares = []
    for seed in range(400):
        T, rng = pose(seed)
        noisy = SPREAD @ T[:3, :3].T + T[:3, 3] + accuracy * rng.standard_normal(SPREAD.shape)
        found = align_points(SPREAD, noisy, accuracy=accuracy)
        error = difference(T, found.T_SP, found.about_S)
        square = error @ np.linalg.solve(found.covariance, error)
        squares.append(square)
        inside += square < chdtri(6, 0.05)
    assert 0.92 < inside / 400 < 0.98
    assert np.isclose(np.mean(squares), 6.0, atol=0.6)


def test_a_frame_of_three_points_is_exact_and_knows_its_error():
    T, _ = pose(3)
    back = np.linalg.inv(T)
    at = np.array([[0.01, -0.02, 0.03], [0.01, -0.02, 0.13], [0.06, -0.02, 0.08]])  # origin, +z, +x
    picks = at @ back[:3, :3].T + back[:3, 3]
    found = align_frame(*picks, origin_S=at[0])
    assert np.allclose(found.T_SP, T, atol=1e-14)
    errors = []
    rng = np.random.default_rng(8)
    for _ in range(4000):
        noisy = picks + 0.0002 * rng.standard_normal((3, 3))
        errors.append(difference(T, align_frame(*noisy, origin_S=at[0]).T_SP, at[0]))
    measured = np.cov(np.array(errors).T)
    scale = np.sqrt(np.diag(found.covariance))
    assert np.abs(measured / np.outer(scale, scale) - found.covariance / np.outer(scale, scale)).max() < 0.12


def test_a_wrong_place_is_named_and_widens_the_covariance():
    points = np.vstack([SPREAD, [0.03, 0.05, 0.08]])
    places = points + [0.1, 0, 0]
    good = align_points(points, places)
    assert not good.warnings
    places[3] += [0.02, 0.0, 0.0]
    found = align_points(points, places)
    assert any("Without point 4 the others agree" in sentence for sentence in found.warnings)
    assert found.covariance[0, 0] > 10 * good.covariance[0, 0]


def test_mirrored_points_are_questioned():
    found = align_points(SPREAD, SPREAD * [1, 1, -1])
    assert any("mirrored" in sentence for sentence in found.warnings)


@pytest.mark.parametrize(
    ("points", "places", "words"),
    [
        (SPREAD[:2], SPREAD[:2], "three or more"),
        (SPREAD, SPREAD[:3], "three or more"),
        (np.outer([0, 1, 2], [0.01, 0.02, 0.03]), SPREAD[:3], "one line"),
        (np.outer([0, 1, 2], [0.05, 0, 0]) + [[0, 0, 0], [0, 0.0005, 0], [0, 0, 0]], SPREAD[:3], "one line"),
        (np.ones((3, 3)), SPREAD[:3], "one place"),
        (SPREAD, 25.4 * SPREAD, "25.4 times"),
        (np.full((4, 3), np.inf), SPREAD, "not finite"),
        (SPREAD[:, :2], SPREAD, "shape"),
    ],
)
def test_points_that_show_no_mount_are_refused(points, places, words):
    with pytest.raises(AlignmentError, match=words):
        align_points(points, places)


@pytest.mark.parametrize(
    ("axis", "plane", "words"),
    [
        ([0, 0, 0.1], [0, 0, 0.2], "one line"),
        ([0, 0, 0], [0.1, 0, 0], "one line|coincides"),
        ([0, 0, 0.1], [0.0001, 0, 0.05], "one line|on the axis"),
    ],
)
def test_picks_that_span_no_frame_are_refused(axis, plane, words):
    with pytest.raises(AlignmentError, match=words):
        align_frame([0, 0, 0], axis, plane)
