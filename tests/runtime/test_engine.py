from __future__ import annotations

import json
import math

import numpy as np
import pytest
from config.runtime.bundles import example
from kernel.runtime_cases import arguments, stream
from runtime.runtime_recordings import BEGIN, flange, wrench
from scipy.spatial.transform import Rotation

from pipeline import kernel
from pipeline.config.runtime import RuntimeConfig
from pipeline.devices.sample import Status
from pipeline.runtime import Engine
from pipeline.runtime.engine import mount_rotation, sensor_rotation

TURNS = Rotation.random(6, 3).as_matrix()


def mounted(quaternion: list[float] | None) -> RuntimeConfig:
    config = example()
    frames = config.model.frames.model_copy(update={"quaternion_ES": quaternion})
    return RuntimeConfig(config.model.model_copy(update={"frames": frames}), config.probe, dict(config.files))


def test_the_same_as_the_kernel_given_everything() -> None:
    config = example()
    readings, R, times = stream(config, 400)
    batch = kernel.Runtime(**arguments(config)).update_batch(readings, R, times)
    engine = Engine(config)
    for i, time in enumerate(times.tolist()):
        engine.poses([flange(time, R[i])])
        told = json.loads(engine.locate(wrench(time, readings[i])).line)
        assert told["force_S_N"] + told["torque_S_Nm"] == batch.wrenches[i].tolist()
        point = batch.points[i]
        assert told["point_S_m"] == (None if np.isnan(point[0]) else point.tolist())
        assert told["runner_up_m"] == (
            None if np.isnan(batch.runner_up_distances[i]) else batch.runner_up_distances[i]
        )
        covariance = batch.covariances[i]
        assert told["covariance_S_m2"] == (
            None if np.isnan(covariance[0, 0]) else covariance.ravel().tolist()
        )


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
