"""Samples from a device, a recording, a file or a virtual bench, and how they are: what an operator is told."""

from __future__ import annotations

import threading
from abc import ABC, abstractmethod
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from enum import StrEnum
from types import TracebackType
from typing import Any, Generic, Protocol, Self, TypeVar

from contactbench.pipeline.devices.protocols import Counters
from contactbench.pipeline.devices.sample import FlangeSample, WrenchSample
from contactbench.pipeline.devices.url import DeviceAddress
from contactbench.pipeline.devices.watch import Watch
from contactbench.pipeline.errors import message

Sample = TypeVar("Sample", bound="WrenchSample | FlangeSample")

_GUESSED_HZ = 100.0


class StreamState(StrEnum):
    """Where a stream is."""

    CLOSED = "closed"
    CONNECTING = "connecting"
    STREAMING = "streaming"
    SILENT = "silent"
    LOST = "lost"


@dataclass(frozen=True)
class Health:
    """A stream at one moment."""

    state: StreamState
    findings: tuple[str, ...]  # what is wrong, in sentences; empty when nothing is
    samples: int  # given since the stream was opened
    rate: float | None  # measured over the last samples, Hz
    # how unevenly they arrive: the 95th percentile of how far an interval is from the median one, s
    jitter: float | None
    counters: Counters  # of the parser
    reconnected: int  # times samples came again after the line was lost
    # what may have happened, such as a re-zero, in sentences; they stay until `acknowledge`
    suspicions: tuple[str, ...] = ()
    # how much later than they should samples came after the one before, s: of the last ones, and of all
    # since the last gap
    lateness: tuple[float, float] | None = None
    failure: str | None = None  # why the stream ended for good; None: it goes on, or was stopped

    @property
    def well(self) -> bool:
        """Whether samples come, and nothing is wrong with them or suspected to be."""
        return self.state is StreamState.STREAMING and not self.findings and not self.suspicions


OnFlanges = Callable[[Sequence[FlangeSample]], None]
OnChange = Callable[[Health], None] | None


class Stream(ABC, Generic[Sample]):
    """
    Samples from a device, a recording or a file.

    It is started once and stopped once; as a context manager it is both.

    Parameters
    ----------
    address : DeviceAddress
        What was opened.
    watch : Watch
        Looks at the samples.
    on_samples : callable
        Gets every batch of samples, oldest first, in the stream's thread; it must be quick and not raise.
    on_change : callable, optional
        Told when the state changed, or a finding or suspicion came or went, in the same thread. A number
        within a finding that goes on is no change: `health` has the latest.

    Attributes
    ----------
    done : threading.Event
        Set when the source is at its end: nothing more will come. Devices have none.
    """

    def __init__(
        self,
        address: DeviceAddress,
        watch: Watch,
        on_samples: Callable[[Sequence[Sample]], None],
        on_change: Callable[[Health], None] | None = None,
    ) -> None:
        self.address = address
        self.done = threading.Event()
        self._on_samples: Callable[[Sequence[Sample]], None] = on_samples
        self._on_change = on_change
        self._watch = watch
        self._watching = threading.Lock()
        self._state = StreamState.CLOSED
        self._told: tuple[StreamState, tuple[str, ...]] = (StreamState.CLOSED, ())

    @abstractmethod
    def start(self) -> Self:
        """Begin."""

    @abstractmethod
    def stop(self) -> None:
        """End it; returns when no more samples come."""

    @abstractmethod
    def _findings(self, state: StreamState) -> dict[str, str]:
        """Return what is wrong, by kind; two of one kind are no news."""

    def __enter__(self) -> Self:
        return self.start()

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.stop()

    @property
    def health(self) -> Health:
        """How the stream is now."""
        with self._watching:
            return self._health(self._state)

    def acknowledge(self) -> None:
        """Drop the suspicions in its health: somebody has read them. `on_change` tells that they are gone."""
        with self._watching:
            self._watch.acknowledge()

    def _health(self, state: StreamState) -> Health:
        watch, findings = self._watch, tuple(self._findings(state).values())
        return Health(
            state, findings, watch.samples, watch.rate(), watch.jitter(), Counters(), 0, watch.suspicions
        )

    def _tell(self) -> None:
        with self._watching:
            now = (self._state, (*self._findings(self._state), *self._watch.suspicions))
            if now == self._told:
                return
            self._told = now
            health = self._health(self._state)  # of this very state: what is told next is judged against it
        if self._on_change is not None:
            self._on_change(health)


