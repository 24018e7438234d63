"""A probe in soft tissue: the bed of springs is one."""

import numpy as np
import pytest

from contactbench import assets
from contactbench.pipeline.contact import Reason, WrenchNoise
from contactbench.pipeline.contact.footprint import spread
from contactbench.pipeline.contact.methods import make
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.mesh import Probe
from contactbench.pipeline.simulation.scenes import (
    Motion,
    Payload,
    PressScene,
    Tissue,
    TrueSurface,
    depth_for,
    hand_motion,
)

_G = 9.80665


def _still(*pose: float) -> Motion:
    nothing = np.zeros((1, 6))
    return Motion(np.array(pose), nothing, nothing, nothing)


def _weight(payload: Payload, R_WS: np.ndarray) -> np.ndarray:
    force = R_WS.T @ [0, 0, -payload.mass * _G]
    return np.concatenate([force, np.cross(payload.centre_of_mass_S, force)])


def test_tissue_pushes_with_depth_times_modulus_times_area(truth: TrueSurface) -> None:
    tissue = Tissue()
    scene = PressScene(truth, motion=_still(0, 0, -0.004, 0, 0, 0), tissue=tissue)
    scene.advance(0.6)
    moment = scene.moment()
    depth = -sum(contact.dist for contact in scene.data.contact)
    assert -moment.contact[2] == pytest.approx(depth * scene.area * tissue.modulus, rel=1e-4)
    np.testing.assert_allclose(moment.reading, moment.contact + _weight(Payload(), np.eye(3)), atol=1e-6)


def test_the_force_hardly_depends_on_how_many_places_feel_it(truth: TrueSurface) -> None:
    pushes = []
    for places in (100, 300):
        scene = PressScene(truth, motion=_still(0, 0, -0.004, 0.02, 0.05, 0), places=places)
        scene.advance(0.4)
        pushes.append(scene.moment().contact[2])
    assert pushes[0] == pytest.approx(pushes[1], rel=0.08)


def test_a_tilted_phantom_is_felt_where_it_is_deep(truth: TrueSurface) -> None:
    moments = []
    for angle in (-0.05, 0.05):
        scene = PressScene(truth, motion=_still(0, 0, -0.003, 0, angle, 0), tissue=Tissue(friction=0.0))
        scene.advance(0.4)
        moments.append(scene.moment())
    # Turned about +y, the tissue comes down where x is positive.
    assert moments[0].centroid_S[0] < -0.003 < 0.003 < moments[1].centroid_S[0]
    push = moments[1].contact[:3] / moments[1].force
    np.testing.assert_allclose(push, [-np.sin(0.05), 0, -np.cos(0.05)], atol=2e-3)


def test_half_the_step_moves_the_contact_by_less_than_a_twentieth_of_a_millimetre(truth: TrueSurface) -> None:
    points = []
    for step in (0.001, 0.0005):
        scene = PressScene(truth, motion=hand_motion(1), step=step)
        scene.advance(0.5)
        points.append(scene.moment().centroid_S)
    assert np.linalg.norm(points[1] - points[0]) < 5e-5


def _convex() -> TrueSurface:
    vertices, faces = assets.make("convex", 6_000)
    return TrueSurface(Probe.from_arrays(vertices, faces, name="convex"))


def test_the_wrench_is_the_sum_of_forces_at_places_on_the_probe() -> None:
    truth = _convex()
    scene = PressScene(truth, motion=hand_motion(1))
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
    scene = PressScene(truth, motion=hand_motion(1))
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
        scene = PressScene(probe, motion=_still(0, 0, -depth_for(probe, 7.0), 0, 0, 0))
        scene.advance(0.5)
        assert scene.moment().force == pytest.approx(7.0, rel=0.05)
    motion = hand_motion(1, depth=depth_for(truth, 7.0, motion=hand_motion(1)))
    scene = PressScene(truth, motion=motion)
    scene.advance(0.5)
    forces = []
    for _ in range(60):
        scene.advance(0.1)
        forces.append(scene.moment().force)
    assert np.mean(forces) == pytest.approx(7.0, rel=0.1)  # six seconds of a minute


@pytest.mark.parametrize(
    ("force", "message"), [(0.0, "positive force"), (float("nan"), "positive"), (1e4, "pushes with")]
)
def test_a_force_that_tissue_does_not_give_has_no_depth(
    truth: TrueSurface, force: float, message: str
) -> None:
    with pytest.raises(InputError, match=message):
        depth_for(truth, force)
    with pytest.raises(InputError, match="alone presses harder"):
        depth_for(truth, 0.01, motion=hand_motion(1, heave=0.01))


def test_places_cover_the_face_evenly_and_lie_on_it(truth: TrueSurface) -> None:
    places, normals, area = spread(truth.probe, 100)
    assert 70 <= len(places) <= 140
    for place, normal in zip(places[::10], normals[::10], strict=True):
        nearest, outward = truth.nearest(place)
        np.testing.assert_allclose(nearest, place, atol=1e-9)
        assert normal @ outward > 0.9
    # The T's face seen from above: some 80 mm by 20 mm, its corners rounded.
    assert area * len(places) == pytest.approx(80e-3 * 20e-3, rel=0.12)


def test_a_hand_stays_within_what_was_said() -> None:
    motion = hand_motion(2, depth=0.004, heave=0.002, slide=0.004, turn=0.1, tremor=0.0)
    poses = np.array([motion.at(time) for time in np.linspace(0, 60, 4000)])
    assert np.abs(poses[:, :2]).max() <= 0.004
    assert np.abs(poses[:, 2] + 0.004).max() <= 0.002
    assert 0.02 < np.abs(poses[:, 3:5]).max() <= 0.1


@pytest.mark.parametrize("wrong", [{"modulus": 0.0}, {"friction": -1.0}, {"damping": float("inf")}])
def test_tissue_that_cannot_be_is_refused(wrong: dict) -> None:
    with pytest.raises(InputError, match="tissue"):
        Tissue(**wrong)


def test_a_motion_that_cannot_be_is_refused() -> None:
    with pytest.raises(InputError, match="hand motion"):
        hand_motion(depth=-1.0)


def test_every_bundled_probe_can_be_pressed() -> None:
    for name in assets.PROBE_NAMES:
        vertices, faces = assets.make(name, 2_000)
        scene = PressScene(TrueSurface(Probe.from_arrays(vertices, faces, name=name)))
        scene.advance(0.1)
        assert scene.moment().force > 0.5
