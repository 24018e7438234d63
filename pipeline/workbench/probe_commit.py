"""A prepared probe into the session, all or nothing, and back out of it."""

from __future__ import annotations

from dataclasses import dataclass
from datetime import UTC, datetime
from typing import TYPE_CHECKING

from contactbench.pipeline.session.files import chunks_of
from contactbench.pipeline.session.make_probe import probe_files
from contactbench.pipeline.workbench.probe_shell import PROBE, PROBE_FILE
from contactbench.pipeline.workbench.undoing import UNDONE, put_input, put_result

if TYPE_CHECKING:
    from contactbench.pipeline.session import Session, State
    from contactbench.pipeline.session.actions import Record
    from contactbench.pipeline.session.state import Input, Result
    from contactbench.pipeline.workbench.probe import Mesh, Preview

ALIGNMENT, ALIGNMENT_FILE = "alignment", "alignment.json"


@dataclass(frozen=True)
class Before:
    """
    What the session said of the probe at some moment: what undoing brings back.

    Attributes
    ----------
    mesh, alignment : Input or None
    result : Result or None
    """

    mesh: Input | None
    alignment: Input | None
    result: Result | None


def before(state: State) -> Before:
    """Return what a session says of the probe now."""
    return Before(
        state.mesh,
        state.current_inputs.get((ALIGNMENT, ALIGNMENT_FILE)),
        state.current_results.get((PROBE, PROBE_FILE)),
    )


def commit(session: Session, preview: Preview) -> Record:
    """
    Put a prepared probe, and what it was made from, into a session; for `Desk.do`.

    As ``contactbench session add SESSION MESH --kind mesh``, the same of the alignment, and ``contactbench session
    compute SESSION probe probe.ply --set ...`` do, with the same bytes.
    """
    files = files_of(preview)
    session.check_writable()
    inputs = {"mesh": _mesh(session, preview.mesh)}
    if preview.plan.alignment is not None:
        inputs[ALIGNMENT] = _alignment(session, preview.plan.alignment.to_json())
    if preview.regions:
        inputs["regions"] = preview.regions
    now = datetime.now(UTC).strftime("%Y-%m-%dT%H:%M:%SZ")
    return session.add_result(PROBE, PROBE_FILE, files, inputs, preview.plan.parameters, created=now)


def files_of(preview: Preview) -> dict[str, bytes]:
    """Return the probe's files, as a session computes them."""
    return probe_files(preview.done.content, PROBE_FILE)


def _mesh(session: Session, mesh: Mesh) -> str:
    """Make a mesh the one in use, unless it is; return its content."""
    known = session.state.mesh
    same = (
        known is not None
        and known.name == mesh.file.name
        and known.file.sha256 == mesh.sha256
        and set(known.companions) == set(mesh.companions)
    )
    if not same:
        beside = {name: chunks_of(path) for name, path in mesh.companions.items()}
        session.change_mesh(mesh.file.name, chunks_of(mesh.file), beside)
    used = session.state.mesh
    assert used is not None  # noqa: S101  (it was just added)
    return used.content


def _alignment(session: Session, text: str) -> str:
    known = session.state.current_inputs.get((ALIGNMENT, ALIGNMENT_FILE))
    if known is None or (session.folder / known.file.path).read_bytes() != text.encode():
        session.add_input(text.encode(), ALIGNMENT, name=ALIGNMENT_FILE)
    return session.state.current_inputs[ALIGNMENT, ALIGNMENT_FILE].content


def bring_back(session: Session, wanted: Before) -> None:
    """
    Append what makes the session say of the probe what it said before; for `Desk.do`.

    Nothing is ever taken out of a session: where there was no probe, the one that is there is rejected.
    """
    now = before(session.state)
    for used, there in ((wanted.mesh, now.mesh), (wanted.alignment, now.alignment)):
        if used is not None and there is not None and used.content != there.content:
            put_input(session, used)
    if wanted.result is not None:
        put_result(session, wanted.result)
    elif now.result is not None:
        session.mark(PROBE, PROBE_FILE, "rejected", UNDONE)
