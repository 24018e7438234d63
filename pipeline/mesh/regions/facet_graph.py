"""A mesh as regions see it: which facets are neighbours, how they lie, and how far it is along the surface."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from contactbench.pipeline.errors import arg
from contactbench.pipeline.kernel import Geodesic, SurfaceIndex
from contactbench.pipeline.mesh.regions.region import RegionError

if TYPE_CHECKING:
    import numpy.typing as npt

    from contactbench.pipeline.mesh.arrays import Floats, Ints, Longs, Mask
    from contactbench.pipeline.mesh.probe import Probe


class FacetGraph:
    """
    Neighbours, normals, areas and distances of a mesh's facets.

    Facets are neighbours when they share an edge, also one of more than two facets. Building takes about
    0.1 s for 300,000 facets; what only some edits need is worked out when it is first asked for.

    Parameters
    ----------
    probe : Probe
        Its vertices and faces count, not its regions.
    """

    def __init__(self, probe: Probe) -> None:
        self.probe = probe
        self.geodesic = Geodesic(probe.vertices, probe.faces)
        self._first, self._second = self.geodesic.neighbours()

    @property
    def facet_count(self) -> int:
        """How many facets there are."""
        return len(self.probe.faces)

    @property
    def neighbours(self) -> tuple[Ints, Ints]:
        """Facets across the edges of facet f: ``second[first[f]:first[f + 1]]``; (m + 1,) and (k,)."""
        return self._first, self._second

    @cached_property
    def pairs(self) -> Longs:
        """Neighbours, each pair once, the lower facet first; (k, 2)."""
        one = np.repeat(np.arange(self.facet_count), np.diff(self._first))
        once = one < self._second
        return np.column_stack((one[once], self._second[once]))

    @cached_property
    def creases(self) -> Floats:
        """Angle between the normals of each pair, rad, (k,): 0 where the surface is flat."""
        # The half-angle form keeps its digits at 0 and at pi, where the cosine alone loses half of them.
        one, other = (self.probe.normals[self.pairs[:, side]] for side in (0, 1))
        half = np.arctan2(np.linalg.norm(one - other, axis=1), np.linalg.norm(one + other, axis=1))
        return 2 * np.asarray(half, dtype=np.float64)

    @cached_property
    def centroids(self) -> Floats:
        """Centroid per facet in S, m, (m, 3)."""
        a, b, c = (self.probe.vertices[self.probe.faces[:, corner]] for corner in range(3))
        centres: Floats = (a + b + c) / 3
        return centres

    @cached_property
    def index(self) -> SurfaceIndex:
        """Where the nearest point of the surface is."""
        return SurfaceIndex(self.probe.vertices, self.probe.faces)

    def pick(self, points: npt.ArrayLike, within: float | None = None) -> tuple[Ints, Floats]:
        """
        Find the points of the surface that are nearest to given ones.

        Parameters
        ----------
        points : (k, 3) array_like
            S, m.
        within : float, optional
            Refuse points that are further from the surface, m.

        Returns
        -------
        faces : (k,) int32
        points : (k, 3) float64
            On these facets.

        Raises
        ------
        RegionError
            A point is further away than `within`.
        """
        rows = np.ascontiguousarray(points, dtype=np.float64).reshape(-1, 3)
        distances, faces, nearest = self.index.closest(rows)
        if within is not None and not (distances <= within).all():
            far = int(np.argmin(distances <= within))
            place = ", ".join(f"{1e3 * value:g}" for value in rows[far])
            raise RegionError(
                f"the point {arg(place)} mm is {arg(1e3 * distances[far]):.3g} mm from the surface, more"
                f" than {arg(1e3 * within):.3g} mm: give a point on the surface, in mm and in the"
                " probe's frame."
            )
        return faces, nearest

    def border_vertices(self, mask: Mask) -> Ints:
        """Vertices between facets of the mask (m,) and others, ascending; the mesh's own rims are not among them."""
        inside = np.zeros(len(self.probe.vertices), dtype=bool)
        outside = np.zeros(len(self.probe.vertices), dtype=bool)
        inside[self.probe.faces[mask]] = True
        outside[self.probe.faces[~mask]] = True
        return np.flatnonzero(inside & outside).astype(np.int32)

    def check_face(self, face: int) -> int:
        """Return the facet number; RegionError if the mesh has no such facet."""
        if not 0 <= face < self.facet_count:
            raise RegionError(
                f"facet {arg(face)} does not exist: they run from 0 to {arg(self.facet_count - 1)}."
            )
        return int(face)
