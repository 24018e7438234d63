"""The bench in real time: a thread that keeps it beside the host's clock."""

from __future__ import annotations

import threading
import time
from typing import TYPE_CHECKING

from contactbench.pipeline.errors import InputError, arg, message

if TYPE_CHECKING:
    from collections.abc import Callable

    from contactbench.pipeline.simulation.virtual.bench import VirtualBench
    from contactbench.pipeline.simulation.virtual.commands import Batch

CATCH_UP_S = 0.2
_SLICE_S = 0.01  # a command waits no longer than this much of a bench that is late
_LOOK_S = 0.002
_SLOW = message(
    "The simulation is running behind because this computer is too slow. Lower the rate, or close"
    " other programs."
)


class BenchError(InputError):
    """A virtual bench that failed: a mistake of the program, or of who got its samples."""


def failure(error: Exception) -> BenchError:
    """Return what to tell of a mistake."""
    return BenchError(f"the virtual bench failed ({arg(type(error).__name__)}: {arg(error)}): open it again.")


class Pacer:
    """
    Advances a bench as time passes.

    Parameters
    ----------
    bench : VirtualBench
        Nobody else may advance it.
    on_batch : callable
        Gets what came, and what to add to its times to have them on the host's monotonic clock, s.
    on_end : callable
        Called at the end, when it was not stopped: with None, or with the error; a BenchError where the program or
        `on_batch` made a mistake, which then also goes to `threading.excepthook`.

    Attributes
    ----------
    slipped : float
        How much time was let go because the computer was too slow, s.
    """

    def __init__(
        self,
        bench: VirtualBench,
        on_batch: Callable[[Batch, float], None],
        on_end: Callable[[InputError | None], None] = lambda _: None,
    ) -> None:
        self._bench, self._on_batch, self._on_end = bench, on_batch, on_end
        self.slipped = 0.0
        self.origin = time.monotonic() - bench.time
        self._stopping = threading.Event()
        self._thread = threading.Thread(target=self._run, name=message("virtual bench"), daemon=True)

    def start(self) -> None:
        """Begin: the bench's clock goes on from where it is."""
        self.origin = time.monotonic() - self._bench.time
        self._thread.start()

    def stop(self) -> None:
        """End it; returns when nothing more comes."""
        self._stopping.set()
        if self._thread.ident is not None and self._thread is not threading.current_thread():
            self._thread.join()

    def findings(self) -> tuple[str, ...]:
        """Return what is wrong, in sentences."""
        return (*self._bench.findings(), *((_SLOW,) if self.slipped else ()))

    def _run(self) -> None:
        try:
            while not self._stopping.is_set() and not self._bench.ended:
                self._on_batch(self._advance(), self.origin)
        except InputError as error:
            self._on_end(error)
            return
        except Exception as error:
            # Whoever waits for samples must hear of it; the thread's hook has the traceback.
            self._on_end(failure(error))
            raise
        if not self._stopping.is_set():
            self._on_end(None)

    def _advance(self) -> Batch:
        late = time.monotonic() - self.origin - self._bench.time
        if late < _LOOK_S:
            self._stopping.wait(_LOOK_S - late)
            late = time.monotonic() - self.origin - self._bench.time
        if late > CATCH_UP_S:
            self.origin += late - CATCH_UP_S
            self.slipped += late - CATCH_UP_S
        return self._bench.advance(min(late, _SLICE_S))
