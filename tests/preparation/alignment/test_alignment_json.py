"""JSON carries an alignment bit for bit, and nothing else passes for one."""

import json

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from contactbench.pipeline.errors import InputError
from contactbench.pipeline.preparation.alignment.alignment import (
    Alignment,
    AlignmentError,
    AlignmentMethod,
    check_transform,
    from_angles,
    from_json,
    from_transform,
)
from contactbench.pipeline.preparation.alignment.points import align_points

PLAIN = json.loads(from_angles([1, 2, 3], [4, 5, 6]).to_json())


def same(a: Alignment, b: Alignment) -> bool:
    def equal(x, y):
        return (x is None) == (y is None) and (x is None or np.array_equal(x, y))

    return (
        (a.method, a.how, a.warnings, a.residual_m) == (b.method, b.how, b.warnings, b.residual_m)
        and np.array_equal(a.T_SP, b.T_SP)
        and equal(a.covariance, b.covariance)
        and equal(a.about_S, b.about_S)
    )


def test_what_is_written_is_read():
    points = np.random.default_rng(0).normal(size=(5, 3)) * 0.05
    full = align_points(points, points + [0.1, 0, 0])
    assert full.covariance is not None
    for alignment in (full, from_angles([1, 2, 3], [4, 5, 6])):
        text = alignment.to_json()
        assert same(from_json(text), alignment)
        assert from_json(text.encode()).method is alignment.method
        assert from_json(text).to_json() == text


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"schema": "contactbench.calibration"}, "choose an alignment file"),
        ({"version": 2}, "newer contactbench"),
        ({"method": "guessed"}, "method"),
        ({"T_SP_m": [[1, 0, 0, 0]] * 4}, "last row"),
        ({"T_SP_m": [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, -1, 0], [0, 0, 0, 1]]}, "mirrors"),
        ({"T_SP_m": [[1, 0, 0]]}, "T_SP_m"),
        ({"T_SP_m": "here"}, "T_SP_m"),
        ({"covariance": [[0.0] * 6] * 6}, "both or neither"),
        ({"how": ["x"] * 1000}, "how"),
        ({"how": "one sentence"}, "how"),
        ({"extra": 1}, "extra"),
        ({"residual_m": -1}, "residual_m"),
    ],
)
def test_a_file_that_says_something_else_is_refused(change, words):
    with pytest.raises(AlignmentError, match=words) as caught:
        from_json(json.dumps({**PLAIN, **change}), "mount.json")
    assert str(caught.value).startswith("mount.json: ")


@pytest.mark.parametrize("field", sorted(set(PLAIN) - {"schema"}))
def test_every_field_must_be_there(field):
    with pytest.raises(AlignmentError, match=field):
        from_json(json.dumps({key: value for key, value in PLAIN.items() if key != field}))


def test_what_is_not_json_is_refused():
    for data in (b"", b"\xff\xfe", "[" * 100_000, "null", "[]", '{"schema": NaN}', " " * 2_000_000):
        with pytest.raises(AlignmentError, match="alignment"):
            from_json(data)


@given(st.text(max_size=60), st.integers(0, 500))
def test_a_damaged_file_never_does_worse_than_an_alignment_error(text, at):
    whole = json.dumps(PLAIN)
    damaged = whole[:at] + text + whole[at + len(text) :]
    try:
        from_json(damaged)
    except AlignmentError:
        return
    assert AlignmentMethod(json.loads(damaged)["method"]) in AlignmentMethod


# ---- typed mounts mean what they say, and what is no mount is refused by name --------------------


angles = st.tuples(*[st.floats(-360, 360) for _ in range(3)])
places = st.tuples(*[st.floats(-5000, 5000) for _ in range(3)])


def test_fixed_axes_turn_about_x_first():
    # z up is first laid along -y by the turn about x, then stays in the plane when turned about z.
    found = from_angles([10, 20, 30], [90, 0, 90])
    assert np.allclose(found.R_SP @ [0, 0, 1], [1, 0, 0], atol=1e-15)
    assert np.allclose(found.p_SP_S, [0.01, 0.02, 0.03])
    assert found.method is AlignmentMethod.TYPED
    assert not found.warnings
    assert "90°, 0° and 90°" in found.how[0]