class Source(Protocol):
    """What is behind one or more streams that share its clock: a recording, a track of poses, a virtual bench."""

    stepwise: bool
    """Whether samples come only when `step` asks for them."""

    @property
    def time(self) -> float:
        """The present time on the samples' clock, s."""

    def join(self, stream: SourceStream[Any]) -> None:
        """Give samples to a stream that was started."""

    def leave(self, stream: SourceStream[Any]) -> None:
        """Give it no more; without a stream the source is closed."""

    def step(self, count: int) -> int:
        """Give the next samples, of all streams; returns how many of `count` there were."""


class SourceStream(Stream[Sample]):
    """
    The wrenches or the poses of a source that has no line and no bytes, but an end.

    Parameters
    ----------
    address, on_samples, on_change
        As for `Stream`; the thread is the source's or, stepwise, that of `step`.
    source : Source
    kind : type
        WrenchSample or FlangeSample.
    rate : float or None
        That the samples should have, Hz; None: what comes first is right.
    judged : bool
        False: nothing is found about the samples, such as poses of which nobody promised a rate.
    """

    def __init__(
        self,
        address: DeviceAddress,
        source: Source,
        kind: type[Sample],
        on_samples: Callable[[Sequence[Sample]], None],
        on_change: Callable[[Health], None] | None = None,
        *,
        rate: float | None = None,
        judged: bool = True,
    ) -> None:
        watch = Watch(rate or _GUESSED_HZ, rate_known=rate is not None, judged=judged)
        super().__init__(address, watch, on_samples, on_change)
        self.source = source
        self.kind: type[Sample] = kind
        self._found: tuple[str, ...] = ()
        self._stopped = False
        self._giving = threading.RLock()  # one that lets who gets the samples stop the stream

    def start(self) -> Self:
        """Begin."""
        self.source.join(self)
        return self

    def stop(self) -> None:
        """End it; the source ends with the last of its streams."""
        with self._giving:
            self._stopped = True
        self.source.leave(self)
        if not self.done.is_set():
            self._become(StreamState.CLOSED)

    def step(self, count: int = 1) -> int:
        """
        Give the next samples, of all streams of the source; returns how many of `count` there were.

        Raises
        ------
        RuntimeError
            It does not go by steps.
        """
        if not self.source.stepwise:
            raise RuntimeError(
                message("only a replay or a virtual bench can be stepped: open it with ?speed=step")
            )
        return self.source.step(count)

    def take(self, samples: Sequence[Sample], findings: tuple[str, ...] = ()) -> None:
        """Give samples on, with what the source found; the source calls it."""
        with self._giving:
            if samples and not self._stopped:
                self._on_samples(samples)
            if samples and not self._stopped:
                with self._watching:
                    self._watch.see(samples)
                self._become(StreamState.STREAMING, findings)

    def end(self, error: Exception | None = None, findings: tuple[str, ...] = ()) -> None:
        """Be at the end, by an error or with what was wrong on the way; the source calls it."""
        try:
            if not self._stopped:  # else it has said that it is closed
                self._become(
                    StreamState.CLOSED if error is None else StreamState.LOST,
                    findings if error is None else (str(error),),
                )
        finally:
            self.done.set()

    def _become(self, state: StreamState, findings: tuple[str, ...] = ()) -> None:
        with self._watching:
            self._state, self._found = state, findings
        self._tell()

    def _findings(self, state: StreamState) -> dict[str, str]:
        seen = self._watch.findings() if state is StreamState.STREAMING else {}
        return seen | dict(zip(self._found, self._found, strict=True))
