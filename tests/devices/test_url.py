import math
from urllib.parse import urlencode

import pytest
from hypothesis import given
from hypothesis import strategies as st

from contactbench.pipeline.devices.driver import AddressError, Carrier
from contactbench.pipeline.devices.url import STEPWISE, DeviceAddress, Protocol

parse = DeviceAddress.parse


def test_each_protocol_has_its_defaults():
    sri = parse("sri+serial:///dev/ttyUSB0")
    assert (sri.protocol, sri.carrier, sri.path, sri.baud, sri.rate) == (
        "sri",
        Carrier.SERIAL,
        "/dev/ttyUSB0",
        115_200,
        200.0,
    )
    assert parse("bota+serial:///dev/ttyUSB0").baud == 460_800
    assert parse("robotiq+serial:///dev/ttyUSB0").baud == 19_200
    ports = {"sri+tcp": 4008, "rdt+udp": 49_152, "elfin+tcp": 10_003, "ur+tcp": 30_004, "igtl+tcp": 18_944}
    for scheme, port in ports.items():
        address = parse(f"{scheme}://192.168.0.108")
        assert (address.host, address.port, address.path) == ("192.168.0.108", port, "")
    assert parse("replay:///data/a%20b.mcap").path == "/data/a b.mcap"
    assert parse("replay:///data/a.mcap").speed == 1.0


def test_what_is_given_counts():
    assert parse("sri+serial:///dev/ttyUSB0?baud=921600&rate=1000").rate == 1000.0
    assert parse("sri+tcp://[::1]:5000").host == "::1"
    onrobot = parse("rdt+udp://box.local:5000?profile=onrobot&cpt=2e5")
    assert (onrobot.port, onrobot.options["cpf"], onrobot.options["cpt"]) == (5000, 1e4, 2e5)
    assert parse("replay:///a.mcap?speed=4").speed == 4.0
    assert parse("replay:///a.mcap?speed=step").speed == STEPWISE


def test_ports_and_drives_of_windows():
    assert parse("sri+serial://COM3?baud=115200").path == "COM3"
    assert parse("sri+serial:///COM3").path == "COM3"
    assert parse("replay:///C:/data/a.mcap").path == "C:/data/a.mcap"


def test_typed_poses():
    turned = parse("still://?rpy=0,-17.5,90")
    assert (turned.protocol, turned.carrier, turned.rate) == (Protocol.STILL, Carrier.TYPED, 10.0)
    assert turned.rpy_degrees == (0.0, -17.5, 90.0)
    assert parse("still://?quaternion=1,0,0,0&rate=2").quaternion == (1.0, 0.0, 0.0, 0.0)
    jointed = parse("still://?robot=elfin3&joints=0,-17,69,0,52,0")
    assert (jointed.robot, jointed.joints_degrees) == ("elfin3", (0.0, -17.0, 69.0, 0.0, 52.0, 0.0))
    assert str(turned) == "still://?rate=10&rpy=0,-17.5,90"


def test_files_of_poses():
    poses = parse("poses:///data/poses.csv?robot=elfin3")
    assert (poses.path, poses.speed, poses.robot) == ("/data/poses.csv", 1.0, "elfin3")
    assert parse("replay:///a.mcap?topic=/wrench2").topic == "/wrench2"


def test_what_gives_what():
    assert parse("ur+tcp://r").gives_wrenches
    assert parse("ur+tcp://r").gives_poses
    for text in ("elfin+tcp://r", "still://?rpy=0,0,0", "poses:///a.csv"):
        assert parse(text).gives_poses
        assert not parse(text).gives_wrenches
    assert parse("sri+tcp://r").gives_wrenches
    assert not parse("sri+tcp://r").gives_poses
    both = parse("replay:///a.mcap")
    assert both.gives_poses
    assert both.gives_wrenches


@pytest.mark.parametrize(
    ("text", "part"),
    [
        ("", "scheme missing"),
        ("/dev/ttyUSB0", "scheme"),
        ("http://192.168.0.1", "scheme http"),
        ("bota+tcp://h", "scheme bota"),
        ("sri+tcp://", "host"),
        ("sri+tcp://a b", "host"),
        ("sri+tcp://me@h", "user name"),
        ("sri+tcp://h/x", "path"),
        ("sri+tcp://h:0", "port"),
        ("sri+tcp://h:65536", "port"),
        ("sri+tcp://h:x", "port"),
        ("sri+tcp://[::1", "host"),
        ("sri+serial://", "path"),
        ("sri+serial://dev/ttyUSB0", "host 'dev'"),
        ("sri+serial:///dev/ttyUSB0?baud=fast", "baud"),
        ("sri+serial:///dev/ttyUSB0?baud=²", "baud"),
        ("sri+serial:///dev/ttyUSB0?baud=1&baud=2", "twice"),
        ("sri+serial:///dev/ttyUSB0?baud", "options"),
        ("sri+serial:///dev/ttyUSB0?speed=2", "'speed'"),
        ("sri+serial:///dev/ttyUSB0?rate=372", "at most 371"),
        ("bota+serial:///dev/ttyUSB0?rate=1246", "at most 1245"),
        ("sri+tcp://h?rate=nan", "rate"),
        ("sri+tcp://h?rate=-1", "rate"),
        ("rdt+udp://h?profile=other", "profile"),
        ("replay:///a.mcap?speed=0", "speed"),
        ("replay://", "path"),
        ("replay:///a%00b", "path"),
        ("replay:///a#b", "%23"),
        ("sri+tcp://h\n", "control character"),
        ("still://", "pose"),
        ("still://here?rpy=0,0,0", "no host or path"),
        ("still:///x?rpy=0,0,0", "no host or path"),
        ("still://?rpy=0,0,0&quaternion=1,0,0,0", "one of"),
        ("still://?rpy=0,0", "3 numbers"),
        ("still://?rpy=0,0,x", "rpy"),
        ("still://?rpy=0,0,nan", "rpy"),
        ("still://?rpy=0,0,inf", "rpy"),
        ("still://?quaternion=1,0,0", "4 numbers"),
        ("still://?quaternion=1,1,0,0", "length"),
        ("still://?quaternion=0,0,0,0", "length"),
        ("still://?joints=0,0,0", "robot"),
        ("still://?rpy=0,0,0&robot=elfin3", "robot"),
        ("still://?robot=elfin3&joints=" + "0," * 70, "1 to 64"),
        ("still://?robot=&joints=0", "robot"),
        ("still://?rpy=0,0,0&rate=0", "rate"),
        ("still://?rpy=0,0,0&rate=1001", "rate"),
        ("poses://", "poses.csv"),
        ("poses:///a.csv?speed=step", "speed"),
        ("replay:///a.mcap?topic=", "topic"),
    ],
)
def test_wrong_addresses_name_the_part(text: str, part: str):
    with pytest.raises(AddressError) as failed:
        parse(text)
    assert part in str(failed.value)
    assert repr(text) in str(failed.value)


