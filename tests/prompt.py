"""
A ``contactbench`` for shells that costs no start: what it imports is imported once, and each command is a fork of that.

``python prompt.py serve SOCKET`` waits for commands; ``python -S -E prompt.py SOCKET WORDS...`` runs one of them there,
in this folder and with these three streams, and ends as it ends.
"""

import array
import gc
import json
import os
import socket
import sys
from contextlib import suppress

_STREAMS = 3
# What most commands import by themselves.
_OFTEN = (
    "calibration", "session", "config.runtime", "contact.stream", "recording", "verification", "report.report_file",
)  # fmt: skip


def warm() -> None:
    """Import what commands import."""
    from importlib import import_module

    from contactbench.pipeline.cli import ENTRIES

    import_module("contactbench.app.cli")
    for entry in ENTRIES.values():
        import_module(entry.place.partition(":")[0])
    for module in _OFTEN:
        import_module(f"contactbench.pipeline.{module}")
    gc.freeze()  # a command that ends looks through all that it got from here, which takes longer than most commands


def serve(place: str) -> None:
    """Run what is asked for, until somebody ends this process."""
    warm()
    server = socket.socket(socket.AF_UNIX)
    server.bind(place)
    server.listen()
    while True:
        asked, _ = server.accept()
        streams = array.array("i", [0] * _STREAMS)
        told, ancillary, *_ = asked.recvmsg(2**20, socket.CMSG_LEN(streams.itemsize * _STREAMS))
        streams = array.array("i", bytes(ancillary[0][2]))
        order = json.loads(told)
        if os.fork() == 0:  # it waits for the command, so that one in the background holds up no other
            server.close()
            _run(asked, streams, order)
            return
        for stream in streams:
            os.close(stream)
        asked.close()
        with suppress(ChildProcessError):
            while os.waitpid(-1, os.WNOHANG)[0]:
                pass


def _run(asked: socket.socket, streams: array.array, order: dict) -> None:
    """Run a command in a process of its own, and say how it ended."""
    from contactbench.app.cli import main

    child = os.fork()
    if child == 0:
        for number, stream in enumerate(streams):
            os.dup2(stream, number)
            os.close(stream)
        asked.close()
        os.chdir(order["folder"])
        sys.argv = ["contactbench", *order["words"]]
        main()
        return
    for stream in streams:
        os.close(stream)
    asked.sendall(str(os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])).encode())
    os._exit(0)


def ask(place: str, words: list[str]) -> int:
    """Have a command run; return its exit code."""
    asked = socket.socket(socket.AF_UNIX)
    asked.connect(place)
    order = json.dumps({"folder": os.getcwd(), "words": words}).encode()  # noqa: PTH109 - pathlib takes its time
    streams = array.array("i", range(_STREAMS))
    asked.sendmsg([order], [(socket.SOL_SOCKET, socket.SCM_RIGHTS, streams)])
    return int(asked.recv(16))


if __name__ == "__main__":
    if sys.argv[1] == "serve":
        serve(sys.argv[2])
    else:
        sys.exit(ask(sys.argv[1], sys.argv[2:]))
