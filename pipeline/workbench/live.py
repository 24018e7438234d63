"""The one path of live samples: from the devices to the charts, the recording, and whoever follows them."""

from __future__ import annotations

import threading
from collections import deque
from dataclasses import dataclass
from operator import is_not
from typing import TYPE_CHECKING, Any

import numpy as np

from contactbench.pipeline.contact.following import FollowedZero
from contactbench.pipeline.devices.pose_source import LONGEST_AHEAD_S, PoseTrack
from contactbench.pipeline.devices.sample import FROZEN_CHANCE, FlangeSample, Status, WrenchSample
from contactbench.pipeline.devices.url import DeviceAddress
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.filtering import KalmanFilter
from contactbench.pipeline.kernel import Contact, FrozenDetector, Reason, Zero
from contactbench.pipeline.runtime import Outlet, Run
from contactbench.pipeline.runtime.outlet import OutputContext
from contactbench.pipeline.runtime.outputs import open_outputs
from contactbench.pipeline.runtime.run import check_runnable, check_sensor, hold_for
from contactbench.pipeline.streams import Pair, open_pair

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    from numpy.typing import NDArray

    from contactbench.pipeline.calibration import GravityModel
    from contactbench.pipeline.config.runtime import RuntimeConfig
    from contactbench.pipeline.contact import ContactSolver
    from contactbench.pipeline.devices.stream import Health
    from contactbench.pipeline.session import State
    from contactbench.pipeline.simulation.virtual.bench import VirtualBench

    Array = NDArray[np.float64]
    _Newest = tuple[float, Array, Array, Array]  # time, filtered wrench, what is taken off it, orientation

_KEPT = 120_000  # samples: 120 s at 1 kHz, 10 minutes at 200 Hz; 20 MB
_USUAL_HZ = 200.0
_FIRST = 1024  # rows looked at first
_SLICE = 4096  # rows compensated at a time under the lock: a millisecond, for a stream waits for it
_CONTACTS = 4096  # at 30 a second, two minutes of them
_NOISE = (0.05, 0.05, 0.05, 0.002, 0.002, 0.002)  # N and N·m, of a reading
_GAP_S = 1.0  # after a longer silence the filter begins anew: what was before says nothing
_NO_TOUCH = (Reason.LOW_FORCE, Reason.STALE, Reason.NOT_FINITE)
_FORGET_S = 0.25  # a contact that was not looked at for longer is not followed


def follows(state: State) -> bool:
    """Tell whether a session is verified with a zero that follows."""
    return state.setting("verification.follow") is True


class Ring:
    """
    The newest samples; any thread may add and read.

    Parameters
    ----------
    capacity : int
        Samples that are kept.
    """

    def __init__(self, capacity: int) -> None:
        self._times = np.full(capacity, np.nan)
        self._raw = np.full((capacity, 6), np.nan)
        self._compensated = np.full((capacity, 6), np.nan)
        self._R_WS = np.full((capacity, 3, 3), np.nan)
        self._stores = self._times, self._raw, self._compensated, self._R_WS
        self._capacity, self.count = capacity, 0
        self._lock = threading.Lock()

    def clear(self) -> None:
        """Forget all."""
        with self._lock:
            self.count = 0

    def add(self, times: Array, raw: Array, compensated: Array, R_WS: Array) -> None:
        """Take samples: times (n,), wrenches raw and compensated (n, 6), orientations (n, 3, 3)."""
        kept = min(len(times), self._capacity)
        with self._lock:
            first = self.count + len(times) - kept
            for store, new in zip(self._stores, (times, raw, compensated, R_WS), strict=True):
                _put(store, first % self._capacity, new[len(times) - kept :])
            self.count += len(times)

    def last(self, seconds: float) -> tuple[Array, Array, Array]:
        """Return times (n,), raw (n, 6) and compensated (n, 6) of the last seconds, oldest first; copies."""
        with self._lock:
            rows = self._rows(seconds)
            times = self._times[rows]
            if len(times):
                # A clock that jumped back, such as a replay begun again, is no reason to show nothing.
                back = np.flatnonzero(np.diff(times) < 0)
                start = int(back[-1]) + 1 if len(back) else 0
                start += int(np.searchsorted(times[start:], times[-1] - seconds))
                rows, times = rows[start:], times[start:]
            return times, self._raw[rows], self._compensated[rows]

    def compensate(self, model: GravityModel | None, zero: FollowedZero | None, done: int) -> int:
        """Compensate some samples anew, from number `done` on; return the number of the first that is left."""
        with self._lock:
            done = max(done, self.count - self._capacity)
            rows = np.arange(done, min(done + _SLICE, self.count)) % self._capacity
            given = self._R_WS[rows], self._raw[rows], self._times[rows]
            self._compensated[rows], _ = _compensated(model, zero, *given)
            return done + len(rows)

    def _rows(self, seconds: float) -> NDArray[np.intp]:
        """Return rows that hold the last seconds, oldest first, and perhaps older ones."""
        kept, some = min(self.count, self._capacity), _FIRST
        while True:  # not all at once: 30 times a second that would be 100 MB of copies
            some = min(some, kept)
            rows = np.arange(self.count - some, self.count, dtype=np.intp) % self._capacity
            if some == kept or self._times[rows[0]] < self._times[rows[-1]] - seconds:
                return rows
            some *= 4


