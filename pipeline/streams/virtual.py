"""The virtual bench as streams: whoever opens the same address is at the same bench, on the same clock."""

from __future__ import annotations

import threading
import time
import weakref
from contextlib import ExitStack
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Generic, TypeVar, cast

from contactbench.pipeline.devices.drive import State
from contactbench.pipeline.devices.sample import FlangeSample, WrenchSample
from contactbench.pipeline.devices.url import STEPWISE, BenchOptions
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.streams.source import Ending, Pulse

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence
    from types import TracebackType
    from typing import Self

    from contactbench.pipeline.devices.drive import Health
    from contactbench.pipeline.devices.url import DeviceAddress
    from contactbench.pipeline.simulation.virtual.bench import VirtualBench
    from contactbench.pipeline.simulation.virtual.given import Batch

Sample = TypeVar("Sample", WrenchSample, FlangeSample)

_worlds: weakref.WeakValueDictionary[str, World] = weakref.WeakValueDictionary()  # of who holds a stream
_opening = threading.Lock()


class VirtualStream(Ending, Generic[Sample]):
    """
    The wrenches or the poses of a virtual bench.

    In real time they are on the host's monotonic clock; stepwise, on the bench's own.

    Parameters
    ----------
    address : DeviceAddress
    world : World
    kind : type
        WrenchSample or FlangeSample.
    on_samples : callable
        Gets samples, oldest first; in the bench's thread or, stepwise, in that of `step`.
    on_change : callable, optional
        Gets the health when its state or findings change.
    """

    def __init__(
        self,
        address: DeviceAddress,
        world: World,
        kind: type[Sample],
        on_samples: Callable[[Sequence[Sample]], None],
        on_change: Callable[[Health], None] | None = None,
    ) -> None:
        bench = world.bench
        rate = bench.rate if kind is WrenchSample else bench.pose_rate
        # A sensor without noise gives the same reading again and again, and is sound.
        judged = kind is not WrenchSample or bool(bench.sensor.settings.noise.all())
        super().__init__(address, Pulse(on_change, rate, judged=judged))
        self.world = world
        self.kind: type[WrenchSample | FlangeSample] = kind
        self._on_samples: Callable[[Sequence[Sample]], None] = on_samples
        self._stopped = False
        self._giving = threading.RLock()  # one that lets who gets the samples stop the stream

    @property
    def bench(self) -> VirtualBench:
        """What is behind it, to be told what to do."""
        return self.world.bench

    @property
    def stepwise(self) -> bool:
        """Whether samples come only when `step` asks for them."""
        return self.world.stepwise

    def start(self) -> Self:
        """Begin; the bench's clock runs from the first of its streams on."""
        self.world.join(self)
        return self

    def stop(self) -> None:
        """End it; with the last stream that is stopped the bench is gone."""
        with self._giving:
            self._stopped = True
        self.world.leave(self)
        if not self.done.is_set():
            self._pulse.become(State.CLOSED)

    def step(self, count: int = 1) -> int:
        """Give the next samples, of all streams of the bench; returns how many of `count` there were."""
        return self.world.step(count)

    def __enter__(self) -> Self:
        return self.start()

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.stop()

    # ---- what the world calls ------------------------------------------------------------------

    def take(self, samples: Sequence[Sample], findings: tuple[str, ...]) -> None:
        """Give samples on."""
        with self._giving:
            if samples and not self._stopped:
                self._on_samples(samples)
            if samples and not self._stopped:
                self._pulse.beat(samples, findings)

    def end(self, error: InputError | None) -> None:
        """Be at the end."""
        try:
            if not self._stopped:
                if error is None:
                    self._pulse.become(State.CLOSED)
                else:
                    self._pulse.become(State.LOST, (str(error),))
        finally:
            self.done.set()


