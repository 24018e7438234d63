"""Contacts on their way out: each output has a thread of its own, so that none keeps the sensor or another waiting."""

from __future__ import annotations

import ipaddress
import math
import socket
import threading
import time
from collections import deque
from contextlib import suppress
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NamedTuple, Protocol

from contactbench.pipeline.errors import OutputError, ReaderGoneError, RunError, arg, message

if TYPE_CHECKING:
    from collections.abc import Sequence

    from contactbench.pipeline.mesh.probe import Probe
    from contactbench.pipeline.recording import RecordingInfo
    from contactbench.pipeline.runtime.lines import Answer

_MOST_WAITING = 10_000  # ten seconds at 1 kHz
_AT_ONCE = 500
_LOOK_S = 0.002
_IDLE_S = 0.2
FRESH_S = 0.5  # older contacts are of no use to whoever acts on them


@dataclass(frozen=True)
class OutputContext:
    """What every output is opened with."""

    about: RecordingInfo
    """Ties the samples' clock to the calendar."""
    probe: Probe
    """For those that show a picture."""
    remote: bool = False
    """Whether other machines may take part: nothing is encrypted or signed."""


class OutletTarget(Protocol):
    """Where contacts go."""

    name: str
    pace: float = 0.005
    """Least time between two writes, s: contacts are gathered meanwhile, for waking a thread costs as much as ten."""
    fresh: float = math.inf
    """How long a contact may wait before it is left out, s: without end where all are kept, as in a file."""
    trouble: str = ""
    """Why it takes nothing now, a sentence; empty: it does, or does not know."""

    def write(self, answers: Sequence[Answer]) -> int:
        """
        Publish contacts, oldest first; returns how many of them were.

        Raises
        ------
        OutputError
            It cannot any more.
        """

    def flush(self) -> None:
        """Bring out what is held back, if anything is; called when nothing comes, too. Raises as `write`."""
        return  # so that it is not abstract

    def close(self) -> None:
        """End it. Raises as `write`."""


class Outlet:
    """
    One target, served by a thread of its own.

    One that published nothing of what it was given has failed, at its end.

    `put` never waits for the target, unless the source can: when ten thousand contacts wait, or one has waited for
    longer than the target's `fresh`, the oldest are dropped and counted. What was computed is not affected.

    Parameters
    ----------
    target : OutletTarget
        Closed at the end.
    patient : bool
        The source can wait, as a recording can: nothing is dropped.
    most_waiting : int

    Attributes
    ----------
    name : str
    published, dropped : int
        Contacts so far.
    failed : threading.Event
        Set once the target takes nothing more.
    error : OutputError or None
        Why.
    """

    def __init__(
        self, target: OutletTarget, *, patient: bool = False, most_waiting: int = _MOST_WAITING
    ) -> None:
        self._target, self._patient, self._most_waiting = target, patient, most_waiting
        self._waiting: deque[tuple[float, Answer]] = deque()
        self._came, self._closing = threading.Event(), threading.Event()
        self._thread = threading.Thread(target=self._run, name=f"to {target.name}", daemon=True)
        self.name = target.name
        self._writing: list[Answer] = []
        self._wrote = -math.inf
        self.published = self.dropped = 0
        self._unsent = 0  # counted in the other thread: one counter has one writer
        self.failed = threading.Event()
        self.error: OutputError | None = None

    @property
    def lost(self) -> int:
        """Contacts that were not published: dropped, or not taken by the target."""
        return self.dropped + self._unsent

    @property
    def trouble(self) -> str:
        """Why it publishes nothing, now or any more; empty: it does, or does not know."""
        return self._target.trouble if self.error is None else str(self.error)

    @property
    def gone(self) -> bool:
        """Whether it failed only because whoever read has closed the pipe."""
        return isinstance(self.error, ReaderGoneError)

    def start(self) -> None:
        """Begin to publish."""
        self._thread.start()

    def put(self, answer: Answer) -> None:
        """Take a contact to publish."""
        if len(self._waiting) >= self._most_waiting and not self._has_room():
            with suppress(IndexError):  # taken meanwhile: there is room
                self._waiting.popleft()
                self.dropped += 1
        self._waiting.append((time.monotonic(), answer))
        if not self._came.is_set():  # while its thread gathers contacts it is not woken for each of them
            self._came.set()

    def close(self, patience: float = 2.0) -> None:
        """Publish what waits, but do not wait for it longer than `patience` s; a target that hangs is left behind."""
        self._closing.set()
        self._came.set()
        if self._thread.ident is None:
            self._finish()
            return
        self._thread.join(patience)
        if self._thread.is_alive():
            self._leave(patience)

    def _leave(self, patience: float) -> None:
        """Give up a target that hangs; its thread ends with the program, and holds nothing of the kernel then."""
        for answer in self._writing:
            answer.let_go()
        with suppress(IndexError):
            while self._waiting.popleft():
                self.dropped += 1
        if self.error is None:
            self.error = OutputError(
                f"{arg(self.name)}: no output was accepted for {arg(patience):g} s, so the rest is lost:"
                " read the output."
            )
        self.failed.set()

    def _has_room(self) -> bool:
        while self._patient and not self._closing.is_set() and not self.failed.is_set():
            time.sleep(_LOOK_S)
            if len(self._waiting) < self._most_waiting:
                return True
        return False

    def _run(self) -> None:
        going = True
        while going:
            answers, going = self._next()
            self._do(answers)
        self._finish()

    def _next(self) -> tuple[list[Answer], bool]:
        if self._target.pace and not self._patient:
            self._closing.wait(max(0.0, self._wrote + self._target.pace - time.monotonic()))
        if not self._waiting:
            self._came.clear()
            if not (self._waiting or self._closing.is_set()):
                self._came.wait(_IDLE_S)
        answers: list[Answer] = []
        going, now = not self._closing.is_set(), time.monotonic()
        with suppress(IndexError):
            while len(answers) < _AT_ONCE:
                put, answer = self._waiting.popleft()
                if self._patient or now - put <= self._target.fresh:
                    answers.append(answer)
                else:
                    self._unsent += 1
            return answers, True
        return answers, going

    def _do(self, answers: list[Answer]) -> None:
        self._writing = answers
        if self.error is None:
            try:
                taken = self._target.write(answers) if answers else 0
                self.published += taken
                self._unsent += len(answers) - taken
                self._target.flush()
            except OutputError as error:
                self._fail(error, len(answers))
        else:
            self._unsent += len(answers)
        self._wrote = time.monotonic()

    def _finish(self) -> None:
        try:
            self._target.close()
        except OutputError as error:
            self._fail(error, 0)
        if self.lost and not self.published and self.error is None:
            why = message(
                f"{arg(self.name)}: no contact was published: check its address, and who receives there."
            )
            self._fail(OutputError(self._target.trouble or why), 0)

    def _fail(self, error: OutputError, missing: int) -> None:
        self._unsent += missing
        if self.error is None:
            self.error = error
        self.failed.set()


