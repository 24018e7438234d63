"""Sensors in processes of their own, a busy core, and what was sent held against what was given."""

from __future__ import annotations

import os
import subprocess
import sys
import threading
import time
from array import array
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from contactbench.pipeline.errors import InputError

if TYPE_CHECKING:
    from collections.abc import Iterator
    from types import TracebackType
    from typing import Self

    from numpy.typing import NDArray

_MARGIN_S = 60.0  # processes start and stop in much less
_GRACE_S = 0.25  # what is sent just before the end may be left on the line
_SPIN = "import sys, time\nend = time.monotonic() + float(sys.argv[1])\nwhile time.monotonic() < end: pass"


@dataclass(frozen=True, eq=False)
class Comparison:
    """One sensor's frames beside the samples that came of them."""

    sent: int  # Frames up to just before the end
    lost: int  # Frames of them that came to nothing
    # Samples that are no frame: other values, a number that was not sent, or one that came before
    changed: int
    # (n,) float64. From the frame's first byte given to the line to the sample given to its reader, s.
    latency: NDArray[np.float64]


def compare(sent: NDArray[np.void], given: NDArray[np.void], until: float) -> Comparison:
    """Hold what was given against what was sent."""
    if len(sent) < 2 or len(given) < 2:
        raise InputError(f"{len(sent)} frames sent, {len(given)} samples given: let the run last longer.")
    number = given["sequence"]
    known = (number >= 0) & (number < len(sent))
    known[1:] &= number[1:] > np.maximum.accumulate(number)[:-1]
    frame = sent[number[known]]
    # The frame's float32 became a Python float, which holds it exactly.
    same = (frame["values"] == given["values"][known]).all(axis=1)
    same &= frame["number"] == number[known] % 65_536
    arrived = np.zeros(len(sent), dtype=bool)
    arrived[number[known][same]] = True
    due = sent["at"] <= until
    return Comparison(
        sent=int(due.sum()),
        lost=int((due & ~arrived).sum()),
        changed=len(given) - int(same.sum()),
        latency=given["at"][known][same] - frame["at"][same],
    )


@contextmanager
def sensor_process(notes: Path, rate: float) -> Iterator[str]:
    """Run a sensor; gives its address."""
    command = [sys.executable, "-m", "benchmarks.live.sensor", str(notes), f"{rate:g}"]
    with subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True) as process:
        try:
            url = process.stdout.readline().strip() if process.stdout else ""
            if not url:
                raise InputError("an emulated sensor did not start: its error is above.")
            yield url
        finally:
            if process.stdin is not None:
                process.stdin.close()
            try:
                process.wait(_MARGIN_S)
            except subprocess.TimeoutExpired:
                process.kill()
    if process.returncode:
        raise InputError(f"an emulated sensor failed (exit {process.returncode}): its error is above.")


@contextmanager
def busy_process(at_most: float, core: int | None = None) -> Iterator[None]:
    """Keep one core busy, this one or whichever, for some seconds at most."""
    process = subprocess.Popen([sys.executable, "-c", _SPIN, f"{at_most:g}"])
    if core is not None:
        os.sched_setaffinity(process.pid, {core})
    try:
        yield
    finally:
        process.kill()
        process.wait()


# ---- how late the machine itself is: what no reader can be faster than ---------------------------


_NAP_S = 0.001


class Sleeper:
    """
    A thread that does nothing but sleep for a millisecond at a time, and notes how much later it wakes.

    Use it in a ``with`` statement, in a process that is otherwise idle.
    """

    def __init__(self) -> None:
        self._late = array("d")
        self._stopping = threading.Event()
        self._thread = threading.Thread(target=self._run, name="sleeper", daemon=True)

    def __enter__(self) -> Self:
        self._thread.start()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._stopping.set()
        self._thread.join()

    @property
    def late(self) -> float:
        """The 99th percentile so far, s; 0 before it has slept."""
        # A copy: what NumPy looks at cannot grow, and the thread goes on.
        return float(np.percentile(np.array(self._late[:]), 99)) if self._late else 0.0

    def _run(self) -> None:
        while not self._stopping.is_set():
            due = time.monotonic() + _NAP_S
            time.sleep(_NAP_S)
            self._late.append(max(0.0, time.monotonic() - due))
