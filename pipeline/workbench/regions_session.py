"""Regions in a session: kept while they are painted, found again, and taken into the probe."""

from __future__ import annotations

import hashlib
from contextlib import suppress
from typing import TYPE_CHECKING

from contactbench.pipeline.errors import InputError, arg, message
from contactbench.pipeline.mesh.regions import RegionSet
from contactbench.pipeline.mesh.regions.exchange import encode_json
from contactbench.pipeline.mesh.regions.history import RegionSteps
from contactbench.pipeline.mesh.sidecar import encode_probe_file
from contactbench.pipeline.preparation.shell_regions import painted_regions
from contactbench.pipeline.session.recompute import inputs_of, recomputed
from contactbench.pipeline.workbench.probe_shell import (
    PROBE,
    REGIONS,
    REGIONS_FILE,
    recipe_of,
    shell_file_of,
)
from contactbench.pipeline.workbench.region_history import (
    read_region_steps,
    regions_digest,
    write_region_steps,
)
from contactbench.pipeline.workbench.regions import RegionsWork

if TYPE_CHECKING:
    from collections.abc import Callable

    from contactbench.pipeline.mesh.regions import RegionReport
    from contactbench.pipeline.mesh.sidecar import ProbeFile
    from contactbench.pipeline.session import Session, State
    from contactbench.pipeline.session.actions import Record
    from contactbench.pipeline.workbench.desk import Desk

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


def open_work(
    desk: Desk,
    progress: Callable[[float], None] | None = None,
    cancelled: Callable[[], bool] | None = None,
) -> RegionsWork:
    """
    Make the session's surface and put its regions on it; takes seconds, so call it in a worker.

    Regions that cannot be put on this surface are left out, and its notes say why: they stay in the session.

    Raises
    ------
    InputError
        There is no mesh, or it cannot be prepared.
    Cancelled
        `cancelled` answered True.
    """
    shell = shell_file_of(
        desk, None if progress is None else lambda share: progress(_SURFACE * share), cancelled
    )
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
        work.model.put_steps(steps)
    work.warm_up()
    if progress is not None:
        progress(1.0)
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


def apply(
    desk: Desk,
    progress: Callable[[float], None] | None = None,
    cancelled: Callable[[], bool] | None = None,
) -> Callable[[Session], Record]:
    """
    Compute the newest probe again with the regions that are kept: ``session compute S probe NAME``.

    It takes long, so call it in a worker; the session is only read.

    Parameters
    ----------
    desk : Desk
    progress, cancelled : callable, optional
        The share that is done, and whether to stop.

    Returns
    -------
    callable
        Records the result: for `Desk.do`.

    Raises
    ------
    InputError
        There is no probe yet, or the computation refuses.
    Cancelled
        `cancelled` answered True; nothing was recorded.
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
    files = recomputed(
        desk.folder,
        state,
        PROBE,
        inputs,
        {**parameters, "name": name},
        None,
        progress=progress,
        cancelled=cancelled,
    )
    return lambda session: session.add_result(PROBE, name, files, inputs, parameters)
