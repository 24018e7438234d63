"""Poses that were typed, and poses from CSV."""

from __future__ import annotations

import threading
import time

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from contactbench.pipeline.devices.driver import AddressError
from contactbench.pipeline.devices.pose_source import file_track, still_track
from contactbench.pipeline.devices.stream import StreamState
from contactbench.pipeline.devices.url import DeviceAddress
from contactbench.pipeline.streams import PoseTrackError, open_poses


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
