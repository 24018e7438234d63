"""What an ATI sensor's page tells, and pages that tell nothing."""

import threading
from contextlib import contextmanager
from dataclasses import replace
from http.server import BaseHTTPRequestHandler, HTTPServer

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from contactbench.pipeline.devices.protocols.parser import ProtocolError
from contactbench.pipeline.devices.protocols.rdt import (
    AtiScale,
    CountScale,
    ScaleError,
    parse_scale,
    read_scale,
    scale_for,
)
from contactbench.pipeline.devices.transport.http_get import MOST_BYTES, PageError
from contactbench.pipeline.devices.url import DeviceAddress


def page(force="N", torque="N-m", cpf="1000000", cpt="1000000", product="ATI Net F/T"):
    return (
        '<?xml version="1.0"?>\n<netft><runstat>0x00000000</runstat><runft>1;2;3;4;5;6</runft>'
        f"<prodname>{product}</prodname><cfgcpf>{cpf}</cfgcpf><cfgcpt>{cpt}</cfgcpt>"
        f"<scfgfu>{force}</scfgfu><scfgtu>{torque}</scfgtu></netft>"
    ).encode()


@contextmanager
def sensor(body, status=200):
    """Serve the page as the sensor does; gives its port and the requests."""
    asked = []

    class Handler(BaseHTTPRequestHandler):
        def do_GET(self):
            asked.append(self.requestline)
            found = self.path == "/netftapi2.xml"
            self.send_response(status if found else 404)
            self.send_header("Content-Type", "text/xml")
            self.end_headers()
            self.wfile.write(body if found else b"")

        def log_message(self, *_):
            pass

    with HTTPServer(("127.0.0.1", 0), Handler) as server:
        thread = threading.Thread(target=server.serve_forever, args=(0.01,), daemon=True)
        thread.start()
        try:
            yield server.server_port, asked
        finally:
            server.shutdown()
            thread.join()


def test_a_sensor_is_asked():
    with sensor(page("lbf", "lbf-in", "4448221.6152605", "2000000")) as (port, asked):
        told = read_scale("127.0.0.1", port)
    assert told.counts_per_newton == pytest.approx(1e6)
    assert told.counts_per_newton_metre == pytest.approx(2e6 / 0.1129848290276167)
    assert told.product == "ATI Net F/T"
    assert asked == ["GET /netftapi2.xml HTTP/1.0"]


def test_a_sensor_that_has_no_such_page():
    with sensor(b"", 500) as (port, _), pytest.raises(PageError, match="answers 500"):
        read_scale("127.0.0.1", port)


# Newtons in a unit, by definition: 1 lb = 0.45359237 kg, 1 in = 25.4 mm, g = 9.80665 m/s².
@pytest.mark.parametrize(
    ("unit", "newtons"),
    [
        ("N", 1.0),
        ("kN", 1000.0),
        ("lbf", 4.4482216152605),
        ("Klbf", 4448.2216152605),
        ("kgf", 9.80665),
        ("Kg", 9.80665),
        ("g", 0.00980665),
    ],
)
def test_force_units(unit, newtons):
    assert parse_scale(page(force=unit, cpf="250")).counts_per_newton == pytest.approx(
        250 / newtons, rel=1e-14
    )


@pytest.mark.parametrize(
    ("unit", "newton_metres"),
    [
        ("N-m", 1.0),
        ("Nm", 1.0),
        ("N-mm", 0.001),
        ("kN-m", 1000.0),
        ("lbf-in", 0.1129848290276167),
        ("Lbf-ft", 1.3558179483314004),
        ("kgf-cm", 0.0980665),
        ("Kg-cm", 0.0980665),
    ],
)
def test_torque_units(unit, newton_metres):
    told = parse_scale(page(torque=unit, cpt="1e3"))
    assert told.counts_per_newton_metre == pytest.approx(1000 / newton_metres, rel=1e-14)


@pytest.mark.parametrize("cpf", ["1000000", " 1000000\n", "1000000.0", "1.0e6", "1E+06"])
def test_ways_to_write_a_number(cpf):
    assert parse_scale(page(cpf=cpf)) == AtiScale(1e6, 1e6, "ATI Net F/T")


@pytest.mark.parametrize("cpf", ["", "0", "-1", "nan", "inf", "1e99", "0x10", "1_000", "1;2", "١", "9" * 200])
def test_impossible_counts(cpf):
    with pytest.raises(ScaleError, match=r"cfgcpf: .* is not a valid number"):
        parse_scale(page(cpf=cpf))


