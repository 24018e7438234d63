"""Regions in a session: kept while they are painted, found again, and taken into the probe."""

import hashlib
import io
import json
import zipfile
from collections.abc import Callable, Iterable, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from contactbench.pipeline.durable import write_durably
from contactbench.pipeline.errors import InputError, arg, message
from contactbench.pipeline.mesh import Probe
from contactbench.pipeline.mesh.monitor import NOBODY, Monitor
from contactbench.pipeline.mesh.regions.exchange import SIZE_LIMIT, encode_json
from contactbench.pipeline.mesh.regions.facet_graph import MeshEdit
from contactbench.pipeline.mesh.regions.model import RegionEdit, RegionSteps
from contactbench.pipeline.mesh.regions.region import Region, RegionSet
from contactbench.pipeline.mesh.regions.transfer import RegionReport
from contactbench.pipeline.mesh.sidecar import ProbeFile, encode_probe_file, load_probe_file
from contactbench.pipeline.preparation.prepare import alignment_of, dense_of, painted_regions, place
from contactbench.pipeline.session import Session, State
from contactbench.pipeline.session.actions import Record
from contactbench.pipeline.session.recompute import ProbeParameters, inputs_of, newest_inputs, recomputed
from contactbench.pipeline.session.state import Result
from contactbench.pipeline.workbench.desk import Desk
from contactbench.pipeline.workbench.regions import RegionsWork

# What changes the number of facets, and not the surface that is painted on.
_AFTER_PAINTING = frozenset(
    {"facets", "max_deviation", "max_contact_error", "forces", "engine", "region_ratio"}
)
# The surface that they were painted on lies beside them under this name: so they outlive changes of it.
_PAINTED = "painted.ply"
# Of the work of opening: the surface.
_SURFACE = 0.8


def surface_key(state: State) -> object:
    """Return what is equal as long as the surface that regions are painted on is the same; None: there is none."""
    recipe = recipe_of(state)
    if recipe is None:
        return None
    inputs = {role: sha for role, sha in recipe.inputs.items() if role != REGIONS}
    parameters = {key: each for key, each in recipe.parameters.items() if key not in _AFTER_PAINTING}
    return (inputs, parameters)


def open_work(desk: Desk, monitor: Monitor = NOBODY) -> RegionsWork:
    """
    Make the session's surface and put its regions on it; takes seconds, so call it in a worker.

    Regions that cannot be put on this surface are left out, and its notes say why: they stay in the session.

    Raises
    ------
    InputError
        There is no mesh, or it cannot be prepared.
    Cancelled
        The caller cancelled.
    """
    shell = shell_file_of(desk, monitor.part(0.0, _SURFACE))
    notes: list[str] = []
    steps = RegionSteps()
    try:
        regions, carried = regions_on(desk, shell)
        if not carried:
            steps = read_region_steps(desk.folder, regions_digest(desk.state))
        else:
            notes.append(
                message("The probe changed after the regions were painted; they were transferred to it.")
            )
            notes += [each.sentence for each in carried if each.vanished]
    except InputError as error:
        regions = shell.regions
        notes.append(message(f"The earlier regions are not shown: {arg(error)}"))
    work = RegionsWork(shell, regions, tuple(notes))
    with suppress(InputError):  # they are of another surface: nothing of it can be undone
        work.put_steps(steps)
    work.warm_up()
    monitor.tell(1.0)
    return work


def regions_on(desk: Desk, shell: ProbeFile) -> tuple[RegionSet, tuple[RegionReport, ...]]:
    """
    Return the session's regions on a shell: as they were painted, or carried over from an older one.

    Parameters
    ----------
    desk : Desk
    shell : ProbeFile
        From `shell_file_of`.

    Returns
    -------
    regions : RegionSet
        Those of the mesh file where nobody painted any.
    carried : tuple of RegionReport
        What carrying over did to each; empty where they are as they were painted.

    Raises
    ------
    InputError
        They do not belong to this surface.
    """
    kept = desk.state.newest(REGIONS)
    if kept is None:
        return shell.regions, ()
    files = inputs_of(desk.folder, desk.state, {REGIONS: kept.content})
    return painted_regions(shell, files[REGIONS])


def keep(session: Session, regions: RegionSet, shell: ProbeFile) -> Record | None:
    """
    Add the regions to a session, unless it has the very same already.

    As ``contactbench session add SESSION regions.json --kind regions --companion painted.ply`` does.

    Parameters
    ----------
    session : Session
        Open for writing.
    regions : RegionSet
        Kept for the shell.
    shell : ProbeFile
        What they are painted on.

    Returns
    -------
    Record or None
        None: nothing was to be added; also where there are no regions and never were any.
    """
    kept = session.state.newest(REGIONS)
    if kept is None and not regions.regions:
        return None
    painted = encode_json(regions, shell.probe)
    if (
        kept is not None
        and kept.slot[1] == REGIONS_FILE
        and kept.file.sha256 == hashlib.sha256(painted).hexdigest()
    ):
        return None
    return session.add_input(
        painted, REGIONS, name=REGIONS_FILE, companions=encode_probe_file(shell, _PAINTED)
    )


