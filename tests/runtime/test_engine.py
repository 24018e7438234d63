from __future__ import annotations

import json
import math
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from config.runtime.bundles import example
from kernel.runtime_cases import stream
from runtime.runtime_recordings import BEGIN, flange, wrench
from scipy.spatial.transform import Rotation

from pipeline import kernel
from pipeline.config.runtime import RuntimeConfig
from pipeline.devices.sample import Status
from pipeline.runtime import Engine
from pipeline.runtime.engine import kernel_arguments, make_runtime, mount_rotation, sensor_rotation

if TYPE_CHECKING:
    from numpy.typing import NDArray

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


def test_the_kernel_gets_what_the_bundle_says_of_a_touch() -> None:
    config = example(clamped=True)
    given = kernel_arguments(config)
    error = np.array([0.04, 0.05, 0.06, 0.001, 0.0012, 0.0009])
    covariance = np.array(config.model.noise.wrench_covariance) + np.diag(error * error)
    assert (given["noise"] == covariance).all()
    assert (given["torsion_arm"], given["mesh_deviation"], given["mesh_curved"]) == (0.002, 5e-5, True)
    expected = {0: 0.0, 1: 2 * math.log(1000.0), 2: 2 * math.log(0.001)}
    assert given["bonus"].tolist() == [expected[rank] for rank in config.probe.region.tolist()]
    assert given["implausible_misfit"] == config.model.gates.implausible_misfit
    assert given["rival_cost"] == 2 * math.log(100.0)


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


def test_a_sample_takes_the_newest_pose_that_is_not_later() -> None:
    config = example()
    weights = [config.gravity.predict(R) for R in TURNS]
    engine = Engine(config)
    engine.poses([flange(BEGIN + 0.01 * i, R) for i, R in enumerate(TURNS)])
    for i in (5, 3, 4):  # a sample may also come late
        answer = engine.locate(wrench(BEGIN + 0.01 * i + 0.005, weights[i]))
        if i == 5:  # the first one: unfiltered, and nothing but its own weight
            assert answer.contact is not None
            assert answer.contact.wrench == pytest.approx(np.zeros(6), abs=1e-9)
    engine = Engine(config)
    engine.poses([flange(BEGIN + 0.01 * i, R) for i, R in enumerate(TURNS)])
    late = engine.locate(wrench(BEGIN + 0.025, weights[2]))
    assert late.contact is not None
    assert late.contact.wrench == pytest.approx(np.zeros(6), abs=1e-9)


def test_an_old_pose_is_stale_and_the_kernel_is_not_asked() -> None:
    engine = Engine(example())
    reading = example().gravity.predict(TURNS[0])
    assert engine.locate(wrench(BEGIN, reading)).reason == "stale"
    engine.poses([flange(BEGIN + 1, TURNS[0])])
    assert engine.locate(wrench(BEGIN + 0.9, reading)).reason == "stale"  # it is of the future
    assert engine.locate(wrench(BEGIN + 1.09, reading)).reason == "low_force"
    assert engine.locate(wrench(BEGIN + 1.2, reading)).reason == "stale"
    still = Engine(example(), hold=math.inf)
    still.poses([flange(BEGIN, TURNS[0])])
    assert still.locate(wrench(BEGIN + 1e6, reading)).reason == "low_force"


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
    R_ES = mount_rotation(config)
    assert R_ES is not None
    assert pytest.approx(Rotation.from_quat(q).as_matrix(), abs=1e-15) == R_ES
    assert sensor_rotation(TURNS[0], R_ES) == pytest.approx(TURNS[0] @ R_ES, abs=1e-15)
    engine = Engine(config)
    engine.poses([flange(BEGIN, TURNS[0])])
    answer = engine.locate(wrench(BEGIN, config.gravity.predict(TURNS[0] @ R_ES)))
    assert answer.contact is not None
    assert answer.contact.wrench == pytest.approx(np.zeros(6), abs=1e-9)


def test_without_a_mount_poses_are_the_sensors() -> None:
    assert mount_rotation(mounted(None)) is None
    assert (sensor_rotation(TURNS[1].T, None) == TURNS[1].T).all()
