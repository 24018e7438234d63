"""The next pose and the plan against brute force, and what can be reached."""

from dataclasses import replace
from itertools import pairwise, permutations

import numpy as np
import pytest
from benchmarks.gravity import plan_error
from scipy.spatial.transform import Rotation
from weighing_files import LOAD, NOISE

from contactbench.pipeline.calibration import (
    Calibration,
    ContactTask,
    GravityModel,
    Level,
    PoseNoise,
    PoseSample,
    calibrate,
)
from contactbench.pipeline.calibration.model import UNKNOWN, prediction_jacobian
from contactbench.pipeline.calibration.orientation import plain
from contactbench.pipeline.calibration.suggest import (
    PosePlan,
    Reachable,
    by_hand,
    by_robot,
    describe,
    plan_poses,
    suggest_pose,
)
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.simulation.loads import weigh

ARM = np.array([0.0, -0.3, 1.2, 0.0, 0.9, 0.0])  # holds its tool over a table
DOWN = Rotation.from_rotvec([np.pi, 0, 0]).as_matrix()  # the sensor, as a robot holds it over a table
FACES = Rotation.from_rotvec(
    np.array([[0, 0, 0], [2, 0, 0], [1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0]]) * np.pi / 2
).as_matrix()


@pytest.fixture(scope="module")
def hand() -> Reachable:
    return by_hand(80)


@pytest.fixture(scope="module")
def plan(hand: Reachable) -> PosePlan:
    return plan_poses(6, hand)


def read(R_WS: np.ndarray, seed: int = 0, load: GravityModel = LOAD, noise: PoseNoise = NOISE):
    return list(weigh(load, R_WS, noise, np.random.default_rng([seed, 41])).poses)


def some(count: int, seed: int = 0) -> np.ndarray:
    return Rotation.random(count, np.random.default_rng([seed, 42])).as_matrix()


def spun(count: int) -> np.ndarray:
    return Rotation.from_rotvec(np.outer(np.linspace(0, 4, count), [0, 0, 1.0])).as_matrix()


def errors_by_brute_force(calibration: Calibration, R_WS: np.ndarray) -> np.ndarray:
    """Invert the information with each pose added."""
    theta = calibration.model.vector
    information = np.linalg.inv(calibration.covariance)
    errors = []
    for R_SW in R_WS.swapaxes(1, 2):
        J = prediction_jacobian(R_SW[None], theta)[0] / calibration.noise.sigmas[:, None]
        errors.append(calibration.task.calibration_error(theta, np.linalg.inv(information + J.T @ J)))
    return np.array(errors)


def at(R_WS: np.ndarray, reachable: Reachable) -> int:
    [index] = np.flatnonzero((reachable.R_WS == R_WS).all(axis=(1, 2)))
    return int(index)


# ---- the next pose -----------------------------------------------------------------------------


@pytest.mark.parametrize(
    "noise",
    [NOISE, PoseNoise([0.02, 0.1, 0.05], [0.001, 0.004, 0.002]), None],
    ids=["known", "axes", "estimated"],
)
@pytest.mark.parametrize("count", [3, 5, 9])
def test_the_suggested_pose_is_nearly_the_best_of_all(hand, noise, count):
    calibration = calibrate(read(some(count)), noise)
    suggestion = suggest_pose(calibration, hand)
    expected = errors_by_brute_force(calibration, hand.R_WS)
    assert suggestion.error_after == pytest.approx(expected[at(suggestion.R_WS, hand)], rel=1e-6)
    assert suggestion.error_after <= 1.05 * expected.min()
    assert suggestion.error_before == calibration.contact_error
    assert suggestion.error_after < suggestion.error_before
    if count < 9:
        assert expected.max() > 1.05 * expected.min()  # or any pose would have done


@pytest.mark.parametrize("count", [3, 6])
def test_a_calibration_with_the_pose_has_the_predicted_error(hand, count):
    poses = read(some(count))
    before = calibrate(poses, NOISE, orientation_sigma=0.0)
    suggestion = suggest_pose(before, hand)
    # As far off as noise is: a reading without any would make the noise look smaller than was given.
    wrench = before.model.predict(suggestion.R_WS) + NOISE.sigmas * [1, -1, 1, -1, 1, -1]
    expected = calibrate(
        [*poses, PoseSample(suggestion.R_WS, wrench[:3], wrench[3:])], NOISE, orientation_sigma=0.0
    )
    assert expected.contact_error == pytest.approx(suggestion.error_after, rel=0.03)
    for seed in range(3):
        noisy = calibrate(poses + read(suggestion.R_WS[None], seed), NOISE)
        assert noisy.contact_error == pytest.approx(suggestion.error_after, rel=0.03)


