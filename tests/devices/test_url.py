from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from pipeline.devices.url import STEPWISE, AddressError, Carrier, DeviceAddress, Protocol

parse = DeviceAddress.parse


def test_each_protocol_has_its_defaults():
    sri = parse("sri+serial:///dev/ttyUSB0")
    assert (sri.protocol, sri.carrier, sri.path, sri.baud, sri.rate) == (
        Protocol.SRI,
        Carrier.SERIAL,
        "/dev/ttyUSB0",
        115_200,
        200.0,
    )
    assert parse("bota+serial:///dev/ttyUSB0").baud == 460_800
    assert parse("robotiq+serial:///dev/ttyUSB0").baud == 19_200
    ports = {"sri+tcp": 4008, "rdt+udp": 49_152, "elfin+tcp": 10_003, "ur+tcp": 30_004}
    for scheme, port in ports.items():
        address = parse(f"{scheme}://192.168.0.108")
        assert (address.host, address.port, address.path) == ("192.168.0.108", port, "")
    assert parse("replay:///data/a%20b.mcap").path == "/data/a b.mcap"
    assert parse("replay:///data/a.mcap").speed == 1.0


def test_what_is_given_counts():
    assert parse("sri+serial:///dev/ttyUSB0?baud=921600&rate=1000").rate == 1000.0
    assert parse("sri+tcp://[::1]:5000").host == "::1"
    onrobot = parse("rdt+udp://box.local:5000?profile=onrobot&cpt=2e5")
    assert (onrobot.port, onrobot.counts_per_newton, onrobot.counts_per_newton_metre) == (5000, 1e4, 2e5)
    assert parse("replay:///a.mcap?speed=4").speed == 4.0
    assert parse("replay:///a.mcap?speed=step").speed == STEPWISE


def test_ports_and_drives_of_windows():
    assert parse("sri+serial://COM3?baud=115200").path == "COM3"
    assert parse("sri+serial:///COM3").path == "COM3"
    assert parse("replay:///C:/data/a.mcap").path == "C:/data/a.mcap"


def test_robots_give_poses():
    assert parse("ur+tcp://r").gives_poses
    assert parse("elfin+tcp://r").gives_poses
    assert not parse("sri+tcp://r").gives_poses


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
        DeviceAddress(Protocol.SRI, Carrier.TCP, host=host, port=port, rate=rate),
        DeviceAddress(Protocol.SRI, Carrier.SERIAL, path=path, baud=baud, rate=rate),
        DeviceAddress(Protocol.REPLAY, Carrier.FILE, path=path, speed=STEPWISE),
        DeviceAddress(
            Protocol.RDT,
            Carrier.UDP,
            host=host,
            port=port,
            profile="ati",
            counts_per_newton=1e6,
            counts_per_newton_metre=rate,
        ),
    ):
        assert parse(str(address)) == address


@given(
    st.one_of(st.text(), st.text().map(lambda text: f"sri+tcp://{text}"), st.text().map("replay://{}".format))
)
def test_any_text_is_an_address_or_an_address_error(text: str):
    try:
        address = parse(text)
    except AddressError:
        return
    assert parse(str(address)) == address
