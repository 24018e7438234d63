import numpy as np
import pytest

from contactbench.pipeline.calibration import GravityModel
from contactbench.pipeline.control.controller import Inertia
from contactbench.pipeline.control.inverse import CartesianMount
from contactbench.pipeline.simulation.marker_touches import truth_of
from contactbench.pipeline.simulation.scenes import Payload
from contactbench.pipeline.simulation.scenes.platform import PlatformScene

PAYLOAD = Payload()


def gravity_of(payload):
    return GravityModel([0, 0, -payload.mass * 9.80665], np.zeros(3), payload.centre_of_mass_S, np.zeros(3))


@pytest.mark.parametrize("gyration", [PAYLOAD.gyration, 0.0])
def test_a_tool_that_is_shaken_in_the_air_feels_nothing(gyration):
    scene = PlatformScene(truth_of("convex"), payload=PAYLOAD, gap=0.2, step=0.001, places=20)
    arm, gravity = CartesianMount(), gravity_of(PAYLOAD)
    inertia = Inertia(gravity, gyration)
    raw, left = [], []
    for k in range(60):
        wrenches = []
        for _ in range(4):
            scene.advance(0.005)
            moment = scene.moment()
            wrenches.append(gravity.compensate(moment.R_WS, moment.reading))
        R, p = arm.flange_pose(scene.joints)
        inertia.moved(R, p)
        if k > 5:
            raw.append(np.mean(wrenches, axis=0))
            left.append(raw[-1] + inertia.wrench(R, 0.02))
        # About the tip, as a controller does.
        turn = 0.05 * np.sin(0.5 * k)
        scene.command(scene.start + [0.14 * turn, 0, 0.003 * np.cos(0.4 * k), 0, turn, 0])
    sizes, rest = np.std(raw, axis=0), np.std(left, axis=0)
    assert sizes[0] > 0.5, "it is shaken"
    assert rest[0] < 0.5 * sizes[0]
    assert rest[2] < 0.5 * sizes[2]
    # Without the tool's own turning the torque keeps that part.
    assert rest[4] < (0.5 if gyration else 0.8) * sizes[4]


def test_at_rest_and_at_first_there_is_none():
    inertia = Inertia(gravity_of(PAYLOAD), 0.04)
    np.testing.assert_array_equal(inertia.wrench(np.eye(3), 0.02), np.zeros(6))
    for _ in range(3):
        inertia.moved(np.eye(3), np.ones(3))
    np.testing.assert_allclose(inertia.wrench(np.eye(3), 0.02), np.zeros(6), atol=1e-9)
