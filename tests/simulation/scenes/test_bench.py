"""The wrist: where it is told to be, what the sensor reads there, and what a push does to it."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from contactbench.pipeline.errors import InputError
from contactbench.pipeline.simulation.scenes import BenchScene, Payload, PhysicsError, TipPress, TrueSurface

_G = 9.80665
_MARKER = np.array([0.02, 0.0, 0.13])


def _weight(payload: Payload, R_WS: np.ndarray) -> np.ndarray:
    force = R_WS.T @ [0, 0, -payload.mass * _G]
    return np.concatenate([force, np.cross(payload.centre_of_mass_S, force)])


def _angle(A: np.ndarray, B: np.ndarray) -> float:
    return float(Rotation.from_matrix(A.T @ B).magnitude())


def test_it_goes_where_it_is_told_and_reads_the_weight_there(truth: TrueSurface) -> None:
    payload = Payload(0.6, np.array([0.01, 0.0, 0.05]))
    scene = BenchScene(truth, payload=payload)
    for seed in range(2):
        R_WS = Rotation.random(rng=np.random.default_rng(seed)).as_matrix()
        scene.advance(scene.turn_to(R_WS) + 0.2)
        moment = scene.moment()
        assert _angle(moment.R_WS, R_WS) < 1e-6
        np.testing.assert_allclose(moment.reading, _weight(payload, R_WS), atol=1e-6)


def test_while_it_turns_the_sensor_feels_the_inertia(truth: TrueSurface) -> None:
    payload = Payload(1.0, np.array([0.0, 0.0, 0.1]))
    scene = BenchScene(truth, payload=payload)
    scene.turn_to(Rotation.from_euler("x", 90, degrees=True).as_matrix(), 0.5)
    scene.advance(0.25)  # the fastest: angular speed 15/8 of the mean, no angular acceleration
    moment = scene.moment()
    speed = np.pi / 2 / 0.5 * 15 / 8
    extra = moment.reading - _weight(payload, moment.R_WS)
    # What holds the mass on its circle pulls inwards, so the sensor feels it outwards.
    np.testing.assert_allclose(extra[:3], [0, 0, 1.0 * 0.1 * speed**2], atol=0.04)


def test_a_touch_in_any_orientation(truth: TrueSurface) -> None:
    payload = Payload()
    R_WS = Rotation.from_euler("xyz", [150, 20, 70], degrees=True).as_matrix()
    scene = BenchScene(truth, payload=payload, R_WS=R_WS)
    point = scene.aim(_MARKER)
    scene.press(TipPress(9, 30, 90, 0.002))
    scene.advance(0.8)
    moment = scene.moment()
    assert moment.force == pytest.approx(9, abs=2e-3)
    assert np.linalg.norm(moment.point_S - point) < 2e-4  # the wrist yields a little
    assert _angle(moment.R_WS, R_WS) < np.radians(0.1)
    np.testing.assert_allclose(moment.reading, moment.contact + _weight(payload, moment.R_WS), atol=1e-3)


def test_time_and_wrist_go_on_when_the_tip_comes_and_goes(truth: TrueSurface) -> None:
    R_WS = Rotation.from_euler("x", 40, degrees=True).as_matrix()
    scene = BenchScene(truth, R_WS=R_WS)
    scene.advance(0.1)
    scene.aim(_MARKER)
    scene.advance(0.1)
    scene.release()
    assert scene.time == pytest.approx(0.2)
    assert _angle(scene.moment().R_WS, R_WS) < 1e-6
    assert scene.moment().contacts == 0


def test_a_bump_is_felt_and_over(truth: TrueSurface) -> None:
    payload = Payload()
    scene = BenchScene(truth, payload=payload)
    scene.bump([5.0, 0, 0], 0.3, [0, 0, 0.1])
    scene.advance(0.2)
    felt = scene.moment().reading - _weight(payload, scene.moment().R_WS)
    np.testing.assert_allclose(felt, [5, 0, 0, 0, 0.5, 0], atol=0.02)
    scene.advance(0.5)
    np.testing.assert_allclose(scene.moment().reading, _weight(payload, np.eye(3)), atol=1e-4)


def test_the_path_of_a_turn_is_smooth_from_the_one_orientation_to_the_other(truth: TrueSurface) -> None:
    begin, end = (Rotation.from_euler("xyz", rpy, degrees=True) for rpy in ([10, 20, 0], [30, -50, 20]))
    scene = BenchScene(truth, R_WS=begin.as_matrix())
    scene.turn_to(end.as_matrix(), 0.4)
    for share in (0.25, 0.5, 0.75):
        scene.advance(0.1)
        done = share**3 * (10 + share * (-15 + 6 * share))
        wanted = begin * Rotation.from_rotvec(done * (begin.inv() * end).as_rotvec())
        # What holds the wrist is that of the step before: half a millisecond's worth.
        assert _angle(scene.moment().R_WS, wanted.as_matrix()) < 1e-3


def test_the_wrist_is_held_at_the_moment_when_the_tip_comes_or_goes(truth: TrueSurface) -> None:
    R_WS = Rotation.from_euler("y", 90, degrees=True).as_matrix()
    scene = BenchScene(truth, R_WS=R_WS)
    scene.advance(0.1)
    for act in (lambda: scene.aim(_MARKER), scene.release):
        act()
        moment = scene.moment()
        np.testing.assert_allclose(moment.reading, _weight(Payload(), moment.R_WS), atol=1e-4)


def test_physics_that_comes_apart_is_an_error_and_no_file(truth: TrueSurface, tmp_path, monkeypatch) -> None:
    monkeypatch.chdir(tmp_path)
    scene = BenchScene(truth)
    scene.data.qvel[0] = 1e20
    with pytest.raises(PhysicsError, match=r"diverged \(BADQVEL"):
        scene.step()
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("degrees", [5.0, 180.0])
def test_a_turn_faster_than_any_arm_is_refused_and_the_fastest_is_sound(
    truth: TrueSurface, degrees: float
) -> None:
    R_WS = Rotation.from_euler("x", degrees, degrees=True).as_matrix()
    scene = BenchScene(truth)
    with pytest.raises(InputError, match="too fast for an arm") as error:
        scene.turn_to(R_WS, 0.01)
    fastest = float(str(error.value).split("give ")[1].split(" s")[0])
    scene.turn_to(R_WS, fastest + 0.001)
    scene.advance(0.4)
    assert _angle(scene.moment().R_WS, R_WS) < 1e-4


def test_what_cannot_be_is_refused(truth: TrueSurface) -> None:
    scene = BenchScene(truth)
    with pytest.raises(InputError, match="rotation matrix"):
        scene.turn_to(np.ones((3, 3)))
    with pytest.raises(InputError, match="not a valid duration"):
        scene.turn_to(np.eye(3), -1.0)
    with pytest.raises(InputError, match="no target"):
        scene.press(TipPress(5))
    with pytest.raises(InputError, match="a bump"):
        scene.bump([1, 2], 0.1)
    with pytest.raises(InputError, match="at most 1000 N"):
        scene.bump([1e4, 0, 0], 0.1)
    scene.aim(_MARKER)
    with pytest.raises(InputError, match="release"):
        scene.turn_to(np.eye(3))
