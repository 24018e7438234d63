"""The solver, and the long double that judges it, against exact rational numbers."""

from __future__ import annotations

import math
from fractions import Fraction
from typing import TYPE_CHECKING

import numpy as np

from contactbench.pipeline.contact import ContactSolver
from contactbench.pipeline.study import hard_meshes as hm
from contactbench.pipeline.study.hard_trials import EXACT
from contactbench.pipeline.study.stability import OPEN, QUIET

from . import theory
from .theory import Row, count

if TYPE_CHECKING:
    from contactbench.pipeline.contact import Contact
    from contactbench.pipeline.study.hard_meshes import Body, Drawn, Float

    Vector = tuple[Fraction, Fraction, Fraction]

PART = "exact"
ERROR = "error against exact arithmetic, times the cosine of the friction angle"
OTHERWISE = "facets accepted or refused otherwise than in exact arithmetic"
DEPTH = "how far from the edge the exact point was then, times that cosine"
NONE = "wrenches without an answer, though a facet has one in exact arithmetic"
SPREAD = "answers of one wrench on a convex body, apart"
DOUBLE, LONG = "double", "long double"
# Stated: rounding decides only within this of an edge, mm; an answer is as near to the exact one.
MOST_MM = 1e-12
# Long double finds what exact arithmetic need not look at: it is itself right to far less than this share of a facet.
_SURE = 1e-9


def run(samples: int, seed: int) -> list[Row]:
    """Compare on facets, edges, vertices and in the gaps between facets."""
    round_body, bent = hm.ellipsoid(), hm.bundled("t-shape", 1000)
    rng = np.random.default_rng(seed)
    rows: list[Row] = []
    for case, body, drawn in (
        ("ellipsoid, inside facets", round_body, hm.press(*hm.places(round_body, samples, rng), rng)),
        (
            "ellipsoid, on edges",
            round_body,
            hm.press(*hm.places(round_body, samples, rng, "edge"), rng, arm=0.003),
        ),
        (
            "ellipsoid, on vertices",
            round_body,
            hm.press(*hm.places(round_body, samples, rng, "vertex"), rng, arm=0.0),
        ),
        (
            "ellipsoid, in the gaps at vertices, where no facet answers",
            round_body,
            hm.press(*hm.places(round_body, samples, rng, "cone"), rng, pitch=0.03),
        ),
        ("T-shape, inside facets", bent, hm.press(*hm.places(bent, samples, rng), rng)),
        ("T-shape, on edges", bent, hm.press(*hm.places(bent, samples, rng, "edge"), rng)),
    ):
        rows += _compared(case, body, drawn)
    return rows


def _compared(case: str, body: Body, drawn: Drawn) -> list[Row]:
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
            long = theory.answers_on(body, np.array([face]), wrench[None])[0]
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


def _convex(body: Body) -> bool:
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


def _possible(body: Body, wrench: Float) -> set[int]:
    """Return facets that may accept a wrench (6,), as far as long double tells."""
    every = np.arange(len(body.faces))
    hit = theory.answers_on(body, every, np.tile(wrench, (len(every), 1)))
    facing = -(body.normals @ wrench[:3].astype(np.longdouble))
    least = hm.areal(body, every, hit).min(axis=1)
    edge_on = np.abs(facing) < _SURE * np.linalg.norm(wrench[:3])
    # Edge-on facets hold a contact only at a grazing angle that no gate lets through.
    return {int(f) for f in np.flatnonzero((facing > 0) & (least > -_SURE) & ~edge_on)}


def _corners(body: Body, face: int) -> tuple[Vector, Vector, Vector]:
    a, b, c = (_vector(body.vertices[v]) for v in body.faces[face])
    return a, b, c


def _facet_point(body: Body, face: int, F: Vector, M: Vector) -> Vector:
    """Solve Eq. 6 on a facet's plane: p (n . F) = n x M + (n . a) F, whatever the length of n."""
    a, b, c = _corners(body, face)
    n = _cross(_minus(b, a), _minus(c, a))
    along, height, turned = _dot(n, F), _dot(n, a), _cross(n, M)
    x, y, z = ((t + height * f) / along for t, f in zip(turned, F, strict=True))
    return x, y, z


def _margins(body: Body, face: int, F: Vector, M: Vector) -> tuple[Fraction, ...]:
    """Return the wrench's moments about the three edges: all negative, and the facet accepts it."""
    corners = _corners(body, face)
    return tuple(
        _dot(M, _minus(b, a)) + _dot(F, _cross(a, b))
        for a, b in zip(corners, (*corners[1:], corners[0]), strict=True)
    )


def _depth(body: Body, face: int, F: Vector, margins: tuple[Fraction, ...]) -> float:
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
