"""The mount from touches: exact, near the bound, honest about what it cannot see and whom to believe."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation
from scipy.special import chdtri

from contactbench.pipeline.contact import WrenchNoise
from contactbench.pipeline.preparation.alignment.alignment import AlignmentError, difference, from_json
from contactbench.pipeline.preparation.alignment.flange import align_axes
from contactbench.pipeline.preparation.alignment.points import align_frame, align_points
from contactbench.pipeline.preparation.alignment.touches.align import Advice, align_touches
from contactbench.pipeline.preparation.alignment.touches.fit import (
    MarkerModel,
    MarkerTouches,
    MountBelief,
    fit_mount,
    put_on_mesh,
)

NOISE = WrenchNoise(0.05, 0.002)


def model_of(case, placement=0.0003):
    points, normals, _ = put_on_mesh(case.touches, case.probe_P)
    return MarkerModel(points, normals, case.touches.wrenches, NOISE.covariance, placement)


def flat_touches(rng, *, angle=0.0, count=15):
    """Touches of a face of 50 x 16 mm at z = 150 mm, and their noisy wrenches."""
    points = np.column_stack(
        [rng.uniform(-0.025, 0.025, count), rng.uniform(-0.008, 0.008, count), np.full(count, 0.15)]
    )
    tilt, around = np.radians(angle) * rng.uniform(0, 1, count), rng.uniform(0, 2 * np.pi, count)
    forces = np.column_stack([np.sin(tilt) * np.cos(around), np.sin(tilt) * np.sin(around), -np.cos(tilt)])
    forces *= rng.uniform(8, 10, count)[:, None]
    wrenches = np.hstack([forces, np.cross(points, forces)])
    wrenches += np.sqrt(np.diag(NOISE.covariance)) * rng.standard_normal(wrenches.shape)
    return MarkerModel(points, np.tile([0.0, 0.0, 1.0], (count, 1)), wrenches, NOISE.covariance, 0.0003)


@pytest.mark.parametrize("name", ["linear", "t-shape"])
def test_without_noise_the_mount_is_found_to_the_mesh_s_own_error(bench, name):
    case = bench(name, 1, noise=None, placement=0.0, facets=8000)
    far, angle = case.error(fit_mount(model_of(case), [case.T_before], MountBelief()).T_SP)
    assert far < 2e-4
    assert angle < 0.15
    before, _ = case.error(case.T_before)
    assert before > 2e-3


def test_the_residual_is_whitened(bench):
    whole = []
    for seed in range(60):
        case = bench("convex", seed, facets=8000)
        whole.append(model_of(case).residuals(case.T_true))
    r = np.concatenate(whole)
    assert np.allclose(np.cov(r.T), np.eye(2), atol=0.12)
    assert np.abs(r.mean(axis=0)).max() < 0.1


def test_the_bound_is_the_textbook_figure():
    model = flat_touches(np.random.default_rng(0), count=400)
    middle = np.abs(model.points_P[:, :2]).max(axis=1) < 0.004
    expected = 2 * (0.002**2 + (0.15 * 0.05) ** 2) / model.wrenches[middle, 2] ** 2 + 2 * 0.0003**2
    found = np.trace(model.sigmas(np.eye(4)), axis1=1, axis2=2)[middle]
    assert np.allclose(found, expected, rtol=0.02)


def test_the_ellipsoid_covers_what_it_says(bench):
    inside, count = 0, 120
    for seed in range(count):
        case = bench("linear", 1000 + seed)
        fit = fit_mount(model_of(case), [case.T_before], MountBelief())
        error = difference(case.T_true, fit.T_SP, fit.about_S)
        inside += error @ np.linalg.solve(fit.covariance, error) < chdtri(6, 0.05)
    # 95 % of 120 is 114, give or take 2.4.
    assert 107 <= inside <= 120


def test_fifteen_touches_serve_new_touches_nearly_as_well_as_the_truth(bench):
    true, found, before = [], [], []
    for seed in range(40):
        case, new = bench("convex", seed), bench("convex", 500 + seed, count=60, placement=0.0)
        fit = fit_mount(model_of(case), [case.T_before], MountBelief())
        # New touches of the same probe, with the mounts' errors carried over to its own true mount.
        judge = model_of(new, placement=0.0)
        for errors, T in ((true, case.T_true), (found, fit.T_SP), (before, case.T_before)):
            errors.append(judge.plane_errors(T @ np.linalg.inv(case.T_true) @ new.T_true))
    scale = [np.sqrt(np.mean(np.square(errors))) for errors in (true, found, before)]
    assert scale[1] < 1.15 * scale[0]
    assert scale[2] > 2 * scale[0]


def test_normal_touches_of_one_flat_face_show_three_of_six(random_rigid):
    for seed in range(5):
        rng = np.random.default_rng(seed)
        model = flat_touches(rng)
        fit = fit_mount(model, [random_rigid(rng, 0.002, 1.5)], MountBelief())
        assert fit.rank == 3
        # Unseen: the shift along the normal, and the tilts about the two axes in the face.
        assert np.linalg.norm(fit.unseen.T @ np.eye(6)[:, [2, 3, 4]], ord=-2) > 0.97
        # Along them the mount stays where it was, with the uncertainty that it had.
        moved = difference(fit.T_SP, fit.start, fit.about_S) / MountBelief().scales
        assert np.abs(fit.unseen.T @ moved).max() < 0.02
        assert np.allclose(np.sqrt(np.diag(fit.covariance))[2:5] / MountBelief().scales[2:5], 1.0, atol=0.05)
        # The rest is known well: 0.75 mm of each touch by the root of fifteen.
        assert np.sqrt(np.diag(fit.covariance))[:2].max() < 0.0003


def test_friction_on_the_flat_face_shows_the_normal_shift_but_not_the_tilts(random_rigid):
    rng = np.random.default_rng(3)
    fit = fit_mount(flat_touches(rng, angle=30.0), [random_rigid(rng, 0.002, 1.5)], MountBelief())
    assert fit.rank == 4
    assert np.linalg.norm(fit.unseen.T @ np.eye(6)[:, [3, 4]], ord=-2) > 0.97


def test_what_the_touches_cannot_show_is_said_and_kept(bench):
    case = bench("linear", 0, angle=(0.0, 1.0), above=0.1499, facing=0.9999, torsion_arm=0.0)
    found = align_touches(case.probe_P, case.touches, case.T_before, NOISE)
    assert found.rank == 3
    assert len(found.unseen) == 3
    assert sum(thing.startswith("a shift along") for thing in found.unseen) == 1
    assert sum(thing.startswith("a turn about") for thing in found.unseen) == 2
    said = [sentence for sentence in found.fitted.warnings if "cannot determine" in sentence]
    assert len(said) == 1
    assert all(thing in said[0] for thing in found.unseen)


def test_a_clear_gain_is_adopted_with_its_figures(bench):
    case = bench("convex", 4)
    found = align_touches(case.probe_P, case.touches, case.T_before, NOISE)
    assert found.advice is Advice.ADOPT
    assert np.array_equal(found.T_SP, found.fitted.T_SP)
    assert found.rank == 6
    assert found.kept.all()
    assert found.check.folds == 15
    assert 0.6 < found.check.ratio < 1.6
    again = from_json(found.fitted.to_json())
    assert np.array_equal(again.T_SP, found.fitted.T_SP)
    assert any("better than its calibration" in sentence for sentence in again.how)
    far, _ = case.error(found.T_SP)
    assert far < case.error(case.T_before)[0]


def test_left_out_touches_cost_more_than_those_that_were_fitted(bench):
    inside, outside = [], []
    for seed in range(6):
        case = bench("t-shape", seed)
        check = align_touches(case.probe_P, case.touches, case.T_before, NOISE).check
        inside.append((check.in_sample**2).mean())
        outside.append((check.out_of_sample**2).mean())
    assert np.sqrt(np.mean(outside)) > 1.1 * np.sqrt(np.mean(inside))


def test_a_mount_that_is_right_already_is_kept(bench):
    kept = 0
    for seed in range(8):
        case = bench("linear", seed, off=(0.0, 0.0))
        found = align_touches(case.probe_P, case.touches, case.T_before, NOISE)
        if found.advice is Advice.KEEP:
            kept += 1
            assert np.array_equal(found.T_SP, found.before)
    assert kept >= 7  # one in twenty may be adopted by chance


def test_swapped_markers_are_named_and_left_out(bench):
    case = bench("linear", 2)
    points = case.touches.points_P.copy()
    points[[3, 7]] = points[[7, 3]]
    names = tuple(f"M{row}" for row in range(15))
    found = align_touches(
        case.probe_P, MarkerTouches(points, case.touches.wrenches, names=names), case.T_before, NOISE
    )
    assert np.flatnonzero(~found.kept).tolist() == [3, 7]
    for name in ("M3", "M7"):
        assert any(sentence.startswith(f"{name} was left out") for sentence in found.fitted.warnings)
    assert found.advice is Advice.ADOPT
    assert case.error(found.T_SP)[0] < 0.002


def test_the_right_one_of_four_axes_is_chosen(bench):
    case = bench("t-shape", 5)
    axes = align_axes(case.probe_P)
    starts = [case.T_true @ np.linalg.inv(axes.alternatives[0]) @ T for T in axes.alternatives]
    found = align_touches(case.probe_P, case.touches, starts, NOISE, belief=MountBelief(0.05, 0.5))
    assert case.error(found.fitted.T_SP)[0] < 0.004


def test_too_small_a_noise_widens_the_covariance_instead_of_blaming_touches(bench):
    case = bench("convex", 6)
    small = WrenchNoise(0.05 / 8, 0.002 / 8)
    right = align_touches(case.probe_P, case.touches, case.T_before, NOISE)
    wrong = align_touches(case.probe_P, case.touches, case.T_before, small, placement=0.0003 / 8)
    assert wrong.kept.sum() >= 13
    assert np.all(wrong.fitted.sigmas_mm > 0.4 * right.fitted.sigmas_mm)
    assert any("scatter" in sentence for sentence in wrong.fitted.warnings)


def test_a_common_wrench_error_moves_the_mount_as_predicted(bench):
    case = bench("linear", 7)
    bias = np.array([0.02, -0.03, 0.01, 0.001, -0.0005, 0.0008])
    clean = align_touches(case.probe_P, case.touches, case.T_before, NOISE)
    shifted = MarkerTouches(case.touches.points_P, case.touches.wrenches + bias)
    biased = align_touches(case.probe_P, shifted, case.T_before, NOISE)
    moved = difference(biased.fitted.T_SP, clean.fitted.T_SP, clean.fitted.about_S)
    predicted = clean.bias_effect @ bias
    assert np.linalg.norm(moved - predicted) < 0.1 * np.linalg.norm(predicted)


def test_few_touches_prove_nothing(bench):
    case = bench("linear", 8, count=5)
    found = align_touches(case.probe_P, case.touches, case.T_before, NOISE)
    assert found.advice is Advice.KEEP
    assert "at least 6" in found.reasons[0]


def test_three_touches_are_fitted_as_far_as_they_go(bench):
    case = bench("linear", 8, count=3)
    found = align_touches(case.probe_P, case.touches, case.T_before, NOISE)
    assert 1 <= found.rank <= 6
    assert len(found.unseen) == 6 - found.rank
    assert found.advice is Advice.KEEP


def test_many_touches_are_left_out_in_ten_folds(bench):
    done = []
    case = bench("linear", 9, count=24)
    found = align_touches(case.probe_P, case.touches, case.T_before, NOISE, progress=done.append)
    assert found.check.folds == 10
    assert np.allclose(done, np.arange(1, 11) / 10)


def test_touches_that_cannot_be_used_are_refused(bench):
    case = bench("linear", 10)
    points, wrenches = case.touches.points_P, case.touches.wrenches
    with pytest.raises(AlignmentError, match="forces pull"):
        align_touches(case.probe_P, MarkerTouches(points, -wrenches), case.T_before, NOISE)
    for unit, parts in (("N·mm", 1000), ("N·cm", 100)):
        wrong = MarkerTouches(points, wrenches * [1, 1, 1, parts, parts, parts])
        with pytest.raises(AlignmentError, match=f"they are in {unit}. Divide mx, my and mz by {parts}"):
            align_touches(case.probe_P, wrong, case.T_before, NOISE)
    with pytest.raises(AlignmentError, match="mm from the mesh"):
        align_touches(case.probe_P, MarkerTouches(points * 2, wrenches), case.T_before, NOISE)
    with pytest.raises(AlignmentError, match="infinitely certain"):
        align_touches(case.probe_P, case.touches, case.T_before, WrenchNoise(0, 0), placement=0.0)
    with pytest.raises(AlignmentError, match="not a rotation"):
        align_touches(case.probe_P, case.touches, case.T_before @ np.diag([2, 2, 2, 1.0]), NOISE)
    with pytest.raises(AlignmentError, match="these are not numbers"):
        align_touches(case.probe_P, case.touches, [[1, 2], [3]], NOISE)
    with pytest.raises(AlignmentError, match="give metres"):
        align_touches(case.probe_P, case.touches, case.T_before, NOISE, placement=0.3)
    with pytest.raises(AlignmentError, match=r"MountBelief\.shift"):
        MountBelief(5.0)
    with pytest.raises(AlignmentError, match="one of each"):
        MarkerTouches(points, wrenches[:-1])


def test_a_marker_beside_the_mesh_is_moved_onto_it_and_told(bench):
    case = bench("linear", 11)
    points = case.touches.points_P.copy()
    _, normals, _ = put_on_mesh(case.touches, case.probe_P)
    points[2] += 0.003 * normals[2]
    touches = MarkerTouches(points, case.touches.wrenches, normals)
    found = align_touches(case.probe_P, touches, case.T_before, NOISE)
    assert any(sentence.startswith("touch 3: the marker is 3.0 mm") for sentence in found.fitted.warnings)
    flipped = normals.copy()
    flipped[4] *= -1
    _, _, warnings = put_on_mesh(
        MarkerTouches(case.touches.points_P, case.touches.wrenches, flipped), case.probe_P
    )
    assert any(sentence.startswith("touch 5: the given normal is 180°") for sentence in warnings)


def test_the_same_touches_give_the_same_bytes(bench):
    case = bench("convex", 12)
    first, second = (
        align_touches(case.probe_P, case.touches, case.T_before, NOISE).fitted.to_json() for _ in range(2)
    )
    assert first == second


# ---- points known in both frames -----------------------------------------------------------------


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


@pytest.mark.parametrize(
    ("points", "words"),
    [
        (SPREAD, ()),
        (SPREAD[:3], ("a fourth, off their plane, would reveal a wrong one or a mirrored frame",)),
        (SPREAD[:3] * [1, 1, 0], ("a fourth, off their plane",)),
        (
            np.vstack([SPREAD[:3], SPREAD[1] + SPREAD[2] * 2]),
            ("in one plane, so a mirrored frame would not show",),
        ),
        (
            np.array([[0.03, 0.01, 0], [-0.03, -0.01, 0], [0, 0, 0.1], [0, 0, 0]]),
            ("in one plane", "in the order 2, 1, 3, 4 they fit as well, with the mesh turned by 180°"),
        ),
        (
            np.array([[0.02, 0, 0], [-0.01, 0.0173, 0], [-0.01, -0.0173, 0], [0, 0, 0.1]]),
            ("they fit as well, with the mesh turned by 120°",),
        ),
    ],
)
def test_what_points_cannot_tell_is_said(points, words):
    T, _ = pose(4)
    found = align_points(points, points @ T[:3, :3].T + T[:3, 3]).warnings
    assert len(found) == len(words)
    for sentence, expected in zip(found, words, strict=True):
        assert expected in sentence


@pytest.mark.parametrize(
    ("points", "places", "words"),
    [
        (SPREAD[:2], SPREAD[:2], "three or more"),
        (SPREAD, SPREAD[:3], "three or more"),
        (np.outer([0, 1, 2], [0.01, 0.02, 0.03]), SPREAD[:3], "one line"),
        (np.outer([0, 1, 2], [0.05, 0, 0]) + [[0, 0, 0], [0, 0.0005, 0], [0, 0, 0]], SPREAD[:3], "one line"),
        (np.ones((3, 3)), SPREAD[:3], "one place"),
        (SPREAD, 25.4 * SPREAD, "25.4 times"),
        (SPREAD, SPREAD * [1, 1, -1], r"fit only mirrored \(within .* left-handed"),
        (np.full((4, 3), np.inf), SPREAD, "not finite"),
        (SPREAD[:, :2], SPREAD, "shape"),
    ],
)
def test_points_that_show_no_mount_are_refused(points, places, words):
    with pytest.raises(AlignmentError, match=words):
        align_points(points, places)


def test_a_mirrored_frame_shows_through_noise():
    rng, points = np.random.default_rng(0), np.vstack([SPREAD, 0.7 * SPREAD[::-1] + 0.01])
    for noise in [0.0002, 0.001, 0.002] * 5:
        places = points + rng.normal(0, noise, (8, 3))
        assert "mirrored" not in " ".join(align_points(points, places).warnings)
        with pytest.raises(AlignmentError, match="fit only mirrored"):
            align_points(points, places * [1, -1, 1])
    few = align_points(SPREAD, SPREAD * [1, 1, -0.92]).warnings
    assert "The points fit better mirrored" in few[0]


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
