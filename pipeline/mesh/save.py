"""Write a probe so that a power cut leaves the old file or the new one, never half of one."""

from __future__ import annotations

import os
from pathlib import Path
from typing import TYPE_CHECKING

from contactbench.pipeline.durable import write_durably
from contactbench.pipeline.errors import arg
from contactbench.pipeline.mesh.colours import facet_colours
from contactbench.pipeline.mesh.errors import MeshError
from contactbench.pipeline.mesh.ply import encode_ply

if TYPE_CHECKING:
    from collections.abc import Sequence

    from contactbench.pipeline.mesh.probe import Probe


def save_probe(probe: Probe, path: str | os.PathLike[str]) -> None:
    """
    Write a probe as binary PLY: metres in S, double coordinates, and the face properties `region` and `invented`.

    ``load_probe(path, units="m")`` gives the same vertices, faces, region, invented and untouchable, bit for bit.
    Facets are coloured by region, and invented ones apart, so that any viewer shows them.

    Parameters
    ----------
    probe : Probe
        What to write; its name is not in the file.
    path : str or path
        Ends in .ply; a file that is there already is replaced in one step.

    Raises
    ------
    MeshError
        Another suffix, or the folder cannot be written; a file that was there is left as it was.
    """
    file = Path(path)
    if file.suffix.lower() != ".ply":
        raise MeshError(
            f"{arg(file)}: a probe is saved as PLY, which keeps its regions: end the name in .ply."
        )
    try:
        write_durably(file, encode_probe(probe))
    except (OSError, ValueError) as error:  # ValueError: a path that no file system can hold
        raise MeshError(
            f"{arg(file)}: the probe cannot be written ({arg(error)}): choose a folder that exists, is writable and has"
            " space."
        ) from error


def encode_probe(probe: Probe, colours: Sequence[str] = ()) -> bytes:
    """
    Give the bytes of a probe's file; the same probe and colours give the same bytes.

    Parameters
    ----------
    probe : Probe
    colours : sequence of str
        ``#rrggbb`` per priority; the palette's where they are left out.
    """
    shown = facet_colours(probe.region, probe.invented, colours)
    return encode_ply(probe.vertices, probe.faces, probe.region, probe.invented, shown, probe.untouchable)
