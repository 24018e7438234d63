"""The virtual bench by its address."""

import time

import numpy as np
import pytest
from waiting import until

from contactbench.pipeline.devices.driver import AddressError
from contactbench.pipeline.devices.stream import StreamState
from contactbench.pipeline.devices.url import DeviceAddress
from contactbench.pipeline.errors import InputError
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