@pytest.mark.parametrize("unit", ["", "mN", "pdl", "N-m", "N/m", "kp"])
def test_unknown_units_are_not_guessed(unit):
    with pytest.raises(ScaleError, match=r"scfgfu: unknown unit"):
        parse_scale(page(force=unit))


@pytest.mark.parametrize("name", ["cfgcpf", "cfgcpt", "scfgfu", "scfgtu"])
def test_missing_and_doubled_parts(name):
    whole = page().decode()
    start, end = whole.index(f"<{name}>"), whole.index(f"</{name}>") + len(name) + 3
    with pytest.raises(ScaleError, match=f"{name} is missing"):
        parse_scale((whole[:start] + whole[end:]).encode())
    with pytest.raises(ScaleError, match=f"{name} appears twice"):
        parse_scale((whole[:end] + whole[start:end] + whole[end:]).encode())


def test_a_product_is_not_needed_and_is_kept_short():
    assert parse_scale(page(product="")).product == ""
    assert parse_scale(page(product="a\u200b\x85b" + "c" * 500)).product.startswith("abc")
    assert len(parse_scale(page(product="c" * 500)).product) == 80


@pytest.mark.parametrize("encoding", ["utf-8", "utf-16"])
@pytest.mark.parametrize(
    "declaration",
    [
        "<!DOCTYPE netft>",
        '<!DOCTYPE netft [<!ENTITY a "1000000">]>',
        '<!DOCTYPE netft SYSTEM "file:///etc/passwd">',
        '<!DOCTYPE netft [<!ENTITY % p SYSTEM "http://127.0.0.1:1/x"> %p;]>',
    ],
)
def test_document_types_are_refused_in_any_encoding(declaration, encoding):
    text = page().decode().replace('<?xml version="1.0"?>\n', declaration)
    with pytest.raises(ScaleError, match="document type"):
        parse_scale(text.encode(encoding))


@pytest.mark.parametrize(
    "data",
    [
        b"",
        b"<html><body>Login",
        b"\xff\xfe\x00",
        page()[:-5],
        page() + b"<netft/>",
        page(cpf="&a;"),
        page().replace(b'"1.0"', b'"1.0" encoding="nonsense"'),
        page().replace(b'"1.0"', b'"1.0" encoding="utf-7"'),
        b"<a>" * 20_000,
    ],
)
def test_what_is_not_xml(data):
    with pytest.raises(ScaleError, match=r"host: /netftapi2\.xml is not XML"):
        parse_scale(data, "host")


def test_too_long_a_page():
    with pytest.raises(ScaleError, match="longer than"):
        parse_scale(page() + b" " * MOST_BYTES)
    assert issubclass(ScaleError, ProtocolError)


@settings(max_examples=80, deadline=None)
@given(st.data())
def test_a_damaged_page_gives_positive_counts_or_its_own_error(data):
    whole = bytearray(page())
    for _ in range(data.draw(st.integers(1, 4))):
        whole[data.draw(st.integers(0, len(whole) - 1))] = data.draw(st.integers(0, 255))
    try:
        told = parse_scale(bytes(whole))
    except ScaleError:
        return
    assert told.counts_per_newton > 0
    assert told.counts_per_newton_metre > 0


class TestScaleFor:
    def test_what_is_typed_is_taken(self):
        address = DeviceAddress.parse("rdt+udp://127.0.0.1?cpf=5&cpt=6")
        assert scale_for(address, 1) == CountScale(5.0, 6.0)

    def test_onrobot_is_fixed_and_not_asked(self):
        address = DeviceAddress.parse("rdt+udp://127.0.0.1?profile=onrobot&cpf=5")
        assert scale_for(address, 1) == CountScale(5.0, 1e5)
        bare = replace(address, options={**address.options, "cpf": None, "cpt": None})
        assert scale_for(bare, 1) == CountScale(1e4, 1e5)

    def test_what_is_left_out_is_asked_for(self):
        address = DeviceAddress.parse("rdt+udp://127.0.0.1")
        with sensor(page("kN", "N-mm", "2000000", "3000")) as (port, _):
            assert scale_for(address, port) == CountScale(2000.0, 3e6)
            assert scale_for(replace(address, options={**address.options, "cpf": 7.0}), port) == CountScale(
                7.0, 3e6
            )