def test_of_poses_nearly_as_good_the_one_least_like_those_before_is_taken(hand):
    calibration = calibrate(read(some(5)), NOISE)
    errors = errors_by_brute_force(calibration, hand.R_WS)
    good = np.flatnonzero(errors <= 1.0499 * errors.min())
    assert len(good) > 2
    down = np.array([0.0, 0.0, -1.0])
    before = np.array([down @ pose.R_WS for pose in calibration.poses])
    likeness = (down @ hand.R_WS @ before.T).max(axis=1)
    chosen = at(suggest_pose(calibration, hand).R_WS, hand)
    assert chosen in good
    assert likeness[chosen] == likeness[good].min()
    assert likeness.min() < likeness[chosen]  # poses that are not good enough do not win by being new


def test_a_set_spun_about_the_vertical_is_told_to_tilt(hand):
    calibration = calibrate(read(spun(4)), NOISE)
    assert calibration.verdict.level == Level.REFUSE
    suggestion = suggest_pose(calibration, hand)
    tilt = np.degrees(np.arccos(np.clip(suggestion.R_WS[2, 2], -1, 1)))
    assert tilt > 30
    assert suggestion.error_after < 0.3 * suggestion.error_before


@pytest.mark.parametrize("upright", [np.eye(3), DOWN], ids=["sensor up", "sensor down"])
def test_a_set_spun_about_an_exact_vertical_is_told_to_tilt_far(hand, upright):
    vertical = replace(LOAD, gravity_W=np.array([0, 0, -6.0]))
    suggestion = suggest_pose(calibrate(read(spun(4) @ upright, load=vertical), NOISE), hand)
    tilt = np.degrees(np.arccos(np.clip(suggestion.R_WS[:, 2] @ upright[:, 2], -1, 1)))
    assert 30 < tilt < 150


@pytest.mark.parametrize("upright", [np.eye(3), DOWN], ids=["sensor up", "sensor down"])
def test_what_a_pose_gains_is_not_overstated_while_the_weight_is_unknown(hand, upright):
    """The base is tilted by two degrees: that much of the weight is felt, the rest is not."""
    poses = read(spun(4) @ upright)
    suggestion = suggest_pose(calibrate(poses, NOISE), hand)
    after = calibrate(poses + read(suggestion.R_WS[None], 1), NOISE)
    assert after.contact_error < 3 * suggestion.error_after


@pytest.mark.parametrize(
    "start", [spun(3), np.tile(np.eye(3), (3, 1, 1)), some(3)], ids=["spun", "same", "any"]
)
@pytest.mark.parametrize("noise", [NOISE, None], ids=["noise known", "noise estimated"])
def test_following_suggestions_leads_to_a_good_calibration(hand, start, noise):
    poses = read(start)
    steps = 0
    while (calibration := calibrate(poses, noise)).verdict.level != Level.GOOD:
        steps += 1
        assert steps <= 8
        poses += read(suggest_pose(calibration, hand).R_WS[None], steps)
    error = np.abs(calibration.model.vector - LOAD.vector) / np.sqrt(np.diag(calibration.covariance))
    assert error.max() < 5
    assert steps <= 6


def test_the_sentence_says_what_to_do_and_what_it_gains(hand):
    suggestion = suggest_pose(calibrate(read(some(5)), NOISE), hand)
    assert describe(suggestion.R_WS) in suggestion.sentence
    assert f" {plain(1e3 * suggestion.error_before)} " in suggestion.sentence
    assert f"-> {plain(1e3 * suggestion.error_after)} mm" in suggestion.sentence
    assert suggestion.joints is None


class Wall:
    """Stands for a clearance check: moves to some joints are not clear."""

    def __init__(self, blocked: np.ndarray) -> None:
        self.blocked = blocked

    def path_conflict(self, first: np.ndarray, last: np.ndarray) -> str | None:
        del first
        return "the floor" if (self.blocked == last).all(axis=1).any() else None


