import json
import math
from typing import Any

import numpy as np
import pytest
from config.runtime.bundles import example
from kernel.runtime_cases import stream
from numpy.typing import NDArray
from runtime.runtime_recordings import BEGIN, flange, wrench
from scipy.spatial.transform import Rotation

from contactbench.pipeline import kernel
from contactbench.pipeline.config.runtime import RuntimeConfig
from contactbench.pipeline.config.runtime.values import kernel_arguments, make_runtime
from contactbench.pipeline.devices.sample import FlangeSample, Status
from contactbench.pipeline.runtime import Engine
from contactbench.pipeline.runtime.lines import health_names

TURNS = Rotation.random(6, 3).as_matrix()


def mounted(quaternion: list[float] | None) -> RuntimeConfig:
    config = example()
    frames = config.model.frames.model_copy(update={"quaternion_ES": quaternion})
    return RuntimeConfig(config.model.model_copy(update={"frames": frames}), config.probe, dict(config.files))


def test_the_same_as_the_kernel_given_everything() -> None:
    config = example()
    readings, R, times = stream(config, 400)
    batch = make_runtime(config).update_batch(readings, R, times)
    engine = Engine(config)
    for i, time in enumerate(times.tolist()):
        engine.poses([flange(time, R[i])])
        told = json.loads(engine.locate(wrench(time, readings[i])).line)
        assert told["force_S_N"] + told["torque_S_Nm"] == batch.wrenches[i].tolist()
        point = batch.points[i]
        assert told["point_S_m"] == (None if np.isnan(point[0]) else point.tolist())
        assert told["accepted"] is bool(batch.accepted[i])
        assert told["confidence"] == batch.confidences[i]
        for name, values in (
            ("misfit", batch.misfits),
            ("left_over_Nm", batch.left_overs),
            ("arm_m", batch.arms),
            ("runner_up_S_m", batch.runners_up),
            ("second_S_m", batch.seconds),
        ):
            assert told[name] == (None if np.isnan(values[i]).any() else values[i].tolist()), name
        covariance = batch.covariances[i]
        assert told["covariance_S_m2"] == (
            None if np.isnan(covariance[0, 0]) else covariance.ravel().tolist()
        )
        variance = np.nan if np.isnan(covariance).any() else np.linalg.eigvalsh(covariance)[-1]
        within = np.nan if told["within_m"] is None else told["within_m"]
        assert within == pytest.approx(np.sqrt(-2 * np.log(0.05) * variance), rel=1e-9, nan_ok=True)


def test_the_kernel_gets_what_the_bundle_says_of_a_touch() -> None:
    config = example(clamped=True)
    given = kernel_arguments(config)
    error = np.array([0.04, 0.05, 0.06, 0.001, 0.0012, 0.0009])
    covariance = np.array(config.model.noise.wrench_covariance) + np.diag(error * error)
    assert (given["noise"] == covariance).all()
    assert (given["torsion_arm"], given["mesh_deviation"], given["mesh_curved"]) == (0.002, 5e-5, True)
    expected = {0: 0.0, 1: 2 * math.log(1000.0), 2: 2 * math.log(0.001)}
    assert given["bonus"].tolist() == [expected[rank] for rank in config.probe.region.tolist()]
    assert given["gates"]["implausible_misfit"] == config.model.gates.implausible_misfit
    assert given["gates"]["rival_cost"] == 2 * math.log(100.0)


def test_what_a_clamp_hides_is_less_often_the_answer() -> None:
    config = example(clamped=True)
    probe, level = config.probe, np.eye(3)
    clamped = np.flatnonzero(probe.region == 2)
    forces = -7.0 * probe.normals[clamped]
    torques = np.cross(probe.vertices[probe.faces[clamped]].mean(axis=1), forces)
    readings = np.hstack([forces, torques]) + config.gravity.predict(level[None])

    def answers_there(bonus: NDArray[Any]) -> int:
        count, live = 0, kernel.Runtime(**{**kernel_arguments(config), "bonus": bonus})
        for reading in readings:
            live.reset()
            count += live.update(reading, level, 0.0).region == 2
        return count

    bonus = kernel_arguments(config)["bonus"]
    assert answers_there(bonus) + 20 < answers_there(np.where(probe.region == 2, 0.0, bonus))


