"""The solver, and the long double that judges it, against exact rational numbers and itself in other units."""

from __future__ import annotations

import math
from dataclasses import replace
from fractions import Fraction
from typing import TYPE_CHECKING

import numpy as np
from benchmarks.solver import hard_meshes as hm
from benchmarks.solver.bits import Row, Where, Workshop, bit_rows, count, differing, kernel_rows

from contactbench.pipeline.contact import ContactSolver, Gates, TouchModel, WrenchNoise
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.mesh import Probe
from contactbench.pipeline.study.report import Figure, StudyReport
from contactbench.pipeline.study.stability import (
    DOUBLE,
    EXACT,
    OPEN,
    QUIET,
    ROUNDOFF,
    answers_on,
    press,
    touch,
)
from contactbench.pipeline.touch_settings import DEFAULT_FORCE_N, DEFAULT_TORQUE_NM

if TYPE_CHECKING:
    from benchmarks.solver.hard_meshes import SolidBody

    from contactbench.pipeline.contact import Contact
    from contactbench.pipeline.study.stability import Drawn, Float

    Vector = tuple[Fraction, Fraction, Fraction]
    from benchmarks.solver.bits import Rows

PART = "exact"
ERROR = "error against exact arithmetic, times the cosine of the friction angle"
OTHERWISE = "facets accepted or refused otherwise than in exact arithmetic"
DEPTH = "how far from the edge the exact point was then, times that cosine"
NONE = "wrenches without an answer, though a facet has one in exact arithmetic"
SPREAD = "answers of one wrench on a convex body, apart"
LONG = "long double"
# Stated: rounding decides only within this of an edge, mm; an answer is as near to the exact one.
MOST_MM = 1e-12
# Long double finds what exact arithmetic need not look at: it is itself right to far less than this share of a facet.
_SURE = 1e-9


def run(samples: int = 1000, seed: int = 0) -> StudyReport:
    """Compare the solver with exact arithmetic, in other units, and bit for bit with its other builds."""
    if samples < 1 or seed < 0:
        raise InputError(f"{samples} samples, seed {seed}: give at least 1 sample and a seed of at least 0")
    with Workshop() as workshop:
        rows = [*exact_rows(samples, seed), *unit_rows(samples, seed), *bit_rows(samples, seed, workshop)]
    figures = tuple(
        Figure(
            f"{row.part}: {row.case}, {row.by}" + (f", {row.x:g}" if row.x is not None else ""),
            row.figure,
            row.median,
            row.unit,
            most=row.most,
            worst=row.worst,
            judged="worst",
        )
        for row in rows
    )
    return StudyReport("Solver", {"samples": samples, "seed": seed}, figures)


def exact_rows(samples: int, seed: int) -> list[Row]:
    """Compare on facets, edges, vertices and in the gaps between facets."""
    round_body, bent = hm.ellipsoid(), hm.bundled("t-shape", 1000)
    rng = np.random.default_rng(seed)
    rows: list[Row] = []
    for case, body, drawn in (
        ("ellipsoid, inside facets", round_body, press(*hm.places(round_body, samples, rng), rng)),
        (
            "ellipsoid, on edges",
            round_body,
            press(*hm.places(round_body, samples, rng, "edge"), rng, arm=0.003),
        ),
        (
            "ellipsoid, on vertices",
            round_body,
            press(*hm.places(round_body, samples, rng, "vertex"), rng, arm=0.0),
        ),
        (
            "ellipsoid, in the gaps at vertices, where no facet answers",
            round_body,
            press(*hm.places(round_body, samples, rng, "cone"), rng, pitch=0.03),
        ),
        ("T-shape, inside facets", bent, press(*hm.places(bent, samples, rng), rng)),
        ("T-shape, on edges", bent, press(*hm.places(bent, samples, rng, "edge"), rng)),
    ):
        rows += _compared(case, body, drawn)
    return rows


