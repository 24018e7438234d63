"""The heatmap viewer: one or two heatmaps with one camera and one scale, through time."""

from __future__ import annotations

from functools import reduce
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from PySide6.QtCore import QObject, Qt, QTimer
from PySide6.QtGui import QCloseEvent, QDragEnterEvent, QDropEvent, QGuiApplication, QKeySequence, QShortcut
from PySide6.QtWidgets import QFileDialog, QLabel, QStackedWidget, QWidget

from contactbench.app.heatmap_viewer.controls import HeatmapControls, Side
from contactbench.app.jobs import Job, Jobs
from contactbench.pipeline.colour_ramp import ColourScale
from contactbench.pipeline.durable import write_file
from contactbench.pipeline.errors import join, message
from contactbench.pipeline.mesh.formats import SUFFIXES
from contactbench.widgets.controls import beside, column, dropped_files
from contactbench.widgets.messages import translated
from contactbench.widgets.time_bar import TimeBar

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

    from contactbench.pipeline.heatmap.selection import Playback, Selection
    from contactbench.pipeline.settings import ReadingSettings
    from contactbench.pipeline.workbench.heatmap_sources import HeatmapInputs, HeatmapSource, OpenedFiles
    from contactbench.widgets.scene import Pick, Scene

# What computes takes seconds to import: that is done beside the window, when there is something to open.

_PROFILE = 160  # parts of the time and of the forces that are counted
_REDRAW = 15  # ms: several changes become one picture
_KEPT = 8  # playbacks


