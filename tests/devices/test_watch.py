"""Every fault, in made-up time: frames of the emulated devices through the parsers to what is found."""

import dataclasses
from itertools import count

import pytest
from benchmarks import faults
from benchmarks.faults import LINES, cases, expectation, resting

from contactbench.pipeline.devices.driver import AddressError, Carrier
from contactbench.pipeline.devices.emulate import emulator
from contactbench.pipeline.devices.faults import Fault, FaultEvent, Mangler, Script, Truth, sine
from contactbench.pipeline.devices.protocols import Counters
from contactbench.pipeline.devices.protocols.registry import driver_for, driver_of
from contactbench.pipeline.devices.reconnecting_stream import SensorStream
from contactbench.pipeline.devices.sample import FlangeSample, Status, WrenchSample
from contactbench.pipeline.devices.stream import StreamState
from contactbench.pipeline.devices.url import DeviceAddress
from contactbench.pipeline.devices.watch import Watch

SENSORS = [line for line in LINES if not line.robot]
RATE = 100.0
START, STOP = 1.5, 2.1
ADDRESSES = {
    "sri serial": "sri+serial:///dev/x?rate=100",
    "sri tcp": "sri+tcp://h?rate=100",
    "bota serial": "bota+serial:///dev/x?rate=100",
    "robotiq serial": "robotiq+serial:///dev/x",
    "rdt ati": "rdt+udp://h",
    "rdt onrobot": "rdt+udp://h?profile=onrobot&rate=100",
    "kunwei serial": "kunwei+serial:///dev/x?rate=100",
    "robotous serial": "robotous+serial:///dev/x?rate=100",
    "line udp": "line+udp://h?fields=n,t,fx,fy,fz,mx,my,mz,status&rate=100",
    "line tcp": "line+tcp://h?fields=n,t,fx,fy,fz,mx,my,mz,status&rate=100",
}


class Played:
    """A device and a watch, without lines and without waiting."""

    def __init__(self, line, script, signal=resting, seconds=5.0):
        address = DeviceAddress.parse(ADDRESSES[str(line)])
        driver = driver_for(address)
        model, _ = driver_of(line.protocol).emulate(RATE, (), address.options)
        self.parser = driver.parser
        self.watch = Watch(driver.rate, rate_known=driver.rate_known, limits=driver.limits)
        self.truth = Truth(signal, script, model.trap, model.full_scale)
        self.mangler = Mangler(model, script, 0, datagrams=line.carrier is Carrier.UDP)
        self.samples, self.last, self.received = [], 0.0, 0
        self.ill = []  # when something was wrong, and what
        self.away = None
        self._play(model, seconds)

    def _play(self, model, seconds):
        due = 0.0
        for number in count():
            if due > seconds or self.away:
                return
            frame = model.frame(self.truth.reading(due), self.truth.moment(due, number))
            emission = self.mangler.mangle(frame, due, number)
            self.away = emission.away
            self._hear(emission.pieces, due)
            due += 1 / (RATE * self.truth.rate_factor(due))

    def _hear(self, pieces, now):
        for piece in pieces:
            self.received += len(piece)
            if samples := self.parser.feed(piece, now):
                self.watch.see(samples)
                self.samples += samples
                self.last = now
        self.watch.count(now, self.parser.counters, self.received)
        found = self.watch.findings()
        if now - self.last > self.watch.patience:
            self.watch.rest()
            found = {"silent": ""} | self.watch.damage()
        if found or self.watch.suspicions:
            self.ill.append((now, (*found, *self.watch.suspicions)))


def name(value):
    return str(value).replace(" ", "-")


@pytest.mark.parametrize(("line", "fault"), list(cases(SENSORS)), ids=name)
def test_every_fault_is_found_in_time_or_costs_nothing(line, fault):
    if fault is Fault.HEADER:
        script = Script([FaultEvent(START, fault, 0.08)])
    else:
        script = Script([FaultEvent(START, fault, STOP - START)])
    played = Played(line, script)
    expected = expectation(line, fault)
    if fault in (Fault.DISCONNECT, Fault.RECONNECT):
        assert played.away is not None  # the line itself tells
        assert not played.ill or line.carrier is Carrier.UDP  # where the last datagram was cut
    elif expected == "shown":
        warming = 0.3 * (STOP - START) if fault is Fault.DRIFT else 0.0
        when, what = played.ill[0]
        assert START <= when <= START + warming + 0.19, what
        if fault not in (Fault.DRIFT, Fault.REZERO):
            assert played.ill[-1][0] <= STOP + 2.1  # and is over by itself
        else:
            played.watch.acknowledge()
            assert not played.watch.findings()
            assert not played.watch.suspicions
    else:
        assert played.ill == []
        if expected == "unseen":
            assert len(played.samples) >= 498


