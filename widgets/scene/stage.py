"""Where the layers put what they draw: what stands still below, what lives above, both turned with the tool."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from vtkmodules.vtkRenderingCore import vtkActor, vtkPolyDataMapper

from contactbench.widgets.scene.shapes import matrix
from contactbench.widgets.theme import colours

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from contactbench.widgets.theme import Colours


class SceneStage:
    """
    What all layers share.

    Attributes
    ----------
    still, live : vtkRenderer
        The probe and what hardly ever changes, whose picture may be kept; and what changes with every sample.
    turn : (4, 4)
        Of the tool in the world.
    size : float
        Of the probe, m: what is drawn to be seen, and not to scale, is sized by it.
    version : int
        Grows when what stands still has changed.
    colours : Colours
    ratio : float
        Device pixels per pixel.
    """

    def __init__(self, still: Any, live: Any, redraw: Callable[[], None]) -> None:
        self.still, self.live, self.redraw = still, live, redraw
        self.turn: NDArray[np.float64] = np.eye(4)
        self.size = 0.1
        self.version = 0
        self.colours: Colours = colours(False)
        self.ratio = 1.0

    def stir(self) -> None:
        """Say that what stands still has changed."""
        self.version += 1
        self.redraw()


class Shape:
    """
    One actor that stands in the tool's frame, or in the world's.

    Parameters
    ----------
    stage : SceneStage
    data : vtkPolyData
    live : bool
        Drawn above what stands still, with every redraw.
    turns : bool
        Turns with the tool.
    """

    def __init__(self, stage: SceneStage, data: Any, live: bool = True, turns: bool = True) -> None:
        self.stage, self.turns, self._live = stage, turns, live
        self.mapper = vtkPolyDataMapper()
        self.mapper.SetInputData(data)
        self.mapper.ScalarVisibilityOff()
        self.actor = vtkActor()
        self.actor.SetMapper(self.mapper)
        self.actor.PickableOff()
        self.look = self.actor.GetProperty()
        self._local: NDArray[np.float64] = np.eye(4)
        self._renderer = stage.live if live else stage.still
        self._renderer.AddActor(self.actor)
        self.place()

    def place(self, local: NDArray[np.float64] | None = None) -> None:
        """Put it where `local` (4, 4) says in its frame; None: leave it there, the tool has turned."""
        if local is not None:
            self._local = local
        T = self.stage.turn @ self._local if self.turns else self._local
        self.actor.SetUserMatrix(matrix(T))

    def give(self, data: Any) -> None:
        """Show other geometry."""
        self.mapper.SetInputData(data)

    def show(self, shown: bool = True) -> None:
        """Show or hide it."""
        self.actor.SetVisibility(shown)

    @property
    def shown(self) -> bool:
        """Whether it is shown."""
        return bool(self.actor.GetVisibility())

    def colour(self, colour: str, opacity: float = 1.0) -> None:
        """Colour it, `#rrggbb`."""
        self.look.SetColor(*rgb(colour))
        self.look.SetOpacity(opacity)

    def plain(self) -> None:
        """Show its colour as it is, without shading: what is a sign and not a body."""
        self.look.LightingOff()

    def lift(self, amount: float = 1.0) -> None:
        """Draw it before the surface it lies on, by a share of the depth of all that is seen; 1: before everything."""
        self.mapper.SetResolveCoincidentTopologyToPolygonOffset()
        units = -60000.0 * amount
        self.mapper.SetRelativeCoincidentTopologyPolygonOffsetParameters(0.0, units)
        self.mapper.SetRelativeCoincidentTopologyLineOffsetParameters(0.0, units)

    def remove(self) -> None:
        """Take it off the stage."""
        self._renderer.RemoveActor(self.actor)


def rgb(colour: str) -> tuple[float, float, float]:
    """Return `#rrggbb` as shares of one."""
    return int(colour[1:3], 16) / 255, int(colour[3:5], 16) / 255, int(colour[5:7], 16) / 255
