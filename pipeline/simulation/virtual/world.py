"""The virtual bench in real time: whoever opens the same address is at the same bench, on the same clock."""

from __future__ import annotations

import threading
import time
import weakref
from contextlib import ExitStack
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from contactbench.pipeline.devices.sample import WrenchSample
from contactbench.pipeline.devices.stream import Health, Sample, SourceStream
from contactbench.pipeline.devices.url import STEPWISE, BenchOptions, DeviceAddress
from contactbench.pipeline.errors import InputError, arg, message

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from contactbench.pipeline.simulation.virtual.bench import VirtualBench
    from contactbench.pipeline.simulation.virtual.commands import Batch

CATCH_UP_S = 0.2
_SLICE_S = 0.01  # a command waits no longer than this much of a bench that is late
_LOOK_S = 0.002
_SLOW = message(
    "The simulation is running behind because this computer is too slow. Lower the rate, or close"
    " other programs."
)


class BenchError(InputError):
    """A virtual bench that failed: a mistake of the program, or of who got its samples."""


def failure(error: Exception) -> BenchError:
    """Return what to tell of a mistake."""
    return BenchError(f"the virtual bench failed ({arg(type(error).__name__)}: {arg(error)}): open it again.")


class Pacer:
    """
    Advances a bench as time passes.

    Parameters
    ----------
    bench : VirtualBench
        Nobody else may advance it.
    on_batch : callable
        Gets what came, and what to add to its times to have them on the host's monotonic clock, s.
    on_end : callable
        Called at the end, when it was not stopped: with None, or with the error; a BenchError where the program or
        `on_batch` made a mistake, which then also goes to `threading.excepthook`.

    Attributes
    ----------
    slipped : float
        How much time was let go because the computer was too slow, s.
    """

    def __init__(
        self,
        bench: VirtualBench,
        on_batch: Callable[[Batch, float], None],
        on_end: Callable[[InputError | None], None] = lambda _: None,
    ) -> None:
        self._bench, self._on_batch, self._on_end = bench, on_batch, on_end
        self.slipped = 0.0
        self.origin = time.monotonic() - bench.time
        self._stopping = threading.Event()
        self._thread = threading.Thread(target=self._run, name=message("virtual bench"), daemon=True)

    def start(self) -> None:
        """Begin: the bench's clock goes on from where it is."""
        self.origin = time.monotonic() - self._bench.time
        self._thread.start()

    def stop(self) -> None:
        """End it; returns when nothing more comes."""
        self._stopping.set()
        if self._thread.ident is not None and self._thread is not threading.current_thread():
            self._thread.join()

    def findings(self) -> tuple[str, ...]:
        """Return what is wrong, in sentences."""
        return (*self._bench.findings(), *((_SLOW,) if self.slipped else ()))

    def _run(self) -> None:
        try:
            while not self._stopping.is_set() and not self._bench.ended:
                self._on_batch(self._advance(), self.origin)
        except InputError as error:
            self._on_end(error)
            return
        except Exception as error:
            # Whoever waits for samples must hear of it; the thread's hook has the traceback.
            self._on_end(failure(error))
            raise
        if not self._stopping.is_set():
            self._on_end(None)

    def _advance(self) -> Batch:
        late = time.monotonic() - self.origin - self._bench.time
        if late < _LOOK_S:
            self._stopping.wait(_LOOK_S - late)
            late = time.monotonic() - self.origin - self._bench.time
        if late > CATCH_UP_S:
            self.origin += late - CATCH_UP_S
            self.slipped += late - CATCH_UP_S
        return self._bench.advance(min(late, _SLICE_S))


_worlds: weakref.WeakValueDictionary[str, World] = weakref.WeakValueDictionary()  # of who holds a stream
_opening = threading.Lock()


class World:
    """
    The source of any number of streams: one bench, and those who watch it.

    Raises
    ------
    InputError
        A name or a file in the address is wrong, or MuJoCo is missing.
    """

    def __init__(self, address: DeviceAddress) -> None:
        self.bench = bench_at(address)
        self.stepwise = address.speed == STEPWISE
        self.truth: Callable[[Batch], None] | None = None
        """Gets every batch, the truth with it, before the streams get their samples."""
        self._key = str(address)
        self._pacer = None if self.stepwise else Pacer(self.bench, self._give, self._end)
        self._lock = threading.Lock()
        self._streams: list[SourceStream[Any]] = []
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

    def stream(
        self,
        address: DeviceAddress,
        kind: type[Sample],
        on_samples: Callable[[Sequence[Sample]], None],
        on_change: Callable[[Health], None] | None = None,
    ) -> SourceStream[Sample]:
        """
        Return a stream of one kind of samples, not yet started.

        In real time it is on the host's monotonic clock; stepwise, on the bench's own.
        """
        rate = self.bench.rate if kind is WrenchSample else self.bench.pose_rate
        # A sensor without noise gives the same reading again and again, and is sound.
        judged = kind is not WrenchSample or bool(self.bench.sensor.settings.noise.all())
        return SourceStream(address, self, kind, on_samples, on_change, rate=rate, judged=judged)

    def join(self, stream: SourceStream[Any]) -> None:
        """Give samples to a stream from now on; the bench's clock runs from the first of its streams on."""
        with self._lock:
            late = self._over
            if not late:
                self._streams.append(stream)
            begins, self._began = not self._began, True
        if late:  # it may have failed before its second stream came
            stream.end(self._failed)
            return
        if begins and self._pacer is not None:
            self._pacer.start()

    def leave(self, stream: SourceStream[Any]) -> None:
        """Give a stream no more samples; without one the bench is gone."""
        with self._lock:
            self._streams = [other for other in self._streams if other is not stream]
            if self._streams or not self._began:
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
        """
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
            streams = tuple(self._streams)
        for stream in streams:
            stream.take(wrenches if stream.kind is WrenchSample else flanges, findings)

    def _end(self, error: InputError | None) -> None:
        with self._lock:
            self._over, self._failed = True, error
            streams = tuple(self._streams)
        self.bench.close()
        with ExitStack() as all_of_them:  # also when one that is told raises
            for stream in streams:
                all_of_them.callback(stream.end, error)


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
    from contactbench.pipeline.simulation.virtual.commands import read_script

    options = address.bench or BenchOptions()
    probe = options.probe if options.mesh is None else load_probe(options.mesh, units="auto")
    script = () if options.script is None else read_script(Path(options.script))
    rate = address.rate or 200.0
    return VirtualBench(
        probe,
        options.sensor,
        seed=options.seed,
        rate=rate,
        pose_rate=options.pose_rate,
        script=script,
        reality=options.reality,
    )