def behind_wall(reachable: Reachable, blocked: np.ndarray) -> Reachable:
    joints = np.arange(6.0 * len(reachable)).reshape(-1, 6) / 100
    return replace(reachable, joints=joints, start=np.zeros(6), check=Wall(joints[blocked]))


def test_a_pose_behind_a_wall_is_not_suggested(hand):
    calibration = calibrate(read(some(5)), NOISE)
    errors = errors_by_brute_force(calibration, hand.R_WS)
    blocked = np.argsort(errors)[:50]
    chosen = at(suggest_pose(calibration, behind_wall(hand, blocked)).R_WS, hand)
    assert chosen == np.argsort(errors)[50]
    with pytest.raises(InputError, match="no candidate can be reached from here by a straight joint move"):
        suggest_pose(calibration, behind_wall(hand, np.arange(len(hand))))


def test_a_light_load_that_is_known_well_is_believed(hand):
    load, quiet = replace(LOAD, gravity_W=np.array([0, 0, -0.3])), PoseNoise(0.005, 0.0002)
    calibration = calibrate(read(some(6), load=load, noise=quiet), quiet)
    assert calibration.observability.weighs
    suggestion = suggest_pose(calibration, hand)
    assert suggestion.error_after < suggestion.error_before


def test_poses_to_come_are_as_noisy_as_those_taken(hand):
    poses = read(some(24), noise=PoseNoise(0.08, 0.0032))
    calibration = calibrate(poses, NOISE)
    assert not calibration.plausible
    suggestion = suggest_pose(calibration, hand)
    wrench = calibration.model.predict(suggestion.R_WS)
    after = calibrate([*poses, PoseSample(suggestion.R_WS, wrench[:3], wrench[3:])], NOISE)
    # With one pose more the scatter is known anew; apart from that the prediction holds.
    assert after.contact_error * np.sqrt(calibration.scatter / after.scatter) == pytest.approx(
        suggestion.error_after, rel=0.05
    )


# ---- plans -------------------------------------------------------------------------------------


def test_six_planned_poses_beat_random_ones_and_the_faces_of_a_cube():
    reachable = by_hand(150)
    rng = np.random.default_rng(43)
    drawn = [plan_error(reachable.R_WS[rng.choice(150, 6, replace=False)]) for _ in range(200)]
    planned = plan_poses(6, reachable).error
    assert planned <= 0.85 * np.median(drawn)
    assert planned < min(drawn)
    assert planned < plan_error(FACES)


@pytest.mark.parametrize("count", range(3, 13))
def test_plans_of_any_size(count):
    made = plan_poses(count, by_hand(40))
    assert made.R_WS.shape == (count, 3, 3)
    assert made.errors.shape == (count,)
    assert (np.diff(made.errors) <= 1e-12).all()
    assert made.error == made.errors[-1]
    assert made.error == pytest.approx(plan_error(made.R_WS), rel=1e-6)
    assert made.joints is None
    assert made.warnings == ()
    traces = np.einsum("iab,jab->ij", made.R_WS, made.R_WS)
    assert (traces - 4 * np.eye(count)).max() < 2.999  # all different


def test_no_single_exchange_improves_a_plan(hand, plan):
    for place in range(6):
        for R_WS in hand.R_WS[::4]:
            other = plan.R_WS.copy()
            other[place] = R_WS
            assert plan_error(other) >= plan.error * (1 - 1e-5)


def test_a_planned_set_calibrates_as_predicted(plan):
    """On the load that was planned for: what is predicted is what a calibration then states."""
    load = GravityModel([0, 0, -5], [3, 2, 1], [0, 0, 0.05], [0.1, 0, 0])
    calibration = calibrate(read(plan.R_WS, load=load), NOISE)
    assert calibration.contact_error == pytest.approx(plan.error, rel=0.03)
    assert calibration.verdict.level == Level.GOOD


