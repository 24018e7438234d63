"""One mesh library's child process, seen from the parent: started late, kept warm, killed without harm."""

import atexit
import contextlib
import os
import queue
import re
import signal
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Mapping
from typing import IO, Any, BinaryIO, cast

import numpy.typing as npt

from contactbench.pipeline.errors import arg, message
from contactbench.pipeline.installation import module_command
from contactbench.pipeline.mesh.engines.libraries import EngineError, Library, Operation
from contactbench.pipeline.mesh.engines.wire import WireError, WireMessage, read_message, write_message
from contactbench.pipeline.mesh.monitor import NOBODY, Monitor

_WORKER = "contactbench.pipeline.mesh.engines.worker"

# How soon a cancel or a timeout is noticed, and how often the progress callback is given a sign of life.
_POLL_S = 0.05

# The libraries tell nothing while they work, so the only honest stages are these.
_STARTED, _WORKING, _DONE = 0.0, 0.1, 1.0

# What the child says goes into error messages; the end of it is where the reason stands.
_LAST_WORDS = 300
_COLOUR = re.compile(r"\x1b\[[\d;]*m")
_HURRY = message(" Allow more time, or start with fewer facets.")
_REPAIR = message(" Repair the mesh first, or use another engine.")


class _DiedIdleError(Exception):
    """
    A warm child was gone before it took up the call, which is therefore not what it died of.

    A process that was just killed looks alive until its last thread has ended, so asking beforehand does not settle it.
    """


