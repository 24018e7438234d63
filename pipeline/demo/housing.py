"""The mesh file that a technician gets of a bundled probe, a hollow housing in its own frame, and its preparation."""

from dataclasses import dataclass
from functools import cache
from pathlib import Path

import numpy as np

from contactbench import assets
from contactbench.pipeline.durable import write_file
from contactbench.pipeline.kernel import SurfaceIndex
from contactbench.pipeline.mesh.arrays import Floats, Ints, Longs
from contactbench.pipeline.mesh.engines import EngineError
from contactbench.pipeline.mesh.probe import Probe
from contactbench.pipeline.mesh.regions.region import Region, RegionSet
from contactbench.pipeline.mesh.shell import Closing
from contactbench.pipeline.mesh.sidecar import ProbeFile, save_probe_file
from contactbench.pipeline.mesh.simplify import Count
from contactbench.pipeline.mesh.triangles import vertex_normals
from contactbench.pipeline.preparation.alignment.alignment import from_transform
from contactbench.pipeline.preparation.prepare import align_step, import_mesh, shell_step, simplify_step

FACETS = 2_000
_CAD_FACETS = 20_000
_WALL = 0.002
_BACK = 0.003  # what lies this near to the flange is open: where the cable leaves
_ALPHA = 0.0015
_FAR = 2e-4  # a prepared mesh further from the design than this is not verified

# The mesh's frame: millimetres, the tip at the origin, the handle along -y.
_R_SP = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]])


@dataclass(frozen=True)
class MeshResult:
    """How the preparation did."""

    # facets_before, facets: of the housing's file, and of the probe
    facets_before: int
    facets: int
    openings: int  # that were closed
    invented_share: float  # of the probe's area
    # deviation_mm, true_size_mm: what 95 % of the probe's head stay within of the design, and the probe's
    # length
    deviation_mm: float
    true_size_mm: float
    closed: bool  # whether it is one closed surface that faces outwards

    @property
    def verified(self) -> bool:
        """Whether the probe is closed and lies where the design does."""
        return self.closed and self.openings == 1 and self.deviation_mm <= 1e3 * _FAR

    def sentence(self, probe: str) -> str:
        """Say it in words."""
        found = (
            f"{probe}: a hollow housing of {self.facets_before:,} facets became a closed probe of {self.facets:,}"
            f" ({100 * self.invented_share:.1f} % of it invented, where the cable leaves); 95 % of its head lie"
            f" within {self.deviation_mm:.3f} mm of the design"
        )
        return f"{found}." if self.verified else f"{found}. FAILED: it differs from the design."


def prepare_probe(folder: Path, name: str) -> MeshResult:
    """Write housing.stl, and probe.ply with its history in probe.json: what preparing makes of it.

    Parameters
    ----------
    folder : Path
        Exists.
    name : str
        One of assets.PROBE_NAMES.

    Raises
    ------
    EngineError
        pymeshlab is missing; then probe.ply is the design itself, without a history.
    InputError
        A file cannot be written.
    """
    design, T_SP = _design(name)
    write_file(folder / "housing.stl", _housing(name, _CAD_FACETS))
    try:
        # From here on only the file counts: what works here works for files from elsewhere.
        content, openings = _prepare(folder / "housing.stl", name, T_SP)
    except EngineError:
        (folder / "probe.json").unlink(missing_ok=True)
        save_probe_file(
            _with_region(ProbeFile(design, RegionSet.empty(len(design.faces)), "S"), name),
            folder / "probe.ply",
        )
        raise
    save_probe_file(content, folder / "probe.ply")
    return _result(content, openings, name)


