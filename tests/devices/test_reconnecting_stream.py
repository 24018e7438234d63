"""A stream on a line that the test writes: what is told, and when."""

import sys
import threading
import time

import numpy as np
import pytest
from benchmarks.faults import resting
from devices.test_watch import Heard
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation
from waiting import be_slow, until

from contactbench.pipeline.devices import reconnecting_stream
from contactbench.pipeline.devices.driver import AddressError
from contactbench.pipeline.devices.pose_source import file_track, still_track
from contactbench.pipeline.devices.protocols.elfin import ElfinPoses
from contactbench.pipeline.devices.protocols.sri import sri_frame
from contactbench.pipeline.devices.reconnecting_stream import SensorStream
from contactbench.pipeline.devices.stream import StreamState
from contactbench.pipeline.devices.transport import Chunk, LineLost, LineUnavailable
from contactbench.pipeline.devices.url import DeviceAddress
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.streams import PoseTrackError, open_poses


class Script:
    """A line whose other end is a function of the time since it was opened."""

    datagrams = False
    name = "script"

    def __init__(self, says):
        self.says = says
        self.written, self.opened_at = [], []
        self.reads = 0
        self._pending = b""
        self._wait = threading.Event()

    @property
    def opened(self):
        return len(self.opened_at)

    def open(self):
        self.opened_at.append(time.monotonic())

    def read(self, timeout):
        self.reads += 1
        data, self._pending = self._pending + self.says(self, time.monotonic() - self.opened_at[-1]), b""
        if not data:
            self._wait.wait(timeout)
        return Chunk(data, time.monotonic())

    def write(self, data):
        self.written.append(data)
        if b"=" in data and b"STOP" not in data:  # an SRI's settings are answered
            self._pending += data.strip().replace(b"AT", b"ACK", 1) + b"$OK\r\n"

    def close(self):
        """Nothing is open."""


def frames(until, rezero=1e9):
    """Say an SRI's frames at 100 Hz, up to a time."""
    given = [0]

    def says(_, now):
        out = b""
        while given[0] < 100 * min(now, until):
            values = resting(given[0] / 100) if given[0] / 100 < rezero else (0.0, 0.0, 0.0, 0.0, 0.0, 0.001)
            values = values[:5] + (values[5] + 1e-4 * (given[0] % 7),)
            out += sri_frame(values, given[0])
            given[0] += 1
        return out

    return says


def sri(line, heard):
    return SensorStream("sri+tcp://h?rate=100", heard.take, heard.change, line=line)


def test_it_never_says_streaming_while_no_sample_comes():
    heard = Heard()
    line = Script(frames(0.4))
    with sri(line, heard) as stream:
        heard.until(lambda: StreamState.STREAMING in heard.states())

        def silent():
            if time.monotonic() - heard.samples[-1].time > 0.2:
                assert stream.health.state is not StreamState.STREAMING
            return StreamState.SILENT in heard.states()

        until(silent)
        told = next(when for when, health in heard.changes if health.state is StreamState.SILENT)
        assert told - heard.samples[-1].time < 0.2
        count, reads = len(heard.changes), line.reads
        until(lambda: line.reads > reads + 5)
        assert len(heard.changes) == count  # a silence that goes on is no news


def test_a_suspicion_stays_until_it_is_acknowledged():
    heard = Heard()
    with sri(Script(frames(9.0, rezero=0.6)), heard) as stream:
        heard.until(lambda: any(health.suspicions for _, health in heard.changes))
        assert not stream.health.well
        count = len(heard.samples)
        heard.until(lambda: len(heard.samples) > count + 10)
        assert "re-zeroed" in stream.health.suspicions[0]
        stream.acknowledge()
        assert stream.health.suspicions == ()
        heard.until(lambda: not heard.changes[-1][1].suspicions)


def test_damage_is_told_while_nothing_else_arrives():
    def says(line, now):
        line.count = getattr(line, "count", 0) + 1
        return b"\x00" * 10 if now < 5 else b""

    heard = Heard()
    with sri(Script(says), heard):
        heard.until(lambda: any("no frame in them" in finding for finding in heard.findings()))
    assert heard.samples == []


