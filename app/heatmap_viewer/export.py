"""What is saved out of the viewer: pictures and meshes as `contactbench heatmap draw` writes them, and films."""

from __future__ import annotations

from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING

from PySide6.QtCore import QObject
from PySide6.QtWidgets import QFileDialog

from contactbench.pipeline.durable import write_durably
from contactbench.pipeline.errors import InputError, arg

if TYPE_CHECKING:
    from collections.abc import Callable

    from contactbench.app.heatmap_viewer.sources import HeatmapSource
    from contactbench.app.heatmap_viewer.viewer import HeatmapViewer
    from contactbench.pipeline.heatmap.film import FilmSettings
    from contactbench.pipeline.heatmap.selection import Selection

_SUFFIXES = (".png", ".ply", ".glb", ".mp4", ".gif")


class HeatmapExport(QObject):
    """Saves what a viewer shows; of two that are compared, both."""

    def __init__(self, viewer: HeatmapViewer) -> None:
        super().__init__(viewer)
        self._viewer = viewer

    def ask(self, what: str) -> None:
        """Ask where to put a "picture", a "film" or a "mesh", and save it."""
        if not self._viewer.sources:
            return
        filters = {
            "picture": self.tr("Picture (*.png)"),
            "film": ";;".join(self._films()),
            "mesh": self.tr("PLY mesh (*.ply);;Binary glTF (*.glb)"),
        }[what]
        name, chosen = QFileDialog.getSaveFileName(self._viewer, self.tr("Save"), "heatmap", filters)
        if name:
            suffix = chosen.rsplit("*", 1)[-1].rstrip(")")
            file = Path(name)
            self.save(file if file.suffix.lower() in _SUFFIXES else file.with_name(file.name + suffix))

    def _films(self) -> tuple[str, ...]:
        """Return the kinds of film that can be made here: an MP4 needs a program that may be missing."""
        there = find_spec("imageio_ffmpeg") is not None
        return (*((self.tr("MP4 film (*.mp4)"),) if there else ()), self.tr("Animated GIF (*.gif)"))

    def save(self, file: Path) -> None:
        """Save to a file, of the kind that its name says: .png, .ply, .glb, .mp4 or .gif."""
        from contactbench.pipeline.heatmap.film import FilmSettings

        viewer, kind = self._viewer, file.suffix.lower()
        sources = [viewer.source(number) for number in range(viewer.visible())]
        names = (
            [file]
            if len(sources) == 1
            else [file.with_stem(f"{file.stem}-{end}") for end in ("left", "right")]
        )
        film = kind in (".mp4", ".gif")
        chosen = viewer.played_selection if film else viewer.selection
        selections = [chosen(number) for number in range(viewer.visible())]
        settings = FilmSettings(viewer.time.speed_value(), viewer.time.seconds())

        def work(progress: Callable[[float], None], cancelled: Callable[[], bool]) -> list[Path]:
            for number, (source, name, selection) in enumerate(zip(sources, names, selections, strict=True)):

                def told(share: float, number: int = number) -> None:
                    progress((number + share) / len(sources))

                if film:
                    _film(source, selection, settings, name, told, cancelled)
                else:
                    _still(source, selection, name, cancelled)
                told(1.0)
            return names

        viewer.work.start(self.tr("Saving {name}").format(name=file.name), work, self._saved)

    def _saved(self, names: list[Path]) -> None:
        said = self.tr("Saved {names}.").format(names=self.tr(" and ").join(map(str, names)))
        self._viewer.controls.say(said)


def _still(source: HeatmapSource, selection: Selection, file: Path, cancelled: Callable[[], bool]) -> None:
    from contactbench.pipeline.heatmap.files import encode_glb, encode_ply
    from contactbench.pipeline.heatmap.picture import encode_png
    from contactbench.pipeline.heatmap.selection import selected_heatmap
    from contactbench.pipeline.mesh.engines.errors import Cancelled

    made = selected_heatmap(source.probe.probe, source.contacts, selection)
    data = {".png": encode_png, ".ply": encode_ply, ".glb": encode_glb}[file.suffix.lower()](made)
    if cancelled():
        raise Cancelled
    try:
        write_durably(file, data)
    except (OSError, ValueError) as error:
        raise InputError(
            f"{arg(file)}: the heatmap cannot be written ({arg(error)}): choose a folder that exists and is writable."
        ) from error


def _film(
    source: HeatmapSource,
    selection: Selection,
    settings: FilmSettings,
    file: Path,
    progress: Callable[[float], None],
    cancelled: Callable[[], bool],
) -> None:
    from contactbench.pipeline.heatmap.film import write_film
    from contactbench.pipeline.heatmap.playback import Playback

    # one of its own: the window goes on using the other
    playback = Playback(source.probe.probe, source.contacts, selection.bandwidth)
    write_film(file, playback, selection, settings, progress=progress, cancelled=cancelled)