def _compensated(
    model: GravityModel | None, zero: FollowedZero | None, R_WS: Array, raw: Array, times: Array
) -> tuple[Array, Array]:
    """Return wrenches without bias and weight, NaN without a calibration; and what is off them as the zero follows."""
    if model is None:
        return np.full_like(raw, np.nan), np.zeros_like(raw)
    untaken = model.compensate(R_WS, raw)
    taken = np.zeros_like(raw) if zero is None else zero.taken(untaken, R_WS, times)
    return untaken - taken, taken


def _put(store: Array, place: int, new: Array) -> None:
    until_end = min(len(new), len(store) - place)
    store[place : place + until_end] = new[:until_end]
    store[: len(new) - until_end] = new[until_end:]


@dataclass(frozen=True, eq=False)
class LiveReading:
    """The newest moment."""

    time: float  # s
    raw: Array  # raw, compensated: (6,); N and N·m; filtered; NaN without a calibration
    compensated: Array
    R_WS: Array  # (3, 3); NaN where no pose is known
    contact: Contact | None  # None: nothing touches, or there is no probe or no calibration
    # What the contact lies on, one of `contactbench.pipeline.contact.facet_marks.MARKS`; None: there is none
    on: str | None = None


class LiveMoment:
    """
    What the filter says now; the contact is looked for when it is asked for, once for each sample.

    Parameters
    ----------
    rate : float
        Samples a second that the filter is made for, Hz.

    Attributes
    ----------
    time : float
        Of the newest sample, s; -inf: none came.
    """

    def __init__(self, rate: float) -> None:
        self._filter = KalmanFilter(rate, sigma=_NOISE)
        self.time = -np.inf
        self._newest: _Newest | None = None
        self._told: tuple[tuple[object, ...], LiveReading] | None = None
        self._looked = -np.inf
        self._contacts: deque[tuple[float, Array]] = deque(maxlen=_CONTACTS)
        self._asking = threading.Lock()

    def add(self, times: Array, raw: Array, R_WS: Array, taken: Array) -> None:
        """Take samples: times (n,), raw wrenches (n, 6), orientations (n, 3, 3), and what is taken off (n, 6)."""
        steps = np.diff(times, prepend=self.time)
        if not 0 < steps[0] <= _GAP_S:
            self._filter.reset()
            steps[0] = 1 / self._filter.rate
        # Times that repeat, as of a batch that came at once, are no reason to stop.
        state = self._filter.update_block(raw - taken, np.maximum(steps, 1e-6))[-1]
        self.time = float(times[-1])
        self._newest = self.time, state, taken[-1], R_WS[-1]

    def reading(self, model: GravityModel | None, solver: ContactSolver | None) -> LiveReading | None:
        """Return the newest moment; None before the first sample."""
        with self._asking:
            key = newest, *_ = self._newest, model, solver
            if newest is None:
                return None
            if self._told is None or any(map(is_not, self._told[0], key)):
                self._told = key, self._look(newest, model, solver)
            return self._told[1]

    def contacts(self, seconds: float) -> tuple[Array, Array]:
        """Return times (n,) and points (n, 3), S, m, of the last seconds of what was asked for; NaN: no contact."""
        with self._asking:
            kept = [each for each in self._contacts if each[0] >= self.time - seconds]
        times = np.array([time for time, _ in kept])
        return times, np.array([point for _, point in kept]).reshape(-1, 3)

    def _look(self, newest: _Newest, model: GravityModel | None, solver: ContactSolver | None) -> LiveReading:
        time, raw, taken, R_WS = newest
        compensated = np.full(6, np.nan) if model is None else model.compensate(R_WS, raw)
        contact, on = None, None
        if solver is not None and np.isfinite(compensated).all():
            contact = self._follow(time, compensated, solver)
            on = None if contact is None else solver.on(contact)
        point = None if contact is None else contact.point
        if self._contacts and self._contacts[-1][0] == time:  # looked for anew: another calibration or probe
            self._contacts.pop()
        self._contacts.append((time, np.full(3, np.nan) if point is None else point))
        return LiveReading(time, raw + taken, compensated, R_WS, contact, on)

    def _follow(self, time: float, compensated: Array, solver: ContactSolver) -> Contact | None:
        """Return the contact, followed as long as the press lasts: so a second touch that joins it is told apart."""
        step = time - self._looked
        if not 0 <= step <= _FORGET_S:
            solver.reset()
        self._looked = time
        found = solver.track(compensated, 0.0, step)
        if found.reason in _NO_TOUCH:
            solver.reset()  # the next press may be anywhere
            return None
        return found


