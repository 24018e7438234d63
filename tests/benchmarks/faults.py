"""Every scripted fault with every protocol on live lines, and how sure the suspicion of a re-zero is."""

from __future__ import annotations

import math
import threading
import time
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from contactbench.pipeline.devices.driver import Carrier
from contactbench.pipeline.devices.emulate import emulator, possible_faults, swinging
from contactbench.pipeline.devices.faults import Fault, FaultEvent, Script, Six
from contactbench.pipeline.devices.protocols.registry import driver_for
from contactbench.pipeline.devices.readings import RezeroDetector
from contactbench.pipeline.devices.reconnecting_stream import SensorStream, poses_from
from contactbench.pipeline.devices.sample import FlangeSample, WrenchSample
from contactbench.pipeline.devices.stream import Health
from contactbench.pipeline.devices.url import DeviceAddress
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.study.report import Figure, StudyReport

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence

    from numpy.typing import NDArray

    from contactbench.pipeline.devices.emulate import Emulator, Sent
    from contactbench.pipeline.devices.protocols.elfin import ElfinPoses
    from contactbench.pipeline.devices.protocols.ur_pose import UrPoses

HEALTHY_S, FAULT_S = 1.3, 0.6
_RATE = 100.0
_ROBOT_RATE = 50.0
_WAIT_S = 5.0
_WEIGHT: Six = (1.0, -2.0, 4.5, 0.12, -0.2, 0.05)  # of a tool, 5 N
_NOISE: Six = (0.05, 0.05, 0.05, 0.004, 0.004, 0.004)
_WARM_K, _SHOWN_K = 10.0, 3.0
# Joints come as degrees with six digits.
_JOINT_TOLERANCE = 2e-8


@dataclass(frozen=True)
class FaultLine:
    """A device and its line."""

    protocol: str
    carrier: Carrier
    options: tuple[tuple[str, str], ...] = ()

    def __str__(self) -> str:
        return f"{self.protocol} {dict(self.options).get('profile', self.carrier)}"

    @property
    def robot(self) -> bool:
        """Whether it gives poses."""
        return self.protocol in ("elfin", "ur")


_FIELDS = (("fields", "n,t,fx,fy,fz,mx,my,mz,status"),)
LINES = (
    FaultLine("sri", Carrier.SERIAL),
    FaultLine("sri", Carrier.TCP),
    FaultLine("bota", Carrier.SERIAL),
    FaultLine("robotiq", Carrier.SERIAL),
    FaultLine("rdt", Carrier.UDP, (("profile", "ati"),)),
    FaultLine("rdt", Carrier.UDP, (("profile", "onrobot"),)),
    FaultLine("elfin", Carrier.TCP),
    FaultLine("ur", Carrier.TCP),
    FaultLine("kunwei", Carrier.SERIAL),
    FaultLine("robotous", Carrier.SERIAL),
    FaultLine("line", Carrier.UDP, _FIELDS),
    FaultLine("line", Carrier.TCP, _FIELDS),
)


@dataclass(frozen=True)
class Outcome:
    """What one fault did."""

    line: FaultLine
    fault: Fault
    # "shown", "unseen" (it must cost nothing and show nothing), or why the stream cannot show it
    expected: str
    detected: float | None  # Seconds from the fault to the first change that shows it; None: never shown
    shown: str  # The state and the finding that came first
    flowing: float | None  # Seconds from the fault's end to the next sample
    well: float | None  # Seconds from its end until nothing is shown any more
    samples: int  # Given; of them not among those sent intact, in their order; sent intact and not given
    made_up: int  # Given; of them not among those sent intact, in their order; sent intact and not given
    lost: int  # Given; of them not among those sent intact, in their order; sent intact and not given
    # Seconds that the emulated device was behind its own time at worst: this machine was busy
    late: float = 0.0

    @property
    def good(self) -> bool:
        """Whether it is as it must be."""
        if self.made_up or self.well is None:
            return False
        if self.expected == "unseen":
            return self.detected is None and self.lost == 0
        return self.expected != "shown" or (self.detected is not None and self.detected <= 0.2)


