"""Causes that the convention check learnt later: each is found and mended, and none is named that is not the cause."""

import re
from dataclasses import replace

import numpy as np
import pytest
from calibration.diagnosis_cases import (
    KGF,
    LOAD,
    NOISE,
    STRAIGHT,
    XYZ,
    assert_named,
    assert_same,
    held,
    misread,
    oriented,
    scaled,
    transposed,
    turned,
)
from scipy.spatial.transform import Rotation

from contactbench.pipeline.calibration import GravityModel, Level, PoseNoise, PoseSample, calibrate
from contactbench.pipeline.calibration.diagnosis.diagnose import Diagnosis, diagnose
from contactbench.pipeline.calibration.diagnosis.explain import in_words
from contactbench.pipeline.calibration.diagnosis.prior import Prior
from contactbench.pipeline.calibration.orientation import Convention, Kind

SURE = 0.75  # odds of 3 to 1
WEIGHED = Prior(mass=LOAD.mass)
LBF = 4.4482216152605


def assert_none_named(found: Diagnosis) -> None:
    """Nothing is named, and the answer says so."""
    assert found.none_known
    assert not found.consistent
    assert max(share for key, share in found.odds.items() if key != "none") < SURE
    assert found.sentence.startswith("No single convention mistake explains the data: ")
    assert f"(odds of another cause: {in_words(found.odds['none'])})" in found.sentence
    assert "more poses" not in found.sentence


# ---- readings ------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("force", "torque", "key"),
    [
        (1, 0.01, "torque_Ncm"),
        (1, LBF * 0.0254, "torque_lbfin"),
        (LBF, 1, "force_lbf"),
        (LBF, LBF * 0.0254, "force_lbf_torque_lbfin"),
        (LBF, LBF * 0.3048, "force_lbf_torque_lbfft"),
        (9.80665, 0.0980665, "force_kgf_torque_kgfcm"),
    ],
)
def test_other_units(force, torque, key):
    truth = held(turned())
    found = diagnose(scaled(truth, 1 / force, 1 / torque), NOISE, prior=WEIGHED)
    assert key in {found.best.hypothesis, *found.tied}
    assert found.explained
    assert not found.consistent
    assert_same(found.corrected(key), truth)
    others = {"force_lbf": {"force_lbf_torque_lbfft"}, "torque_lbfin": {"torque_kgfcm"}}
    others |= {b: {a} for a, (b,) in others.items()}
    assert {found.best.hypothesis, *found.tied} <= {key} | others.get(key, set())


@pytest.mark.parametrize("channel", range(6))
def test_a_single_channel_with_the_wrong_sign(channel):
    truth = held(
        turned(), load=GravityModel(LOAD.gravity_W, LOAD.force_bias, [0.03, -0.02, 0.07], LOAD.torque_bias)
    )
    sign = np.where(np.arange(6) == channel, -1.0, 1.0)
    name = ("fx", "fy", "fz", "mx", "my", "mz")[channel]
    found = diagnose(scaled(truth, sign[:3], sign[3:]), NOISE)
    assert_named(found, f"{name}_negated", truth)
    assert f"Multiply {name} by -1" in found.sentence


@pytest.mark.parametrize(
    ("order", "key"),
    [
        ([1, 0, 2, 3, 4, 5], "fx_fy_swapped"),
        ([0, 2, 1, 3, 4, 5], "fy_fz_swapped"),
        ([2, 1, 0, 3, 4, 5], "fx_fz_swapped"),
        ([1, 0, 2, 4, 3, 5], "fx_fy_mx_my_swapped"),
        ([0, 2, 1, 3, 5, 4], "fy_fz_my_mz_swapped"),
        ([0, 1, 2, 4, 3, 5], "mx_my_swapped"),
        ([3, 4, 5, 0, 1, 2], "force_torque_swapped"),
    ],
)
def test_swapped_channels(order, key):
    truth = [replace(pose, force_sd=[1.0, 2, 3], torque_sd=[4.0, 5, 6]) for pose in held(turned())]
    wrenches = [np.concatenate([pose.force, pose.torque])[order] for pose in truth]
    recorded = [replace(pose, force=w[:3], torque=w[3:]) for pose, w in zip(truth, wrenches, strict=True)]
    found = diagnose(recorded, NOISE)
    assert_named(found, key, truth)
    np.testing.assert_allclose(found.corrected(key)[0].force_sd, np.arange(1.0, 7)[order][:3])