def keep_with_steps(
    session: Session, regions: RegionSet, shell: ProbeFile, steps: RegionSteps
) -> Record | None:
    """Add the regions to a session as `keep` does, and write beside it the steps that led to them."""
    record = keep(session, regions, shell)
    write_region_steps(session.folder, steps, regions_digest(session.state))
    return record


def apply(desk: Desk, monitor: Monitor = NOBODY) -> Callable[[Session], Record]:
    """
    Compute the newest probe again with the regions that are kept: ``session compute S probe NAME``.

    It takes long, so call it in a worker; the session is only read.

    Parameters
    ----------
    desk : Desk
    monitor : Monitor

    Returns
    -------
    callable
        Records the result: for `Desk.do`.

    Raises
    ------
    InputError
        There is no probe yet, or the computation refuses.
    Cancelled
        The caller cancelled; nothing was recorded.
    """
    state = desk.state
    recipe, kept = recipe_of(state), state.newest(REGIONS)
    if recipe is None or recipe.result is None:
        raise InputError(
            "There is no probe yet: prepare it in step 3, Probe; the regions will be applied to it."
        )
    name, parameters = recipe.result.action.name, dict(recipe.parameters)
    inputs = {role: sha for role, sha in recipe.inputs.items() if role != REGIONS}
    if kept is not None:
        inputs[REGIONS] = kept.content
    files = recomputed(desk.folder, state, PROBE, inputs, {**parameters, "name": name}, None, monitor=monitor)
    return lambda session: session.add_result(PROBE, name, files, inputs, parameters)


# ---- steps of painting that outlive the window ---------------------------------------------------


REGION_STEPS_FILE = "undo-regions.npz"
_VERSION, _MOST = 1, 200
_MOST_FACETS = 2**20  # of all steps together: written whenever somebody pauses


def write_region_steps(folder: Path, steps: RegionSteps, regions: str) -> None:
    """
    Write steps beside a session's journal; the oldest go where there are too many.

    A disk that takes nothing loses the steps, and nothing else.

    Parameters
    ----------
    folder : path
        Of the session.
    steps : RegionSteps
    regions : str
        SHA-256 of the regions in the session that they led to; see `regions_digest`.
    """
    steps = RegionSteps(_newest(steps.done), _newest(steps.undone))
    edits = (*steps.done, *steps.undone)
    about = {
        "version": _VERSION,
        "regions": regions,
        "done": len(steps.done),
        "steps": [_about(each) for each in edits],
    }
    arrays: dict[str, Any] = {
        "about": np.frombuffer(json.dumps(about, ensure_ascii=False).encode(), dtype=np.uint8),
        "faces": _joined((each.faces for each in edits), np.int32),
        "old": _joined((each.old for each in edits), np.uint8),
        "new": _joined((each.new for each in edits), np.uint8),
    }
    content = io.BytesIO()
    np.savez_compressed(content, allow_pickle=False, **arrays)
    try:
        write_durably(folder / REGION_STEPS_FILE, content.getvalue())
    except OSError:
        return


def read_region_steps(folder: Path, regions: str) -> RegionSteps:
    """
    Return the steps beside a session's journal; none where the file is missing, damaged, or led to other regions.

    Parameters
    ----------
    folder : path
    regions : str
        SHA-256 of the regions that the session has; see `regions_digest`.
    """
    try:
        with (folder / REGION_STEPS_FILE).open("rb") as stream:
            content = io.BytesIO(stream.read(SIZE_LIMIT))
        with np.load(content, allow_pickle=False) as arrays:
            about = json.loads(arrays["about"].tobytes())
            if about["version"] != _VERSION or about["regions"] != regions:
                return RegionSteps()
            faces, old, new = (arrays[name].astype(np.int32) for name in ("faces", "old", "new"))
        edits, begin = [], 0
        for each in about["steps"]:
            end = begin + int(each["facets"])
            edits.append(_edit(each, faces[begin:end], old[begin:end], new[begin:end]))
            begin = end
        done = int(about["done"])
    except (
        OSError,
        EOFError,
        ValueError,
        KeyError,
        TypeError,
        zipfile.BadZipFile,
        InputError,
        RecursionError,
    ):
        return RegionSteps()
    return RegionSteps(tuple(edits[:done]), tuple(edits[done:]))


def regions_digest(state: State) -> str:
    """Return the SHA-256 of the regions that a session keeps; empty: none."""
    kept = state.newest("regions")
    return "" if kept is None else kept.file.sha256


