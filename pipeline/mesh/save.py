"""Write a probe so that a power cut leaves the old file or the new one, never half of one."""

from __future__ import annotations

import os
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from pipeline.durable import write_durably
from pipeline.mesh.errors import MeshError
from pipeline.mesh.ply import encode_ply

if TYPE_CHECKING:
    import numpy.typing as npt

    from pipeline.mesh.probe import Probe

# Okabe and Ito's colours, told apart by everybody; their orange is kept for what is invented.
PALETTE = ((86, 180, 233), (0, 158, 115), (240, 228, 66), (0, 114, 178), (213, 94, 0), (204, 121, 167))
_PLAIN, _INVENTED = (200, 200, 200), (230, 159, 0)


def save_probe(probe: Probe, path: str | os.PathLike[str]) -> None:
    """
    Write a probe as binary PLY: metres in S, double coordinates, and the face properties `region` and `invented`.

    ``load_probe(path, units="m")`` gives the same vertices, faces, region and invented, bit for bit. Facets are
    coloured by region, and invented ones apart, so that any viewer shows them.

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
        raise MeshError(f"{file}: a probe is saved as PLY, which keeps its regions: end the name in .ply.")
    try:
        write_durably(file, encode_probe(probe))
    except (OSError, ValueError) as error:  # ValueError: a path that no file system can hold
        raise MeshError(
            f"{file}: the probe cannot be written ({error}): choose a folder that exists, is writable and has"
            " space."
        ) from error


def encode_probe(probe: Probe) -> bytes:
    """Give the bytes that `save_probe` writes; the same probe gives the same bytes."""
    return encode_ply(probe.vertices, probe.faces, probe.region, probe.invented, _colours(probe))


def _colours(probe: Probe) -> npt.NDArray[np.uint8]:
    """Red, green, blue per facet, (m, 3); an invented facet in a region is half of each."""
    colours = np.array([_PLAIN, *PALETTE], dtype=np.uint16)
    colours = colours[np.where(probe.region > 0, 1 + (probe.region - 1) % len(PALETTE), 0)]
    guessed = probe.invented[:, None]
    mixed = np.where((probe.region > 0)[:, None], (colours + _INVENTED) // 2, _INVENTED)
    return np.where(guessed, mixed, colours).astype(np.uint8)
