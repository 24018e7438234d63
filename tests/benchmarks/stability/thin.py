"""Slivers: facets thinner and thinner, flat caps over a long edge and needles with a short one."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from contactbench.pipeline.contact import ContactSolver
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.study import hard_meshes as hm
from contactbench.pipeline.study.hard_trials import EXACT
from contactbench.pipeline.study.stability import DOUBLE, ERROR, OPEN, QUIET

from . import builds, theory
from .rounding import SINGLE
from .theory import Row, Where, count

if TYPE_CHECKING:
    from contactbench.pipeline.study.hard_meshes import Body, Float, Ints

    from .builds import Workshop

PART = "thin facets"
HEIGHT = "height of the facet, of its longest edge"
NORMAL = "normal, off by"
FROM_TRUTH = "from the point that was pressed"
UNANSWERED, REFUSED = "not answered", "mesh refused"
CAP, NEEDLE = "caps", "needles"
# Stated for double precision, from a height of this on: what thinner facets do is only shown.
_HEIGHT, MOST_MM = 1e-8, 1e-3


def run(samples: int, seed: int, workshop: Workshop | None) -> list[Row]:
    """Press on thin facets."""
    rows: list[Row] = []
    for power in range(1, 16):
        for i, kind in enumerate((CAP, NEEDLE)):
            rows += _thin(kind, 10.0**-power, samples, np.random.default_rng((seed, power, i)), workshop)
    return rows


def _thin(
    kind: str, height: float, samples: int, rng: np.random.Generator, workshop: Workshop | None
) -> list[Row]:
    whole = hm.ellipsoid(2)
    chosen = rng.permutation(len(whole.faces))[: len(whole.faces) // 4]
    body, thin = (_caps if kind == CAP else _needles)(whole, chosen, height)
    more: Where = {"x": height, "axis": HEIGHT}
    try:
        touches = theory.touch(body, samples, rng, among=thin, angle=(0.0, 45.0))
        solver = ContactSolver(body.probe(), QUIET, OPEN, EXACT)
    except InputError:
        return [count(PART, kind, DOUBLE, REFUSED, 1, 1, **more)]
    rows = []
    answers = {DOUBLE: builds.kernel_rows(solver.locate_batch(touches.wrenches))}
    if workshop is not None:
        try:
            answers[SINGLE] = workshop.solve(builds.SINGLE, solver, touches.wrenches)[0]
        except InputError:
            rows.append(count(PART, kind, SINGLE, REFUSED, 1, 1, **more))
    for by, found in answers.items():
        judged = by == DOUBLE and height >= _HEIGHT
        off = theory.errors(body, found["point"], found["face"], found["vertex"], touches.wrenches)
        pressed = np.linalg.norm(found["point"] - touches.points, axis=1)
        rows += [
            Row.of(PART, kind, by, ERROR, "mm", 1e3 * off, most=MOST_MM if judged else None, **more),
            Row.of(PART, kind, by, FROM_TRUTH, "mm", 1e3 * pressed, most=MOST_MM if judged else None, **more),
            Row.of(PART, kind, by, NORMAL, "degrees", _turned(body, found), **more),
        ]
        none = int((~np.isfinite(found["point"][:, 0])).sum())
        rows.append(count(PART, kind, by, UNANSWERED, none, samples, most=0.0 if judged else None, **more))
    return rows


def _turned(body: Body, found: builds.Rows) -> Float:
    """Return the angle between each facet's normal as answered and as it is, degrees."""
    on_facet = (found["vertex"] < 0) & (found["face"] >= 0)
    given, true = found["normal"][on_facet], body.normals[found["face"][on_facet]].astype(np.float64)
    sine = np.linalg.norm(np.cross(given, true), axis=1)
    return np.asarray(np.degrees(np.arctan2(sine, np.einsum("ni,ni->n", given, true))))


def _caps(body: Body, faces: Ints, height: float) -> tuple[Body, Ints]:
    """Split facets so that one part is flat over a whole edge: its two others nearly lie on it."""
    return hm.slivered(body, faces, height), len(body.faces) - len(faces) + np.arange(len(faces))


def _needles(body: Body, faces: Ints, height: float) -> tuple[Body, Ints]:
    """Split facets at a point next to a corner: two parts have a short edge there."""
    shares = np.array([1.0 - height, 0.5 * height, 0.5 * height])
    added = np.einsum("c,ncx->nx", shares, body.vertices[body.faces[faces]])
    i, j, k = body.faces[faces].T
    new = len(body.vertices) + np.arange(len(faces))
    parts = [np.stack(t, axis=1) for t in ((i, j, new), (k, i, new), (j, k, new))]
    rest = np.delete(body.faces, faces, axis=0)
    split = hm.Body(np.vstack([body.vertices, added]), np.vstack([rest, *parts]))
    return split, len(rest) + np.arange(2 * len(faces))
