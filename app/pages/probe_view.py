"""What the scene shows while a probe is prepared."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from contactbench.pipeline.mesh import Probe
    from contactbench.pipeline.preparation.alignment import Alignment
    from contactbench.pipeline.workbench.probe import ProbePreview
    from contactbench.widgets.scene import Scene


@dataclass(frozen=True, eq=False)
class Shown:
    """Meshes that can be shown, all in the same place."""

    original: Probe | None = None  # As the file has it
    dense: Probe | None = None  # The outer surface with all its facets
    alignment: Alignment | None = None  # What took them from the mesh's frame to where they are shown


class ProbeView:
    """
    Shows one mesh, perhaps with the original over it, or with the deviation as colours.

    Parameters
    ----------
    scene : Scene
    title : str
        Of the colours: what they are, with its unit.
    """

    def __init__(self, scene: Scene, title: str) -> None:
        self._scene, self._title = scene, title
        self.shown = Shown()
        self.preview: ProbePreview | None = None
        self.used: Probe | None = None  # the session's
        self.overlay = self.deviation = False
        self._main: Probe | None = None

    def draw(self, *, fit: bool = False) -> None:
        """Show it all; `fit`: so that it fills the view."""
        simplified = None if self.preview is None else self.preview.done.content.probe
        dense, field = self.shown.dense, None
        if self.deviation and self.preview is not None:
            dense, field = self.preview.placed.probe, 1e3 * self.preview.deviation
            main: Probe | None = dense
        else:
            main = simplified or dense or self.used or self.shown.original
        if main is not self._main:
            self._scene.show_field(None)  # it belongs to the mesh before
            self._scene.show_probe(main)
            self._main = main
        self._scene.show_field(field, self._title)
        self._scene.show_overlay(
            self.shown.original if self.overlay and main is not self.shown.original else None
        )
        if fit and main is not None:
            self._scene.look("fit")

    def forget(self) -> None:
        """Take away what only this page shows; another page may show another mesh."""
        self._scene.show_field(None)
        self._scene.show_overlay(None)
        self._main = None