_HOSTS = st.sampled_from(["h", "192.168.0.1", "::1", "box.local"])
_PATHS = st.text(st.characters(min_codepoint=33, exclude_categories=["Cs", "Cc"]), min_size=1).map(
    lambda name: f"/dev/{name}"
)


@given(_HOSTS, st.integers(1, 65_535), _PATHS, st.floats(0.001, 300), st.integers(93_000, 12_000_000))
def test_what_is_written_is_read_back(host: str, port: int, path: str, rate: float, baud: int):
    for address in (
        DeviceAddress("sri", Carrier.TCP, host=host, port=port, rate=rate),
        DeviceAddress("sri", Carrier.SERIAL, path=path, baud=baud, rate=rate),
        DeviceAddress(Protocol.REPLAY, Carrier.FILE, path=path, speed=STEPWISE),
        DeviceAddress(
            "rdt", Carrier.UDP, host=host, port=port, options={"profile": "ati", "cpf": 1e6, "cpt": rate}
        ),
    ):
        assert parse(str(address)) == address


_DEGREES = st.floats(-3600, 3600)
_NAMES = st.text(st.characters(exclude_categories=["C", "Z"]), min_size=1)


@given(_PATHS, _NAMES, st.tuples(_DEGREES, _DEGREES, _DEGREES), st.floats(0.001, 1e3))
def test_what_is_typed_is_read_back(path: str, name: str, degrees: tuple[float, ...], number: float):
    w, x, y = (math.sin(angle) for angle in degrees)
    size = math.hypot(w, x, y, 1.0)
    unit = (w / size, x / size, y / size, 1.0 / size)
    still = {"protocol": Protocol.STILL, "carrier": Carrier.TYPED, "rate": number}
    for address in (
        DeviceAddress(**still, rpy_degrees=degrees),
        DeviceAddress(**still, quaternion=unit),
        DeviceAddress(**still, joints_degrees=degrees * 2, robot=name),
        DeviceAddress(Protocol.POSES, Carrier.FILE, path=path, speed=number, robot=name),
        DeviceAddress(Protocol.REPLAY, Carrier.FILE, path=path, speed=number, topic=name),
    ):
        assert parse(str(address)) == address


_QUERIES = st.lists(
    st.tuples(
        st.sampled_from(["rpy", "quaternion", "joints", "robot", "rate", "speed", "topic"]),
        st.one_of(st.text(), st.lists(st.one_of(st.integers(-400, 400), st.floats())).map(repr)),
    )
).map(lambda pairs: urlencode({name: value.strip("[]").replace(" ", "") for name, value in pairs}))


@given(
    st.one_of(
        st.text(),
        st.text().map(lambda text: f"sri+tcp://{text}"),
        st.text().map("replay://{}".format),
        st.text().map("still://?{}".format),
        _QUERIES.map("still://?{}".format),
        _QUERIES.map("poses:///a.csv?{}".format),
        _QUERIES.map("replay:///a.mcap?{}".format),
    )
)
def test_any_text_is_an_address_or_an_address_error(text: str):
    try:
        address = parse(text)
    except AddressError:
        return
    assert parse(str(address)) == address


def test_the_tool_of_a_ur_is_typed_as_on_its_pendant():
    address = parse("ur+tcp://192.168.0.9?tool=0,0,0.14,0,0,1.5708")
    assert address.options["tool"] == (0, 0, 0.14, 0, 0, 1.5708)
    assert parse(str(address)) == address
    for wrong in ("1,2,3", "0,0,0,0,0,nan", "0,0,140,0,0,0"):
        with pytest.raises(AddressError, match="tool"):
            parse(f"ur+tcp://192.168.0.9?tool={wrong}")
    with pytest.raises(AddressError, match="unknown option 'tool'"):
        parse("sri+tcp://192.168.0.9?tool=0,0,0,0,0,0")


@pytest.mark.parametrize("zone", ["%25eth0", "%eth0"])
def test_a_link_local_address_names_its_interface(zone: str):
    address = parse(f"sri+tcp://[fe80::1{zone}]:4008")
    assert address.host == "fe80::1%eth0"
    assert parse(str(address)) == address


@pytest.mark.parametrize("host", ["a%25eth0", "[fe80::1%25]", "[fe80::1%25e/0]"])
def test_a_zone_that_cannot_be_is_refused(host: str):
    with pytest.raises(AddressError, match="address"):
        parse(f"sri+tcp://{host}:4008")
