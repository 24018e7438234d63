"""What the processes of a study write down while they run, how it is read back, and how much memory they use."""

import struct
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from contactbench.pipeline.devices.protocols.sri import Layout
from contactbench.pipeline.errors import InputError


def resident() -> int | None:
    """Return the memory of this process that is in use now, bytes; None where the system does not say."""
    try:
        pages = int(Path("/proc/self/statm").read_text(encoding="utf-8").split()[1])
    except (OSError, ValueError, IndexError):
        return None
    import resource

    return pages * resource.getpagesize()


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
