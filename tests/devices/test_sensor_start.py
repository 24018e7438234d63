"""How devices are started: what they refuse, what they ignore, and what is asked of them before."""

from __future__ import annotations

import struct
import time

import pytest
from devices.test_reconnecting_stream import Script
from devices.test_sensor import Heard, listen, moving
from waiting import until

from contactbench.pipeline.devices.emulate import emulator
from contactbench.pipeline.devices.protocols import rdt
from contactbench.pipeline.devices.protocols.device_model import Quirk
from contactbench.pipeline.devices.protocols.rdt import ScaleError, rdt_record
from contactbench.pipeline.devices.protocols.registry import driver_for
from contactbench.pipeline.devices.readings import Readings
from contactbench.pipeline.devices.reconnecting_stream import SensorStream
from contactbench.pipeline.devices.sample import Status
from contactbench.pipeline.devices.url import DeviceAddress


def test_an_older_box_is_asked_for_its_rate_in_its_own_words():
    heard = Heard()
    began = time.monotonic()
    device = emulator("sri", "tcp", rate=50.0, signal=moving(), quirks=[Quirk.OLDER])
    with device, listen(device, heard) as stream:
        heard.until(lambda: len(heard.samples) > 120)
        assert heard.samples[0].time - began < 0.9  # a refusal is not waited for
        assert stream.health.rate == pytest.approx(200.0, rel=0.1)
        assert stream.health.findings == ()
    assert device.refused == [b"AT+SMPF=200\r\n"]
    assert b"AT+SMPR=200\r\n" in device.commands


@pytest.mark.parametrize("quirk", [Quirk.CRC32_ONLY, Quirk.CRC32_SILENTLY])
def test_a_box_that_keeps_its_checksum_is_understood_and_told(quirk):
    heard = Heard()
    device = emulator("sri", "tcp", rate=200.0, signal=moving(), quirks=[quirk])
    with device, listen(device, heard) as stream:
        heard.until(lambda: len(heard.samples) > 50)
        findings = " ".join(stream.health.findings)
        assert "did not accept" in findings
        assert "DCKMD=SUM" in findings
        assert stream.health.counters.bad_checksums == 0


def test_a_setting_that_is_refused_in_every_way_is_told():
    def says(line, _now):
        asked, line.written = line.written, []
        return b"".join(b"ERROR\r\n" for data in asked if b"SMP" in data or b"DCK" in data)

    heard = Heard()
    line = Script(says)
    line.write = lambda data: line.written.append(data)
    with SensorStream("sri+tcp://h", heard.take, heard.change, line=line):
        heard.until(lambda: any("'AT+SMPR=200' (it refused it)" in finding for finding in heard.findings()))


@pytest.mark.parametrize("kind", ["robotiq", "sri"])
def test_a_device_is_left_alone_after_a_stop(kind):
    written = []

    class Timed(Script):
        def write(self, data):
            written.append((time.monotonic(), data))

    heard = Heard()
    line = Timed(lambda _line, _now: b"")
    address = f"{kind}+serial:///dev/x"
    with SensorStream(address, heard.take, heard.change, line=line):
        until(lambda: len(written) >= 2)
    assert written[1][0] - written[0][0] > 0.05


def test_onrobot_is_told_a_rate_only_when_one_is_asked_for():
    start = driver_for(DeviceAddress.parse("rdt+udp://h?profile=onrobot")).start
    assert [command.data.hex() for command in start] == ["1234000200000000"]
    asked = driver_for(DeviceAddress.parse("rdt+udp://h?profile=onrobot&rate=300"))
    assert [command.data.hex() for command in asked.start] == ["1234008200000003", "1234000200000000"]
    assert asked.rate == pytest.approx(1000 / 3)  # what the box makes of it: no false finding


def test_an_ati_sensor_is_asked_for_its_counts_where_the_address_has_none(monkeypatch):
    monkeypatch.setattr(rdt, "scale_for", lambda _: rdt.CountScale(4.0, 8.0))
    record = rdt_record((1.0, 2.0, 3.0, 4.0, 5.0, 6.0), rdt.CountScale(4.0, 8.0))
    heard = Heard()
    made = driver_for(DeviceAddress.parse("rdt+udp://h"))
    assert made.parser.scale == rdt.ATI_TYPICAL  # nothing is asked before the stream begins
    line = Script(lambda _line, _now: b"")
    line.says = lambda line, _now: record if line.written and line.written.pop() else b""
    with SensorStream("rdt+udp://h", heard.take, heard.change, line=line):
        heard.until(lambda: heard.samples)
    assert heard.samples[0].force == (1.0, 2.0, 3.0)
    assert heard.samples[0].torque == (4.0, 5.0, 6.0)


def test_counts_that_are_assumed_are_told_as_long_as_they_are(monkeypatch):
    def fail(_):
        raise ScaleError("no page.")

    monkeypatch.setattr(rdt, "scale_for", fail)
    heard = Heard()
    numbers = iter(range(1, 10**6))

    def says(_line, now):
        return rdt_record((1.0, 2.0, now, 0.1, 0.2, 0.3), rdt.ATI_TYPICAL, sequence=next(numbers))

    with SensorStream("rdt+udp://h", heard.take, heard.change, line=Script(says)) as stream:
        heard.until(lambda: len(heard.samples) > 50)
        assert any("1e+06 per N" in finding for finding in stream.health.findings)


def test_too_much_load_is_not_called_a_broken_sensor():
    parser = rdt.RdtParser(rdt.ATI_TYPICAL)
    (sample,) = parser.feed(rdt_record((1.0,) * 6, rdt.ATI_TYPICAL, status=0x8000_0002), 0.0)
    assert Status.ERROR in sample.status
    made = driver_for(DeviceAddress.parse("rdt+udp://h?cpf=1&cpt=1"))
    readings = Readings(made.limits)
    readings.see(sample)
    (finding,) = readings.findings().values()
    assert "remove the load" in finding


def test_a_count_that_begins_again_soon_costs_two_samples():
    parser = rdt.RdtParser(rdt.ATI_TYPICAL)
    given = 0
    for number, raw in enumerate([*range(1, 15), *range(1, 40)]):
        record = struct.pack(">3I6i", raw, 1000 + number, 0, *[number] * 6)
        given += len(parser.feed(record, 0.01 * number))
    assert given == 53 - 2
    assert parser.counters.restarts == 1


def test_datagrams_that_were_overtaken_in_order_are_no_restart():
    parser = rdt.RdtParser(rdt.ATI_TYPICAL)
    for raw in (1, 2, 3, 8, 4, 5, 6, 7, 9, 10):
        parser.feed(struct.pack(">3I6i", raw, raw, 0, *[raw] * 6), 0.01 * raw)
    assert parser.counters.restarts == 0
    assert parser.counters.duplicates == 4
