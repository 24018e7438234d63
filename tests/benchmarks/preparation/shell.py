"""The outer shell of hollow bodies: sound, on the true outside, its openings closed."""

from __future__ import annotations

import time
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from benchmarks.preparation.shapes import bundled

from contactbench import assets
from contactbench.pipeline.kernel import SurfaceIndex
from contactbench.pipeline.mesh import Probe, load_probe
from contactbench.pipeline.mesh.shell import Closing, make_shell
from contactbench.pipeline.mesh.shell.wrap import draw_points
from contactbench.pipeline.mesh.soundness import check_soundness
from contactbench.pipeline.mesh.triangles import cross_products, twins
from contactbench.pipeline.study.report import Figure, StudyReport

if TYPE_CHECKING:
    import numpy.typing as npt

    Mesh = tuple[npt.NDArray[np.float64], npt.NDArray[np.int32]]
    import os
    from collections.abc import Callable, Iterator, Sequence

    from contactbench.pipeline.mesh import Probe
    from contactbench.pipeline.mesh.shell import Shell

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


_NEAR_MM = 0.3
_SAMPLES = 60_000


@dataclass(frozen=True, eq=False)
class Case:
    """A mesh to make a shell of."""

    name: str
    probe: Probe
    outside: Probe | None = None  # The true outer surface, where it is known
    openings: int | None = None  # How many openings it has, where that is known


def run(
    files: Sequence[str | os.PathLike[str]] = (),
    *,
    facets: int = 20_000,
    quick: bool = False,
    seed: int = 0,
    progress: Callable[[str], None] = lambda _: None,
) -> StudyReport:
    """Make a shell of every mesh and measure it."""
    figures: list[Figure] = []
    for case in _cases(files, facets, quick):
        progress(f"{case.name}: {len(case.probe.faces):,} facets")
        figures += judge(case, np.random.default_rng(seed))
    settings = {
        "meshes": len(files) or "bundled housings",
        "seed": seed,
    }
    note = (
        "Hulls and unchanged meshes are made of the facets of the file, so only what was wrapped has distances from"
        " what is visible of the original, except at invented facets, and inner hits: half-lines from all round"
        " outside that land on an inner wall."
    )
    return StudyReport("Outer shell", settings, tuple(figures), (note,))


def judge(case: Case, rng: np.random.Generator) -> list[Figure]:
    """Make a shell and measure it."""
    began = time.perf_counter()
    shell = make_shell(case.probe, Closing.AUTO)
    seconds = time.perf_counter() - began
    return [
        Figure(
            case.name,
            f"time, {len(case.probe.faces):,} to {len(shell.probe.faces):,} facets, {shell.how}",
            seconds,
            "s",
        ),
        *_soundness(case.name, shell),
        *_fit(case, shell, rng),
        *_openings(case, shell),
    ]


def _cases(files: Sequence[str | os.PathLike[str]], facets: int, quick: bool) -> Iterator[Case]:
    for file in files:
        yield Case(Path(file).name, load_probe(file, "auto"))
    if files:
        return
    for name in assets.PROBE_NAMES[: 1 if quick else None]:
        hollow, outside = housing(name, facets)
        yield Case(f"{name}, hollow", hollow, outside, 1)


def _soundness(name: str, shell: Shell) -> list[Figure]:
    sound = check_soundness(shell.probe.vertices, shell.probe.faces)
    health = sound.health
    defects = {
        "rim edges (closed: 0)": health.boundary_edges,
        "edges of more than two facets (manifold: 0)": health.nonmanifold_edges,
        "faces inwards, or both ways (outward: 0)": int(not (health.outward and health.winding_consistent)),
        "parts inside others": sound.nested_parts,
        "pairs of facets that cross or overlap": sound.crossing + sound.overlapping,
        "facets folded back": len(sound.folded_facets),
    }
    figures = [Figure(name, what, float(count), most=0.0) for what, count in defects.items()]
    return [*figures, Figure(name, "parts", float(health.components))]  # a file may have several


def _fit(case: Case, shell: Shell, rng: np.random.Generator) -> list[Figure]:
    figures = []
    if shell.fit is not None:
        fit = shell.fit
        figures += [
            Figure(case.name, "visible outside to shell, 95 %", 1e3 * fit.visible_p95, "mm", most=_NEAR_MM),
            Figure(case.name, "visible outside to shell, largest", 1e3 * fit.visible_max, "mm"),
        ]
    if case.outside is not None:
        figures.append(_truth(case, case.outside, shell, rng))
    return figures


def _truth(case: Case, outside: Probe, shell: Shell, rng: np.random.Generator) -> Figure:
    """Measure from the true outer surface to the shell: no figure of the shell's own."""
    points, _ = draw_points(outside.vertices, outside.faces, _SAMPLES, rng)
    distance, _, _ = SurfaceIndex(shell.probe.vertices, shell.probe.faces).closest(points)
    middle, p95, worst = (1e3 * np.percentile(distance, [50, 95, 100])).tolist()
    what = f"true outside to shell, 95 % (median {middle:.2g} mm)"
    return Figure(case.name, what, p95, "mm", most=_NEAR_MM, worst=worst)


def _openings(case: Case, shell: Shell) -> list[Figure]:
    closed = sum(opening.closing is not Closing.OPEN for opening in shell.openings)
    invented = 100 * shell.invented_area / float(shell.probe.areas.sum())
    left = len(shell.openings) - closed
    return [
        Figure(case.name, "openings closed", float(closed), least=case.openings, most=case.openings),
        Figure(case.name, "openings left open", float(left), most=None if case.openings is None else 0.0),
        Figure(case.name, "invented, of the shell's area", invented, "%"),
    ]
