"""Undoing in a session whose journal only grows: what was there before is added once more."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, TypeVar

from pydantic_core import PydanticUndefined, to_jsonable_python

from contactbench.pipeline.errors import arg, message
from contactbench.pipeline.session.recompute import RECOMPUTE
from contactbench.pipeline.session.state import MESH

if TYPE_CHECKING:
    from collections.abc import Callable

    from contactbench.pipeline.session import Session, State
    from contactbench.pipeline.session.state import Input, Result

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

    @property
    def empty(self) -> bool:
        """Whether nothing happened that could be taken back."""
        return not (self.settings or self.inputs or self.results)

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
                put_result(session, before)
        for before_input, after in self.inputs.values():
            if before_input is None:
                session.note(
                    message(
                        f"Undone: adding {arg(after.kind)} {arg(after.name)}. It stays in the session, unused."
                    )
                )
            else:
                put_input(session, before_input)
        for key, (value, _) in self.settings.items():
            session.set_parameter(key, value)

    def redo(self, session: Session) -> None:
        """Put there again what the action left."""
        for key, (_, value) in self.settings.items():
            session.set_parameter(key, value)
        for _, after in self.inputs.values():
            put_input(session, after)
        for _, after_result in self.results.values():
            put_result(session, after_result)


def observed(action: Callable[[Session], T]) -> Callable[[Session], tuple[T, SessionChange]]:
    """Return an action that also tells what it did."""

    def run(session: Session) -> tuple[T, SessionChange]:
        before = session.state
        result = action(session)
        return result, change_between(before, session.state)

    return run


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


def put_result(session: Session, result: Result) -> None:
    """Add a result that the session had once more, from its own files, and say of it what was said last."""
    action = result.action
    files = {name: (session.folder / ref.path).read_bytes() for name, ref in action.files.items()}
    session.add_result(
        action.kind, action.name, files, action.inputs, action.parameters, created=action.created
    )
    mark = result.mark
    if mark is not None:
        session.mark(mark.kind, mark.name, mark.mark, mark.reason)


def put_input(session: Session, used: Input) -> None:
    """Add an input that the session had once more, from its own files."""
    companions = {name: session.folder / ref.path for name, ref in used.companions.items()}
    about = {} if used.kind == MESH else used.about
    session.add_input(
        session.folder / used.file.path,
        used.kind,
        name=used.name,
        sensor=used.sensor,
        companions=companions,
        about=about,
    )
