"""Is what is sure right? Edges of thin fins, touches beside a declared region, and pulls that nobody modelled."""

from __future__ import annotations

from functools import partial
from itertools import product
from typing import TYPE_CHECKING

import manifold3d
import numpy as np
from benchmarks.solids import box, capsule

from contactbench.assets import PROBE_NAMES
from contactbench.pipeline.contact import ContactSolver, Reason, WrenchNoise
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.mesh import Probe
from contactbench.pipeline.simulation import add_noise, draw_touches
from contactbench.pipeline.simulation.marker_touches import check_bundled
from contactbench.pipeline.study.confidence.cases import ASTRAY_M, NOISES, ask, mesh, press
from contactbench.pipeline.study.harness import chances
from contactbench.pipeline.study.report import Figure, StudyReport
from contactbench.pipeline.study.sweep.plan import MeshSurface, TouchedBody, body_of

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence

    from contactbench.pipeline.study.confidence.cases import Measured

    Case = tuple[str, Callable[[np.random.Generator], Measured], float | None]

FINS_M, PULLS_N = (0.0003, 0.0008, 0.002), (0.2, 0.5)
PULL_HEIGHT_M = 0.03  # above the sensor: where a cable is tied to the tool
_FACE_M, _FACING = 0.015, 0.7  # the lens: so near to the tip, and so level
_WRONG = ("sure and over 10 mm off", "sure, of these over 5 mm off")  # what is judged
_MOST = 0.1  # %


def run(
    probes: Sequence[str] = PROBE_NAMES,
    *,
    touches: int = 10_000,
    seeds: int = 5,
    seed: int = 0,
    facets: int = 2_000,
    progress: Callable[[str], None] = lambda _: None,
) -> StudyReport:
    """Measure every case, each with several seeds."""
    if touches < 100 or seeds < 1 or seed < 0:
        raise InputError(f"{touches} touches, {seeds} seeds, seed {seed}: give at least 100, 1 and 0.")
    figures = []
    for number, (name, measure, most) in enumerate(_cases(check_bundled(probes), touches, facets)):
        progress(name)
        found = [measure(rng) for rng in chances(seeds, seed, number)]
        for figure in found[0]:
            shares = [100 * one[figure] for one in found]
            figures.append(Figure.of(name, figure, shares, "%", most=most if figure in _WRONG else None))
    about = {"touches": touches, "seeds": seeds, "first seed": seed, "facets": facets}
    return StudyReport("Is what is sure right?", about, tuple(figures))


def _cases(probes: Sequence[str], count: int, facets: int) -> Iterator[Case]:
    for thickness, (said, noise) in product(FINS_M, NOISES.items()):
        yield f"fin of {1e3 * thickness:g} mm, {said} noise", partial(fin, thickness, noise, count), _MOST
    for probe in probes:
        yield f"{probe}, lens declared, touched anywhere", partial(region, probe, facets, count), _MOST
        for (said, noise), declared, pull in product(NOISES.items(), (False, True), PULLS_N):
            name = (
                f"{probe}, pulled by {pull:g} N, {said} noise, {'lens declared' if declared else 'no region'}"
            )
            case = partial(pulled, probe, facets, noise, pull, count, region=declared)
            # A pull of ten times the model's error is shown, not judged.
            yield name, case, _MOST if pull == PULLS_N[0] else None


def fin(thickness: float, noise: WrenchNoise, count: int, rng: np.random.Generator) -> Measured:
    """Press on the edge of a thin fin: beside it, the body behind it answers as well."""
    probe, edge = make_fin(thickness)
    asked = press(TouchedBody(edge, 0.0), ContactSolver(probe, noise), count, rng, force=(5.0, 10.0))
    return {
        "sure": float(asked.sure.mean()),
        "sure and over 10 mm off": float(np.mean(asked.sure & asked.off(ASTRAY_M))),
        "ambiguous": asked.reason(Reason.AMBIGUOUS),
    }


def region(name: str, facets: int, count: int, rng: np.random.Generator) -> Measured:
    """Declare the lens as the region of contact, and touch anywhere."""
    asked = press(body_of(name), ContactSolver(mesh(name, facets, region=True)), count, rng)
    return {
        "sure": float(asked.sure.mean()),
        "sure, of these over 5 mm off": float(asked.off(0.005)[asked.sure].mean()),
        "by region": asked.reason(Reason.BY_REGION),
        "by region, of all over 5 mm off": float(
            np.mean(asked.off(0.005) & (asked.batch.reasons == Reason.BY_REGION))
        ),
        "ambiguous": asked.reason(Reason.AMBIGUOUS),
    }


def pulled(
    name: str,
    facets: int,
    noise: WrenchNoise,
    pull: float,
    count: int,
    rng: np.random.Generator,
    *,
    region: bool,
) -> Measured:
    """Press the lens with 7 N while something that nobody told of pulls at the tool's side."""
    probe = mesh(name, facets, region=region)
    solver = ContactSolver(probe, noise)
    touches = draw_touches(
        body_of(name).surface,
        count,
        rng,
        force=(7.0, 7.0),
        above=float(probe.bounds[1, 2]) - _FACE_M,
        facing=_FACING,
    )
    side = rng.uniform(0.0, 2 * np.pi, count)
    force = pull * np.stack([np.cos(side), np.sin(side), np.zeros(count)], axis=1)
    unmodelled = np.hstack([force, np.cross([0.0, 0.0, PULL_HEIGHT_M], force)])
    asked = ask(solver, touches, add_noise(touches.wrenches + unmodelled, noise, rng))
    wrong = asked.off(ASTRAY_M)
    return {
        "sure": float(asked.sure.mean()),
        "sure and over 10 mm off": float(np.mean(asked.sure & wrong)),
        "accepted": float(asked.batch.accepted.mean()),
        "accepted and over 10 mm off": float(np.mean(asked.batch.accepted & wrong)),
        "ambiguous": asked.reason(Reason.AMBIGUOUS),
    }


# ---- a capsule with a fin -------------------------------------------------------------------------------------


def make_fin(thickness: float) -> tuple[Probe, MeshSurface]:
    """Return a closed capsule along z with a fin of 12 mm along +x, as thick as given, m, and the fin's outer edge."""
    half = 500 * thickness
    body = capsule(15.0, 70.0).warped(lambda points: points + [0.0, 0.0, 15.0])
    one, other = (
        manifold3d.Manifold(manifold3d.Mesh64(each.vertices, each.faces.astype(np.uint64)))
        for each in (body, box((0.0, 27.0), (-half, half), (25.0, 75.0), 3.0))
    )
    whole = (one + other).to_mesh64()
    vertices, faces = 1e-3 * whole.vert_properties, whole.tri_verts.astype(np.int32)
    outer = vertices[faces][:, :, 0].min(axis=1) > 0.0269
    probe = Probe.from_arrays(vertices, faces, name=f"fin of {1e3 * thickness:g} mm")
    return probe, MeshSurface(Probe.from_arrays(vertices, faces[outer], name="edge"))