class Child:
    """
    A library's process; any thread may call, one call runs at a time.

    Parameters
    ----------
    library : Library
        Which library it runs.
    """

    # Of all of them, added to this process's own: more where a window or a sensor would wait for the processors.
    niceness = 0

    def __init__(self, library: Library) -> None:
        self.library = library
        self._lock = threading.Lock()
        self._process: subprocess.Popen[bytes] | None = None
        self._stopped = f"{library}: cancelled"
        self._life = -1  # the child ends when this pipe does, whatever it is doing
        self._ready = False
        self._noise: IO[bytes] | None = None

    @property
    def pid(self) -> int | None:
        """The child's process id, None while there is none."""
        process = self._process
        return None if process is None or process.poll() is not None else process.pid

    def call(
        self, request: WireMessage, monitor: Monitor = NOBODY, timeout_s: float | None = None
    ) -> WireMessage:
        """
        Send a call and wait for its result.

        Raises
        ------
        Cancelled
            The caller cancelled; the child was killed, the next call starts another.
        EngineError
            The library is missing, refused, crashed, or took too long.
        """
        self._acquire(monitor)
        try:
            self._start()
            try:
                return self._exchange(request, monitor, timeout_s)
            except _DiedIdleError:
                self._start()
                return self._exchange(request, monitor, timeout_s)
        finally:
            self._lock.release()

    def begin(self) -> None:
        """Start the child unless it is there, without waiting for it; what is wrong with it the next call says."""
        if self._lock.acquire(blocking=False):
            try:
                with contextlib.suppress(EngineError):
                    self._start()
            finally:
                self._lock.release()

    def stop(self) -> None:
        """End the child; a call that another thread is in fails. The next call starts a new child."""
        if self._lock.acquire(blocking=False):
            try:
                self._discard()
            finally:
                self._lock.release()
        elif (process := self._process) is not None:
            process.kill()

    def forget(self) -> None:
        """Drop the child without ending it: after a fork it belongs to the parent's parent."""
        if self._process is not None:
            for pipe in (self._process.stdin, self._process.stdout):
                with contextlib.suppress(OSError):
                    os.close(cast("BinaryIO", pipe).fileno())
            os.close(self._life)
            # Popen would wait for a process that is not this one's child.
            self._process.returncode = 0
        self.__init__(self.library)  # type: ignore[misc]

    def _acquire(self, monitor: Monitor) -> None:
        monitor.check(self._stopped)
        while not self._lock.acquire(timeout=_POLL_S):
            monitor.tell(_STARTED, self._stopped)

    def _start(self) -> None:
        if self.pid is not None:
            return
        self._discard()
        theirs, self._life = os.pipe()
        # Appending: the file can be emptied here while the child keeps writing at its end.
        self._noise = tempfile.TemporaryFile("a+b")  # noqa: SIM115 -- it lives as long as the child
        posix = os.name == "posix"
        try:
            self._process = subprocess.Popen(  # noqa: S603 -- this Python and a module of ours
                module_command(_WORKER, str(self.library), str(self.niceness), *[str(theirs)] * posix),
                pass_fds=(theirs,) if posix else (),
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                stderr=self._noise,
                env=_environment(),
                creationflags=getattr(subprocess, "CREATE_NO_WINDOW", 0),
            )
        except OSError as error:
            self._discard()
            raise EngineError(
                f"{arg(self.library)} cannot be started ({arg(error)}): check that {arg(sys.executable)} can be run."
            ) from error
        finally:
            os.close(theirs)

    def _exchange(self, request: WireMessage, monitor: Monitor, timeout_s: float | None) -> WireMessage:
        process, noise = self._process, self._noise
        if process is None or noise is None:
            raise AssertionError("started before")
        noise.truncate(0)
        events: queue.SimpleQueue[WireMessage | None] = queue.SimpleQueue()
        thread = threading.Thread(
            target=_converse,
            args=(process, request, events, self._ready),
            name=str(self.library),
            daemon=True,
        )
        thread.start()
        try:
            answer = self._wait(request, events, monitor, timeout_s)
        except BaseException:
            # Whatever ended the wait, an answer to this call must not be read by the next one.
            process.kill()
            thread.join()
            self._discard()
            raise
        thread.join()
        if answer.kind == "failed":
            raise EngineError(
                f"{arg(self.library)} refused '{arg(request.kind)}':"
                f" {arg(answer.fields.get('reason', message('no reason given')))}."
                f"{arg('' if 'file' in request.arrays else _REPAIR)}"
            )
        monitor.tell(_DONE, self._stopped)
        return answer

    def _wait(
        self,
        request: WireMessage,
        events: queue.SimpleQueue[WireMessage | None],
        monitor: Monitor,
        timeout_s: float | None,
    ) -> WireMessage:
        deadline = None if timeout_s is None else time.monotonic() + timeout_s
        stage, warm = _STARTED, self._ready
        while True:
            monitor.tell(stage, self._stopped)
            if deadline is not None and time.monotonic() > deadline:
                raise EngineError(
                    f"{arg(self.library)} took longer than {arg(timeout_s):g} s for '{arg(request.kind)}'"
                    f" and was stopped.{arg('' if 'file' in request.arrays else _HURRY)}"
                )
            with contextlib.suppress(queue.Empty):
                match events.get(timeout=_POLL_S):
                    case WireMessage(kind="done" | "failed") as answer:
                        return answer
                    case WireMessage(kind="missing") as answer:
                        raise self._missing(answer)
                    case WireMessage(kind="ready"):
                        self._ready = True
                    case WireMessage(kind="working"):
                        stage = _WORKING
                    case _ if warm and stage == _STARTED:
                        raise _DiedIdleError
                    case _:
                        raise self._death(request)

    def _missing(self, answer: WireMessage) -> EngineError:
        return EngineError(
            f"{arg(self.library)} cannot be loaded ({arg(answer.fields.get('reason'))}): {arg(self.library.install)}."
        )

    def _death(self, request: WireMessage) -> EngineError:
        process = self._process
        if process is None:
            raise AssertionError("it died, so it was there")
        try:
            code = process.wait(timeout=1)
        except subprocess.TimeoutExpired:
            how = message("returned a nonsensical answer")
        else:
            how = message(f"died ({arg(_cause(code))})")
        facets = len(request.arrays.get("faces", ()))
        size = message(f" of {arg(facets)} facets") if facets else ""
        causes = message(" The usual causes are facets without area, duplicates and holes.") if facets else ""
        return EngineError(
            f"{arg(self.library)} {arg(how)} on '{arg(request.kind)}'{arg(size)}; nothing else was affected."
            f"{arg(self._last_words())}{arg(causes)}{arg(_REPAIR if facets else '')}"
        )

    def _last_words(self) -> str:
        if self._noise is None:
            return ""
        self._noise.seek(0)
        # VTK and Open CASCADE colour what they say, and VTK sets it to the right.
        lines = _COLOUR.sub("", self._noise.read().decode(errors="replace")).split("\n")
        words = next((" ".join(line.split())[-_LAST_WORDS:] for line in reversed(lines) if line.strip()), "")
        return message(f" Last output: {arg(words)}.") if words else ""

    def _discard(self) -> None:
        process, noise = self._process, self._noise
        self._process, self._noise, self._ready = None, None, False
        if process is not None:
            process.kill()
            process.wait()
            for pipe in (process.stdin, process.stdout):
                # Closing flushes, which a dead child's pipe refuses.
                with contextlib.suppress(OSError):
                    cast("BinaryIO", pipe).close()
        if noise is not None:
            noise.close()
            os.close(self._life)


