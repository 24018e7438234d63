"""Lines of text and JSON with a declared layout: read exactly, or dropped and counted."""

import json
import math
import os
import socket
import threading
from itertools import pairwise
from urllib.parse import urlencode

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from contactbench.pipeline.devices.driver import AddressError
from contactbench.pipeline.devices.emulate import emulator
from contactbench.pipeline.devices.faults import Fault, Script, sine
from contactbench.pipeline.devices.protocols.line import LineParser, LineWrenches, pose_maker
from contactbench.pipeline.devices.protocols.line_layout import OPTIONS, Layout, unescaped, with_file
from contactbench.pipeline.devices.protocols.registry import driver_for
from contactbench.pipeline.devices.sample import Status
from contactbench.pipeline.devices.url import DeviceAddress
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.streams import open_poses, open_sensor

WRENCH = "fx,fy,fz,mx,my,mz"
LBF = 4.4482216152605
WAIT_S = 10.0


def layout(**options: str) -> Layout:
    return Layout.of(with_file({key: OPTIONS[key].read(value) for key, value in options.items()}))


def read(lines: bytes, *, datagrams: bool = True, **options: str):
    parser = LineWrenches(layout(**options), datagrams=datagrams)
    return parser.feed(lines, 1.0), parser.counters


def sensor(query: str):
    return driver_for(DeviceAddress.parse(f"line+tcp://h?{query}"))


# ---- what is read ------------------------------------------------------------------------------


def test_columns_in_any_order_and_unit():
    (sample,), _ = read(
        b"250;7;10;-20;30;1000;2000;-3000;0;x;y\n",
        fields="t,n,fz,fy,fx,mx,my,mz,status,*",
        force="lbf",
        torque="N-mm",
        time="ms",
        flip="fz,mx",
    )
    assert sample.force == pytest.approx((30 * LBF, -20 * LBF, -10 * LBF))
    assert sample.torque == pytest.approx((-1.0, 2.0, -3.0))
    assert (sample.sequence, sample.device_time, sample.status, sample.time) == (7, 0.25, Status.OK, 1.0)


def test_json_by_keys_and_places():
    line = json.dumps(
        {"header": {"stamp": 2.5}, "wrench": [[1, -2, 3.5], {"x": 0.1, "y": -0.2, "z": "0.05"}]}
    )
    (sample,), _ = read(
        line.encode(),
        fields="t:header.stamp,fx:wrench.0.0,fy:wrench.0.1,fz:wrench.0.2,mx:wrench.1.x,my:wrench.1.y,mz:wrench.1.z",
    )
    assert (sample.force, sample.torque, sample.device_time) == ((1, -2, 3.5), (0.1, -0.2, 0.05), 2.5)


def test_a_number_of_newtons_may_stand_for_a_unit():
    (sample,), _ = read(b"100 0 -100 1 0 -1\n", fields=WRENCH, force="0.01", torque="0.001")
    assert (sample.force, sample.torque) == ((1.0, 0.0, -1.0), (0.001, 0.0, -0.001))


@pytest.mark.parametrize(
    ("separator", "line"),
    [
        ("auto", b" 1, -2 ,3.5,  0.1,-0.2,0.05\r\n"),
        ("auto", b" 1  -2 3.5   0.1 -0.2 0.05 \r\n"),
        ("auto", b"1; -2 ;3.5;0.1;-0.2;0.05;\r\n"),
        ("auto", b"1\t-2\t 3.5\t0.1\t-0.2\t0.05\t\n"),
        ("comma", b"1, -2 ,3.5,0.1,-0.2,0.05\r\n"),
        ("semicolon", b"1;-2;3.5;0.1;-0.2;0.05\n"),
        ("tab", b"1\t-2\t3.5\t0.1\t-0.2\t0.05\n"),
        ("space", b"1 -2 3.5 0.1 -0.2 0.05\n"),
        ("auto", b"[1, -2, 3.5, 0.1, -0.2, 0.05]\n"),
        ("auto", b" p[1,-2,3.5,0.1,-0.2,0.05]\r\n"),
        ("auto", b"(1 -2 3.5 0.1 -0.2 0.05)\n"),
        ("auto", b"1N, -2 N, 0.0035kN, 100 Nmm, -0.2N-m, 0.05Nm\n"),
    ],
)
def test_separators(separator: str, line: bytes):
    (sample,), _ = read(line, fields=WRENCH, separator=separator)
    assert sample.force + sample.torque == (1.0, -2.0, 3.5, 0.1, -0.2, 0.05)