def _newest(edits: Sequence[RegionEdit]) -> tuple[RegionEdit, ...]:
    """Return the last ones that are not too many."""
    kept: list[RegionEdit] = []
    facets = 0
    for each in reversed(edits):
        facets += len(each.faces) + sum(
            8 * len(cut.faces) for cut in (each.there, each.back) if cut is not None
        )
        if len(kept) == _MOST or facets > _MOST_FACETS:
            break
        kept.append(each)
    return tuple(reversed(kept))


def _joined(arrays: Iterable[NDArray[np.int32]], dtype: type[np.generic]) -> NDArray[Any]:
    return np.concatenate([np.empty(0, dtype=np.int32), *arrays]).astype(dtype)


def _about(edit: RegionEdit) -> dict[str, Any]:
    return {
        "text": edit.text,
        "key": edit.key,
        "before": [vars(each) for each in edit.before],
        "after": [vars(each) for each in edit.after],
        "table": None if edit.table is None else edit.table.tolist(),
        "facets": len(edit.faces),
        **{
            name: cut.to_json()
            for name, cut in (("there", edit.there), ("back", edit.back))
            if cut is not None
        },
    }


def _edit(
    about: dict[str, Any], faces: NDArray[np.int32], old: NDArray[np.int32], new: NDArray[np.int32]
) -> RegionEdit:
    before, after = (tuple(Region(**each) for each in about[name]) for name in ("before", "after"))
    table = None if about["table"] is None else np.array(about["table"], dtype=np.int32)
    there, back = (MeshEdit.from_json(about[name]) if name in about else None for name in ("there", "back"))
    key = str(about["key"])
    return RegionEdit(str(about["text"]), before, after, table, faces, old, new, there, back, key)


# ---- the dense, aligned outer surface of a session's probe: what regions are painted on ----------


PROBE, PROBE_FILE = "probe", "probe.ply"
REGIONS, REGIONS_FILE = "regions", "regions.json"


@dataclass(frozen=True, eq=False)
class ProbeRecipe:
    """How the session's probe is made."""

    inputs: Mapping[str, str]  # Role -> hash
    parameters: Mapping[str, Any]  # As `ProbeParameters`, without the name
    result: Result | None = None  # The probe that was made so; None: it is only planned


def recipe_of(state: State) -> ProbeRecipe | None:
    """
    Return how the session's newest probe was made, or else how it would be; None without a mesh.

    What was set since in the session's parameters of the kind ``probe`` counts.
    """
    newest = state.made(PROBE)
    known = ProbeParameters.model_fields
    settings = {name: setting for name, setting in state.named(PROBE).items() if name in known}
    if newest is not None:
        since = {key: each.value for key, each in settings.items() if each.number > newest.number}
        return ProbeRecipe(newest.action.inputs, {**newest.action.parameters, **since}, newest)
    if state.mesh is None:
        return None
    given = {key: each.value for key, each in settings.items()}
    return ProbeRecipe(newest_inputs(state, PROBE), given)


def shell_file_of(desk: Desk, monitor: Monitor = NOBODY) -> ProbeFile:
    """
    Return the surface that regions are painted on, with its history: closed, in S, with all its facets.

    It takes seconds the first time, so call it in a worker; the same mesh and parameters give the same one at once.

    Parameters
    ----------
    desk : Desk
    monitor : Monitor

    Raises
    ------
    InputError
        There is no mesh, or it cannot be prepared.
    Cancelled
        The caller cancelled.
    """
    state = desk.state
    recipe = recipe_of(state)
    if recipe is None:
        raise InputError("There is no probe to paint on: prepare the probe first.")
    if "mesh" not in recipe.inputs:
        raise InputError(
            "This probe was imported, and the session does not have its mesh: choose the mesh in"
            " step 3, Probe, to paint on it."
        )
    wanted = {role: sha for role, sha in recipe.inputs.items() if role in {"mesh", "alignment"}}
    files = inputs_of(desk.folder, state, wanted)
    given = ProbeParameters.checked({**recipe.parameters, "name": PROBE_FILE})
    dense = dense_of(files["mesh"], given, remember=True, monitor=monitor)
    return place(dense, alignment_of(given, files.get("alignment")))


def used_probe(desk: Desk) -> Probe | None:
    """Return the session's probe as it is used; None: there is none."""
    found = used_probe_file(desk)
    return None if found is None else found.probe


def unlike_painted(desk: Desk) -> dict[str, str]:
    """Return what sets the regions of the probe in use apart from what was painted, by the probe's content."""
    made, found = desk.state.made(PROBE), used_probe_file(desk)
    return {} if made is None or found is None else {made.content: " ".join(found.region_warnings)}


def used_probe_file(desk: Desk) -> ProbeFile | None:
    """Return the session's probe as it is used, with its regions and history; None: there is none."""
    recipe = recipe_of(desk.state)
    if recipe is None or recipe.result is None:
        return None
    files = inputs_of(desk.folder, desk.state, {PROBE: recipe.result.content})
    return load_probe_file(files[PROBE])
