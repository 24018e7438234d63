"""Work that is begun before its result is needed, and dropped when it is not."""

from __future__ import annotations

import threading
from concurrent.futures import ThreadPoolExecutor, wait
from contextlib import contextmanager
from typing import TYPE_CHECKING, TypeVar

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

T = TypeVar("T")

_POLL_S = 0.05


@contextmanager
def begun(
    work: Callable[[Callable[[], bool]], T], tick: Callable[[], None], *, at_once: bool = True
) -> Iterator[Callable[[], T]]:
    """
    Do work in a thread of its own; it is told to stop at the end of the block.

    Parameters
    ----------
    work : callable
        Takes what it has to ask whether to stop.
    tick : callable
        Called all the time while the result is waited for; may raise to stop.
    at_once : bool
        Begin now; otherwise when the result is asked for.

    Yields
    ------
    callable
        Waits for the result, and raises what the work raised.
    """
    over = threading.Event()
    with ThreadPoolExecutor(1) as pool:
        try:
            early = pool.submit(work, over.is_set) if at_once else None

            def result() -> T:
                done = early or pool.submit(work, over.is_set)
                while not done.done():
                    tick()
                    wait((done,), _POLL_S)
                return done.result()

            yield result
        finally:
            over.set()