def turning(time: float) -> NDArray[Any]:
    """Return R_WS of a wrist that turns at 20 degrees a second."""
    return Rotation.from_rotvec([0.2 * time, 0.25 * time, -0.1 * time]).as_matrix()


@pytest.mark.parametrize("behind", [0.0, 0.1])
def test_a_sample_takes_the_pose_at_its_own_time(behind: float) -> None:
    """Between two poses of 10 Hz, or carried on from the last one, of a wrist that turns at 20 degrees a second."""
    config = example()
    for time in np.linspace(1.0, 1.5, 23).tolist():
        engine = Engine(config)
        engine.poses(
            [flange(t, turning(t)) for t in (0.1 * np.arange(20)).tolist() if t <= time + 0.1 - behind]
        )
        answer = engine.locate(wrench(time, config.gravity.predict(turning(time))))
        assert answer.contact is not None
        assert answer.contact.wrench == pytest.approx(np.zeros(6), abs=1e-9)  # nothing but its own weight
        assert 0 <= answer.contact.pose_age < 0.1 + behind


def test_without_a_pose_young_enough_it_is_stale_and_says_so() -> None:
    config = example()
    engine, reading = Engine(config), config.gravity.predict(TURNS[0])
    ahead = config.model.streams.pose_ahead_s
    assert engine.locate(wrench(BEGIN, reading)).reason == "stale"
    engine.poses([flange(BEGIN + 1, TURNS[0])])
    before = engine.locate(wrench(BEGIN + 0.9, reading))
    assert (before.reason, health_names(before.health)) == ("stale", ("no_pose",))
    assert engine.locate(wrench(BEGIN + 1 + 0.99 * ahead, reading)).reason == "low_force"
    assert engine.locate(wrench(BEGIN + 1 + 1.01 * ahead, reading)).reason == "stale"
    still = Engine(config, hold=math.inf)
    still.poses([flange(BEGIN, TURNS[0])])
    assert still.locate(wrench(BEGIN + 1e6, reading)).reason == "low_force"


def test_a_hung_sensor_is_never_accepted_and_is_well_again_when_it_lives() -> None:
    config = example()
    engine, chance = Engine(config, hold=math.inf), np.random.default_rng(5)
    engine.poses([flange(BEGIN, TURNS[0])])
    face = int(np.argmax(config.probe.region == 1))
    force = -8.0 * config.probe.normals[face]
    torque = np.cross(config.probe.vertices[config.probe.faces[face]].mean(axis=0), force)
    reading = config.gravity.predict(TURNS[0]) + np.concatenate([force, torque])
    answers = []
    for i in range(600):
        hung = 300 <= i < 500
        if not hung:
            noisy = reading + chance.normal(0, [0.02] * 3 + [5e-4] * 3)
        answers.append(engine.locate(wrench(BEGIN + 0.005 * i, noisy)))
    accepted = [answer.contact is not None and answer.contact.accepted for answer in answers]
    frozen = [health_names(answer.health) == ("frozen",) for answer in answers]
    assert all(accepted[10:300])
    first = frozen.index(True)
    assert 300 < first <= 300 + 40  # 0.2 s at 200 Hz
    assert all(frozen[first:500])
    assert not any(accepted[first:500])
    assert not any(frozen[500:])
    assert all(answer.reason == "unhealthy" for answer in answers[first:500])
    assert all(accepted[510:])


def test_a_sample_whose_time_is_a_guess_is_not_accepted() -> None:
    config = example()
    engine = Engine(config, hold=math.inf)
    engine.poses([flange(BEGIN, TURNS[0])])
    answer = engine.locate(wrench(BEGIN, config.gravity.predict(TURNS[0]), Status.CLOCK))
    assert (answer.reason, health_names(answer.health)) == ("unhealthy", ("clock",))


