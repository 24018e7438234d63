"""From the bytes of a sensor to contacts: what the live path promises, with made-up arrivals instead of a clock."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from config.runtime.bundles import example
from runtime.runtime_recordings import BEGIN, flange, wrench
from scipy.signal import butter, sosfilt
from scipy.spatial.transform import Rotation
from verification.touch_cases import MODEL, RATE, Push, protocol, stream

from contactbench.pipeline import kernel
from contactbench.pipeline.devices.clock import SampleClock
from contactbench.pipeline.devices.faults import Fault, FaultEvent, Script, Truth
from contactbench.pipeline.devices.protocols import bota, rdt, robotiq, sri
from contactbench.pipeline.devices.protocols.bota import BotaModel
from contactbench.pipeline.devices.protocols.rdt import RdtModel
from contactbench.pipeline.devices.protocols.robotiq import RobotiqModel
from contactbench.pipeline.devices.protocols.sri import SriModel
from contactbench.pipeline.devices.sample import FROZEN_CHANCE, FlangeSample, Status, WrenchSample
from contactbench.pipeline.recording import DeviceInfo, RecordingInfo, RecordingWriter
from contactbench.pipeline.runtime import Engine, Run
from contactbench.pipeline.runtime.lines import health_names
from contactbench.pipeline.verification.source import read_touch_recording
from contactbench.pipeline.workbench.live import Live

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator
    from pathlib import Path

    from numpy.typing import NDArray

    from contactbench.pipeline.devices.protocols.device_model import Model

TURN = np.radians(20.0)  # rad/s
BATCH_S, HELD_S, HOLD_UPS = 0.016, 0.4, (1.3, 2.5)
PIECE = 13  # bytes: no frame has so few


def turning(time: float) -> Rotation:
    """Return the sensor's orientation at a time, s since BEGIN, while the wrist turns at 20 degrees a second."""
    return Rotation.from_rotvec([TURN * time, 0.0, 0.0])


def touch() -> tuple[NDArray[Any], NDArray[Any]]:
    """Return a place on the acoustic face, and what a push of 8 N there does to the sensor."""
    probe = example().probe
    face = int(np.argmax(probe.region == 1))
    point = probe.vertices[probe.faces[face]].mean(axis=0)
    force = -8.0 * probe.normals[face]
    return point, np.concatenate([force, np.cross(point, force)])


def six(values: NDArray[Any]) -> tuple[float, float, float, float, float, float]:
    fx, fy, fz, mx, my, mz = values.tolist()
    return fx, fy, fz, mx, my, mz


# ---- every sample is there, in order, and in time ------------------------------------------------


def held_up(times: NDArray[Any]) -> NDArray[Any]:
    for begin in HOLD_UPS:
        times = np.where((times > begin) & (times < begin + HELD_S), begin + HELD_S, times)
    return times


ARRIVALS: dict[str, Callable[[NDArray[Any]], NDArray[Any]]] = {
    "at once": lambda times: times + 1e-4,
    "in batches": lambda times: np.ceil(times / BATCH_S) * BATCH_S,
    "held up": held_up,
}