@pytest.mark.parametrize(
    ("ok", "well", "ill"),
    [("OK", b"OK", b"E7"), ("0", b"0.0", b"1"), ("0", b"00", b"nan"), ("0x10", b"0x10", b"16")],
)
def test_a_status_that_is_not_well_is_no_measurement(ok: str, well: bytes, ill: bytes):
    lines = b"1,2,3,4,5,6,%b\n1,2,3,4,5,6,%b\n" % (well, ill)
    samples, _ = read(lines, fields=f"{WRENCH},status", ok=ok)
    assert [each.status for each in samples] == [Status.OK, Status.ERROR | Status.INVALID]


@pytest.mark.parametrize(
    ("ok", "well", "ill"),
    [("true", "true", "false"), ("False", "false", "true"), ("1", "true", "0"), ("0", "false", "null")],
)
def test_a_status_of_json_may_be_true_or_false(ok: str, well: str, ill: str):
    fields = ",".join(f"{role}:f.{place}" for place, role in enumerate(WRENCH.split(","))) + ",status:s"
    lines = "".join(f'{{"f": [1, 2, 3, 4, 5, 6], "s": {each}}}\n' for each in (well, ill))
    samples, _ = read(lines.encode(), fields=fields, ok=ok)
    assert [each.status for each in samples] == [Status.OK, Status.ERROR | Status.INVALID]


@pytest.mark.parametrize(
    "line",
    [b"1,,2,3,4,5,6", b",1,2,3,4,5,6", b"1\t\t2\t3\t4\t5\t6", b"\t1\t2\t3\t4\t5\t6", b"1,2,3,4,5,6,,7"],
)
def test_an_empty_column_drops_the_line_and_shifts_nothing(line: bytes):
    samples, counters = read(line + b"\n7,7,7,7,7,7,7,x\n", fields=f"t,{WRENCH},*")
    assert [each.force for each in samples] == [(7, 7, 7)]
    assert counters.bad_checksums == 1


@pytest.mark.parametrize(
    ("line", "why"),
    [
        (b"1,2,3,4,5", "'1,2,3,4,5' has 5 columns, and the option fields 6"),
        (b"1,2,x3,4,5,6", "column fz holds 'x3'"),
        (b"1,2,,4,5,6", "column fz is empty in '1,2,,4,5,6'"),
        (b"1,2,3,4 furlong,5,6", "column mx holds '4 furlong'"),
        (b"[1,2,3,4,5,6", "column fx holds '[1'"),
        (b"1,2,3,4,5,6 N", "column mz holds '6 N'"),
    ],
)
def test_a_line_that_is_left_out_is_shown_with_the_column_that_failed(line: bytes, why: str):
    parser = LineWrenches(layout(fields=WRENCH), datagrams=True)
    for _ in range(3):
        assert parser.feed(line, 5.0) == []
    assert tuple(parser.troubles().values()) == (f"Lines dropped: 3, because {why}.",)


def test_a_unit_behind_a_number_counts_and_a_flipped_sign_stays():
    (sample,), _ = read(b"1 N,2 kN,3,4 Nm,5 Nmm,6\n", fields=WRENCH, force="lbf", torque="Ncm", flip="fy,my")
    assert sample.force == pytest.approx((1.0, -2000.0, 3 * LBF))
    assert sample.torque == pytest.approx((4.0, -0.005, 0.06))


@pytest.mark.parametrize("line", [b"1,5;1,02;2,03", b"1,5\t1,02\t2,03", b"1;2;3\t4;5;6"])
def test_a_line_with_two_separators_is_dropped_and_the_remedy_told(line: bytes):
    parser = LineWrenches(layout(fields=WRENCH), datagrams=True)
    assert parser.feed(line, 5.0) == []
    (what,) = parser.troubles().values()
    assert what.startswith("Lines dropped: 1, because they have more than one of comma, semicolon and tab")
    assert what.endswith("name the separator with the option separator.")
    assert len(parser.feed(b"1,2,3,4,5,6", 8.0)) == 1
    assert parser.troubles() == {}


def test_decimal_commas_between_blanks_are_no_columns():
    samples, counters = read(b"1,5 1,02 2,03\n", fields=WRENCH)
    assert (samples, counters.bad_checksums) == ([], 1)


