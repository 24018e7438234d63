from dataclasses import replace

import numpy as np
import pytest
from benchmarks.verification import bench
from scipy.spatial.transform import Rotation

from contactbench.pipeline.verification import diagnosis
from contactbench.pipeline.verification.causes import TouchEvidence, alignment_columns, explain
from contactbench.pipeline.verification.diagnosis import diagnose
from contactbench.pipeline.verification.figures import ErrorCause

NOISE = np.diag(np.repeat([0.02, 5e-4], 3) ** 2) / 50


def touches(*, repeats=1, sides=False, orientations=False, tilt=0.02, seed=0):
    """Evidence without errors: a face of 5 x 3 markers, pressed from above; or all six sides of a box."""
    rng = np.random.default_rng(seed)
    x, y = (each.ravel() for each in np.meshgrid(np.linspace(-0.028, 0.028, 5), [-0.005, 0.0, 0.005]))
    points = np.column_stack([x, y, np.full(15, 0.03)])
    normals = np.tile([0.0, 0.0, 1.0], (15, 1))
    if sides:
        turns = Rotation.create_group("O").as_matrix()[rng.permutation(24)[:15]]
        points, normals = (np.einsum("nij,nj->ni", turns, each) for each in (points, normals))
        points = points + [0.0, 0.0, 0.1]
    markers = np.repeat(np.arange(15), repeats)
    points, normals = points[markers], normals[markers]
    n = len(markers)
    F = 9.0 * (tilt * rng.normal(size=(n, 3)) - normals)
    R = Rotation.random(n, random_state=seed).as_matrix() if orientations else np.tile(np.eye(3), (n, 1, 1))
    theta = np.concatenate([[0.0, 0.0, -5.0], np.zeros(9)])
    theta[6:9] = [0.0, 0.0, -0.2]
    wrenches = np.hstack([F, np.cross(points, F)])
    return TouchEvidence(
        np.zeros((n, 3)), markers, points, normals, np.zeros(n), wrenches, R, np.zeros(n), NOISE, theta
    )


def misaligned(evidence, *, turn=(0.0, 0.0, 0.0)):
    columns = alignment_columns(evidence.sensitivities, evidence.wrenches)
    return with_errors(evidence, columns @ [*turn, 0.002, 0.0, 0.0])


def with_errors(evidence, errors, seed=1):
    noise = np.random.default_rng(seed).multivariate_normal(np.zeros(6), NOISE, len(errors))
    along = errors - np.einsum("ni,ni,nj->nj", errors, evidence.normals, evidence.normals)
    return replace(evidence, errors=along + np.einsum("nij,nj->ni", evidence.sensitivities, noise))


@pytest.mark.parametrize("tilt", [0.02, 0.2])
def test_a_face_pressed_one_way_in_one_orientation_cannot_tell_alignment_from_gravity(tilt):
    evidence = misaligned(touches(tilt=tilt), turn=(0.0, 0.02, 0.0) if tilt > 0.1 else (0.0, 0.0, 0.0))
    found = explain(evidence)
    assert {found.first, *found.rivals} == {ErrorCause.ALIGNMENT, ErrorCause.GRAVITY}
    assert not found.aligned
    text = diagnose(evidence, within=False).text
    assert "These touches cannot tell which it is; touch in a second orientation, or on other sides" in text
    assert "alignment or gravity" in text or "gravity or alignment" in text
    assert "Realign the probe" not in text
    assert "Recalibrate bias" not in text


def test_sides_or_orientations_tell_them_apart():
    for evidence in (touches(sides=True), touches(orientations=True)):
        found = explain(misaligned(evidence, turn=(0.03, 0.02, 0.0)))
        assert found.first is ErrorCause.ALIGNMENT
        assert found.rivals == ()
        assert found.aligned


def test_an_alignment_that_would_make_up_for_a_wrong_weight_does_not_help():
    found = [bench(ErrorCause.GRAVITY, np.random.default_rng([9, t])).verified() for t in range(3)]
    assert all(each.diagnosis.first is ErrorCause.GRAVITY for each in found)
    assert not any(each.alignment_refined.helps for each in found)


@pytest.mark.parametrize(("share", "words"), [(0.48, "the largest part of"), (0.7, "most of")])
def test_less_than_half_is_not_called_most(monkeypatch, share, words):
    evidence = misaligned(touches(sides=True), turn=(0.03, 0.02, 0.0))
    shares = {ErrorCause.ALIGNMENT: share, ErrorCause.NOISE: 0.9 - share, ErrorCause.MESH: 0.1}
    mixed = replace(explain(evidence), shares={**dict.fromkeys(ErrorCause, 0.0), **shares})
    monkeypatch.setattr(diagnosis, "explain", lambda _: mixed)
    for within in (True, False):
        text = diagnose(evidence, within).text
        assert {part: part in text for part in ("the largest part of", "most of")} == {
            part: part == words for part in ("the largest part of", "most of")
        }


