import numpy as np
import pytest
from config.runtime.bundles import example
from control.closed_loop import Ramp, gravity, loop, settings_for

from contactbench.pipeline.calibration import GravityModel
from contactbench.pipeline.contact import Gates, WrenchNoise
from contactbench.pipeline.control.controller import Controller, Inertia, PoseLag
from contactbench.pipeline.control.intake import SampleIntake
from contactbench.pipeline.control.inverse import CartesianMount
from contactbench.pipeline.control.margins import loop_of, margins
from contactbench.pipeline.control.settings import USUAL_MODULUS, Foundation, Variant
from contactbench.pipeline.control.states import ControlState, SensorMount
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.simulation.marker_touches import model_of, truth_of
from contactbench.pipeline.simulation.scenes.physics import Payload
from contactbench.pipeline.simulation.scenes.platform import PlatformMotion, PlatformScene, TissueCourse

BIAS = (0.05, -0.05, 0.05, 0.002, -0.002, 0.002)


def turning(axis, period=2.0, start=2.8):
    return PlatformMotion.along(axis, np.radians(10), period, start=start)


@pytest.mark.parametrize(("name", "stiffer"), [("convex", 1), ("t-shape", 1), ("t-shape", 5)])
def test_first_touch_does_not_swing(name, stiffer):
    run = loop(name, modulus=stiffer * USUAL_MODULUS, bias=BIAS).until(ControlState.TRACK)
    assert max(run.forces) < 1.15 * 7.0
    run.run(0.6)
    assert np.std(run.forces[-20:]) < 0.1
    assert np.mean(run.forces[-20:]) == pytest.approx(7.0, abs=0.1)


@pytest.mark.parametrize("axis", ["rx", "ry"])
def test_tissue_that_turns_in_two_seconds_is_followed(axis):
    run = loop("t-shape", motion=turning(axis), bias=BIAS).run(4.8)
    late = np.array(run.times) > 3.3
    assert np.degrees(np.abs(np.array(run.angles)[late])).mean(axis=0).max() < 4.0
    forces = np.array(run.forces)[late]
    assert 5.5 < forces.min() < forces.max() < 8.0
    assert run.controller.state is ControlState.TRACK


def test_tissue_that_heaves_from_the_first_touch_on_is_tracked():
    heaving = PlatformMotion.along("z", 0.01, 3.0, start=1.2)
    run = loop("convex", settings_for("convex"), motion=heaving).until(ControlState.TRACK)
    assert max(run.forces) < 15.0
    run.run(1.0)
    assert run.controller.state is ControlState.TRACK
    assert np.abs(np.array(run.forces[-25:]) - 7.0).max() < 1.5


def test_the_aware_variant_follows_better_than_the_plain_one():
    off = {}
    for variant in Variant:
        run = loop("t-shape", settings_for(variant=variant), motion=turning("ry", period=4.0, start=2.4)).run(
            3.8
        )
        off[variant] = np.abs(np.array(run.angles)[-50:, 0]).mean()
    assert off[Variant.AWARE] < 0.6 * off[Variant.PLAIN]


RIB = TissueCourse((2.4, 2.7), (1.0, 6.0))


def test_on_a_rib_the_force_does_not_swing_and_the_stiffness_is_known():
    run = loop("linear", settings_for("linear"), course=RIB).run(4.2)
    late = np.array(run.times) > 3.7
    forces = np.array(run.forces)[late]
    assert max(run.forces) < 12.0
    assert np.abs(forces - 7.0).max() < 1.0
    assert np.ptp(forces) < 0.9
    assert run.controller.state is ControlState.TRACK
    true = Foundation(model_of("linear", 1000)).at(7.0, 6 * USUAL_MODULUS).stiffness
    assert run.controller.surface.press(7.0).stiffness == pytest.approx(true, rel=0.4)


