"""Which facet is under the pointer: a static cell locator, which answers in microseconds."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from vtkmodules.vtkCommonCore import mutable
from vtkmodules.vtkCommonDataModel import vtkStaticCellLocator

if TYPE_CHECKING:
    from numpy.typing import NDArray


@dataclass(frozen=True, eq=False)
class Pick:
    """A place on the probe under the mouse."""

    face: int
    point: NDArray[np.float64]  # (3,): S, m


def _number(value: float) -> Any:
    """Return a number that VTK writes to; its stubs call it an object."""
    return mutable(value)


class Picker:
    """
    Finds facets on lines of sight, and near points.

    Parameters
    ----------
    data : vtkPolyData
        What the mapper draws: a locator on another copy finds nothing in it.
    """

    def __init__(self, data: Any) -> None:
        self.data = data
        self._locator: Any = None

    def build(self) -> None:
        """Make the locator now, about 0.1 ms per 1,000 facets; otherwise the first question makes it."""
        if self._locator is None:
            self._locator = vtkStaticCellLocator()
            self._locator.SetDataSet(self.data)
            self._locator.BuildLocator()

    def along(self, begin: NDArray[np.float64], end: NDArray[np.float64]) -> Pick | None:
        """Return the first place on a line from `begin` to `end`, S, m."""
        self.build()
        share, part, cell = _number(0.0), _number(0), _number(-1)
        point, inside = [0.0] * 3, [0.0] * 3
        if not self._locator.IntersectWithLine(list(begin), list(end), 0.0, share, point, inside, part, cell):
            return None
        return Pick(int(cell.get()), np.array(point))

    def nearest(self, point: NDArray[np.float64]) -> Pick:
        """Return the place of the surface that is nearest to a point, S, m."""
        self.build()
        found, cell, part, squared = [0.0] * 3, _number(-1), _number(0), _number(0.0)
        self._locator.FindClosestPoint(list(point), found, cell, part, squared)
        return Pick(int(cell.get()), np.array(found))
