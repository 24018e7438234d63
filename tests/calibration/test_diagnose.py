"""The convention check: the right mistake is named, and by what; nothing is changed unasked."""

from dataclasses import replace
from itertools import permutations

import numpy as np
import pytest
from calibration.diagnosis_cases import (
    FACTORS,
    FIXED,
    LOAD,
    NOISE,
    STRAIGHT,
    XYZ,
    angles,
    assert_named,
    assert_same,
    held,
    meaning,
    misread,
    oriented,
    pushed,
    scaled,
    transposed,
    turned,
    written,
)
from scipy.spatial.transform import Rotation

from contactbench.pipeline.calibration import PoseNoise
from contactbench.pipeline.calibration.diagnosis.diagnose import diagnose
from contactbench.pipeline.calibration.diagnosis.hypotheses import hypotheses
from contactbench.pipeline.calibration.diagnosis.prior import Prior
from contactbench.pipeline.calibration.diagnosis.rereadings import RawOrientations, angles_of, from_angles
from contactbench.pipeline.calibration.diagnosis.side_by_side import HypothesisNoise
from contactbench.pipeline.calibration.diagnosis.side_by_side import weigh as weigh_hypotheses
from contactbench.pipeline.calibration.model import maximise, two_stage
from contactbench.pipeline.calibration.orientation import Convention, Kind, rotations
from contactbench.pipeline.calibration.poses import stack

# ---- as declared ---------------------------------------------------------------------------------


def test_clean_data_are_consistent():
    poses = held(turned())
    found = diagnose(poses, NOISE)
    assert found.consistent
    assert found.explained
    assert found.best.hypothesis == "as_declared"
    assert found.best.margin == 0
    assert found.sentence.startswith("The data are consistent as they are: residuals ")
    assert found.best.residual == pytest.approx(1, abs=0.3)
    assert found.best.mass == pytest.approx(LOAD.mass, rel=0.02)
    # Signs leave no trace in residuals, so what is known of loads is part of every such verdict.
    assert found.decided_by == "prior: gravity points down, the centre of mass lies on the tool's side"
    assert_same(found.corrected("as_declared"), poses, 0)


def test_nothing_is_changed_unasked():
    poses = transposed(held(turned()))
    before = [np.concatenate([*pose.R_WS, pose.force, pose.torque]) for pose in poses]
    diagnose(poses, NOISE)
    for pose, numbers in zip(poses, before, strict=True):
        assert (np.concatenate([*pose.R_WS, pose.force, pose.torque]) == numbers).all()


@pytest.mark.parametrize("given", [None, NOISE])
def test_perfect_data_are_as_declared(given):
    found = diagnose(held(turned(), noise=PoseNoise(1e-12, 1e-12)), given, prior=Prior(mass=LOAD.mass))
    assert found.best.hypothesis == "as_declared"
    assert found.consistent


@pytest.mark.parametrize("times", [0.5, 2.0])
def test_noise_that_is_wrong_by_a_factor_of_two_does_no_harm(times):
    assert diagnose(held(turned(12)), PoseNoise(0.05 * times, 0.002 * times)).consistent


def test_noise_may_differ_from_axis_to_axis():
    noise = PoseNoise(np.array([0.02, 0.05, 0.2]), np.array([0.001, 0.004, 0.0005]))
    assert diagnose(held(turned(), noise=noise), noise).consistent


def test_the_fit_is_the_most_likely_one():
    poses = stack(held(turned()))
    candidates, _ = hypotheses(poses, None)
    declared = weigh_hypotheses(candidates[:1], poses, HypothesisNoise(NOISE.sigmas, 0.4))[0]
    best = maximise(poses, NOISE.sigmas, two_stage(poses))
    assert declared.squares.sum() == pytest.approx(best.cost, rel=1e-3)
    np.testing.assert_allclose(declared.gravity_W, best.theta[:3], atol=0.002)
    np.testing.assert_allclose(declared.centre_of_mass_S, best.theta[6:9], atol=1e-4)
    sigmas = np.sqrt(np.diag(best.covariance))[[0, 1, 2, 6, 7, 8]]
    noise = np.repeat(declared.noise, 3)
    np.testing.assert_allclose(np.sqrt(np.diag(declared.covariance)) / noise, sigmas, rtol=0.2)