# ---- frames --------------------------------------------------------------------------------------


@pytest.mark.parametrize("given", [NOISE, None])
@pytest.mark.parametrize("degrees", [-33, 5, 14, 61, 160])
def test_a_sensor_that_is_turned_about_its_axis_by_any_angle(degrees, given):
    truth = held(turned(12))
    turn = Rotation.from_euler("z", -degrees, degrees=True).as_matrix()
    found = diagnose(oriented(truth, [pose.R_WS @ turn for pose in truth]), given)
    assert found.best.hypothesis == "mount"
    assert not found.consistent
    assert found.odds["mount"] > 0.9
    angle = np.degrees(Rotation.from_matrix(found.best.turn).as_rotvec()[2])
    assert angle == pytest.approx(degrees, abs=1)
    assert_same(found.corrected("mount"), truth, 0.02)
    assert "about its z axis on the flange" in found.sentence


@pytest.mark.parametrize("given", [NOISE, None])
@pytest.mark.parametrize("vector", [(0.09, 0, 0), (-0.06, 0.07, 0.0), (0.5, -0.9, 0.2), (2, 1, -1)])
def test_a_sensor_that_is_mounted_in_any_other_way(vector, given):
    truth = held(turned(12))
    turn = Rotation.from_rotvec(vector).as_matrix()
    poses = oriented(truth, [pose.R_WS @ turn.T for pose in truth])
    found = diagnose(poses, given)
    assert found.best.hypothesis == "mount"
    assert not found.consistent
    np.testing.assert_allclose(found.best.turn, turn, atol=0.02)
    assert_same(found.corrected("mount"), truth, 0.02)
    assert "--estimate-mount" in found.sentence
    assert found.to_json()["ranking"][0]["turn"] == found.best.turn.tolist()


@pytest.mark.parametrize("down", [(1, 0, 0), (0, -1, 0), (0, 0, 1)])
def test_gravity_along_another_axis_of_the_world(down):
    up = Rotation.align_vectors([down], [[0.0, 0, -1]])[0].as_matrix()
    poses = held(turned())
    poses = oriented(poses, [up @ pose.R_WS for pose in poses])
    found = diagnose(poses, NOISE)
    key = next(
        name for name in ("gravity_along_+x", "gravity_along_-y", "gravity_along_+z") if name in found.odds
    )
    key = "gravity_along_" + ("-" if min(down) < 0 else "+") + "xyz"[int(np.argmax(np.abs(down)))]
    assert key in {found.best.hypothesis, *found.tied}
    assert not found.consistent
    assert found.odds["wrench_negated"] < SURE
    if down[2] == 0:
        assert f"pass --down {','.join(map(str, down))}." in found.sentence
    assert_same(found.corrected(key), poses)
    assert diagnose(poses, NOISE, prior=Prior(down_W=down)).consistent


def test_gravity_in_a_slanted_frame():
    camera = Rotation.from_rotvec([0.7, 0.5, 0]).as_matrix()
    poses = held(turned())
    poses = oriented(poses, [camera @ pose.R_WS for pose in poses])
    found = diagnose(poses, NOISE)
    assert found.best.hypothesis == "world_turned"
    assert "pass --down" in found.sentence
    down = [
        float(number) for number in found.sentence.split("--down ")[1].split(". ")[0].rstrip(".").split(",")
    ]
    assert diagnose(poses, NOISE, prior=Prior(down_W=tuple(down))).consistent


def test_a_wall_is_no_mistake_once_it_is_said():
    wall = GravityModel([7.0, 0, 0], LOAD.force_bias, LOAD.centre_of_mass_S, LOAD.torque_bias)
    poses = held(turned(), wall)
    assert diagnose(poses, NOISE, prior=Prior(down_W=(1, 0, 0))).consistent
    found = diagnose(transposed(poses), NOISE, prior=Prior(down_W=(1, 0, 0)))
    assert_same(found.corrected("transposed"), poses)
    assert found.best.hypothesis == "transposed"


# ---- orientations and rows -----------------------------------------------------------------------