def expectation(line: FaultLine, fault: Fault) -> str:
    """Return what must be seen of a fault: see `Outcome.expected`."""
    if fault is Fault.HEADER or (fault is Fault.SPLIT and line.carrier is not Carrier.UDP):
        return "unseen"
    if fault is Fault.MERGED and line.protocol != "elfin":
        return "unseen"
    if fault is Fault.DRIFT and line.protocol != "bota":
        return "not visible in the stream: the calibration check finds it"
    if fault is Fault.CLOCK_JUMP and line.protocol == "rdt":
        return "not visible, and harmless: the sensor's own clock is not used"
    if fault is Fault.STUCK and line.robot:
        return "normal: a robot may stand still"
    return "shown"


def cases(lines: Sequence[FaultLine] = LINES) -> Iterator[tuple[FaultLine, Fault]]:
    """Yield every fault that each device can have."""
    for line in lines:
        for fault in Fault:
            if fault in possible_faults(line.protocol):
                yield line, fault


def run_case(line: FaultLine, fault: Fault, *, seed: int = 0) -> Outcome:
    """Play one fault to a stream, as a user would open it."""
    heard = Heard()
    script = _script(fault)
    made = emulator(
        line.protocol,
        line.carrier,
        rate=_RATE,
        signal=swinging(line.protocol) if line.robot else resting,
        script=script,
        seed=seed,
        options=dict(line.options),
    )
    with made as device, _stream(line, device.url, heard) as stream:
        heard.wait(lambda: bool(device.log) and time.monotonic() > _origin(device) + script.events[-1].stop)
        start, end = _origin(device) + _visible(script), _origin(device) + script.events[-1].stop
        heard.wait(lambda: heard.after(end) is not None)
        if fault in (Fault.REZERO, Fault.DRIFT):  # for good: somebody reads it
            time.sleep(0.2)
            stream.acknowledge()
        # A fault of the last moment shows with the next samples.
        settled = heard.wait(lambda: time.monotonic() > end + 0.3 and stream.health.well)
        until = time.monotonic() if settled else None
    return _judge(line, fault, device, heard, (start, end, until))


def resting(at: float) -> Six:
    """Return what a sensor under a tool at rest measures, with a noise that is the same again."""
    noise = [a * math.sin(1e4 * at * (k + 3) + k) for k, a in enumerate(_NOISE)]
    fx, fy, fz, mx, my, mz = (w + n for w, n in zip(_WEIGHT, noise, strict=True))
    return (fx, fy, fz, mx, my, mz)


class Heard:
    """What a stream gave and told."""

    def __init__(self) -> None:
        self.samples: list[WrenchSample | FlangeSample] = []
        self.changes: list[tuple[float, Health]] = []
        self._news = threading.Condition()

    def take(self, samples: Sequence[WrenchSample | FlangeSample]) -> None:
        with self._news:
            self.samples += samples
            self._news.notify_all()

    def change(self, health: Health) -> None:
        with self._news:
            self.changes.append((time.monotonic(), health))
            self._news.notify_all()

    def after(self, when: float) -> float | None:
        """Return the time of the first sample after `when`."""
        return next((s.time for s in self.samples if s.time > when), None)

    def wait(self, what: Callable[[], bool]) -> bool:
        deadline = time.monotonic() + _WAIT_S
        while not what() and time.monotonic() < deadline:
            with self._news:
                self._news.wait(0.02)
        return what()


def _script(fault: Fault) -> Script:
    if fault is Fault.HEADER:  # short ones: readings that stay the same are a fault of their own
        return Script([FaultEvent(HEALTHY_S + 0.2 * k, fault, 0.08) for k in range(3)])
    return Script([FaultEvent(HEALTHY_S, fault, FAULT_S)])


def _visible(script: Script) -> float:
    """Return when there is something to be seen, s of the script."""
    event = script.events[0]
    warming = event.duration * _SHOWN_K / _WARM_K if event.fault is Fault.DRIFT else 0.0
    return event.start + warming


