"""All words of the view: they find their places together, and lead to their points by a line where they are off."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from vtkmodules.vtkCommonDataModel import vtkPolyData
from vtkmodules.vtkRenderingCore import vtkActor2D, vtkPolyDataMapper2D

from contactbench.widgets.scene.label_places import BESIDE, Word, label_places
from contactbench.widgets.scene.shapes import segments
from contactbench.widgets.scene.stage import rgb

if TYPE_CHECKING:
    from collections.abc import Sequence

    from contactbench.widgets.scene.label import Label
    from contactbench.widgets.scene.stage import SceneStage


class LabelBoard:
    """
    Places labels in a frame.

    Layers tell their labels with `want`, and what must not be covered with `keep_free`; then `place` does it.
    """

    def __init__(self, stage: SceneStage) -> None:
        self._stage = stage
        self._wanted: list[tuple[int, int, Label, float, float, int, int]] = []
        self._free: list[tuple[float, float, float, float]] = []
        self._before: object = None
        self._mapper = vtkPolyDataMapper2D()
        self._mapper.SetInputData(vtkPolyData())
        self._lines: Any = vtkActor2D()
        self._lines.SetMapper(self._mapper)
        self._lines.GetPositionCoordinate().SetCoordinateSystemToDisplay()
        stage.live.AddViewProp(self._lines)

    def dress(self) -> None:
        """Take the theme's colours."""
        self._lines.GetProperty().SetColor(*rgb(self._stage.colours.text))
        self._lines.GetProperty().SetLineWidth(self._stage.ratio)

    def want(self, label: Label, x: float, y: float, visible: bool, rank: int) -> None:
        """Have a label stand beside a place, device pixels; the lower the rank, the surer it is shown."""
        if visible and label.written:
            self._wanted.append((rank, len(self._wanted), label, x, y, label.width, label.height))
        else:
            label.hide()

    def keep_free(self, x: float, y: float, radius: float) -> None:
        """Have no label stand on a disc, device pixels."""
        self._free.append((x - radius, y - radius, x + radius, y + radius))

    def place(self, size: tuple[int, int], covered: Sequence[tuple[float, float, float, float]] = ()) -> None:
        """Place all labels in a picture of a size, and not below what lies over it; the next frame begins anew."""
        wanted = sorted(self._wanted, key=lambda each: each[:2])
        before, self._before = self._before, (tuple(wanted), tuple(self._free), tuple(covered), size)
        if before == self._before:  # as under the brush: then no frame is spent on it
            self._wanted, self._free = [], []
            return
        words = [Word(x, y, wide, high, label.plain, label.place) for _, _, label, x, y, wide, high in wanted]
        free = np.array([*self._free, *covered], float).reshape(-1, 4)
        leaders: list[tuple[float, float, float]] = []
        for (_, _, label, x, y, *_), found in zip(
            wanted, label_places(words, free, size, self._stage.ratio), strict=True
        ):
            if found is None:
                label.hide()
                continue
            left, top, label.place = found
            label.stand(left, top, size[1])
            if label.place >= BESIDE:
                near_x = float(np.clip(x, left, left + label.width))
                near_y = float(np.clip(y, top, top + label.height))
                leaders += [(x, size[1] - y, 0.0), (near_x, size[1] - near_y, 0.0)]
        self._mapper.SetInputData(segments(np.array(leaders).reshape(-1, 3)))
        self._lines.SetVisibility(bool(leaders))
        self._wanted, self._free = [], []