@dataclass(frozen=True, eq=False)
class LiveBlock:
    """Samples that came together, each with the orientation that the sensor had; n of them."""

    times: Array  # (n,); s, on the samples' clock
    wrenches: Array  # (n, 6); Raw, S, N and N·m
    # (n, 3, 3); NaN where no pose is known, or the reading is not to be used: the sensor hangs or flags it,
    # or its time is a guess
    R_WS: Array
    saturated: NDArray[np.bool_]  # (n,) bool

    @property
    def whole(self) -> NDArray[np.bool_]:
        """(n,): the wrench is a reading, not saturated."""
        good: NDArray[np.bool_] = np.isfinite(self.wrenches).all(axis=1) & ~self.saturated
        return good

    @property
    def known(self) -> NDArray[np.bool_]:
        """(n,): it is whole, and the orientation is known."""
        good: NDArray[np.bool_] = self.whole & np.isfinite(self.R_WS).all(axis=(1, 2))
        return good


@dataclass(frozen=True)
class Tap:
    """Who gets all that the devices give, as they give it, in the streams' threads."""

    wrenches: Callable[[Sequence[WrenchSample]], None]  # wrenches, flanges: Get samples, oldest first
    flanges: Callable[[Sequence[FlangeSample]], None]
    health: Callable[[str, Health], None]  # Gets "sensor" or "robot", and the health that changed
    closed: Callable[[], None] = lambda: None  # Called when the devices are closed: nothing more comes


