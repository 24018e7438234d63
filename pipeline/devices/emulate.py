"""Wire-exact emulated devices on real lines, with scripted faults, in threads of their own."""

from __future__ import annotations

import math
import threading
import time
from collections import Counter, deque
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from types import TracebackType

from contactbench.pipeline.devices.device_line import DeviceLine, PtyLine, TcpServerLine, UdpServerLine
from contactbench.pipeline.devices.driver import Carrier, Driver
from contactbench.pipeline.devices.faults import (
    SYNTHETIC,
    Emission,
    EmulatorError,
    Fault,
    FaultEvent,
    FrameMoment,
    Mangler,
    Script,
    SensorReading,
    Signal,
    Truth,
    constant,
    sine,
)
from contactbench.pipeline.devices.protocols.device_model import Model, Quirk
from contactbench.pipeline.devices.protocols.registry import driver_of, drivers
from contactbench.pipeline.devices.url import options_query, read_options
from contactbench.pipeline.errors import InputError, arg

_IDLE_S = 0.05  # how long a stop may go unnoticed
_BETWEEN_PIECES_S = 0.0005  # without it the kernel joins them again
_AT_ONCE = 64  # frames between two looks at what the host says
_LATE_S = 1.0  # who is later than this has been suspended, or cannot keep up
LOG = 100_000
"""Frames that a log holds unless it is told otherwise."""


@dataclass(frozen=True, slots=True)
class Sent:
    """One frame as it went out, or did not."""

    count: int  # of all frames of this emulator, from 0
    time: float  # when it was due, seconds after the first frame of all
    sent_at: float  # when it was given to the line, seconds of the monotonic clock
    reading: SensorReading  # what is in it
    moment: FrameMoment  # its number, and the device's clock
    frame: bytes  # as it was before the line's faults
    intact: bool  # all of it went on the line, unchanged
    fault: Fault | None  # of the line, that acted on it


