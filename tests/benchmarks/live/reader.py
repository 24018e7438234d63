"""A child process of the study: reads all sensors at once, as the application does, and notes what it is given.

Started as ``python -m benchmarks.live.reader FOLDER SECONDS URL...``; the last line that it
writes is JSON.
"""

from __future__ import annotations

import json
import struct
import sys
import time
from contextlib import ExitStack
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import IO, TYPE_CHECKING, Any

import numpy as np

from contactbench.pipeline.devices.protocols.sri import Layout
from contactbench.pipeline.devices.reconnecting_stream import SensorStream
from contactbench.pipeline.errors import InputError

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from contactbench.pipeline.devices.sample import WrenchSample

_PATIENCE_S = 10.0
_POLL_S = 0.01
_EARLY = 0.1  # the share of the run after which everything that is kept should be there


@dataclass(frozen=True)
class Cost:
    """What reading took."""

    seconds: float  # How long all sensors were read
    processor: float  # Time of the processor that the whole process used in these seconds, s
    ended: float  # When the streams began to be stopped, seconds of the monotonic clock
    # Memory of the process after a tenth of the time and at its end, bytes; None where the system does not
    # say
    resident_early: int | None
    # Memory of the process after a tenth of the time and at its end, bytes; None where the system does not
    # say
    resident_end: int | None
    findings: tuple[str, ...]  # What the streams found wrong, in sentences, each once


class Notes:
    """One sensor's samples as they are given, with the time."""

    def __init__(self, file: IO[bytes]) -> None:
        self._file = file
        self.count = 0

    def __call__(self, samples: Sequence[WrenchSample]) -> None:
        """Take samples."""
        at = time.monotonic()
        for sample in samples:
            self._file.write(GIVEN.pack(at, sample.sequence or 0, *sample.force, *sample.torque))
        self.count += len(samples)


def read(folder: Path, seconds: float, urls: Sequence[str]) -> Cost:
    """Read sensors for a time, and write what they gave to ``given-0.bin`` and so on."""
    with ExitStack() as stack:
        files = [stack.enter_context((folder / f"given-{i}.bin").open("wb")) for i in range(len(urls))]
        notes = [Notes(file) for file in files]
        found: dict[str, None] = {}
        streams = [
            SensorStream(url, note, lambda health: found.update(dict.fromkeys(health.findings)))
            for url, note in zip(urls, notes, strict=True)
        ]
        for stream in streams:
            stack.enter_context(stream)
        _await_all(notes)
        began, used = time.monotonic(), time.process_time()
        time.sleep(_EARLY * seconds)
        early = resident()
        time.sleep(max(0.0, began + seconds - time.monotonic()))
        ended, processor = time.monotonic(), time.process_time() - used
        end = resident()
    return Cost(ended - began, processor, ended, early, end, tuple(found))


def _await_all(notes: Sequence[Notes]) -> None:
    deadline = time.monotonic() + _PATIENCE_S
    while not all(note.count for note in notes):
        if time.monotonic() > deadline:
            raise TimeoutError(f"a sensor gave nothing for {_PATIENCE_S:g} s")
        time.sleep(_POLL_S)


def resident() -> int | None:
    """Return the memory of this process that is in use now, bytes; None where the system does not say."""
    try:
        pages = int(Path("/proc/self/statm").read_text(encoding="utf-8").split()[1])
    except (OSError, ValueError, IndexError):
        return None
    import resource

    return pages * resource.getpagesize()


def main(folder: str, seconds: str, *urls: str) -> None:
    """Read, and write what it took to standard output as JSON."""
    cost: dict[str, Any] = asdict(read(Path(folder), float(seconds), urls))
    sys.stdout.write(json.dumps(cost) + "\n")


if __name__ == "__main__":
    main(*sys.argv[1:])


# ---- what the processes of the study write down while they run, and how it is read back ----------


FRAME_BYTES = Layout().frame_bytes
SENT = struct.Struct(f"<d{FRAME_BYTES}s")
"""When a frame was given to the line, seconds of the monotonic clock that all processes share; the frame."""
GIVEN = struct.Struct("<dq6d")
"""When a sample was given to whoever reads, on the same clock; its sequence; N and N·m."""

SENT_TYPE = np.dtype([("at", "<f8"), ("head", "S4"), ("number", ">u2"), ("values", "<f4", 6), ("sum", "u1")])
GIVEN_TYPE = np.dtype([("at", "<f8"), ("sequence", "<i8"), ("values", "<f8", 6)])


def read_back(path: Path, kind: np.dtype[np.void]) -> NDArray[np.void]:
    """Return the records of a file."""
    data = path.read_bytes()
    if len(data) % kind.itemsize:
        raise InputError(
            f"{path.name}: the last record is cut off: the process that wrote it was ended. Run again."
        )
    return np.frombuffer(data, dtype=kind)
