"""Where contact sensing breaks: hard cases, each judged by a truth that shares no code with the solver.

The truth is analytic (wrenches are made from known points) or worked out facet by facet in long double, see
`hard_meshes`. The literal Algorithm 1 answers the same wrenches beside contactbench.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
from benchmarks.solver import hard_meshes as hm
from benchmarks.solver.hard_meshes import SolidBody, places
from benchmarks.solver.hard_trials import (
    COLUMNS,
    CURVED,
    EXACT,
    HardCase,
    HardTrial,
    Rule,
    certified,
    complete,
    exact,
    like,
    refused,
    within,
)

from contactbench import assets
from contactbench.pipeline.contact import Gates, Reason, TouchModel, WrenchNoise
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.simulation import add_noise, draw_touches
from contactbench.pipeline.study.report import Figure, Sheet, StudyReport
from contactbench.pipeline.study.stability import Drawn, press

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from benchmarks.solver.hard_meshes import Place, Solutions

    from contactbench.pipeline.study.stability import Float

Rng = np.random.Generator

_OPEN = Gates(friction_angle=89.99)  # lets all but edge-on candidates through
_FOR_A_SHARE = 20_000
_COMPLETE = Rule("the truth is the point or a candidate within 5 mm", unflagged=1.0)


def run(
    *, samples: int = 2000, seed: int = 0, progress: Callable[[str], None] = lambda _: None
) -> StudyReport:
    """Try every hard case.

    Parameters
    ----------
    samples : int
        Wrenches of a case, at least 100; ambiguity takes ten times as many and no fewer than 20,000, a
        brute-force truth a quarter.
    seed : int
        Of the wrenches and the noise.
    progress : callable
        Told in words what is being tried.

    Raises
    ------
    InputError
        Too few samples.
    """
    if samples < 100:
        raise InputError(f"samples: {samples} are too few to meet every case; give at least 100")
    found = cases(samples, seed, progress)
    figures = tuple(Figure(case.name, "rules broken", len(case.faults), most=0) for case in found)
    notes = tuple(f"{case.name}: {case.what}. Passes when: {case.expectation}." for case in found)
    sheet = Sheet("cases", "Cases", COLUMNS, tuple(case.row for case in found))
    return StudyReport("Hard cases", {"samples": samples, "seed": seed}, figures, notes, (sheet,))


def cases(samples: int, seed: int, progress: Callable[[str], None] = lambda _: None) -> list[HardCase]:
    """Try every case of every group."""
    found = []
    for said, group in GROUPS.items():
        progress(said)
        found += [trial.run() for trial in group(samples, np.random.default_rng(seed))]
    return found


# ---- the cases ---------------------------------------------------------------------------------------


def _tangential(n: int, rng: Rng) -> Iterator[HardTrial]:
    body = hm.bundled("t-shape", 1000)
    for angles in ((80.0, 85.0), (89.0, 89.9)):
        said = " and ".join(f"{a:g}" for a in angles)
        drawn = press(*places(body, n // 4, rng), rng, angle=np.resize(angles, n // 4))
        found = [hm.solve(body, w) for w in drawn.wrenches]
        outside = drawn.take(np.array([s.angles.min() > 75.5 for s in found]))
        what = f"T-shape, force {said} degrees from the normal, no other contact inside the friction cone"
        # From 89 degrees on a graze and a miss are one: far from a closed probe some edge-on vertex always
        # answers, and calling that a touch would leave nothing to call a miss.
        reasons = [Reason.TANGENTIAL] if max(angles) < 89.0 else [Reason.TANGENTIAL, Reason.IMPLAUSIBLE]
        yield HardTrial(f"tangential {said}", what, refused(*reasons), body.probe(), outside)
        first = drawn.take(np.array([_wins(f, p) for f, p in zip(found, drawn.points, strict=True)]))
        what = (
            f"the same, cone opened to {_OPEN.friction_angle} degrees, the truth has clearly the least torque"
        )
        name, probe = f"tangential {said}, open cone", body.probe()
        yield HardTrial(name, what, exact("1e-6 m"), probe, first, gates=_OPEN)


def _force(n: int, rng: Rng) -> Iterator[HardTrial]:
    body = hm.ellipsoid()
    drawn = press(*places(body, n, rng), rng)
    unit = drawn.wrenches / np.linalg.norm(drawn.wrenches[:, :3], axis=1, keepdims=True)
    free = Gates(min_force=0.0)
    low, clipped = refused(Reason.LOW_FORCE), refused(Reason.SATURATED)
    right = exact("1e-9 m")
    safe = replace(right, words="a point right to 1e-9 m, or none", answered=(0.0, 1.0))
    for name, size, gates, rule in (
        ("zero force", 0.0, Gates(), low),
        ("zero force, no gate", 0.0, free, low),
        ("force just under its gate", 0.5 * (1 - 1e-9), Gates(), low),
        ("force just over its gate", 0.5 * (1 + 1e-9), Gates(), right),
        ("denormal force", 1e-310, Gates(), low),
        ("denormal force, no gate", 1e-310, free, safe),
        ("force with denormal square, no gate", 1e-160, free, safe),
        ("force of 1e-150 N, no gate", 1e-150, free, right),
        ("force of 1e150 N", 1e150, Gates(), right),
        ("force of 1e200 N", 1e200, Gates(), clipped),
    ):
        what = f"ellipsoid, |F| = {size:.10g} N, gate {gates.min_force:g} N, torque in proportion"
        yield HardTrial(name, what, rule, body.probe(), Drawn(size * unit, drawn.points), gates=gates)


def _numbers(n: int, rng: Rng) -> Iterator[HardTrial]:
    body = hm.bundled("t-shape", 1000)
    drawn = press(*places(body, max(1, n // 100), rng), rng)

    def spoilt(values: tuple[float, ...]) -> Drawn:
        rows = np.repeat(drawn.wrenches, 6 * len(values), axis=0)
        turn = np.arange(len(rows)) % (6 * len(values))
        rows[np.arange(len(rows)), turn % 6] = np.array(values)[turn // 6]
        return Drawn(rows, np.full((len(rows), 3), np.nan))

    bad = spoilt((np.nan, np.inf, -np.inf))
    yield HardTrial(
        "not finite", "NaN and infinity in each channel", refused(Reason.NOT_FINITE), body.probe(), bad
    )
    gates = Gates(saturation=(60.0, 60.0, 60.0, 8.0, 8.0, 8.0))
    full = spoilt((60.0, -60.0, 1e9))
    yield HardTrial(
        "saturated",
        "each channel at or past its limit",
        refused(Reason.SATURATED),
        body.probe(),
        full,
        gates=gates,
    )


def _borders(n: int, rng: Rng) -> Iterator[HardTrial]:
    body = hm.ellipsoid()
    probe = body.probe()
    spots: tuple[tuple[Place, str], ...] = (("edge", "on edges"), ("vertex", "on vertices"))
    words = "every wrench answered by an exact solution of the facet or vertex named, within 10 mm"
    # The cone is open: rounding decides which facet answers, and a neighbour may be outside the usual cone.
    for place, name in spots:
        drawn = press(*places(body, n, rng, place), rng, arm=0.0)
        what = f"ellipsoid, contacts exactly {name}, no local torque"
        yield HardTrial(f"{name}, k = 0", what, exact("1e-9 m"), probe, drawn, gates=_OPEN)
        drawn = press(*places(body, n, rng, place), rng, arm=0.003)
        what = f"ellipsoid, contacts exactly {name}, local torque about the normal of one of the facets there"
        check = certified(body, drawn.wrenches)
        yield HardTrial(
            f"{name}, k != 0", what, Rule(words, wrong=0.0), probe, drawn, gates=_OPEN, check=check
        )
    body = hm.box()
    top = body.normals[:, 2] > 0.5
    points = np.concatenate([places(body, n // 2, rng, place, among=top)[0] for place, _ in spots])
    points = np.round(points * 256) / 256  # dyadic: every product is exact, every tie is a tie
    inner = np.all((points[:, :2] > 0) & (points[:, :2] < points[:, 2].max()), axis=1)
    up = np.tile([0.0, 0.0, 1.0], (int(inner.sum()), 1))
    k = np.resize([0.0, 0.125, -0.125], len(up))[:, None] * up
    drawn = Drawn(np.hstack([-8.0 * up, np.cross(points[inner], -8.0 * up) + k]), points[inner])
    what = "box of dyadic numbers, force straight down on edges and vertices: many moments exactly zero"
    yield HardTrial("exact ties", what, exact("1e-9 m"), body.probe(), drawn)


def _gaps(n: int, rng: Rng) -> Iterator[HardTrial]:
    body = hm.ellipsoid()
    pitch = rng.choice([0.0003, 0.03, 0.3], n)
    drawn = press(*places(body, n, rng, "cone"), rng, pitch=pitch)
    rule = Rule("every wrench answered, within 4.5 of the standard deviations that are stated", unflagged=1.0)
    what = "ellipsoid, wrenches that in the closed form only a vertex answers, pitch 0.3 to 300 mm"
    yield HardTrial("gaps at vertices", what, rule, body.probe(), drawn, model=CURVED, check=within(drawn))
    few = n // 4
    inside = np.einsum("nc,ncx->nx", rng.dirichlet(np.ones(4), few), rng.choice(body.vertices, (few, 4)))
    force = 9.0 * _directions(few, rng)
    pitches = 10.0 ** rng.uniform(-6, 1, (few, 1)) * rng.choice([-1.0, 1.0], (few, 1))
    wrenches = np.hstack([force, np.cross(inside, force) + pitches * force])
    found = [hm.solve(body, w).points for w in wrenches]
    truth = np.array([p[0] if len(p) == 1 else np.full(3, np.nan) for p in found])
    what = "ellipsoid, axes through its inside from everywhere, pitch 1 um to 10 m, against brute force"
    gates = Gates(friction_angle=89.9999)
    name, drawn = "every axis through a convex body", Drawn(wrenches, truth)
    check = within(drawn)
    yield HardTrial(name, what, rule, body.probe(), drawn, gates=gates, model=CURVED, check=check)


def _ambiguity(n: int, rng: Rng) -> Iterator[HardTrial]:
    body, noise = hm.bundled("t-shape", 1000), WrenchNoise()
    probe = body.probe()
    # A share of 0.02 % takes many touches to tell from chance.
    touches = draw_touches(assets.surface("t-shape"), max(10 * n, _FOR_A_SHARE), rng, above=0.02)
    rule = Rule("at least 98 % answered, no error over 10 mm that is not flagged", (0.98, 1.0))
    facets = press(*places(body, 10 * n, rng), rng, angle=(0.0, 30.0))
    what = "T-shape, touches of its facets up to 30 degrees, no noise, and the solver expects none, but any torsion"
    yield HardTrial("ambiguity, exact", what, rule, probe, facets)
    what = "T-shape, touches of the true surface up to 30 degrees"
    clean = Drawn(touches.wrenches, touches.points)
    usual = TouchModel()
    what_clean = f"{what}, no noise, solver as delivered"
    yield HardTrial("ambiguity, no noise", what_clean, rule, probe, clean, noise, model=usual)
    words = "at least 98 % answered, at most 0.02 % with an error over 10 mm that is not flagged"
    noisy = Drawn(add_noise(touches.wrenches, noise, rng), touches.points)
    rule = Rule(words, (0.98, 1.0), 2e-4)
    yield HardTrial("ambiguity, noise", f"{what}, default noise", rule, probe, noisy, noise, model=usual)


def _saddles(n: int, rng: Rng) -> Iterator[HardTrial]:
    body = hm.bundled("t-shape", 1000)
    height = body.corners[:, :, 2].mean(axis=1)
    neck = np.asarray((height > 0.085) & (height < 0.108))
    few = n // 4
    drawn = press(*places(body, few, rng, among=neck), rng, pitch=rng.uniform(0.02, 0.5, few))
    what = "T-shape, touches on the saddle of its neck, pitch 20 to 500 mm: several contacts fit one wrench"
    check = complete(drawn)
    yield HardTrial("overlaps at saddles", what, _COMPLETE, body.probe(), drawn, gates=_OPEN, check=check)


def _meshes(n: int, rng: Rng) -> Iterator[HardTrial]:
    body = hm.ellipsoid()
    drawn = press(*places(body, n, rng), rng)
    tenth = rng.permutation(len(body.faces))[: len(body.faces) // 10]
    doubled, split = np.vstack([body.faces, body.faces[tenth]]), hm.slivered(body, tenth, 1e-6)
    for name, what, probe in (
        ("duplicate facets", "every tenth facet twice", body.probe(doubled)),
        ("sliver facets", "every tenth facet split, one part of aspect 1e6", split.probe()),
    ):
        yield HardTrial(name, f"ellipsoid, {what}", exact("1e-7 m"), probe, drawn)
    rule = Rule("every wrench answered, within 10 mm or flagged")
    what = "the same through a binary STL file: single precision makes the slivers' normals rounding"
    yield HardTrial("slivers in single precision", what, rule, hm.through_stl(split), drawn)
    rule = Rule("at least 90 % answered, no wrong point", (0.9, 1.0), wrong=0.0, tolerance_mm=1e-4)
    what = "ellipsoid, unmerged: no facet shares a vertex, so no vertex can answer"
    yield HardTrial("soup", what, rule, hm.soup(body).probe(), drawn)
    what = "ellipsoid, written as binary STL and read again"
    probe = hm.through_stl(body)
    yield HardTrial("soup through an STL file", what, exact("1e-6 m"), probe, drawn)
    some = body.faces.copy()
    some[tenth] = some[tenth, ::-1]
    words = "what is answered is right, or the mesh's health says that facets are turned over"
    rule = Rule(words, (0.0, 1.0), tolerance_mm=1e-4)
    for name, what, faces in (
        ("inside out", "all facets turned over: the far side answers", body.faces[:, ::-1]),
        ("a tenth turned over", "every tenth facet turned over: the far side or nothing answers there", some),
    ):
        yield HardTrial(name, f"ellipsoid, {what}", rule, body.probe(faces), drawn, known_bad_mesh=True)


def _origins(n: int, rng: Rng) -> Iterator[HardTrial]:
    round_body, square = hm.ellipsoid(), hm.box()
    through = np.abs(np.einsum("fi,fi->f", square.normals, square.corners[:, 0])) < 1e-12
    drawn = press(*places(square, n, rng, among=np.asarray(through)), rng)
    what = "box with the sensor origin at a corner, touches on the three sides whose plane runs through it"
    yield HardTrial("planes through the origin", what, exact("1e-9 m"), square.probe(), drawn)
    far = np.array([0.6, -0.64, 0.48])
    middle = round_body.vertices.mean(axis=0)
    for name, origin in (
        ("origin inside", middle + np.array([0.003, 0.002, -0.01])),
        ("origin on a vertex", round_body.vertices[100]),
        ("origin on a facet", round_body.vertices[round_body.faces[100]].mean(axis=0)),
        ("mesh 1 m away", middle + far),
    ):
        body = round_body.moved(-origin)
        drawn = press(*places(body, n, rng), rng)
        yield HardTrial(name, f"ellipsoid, sensor {name}", exact("1e-9 m"), body.probe(), drawn)


def _turns(n: int, rng: Rng) -> Iterator[HardTrial]:
    body = hm.bundled("t-shape", 1000)
    drawn = press(*places(body, n, rng), rng, angle=(0.0, 40.0))
    words = "the same reasons and points as the plain mesh, to 1e-9 of its size"
    same = Rule(words, (0.0, 1.0), unflagged=1.0)
    # Without any noise, the least that the solver takes instead would follow the size of the mesh's box.
    noise, gates, model = WrenchNoise(0.001, 1e-5), Gates(first_odds=1.0), replace(EXACT, torsion_arm=0.01)
    base = HardTrial("", "", same, body.probe(), drawn, noise, gates, model)

    def twin(name: str, what: str, other: SolidBody, of: Drawn, move: Callable[[Float], Float]) -> HardTrial:
        check, said = like(base, move, other.size), f"T-shape, {what}"
        return HardTrial(name, said, same, other.probe(), of, noise, gates, model, check=check)

    turn = np.linalg.qr(rng.standard_normal((3, 3)))[0]
    turn *= np.linalg.det(turn)
    turned = Drawn((drawn.wrenches.reshape(-1, 2, 3) @ turn.T).reshape(-1, 6), drawn.points @ turn.T)
    spun = SolidBody(body.vertices @ turn.T, body.faces)
    yield twin("turned", "mesh and wrench rotated", spun, turned, lambda p: p @ turn.T)
    order = rng.permutation(len(body.vertices))
    faces = np.argsort(order)[body.faces][rng.permutation(len(body.faces))]
    shuffled = SolidBody(body.vertices[order], faces)
    yield twin("shuffled", "facets and vertices in another order", shuffled, drawn, lambda p: p)


def _axes(n: int, rng: Rng) -> Iterator[HardTrial]:
    body = hm.bundled("t-shape", 1000)
    drawn = press(*places(body, n // 4, rng), rng, arm=0.0)
    alone = [np.count_nonzero(hm.solve(body, w).angles < _OPEN.friction_angle) == 1 for w in drawn.wrenches]
    drawn = drawn.take(np.array(alone))
    truth = Drawn(drawn.wrenches, np.array([hm.entry(body, w) for w in drawn.wrenches]).reshape(-1, 3))
    what = "T-shape, k = 0, where the axis enters once, against a ray against every triangle"
    yield HardTrial("wrench axis", what, exact("1e-6 m"), body.probe(), truth, gates=_OPEN)


def _torques(n: int, rng: Rng) -> Iterator[HardTrial]:
    body, bent = hm.ellipsoid(), hm.bundled("t-shape", 1000)
    drawn = press(*places(body, n, rng), rng, pitch=1.0)
    what = "ellipsoid, torque about the axis of 1 m times the force"
    free, rule = f"{what}, any torsion allowed", exact("1e-9 m")
    yield HardTrial("pitch 1 m", free, rule, body.probe(), drawn)
    known, rule = f"{what}, solver as delivered", refused(Reason.IMPLAUSIBLE)
    usual, some = TouchModel(), drawn.take(slice(0, n // 8))
    name, noise = "pitch 1 m, as delivered", WrenchNoise()
    yield HardTrial(name, known, rule, body.probe(), some, noise, model=usual)
    drawn = press(*places(body, n, rng), rng, pitch=1e3)
    what = "ellipsoid, torque about the axis of 1 km times the force, any torsion allowed"
    yield HardTrial("pitch 1 km", what, rule, body.probe(), drawn)
    drawn = press(*places(bent, n // 10, rng), rng, pitch=1.0)
    what = "T-shape, torque about the axis of 1 m times the force: several contacts answer one wrench"
    check = complete(drawn)
    yield HardTrial("pitch 1 m, T-shape", what, _COMPLETE, bent.probe(), drawn, gates=_OPEN, check=check)


def _wins(found: Solutions, truth: Float) -> bool:
    """Tell whether the truth has the least torque by 2 %: for one wrench it grows as 1 / cos(friction angle)."""
    order = np.argsort(found.angles)[:2]
    cosines = np.cos(np.radians(found.angles[order]))
    clear = len(order) < 2 or cosines[1] < 0.98 * cosines[0]
    return bool(clear and np.linalg.norm(found.points[order[0]] - truth) < 1e-9)


def _directions(count: int, rng: Rng) -> Float:
    vectors = rng.standard_normal((count, 3))
    return np.asarray(vectors / np.linalg.norm(vectors, axis=1, keepdims=True))


GROUPS: dict[str, Callable[[int, Rng], Iterator[HardTrial]]] = {
    "force along the surface": _tangential,
    "forces too small and too large": _force,
    "numbers that are none, channels at their limits": _numbers,
    "contacts on edges and vertices": _borders,
    "gaps between facets": _gaps,
    "ambiguity on a T-shape": _ambiguity,
    "overlaps at saddles": _saddles,
    "broken meshes": _meshes,
    "where the sensor origin is": _origins,
    "turns and orders": _turns,
    "the wrench axis": _axes,
    "very large torques": _torques,
}