@pytest.mark.parametrize("line", SENSORS, ids=name)
def test_nothing_is_found_where_nothing_is_wrong(line):
    played = Played(line, Script(), seconds=20.0)
    assert played.ill == []
    assert played.watch.rate() == pytest.approx(RATE, rel=0.01)


def sample(time, force=(1.0, 2.0, 3.0), **more):
    return WrenchSample(time, force, (0.1, 0.2, 0.3), **more)


def noisy(time, **more):
    values = resting(time)
    return WrenchSample(time, values[:3], values[3:], **more)


def found(samples, **how):
    watch = Watch(100.0, **how)
    watch.see(samples)
    return watch.findings()


def test_a_flag_of_one_sample_is_shown_long_enough_to_be_read():
    samples = [noisy(k / 100) for k in range(20)]
    samples[10] = dataclasses.replace(samples[10], status=Status.OVERRANGE)
    assert "OVERRANGE" in found(samples)
    samples += [noisy(k / 100) for k in range(20, 80)]
    assert found(samples) == {}


def test_one_channel_at_its_end_while_others_move():
    def row(k):
        fx, fy, fz = resting(k / 100)[:3]
        return sample(k / 100, (150.0 if k >= 100 else fx, fy, fz))

    words = found([row(k) for k in range(120)])["end"]
    assert words.startswith("Fx at 150 N: exactly the same for 19 samples")
    assert found([row(k) for k in range(105)]) == {}


def test_a_channel_that_is_quiet_is_not_at_its_end():
    def row(k):
        fx, fy, _ = resting(k / 100)[:3]
        return sample(k / 100, (fx, fy, 20.0 if k % 2 and k < 100 else 19.99))

    assert found([row(k) for k in range(300)]) == {}


def test_a_pause_of_the_computer_is_no_wrong_rate_and_no_leap():
    times = [k / 100 for k in range(400)]
    late = [1.62 if 1.5 <= t < 1.62 else t for t in times]  # they wait, and then come at once
    watch = Watch(100.0)
    for t, device in zip(late, times, strict=True):
        measured = noisy(device, sequence=round(100 * device), device_time=device)
        watch.see([dataclasses.replace(measured, time=t)])
        assert watch.findings() == {}


def test_a_rate_of_the_device_s_own_is_learnt():
    watch = Watch(100.0, rate_known=False)
    for k in range(3000):
        watch.see([noisy(k / 1000)])
    assert watch.findings() == {}
    for k in range(400):
        watch.see([noisy(3.0 + k / 500)])
    assert "instead of 1000 Hz" in watch.findings()["rate"]


def test_a_robot_may_stand_still():
    watch = Watch(100.0)
    for k in range(300):
        watch.see([FlangeSample(k / 100, None, None, device_time=k / 100)])
    assert watch.findings() == {}


def counted(*steps, rate=100.0):
    watch = Watch(rate)
    for now, counters, received in steps:
        watch.count(now, counters, received)
    return watch.damage()


def test_answers_before_the_first_frames_are_no_damage():
    steps = [(0.0, Counters(skipped_bytes=40), 40)]
    steps += [(k / 100, Counters(frames=k, skipped_bytes=40), 40 + 31 * k) for k in range(1, 100)]
    assert counted(*steps) == {}


def test_bytes_without_frames_are_told():
    words = counted(*[(k / 100, Counters(skipped_bytes=31 * k), 31 * k) for k in range(20)])
    assert "no frame in them" in words["no frame"]


def test_lost_samples_are_told_and_forgotten_after_a_second():
    steps = [(k / 100, Counters(frames=k, lost=7 if k > 50 else 0), 31 * k) for k in range(100)]
    assert counted(*steps)["lost"].startswith("7 of the last 103 samples were lost")
    steps += [(k / 100, Counters(frames=k, lost=7), 31 * k) for k in range(100, 200)]
    assert counted(*steps) == {}