# ---- each mistake by itself ----------------------------------------------------------------------


@pytest.mark.parametrize("key", FACTORS)
def test_units_and_signs(key):
    truth = held(turned())
    force, torque = FACTORS[key]
    assert_named(diagnose(scaled(truth, 1 / force, 1 / torque), NOISE), key, truth)


def test_the_scatter_within_a_pose_is_in_the_same_unit():
    sd = np.array([1.0, 2.0, 3.0])
    poses = [replace(pose, force_sd=sd, torque_sd=1000 * sd) for pose in held(turned())]
    found = diagnose(poses, NOISE)
    np.testing.assert_allclose(found.corrected("torque_Nmm")[0].torque_sd, sd)
    np.testing.assert_allclose(found.corrected("wrench_negated")[0].force_sd, sd)


@pytest.mark.parametrize("axis", [0, 1, 2])
def test_an_axis_that_is_reversed(axis):
    truth = held(turned())
    sign = np.where(np.arange(3) == axis, -1.0, 1.0)
    assert_named(diagnose(scaled(truth, sign, sign), NOISE), f"axis_{'xyz'[axis]}_reversed", truth)


@pytest.mark.parametrize("angle", [90, 180, 270])
def test_a_sensor_that_is_turned_on_the_flange(angle):
    truth = held(turned())
    c, s = np.cos(np.radians(angle)), np.sin(np.radians(angle))
    mount = np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]])  # v_flange = mount @ v_sensor
    found = diagnose(oriented(truth, [pose.R_WS @ mount.T for pose in truth]), NOISE)
    assert_named(found, f"yaw_{angle}", truth)
    assert f"Rz({angle if angle <= 180 else angle - 360}°)" in found.sentence


def test_transposed_orientations():
    truth = held(turned())
    found = diagnose(transposed(truth), NOISE)
    assert_named(found, "transposed", truth)
    assert found.decided_by == "residuals"
    assert found.finding("as_declared").residual > 20
    assert "the residuals fall from" in found.sentence
    assert "Pass --inverse" in found.sentence


@pytest.mark.parametrize("jump", [(0.5, -0.8, 0.3), (0.0, 0.0, -3.0)])
@pytest.mark.parametrize("change", range(2, 8))
def test_a_re_zero_half_way(change, jump):
    truth = held(turned())
    found = diagnose(pushed(truth, *range(change, 9), force=jump), NOISE)
    assert_named(found, f"rezero_before_{change + 1}", truth, 0.1)
    assert f"re-zeroed between poses {change} and {change + 1}" in found.sentence


# ---- orientations, from the numbers as written ---------------------------------------------------


@pytest.mark.parametrize("order", [*FIXED[1:], *(order.upper() for order in FIXED)])
def test_another_euler_order(order):
    truth = held(turned())
    poses, raw = misread(truth, replace(XYZ, order=order), XYZ)
    found = diagnose(poses, NOISE, raw=raw)
    assert_named(found, f"euler_{order}", truth)
    assert f"Pass --euler {order}." in found.sentence


VECTOR, ZYX = (Convention(kind, "ZYX", degrees=False) for kind in (Kind.ROTATION_VECTOR, Kind.EULER))


@pytest.mark.parametrize(
    ("meant", "read", "key", "remedy"),
    [
        (VECTOR, ZYX, "rotation_vector", "Pass --rotation-vector."),
        (ZYX, VECTOR, "euler_ZYX", "Pass --euler ZYX."),
        (ZYX, replace(ZYX, degrees=True), "radians", "Pass --radians."),
        (replace(ZYX, degrees=True), ZYX, "degrees", "Leave out --radians."),
        (replace(VECTOR, degrees=True), VECTOR, "degrees", "Leave out --radians."),
        (replace(XYZ, inverse=True), XYZ, "transposed", "Pass --inverse"),
        (XYZ, replace(XYZ, inverse=True), "transposed", "Leave out --inverse."),
        (replace(ZYX, inverse=True), replace(ZYX, inverse=True, order="xyz"), "euler_ZYX", "--euler ZYX"),
        (Convention(inverse=True), Convention(), "transposed", "Pass --inverse"),
    ],
)
@pytest.mark.parametrize("mounted", [False, True])
def test_numbers_that_mean_something_else(meant, read, key, remedy, mounted):
    truth = held(turned())
    R_ES = Rotation.from_rotvec([0.3, -0.2, 0.9]).as_matrix() if mounted else STRAIGHT
    poses, raw = misread(truth, meant, read, R_ES)
    found = diagnose(poses, NOISE, raw=raw)
    assert_named(found, key, truth)
    assert remedy in found.sentence