class Emulator:
    """A device that answers, streams, fails by script, and keeps a log of what it truly sent.

    Use it in a ``with`` statement, or call `start` and `close`.

    Parameters
    ----------
    model : Model
        What it is.
    line : DeviceLine
        Its end of the line; it is closed with the emulator.
    scheme : str
        Of the address, such as "sri+tcp".
    signal : callable
        What it measures; the synthetic wrench if none is given.
    script : Script
        Faults; none if none is given. Their times count from the first frame.
    seed : int
        Of chance in the faults.
    query : str
        Options of the address.
    log : int
        How many frames the log holds, the latest ones; 0 for an emulator that runs for days.

    Attributes
    ----------
    log : deque of Sent
    counts : Counter
        Of frames "intact" and "not intact", of "bytes" and "bytes nobody took", and of frames "skipped": those
        that were due while the emulator was suspended, or that this machine is too slow for.

    Raises
    ------
    EmulatorError
        The device cannot have one of the faults.
    """

    def __init__(
        self,
        model: Model,
        line: DeviceLine,
        scheme: str,
        *,
        signal: Signal | None = None,
        script: Script | None = None,
        seed: int = 0,
        query: str = "",
        log: int = LOG,
    ) -> None:
        script = script or Script()
        script.check(model.faults, model.name)
        self.model = model
        self.url = f"{scheme}://{line.where}{query}"
        self.log: deque[Sent] = deque(maxlen=log)
        self.counts: Counter[str] = Counter()
        self.failure: BaseException | None = None
        self._line = line
        self._truth = Truth(signal or constant(SYNTHETIC), script, model.trap, model.full_scale)
        self._mangler = Mangler(model, script, seed, datagrams=line.datagrams)
        self._origin: float | None = None
        self._due: float | None = None
        self._number = self._count = 0
        self._heard_at = -math.inf
        self._answered: tuple[SensorReading, FrameMoment] | None = None
        self._stop = threading.Event()
        self._thread = threading.Thread(target=self._run, name=f"emulated {model.name}", daemon=True)
        model.answer = self._answer

    def start(self) -> Emulator:
        """Start the thread."""
        self._thread.start()
        return self

    def close(self) -> None:
        """End the thread and the line.

        Raises
        ------
        EmulatorError
            The thread had failed.
        """
        self._stop.set()
        if self._thread.ident is not None:
            self._thread.join()
        self._line.close()
        if self.failure is not None:
            raise EmulatorError(
                f"emulated {arg(self.model.name)}: it failed: {arg(self.failure)!r}."
            ) from self.failure

    def __enter__(self) -> Emulator:
        return self.start()

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    @property
    def refused(self) -> list[bytes]:
        """What it was told and must not be told, the last 1000."""
        return list(self.model.refused)

    @property
    def commands(self) -> list[bytes]:
        """What it was told and obeyed, the last 1000."""
        return list(self.model.commands)

    def measure(self, signal: Signal) -> None:
        """Let it measure something else from now on; any thread may call this.

        Faults that hold on to a value of the past, stuck and rezero, take it from the new signal.
        """
        self._truth.signal = signal

    def intact(self) -> list[Sent]:
        """Return the frames of the log that went out whole and unchanged."""
        return [sent for sent in list(self.log) if sent.intact]

    # ---- the thread ----------------------------------------------------------------------------

    def _run(self) -> None:
        try:
            self._send(self.model.greeting())
            while not self._stop.is_set():
                self._step()
        except Exception as error:  # noqa: BLE001 - it is kept, and raised by close
            self.failure = error

    def _step(self) -> None:
        data = self._line.receive(self._patience())
        if self._line.fresh:
            self._line.fresh = False
            self._restart()
        if data:
            self._obey(data)
        if not self.model.streaming or self.model.asked_only:
            self._due = None
            return
        if self._due is None:
            self._due = self._now()
        for _ in range(_AT_ONCE):
            if self._due is None or self._due > self._now() or self._stop.is_set():
                return
            self._stream(self._caught_up(self._due))

    def _caught_up(self, due: float) -> float:
        """Skip what a device would have sent long ago; it goes on counting, as for a host that did not listen."""
        late = self._now() - due
        if late <= _LATE_S:
            return due
        missed = int(late * self.model.rate * self._truth.rate_factor(due))
        self._number += missed
        self.counts["skipped"] += missed
        return due + late

    def _patience(self) -> float:
        if self._due is None:
            return _IDLE_S
        return min(_IDLE_S, max(0.0, self._due - self._now()))

    def _now(self) -> float:
        now = time.monotonic()
        if self._origin is None:
            self._origin = now
        return now - self._origin

    def _obey(self, data: bytes) -> None:
        now = time.monotonic()
        silence, self._heard_at = now - self._heard_at, now
        if self.model.busy:
            time.sleep(self.model.busy)
        answers = self.model.feed(data, silence)
        if self.model.busy and not self._line.fresh:
            self.model.too_soon(self._line.receive(0.0))
        for answer in answers:
            if self._answered is None and self.model.asked_only:
                self._answer()  # its answers are all it sends: the faults of the line are for them
            if self._answered is None:
                self._send(answer)
            else:
                (reading, moment), self._answered = self._answered, None
                self._emit(self._now(), reading, moment, answer)

    def _answer(self) -> tuple[SensorReading, FrameMoment]:
        """Return what a frame that was asked for holds; the answer that follows is that frame."""
        now = self._now()
        self._answered = self._truth.reading(now), self._truth.moment(now, self._next())
        return self._answered

    def _stream(self, due: float) -> None:
        reading, moment = self._truth.reading(due), self._truth.moment(due, self._next())
        self._due = due + 1 / (self.model.rate * self._truth.rate_factor(due))
        frame = self.model.frame(reading, moment)
        if not self.model.streaming:
            self._due = None
        self._emit(due, reading, moment, frame)

    def _next(self) -> int:
        self._number += 1
        return self._number - 1

    def _emit(self, due: float, reading: SensorReading, moment: FrameMoment, frame: bytes) -> None:
        emission = self._mangler.mangle(frame, due, self._count)
        # Said before it is sent: whoever has received a frame finds it in the log.
        sent = Sent(
            self._count, due, time.monotonic(), reading, moment, frame, emission.intact, emission.fault
        )
        self.log.append(sent)
        self._count += 1
        taken = self._put(emission)
        if not taken and self.log:
            self.log[-1] = replace(sent, intact=False)
        self.counts["intact" if taken and emission.intact else "not intact"] += 1
        if emission.away is not None:
            self._go_away(emission.away)

    def _put(self, emission: Emission) -> bool:
        taken = True
        for number, piece in enumerate(emission.pieces):
            if number:
                time.sleep(_BETWEEN_PIECES_S)
            taken = self._send(piece) and taken
        return taken

    def _send(self, data: bytes) -> bool:
        taken = not data or self._line.send(data)
        self.counts["bytes" if taken else "bytes nobody took"] += len(data)
        return taken

    def _go_away(self, event: FaultEvent) -> None:
        self._line.hang_up()
        self._stop.wait(max(0.0, event.stop - self._now()))
        self._line.restore()
        self._restart()
        self._send(self.model.greeting())

    def _restart(self) -> None:
        self.model.restart()
        self._mangler.restart()
        self._number, self._due = 0, None


