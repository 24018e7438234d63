"""The probe's surface: a colour per facet, edges, hatching, fields, and a second mesh."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk
from vtkmodules.vtkCommonCore import vtkLookupTable
from vtkmodules.vtkCommonDataModel import vtkPolyData

from contactbench.pipeline.colour_ramp import PLAIN, ColourScale
from contactbench.widgets.scene.smooth import MANY, Prepared, SmoothSurface, crosses, rounded
from contactbench.widgets.scene.stage import SceneStage, Shape, segments, thinned, triangles
from contactbench.widgets.scene.views import Picker

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from contactbench.pipeline.mesh import Probe

_LIFT = 0.001  # of the depth of all: half a millimetre; with more, edges of the far side come through a wall
_NOT_TOO_MANY = 250_000  # facets up to which the window may wait for a likeness


class ProbeLayer:
    """
    Draws the probe.

    Attributes
    ----------
    probe : Probe or None
    picker : Picker or None
        In S.
    bounds : (2, 3)
        In S, m.
    """

    def __init__(self, stage: SceneStage) -> None:
        self._stage = stage
        self.probe: Probe | None = None
        self.picker: Picker | None = None
        self.bounds: NDArray[np.float64] = np.array([[-0.05] * 3, [0.05] * 3])
        self._colours: NDArray[np.uint8] = np.zeros((0, 3), np.uint8)
        self._scalars: Any = None
        self._pending: list[NDArray[np.int32]] = []
        self._kept: NDArray[np.int64] | None = None  # of which facet each of the likeness is one
        self._field_of: tuple[NDArray[np.float64], ColourScale, Probe | None] | None = None
        self._narrow: NDArray[np.bool_] | None = None  # facets that are pale, see `hatch`; None: none
        self._smooth: SmoothSurface | None = None  # None: not known yet, each facet is flat
        self.surface = _surface(stage)
        self._coarse = _surface(stage)
        self.fresh = _surface(stage)  # facets painted since the picture was kept
        self._edges = Shape(stage, vtkPolyData(), live=False)
        self._hatching = Shape(stage, vtkPolyData(), live=False)
        self._crossed = Shape(stage, vtkPolyData(), live=False)
        self._field = _surface(stage)
        self._overlay = _surface(stage)
        self.fresh.show(False)
        self._coarse.show(False)
        for lines in (self._edges, self._hatching, self._crossed):
            lines.plain()
            lines.lift(_LIFT)
        self._field.show(False)
        self._overlay.show(False)
        self._overlay.look.BackfaceCullingOn()
        self.dress()

    @property
    def shapes(self) -> tuple[Shape, ...]:
        """All that stands still."""
        lines = self._edges, self._hatching, self._crossed
        return self.surface, self._coarse, *lines, self._field, self._overlay

    def dress(self) -> None:
        """Take the theme's colours."""
        colours = self._stage.colours
        # not see-through: such lines leave no depth, and what is painted later would cover them
        self._edges.colour("#7d8287")
        # soft: on a narrow seam the lines are short, and black ones look like a fault of the picture
        self._hatching.colour("#6f7478")
        self._crossed.colour("#2b2f33")
        self._overlay.colour(colours.series[5])
        for shape in (self._edges, self._hatching, self._crossed):
            shape.look.SetLineWidth(self._stage.ratio)

    def show(self, probe: Probe | None, colours: NDArray[np.uint8] | None) -> None:
        """Show another probe."""
        self.probe, self._kept, self._smooth, self._pending = probe, None, None, []
        self._field.show(False)
        self._field_of = None
        self._coarse.show(False)
        self.surface.show(probe is not None)
        if probe is None:
            self.picker = None
            for shape in (self.surface, self._edges, self._hatching, self._crossed):
                shape.give(vtkPolyData())
            return
        self.bounds = np.array(probe.bounds)
        data = triangles(probe.vertices, probe.faces)
        self._colours = np.full((len(probe.faces), 3), PLAIN, np.uint8)
        if colours is not None:
            self._colours[:] = colours
        self._scalars = _colour_cells(data, self._colours)
        self.surface.give(data)
        self.picker = Picker(self.surface.mapper.GetInput())
        self._edges.give(vtkPolyData())
        self._hatching.give(vtkPolyData())
        self._narrow = None
        self.cross(np.flatnonzero(np.isin(probe.region, probe.untouchable)))

    def cross(self, faces: NDArray[np.intp] | NDArray[np.int32]) -> None:
        """Cross out the facets (c,) that nothing can touch, and no others."""
        if self.probe is not None:
            self._crossed.give(crosses(self.probe, faces) if len(faces) else vtkPolyData())

    def take(self, prepared: Prepared) -> None:
        """Take what was computed of the probe that is shown."""
        if self.probe is not prepared.probe:
            return
        self._edges.give(segments(prepared.creases))
        self._smooth = smooth = prepared.smooth
        data = triangles(prepared.probe.vertices[smooth.of], smooth.faces, smooth.normals)
        data.GetCellData().SetScalars(self._scalars)
        self.surface.give(data)
        if self._field.shown and self._field_of is not None:
            self.show_field(*self._field_of)
        self._hatching.give(segments(prepared.hatched))
        if prepared.narrow.any():
            self._narrow = prepared.narrow
            self._make_pale(None)
        if prepared.likeness is not None and self._kept is None:
            self._give_likeness(prepared.likeness)

    def build_picker(self) -> None:
        """Make ready to find facets: about 0.1 ms per 1,000 facets."""
        if self.picker is not None:
            self.picker.build()

    def paint(self, faces: NDArray[np.int32] | None, colours: NDArray[np.uint8]) -> bool:
        """Give facets other colours; return whether so many that all is to be drawn again."""
        if self.probe is None:
            return False
        if faces is None:
            self._colours[:] = colours
            self._make_pale(None)
            self._pending = []
        else:
            self._colours[faces] = colours
            self._make_pale(faces)
            self._pending.append(np.asarray(faces))
        if self._field.shown:
            self._pending = []  # they are seen when the field has gone
        # the array that VTK draws is this one: it only has to hear that it changed
        self._scalars.Modified()
        return faces is None or sum(len(some) for some in self._pending) * 3 > len(self._colours)

    def take_fresh(self) -> bool:
        """Prepare the facets that were painted since the last call to be drawn alone; whether there are any."""
        if not self._pending or self.probe is None:
            return False
        faces = np.unique(np.concatenate(self._pending))
        self._pending = []
        corners = self.probe.vertices[self.probe.faces[faces]].reshape(-1, 3)
        smooth = self._smooth
        normals = None if smooth is None else smooth.normals[smooth.faces[faces]].reshape(-1, 3)
        data = triangles(corners, np.arange(len(corners), dtype=np.int32).reshape(-1, 3), normals)
        _colour_cells(data, self._colours[faces])
        self.fresh.give(data)
        return True

    @property
    def marked(self) -> tuple[bool, bool, bool]:
        """Whether there are facets that are hatched, pale because made up in a narrow seam, and crossed out."""
        hatched, crossed = (
            bool(shape.mapper.GetInput().GetNumberOfCells()) for shape in (self._hatching, self._crossed)
        )
        return hatched, self._narrow is not None, crossed

    @property
    def coarse(self) -> bool:
        """Whether the likeness is shown."""
        return self._coarse.shown

    def set_coarse(self, coarse: bool, at_once: bool = False) -> bool:
        """
        Show a likeness of few facets, where there are many; return whether anything changed.

        One that is not there yet is not waited for, unless it is wanted `at_once`: 10 ms for 100,000 facets, of which
        the first frame takes 75 ms where there is no graphics card.
        """
        if at_once and coarse and self.probe is not None and MANY < len(self.probe.faces) <= _NOT_TOO_MANY:
            self.likeness()
        coarse = coarse and self.probe is not None and self._kept is not None
        if coarse == self._coarse.shown or self._field.shown:
            return False
        if coarse:
            likeness = self.likeness()
            _colour_cells(likeness, self._colours[self._kept])
            self._coarse.give(likeness)
        # two actors, so that neither is sent to the graphics card again
        self._coarse.show(coarse)
        self.surface.show(self.probe is not None and not coarse)
        return True

    def likeness(self) -> Any:
        """Return the surface with few facets; the surface itself where it has few."""
        if self.probe is None or len(self.probe.faces) <= MANY:
            return self._fine()
        if self._kept is None:
            self._give_likeness(thinned(self.probe.vertices, self.probe.faces))
        return self._coarse.mapper.GetInput()

    def _give_likeness(self, made: tuple[NDArray[np.float64], NDArray[np.int32], NDArray[np.int64]]) -> None:
        vertices, faces, self._kept = made
        self._coarse.give(triangles(vertices, faces, rounded(vertices, faces)))

    def _make_pale(self, faces: NDArray[np.int32] | None) -> None:
        """Make narrow patches that were made up pale, of all facets or of these (c,): lines would look like cracks."""
        if self._narrow is None:
            return
        those = np.flatnonzero(self._narrow) if faces is None else faces[self._narrow[faces]]
        self._colours[those] = (self._colours[those].astype(np.uint16) + 2 * 255) // 3
        self._scalars.Modified()

    def _fine(self) -> Any:
        return self.picker.data if self.picker is not None else vtkPolyData()

    # ---- a second mesh, and fields -----------------------------------------------------------------

    def show_overlay(self, probe: Probe | None, opacity: float) -> None:
        """Show a second mesh, see-through."""
        self._overlay.show(probe is not None)
        self._overlay.give(vtkPolyData() if probe is None else triangles(probe.vertices, probe.faces))
        self._overlay.look.SetOpacity(opacity)

    def show_field(
        self, values: NDArray[np.float64] | None, scale: ColourScale, on: Probe | None = None
    ) -> None:
        """Show a scalar per vertex, of the probe or of `on`, as colours, or the facets' own colours again."""
        shown = values is not None and self.probe is not None
        self._field_of = None if values is None else (values, scale, on)
        self._field.show(shown)
        self._coarse.show(False)
        self.surface.show(self.probe is not None and not shown)
        if values is None or self.probe is None:
            return
        data, given = vtkPolyData(), np.asarray(values, np.float64)
        if on is not None:
            data.ShallowCopy(triangles(on.vertices, on.faces))
        else:
            data.ShallowCopy(self.surface.mapper.GetInput())
            given = given if self._smooth is None else given[self._smooth.of]
        data.GetCellData().SetScalars(None)
        data.GetPointData().SetScalars(numpy_to_vtk(np.ascontiguousarray(given), deep=True))
        mapper = self._field.mapper
        mapper.SetInputData(data)
        mapper.ScalarVisibilityOn()
        mapper.SetScalarModeToUsePointData()
        mapper.SetColorModeToMapScalars()
        # the value is interpolated and then coloured: between two corners no colour shows that is not on the bar
        mapper.InterpolateScalarsBeforeMappingOn()
        mapper.SetLookupTable(_table(scale))
        mapper.SetUseLookupTableScalarRange(True)


