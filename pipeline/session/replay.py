"""Computing every result once more from raw inputs, and comparing it byte by byte."""

from __future__ import annotations

import hashlib
from dataclasses import dataclass
from enum import StrEnum
from typing import TYPE_CHECKING

from contactbench.pipeline.errors import InputError, arg, message
from contactbench.pipeline.session.actions import TOOL
from contactbench.pipeline.session.recompute import RECOMPUTE, recomputed

if TYPE_CHECKING:
    from collections.abc import Callable

    from contactbench.pipeline.session.state import Result
    from contactbench.pipeline.session.store import Session


class ReplayOutcome(StrEnum):
    """What computing a result again gave."""

    SAME = "same"
    DIFFERENT = "different"
    FAILED = "failed"
    UNKNOWN = "unknown"  # nothing here computes this kind


@dataclass(frozen=True)
class Replayed:
    """One result, computed again."""

    kind: str
    name: str
    number: int  # Of its record
    outcome: ReplayOutcome
    sentence: str  # What came of it


def replay(session: Session, progress: Callable[[int, int], None] | None = None) -> tuple[Replayed, ...]:
    """
    Compute every result of a session again, also replaced and stale ones; adds nothing to it.

    Parameters
    ----------
    session : Session
        Open for reading or writing.
    progress : callable, optional
        Takes the number of results that are done, and of all.

    Returns
    -------
    tuple of Replayed
        Oldest first.
    """
    found = []
    results = session.state.results
    for done, result in enumerate(results, 1):
        outcome, why = _again(session, result)
        found.append(Replayed(*result.slot, result.number, outcome, f"{result.title}: {why}"))
        if progress is not None:
            progress(done, len(results))
    return tuple(found)


def _again(session: Session, result: Result) -> tuple[ReplayOutcome, str]:
    action = result.action
    if action.kind not in RECOMPUTE:
        return ReplayOutcome.UNKNOWN, message(
            "this kind of result cannot be computed here, so it was not compared."
        )
    parameters = {**action.parameters, "name": action.name}
    try:
        files = recomputed(
            session.folder,
            session.state,
            action.kind,
            action.inputs,
            parameters,
            action.created,
            before=result.number,
        )
    except InputError as error:
        return ReplayOutcome.FAILED, message(f"it cannot be recomputed: {arg(error)}")
    differing = sorted(
        name
        for name in files.keys() | action.files.keys()
        if name not in files
        or name not in action.files
        or hashlib.sha256(files[name]).hexdigest() != action.files[name].sha256
    )
    if not differing:
        return ReplayOutcome.SAME, message("identical bytes.")
    older = (
        "" if result.tool == TOOL else message(f" It was made by {arg(result.tool)}, this is {arg(TOOL)}.")
    )
    return ReplayOutcome.DIFFERENT, message(f"different bytes in {arg(', '.join(differing))}.{arg(older)}")
