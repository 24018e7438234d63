"""The convention check: the right mistake is named, and by what: residuals, priors, bumps, or nothing."""

import json
from dataclasses import replace
from itertools import permutations

import numpy as np
import pytest
from calibration.diagnosis_cases import (
    FACTORS,
    FIXED,
    KGF,
    LOAD,
    NOISE,
    TWINS,
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
from weighing_files import draw_noise

from contactbench.pipeline.calibration import GravityModel, PoseError, PoseNoise, PoseSample
from contactbench.pipeline.calibration.diagnosis.diagnose import diagnose
from contactbench.pipeline.calibration.diagnosis.hypotheses import hypotheses
from contactbench.pipeline.calibration.diagnosis.prior import Prior
from contactbench.pipeline.calibration.diagnosis.rereadings import RawOrientations, angles_of, from_angles
from contactbench.pipeline.calibration.diagnosis.side_by_side import HypothesisNoise
from contactbench.pipeline.calibration.diagnosis.side_by_side import weigh as weigh_hypotheses
from contactbench.pipeline.calibration.model import maximise, two_stage
from contactbench.pipeline.calibration.orientation import Convention, Kind, rotations
from contactbench.pipeline.calibration.poses import stack
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.simulation.loads import draw_load, weigh

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
def test_numbers_that_mean_something_else(meant, read, key, remedy):
    truth = held(turned())
    poses, raw = misread(truth, meant, read, Rotation.from_rotvec([0.3, -0.2, 0.9]).as_matrix())
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
    found = diagnose(truth, NOISE, raw=RawOrientations(np.degrees(numbers), read))
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


# ---- what residuals do not tell ------------------------------------------------------------------


def test_what_is_known_of_loads_decides_on_signs():
    truth = held(turned())
    found = diagnose(scaled(truth, -1, -1), NOISE)
    assert found.decided_by == "nothing"
    assert {found.best.hypothesis, *found.tied} == {"wrench_negated", *TWINS["wrench_negated"]}
    assert found.best.log_likelihood == pytest.approx(found.finding("as_declared").log_likelihood, abs=1e-3)
    assert "do not decide it, but as declared gravity would point 179° away from down" in found.sentence
    assert found.sentence.startswith(
        "The controller already subtracts a payload that is heavier than the tool"
    )
    assert (
        "Cannot be distinguished from: forces and torques with the wrong sign; gravity along +z of the world."
        " Press the tool with a finger" in found.sentence
    )
    found = diagnose(scaled(truth, 1, -1), NOISE)
    assert found.tied == ("tool_behind",)
    assert (
        "would lie 70 mm on the other side of the sensor; read this way, 70 mm on the tool's side"
        in found.sentence
    )


def test_a_base_on_the_ceiling_is_no_reaction():
    up = GravityModel(-LOAD.gravity_W, LOAD.force_bias, LOAD.centre_of_mass_S, LOAD.torque_bias)
    poses = held(turned(), up)
    found = diagnose(poses, NOISE)
    assert {found.best.hypothesis, *found.tied} == {"wrench_negated", *TWINS["wrench_negated"]}
    assert max(share for key, share in found.odds.items() if key != "gravity_along_+z") < 0.75
    assert diagnose(poses, NOISE, prior=Prior(down_W=(0, 0, 2))).consistent


def test_a_sensor_whose_z_axis_points_away_from_the_tool():
    behind = GravityModel(LOAD.gravity_W, LOAD.force_bias, -LOAD.centre_of_mass_S, LOAD.torque_bias)
    poses = held(turned(), behind)
    found = diagnose(poses, NOISE)
    assert {found.best.hypothesis, *found.tied} == {"torque_negated", "tool_behind"}
    assert diagnose(poses, NOISE, prior=Prior(tool_axis_S=(0, 0, -1))).consistent


def test_a_sign_that_nothing_decides():
    beside = GravityModel(LOAD.gravity_W, LOAD.force_bias, [0.05, 0.0, 0.0], LOAD.torque_bias)
    found = diagnose(held(turned(), beside), NOISE)
    assert found.consistent
    assert found.decided_by == "nothing"
    assert found.tied == ("torque_negated", "mx_negated")  # its mx never changes
    assert (
        "Cannot be distinguished from: torques with the wrong sign; mx with the wrong sign." in found.sentence
    )


def test_without_noise_units_are_told_by_what_they_make_of_the_load():
    truth = held(turned())
    found = diagnose(scaled(truth, 1, 1000))
    assert found.best.hypothesis == "torque_Nmm"
    assert found.explained
    assert "the centre of mass lies within the tool" in found.decided_by
    assert "would lie 70 m from the sensor; read this way, 70 mm" in found.sentence
    likelihoods = [found.finding(key).log_likelihood for key in ("as_declared", *FACTORS)]
    np.testing.assert_allclose(likelihoods, likelihoods[0], atol=0.01)
    residuals = [found.finding(key).residual for key in ("as_declared", *FACTORS)]
    np.testing.assert_allclose(residuals, 1, rtol=0.01)  # each has the noise that suits it


def test_the_length_of_the_tool_tells_kilograms_from_newtons():
    poses = scaled(held(turned()), 1 / KGF, 1)
    found = diagnose(poses)
    assert "force_kgf" in {found.best.hypothesis, *found.tied}  # or in pounds: as plausible without the mass
    assert not found.consistent
    assert "as declared the centre of mass would lie 684 mm from the sensor; read this way" in found.sentence
    assert max(found.odds.values()) < 0.75
    assert diagnose(poses, prior=Prior(mass=LOAD.mass)).best.hypothesis == "force_kgf"


@pytest.mark.parametrize("factor", [1.0, 1 / KGF])
def test_without_noise_only_a_balance_tells_newtons_from_kilograms(factor):
    poses = scaled(held(turned()), factor, factor)
    found = diagnose(poses)
    # Pounds would need a sensor whose torques are unusually noisy beside its forces: that alone speaks against them.
    assert found.decided_by.endswith("a plausible noise") if factor == 1 else found.decided_by == "nothing"
    readings = [found.finding(key).evidence for key in ("as_declared", "force_kgf_torque_kgfm")]
    assert max(readings) - min(readings) < 4
    assert not found.consistent
    assert "Weigh the tool" in found.sentence
    assert any("The noise was not given" in sentence for sentence in found.not_testable)
    weighed = diagnose(poses, prior=Prior(mass=0.72, mass_sigma=0.02))
    assert weighed.best.hypothesis == ("as_declared" if factor == 1 else "force_kgf_torque_kgfm")
    weight = weighed.finding("as_declared").priors["the mass as weighed"]
    assert weight > -2 if factor == 1 else weight < -50


def test_noise_that_was_estimated_from_the_poses_is_not_known():
    poses = scaled(held(turned()), 1 / KGF, 1 / KGF)
    guess = PoseNoise(0.05, 0.002, estimated=True)
    assert diagnose(poses, guess).finding("force_kgf").log_likelihood == pytest.approx(
        diagnose(poses).finding("force_kgf").log_likelihood
    )
    assert diagnose(poses, NOISE).best.hypothesis == "force_kgf_torque_kgfm"


def test_a_verdict_that_rests_on_the_noise_says_so():
    found = diagnose(held(turned()), PoseNoise(0.5, 0.02))
    assert found.best.hypothesis == "force_kgf_torque_kgfm"
    assert "Or the specified noise is" in found.sentence
    assert diagnose(held(turned()), PoseNoise(0.5, 0.02), prior=Prior(mass=0.71)).best.hypothesis == (
        "as_declared"
    )


def test_orders_that_make_no_difference_are_tied():
    rng = np.random.default_rng(5)
    numbers = np.column_stack([rng.uniform(-80, 80, (10, 2)), np.zeros(10)])  # nothing about z
    truth = held(meaning(np.radians(numbers), "xyz"))
    found = diagnose(oriented(truth, meaning(np.radians(numbers), "yxz")), NOISE)
    same = {f"euler_{order}_read_as_euler_yxz" for order in ("xyz", "xzy", "zxy")}
    assert {found.best.hypothesis, *found.tied} >= same
    assert found.decided_by == "nothing"
    assert found.explained
    assert "Cannot be distinguished from: Euler angles" in found.sentence
    declared = diagnose(truth, NOISE)
    assert declared.consistent
    assert not declared.tied
    assert any("fit equally well as declared and as" in sentence for sentence in declared.not_testable)


# ---- bumps ---------------------------------------------------------------------------------------


@pytest.mark.parametrize("given", [NOISE, None])
@pytest.mark.parametrize("which", [(0,), (3,), (8,), (3, 4), (0, 8), (6, 8)])
def test_bumped_poses_are_no_mistake(given, which):
    poses = held(turned())
    for size, index in enumerate(which, 1):
        poses = pushed(poses, index, force=(size, -2, 0.5 / size))
    found = diagnose(poses, given, prior=Prior(mass=LOAD.mass))
    assert found.consistent
    assert found.best.left_out == which
    assert "pose 9 look" in found.sentence.lower() if which[-1] == 8 else "bumped" in found.sentence
    if which == (8,):
        assert "(or the sensor was re-zeroed before it)" in found.sentence


def test_two_bumps_do_not_hide_one_another():
    rng = np.random.default_rng(7)
    for seed in range(4):
        which = np.sort(rng.choice(8, 2, replace=False)).tolist()
        poses = held(turned(8, seed), seed=seed)
        for index in which:
            poses = pushed(poses, index, force=rng.uniform(1, 5) * turned(1, int(rng.integers(99)))[0][0])
        found = diagnose(poses, NOISE)
        assert found.consistent, seed
        assert list(found.best.left_out) == which, seed


def test_a_mistake_is_found_beneath_bumps():
    truth = pushed(held(turned()), 2, 6)
    found = diagnose(transposed(truth), NOISE)
    assert found.best.hypothesis == "transposed"
    assert found.best.left_out == (2, 6)
    assert "Pose 3 and pose 7 look bumped" in found.sentence
    named = [replace(pose, name=f"shelf {index}") for index, pose in enumerate(truth)]
    assert "Shelf 2 and shelf 6 look bumped" in diagnose(named, NOISE).sentence


def test_a_bump_beside_a_re_zero_leaves_its_moment_open():
    poses = pushed(pushed(held(turned(12)), *range(6, 12)), 5, force=(-3, 2, 4))
    found = diagnose(poses, NOISE)
    assert {found.best.hypothesis, *found.tied} == {"rezero_before_6", "rezero_before_7"}
    assert "It may equally have been before pose" in found.sentence


# ---- what nothing explains -----------------------------------------------------------------------


@pytest.mark.parametrize("given", [NOISE, None])
def test_two_mistakes_at_once_are_not_explained(given):
    truth = held(turned(12))
    turn = Rotation.from_euler("z", 90, degrees=True).as_matrix()
    poses = oriented(truth, [(pose.R_WS @ turn).T for pose in truth])
    found = diagnose(poses, given)
    assert not found.explained
    assert not found.consistent
    assert found.sentence.startswith("No single convention mistake explains the data: ")


def test_the_first_of_two_mistakes_says_that_there_is_a_second():
    truth = held(turned())
    found = diagnose(transposed(scaled(truth, -1, -1)), NOISE)
    assert found.best.hypothesis == "transposed"
    assert "But then gravity points 179° away from down. Correct this, then check again" in found.sentence
    assert "wrench_negated" in diagnose(found.corrected("transposed"), NOISE).tied
    found = diagnose(transposed(scaled(truth, 1, -1)), NOISE)
    assert "the centre of mass lies 70 mm on the other side of the sensor. Correct this" in found.sentence
    found = diagnose(transposed(truth), NOISE, prior=Prior(mass=2.0))
    assert "But then the mass comes out as 0.72 kg where 2 kg was weighed. Correct this" in found.sentence
    assert "But then" not in diagnose(transposed(truth), NOISE).sentence


def test_unexplained_data_that_fit_best_as_they_are():
    found = diagnose(held(turned(12), noise=PoseNoise(0.3, 0.012)), NOISE)
    assert found.best.hypothesis == "as_declared"
    assert not found.explained
    assert "no other reading is more probable" in found.sentence


@pytest.mark.parametrize(
    ("R_WS", "words"),
    [
        (np.repeat(turned(1), 6, axis=0), "Every pose has the same orientation"),
        (Rotation.from_euler("z", np.arange(6)[:, None]).as_matrix(), "Every pose has the same tilt"),
    ],
)
def test_poses_that_tell_nothing(R_WS, words):
    found = diagnose(held(R_WS), NOISE)
    assert found.sentence.startswith("These poses show no inconsistency")
    assert words in found.sentence
    assert found.decided_by == "nothing"


def test_a_load_that_is_not_felt():
    nothing = GravityModel(np.zeros(3), LOAD.force_bias, np.zeros(3), LOAD.torque_bias)
    assert "feels no weight" in diagnose(held(turned(), nothing), NOISE).sentence


def test_a_load_that_is_not_what_was_said():
    tilted = GravityModel([3.0, 0.0, -6.0], LOAD.force_bias, LOAD.centre_of_mass_S, LOAD.torque_bias)
    found = diagnose(held(turned(), tilted), NOISE)
    assert found.consistent
    assert "But gravity points 26° away from down. Check what was declared about the tool" in found.sentence
    found = diagnose(held(turned()), NOISE, prior=Prior(mass=1.0))
    assert found.consistent
    assert "But the mass comes out as 0.72 kg where 1 kg was weighed. Check" in found.sentence
    assert "But" not in diagnose(held(turned()), NOISE).sentence


# ---- the answer as a whole -----------------------------------------------------------------------


def test_the_ranking_is_complete_and_plain():
    found = diagnose(scaled(held(turned()), 1, -1), NOISE)
    keys = [finding.hypothesis for finding in found.ranking]
    assert len(set(keys)) == len(keys)
    assert {"as_declared", "transposed", "quaternion_xyzw", "yaw_180", *FACTORS} <= set(keys)
    scores = [finding.score for finding in found.ranking]
    assert scores == sorted(scores, reverse=True)
    declared = found.finding("as_declared")
    for finding in found.ranking:
        assert finding.score == pytest.approx(finding.log_likelihood + finding.log_prior)
        assert finding.margin == pytest.approx(finding.score - declared.score)
        assert finding.sentence
        assert finding.title
    mistake = found.best.log_prior - sum(found.best.priors.values())
    assert mistake < np.log(Prior().mistake)  # which its family shares
    assert sum(found.odds.values()) == pytest.approx(1)
    again = json.loads(json.dumps(found.to_json()))
    assert again["best"] == "torque_negated"
    assert again["ranking"][0]["mass"] == pytest.approx(LOAD.mass, rel=0.02)
    assert again["not_testable"] == list(found.not_testable)


def test_many_poses():
    found = diagnose(pushed(held(turned(60)), 5, 17, 30, 31), NOISE)
    assert found.consistent
    assert found.best.left_out == (5, 17, 30, 31)


@pytest.mark.parametrize("count", [3, 201])
def test_too_few_or_too_many_poses(count):
    with pytest.raises(PoseError, match=rf"{count} poses: the convention check needs 4 to 200"):
        diagnose(held(turned(count)), NOISE)


def test_raw_numbers_that_belong_to_other_poses():
    poses, raw = misread(held(turned()), XYZ, XYZ)
    with pytest.raises(InputError, match="raw has 9 rows for 8 poses"):
        diagnose(poses[:8], NOISE, raw=raw)
    with pytest.raises(InputError, match=r"raw row 3 is not the orientation of pose 3"):
        diagnose(oriented(poses, [turned(1)[0] if i == 2 else p.R_WS for i, p in enumerate(poses)]), raw=raw)


@pytest.mark.parametrize("values", [np.zeros((9, 4)), np.zeros(3), np.full((9, 3), np.nan)])
def test_raw_numbers_of_the_wrong_shape(values):
    with pytest.raises(InputError, match=r"RawOrientations.values: give finite numbers of shape \(n, 3\)"):
        RawOrientations(values, XYZ)


def test_a_hypothesis_that_does_not_exist():
    found = diagnose(held(turned()), NOISE)
    with pytest.raises(InputError, match=r"no hypothesis 'mirrored'\. Tested: as_declared, "):
        found.corrected("mirrored")


@pytest.mark.parametrize(
    ("wrong", "words"),
    [
        ({"tilt": 0.0}, "Prior.tilt"),
        ({"mass": -1.0}, "Prior.mass: -1.0"),
        ({"mass": float("nan")}, "Prior.mass"),
        ({"mass_sigma": 0.1}, "Prior.mass_sigma without Prior.mass"),
        ({"mass_range": (2.0, 1.0)}, "Prior.mass_range"),
        ({"down_W": (0.0, 0.0, 0.0)}, "Prior.down_W"),
        ({"tool_axis_S": (0.0, 1.0)}, "Prior.tool_axis_S"),
        ({"tool_length": 0.0}, "Prior.tool_length"),
        ({"noise_factor": 0.5}, "Prior.noise_factor"),
        ({"mistake": 2.0}, "Prior.mistake"),
    ],
)
def test_a_prior_that_makes_no_sense(wrong, words):
    with pytest.raises(InputError, match=words):
        Prior(**wrong)


# ---- statistics ----------------------------------------------------------------------------------


def mistaken(rng: np.random.Generator, poses: list[PoseSample], key: str) -> list[PoseSample]:
    if key == "as_declared":
        return poses
    if key in FACTORS:
        return scaled(poses, 1 / FACTORS[key][0], 1 / FACTORS[key][1])
    if key == "transposed":
        return transposed(poses)
    if key == "yaw_180":
        return oriented(poses, [pose.R_WS * [-1, -1, 1] for pose in poses])
    if key.startswith("euler"):
        turn = Rotation.from_matrix(np.array([pose.R_WS for pose in poses]))
        return oriented(poses, meaning(angles(turn, "zyx"), "xyz"))
    force = rng.uniform(2, 5) * Rotation.random(rng=rng).as_matrix()[0]
    return pushed(poses, *range(int(key[-1]) - 1, len(poses)), force=force)


KEYS = ("as_declared", "transposed", "yaw_180", "euler_zyx_read_as_euler_xyz", "rezero_before_4", *FACTORS)


@pytest.mark.parametrize("bumped", [False, True])
def test_random_sets_are_told_right(bumped):
    rng = np.random.default_rng([6, bumped])
    wrong = []
    for key in KEYS * 2:
        noise, load, count = draw_noise(rng), draw_load(rng, (0.3, 2.0)), int(rng.integers(8, 13))
        poses = list(weigh(load, turned(count, int(rng.integers(1000))), noise, rng).poses)
        if bumped:  # not beside the re-zero, whose moment it would blur
            poses = pushed(poses, int(rng.integers(5, count - 1)), force=rng.uniform(-10, 10, 3))
        found = diagnose(mistaken(rng, poses, key), noise, prior=Prior(mass=load.mass))
        named = {found.best.hypothesis, *found.tied}
        told = key in named and not named - {key, *TWINS.get(key, ())}
        if not told or found.consistent != (key == "as_declared"):
            wrong.append((key, found.sentence))
    assert not wrong