# ---- by the scheme of a driver ---------------------------------------------------------------------


def emulated() -> tuple[str, ...]:
    """Return the schemes of the devices that can be emulated."""
    return tuple(scheme for scheme, known in drivers().items() if known.emulated is not None)


def emulator(
    scheme: str,
    carrier: Carrier | str | None = None,
    *,
    port: int = 0,
    rate: float | None = None,
    signal: Signal | None = None,
    script: Script | None = None,
    seed: int = 0,
    options: Mapping[str, str] | None = None,
    quirks: Iterable[Quirk | str] = (),
    log: int = LOG,
) -> Emulator:
    """Make an emulated device, not yet started.

    Parameters
    ----------
    scheme : str
        Of its driver.
    carrier : Carrier or None
        The device's usual one if none is given.
    port : int
        Of TCP and UDP, on the loopback interface; 0: any free one.
    rate : float or None
        Frames per second until a command changes it.
    signal, script, seed, log
        As for `Emulator`; without a signal a constant one.
    options : mapping
        As in an address of it, such as ``{"profile": "onrobot"}``.
    quirks : iterable of Quirk
        What this one does and others of its kind do not.

    Raises
    ------
    EmulatorError
        There is no such device, carrier, port, option, quirk or fault.

    Examples
    --------
    >>> with emulator("sri", "tcp") as device:
    ...     device.url.startswith("sri+tcp://127.0.0.1:")
    True
    """
    known = _driver(scheme)
    carriers = tuple(way.carrier for way in known.ways)
    if carrier is not None and carrier not in list(carriers):
        raise EmulatorError(
            f"{arg(scheme)} over {arg(carrier)} is not supported: use {arg(', '.join(carriers))}."
        )
    try:
        given = {name: read_options(known, name, text) for name, text in (options or {}).items()}
    except ValueError as error:
        raise EmulatorError(f"{arg(scheme)}: {arg(error)}.") from error
    try:
        model, needed = known.emulate(rate, quirks, given)
    except InputError:
        raise
    except Exception as error:
        raise EmulatorError(
            f"{arg(scheme)}: the driver of {arg(known.title)} failed: {arg(error)!r}."
        ) from error
    if script is not None:
        script.check(model.faults, model.name)
    over = Carrier(carrier or carriers[0])
    return Emulator(
        model,
        _line(over, scheme, port),
        f"{scheme}+{over}",
        signal=signal or constant(model.rest),
        script=script,
        seed=seed,
        query=options_query(known, needed),
        log=log,
    )


def socket_of(scheme: str) -> Carrier:
    """Return what carries a device's bytes over a network: TCP where both can, or neither."""
    return next((way.carrier for way in _driver(scheme).ways if way.port is not None), Carrier.TCP)


def swinging(scheme: str | Model) -> Signal:
    """Return a signal to look at: a slow sine of each channel about the constant one."""
    model = _model(scheme) if isinstance(scheme, str) else scheme
    return sine(model.swing, model.swing_hz, model.rest)


def possible_faults(scheme: str) -> frozenset[Fault]:
    """Return the faults that the emulated device of a scheme can have."""
    return _model(scheme).faults


def _driver(scheme: str) -> Driver:
    try:
        known = driver_of(scheme)
    except ValueError as error:
        raise EmulatorError(f"device {arg(scheme)!r}: {arg(error)}.") from error
    if known is None or known.emulated is None:
        raise EmulatorError(f"unknown device {arg(scheme)!r}. Known: {arg(', '.join(emulated()))}.")
    return known


def _model(scheme: str) -> type[Model]:
    model = _driver(scheme).emulated
    assert model is not None  # noqa: S101 - `_driver` has looked
    return model


def _line(carrier: Carrier, scheme: str, port: int) -> DeviceLine:
    if carrier is Carrier.SERIAL:
        return PtyLine(scheme)
    return UdpServerLine(port) if carrier is Carrier.UDP else TcpServerLine(port)
