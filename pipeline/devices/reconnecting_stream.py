"""A device kept streaming: opened, started, read, watched, and opened again when its line was lost."""

import threading
import time
from abc import abstractmethod
from collections.abc import Callable, Sequence
from contextlib import suppress
from dataclasses import replace
from typing import Self

from contactbench.pipeline.devices.clock import SampleClock
from contactbench.pipeline.devices.driver import Carrier, Driver
from contactbench.pipeline.devices.protocols import Command, Counters, ProtocolError
from contactbench.pipeline.devices.protocols.parser import ASSUMED_RATE_HZ, Parser, SensorDriver
from contactbench.pipeline.devices.protocols.registry import driver_for, driver_of
from contactbench.pipeline.devices.sample import FlangeSample, WrenchSample
from contactbench.pipeline.devices.stream import Health, OnChange, OnFlanges, Sample, Stream, StreamState
from contactbench.pipeline.devices.transport import Line, LineError, LineLost, TcpLine, UdpLine, line_to
from contactbench.pipeline.devices.url import DeviceAddress
from contactbench.pipeline.devices.watch import Watch
from contactbench.pipeline.errors import InputError, arg, message

READ_S = 0.02  # how long a read may wait: how soon a stop or a silence is noticed
_RETRY_S = (0.1, 0.2, 0.5, 1.0, 2.0)
# A device that was switched off and on says nothing until it is started again.
_START_AGAIN_S = 1.0
# A peer that vanished without a word leaves a TCP connection that looks well for minutes.
_DEAD_S = 3.0
# What printing on a closed terminal raises is the latter, which would end the thread without a word.
_FAILURES = (Exception, SystemExit)