@pytest.mark.parametrize(
    ("columns", "key"), [([1, 2, 3, 0], "quaternion_xyzw"), ([3, 0, 1, 2], "quaternion_wxyz")]
)
@pytest.mark.parametrize("with_raw", [True, False])
def test_quaternions_in_another_order(columns, key, with_raw):
    truth = held(turned())
    numbers = written(np.array([pose.R_WS for pose in truth]), Convention())[:, columns]
    raw = RawOrientations(numbers, Convention())
    poses = oriented(truth, rotations(numbers, Convention()))
    assert_named(diagnose(poses, NOISE, raw=raw if with_raw else None), key, truth)


def test_joints_in_radians():
    pytest.importorskip("mujoco")
    rng = np.random.default_rng(3)
    meant = Convention(Kind.JOINTS, degrees=False, robot="elfin3")
    numbers = rng.uniform(-2, 2, (9, 6))
    truth = held(rotations(numbers, meant))
    read = replace(meant, degrees=True)
    poses = oriented(truth, rotations(numbers, read))
    assert_named(diagnose(poses, NOISE, raw=RawOrientations(numbers, read)), "radians", truth)
    in_degrees = RawOrientations(np.degrees(numbers), read)
    found = diagnose(truth, NOISE, raw=in_degrees)
    assert found.consistent
    assert any("cannot be radians" in sentence for sentence in found.not_testable)


# ---- orientations that an earlier program converted ----------------------------------------------


@pytest.mark.parametrize(("meant", "read"), list(permutations(FIXED, 2))[::3])
def test_a_conversion_from_the_wrong_euler_order(meant, read):
    truth = held(turned())  # angles of any size: which of the two sets was written follows from what it meant
    R_WS = np.array([pose.R_WS for pose in truth])
    poses = oriented(truth, meaning(angles(Rotation.from_matrix(R_WS), meant), read))
    found = diagnose(poses, NOISE)
    assert_named(found, f"euler_{meant}_read_as_euler_{read}", truth, 1e-6)
    assert any("can only be tested with the angles" in sentence for sentence in found.not_testable)


@pytest.mark.parametrize("order", FIXED)
@pytest.mark.parametrize("vectors_meant", [True, False])
def test_a_conversion_that_took_rotation_vectors_for_angles(order, vectors_meant):
    rng = np.random.default_rng(4)
    truth = held(Rotation.from_rotvec(rng.uniform(-1.2, 1.2, (9, 3))).as_matrix())
    R_WS = Rotation.from_matrix(np.array([pose.R_WS for pose in truth]))
    meant, read = ("vector", order) if vectors_meant else (order, "vector")
    key = f"rotation_vector_read_as_euler_{order}"
    if not vectors_meant:
        key = f"euler_{order}_read_as_rotation_vector"
    found = diagnose(oriented(truth, meaning(angles(R_WS, meant), read)), NOISE)
    assert_named(found, key, truth, 1e-6)


@pytest.mark.parametrize("way", FIXED)
def test_angles_that_are_not_unique_still_mean_the_same_rotation(way):
    locked = np.zeros((8, 3))
    locked[:, ["xyz".index(axis) for axis in way]] = [
        [first, middle, last] for first in (10, -100) for middle in (90, -90) for last in (0, 60)
    ]
    R = from_angles(np.radians(locked), way)
    np.testing.assert_allclose(R, meaning(np.radians(locked), way), atol=1e-12)
    np.testing.assert_allclose(from_angles(angles_of(R, way), way), R, atol=1e-9)


def test_straight_up_does_not_upset_the_recovered_angles():
    upright = Rotation.from_euler("y", [[90], [-90], [90], [90]], degrees=True).as_matrix()
    found = diagnose(held(np.concatenate([upright, turned(6)])), NOISE)
    assert found.consistent
