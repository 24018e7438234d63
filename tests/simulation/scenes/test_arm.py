"""The probe on an arm over a moving phantom: the chain is the arm's, its limits hold, the sensor feels everything."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from contactbench.pipeline.errors import InputError
from contactbench.pipeline.robot import Clearance, ClearanceCheck
from contactbench.pipeline.simulation.scenes.arm import ArmScene
from contactbench.pipeline.simulation.scenes.physics import Payload, TrueSurface
from contactbench.pipeline.simulation.scenes.platform import DOWN, PlatformMotion, PlatformScene, Tissue
from contactbench.pipeline.simulation.scenes.setpoints import ServoSettings

_G = np.array([0.0, 0.0, -9.80665])
_PERIOD = 0.02
_R_ES = Rotation.from_euler("xyz", [0.02, -0.03, 0.7]).as_matrix()
_P_ES_E = np.array([0.003, -0.002, 0.03])


def _weight(payload: Payload, R_BS: np.ndarray) -> np.ndarray:
    force = R_BS.T @ (payload.mass * _G)
    return np.concatenate([force, np.cross(payload.centre_of_mass_S, force)])


def _held(scene: ArmScene, seconds: float) -> None:
    for _ in range(round(seconds / _PERIOD)):
        scene.command(scene.start)
        scene.advance(_PERIOD)


def test_it_begins_above_the_phantom_pointing_down(truth: TrueSurface) -> None:
    scene = ArmScene(truth, R_ES=_R_ES, p_ES_E=_P_ES_E, gap=0.004)
    np.testing.assert_allclose(scene.angles(), 0, atol=1e-9)
    R_BE, p_BE_B = scene.robot.flange_pose(scene.start)
    R_BS = R_BE @ scene.R_ES
    np.testing.assert_allclose(R_BS, scene.T_BP[:3, :3] @ DOWN, atol=1e-9)
    top = truth.probe.vertices[:, 2].max()
    tip = p_BE_B + R_BE @ scene.p_ES_E + R_BS @ [0, 0, top]
    np.testing.assert_allclose(tip - scene.surface()[0], [0, 0, 0.004], atol=1e-9)


def test_the_sensor_is_where_the_kinematics_say_at_any_joints(truth: TrueSurface) -> None:
    scene = ArmScene(truth, R_ES=_R_ES, p_ES_E=_P_ES_E)
    q = np.array([0.5, -0.4, 1.1, 0.6, -0.7, 0.9])
    scene.data.qpos[:6] = q
    moment = scene.moment()
    R_BE, p_BE_B = scene.robot.flange_pose(q)
    np.testing.assert_allclose(moment.R_WS, R_BE @ _R_ES, atol=1e-9)
    np.testing.assert_allclose(scene.data.site("S").xpos, p_BE_B + R_BE @ _P_ES_E, atol=1e-9)


def test_gravity_bends_nothing_and_the_motors_hold_the_weight(truth: TrueSurface) -> None:
    scene = ArmScene(truth)
    _held(scene, 0.4)
    np.testing.assert_allclose(scene.true_joints, scene.start, atol=1e-7)
    # The second joint holds what hangs in front of it: mass times lever, by the virtual work of a small turn.
    centres = []
    for angle in (-1e-4, 1e-4):
        scene.data.qpos[:6] = scene.start + angle * np.eye(6)[1]
        scene.mujoco.mj_forward(scene.model, scene.data)
        arm = [scene.model.body(joint.name).id for joint in scene.robot.description.joints]
        bodies = [*arm, scene.model.body("probe").id]
        centres.append(scene.model.body_mass[bodies] @ scene.data.xipos[bodies, 2])
    lifted = 9.80665 * (centres[1] - centres[0]) / 2e-4
    assert abs(lifted) > 5
    assert scene.torques[1] == pytest.approx(lifted, rel=1e-3)


def test_at_rest_it_reads_contact_and_weight(truth: TrueSurface) -> None:
    payload = Payload(0.6, np.array([0.01, -0.004, 0.05]))
    scene = ArmScene(truth, payload=payload, R_ES=_R_ES, gap=-0.002)
    _held(scene, 0.8)
    moment = scene.moment()
    assert moment.contact[2] < -2.0
    np.testing.assert_allclose(moment.reading, moment.contact + _weight(payload, moment.R_WS), atol=1e-3)


def test_a_push_bends_the_arm_for_a_moment_and_the_encoders_see_it(truth: TrueSurface) -> None:
    scene = ArmScene(truth, gap=-0.002, servo=ServoSettings(counts=2**20))
    raised = []
    for _ in range(40):
        _held(scene, _PERIOD)
        raised.append(
            scene.robot.flange_pose(scene.joints)[1][2] - scene.robot.flange_pose(scene.start)[1][2]
        )
    assert 1e-5 < max(raised) < 1e-3
    assert abs(raised[-1]) < 1e-5
    np.testing.assert_allclose(scene.joints, scene.true_joints, atol=np.pi / 2**20 + 1e-12)


@pytest.mark.parametrize("scene_of", [PlatformScene, ArmScene])
def test_a_pressed_phantom_hardly_yields_wherever_it_stands(truth: TrueSurface, scene_of: type) -> None:
    scene = scene_of(truth, gap=-0.002, tissue=Tissue(friction=0.0))
    _held(scene, 0.6)
    point, normal = scene.surface()
    np.testing.assert_allclose(point, scene.T_BP[:3, 3], atol=2e-4)
    np.testing.assert_allclose(normal, [0, 0, 1], atol=1e-4)
    np.testing.assert_allclose(scene.angles(), 0, atol=1e-4)


def test_the_same_tilt_means_the_same_as_on_the_mount(truth: TrueSurface) -> None:
    motion = PlatformMotion(np.array([0, 0, 0, 0.04, -0.06, 0]), 4.0)
    angles = []
    for scene in (PlatformScene(truth, motion=motion, gap=0.03), ArmScene(truth, motion=motion, gap=0.03)):
        scene.advance(1.0)
        angles.append(scene.angles())
    np.testing.assert_allclose(angles[0], angles[1], atol=1e-4)
    assert angles[0][0] == pytest.approx(0.06, abs=1e-3)


def test_the_limits_hold_however_it_is_commanded(truth: TrueSurface) -> None:
    scene = ArmScene(truth, gap=0.05)
    rng = np.random.default_rng(0)
    before = np.zeros(6)
    for k in range(600):
        if k % 20 == 0:
            scene.command(scene.start + rng.choice([-0.3, 0.3], 6))
        scene.step()
        speed = np.array(scene.data.qvel[:6])
        assert (np.abs(speed) <= scene.robot.velocity_limits * (1 + 1e-9)).all()
        assert (np.abs(speed - before) <= scene.robot.acceleration_limits * scene.step_s * (1 + 1e-6)).all()
        assert (np.abs(scene.torques) <= [joint.effort for joint in scene.robot.description.joints]).all()
        before = speed


def test_motors_that_are_too_weak_let_it_sink(truth: TrueSurface) -> None:
    scene = ArmScene(truth, payload=Payload(60.0), gap=0.03)
    scene.advance(0.1)
    most = [joint.effort for joint in scene.robot.description.joints]
    assert (np.abs(scene.torques) <= most).all()
    assert (np.abs(scene.torques) == most).any()
    assert scene.moment().R_WS.shape == (3, 3)
    assert np.abs(scene.true_joints - scene.start).max() > 1e-3


def test_all_motions_keep_well_clear_of_the_limits_and_of_the_arm_itself(truth: TrueSurface) -> None:
    scene = ArmScene(truth)
    top = float(truth.probe.vertices[:, 2].max())
    clear = ClearanceCheck(scene.robot.description, Clearance(p_ET_E=(0.0, 0.0, top), tool_radius=0.04))
    for pose in ([0, 0, 0.01, 0, 0, 0], [0, 0, -0.01, 0, 0, 0], *np.radians(10) * _SIGNS):
        R_BS = scene.T_BP[:3, :3] @ Rotation.from_euler("XYZ", pose[3:]).as_matrix() @ DOWN
        q = scene.joints_for(R_BS, scene.T_BP[:3, 3] + pose[:3] - R_BS @ [0, 0, top])
        assert scene.robot.within_limits(q, margin=0.5)
        assert clear.conflict(q) is None
        J = scene.robot.flange_jacobian(q)
        J[:3] /= 0.3
        assert np.linalg.svd(J)[1].min() > 0.3


_SIGNS = np.array([[0, 0, 0, x, y, 0] for x in (-1, 0, 1) for y in (-1, 0, 1) if x or y], dtype=float)


@pytest.mark.parametrize("scene_of", [PlatformScene, ArmScene])
def test_held_on_the_moving_phantom_it_stays_upright_at_its_depth(truth: TrueSurface, scene_of: type) -> None:
    motion = PlatformMotion(np.array([0.002, 0.003, 0.004, 0.08, -0.06, 0.0]), 3.0)
    scene = scene_of(truth, motion=motion, gap=-0.002)
    q, after = scene.start, []
    for k in range(60):
        R_BS, p_BS_B = scene.held_at(-0.002, motion.at((k + 1) * _PERIOD))
        q = scene.joints_for(R_BS, p_BS_B, q)
        scene.command(q)
        scene.advance(_PERIOD)
        after.append((*np.degrees(scene.angles()), scene.moment().contact[2]))
    angles, push = np.array(after)[25:, :2], np.array(after)[25:, 2]
    assert np.abs(angles).max() < 0.1
    assert push.max() - push.min() < 0.1 * np.abs(push).max()


def test_looking_changes_nothing(truth: TrueSurface) -> None:
    ends = []
    for looked in (False, True):
        scene = ArmScene(truth, motion=PlatformMotion.along("rx", 0.05, 1.0), gap=-0.002)
        for _ in range(20):
            scene.command(scene.start)
            for _ in range(4):
                scene.advance(_PERIOD / 4)
                if looked:
                    scene.moment()
                    scene.angles()
        ends.append(scene.true_joints)
    np.testing.assert_allclose(ends[0], ends[1], atol=1e-9)


def test_what_cannot_be_is_refused(truth: TrueSurface) -> None:
    far = np.eye(4)
    far[0, 3] = 2.0
    with pytest.raises(InputError, match="elfin3 does not reach"):
        ArmScene(truth, T_BP=far)
    with pytest.raises(InputError, match=r"T_ES: .* not a rotation matrix"):
        ArmScene(truth, R_ES=2 * np.eye(3))
    with pytest.raises(InputError, match=r"T_BP: give a pose of \(4, 4\)"):
        ArmScene(truth, T_BP=np.eye(3))
    scene = ArmScene(truth)
    with pytest.raises(InputError, match="joint angles must be finite"):
        scene.command(np.full(6, np.nan))
    with pytest.raises(InputError, match="outside its limits"):
        scene.command(scene.start + 3.0)
    scene.advance(0.1)
    np.testing.assert_allclose(scene.true_joints, scene.start, atol=1e-7)


def test_in_motion_it_also_reads_the_inertia(truth: TrueSurface) -> None:
    payload = Payload()
    scene = ArmScene(truth, payload=payload, gap=0.05)
    for k in range(20):
        scene.command(scene.start + 0.02 * np.sin(15 * k * _PERIOD) * np.array([1, 1, -1, 0, 0, 0]))
        scene.advance(_PERIOD)
    centres = []
    for at in range(3):
        if at == 1:
            moment = scene.moment()
        R_BE, p_BE_B = scene.robot.flange_pose(scene.true_joints)
        centres.append(p_BE_B + R_BE @ payload.centre_of_mass_S)
        scene.step()
    acceleration = (centres[2] - 2 * centres[1] + centres[0]) / scene.step_s**2
    assert np.linalg.norm(acceleration) > 0.5
    force = moment.R_WS.T @ (payload.mass * (_G - acceleration))
    np.testing.assert_allclose(moment.reading[:3], force, atol=0.02)


def test_the_same_commands_give_the_same_to_the_last_bit(truth: TrueSurface) -> None:
    readings = []
    for _ in range(2):
        scene = ArmScene(truth, motion=PlatformMotion.along("z", 0.002, 1.0), gap=-0.002)
        _held(scene, 0.2)
        readings.append(scene.moment().reading)
    np.testing.assert_array_equal(*readings)
