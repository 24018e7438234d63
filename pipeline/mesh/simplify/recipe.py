"""The ways to simplify a mesh: an engine with settings, in the order in which they are tried."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal, Unpack

from pipeline.mesh import engines

if TYPE_CHECKING:
    import numpy as np
    import numpy.typing as npt

    Mesh = tuple[npt.NDArray[np.float64], npt.NDArray[np.int32]]

# fast-simplification spoils the shape when it is to leave less than a few thousandths of the facets: from a million to
# 500 in one step is seven times as far off, and takes twice as long, as with a stop at 20,000. With less to do the
# stop costs a fifth in RMS.
_STRIDE, _MIDDLE = 300, 20_000

Engine = Literal["auto", "fast-simplification", "meshlab", "best"]


@dataclass(frozen=True)
class Recipe:
    """
    An engine with its settings.

    Attributes
    ----------
    name : str
        For people.
    library : Library
        The engine.
    aggression : float
        fast-simplification: how fast its threshold rises.
    scale : float
        fast-simplification: its thresholds are absolute, so another size is another result, not better or
        worse on the whole.
    careful : bool
        MeshLab: keep topology and normals, and spread vertices evenly in flat parts; slower.
    """

    name: str
    library: engines.Library
    aggression: float = 7.0
    scale: float = 1.0
    careful: bool = False

    def simplify(
        self,
        vertices: npt.NDArray[np.float64],
        faces: npt.NDArray[np.int32],
        count: int,
        **control: Unpack[engines.Control],
    ) -> Mesh:
        """
        Let the engine do it.

        Parameters
        ----------
        vertices : (n, 3) float64
            About 100 units long.
        faces : (m, 3) int32
            Clean.
        count : int
            Facets to reach, fewer than there are.
        **control
            See `engines.run`.

        Returns
        -------
        vertices : (k, 3) float64
            In the same unit.
        faces : (l, 3) int32

        Raises
        ------
        EngineError, Cancelled
            See `engines.run`.
        """
        if self.library is engines.Library.MESHLAB:
            careful = self.careful
            return engines.quadric(
                vertices, faces, count, planar=careful, keep_normals=careful, keep_topology=careful, **control
            )
        if len(faces) > _STRIDE * count:
            vertices, faces = self._fast(vertices, faces, max(_MIDDLE, 2 * count), **control)
        return self._fast(vertices, faces, count, **control)

    def _fast(
        self,
        vertices: npt.NDArray[np.float64],
        faces: npt.NDArray[np.int32],
        count: int,
        **control: Unpack[engines.Control],
    ) -> Mesh:
        if count >= len(faces):
            return vertices, faces
        coarse, facets = engines.fast_quadric(
            vertices * self.scale, faces, count, aggression=self.aggression, **control
        )
        return coarse / self.scale, facets


_FAST = Recipe("fast-simplification", engines.Library.FAST_SIMPLIFICATION)
_LARGER = tuple(
    Recipe(f"fast-simplification at {scale:g}-fold size", engines.Library.FAST_SIMPLIFICATION, scale=scale)
    for scale in (4.0, 16.0)
)
_PRESSED = Recipe("fast-simplification, pressed", engines.Library.FAST_SIMPLIFICATION, aggression=11.0)
_MESHLAB = Recipe("meshlab", engines.Library.MESHLAB)
_CAREFUL = Recipe("meshlab, careful", engines.Library.MESHLAB, careful=True)

# fast-simplification comes first: a tenth of the time, no optional library, and on smooth shapes the smaller
# error.
ORDER: dict[Engine, tuple[Recipe, ...]] = {
    "auto": (_FAST, _CAREFUL, _MESHLAB, _PRESSED),
    "fast-simplification": (_FAST, _PRESSED, _CAREFUL, _MESHLAB),
    "meshlab": (_MESHLAB, _CAREFUL, _FAST, _PRESSED),
    "best": (_FAST, *_LARGER, _MESHLAB, _CAREFUL),
}
