"""A soft pad that presses a probe: where its pressure goes, and what that does to the sensor."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from contactbench.pipeline.errors import InputError
from contactbench.pipeline.kernel import SurfaceIndex
from contactbench.pipeline.simulation.reality.real_probe import leaning

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from contactbench.pipeline.simulation.scenes.physics import TrueSurface

    Array = NDArray[np.float64]

_PLACES = 200
_MODULUS = 3e6  # N/m³: 15 mm across, 9 N press it in by 4 mm
_FRICTION = 0.4
_REACH_M = 0.02
_HALVINGS = 60


@dataclass(frozen=True, eq=False)
class PadPress:
    """One press; everything in S."""

    contact: Array  # (6,) what the pad does to the probe, N and N·m about S
    places: Array  # (n, 3) of the surface that it touches, m
    pressures: Array  # (n,) forces along the normals there, N

    @property
    def centre_of_pressure(self) -> Array:
        """Mean of the places by what presses there, (3,), m."""
        return np.asarray(self.pressures @ self.places / self.pressures.sum())


class Pad:
    """
    A round pad on a bed of springs, flat before it is pressed.

    Pressure is ``p = E max(0, d + theta x - g)`` along the surface's normal, g the gap between surface and pad.
    Friction obeys ``|f| <= 0.4 p``; what pulls along the surface comes first, and of what is left a share turns about
    the normal: ``f = -0.4 p share sqrt(1 - (F_t / 0.4 F_n)²) (n x r) / |r|`` (limit surface of Goyal, Ruina and
    Papadopoulos 1991).

    Parameters
    ----------
    radius : float
        m.
    lean : float
        How far the pad stands askew, degrees, and to which azimuth.
    twist : float
        The share, -1 to 1.
    """

    def __init__(
        self, truth: TrueSurface, radius: float, lean: float = 0.0, azimuth: float = 0.0, twist: float = 0.0
    ) -> None:
        self._probe, self._radius, self._twist = truth.probe, radius, twist
        self._lean, self._azimuth = np.radians(lean), azimuth
        self._index = SurfaceIndex(truth.probe.vertices, truth.probe.faces)
        k = np.arange(
            _PLACES // 2
        )  # a sunflower, even over the disc, and its mirror image: the middle is its centre
        r, turn = radius * np.sqrt((k + 0.5) / len(k)), k * np.pi * (3 - np.sqrt(5))
        half = np.column_stack([r * np.cos(turn), r * np.sin(turn)])
        self._disc = np.concatenate([half, -half])

    def press(self, point: Array, normal: Array, force: Array) -> PadPress:
        """
        Press at a point with a force (3,), N, of which the part along the normal is kept; what slips is lost.

        Raises
        ------
        InputError
            The force pulls, or the pad meets no surface.
        """
        push = float(-force @ normal)
        x = leaning(normal, 0.0)
        y = np.cross(normal, x)
        starts = point + self._disc @ np.array([x, y]) + _REACH_M * normal
        down = np.broadcast_to(-normal, starts.shape)
        distances, facets = self._index.first_hit(starts, np.ascontiguousarray(down))
        hit = (facets >= 0) & (distances < 2 * _REACH_M)
        if push <= 0 or not hit.any():
            raise InputError("a soft pad: it meets no surface, or pulls: touch elsewhere, or with less tilt.")
        gaps = distances[hit] - _REACH_M
        normals = self._probe.normals[facets[hit]]
        places = starts[hit] - distances[hit, None] * normal
        tilted = np.tan(self._lean) * (self._disc[hit] @ _bearing(self._azimuth))
        stiffness = _MODULUS * np.pi * self._radius**2 / _PLACES
        facing = np.maximum(normals @ normal, 0.0)
        pressures = _pressed(tilted - gaps, stiffness, facing, push)
        forces = -pressures[:, None] * normals
        forces += self._dragged(pressures, normals, places, force + push * normal, push)
        torque = np.cross(places, forces).sum(axis=0)
        on = pressures > 0
        return PadPress(np.concatenate([forces.sum(axis=0), torque]), places[on], pressures[on])

    def _dragged(
        self, pressures: Array, normals: Array, places: Array, sideways: Array, push: float
    ) -> Array:
        held = _FRICTION * push
        pull = float(np.linalg.norm(sideways))
        share = min(1.0, pull / held)
        slide = pressures[:, None] / pressures.sum() * sideways * min(1.0, held / max(pull, 1e-12))
        turn = np.cross(normals, places - pressures @ places / pressures.sum())
        turn /= np.maximum(np.linalg.norm(turn, axis=1, keepdims=True), 1e-9)
        free = self._twist * np.sqrt(1.0 - share**2)
        return np.asarray(slide - _FRICTION * free * pressures[:, None] * turn)


def _bearing(azimuth: float) -> Array:
    return np.array([np.cos(np.radians(azimuth)), np.sin(np.radians(azimuth))])


def _pressed(heights: Array, stiffness: float, facing: Array, push: float) -> Array:
    """Return pressures (n,), N, that push together along the pad's axis; by halving the depth."""
    low, high = -float(heights.max()), -float(heights.min()) + push / (stiffness * max(facing.sum(), 1e-9))
    for _ in range(_HALVINGS):
        middle = (low + high) / 2
        much = stiffness * np.maximum(heights + middle, 0.0) @ facing > push
        low, high = (low, middle) if much else (middle, high)
    return np.asarray(stiffness * np.maximum(heights + high, 0.0))