@pytest.mark.parametrize("pose_rate", [10.0, 125.0])
@pytest.mark.parametrize("arrivals", ARRIVALS)
@pytest.mark.parametrize("rate", [200.0, 1000.0])
def test_however_samples_arrive_each_is_located_at_its_own_time(
    rate: float, arrivals: str, pose_rate: float
) -> None:
    config, rng = example(), np.random.default_rng(1)
    point, pushed = touch()
    model, parser, clock = SriModel(rate), sri.SriParser(), SampleClock(rate)
    truth = np.arange(int(3.0 * rate)) / rate
    said: list[tuple[WrenchSample, Any]] = []
    run = Run(config, on_answer=lambda sample, answer: said.append((sample, answer.contact)))
    begun = Script()
    arrived = ARRIVALS[arrivals](truth)
    moments = iter(np.arange(-0.2, 4.0, 1.0 / pose_rate).tolist())
    due = next(moments)
    for arrival in np.unique(arrived).tolist():
        while due <= arrival:
            run.poses([flange(BEGIN + due, turning(due).as_matrix())])
            due = next(moments)
        data = b""
        for number in np.flatnonzero(arrived == arrival).tolist():
            time = float(truth[number])
            weight = config.gravity.predict(turning(time).as_matrix())
            reading = six(weight + pushed + rng.normal(0, [0.02] * 3 + [5e-4] * 3))
            measured = Truth(lambda _, now=reading: now, begun, None, None)
            data += model.frame(measured.reading(time), measured.moment(time, number))
        for begin in range(0, len(data), PIECE):  # a line cuts where it likes
            run.wrenches(clock.stamp(parser.feed(data[begin : begin + PIECE], BEGIN + arrival)))
    times = np.array([sample.time for sample, _ in said]) - BEGIN
    assert len(said) == len(truth)
    assert parser.counters.lost == 0
    assert (np.diff(times) > 0).all()
    assert np.abs(times - truth)[truth > 1.0].max() < 1e-3
    assert run.reasons["stale"] == 0
    assert not run.unhealthy
    assert run.good
    settled = [contact for (_, contact), time in zip(said, truth, strict=True) if time > 1.0]
    assert all(contact.accepted for contact in settled)
    # A time that is wrong by 5 ms, or an orientation of the pose before, moves the weight by more.
    pulls = np.array([contact.wrench[:3] for contact in settled]) - pushed[:3]
    assert np.abs(pulls.mean(axis=0)).max() < 0.01
    assert max(np.linalg.norm(contact.point - point) for contact in settled) < 1e-3


# ---- a sensor that hangs or says nothing ---------------------------------------------------------


@dataclass(frozen=True)
class Kind:
    """A sensor as it is on the wire: noise of force (N) and torque (N·m)."""

    make: Callable[[], tuple[Model, Any]]
    rate: float
    force: float
    torque: float


KINDS = {
    "sri": Kind(lambda: (SriModel(200.0), sri.SriParser()), 200.0, 0.05, 0.002),
    "bota": Kind(lambda: (BotaModel(200.0), bota.BotaParser(200.0)), 200.0, 0.05, 0.002),
    "robotiq": Kind(lambda: (RobotiqModel(100.0), robotiq.RobotiqParser()), 100.0, 0.1, 0.005),
    "robotiq, quiet": Kind(lambda: (RobotiqModel(100.0), robotiq.RobotiqParser()), 100.0, 0.01, 5e-4),
    "ati": Kind(lambda: (RdtModel(500.0), rdt.RdtParser(rdt.CountScale(1e6, 1e6))), 500.0, 0.02, 5e-4),
    "onrobot": Kind(
        lambda: (RdtModel(500.0, profile="onrobot"), rdt.RdtParser(rdt.ONROBOT_SCALE)), 500.0, 0.035, 5e-4
    ),
}
HUNG_S, HANGS_S, WHOLE_S = 8.0, 1.0, 10.0


def streamed(kind: Kind, fault: Fault) -> Iterator[WrenchSample]:
    """Yield what a sensor gives that is pushed, and hangs or says nothing from 8 to 9 s."""
    (model, parser), (_, pushed) = kind.make(), touch()
    rng, still = np.random.default_rng(2), example().gravity.predict(np.eye(3)) + pushed
    count = int(WHOLE_S * kind.rate)
    readings = still + rng.normal(0, [kind.force] * 3 + [kind.torque] * 3, (count, 6))
    script = Script([FaultEvent(HUNG_S, Fault.STUCK, HANGS_S)] if fault is Fault.STUCK else [])
    truth = Truth(lambda time: six(readings[min(round(time * kind.rate), count - 1)]), script, None, None)
    for number in range(count):
        time = number / kind.rate
        if fault is Fault.STALL and HUNG_S <= time < HUNG_S + HANGS_S:
            continue
        yield from parser.feed(model.frame(truth.reading(time), truth.moment(time, number)), BEGIN + time)


@pytest.mark.parametrize("kind", KINDS)
def test_a_hung_sensor_is_known_within_a_fifth_of_a_second(kind: str) -> None:
    engine = Engine(example(), hold=np.inf)
    engine.poses([flange(BEGIN, np.eye(3))])
    told, accepted = [], []
    for sample in streamed(KINDS[kind], Fault.STUCK):
        answer = engine.locate(sample)
        assert answer.contact is not None
        time = sample.time - BEGIN
        accepted += [time] if answer.contact.accepted else []
        told += [time] if "frozen" in health_names(answer.health) else []
    assert told[0] - HUNG_S < 0.2
    assert told[-1] < HUNG_S + HANGS_S
    hung = np.array(accepted)
    assert not ((hung >= told[0]) & (hung < HUNG_S + HANGS_S)).any()
    assert (hung < HUNG_S).sum() > 7 * KINDS[kind].rate
    assert (hung > HUNG_S + HANGS_S + 0.1).sum() > 0.8 * KINDS[kind].rate  # and it is well again