def test_a_gap_that_was_a_silence_is_not_told_twice():
    watch = Watch(100.0)
    for k in range(200):
        watch.count(k / 100, Counters(frames=k), 31 * k)
    watch.rest()
    for k in range(200, 220):
        watch.count(1.0 + k / 100, Counters(frames=k, lost=100 if k > 201 else 0), 31 * k)
    assert watch.damage() == {}


@pytest.mark.parametrize("kelvin", [-3.2, 3.2])
def test_warming_is_told_until_it_is_acknowledged(kelvin):
    watch = Watch(100.0)
    watch.see([noisy(k / 100, temperature=25.0) for k in range(100)])
    assert watch.findings() == {}
    watch.see([noisy(k / 100, temperature=25.0 + kelvin) for k in range(100, 110)])
    assert ("warmer" if kelvin > 0 else "colder") in watch.findings()["temperature"]
    watch.acknowledge()
    assert watch.findings() == {}


@pytest.mark.parametrize("factor", [0.2, 0.5, 2.0])
def test_a_rate_that_changes_is_found_soon(factor):
    watch = Watch(100.0)
    watch.see([noisy(k / 100) for k in range(200)])
    step = 0.01 / factor
    for k in range(1, 100):
        watch.see([noisy(1.99 + k * step)])
        if watch.findings():
            break
    assert k * step <= max(0.19, 3 * step)
    assert "instead of 100 Hz" in watch.findings()["rate"]


def test_what_was_held_up_while_nobody_read_is_no_wrong_rate():
    """Six tenths of a second in every three; then what waited comes within 90 ms, of which nobody reads for 30."""
    watch, said = Watch(1000.0), set()
    for k in range(12_000):
        waited = k % 3000 - 1200  # samples since it stopped
        late = 0.6 + (1e-4 - 1e-3) * waited + (0.03 if waited > 300 else 0.0) if waited > 0 else 0.0
        watch.see([noisy(k / 1000 + max(late, 0.0))])
        said |= set(watch.findings())
    assert said == set()


@pytest.mark.parametrize("backlog", [20, 60, 200])
@pytest.mark.parametrize("wait", [0.05, 0.12, 0.2])
def test_what_waited_before_the_first_reading_is_no_wrong_rate(backlog, wait):
    watch = Watch(200.0)
    watch.see([noisy(0.0)])
    watch.see([noisy(wait)] * backlog)
    for number in range(1, 60):
        watch.see([noisy(wait + number / 200)])
        assert "rate" not in watch.findings()


def test_the_worst_lateness_is_kept_and_the_usual_one_is_small():
    watch = Watch(200.0)
    time = 0.0
    for number in range(1000):
        time += 0.005 + (0.03 if number == 300 else 0.0)
        watch.see([noisy(time)])
    usual, worst = watch.lateness()
    assert worst == pytest.approx(0.03, abs=1e-6)
    assert usual == pytest.approx(0.0, abs=1e-6)


# ---- streams against emulated sensors on real lines ----------------------------------------------


DEVICES = [("sri", "serial"), ("sri", "tcp"), ("bota", "serial"), ("robotiq", "serial"), ("rdt", "udp")]


class Heard(faults.Heard):
    """What a stream gave, and when its health changed."""

    def until(self, what):
        assert self.wait(what), (len(self.samples), [h for _, h in self.changes][-3:])

    def states(self):
        return [health.state for _, health in self.changes]

    def findings(self):
        return [finding for _, health in self.changes for finding in health.findings]


def moving():
    return sine((0.5, 0.4, 0.3, 0.02, 0.03, 0.01), 3.0, (1.0, -2.0, 3.5, 0.1, -0.2, 0.05))


def listen(device, heard):
    return SensorStream(device.url, heard.take, heard.change)


def fault(kind, start, duration=0.4, size=None):
    return Script(
        [FaultEvent(start, kind, duration, size) if size is not None else FaultEvent(start, kind, duration)]
    )


