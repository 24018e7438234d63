"""Curves once around a probe, evenly spaced between its edges: where the rings of a mesh go."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import gaussian_filter

from contactbench.assets.section import unit_section
from contactbench.assets.surface import Station, Surface

Array = NDArray[np.float64]

_ANGLES = 384
_STEP = 0.25e-3  # [m] spacing of the tables along the profile
_GAIN = 1.5e-3  # [m] how strongly curvature shortens facets
_OFF_END = 1e-6  # the chart is singular at its very ends
_FINEST = 2.0  # facets on tight fillets are shorter by this factor at most


@dataclass(frozen=True)
class Band:
    """The part of a surface between two stations, tabulated at levels (rows) and angles (columns)."""

    t: Array
    """(levels, angles) profile parameter."""
    weight: Array
    """(levels, angles) how much shorter facets should be along the fronts."""
    level: Array
    """(levels, angles) weighted length along the meridian, from 0 to 1."""
    area: float
    """Area times both weights [m^2]."""
    perimeter: float
    """Mean weighted length of the fronts [m]."""

    def fronts(self, levels: Array) -> tuple[Array, Array]:
        """Return parameters and weights (k, angles) of the curves on which ``level`` has given values."""
        columns = range(self.t.shape[1])
        t = np.stack([np.interp(levels, self.level[:, j], self.t[:, j]) for j in columns], axis=1)
        weight = np.stack([np.interp(levels, self.level[:, j], self.weight[:, j]) for j in columns], axis=1)
        return t, weight


@dataclass(frozen=True)
class Fronts:
    """All bands of a surface, from the middle of the flange to the middle of the face."""

    phi: Array
    """Angles of the tables, the first repeated at 2 pi [rad]."""
    bands: tuple[Band, ...]
    area: float
    """Weighted area of the surface [m^2]."""

    @staticmethod
    @lru_cache(maxsize=8)
    def of(surface: Surface) -> Fronts:
        """Tabulate a surface; the last few are remembered."""
        phi = np.linspace(0, 2 * np.pi, _ANGLES + 1)
        stations = (Station(0.0, 0.0), *surface.stations, Station(1.0, 1.0))
        bands = tuple(_band(surface, phi, *pair) for pair in pairwise(stations))
        return Fronts(phi, bands, sum(band.area for band in bands))


def _band(surface: Surface, phi: Array, start: Station, stop: Station) -> Band:
    low, high = _curve(phi, start), _curve(phi, stop)
    reach = float(np.max(high - low)) * _profile_length(surface)
    s = np.linspace(0, 1, max(24, int(reach / _STEP)))[:, None]
    t = low + (high - low) * s
    around = np.broadcast_to(phi, t.shape)
    along, weight = _weights(surface, around, t)
    p = surface.points(around, t).reshape(*t.shape, 3)
    steps = np.linalg.norm(np.diff(p, axis=0), axis=-1) * (along[1:] + along[:-1]) / 2
    length = np.concatenate([np.zeros((1, len(phi))), np.cumsum(steps, axis=0)])
    area, perimeter = _measure(p, along, weight)
    return Band(t, weight, length / length[-1], area, perimeter)


def _weights(surface: Surface, phi: Array, t: Array) -> tuple[Array, Array]:
    """Return how much shorter facets should be along the meridians and along the fronts."""
    jet = surface.jet(phi.ravel(), np.clip(t.ravel(), _OFF_END, 1 - _OFF_END))
    normals = surface.normals(phi, t)
    rise = np.abs(np.einsum("ij,ij->i", jet.tt, normals)) / np.einsum("ij,ij->i", jet.t, jet.t)
    bend = np.abs(surface.principal_curvatures(phi, t)).max(axis=-1)
    # Rounded edges that run along the probe must not count along it: meridians beside them would be shorter,
    # and fronts would cross the edges at a slant.
    spread = (len(t) / 40, _ANGLES / 80)
    along, around = (
        # Facets should change size gradually, over about their own length.
        gaussian_filter(
            np.clip(1 + _GAIN * curve.reshape(t.shape), 1, _FINEST), spread, mode=("nearest", "wrap")
        )
        for curve in (rise, bend)
    )
    return along, around


def _curve(phi: Array, station: Station) -> Array:
    """Profile parameter of a station at each angle: ``side`` on the x ends, bulging to ``front``."""
    x = unit_section(phi, np.full_like(phi, 4.0))[0].value
    return station.side + (station.front - station.side) * (1 - x**2) ** 2


def _profile_length(surface: Surface) -> float:
    points = surface.profile(np.linspace(0, 1, 500))[:, :3]
    return float(np.linalg.norm(np.diff(points, axis=0), axis=-1).sum())


def _measure(p: Array, along: Array, weight: Array) -> tuple[float, float]:
    """Weighted area of a tabulated patch and the mean weighted length of its rows."""
    across, down = p[:-1, 1:] - p[1:, :-1], p[1:, 1:] - p[:-1, :-1]
    cells = np.linalg.norm(np.cross(across, down), axis=-1) / 2
    area = float((cells * weight[:-1, :-1] * along[:-1, :-1]).sum())
    rows = np.linalg.norm(np.diff(p, axis=1), axis=-1) * (weight[:, 1:] + weight[:, :-1]) / 2
    return area, float(rows.sum(axis=1).mean())