def _stream(line: FaultLine, url: str, heard: Heard) -> SensorStream | ElfinPoses | UrPoses:
    if line.robot:
        return poses_from(f"{url}?rate={_ROBOT_RATE:g}", heard.take, heard.change)
    # An ATI sensor's rate is its own: no rate is given, so the stream has to learn it.
    own = line.protocol == "robotiq" or ("profile", "ati") in line.options
    option = "" if own else f"{'&' if '?' in url else '?'}rate={_RATE:g}"
    return SensorStream(url + option, heard.take, heard.change)


def _origin(device: Emulator) -> float:
    """Return the monotonic time at which the script began, s."""
    return min(sent.sent_at - sent.time for sent in list(device.log)[:50])


def _judge(
    line: FaultLine, fault: Fault, device: Emulator, heard: Heard, times: tuple[float, float, float | None]
) -> Outcome:
    start, end, settled = times
    made_up, lost = compare(heard.samples, device.intact(), DeviceAddress.parse(device.url))
    until = math.inf if settled is None else settled
    told = [(when, health) for when, health in heard.changes if when <= until]
    ill = next(((when, health) for when, health in told if when >= start and not health.well), None)
    # Seen to be well; when it was told is nearer to the truth.
    well = None if settled is None else max(0.0, (told[-1][0] if told[-1][1].well else settled) - end)
    flowing = heard.after(end)
    return Outcome(
        line,
        fault,
        expectation(line, fault),
        None if ill is None else ill[0] - start,
        "" if ill is None else _shown(ill[1]),
        None if flowing is None else flowing - end,
        well,
        len(heard.samples),
        made_up,
        lost,
        max(sent.sent_at - sent.time for sent in list(device.log)) - _origin(device),
    )


def _shown(health: Health) -> str:
    return f"{health.state}: {' '.join((*health.findings, *health.suspicions))}"


def compare(
    samples: Sequence[WrenchSample | FlangeSample], sent: Sequence[Sent], address: DeviceAddress
) -> tuple[int, int]:
    """Look for each sample among what was sent intact, in order."""
    rows = [_values(each, address) for each in sent]
    tolerance = _JOINT_TOLERANCE if address.gives_poses else 0.0
    made_up, position, first, matched = 0, 0, None, 0
    for sample in samples:
        wanted = _given(sample)
        found = next((k for k in range(position, len(rows)) if _equal(rows[k], wanted, tolerance)), None)
        if found is None:
            made_up += 1
            continue
        first = found if first is None else first
        position, matched = found + 1, matched + 1
    return made_up, 0 if first is None else position - first - matched


def _given(sample: WrenchSample | FlangeSample) -> tuple[float, ...]:
    if isinstance(sample, WrenchSample):
        return (*sample.force, *sample.torque)
    return () if sample.joints is None else tuple(sample.joints.tolist())


def _values(sent: Sent, address: DeviceAddress) -> tuple[float, ...]:
    """Return what is in a frame, as its bytes say."""
    if address.gives_poses:
        return sent.reading.values
    parser = driver_for(address).parser
    parser.feed(b"\n", 0.0)  # a line of text is believed from its beginning on
    (sample,) = parser.feed(sent.frame, 0.0)
    return _given(sample)


def _equal(one: tuple[float, ...], two: tuple[float, ...], tolerance: float) -> bool:
    return len(one) == len(two) and all(abs(a - b) <= tolerance for a, b in zip(one, two, strict=True))


_MOST_MS = 200.0
_CAUGHT = 0.95
_WORKERS = 6
# A pause of the machine this long is itself a fault to a stream, s.
_PAUSE_S, _TICK_S = 0.03, 0.005
_TRIES = 3
_RATES = (100.0, 200.0, 1000.0)
_SHORT = (
    *((LINES[1], fault) for fault in (Fault.MERGED, Fault.BAD_CHECKSUM, Fault.STALL, Fault.REZERO)),
    *((LINES[7], fault) for fault in (Fault.SPLIT, Fault.GARBAGE, Fault.DISCONNECT, Fault.CLOCK_JUMP)),
)


@dataclass(frozen=True)
class Measured:
    """All outcomes."""

    outcomes: tuple[Outcome, ...]
    repeated: int  # Runs that were made again because this machine paused in them