def test_another_reason_why_a_line_is_lost_is_told():
    reasons = iter(["first", "second", "third"])

    def says(_line, _now):
        raise LineLost(next(reasons, "last"))

    heard = Heard()
    with sri(Script(says), heard):
        heard.until(lambda: "second" in heard.findings())
    assert heard.findings()[0] == "first"


@pytest.mark.parametrize(
    ("answer", "words"),
    [
        (b"ReadActPos,Fail,20011,;", "error code 20011"),
        (b"errorcmd,x,;", "does not know"),
        (b"nonsense;" * 9, "no frame in them"),
    ],
)
def test_an_answer_that_refuses_is_a_finding_and_the_line_stays(answer, words):
    def says(line, _now):
        asked, line.written = line.written, []
        return answer * len(asked)

    heard = Heard()
    line = Script(says)
    address = DeviceAddress.parse("elfin+tcp://h?rate=50")
    with ElfinPoses(address, heard.take, heard.change, line=line) as stream:
        heard.until(lambda: any(words in finding for finding in heard.findings()))
        heard.until(lambda: stream.health.state is StreamState.SILENT)
        assert stream.health.counters.bad_checksums > 0
    assert line.opened == 1
    assert heard.samples == []


def test_what_is_told_is_the_state_that_was_reached_also_after_a_slow_listener():
    heard = Heard()

    def slow(samples):
        if not heard.samples:
            be_slow(0.3)
        heard.take(samples)

    line = Script(frames(9.0))
    with SensorStream("sri+tcp://h?rate=100", slow, heard.change, line=line) as stream:
        heard.until(lambda: len(heard.samples) > 50 and stream.health.well)
        assert heard.changes[-1][1].well


# ---- streams that end for good, and lines that look well and are not -----------------------------


def raising(*_):
    raise ValueError("of the listener")


def test_what_a_listener_raises_ends_the_stream_and_stops_the_device():
    heard = Heard()
    line = Script(frames(9.0))
    with SensorStream("sri+tcp://h?rate=100", raising, heard.change, line=line) as stream:
        heard.until(lambda: heard.changes and heard.changes[-1][1].failure is not None)
        health = stream.health
        assert health.state is StreamState.LOST
        assert "of the listener" in health.failure
        assert health.findings == (health.failure,)
        assert isinstance(stream.failure, ValueError)
        until(lambda: line.written.count(b"AT+GSD=STOP\r\n") == 2)  # before the start, and at the end
    assert stream.health.state is StreamState.LOST


def test_a_listener_of_changes_that_raises_ends_it_too():
    line = Script(frames(9.0))
    with SensorStream("sri+tcp://h?rate=100", lambda _: None, raising, line=line) as stream:
        until(lambda: stream.failure is not None)
    assert stream.health.state is StreamState.LOST
    assert not any(thread.name == str(stream.address) for thread in threading.enumerate())


def test_a_listener_that_wants_to_exit_does_not_end_the_thread_in_silence():
    line = Script(frames(9.0))
    with SensorStream("sri+tcp://h?rate=100", lambda _: sys.exit(1), line=line) as stream:
        until(lambda: stream.failure is not None)
        until(lambda: stream.health.state is StreamState.LOST)


def test_a_stream_that_is_stopped_has_not_failed():
    heard = Heard()
    with sri(Script(frames(9.0)), heard) as stream:
        heard.until(lambda: len(heard.samples) > 5)
    assert stream.failure is None
    assert heard.changes[-1][1].failure is None


def test_kinematics_that_are_missing_are_refused_at_once(monkeypatch):
    monkeypatch.setitem(sys.modules, "mujoco", None)
    with pytest.raises(InputError, match="MuJoCo"):
        ElfinPoses(DeviceAddress.parse("elfin+tcp://h"), raising, line=Script(frames(0.0)))


@pytest.mark.parametrize(("address", "again"), [("sri+tcp://h?rate=100", True), ("bota+serial:///x", False)])
def test_a_connection_that_is_dead_is_opened_again(monkeypatch, address, again):
    monkeypatch.setattr(reconnecting_stream, "_DEAD_S", 0.3)
    monkeypatch.setattr("contactbench.pipeline.devices.reconnecting_stream._REPLY_S", 0.05)
    heard = Heard()
    line = Script(lambda _line, _now: b"")
    line.write = lambda _: None
    with SensorStream(address, heard.take, heard.change, line=line):
        if again:
            heard.until(lambda: any("nothing received" in finding for finding in heard.findings()))
            until(lambda: line.opened == 2)
        else:  # a serial line is there as long as its plug is
            heard.until(lambda: StreamState.SILENT in heard.states())
            until(lambda: time.monotonic() > line.opened_at[0] + 0.5)
            assert line.opened == 1