def test_silence_is_told() -> None:
    config = example()
    engine = Engine(config, hold=math.inf)
    assert engine.silent(BEGIN) is not None
    engine.poses([flange(BEGIN, TURNS[0])])
    engine.locate(wrench(BEGIN, config.gravity.predict(TURNS[0])))
    silence = config.model.streams.silence_s
    assert engine.silent(BEGIN + 0.99 * silence) is None
    told = engine.silent(BEGIN + 1.01 * silence)
    assert told is not None
    line = json.loads(told.line)
    assert (line["health"], line["reason"], line["accepted"]) == (["silent"], "stale", False)
    assert line["time"] == BEGIN + 1.01 * silence


def test_what_moving_the_tool_does_is_taken_off_where_poses_have_positions() -> None:
    """0.6 kg at 1 m/s²: 0.6 N that is no touch."""
    config = example()
    weight = np.linalg.norm(config.gravity.gravity_W)
    mass, omega, R = weight / 9.80665, 2 * np.pi, TURNS[0]

    def left(known: bool) -> tuple[float, float]:
        engine, worst = Engine(config), []
        for i in range(2_000):
            t = BEGIN + 0.001 * i
            if i % 8 == 0:
                p = np.array([np.sin(omega * t) / omega**2, 0.0, 0.2])
                engine.poses([FlangeSample(t, R, p if known else np.full(3, np.nan))])
            pull = R.T @ np.array([mass * np.sin(omega * t), 0.0, 0.0])
            torque = np.cross(config.gravity.centre_of_mass_S, pull)
            answer = engine.locate(wrench(t, config.gravity.predict(R) + np.concatenate([pull, torque])))
            assert answer.contact is not None
            if i > 500:
                worst.append(answer.contact.wrench)
        rows = np.array(worst)
        return float(np.linalg.norm(rows[:, :3], axis=1).max()), float(
            np.linalg.norm(rows[:, 3:], axis=1).max()
        )

    force, torque = left(known=True)
    without = left(known=False)
    assert without[0] > 0.9 * mass
    assert force < 0.2 * without[0]
    assert torque < 0.2 * without[1]


@pytest.mark.parametrize("status", [Status.INVALID, Status.RAW, Status.ERROR, Status.OVERRANGE])
def test_what_the_sensor_calls_no_measurement_is_none(status: Status) -> None:
    engine = Engine(example())
    engine.poses([flange(BEGIN, TURNS[0])])
    reading = example().gravity.predict(TURNS[0])
    assert engine.locate(wrench(BEGIN + 0.01, reading, status)).reason == "not_finite"
    assert engine.locate(wrench(BEGIN + 0.02, reading, Status.LATE)).reason == "low_force"


def test_at_its_limits_it_is_saturated() -> None:
    engine = Engine(example())
    engine.poses([flange(BEGIN, TURNS[0])])
    reading = [0.0, 200.0, 0.0, 0.0, 0.0, 0.0]
    assert engine.locate(wrench(BEGIN + 0.01, reading, Status.OVERRANGE)).reason == "saturated"


def test_the_mount_turns_the_flange_into_the_sensor() -> None:
    q = Rotation.from_euler("xyz", [10, 20, 30], degrees=True).as_quat()
    config = mounted([q[3], q[0], q[1], q[2]])
    R_ES = kernel_arguments(config)["R_ES"]
    assert pytest.approx(Rotation.from_quat(q).as_matrix(), abs=1e-15) == R_ES
    engine = Engine(config)
    engine.poses([flange(BEGIN, TURNS[0])])
    answer = engine.locate(wrench(BEGIN, config.gravity.predict(TURNS[0] @ R_ES)))
    assert answer.contact is not None
    assert answer.contact.wrench == pytest.approx(np.zeros(6), abs=1e-9)


def test_without_a_mount_poses_are_the_sensors() -> None:
    config = mounted(None)
    assert kernel_arguments(config)["R_ES"] is None
    engine = Engine(config)
    engine.poses([flange(BEGIN, TURNS[1])])
    answer = engine.locate(wrench(BEGIN, config.gravity.predict(TURNS[1])))
    assert answer.contact is not None
    assert answer.contact.wrench == pytest.approx(np.zeros(6), abs=1e-9)