class World:
    """
    One bench and those who watch it.

    Parameters
    ----------
    address : DeviceAddress

    Raises
    ------
    InputError
        A name or a file in the address is wrong, or MuJoCo is missing.
    """

    def __init__(self, address: DeviceAddress) -> None:
        from contactbench.pipeline.simulation.virtual.pace import Pacer  # physics is slow to import

        self.bench = bench_at(address)
        self.stepwise = address.speed == STEPWISE
        self.truth: Callable[[Batch], None] | None = None
        """Gets every batch, the truth with it, before the streams get their samples."""
        self._key = str(address)
        self._pacer = None if self.stepwise else Pacer(self.bench, self._give, self._end)
        self._lock = threading.Lock()
        self._views: list[VirtualStream[WrenchSample] | VirtualStream[FlangeSample]] = []
        self._began = self._over = False
        self._failed: InputError | None = None

    @property
    def time(self) -> float:
        """The present time on the samples' clock, s."""
        return self.bench.time if self.stepwise else time.monotonic()

    @property
    def over(self) -> bool:
        """Whether it is at its end, and whoever comes wants another."""
        return self._over

    def join(self, view: VirtualStream[WrenchSample] | VirtualStream[FlangeSample]) -> None:
        """Give samples to a stream from now on."""
        with self._lock:
            late = self._over
            if not late:
                self._views.append(view)
            begins, self._began = not self._began, True
        if late:  # it may have failed before its second stream came
            view.end(self._failed)
            return
        if begins and self._pacer is not None:
            self._pacer.start()

    def leave(self, view: object) -> None:
        """Give a stream no more samples; without one the bench is gone."""
        with self._lock:
            self._views = [other for other in self._views if other is not view]
            if self._views or not self._began:
                return
            self._over = True
        with _opening:
            if _worlds.get(self._key) is self:
                del _worlds[self._key]
        if self._pacer is not None:
            self._pacer.stop()
        self.bench.close()

    def step(self, count: int) -> int:
        """
        Give the next samples; returns how many there were.

        Whatever who gets them raises is raised here, and the bench is at its end.

        Raises
        ------
        RuntimeError
            The bench goes in real time.
        """
        if not self.stepwise:
            raise RuntimeError("this virtual bench goes in real time: open it with ?speed=step")
        from contactbench.pipeline.simulation.virtual.pace import failure

        given = 0
        while given < count and not self._over:
            try:
                batch = self.bench.advance_samples(1)
            except InputError as error:
                self._end(error)
                break
            except Exception as error:
                self._end(failure(error))
                raise
            try:
                self._give(batch, 0.0)
            except Exception as error:
                self._end(failure(error))
                raise
            given += len(batch.wrenches) + len(batch.flanges)
            if self.bench.ended:
                self._end(None)
        return given

    def _give(self, batch: Batch, origin: float) -> None:
        if self.truth is not None:
            self.truth(batch)
        findings = self.bench.findings() if self._pacer is None else self._pacer.findings()
        wrenches = [replace(sample, time=origin + sample.time) for sample in batch.wrenches]
        flanges = [replace(sample, time=origin + sample.time) for sample in batch.flanges]
        with self._lock:
            views = tuple(self._views)
        for view in views:
            if view.kind is WrenchSample:
                cast("VirtualStream[WrenchSample]", view).take(wrenches, findings)
            else:
                cast("VirtualStream[FlangeSample]", view).take(flanges, findings)

    def _end(self, error: InputError | None) -> None:
        with self._lock:
            self._over, self._failed = True, error
            views = tuple(self._views)
        self.bench.close()
        with ExitStack() as all_of_them:  # also when one that is told raises
            for view in views:
                all_of_them.callback(view.end, error)


def world_at(address: DeviceAddress) -> World:
    """
    Return the world of an address: the one that is there as long as somebody has a stream of it, or a new one.

    Raises
    ------
    InputError
        As `bench_at`.
    """
    key = str(address)
    with _opening:
        world = _worlds.get(key)
        if world is None or world.over:
            world = _worlds[key] = World(address)
        return world


def bench_at(address: DeviceAddress) -> VirtualBench:
    """
    Return a new bench as an address says.

    Raises
    ------
    InputError
        A name or a file in it is wrong, or MuJoCo is missing.
    """
    from contactbench.pipeline.mesh import load_probe
    from contactbench.pipeline.simulation.virtual.bench import VirtualBench
    from contactbench.pipeline.simulation.virtual.script import read_script

    options = address.bench or BenchOptions()
    probe = options.probe if options.mesh is None else load_probe(options.mesh, units="auto")
    script = () if options.script is None else read_script(Path(options.script))
    rate = address.rate or 200.0
    return VirtualBench(
        probe, options.sensor, seed=options.seed, rate=rate, pose_rate=options.pose_rate, script=script
    )
