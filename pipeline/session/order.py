"""Whether what results were computed from was there before them."""

from __future__ import annotations

from typing import TYPE_CHECKING

from pipeline.session.actions import InputAdded, MeshChanged, ResultAdded
from pipeline.session.errors import JournalError
from pipeline.session.identity import content_hash, input_hash

if TYPE_CHECKING:
    from collections.abc import Iterable

    from pipeline.session.actions import Record


def refuse_later_inputs(records: Iterable[Record]) -> None:
    """
    Refuse a result that names something that no earlier record holds.

    No session writes that. In a journal made by hand, results could follow from one another in a circle.

    Raises
    ------
    JournalError
        There is one.
    """
    known: set[str] = set()
    for record in records:
        action = record.action
        if isinstance(action, InputAdded | MeshChanged):
            known.add(input_hash(action.file, action.companions))
        elif isinstance(action, ResultAdded):
            for role, sha256 in action.inputs.items():
                if sha256 not in known:
                    raise JournalError(
                        f"record {record.number}: {role}: no earlier record holds the content {sha256[:12]} that this"
                        " result was computed from: take the session from a backup."
                    )
            known.update(file.sha256 for file in action.files.values())
            known.add(content_hash(action))