@pytest.mark.parametrize(("protocol", "carrier"), DEVICES)
def test_every_sample_was_sent_and_in_order(protocol, carrier):
    heard = Heard()
    with emulator(protocol, carrier, rate=100.0, signal=moving()) as device, listen(device, heard) as stream:
        heard.until(lambda: len(heard.samples) >= 60)
        health = stream.health
    assert health.state is StreamState.STREAMING
    assert health.counters.lost == health.counters.bad_checksums == 0
    assert heard.states()[0] is StreamState.CONNECTING
    assert heard.states()[-1] is StreamState.CLOSED
    times = [sample.time for sample in heard.samples]
    assert times == sorted(set(times))
    assert all(sample.arrival is not None and sample.time <= sample.arrival for sample in heard.samples)
    assert not any(Status.CLOCK in sample.status for sample in heard.samples)
    assert device.refused == []  # nothing but what it takes to stream was sent
    sent = iter([entry.reading.values for entry in device.intact()])
    for sample in heard.samples:  # each one was sent, in this order: none is made up
        given = (*sample.force, *sample.torque)
        assert any(given == pytest.approx(values, abs=0.006) for values in sent)


@pytest.mark.parametrize(("protocol", "carrier"), DEVICES)
def test_a_silence_is_noticed_and_ends_by_itself(protocol, carrier):
    heard = Heard()
    script = fault(Fault.STALL, 0.5, 0.6)
    with (
        emulator(protocol, carrier, rate=100.0, signal=moving(), script=script) as device,
        listen(device, heard),
    ):
        heard.until(lambda: StreamState.SILENT in heard.states())
        silent, health = next(
            (when, health) for when, health in heard.changes if health.state is StreamState.SILENT
        )
        count = len(heard.samples)
        heard.until(lambda: len(heard.samples) > count + 10)
    before = [sample.time for sample in heard.samples if sample.time <= silent]
    assert 0.1 < silent - before[-1] < 0.25
    assert "no sample for" in health.findings[0]
    assert heard.states()[-2] is StreamState.STREAMING


@pytest.mark.parametrize(("protocol", "carrier"), [pair for pair in DEVICES if pair != ("rdt", "udp")])
def test_a_lost_line_is_opened_again(protocol, carrier):
    heard = Heard()
    script = fault(Fault.DISCONNECT, 0.5, 0.5)
    with (
        emulator(protocol, carrier, rate=100.0, signal=moving(), script=script) as device,
        listen(device, heard) as stream,
    ):
        heard.until(lambda: StreamState.LOST in heard.states())
        count = len(heard.samples)
        heard.until(lambda: len(heard.samples) > count + 10)
        assert stream.health.reconnected >= 1
    assert Status.CLOCK in heard.samples[count].status
    assert "connection lost" in " ".join(heard.findings())


def test_readings_that_stay_the_same_are_noticed():
    heard = Heard()
    script = fault(Fault.STUCK, 0.3, 2.0)
    with emulator("sri", "tcp", rate=200.0, signal=moving(), script=script) as device, listen(device, heard):
        heard.until(lambda: any("No channel has changed" in finding for finding in heard.findings()))


def test_a_wrong_rate_is_noticed():
    heard = Heard()
    script = fault(Fault.WRONG_RATE, 0.0, 30.0)
    with emulator("sri", "tcp", rate=200.0, signal=moving(), script=script) as device, listen(device, heard):
        heard.until(lambda: any("Hz instead of 200 Hz" in finding for finding in heard.findings()))


def test_damage_costs_the_damaged_frames_only():
    heard = Heard()
    script = fault(Fault.GARBAGE, 0.2, 0.3)
    with (
        emulator("sri", "serial", rate=200.0, signal=moving(), script=script) as device,
        listen(device, heard) as stream,
    ):
        heard.until(lambda: len(heard.samples) > 200)
        counters = stream.health.counters
    assert counters.skipped_bytes > 0
    assert counters.lost == 0


def test_a_device_that_is_not_there_is_a_sentence_and_is_waited_for():
    heard = Heard()
    with SensorStream("sri+serial:///dev/no-such-port", heard.take, heard.change) as stream:
        heard.until(lambda: StreamState.LOST in heard.states())
        assert "cannot be opened" in " ".join(heard.findings())
        assert not stream.health.well
    assert heard.samples == []
    assert heard.states()[-1] is StreamState.CLOSED


def test_a_robot_is_no_force_sensor():
    with pytest.raises(AddressError, match="not a force/torque sensor"):
        driver_for(DeviceAddress.parse("elfin+tcp://127.0.0.1"))
