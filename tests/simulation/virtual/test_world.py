"""The virtual bench by its address."""

import time
from itertools import pairwise

import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from waiting import JumpingClock, until

from contactbench.pipeline.calibration.calibrate import calibrate
from contactbench.pipeline.calibration.poses import PoseSample
from contactbench.pipeline.devices.driver import AddressError
from contactbench.pipeline.devices.protocols.arms import ELFIN3_TABLE, flange_pose
from contactbench.pipeline.devices.stream import StreamState
from contactbench.pipeline.devices.url import DeviceAddress
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.simulation.virtual.bench import VirtualBench
from contactbench.pipeline.simulation.virtual.run import ServedBench, WristArm
from contactbench.pipeline.simulation.virtual.world import CATCH_UP_S, Pacer
from contactbench.pipeline.streams import open_pair, open_poses, open_sensor

HERE = "virtual://bench?probe=linear&sensor=ideal"


def test_the_same_address_is_the_same_bench_on_one_clock():
    wrenches, flanges, told = [], [], []
    sensor = open_sensor(HERE, wrenches.extend, told.append)
    poses = open_poses(HERE, flanges.extend)
    assert sensor.source.bench is poses.source.bench
    assert open_sensor(f"{HERE}&seed=1", wrenches.extend).source.bench is not sensor.source.bench
    with sensor, poses:
        begin = time.monotonic()
        done = sensor.source.bench.turn_to(rpy=(0, 40, 0), seconds=0.3).result(2)
        until(lambda: wrenches and flanges and min(wrenches[-1].time, flanges[-1].time) > begin + 0.6)
        assert sensor.health.state is StreamState.STREAMING
    assert told[-1].state is StreamState.CLOSED
    assert done.until - done.time == pytest.approx(0.3)
    assert begin - 0.1 < wrenches[-1].time - 0.5 < time.monotonic()
    assert flanges[-1].R_BE[0, 2] == pytest.approx(np.sin(np.radians(40)), abs=1e-4)
    # Wrenches and poses of one moment have one time.
    assert {sample.time for sample in flanges[2:-2]} <= {sample.time for sample in wrenches}
    # The bench is gone with its last stream.
    assert open_sensor(HERE, wrenches.extend).source.bench is not sensor.source.bench


def test_stepwise_gives_the_same_every_time(tmp_path):
    script = tmp_path / "a.jsonl"
    script.write_text(
        '{"at": 0.05, "do": "touch", "marker": 3}\n{"at": 0.3, "do": "end"}\n', encoding="utf-8"
    )
    address = f"{HERE}&speed=step&rate=1000&script={script}"
    runs = []
    for _ in range(2):
        wrenches, flanges, truths = [], [], []
        pair = open_pair(address, address, wrenches.extend, flanges.extend)
        pair.source.truth = lambda batch, truths=truths: truths.extend(batch.truths)
        with pair:
            assert pair.stepwise
            assert pair.step(5) == 5
            while not pair.finished:
                pair.step(100)
            assert pair.now() == pytest.approx(0.3)
            about = pair.about()
            assert pair.step(1) == 0
        assert pair.sensor.health.state is StreamState.CLOSED
        assert [device.rate for device in about.devices] == [1000.0, 50.0]
        assert [truth.time for truth in truths] == [sample.time for sample in wrenches]
        runs.append((wrenches, [sample.R_BE.tobytes() for sample in flanges]))
    assert len(runs[0][0]) == 300
    assert runs[0] == runs[1]


def test_a_script_that_fails_is_shown(tmp_path):
    script = tmp_path / "a.jsonl"
    script.write_text('{"at": 0.01, "do": "touch", "marker": 99}\n', encoding="utf-8")
    stream = open_sensor(f"{HERE}&script={script}", lambda _: None)
    with stream:
        assert stream.done.wait(5)
        assert stream.health.state is StreamState.LOST
        assert "line 1: touch: there is no marker 99" in stream.health.findings[0]


