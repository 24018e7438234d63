"""A brush and one stroke of it: facets change at once, and become one step when the stroke is finished."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from contactbench.pipeline.errors import arg
from contactbench.pipeline.mesh.regions.region import RegionError

if TYPE_CHECKING:
    from collections.abc import Callable
    from types import TracebackType

    import numpy.typing as npt

    from contactbench.pipeline.mesh.arrays import Ints, Mask
    from contactbench.pipeline.mesh.regions.facet_graph import FacetGraph


@dataclass(frozen=True)
class Brush:
    """
    How a stroke paints.

    Attributes
    ----------
    radius : float
        In metres, above 0.
    geodesic : bool
        Measured along the surface; otherwise straight through space, but only as far as the facets hang
        together with the stroke within the radius, so that the far side of a thin wall stays clean.
    erase : bool
        Take facets out of their region instead.
    protect : bool
        Facets of other regions stay as they are.

    Raises
    ------
    RegionError
        The radius is not a positive length.
    """

    radius: float
    geodesic: bool = True
    erase: bool = False
    protect: bool = False

    def __post_init__(self) -> None:
        if not (math.isfinite(self.radius) and self.radius > 0):
            raise RegionError(f"the brush has a radius of {arg(self.radius)} m: give a length above 0.")


class Stroke:
    """
    One stroke, from pressing the button to letting it go; made by `RegionModel.stroke`.

    As a context manager it finishes at the end of the block, and aborts when the block raises.
    """

    def __init__(
        self,
        graph: FacetGraph,
        brush: Brush,
        rank: int,
        labels: Ints,
        changed: Callable[[Ints], None],
        ended: Callable[[Ints, Ints], None],
    ) -> None:
        self.brush = brush
        self.rank = rank
        self._graph = graph
        self._labels = labels
        self._changed = changed
        self._ended = ended
        self._faces: list[Ints] = []
        self._old: list[Ints] = []
        self._open = True
        graph.geodesic.begin(brush.radius, brush.geodesic)

    def extend(self, face: int, point: npt.ArrayLike, *, joined: bool = True) -> Ints:
        """
        Go on to a picked point.

        Between two picks the stroke runs along the surface; where no way leads that is not many times
        longer than the straight line, the picks stay apart.

        Parameters
        ----------
        face : int
            The facet that was picked.
        point : (3,) array_like
            Where on it, S, m.
        joined : bool
            False after the pointer left the surface and came back: nothing in between is painted.

        Returns
        -------
        (c,) int32
            Facets whose label changed, ascending.

        Raises
        ------
        RegionError
            The stroke has ended, the facet does not exist, or the point is not finite.
        """
        self._refuse_ended()
        where = np.ascontiguousarray(point, dtype=np.float64)
        if where.shape != (3,) or not np.isfinite(where).all():
            raise RegionError(f"the picked point {arg(where.tolist())} is not a point in space: pick again.")
        fresh = self._graph.geodesic.extend(self._graph.check_face(face), where, joined)
        old = self._labels[fresh]
        changes = self._changes(old)
        faces, old = fresh[changes], old[changes]
        self._labels[faces] = 0 if self.brush.erase else self.rank
        if len(faces):
            self._faces.append(faces)
            self._old.append(old)
            self._changed(faces)
        return faces

    def _changes(self, old: Ints) -> Mask:
        if self.brush.erase:
            return np.equal(old, self.rank) if self.brush.protect else np.not_equal(old, 0)
        return np.equal(old, 0) if self.brush.protect else np.not_equal(old, self.rank)

    def finish(self) -> Ints:
        """End the stroke and make it a step; returns all facets (c,) int32 that changed, ascending."""
        self._refuse_ended()
        self._open = False
        faces, old = self._all()
        self._ended(faces, old)
        return faces

    def abort(self) -> None:
        """End the stroke as if it had never begun."""
        self._refuse_ended()
        self._open = False
        faces, old = self._all()
        self._labels[faces] = old
        self._ended(faces[:0], old[:0])
        if len(faces):
            self._changed(faces)

    def __enter__(self) -> Stroke:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if not self._open:
            return
        if kind is None:
            self.finish()
        else:
            self.abort()

    def _all(self) -> tuple[Ints, Ints]:
        """Return every facet that changed, ascending, and its old label; the kernel covers each only once."""
        if not self._faces:
            nothing = np.empty(0, dtype=np.int32)
            return nothing, nothing
        faces, old = np.concatenate(self._faces), np.concatenate(self._old)
        order = np.argsort(faces)
        return faces[order], old[order]

    def _refuse_ended(self) -> None:
        if not self._open:
            raise RegionError("this stroke has ended: start another one.")
