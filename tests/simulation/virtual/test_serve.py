"""The bench behind real lines tells what it tells directly."""

import time
from itertools import pairwise

import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from waiting import JumpingClock, until

from contactbench.pipeline.calibration.calibrate import calibrate
from contactbench.pipeline.calibration.poses import PoseSample
from contactbench.pipeline.devices.protocols.arms import ELFIN3_TABLE, flange_pose
from contactbench.pipeline.simulation.virtual.bench import VirtualBench
from contactbench.pipeline.simulation.virtual.pace import CATCH_UP_S, Pacer
from contactbench.pipeline.simulation.virtual.serve import ServedBench, WristArm
from contactbench.pipeline.streams import open_pair

REST_S, TURN_S = 0.35, 0.25
POSES = [(0, 0, 0), (90, 0, 0), (-80, 10, 0), (0, 85, 0), (30, -85, 0), (175, 0, 40)]


def mean_pose(wrenches, flanges, start, stop):
    forces = np.array([sample.force for sample in wrenches if start < sample.time < stop])
    torques = np.array([sample.torque for sample in wrenches if start < sample.time < stop])
    R = [sample.R_BE for sample in flanges if start < sample.time < stop][-1]
    spread = {"force_sd": forces.std(axis=0), "torque_sd": torques.std(axis=0)}
    return PoseSample(R, forces.mean(axis=0), torques.mean(axis=0), len(forces), **spread)


def test_a_calibration_over_the_wire_is_the_direct_one():
    wrenches, flanges, direct, turned, still = [], [], [], [], []
    with ServedBench(VirtualBench(seed=2), on_batch=direct.append) as served:
        pair = open_pair(served.sensor.url, served.robot.url, wrenches.extend, flanges.extend)
        with pair:
            until(lambda: wrenches and flanges)
            for rpy in POSES:
                done = served.bench.turn_to(rpy=rpy, seconds=TURN_S).result(2)
                # By the bench's own clock: on a busy machine it may be behind that of the wall.
                until(lambda: served.bench.time > done.until + 0.2)  # noqa: B023 - called at once
                start = time.monotonic()
                until(lambda: served.bench.time > done.until + 0.2 + REST_S)  # noqa: B023
                turned.append(mean_pose(wrenches, flanges, start, time.monotonic()))
                still.append((done.until + 0.1, done.until + 0.1 + REST_S))
    samples = [sample for batch in direct for sample in batch.wrenches]
    poses = [sample for batch in direct for sample in batch.flanges]
    plain = [mean_pose(samples, poses, *span) for span in still]
    # What is read back of the orientation is the bench's own, to the digits on the wire.
    for wired, own in zip(turned, plain, strict=True):
        assert Rotation.from_matrix(wired.R_WS.T @ own.R_WS).magnitude() < 1e-6
    ours, theirs = calibrate(turned).model, calibrate(plain).model
    sigma = 0.05 / np.sqrt(REST_S * 200)
    np.testing.assert_allclose(ours.gravity_W, theirs.gravity_W, atol=6 * sigma)
    np.testing.assert_allclose(ours.force_bias, theirs.force_bias, atol=6 * sigma)
    np.testing.assert_allclose(ours.centre_of_mass_S, theirs.centre_of_mass_S, atol=1e-3)
    assert -ours.gravity_W[2] == pytest.approx(0.45 * 9.80665, abs=6 * sigma)
    # No sample came out of its order, or was made up; on a busy machine some come twice, for a box tells what
    # it has when a frame is due, or not at all.
    sent = [tuple(np.float32((*sample.force, *sample.torque)).tolist()) for sample in samples]
    got = [tuple(np.float32((*sample.force, *sample.torque)).tolist()) for sample in wrenches]
    place = {values: row for row, values in enumerate(sent)}
    rows = [place[values] for values in got if values in place]
    assert len(rows) >= 0.99 * len(got)
    assert all(before <= after for before, after in pairwise(rows))
    assert len(set(rows)) > 0.5 * (rows[-1] - rows[0])


def test_the_arm_stands_as_any_wrist_does():
    arm = WristArm()
    rotations = Rotation.random(2000, random_state=np.random.default_rng(0)).as_matrix()
    flat = [Rotation.from_euler("xyz", rpy, degrees=True).as_matrix() for rpy in POSES]
    for R_BE in (np.eye(3), -np.diag([1.0, 1.0, -1.0]), *flat, *rotations):
        found, _ = flange_pose(ELFIN3_TABLE, arm.joints(R_BE))
        np.testing.assert_allclose(found, R_BE, atol=1e-9)


def test_an_arm_that_follows_a_turn_does_not_leap():
    arm = WristArm()
    joints = [
        arm.joints(Rotation.from_euler("y", a, degrees=True).as_matrix()) for a in np.arange(0, 60, 0.5)
    ]
    assert np.abs(np.diff(joints[1:], axis=0)).max() < 0.05


def test_a_computer_that_is_too_slow_lets_time_slip_and_says_so(monkeypatch):
    clock = JumpingClock()
    monkeypatch.setattr("contactbench.pipeline.simulation.virtual.pace.time", clock)
    bench = VirtualBench(sensor="ideal")
    times = []

    def take(batch, origin):
        times.extend(origin + sample.time for sample in batch.wrenches)
        if len(times) > 10 and not clock.ahead:
            clock.ahead = CATCH_UP_S + 0.5

    pacer = Pacer(bench, take)
    pacer.start()
    until(lambda: pacer.slipped)
    until(lambda: clock.monotonic() - times[-1] < 0.1)  # it has caught up
    pacer.stop()
    assert pacer.slipped == pytest.approx(0.5, abs=0.25)
    assert "too slow" in pacer.findings()[0]
    assert (np.diff(times) > 0).all()
    assert times[-1] == pytest.approx(clock.monotonic(), abs=0.2)