def test_a_device_that_takes_connections_and_gives_nothing_is_tried_less_and_less_often():
    def says(_line, now):
        if now > 0.01:
            raise LineLost("closed by the device")
        return b""

    heard = Heard()
    line = Script(says)
    line.write = lambda _: None
    with SensorStream("rdt+udp://h?cpf=1&cpt=1", heard.take, heard.change, line=line) as stream:
        until(lambda: line.opened == 4)
        assert (np.diff(line.opened_at) > (0.1, 0.2, 0.5)).all()
        assert stream.health.reconnected == 0  # no attempt is a reconnection


def test_only_samples_after_a_loss_are_a_reconnection():
    given = frames(1e9)

    def says(line, now):
        if line.opened == 1 and now > 0.3:
            raise LineLost("unplugged")
        return given(line, now)

    class Absent(Script):
        def open(self):
            super().open()
            if self.opened == 2:
                raise LineUnavailable("not there yet")

    heard = Heard()
    with sri(Absent(says), heard) as stream:
        heard.until(lambda: StreamState.LOST in heard.states())
        count = len(heard.samples)
        heard.until(lambda: len(heard.samples) > count)
        assert stream.health.reconnected == 1


# ---- poses that were typed, and poses from CSV ---------------------------------------------------


def typed(address):
    return next(still_track(DeviceAddress.parse(address))(5.0))


def from_file(tmp_path, text, options=""):
    file = tmp_path / "poses.csv"
    file.write_text(text, encoding="utf-8")
    return list(file_track(DeviceAddress.parse(f"poses://{file}{options}"))(100.0))


def test_turns_are_about_fixed_axes():
    pose = typed("still://?rpy=10,20,30")
    expected = Rotation.from_euler("z", 30, degrees=True)
    expected = expected * Rotation.from_euler("y", 20, degrees=True)
    expected = expected * Rotation.from_euler("x", 10, degrees=True)
    assert pytest.approx(expected.as_matrix()) == pose.R_BE
    assert np.isnan(pose.p_BE_B).all()
    assert pose.joints is None
    assert pose.time == 5.0


def test_a_quaternion_is_scalar_first_and_made_unit():
    pose = typed("still://?quaternion=0.707,0,0.707,0")
    assert pytest.approx(Rotation.from_euler("y", 90, degrees=True).as_matrix()) == pose.R_BE
    assert pytest.approx(np.eye(3), abs=1e-14) == pose.R_BE.T @ pose.R_BE


def test_joints_give_the_flange():
    pytest.importorskip("mujoco")
    pose = typed("still://?robot=elfin3&joints=0,0,90,0,90,0")
    assert pose.p_BE_B == pytest.approx([0.324, 0, 0.3035])
    assert pytest.approx(np.diag([-1.0, 1, -1]), abs=1e-9) == pose.R_BE
    assert np.degrees(pose.joints) == pytest.approx([0, 0, 90, 0, 90, 0])


@pytest.mark.parametrize(
    ("address", "part"),
    [
        ("still://?robot=hal&joints=0,0,90,0,90,0", "hal"),
        ("still://?robot=elfin3&joints=0,0,90", "joints"),
        ("still://?robot=elfin3&joints=0,300,90,0,90,0", "joint J2"),
    ],
)
def test_joints_that_cannot_be_are_refused(address, part):
    with pytest.raises(AddressError, match=part):
        open_poses(address, lambda _: None)


def test_a_still_pose_is_given_at_its_rate_on_the_host_clock():
    enough, given, told = threading.Event(), [], []

    def take(samples):
        given.extend(samples)
        if len(given) >= 5:
            enough.set()

    begun = time.monotonic()
    with open_poses("still://?rpy=0,90,0&rate=100", take, told.append) as stream:
        assert enough.wait(10)
        assert stream.health.state is StreamState.STREAMING
    assert not stream.done.is_set()
    assert [told[0].state, told[-1].state] == [StreamState.STREAMING, StreamState.CLOSED]
    assert np.diff([pose.time for pose in given]) == pytest.approx(0.01)
    assert begun <= given[0].time
    assert given[-1].time <= time.monotonic()  # none before its time


