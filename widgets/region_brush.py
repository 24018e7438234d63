"""The brush: what the mouse does in the scene, as strokes on the regions."""

from PySide6.QtCore import QObject, Qt, Signal

from contactbench.pipeline.mesh.regions.region import RegionError
from contactbench.pipeline.mesh.regions.selections import Brush
from contactbench.pipeline.workbench.regions import RegionsWork
from contactbench.widgets.scene.scene import Pick, Scene

SMALLEST, LARGEST, USUAL = 0.5e-3, 30e-3, 3e-3  # radius, m
STEP = 1.2  # the radius grows by this at each turn of the wheel


class RegionBrush(QObject):
    """
    Strokes drawn in a scene while its tool is "brush".

    Between `take` and `release` it holds the tool. Shift, held when a stroke begins, erases with the brush and
    paints with the eraser.

    Attributes
    ----------
    radius : float
        m; change it by `resize` and `scale`.
    erase, protect : bool
        See `contactbench.pipeline.mesh.regions.Brush`.
    rank : int
        Of the region that is painted; 0: none is chosen, and a stroke says so.
    """

    drawn = Signal(str)  # a stroke has ended; what the step is called
    resized = Signal(float)  # radius, m
    refused = Signal(object)  # why nothing is painted

    def __init__(self, scene: Scene, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._scene = scene
        self._work: RegionsWork | None = None
        self._joined = True
        self.radius, self.rank = USUAL, 0
        self.erase = self.protect = False
        scene.brush_began.connect(self._begin)
        scene.brush_moved.connect(self._move)
        scene.brush_ended.connect(self._end)
        scene.brush_scaled.connect(self.scale)

    def take(self, work: RegionsWork) -> None:
        """Have the left button paint on these regions."""
        self._work = work
        self._scene.set_tool("brush", self.radius)

    def release(self) -> None:
        """Abort a stroke that is being drawn, and paint no more; the scene's tool stays what it is."""
        self.abort()
        self._work = None

    def abort(self) -> bool:
        """Take back the stroke that is being drawn; returns whether there was one."""
        if self._work is None or not self._work.drawing:
            return False
        self._work.abort()
        return True

    def resize(self, radius: float) -> None:
        """Set the radius, m; beyond the limits, the nearest of them."""
        radius = min(max(radius, SMALLEST), LARGEST)
        if radius == self.radius:
            return
        self.radius = radius
        if self._work is not None:
            self._scene.set_tool("brush", radius)
        self.resized.emit(radius)

    def scale(self, turns: int) -> None:
        """Make the brush larger or smaller by so many turns of the wheel."""
        if self._work is not None:
            self.resize(self.radius * STEP**turns)

    # ---- the mouse ---------------------------------------------------------------------------

    def _begin(self, pick: Pick, modifiers: Qt.KeyboardModifier) -> None:
        if self._work is None:
            return
        turned = bool(modifiers & Qt.KeyboardModifier.ShiftModifier)
        erase = self.erase != turned
        brush = Brush(self.radius, erase=erase, protect=self.protect)
        self._work.abort()
        try:
            self._work.begin(brush, self.rank)
        except RegionError:
            self.refused.emit(self.tr("No region selected. Add one or select one in the list, then paint."))
            return
        self._joined = True
        self._extend(pick)

    def _move(self, pick: Pick | None) -> None:
        if self._work is None or not self._work.drawing:
            return
        if pick is None:
            self._joined = False
            return
        self._extend(pick)

    def _extend(self, pick: Pick) -> None:
        if self._work is None:
            return
        try:
            self._work.extend(pick.face, pick.point, joined=self._joined)
        except RegionError as error:
            self._work.abort()
            self.refused.emit(str(error))
        self._joined = True

    def _end(self) -> None:
        if self._work is None:
            return
        text = self._work.finish()
        if text is not None:
            self.drawn.emit(text)