@pytest.mark.parametrize(
    "line",
    [
        b"1,2,3,4,5",
        b"1,2,3,4,5,6,7",
        b"1,2,3,4,5,x",
        b"1,2,3,4,5,nan",
        b"1,2,3,4,5,inf",
        b"1,2,3,4,5,1e10",
        b"1,2,3,4,5,1_0",
        b"1,2,3,4,5,\xb2",
        b"1,2,3,4,5,",
        b"fx,fy,fz,mx,my,mz",
        b"1,2,3,4,5," + b"6" * 9000,
    ],
)
def test_bad_lines_are_dropped_and_counted(line: bytes):
    samples, counters = read(line + b"\n1,2,3,4,5,6\n", fields=WRENCH)
    assert [each.torque for each in samples] == [(4, 5, 6)]
    assert (counters.frames, counters.bad_checksums, counters.skipped_bytes) == (1, 1, len(line))


@pytest.mark.parametrize(
    "line",
    [
        b"{",
        b"[]",
        b"[" * 5000,
        b'{"f": [1, 2, 3, 4, 5]}',
        b'{"f": [1, 2, 3, 4, 5, NaN]}',
        b'{"f": [1, 2, 3, 4, 5, true]}',
        b'{"f": [1, 2, 3, 4, 5, null]}',
        b'{"f": [1, 2, 3, 4, 5, [6]]}',
        b'{"f": [1, 2, 3, 4, 5, 1' + b"0" * 5000 + b"]}",
        b'{"f": 7}',
        b'\xff{"f": [1, 2, 3, 4, 5, 6]}',
    ],
)
def test_bad_json_is_dropped_and_counted(line: bytes):
    fields = ",".join(f"{role}:f.{place}" for place, role in enumerate(WRENCH.split(",")))
    samples, counters = read(line + b'\n{"f": [1, 2, 3, 4, 5, 6]}\n', fields=fields)
    assert [each.force for each in samples] == [(1, 2, 3)]
    assert counters.bad_checksums == 1


# ---- what is old, cut or repeated --------------------------------------------------------------


def test_the_line_under_way_at_the_beginning_is_not_believed():
    """The end of 112,2,3,4,5,6 looks like a line; so it is after the line was lost."""
    parser = sensor(f"fields={WRENCH}").parser
    assert parser.feed(b"2,2,3,4,5,6\n1,2,3,4,5,6\n1,2,3,", 0.0)[0].force == (1, 2, 3)
    parser.reset()
    assert parser.feed(b"4,2,3,4,5,6\n", 0.0) == []
    assert parser.feed(b"7,2,3,4,5,6\n", 0.0)[0].force == (7, 2, 3)


def test_one_byte_at_a_time_gives_the_same():
    stream = b"#\n" + b"".join(b"%d,1,2,3,4,5,6\n" % n for n in range(20))
    whole = sensor(f"fields=n,{WRENCH}").parser.feed(stream, 0.0)
    parser = sensor(f"fields=n,{WRENCH}").parser
    assert [each for byte in stream for each in parser.feed(bytes([byte]), 0.0)] == whole
    assert [each.sequence for each in whole] == list(range(20))


def test_a_repeated_or_overtaken_datagram_is_not_given_again():
    numbers = [1, 2, 2, 5, 4, 6]
    parser = LineWrenches(layout(fields=f"n,{WRENCH}"), datagrams=True)
    given = [s.sequence for n in numbers for s in parser.feed(b"%d,1,2,3,4,5,6" % n, 0.0)]
    assert given == [1, 2, 5, 6]
    assert (parser.counters.duplicates, parser.counters.lost) == (2, 2)
    by_time = LineWrenches(layout(fields=f"t,{WRENCH}", time="ms"), datagrams=True)
    given = [s.device_time for n in numbers for s in by_time.feed(b"%d,1,2,3,4,5,%d" % (n, n), 0.0)]
    assert given == [0.001, 0.002, 0.005, 0.006]
    assert by_time.feed(b"-2000,1,2,3,4,5,6", 0.0)  # its clock was set


def test_equal_lines_without_time_or_count_are_readings():
    samples, counters = read(b"1,2,3,4,5,6\n" * 3, fields=WRENCH)
    assert (len(samples), counters.duplicates) == (3, 0)