def _compared(case: str, body: SolidBody, drawn: Drawn) -> list[Row]:
    solver = ContactSolver(body.probe(), QUIET, OPEN, EXACT)
    off, long_off, depths, apart, none = [], [], [0.0], [0.0], 0
    for wrench in drawn.wrenches:
        answers = _answers(solver.locate(wrench))
        facets = {face for face, _, _ in answers}
        F, M = _vector(wrench[:3]), _vector(wrench[3:])
        apart += [float(np.linalg.norm(point - answers[0][1])) for _, point, _ in answers[1:]]
        for face, point, cosine in answers:
            # Where no facet holds a touch there is none: a corner explains a wrench only as a point of its facet.
            truth = _facet_point(body, face, F, M)
            off.append(cosine * _distance(_vector(point), truth))
            long = answers_on(body, np.array([face]), wrench[None])[0]
            long_off.append(cosine * _distance(_long_vector(long), truth))
        held = False
        for face in facets | _possible(body, wrench):
            margins = _margins(body, face, F, M)
            held |= max(margins) <= 0
            # On the very edge, the solver's rule for ties decides.
            if max(margins) != 0 and (max(margins) < 0) != (face in facets):
                depths.append(_depth(body, face, F, margins))
        none += held and not answers
    tries = len(drawn)
    rows = [
        count(PART, case, DOUBLE, OTHERWISE, len(depths) - 1, tries),
        Row.of(PART, case, DOUBLE, DEPTH, "mm", 1e3 * np.array(depths), most=MOST_MM),
        count(PART, case, DOUBLE, NONE, none, tries, most=0.0),
    ]
    if off:
        rows.append(Row.of(PART, case, DOUBLE, ERROR, "mm", 1e3 * np.array(off), most=MOST_MM))
        rows.append(Row.of(PART, case, LONG, ERROR, "mm", 1e3 * np.array(long_off), most=1e-3 * MOST_MM))
    if _convex(body):
        rows.append(Row.of(PART, case, DOUBLE, SPREAD, "mm", 1e3 * np.array(apart), most=MOST_MM))
    return rows


def _convex(body: SolidBody) -> bool:
    """Tell whether no vertex lies outside a facet's plane, but for rounding."""
    used = body.vertices[np.unique(body.faces)]
    above = (used - body.corners[:, :1].astype(np.float64)) @ body.normals.astype(np.float64)[:, :, None]
    return bool(above.max() <= _SURE * body.size)


def _answers(contact: Contact) -> list[tuple[int, Float, float]]:
    """Return facet, point and cosine of the friction angle of all candidates."""
    found = [(c.face, c.point, _cosine(c.friction_angle)) for c in contact.candidates]
    if contact.point is not None and contact.face is not None:
        found.append((contact.face, contact.point, _cosine(contact.friction_angle)))
    return found


def _cosine(degrees: float) -> float:
    return math.cos(math.radians(degrees))


def _possible(body: SolidBody, wrench: Float) -> set[int]:
    """Return facets that may accept a wrench (6,), as far as long double tells."""
    every = np.arange(len(body.faces))
    hit = answers_on(body, every, np.tile(wrench, (len(every), 1)))
    facing = -(body.normals @ wrench[:3].astype(np.longdouble))
    least = hm.areal(body, every, hit).min(axis=1)
    edge_on = np.abs(facing) < _SURE * np.linalg.norm(wrench[:3])
    # Edge-on facets hold a contact only at a grazing angle that no gate lets through.
    return {int(f) for f in np.flatnonzero((facing > 0) & (least > -_SURE) & ~edge_on)}


def _corners(body: SolidBody, face: int) -> tuple[Vector, Vector, Vector]:
    a, b, c = (_vector(body.vertices[v]) for v in body.faces[face])
    return a, b, c


