"""A run: samples come in the threads of their streams, contacts go out in those of the outputs."""

from __future__ import annotations

import gc
import math
import sys
import time
from collections import Counter
from collections.abc import Callable, Sequence
from contextlib import contextmanager
from typing import TYPE_CHECKING, Self

import numpy as np

from contactbench.pipeline.config.runtime import RuntimeConfig
from contactbench.pipeline.config.runtime.values import make_runtime
from contactbench.pipeline.contact.facet_marks import facet_marks
from contactbench.pipeline.devices.sample import FlangeSample, WrenchSample
from contactbench.pipeline.devices.url import DeviceAddress, Protocol
from contactbench.pipeline.errors import RunError, arg, message
from contactbench.pipeline.runtime.lines import Answer, contact_schema, health_names
from contactbench.pipeline.runtime.outputs import OUTPUTS

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from contactbench.pipeline import kernel
    from contactbench.pipeline.runtime.outlet import Outlet

_UNKNOWN = np.full(3, np.nan)


class Engine:
    """
    One stream of wrenches and one of poses, into contacts.

    A sample takes the pose at its own time: between two poses, or carried on from the last one, as the config's
    ``streams`` allow. Without one the reason is ``stale``, and the filters are left as they were.

    Wrenches may come in one thread and poses in another.

    Parameters
    ----------
    config : RuntimeConfig
    hold : float, optional
        As for `make_runtime`; infinite for a pose that stands still.
    clock : callable, optional
        The present on the samples' clock, s: a contact's latency then runs until it is found. Left out, it ends with
        the sample's arrival.
    """

    def __init__(
        self, config: RuntimeConfig, *, hold: float | None = None, clock: Callable[[], float] | None = None
    ) -> None:
        self._runtime, self._clock = make_runtime(config, hold=hold), clock
        self._marks = facet_marks(config.probe)

    def poses(self, samples: Sequence[FlangeSample]) -> None:
        """Take poses of the flange, oldest first."""
        for sample in samples:
            R = np.ascontiguousarray(sample.R_BE, dtype=np.float64)
            p = np.ascontiguousarray(sample.p_BE_B, dtype=np.float64)
            self._runtime.pose(R, p if p.shape == (3,) else _UNKNOWN, sample.time)

    def locate(self, sample: WrenchSample) -> Answer:
        """Say where the probe is touched."""
        reading = np.array((*sample.force, *sample.torque))
        arrival = sample.time if sample.arrival is None else sample.arrival
        contact = self._runtime.locate(reading, sample.time, arrival, int(sample.status))
        latency = contact.latency if self._clock is None else contact.latency + (self._clock() - arrival)
        mark = -1 if contact.face is None else int(self._marks[contact.face])
        return Answer(contact, latency, self._runtime.zero(), mark)

    def silent(self, now: float) -> Answer | None:
        """Return an answer that says that no sample comes, or None while they do; `now` in s of the samples' clock."""
        contact = self._runtime.silent(now)
        return None if contact is None else Answer(contact, contact.latency, self._runtime.zero())


_SWITCH_S = 1e-4
_RATE_OFF = 0.05
_BUSY = 0.85  # of one processor core: nearly all of this program waits for one lock
_HEARTBEAT_S = 0.1
_TRIALS, _READING = 60, 3.6  # what reading a sample takes, as `Output.effort`
_UNUSABLE = ("stale", "unhealthy", "not_finite", "not_a_rotation")
_MOST_UNUSABLE = 0.05  # of the samples: beyond, a run is no good


class Latencies:
    """How old readings were when their contacts were known: counts in bins that are 5 % wide."""

    def __init__(self) -> None:
        self._counts: Counter[int] = Counter()

    def add(self, seconds: float) -> None:
        """Take one; what is not finite does not count."""
        if math.isfinite(seconds):
            self._counts[round(math.log(max(seconds, 1e-6), 1.05))] += 1

    def quantile(self, share: float) -> float | None:
        """Return the latency that a share of the samples does not exceed, s, to 2.5 %; None: none is known."""
        left = share * self._counts.total()
        for bin_, count in sorted(self._counts.items()):
            left -= count
            if left <= 0:
                return float(1.05**bin_)
        return None


