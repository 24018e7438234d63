"""Let an engine do an operation: the one way into the child processes."""

from __future__ import annotations

import atexit
import os
from typing import TYPE_CHECKING, Any

from contactbench.pipeline.mesh.engines.child import Child, Watch
from contactbench.pipeline.mesh.engines.operation import Library, Operation
from contactbench.pipeline.mesh.engines.wire import Message

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    import numpy.typing as npt

_CHILDREN = {library: Child(library) for library in Library}


def run(
    operation: Operation,
    arrays: Mapping[str, npt.NDArray[Any]],
    parameters: Mapping[str, float | int | bool | str],
    *,
    progress: Callable[[float], None] | None = None,
    cancelled: Callable[[], bool] | None = None,
    timeout_s: float | None = None,
) -> dict[str, npt.NDArray[Any]]:
    """
    Run an operation in its library's child process.

    The arrays go as they are: the typed functions check them first. The first call starts the child (about
    a second), which then stays warm. Calls from several threads to one library queue up.

    Parameters
    ----------
    operation : Operation
        What to do.
    arrays : mapping
        float64, int32 or bool arrays by name.
    parameters : mapping
        Plain values by name.
    progress : callable, optional
        Takes 0 at the start, 0.1 when the library begins, 1 when its result is here, and in between the last of
        these again every 0.05 s as a sign of life: the libraries do not say how far they are. Called in the
        calling thread; what it raises stops the engine and reaches the caller.
    cancelled : callable, optional
        Asked every 0.05 s; once it answers True the child is killed.
    timeout_s : float, optional
        Longest time in seconds, without the wait for other threads' calls.

    Returns
    -------
    dict
        float64, int32 or bool arrays by name; their content is the library's and unchecked.

    Raises
    ------
    Cancelled
        `cancelled` answered True.
    EngineError
        The library is missing, refused, crashed or took too long. The next call starts afresh.
    """
    request = Message(str(operation), dict(parameters), dict(arrays))
    watch = Watch(progress, cancelled, timeout_s)
    return _CHILDREN[operation.library].call(request, watch).arrays


def engine_pid(library: Library) -> int | None:
    """Return the process id of a library's child, None when it is not running."""
    return _CHILDREN[library].pid


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
