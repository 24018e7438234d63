"""Surfaces of true size that are studied: the bundled probes, a bumpy sphere, surfaces whose distances are known."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from contactbench import assets
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.mesh import Probe

if TYPE_CHECKING:
    import numpy.typing as npt

    Floats = npt.NDArray[np.float64]
    Ints = npt.NDArray[np.int32]

BUMPY = "bumpy sphere"


def bundled(name: str, facets: int) -> Probe:
    """Mesh a bundled probe."""
    if name not in assets.PROBE_NAMES:
        raise InputError(f"there is no bundled probe {name!r}; choose one of {', '.join(assets.PROBE_NAMES)}")
    if facets < 300:
        raise InputError(f"{facets} facets are too few for a bundled probe; give at least 300")
    return Probe.from_arrays(*assets.make(name, facets), name=name)


def bumpy_sphere(facets: int) -> Probe:
    """Mesh a sphere of 80 mm with waves of 2 mm: curved everywhere, both ways."""
    directions, faces = sphere(facets)
    x, y, z = directions.T
    radius = 0.04 * (1 + 0.05 * np.sin(10 * x) * np.sin(8 * y) * np.sin(9 * z))
    return Probe.from_arrays(directions * radius[:, None], faces, name=BUMPY)


def sphere(facets: int, rng: np.random.Generator | None = None) -> tuple[Floats, Ints]:
    """Mesh the unit sphere."""
    from scipy.spatial import ConvexHull

    count = facets // 2 + 2
    if rng is None:
        # A Fibonacci lattice.
        i = np.arange(count) + 0.5
        height = 1 - 2 * i / count
        turn = np.pi * (1 + np.sqrt(5)) * i
        ring = np.sqrt(1 - height**2)
        points = np.column_stack((ring * np.cos(turn), ring * np.sin(turn), height))
    else:
        points = rng.standard_normal((count, 3))
        points /= np.linalg.norm(points, axis=1, keepdims=True)
    faces = np.asarray(ConvexHull(points).simplices, dtype=np.int32)
    a, b, c = (points[faces[:, corner]] for corner in range(3))
    inwards = np.einsum("ij,ij->i", np.cross(b - a, c - a), a) < 0
    faces[inwards] = faces[inwards, ::-1]
    return points, faces


def plane(facets: int, rng: np.random.Generator) -> tuple[Floats, Ints]:
    """Mesh the square from -1 to 1 with vertices at random places; (n, 3), (m, 3)."""
    from scipy.spatial import Delaunay

    flat = rng.uniform(-1, 1, (facets // 2, 2))
    return np.column_stack((flat, np.zeros(len(flat)))), np.asarray(Delaunay(flat).simplices, dtype=np.int32)


def cylinder(facets: int, rng: np.random.Generator) -> tuple[Floats, Ints]:
    """Mesh a tube of radius 1 from z = -2 to 2 with vertices at random places; (n, 3), (m, 3)."""
    from scipy.spatial import Delaunay

    turn, height = rng.uniform(0, 2 * np.pi, facets // 2), rng.uniform(-2, 2, facets // 2)
    count = len(turn)
    # Unrolled three times, so that the middle copy knows its neighbours across the cut.
    unrolled = np.column_stack(
        (np.concatenate((turn - 2 * np.pi, turn, turn + 2 * np.pi)), np.tile(height, 3))
    )
    triangles = np.asarray(Delaunay(unrolled).simplices)
    # At the open ends long slivers reach across the tube.
    triangles = triangles[np.ptp(unrolled[triangles, 0], axis=1) < 0.5]
    middle = unrolled[triangles, 0].mean(axis=1)
    faces = (triangles[(middle >= 0) & (middle < 2 * np.pi)] % count).astype(np.int32)
    return np.column_stack((np.cos(turn), np.sin(turn), height)), faces
