"""
The child process: reads calls from standard input, lets one mesh library do them, writes the results.

``python -P -m contactbench.pipeline.mesh.engines.worker meshlab 0``

A crash, a leak or a lost state of the library ends or spoils this process only. The parent starts it,
and it ends when its standard input does, which is when the parent goes, however it goes.
"""

import contextlib
import importlib
import os
import signal
import sys
from collections.abc import Iterator
from typing import Any, BinaryIO

from contactbench.pipeline.errors import message
from contactbench.pipeline.installation import component_folders
from contactbench.pipeline.mesh.engines.libraries import REFUSALS, Library, Operation, perform
from contactbench.pipeline.mesh.engines.wire import WireError, WireMessage, read_message, write_message

# Imported by name at run time: pymeshlab and the CGAL half of libigl are GPL-3, and stay on this side of the process
# boundary, where nothing but the messages of this package passes.
_MODULES = {
    Library.MESHLAB: "pymeshlab",
    Library.CGAL: "igl.copyleft.cgal",
    Library.COLLADA: "collada",
    Library.VTK: "vtkmodules.vtkIOXML",
    Library.CASCADIO: "cascadio",
}


# A small file can claim any size; four million facets of a real one take less.
_READERS, _FOR_A_FILE = (Library.COLLADA, Library.VTK, Library.CASCADIO), 2**33


def main(library: str, niceness: str = "0", life: str = "") -> int:
    """
    Serve calls until standard input ends.

    Parameters
    ----------
    library : str
        A `Library`.
    niceness : str
        Added to that of the process, where there is such a thing.
    life : str
        The number of a pipe's end that reads nothing, and ends with the parent.

    Returns
    -------
    int
        The exit code.
    """
    # Ctrl-C in a terminal reaches the whole group; the parent decides what it means.
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    calls, results = _private_pipes()
    _limit_resources(_FOR_A_FILE if library in _READERS else None)
    if hasattr(os, "nice"):
        os.nice(int(niceness))
    name = Library(library)
    sys.path += map(str, component_folders("meshlab"))
    try:
        module = importlib.import_module(_MODULES[name])
    except ImportError as error:
        write_message(results, WireMessage("missing", {"reason": str(error)}))
        return 0
    write_message(results, WireMessage("ready"))
    try:
        while (call := read_message(calls)) is not None:
            write_message(results, WireMessage("working"))
            with _ended_with_the_parent(life):
                result = _answer(module, call)
            write_message(results, result)
    except (BrokenPipeError, WireError):
        # The parent went away in the middle of a message; there is nobody left to tell.
        return 1
    return 0


def _answer(module: Any, call: WireMessage) -> WireMessage:
    try:
        arrays = perform(module, Operation(call.kind), call.arrays, call.fields)
    except MemoryError:
        return WireMessage("failed", {"reason": message("it ran out of memory")})
    except REFUSALS as error:
        return WireMessage("failed", {"reason": _in_one_line(error)})
    # pymeshlab's own exception is known only through the module.
    except getattr(module, "PyMeshLabException", RuntimeError) as error:
        return WireMessage("failed", {"reason": _in_one_line(error)})
    return WireMessage("done", arrays=arrays)


def _in_one_line(error: BaseException) -> str:
    return " ".join(str(error).split())[:1000]


def _private_pipes() -> tuple[BinaryIO, BinaryIO]:
    """Take standard input and output for messages: what the libraries print goes to standard error instead."""
    calls = os.fdopen(os.dup(0), "rb")
    results = os.fdopen(os.dup(1), "wb")
    nothing = os.open(os.devnull, os.O_RDONLY)
    os.dup2(nothing, 0)
    os.close(nothing)
    os.dup2(2, 1)
    return calls, results


@contextlib.contextmanager
def _ended_with_the_parent(life: str) -> Iterator[None]:
    """
    End this process at once when the parent goes while the library works.

    The library holds the interpreter, so no thread of ours could watch. The kernel does: it sends SIGIO, which
    ends a process that does not handle it, when the pipe's other end closes. (PR_SET_PDEATHSIG looks made for
    this, but means the parent's *thread*: the engine would die with the worker thread that first used it.)
    It sends SIGIO for what is written as well, a moment after that could be read: the pipe of the calls would end
    a child that is quick. Where there is no such signal, the end comes after the operation.
    """
    if not life or not hasattr(os, "O_ASYNC"):
        yield
        return
    import fcntl
    import select

    end = int(life)
    flags = fcntl.fcntl(end, fcntl.F_GETFL)
    signal.signal(signal.SIGIO, signal.SIG_DFL)
    fcntl.fcntl(end, fcntl.F_SETOWN, os.getpid())
    fcntl.fcntl(end, fcntl.F_SETFL, flags | os.O_ASYNC)
    try:
        # The parent may have gone just before the kernel was asked.
        if select.select([end], [], [], 0)[0]:
            raise BrokenPipeError
        yield
    finally:
        fcntl.fcntl(end, fcntl.F_SETFL, flags)


def _limit_resources(most: int | None) -> None:
    """Leave no core file of a crash, and fail for want of `most` bytes rather than make the machine swap."""
    try:
        import resource
    except ImportError:
        return
    resource.setrlimit(resource.RLIMIT_CORE, (0, resource.getrlimit(resource.RLIMIT_CORE)[1]))
    machine = os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE")
    _, hard = resource.getrlimit(resource.RLIMIT_AS)
    limit = min(machine, most or machine, machine if hard == resource.RLIM_INFINITY else hard)
    # Some systems have the limit but refuse to set it.
    with contextlib.suppress(ValueError, OSError):
        resource.setrlimit(resource.RLIMIT_AS, (limit, hard))


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
