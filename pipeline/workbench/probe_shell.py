"""The dense, aligned outer surface of a session's probe: what regions are painted on."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from contactbench.pipeline.errors import InputError
from contactbench.pipeline.mesh.sidecar import load_probe_file
from contactbench.pipeline.preparation.prepare import alignment_of, dense_of, place
from contactbench.pipeline.session.make import ProbeParameters
from contactbench.pipeline.session.recompute import inputs_of, newest_inputs

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from contactbench.pipeline.mesh import Probe
    from contactbench.pipeline.mesh.sidecar import ProbeFile
    from contactbench.pipeline.session import State
    from contactbench.pipeline.session.state import Result
    from contactbench.pipeline.workbench.desk import Desk

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


def shell_file_of(
    desk: Desk,
    progress: Callable[[float], None] | None = None,
    cancelled: Callable[[], bool] | None = None,
) -> ProbeFile:
    """
    Return the surface that regions are painted on, with its history: closed, in S, with all its facets.

    It takes seconds the first time, so call it in a worker; the same mesh and parameters give the same one at once.

    Parameters
    ----------
    desk : Desk
    progress, cancelled : callable, optional
        The share that is done, 0 to 1, and whether to stop.

    Raises
    ------
    InputError
        There is no mesh, or it cannot be prepared.
    Cancelled
        `cancelled` answered True.
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
    dense = dense_of(files["mesh"], given, remember=True, progress=progress, cancelled=cancelled)
    return place(dense, alignment_of(given, files.get("alignment")))


def used_probe(desk: Desk) -> Probe | None:
    """Return the session's probe as it is used; None: there is none."""
    recipe = recipe_of(desk.state)
    if recipe is None or recipe.result is None:
        return None
    files = inputs_of(desk.folder, desk.state, {PROBE: recipe.result.content})
    return load_probe_file(files[PROBE]).probe
