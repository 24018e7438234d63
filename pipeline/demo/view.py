"""An orthographic view: from S to millimetres on paper."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True)
class View:
    """A look at the probe with +z of S upwards on paper."""

    focal: tuple[float, float, float]  # (x, y, z) point of S in the middle of the paper, m
    # azimuth, elevation: where the camera is, degrees: azimuth from -y towards +x, elevation above the
    # flange plane
    azimuth: float
    elevation: float
    # width, height: what the paper shows, mm
    width: float
    height: float

    @cached_property
    def toward(self) -> Array:
        """Unit vector (3,) of S from the focal point to the camera."""
        a, e = np.radians([self.azimuth, self.elevation])
        return np.array([np.sin(a) * np.cos(e), -np.cos(a) * np.cos(e), np.sin(e)])

    @cached_property
    def right(self) -> Array:
        """Unit vector (3,) of S that points to the right on paper."""
        a = np.radians(self.azimuth)
        return np.array([np.cos(a), np.sin(a), 0.0])

    @cached_property
    def up(self) -> Array:
        """Unit vector (3,) of S that points upwards on paper."""
        return np.cross(self.toward, self.right)

    def project(self, points: ArrayLike) -> Array:
        """Return where points (..., 3) of S, m, lie on paper: (..., 2), mm from the middle."""
        offset = np.asarray(points, dtype=np.float64) - self.focal
        return np.asarray(offset @ np.column_stack([self.right, self.up]) * 1e3)