class Live:
    """
    The devices of a bench, open or not.

    Samples come in the streams' threads: `follow` hands them on there, `reading` and `history` may be asked for
    in any thread, at any rate.

    Attributes
    ----------
    pair : Pair or None
        What is open.
    model : GravityModel or None
        What wrenches are compensated with; see `set_model`.
    solver : ContactSolver or None
        What finds contacts; None: nothing does.
    addresses : (str, str or None) or None
        Of the sensor and the source of poses, as they were given.
    R_ES : (3, 3)
        How the sensor is mounted on the flange.
    run : Run or None
        The runtime that sends contacts of what is open; None: none are sent.
    ring : Ring
        The samples that came last.
    on_error : list of callable
        Get what a follower raised, in the thread in which it did; the stream goes on.
    """

    def __init__(self) -> None:
        self.pair: Pair | None = None
        self.model: GravityModel | None = None
        self.solver: ContactSolver | None = None
        self.addresses: tuple[str, str | None] | None = None
        self.run: Run | None = None
        self.R_ES: Array = np.eye(3)
        self.on_error: list[Callable[[Exception], None]] = []
        self.ring = Ring(_KEPT)
        self._track, self._moment = PoseTrack(np.eye(3)), LiveMoment(_USUAL_HZ)
        self._detector = FrozenDetector()
        self._zero: FollowedZero | None = None
        self._waiting: list[WrenchSample] = []
        self._followers: list[Callable[[LiveBlock], None]] = []
        self._taps: list[Tap] = []
        self._changing = threading.Lock()  # the calibration
        self._lock = threading.RLock()  # of what waits and who gets it: samples keep their order
        self._opening = threading.Lock()

    # ---- open and closed ---------------------------------------------------------------------------

    def open(self, sensor: str, poses: str | None, R_ES: Array | None = None) -> None:
        """
        Open devices, and close those that were open; waits, so call it in a worker.

        Parameters
        ----------
        sensor, poses : str
            Addresses; None: the orientation is not known.
        R_ES : (3, 3), optional
            How the sensor is mounted on the flange; left out, as the flange.

        Raises
        ------
        InputError
            An address does not do; then nothing is open. A device that is not there is no error: it is waited for,
            and `health` says so.
        """
        for address in (sensor, poses):
            if address is not None:
                DeviceAddress.parse(address)  # a mistyped address closes nothing
        with self._opening:
            self._open(sensor, poses, np.eye(3) if R_ES is None else np.array(R_ES, dtype=np.float64))

    def ensure(self, sensor: str, poses: str | None, R_ES: Array | None = None) -> None:
        """Open devices as `open` does, unless just these are open already and have not ended."""
        mount = np.eye(3) if R_ES is None else np.array(R_ES, dtype=np.float64)
        with self._opening:
            same = self.addresses == (sensor, poses) and np.allclose(self.R_ES, mount)
            if self.pair is None or not same or self.pair.finished:
                self._open(sensor, poses, mount)

    def _open(self, sensor: str, poses: str | None, mount: Array) -> None:
        self._close()
        pair = open_pair(
            sensor,
            poses,
            self._take_wrenches,
            self._take_flanges,
            lambda health: self._tell("sensor", health),
            lambda health: self._tell("robot", health),
        )
        with self._lock:
            self._waiting.clear()
            self.ring.clear()
            self._detector = FrozenDetector()
            self._zero = self._zero and FollowedZero()
            self._track, self._moment = PoseTrack(mount), LiveMoment(_rate_of(pair))
            self.R_ES, self.addresses, self.pair = mount, (sensor, poses), pair
        try:
            pair.start()
        except BaseException:
            self._close()
            raise

    def close(self) -> None:
        """Close them; returns when nothing more comes."""
        with self._opening:
            self._close()

    def _close(self) -> None:
        pair, self.pair = self.pair, None
        if pair is None:
            return
        pair.stop()  # not under the lock that its threads take
        with self._lock:
            self._waiting.clear()
            taps, self._taps = self._taps, []
        for tap in taps:
            self._guarded(tap.closed)

    # ---- how they are ------------------------------------------------------------------------------

    @property
    def health(self) -> tuple[Health, Health | None] | None:
        """Of the sensor and of the source of poses; None: nothing is open."""
        pair = self.pair
        if pair is None:
            return None
        return pair.sensor.health, None if pair.poses is None else pair.poses.health

    @property
    def bench(self) -> VirtualBench | None:
        """The virtual bench; None: none is open."""
        return None if self.pair is None else self.pair.bench

    @property
    def opening(self) -> bool:
        """Whether devices are just being opened, or closed."""
        return self._opening.locked()

    @property
    def rate(self) -> float | None:
        """Measured rate of the sensor, Hz; None: it is not known."""
        pair = self.pair
        return None if pair is None else pair.sensor.health.rate

    @property
    def lost(self) -> int:
        """Samples of the sensor that are known to be lost since it was opened."""
        pair = self.pair
        return 0 if pair is None else pair.sensor.health.counters.lost

    # ---- who gets what comes -----------------------------------------------------------------------

    def follow(self, follower: Callable[[LiveBlock], None]) -> Callable[[], None]:
        """Have blocks given to `follower`, in the streams' thread; returns what ends that."""
        with self._lock:
            self._followers.append(follower)
        return lambda: self._drop(self._followers, follower)

    @property
    def taped(self) -> bool:
        """Whether what the devices give is being recorded."""
        return bool(self._taps)

    def tap(self, tap: Tap) -> Callable[[], None]:
        """Have all that the devices give handed to `tap`, until they are closed; returns what ends that before."""
        with self._lock:
            self._taps.append(tap)
            pair = self.pair
        if pair is not None:  # how they are now: only changes are told later
            tap.health("sensor", pair.sensor.health)
            if pair.poses is not None:
                tap.health("robot", pair.poses.health)
        return lambda: self._drop(self._taps, tap)

    def _drop(self, those: list[Any], one: object) -> None:
        with self._lock:
            if one in those:
                those.remove(one)

    # ---- what is known -----------------------------------------------------------------------------

    def set_model(self, model: GravityModel | None, *, follow: bool = False) -> None:
        """
        Compensate with another calibration from now on, and all that is in memory; None: with none.

        `follow`: the zero follows, as in a runtime.
        """
        zero, done = FollowedZero() if follow else None, 0
        with self._changing:
            while self.ring.count - done > _SLICE:
                done = self.ring.compensate(model, zero, done)
            with self._lock:
                while done < self.ring.count:
                    done = self.ring.compensate(model, zero, done)
                self.model, self._zero = model, zero

    @property
    def zero(self) -> Zero | None:
        """What is taken off as the zero follows: where contacts go out, of these; None: it does not follow."""
        if (run := self.run) is not None:
            return run.zero
        return None if self._zero is None else self._zero.at(self._moment.time)

    def reading(self) -> LiveReading | None:
        """Return the newest moment; None: no sample came yet."""
        return self._moment.reading(self.model, self.solver)

    def history(self, seconds: float) -> tuple[Array, Array, Array]:
        """Return times (n,), raw (n, 6) and compensated (n, 6) of the last seconds; every sample, not filtered."""
        return self.ring.last(seconds)

    def contacts(self, seconds: float) -> tuple[Array, Array]:
        """Return times (n,) and points (n, 3), S, m, of what `reading` found; NaN where nothing touched."""
        return self._moment.contacts(seconds)

    # ---- in the streams' threads -------------------------------------------------------------------

    def _take_wrenches(self, samples: Sequence[WrenchSample]) -> None:
        with self._lock:
            for tap in tuple(self._taps):
                self._guarded(tap.wrenches, samples)
            self._waiting.extend(samples)
            self._guarded(self._hand_on)

    def _take_flanges(self, samples: Sequence[FlangeSample]) -> None:
        with self._lock:
            for tap in tuple(self._taps):
                self._guarded(tap.flanges, samples)
            self._guarded(self._track.add, samples)
            self._guarded(self._hand_on)

    def _tell(self, device: str, health: Health) -> None:
        with self._lock:
            taps = tuple(self._taps)
        for tap in taps:
            self._guarded(tap.health, device, health)

    def _hand_on(self) -> None:
        """Hand on what need not wait for another pose."""
        waiting = self._waiting
        if not waiting:
            return
        count = len(waiting)
        pair = self.pair
        if pair is not None and pair.poses is not None:
            newest = waiting[-1].time
            # A sample waits for the pose after it, as a recording would have it; poses of 50 Hz are soon there. Where
            # they are late, or have stopped, it waits no longer than the last one is carried on.
            until = max(self._track.newest, newest - LONGEST_AHEAD_S)
            count = sum(sample.time <= until for sample in waiting)
        if count:
            self._waiting = waiting[count:]
            self._give(self._block(waiting[:count]))

    def _block(self, samples: Sequence[WrenchSample]) -> LiveBlock:
        times = np.array([sample.time for sample in samples], dtype=np.float64)
        wrenches = np.array([(*sample.force, *sample.torque) for sample in samples], dtype=np.float64)
        saturated = np.array([bool(sample.status & Status.OVERRANGE) for sample in samples])
        frozen = [self._detector.see((*sample.force, *sample.torque), FROZEN_CHANCE) for sample in samples]
        flagged = [bool(sample.status & ~(Status.LATE | Status.OVERRANGE)) for sample in samples]
        R_WS = self._track.at(times)
        R_WS[np.array(frozen) | np.array(flagged)] = np.nan
        return LiveBlock(times, wrenches, R_WS, saturated)

    def _give(self, block: LiveBlock) -> None:
        compensated, taken = _compensated(self.model, self._zero, block.R_WS, block.wrenches, block.times)
        self.ring.add(block.times, block.wrenches, compensated, block.R_WS)
        self._moment.add(block.times, block.wrenches, block.R_WS, taken)
        for follower in tuple(self._followers):
            self._guarded(follower, block)

    def _guarded(self, call: Callable[..., None], *given: object) -> None:
        try:
            call(*given)
        except Exception as error:  # noqa: BLE001 - whatever goes wrong with a block, the devices go on
            for listener in tuple(self.on_error):
                listener(error)


