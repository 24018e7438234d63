"""Poses: what cannot be used is refused by name, what is taken in is a rotation and stays as it is."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from contactbench.pipeline.calibration import PoseError, PoseSample
from contactbench.pipeline.calibration.poses import named, stack
from contactbench.pipeline.errors import InputError

ANGLES = st.floats(-10, 10, allow_subnormal=False)
NAN, INF = float("nan"), float("inf")


def pose(R_WS=None, force=(1.0, 2.0, 3.0), torque=(0.1, 0.2, 0.3), **more) -> PoseSample:
    return PoseSample(np.eye(3) if R_WS is None else R_WS, force, torque, **more)


@given(st.tuples(ANGLES, ANGLES, ANGLES))
@settings(max_examples=40, deadline=None)
def test_a_rotation_typed_with_four_digits_becomes_the_nearest_rotation(rotvec):
    R = Rotation.from_rotvec(rotvec).as_matrix()
    taken = pose(np.round(R, 4)).R_WS
    assert np.abs(taken @ taken.T - np.eye(3)).max() < 1e-14
    assert np.linalg.det(taken) > 0
    assert np.abs(taken - R).max() < 1e-4
    assert np.abs(pose(R).R_WS - R).max() < 1e-14


@pytest.mark.parametrize(
    ("wrong", "said"),
    [
        ({"R_WS": np.diag([1.0, 1.0, -1.0])}, "reflection"),
        ({"R_WS": -np.eye(3)}, "reflection"),
        ({"R_WS": np.diag([1.0, 1.0, -1.0004])}, "reflection"),
        ({"R_WS": 1.002 * np.eye(3)}, "not a rotation"),
        ({"R_WS": [[1, 0.01, 0], [0, 1, 0], [0, 0, 1]]}, "not a rotation"),
        ({"R_WS": np.zeros((3, 3))}, "not a rotation"),
        ({"R_WS": np.eye(2)}, r"shape \(2, 2\)"),
        ({"R_WS": np.full((3, 3), NAN)}, "finite"),
        ({"R_WS": [[INF, 0, 0], [0, 1, 0], [0, 0, 1]]}, "finite"),
        ({"force": [1, 2]}, "force needs three numbers, N"),
        ({"force": 5.0}, "force needs three numbers"),
        ({"force": [1, NAN, 2]}, "force is"),
        ({"torque": [1, INF, 2]}, "torque is"),
        ({"torque": [[1, 2, 3]]}, "torque needs three numbers, N·m"),
        ({"force": [0, 0, 1.01e5]}, "below 100000 N"),
        ({"torque": [0, -1.01e5, 0]}, "below 100000 N·m"),
        ({"force_sd": [0.1, -0.1, 0.1]}, "force_sd is negative"),
        ({"torque_sd": [0.1, NAN, 0.1]}, "torque_sd is"),
        ({"torque_sd": 0.1}, "torque_sd needs three numbers"),
        ({"count": 0}, "at least one sample"),
        ({"count": -3}, "at least one sample"),
        ({"temperature": NAN}, "temperature is nan"),
        ({"time": INF}, "time is inf"),
    ],
)
def test_what_cannot_be_used_is_refused_by_name(wrong, said):
    with pytest.raises(PoseError, match=said) as refusal:
        pose(**wrong, name="upside down")
    assert str(refusal.value).startswith("upside down: ")
    with pytest.raises(InputError, match=r"^pose: "):
        pose(**wrong)


@pytest.mark.parametrize("kind", [np.float64, np.float32, np.int64, list])
def test_any_numbers_are_taken_and_kept_apart_from_the_caller(kind):
    values = [3, -4, 5]
    given_force = list(values) if kind is list else np.array(values, dtype=kind)
    taken = pose(np.eye(3, dtype=int), given_force)
    assert taken.force.dtype == taken.R_WS.dtype == np.float64
    given_force[0] = 100
    assert taken.force.tolist() == values


def test_a_pose_cannot_be_changed():
    readonly = np.array([1.0, 2.0, 3.0])
    readonly.flags.writeable = False
    taken = pose(force=readonly, force_sd=readonly, torque_sd=readonly)
    for field in ("R_WS", "force", "torque", "force_sd", "torque_sd"):
        with pytest.raises(ValueError, match="read-only"):
            getattr(taken, field)[0] = 7
    with pytest.raises(AttributeError):
        taken.count = 2


def test_arrays_hold_the_transposes_and_force_before_torque():
    rotations = Rotation.from_rotvec([[0.1, 0.2, 0.3], [1, 0, 0], [0, 0, 2]]).as_matrix()
    poses = [
        pose(R, [i, 10 + i, 20 + i], [30 + i, 40 + i, 50 + i]) for i, R in enumerate(rotations.astype(float))
    ]
    arrays = stack(poses)
    assert len(arrays) == 3
    for i, R in enumerate(rotations):
        assert np.allclose(arrays.R_SW[i], R.T, atol=1e-15)
        assert arrays.wrenches[i].tolist() == [i, 10 + i, 20 + i, 30 + i, 40 + i, 50 + i]
    assert np.array_equal(np.hstack([arrays.F, arrays.M]), arrays.wrenches)
    for chosen in (np.array([True, False, True]), np.array([0, 2])):
        some = arrays.take(chosen)
        assert np.array_equal(some.R_SW, arrays.R_SW[[0, 2]])
        assert np.array_equal(some.wrenches, arrays.wrenches[[0, 2]])


def test_a_pose_without_a_name_is_called_by_its_number():
    assert [named([pose(), pose(name="left")], i) for i in (0, 1)] == ["pose 1", "left"]