def load_from_now() -> Callable[[], float]:
    """Return what tells the share of a processor core used since now; above 1: libraries have threads of their own."""
    begun, used = time.monotonic(), time.process_time()
    return lambda: (time.process_time() - used) / max(time.monotonic() - begun, 1e-6)


class Run:
    """
    Locate every sample, at once and in the sensor's thread, and hand the contacts to the outputs.

    Use it in a ``with`` statement, around the streams.

    Parameters
    ----------
    config : RuntimeConfig
    outlets : sequence of Outlet
        Started and closed here.
    hold : float, optional
        As for `Engine`.
    on_answer : callable, optional
        Gets every contact in the sensor's thread, before the outputs; it must be quick and not raise.
    clock : callable, optional
        As for `Engine`.

    Attributes
    ----------
    reasons, unhealthy : Counter
        Samples so far by their reason, and by what is wrong with their health.
    on : Counter
        Contacts so far by what they lie on, one of `contactbench.pipeline.contact.facet_marks.MARKS`.
    latencies : Latencies
    positions : bool or None
        Whether poses come with positions; None: none came yet.
    zero : kernel.Zero or None
        What is known of the sensor's zero at the last sample; None: none came yet.
    """

    def __init__(
        self,
        config: RuntimeConfig,
        outlets: Sequence[Outlet] = (),
        *,
        hold: float | None = None,
        on_answer: Callable[[WrenchSample, Answer], None] | None = None,
        clock: Callable[[], float] | None = None,
    ) -> None:
        self._engine = Engine(config, hold=hold, clock=clock)
        self.outlets, self._on_answer = tuple(outlets), on_answer
        self.reasons: Counter[str] = Counter()
        self.unhealthy: Counter[str] = Counter()
        self.on: Counter[str] = Counter()
        self.latencies = Latencies()
        self.positions: bool | None = None
        self.zero: kernel.Zero | None = None
        self._beat = -math.inf
        self._begun, self._counted, self._lost = False, 0, 0

    def __enter__(self) -> Self:
        for outlet in self.outlets:
            outlet.start()
        return self

    def __exit__(self, *_: object) -> None:
        """Publish what waits; the streams have ended."""
        for outlet in self.outlets:
            outlet.close()

    def wrenches(self, samples: Sequence[WrenchSample]) -> None:
        """Take wrenches, oldest first."""
        for sample in samples:
            answer = self._engine.locate(sample)
            self.zero = answer.zero
            self.reasons[answer.reason] += 1
            usable = answer.reason not in _UNUSABLE
            self._begun |= usable
            self._counted += self._begun
            self._lost += self._begun and not usable
            if answer.health:
                self.unhealthy.update(health_names(answer.health))
            if answer.on is not None:
                self.on[answer.on] += 1
            self.latencies.add(answer.latency)
            if self._on_answer is not None:
                self._on_answer(sample, answer)
            for outlet in self.outlets:
                outlet.put(answer)

    def poses(self, samples: Sequence[FlangeSample]) -> None:
        """Take poses of the flange, oldest first."""
        self._engine.poses(samples)
        if samples:
            self.positions = bool(np.isfinite(samples[-1].p_BE_B).all())

    def heartbeat(self, now: float) -> Answer | None:
        """Publish, and return, that no sample comes: ten times a second; `now` in s of the samples' clock."""
        if now - self._beat < _HEARTBEAT_S or (answer := self._engine.silent(now)) is None:
            return None
        self._beat = now
        for outlet in self.outlets:
            outlet.put(answer)
        return answer

    @property
    def unusable(self) -> float:
        """Share of the samples, since the first that could be used, that had no pose, no time or no healthy sensor."""
        return self._lost / self._counted if self._counted else 1.0

    @property
    def good(self) -> bool:
        """Whether samples came, and all but a few could be used."""
        return self.unusable <= _MOST_UNUSABLE


def check_runnable(config: RuntimeConfig, *, unverified: bool = False) -> None:
    """
    Refuse a config that nobody has verified, unless told otherwise.

    Raises
    ------
    RunError
        It is not verified.
    """
    if config.model.verified or unverified:
        return
    stale = config.model.provenance.stale
    why = message(f" ({arg('; '.join(stale))})") if stale else ""
    raise RunError(
        f"the bundle is not verified{arg(why)}: verify and export again, or add --unverified for trials"
        " without a person."
    )


