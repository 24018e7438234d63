"""The scene's camera among what is shown: how it fits it, which depths it covers, what it sees and what is under it."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from contactbench.widgets.scene.views import SceneLook, Screen, facing, fitted, looking, moved, turned

if TYPE_CHECKING:
    from numpy.typing import NDArray
    from PySide6.QtCore import QPointF

    from contactbench.widgets.scene.picker import Pick
    from contactbench.widgets.scene.pose_layer import PoseLayer
    from contactbench.widgets.scene.probe_layer import ProbeLayer
    from contactbench.widgets.scene.stage import SceneStage
    from contactbench.widgets.scene.view import SceneView

_AROUND = 1.25  # room about the probe for the arrow of a force
# Right and down, radians: from where else a point is looked at if something hides it.
_SWINGS = [(turn, tilt) for tilt in (0.0, 0.5, -0.6, -1.2) for turn in (0.0, 0.6, -0.6, 1.2, -1.2, 2.0, -2.0)]
_COVERED = 64.0  # px along the lower edge: buttons and the scale bar


class Eye:
    """
    Looks at the scene.

    Attributes
    ----------
    look : SceneLook
    also : (k, 3)
        What is to be seen beside the probe, S, m.
    reach : float
        How far from the origin there is anything, m; grows and shrinks in steps of two.
    """

    def __init__(self, view: SceneView, stage: SceneStage, probe: ProbeLayer, poses: PoseLayer) -> None:
        self._view, self._stage, self._probe, self._poses = view, stage, probe, poses
        self.also: NDArray[np.float64] = np.zeros((0, 3))
        self.look = looking("oblique", (0.0, 0.0, 0.0), 0.08)
        self.reach = 0.1

    def screen(self) -> Screen:
        """Return the camera with the size of the picture, device pixels."""
        ratio = self._view.devicePixelRatioF()
        width, height = round(self._view.width() * ratio), round(self._view.height() * ratio)
        return Screen(self.look, max(1, width), max(1, height))

    def aim(self) -> None:
        """Set VTK's camera; its range of depths changes in steps, so that a kept picture stays right."""
        bounds = [
            *self._stage.live.ComputeVisiblePropBounds(),
            *self._stage.still.ComputeVisiblePropBounds(),
        ]
        # what is not there has bounds of 1e299
        far = max([abs(value) for value in bounds if abs(value) < 1e3] + [0.02]) * np.sqrt(3.0)
        self.reach = float(2.0 ** np.ceil(np.log2(far)))
        look, into = self.look, self.look.axes[2]
        middle = -float(np.dot(look.focal, into))
        distance = look.distance
        if not look.perspective:
            # a parallel view is the same from anywhere on the line of sight: stand before everything
            distance = max(2.0 * self.reach - middle, self.reach)
        camera: Any = self._stage.still.GetActiveCamera()
        camera.SetParallelProjection(not look.perspective)
        camera.SetPosition(*(np.asarray(look.focal) - distance * into))
        camera.SetFocalPoint(*look.focal)
        camera.SetViewUp(*look.up)
        camera.SetParallelScale(look.scale)
        near, end = distance + middle - self.reach, max(distance + middle + self.reach, 1e-3)
        # in perspective most of the depth lies just before the camera: it must not begin there
        least = min(0.05 * end, 0.3 * distance) if look.perspective else 1e-6
        camera.SetClippingRange(max(near, least), end)

    def fit(self, view: str | None) -> SceneLook:
        """Return the camera in which all of the probe is seen, from a named side or from where it is."""
        middle, radius = self._ball()
        found = fitted(self.look, middle, radius)
        if view is not None:
            found = looking(view, middle, radius, self.look.perspective)
        high, wide = max(self._view.height(), 1), max(self._view.width(), 1)
        # what lies along the lower edge must not cover it
        covered = min(_COVERED / high, 0.3)
        scale = _AROUND * self._half(found, radius, high / wide) / (1.0 - covered)
        return moved(replace(found, scale=scale), 0.0, -covered * scale)

    def facing(self, point: NDArray[np.float64]) -> SceneLook:
        """Return the camera in which all of the probe is seen, and a point of its surface (3,), S, m, faces it."""
        picker, turn = self._probe.picker, self._stage.turn[:3, :3]
        outward = np.array([0.0, -1.0, 0.0])
        if picker is not None and self._probe.probe is not None:
            outward = self._probe.probe.normals[picker.nearest(point).face]
        whole, before = self.fit(None), self.look
        best = facing(whole, turn @ outward)
        for swing in _SWINGS:  # something may stand before it
            self.look = self._centred(turned(best, *swing))
            if self.sees(point):
                break
        else:
            self.look = self._centred(best)
        found, self.look = self.look, before
        return found

    def _centred(self, look: SceneLook) -> SceneLook:
        """Return a camera that looks in the same direction, with the whole probe as `fit` has it."""
        before, self.look = self.look, look
        found, self.look = self.fit(None), before
        return found

    def with_perspective(self, perspective: bool) -> SceneLook:
        """Return the camera in the other way of looking."""
        return replace(self.look, perspective=perspective)

    def pick(self, place: QPointF) -> Pick | None:
        """Return what is seen at a place of the view, in pixels of Qt."""
        picker = self._probe.picker
        if picker is None:
            return None
        ratio = self._view.devicePixelRatioF()
        begin, end = self.screen().ray(place.x() * ratio, place.y() * ratio, 4.0 * self.reach + 1.0)
        turn, origin = self._stage.turn[:3, :3], self._stage.turn[:3, 3]
        return picker.along(turn.T @ (begin - origin), turn.T @ (end - origin))

    def sees(self, point: NDArray[np.float64]) -> bool:
        """Whether no part of the probe hides a point of S."""
        picker = self._probe.picker
        if picker is None:
            return True
        turn, origin = self._stage.turn[:3, :3], self._stage.turn[:3, 3]
        world = turn @ point + origin
        into = self.look.axes[2]
        if self.look.perspective:
            eye = np.asarray(self.look.focal) - self.look.distance * into
            into = (world - eye) / max(float(np.linalg.norm(world - eye)), 1e-9)
        begin, end = world - 4.0 * self.reach * into, world - 0.01 * self._stage.size * into
        return picker.along(turn.T @ (begin - origin), turn.T @ (end - origin)) is None

    def _half(self, look: SceneLook, radius: float, narrow: float) -> float:
        """Return half of what must be seen from bottom to top: of the probe's box, as it is turned, or of its ball."""
        if self._poses.in_world or look.perspective:
            return radius * max(1.0, narrow)
        low, high = self._probe.bounds
        sides = 0.5 * (high - low)
        beyond = np.abs((self.also - 0.5 * (low + high)) @ look.axes.T)
        right, up, _ = np.maximum(np.abs(look.axes) @ sides, beyond.max(axis=0, initial=0.0))
        return float(max(up, right * narrow, 0.4 * radius))

    def _ball(self) -> tuple[tuple[float, float, float], float]:
        """Return the middle and the radius of what is to be seen: in the world, whichever way the tool is held."""
        low, high = self._probe.bounds
        if self._poses.in_world:
            return (0.0, 0.0, 0.0), float(np.linalg.norm(np.maximum(np.abs(low), np.abs(high))))
        x, y, z = (float(value) for value in 0.5 * (low + high))
        return (x, y, z), float(np.linalg.norm(high - low)) / 2
