"""The steps from a mesh file to a probe, each written down in its history."""

from __future__ import annotations

import hashlib
import warnings
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from contactbench.pipeline.files import File, as_file
from contactbench.pipeline.mesh import MeshWarning
from contactbench.pipeline.mesh.load import probe_of, read_mesh
from contactbench.pipeline.mesh.regions import RegionSet, transfer
from contactbench.pipeline.mesh.shell import Closing, make_shell
from contactbench.pipeline.mesh.sidecar import ProbeFile, load_probe_file, sidecar_of
from contactbench.pipeline.mesh.simplify import Count, MaxDeviation, simplify
from contactbench.pipeline.preparation.alignment import AlignmentError

if TYPE_CHECKING:
    import os
    from collections.abc import Callable, Mapping, Sequence

    from contactbench.pipeline.mesh import Probe
    from contactbench.pipeline.mesh.regions import RegionReport, Transferred
    from contactbench.pipeline.mesh.shell import Shell
    from contactbench.pipeline.mesh.simplify import Engine, Simplified, Target
    from contactbench.pipeline.mesh.units import Units
    from contactbench.pipeline.preparation.alignment import Alignment

    Progress = Callable[[float], None] | None
    Cancel = Callable[[], bool] | None


def import_mesh(path: str | os.PathLike[str], units: Units | Literal["auto"] = "auto") -> ProbeFile:
    """
    Read a mesh file of any kind; one that contactbench wrote brings its regions and its history.

    Parameters
    ----------
    path : str or path
    units : {"auto", "mm", "m", "cm", "in"}
        See `load_probe`. Not asked for a file that contactbench wrote: it is in metres.

    Returns
    -------
    ProbeFile
        Its notes say how the unit was found, where that is not certain, and what is wrong with the mesh.

    Raises
    ------
    MeshError
        See `load_probe`.
    """
    file = as_file(path)
    read = read_mesh(file, units)
    if read.raw.settled:
        known = load_probe_file(file)
        if known.history:
            return known
        # Saved by hand, or its JSON file was lost: in metres all the same.
        return ProbeFile(
            known.probe, known.regions, known.frame, (_origin(file, known, "m", ""),), known.notes
        )
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", MeshWarning)
        probe = probe_of(file, read)
    notes = (*read.notes, *probe.health.sentences)
    found = ProbeFile(probe, RegionSet.from_labels(probe.region), notes=notes)
    reason = "" if read.guess is None else read.guess.reason
    return ProbeFile(
        probe, found.regions, history=(_origin(file, found, read.units, reason),), notes=found.notes
    )


def shell_step(
    content: ProbeFile,
    closings: Closing | Sequence[Closing],
    *,
    alpha: float | None = None,
    gap: float | None = None,
    progress: Progress = None,
    cancelled: Cancel = None,
) -> tuple[ProbeFile, Shell]:
    """Make the outer shell; lengths in metres; see `make_shell` for the rest and for what it raises."""
    shell = make_shell(
        content.probe, closings, alpha=alpha, coarse=gap, progress=progress, cancelled=cancelled
    )
    asked = [closings] if isinstance(closings, Closing) else closings
    parameters = {
        "closings": [closing.value for closing in asked],
        "alpha_mm": None if alpha is None else 1e3 * alpha,
        "gap_mm": None if gap is None else 1e3 * gap,
    }
    return content.after("shell", shell.probe, parameters, shell.to_json()), shell


def align_step(content: ProbeFile, alignment: Alignment, *, again: bool = False) -> ProbeFile:
    """
    Move the probe from the mesh's frame P to the sensor frame S.

    Parameters
    ----------
    content : ProbeFile
    alignment : Alignment
    again : bool
        Move a probe that is in S already: then the alignment is a correction within S.

    Raises
    ------
    AlignmentError
        The probe is in S already, and `again` was not said.
    MeshError
        See `Alignment.place`.
    """
    refuse_aligned(content, again=again)
    parameters: dict[str, Any] = {"method": alignment.method.value, "T_SP_m": alignment.T_SP.tolist()}
    result = {
        "sigmas_mm": None if alignment.sigmas_mm is None else alignment.sigmas_mm.tolist(),
        "sigmas_deg": None if alignment.sigmas_deg is None else alignment.sigmas_deg.tolist(),
        "residual_mm": None if alignment.residual_m is None else 1e3 * alignment.residual_m,
        "warnings": list(alignment.warnings),
    }
    return content.after("align", alignment.place(content.probe), parameters, result, frame="S")


def refuse_aligned(content: ProbeFile, *, again: bool) -> None:
    """
    Refuse to align what is aligned.

    Raises
    ------
    AlignmentError
    """
    if content.frame == "S" and not again:
        raise AlignmentError(
            "the probe is already in the sensor frame and would be moved twice. Start from the"
            " mesh before alignment, or mark this as a correction (again)."
        )


def simplify_step(
    content: ProbeFile,
    target: Target,
    *,
    stated: Mapping[str, Any] | None = None,
    engine: Engine = "auto",
    region_ratio: float = 1.0,
    progress: Progress = None,
    cancelled: Cancel = None,
) -> tuple[ProbeFile, Simplified, tuple[RegionReport, ...]]:
    """
    Give the probe fewer facets.

    Parameters
    ----------
    content : ProbeFile
    target : Target
    stated : mapping, optional
        How to write the target down; left out for a `Count` or a `MaxDeviation`.
    engine, region_ratio, progress, cancelled
        See `simplify`, also for what it raises.

    Returns
    -------
    ProbeFile
    Simplified
    tuple of RegionReport
        What became of the area of each region.
    """
    done = simplify(
        content.probe,
        target,
        engine=engine,
        region_ratio=region_ratio,
        progress=progress,
        cancelled=cancelled,
    )
    parameters = {
        **(_target(target) if stated is None else stated),
        "engine": engine,
        "region_ratio": region_ratio,
    }
    carried = _carried(content, done.probe)
    result = {
        "facets": done.count,
        "engine": done.engine,
        "deviation": done.deviation.to_json(),
        "regions": {str(rank): part.to_json() for rank, part in done.regions.items()},
        "carried": [report.to_json() for report in carried.report],
        "steps": list(done.steps),
    }
    after = content.after("simplify", done.probe, parameters, result, regions=carried.regions)
    return after, done, carried.report


def _carried(content: ProbeFile, probe: Probe) -> Transferred:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", MeshWarning)  # a region that vanished is told by its report
        return transfer(content.regions, content.probe, probe)


def _target(target: Target) -> dict[str, Any]:
    if isinstance(target, Count):
        return {"facets": target.facets}
    if isinstance(target, MaxDeviation):
        return {"max_deviation_mm": 1e3 * target.metres}
    return {"max_error": target.limit}


def _origin(file: File, content: ProbeFile, units: str, reason: str) -> dict[str, Any]:
    """Write down where the history begins: the file, by its content."""
    size = np.ptp(content.probe.bounds, axis=0)
    step = content.after(
        "import",
        content.probe,
        {
            "file": file.name,
            "sha256": hashlib.sha256(file.read_bytes()).hexdigest(),
            "units": units,
            "beside": sidecar_of(file).exists(),
        },
        {"why_units": reason, "size_mm": [round(1e3 * float(x), 6) for x in size]},
    ).history[-1]
    return dict(step)