class Place(NamedTuple):
    """A resolved address."""

    family: socket.AddressFamily
    address: Any  # as `socket.bind` and `socket.connect` take it

    @property
    def host(self) -> str:
        """IP address."""
        return str(self.address[0])

    @property
    def port(self) -> int:
        """TCP or UDP port."""
        return int(self.address[1])


def resolve(option: str, text: str, kind: socket.SocketKind, *, remote: bool, listens: bool = False) -> Place:
    """
    Return what HOST:PORT stands for.

    Parameters
    ----------
    option : str
        What gave it, such as ``--udp``, for messages.
    text : str
    kind : socket.SocketKind
    remote : bool
        Whether it may be, or be reached from, another machine: nothing is encrypted or signed.
    listens : bool
        It is an address to listen on: port 0 is any free one.

    Raises
    ------
    RunError
        It is no address, or on another machine without leave.
    """
    host, _, port = text.rpartition(":")
    lowest = 0 if listens else 1
    if not host or not (
        port.isascii() and port.isdigit() and len(port) <= 5 and lowest <= int(port) < 65_536
    ):
        raise RunError(f"{arg(option)} {arg(text)}: give a host and a port, such as 127.0.0.1:9000.")
    try:
        family, _, _, _, place = socket.getaddrinfo(host.strip("[]"), int(port), type=kind)[0]
        near = ipaddress.ip_address(str(place[0]).partition("%")[0]).is_loopback
    except (OSError, UnicodeError, ValueError) as error:
        raise RunError(
            f"{arg(option)} {arg(text)}: there is no such host ({arg(error)}): write its IP address, such as 127.0.0.1."
        ) from error
    if not near and not remote and listens:
        raise RunError(
            f"{arg(option)} {arg(text)}: other machines could connect there, and contacts are neither"
            " encrypted nor signed: listen on 127.0.0.1, or allow other machines (--allow-remote)."
        )
    if not near and not remote:
        raise RunError(
            f"{arg(option)} {arg(text)}: this is another machine, and contacts are neither encrypted nor"
            " signed: send to 127.0.0.1, or allow other machines (--allow-remote)."
        )
    return Place(family, place)