class HeatmapViewer(QWidget):
    """
    Shows where, when and how hard a probe was touched.

    Attributes
    ----------
    controls : HeatmapControls
    time : TimeBar
    sides : list of Side
        One, and a second once two were compared.
    sources : list of HeatmapSource
    """

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.jobs = Jobs(self)
        self.controls, self.time = HeatmapControls(self), TimeBar(self)
        self.sides = [Side(self)]
        self.sources: list[HeatmapSource] = []
        self._files: HeatmapInputs | None = None
        self._shown = [0, 0]
        self._wanted: dict[int, tuple[HeatmapSource, float]] = {}
        self._making: set[int] = set()
        self._playbacks: dict[tuple[int, float], Playback] = {}
        self.work = ViewerWork(self.jobs, self.controls)
        self._closed = False
        self._camera = OneCamera(self)
        self._saving = HeatmapExport(self)
        self._redraw = QTimer(self, interval=_REDRAW, singleShot=True)
        self._lay_out()
        self._connect()
        self.setAcceptDrops(True)
        self.controls.set_ready(False)
        self.time.setEnabled(False)

    # ---- making ------------------------------------------------------------------------------------

    def _lay_out(self) -> None:
        self._empty = QLabel(
            self.tr(
                "Drop files here: a recording (.mcap) with its calibration (.json) and probe"
                " (.ply),\ncontacts (.csv) with the probe, a verification (.json) with the probe,\nor a"
                " session folder, which contains all of them."
            ),
            self,
        )
        self._empty.setAlignment(Qt.AlignmentFlag.AlignCenter)
        self._empty.setWordWrap(True)
        self._empty.setProperty("role", "muted")
        maps = QWidget(self)
        self._beside = beside(maps, (self.sides[0], 1))
        self._stack = QStackedWidget(self)
        self._stack.addWidget(self._empty)
        self._stack.addWidget(maps)
        left = column(None, (self._stack, 1), self.time, space=0)
        beside(self, (left, 1), self.controls, space=0)

    def _connect(self) -> None:
        controls = self.controls
        controls.changed.connect(self._redraw.start)
        controls.widened.connect(lambda _metres: self._make_all())
        controls.compare.toggled.connect(self._compare)
        controls.reading.changed.connect(self._read_again)
        controls.clock.currentIndexChanged.connect(self._shifted)
        controls.later.valueChanged.connect(self._shifted)
        controls.asked_open.connect(self._ask_open)
        controls.asked_save.connect(self._saving.ask)
        self.time.changed.connect(self._redraw.start)
        self._redraw.timeout.connect(self._show)
        self._join(0)
        for keys, action in (
            ("P", self._play),
            ("Ctrl+O", lambda: self._ask_open(False)),
            ("Ctrl+S", lambda: self._saving.ask("picture")),
            ("Ctrl+Shift+C", self._copy),
        ):
            shortcut = QShortcut(QKeySequence(keys), self)
            shortcut.setContext(Qt.ShortcutContext.WidgetWithChildrenShortcut)
            shortcut.activated.connect(action)
        self.time.play.setToolTip(self.tr("Play or pause the time window (P)."))

    def _join(self, number: int) -> None:
        side = self.sides[number]
        side.chosen.connect(lambda source: self._choose(number, source))
        side.scene.dropped.connect(lambda path: self.open([path]))
        side.pointed.connect(lambda pick: self._read_beside(number, pick))
        self._camera.add(side.scene)

    def _read_beside(self, number: int, pick: Pick | None) -> None:
        """Read the other heatmap at the same place, too, where both are on one probe."""
        here = self.sides[number].playback
        for side in self.sides:
            there = side.playback
            if side is self.sides[number] or here is None or there is None:
                continue
            same = here.probe is there.probe or (
                np.array_equal(here.probe.faces, there.probe.faces)
                and np.array_equal(here.probe.vertices, there.probe.vertices)
            )
            side.read_at(pick if same else None)

    def _copy(self) -> None:
        """Put what is seen into the clipboard; two that are compared side by side."""
        if not self.sources:
            self.controls.say(self.tr("Nothing is shown yet: open files or a session first."))
            return
        for side in self.sides:
            side.scene.buttons.hide()
        QGuiApplication.clipboard().setPixmap(self._stack.grab())
        for side in self.sides:
            side.scene.buttons.show()
        self.controls.say(self.tr("The picture is in the clipboard."))

    def _play(self) -> None:
        if self.time.isEnabled():
            self.time.toggle()

    # ---- opening -----------------------------------------------------------------------------------

    def open(self, paths: Iterable[Path]) -> None:
        """Open files and folders of sessions, beside what is open; what is missing is said."""
        before, given, how = self._files, tuple(paths), self.controls.reading.how()

        def work(progress: Callable[[float], None], cancelled: Callable[[], bool]) -> OpenedFiles:
            from contactbench.pipeline.mesh.monitor import Monitor
            from contactbench.pipeline.workbench.heatmap_sources import open_files, sorted_files

            found = sorted_files(given, before)
            if before is not None and not found.contacts:  # a probe alone: what waited for it is tried again
                found = sorted_files((*(path for _, path in before.contacts), *given), before)
            return open_files(found, how, Monitor(progress, cancelled))

        self.work.start(self.tr("Opening"), work, self._opened)

    def _opened(self, opened: OpenedFiles) -> None:
        from contactbench.pipeline.heatmap.heatmap import default_bandwidth

        known = {source.name for source in self.sources}
        self._files = opened.files
        fresh = [*opened.sources]
        self.sources = [each for each in self.sources if each.name not in {new.name for new in fresh}] + fresh
        said = [*opened.problems, *(note for source in fresh for note in source.notes)]
        if not opened.files.contacts:
            said.append(self.tr("Now add contact data: a recording, contacts or a verification."))
        self.controls.say(join("\n", dict.fromkeys(said)), bad=bool(opened.problems))
        if not fresh:
            return
        first = len(self.sources) - len(fresh)
        self._shown = [first, min(first + 1, len(self.sources) - 1)]
        if not known:
            self.controls.set_bandwidth(max(5e-4, round(default_bandwidth(fresh[0].contacts.sigmas), 4)))
        self._stack.setCurrentIndex(1)
        self.controls.set_ready(True)
        self.time.setEnabled(True)
        self._sources_changed()

    def _read_again(self, how: ReadingSettings) -> None:
        """Read the recordings once more, in another way; what cannot be stays as it was."""
        before = tuple(self.sources)
        if not before:
            return

        def work(progress: Callable[[float], None], cancelled: Callable[[], bool]) -> OpenedFiles:
            from contactbench.pipeline.mesh.monitor import Monitor
            from contactbench.pipeline.workbench.heatmap_sources import read_again

            return read_again(before, how, Monitor(progress, cancelled))

        def came(opened: OpenedFiles) -> None:
            fresh = {source.name: source for source in opened.sources}
            self.sources = [fresh.get(source.name, source) for source in self.sources]
            said = [*opened.problems, *(note for source in opened.sources for note in source.notes)]
            self.controls.say(join("\n", dict.fromkeys(said)), bad=bool(opened.problems))
            self._sources_changed()

        self.work.start(self.tr("Reloading"), work, came)

    def _sources_changed(self) -> None:
        names = [source.name for source in self.sources]
        for number, side in enumerate(self.sides):
            side.set_sources(names, self._shown[number])
        seen = [self.sources[self._shown[number]] for number in range(self.visible())]
        self._one_clock()
        forces = [s.contacts.forces for s in seen if s.contacts.forces is not None]
        largest = float(np.ceil(10 * max(f.max() for f in forces))) / 10 if forces else None
        self.controls.set_forces(largest, None if largest is None else _counted(forces, largest))
        self.controls.set_confidences(all(s.contacts.confidences is not None for s in seen))
        self._make_all()

    def _one_clock(self) -> None:
        """Show how long it all lasts on the one clock, and when how much was touched."""
        seen = [(self.source(number).contacts, self.shift(number)) for number in range(self.visible())]
        duration = max(max(each.duration, float(each.moments[-1])) - shift for each, shift in seen)
        if duration != self.time.slider.limits()[1]:
            self.time.set_duration(duration)
        self.time.slider.set_profile(_counted([each.moments - shift for each, shift in seen], duration))

    def shift(self, number: int) -> float:
        """
        Return what is added to the time that is shown to have a side's own time, s.

        Of two that are compared, the first keeps its clock; the second is moved so that both are touched first at the
        same moment, and by what is asked for. Where it would begin before zero, both are moved.
        """
        if self.visible() == 1:
            return 0.0
        shown = [self.source(side).contacts for side in range(2)]
        aligned = bool(self.controls.clock.currentData())
        second = (shown[1].onset - shown[0].onset if aligned else 0.0) - self.controls.later.value()
        begin = min(0.0, float(shown[0].moments[0]), float(shown[1].moments[0]) - second)
        return (second if number else 0.0) + begin

    def _shifted(self) -> None:
        if self.sources:
            slider = self.time.slider
            before = None if slider.whole() else slider.values()
            self._one_clock()
            if before is not None:  # the window stays where it is, and the second one moves under it
                slider.set_values(*before)
            self._redraw.start()

    def _choose(self, number: int, source: int) -> None:
        self._shown[number] = source
        self._sources_changed()

    def visible(self) -> int:
        """Return how many heatmaps are seen."""
        return 2 if self.controls.compare.isChecked() and len(self.sides) > 1 else 1

    def _compare(self, two: bool) -> None:
        if two and len(self.sides) == 1:
            self.sides.append(Side(self))
            self._beside.addWidget(self.sides[1], 1)
            self._join(1)
        if len(self.sides) > 1:
            self.sides[1].setVisible(two)
        self._camera.join(two)
        if self.sources:
            self._sources_changed()

    def _ask_open(self, session: bool) -> None:
        if session:
            folder = QFileDialog.getExistingDirectory(self, self.tr("Open session folder"))
            names = [folder] if folder else []
        else:
            names, _ = QFileDialog.getOpenFileNames(
                self,
                self.tr("Open recordings, contacts or verifications with probe and calibration"),
                "",
                self.tr("Supported files ({});;All files (*)").format(
                    " ".join(f"*{each}" for each in (".mcap", ".csv", ".json", *SUFFIXES))
                ),
            )
        if names:
            self.open([Path(name) for name in names])

    # ---- showing -----------------------------------------------------------------------------------

    def _make_all(self) -> None:
        """Have every side's contacts spread by the bandwidth that is wanted now."""
        if not self.sources or self._closed:
            return
        for number in range(self.visible()):
            source = self.sources[self._shown[number]]
            self._wanted[number] = (source, self.controls.bandwidth_m())
            self._make(number)
        self._redraw.start()

    def _make(self, number: int) -> None:
        if number in self._making:
            return  # the newest wish is fulfilled when that is done
        source, bandwidth = self._wanted[number]
        key = (id(source), bandwidth)
        kept = self._playbacks.get(key)
        if kept is not None and kept.contacts is source.contacts:  # a number may belong to another one by now
            self._made(number, kept)
            return
        self._making.add(number)

        def done(playback: Playback) -> None:
            while len(self._playbacks) >= _KEPT:
                self._playbacks.pop(next(iter(self._playbacks)))
            self._playbacks[key] = playback
            self._making.discard(number)
            if self._wanted[number] == (source, bandwidth):
                self._made(number, playback)
            else:
                self._make(number)

        def failed(error: BaseException) -> None:
            self._making.discard(number)
            self.work.tell(error)
            if self._wanted[number] != (source, bandwidth):
                self._make(number)

        def work(_progress: Callable[[float], None], _cancelled: Callable[[], bool]) -> Playback:
            from contactbench.pipeline.heatmap.selection import Playback

            return Playback(source.probe.probe, source.contacts, bandwidth)

        self.work.start(self.tr("Computing heatmap"), work, done, failed)

    def _made(self, number: int, playback: Playback) -> None:
        self.sides[number].set_playback(playback)
        if number == 1:
            self._camera.follow_first()
        self._redraw.start()

    def selection(self, number: int = 0) -> Selection:
        """Return what is seen of a side now, on its own clock."""
        return self._selection(number, *self.time.chosen())

    def played_selection(self, number: int = 0) -> Selection:
        """Return all that is played of a side, on its own clock."""
        ends = self.time.played_range()
        if self.visible() == 2 and ends == (None, None):  # both films begin at the same moment
            ends = self.time.slider.limits()
        return self._selection(number, *ends)

    def _selection(self, number: int, *ends: float | None) -> Selection:
        shift = self.shift(number) if self.sources else 0.0
        start, end = (None if each is None else round(each + shift, 3) for each in ends)
        return self.controls.selection(start, end)

    def source(self, number: int) -> HeatmapSource:
        """Return what a side shows."""
        return self.sources[self._shown[number]]

    def _show(self) -> None:
        if self._closed:
            return
        playing = self.time.slider.playhead() is not None
        window = self.time.seconds() if playing else None
        sides = list(enumerate(self.sides[: self.visible()]))
        scales = [side.scale(self.played_selection(number), window) for number, side in sides]
        for number, side in sides:
            side.show_selection(self.selection(number), reduce(ColourScale.joined, scales))

    # ---- dropping and closing ----------------------------------------------------------------------

    def dragEnterEvent(self, event: QDragEnterEvent) -> None:
        """Take files."""
        if event.mimeData().hasUrls():
            event.acceptProposedAction()

    def dropEvent(self, event: QDropEvent) -> None:
        """Open what was dropped."""
        if paths := dropped_files(event):
            self.open(paths)

    def close_viewer(self) -> None:
        """End the work and give the scenes back; it is of no use afterwards."""
        if self._closed:
            return
        self._closed = True
        self.time.stop()
        self._redraw.stop()
        self._camera.join(False)
        self.work.close()
        for side in self.sides:
            side.scene.close_scene()

    def closeEvent(self, event: QCloseEvent) -> None:
        """Close for good."""
        self.close_viewer()
        super().closeEvent(event)


