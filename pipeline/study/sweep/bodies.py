"""The probes of a sweep: what is touched, and the mesh that it is located on."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from contactbench import assets
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.mesh import Probe
from contactbench.pipeline.mesh.sidecar import load_probe_file
from contactbench.pipeline.simulation.marker_touches import model_of

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

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