def housing_of(name: str, facets: int | None = None) -> tuple[bytes, Floats, float]:
    """
    Return what a technician gets of a bundled probe.

    Parameters
    ----------
    name : str
        One of assets.PROBE_NAMES.
    facets : int, optional
        Of the whole outside, before it is hollow; as many as a CAD program makes where it is left out.

    Returns
    -------
    file : bytes
        A binary STL file, mm in its own frame P.
    T_SP : (4, 4) float64
        How it is mounted, translation in m.
    alpha : float
        Size of the facets with which its outer surface is well made, m.
    """
    return _housing(name, facets or _CAD_FACETS), _design(name)[1], _ALPHA


@cache
def _design(name: str) -> tuple[Probe, Floats]:
    vertices, faces = assets.make(name, FACETS)
    T_SP = np.eye(4)
    T_SP[:3, :3], T_SP[2, 3] = _R_SP, vertices[:, 2].max()
    return Probe.from_arrays(vertices, faces, name=name), T_SP


@cache
def _housing(name: str, facets: int) -> bytes:
    """Make a binary STL file: the outside without its back, an inner wall and the edge between; millimetres in P."""
    vertices, faces = assets.make(name, facets)
    outside = Probe.from_arrays(vertices, faces)
    tip = float(vertices[:, 2].max())
    front = faces[vertices[faces][:, :, 2].min(axis=1) > _BACK]
    normals = vertex_normals(outside.normals * outside.areas[:, None], faces, len(vertices))
    inner = vertices - _WALL * normals
    a, b = _edge_of(front).T
    edge = [
        np.stack(quad, axis=1)
        for quad in ((vertices[a], inner[a], vertices[b]), (vertices[b], inner[a], inner[b]))
    ]
    corners = np.concatenate((vertices[front], inner[front[:, ::-1]], *edge))
    corners_P = 1000 * ((corners - [0.0, 0.0, tip]) @ _R_SP)
    rows = np.zeros(len(corners), dtype=[("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("spare", "<u2")])
    rows["corners"] = corners_P
    return b"housing, made by contactbench".ljust(80) + np.uint32(len(rows)).tobytes() + rows.tobytes()


def _edge_of(faces: Ints) -> Longs:
    """Give the edges (k, 2) of one facet only, as that facet runs along them."""
    half = np.concatenate([faces[:, [k, (k + 1) % 3]] for k in range(3)]).astype(np.int64)
    count = int(faces.max()) + 1
    return half[~np.isin(half[:, 0] * count + half[:, 1], half[:, 1] * count + half[:, 0])]


def _prepare(file: Path, name: str, T_SP: Floats) -> tuple[ProbeFile, int]:
    content, shell = shell_step(import_mesh(file), Closing.AUTO, alpha=_ALPHA)
    content = align_step(content, from_transform(T_SP))
    content, *_ = simplify_step(_with_region(content, name), Count(FACETS))
    return content, len(shell.openings)


def _with_region(content: ProbeFile, name: str) -> ProbeFile:
    probe = content.probe
    labels = assets.contact_region(name, probe.vertices, probe.faces)
    regions = RegionSet.from_labels(labels, (Region("Acoustic face", "#009e73"),))
    return content.after(
        "region", probe, {"command": "acoustic face"}, {"changed": int(labels.sum())}, regions=regions
    )


def _result(content: ProbeFile, openings: int, name: str) -> MeshResult:
    vertices, faces = assets.make(name, _CAD_FACETS)
    probe = content.probe
    head = probe.vertices[~np.isin(np.arange(len(probe.vertices)), probe.faces[probe.invented])]
    head = head[head[:, 2] > 2 * _BACK]
    distance, _, _ = SurfaceIndex(vertices, faces).closest(np.ascontiguousarray(head))
    return MeshResult(
        facets_before=int(content.history[0]["output"]["facets"]),
        facets=len(probe.faces),
        openings=openings,
        invented_share=float(probe.areas[probe.invented].sum() / probe.areas.sum()),
        deviation_mm=1e3 * float(np.percentile(distance, 95)),
        true_size_mm=1e3 * probe.size,
        closed=not probe.health.sentences,
    )
