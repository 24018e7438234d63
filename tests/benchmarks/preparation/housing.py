"""Bundled probes as scanned housings: hollow, open at the flange, with an inner wall 2 mm inside."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from benchmarks.preparation.shapes import bundled

from contactbench.pipeline.mesh import Probe
from contactbench.pipeline.mesh.triangles import cross_products, twins

if TYPE_CHECKING:
    import numpy.typing as npt

    Mesh = tuple[npt.NDArray[np.float64], npt.NDArray[np.int32]]

WALL = 0.002
# The flange's end is level, at z = 0.
_LEVEL, _DOWN = 0.0005, -0.99


def housing(name: str, facets: int) -> tuple[Probe, Probe]:
    """Hollow out a bundled probe."""
    solid = bundled(name, facets)
    low = (solid.vertices[solid.faces, 2] < _LEVEL).all(axis=1)
    outer = np.ascontiguousarray(solid.faces[~(low & (solid.normals[:, 2] < _DOWN))])
    inner = solid.vertices - WALL * _vertex_normals(solid)
    count = len(solid.vertices)
    a, b = _rim(outer).T
    lip = np.concatenate((np.column_stack((b, a, a + count)), np.column_stack((b, a + count, b + count))))
    faces = np.concatenate((outer, outer[:, ::-1] + count, lip)).astype(np.int32)
    hollow = Probe.from_arrays(np.concatenate((solid.vertices, inner)), faces, name=name)
    return hollow, Probe.from_arrays(solid.vertices, outer, name=name)


def _rim(faces: npt.NDArray[np.int32]) -> npt.NDArray[np.int32]:
    """Half-edges (k, 2) without a facet on their other side."""
    edges = np.stack((faces, np.roll(faces, -1, axis=1)), axis=2).reshape(-1, 2)
    return np.asarray(edges[twins(faces) < 0])


def _vertex_normals(probe: Probe) -> npt.NDArray[np.float64]:
    summed = np.zeros_like(probe.vertices)
    cross = cross_products(probe.vertices, probe.faces)
    for corner in range(3):
        np.add.at(summed, probe.faces[:, corner], cross)
    return np.asarray(summed / np.linalg.norm(summed, axis=1, keepdims=True))