def test_a_swing_that_nothing_stops_makes_it_stand_still_and_measure_anew(monkeypatch):
    monkeypatch.setattr(Controller, "_follow", swinging_from(2.0))
    run = loop("t-shape").run(3.2)
    told = [(each.after, each.reason) for each in run.controller.safety.changes]
    held = next(k for k, (_, reason) in enumerate(told) if "although the gain was lowered" in reason)
    assert [state for state, _ in told[held : held + 2]] == [ControlState.HOLD, ControlState.CONTACT]
    assert max(run.forces) < 8.5


def swinging_from(time):
    """Return a `_follow` that sees a swing in what is none, once."""

    def follow(controller, now, *_):
        if now > time and not any(each.after is ControlState.HOLD for each in controller.safety.changes):
            for k in range(60):
                controller._swing.take(4.0 * np.sin(2 * np.pi * 3.0 * 0.02 * k), 0.02)

    return follow


def test_tissue_that_is_lost_is_not_run_after():
    bubble = TissueCourse((2.4, 2.42), (1.0, 1e-3))
    run = loop("convex", settings_for("convex"), course=bubble).until(ControlState.TRACK)
    while run.controller.state is ControlState.TRACK:
        run.step()
    assert run.controller.state is ControlState.APPROACH
    settings = run.controller.settings
    lost = [c for c in run.commands if c.state is ControlState.TRACK and c.force < settings.low_force]
    assert len(lost) >= 4
    assert max(-c.twist[2] for c in lost) <= settings.approach_speed + 1e-9


def test_limits_do_not_wind_up_the_force_loop():
    # The tissue goes away faster than the probe may, for long; back at it, it must not be hit.
    slow = settings_for(max_speed=0.004, approach_speed=0.003)
    run = loop("t-shape", slow).until(ControlState.TRACK)
    run.scene.motion = Ramp(np.array([0, 0, -0.0012, 0, 0, 0]), run.scene.time)
    run.run(0.3)
    assert np.abs(run.commands[-1].twist[:3]).max() <= 0.004 + 1e-12
    assert abs(run.controller._force.speed) < 0.02
    run.run(1.2)
    assert max(run.forces[-50:]) < 7.6


def test_what_a_calibration_leaves_is_taken_off_in_the_air():
    off = {}
    for taring in (0.0, 0.5):
        run = loop("convex", settings_for("convex", taring=taring), bias=BIAS, noise=(0.01, 0.0003))
        run.until(ControlState.TRACK).run(0.2)
        wanted = run.controller.wanted_S[:2]
        moment = run.scene.moment()
        off[taring] = np.linalg.norm(run.commands[-1].offset - (moment.point_S[:2] - wanted))
    assert off[0.5] < 0.5 * off[0.0]


def test_the_same_inputs_give_the_same_bytes():
    first, second = (loop("t-shape", motion=turning("ry", start=1.0)).run(2.2) for _ in range(2))
    one, two = (
        b"".join(each.q.tobytes() + each.twist.tobytes() for each in run.commands) for run in (first, second)
    )
    assert one == two


def test_signs_a_contact_off_in_x_turns_the_probe_about_y():
    for axis, which in (("ry", 0), ("rx", 1)):
        run = loop("t-shape", settings_for(variant=Variant.PLAIN), noise=(1e-3, 1e-5)).until(
            ControlState.TRACK
        )
        run.scene.motion = Ramp(
            0.02 * np.eye(6)[3 + (axis == "ry")], run.scene.time
        )  # a lasting tilt of 1.1 degrees
        before = abs(run.scene.angles()[which])
        run.run(1.5)
        tilted = np.abs(np.array(run.angles)[:, which]).max()
        assert before < 0.005 < 0.009 < tilted
        assert abs(run.scene.angles()[which]) < 0.3 * tilted


def test_no_motion_on_old_data():
    run = loop().until(ControlState.TRACK)
    q = run.commands[-1].q
    held = [run.step(samples=[]) for _ in range(5)]
    np.testing.assert_array_equal(held[0].twist, np.zeros(6))
    assert held[-1].state is ControlState.HOLD
    assert np.abs(held[-1].q - q).max() < 3e-4
    run.run(1.5)
    assert [each.after for each in run.controller.safety.changes][-2:] == [
        ControlState.HOLD,
        ControlState.TRACK,
    ]