def test_a_datagram_that_was_cut_is_not_believed():
    parser = LineWrenches(layout(fields=WRENCH), datagrams=True)
    assert len(parser.feed(b"1,2,3,4,5,61\n", 0.0)) == 1
    assert parser.feed(b"1,2,3,4,5,6", 0.0) == []
    assert parser.counters.bad_checksums == 1


def test_a_count_runs_round():
    samples, counters = read(
        b"".join(b"%d,1,2,3,4,5,6\n" % (n % 256) for n in range(250, 260)), fields=f"n,{WRENCH}", bits="8"
    )
    assert [each.sequence for each in samples] == list(range(250, 260))
    assert counters.wraps == 1


@given(
    st.lists(
        st.binary(max_size=60) | st.sampled_from([b"1,2,3,4,5,6", b"\n", b",", b"-", b"1e5"]), max_size=30
    )
)
def test_any_bytes_are_survived(pieces: list[bytes]):
    for datagrams in (True, False):
        parser = LineWrenches(layout(fields=WRENCH), datagrams=datagrams)
        for piece in pieces:
            for sample in parser.feed(piece, 0.0):
                assert all(map(math.isfinite, sample.force + sample.torque))
        stream = LineWrenches(layout(fields=WRENCH), datagrams=False)
        stream.feed(b"".join(pieces) + b"\n", 0.0)
        assert [s.force for s in stream.feed(b"1,2,3,4,5,6\n", 0.0)] == [(1, 2, 3)]


def test_the_buffer_stays_small():
    parser = LineWrenches(layout(fields=WRENCH), datagrams=False)
    for _ in range(100):
        parser.feed(b"1" * 1000, 0.0)
        assert parser.pending <= 8192
    assert parser.counters.skipped_bytes + parser.pending == 100_000


# ---- poses -------------------------------------------------------------------------------------


@pytest.mark.parametrize("rotation", [None, "vector", "rpy"])
def test_poses_in_any_way(rotation: str | None):
    turned = Rotation.from_euler("xyz", [0.3, -0.4, 1.1])
    x, y, z, w = turned.as_quat().tolist()
    if rotation is None:
        made = pose_maker(layout(fields="x,y,z,qw,qx,qy,qz", length="mm"))
        numbers = {"qw": w, "qx": x, "qy": y, "qz": z}
    else:
        made = pose_maker(layout(fields="x,y,z,rx,ry,rz", rotation=rotation))
        vector = turned.as_rotvec() if rotation == "vector" else [0.3, -0.4, 1.1]
        numbers = dict(zip(("rx", "ry", "rz"), vector, strict=True))
    sample = made({"x": 0.1, "y": 0.2, "z": 0.3, **numbers}, 5.0, Status.OK, None)
    assert not isinstance(sample, str)
    assert pytest.approx(turned.as_matrix()) == sample.R_BE
    assert sample.p_BE_B == pytest.approx([0.1, 0.2, 0.3])
    assert made({"x": 1e6, "y": 0.2, "z": 0.3, **numbers}, 5.0, Status.OK, None) == ""


def test_a_quaternion_of_another_length_is_dropped():
    made = pose_maker(layout(fields="qw,qx,qy,qz"))
    assert made({"qw": 1.0, "qx": 1.0, "qy": 0.0, "qz": 0.0}, 0.0, Status.OK, None) == ""
    sample = made({"qw": 1.0, "qx": 0.0, "qy": 0.0, "qz": 0.0}, 0.0, Status.OK, None)
    assert not isinstance(sample, str)
    assert np.isnan(sample.p_BE_B).all()


@pytest.mark.parametrize(
    ("carrier", "options"),
    [
        ("tcp", {"fields": "t,x,y,z,rx,ry,rz", "rotation": "rpy", "angle": "deg", "length": "mm"}),
        ("udp", {"fields": "t,qw,qx,qy,qz,x,y,z"}),
        (
            "serial",
            {"fields": "t:a,q1:q.0,q2:q.1,q3:q.2,q4:q.3,q5:q.4,q6:q.5", "robot": "elfin3", "angle": "deg"},
        ),
    ],
)
def test_a_robot_of_lines_tells_the_flange_of_its_joints(carrier: str, options: dict[str, str]):
    from contactbench.pipeline.devices.protocols.arms import ELFIN3_TABLE, flange_pose

    R_BE, p_BE_B = flange_pose(ELFIN3_TABLE, (0.3, -0.4, 1.1, 0.5, -0.7, 0.9))
    heard, enough = [], threading.Event()

    def take(samples):
        heard.extend(samples)
        if len(heard) > 5:
            enough.set()

    with emulator("line", carrier, options=options) as device, open_poses(device.url, take):
        assert enough.wait(WAIT_S)
    assert pytest.approx(R_BE, abs=1e-6) == heard[0].R_BE
    assert heard[0].p_BE_B == pytest.approx(p_BE_B, abs=1e-6)


