"""Next to edges and vertices: when rounding names another facet, and how far the answer jumps across an edge."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from contactbench.pipeline.contact import ContactSolver, Gates
from contactbench.pipeline.study import hard_meshes as hm
from contactbench.pipeline.study.hard_trials import EXACT
from contactbench.pipeline.study.stability import DOUBLE, NEAR, OPEN, QUIET, REFUSED, SURE_SHARE

from . import theory
from .rounding import both_precisions, measure
from .theory import Row, Where, count

if TYPE_CHECKING:
    from contactbench.pipeline.study.hard_meshes import Body, Ints, Long

    from .builds import Workshop

PART = "edges"
PITCH = "local torque over force, mm"
OTHER = "answered by another facet or vertex"
UNANSWERED = "not answered"
JUMP = "jump of the point across an edge"
JUMP_OFF = "jump, off its prediction by"
MEASURED, PREDICTED = "measured", "|h| |n1 x n2| / (|n1.f| |n2.f|)"


def run(samples: int, seed: int, workshop: Workshop | None) -> list[Row]:
    """Measure next to edges, next to vertices, and the jumps between facets."""
    body = hm.ellipsoid()
    rows: list[Row] = []
    for power in range(1, 16, 2):
        for i, place in enumerate(("edge", "vertex")):
            rng = np.random.default_rng((seed, power, i))
            rows += _near(body, place, 10.0**-power, samples, rng, workshop)
    for power in range(3, 16, 3):
        for i, place in enumerate(("edge", "vertex")):
            rng = np.random.default_rng((seed, 100 + power, i))
            rows += _refused(hm.bundled("t-shape", 1000), place, 10.0**-power, samples, rng, workshop)
    for i, pitch in enumerate((0.03, 0.1, 0.3, 1.0)):
        rows += _jumps(body, pitch, samples, np.random.default_rng((seed, 50 + i)))
    return rows


def _near(
    body: Body, place: str, near: float, samples: int, rng: np.random.Generator, workshop: Workshop | None
) -> list[Row]:
    touches = theory.next_to(body, place, near, samples, rng)
    case = f"ellipsoid, next to {place} points"
    more: Where = {"x": near, "axis": NEAR}
    answers = both_precisions(body, touches, workshop)
    rows = measure(PART, case, body, touches, answers, **more)
    for by, found in answers.items():
        none = ~np.isfinite(found["point"][:, 0])
        other = ((found["face"] != touches.faces) | (found["vertex"] >= 0)) & ~none
        most = 0.0 if by == DOUBLE and near >= SURE_SHARE else None
        rows.append(count(PART, case, by, OTHER, int(other.sum()), samples, most=most, **more))
        rows.append(count(PART, case, by, UNANSWERED, int(none.sum()), samples, most=0.0, **more))
    return rows


def _refused(
    body: Body, place: str, near: float, samples: int, rng: np.random.Generator, workshop: Workshop | None
) -> list[Row]:
    """Count what is refused at a sharp rim because rounding names the facet on its other side."""
    touches = theory.next_to(body, place, near, samples, rng)
    rows = []
    for by, found in both_precisions(body, touches, workshop, Gates()).items():
        refused = 100.0 * float((~np.isfinite(found["point"][:, 0])).mean())
        most = 0.0 if by == DOUBLE and near >= SURE_SHARE else None
        more: Where = {"x": near, "axis": NEAR, "most": most}
        rows.append(
            Row(PART, f"T-shape, next to {place} points", by, REFUSED, "%", samples, refused, refused, **more)
        )
    return rows


def _jumps(body: Body, pitch_mm: float, samples: int, rng: np.random.Generator) -> list[Row]:
    """Let the axis of a wrench of this pitch cross the middle of edges: the answer steps along the edge."""
    (first, second), (a, b) = _edges(body, samples, rng)
    n1, n2 = body.normals[first], body.normals[second]
    f = hm.press(0.5 * (a + b), n1, rng, angle=(0.0, 45.0)).wrenches[:, :3].astype(np.longdouble)
    middle = np.cross(0.5 * (a + b), f)
    # On the first facet's side of the edge it answers at the middle; k n . F = pitch |F|^2.
    pitch = 1e-3 * pitch_mm
    k = pitch * _dot(f, f) / _dot(n1, f)
    side = 1e-9 * np.cross(np.cross(n1, b - a), f)
    solver = ContactSolver(body.probe(), QUIET, OPEN, EXACT)
    one, other = (
        solver.locate_batch(np.hstack([f, middle + k[:, None] * n1 + step]).astype(np.float64))
        for step in (side, -side)
    )
    # A step past the end of the edge, or into the gap of a vertex, is not one edge's alone.
    alone = (one.faces == first) & (other.faces == second) & (one.vertices < 0) & (other.vertices < 0)
    slant = np.abs(_dot(n1, f) * _dot(n2, f)) / _dot(f, f)
    n = np.cross(n1, n2)
    predicted = (pitch_mm * np.sqrt(_dot(n, n)) / slant).astype(np.float64)[alone]
    measured = 1e3 * np.linalg.norm(other.points - one.points, axis=1)[alone]
    case = "ellipsoid, middle of its edges"
    more: Where = {"x": pitch_mm, "axis": PITCH}
    off = 100.0 * np.abs(measured - predicted) / predicted
    return [
        Row.of(PART, case, MEASURED, JUMP, "mm", measured, **more),
        Row.of(PART, case, PREDICTED, JUMP, "mm", predicted, **more),
        Row.of(PART, case, MEASURED, JUMP_OFF, "%", off, most=1.0, **more),
    ]


def _edges(body: Body, count: int, rng: np.random.Generator) -> tuple[tuple[Ints, Ints], tuple[Long, Long]]:
    """Draw edges of a closed mesh: the facets (count,) left and right of each, and its ends (count, 3), m."""
    start, end = body.faces.ravel(), np.roll(body.faces, -1, axis=1).ravel()
    key, twin = start * len(body.vertices) + end, end * len(body.vertices) + start
    order = np.argsort(key)
    chosen = rng.integers(len(key), size=count)
    across = order[np.searchsorted(key[order], twin[chosen])]
    at = body.vertices.astype(np.longdouble)
    return (chosen // 3, across // 3), (at[start[chosen]], at[end[chosen]])


def _dot(a: Long, b: Long) -> Long:
    return np.asarray(np.einsum("ni,ni->n", a, b))
