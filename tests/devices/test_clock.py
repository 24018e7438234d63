"""Times of samples against the truth, from made-up arrivals."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import pytest

from contactbench.pipeline.devices.clock import SampleClock
from contactbench.pipeline.devices.faults import SYNTHETIC, Fault, FaultEvent, Script, Truth, constant
from contactbench.pipeline.devices.protocols import bota, robotiq, sri
from contactbench.pipeline.devices.protocols.bota import BotaModel
from contactbench.pipeline.devices.protocols.robotiq import RobotiqModel
from contactbench.pipeline.devices.protocols.sri import SriModel
from contactbench.pipeline.devices.sample import FlangeSample, Status, WrenchSample

PARSERS = {
    SriModel: lambda _: sri.SriParser(),
    BotaModel: bota.BotaParser,
    RobotiqModel: lambda _: robotiq.RobotiqParser(),
}
BEGIN = 100.0
BATCH_S = 0.016  # what a serial adapter hands on at once
HELD_S = 0.4


@dataclass
class Arrivals:
    """What was measured when, and when it arrived."""

    truth: np.ndarray
    arrival: np.ndarray
    number: np.ndarray

    def late(self, mean: float, seed: int = 0) -> Arrivals:
        """Delay every sample by its own time; none overtakes another."""
        delays = np.random.default_rng(seed).exponential(mean, len(self.truth))
        return replace(self, arrival=np.maximum.accumulate(self.arrival + delays))

    def batched(self) -> Arrivals:
        """Hand samples on every 16 ms."""
        return replace(self, arrival=np.ceil(self.arrival / BATCH_S) * BATCH_S)

    def held(self, *begins: float) -> Arrivals:
        """Hold up for 0.4 s what arrives from these moments on."""
        arrival = self.arrival
        for begin in begins:
            arrival = np.where((arrival > begin) & (arrival < begin + HELD_S), begin + HELD_S, arrival)
        return replace(self, arrival=arrival)

    def kept(self, some: np.ndarray) -> Arrivals:
        """Lose the others."""
        return Arrivals(self.truth[some], self.arrival[some], self.number[some])

    def after(self, seconds: float) -> np.ndarray:
        return self.truth > BEGIN + seconds


def measured(rate: float, seconds: float = 30.0) -> Arrivals:
    number = np.arange(int(rate * seconds))
    truth = BEGIN + (number + 0.3) / rate
    return Arrivals(truth, truth.copy(), number)


def wrench(arrival: float, number: int | None = None, device_time: float | None = None) -> WrenchSample:
    return WrenchSample(arrival, (1.0, 2.0, 3.0), (0.1, 0.2, 0.3), number, device_time=device_time)


class Timed:
    """What a clock makes of arrivals."""

    def __init__(self, clock: SampleClock, given: Arrivals, counts=None, device=None) -> None:
        self.given, self.samples, self.clock = given, [], clock
        begins = np.flatnonzero(np.diff(given.arrival, prepend=-np.inf))
        for rows in np.split(np.arange(len(given.truth)), begins[1:]):
            batch = [
                wrench(
                    float(given.arrival[row]),
                    None if counts is None else int(counts[row]),
                    None if device is None else float(device[row]),
                )
                for row in rows
            ]
            self.samples += clock.stamp(batch)
        self.times = np.array([sample.time for sample in self.samples])
        self.flagged = np.array([Status.CLOCK in sample.status for sample in self.samples])
        # Whatever else happens.
        assert len(self.times) == len(given.truth)
        assert (np.diff(self.times) > 0).all()
        assert (self.times <= given.arrival + 1e-9).all()
        assert [sample.arrival for sample in self.samples] == given.arrival.tolist()

    def worst(self, after: float = 1.0, until: float = np.inf) -> float:
        rows = self.given.after(after) & ~self.given.after(until)
        return float(np.abs(self.times - self.given.truth)[rows].max())


PROCESSES = {
    "at once": lambda given: given,
    "jitter": lambda given: given.late(0.002),
    "batches": Arrivals.batched,
    "jitter and batches": lambda given: given.late(0.002).batched(),
    "bursts": lambda given: given.late(0.001).held(101.3, 109.0, 109.6, 122.0),
    "batches and bursts": lambda given: given.batched().held(101.3, 109.0, 109.6, 122.0),
}


@pytest.mark.parametrize("process", PROCESSES)
@pytest.mark.parametrize("rate", [200.0, 1000.0])
def test_counted_samples_are_timed_within_a_millisecond(rate, process):
    given = PROCESSES[process](measured(rate))
    timed = Timed(SampleClock(rate), given, given.number)
    # In the first second, no sample without jitter may have come at the end of a batch.
    assert timed.worst() < (2e-3 if process == "jitter and batches" else 1e-3)
    assert timed.worst(after=2.0) < 1e-3
    assert not timed.flagged.any()


@pytest.mark.parametrize("process", ["jitter", "batches"])
@pytest.mark.parametrize("ppm", [-1000.0, 100.0, 1000.0])
def test_the_devices_clock_may_drift(ppm, process):
    given = PROCESSES[process](measured(200.0, seconds=60.0))
    device = 7.0 + (given.truth - BEGIN) * (1 + 1e-6 * ppm)
    timed = Timed(SampleClock(200.0), given, device=device)
    assert timed.worst() < 1e-3
    assert not timed.flagged.any()


@pytest.mark.parametrize("off", [0.5, 0.97, 1.03, 2.0, None])
@pytest.mark.parametrize("process", ["jitter", "batches"])
def test_the_rate_may_be_wrong_or_unknown(off, process):
    given = PROCESSES[process](measured(1000.0, seconds=10.0))
    timed = Timed(SampleClock(None if off is None else 1000.0 * off), given, given.number)
    assert timed.worst(after=2.0) < 1e-3
    assert not timed.flagged.any()


def test_a_rate_that_is_unknown_shows_soon():
    given = measured(200.0, seconds=2.0).late(0.001)
    assert Timed(SampleClock(), given, given.number).worst(after=0.2) < 8e-3


@pytest.mark.parametrize("rate", [1000.0, None])
@pytest.mark.parametrize("waited", [0.5, 2.0])
def test_what_had_waited_before_the_line_was_read_turns_no_line(waited, rate):
    given = measured(1000.0, seconds=6.0)
    waiting = given.truth < BEGIN + waited
    given.arrival[waiting] = BEGIN + waited + 1e-5 * (given.number[waiting] - waiting.sum())
    timed = Timed(SampleClock(rate), given, given.number)
    assert timed.worst(after=waited + (0.01 if rate else 1.3)) < 1e-3


def test_jitter_does_not_turn_a_young_line():
    given = measured(200.0, seconds=10.0).late(0.002, seed=4).batched()
    assert Timed(SampleClock(200.0), given, given.number).worst() < 1e-3


def test_a_clock_that_changes_its_pace_is_followed():
    given = measured(200.0, seconds=80.0).late(0.001)
    truth = given.truth - BEGIN
    device = truth - 2e-3 * np.maximum(truth - 50, 0)
    assert Timed(SampleClock(200.0), given, device=device).worst(after=75.0) < 1e-3


def test_what_is_lost_by_count_is_not_guessed():
    given = measured(200.0).late(0.002)
    given = given.kept(np.random.default_rng(1).random(len(given.truth)) > 0.02)
    assert Timed(SampleClock(200.0), given, given.number).worst() < 1e-3


@pytest.mark.parametrize("rate", [100.0, None])
@pytest.mark.parametrize("process", ["jitter", "batches"])
def test_without_a_count_losses_show_in_the_arrivals(process, rate):
    given = PROCESSES[process](measured(100.0))
    given = given.kept(np.random.default_rng(1).random(len(given.truth)) > 0.02)
    timed = Timed(SampleClock(rate), given)
    off = np.abs(timed.times - given.truth)[given.after(1.0)]
    assert np.median(off) < 8e-3
    assert off.max() < (0.035 if rate else 0.06)  # three in a row
    assert not timed.flagged.any()


def test_without_a_count_a_gap_is_a_leap():
    given = measured(100.0, seconds=10.0).late(0.001)
    given = given.kept((given.truth < BEGIN + 5) | (given.truth > BEGIN + 5.6))
    timed = Timed(SampleClock(100.0), given)
    assert timed.worst() < 0.012
    assert timed.flagged.any()


def test_a_count_that_begins_anew_is_a_leap():
    given = measured(200.0, seconds=10.0).late(0.001)
    counts = np.where(given.truth < BEGIN + 5, given.number + 5000, given.number)
    timed = Timed(SampleClock(200.0), given, counts)
    leap = np.argmax(given.truth > BEGIN + 5)
    assert np.flatnonzero(timed.flagged)[0] == leap
    assert given.arrival[timed.flagged][-1] - given.arrival[leap] == pytest.approx(0.2, abs=0.01)
    assert timed.worst(until=5.0) < 1e-3
    assert timed.worst(after=6.0) < 1e-3
    assert timed.worst() < 0.01


@pytest.mark.parametrize("process", ["jitter", "batches"])
@pytest.mark.parametrize("size", [-900, 20, 100, 3000])
def test_a_count_that_leaps_is_noticed(size, process):
    given = PROCESSES[process](measured(200.0, seconds=10.0))
    timed = Timed(SampleClock(200.0), given, given.number + 2000 + size * (given.truth > BEGIN + 5))
    assert timed.flagged.any()
    assert timed.worst(until=4.98) < 1e-3  # one batch before and after the leap
    assert timed.worst(after=6.0) < 1e-3
    assert timed.worst() < 0.02


def test_after_a_leap_the_measured_rate_still_holds():
    given = measured(200.0, seconds=10.0).late(0.001)
    timed = Timed(SampleClock(206.0), given, given.number - 900 * (given.truth > BEGIN + 5) + 2000)
    assert timed.worst(after=5.5, until=5.95) < 2e-3


@pytest.mark.parametrize("counts_on", [True, False])
def test_after_a_silence(counts_on):
    given = measured(200.0, seconds=12.0).late(0.001)
    given = given.kept((given.truth < BEGIN + 5) | (given.truth > BEGIN + 8))
    timed = Timed(SampleClock(200.0), given, given.number if counts_on else np.arange(len(given.truth)))
    assert timed.flagged.any() != counts_on
    assert timed.worst() < (1e-3 if counts_on else 0.01)


def test_a_count_that_falls_behind_for_good_began_anew():
    given = measured(200.0, seconds=10.0)
    given = given.kept((given.truth < BEGIN + 5) | (given.truth > BEGIN + 5.7))
    timed = Timed(SampleClock(200.0), given, np.arange(len(given.truth)))
    assert timed.worst(after=6.3) < 1e-3
    assert timed.flagged.any()


def test_a_reconnection_is_a_leap_and_the_start_is_none():
    clock, given = SampleClock(200.0), measured(200.0, seconds=3.0)
    assert not Timed(clock, given, given.number).flagged.any()
    clock.forget()
    later = replace(given, truth=given.truth + 60, arrival=given.arrival + 60)
    second = Timed(clock, later, given.number)
    assert second.flagged[:40].all()
    assert not second.flagged[50:].any()
    assert not clock.leapt
    assert second.worst() < 1e-3


@pytest.mark.parametrize("wrong", ["stuck", "steps", "twice as fast", "random", "not finite"])
def test_a_wrong_clock_is_not_believed(wrong):
    given = measured(200.0, seconds=20.0).late(0.001)
    truth = given.truth - BEGIN
    device = {
        "stuck": np.zeros_like(truth),
        "steps": np.floor(truth * 20) / 20,
        "twice as fast": 2 * truth,
        "random": np.random.default_rng(0).uniform(0, 1e9, len(truth)),
        "not finite": np.full(len(truth), np.nan),
    }[wrong]
    assert Timed(SampleClock(200.0), given, given.number, device).worst(after=3.0) < 1e-3


@pytest.mark.parametrize("seed", range(20))
def test_anything_is_timed_in_order(seed):
    rng = np.random.default_rng(seed)
    steps = 10.0 ** rng.uniform(-6, rng.choice([-3, 0, 3]), 500)
    arrival = BEGIN + np.cumsum(np.where(rng.random(500) < 0.5, 0.0, steps))
    given = Arrivals(arrival, arrival, np.arange(500))
    counts = rng.choice([0, 1, 5, 2**62, 2**63 - 1], 500) if seed % 2 else None
    device = rng.choice([0.0, 1e-300, -1e308, 1e308, np.inf, np.nan], 500) if seed % 3 else None
    assert np.isfinite(Timed(SampleClock(rng.choice([0.1, 1e4])), given, counts, device).times).all()


@pytest.mark.parametrize("model", [SriModel, BotaModel, RobotiqModel])
@pytest.mark.parametrize("leap", [-4.0, 4.0, None])
def test_emulated_sensors_behind_an_adapter_that_batches(model, leap):
    rate = 100.0 if model is RobotiqModel else 200.0
    sensor, parser = model(rate), PARSERS[model](rate)
    script = Script() if leap is None else Script([FaultEvent(5.0, Fault.CLOCK_JUMP, 0.1, leap)])
    truth, clock = Truth(constant(SYNTHETIC), script, sensor.trap, sensor.full_scale), SampleClock(rate)
    found, due, waiting, until = [], [], b"", BATCH_S
    for number in range(int(10 * rate)):
        at = number / rate
        if at > until:
            found += clock.stamp(parser.feed(waiting, BEGIN + until))
            waiting, until = b"", np.ceil(at / BATCH_S) * BATCH_S
        waiting += sensor.frame(truth.reading(at), truth.moment(at, number))
        due.append(BEGIN + at)
    times = np.array([sample.time for sample in found])
    off = np.abs(times - due[: len(times)])
    assert len(times) >= len(due) - 4
    assert (np.diff(times) > 0).all()
    settled = (times > BEGIN + 1) & ((times < BEGIN + 4.9) | (times > BEGIN + 6))
    assert off[settled].max() < 2e-3
    assert off[times > BEGIN + 1].max() < 0.02


def test_times_wait_for_a_line_that_comes_down():
    for arrival, expected in ((100.011, [0.0025, 0.006, 0.011]), (100.003, [0.001, 0.002, 0.003])):
        clock = SampleClock(200.0)
        clock.stamp([wrench(100.0, 1)])
        batch = clock.stamp([wrench(arrival, number) for number in (2, 3, 4)])
        assert [sample.time - 100 for sample in batch] == pytest.approx(expected)


def test_arrivals_that_go_back_are_another_clock():
    clock = SampleClock(200.0)
    (late,) = clock.stamp([wrench(50.0, 1)])
    (early,) = clock.stamp([wrench(3.0, 2)])
    assert (late.time, early.time) == (50.0, 3.0)
    assert Status.CLOCK in early.status


def test_poses_have_no_status():
    pose = FlangeSample(5.0, np.eye(3), np.zeros(3), device_time=77.0)
    clock = SampleClock(100.0)
    (first,) = clock.stamp([pose])
    second, third = clock.stamp(
        [replace(pose, time=5.1, device_time=77.01), replace(pose, time=5.1, device_time=77.02)]
    )
    assert (first.time, first.arrival) == (5.0, 5.0)
    assert (second.time, third.time) == pytest.approx((5.01, 5.02))
    assert third.arrived == 5.1
    assert clock.stamp([]) == []