def hold_for(poses: DeviceAddress) -> float | None:
    """Return how long a pose counts, s: for ever for one that was typed; None: as the config says."""
    return math.inf if poses.protocol is Protocol.STILL else None


def check_sensor(config: RuntimeConfig, serial: str, *, other: bool = False) -> None:
    """
    Refuse a sensor that says another serial number than the config's, unless told otherwise.

    Parameters
    ----------
    config : RuntimeConfig
    serial : str
        What is known of the sensor; one that is empty or ``unknown`` is no mismatch.
    other : bool

    Raises
    ------
    RunError
        It is another sensor.
    """
    wanted = config.model.sensor.serial
    if other or not known(serial) or not known(wanted) or serial == wanted:
        return
    raise RunError(
        f"the sensor's serial number is {arg(ascii(serial)[:100])}, but the bundle is for {arg(ascii(wanted)[:100])}:"
        " connect that sensor, or calibrate, verify and export with this one. Add --other-sensor"
        " if they are the same."
    )


def known(name: str | None) -> bool:
    """Return whether a model or serial number says anything."""
    return name is not None and name.strip().lower() not in ("", "unknown")


def sensor_name(model: str, serial: str) -> str:
    """Return what is known of a sensor's model and serial number; empty: nothing."""
    return " ".join(filter(known, (model, serial)))


def sensor_warnings(config: RuntimeConfig, model: str, serial: str) -> list[str]:
    """
    Say where a sensor is not the one that the config belongs to, in sentences.

    Parameters
    ----------
    config : RuntimeConfig
    model, serial : str
        What is known of the sensor; empty where that is nothing.
    """
    wanted = config.model.sensor
    said = []
    for what, expected, given in (
        ("model", wanted.model, model),
        (message("serial number"), wanted.serial, serial),
    ):
        if known(given) and known(expected) and given != expected:
            said.append(
                message(
                    f"The sensor's {arg(what)} is {arg(given)}, but the bundle is for {arg(expected)}: contacts from"
                    " another sensor are wrong."
                )
            )
    if not known(model) and not known(serial):
        name = sensor_name(wanted.model, wanted.serial) or message("an unnamed one")
        said.append(
            message(
                f"The sensor does not identify itself; the bundle is for {arg(name)}: make sure it is this one."
            )
        )
    return said


def motion_warning(config: RuntimeConfig, positions: bool | None) -> str | None:
    """Say that the inertia of a moving tool stays in the readings; None: it is taken off, or no pose came yet."""
    if positions is None or (positions and config.model.streams.motion is not None):
        return None
    why = message("the bundle says so") if positions else message("the poses have no positions")
    return message(
        f"The inertia of a moving tool is not subtracted because {arg(why)}: 1 kg at 1 m/s² adds 1 N."
    )


def rate_warning(config: RuntimeConfig, rate: float | None, load: float = 0.0) -> str | None:
    """
    Say that a measured rate is not the one that the config's filters are for; None: it is, or is unknown.

    Parameters
    ----------
    config : RuntimeConfig
    rate : float or None
        Samples per second that arrived.
    load : float
        Share of a processor core that this program used: where that is nearly all, it may be what is too slow.
    """
    wanted = config.model.sensor.rate_Hz
    if rate is None or abs(rate / wanted - 1) <= _RATE_OFF:
        return None
    if rate < wanted and load >= _BUSY:
        return message(
            f"Only {arg(rate):.0f} of {arg(wanted):.0f} samples per second are handled, and this program uses"
            f" {arg(load):.0%} of a processor core: it is probably too slow here, not the sensor. Use fewer outputs, or"
            " stop other programs."
        )
    return message(
        f"The sensor sends {arg(rate):.0f} samples per second, but the bundle is for {arg(wanted):.0f}, so"
        " its filters act at another frequency. Set the sensor's rate, or export for this one."
    )