def test_a_plan_is_for_a_load_a_noise_and_a_task(hand, plan):
    task = ContactTask(point=np.array([0.1, 0, 0.2]), normal=np.array([1.0, 0, 0]))
    other = plan_poses(6, hand, task=task)
    assert plan_error(other.R_WS, task=task) <= plan_error(plan.R_WS, task=task)
    assert plan_error(plan.R_WS) < plan_error(other.R_WS)
    double = PoseNoise(0.1, 0.004)
    assert plan_error(plan.R_WS, noise=double) == pytest.approx(2 * plan.error, rel=1e-3)
    J = prediction_jacobian(plan.R_WS.swapaxes(1, 2), np.array([0, 0, -5, *[0] * 5, 0.05, 0, 0, 0]))
    rows = (J / NOISE.sigmas[:, None]).reshape(-1, 12)
    covariance = np.linalg.inv(rows.T @ rows + np.diag(UNKNOWN**-2))
    theta = np.array([0, 0, -5, *[0] * 5, 0.05, 0, 0, 0])
    assert ContactTask().calibration_error(theta, covariance) == pytest.approx(plan.error, rel=1e-6)


def test_a_plan_goes_the_shortest_way():
    reachable = by_hand(40, R_WS_now=np.eye(3))
    made = plan_poses(5, reachable)
    chosen = [at(R_WS, reachable) for R_WS in made.R_WS]
    between = reachable.between(chosen)
    first = reachable.travel[chosen]

    def length(order) -> float:
        return first[order[0]] + sum(between[a, b] for a, b in pairwise(order))

    assert length(range(5)) == pytest.approx(min(length(order) for order in permutations(range(5))))
    for i, j in permutations(range(5), 2):
        turn = Rotation.from_matrix(made.R_WS[i].T @ made.R_WS[j]).magnitude()
        assert between[i, j] == pytest.approx(turn, abs=1e-6)


def test_moves_that_are_not_clear_are_said(hand):
    walled = behind_wall(hand, np.arange(len(hand)))
    made = plan_poses(4, walled)
    assert len(made.warnings) == 4
    assert "move to pose 1 is not clear (the floor): go around" in made.warnings[0]
    assert plan_poses(4, behind_wall(hand, np.array([], dtype=int))).warnings == ()


def test_planning_tells_how_far_it_is_and_can_be_stopped(hand):
    told: list[tuple[int, int]] = []

    class Stop(Exception):  # noqa: N818
        pass

    def progress(done: int, total: int) -> None:
        told.append((done, total))
        if len(told) == 7:
            raise Stop

    with pytest.raises(Stop):
        plan_poses(5, hand, progress=progress)
    assert len(told) == 7
    told.clear()
    plan_poses(4, hand, progress=lambda done, total: told.append((done, total)))
    assert all(before < after for (before, _), (after, _) in pairwise(told))
    assert all(0 <= done <= total for done, total in told)
    assert len({total for _, total in told}) == 1


@pytest.mark.parametrize(
    ("count", "said"), [(2, "3 to 60 poses, not 2"), (61, "not 61"), (50, "only 40 poses")]
)
def test_plans_that_cannot_be_made_are_refused(count, said):
    with pytest.raises(InputError, match=said):
        plan_poses(count, by_hand(40))


@pytest.mark.parametrize("noise", [PoseNoise(1e-6, 1e-8), PoseNoise(1e-9, 1e-9)])
def test_plans_and_suggestions_with_hardly_any_noise(hand, noise):
    assert 0 < plan_poses(4, hand, noise=noise).error < 1e-4
    for count in (3, 5):
        assert suggest_pose(calibrate(read(spun(count), noise=noise), noise), hand).error_after < 1e-3


# ---- by hand -----------------------------------------------------------------------------------


def test_orientations_by_hand_cover_all_rotations():
    R_WS = by_hand(300).R_WS
    assert np.allclose(R_WS @ R_WS.swapaxes(1, 2), np.eye(3), atol=1e-12)
    assert np.allclose(np.linalg.det(R_WS), 1)
    traces = np.einsum("iab,jab->ij", Rotation.random(2_000, np.random.default_rng(44)).as_matrix(), R_WS)
    gaps = np.degrees(np.arccos(np.clip((traces.max(axis=1) - 1) / 2, -1, 1)))
    assert gaps.max() < 41  # 300 random rotations leave 46
    # Even in area: the z axis is as often in each of ten bands of equal height.
    assert np.histogram(R_WS[:, 2, 2], 10, (-1, 1))[0].tolist() == [30] * 10


@pytest.mark.parametrize("tilt", [0.1, 1.0, 2.5])
def test_tilt_by_hand_stays_below_its_limit(tilt):
    angles = np.arccos(np.clip(-by_hand(200, max_tilt=tilt).R_WS[:, 2, 2], -1, 1))
    assert angles.max() <= tilt
    assert angles.max() > 0.97 * tilt