@pytest.mark.parametrize(
    ("options", "good", "bad"),
    [
        ({"fields": "rx,ry,rz", "rotation": "rpy"}, (3.0, -6.28, 0.1), (30.0, 0.1, 0.2)),
        ({"fields": "rx,ry,rz", "rotation": "vector"}, (3.0, -3.0, 0.1), (5.0, 5.0, 0.2)),
        ({"fields": "q1,q2,q3,q4,q5,q6", "robot": "elfin3"}, (0.3,) * 6, (0.3, 30.0, 0.3, 0.3, 0.3, 0.3)),
    ],
)
def test_degrees_that_were_not_declared_are_dropped_and_asked_for(options, good, bad):
    declared = layout(**options)
    parser = LineParser(declared, pose_maker(declared), datagrams=True)
    assert len(parser.feed(",".join(map(str, good)).encode(), 1.0)) == 1
    assert parser.troubles() == {}
    assert parser.feed(",".join(map(str, bad)).encode(), 1.0) == []
    assert parser.counters.bad_checksums == 1
    (what,) = parser.troubles().values()
    assert what.endswith("if they are degrees, set the option angle of the address to deg.")
    in_degrees = layout(**options, angle="deg")
    assert (
        len(
            LineParser(in_degrees, pose_maker(in_degrees), datagrams=True).feed(
                ",".join(map(str, bad)).encode(), 1.0
            )
        )
        == 1
    )


def test_joints_need_as_many_as_the_robot_has():
    with pytest.raises(InputError, match="it has 6 joints, and the lines have 2"):
        open_poses("line+tcp://h?fields=q1,q2&robot=elfin3", lambda _: None)
    with pytest.raises(InputError, match="no robot named"):
        open_poses("line+tcp://h?fields=q1,q2&robot=other", lambda _: None)


# ---- on real lines -----------------------------------------------------------------------------


@pytest.mark.parametrize("carrier", ["udp", "tcp", "serial"])
@pytest.mark.parametrize("fault", [Fault.BAD_CHECKSUM, Fault.GARBAGE, Fault.MERGED, Fault.SPLIT, Fault.STALL])
def test_faults_make_nothing_up(carrier: str, fault: Fault):
    heard, enough = [], threading.Event()

    def take(samples):
        heard.extend(samples)
        if heard[-1].device_time > 0.9:
            enough.set()

    script = Script([(0.3, fault, 0.3)])
    options = {"fields": f"n,t,{WRENCH},status"}
    signal = sine((5, 5, 5, 0.1, 0.1, 0.1))
    device = emulator("line", carrier, options=options, signal=signal, script=script)
    with device, open_sensor(device.url, take):
        assert enough.wait(WAIT_S)
    sent = {each.moment.number: each.reading.values for each in device.intact()}
    for sample in heard:
        assert sample.force + sample.torque == pytest.approx(sent[sample.sequence], abs=1e-8)
    assert all(a.sequence < b.sequence for a, b in pairwise(heard))


def test_a_device_is_told_to_start_and_stop():
    options = {"fields": WRENCH, "start": "GO\\r\\n", "stop": "HALT\\r\\n"}
    enough = threading.Event()
    device = emulator("line", "tcp", options=options)
    with device, open_sensor(device.url, lambda _: enough.set()):
        assert enough.wait(WAIT_S)
    assert device.commands == [b"GO\r\n"]


def test_a_device_that_sends_by_itself_is_listened_to():
    heard, enough = [], threading.Event()

    def take(samples):
        heard.extend(samples)
        enough.set()

    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    with (
        socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as device,
        open_sensor(f"line+udp://127.0.0.1?listen={port}&fields={WRENCH}", take),
    ):
        for _ in range(1000):
            device.sendto(b"1,2,3,4,5,6", ("127.0.0.1", port))
            if enough.wait(0.01):
                break
    assert heard[0].force == (1, 2, 3)


