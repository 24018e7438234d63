"""The mesh as the edge collapse gets it: centred, 100 units long, on a grid, and clean."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from contactbench.pipeline.mesh.clean import merge_vertices
from contactbench.pipeline.mesh.deviation import doubled_areas
from contactbench.pipeline.mesh.triangles import first_alike

if TYPE_CHECKING:
    import numpy.typing as npt

    from contactbench.pipeline.mesh.probe import Probe

_LENGTH = 100.0

# A metre and a millimetre file of one part differ by rounding, and a difference in the last bit can send the
# collapse down another path. On a grid of 6e-8 of the size both become the same but for one mesh in hundreds.
_GRID = _LENGTH * 2.0**-24

# CAD coordinates are often round numbers: without this shift many would lie halfway between grid points.
_SHIFT = 0.381966

_MERGE = 1e-7 * _LENGTH


@dataclass(frozen=True, eq=False)
class Canonical:
    """
    A mesh in the collapse's unit.

    Attributes
    ----------
    vertices : (n, 3) float64
        From -50 to 50 along the longest axis.
    faces : (m, 3) int32
        No facet twice, none without area.
    centre : (3,) float64
        Middle of the bounding box, metres in S.
    unit : float
        Metres per unit.
    """

    vertices: npt.NDArray[np.float64]
    faces: npt.NDArray[np.int32]
    centre: npt.NDArray[np.float64]
    unit: float

    def back(self, vertices: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
        """Return coordinates in metres in S."""
        return vertices * self.unit + self.centre


def make_canonical(probe: Probe) -> Canonical:
    """
    Scale, centre and clean a probe.

    Unmerged vertices would be taken for holes, and duplicate facets for a third one at an edge, so both are mended
    where the probe has them.

    Parameters
    ----------
    probe : Probe
        Its facets have area.

    Returns
    -------
    Canonical
    """
    centre, unit = probe.bounds.mean(axis=0), probe.size / _LENGTH
    exact = (probe.vertices - centre) / unit
    vertices = _on_grid(exact)
    if not doubled_areas(vertices, probe.faces).all():
        # Facets thinner than the grid: their shape matters more than the last bits.
        vertices = exact
    faces = probe.faces
    if not probe.health.watertight or probe.health.duplicate_facets:
        vertices, faces = merge_vertices(vertices, faces, _MERGE)
        faces = faces[doubled_areas(vertices, faces) > 0]
        faces = faces[first_alike(np.sort(faces, axis=1)) == np.arange(len(faces))]
    return Canonical(vertices, faces, centre, unit)


def _on_grid(exact: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
    # In place: each temporary of a million vertices is 12 MB.
    grid = exact / _GRID
    grid += _SHIFT
    np.rint(grid, out=grid)
    grid -= _SHIFT
    grid *= _GRID
    return grid