def run(
    *, short: bool = False, trials: int = 300, seed: int = 0, progress: Callable[[str], None] = lambda _: None
) -> StudyReport:
    """Play every fault to every protocol, and judge what was shown, what came back and what was made up."""
    if trials < 1:
        raise InputError("give a number of trials above 0.")
    measured = measure(list(_SHORT if short else cases()), seed=seed, progress=progress)
    progress(f"suspicion of a re-zero: {trials} trials")
    figures = (*_figures(measured.outcomes), *rezero_figures(trials, seed))
    settings = {"cases": len(measured.outcomes), "trials": trials, "seed": seed}
    return StudyReport("Faults on live lines", settings, figures, _notes(measured))


def measure(
    chosen: Sequence[tuple[FaultLine, Fault]],
    *,
    seed: int = 0,
    workers: int = _WORKERS,
    progress: Callable[[str], None] = lambda _: None,
) -> Measured:
    """
    Run cases, some at a time.

    A case that does not come out as it must, while this machine paused, is run again.
    """
    repeated: list[FaultLine] = []

    def once(case: tuple[FaultLine, Fault]) -> Outcome:
        for _ in range(_TRIES):
            begun = time.monotonic()
            outcome = run_case(*case, seed=seed)
            if outcome.good or max(outcome.late, pauses.longest(begun)) < _PAUSE_S:
                break
            repeated.append(case[0])
        return outcome

    outcomes = []
    with _Pauses() as pauses, ThreadPoolExecutor(workers) as pool:
        for number, outcome in enumerate(pool.map(once, chosen), 1):
            outcomes.append(outcome)
            if number % 10 == 0 or number == len(chosen):
                progress(f"{number} of {len(chosen)} faults played")
    return Measured(tuple(outcomes), len(repeated))


def rezero_figures(trials: int, seed: int) -> tuple[Figure, ...]:
    """Measure how many re-zeros under 5 N are suspected, and how often touches and taps are."""
    rng = np.random.default_rng(seed)
    caught = sum(_caught(rng, _RATES[k % 3]) for k in range(trials))
    false = sum(
        _alarms(_touched(rng, 30.0, _RATES[k % 3], _rest(rng, k)), _RATES[k % 3]) for k in _some(trials)
    )
    return (
        Figure("re-zero under 5 N", "suspected", caught / trials, least=_CAUGHT),
        Figure("touches and taps", f"suspected in {len(_some(trials)) / 2:.0f} min", false, most=0),
    )