@pytest.mark.parametrize(
    ("meant", "key", "remedy"),
    [
        (replace(XYZ, order="ZYZ"), "euler_ZYZ", "Pass --euler ZYZ."),
        (replace(XYZ, order="xzx"), "euler_xzx", "Pass --euler xzx."),
        (
            Convention(Kind.ROTATION_VECTOR, degrees=False),
            "rotation_vector_radians",
            "Pass --rotation-vector, and pass --radians.",
        ),
    ],
)
def test_other_numbers_behind_the_orientations(meant, key, remedy):
    truth = held(turned())
    poses, raw = misread(truth, meant, XYZ, STRAIGHT)
    found = diagnose(poses, NOISE, raw=raw)
    assert_named(found, key, truth)
    assert remedy in found.sentence


def test_a_conversion_with_the_columns_the_other_way_round():
    truth = held(turned())
    numbers = Rotation.from_matrix([pose.R_WS for pose in truth]).as_euler("ZYX")
    found = diagnose(oriented(truth, Rotation.from_euler("xyz", numbers).as_matrix()), NOISE)
    assert_named(found, "columns_ZYX_read_as_xyz", truth, 1e-6)


@pytest.mark.parametrize("step", [1, -1])
@pytest.mark.parametrize("wraps", [True, False])
def test_orientations_that_belong_to_the_next_row(step, wraps):
    truth = held(turned(10))
    R_WS = np.roll([pose.R_WS for pose in truth], step, axis=0)
    if not wraps:
        R_WS[0 if step > 0 else -1] = turned(1, 77)[0]
    found = diagnose(oriented(truth, R_WS), NOISE)
    key = f"rows_shifted_by_{step}"
    assert found.best.hypothesis == key
    assert found.odds[key] > 0.95
    assert not found.consistent
    assert len(found.best.left_out) == (0 if wraps else 1)
    assert ("then has no orientation of its own" in found.sentence) is not wraps
    kept = [index for index in range(10) if index not in found.best.left_out]
    mended = found.corrected(key)
    assert_same([mended[index] for index in kept], [truth[index] for index in kept])


@pytest.mark.parametrize(("first", "second"), [(0, 1), (2, 7), (4, 9)])
def test_two_orientations_that_are_swapped(first, second):
    truth = held(turned(10))
    R_WS = [pose.R_WS for pose in truth]
    R_WS[first], R_WS[second] = R_WS[second], R_WS[first]
    found = diagnose(oriented(truth, R_WS), NOISE)
    assert_named(found, f"rows_{first + 1}_and_{second + 1}_swapped", truth)
    assert f"orientations of poses {first + 1} and {second + 1} are swapped" in found.sentence


@pytest.mark.parametrize("timed", [True, False])
def test_a_zero_that_drifts(timed):
    times = np.array([0, 5, 10, 100, 110, 120, 130, 140, 150, 400.0]) if timed else np.arange(10.0)
    drift = np.array([0.8, -0.5, 0.3, 0.01, 0.02, -0.01])
    truth = [
        replace(pose, time=float(t) if timed else None)
        for pose, t in zip(held(turned(10)), times, strict=True)
    ]
    poses = [
        replace(pose, force=pose.force + share * drift[:3], torque=pose.torque + share * drift[3:])
        for pose, share in zip(truth, (times - times[-1]) / np.ptp(times), strict=True)
    ]
    found = diagnose(poses, NOISE)
    assert found.best.hypothesis == "drift"
    assert found.odds["drift"] > SURE
    assert_same(found.corrected("drift"), truth, 0.3)


def test_a_zero_that_settles_is_no_re_zero():
    truth = held(turned(12))
    settled = 1 - np.exp(-4 * np.linspace(0, 1, 12))
    poses = [
        replace(pose, force=pose.force + share * np.array([0.6, -0.5, 0.4]))
        for pose, share in zip(truth, settled, strict=True)
    ]
    found = diagnose(poses, NOISE)
    assert found.best.hypothesis == "drift"
    assert max([0.0, *(share for key, share in found.odds.items() if key.startswith("rezero"))]) < 0.25


# ---- the sensor ----------------------------------------------------------------------------------


@pytest.mark.parametrize("given", [NOISE, None])
@pytest.mark.parametrize(
    ("force", "torque", "key", "words"),
    [
        ([1.2, 1, 1], 1, "channel_fx", "The gain of the channel fx is wrong by +2"),
        (1, [1, 0, 1], "channel_my", "hardly responds"),
    ],
)
def test_one_wrong_channel_is_named(force, torque, key, words, given):
    poses = scaled(held(turned(12)), force, torque)
    found = diagnose(poses, given)
    assert found.best.hypothesis == key
    assert found.odds[key] > 0.95
    assert words in found.sentence
    calibration = calibrate(poses, given)
    assert calibration.verdict.level != Level.GOOD
    told = calibration.causes[0]
    assert (told.key, told.believed) == ("channel", True)
    assert "the force residuals " in told.sentence
    assert "the torque residuals " in told.sentence