def _surface(stage: SceneStage) -> Shape:
    shape = Shape(stage, vtkPolyData(), live=False)
    shape.look.SetInterpolationToPhong()
    shape.look.SetAmbient(0.36)
    shape.look.SetDiffuse(0.74)
    shape.look.SetSpecular(0.0)
    # The same corners must fall on the same depths in the whole surface and in a piece of it, and VTK's own
    # shift and scale depend on the extent.
    shape.mapper.SetVBOShiftScaleMethod(0)
    shape.mapper.SetResolveCoincidentTopologyToPolygonOffset()
    shape.mapper.SetRelativeCoincidentTopologyPolygonOffsetParameters(0.0, 0.0)
    shape.mapper.SetScalarModeToUseCellData()
    shape.mapper.SetColorModeToDirectScalars()
    shape.mapper.ScalarVisibilityOn()
    return shape


def _colour_cells(data: Any, colours: NDArray[np.uint8]) -> Any:
    scalars = numpy_to_vtk(np.ascontiguousarray(colours))
    data.GetCellData().SetScalars(scalars)
    return scalars


def _table(scale: ColourScale) -> Any:
    shades = scale.ramp()
    table = vtkLookupTable()
    table.SetNumberOfTableValues(len(shades))
    for i, (red, green, blue) in enumerate(shades):
        table.SetTableValue(i, red, green, blue, 1.0)
    table.SetTableRange(scale.low, scale.top)
    if scale.logarithmic:
        table.SetScaleToLog10()
    table.SetNanColor(PLAIN / 255, PLAIN / 255, PLAIN / 255, 1.0)
    return table


def limits_of(values: NDArray[np.float64]) -> ColourScale:
    """Return the scale from the lowest to the highest finite value, never the same."""
    finite = values[np.isfinite(values)]
    if len(finite) == 0:
        return ColourScale()
    low, high = float(finite.min()), float(finite.max())
    return ColourScale(high if high > low else low + max(abs(low), 1.0) * 1e-3, low)
