"""What decides between readings: residuals, priors, bumps, or nothing."""

import json
from dataclasses import replace

import numpy as np
import pytest
from calibration.diagnosis_cases import (
    FACTORS,
    KGF,
    LOAD,
    NOISE,
    TWINS,
    XYZ,
    angles,
    held,
    meaning,
    misread,
    oriented,
    pushed,
    scaled,
    transposed,
    turned,
)
from scipy.spatial.transform import Rotation
from weighing_files import draw_noise

from contactbench.pipeline.calibration import GravityModel, PoseError, PoseNoise, PoseSample
from contactbench.pipeline.calibration.diagnosis.diagnose import diagnose
from contactbench.pipeline.calibration.diagnosis.prior import Prior
from contactbench.pipeline.calibration.diagnosis.rereadings import RawOrientations
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.simulation.loads import draw_load, weigh

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
    assert found.decided_by == "nothing"
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
    found = diagnose(held(turned(), nothing), NOISE)
    assert "feels no weight" in found.sentence


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
    for key in KEYS * 3:
        noise, load, count = draw_noise(rng), draw_load(rng, (0.3, 2.0)), int(rng.integers(8, 13))
        poses = list(weigh(load, turned(count, int(rng.integers(1000))), noise, rng).poses)
        if bumped:  # not beside the re-zero, whose moment it would blur
            poses = pushed(poses, int(rng.integers(5, count - 1)), force=rng.uniform(-10, 10, 3))
        found = diagnose(mistaken(rng, poses, key), noise, prior=Prior(mass=load.mass))
        named = {found.best.hypothesis, *found.tied}
        told = key in named and not named - {key, *TWINS.get(key, ())}
        if not told or found.consistent != (key == "as_declared"):
            wrong.append((key, found.sentence))
    assert len(wrong) <= 1, wrong