def _facet_point(body: SolidBody, face: int, F: Vector, M: Vector) -> Vector:
    """Solve Eq. 6 on a facet's plane: p (n . F) = n x M + (n . a) F, whatever the length of n."""
    a, b, c = _corners(body, face)
    n = _cross(_minus(b, a), _minus(c, a))
    along, height, turned = _dot(n, F), _dot(n, a), _cross(n, M)
    x, y, z = ((t + height * f) / along for t, f in zip(turned, F, strict=True))
    return x, y, z


def _margins(body: SolidBody, face: int, F: Vector, M: Vector) -> tuple[Fraction, ...]:
    """Return the wrench's moments about the three edges: all negative, and the facet accepts it."""
    corners = _corners(body, face)
    return tuple(
        _dot(M, _minus(b, a)) + _dot(F, _cross(a, b))
        for a, b in zip(corners, (*corners[1:], corners[0]), strict=True)
    )


def _depth(body: SolidBody, face: int, F: Vector, margins: tuple[Fraction, ...]) -> float:
    """Return how far the exact point is from the edge that decides, times the cosine of the friction angle, m."""
    corners = _corners(body, face)
    worst = max(range(3), key=lambda i: margins[i])
    edge = _minus(corners[(worst + 1) % 3], corners[worst])
    # A moment about an edge is its length times the point's distance times the unit normal's n . F.
    return abs(float(margins[worst])) / (_length(edge) * _length(F))


def _vector(values: Float) -> Vector:
    x, y, z = (Fraction(float(v)) for v in values)
    return x, y, z


def _long_vector(values: np.ndarray[tuple[int, ...], np.dtype[np.longdouble]]) -> Vector:
    high = values.astype(np.float64)
    low = (values - high).astype(np.float64)
    x, y, z = (Fraction(float(h)) + Fraction(float(v)) for h, v in zip(high, low, strict=True))
    return x, y, z


def _minus(a: Vector, b: Vector) -> Vector:
    return a[0] - b[0], a[1] - b[1], a[2] - b[2]


def _dot(a: Vector, b: Vector) -> Fraction:
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def _cross(a: Vector, b: Vector) -> Vector:
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]


def _length(a: Vector) -> float:
    return math.sqrt(float(_dot(a, a)))


def _distance(a: Vector, b: Vector) -> float:
    return _length(_minus(a, b))


UNITS = "units"
DIFFER, ROUNDING = "answers that differ in any bit", "point, unscaled, off by, of the probe's size"
REASON, FORGOTTEN = "another reason", "another reason when the gates stay in metres and newtons"
LENGTH, FORCE = "numbers of length, of those in metres", "numbers of force, of those in newtons"
NAMED = {"µm": 1e6, "mm": 1e3, "m": 1.0, "km": 1e-3}
# Stated: unscaling is a matter of roundoffs.
MOST_ROUNDOFFS = 100 * ROUNDOFF
# As delivered, on a mesh that is a little off; and without lengths of its own, for units in which 1 mm is more than a
# model allows.
USUAL, AXIS = TouchModel(mesh_deviation=1e-4), TouchModel(torsion_arm=0.0)
_MOST_LENGTH = 1e6