def _rate_of(pair: Pair) -> float:
    """Return the rate that the filter is made for, Hz: what the device was asked for, or recorded with."""
    known = None if pair.player is None else pair.player.devices.get("wrench")
    rate = pair.sensor.address.rate if known is None else known.rate
    return rate or _USUAL_HZ


# ---- contacts of the open devices to other programs, while the window is open --------------------


@dataclass(frozen=True)
class OutputState:
    """How one output is doing."""

    option: str  # of `OUTPUTS`
    published: int  # contacts
    lost: int
    error: str  # why it takes nothing, now or any more; empty: it does


class LiveOutputs:
    """
    The runtime on the devices that are open, with its outputs; any thread may call it.

    Parameters
    ----------
    live : Live
    """

    def __init__(self, live: Live) -> None:
        self._live, self._lock = live, threading.Lock()
        self._run: Run | None = None
        self._options: tuple[str, ...] = ()
        self._end: Callable[[], None] = _nothing

    @property
    def running(self) -> bool:
        """Whether contacts go out."""
        return self._run is not None

    def start(
        self,
        config: RuntimeConfig,
        addresses: Mapping[str, str],
        *,
        unverified: bool = False,
        remote: bool = False,
    ) -> None:
        """
        Begin to publish contacts; what was published before ends.

        Parameters
        ----------
        config : RuntimeConfig
        addresses : mapping
            Of outputs, by their names in `OUTPUTS`.
        unverified : bool
            Also with a bundle that is not verified.
        remote : bool
            Outputs may reach other machines.

        Raises
        ------
        InputError
            No sensor or no source of poses is open, the bundle or the sensor does not do, or an output cannot be
            opened.
        """
        self.stop()
        pair = self._live.pair
        if pair is None or pair.poses is None:
            raise InputError("Live outputs need a sensor and a source of poses: open them in step 1.")
        if not addresses:
            raise InputError("No output is chosen: choose one.")
        check_runnable(config, unverified=unverified)
        about = pair.about()
        check_sensor(config, about.devices[0].serial)
        targets = open_outputs(addresses, OutputContext(about, config.probe, remote))
        clock = pair.now if pair.player is None else None
        outlets = list(map(Outlet, targets.values()))
        run = Run(config, outlets, hold=hold_for(pair.poses.address), clock=clock)
        with self._lock:
            run.__enter__()  # its end is `stop`
            self._run, self._options = run, tuple(targets)
            self._live.run = run
        self._end = self._live.tap(Tap(run.wrenches, run.poses, lambda *_: None, self.stop))

    def stop(self) -> None:
        """End; an output that hangs is left after 2 s."""
        with self._lock:
            run, self._run = self._run, None
            self._live.run = None
            end, self._end = self._end, _nothing  # it holds the run, and with it the kernel
        end()
        if run is not None:
            run.__exit__(None, None, None)

    def look(self) -> tuple[OutputState, ...]:
        """Say that no sample comes, where that is so, and return how the outputs are doing; call it often."""
        run, pair = self._run, self._live.pair
        if run is None:
            return ()
        if pair is not None and pair.player is None and not pair.stepwise:
            run.heartbeat(pair.now())
        return tuple(
            OutputState(option, each.published, each.lost, each.trouble)
            for option, each in zip(self._options, run.outlets, strict=True)
        )


def _nothing() -> None:
    """Nothing is tapped."""
