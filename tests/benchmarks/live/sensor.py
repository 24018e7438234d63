"""A child process of the study: one emulated SRI sensor on a pseudo-terminal, which notes what it sends and when.

Started as ``python -m benchmarks.live.sensor FILE RATE``. It prints its address, and runs
until its standard
input is closed, so that it never outlives the process that started it.
"""

from __future__ import annotations

import math
import sys
import time
from pathlib import Path
from typing import IO, TYPE_CHECKING

from benchmarks.live.reader import FRAME_BYTES, SENT

from contactbench.pipeline.devices.device_line import PtyLine
from contactbench.pipeline.devices.emulate import Emulator
from contactbench.pipeline.devices.protocols.sri import SriModel

if TYPE_CHECKING:
    from contactbench.pipeline.devices.device_line import DeviceLine
    from contactbench.pipeline.devices.faults import Six

_BAUD = 921_600  # what carries 1 kHz


class NotedLine:
    """A line that notes every frame on its way out."""

    datagrams = False

    def __init__(self, line: DeviceLine, notes: IO[bytes]) -> None:
        self._line = line
        self._notes = notes
        self.where = line.where
        self.fresh = False

    def receive(self, timeout: float) -> bytes:
        """As `DeviceLine`."""
        data = self._line.receive(timeout)
        self.fresh = self._line.fresh
        return data

    def send(self, data: bytes) -> bool:
        """As `DeviceLine`."""
        at = time.monotonic()
        taken = self._line.send(data)
        if len(data) == FRAME_BYTES and data.startswith(b"\xaa\x55"):
            self._notes.write(SENT.pack(at, data))
        return taken

    def hang_up(self) -> None:
        """As `DeviceLine`."""
        self._line.hang_up()

    def restore(self) -> None:
        """As `DeviceLine`."""
        self._line.restore()

    def close(self) -> None:
        """As `DeviceLine`."""
        self._line.close()


def main(notes: Path, rate: float) -> None:
    """Be a sensor until standard input ends."""
    with notes.open("wb") as file:
        line = NotedLine(PtyLine("sri"), file)
        query = f"?baud={_BAUD}&rate={rate:g}"
        with Emulator(SriModel(), line, "sri+serial", signal=_signal, query=query) as device:
            sys.stdout.write(device.url + "\n")
            sys.stdout.flush()
            sys.stdin.read()


def _signal(time: float) -> Six:
    """Return readings of which no two are alike: a sample that is given twice, or mixed up, is noticed."""
    swing = math.sin(time)
    return (time, swing, 3.5 + swing, 0.1 * swing, -1e-3 * time, 0.05)


if __name__ == "__main__":
    main(Path(sys.argv[1]), float(sys.argv[2]))