@pytest.mark.parametrize("wrong", [(1, 3), (7,)])
def test_markers_that_are_elsewhere_are_named(wrong):
    evidence = touches(repeats=3, sides=True)
    errors = np.zeros((45, 3))
    errors[np.isin(evidence.markers, wrong)] = [0.0015, 0.0012, 0.0009]
    found = diagnose(with_errors(evidence, errors), within=False)
    assert found.first is ErrorCause.MARKERS
    assert f"check the positions of {'markers 2, 4' if len(wrong) == 2 else 'the marker 8'}." in found.text
    named = diagnose(with_errors(evidence, errors), within=False, names=[f"m{k}" for k in range(15)])
    assert f"m{wrong[0]}" in named.text


def test_where_all_markers_are_off_all_are_to_be_checked():
    evidence = touches(repeats=3, sides=True)
    places = 0.0005 * np.random.default_rng(4).normal(size=(15, 3))
    found = diagnose(with_errors(evidence, places[evidence.markers]), within=False)
    assert found.first is ErrorCause.MARKERS
    assert "check the positions of the markers." in found.text


def test_labels_that_are_swapped_are_named_and_leave_no_wrong_remedy():
    evidence = touches(repeats=2)
    rows = 2 * np.arange(15)
    true = np.arange(15)
    true[[1, 6, 3, 9]] = 6, 1, 9, 3  # of two pairs the labels are swapped
    errors = (evidence.points[rows][true] - evidence.points[rows])[evidence.markers]
    noisy = with_errors(evidence, np.zeros((30, 3)))
    found = diagnose(replace(evidence, errors=errors + noisy.errors), within=False, names="abcdefghijklmno")
    assert found.first is found.shares[0].cause is ErrorCause.MARKERS
    assert found.shares[0].share > 0.99
    assert "labels of markers are swapped: b and g; d and j." in found.text
    assert "swapped" not in diagnose(noisy, within=True).text


@pytest.mark.parametrize("passed", [True, False])
def test_a_verification_that_failed_does_not_say_that_no_action_is_needed(passed):
    text = diagnose(with_errors(touches(), np.zeros((15, 3))), within=True, passed=passed).text
    assert ("No action needed" in text) is passed


def test_single_touches_do_not_tell_markers_from_noise():
    evidence = touches(sides=True)
    places = 0.0005 * np.random.default_rng(4).normal(size=(15, 3))
    assert diagnose(with_errors(evidence, places), within=False).first is ErrorCause.NOISE


def test_noise_that_was_seen_within_touches_is_not_what_lies_between_them():
    still = touches(sides=True, orientations=True)
    once = with_errors(still, np.zeros((15, 3)))
    louder = replace(once, errors=4.0 * once.errors)
    assert explain(louder).first is ErrorCause.NOISE
    assert explain(replace(louder, measured=True)).first is ErrorCause.SENSOR
    assert explain(replace(once, measured=True)).first is ErrorCause.NOISE


def test_what_is_not_found_of_the_newer_causes_is_not_listed():
    found = bench(None, np.random.default_rng(5)).verified().diagnosis
    assert {each.cause for each in found.shares} == set(list(ErrorCause)[:6])


@pytest.mark.parametrize(
    ("wrong", "first", "words"),
    [
        (0.0, ErrorCause.NOISE, ("errors speak for that, 1,000,000 to 1; no drift shows",)),
        (-1.0, ErrorCause.DRIFT, ("errors speak against that, 1,000,000 to 1", "lift the probe clear")),
        (
            None,
            ErrorCause.GRAVITY,
            ("errors speak for that", "no drift shows", "a warmer sensor does not help"),
        ),
    ],
)
def test_drift_that_was_taken_off_is_told_from_what_is_left(wrong, first, words):
    still = touches(sides=True, orientations=True)
    since = np.linspace(0.0, 300.0, 15)
    taken = np.outer(np.sin(since / 90), [0.1, -0.05, 0.08, 0.004, 0.006, -0.003])
    left = np.tile([0, 0, 0, 0.01, -0.01, 0.005], (15, 1)) if wrong is None else wrong * taken
    evidence = with_errors(still, np.einsum("nij,nj->ni", still.sensitivities, left))
    found = diagnose(replace(evidence, starts=since, taken=taken), within=False)
    assert found.first is first, found.text
    assert found.drift.force_N == pytest.approx(np.sqrt((taken[:, :3] ** 2).sum(axis=1).mean()))
    assert all(each in found.text for each in words), found.text
    assert diagnose(evidence, within=False).drift is None