def _counted(parts: list[Any], most: float) -> Any:
    """Return how many of all numbers are in each even part from 0 to the largest; roots, so that few are seen, too."""
    counts, _ = np.histogram(np.concatenate(parts), bins=_PROFILE, range=(0.0, max(most, 1e-9)))
    return np.sqrt(counts)


# ---- two scenes that are looked at in the same way -----------------------------------------------


class OneCamera(QObject):
    """Turns each scene as another one was turned, while they are joined."""

    def __init__(self, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._scenes: list[Scene] = []
        self._joined = False

    def add(self, scene: Scene) -> None:
        """Take one more scene in."""
        self._scenes.append(scene)
        scene.camera_moved.connect(lambda: self._follow(scene))

    def join(self, joined: bool) -> None:
        """Begin to keep them alike, as the first is looked at, or end it."""
        self._joined = joined
        self.follow_first()

    def follow_first(self) -> None:
        """Look everywhere as the first is looked at."""
        if self._scenes:
            self._follow(self._scenes[0])

    def _follow(self, moved: Scene) -> None:
        camera = moved.camera() if self._joined else ()
        for scene in self._scenes:
            if camera and scene is not moved:
                scene.set_camera(camera)


# ---- long work of the viewer ---------------------------------------------------------------------


class ViewerWork(QObject):
    """
    Starts jobs, and shows the newest of them.

    Parameters
    ----------
    jobs : Jobs
    controls : HeatmapControls
        The panel.
    """

    def __init__(self, jobs: Jobs, controls: HeatmapControls) -> None:
        super().__init__(controls)
        self._jobs, self._controls = jobs, controls
        self._running: list[Job] = []
        controls.stop.clicked.connect(self.stop)

    def start(
        self,
        title: str,
        work: Callable[[Callable[[float], None], Callable[[], bool]], Any],
        done: Callable[[Any], None],
        failed: Callable[[BaseException], None] | None = None,
    ) -> None:
        """Do something long; as `Jobs.start`, but nobody is told once the viewer is closed."""
        job = self._jobs.start(title, work, done, failed or self.tell)
        self._running.append(job)
        job.progressed.connect(self._show)
        job.finished.connect(lambda: self._ended(job))
        self._show()

    def stop(self) -> None:
        """Ask all of it to stop."""
        for job in self._running:
            job.cancel()

    def close(self) -> None:
        """Stop it, and tell nobody."""
        self._jobs.let_go()

    def tell(self, error: BaseException) -> None:
        """Say why something did not come to its end."""
        if type(error).__name__ == "Cancelled":  # the pipeline's, which takes long to import
            self._controls.say(self.tr("Stopped; nothing was changed."))
        elif isinstance(error, ValueError | OSError):
            self._controls.say(str(error), bad=True)
        else:
            said = self.tr("Unexpected error: {what}.")
            self._controls.say(said.format(what=translated(error)), bad=True)

    def _show(self, _share: float = 0.0) -> None:
        if self._running and not self._jobs.let_gone:
            self._controls.show_work(self._running[-1].title, self._running[-1].share)

    def _ended(self, job: Job) -> None:
        self._running.remove(job)
        if not self._running and not self._jobs.let_gone:
            self._controls.show_work(None)


# ---- what is saved out of the viewer -------------------------------------------------------------


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
        from contactbench.pipeline.heatmap.picture import FilmSettings, write_film
        from contactbench.pipeline.heatmap.selection import Playback
        from contactbench.pipeline.mesh.monitor import Monitor

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
                    # one of its own: the window goes on using the other
                    playback = Playback(source.probe.probe, source.contacts, selection.bandwidth)
                    write_film(name, playback, selection, settings, monitor=Monitor(told, cancelled))
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
    from contactbench.pipeline.mesh.engines import Cancelled

    made = selected_heatmap(source.probe.probe, source.contacts, selection)
    data = {".png": encode_png, ".ply": encode_ply, ".glb": encode_glb}[file.suffix.lower()](made)
    if cancelled():
        raise Cancelled
    write_file(file, data, what=message("the heatmap cannot be written"))