def test_travel_by_hand_is_the_angle_from_here():
    here = Rotation.from_rotvec([0.3, 0.2, 0.1])
    reachable = by_hand(50, R_WS_now=here.as_matrix())
    turned = here.inv() * Rotation.from_matrix(reachable.R_WS)
    assert np.allclose(reachable.travel, turned.magnitude())
    assert not by_hand(50).travel.any()
    assert reachable.joint_vector(3) is None
    assert reachable.obstacle(None, 3) is None
    assert len(reachable) == 50


@pytest.mark.parametrize(
    ("wrong", "said"),
    [
        ({"count": 11}, "at least 12"),
        ({"max_tilt": 0.0}, "tilt"),
        ({"max_tilt": 3.2}, "tilt"),
        ({"max_tilt": np.nan}, "tilt"),
    ],
)
def test_orientations_by_hand_that_make_no_sense_are_refused(wrong, said):
    with pytest.raises(InputError, match=said):
        by_hand(**wrong)


@pytest.mark.parametrize(
    ("turn", "words"),
    [
        ((180, 0, 0), ["sensor z straight down"]),
        ((0, 0, 30), ["sensor z straight up"]),
        (
            (120, 0, 0),
            ["z 60° from straight down", "bearing 270°", "-y axis lowest (30° from straight down)"],
        ),
        ((0, 90, 0), ["z 90° from straight down", "bearing 0°", "+x axis lowest (0° from straight down)"]),
        ((-150, 0, 0), ["z 30° from straight down", "bearing 90°", "+z axis lowest (30°"]),
    ],
)
def test_orientations_in_words(turn, words):
    text = describe(Rotation.from_rotvec(turn, degrees=True).as_matrix())
    assert all(word in text for word in words), text


# ---- by a robot --------------------------------------------------------------------------------


@pytest.mark.parametrize("wrist_only", [True, False])
def test_what_a_robot_reaches(elfin, wrist_only):
    R_ES = Rotation.from_rotvec([0, 0, 0.7]).as_matrix()
    R_WB = Rotation.from_rotvec([0.2, 0, 0]).as_matrix()
    reachable = by_robot(elfin, ARM, R_ES=R_ES, R_WB=R_WB, count=20, wrist_only=wrist_only)
    assert 12 <= len(reachable) <= 20
    assert elfin.within_limits(reachable.joints).all()
    for index, (R_WS, joints) in enumerate(zip(reachable.R_WS, reachable.joints, strict=True)):
        R_BE, _ = elfin.flange_pose(joints)
        assert np.allclose(R_WS, R_WB @ R_BE @ R_ES, atol=1e-12)
        assert reachable.travel[index] == pytest.approx(elfin.travel(ARM, joints))
        assert reachable.joint_vector(index) is not None
    assert np.array_equal(reachable.joints[:, :3], np.tile(ARM[:3], (len(reachable), 1))) is wrist_only
    between = reachable.between([0, 3, 5])
    assert between[1, 2] == pytest.approx(elfin.travel(reachable.joints[3], reachable.joints[5]))
    plain = by_robot(elfin, ARM, count=20, wrist_only=wrist_only)
    assert np.allclose(R_WB @ plain.R_WS @ R_ES, reachable.R_WS)


def test_a_plan_and_a_suggestion_for_a_robot(elfin):
    reachable = by_robot(elfin, ARM, count=60)
    made = plan_poses(5, reachable)
    assert made.joints.shape == (5, 6)
    assert elfin.within_limits(made.joints).all()
    assert np.allclose(elfin.flange_rotations(made.joints), made.R_WS)
    suggestion = suggest_pose(calibrate(read(made.R_WS[:3]), NOISE), reachable)
    assert np.allclose(elfin.flange_rotations(suggestion.joints[None])[0], suggestion.R_WS)
    assert suggestion.travel == pytest.approx(elfin.travel(ARM, suggestion.joints))
    assert reachable.check.path_conflict(ARM, suggestion.joints) is None
    for number, (here, there) in enumerate(zip(ARM, suggestion.joints, strict=True), 1):
        moved = abs(there - here) > np.radians(0.5)
        assert (f"joint {number} to {np.degrees(there):.0f}°" in suggestion.sentence) is bool(moved)
