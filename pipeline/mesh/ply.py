"""
PLY, binary and text, with an integer property `region` per facet.

A PLY header says how many rows of which properties follow. It is read first, so that an absurd number is
refused before anything is allocated for it.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from contactbench.pipeline.mesh.parse import RawMesh
from contactbench.pipeline.mesh.ply_body import read_binary, read_text
from contactbench.pipeline.mesh.ply_header import SETTLED, UNTOUCHABLE, ignored, read_header

if TYPE_CHECKING:
    import numpy.typing as npt


def read_ply(data: bytes) -> RawMesh:
    """
    Read the content of a PLY file; polygons become triangles that share their polygon's region.

    Raises
    ------
    MeshError
        Not a PLY file, cut short, without facets, or with properties of an unsuitable type.
    """
    header = read_header(data)
    body = read_binary(header, data) if header.order else read_text(header, data)
    labels, notes = body.labels, header.notes + body.notes
    if not header.settled:
        foreign = [name for name, values in labels.items() if not _may_be_ours(name, values)]
        labels = {name: values for name, values in labels.items() if name not in foreign}
        notes += tuple(map(ignored, foreign))
    return RawMesh(
        body.vertices,
        body.faces,
        labels.get("region"),
        settled=header.settled,
        invented=labels.get("invented"),
        stated="m" if header.settled else None,
        untouchable=header.untouchable,
        notes=notes,
    )


def _may_be_ours(name: str, values: npt.NDArray[np.int64]) -> bool:
    most = np.iinfo(np.int32).max if name == "region" else 1
    return bool(((values >= 0) & (values <= most)).all())


def encode_ply(
    vertices: npt.NDArray[np.float64],
    faces: npt.NDArray[np.int32],
    region: npt.NDArray[np.int32],
    invented: npt.NDArray[np.bool_],
    colours: npt.NDArray[np.uint8],
    untouchable: tuple[int, ...] = (),
) -> bytes:
    """
    Encode a mesh as binary little-endian PLY.

    Parameters
    ----------
    vertices : (n, 3) float64
        Metres in S; written as double, so nothing is rounded.
    faces : (m, 3) int32
        Vertex indices.
    region : (m,) int32
        Priority per facet, written as the property `region`.
    invented : (m,) bool
        Facets that the original did not hold, written as the property `invented`, 0 or 1.
    colours : (m, 3) uint8
        Red, green, blue per facet: for viewers, ignored when the file is read.
    untouchable : tuple of int
        Regions that nothing can touch, written as a comment of the header.

    Returns
    -------
    bytes
        The whole file.
    """
    fields = [("count", "u1"), ("vertex_indices", "<i4", (3,)), ("region", "<i4"), ("invented", "u1")]
    rows = np.empty(len(faces), dtype=[*fields, ("colour", "u1", (3,))])
    rows["count"], rows["vertex_indices"], rows["region"] = 3, faces, region
    rows["invented"], rows["colour"] = invented, colours
    hidden = " ".join([f"comment {UNTOUCHABLE}", *map(str, untouchable)]) + "\n" if untouchable else ""
    header = (
        f"ply\nformat binary_little_endian 1.0\ncomment {SETTLED}\ncomment metres\n{hidden}"
        f"element vertex {len(vertices)}\nproperty double x\nproperty double y\nproperty double z\n"
        f"element face {len(faces)}\nproperty list uchar int vertex_indices\nproperty int region\n"
        "property uchar invented\nproperty uchar red\nproperty uchar green\nproperty uchar blue\nend_header\n"
    )
    return header.encode("ascii") + vertices.astype("<f8").tobytes() + rows.tobytes()