@pytest.mark.parametrize("kind", KINDS)
def test_a_silent_sensor_is_known_within_a_fifth_of_a_second(kind: str) -> None:
    engine = Engine(example(), hold=np.inf)
    engine.poses([flange(BEGIN, np.eye(3))])
    samples = list(streamed(KINDS[kind], Fault.STALL))
    silent, waiting = [], iter(samples)
    sample = next(waiting, None)
    for now in (BEGIN + np.arange(0.0, WHOLE_S - 0.1, 0.02)).tolist():
        while sample is not None and sample.time <= now:
            engine.locate(sample)
            sample = next(waiting, None)
        answer = engine.silent(now)
        if answer is not None:
            assert answer.contact is not None
            assert not answer.contact.accepted
            silent.append(now - BEGIN)
    assert HUNG_S < silent[0] < HUNG_S + 0.2
    assert HUNG_S + HANGS_S - 0.04 < silent[-1] <= HUNG_S + HANGS_S


def correlated(rng: np.random.Generator, count: int) -> NDArray[Any]:
    """Return noise as a low-pass of a twentieth of the rate within the sensor leaves it, of unit size."""
    noise = sosfilt(butter(2, 0.1, output="sos"), rng.normal(size=(count, 6)), axis=0)
    return noise / noise[100:].std(axis=0)


