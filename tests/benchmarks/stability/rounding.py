"""How much of a solve is rounding: errors in double and single precision, over what the condition explains."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from contactbench.pipeline.contact import ContactSolver, methods
from contactbench.pipeline.study import hard_meshes as hm
from contactbench.pipeline.study.hard_trials import EXACT
from contactbench.pipeline.study.stability import (
    ALGORITHM1,
    COSINE,
    COSINES,
    DOUBLE,
    MOST_ROUNDOFFS,
    OPEN,
    QUIET,
    roundoffs,
)

from . import builds, theory
from .theory import Row

if TYPE_CHECKING:
    from contactbench.pipeline.contact import Gates
    from contactbench.pipeline.study.hard_meshes import Body

    from .builds import Rows, Workshop
    from .theory import FacetTouches

PART = "rounding"
FACETS, FAR = "facets", "distance of the mesh from the sensor origin, m"
SINGLE = "single"
_UNITS = {DOUBLE: theory.ROUNDOFF, SINGLE: theory.FLOAT_ROUNDOFF, ALGORITHM1: theory.ROUNDOFF}


def run(samples: int, seed: int, workshop: Workshop | None, *, quick: bool = False) -> list[Row]:
    """Measure rounding towards n . F = 0, with finer meshes and further from the sensor origin."""
    rows: list[Row] = []
    for i, cosine in enumerate(COSINES):
        rng = np.random.default_rng((seed, i))
        angle = np.full(samples, np.degrees(np.arccos(cosine)))
        touches = theory.touch(hm.ellipsoid(), samples, rng, angle=angle)
        case = "ellipsoid, force turned towards the facet"
        rows += _rows(case, hm.ellipsoid(), touches, workshop, x=cosine, axis=COSINE)
    for subdivisions in (1, 2, 3) if quick else (1, 2, 3, 4, 5, 6):
        body, rng = hm.ellipsoid(subdivisions), np.random.default_rng((seed, 20 + subdivisions))
        touches = theory.touch(body, samples, rng)
        rows += _rows("ellipsoid, finer and finer", body, touches, workshop, x=len(body.faces), axis=FACETS)
    for i, far in enumerate((0.0, 0.1, 1.0, 10.0)):
        body = hm.ellipsoid().moved(far * np.array([0.6, -0.64, 0.48]))
        touches = theory.touch(body, samples, np.random.default_rng((seed, 40 + i)))
        rows += _rows("ellipsoid, further and further away", body, touches, workshop, x=far, axis=FAR)
    return rows


def _rows(case: str, body: Body, touches: FacetTouches, workshop: Workshop | None, **more: Any) -> list[Row]:
    answers = both_precisions(body, touches, workshop)
    eliminated = methods.algorithm1(body.probe(), QUIET, OPEN).locate_batch(touches.wrenches)
    answers[ALGORITHM1] = builds.kernel_rows(eliminated)
    return measure(PART, case, body, touches, answers, **more)


def both_precisions(
    body: Body, touches: FacetTouches, workshop: Workshop | None, gates: Gates = OPEN
) -> dict[str, Rows]:
    """Return the answers where no noise is expected, as :data:`builds.ROW`: of the kernel, and in single precision."""
    solver = ContactSolver(body.probe(), QUIET, gates, EXACT)
    answers = {DOUBLE: builds.kernel_rows(solver.locate_batch(touches.wrenches))}
    if workshop is not None:
        answers[SINGLE] = workshop.solve(builds.SINGLE, solver, touches.wrenches)[0]
    return answers


def measure(
    part: str, case: str, body: Body, touches: FacetTouches, answers: dict[str, Rows], **more: Any
) -> list[Row]:
    """
    Give the errors of answers against the exact solution of the facet or vertex that each names.

    A row of the errors, mm, and one of them over unit roundoff and condition, which is judged but for Algorithm 1.
    """
    rows = []
    for by, found in answers.items():
        most = None if by == ALGORITHM1 else MOST_ROUNDOFFS
        named = found["point"], found["face"], found["vertex"]
        rows += roundoffs(part, case, by, body, touches, named, most=most, unit=_UNITS[by], **more)
    return rows
