"""Distances along meshed surfaces beside the exact ones of the surface: a plane, a sphere, a cylinder."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from benchmarks.preparation import shapes

from contactbench.pipeline.kernel import Geodesic

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    import numpy.typing as npt

    Floats = npt.NDArray[np.float64]
    Distance = Callable[[Floats, Floats], Floats]

# Nearer than this many edge lengths the surface is not yet resolved.
_EDGES = 5
_SOURCES = 10


def distance_errors(rng: np.random.Generator, facets: int = 8_000) -> Iterator[tuple[str, Floats]]:
    """Compare geodesic distances with exact ones, at least five edge lengths away."""
    yield "plane, random", _errors(*shapes.plane(facets, rng), _straight, 0.5, rng)
    yield "sphere, even", _errors(*shapes.sphere(facets), _great_circle, 2.0, rng)
    yield "sphere, random", _errors(*shapes.sphere(facets, rng), _great_circle, 2.0, rng)
    # Far from the open ends, where no shortest way leads around the edge of the mesh.
    yield "cylinder, random", _errors(*shapes.cylinder(facets, rng), _helix, 1.2, rng)


def _errors(
    vertices: Floats, faces: npt.NDArray[np.int32], exact: Distance, limit: float, rng: np.random.Generator
) -> Floats:
    geodesic = Geodesic(np.ascontiguousarray(vertices), np.ascontiguousarray(faces))
    edge = float(np.mean(np.linalg.norm(vertices[faces] - vertices[np.roll(faces, 1, axis=1)], axis=2)))
    centres = vertices[faces].mean(axis=1)
    middle = np.flatnonzero((np.abs(centres) < [1.1, 1.1, 0.7]).all(axis=1))
    if np.ptp(vertices[:, 2]) == 0:
        middle = middle[(np.abs(centres[middle]) < 0.4).all(axis=1)]
    found = []
    for face in rng.choice(middle, _SOURCES, replace=False).tolist():
        there, distance = geodesic.around(face, np.ascontiguousarray(centres[face]), limit)
        true = exact(centres[face], vertices[there])
        far = true >= _EDGES * edge
        found.append(np.abs(distance[far] / true[far] - 1))
    return np.concatenate(found)


def _straight(source: Floats, points: Floats) -> Floats:
    return np.asarray(np.linalg.norm(points - source, axis=1))


def _great_circle(source: Floats, points: Floats) -> Floats:
    pole = source / np.linalg.norm(source)
    sine = np.linalg.norm(np.cross(points, pole), axis=1)
    return np.asarray(np.arctan2(sine, points @ pole))


def _helix(source: Floats, points: Floats) -> Floats:
    turn = np.arctan2(points[:, 1], points[:, 0]) - np.arctan2(source[1], source[0])
    around = np.abs((turn + np.pi) % (2 * np.pi) - np.pi)
    return np.asarray(np.hypot(around, points[:, 2] - source[2]))
