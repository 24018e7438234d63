"""Where the mesh lies: from what is asked for in the panel to an alignment."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtWidgets import QGroupBox, QVBoxLayout, QWidget

from contactbench.pipeline.errors import InputError
from contactbench.pipeline.preparation.alignment import from_angles
from contactbench.pipeline.workbench.probe_alignment import (
    back_to_mesh,
    by_axes,
    by_file,
    by_flange,
    by_points,
    by_touches,
    numbers_of,
)
from contactbench.widgets.alignment_panel import AlignmentPanel
from contactbench.widgets.mesh_report import MeshReport

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    import numpy as np
    from numpy.typing import NDArray

    from contactbench.app.pages.probe_stages import ProbeStages
    from contactbench.app.pages.probe_view import Shown
    from contactbench.pipeline.mesh import Probe
    from contactbench.pipeline.preparation.alignment import Alignment


class PlaceSection(QGroupBox):
    """Where the mesh lies in the sensor frame."""

    def __init__(self, stages: ProbeStages, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setTitle(self.tr("3  Alignment with sensor"))
        self._stages, self.panel, self.report = stages, AlignmentPanel(), MeshReport(1)
        layout = QVBoxLayout(self)
        layout.addWidget(self.panel)
        layout.addWidget(self.report)
        stages.begun.connect(self.panel.clear_picks)
        stages.aligned.connect(self.show_alignment)
        panel = self.panel
        panel.numbers_given.connect(self._by_numbers)
        panel.points_given.connect(self._by_points)
        panel.flange_given.connect(self._by_flange)
        panel.shape_given.connect(self._by_shape)
        panel.touches_given.connect(self._by_touches)
        panel.file_given.connect(self._by_file)
        panel.picking.connect(lambda _on: self.choose_tool())

    def choose_tool(self) -> None:
        """Let clicks on the mesh pick places, where places are asked for."""
        self._stages.bench.scene.set_tool("pick" if self.panel.wants_picks else "turn")

    def pick(self, point: NDArray[np.float64], facet: int, shown: Shown) -> None:
        """Take a place on the mesh that was clicked, as it is shown."""
        if self.panel.wants_picks:
            self.panel.pick(back_to_mesh(point, shown.alignment), facet)

    def show_alignment(self, alignment: Alignment | None, notes: tuple[str, ...] = ()) -> None:
        """Show where the mesh lies, and what to know about it."""
        self.panel.show_numbers(numbers_of(alignment))
        said: list[tuple[str, str]] = []
        if alignment is not None:
            said += [("doubt", each) for each in alignment.warnings]
            said += [("note", each) for each in (*notes, *alignment.how)]
        self.report.show_sentences(said)

    # ---- the ways --------------------------------------------------------------------------------

    def _by_numbers(self, numbers: tuple[float, ...]) -> None:
        self._try(lambda: from_angles(list(numbers[:3]), list(numbers[3:])))

    def _by_points(self, pairs: list[tuple[NDArray[np.float64], NDArray[np.float64]]]) -> None:
        self._try(lambda: by_points(pairs))

    def _by_shape(self, lowest_mm: float) -> None:
        mesh = self._mesh()
        if mesh is not None:
            self._work(lambda _progress: (by_axes(mesh, lowest_mm), ()))

    def _by_flange(
        self, facet: int, toward: NDArray[np.float64] | None, clock: float, height_mm: float
    ) -> None:
        mesh = self._mesh()
        if mesh is not None:
            self._work(lambda _progress: (by_flange(mesh, facet, toward, clock, height_mm), ()))

    def _by_touches(self, file: Path) -> None:
        mesh, mount = self._mesh(), self._stages.plan.alignment
        if mesh is not None:
            self._work(lambda progress: by_touches(mesh, file, mount, progress))

    def _by_file(self, file: Path) -> None:
        self._work(lambda _progress: (by_file(file), ()))

    def _mesh(self) -> Probe | None:
        """Return the mesh in its own frame with the facets that are shown: those that were picked."""
        stages = self._stages
        if stages.dense is not None:
            return stages.dense.content.probe
        return None if stages.mesh is None else stages.mesh.original.probe

    def _try(self, align: Callable[[], Alignment]) -> None:
        """Align by what takes no time."""
        try:
            self._stages.put(align())
        except InputError as error:
            self._stages.bar.say(str(error), bad=True)

    def _work(self, align: Callable[[Callable[[float], None]], tuple[Alignment, tuple[str, ...]]]) -> None:
        self._stages.worker.start(
            self.tr("Aligning mesh"),
            lambda progress, _cancelled: align(progress),
            lambda found: self._stages.put(*found),
        )
