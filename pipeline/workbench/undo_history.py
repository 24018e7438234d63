"""What can be undone of a session, also after it was opened again: which records each step made."""

from __future__ import annotations

import json
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, TypeVar

from contactbench.pipeline.durable import write_durably
from contactbench.pipeline.session.state import fold
from contactbench.pipeline.workbench.session_change import change_between

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence
    from pathlib import Path

    from contactbench.pipeline.session import Session
    from contactbench.pipeline.workbench.session_change import SessionChange

T = TypeVar("T")
UNDO_FILE = "undo.json"
_VERSION, _MOST, _LARGEST = 1, 200, 2**20


class Deed:
    """
    One step: what it is called, and between which records of the journal it happened.

    The journal has all that it takes to go back, so nothing else is kept of it.

    Parameters
    ----------
    text : str
        For people.
    first, last : int
        How many records there were before and after it; the same: it did nothing, or is not done yet.
    chain : str
        Hash of its last record: by it, the records of another journal are told apart.
    """

    def __init__(self, text: str, first: int = 0, last: int = 0, chain: str = "") -> None:
        self.text, self.first, self.last, self.chain = text, first, last, chain

    @property
    def happened(self) -> bool:
        """Whether it left anything."""
        return self.last > self.first

    def begin(self, session: Session) -> None:
        """Let it begin here."""
        self.first = self.last = session.state.count

    def end(self, session: Session) -> None:
        """Let it end here."""
        self.last, self.chain = session.state.count, session.records[-1].hash

    def around(self, action: Callable[[Session], T]) -> Callable[[Session], T]:
        """Return an action that is this step; one that fails is none."""

        def run(session: Session) -> T:
            self.begin(session)
            result = action(session)
            self.end(session)
            return result

        return run

    def change(self, session: Session) -> SessionChange:
        """Return what it changed: by that, it can be taken back and done again."""
        records = session.records
        return change_between(fold(records[: self.first]), fold(records[: self.last]))


@dataclass(frozen=True)
class UndoHistory:
    """The steps of a session, oldest first."""

    deeds: tuple[Deed, ...] = ()
    done: int = 0  # How many of them are done; the others were taken back, and can be done again


def write_history(folder: Path, deeds: Sequence[Deed], done: int) -> None:
    """
    Write the steps of a session into its folder; those that left nothing are left out.

    A disk that takes nothing loses the steps, and nothing else: the journal is not touched.
    """
    left = max(0, len(deeds) - _MOST)
    kept = [(number, each) for number, each in enumerate(deeds) if each.happened and number >= left]
    content = {
        "version": _VERSION,
        "done": sum(number < done for number, _ in kept),
        "steps": [
            {"text": each.text, "first": each.first, "last": each.last, "chain": each.chain}
            for _, each in kept
        ],
    }
    try:
        write_durably(folder / UNDO_FILE, json.dumps(content, ensure_ascii=False).encode())
    except OSError:
        return


def read_history(session: Session) -> UndoHistory:
    """Return the steps of a session; none where the file is missing, or of another journal."""
    try:
        with (session.folder / UNDO_FILE).open("rb") as stream:
            content = json.loads(stream.read(_LARGEST))
        if content["version"] != _VERSION:
            return UndoHistory()
        deeds = tuple(_deed(each) for each in content["steps"])
        done = int(content["done"])
    except (OSError, ValueError, KeyError, TypeError, RecursionError):
        return UndoHistory()
    records = session.records
    known = all(
        0 < each.first < each.last <= len(records) and records[each.last - 1].hash == each.chain
        for each in deeds
    )
    return UndoHistory(deeds, min(max(done, 0), len(deeds))) if known else UndoHistory()


def _deed(value: dict[str, Any]) -> Deed:
    return Deed(str(value["text"]), int(value["first"]), int(value["last"]), str(value["chain"]))
