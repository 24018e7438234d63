"""
The probe that is being prepared, in the session at every stage: its mesh, and all that is chosen of it.

A draft changes no result: what is in use stays so until the draft itself is used. It is one setting, so that undoing a
stage is putting back the value before, and the mesh's file is an input of a kind of its own.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from contactbench.pipeline.errors import InputError, arg
from contactbench.pipeline.preparation.alignment import from_json
from contactbench.pipeline.session.files import digest_of
from contactbench.pipeline.session.why import PROBE_DRAFT
from contactbench.pipeline.workbench.probe import ProbePlan, commit

if TYPE_CHECKING:
    from contactbench.pipeline.session import Session, State
    from contactbench.pipeline.session.actions import Record
    from contactbench.pipeline.session.state import Input
    from contactbench.pipeline.workbench.probe import Mesh, ProbePreview

DRAFT, DRAFT_MESH = PROBE_DRAFT, "draft-mesh"
_LISTS = ("close",)


@dataclass(frozen=True)
class ProbeDraft:
    """What is being prepared."""

    mesh: str  # `Input.content` of its mesh
    name: str  # Of the mesh's file
    plan: ProbePlan


def draft_of(state: State) -> ProbeDraft | None:
    """
    Return the draft of a session; None: there is none.

    Raises
    ------
    InputError
        What the session says of it makes no sense.
    """
    value = state.setting(DRAFT)
    if value is None:
        return None
    try:
        mesh, given = str(value["mesh"]), dict(value["plan"])
        known = state.input_with(mesh)
        name = "" if known is None else known.name
        chosen: dict[str, Any] = {key: tuple(each) if key in _LISTS else each for key, each in given.items()}
        placed = value.get("alignment")
        alignment = None if placed is None else from_json(str(placed).encode(), f"{DRAFT}.alignment")
        plan = ProbePlan(alignment=alignment, painted=bool(value.get("painted", True)), **chosen)
        _ = plan.given  # refused as a computation would
    except (AttributeError, KeyError, TypeError, ValueError) as error:
        if isinstance(error, InputError):
            raise
        raise InputError(
            f"{arg(DRAFT)}: the draft cannot be read ({arg(error)}): choose the mesh again."
        ) from error
    return ProbeDraft(mesh, name, plan)


def keep_draft(session: Session, mesh: Mesh, plan: ProbePlan) -> Record | None:
    """
    Keep what is being prepared; None: the session has the very same.

    Parameters
    ----------
    session : Session
        Open for writing.
    mesh : Mesh
        Its file becomes an input, unless the session has it.
    plan : ProbePlan
    """
    known = _known(session.state, mesh)
    if known is None:
        session.add_input(mesh.file, DRAFT_MESH, name=mesh.file.name, companions=mesh.companions)
        known = session.state.current_inputs[DRAFT_MESH, mesh.file.name]
    value: dict[str, Any] = {
        "mesh": known.content,
        "plan": plan.parameters,
        "alignment": None if plan.alignment is None else plan.alignment.to_json(),
        "painted": plan.painted,
    }
    return None if session.state.setting(DRAFT) == value else session.set_parameter(DRAFT, value)


def use_draft(session: Session, preview: ProbePreview) -> Record:
    """Make a prepared probe the session's, as `commit` does: it is a draft no more."""
    record = commit(session, preview)
    if session.state.setting(DRAFT) is not None:
        session.set_parameter(DRAFT, None)
    return record


def _known(state: State, mesh: Mesh) -> Input | None:
    """Return the session's own copy of a mesh with what belongs to it; None: there is none."""
    beside = {name: digest_of(path)[0] for name, path in mesh.companions.items()}
    for each in reversed(state.inputs):
        there = {name: ref.sha256 for name, ref in each.companions.items()}
        if (each.name, each.file.sha256, there) == (mesh.file.name, mesh.sha256, beside):
            return each
    return None
