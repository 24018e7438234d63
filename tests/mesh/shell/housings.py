"""Hollow housings whose true outside is known."""

import numpy as np
import trimesh

from contactbench.pipeline.mesh import Probe

LENGTH, WIDTH, HEIGHT, WALL = 0.06, 0.024, 0.1, 0.002  # m
MOUTH = (LENGTH - 2 * WALL) * (WIDTH - 2 * WALL)  # m²


def box(low, high, open_top=False):
    x, y, z = np.transpose([low, high])
    vertices = np.array([[a, b, c] for c in z for b in y for a in x], dtype=float)
    quads = [[0, 2, 3, 1], [0, 1, 5, 4], [1, 3, 7, 5], [3, 2, 6, 7], [2, 0, 4, 6]]
    quads += [] if open_top else [[4, 5, 7, 6]]
    return vertices, np.array([t for a, b, c, d in quads for t in ((a, b, c), (a, c, d))], dtype=np.int32)


def housing(arch=0.0, depth=HEIGHT - WALL, width=WIDTH, height=HEIGHT) -> Probe:
    """A box of 60 x 24 x 100 mm, or so wide and high, with walls of 2 mm, open above, so deep; the long ones arched."""
    outer, faces = box([-LENGTH / 2, -width / 2, 0], [LENGTH / 2, width / 2, height], open_top=True)
    inner, inner_faces = box(
        [-LENGTH / 2 + WALL, -width / 2 + WALL, height - depth],
        [LENGTH / 2 - WALL, width / 2 - WALL, height],
        open_top=True,
    )
    ring = [[4, 5, 13, 12], [5, 7, 15, 13], [7, 6, 14, 15], [6, 4, 12, 14]]
    lip = np.array([t for a, b, c, d in ring for t in ((a, b, c), (a, c, d))], dtype=np.int32)
    vertices = np.concatenate((outer, inner))
    triangles = np.concatenate((faces, inner_faces[:, ::-1] + 8, lip))
    if arch:
        import trimesh

        for _ in range(4):
            vertices, triangles = trimesh.remesh.subdivide(vertices, triangles)
        top = vertices[:, 2] > height - 1e-9
        vertices[top, 2] += arch * (1 - (vertices[top, 0] / (LENGTH / 2)) ** 2)
    return Probe.from_arrays(vertices, triangles.astype(np.int32), name="housing")


def write_stl(file, probe, scale=1000.0):
    """Write a probe as a mesh file, mm."""
    mesh = trimesh.Trimesh(probe.vertices * scale, probe.faces, process=False)
    file.write_bytes(mesh.export(file_type="stl"))
    return file
