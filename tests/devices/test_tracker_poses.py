"""A tracker over OpenIGTLink, emulated on a real socket, and served by an independent program."""

from __future__ import annotations

import time
from contextlib import ExitStack

import numpy as np
import pytest
from devices.test_reconnecting_stream import Script as Line
from devices.test_sensor import Heard, fault
from scipy.spatial.transform import Rotation
from waiting import until

from contactbench.pipeline.devices.emulate import emulator, swinging
from contactbench.pipeline.devices.faults import Fault, constant
from contactbench.pipeline.devices.protocols import igtl
from contactbench.pipeline.devices.protocols.igtl import IgtlError
from contactbench.pipeline.devices.protocols.igtl_pose import BODY, BodyStream, IgtlModel
from contactbench.pipeline.devices.reconnecting_stream import ParsedPoses, poses_from
from contactbench.pipeline.devices.stream import StreamState
from contactbench.pipeline.devices.url import DeviceAddress

R_TB = Rotation.from_rotvec(IgtlModel.rest[3:]).as_matrix()
P_TB_T = np.array(IgtlModel.rest[:3])


def line(name: str, stamp: int, p: np.ndarray = P_TB_T) -> bytes:
    return igtl.pack(igtl.TRANSFORM, name, stamp, igtl.transform(R_TB, p))


@pytest.mark.parametrize("options", ["", f"?device={BODY}", f"?device={BODY}&rate=100"])
def test_a_body_stands_in_for_the_flange(options: str) -> None:
    heard = Heard()
    with (
        emulator("igtl", signal=constant(IgtlModel.rest)) as device,
        poses_from(device.url + options, heard.take, heard.change) as stream,
    ):
        heard.until(lambda: len(heard.samples) > 20)
        assert stream.health.state is StreamState.STREAMING
        assert stream.health.counters.bad_checksums == stream.health.counters.skipped_bytes == 0
    for sample in heard.samples:
        assert pytest.approx(R_TB, abs=1e-6) == sample.R_BE
        assert pytest.approx(P_TB_T, abs=1e-6) == sample.p_BE_B
        assert sample.time <= sample.arrival
    clock = [sample.device_time - sample.time for sample in heard.samples]
    assert np.ptp(clock) < 5e-3  # the server's clock counts, not the arrivals
    assert len(device.commands) == (2 if "rate" in options else 0)
    assert device.refused == []


@pytest.mark.parametrize("kind", [Fault.SPLIT, Fault.MERGED, Fault.GARBAGE, Fault.BAD_CHECKSUM, Fault.STALL])
def test_only_damaged_messages_are_lost(kind: Fault) -> None:
    heard = Heard()
    with (
        emulator("igtl", rate=100.0, signal=swinging("igtl"), script=fault(kind, 0.2, 0.3)) as device,
        poses_from(device.url, heard.take, heard.change),
    ):
        heard.until(lambda: len(heard.samples) > 80)
        got = list(heard.samples)
        sent = {
            round(1.7e9 + each.moment.clock, 4): each.reading.values
            for each in list(device.log)
            if each.intact
        }
    for sample in got:
        wanted = sent[round(sample.device_time, 4)]
        assert sample.p_BE_B == pytest.approx(wanted[:3], abs=1e-6)
        assert Rotation.from_matrix(sample.R_BE).as_rotvec() == pytest.approx(wanted[3:], abs=1e-5)


def test_a_lost_tracker_is_connected_again() -> None:
    heard = Heard()
    with (
        emulator("igtl", signal=swinging("igtl"), script=fault(Fault.DISCONNECT, 0.4, 0.4)) as device,
        poses_from(device.url, heard.take, heard.change) as stream,
    ):
        heard.until(lambda: StreamState.LOST in heard.states())
        count = len(heard.samples)
        heard.until(lambda: len(heard.samples) > count + 10)
        assert stream.health.reconnected >= 1


def test_an_independent_server_is_understood() -> None:
    pyigtl = pytest.importorskip("pyigtl")
    server = pyigtl.OpenIGTLinkServer(port=0)
    heard, matrix = Heard(), np.eye(4)
    matrix[:3, :3], matrix[:3, 3] = R_TB, 1e3 * P_TB_T
    address = f"igtl+tcp://127.0.0.1:{server.server_address[1]}?device=Tool"
    with ExitStack() as stack:
        stack.callback(server.stop)
        stack.enter_context(poses_from(address, heard.take))
        for name, mm in (("Other", np.zeros(3)), ("Tool", 1e3 * P_TB_T)):
            matrix[:3, 3] = mm
            server.send_message(
                pyigtl.TransformMessage(matrix.copy(), device_name=name, timestamp=time.time())
            )
        heard.until(lambda: heard.samples)
        assert heard.samples[0].p_BE_B == pytest.approx(P_TB_T, abs=1e-6)
        assert pytest.approx(R_TB, abs=1e-6) == heard.samples[0].R_BE


def test_several_bodies_need_a_choice() -> None:
    bodies = BodyStream()
    assert len(bodies.feed(line("A", 10**9) + line("A", 2 * 10**9), 1.0)) == 2
    with pytest.raises(IgtlError, match=r"several bodies \(A, B\): add \?device=NAME"):
        bodies.feed(line("B", 3 * 10**9), 1.0)
    chosen = BodyStream("B")
    assert len(chosen.feed(line("A", 10**9) + line("B", 10**9), 1.0)) == 1


def test_a_measurement_that_is_sent_again_is_no_new_one() -> None:
    bodies = BodyStream()
    found = bodies.feed(line(BODY, 10**9) * 3 + line(BODY, 2 * 10**9) + line(BODY, 0) * 2, 1.0)
    assert [sample.device_time for sample in found] == [1.0, 2.0, None, None]
    assert bodies.counters.duplicates == 2


def test_a_body_that_is_not_there_is_said() -> None:
    heard, stamps = Heard(), iter(range(1, 10**6))
    talk = Line(lambda *_: line("A", next(stamps) * 10**9))
    where = DeviceAddress.parse("igtl+tcp://h?device=B")
    with ParsedPoses(where, BodyStream("B"), heard.take, heard.change, line=talk):
        until(lambda: any("sends no body 'B', only A" in each for each in heard.findings()))
    assert heard.samples == []


def test_a_pose_that_is_none_is_said_and_dropped() -> None:
    bodies = BodyStream()
    assert bodies.feed(igtl.pack(igtl.TRANSFORM, BODY, 1, bytes(48)), 1.0) == []
    assert "orientation is no rotation" in bodies.troubles()["pose"]
    assert bodies.counters.bad_checksums == 1
    assert len(bodies.feed(line(BODY, 10**9), 1.0)) == 1
    assert bodies.troubles() == {}
