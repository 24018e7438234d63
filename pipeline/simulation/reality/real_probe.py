"""The probe that is on the bench, beside the one that the program is told of."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np
from scipy.spatial import cKDTree
from scipy.spatial.transform import Rotation

from contactbench.pipeline.mesh import Probe
from contactbench.pipeline.mesh.triangles import vertex_normals
from contactbench.pipeline.simulation.reality.chance import chance
from contactbench.pipeline.simulation.scenes.indenter import TipPress, along
from contactbench.pipeline.simulation.scenes.physics import TrueSurface

if TYPE_CHECKING:
    from collections.abc import Callable

    from contactbench.pipeline.mesh.arrays import Floats
    from contactbench.pipeline.reality import Reality

    Place = Callable[[Floats], Floats]

_RIM_M = 0.002  # over which a lens that sticks out meets the housing
_NECK = (0.4, 0.6)  # shares of the probe's length between which it is bent
_SHIFT_M_PER_DEG = 0.001


@dataclass(frozen=True, eq=False)
class RealProbe:
    """A probe that is not quite what it is said to be; everything in S, m."""

    truth: TrueSurface
    targets: Floats  # (k, 3) where somebody who aims at each marker puts the tip, on the true surface
    tip: float = 0.0  # radius of the ball that is aimed, m
    T_said: Floats = field(
        default_factory=lambda: np.eye(4)
    )  # takes the probe as it was said to sit to how it does

    @classmethod
    def of(cls, truth: TrueSurface, markers: Floats, reality: Reality, seed: int) -> RealProbe:
        """
        Draw it.

        The mesh is bent at its neck, ``p' = R(b s(z)) (p - c) + c`` with a smooth step s, then scaled about S, and its
        acoustic face (every region) lifted along its normals; the whole is turned and shifted on its seat. Markers go
        along as points of the material, and are set beside their places.

        Parameters
        ----------
        truth : TrueSurface
            As the program is told, but finer.
        markers : (k, 3)
            On it.
        """
        seat = _seat(reality.seat, chance(seed, "seat"))
        if not {"lens", "scale", "bend", "seat", "markers"} & set(reality.on):
            return cls(truth, markers, reality.tip / 1e3)
        moved = _moved(truth.probe, reality, seed)
        vertices = moved(truth.probe.vertices) @ seat[:3, :3].T + seat[:3, 3]
        probe = truth.probe
        real = TrueSurface(Probe.from_arrays(vertices, probe.faces, probe.region, name=probe.name))
        places = moved(markers) @ seat[:3, :3].T + seat[:3, 3]
        beside = reality.markers / 1e3 * chance(seed, "markers").standard_normal((len(markers), 2))
        targets = [_beside(real, place, *off) for place, off in zip(places, beside.tolist(), strict=True)]
        return cls(real, np.array(targets), reality.tip / 1e3, seat)

    def aimed(self, place: Floats, press: TipPress) -> Floats:
        """Return where a ball touches whose axis is aimed at a place (3,): beside it, where it leans, (3,)."""
        if self.tip == 0 or press.tilt == 0:
            return place
        _, normal = self.truth.nearest(place)
        lean = leaning(normal, press.azimuth)
        return self.truth.nearest(place - self.tip * np.sin(np.radians(press.tilt)) * lean)[0]


def leaning(normal: Floats, azimuth: float) -> Floats:
    """Return the direction (3,) along a surface at an azimuth, degrees, as `TipPress` has it."""
    x = along(normal)
    x = x - (x @ normal) * normal
    x /= np.linalg.norm(x)
    angle = np.radians(azimuth)
    return np.asarray(np.cos(angle) * x + np.sin(angle) * np.cross(normal, x))


def direction(rng: np.random.Generator) -> Floats:
    """Draw a unit vector (3,)."""
    v = rng.standard_normal(3)
    return np.asarray(v / np.linalg.norm(v))


def _beside(truth: TrueSurface, place: Floats, first: float, second: float) -> Floats:
    _, normal = truth.nearest(place)
    x = leaning(normal, 0.0)
    return truth.nearest(place + first * x + second * np.cross(normal, x))[0]


def _seat(degrees: float, rng: np.random.Generator) -> Floats:
    T = np.eye(4)
    T[:3, :3] = Rotation.from_rotvec(np.radians(degrees) * direction(rng)).as_matrix()
    T[:3, 3] = degrees * _SHIFT_M_PER_DEG * direction(rng)
    return T


def _moved(probe: Probe, reality: Reality, seed: int) -> Place:
    """Return what takes points (n, 3) of the mesh to where they are; the seat is left out."""
    lifted, bent = _lifted(probe, reality.lens / 1e3), _bent(probe, reality.bend, chance(seed, "bend"))
    return lambda points: reality.scale * bent(lifted(points))


def _lifted(probe: Probe, height: float) -> Place:
    if height == 0:
        return lambda points: points
    normals = vertex_normals(probe.normals * probe.areas[:, None], probe.faces, len(probe.vertices))
    outside = np.unique(probe.faces[probe.region == 0])
    # How far each vertex is lifted: none at the rim, all of it 2 mm inside.
    away, _ = cKDTree(probe.vertices[outside]).query(probe.vertices)
    lift = (height * np.clip(away / _RIM_M, 0.0, 1.0))[:, None] * normals
    near = cKDTree(probe.vertices)
    return lambda points: points + lift[near.query(points)[1]]


def _bent(probe: Probe, degrees: float, rng: np.random.Generator) -> Place:
    bearing = rng.uniform(0, 2 * np.pi)
    if degrees == 0:
        return lambda points: points
    z = probe.vertices[:, 2]
    low, high = z.min() + np.array(_NECK) * np.ptp(z)
    centre = np.array([0.0, 0.0, (low + high) / 2])
    axis = np.radians(degrees) * np.array([np.cos(bearing), np.sin(bearing), 0.0])

    def bent(points: Floats) -> Floats:
        u = np.clip((points[:, 2] - low) / (high - low), 0.0, 1.0)
        share = u * u * (3 - 2 * u)
        return np.asarray(Rotation.from_rotvec(share[:, None] * axis).apply(points - centre) + centre)

    return bent