def test_silence_ends_safe_and_away():
    run = loop().until(ControlState.TRACK)
    for _ in range(60):
        run.step(samples=[])
    assert run.controller.state is ControlState.SAFE
    assert run.forces[-1] == 0.0


def test_an_arm_that_does_not_move_is_not_pushed_on():
    run = loop(settings=settings_for(attempts=1, approach_speed=0.02)).until(ControlState.TRACK)
    run.scene.command = lambda _: None
    run.scene.motion = Ramp(np.array([0, 0, -0.003, 0, 0, 0]), run.scene.time)  # away: it would go after it
    run.run(2.6)
    assert any("commanded position" in each.reason for each in run.controller.safety.changes)
    assert run.controller.state is ControlState.SAFE
    # What was sent stays near to where it stands: should it let go, it would not jump.
    tips = np.array([each.q[2] for each in run.commands])
    assert np.abs(tips[-100:] - run.scene.joints[2]).max() < 0.1


def test_joints_that_are_no_numbers_move_nothing():
    run = loop().until(ControlState.TRACK)
    for _ in range(120):
        run.step(joints=np.full(6, np.nan))
    assert ControlState.HOLD in [each.after for each in run.controller.safety.changes]
    assert run.controller.state in (ControlState.RETRACT, ControlState.SAFE)
    assert max(run.forces) < 12.0
    assert all(np.isfinite(each.q).all() for each in run.commands)


def test_a_jump_of_the_force_makes_it_go_back():
    run = loop().until(ControlState.TRACK)
    run.bias = np.array([0, 0, -20.0, 0, 0, 0])
    for _ in range(3):
        command = run.step()
    assert command.state is ControlState.RETRACT
    assert np.linalg.norm(command.twist[:3]) == pytest.approx(run.controller.settings.max_speed)
    run.bias = np.zeros(6)
    run.run(1.5)
    assert run.controller.state is ControlState.SAFE


def test_a_stop_goes_back_and_ends():
    run = loop().until(ControlState.CONTACT)
    run.controller.stop()
    assert np.linalg.norm(run.step().twist[:3]) == pytest.approx(run.controller.settings.retract_speed)
    assert run.controller.state is ControlState.RETRACT
    run.run(1.5)
    assert run.controller.state is ControlState.SAFE
    assert run.forces[-1] == 0.0
    q = run.commands[-1].q
    np.testing.assert_array_equal(run.step().q, q)


def test_joints_of_another_arm_are_refused():
    run = loop()
    with pytest.raises(InputError, match="give all"):
        run.controller.step(0.0, np.zeros(7), [])


def test_the_model_of_the_force_loop_says_where_the_simulation_swings():
    base = settings_for(variant=Variant.PLAIN, probing=0.0, taring=0.0, approach_speed=0.002, max_speed=0.5)
    foundation = Foundation(model_of("t-shape", 1000))
    room = margins(loop_of(base, foundation, USUAL_MODULUS, "force", unknown=0.0)).gain
    spread = {}
    for share in (0.6, 1.7):
        gains = {
            "force_damping": base.force_damping / (room * share),
            "force_mass": base.force_mass / (room * share),
        }
        settings = settings_for(
            variant=Variant.PLAIN, probing=0.0, taring=0.0, approach_speed=0.002, max_speed=0.5, **gains
        )
        # Without the damping of the tissue, which the model leaves out.
        run = loop("t-shape", settings, noise=(0.01, 0.0002), damping=1e-3).run(2.6)
        spread[share] = max(run.forces) - 7.0
    assert spread[0.6] < 2.0
    assert spread[1.7] > 5.0


