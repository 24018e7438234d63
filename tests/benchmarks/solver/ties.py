"""Where two touches explain a wrench equally well: the search, every facet, and docs/bundle.md in NumPy agree.

Meshes are symmetric, forces run along axes, and lines of force pass through corners and middles: rounding would decide.
"""

from __future__ import annotations

import tempfile
from dataclasses import replace
from itertools import product
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from benchmarks.solids import Box, blocks, joined, lathe
from config.runtime.bundle_reference import Reference
from config.runtime.bundles import example

from contactbench import assets
from contactbench.pipeline import kernel
from contactbench.pipeline.config.runtime.values import kernel_arguments
from contactbench.pipeline.contact import Reason
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.mesh import Probe
from contactbench.pipeline.mesh.sidecar import encode_probe
from contactbench.pipeline.study.report import Figure, Sheet, StudyReport

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    Float = NDArray[np.float64]

_NEAR_M = 1e-7
_GIVEN = (
    "vertices",
    "faces",
    "region",
    "noise",
    "bonus",
    "torsion_arm",
    "mesh_deviation",
    "mesh_curved",
    "gates",
)


def run(
    *, wrenches: int = 200_000, seed: int = 0, progress: Callable[[str], None] = lambda _: None
) -> StudyReport:
    """Compare answers on every mesh.

    Parameters
    ----------
    wrenches : int
        Of all meshes together, at least one each.
    seed : int
        Of what is touched.
    progress : callable
        Told in words what is being tried.

    Raises
    ------
    InputError
        Too few wrenches.
    """
    tried = meshes()
    if wrenches < len(tried):
        raise InputError(f"wrenches: {wrenches} are too few for {len(tried)} meshes.")
    rows, figures = [], []
    for i, probe in enumerate(tried):
        progress(probe.name)
        count = wrenches // len(tried) + (i < wrenches % len(tried))
        touched = draw(probe, count, np.random.default_rng((seed, i)))
        pruned, told = differences(probe, touched)
        rows.append((probe.name, len(probe.faces), count, pruned, told))
        figures += [
            Figure(probe.name, what, found, most=0)
            for what, found in (("differ from every facet", pruned), ("differ from bundle.md", told))
        ]
    columns = ("mesh", "facets", "wrenches", "differ from every facet", "differ from bundle.md")
    sheet = Sheet("ties", "Ties", columns, tuple(rows))
    return StudyReport("Ties", {"wrenches": wrenches, "seed": seed}, tuple(figures), (), (sheet,))


def differences(probe: Probe, wrenches: Float) -> tuple[int, int]:
    """Count answers that differ from those of every facet one by one, and from those of the page."""
    config = example(200)
    config = replace(config, probe=probe, files={**config.files, "probe.ply": encode_probe(probe)})
    given = {name: value for name, value in kernel_arguments(config).items() if name in _GIVEN}
    arrays = [given.pop(name) for name in _GIVEN[:4]]
    solver = kernel.Solver(*arrays, **given)
    with tempfile.TemporaryDirectory() as folder:
        config.write(Path(folder) / "bundle")
        reference = Reference(Path(folder) / "bundle")
    batch = solver.locate_batch(wrenches)
    differ = 0
    for i, wrench in enumerate(wrenches):
        there = reference.located(wrench, reference.C, None, reference.l0)
        same = Reason(batch.reasons[i]).name.lower() == there.reason
        if same and there.chosen is not None:
            off = float(np.linalg.norm(batch.points[i] - there.chosen.point))
            same = (
                batch.faces[i] == there.chosen.face
                and off < _NEAR_M
                and batch.candidates[i] == there.candidates
            )
        differ += not same
    return len(solver.search_differences(wrenches, None)), differ


def draw(probe: Probe, count: int, rng: np.random.Generator) -> Float:
    """Give wrenches (count, 6), half of them without noise, through the places that rounding would choose between."""
    corners, faces = probe.vertices[probe.faces], rng.integers(len(probe.faces), size=count)
    middle = np.array([[1.0, 0, 0], [0.5, 0.5, 0], [1 / 3, 1 / 3, 1 / 3], [0.25, 0.5, 0.25]])
    points = np.einsum("nk,nki->ni", middle[rng.integers(len(middle), size=count)], corners[faces])
    between = rng.random(count) < 0.3  # on a plane of symmetry, maybe beside the surface
    points[between] = 0.5 * (points[between] + rng.permutation(points[between]))
    axes = np.array([a for a in product((-1.0, 0.0, 1.0), repeat=3) if any(a)])
    forces = axes[rng.integers(len(axes), size=count)]
    pressed = rng.random(count) < 0.6
    forces[pressed] = -probe.normals[faces[pressed]]
    away = np.sum(forces * probe.normals[faces], axis=1) > 0
    forces[away] *= -1
    forces *= (rng.integers(1, 12, count) / np.linalg.norm(forces, axis=1))[:, None]
    torsion = rng.choice([0.0, 0.0, 5e-4, -2e-3], count)[:, None] * forces
    wrenches = np.hstack([forces, np.cross(points, forces) + torsion])
    noisy = rng.random(count) < 0.5
    wrenches[noisy] += rng.standard_normal((int(noisy.sum()), 6)) * np.repeat([0.05, 0.002], 3)
    return np.asarray(wrenches)


def meshes() -> list[Probe]:
    """Return 30 meshes: boxes, parallel plates, steps, prongs, cylinders, and the bundled probes."""
    side, thin = (-20.0, 20.0), Box((-20, 20), (-20, 20), (0, 10))
    found = {
        f"box in cells of {step:g} mm": blocks(Box(side, side, (0, 20)), step=step) for step in (40, 20, 10)
    }
    for gap in (0.4, 1.0, 2.0, 2.5, 3.0, 3.6, 5.0, 10.0):
        over = blocks(Box((-20, 0), side, (10 + gap, 12 + gap)))
        found[f"plates {gap:g} mm apart"] = joined(blocks(thin), over)
    at = range(-20, 20, 10)
    for step in (0.5, 1.0, 2.0, 2.5, 3.0, 4.0, 5.0):
        raised = [Box((x, x + 10), (y, y + 10), (10, 10 + step)) for x in at for y in at if (x + y) % 20]
        found[f"steps of {step:g} mm"] = blocks(thin, *raised)
    for wide in (2, 5):
        prongs = [Box((x, x + wide), (y, y + wide), (10, 30)) for x in at for y in at]
        found[f"prongs of {wide} mm"] = blocks(thin, *prongs)
    for sides in (4, 6, 8, 12, 16, 24, 36):
        found[f"cylinder of {sides} sides"] = lathe([(0, 0), (10, 0), (10, 20), (10, 40), (0, 40)], sides)
    made = [Probe.from_arrays(1e-3 * mesh.vertices, mesh.faces, name=name) for name, mesh in found.items()]
    return made + [Probe.from_arrays(*assets.make(name, 250), name=name) for name in assets.PROBE_NAMES]