@given(places, angles)
def test_both_forms_of_one_rotation_agree(xyz, rxyz):
    by_angles = from_angles(xyz, rxyz)
    assert np.allclose(by_angles.T_SP, from_transform(by_angles.T_SP).T_SP, atol=1e-12)
    assert np.abs(by_angles.R_SP.T @ by_angles.R_SP - np.eye(3)).max() < 1e-14


def with_rotation(R):
    T = np.eye(4)
    T[:3, :3] = R
    return T


def test_angles_that_look_like_radians_are_questioned():
    assert "radians" in from_angles([0, 0, 0], [1.5708, 0, 0]).warnings[0]
    assert not from_angles([0, 0, 0], [1.5, 2.0, 0]).warnings
    assert not from_angles([0, 0, 0], [0, 0, 0]).warnings


@pytest.mark.parametrize(
    ("make", "words"),
    [
        (lambda: from_angles([0, 0, 10_000], [0, 0, 0]), "10 m or longer"),
        (lambda: from_angles([0, 0], [0, 0, 0]), "translation: the shape"),
        (lambda: from_angles([0, 0, 0], [0, 0, 361]), "beyond ±360"),
        (lambda: from_angles([0, 0, np.nan], [0, 0, 0]), "not finite"),
        (lambda: from_angles(["a", 0, 0], [0, 0, 0]), "not numbers"),
        (lambda: from_transform(with_rotation(np.diag([1, 1, -1]))), "mirrors"),
        (lambda: from_transform(with_rotation(1.001 * np.eye(3))), "scales or shears"),
        (lambda: from_transform(with_rotation(1e200 * np.eye(3))), "scales or shears"),
        (lambda: from_transform(np.eye(3)), "shape is"),
        (lambda: from_transform(np.vstack([np.eye(4)[:3], [0.1, 0, 0, 1]])), "transposed"),
        (lambda: from_transform(np.vstack([np.eye(4)[:3], [0, 0, 0, 2]])), "last row"),
    ],
)
def test_what_is_no_mount_is_refused(make, words):
    with pytest.raises(AlignmentError, match=words) as caught:
        make()
    assert isinstance(caught.value, InputError)


def test_an_alignment_cannot_be_changed_and_places_a_probe(bench, move):
    case = bench("linear", 0)
    found = Alignment(case.T_true, AlignmentMethod.TYPED)
    placed = found.place(case.probe_P)
    assert np.allclose(placed.vertices, move(case.T_true, case.probe_P.vertices), rtol=0, atol=1e-15)
    assert np.array_equal(placed.faces, case.probe_P.faces)
    assert placed.name == case.probe_P.name
    with pytest.raises(ValueError, match="read-only"):
        found.T_SP[0, 3] = 1.0


def test_a_rounded_matrix_becomes_orthogonal():
    T = from_angles([1, 2, 3], [10, 20, 30]).T_SP.round(7)
    assert np.abs(check_transform(T)[:3, :3].T @ check_transform(T)[:3, :3] - np.eye(3)).max() < 1e-14


def test_a_covariance_needs_its_point_and_must_be_one():
    with pytest.raises(AlignmentError, match="both or neither"):
        Alignment(np.eye(4), AlignmentMethod.TYPED, covariance=np.eye(6))
    with pytest.raises(AlignmentError, match="negative eigenvalue"):
        Alignment(np.eye(4), AlignmentMethod.TYPED, covariance=-np.eye(6), about_S=np.zeros(3))
    found = Alignment(np.eye(4), AlignmentMethod.TYPED, covariance=1e-6 * np.eye(6), about_S=np.zeros(3))
    assert np.allclose(found.sigmas_mm, 1.0)
    assert np.allclose(found.sigmas_deg, np.degrees(1e-3))
