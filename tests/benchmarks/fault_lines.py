"""One fault on one live line: when it is shown, when all is well again, and whether every sample was sent."""

from __future__ import annotations

import math
import threading
import time
from dataclasses import dataclass
from typing import TYPE_CHECKING

from contactbench.pipeline.devices.driver import Carrier
from contactbench.pipeline.devices.emulate import emulator, possible_faults, swinging
from contactbench.pipeline.devices.faults import Fault, FaultEvent, Script, Six
from contactbench.pipeline.devices.protocols.registry import driver_for
from contactbench.pipeline.devices.reconnecting_stream import SensorStream, poses_from
from contactbench.pipeline.devices.sample import FlangeSample, WrenchSample
from contactbench.pipeline.devices.stream import Health
from contactbench.pipeline.devices.url import DeviceAddress

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence

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
    heard = _Heard()
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


class _Heard:
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


def _stream(line: FaultLine, url: str, heard: _Heard) -> SensorStream | ElfinPoses | UrPoses:
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
    line: FaultLine,
    fault: Fault,
    device: Emulator,
    heard: _Heard,
    times: tuple[float, float, float | None],
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
