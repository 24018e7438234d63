"""How a session computes a probe."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from contactbench.pipeline.session.making import Parameters, check_roles, folder_for, read_parameters
from contactbench.pipeline.settings import ProbeSettings

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping
    from pathlib import Path

    from contactbench.pipeline.mesh.sidecar import ProbeFile

    Progress = Callable[[float], None] | None
    Cancel = Callable[[], bool] | None


class ProbeParameters(ProbeSettings, Parameters):
    """As the options of ``contactbench probe prepare``."""


def probe(
    inputs: Mapping[str, Path],
    parameters: Mapping[str, Any],
    _created: str | None,
    *,
    progress: Progress = None,
    cancelled: Cancel = None,
    remember: bool = False,
) -> dict[str, bytes]:
    """
    Prepare a probe from ``mesh``: the bytes that ``contactbench probe prepare`` writes.

    ``alignment`` and ``regions`` may be left out. See `contactbench.pipeline.preparation.prepare.prepared`.
    """
    from contactbench.pipeline.preparation.prepare import prepared

    check_roles(inputs, "mesh", "alignment", "regions")
    given = read_parameters(ProbeParameters, parameters)
    done = prepared(inputs, given, progress=progress, cancelled=cancelled, remember=remember)
    return probe_files(done.content, given.name)


def probe_files(content: ProbeFile, name: str) -> dict[str, bytes]:
    """Return the files that a probe is kept in, under a name that ends in ``.ply``."""
    from contactbench.pipeline.mesh.sidecar import save_probe_file, sidecar_of

    with folder_for(name, ".ply") as out:
        save_probe_file(content, out)
        return {file.name: file.read_bytes() for file in (out, sidecar_of(out))}