def test_a_slight_error_of_a_gain_comes_first():
    calibration = calibrate(scaled(held(turned(12)), [1, 1.03, 1], 1))
    assert calibration.causes[0].key == "channel"


def test_a_channel_with_the_wrong_sign_is_not_called_dead():
    told = calibrate(scaled(held(turned(12)), 1, [1, 1, -1])).causes
    assert any("The gain of the channel mz is wrong by -2" in cause.sentence for cause in told)


@pytest.mark.parametrize(
    ("in_world", "key"), [((True, True), "wrench_in_base"), ((True, False), "force_in_base")]
)
def test_readings_along_the_axes_of_the_base(in_world, key):
    truth = held(turned(12))
    forces, torques = (
        [pose.R_WS @ half if world else half for pose, half in zip(truth, halves, strict=True)]
        for world, halves in zip(in_world, ([p.force for p in truth], [p.torque for p in truth]), strict=True)
    )
    recorded = [replace(p, force=F, torque=M) for p, F, M in zip(truth, forces, torques, strict=True)]
    assert_named(diagnose(recorded, NOISE), key, truth)


def test_a_likelier_reading_stands_before_what_is_believed_of_the_poses_as_declared():
    waves = np.sin(np.linspace(0, 3, 40))[:, None] * [0.5, -0.7, 0.4]
    recorded = [
        replace(pose, force=pose.R_WS @ (pose.force + wave), torque=pose.R_WS @ pose.torque)
        for pose, wave in zip(held(turned(40)), waves, strict=True)
    ]
    calibration = calibrate(recorded)
    first, *others = calibration.causes
    assert (first.key, first.believed) == ("wrench_in_base", False)
    assert not any(cause.believed for cause in others)
    assert calibration.verdict.reasons[0] == first.sentence


def test_a_channel_at_its_limit_and_a_filter_are_named():
    truth = held(turned(12))
    wrenches = np.array([np.concatenate([pose.force, pose.torque]) for pose in truth])
    limited = wrenches.copy()
    limited[:, 0] = np.minimum(limited[:, 0], np.sort(limited[:, 0])[-4])
    lagging = wrenches.copy()
    for i in range(1, 12):
        lagging[i] = 0.9 * wrenches[i] + 0.1 * lagging[i - 1]
    for recorded, key in ((limited, "clipped"), (lagging, "filter")):
        poses = [replace(pose, force=w[:3], torque=w[3:]) for pose, w in zip(truth, recorded, strict=True)]
        calibration = calibrate(poses, NOISE)
        assert calibration.causes[0].key == key
        assert calibration.causes[0].odds > 0.9
        assert calibration.verdict.level != Level.GOOD


@pytest.mark.parametrize(
    ("force", "torque", "words"),
    # Torques in lbf·in, forces in kgf, torques of the other sign, and torques 1000 times too small.
    [(1, 8.85, "no tool"), (1 / 9.80665, 1, "no tool"), (1, -1, "(--tip)"), (1, 1e-3, "1000 times")],
)
def test_no_calibration_is_good_where_no_tool_can_be(force, torque, words):
    poses = held(turned(12))
    assert calibrate(poses, NOISE).verdict.level == Level.GOOD
    calibration = calibrate(scaled(poses, force, torque))
    assert calibration.verdict.level != Level.GOOD
    assert any(words in reason for reason in calibration.verdict.reasons)


# ---- what is not known ---------------------------------------------------------------------------


def readings_of_chance(poses: list[PoseSample]) -> list[PoseSample]:
    rng = np.random.default_rng(9)
    return [
        replace(pose, force=5 * rng.standard_normal(3), torque=0.3 * rng.standard_normal(3)) for pose in poses
    ]


