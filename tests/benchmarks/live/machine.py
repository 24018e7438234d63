"""How late the machine itself is: what no reader can be faster than."""

from __future__ import annotations

import threading
import time
from array import array
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from types import TracebackType
    from typing import Self

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
