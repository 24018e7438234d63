"""What can be undone of a session, also after it was opened again: which records each step made."""

import json
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, TypeVar

from pydantic_core import PydanticUndefined, to_jsonable_python

from contactbench.pipeline.durable import write_durably
from contactbench.pipeline.errors import arg, message
from contactbench.pipeline.session import Session, State
from contactbench.pipeline.session.recompute import RECOMPUTE
from contactbench.pipeline.session.state import Input, Result, fold
from contactbench.pipeline.workbench.regions_session import read_region_steps, regions_digest

T = TypeVar("T")
Slot = tuple[str, str]
UNDONE = "undone"


@dataclass(frozen=True)
class SessionChange:
    """What an action did to a session; by it, the action can be taken back and done again."""

    # Key -> value before and after; a setting that was not there has the value that it then stands for
    settings: dict[str, tuple[Any, Any]]
    inputs: dict[Slot, tuple[Input | None, Input]]  # Slot -> input before (None: none) and after
    results: dict[Slot, tuple[Result | None, Result]]  # Slot -> result before (None: none) and after

    def undo(self, session: Session) -> None:
        """
        Put back what was there before; newest first, for a result stands on inputs.

        A result that was the first of its kind is marked as rejected: undone. An input that was the first of its kind
        and name stays, for nothing raw is ever deleted, and a note says so.
        """
        for slot, (before, _) in self.results.items():
            if before is None:
                session.mark(*slot, "rejected", UNDONE)
            else:
                session.add_again(before)
        for before_input, after in self.inputs.values():
            if before_input is None:
                session.note(
                    message(
                        f"Undone: adding {arg(after.kind)} {arg(after.name)}. It stays in the session, unused."
                    )
                )
            else:
                session.add_again(before_input)
        for key, (value, _) in self.settings.items():
            session.set_parameter(key, value)

    def redo(self, session: Session) -> None:
        """Put there again what the action left."""
        for key, (_, value) in self.settings.items():
            session.set_parameter(key, value)
        for _, after in self.inputs.values():
            session.add_again(after)
        for _, after_result in self.results.values():
            session.add_again(after_result)


def change_between(before: State, after: State) -> SessionChange:
    """Return what is another in a session's state."""
    settings = {
        key: (value_in(before, key), setting.value)
        for key, setting in after.settings.items()
        if value_in(before, key) != setting.value
    }
    old_inputs, old_results = before.current_inputs, before.current_results
    inputs = {
        slot: (old_inputs.get(slot), new)
        for slot, new in after.current_inputs.items()
        if old_inputs.get(slot) is None or old_inputs[slot].content != new.content
    }
    results = {
        slot: (old_results.get(slot), new)
        for slot, new in after.current_results.items()
        if old_results.get(slot) != new
    }
    return SessionChange(settings, inputs, results)


def value_in(state: State, key: str) -> Any:
    """Return the value of a setting, or the one that is meant where it was never set; None: nothing."""
    found = state.settings.get(key)
    if found is not None:
        return found.value
    kind, _, parameter = key.partition(".")
    if kind not in RECOMPUTE or parameter not in RECOMPUTE[kind].parameters.model_fields:
        return None
    default = RECOMPUTE[kind].parameters.model_fields[parameter].get_default(call_default_factory=True)
    return None if default is PydanticUndefined else to_jsonable_python(default)


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
class PaintedStep:
    """One step of painting, which the regions' own history takes back and does again."""

    text: str
    key: str  # Of its `RegionEdit`


@dataclass(frozen=True)
class UndoHistory:
    """The steps of a session, oldest first."""

    deeds: tuple[Deed | PaintedStep, ...] = ()
    done: int = 0  # How many of them are done; the others were taken back, and can be done again


def write_history(folder: Path, deeds: Sequence[Deed | PaintedStep], done: int) -> None:
    """
    Write the steps of a session into its folder; those that left nothing are left out.

    A disk that takes nothing loses the steps, and nothing else: the journal is not touched.
    """
    left = max(0, len(deeds) - _MOST)
    kept = [
        (number, each)
        for number, each in enumerate(deeds)
        if number >= left and (isinstance(each, PaintedStep) or each.happened)
    ]
    content = {
        "version": _VERSION,
        "done": sum(number < done for number, _ in kept),
        "steps": [vars(each) for _, each in kept],
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
        if isinstance(each, Deed)
    )
    return _with_painting(session, deeds, done) if known else UndoHistory()


def _with_painting(session: Session, deeds: Sequence[Deed | PaintedStep], done: int) -> UndoHistory:
    """Leave out what was painted and is not in the session: after a kill, this file may be ahead of it."""
    steps = read_region_steps(session.folder, regions_digest(session.state))
    painted = {each.key: True for each in steps.done} | {each.key: False for each in steps.undone}
    kept = [
        (each, number < done if isinstance(each, Deed) else painted[each.key])
        for number, each in enumerate(deeds)
        if isinstance(each, Deed) or each.key in painted
    ]
    there = [is_done for _, is_done in kept]
    if there != sorted(there, reverse=True):  # what was done after something that was taken back
        kept = [(each, number < done) for number, each in enumerate(deeds) if isinstance(each, Deed)]
    return UndoHistory(tuple(each for each, _ in kept), sum(is_done for _, is_done in kept))


def _deed(value: dict[str, Any]) -> Deed | PaintedStep:
    if "key" in value:
        return PaintedStep(str(value["text"]), str(value["key"]))
    return Deed(str(value["text"]), int(value["first"]), int(value["last"]), str(value["chain"]))
