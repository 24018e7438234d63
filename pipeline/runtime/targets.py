"""Where contacts can go: lines to a file or a pipe, datagrams, an MCAP file."""

from __future__ import annotations

import os
import socket
import stat
import sys
import time
from collections.abc import Sequence
from pathlib import Path

from contactbench.pipeline.errors import OutputError, ReaderGoneError, arg, message
from contactbench.pipeline.recording import RecordingError
from contactbench.pipeline.recording.chunk_file import ChunkFile
from contactbench.pipeline.recording.messages import ABOUT_RECORD, DEVICE_RECORD, about_record, device_record
from contactbench.pipeline.runtime.lines import CONTACT_SCHEMA, Answer, contact_schema
from contactbench.pipeline.runtime.outlet import FRESH_S, OutletTarget, OutputContext, resolve

CONTACT_TOPIC = "/contact"
_CHUNK_BYTES = 2**20
_CHUNK_S = 0.5
_SYNC_S = 1.0
_FILE_PACE_S = (
    0.05  # nobody waits for a file; a thread woken for every sample would cost the sensor's its turn
)


class LineTarget(OutletTarget):
    """
    Contacts as lines of JSON, into a file that is made for them or into what is open already.

    Written without a buffer of its own: a pipe that nobody empties must not hang the end of the process.

    Parameters
    ----------
    name : str
        What messages call it.
    descriptor : int
        To write to; closed at the end.
    pace : float
        As `OutletTarget`.
    """

    def __init__(self, name: str, descriptor: int, *, pace: float = 0.0) -> None:
        self.name, self._file, self.pace = name, descriptor, pace

    @classmethod
    def new(cls, path: Path) -> LineTarget:
        """
        Make a file.

        Raises
        ------
        OutputError
            It is there already, or cannot be made.
        """
        try:
            file = os.open(path, os.O_WRONLY | os.O_CREAT | os.O_EXCL | getattr(os, "O_BINARY", 0), 0o644)
        except FileExistsError as error:
            raise OutputError(
                f"{arg(path)}: it already exists: choose another name, or delete it."
            ) from error
        except (OSError, ValueError) as error:  # ValueError: a path that no file system can hold
            raise OutputError(
                f"{arg(path)}: it cannot be written ({arg(error)}): choose a writable location."
            ) from error
        return cls(str(path), file, pace=_FILE_PACE_S)

    def write(self, answers: Sequence[Answer]) -> int:
        """As `OutletTarget`."""
        left = memoryview(b"".join([answer.line for answer in answers]))
        try:
            while left:
                left = left[os.write(self._file, left) :]
        except BrokenPipeError as error:
            raise ReaderGoneError(f"{arg(self.name)}: its reader has closed it.") from error
        except OSError as error:
            raise OutputError(
                f"{arg(self.name)}: it cannot be written ({arg(error)}): free disk space, or choose another location."
            ) from error
        return len(answers)

    def close(self) -> None:
        """As `OutletTarget`."""
        try:
            os.close(self._file)
        except OSError as error:
            raise OutputError(
                f"{arg(self.name)}: its end cannot be written ({arg(error)}): free disk space."
            ) from error


def line_target(address: str, _context: OutputContext) -> LineTarget:
    """
    Return the lines to a new file, or for ``-`` to standard output, which stays open at their end.

    Raises
    ------
    OutputError
        As `LineTarget.new`.
    """
    if address != "-":
        return LineTarget.new(Path(address))
    sys.stdout.flush()
    descriptor = os.dup(sys.stdout.fileno())
    pace = (
        _FILE_PACE_S if stat.S_ISREG(os.fstat(descriptor).st_mode) else 0.0
    )  # a controller may wait for a pipe
    return LineTarget(message("standard output"), descriptor, pace=pace)


class UdpTarget(OutletTarget):
    """
    One datagram of JSON for every contact; what the system does not take at once is not sent.

    Parameters
    ----------
    address : str
        HOST:PORT.
    context : OutputContext

    Raises
    ------
    RunError
        It is no address, or on another machine without leave.
    """

    pace, fresh = 0.0, FRESH_S  # a controller may wait for them

    def __init__(self, address: str, context: OutputContext) -> None:
        self.name = f"udp {address}"
        family, self._to = resolve("--udp", address, socket.SOCK_DGRAM, remote=context.remote)
        self._socket = socket.socket(family, socket.SOCK_DGRAM)
        self._socket.setblocking(False)

    def write(self, answers: Sequence[Answer]) -> int:
        """As `OutletTarget`."""
        sent = 0
        for answer in answers:
            try:
                self._socket.sendto(answer.line, self._to)
            except OSError:  # nobody listens, no route, a full buffer: the next one may arrive
                continue
            sent += 1
        return sent

    def close(self) -> None:
        """As `OutletTarget`."""
        self._socket.close()


class McapTarget(OutletTarget):
    """
    Contacts on ``/contact`` of a new MCAP file, as JSON; all but the last half second survives a crash.

    Parameters
    ----------
    address : str
        Path that must not exist.
    context : OutputContext

    Raises
    ------
    OutputError
        It is there already, or cannot be made.
    """

    pace = _FILE_PACE_S

    def __init__(self, address: str, context: OutputContext) -> None:
        about = context.about
        self.name, self._about = address, about
        try:
            self._file = ChunkFile(Path(address), about.tool)
            self._file.add_metadata(ABOUT_RECORD, about_record(about))
            for device in about.devices:
                self._file.add_metadata(DEVICE_RECORD, device_record(device))
            schema = self._file.add_schema(CONTACT_SCHEMA, contact_schema())
            self._channel = self._file.add_channel(CONTACT_TOPIC, schema)
        except RecordingError as error:
            raise OutputError(str(error)) from error
        self._chunked = self._synced = time.monotonic()

    def write(self, answers: Sequence[Answer]) -> int:
        """As `OutletTarget`; a sample whose time is no time is left out."""
        written = 0
        try:
            for answer in answers:
                try:
                    stamp = self._about.log_time(answer.time)
                except ValueError:
                    continue
                self._file.add_message(self._channel, stamp, answer.message(stamp))
                written += 1
                if self._file.pending >= _CHUNK_BYTES:
                    self._file.finish_chunk()
        except RecordingError as error:
            raise OutputError(str(error)) from error
        return written

    def flush(self) -> None:
        """As `OutletTarget`: at most twice a second, for small chunks make a large file."""
        now = time.monotonic()
        try:
            if now - self._chunked >= _CHUNK_S:
                self._file.finish_chunk()
                self._chunked = now
            if now - self._synced >= _SYNC_S:
                self._file.sync()
                self._synced = now
        except RecordingError as error:
            raise OutputError(str(error)) from error

    def close(self) -> None:
        """As `OutletTarget`."""
        try:
            self._file.finish()
        except RecordingError as error:
            raise OutputError(str(error)) from error
