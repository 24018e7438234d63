"""The smallest scene against what statics says, and against an independent sum over its contacts."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from contactbench.pipeline.errors import InputError
from contactbench.pipeline.simulation.scenes.indenter import STEP_S, Tip, TipPress, TouchScene
from contactbench.pipeline.simulation.scenes.physics import Payload, TrueSurface

_G = 9.80665


def _places(truth: TrueSurface, count: int, seed: int) -> np.ndarray:
    head = np.flatnonzero(truth.probe.vertices[truth.probe.faces][:, :, 2].min(axis=1) > 0.09)
    chosen = np.random.default_rng(seed).choice(head, count, replace=False)
    return truth.probe.vertices[truth.probe.faces[chosen]].mean(axis=1)


def _sum_over_contacts(scene: TouchScene) -> tuple[np.ndarray, np.ndarray]:
    """Net wrench on the probe about the sensor, and the force-weighted mean place, from each contact's own force."""
    net, place, weight = np.zeros(6), np.zeros(3), 0.0
    local = np.zeros(6)
    R, p = scene.data.site_xmat[0].reshape(3, 3), scene.data.site_xpos[0]
    tip = scene.model.body("other").id
    for index in range(scene.data.ncon):
        contact = scene.data.contact[index]
        scene.mujoco.mj_contactForce(scene.model, scene.data, index, local)
        frame = contact.frame.reshape(3, 3)
        # The force is on the second geom, along the normal from the first one.
        sign = -1.0 if scene.model.geom_bodyid[contact.geom2] == tip else 1.0
        force, torque = sign * frame.T @ local[:3], sign * frame.T @ local[3:]
        at = R.T @ (contact.pos - p)
        net += np.concatenate([R.T @ force, R.T @ torque + np.cross(at, R.T @ force)])
        size = np.linalg.norm(force)
        place, weight = place + size * at, weight + size
    return net, place / weight


@pytest.mark.parametrize(
    "press", [TipPress(9), TipPress(9, 30, 0, 0.004), TipPress(10, 30, 90, -0.004), TipPress(1, 10)]
)
def test_at_rest_the_sensor_reads_contact_and_weight(truth: TrueSurface, press: TipPress) -> None:
    payload = Payload(0.6, np.array([0.01, 0.0, 0.05]))
    for number, place in enumerate(_places(truth, 4, 5)):
        R_WS = Rotation.random(rng=np.random.default_rng(number)).as_matrix()
        scene = TouchScene(truth, place, payload=payload, R_WS=R_WS)
        scene.press(press)
        moment = scene.settle()
        assert moment is not None
        weight = R_WS.T @ [0, 0, -payload.mass * _G]
        weight = np.concatenate([weight, np.cross(payload.centre_of_mass_S, weight)])
        np.testing.assert_allclose(moment.reading, moment.contact + weight, atol=1e-9)
        assert moment.force == pytest.approx(press.force, abs=1e-3)
        assert moment.torsion == pytest.approx(press.torsion, abs=2e-4)


def test_the_truth_is_the_sum_over_the_contacts(truth: TrueSurface) -> None:
    for place in _places(truth, 6, 8):
        scene = TouchScene(truth, place)
        scene.press(TipPress(8, 20, 45, 0.002))
        moment = scene.settle()
        assert moment is not None
        net, centroid = _sum_over_contacts(scene)
        np.testing.assert_allclose(moment.contact, net, atol=1e-9)
        np.testing.assert_allclose(moment.centroid_S, centroid, atol=1e-9)


def test_a_perpendicular_touch_is_at_the_marker_and_a_tilted_one_sticks(truth: TrueSurface) -> None:
    for place in _places(truth, 4, 2):
        for tilt in (0.0, 30.0):
            scene = TouchScene(truth, place)
            scene.press(TipPress(9, tilt))
            moment = scene.settle()
            assert moment is not None
            assert np.linalg.norm(moment.point_S - scene.marker_S) < 2e-5
            cosine = -moment.contact[:3] @ moment.normal_S / moment.force
            angle = np.degrees(np.arccos(min(cosine, 1.0)))  # rounding can pass 1
            assert angle == pytest.approx(tilt, abs=3.0)  # the surface turns between facets


def test_half_the_step_moves_the_contact_by_less_than_a_twentieth_of_a_millimetre(truth: TrueSurface) -> None:
    for place in _places(truth, 3, 4):
        points = []
        for step in (STEP_S, STEP_S / 2):
            scene = TouchScene(truth, place, step=step)
            scene.press(TipPress(9, 30, 90, 0.003))
            moment = scene.settle()
            assert moment is not None
            points.append(moment.point_S)
        assert np.linalg.norm(points[1] - points[0]) < 5e-5


def test_a_tip_without_enough_friction_slips_and_says_so(truth: TrueSurface) -> None:
    scene = TouchScene(truth, _places(truth, 1, 1)[0], tip=Tip(friction=0.2))
    scene.press(TipPress(9, 30))
    assert scene.settle() is None


def test_in_the_air_there_is_no_contact(truth: TrueSurface) -> None:
    scene = TouchScene(truth, _places(truth, 1, 1)[0])
    scene.advance(0.1)
    moment = scene.moment()
    assert (moment.contacts, moment.force) == (0, 0.0)
    assert np.isnan(moment.point_S).all()


def test_a_lifted_tip_lets_go(truth: TrueSurface) -> None:
    scene = TouchScene(truth, _places(truth, 1, 1)[0])
    scene.press(TipPress(9))
    assert scene.settle() is not None
    scene.press(TipPress(0))
    scene.advance(1.0)
    assert scene.moment().contacts == 0


def test_the_same_touch_gives_the_same_bytes(truth: TrueSurface) -> None:
    readings = []
    for _ in range(2):
        scene = TouchScene(truth, _places(truth, 1, 6)[0])
        scene.press(TipPress(9, 30, 10, 0.001))
        scene.advance(0.4)
        readings.append(scene.moment().reading.tobytes())
    assert readings[0] == readings[1]


def test_a_place_off_the_probe_aims_at_its_nearest_point(truth: TrueSurface) -> None:
    scene = TouchScene(truth, [0.0, 0.0, 0.3])
    assert scene.marker_S[2] == pytest.approx(truth.probe.vertices[:, 2].max(), abs=1e-4)


@pytest.mark.parametrize(
    "wrong",
    [{"force": -1.0}, {"torsion": 11.0}, {"torsion": float("nan")}, {"tilt": 90.0}, {"force": float("nan")}],
)
def test_a_press_that_cannot_be_is_refused(wrong: dict) -> None:
    with pytest.raises(InputError, match="press"):
        TipPress(**wrong)
