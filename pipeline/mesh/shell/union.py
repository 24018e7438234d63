"""Closed bodies that cross, as CAD assemblies have them: their union, by manifold3d."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from contactbench.pipeline.kernel import crossings
from contactbench.pipeline.mesh.health import edge_table, label_parts
from contactbench.pipeline.mesh.shell.cut import Cut
from contactbench.pipeline.mesh.soundness import CROSSING
from contactbench.pipeline.mesh.triangles import six_volumes

if TYPE_CHECKING:
    from numpy.typing import NDArray

_MOST_BODIES = 2000


def unite(vertices: NDArray[np.float64], faces: NDArray[np.int32]) -> Cut | None:
    """
    Unite bodies that cross each other: what lies inside another one is gone, and the rest is cut where they meet.

    Cutting facet by facet (`cut_crossings`) needs no bodies, but rounds what it cuts, and many slanted cuts near each
    other cross again without end. A union of bodies cannot (Manifold, E. Lalish, by symbolic perturbation).

    Parameters
    ----------
    vertices : (n, 3) float64
        Any unit.
    faces : (m, 3) int32
        With area, none twice.

    Returns
    -------
    Cut or None
        None where the facets are no bodies, each closed, 2-manifold and wound one way; where no two of them cross;
        or where a body crosses itself, which no union mends.
    """
    if (edge_table(faces, len(vertices)).uses != 2).any():
        return None
    part = label_parts(faces, len(vertices))
    if not 2 <= part.max() + 1 <= _MOST_BODIES:
        return None
    pairs, kinds, _, complete = crossings(vertices, faces)
    met = part[pairs[kinds == CROSSING]]
    if not complete or len(met) == 0 or (met[:, 0] == met[:, 1]).any():
        return None
    inverted = six_volumes(vertices, faces, part) < 0
    outward = faces.copy()
    outward[inverted[part]] = outward[inverted[part]][:, ::-1]
    made = _union(vertices, outward, part)
    if made is None:
        return None
    points, triangles, born = made
    # As they were: whoever keeps them turns them over, and says so.
    back = inverted[part[born]]
    triangles[back] = triangles[back][:, ::-1]
    _, _, counts, _ = crossings(points, triangles)
    return Cut(points, triangles, born, left=0) if not counts.any() else None


def _union(
    vertices: NDArray[np.float64], faces: NDArray[np.int32], part: NDArray[np.int64]
) -> tuple[NDArray[np.float64], NDArray[np.int32], NDArray[np.int64]] | None:
    import manifold3d

    bodies = []
    first = manifold3d.Manifold.reserve_ids(1)
    for number in range(int(part.max()) + 1):
        own = np.flatnonzero(part == number)
        used, corner = np.unique(faces[own], return_inverse=True)
        body = manifold3d.Manifold(
            manifold3d.Mesh64(
                vert_properties=vertices[used],
                tri_verts=corner.reshape(-1, 3).astype(np.uint64),
                face_id=own.astype(np.uint64),  # facets of one number may be merged where they are level
                run_index=np.array([0, 3 * len(own)], dtype=np.uint64),
                run_original_id=np.array([first], dtype=np.uint32),
            )
        )
        if body.status() != manifold3d.Error.NoError:
            return None
        bodies.append(body)
    mesh = manifold3d.Manifold.batch_boolean(bodies, manifold3d.OpType.Add).to_mesh64()
    triangles = np.array(mesh.tri_verts, dtype=np.int32)
    if len(triangles) == 0:
        return None
    return (
        np.array(mesh.vert_properties, dtype=np.float64)[:, :3],
        triangles,
        np.array(mesh.face_id, dtype=np.int64),
    )