@pytest.mark.parametrize(
    "spoil",
    [
        lambda poses: [*poses[:6], *transposed(poses[6:])],
        readings_of_chance,
        lambda poses: scaled(transposed(poses), [1, -1, 1], [1, 1, 1]),
    ],
    ids=["half transposed", "chance", "two mistakes"],
)
def test_what_no_cause_explains_gets_no_name(spoil):
    assert_none_named(diagnose(spoil(held(turned(12))), NOISE, prior=WEIGHED))


def test_odds_are_those_of_all_readings_and_of_none():
    found = diagnose(transposed(held(turned())), NOISE)
    assert sum(found.odds.values()) == pytest.approx(1)
    assert found.odds["transposed"] > 0.95
    assert not found.none_known
    assert found.sentence.startswith("The orientations are transposed")
    assert found.to_json()["odds"] == dict(found.odds)


@pytest.mark.parametrize(
    ("probability", "words"), [(0.75, "3 to 1"), (0.5, "1 to 1"), (0.2, "1 to 4"), (1.0, "over 1000 to 1")]
)
def test_odds_in_words(probability, words):
    assert in_words(probability) == words


def test_what_is_not_well_supported_is_said_with_its_odds():
    found = diagnose(scaled(held(turned()), 1 / LBF, 1), NOISE, prior=WEIGHED)  # or torques in lbf·ft
    assert found.best.hypothesis.startswith("force_lbf")
    assert max(found.odds.values()) < 0.95
    said = rf"ly, at odds of {in_words(found.odds[found.best.hypothesis])}\): "
    assert re.match(rf"Forces are in lbf.* \((possib|probab){said}", found.sentence)


def test_units_that_nobody_can_exclude_keep_a_verdict_from_being_good():
    poses = held(turned(), replace(LOAD, centre_of_mass_S=np.array([0.0, 0.0, 0.03])))
    assert calibrate(poses).verdict.level is Level.GOOD
    read = calibrate(scaled(poses, 1 / LBF, 1)).verdict
    assert read.level is Level.USABLE
    assert re.search(
        r"of \d+\.\d %: forces in lbf.* fit as well, .* of 0\.7\d kg .* of 0\.16 kg", read.reasons[0]
    )
    # Alike for both, they move no contact.
    assert calibrate(scaled(poses, 1 / KGF, 1 / KGF)).verdict.level is Level.GOOD


def test_many_variants_of_a_mistake_do_not_add_up():
    found = diagnose(held(turned(20)), NOISE)
    assert found.consistent
    assert found.odds["as_declared"] > 0.9


# ---- without noise and mass ----------------------------------------------------------------------


def test_units_keep_data_from_being_called_consistent():
    poses = held(turned(12))
    found = diagnose(poses)
    assert found.best.hypothesis == "as_declared"
    assert not found.consistent
    assert not found.none_known
    assert (
        "But the units cannot be determined without the tool's mass: 0.71 kg as declared, or"
        in found.sentence
    )
    assert diagnose(poses, prior=WEIGHED).consistent


def test_residuals_that_may_be_more_than_noise_are_not_consistent():
    found = diagnose(held(turned(12), noise=PoseNoise(0.4, 0.02)), prior=WEIGHED)
    assert not found.consistent
    assert "Give the noise from the sensor's data sheet" in found.sentence


# ---- noise of the orientations -------------------------------------------------------------------


def test_orientations_that_are_noisy_are_no_mistake():
    heavy = GravityModel([0, 0, -40.0], LOAD.force_bias, LOAD.centre_of_mass_S, LOAD.torque_bias)
    rng = np.random.default_rng(2)
    quiet = PoseNoise(0.03, 0.001)
    poses = held(turned(12), heavy, quiet)
    shaken = [
        pose.R_WS @ Rotation.from_rotvec(np.radians(0.5) * rng.standard_normal(3)).as_matrix()
        for pose in poses
    ]
    poses = oriented(poses, shaken)
    prior = Prior(mass=40 / 9.80665)
    assert not diagnose(poses, quiet, prior=prior).consistent
    said = diagnose(poses, replace(quiet, orientation=np.radians(0.5)), prior=prior)
    assert said.consistent
    assert said.best.residual == pytest.approx(1, abs=0.3)


def test_residuals_that_chance_refutes_leave_no_cause_probable():
    found = diagnose(held(turned(20), noise=PoseNoise(0.14, 0.0056)), NOISE, prior=WEIGHED)
    assert not found.explained
    assert found.none_known
    assert found.odds["none"] > 0.9
    assert "a specified noise that is too small" in found.sentence