class ReconnectingStream(Stream[Sample]):
    """
    One device's samples, in a thread of their own.

    Lost lines are opened again by themselves. What did not arrive is never made up: a gap stays a gap.
    What nobody foresaw, such as a callable that raises, ends the stream: it is then lost for good, and
    `failure` is the reason.

    Parameters
    ----------
    address, watch, on_samples, on_change
        As for `Stream`.
    line : Line
    """

    def __init__(
        self,
        address: DeviceAddress,
        line: Line,
        watch: Watch,
        on_samples: Callable[[Sequence[Sample]], None],
        on_change: Callable[[Health], None] | None = None,
    ) -> None:
        super().__init__(address, watch, on_samples, on_change)
        self._line = line
        self._why, self._reconnected = "", 0
        self._failure: BaseException | None = None
        self._tries = 0  # to open the line, since the last sample
        self._last = self._heard = self._reviewed = 0.0
        self._received = 0
        self._stopping = threading.Event()
        self._thread: threading.Thread | None = None

    def start(self) -> Self:
        """Begin; the line is opened in the background. A stream is started once."""
        self._thread = threading.Thread(target=self._run, name=str(self.address), daemon=True)
        self._thread.start()
        return self

    def stop(self) -> None:
        """Stop the device and close the line; returns when that is done."""
        self._stopping.set()
        if isinstance(self._line, TcpLine):
            self._line.interrupt()
        if self._thread is not None:
            self._thread.join()

    @property
    def health(self) -> Health:
        """How the stream is now."""
        with self._watching:
            state = self._state
            # The thread may be held up, such as by a line that takes nothing: no one is told of samples that are not.
            if (
                state is StreamState.STREAMING
                and time.monotonic() - self._last > self._watch.patience + 2 * READ_S
            ):
                state, self._why = StreamState.SILENT, self._silence(time.monotonic())
            return self._health(state)

    @property
    def failure(self) -> BaseException | None:
        """What ended the stream for good; None: it goes on, or was stopped."""
        return self._failure

    # ---- what each kind of device does ---------------------------------------------------------

    @abstractmethod
    def _begin(self) -> None:
        """Make the device stream; the line is open."""

    @abstractmethod
    def _feed(self, data: bytes, arrived: float) -> list[Sample]:
        """Turn bytes into samples, oldest first."""

    @abstractmethod
    def _end(self) -> None:
        """Make the device stop; the line is open or lost."""

    def _idle(self, now: float) -> float:  # noqa: ARG002 - for those that ask
        """Do what is due between reads, such as asking again; return how long a read may wait, s."""
        return READ_S

    def _reset(self) -> None:
        """Forget what was half received; the line was lost."""

    def _counters(self) -> Counters:
        return Counters()

    def _troubles(self) -> dict[str, str]:
        """Return what the device itself says is wrong, by kind."""
        return {}

    # ---- the thread ----------------------------------------------------------------------------

    def _health(self, state: StreamState) -> Health:
        return replace(
            super()._health(state),
            counters=self._counters(),
            reconnected=self._reconnected,
            lateness=self._watch.lateness(),
            failure=None if self._failure is None else self._why,
        )

    def _findings(self, state: StreamState) -> dict[str, str]:
        if state is StreamState.LOST:
            return {self._why: self._why}
        troubles = self._troubles()
        if isinstance(self._line, UdpLine):
            troubles = troubles | self._line.troubles()
        if state is StreamState.SILENT:
            return {"silent": self._why} | self._watch.damage() | troubles
        if state is StreamState.CONNECTING:
            return troubles
        if state is not StreamState.STREAMING:
            return {}
        found = self._watch.findings()
        if "overrun" in troubles:  # which looks like a loss of the device, and like a leap of its clock
            found = {kind: what for kind, what in found.items() if kind not in ("lost", "leap", "rate")}
        return found | troubles

    def _run(self) -> None:
        try:
            self._keep_on()
        except _FAILURES as error:  # whatever it is, the device is stopped and somebody told
            self._fail(error)
        self._finish()

    def _keep_on(self) -> None:
        while not self._stopping.is_set():
            self._change(StreamState.CONNECTING if self._tries == 0 else StreamState.LOST)
            try:
                self._line.open()
                self._heard = time.monotonic()
                self._begin()
                self._read()
            except (LineError, ProtocolError) as error:
                self._lose(error)
                self._stopping.wait(_RETRY_S[min(self._tries, len(_RETRY_S) - 1)])
                self._tries += 1

    def _fail(self, error: BaseException) -> None:
        why = (
            str(error)
            if isinstance(error, InputError)
            else message(f"{arg(self.address)}: the stream failed: {arg(error)!r}.")
        )
        with self._watching:
            self._failure, self._why = error, why
        self._stopping.set()

    def _lose(self, error: LineError | ProtocolError) -> None:
        self._why = str(error)
        self._change(StreamState.LOST)
        self._tell()  # another reason is news
        with self._watching:
            self._reset()
            self._watch.forget()
        self._line.close()

    def _read(self) -> None:
        self._last = begun_again = time.monotonic()
        while not self._stopping.is_set():
            chunk = self._line.read(self._idle(time.monotonic()))
            if self._take(chunk.data, chunk.time):
                self._change(StreamState.STREAMING)
            elif chunk.time - self._last > self._watch.patience:
                self._be_silent(chunk.time)
                if chunk.time - max(self._last, begun_again) > _START_AGAIN_S:
                    self._begin()
                    begun_again = time.monotonic()
            if self.address.carrier is Carrier.TCP and chunk.time - self._heard > _DEAD_S:
                raise LineLost(
                    f"{arg(self._line.name)}: nothing received for {arg(_DEAD_S):g} s: check cable and"
                    " device. Reconnecting."
                )
            self._review(chunk.time)

    def _be_silent(self, now: float) -> None:
        with self._watching:
            self._why = self._silence(now)
            self._watch.rest()
        self._change(StreamState.SILENT)

    def _silence(self, now: float) -> str:
        return message(
            f"{arg(self.address)}: no sample for {arg(now - self._last):.1f} s: check that the device has"
            " power and that no other program uses its line."
        )

    def _take(self, data: bytes, arrived: float) -> bool:
        """Give on the samples that end in these bytes; tells whether there were any."""
        if not data:
            return False
        self._heard = arrived
        samples = self._feed(data, arrived)
        with self._watching:
            self._received += len(data)
            if samples:
                # Only now: a device may take connections and give nothing.
                self._reconnected += self._tries > 0 and self._watch.samples > 0
                self._tries = 0
                self._last = arrived
                self._watch.see(samples)
            if not self._watch.settled:  # else `_review` does: a hundred times a second is enough
                self._watch.count(arrived, self._counters(), self._received)
        if samples:
            self._on_samples(samples)
        return bool(samples)

    def _change(self, state: StreamState) -> None:
        if state is not self._state:
            self._state = state
            self._tell()

    def _review(self, now: float) -> None:
        """See what is wrong, also when nothing arrives; not for each of a thousand samples a second."""
        if now - self._reviewed >= READ_S / 2:
            self._reviewed = now
            with self._watching:
                self._watch.count(now, self._counters(), self._received)
            self._tell()

    def _finish(self) -> None:
        try:
            with suppress(LineError):  # it is gone, and with it the stream
                self._end()
            self._line.close()
            self._change(StreamState.CLOSED if self._failure is None else StreamState.LOST)
            self._tell()  # why it failed is news to those who know that it is lost
        except _FAILURES as error:  # a listener that fails may do so again
            self._fail(error)
            self._state = StreamState.LOST
            self._line.close()


# ---- A robot kept telling where its flange is. It is asked, and never moved ----------------------


