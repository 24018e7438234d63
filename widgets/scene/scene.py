"""One persistent 3D view: the probe in its sensor's frame, what touches it, and where it should be touched."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from PySide6.QtCore import QEvent, QPointF, QRect, Qt, Signal
from PySide6.QtGui import QGuiApplication, QHideEvent, QImage, QPixmap, QResizeEvent, QShowEvent
from PySide6.QtWidgets import QWidget
from vtkmodules.vtkRenderingCore import vtkRenderer

from contactbench.pipeline.colour_ramp import ColourScale
from contactbench.widgets.messages import number
from contactbench.widgets.scene.contact_layer import ContactLayer, ErrorLayer, ForceLayer, TouchErrors
from contactbench.widgets.scene.label_board import LabelBoard
from contactbench.widgets.scene.legend import ColourBar, KeySign, ScaleBar, SceneKey, ViewButtons
from contactbench.widgets.scene.marker_layer import BrushLayer, MarkerLayer
from contactbench.widgets.scene.pose_layer import PlaceHandle, PoseLayer
from contactbench.widgets.scene.probe_layer import ProbeLayer, limits_of
from contactbench.widgets.scene.smooth import Ahead, Prepared
from contactbench.widgets.scene.stage import SceneStage, homogeneous, rgb
from contactbench.widgets.scene.view import FramePacer, SceneView, StillPicture
from contactbench.widgets.scene.views import VIEWS, Eye, Mouse, Pick, SceneLook, Screen
from contactbench.widgets.theme import colours as theme_colours
from contactbench.widgets.theme import is_dark

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from contactbench.pipeline.mesh import Probe
    from contactbench.pipeline.mesh.regions.region import Region

__all__ = ["Pick", "Scene"]

_MARGIN = 12
_WIDE = 560  # px: of a view that has its legend beside it, and not below


class Scene(QWidget):
    """
    The 3D view. Lengths in m, forces in N, all in S unless said otherwise; only the GUI thread may use it.

    Methods change it in place and ask for one redraw, at most 30 times a second.
    """

    picked = Signal(object)  # Pick, on a click without a drag
    hovered = Signal(object)  # Pick or None
    brush_began = Signal(object, object)  # Pick, Qt.KeyboardModifiers; only while the tool is "brush"
    brush_moved = Signal(object)  # Pick or None where the pointer left the probe
    brush_ended = Signal()
    brush_scaled = Signal(int)  # +1 or -1: Ctrl + wheel
    handle_moved = Signal(object)  # (4, 4), S, m: where the mouse has put the handle
    handle_dropped = Signal()
    dropped = Signal(object)  # Path of a file that was dropped on it
    camera_moved = Signal()  # by the user or by look(); not by set_camera()
    drawn = Signal(float)  # a frame was drawn, in so many ms

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setAccessibleName(self.tr("3D view of the probe"))
        self._closed = False
        self._fitted = self._held = False
        self._rough = False  # the picture that is kept has edges that are not smoothed
        self.view = SceneView(self)
        self._live = vtkRenderer()
        self._layers()
        self._children()
        self.set_dark(is_dark())

    def _layers(self) -> None:
        window, still = self.view.ren_win, self.view.renderer
        window.SetNumberOfLayers(2)
        self._live.SetLayer(1)
        self._live.InteractiveOff()
        self._live.PreserveDepthBufferOn()
        self._live.SetActiveCamera(still.GetActiveCamera())
        self._live.SetLightCollection(still.GetLights())
        self._live.AutomaticLightCreationOff()
        # Not in the first frame, which makes ready all that draws: in two halves the window stands still for less.
        self._live.DrawOff()
        window.AddRenderer(self._live)
        self._pacing = FramePacer(self.view, self)
        self._pacing.drawn.connect(self.drawn)
        self._pacing.settled.connect(self._refine)
        self._pacing.beat.connect(self._beat)
        self.ahead = Ahead(self._prepared, self)
        self.stage = SceneStage(still, self._live, self.redraw)
        self.probe_layer = ProbeLayer(self.stage)
        self._force = ForceLayer(self.stage)
        self._contact = ContactLayer(self.stage)
        self._markers = MarkerLayer(self.stage)
        self._errors = ErrorLayer(self.stage)
        self._board = LabelBoard(self.stage)
        self._field_bar: tuple[str, ColourScale, float | None] | None = None
        self._region_signs: tuple[KeySign, ...] = ()
        self._poses, self.handle = PoseLayer(self.stage), PlaceHandle(self.stage)
        self._brush = BrushLayer(self.stage)
        self._still = StillPicture(window, still)
        self._eye = Eye(self.view, self.stage, self.probe_layer, self._poses)
        self.view.stage_hands = self

    def _children(self) -> None:
        self.buttons = ViewButtons(self)
        self.scale_bar, self.colour_bar, self.key = ScaleBar(self), ColourBar(self), SceneKey(self)
        self.buttons.chosen.connect(self._look_as_asked)
        self.buttons.perspective.connect(self.set_perspective)
        self.view.dropped.connect(self.dropped)
        self.mouse = Mouse(self)
        self.view.mouse = self.mouse

    # ---- the probe ---------------------------------------------------------------------------------

    def show_probe(
        self, probe: Probe | None, colours: NDArray[np.uint8] | None = None, regions: Sequence[Region] = ()
    ) -> None:
        """
        Show another probe, with a colour (m, 3) per facet, or else in those of its regions; the view stays.

        Invented facets are hatched, those that nothing can touch are crossed out; beside the view stands what that
        means, with the names of the regions that are given, in the order of their ranks.
        """
        named = [(region.name, region.colour) for region in regions]
        if colours is None and probe is not None and probe.region.any():
            # not before there is a probe: the window opens sooner without it
            from contactbench.pipeline.mesh.colours import facet_colours

            colours = facet_colours(
                probe.region, np.zeros(len(probe.faces), bool), [each[1] for each in named]
            )
        self._region_signs = tuple(KeySign("area", name, colour) for name, colour in named)
        self.probe_layer.show(probe, colours)
        self._field_bar = None
        self._poses.show_stand_in(probe is None)
        self._brush.show(None, None)
        self.ahead.begin(None if self._closed else probe)
        if probe is not None:
            self.stage.size = probe.size
            self._poses.size()
            self._markers.dress()
            if self.view.software and self._pacing.moving:
                self.probe_layer.set_coarse(True, at_once=True)
            # what is not needed for the first frame is made after it
            self._pacing.later([self.probe_layer.build_picker])
            if not self._fitted:
                self._fitted = True
                self._set_look(self._eye.fit("oblique"))
        self._tell_legend()
        self.stage.stir()

    def paint(self, faces: NDArray[np.int32] | None, colours: NDArray[np.uint8]) -> None:
        """Give facets other colours: (c, 3) of the given ones, or (m, 3) of all."""
        if self.probe_layer.paint(faces, colours):
            self.stage.stir()
        else:
            self.redraw()

    def show_untouchable(self, faces: NDArray[np.int32]) -> None:
        """Cross out other facets (c,) than those that the probe says nothing can touch."""
        self.probe_layer.cross(faces)
        self._tell_legend()
        self.stage.stir()

    def show_overlay(self, probe: Probe | None, opacity: float = 0.25) -> None:
        """Show a second mesh, see-through, such as the original beside the simplified one."""
        self.probe_layer.show_overlay(probe, opacity)
        self.stage.stir()

    def show_field(
        self,
        values: NDArray[np.float64] | None,
        title: str = "",
        scale: ColourScale | None = None,
        on: Probe | None = None,
    ) -> None:
        """
        Show a scalar per vertex (n,) as colours with a bar beside the view; None: none. NaN stays plain.

        The vertices are those of the probe that is shown, or of `on`: its surface in other facets.
        """
        scale = scale or (limits_of(values) if values is not None else ColourScale())
        self.probe_layer.show_field(values, scale, on)
        shown = values is not None and self.probe_layer.probe is not None
        finite = values[np.isfinite(values)] if values is not None else np.zeros(0)
        largest = float(finite.max()) if len(finite) else None
        self._field_bar = (title, scale, largest) if shown else None
        self._tell_legend()
        self.stage.stir()

    # ---- what happens to it ------------------------------------------------------------------------

    def show_force(self, force: NDArray[np.float64] | None, at: NDArray[np.float64] | None = None) -> None:
        """Show the force on the probe as an arrow whose tip is at a point; without one, at the sensor's origin."""
        self._force.show(force, at)
        self.redraw()

    def show_contact(
        self,
        point: NDArray[np.float64] | None,
        covariance: NDArray[np.float64] | None = None,
        normal: NDArray[np.float64] | None = None,
        candidates: NDArray[np.float64] | None = None,
        captions: tuple[str, str] = ("", ""),
        sure: str = "",
    ) -> None:
        """
        Show the contact as a disc of the 95 % ellipse, and candidates (k, 3) that are rivals to it as hollow rings.

        Beside the contact stands how sure it is; beside the first candidate the first of the captions, or the second
        where it is behind the probe.
        """
        probe = self.probe_layer.probe
        normals = None if probe is None else probe.normals
        picker = self.probe_layer.picker
        self._contact.show(point, covariance, normal, candidates, captions, picker, normals, sure)
        self.redraw()

    def show_markers(
        self,
        points: NDArray[np.float64],
        names: Sequence[str] = (),
        states: Sequence[str] = (),
        next_one: int | None = None,
        tints: Sequence[str] = (),
        worst: int | None = None,
    ) -> None:
        """
        Show markers (k, 3) with names; states "open", "done" or "failed"; the next one pulses at 1 Hz.

        They have the colours of their states, or tints ``#rrggbb``; the name of the worst is always seen.
        """
        self._markers.show(points, names, states, next_one, tints, worst)
        self._start_pulse()
        self.redraw()

    def show_errors(self, touches: TouchErrors | None) -> None:
        """Show how far touches were located from their markers; how many times as long is said beside the view."""
        probe = self.probe_layer.probe
        self._errors.show(touches, self.probe_layer.picker, None if probe is None else probe.normals)
        self._eye.also = self._errors.tips
        self._tell_legend()
        self.redraw()

    def bring_into_view(self, point: NDArray[np.float64]) -> None:
        """Look at all of the probe from where a point of its surface is seen best; z stays up."""
        if not self._held:
            self.move_camera(self._eye.facing(point))

    # ---- how it stands -----------------------------------------------------------------------------

    def show_orientation(
        self, R_WS: NDArray[np.float64] | None, p_WS_W: NDArray[np.float64] | None = None
    ) -> None:
        """Show the tool as it stands in the world, and where (3,), m; None: show it in S."""
        self.stage.turn_to(homogeneous(R_WS, p_WS_W))
        self._poses.show_orientation(R_WS is not None, self.tr("down"))
        self._moves()
        self.stage.stir()

    def show_ghost(self, R: NDArray[np.float64] | None, p: NDArray[np.float64] | None = None) -> None:
        """Show the tool see-through as it should be held next, R_WS, or its mesh where it would lie, R and p, m."""
        shown = R is not None
        self._poses.show_ghost(
            homogeneous(R, p) if shown else None, self.probe_layer.likeness() if shown else None
        )
        self.redraw()

    def show_handle(self, R: NDArray[np.float64] | None, p: NDArray[np.float64] | None = None) -> None:
        """Show axes that the mouse moves and turns, by R at p, m; see `handle_moved`. None: hide them."""
        self.handle.show(None if R is None else homogeneous(R, p))
        self.redraw()

    def show_phantom(
        self, point: NDArray[np.float64] | None, normal: NDArray[np.float64] | None = None
    ) -> None:
        """Show a plane of soft tissue."""
        self._poses.show_phantom(point, normal)
        self.redraw()

    # ---- how it is looked at ----------------------------------------------------------------------

    def look(self, view: str) -> None:
        """Look from "front", "side", "top" or "fit" (only fits the size), unless the view is held."""
        if view not in (*VIEWS, "fit"):
            raise ValueError(f"There is no view {view!r}: choose one of {', '.join((*VIEWS, 'fit'))}.")
        if not self._held:
            self.move_camera(self._eye.fit(None if view == "fit" else view))

    def hold(self, camera: tuple[tuple[float, float, float], ...]) -> None:
        """Look as `camera` said, whatever is shown, until it is released or somebody moves the view."""
        self.set_camera(camera)
        self._held = True

    def release(self) -> None:
        """Let pages choose the view again."""
        self._held = False

    def _look_as_asked(self, view: str) -> None:
        self.release()
        self.look(view)

    def set_perspective(self, perspective: bool) -> None:
        """Choose between the parallel view, in which lengths are true, and the perspective one."""
        if perspective != self._eye.look.perspective:
            self.move_camera(self._eye.with_perspective(perspective))

    def set_tool(self, tool: str, brush_radius: float = 0.0) -> None:
        """Choose what the left button does: "turn", "pick" or "brush" (which shows a circle of the radius)."""
        cursors = {"turn": Qt.CursorShape.ArrowCursor, "pick": Qt.CursorShape.CrossCursor}
        if tool not in (*cursors, "brush"):
            raise ValueError(f"There is no tool {tool!r}: choose turn, pick or brush.")
        self.mouse.tool = tool
        self.view.setCursor(cursors.get(tool, Qt.CursorShape.CrossCursor))
        self._brush.set_radius(brush_radius if tool == "brush" else 0.0)
        self.redraw()

    def camera(self) -> tuple[tuple[float, float, float], ...]:
        """Return position, focal point and up, and how large and in which way, for another scene."""
        return self._eye.look.tuples()

    def set_camera(self, camera: tuple[tuple[float, float, float], ...]) -> None:
        """Look as `camera` said."""
        self._fitted = True
        self._set_look(SceneLook.of(camera, self._eye.look))

    def set_dark(self, dark: bool) -> None:
        """Choose the theme."""
        colours = theme_colours(dark)
        self.stage.colours = colours
        self._poses.dark = dark
        self.view.renderer.SetBackground(*rgb(colours.background))
        for part in (self.buttons, self.scale_bar, self.colour_bar, self.key):
            part.dress(colours)
        self._dress()

    def picture(self) -> NDArray[np.uint8]:
        """Return what is seen, (h, w, 3)."""
        image = self.grab().toImage().convertToFormat(QImage.Format.Format_RGB888)
        rows = np.frombuffer(image.constBits(), np.uint8).reshape(image.height(), image.bytesPerLine())
        return rows[:, : 3 * image.width()].reshape(image.height(), image.width(), 3).copy()

    def photo(self) -> QPixmap:
        """Return what is seen, with its legend and without its buttons."""
        self.buttons.hide()
        try:
            return self.grab()
        finally:
            self.buttons.show()

    def copy_picture(self) -> None:
        """Put what is seen into the clipboard, as `photo` has it."""
        QGuiApplication.clipboard().setPixmap(self.photo())

    def close_scene(self) -> None:
        """Give everything of VTK back; the widget is of no use afterwards."""
        if self._closed:
            return
        self._closed = True
        self._pacing.close()
        self.ahead.close()
        self.mouse.stop()
        self.view.mouse = self.view.stage_hands = None
        window = self.view.ren_win
        window.MakeCurrent()
        self._still.close()
        self._live.RemoveAllViewProps()
        window.RemoveRenderer(self._live)
        self.view.close()
        self.view.ren_win = None

    # ---- what the mouse asks for -------------------------------------------------------------------

    def projection(self) -> Screen:
        """Return the camera with the size of the picture, device pixels."""
        return self._eye.screen()

    def pick_at(self, place: QPointF) -> Pick | None:
        """Return what is seen at a place of the view, in pixels of Qt."""
        return self._eye.pick(place)

    def move_camera(self, look: SceneLook) -> None:
        """Look otherwise, and tell it."""
        self._held = False
        self._set_look(look)
        self._moves()
        self.camera_moved.emit()

    def show_brush(self, pick: Pick | None) -> None:
        """Show the brush's circle on the surface."""
        self._pacing.brisk = self.mouse.painting
        self._brush.show(pick, self.probe_layer.probe)
        self.redraw()

    def settle(self) -> None:
        """Draw all facets again, shortly after the last movement."""
        self._pacing.settle()

    def redraw(self) -> None:
        """Ask for a frame; they come no more often than 30 times a second, nor than they can be drawn."""
        self._pacing.redraw()

    # ---- a frame -----------------------------------------------------------------------------------

    def before(self) -> None:
        """Get everything into its place; the view calls it before VTK draws."""
        self._pacing.begin()
        self.mouse.apply_drag()
        ratio = self.view.devicePixelRatioF()
        if ratio != self.stage.ratio:
            self.stage.ratio = ratio
            self._dress()
        screen = self.projection()
        self._eye.aim()
        self._markers.label(screen, self._eye.sees, self._board)
        self._contact.label(screen, self._eye.sees, self._board)
        self._errors.label(screen, self._board)
        self._poses.label(screen, self._board)
        self._board.place((screen.width, screen.height), self._covered(ratio))
        self.scale_bar.setVisible(not self._eye.look.perspective)
        self.scale_bar.set_scale(screen.metres_per_pixel * ratio)
        fresh = self.probe_layer.fresh.actor if self.probe_layer.take_fresh() else None
        key: object = (screen, self._eye.reach, self.stage.version)
        if not self.view.software or self.probe_layer.coarse:
            key = None  # a graphics card draws all, and any a likeness, faster than a picture is copied
        still = [*(shape.actor for shape in self.probe_layer.shapes), *self._poses.still]
        whole = self._still.prepare(key, still, fresh)
        # Without a graphics card edges are smoothed once all is at rest: it costs as much as a frame of few facets.
        smooth = self.view.software and whole and key is not None and not self._pacing.moving
        self.view.renderer.SetUseFXAA(smooth)
        self._rough = self.view.software and not smooth and (whole or self._rough or fresh is not None)
        if fresh is not None:
            self._pacing.settle()  # what was painted has smooth edges once nobody paints

    def after(self) -> None:
        """Put back what was hidden for the frame."""
        self._still.finish(self.probe_layer.fresh.actor)
        if not self._live.GetDraw():
            self._live.DrawOn()
            self.redraw()

    # ---- the rest ----------------------------------------------------------------------------------

    def _dress(self) -> None:
        probe, contact, markers = self.probe_layer, self._contact, self._markers
        for layer in (
            probe,
            self._force,
            contact,
            markers,
            self._errors,
            self._poses,
            self._brush,
            self._board,
        ):
            layer.dress()
        self.handle.dress(self._poses.dark)
        self.stage.stir()

    def _set_look(self, look: SceneLook) -> None:
        self._eye.look = look
        self.buttons.buttons["perspective"].setChecked(look.perspective)
        self.redraw()

    def _moves(self) -> None:
        """Let a likeness of few facets stand in while all moves, where drawing them takes too long."""
        if self.view.software and self.probe_layer.set_coarse(True):
            self.stage.stir()
        self._pacing.settle()

    def _refine(self) -> None:
        if self.mouse.dragging or self.mouse.painting:
            self._pacing.settle()
        elif self.probe_layer.set_coarse(False) or self._rough:
            self.stage.stir()

    def _prepared(self, prepared: Prepared) -> None:
        self.probe_layer.take(prepared)
        self._tell_legend()
        self.stage.stir()

    def _beat(self) -> None:
        self._markers.pulse()
        self.redraw()

    def _start_pulse(self) -> None:
        self._pacing.set_pulse(self._markers.pulses and self.isVisible())

    def _tell_legend(self) -> None:
        """Have beside the view what is needed to read it, and no more."""
        touches, bar = self._errors.touches, self._field_bar
        if touches is not None and bar is None:
            bar = (
                self.tr("error, mm"),
                ColourScale(1e3 * touches.top or 1e-3),
                1e3 * float(touches.sizes.max()),
            )
        if bar is not None:
            self.colour_bar.tell(*bar)
        self.colour_bar.setVisible(bar is not None)
        signs = [*self._region_signs, *self._surface_signs(), *self._error_signs()]
        self.key.tell(signs)
        self.key.setVisible(bool(signs))
        self._arrange()

    def _surface_signs(self) -> list[KeySign]:
        lines, pale, crossed = self.probe_layer.marked
        known = (
            (lines, KeySign("lines", self.tr("made up: hatched"))),
            (pale, KeySign("pale", self.tr("made up: seam"))),
            (crossed, KeySign("crossed", self.tr("untouchable: crossed"))),
        )
        return [sign for there, sign in known if there]

    def _error_signs(self) -> list[KeySign]:
        touches = self._errors.touches
        if touches is None:
            return []
        times = number(self._errors.times, "g")
        signs = [KeySign("arrow", self.tr("error, {times} times").format(times=times))]
        if touches.covariances is not None and np.isfinite(touches.covariances).any():
            signs.append(KeySign("ellipse", self.tr("95 % of noise, {times} times").format(times=times)))
        if touches.rivals is not None and len(touches.rivals):
            signs.append(KeySign("ring", self.tr("possible alternative")))
        return signs

    def _arrange(self) -> None:
        """Have the view, and beside or below it what is read with it; over it only what can be pressed."""
        shown = [part for part in (self.colour_bar, self.key) if not part.isHidden()]
        lying = self.width() < _WIDE
        room = self.rect()
        if shown and not lying:
            sizes = [part.wanted(False, 0) for part in shown]
            wide = max(size.width() for size in sizes) + _MARGIN
            top = _MARGIN
            for part, size in zip(shown, sizes, strict=True):
                part.setGeometry(self.width() - wide, top, wide - _MARGIN, size.height())
                top += size.height() + _MARGIN
            room.setWidth(self.width() - wide)
        elif shown:
            sizes = [part.wanted(True, self.width()) for part in shown]
            top = self.height() - sum(size.height() for size in sizes)
            room.setHeight(max(top, 1))
            for part, size in zip(shown, sizes, strict=True):
                part.setGeometry(0, top, size.width(), size.height())
                top += size.height()
        if self.view.geometry() != room:
            self.view.setGeometry(room)
        size, bar = self.buttons.fit(room.width() - 2 * _MARGIN, room.height() - _MARGIN), self.scale_bar
        self.buttons.setGeometry(
            QRect(_MARGIN, room.height() - size.height() - _MARGIN, size.width(), size.height())
        )
        left = self.buttons.geometry().right() + 2 * _MARGIN
        low = room.height() - bar.height() - _MARGIN - 4
        if left + bar.width() > room.width() - _MARGIN:
            left, low = _MARGIN, low - size.height() - _MARGIN
        bar.move(left, low)
        self.buttons.raise_()
        bar.raise_()

    def _covered(self, ratio: float) -> list[tuple[float, float, float, float]]:
        """Return what lies over the view: left, top, right and bottom, device pixels."""
        boxes = [part.geometry() for part in (self.buttons, self.scale_bar) if not part.isHidden()]
        return [(ratio * b.left(), ratio * b.top(), ratio * b.right(), ratio * b.bottom()) for b in boxes]

    def resizeEvent(self, _event: QResizeEvent) -> None:
        """Keep everything in its corner."""
        self._arrange()

    def showEvent(self, _event: QShowEvent) -> None:
        """Go on."""
        self._start_pulse()

    def hideEvent(self, _event: QHideEvent) -> None:
        """Nobody looks: stand still."""
        if hasattr(self, "_pacing"):  # a native window may be hidden while it is still being made
            self._pacing.set_pulse(False)

    def changeEvent(self, event: QEvent) -> None:
        """Follow the theme."""
        if event.type() == QEvent.Type.PaletteChange and hasattr(self, "mouse") and not self._closed:
            self.set_dark(is_dark())
        super().changeEvent(event)