HEALTHY: dict[str, Callable[[np.random.Generator, int], NDArray[Any]]] = {
    "white": lambda rng, count: rng.normal(size=(count, 6)),
    "correlated": correlated,
    "drifting": lambda rng, count: rng.normal(size=(count, 6)) + np.linspace(0.0, 100.0, count)[:, None],
    "each value twice": lambda rng, count: np.repeat(rng.normal(size=(count // 2, 6)), 2, axis=0),
    "at times two or eight times": lambda rng, count: np.repeat(
        rng.normal(size=(count, 6)), rng.choice([1, 2, 8], count, p=[0.9, 0.09, 0.01]), axis=0
    )[:count],
}


@pytest.mark.parametrize("step", [0.0, 0.1, 1.0, 2.0])
@pytest.mark.parametrize("noise", HEALTHY)
def test_an_hour_of_a_healthy_sensor_is_never_frozen(noise: str, step: float) -> None:
    """At 100 Hz; `step`: what its last digit is worth, in standard deviations of the noise."""
    readings = HEALTHY[noise](np.random.default_rng(3), 360_000)
    if step:
        readings = np.round(readings / step) * step
    assert not kernel.frozen(np.ascontiguousarray(readings), FROZEN_CHANCE).any()


# ---- live, and as recorded -----------------------------------------------------------------------

ABOUT = RecordingInfo(
    1_700_000_000_000_000_000,
    BEGIN,
    (
        DeviceInfo("wrench", "/wrench", "sri+tcp://10.0.0.1", "virtual", "V-0001", RATE),
        DeviceInfo("flange", "/flange", "elfin+tcp://10.0.0.2", rate=10.0),
    ),
)


def swaying(time: float) -> Rotation:
    return Rotation.from_rotvec([TURN / np.pi * np.sin(np.pi * time), 0.0, 0.0])


@pytest.mark.parametrize(
    ("turned", "pose_rate", "jitter"),
    [(turning, 10.0, 0.0), (turning, 10.0, 0.02), (swaying, 25.0, 0.0), (swaying, 10.0, 0.02)],
)
def test_touches_are_where_the_recording_of_them_says(
    tmp_path: Path, turned: Callable[[float], Rotation], pose_rate: float, jitter: float
) -> None:
    rng = np.random.default_rng(4)
    times, pushes, _ = stream(*[Push(marker=i % 3) for i in range(6)])
    R = np.array([turned(time).as_matrix() for time in times.tolist()])
    moments = np.arange(-5, pose_rate * (times[-1] + 0.5)) / pose_rate
    moments += rng.uniform(-jitter, jitter, len(moments))
    mixed: list[tuple[float, WrenchSample | FlangeSample]] = []
    for time, row in zip(times.tolist(), pushes + MODEL.predict(R), strict=True):
        fx, fy, fz, mx, my, mz = six(row)
        mixed.append((time, WrenchSample(BEGIN + time, (fx, fy, fz), (mx, my, mz))))
    mixed += [(time + 0.01, flange(BEGIN + time, turned(time).as_matrix())) for time in moments.tolist()]
    file = tmp_path / "touches.mcap"
    with RecordingWriter(file, ABOUT) as writer:
        for _, sample in sorted(mixed, key=lambda each: each[0]):
            if isinstance(sample, WrenchSample):
                writer.wrench(sample)
            else:
                writer.flange(sample)

    blocks: list[Any] = []
    live = Live()
    live.follow(blocks.append)
    live.open(f"replay://{file}?speed=step", f"replay://{file}?speed=step")
    pair = live.pair
    assert pair is not None
    while not pair.finished:
        pair.step(500)
    live.close()
    recorded = read_touch_recording(file)
    found = [
        places(
            np.concatenate([block.times for block in blocks]),
            np.concatenate([block.wrenches for block in blocks]),
            np.concatenate([block.R_WS for block in blocks]),
        ),
        places(recorded.times, recorded.wrenches, recorded.R_WS),
    ]
    assert len(found[0]) == len(found[1]) == 6
    assert np.linalg.norm(found[0] - found[1], axis=1).max() < 5e-5
    # The weight, turned as it was 0.05 s before, would show.
    assert np.ptp(R @ [0.0, 0.0, 1.0], axis=0).max() > 0.05


def places(times: NDArray[Any], wrenches: NDArray[Any], R_WS: NDArray[Any]) -> NDArray[Any]:
    """Return where the touches of a stream are, S, m."""
    followed = protocol()
    events = [*followed.feed(times, MODEL.compensate(R_WS, wrenches), R_WS, None), *followed.finish()]
    touches = [event.touch for event in events if event.touch is not None]
    return np.array([each.located.point for each in touches if each.located is not None])


def test_a_sensor_that_speaks_without_poses_or_measurements_is_not_silent() -> None:
    engine = Engine(example())
    for i in range(50):
        engine.locate(wrench(BEGIN + 0.01 * i, np.zeros(6)))
    assert engine.silent(BEGIN + 0.5) is None
    assert engine.silent(BEGIN + 0.7) is not None
    engine.poses([flange(BEGIN + 1.0, np.eye(3))])
    engine.locate(wrench(BEGIN + 1.0, np.zeros(6), Status.INVALID))
    assert engine.silent(BEGIN + 1.1) is None


def test_poses_that_came_almost_at_once_do_not_throw_the_tool_about() -> None:
    engine, (_, pushed) = Engine(example()), touch()
    trembled = Rotation.from_rotvec([0.0, 2e-5, 1e-5]).as_matrix()
    engine.poses([flange(BEGIN, np.eye(3)), flange(BEGIN + 1e-6, trembled)])
    answer = engine.locate(wrench(BEGIN + 0.14, example().gravity.predict(np.eye(3)) + pushed))
    assert answer.contact is not None
    assert answer.contact.wrench == pytest.approx(pushed, abs=1e-3)


@pytest.mark.parametrize("first", [100, 0])
def test_one_hang_does_not_hide_the_next(first: int) -> None:
    """Constant readings while a sensor starts, or spells of hanging that get longer and longer."""
    rng, detector = np.random.default_rng(5), kernel.FrozenDetector()

    def lives(count: int) -> None:
        for row in rng.normal(size=(count, 6)).tolist():
            detector.see(tuple(row), FROZEN_CHANCE)

    def hangs(count: int) -> int:
        row = tuple(rng.normal(size=6).tolist())
        return [detector.see(row, FROZEN_CHANCE) for _ in range(count)].count(False)

    hangs(first)
    lives(2_000)
    for length in () if first else (4, 12, 28, 60):
        hangs(length + 1)
        lives(200)
    assert hangs(200) < 40  # 0.2 s at 200 Hz