def _some(trials: int) -> range:
    # Half minutes cost a thousand times what one re-zero does.
    return range(max(2, trials // 25))


# ---- the report ----------------------------------------------------------------------------------


def _figures(outcomes: Sequence[Outcome]) -> Iterator[Figure]:
    for each in outcomes:
        if each.expected == "shown":
            after = np.inf if each.detected is None else 1e3 * each.detected
            yield Figure(str(each.line), f"{each.fault}: shown after", after, "ms", most=_MOST_MS)
        elif each.expected == "unseen":
            cost = each.lost + (each.detected is not None)
            yield Figure(str(each.line), f"{each.fault}: samples lost, or shown", cost, most=0)
    for line in dict.fromkeys(each.line for each in outcomes):
        mine = [each for each in outcomes if each.line == line]
        made_up, given = sum(each.made_up for each in mine), sum(each.samples for each in mine)
        yield Figure(str(line), f"made up, of {given} samples", made_up, most=0)
        yield Figure(
            str(line), "faults that it did not get over", sum(each.well is None for each in mine), most=0
        )
        again = [1e3 * each.flowing for each in mine if each.flowing is not None]
        if again:
            yield Figure.of(str(line), "samples again after the end", again, "ms")


def _notes(measured: Measured) -> tuple[str, ...]:
    notes = []
    for fault in Fault:
        found = [o for o in measured.outcomes if o.fault is fault and o.expected not in ("shown", "unseen")]
        for words in dict.fromkeys(outcome.expected for outcome in found):
            lines = ", ".join(str(outcome.line) for outcome in found if outcome.expected == words)
            notes.append(f"{fault} of {lines}: {words}.")
    notes.append(f"Runs repeated because this machine paused: {measured.repeated}.")
    notes.append(
        "A re-zero is suspected from rest to rest only, and never once the sensor had rested at zero."
    )
    return tuple(notes)


class _Pauses:
    """Notices when this process gets no time."""

    def __init__(self) -> None:
        self._pauses: list[tuple[float, float]] = []
        self._stop = threading.Event()
        self._thread = threading.Thread(target=self._run, name="pauses", daemon=True)

    def __enter__(self) -> _Pauses:
        self._thread.start()
        return self

    def __exit__(self, *_: object) -> None:
        self._stop.set()
        self._thread.join()

    def longest(self, since: float) -> float:
        """Return the longest pause since then, s."""
        return max((length for when, length in list(self._pauses) if when >= since), default=0.0)

    def _run(self) -> None:
        last = time.monotonic()
        while not self._stop.wait(_TICK_S):
            now = time.monotonic()
            if now - last > _PAUSE_S:
                self._pauses.append((now, now - last))
            last = now


# ---- re-zeros and touches ------------------------------------------------------------------------


def _rest(rng: np.random.Generator, number: int) -> NDArray[np.float64]:
    """Return the wrench at rest, (6,): under 5 N, under little, and of a bare sensor at zero."""
    return _load(rng, (5.0, 0.5, 0.0)[number % 3])


def _load(rng: np.random.Generator, force: float) -> NDArray[np.float64]:
    """Return a force of any direction with its torque, (6,) N and N·m."""
    direction = rng.normal(size=3)
    vector = force * direction / np.linalg.norm(direction)
    return np.concatenate([vector, np.cross(rng.uniform(-0.1, 0.1, 3), vector)])


def _noise(rng: np.random.Generator, rows: int) -> NDArray[np.float64]:
    sigma = rng.uniform(0.01, 0.1)
    return rng.normal(size=(rows, 6)) * ([sigma] * 3 + [sigma / 30] * 3)


def _touched(
    rng: np.random.Generator, seconds: float, rate: float, rest: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Return rest, interrupted by taps and touches that begin and end slowly or within a sample, (n, 6)."""
    rows = int(seconds * rate)
    readings = rest + _noise(rng, rows)
    position = int(0.3 * rate)
    while position < rows:
        shape = _tap(rng, rate) if rng.random() < 0.5 else _touch(rng, rate)
        shape = shape[: rows - position]
        readings[position : position + len(shape)] += shape[:, None] * _load(rng, rng.uniform(2.0, 30.0))
        position += len(shape) + int(rng.uniform(0.05, 1.0) * rate)
    return readings


def _tap(rng: np.random.Generator, rate: float) -> NDArray[np.float64]:
    steps = max(1, int(rng.uniform(0.005, 0.06) * rate))
    pulse: NDArray[np.float64] = np.sin(np.pi * (np.arange(steps) + rng.uniform(0.2, 0.8)) / steps)
    return pulse


def _touch(rng: np.random.Generator, rate: float) -> NDArray[np.float64]:
    up, down = (int(rng.choice([0.001, 0.02, 0.3]) * rate) for _ in range(2))
    hold = np.ones(max(1, int(rng.uniform(0.1, 1.5) * rate)))
    return np.concatenate([np.linspace(0, 1, up + 1)[1:], hold, np.linspace(1, 0, down + 1)[1:]])


def _alarms(readings: NDArray[np.float64], rate: float) -> int:
    detector = RezeroDetector()
    found = 0
    for number, (fx, fy, fz, mx, my, mz) in enumerate(readings.tolist()):
        found += detector.feed(WrenchSample(number / rate, (fx, fy, fz), (mx, my, mz))) is not None
    return found


def _caught(rng: np.random.Generator, rate: float) -> bool:
    """Zero a sensor under 5 N, at rest after some touches."""
    rest = _load(rng, 5.0)
    before, still = _touched(rng, 2.0, rate, rest), rest + _noise(rng, int(0.8 * rate))
    at = len(still) // 2
    still[at:] -= still[at - 10 : at].mean(axis=0)
    return _alarms(np.concatenate([before, still]), rate) == 1