def _converse(
    process: subprocess.Popen[bytes],
    request: WireMessage,
    events: queue.SimpleQueue[WireMessage | None],
    ready: bool,
) -> None:
    """Write the call and read what comes, in a thread of its own: the caller can then leave at any time."""
    results = cast("BinaryIO", process.stdout)
    with contextlib.suppress(OSError, ValueError, WireError, MemoryError):
        if not ready:
            events.put(greeting := read_message(results))
            if greeting is None or greeting.kind != "ready":
                return
        write_message(cast("BinaryIO", process.stdin), request)
        while (packet := read_message(results)) is not None:
            events.put(packet)
            if packet.kind in ("done", "failed"):
                return
    events.put(None)


def _environment() -> dict[str, str]:
    """
    Leave out what would lead the Qt inside pymeshlab to this program's plugins, and turn warnings fatal.

    libigl cuts crossings in one thread: with more, the order in which they happen to look at a number decides how its
    last bit is rounded, and the same mesh gave other bytes in one run of four.
    """
    kept = {
        key: value
        for key, value in os.environ.items()
        if not key.startswith(("QT_", "QML")) and key != "PYTHONWARNINGS"
    }
    return kept | {"IGL_NUM_THREADS": "1"}


def _cause(code: int) -> str:
    if code >= 0:
        return message(f"exit code {arg(code)}")
    name = signal.Signals(-code).name if -code in set(signal.Signals) else f"signal {-code}"
    return message(f"{arg(name)}, possibly out of memory") if name == "SIGKILL" else name


_CHILDREN = {library: Child(library) for library in Library}


def run(
    operation: Operation,
    arrays: Mapping[str, npt.NDArray[Any]],
    parameters: Mapping[str, float | int | bool | str],
    *,
    monitor: Monitor = NOBODY,
    timeout_s: float | None = None,
) -> dict[str, npt.NDArray[Any]]:
    """
    Run an operation in its library's child process.

    The arrays go as they are: the typed functions check them first. The first call starts the child (about
    a second), which then stays warm. Calls from several threads to one library queue up; of cuts two go at once.

    Parameters
    ----------
    operation : Operation
        What to do.
    arrays : mapping
        float64, int32 or bool arrays by name.
    parameters : mapping
        Plain values by name.
    monitor : Monitor
        Told 0 at the start, 0.1 when the library begins, 1 when its result is here, and in between the last of
        these again every 0.05 s as a sign of life: the libraries do not say how far they are. Asked every 0.05 s; once
        the work is to stop, the child is killed.
    timeout_s : float, optional
        Longest time in seconds, without the wait for other threads' calls.

    Returns
    -------
    dict
        float64, int32 or bool arrays by name; their content is the library's and unchecked.

    Raises
    ------
    Cancelled
        The caller cancelled.
    EngineError
        The library is missing, refused, crashed or took too long. The next call starts afresh.
    """
    request = WireMessage(str(operation), dict(parameters), dict(arrays))
    return _CHILDREN[operation.library].call(request, monitor, timeout_s).arrays


def start_engine(operation: Operation) -> None:
    """Start the child of an operation that will be needed soon: it loads its library while other work is done."""
    _CHILDREN[operation.library].begin()


def stop_engines() -> None:
    """End the children, which frees their memory; the next operation starts a new one. Also done at exit."""
    for child in _CHILDREN.values():
        child.stop()


def _forget_engines() -> None:
    for child in _CHILDREN.values():
        child.forget()


atexit.register(stop_engines)
# A forked copy of this process would write into the same pipes.
if hasattr(os, "register_at_fork"):
    os.register_at_fork(after_in_child=_forget_engines)