class ParsedPoses(ReconnectingStream[FlangeSample]):
    """
    A robot that sends its flange by itself, once it was told to.

    Parameters
    ----------
    address : DeviceAddress
    parser : Parser
        Of its poses.
    on_samples, on_change
        As for `ReconnectingStream`.
    start, stop : bytes
        What to send first and last; empty: nothing.
    guess : float
        Poses per second until they have come, where the address gives no rate.
    """

    def __init__(
        self,
        address: DeviceAddress,
        parser: Parser[FlangeSample],
        on_samples: OnFlanges,
        on_change: OnChange = None,
        *,
        start: bytes = b"",
        stop: bytes = b"",
        guess: float = ASSUMED_RATE_HZ,
        line: Line | None = None,
    ) -> None:
        self._parser, self._start, self._stop = parser, start, stop
        self._clock = SampleClock(address.rate)
        watch = Watch(address.rate or guess, rate_known=address.rate is not None)
        super().__init__(address, line or line_to(address), watch, on_samples, on_change)

    def _begin(self) -> None:
        self._parser.begin()
        if self._start:
            self._line.write(self._start)

    def _feed(self, data: bytes, arrived: float) -> list[FlangeSample]:
        return self._clock.stamp(self._parser.feed(data, arrived))

    def _end(self) -> None:
        if self._stop:
            self._line.write(self._stop)

    def _reset(self) -> None:
        self._parser.reset()
        self._clock.forget()

    def _counters(self) -> Counters:
        return self._parser.counters

    def _troubles(self) -> dict[str, str]:
        return self._parser.troubles()


def poses_from(
    address: DeviceAddress | str, on_samples: OnFlanges, on_change: OnChange = None
) -> ReconnectingStream[FlangeSample]:
    """
    Return the stream of the robot at an address, not yet started.

    Raises
    ------
    AddressError
        It is no robot.
    """
    where = DeviceAddress.parse(address) if isinstance(address, str) else address
    return (driver_of(where.protocol) or Driver()).poses(where, on_samples, on_change)


# ---- A force/torque sensor kept streaming --------------------------------------------------------


_REPLY_S = 1.0
_REPLY_BYTES = 4096


class SensorStream(ReconnectingStream[WrenchSample]):
    """
    One sensor's samples; see `ReconnectingStream`.

    Parameters
    ----------
    address : DeviceAddress or str
    on_samples, on_change
        As for `ReconnectingStream`.
    line, driver : optional
        Instead of the address's own, such as a line of a test.

    Raises
    ------
    AddressError, ProtocolError
        It is no sensor's address, or the rate does not fit.
    """

    def __init__(
        self,
        address: DeviceAddress | str,
        on_samples: Callable[[Sequence[WrenchSample]], None],
        on_change: Callable[[Health], None] | None = None,
        *,
        line: Line | None = None,
        driver: SensorDriver | None = None,
    ) -> None:
        where = DeviceAddress.parse(address) if isinstance(address, str) else address
        self._driver = driver or driver_for(where)
        watch = Watch(self._driver.rate, rate_known=self._driver.rate_known, limits=self._driver.limits)
        self._clock = SampleClock(self._driver.rate if self._driver.rate_known else None)
        self._unprepared = ""
        self._unaccepted: dict[str, str] = {}
        super().__init__(where, line or line_to(where), watch, on_samples, on_change)

    def _begin(self) -> None:
        # Once samples were given, those that follow must mean the same.
        if self._driver.prepare is not None and not self._watch.samples:
            self._unprepared = self._driver.prepare()
        self._unaccepted = {}
        for command in self._driver.start:
            self._send(command)

    def _send(self, command: Command) -> None:
        """Send a command and wait for its answer; samples that come in between are given on."""
        self._line.write(command.data)
        if command.settle:
            self._settle(command.settle)
        heard, agreed = b"", command.answered(b"")
        deadline = time.monotonic() + _REPLY_S
        while agreed is None and time.monotonic() < deadline and not self._stopping.is_set():
            chunk = self._line.read(READ_S)
            heard = (heard + chunk.data)[-_REPLY_BYTES:]
            agreed = command.answered(heard)
            self._take(chunk.data, chunk.time)
        if agreed or self._stopping.is_set():
            return
        if command.instead is not None:
            self._send(command.instead)
        elif heard:  # a device that says nothing at all is silent: that is told anyway
            self._refused(command, message("refused it") if agreed is False else message("did not answer"))

    def _settle(self, seconds: float) -> None:
        """Let pass what a stream before this one left on the line."""
        deadline = time.monotonic() + seconds
        while (left := deadline - time.monotonic()) > 0 and not self._stopping.is_set():
            chunk = self._line.read(min(left, READ_S))
            if chunk.data:
                self._heard = chunk.time
        with self._watching:
            self._driver.parser.reset()

    def _refused(self, command: Command, what: str) -> None:
        shown = command.data.decode("ascii", "backslashreplace").strip()
        with self._watching:
            self._unaccepted[shown] = message(
                f"The device did not accept {arg(shown[:60])!r} (it {arg(what)}): its rate or units may"
                " differ. Check that its firmware is supported."
            )

    def _feed(self, data: bytes, arrived: float) -> list[WrenchSample]:
        return self._clock.stamp(self._driver.parser.feed(data, arrived))

    def _end(self) -> None:
        for command in self._driver.stop:
            self._line.write(command.data)

    def _reset(self) -> None:
        self._driver.parser.reset()
        self._clock.forget()

    def _troubles(self) -> dict[str, str]:
        found = dict(self._unaccepted)
        if self._unprepared:
            found["unprepared"] = self._unprepared
        return found | (self._driver.troubles() if self._driver.troubles is not None else {})

    def _counters(self) -> Counters:
        return self._driver.parser.counters
