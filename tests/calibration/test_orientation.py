"""Orientations as they are written, against matrices multiplied by hand."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from contactbench.pipeline.calibration.orientation import Convention, Kind, RowError, rotations
from contactbench.pipeline.errors import InputError

ANGLE = st.floats(-720, 720, allow_subnormal=False)
ANGLES = st.tuples(ANGLE, ANGLE, ANGLE)
ORDERS = [a + b + c for a in "xyz" for b in "xyz" for c in "xyz" if a != b and b != c]


def about(axis: str, degrees: float) -> np.ndarray:
    """Rotation about a coordinate axis, as every textbook prints it."""
    c, s = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
    return {
        "x": np.array([[1, 0, 0], [0, c, -s], [0, s, c]]),
        "y": np.array([[c, 0, s], [0, 1, 0], [-s, 0, c]]),
        "z": np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]]),
    }[axis]


def one(values, convention: Convention) -> np.ndarray:
    return rotations(np.array([values], dtype=float), convention)[0]


# ---- Euler angles ------------------------------------------------------------------------------


@given(ANGLES, st.sampled_from(ORDERS))
@settings(max_examples=40, deadline=None)
def test_euler_angles_about_fixed_and_turning_axes(angles, order):
    first, second, third = (about(axis, angle) for axis, angle in zip(order, angles, strict=True))
    fixed = one(angles, Convention(Kind.EULER, order=order))
    turning = one(angles, Convention(Kind.EULER, order=order.upper()))
    assert np.allclose(fixed, third @ second @ first, atol=1e-12)
    assert np.allclose(turning, first @ second @ third, atol=1e-12)


def test_a_quarter_turn_about_z_points_x_along_y():
    for order in ("xyz", "XYZ"):
        R_WS = one([0, 0, 90], Convention(Kind.EULER, order=order))
        assert np.allclose(R_WS @ [1, 0, 0], [0, 1, 0], atol=1e-15)


@pytest.mark.parametrize("order", ["", "xy", "xyzx", "xxy", "zyy", "xYz", "abc", "XYy", "x y"])
def test_orders_that_are_none_are_refused(order):
    with pytest.raises(InputError, match="give three axes"):
        Convention(Kind.EULER, order=order)


# ---- the other kinds ---------------------------------------------------------------------------


@given(ANGLES)
@settings(max_examples=25, deadline=None)
def test_every_kind_names_the_same_rotation(angles):
    turn = Rotation.from_euler("xyz", angles, degrees=True)
    R_WS = turn.as_matrix()
    vector = turn.as_rotvec()
    x, y, z, w = turn.as_quat()
    written = {
        Convention(Kind.QUATERNION): [w, x, y, z],
        Convention(Kind.QUATERNION, degrees=False): [-w, -x, -y, -z],
        Convention(Kind.ROTATION_VECTOR): np.degrees(vector),
        Convention(Kind.ROTATION_VECTOR, degrees=False): vector,
        Convention(Kind.EULER): angles,
        Convention(Kind.EULER, degrees=False): np.radians(angles),
        Convention(Kind.EULER, inverse=True, order="XYZ"): -np.array(angles),
    }
    for convention, values in written.items():
        assert np.allclose(one(values, convention), R_WS, atol=1e-9), convention


@pytest.mark.parametrize("kind", [Kind.QUATERNION, Kind.EULER, Kind.ROTATION_VECTOR])
def test_the_inverse_is_the_transpose_of_every_row(kind):
    turns = Rotation.random(5, np.random.default_rng(0))
    values = {
        Kind.QUATERNION: turns.as_quat()[:, [3, 0, 1, 2]],
        Kind.EULER: turns.as_euler("xyz", degrees=True),
        Kind.ROTATION_VECTOR: np.degrees(turns.as_rotvec()),
    }[kind]
    plain = rotations(values, Convention(kind))
    inverse = rotations(values, Convention(kind, inverse=True))
    assert np.allclose(plain, turns.as_matrix(), atol=1e-12)
    assert np.array_equal(inverse, plain.transpose(0, 2, 1))
    assert inverse.flags.c_contiguous


def test_rounded_quaternions_are_taken_and_made_rotations():
    assert np.allclose(one([0.71, 0.71, 0, 0], Convention()), about("x", 90), atol=1e-12)


@pytest.mark.parametrize("bad", [[0, 0, 0, 0], [1, 0.3, 0, 0], [90, 0, 0, 0], [0.97, 0, 0, 0]])
def test_a_quaternion_that_is_none_names_its_row(bad):
    good = [1, 0, 0, 0]
    with pytest.raises(
        RowError, match=r"^row 3: the quaternion has length .*, not 1: check the columns"
    ) as error:
        rotations(np.array([good, good, bad, good], dtype=float), Convention())
    assert error.value.row == 2
    assert error.value.what.startswith("the quaternion")
    assert isinstance(error.value, InputError)


@pytest.mark.parametrize("kind", list(Kind))
def test_columns_and_no_rows(kind):
    if kind == Kind.JOINTS:
        pytest.importorskip("mujoco")
    convention = Convention(kind, robot="elfin3")
    assert rotations(np.zeros((0, len(convention.columns))), convention).shape == (0, 3, 3)
    assert len(set(convention.columns)) == {"quaternion": 4, "joints": 6, "rotation matrix": 9}.get(
        kind.value, 3
    )


def test_columns_are_in_the_order_in_which_they_are_read():
    assert Convention().columns == ("qw", "qx", "qy", "qz")
    assert Convention(Kind.EULER).columns == ("rx", "ry", "rz")
    assert Convention(Kind.JOINTS, robot="elfin3").columns == ("j1", "j2", "j3", "j4", "j5", "j6")


# ---- joints ------------------------------------------------------------------------------------


def test_joints_give_the_flange(elfin):
    q = np.random.default_rng(1).uniform(-2, 2, (4, 6))
    in_rad = rotations(q, Convention(Kind.JOINTS, robot="elfin3", degrees=False))
    in_degrees = rotations(np.degrees(q), Convention(Kind.JOINTS, robot="elfin3"))
    upside_down = rotations(q, Convention(Kind.JOINTS, robot="elfin3", degrees=False, inverse=True))
    for row, joints in enumerate(q):
        R_BE, _ = elfin.flange_pose(joints)
        assert np.allclose(in_rad[row], R_BE, atol=1e-12)
        assert np.allclose(in_degrees[row], R_BE, atol=1e-12)
        assert np.allclose(upside_down[row], R_BE.T, atol=1e-12)


def test_joints_out_of_their_limits_name_their_row(elfin):
    q = np.zeros((3, 6))
    q[1, 2] = 3.0
    with pytest.raises(RowError, match=r"^row 2: joint J3 is at 3\.0000 rad") as error:
        rotations(q, Convention(Kind.JOINTS, robot=elfin.description.name, degrees=False))
    assert error.value.row == 1
    with pytest.raises(RowError, match="check whether these are degrees"):
        rotations(np.full((1, 6), 45.0), Convention(Kind.JOINTS, robot="elfin3", degrees=False))


def test_an_unknown_robot_is_named():
    with pytest.raises(InputError, match="no robot named 'r2d2'"):
        rotations(np.zeros((1, 6)), Convention(Kind.JOINTS, robot="r2d2"))