def test_a_bundle_is_all_it_takes():
    config, arm = example(), CartesianMount()
    told = config.model.frames.quaternion_ES
    more = {} if told is not None else {"quaternion_ES": (1.0, 0.0, 0.0, 0.0)}
    controller = Controller.from_config(config, arm, np.zeros(6), p_ES_E=(0, 0, 0.01), **more)
    settings = controller.settings
    assert settings.max_force == config.model.limits.max_force_N
    solver, touch = controller._intake._method.engine, config.model.touch
    assert solver.model.torsion_arm == touch.torsion_arm_m
    assert solver.model.mesh_deviation == touch.mesh_deviation_m
    told_N = np.sqrt(np.diag(solver.model.model_error.covariance)[:3])
    np.testing.assert_allclose(told_N, touch.model_error.force_N)
    odds = np.exp(0.5 * solver.gates.bonus(config.probe.region, config.probe.untouchable))
    said = np.array([1.0, *(region.odds for region in config.model.regions)])
    np.testing.assert_allclose(odds, said[config.probe.region])
    if config.model.controller is not None:
        assert settings.desired_force == config.model.controller.desired_force_N
    assert controller.wanted_S[2] == pytest.approx(config.probe.vertices[:, 2].max())
    assert controller.step(0.0, np.zeros(6), []).state is ControlState.HOLD
    with pytest.raises(InputError, match="no method"):
        Controller.from_config(config, arm, np.zeros(6), method="guess", **more)
    if told is None:
        with pytest.raises(InputError, match="the rotation of the sensor"):
            Controller.from_config(config, arm, np.zeros(6))
    else:
        with pytest.raises(InputError, match="recalibrate"):
            Controller.from_config(config, arm, np.zeros(6), quaternion_ES=(0.0, 1.0, 0.0, 0.0))


@pytest.mark.parametrize(
    "wrong",
    [(2 * np.eye(3), np.zeros(3)), (np.diag([1, 1, -1.0]), np.zeros(3)), (np.eye(3), np.full(3, np.nan))],
)
def test_a_mount_must_be_a_rotation_and_a_place(wrong):
    with pytest.raises(InputError, match="mount"):
        SensorMount(*wrong)


def test_a_mount_turns_what_is_seen_not_what_is_done():
    probe, arm = model_of("t-shape", 1000), CartesianMount()
    turned = np.array([[0.0, -1, 0], [1, 0, 0], [0, 0, 1]])
    intake = SampleIntake(probe, gravity(), WrenchNoise(), Gates())
    place = np.array([0.01, 0.02, 0.03])
    controller = Controller(settings_for(), arm, probe, intake, SensorMount(turned, place), np.zeros(6))
    R_BE, p_BE_B = arm.flange_pose(np.zeros(6))
    R_BS, tip = controller._pose(np.zeros(6))
    np.testing.assert_allclose(R_BS, R_BE @ turned)
    np.testing.assert_allclose(tip, p_BE_B + R_BE @ (place + turned @ controller.wanted_S))
    np.testing.assert_allclose(R_BE @ (turned @ controller._lever_S), tip - p_BE_B, atol=1e-12)


# ----  --------------------------------------------------------------------------------------------


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


# ---- how late poses are, from how far the arm is behind what it was sent -------------------------


DT = 0.02


@pytest.mark.parametrize("late", [0, 1, 5])
def test_it_says_by_how_much_they_are_late(late):
    times = DT * np.arange(200)
    sent = 0.005 * np.sin(2 * np.pi * times / 2)
    told = np.concatenate([np.full(late, sent[0]), sent])[: len(sent)]
    told = told + np.random.default_rng(0).normal(0, 1e-5, len(told))
    lag = PoseLag()
    for k in range(1, len(sent)):
        lag.take((sent[k] - sent[k - 1]) / DT, (told[k] - told[k - 1]) / DT, sent[k] - told[k], DT)
    assert lag.seconds == pytest.approx(late * DT, abs=0.01)


def test_who_stands_still_says_nothing():
    lag = PoseLag()
    for _ in range(500):
        lag.take(1e-4, 1e-4, 1e-3, DT)
    assert lag.seconds == 0.0


def test_an_arm_that_does_not_move_is_not_late():
    lag = PoseLag()
    for k in range(100):
        lag.take(0.01, 0.0, 0.01 * k * DT, DT)
    assert lag.seconds == 0.0