# ---- the declaration ---------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("options", "part"),
    [
        ({}, "say what the columns are"),
        ({"fields": "t,fx"}, "fy, fz, mx, my, mz missing"),
        ({"fields": "t,n"}, "give fx,fy,fz,mx,my,mz of a sensor, or"),
        ({"fields": f"{WRENCH},fx"}, "fx appears twice"),
        ({"fields": f"*,{WRENCH}"}, "put it last"),
        ({"fields": f"{WRENCH},u"}, "'u' is unknown"),
        ({"fields": f"{WRENCH},t:time"}, "give names alone for columns"),
        ({"fields": "t:"}, "give its key"),
        ({"fields": "rx,ry,rz"}, "rotation: give vector or rpy"),
        ({"fields": WRENCH, "rotation": "rpy"}, "rotation: give vector or rpy"),
        ({"fields": "q1,q3", "robot": "elfin3"}, "without a gap"),
        ({"fields": "q1,q2"}, "name the robot"),
        ({"fields": WRENCH, "robot": "elfin3"}, "name the robot"),
        ({"fields": "rx,ry,rz,q1", "rotation": "rpy", "robot": "elfin3"}, "give one of a quaternion"),
        ({"fields": WRENCH, "force": "stone"}, "give a unit"),
        ({"fields": WRENCH, "force": "0"}, "give a unit"),
        ({"fields": WRENCH, "force": "-N"}, "such as -1 to change the sign"),
        ({"fields": WRENCH, "torque": "Nm-"}, "such as -1 to change the sign"),
        ({"fields": "rx,ry,rz", "rotation": "rpy", "angle": "-deg"}, "such as -1 to change the sign"),
        ({"fields": WRENCH, "flip": "t"}, "give some of"),
        ({"fields": WRENCH, "separator": "bar"}, "choose one of"),
        ({"fields": WRENCH, "bits": "0"}, "from 1 to 53"),
        ({"fields": WRENCH, "start": "\x07"}, "control character|printable"),
        ({"layout": "/nowhere/layout.toml"}, "give a TOML or JSON file"),
    ],
)
def test_a_layout_that_cannot_be_is_refused(options: dict[str, str], part: str):
    with pytest.raises(AddressError, match=part):
        DeviceAddress.parse(f"line+tcp://h?{urlencode(options)}")


@pytest.mark.parametrize(
    ("name", "text"),
    [
        (
            "a.toml",
            'fields = ["t", "fx", "fy", "fz", "mx", "my", "mz"]\nforce = "lbf"\ntime = 0.001\nbits = 16\n',
        ),
        ("a.json", '{"fields": "t,fx,fy,fz,mx,my,mz", "force": "lbf", "time": 0.001, "bits": 16}'),
    ],
)
def test_a_layout_may_stand_in_a_file_that_the_address_overrules(tmp_path, name: str, text: str):
    file = tmp_path / name
    file.write_text(text)
    address = DeviceAddress.parse(f"line+tcp://h?layout={file}&force=kN")
    assert (address.options["force"], address.options["bits"], address.options["layout"]) == ("kN", 16, None)
    file.unlink()  # all is in the address now, such as that in a recording
    assert DeviceAddress.parse(str(address)) == address
    assert address.gives_wrenches
    assert not address.gives_poses


def test_a_pipe_is_no_layout(tmp_path):
    os.mkfifo(tmp_path / "a.toml")
    with pytest.raises(AddressError, match="there is no such file"):
        DeviceAddress.parse(f"line+tcp://h?layout={tmp_path}/a.toml")


def test_a_plus_in_an_option_is_a_plus():
    address = DeviceAddress.parse(f"line+tcp://h?fields={WRENCH}&start=AT+GO%20NOW\\r\\n&ok=A%2B")
    assert (address.options["start"], address.options["ok"]) == ("AT+GO NOW\\r\\n", "A+")
    assert DeviceAddress.parse(str(address)) == address


@pytest.mark.parametrize(
    "text", ["fields", "other = 1", "bits = 'x'", "layout = 'b.toml'", "#" * 70_000, "\xff"]
)
def test_a_file_that_is_no_layout_is_refused_by_name(tmp_path, text: str):
    file = tmp_path / "a.toml"
    file.write_text(text, encoding="latin-1")
    with pytest.raises(AddressError, match=r"a\.toml"):
        DeviceAddress.parse(f"line+tcp://h?layout={file}")


def test_escapes():
    assert unescaped("GO\\r\\n\\\\n\\t") == b"GO\r\n\\n\t"
    assert unescaped(None) == b""
