"""A probe in soft tissue: the bed of springs is one."""

import numpy as np
import pytest
from press_scene import PressScene, depth_for, hand, still
from scipy.spatial.transform import Rotation

from contactbench import assets
from contactbench.pipeline.contact import Reason, WrenchNoise
from contactbench.pipeline.contact.methods import make
from contactbench.pipeline.contact.patch import spread
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.mesh import Probe
from contactbench.pipeline.simulation.scenes.indenter import BenchScene, TipPress
from contactbench.pipeline.simulation.scenes.physics import Payload, PhysicsError, TrueSurface
from contactbench.pipeline.simulation.scenes.platform import Tissue

_G = 9.80665


def _weight(payload: Payload, R_WS: np.ndarray) -> np.ndarray:
    force = R_WS.T @ [0, 0, -payload.mass * _G]
    return np.concatenate([force, np.cross(payload.centre_of_mass_S, force)])


def test_tissue_pushes_with_depth_times_modulus_times_area(truth: TrueSurface) -> None:
    tissue = Tissue()
    scene = PressScene(truth, still(0, 0, -0.004, 0, 0, 0), tissue=tissue)
    scene.advance(0.6)
    moment = scene.moment()
    depth = -sum(contact.dist for contact in scene.data.contact)
    assert -moment.contact[2] == pytest.approx(depth * scene.area * tissue.modulus, rel=1e-4)
    np.testing.assert_allclose(moment.reading, moment.contact + _weight(Payload(), np.eye(3)), atol=1e-6)


def test_the_force_hardly_depends_on_how_many_places_feel_it(truth: TrueSurface) -> None:
    pushes = []
    for places in (100, 300):
        scene = PressScene(truth, still(0, 0, -0.004, 0.02, 0.05, 0), places=places)
        scene.advance(0.4)
        pushes.append(scene.moment().contact[2])
    assert pushes[0] == pytest.approx(pushes[1], rel=0.08)


def test_a_tilted_phantom_is_felt_where_it_is_deep(truth: TrueSurface) -> None:
    moments = []
    for angle in (-0.05, 0.05):
        scene = PressScene(truth, still(0, 0, -0.003, 0, angle, 0), tissue=Tissue(friction=0.0))
        scene.advance(0.4)
        moments.append(scene.moment())
    # Turned about +y, the tissue comes down where x is positive.
    assert moments[0].centroid_S[0] < -0.003 < 0.003 < moments[1].centroid_S[0]
    push = moments[1].contact[:3] / moments[1].force
    np.testing.assert_allclose(push, [-np.sin(0.05), 0, -np.cos(0.05)], atol=2e-3)


def test_half_the_step_moves_the_contact_by_less_than_a_twentieth_of_a_millimetre(truth: TrueSurface) -> None:
    points = []
    for step in (0.001, 0.0005):
        scene = PressScene(truth, hand(), step=step)
        scene.advance(0.5)
        points.append(scene.moment().centroid_S)
    assert np.linalg.norm(points[1] - points[0]) < 5e-5


def _convex() -> TrueSurface:
    vertices, faces = assets.make("convex", 6_000)
    return TrueSurface(Probe.from_arrays(vertices, faces, name="convex"))


def test_the_wrench_is_the_sum_of_forces_at_places_on_the_probe() -> None:
    truth = _convex()
    scene = PressScene(truth, hand())
    scene.advance(0.7)
    moment = scene.moment()
    places, _, _ = spread(truth.probe, 100)
    body = scene.model.geom_bodyid
    felt = dict(zip(np.flatnonzero(body == scene.model.body("probe").id), places, strict=True))
    local, net = np.zeros(6), np.zeros(6)
    for index, contact in enumerate(scene.data.contact):
        scene.mujoco.mj_contactForce(scene.model, scene.data, index, local)
        sign, place = (1.0, felt[contact.geom2]) if contact.geom2 in felt else (-1.0, felt[contact.geom1])
        force = sign * contact.frame.reshape(3, 3).T @ local[:3]
        net += np.concatenate([force, np.cross(place, force)])
        # MuJoCo's own place is half the penetration off, and up to the ball's radius to the side.
        assert np.linalg.norm(contact.pos - place) <= 0.5 * abs(contact.dist) + 1e-3
    assert np.linalg.norm(net[:2]) > 0.3  # without friction all places along the normal would do
    np.testing.assert_allclose(moment.contact, net, atol=1e-9)
    np.testing.assert_allclose(moment.reading, moment.contact + _weight(Payload(), np.eye(3)), atol=1e-6)


def test_location_without_noise_finds_the_point_of_the_truth() -> None:
    truth = _convex()
    scene = PressScene(truth, hand())
    scene.advance(0.5)
    moments = []
    for _ in range(25):
        scene.advance(0.1)
        moments.append(scene.moment())
    method = make("contactbench", truth.probe, WrenchNoise(0.05, 0.0014))
    found = method.locate_batch(np.array([moment.contact for moment in moments]))
    sure = np.isin(found.reasons, (Reason.OK, Reason.VERTEX))
    assert sure.mean() > 0.8
    off = np.linalg.norm(found.points - [moment.point_S for moment in moments], axis=1)[sure]
    assert np.sqrt((off**2).mean()) < 1e-4


def test_a_wanted_force_has_its_depth(truth: TrueSurface) -> None:
    for probe in (truth, _convex()):
        scene = PressScene(probe, still(0, 0, -depth_for(probe, 7.0), 0, 0, 0))
        scene.advance(0.5)
        assert scene.moment().force == pytest.approx(7.0, rel=0.05)


def test_places_cover_the_face_evenly_and_lie_on_it(truth: TrueSurface) -> None:
    places, normals, area = spread(truth.probe, 100)
    assert 70 <= len(places) <= 140
    for place, normal in zip(places[::10], normals[::10], strict=True):
        nearest, outward = truth.nearest(place)
        np.testing.assert_allclose(nearest, place, atol=1e-9)
        assert normal @ outward > 0.9
    # The T's face seen from above: some 80 mm by 20 mm, its corners rounded.
    assert area * len(places) == pytest.approx(80e-3 * 20e-3, rel=0.12)


@pytest.mark.parametrize("wrong", [{"modulus": 0.0}, {"friction": -1.0}, {"damping": float("inf")}])
def test_tissue_that_cannot_be_is_refused(wrong: dict) -> None:
    with pytest.raises(InputError, match="tissue"):
        Tissue(**wrong)


def test_every_bundled_probe_can_be_pressed() -> None:
    for name in assets.PROBE_NAMES:
        vertices, faces = assets.make(name, 2_000)
        scene = PressScene(TrueSurface(Probe.from_arrays(vertices, faces, name=name)), hand())
        scene.advance(0.1)
        assert scene.moment().force > 0.5


# ---- the wrist -----------------------------------------------------------------------------------


_MARKER = np.array([0.02, 0.0, 0.13])


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
    scene = BenchScene(truth, R_WS=Rotation.from_euler("y", 90, degrees=True).as_matrix())
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
