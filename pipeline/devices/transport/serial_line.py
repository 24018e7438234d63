"""Serial lines, by pyserial."""

import errno
import os
import select
import time
from contextlib import suppress
from typing import Any

from contactbench.pipeline.devices.transport.sockets import Chunk, LineLost, LineUnavailable
from contactbench.pipeline.errors import arg, message

try:
    import termios
except ImportError:  # Windows
    _ERRORS: tuple[type[Exception], ...] = (OSError,)
else:
    # A terminal that was hung up raises this one from whatever touches its settings.
    _ERRORS = (OSError, termios.error)

# ValueError: a speed or a path that the system cannot have.
_OPENING_ERRORS: tuple[type[Exception], ...] = (*_ERRORS, ValueError)
_WRITE_TIMEOUT_S = 1.0
_AT_ONCE = 2**16  # bytes
_REMEDIES = {
    errno.ENOENT: message("plug in the device, or choose another of the listed ports"),
    errno.EACCES: message(
        "get permission to use serial ports (on Linux: the group dialout), or close the other program"
    ),
    errno.EAGAIN: message("another program is using it: close that program"),
    errno.EBUSY: message("another program is using it: close that program"),
}


class SerialLine:
    """A serial port, 8N1, for this process alone.

    Parameters
    ----------
    path : str
        Such as /dev/ttyUSB0 or COM3.
    baud : int
        Bit/s.
    """

    datagrams = False

    def __init__(self, path: str, baud: int) -> None:
        self.name = path
        self._baud = baud
        self._port: Any = None

    def open(self) -> None:
        """Open the port; see `Line.open`."""
        import serial  # type: ignore[import-untyped]

        self.close()
        try:
            self._port = serial.Serial(
                self.name, self._baud, timeout=0.0, write_timeout=_WRITE_TIMEOUT_S, exclusive=True
            )
        except _OPENING_ERRORS as error:
            number = getattr(error, "errno", None)
            remedy = _REMEDIES.get(
                number or 0, message("check the path and the speed, and that the device is plugged in")
            )
            raise LineUnavailable(
                f"{arg(self.name)}: the port cannot be opened ({arg(error)}): {arg(remedy)}."
            ) from error

    def read(self, timeout: float) -> Chunk:
        """Return what is there; see `Line.read`."""
        port = self._opened()
        try:
            data = self._there(port, timeout)
        except _ERRORS as error:
            raise self._lost(error) from error
        return Chunk(data, time.monotonic())

    @staticmethod
    def _there(port: Any, timeout: float) -> bytes:
        if os.name == "posix":  # half the system calls, which cost as much as all the rest of a sample
            if not select.select([port], [], [], timeout)[0]:
                return b""
            if not (data := os.read(port.fileno(), _AT_ONCE)):
                raise OSError(message("nothing can be read from it any more"))
            return data
        if port.timeout != timeout:  # setting it costs system calls, equal or not
            port.timeout = timeout
        first: bytes = port.read(1)
        # Not read(many): that waits until there are as many.
        return first and first + port.read(port.in_waiting)

    def write(self, data: bytes) -> None:
        """Send all of `data`; see `Line.write`."""
        try:
            self._opened().write(data)
        except _ERRORS as error:
            raise self._lost(error) from error

    def close(self) -> None:
        """Close the port."""
        port, self._port = self._port, None
        if port is not None:
            with suppress(*_ERRORS):
                port.close()

    def _opened(self) -> Any:
        if self._port is None:
            raise LineLost(f"{arg(self.name)}: the port is not open: open it first.")
        return self._port

    def _lost(self, error: Exception) -> LineLost:
        self.close()
        return LineLost(f"{arg(self.name)}: connection lost ({arg(error)}): check the plug, then reconnect.")
