"""The probes of a sweep: what is touched, and the mesh that it is located on."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from contactbench import assets
from contactbench.pipeline.contact.noise import WrenchNoise
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.filtering import KalmanFilter
from contactbench.pipeline.mesh.sidecar import load_probe_file
from contactbench.pipeline.simulation.marker_touches import model_of
from contactbench.pipeline.simulation.sensor_model import PRESETS

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from numpy.typing import NDArray

    from contactbench.pipeline.mesh import Probe
    from contactbench.pipeline.simulation.touches import Sampled

_ABOVE_M = 0.02  # of a bundled probe: what is nearer to the flange is not touched
_KEPT = 8  # meshes of a process


@dataclass(frozen=True, eq=False)
class TouchedBody:
    """A probe that is touched."""

    surface: Sampled  # as it truly is
    above: float  # only what lies higher than this is touched, z in S, m


class MeshSurface:
    """A mesh as a true surface."""

    def __init__(self, probe: Probe) -> None:
        self._corners = probe.vertices[probe.faces]
        areas = np.linalg.norm(
            np.cross(self._corners[:, 1] - self._corners[:, 0], self._corners[:, 2] - self._corners[:, 0]),
            axis=1,
        )
        self._normals = probe.normals
        self._shares = np.cumsum(areas) / areas.sum()

    def sample(self, count: int, rng: np.random.Generator) -> Sequence[NDArray[np.float64]]:
        """Give points (count, 3), m, spread evenly by area, and outward normals (count, 3)."""
        faces = np.minimum(np.searchsorted(self._shares, rng.random(count)), len(self._shares) - 1)
        u, v = np.sqrt(rng.random(count)), rng.random(count)
        weights = np.column_stack([1 - u, u * (1 - v), u * v])
        return np.einsum("nk,nkd->nd", weights, self._corners[faces]), self._normals[faces]


@lru_cache(maxsize=_KEPT)
def body_of(name: str) -> TouchedBody:
    """Return what is touched: a bundled probe's exact surface, or the file's own mesh; InputError."""
    if name in assets.PROBE_NAMES:
        return TouchedBody(assets.surface(name), _ABOVE_M)
    probe = _file(name)
    low, high = probe.bounds
    return TouchedBody(MeshSurface(probe), float(low[2] + 0.15 * (high[2] - low[2])))


@lru_cache(maxsize=_KEPT)
def mesh_of(name: str, facets: int) -> Probe:
    """Return the mesh of about so many facets that contacts are located on; InputError."""
    if name in assets.PROBE_NAMES:
        return model_of(name, facets)
    from contactbench.pipeline.mesh.simplify import Count, simplify

    probe = _file(name)
    return probe if facets >= len(probe.faces) else simplify(probe, Count(facets)).probe


def file_facets(name: str) -> int | None:
    """Return how many facets a file has; None for a bundled probe, which can have any number; InputError."""
    return None if name in assets.PROBE_NAMES else len(_file(name).faces)


@lru_cache(maxsize=_KEPT)
def _file(name: str) -> Probe:
    content = load_probe_file(Path(name))
    if content.history and content.frame != "S":
        raise InputError(
            f"{name}: the probe is not aligned with the sensor: `contactbench probe align` does it."
        )
    return content.probe


# ---- sensors and filters of a sweep, as what they leave of the noise in a held touch -------------


# Standard deviation of one reading: Fx, Fy, Fz in N, Mx, My, Mz in N·m.
NOISES: Mapping[str, tuple[float, ...]] = {
    "none": (0.0,) * 6,
    **{name: tuple(float(x) for x in np.asarray(settings.noise)) for name, settings in PRESETS.items()},
}
# Share of the standard deviation of white noise that is left in a touch that is held long enough. Filters are linear:
# of Gaussian noise they make Gaussian noise of that share, so that it can be drawn as it is.
FILTERS: Mapping[str, float] = {
    "none": 1.0,
    "mean-10": float(1 / np.sqrt(10)),
    "mean-50": float(1 / np.sqrt(50)),
    "kalman": float(KalmanFilter().figures(200.0).noise_left),
}
_QUIETEST = np.repeat([1e-6, 1e-8], 3)  # a solver needs some noise to weigh candidates by


def deviations(noise: str, way: str) -> NDArray[np.float64]:
    """Return the standard deviations (6,) of a filtered reading, N and N·m."""
    return FILTERS[way] * np.array(NOISES[noise])


def believed(noise: str, way: str) -> WrenchNoise:
    """Return the noise that a method is told: that of the filtered reading, a millionth of a newton at least."""
    sigmas = np.maximum(deviations(noise, way), _QUIETEST)
    return WrenchNoise(force=sigmas[:3], torque=sigmas[3:])