def test_readings_without_noise_are_no_fault():
    with open_sensor(f"{HERE}&speed=step&rate=1000", lambda _: None) as stream:
        stream.step(400)
        assert (stream.health.suspicions, stream.health.findings) == ((), ())


def test_a_tip_that_slid_off_is_a_finding():
    with open_sensor(f"{HERE}&speed=step", lambda _: None) as stream:
        touch = stream.source.bench.touch(3, tilt=80.0)
        stream.step(500)
        assert touch.result(0).time == 0.0
        assert any("slid off" in finding for finding in stream.health.findings)


@pytest.mark.filterwarnings("ignore::pytest.PytestUnhandledThreadExceptionWarning")
def test_who_makes_a_mistake_with_samples_leaves_nobody_waiting():
    def broken(_):
        raise ZeroDivisionError("mine")

    pair = open_pair(HERE, HERE, broken, lambda _: None)
    with pair:
        for stream in (pair.sensor, pair.poses):
            assert stream.done.wait(5)
            assert stream.health.state is StreamState.LOST
            assert "ZeroDivisionError: mine" in stream.health.findings[0]
        with pytest.raises(InputError, match="closed"):
            pair.sensor.source.bench.release().result(1)


def test_a_stream_that_comes_after_the_bench_failed_hears_why(tmp_path):
    script = tmp_path / "a.jsonl"
    script.write_text('{"at": 0.0, "do": "touch", "marker": 99}\n', encoding="utf-8")
    address = f"{HERE}&speed=step&script={script}"
    sensor, poses = (opened(address, lambda _: None) for opened in (open_sensor, open_poses))
    with sensor:
        assert sensor.step(1) == 0
        with poses:
            assert poses.done.is_set()
            assert "marker 99" in poses.health.findings[0]


def test_who_makes_a_mistake_stepwise_hears_it_where_he_steps():
    def broken(_):
        raise ZeroDivisionError

    pair = open_pair(f"{HERE}&speed=step", f"{HERE}&speed=step", broken, lambda _: None)
    with pair:
        with pytest.raises(ZeroDivisionError):
            pair.step(1)
        assert pair.poses.done.is_set()
        assert pair.poses.health.state is StreamState.LOST


def test_the_address_reads_back():
    where = DeviceAddress.parse("virtual://bench?mesh=/a/b%20c.ply&seed=7&speed=step&rate=500&pose_rate=100")
    assert where.bench.mesh == "/a/b c.ply"
    assert DeviceAddress.parse(str(where)) == where
    assert where.gives_wrenches
    assert where.gives_poses


@pytest.mark.parametrize(
    ("address", "message"),
    [
        ("virtual://", "the virtual bench has no host"),
        ("virtual://bench/a", "the virtual bench has no host"),
        ("virtual://bench?speed=2", "give step"),
        ("virtual://bench?seed=-1", "whole number"),
        ("virtual://bench?rate=2000", "at most 1000 Hz"),
        ("virtual://bench?probe=linear&mesh=a.ply", "one of them"),
        ("virtual://bench?baud=9600", "unknown option"),
    ],
)
def test_an_address_that_is_wrong_is_refused(address, message):
    with pytest.raises(AddressError, match=message):
        DeviceAddress.parse(address)


def test_names_that_nothing_has_are_refused_when_it_is_opened(tmp_path):
    for option in (
        "probe=axe",
        "sensor=best",
        f"script={tmp_path / 'none'}",
        f"mesh={tmp_path / 'none.stl'}",
    ):
        with pytest.raises(InputError):
            open_sensor(f"virtual://bench?{option}", lambda _: None)


def test_two_benches_make_no_pair():
    with pytest.raises(AddressError, match="bench or clock"):
        open_pair(HERE, f"{HERE}&seed=1", lambda _: None, lambda _: None)
    with pytest.raises(AddressError, match="bench or clock"):
        open_pair(f"{HERE}&speed=step", "still://?rpy=0,0,0", lambda _: None, lambda _: None)


# ---- the bench behind real lines tells what it tells directly ------------------------------------


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
    monkeypatch.setattr("contactbench.pipeline.simulation.virtual.world.time", clock)
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