def unit_rows(samples: int, seed: int) -> list[Row]:
    """Scale lengths and forces by powers of ten and of two."""
    body, rng = hm.bundled("t-shape", 1000), np.random.default_rng(seed)
    wrenches = touch(body, samples, rng, angle=(0.0, 70.0)).wrenches
    scene, axis = (_Scene(body, wrenches, model) for model in (USUAL, AXIS))
    rows: list[Row] = []
    for factor in (*NAMED.values(), 1e-6, 1e-9, 1e-12):
        rows += scene.scaled("lengths in another unit", factor, 1.0, {"x": factor, "axis": LENGTH})
    rows += axis.scaled("lengths in another unit, wrench axis", 1e9, 1.0, {"x": 1e9, "axis": LENGTH})
    for factor in (1e-9, 1e-6, 1e-3, 1e3, 1e6, 1e9):
        rows += scene.scaled("forces in another unit", 1.0, factor, {"x": factor, "axis": FORCE})
    for power in (-40, -20, -1, 1, 20, 30):
        small = 2.0**power <= _MOST_LENGTH
        said = "lengths times a power of two" if small else "lengths times a power of two, wrench axis"
        rows += (scene if small else axis).scaled(
            said, 2.0**power, 1.0, {"x": 2.0**power, "axis": LENGTH}, exact=True
        )
        rows += scene.scaled(
            "forces times a power of two", 1.0, 2.0**power, {"x": 2.0**power, "axis": FORCE}, exact=True
        )
    for power in (-30, -60, -90, -120, -150):
        rows += scene.scaled("lengths far out", 10.0**power, 1.0, {"x": 10.0**power, "axis": LENGTH})
    return rows + [scene.forgotten(name, factor) for name, factor in NAMED.items()]


class _Scene:
    """One probe and its wrenches, to be scaled."""

    def __init__(self, body: SolidBody, wrenches: Float, model: TouchModel) -> None:
        self.body, self.wrenches, self.model = body, wrenches, model
        # What lies in front has odds of its own from 3 mm on, whatever the unit: without these, every limit scales.
        self.gates = Gates(first_odds=1.0)
        self.base = self._answers(1.0, 1.0, self.gates)

    def _answers(self, length: float, force: float, gates: Gates) -> Rows:
        probe = Probe.from_arrays(self.body.vertices * length, self.body.faces, check_size=False)
        noise = WrenchNoise(0.05 * force, 0.002 * force * length)
        model = replace(
            self.model,
            torsion_arm=self.model.torsion_arm * length,
            model_error=WrenchNoise(DEFAULT_FORCE_N * force, DEFAULT_TORQUE_NM * force * length),
            mesh_deviation=self.model.mesh_deviation * length,
        )
        solver = ContactSolver(probe, noise, gates, model)
        wrenches = self.wrenches * np.repeat([force, force * length], 3)
        return kernel_rows(solver.locate_batch(wrenches))

    def _gates(self, length: float, force: float) -> Gates:
        scaled = {"min_force": force, "ambiguity_distance": length, "follow_distance": length}
        scaled["depth_distance"] = length
        values = {name: getattr(self.gates, name) * scale for name, scale in scaled.items()}
        return self.gates.model_copy(update=values)

    def scaled(
        self, case: str, length: float, force: float, more: Where, *, exact: bool = False
    ) -> list[Row]:
        """Scale probe, wrenches, noise, model and gates, solve, and unscale."""
        found = self._answers(length, force, self._gates(length, force))
        for name, factor in (("point", length), ("torque", force * length), ("covariance", length**2)):
            found[name] /= factor
        reasons = 100.0 * float(np.mean(found["reason"] != self.base["reason"]))
        rows = [Row(UNITS, case, DOUBLE, REASON, "%", len(found), reasons, reasons, most=0.0, **more)]
        if exact:
            bits = int(differing(found, self.base).sum())
            return [*rows, count(UNITS, case, DOUBLE, DIFFER, bits, len(found), most=0.0, **more)]
        off = np.linalg.norm(found["point"] - self.base["point"], axis=1) / self.body.size
        return [*rows, Row.of(UNITS, case, DOUBLE, ROUNDING, "", off, most=MOST_ROUNDOFFS, **more)]

    def forgotten(self, unit: str, length: float) -> Row:
        """Scale all but the gates: the limits that have a unit decide otherwise then."""
        found = self._answers(length, 1.0, self.gates)
        share = 100.0 * float(np.mean(found["reason"] != self.base["reason"]))
        more: Where = {"x": length, "axis": LENGTH}
        return Row(
            UNITS,
            f"lengths in {unit}, gates in metres",
            DOUBLE,
            FORGOTTEN,
            "%",
            len(found),
            share,
            share,
            **more,
        )