def load_words(rate: float | None, load: float) -> str | None:
    """Say how many contacts per second fit on this computer, by `load` at `rate`, Hz; None: not known."""
    if rate is None or load <= 0.0:
        return None
    return message(
        f"processor: {arg(load):.0%} of a core at {arg(rate):.0f} samples per second; with these outputs about"
        f" {arg(rate / load):,.0f} would fit."
    )


def rate_that_fits(config: RuntimeConfig, outputs: Iterable[str]) -> float:
    """Estimate how many contacts a second one core can read, locate and bring to outputs, by their names."""
    engine = Engine(config, hold=math.inf)
    engine.poses([FlangeSample(0.0, np.eye(3), np.full(3, np.nan))])
    push = config.gravity.predict(np.eye(3)) + [0.0, 0.0, -5.0, 0.0, 0.0, 0.0]
    located, spoken = [], []
    for k in range(_TRIALS):
        begun = time.perf_counter()
        engine.locate(WrenchSample(1e-3 * k, tuple(push[:3]), tuple(push[3:])))
        between = time.perf_counter()
        contact_schema()
        located.append(between - begun)
        spoken.append(time.perf_counter() - between)
    efforts = _READING + sum(OUTPUTS[name].effort for name in outputs)
    return 1.0 / (min(located) + efforts * min(spoken))  # the quickest: no other program was in the way


def fit_words(config: RuntimeConfig, fits: float) -> tuple[str, bool]:
    """Say before a run how many contacts per second fit; also whether they are fewer than the bundle's sensor sends."""
    rate = config.model.sensor.rate_Hz
    words = message(
        f"About {arg(fits):,.0f} contacts per second fit on one core with these outputs; the sensor sends"
        f" {arg(rate):,.0f}."
    )
    more = message("Readings and contacts will be lost: use fewer outputs, or a lower rate.")
    return (f"{words} {more}", True) if fits < rate else (words, False)


def mark_warnings(on: Counter[str]) -> list[str]:
    """Say how many contacts, counted by what they lie on, rest on a guess or should not be; empty: none."""
    total = on.total()
    sentences = {
        "invented": message(
            f"{arg(on['invented']):,} of {arg(total):,} contacts are on invented facets: the mesh file had an"
            " opening there, so surface and contacts are guesses."
        ),
        "untouchable": message(
            f"{arg(on['untouchable']):,} of {arg(total):,} contacts are on untouchable regions: check the region,"
            " then the mount."
        ),
    }
    return [text for mark, text in sentences.items() if on[mark] > 0]


def zero_words(zero: kernel.Zero) -> str:
    """Say how far the sensor's zero is off, what that does to a contact, and what to do."""
    if (offset := zero.offset) is None or (sigma := zero.sigma) is None:
        return message(
            "The sensor's zero is not known yet: hold the probe still for a second without touching anything."
        )
    sizes = []
    for part, scale, unit in ((slice(3), 1.0, "N"), (slice(3, 6), 1e3, "mN·m")):
        size = float(np.linalg.norm(offset[part]))
        spread = float(np.linalg.norm(offset[part] * sigma[part])) / size if size > 0 else 0.0
        sizes.append(f"{scale * size:.2g} ± {scale * spread:.1g} {unit}")
    off = " and ".join(sizes)
    shift = message(
        f"a contact at 10 N moves by up to {arg(1e3 * zero.shift):.2g} ± {arg(1e3 * zero.shift_sigma):.1g} mm"
    )
    if zero.state == "off":
        return message(
            f"The sensor's zero is off by {arg(off)}: {arg(shift)}. Recalibrate before you trust a contact."
        )
    if zero.state == "doubtful":
        return message(
            f"The sensor reads {arg(off)} too much, or something touches the probe. If nothing does,"
            f" {arg(shift)}. Lift the probe clear and hold it still at three tilts, 20° apart."
        )
    return message(f"The sensor's zero is confirmed: off by {arg(off)}; {arg(shift)}.")


@contextmanager
def responsive() -> Iterator[None]:
    """Let threads take turns sooner, and spare what is there now from garbage collection: both cost milliseconds."""
    before = sys.getswitchinterval()
    gc.collect()
    gc.freeze()
    sys.setswitchinterval(_SWITCH_S)
    try:
        yield
    finally:
        sys.setswitchinterval(before)
        gc.unfreeze()