def test_quaternions_and_positions(tmp_path):
    poses = from_file(
        tmp_path,
        "t,qw,qx,qy,qz,x,y,z\n7,1,0,0,0,0.1,0.2,0.3\n7.5,0,1,0,0,,,\n9,0,0,0.99,0,1,2,3\n",
        "?speed=2",
    )
    assert [pose.time for pose in poses] == [100.0, 100.25, 101.0]
    assert poses[0].p_BE_B.tolist() == [0.1, 0.2, 0.3]
    assert np.isnan(poses[1].p_BE_B).all()
    assert pytest.approx(np.diag([-1.0, 1, -1])) == poses[2].R_BE


def test_joints_of_a_file(tmp_path):
    pytest.importorskip("mujoco")
    poses = from_file(tmp_path, "t,j1,j2,j3,j4,j5,j6\n0,0,0,90,0,90,0\n", "?robot=elfin3")
    assert poses[0].p_BE_B == pytest.approx([0.324, 0, 0.3035])
    assert np.degrees(poses[0].joints) == pytest.approx([0, 0, 90, 0, 90, 0])


def test_a_file_has_an_end(tmp_path):
    file = tmp_path / "poses.csv"
    file.write_text("t,qw,qx,qy,qz\n" + "".join(f"{t / 100},1,0,0,0\n" for t in range(50)), encoding="utf-8")
    given, told = [], []
    with open_poses(f"poses://{file}?speed=100", given.extend, told.append) as stream:
        assert stream.done.wait(10)
    assert len(given) == 50
    assert (stream.health.state, stream.health.findings) == (StreamState.CLOSED, ())
    assert told[-1].state is StreamState.CLOSED


@pytest.mark.parametrize(
    ("text", "part"),
    [
        ("t,qw,qx,qy\n0,1,0,0\n", "qz"),
        ("qw,qx,qy,qz\n1,0,0,0\n", "t"),
        ("t,qw,qx,qy,qz\n", "no row"),
        ("t,qw,qx,qy,qz\n0,1,0,0,0\n1,2,0,0,0\n", "line 3"),
        ("t,qw,qx,qy,qz\n0,1,0,0,0\n1,1e200,1e200,0,0\n", "line 3"),
        ("t,qw,qx,qy,qz\n1,1,0,0,0\n0,1,0,0,0\n", "line 3"),
        ("t,qw,qx,qy,qz\n0,1,0,0,0\nnan,1,0,0,0\n", "line 3"),
        ("t,qw,qx,qy,qz\n0,1,0,0,0\n1e300,1,0,0,0\n", "line 3"),
        ("t,qw,qx,qy,qz,x,y\n0,1,0,0,0,1,1\n", "x, y, z"),
        ("t,qw,qx,qy,qz,x,y,z\n0,1,0,0,0,1,1,324\n0,1,0,0,0,1,1,3240\n", "metres"),
        ("t,j1,j2,j3,j4,j5,j6\n0,0,0,0,0,0,0\n", "robot"),
    ],
)
def test_files_that_cannot_be_used_name_the_place(tmp_path, text, part):
    with pytest.raises(PoseTrackError, match=part):
        from_file(tmp_path, text)


def test_a_file_that_is_not_there(tmp_path):
    with pytest.raises(PoseTrackError, match="no such file"):
        open_poses(f"poses://{tmp_path}/none.csv", lambda _: None)


numbers = st.one_of(st.floats(), st.floats(-1, 1), st.just(1.0), st.just(0.0))


@settings(max_examples=25, deadline=None)
@given(st.lists(st.lists(numbers, min_size=8, max_size=8), min_size=1, max_size=4))
def test_any_numbers_are_rotations_or_an_error(tmp_path_factory, rows):
    lines = [",".join(map(repr, row)) for row in rows]
    text = "t,qw,qx,qy,qz,x,y,z\n" + "\n".join(lines) + "\n"
    try:
        poses = from_file(tmp_path_factory.mktemp("p"), text)
    except PoseTrackError:
        return
    for pose in poses:
        assert np.abs(pose.R_BE.T @ pose.R_BE - np.eye(3)).max() < 1e-12
        assert np.isfinite(pose.time)
