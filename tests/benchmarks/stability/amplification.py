"""What a small error of the wrench does to the point: measured against first-order theory."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from contactbench.pipeline.contact import ContactSolver, WrenchNoise
from contactbench.pipeline.simulation import add_noise
from contactbench.pipeline.study import hard_meshes as hm
from contactbench.pipeline.study.hard_trials import EXACT
from contactbench.pipeline.study.stability import COSINE, COSINES, OPEN, PREDICTED, QUIET

from . import theory
from .theory import Row, Where

if TYPE_CHECKING:
    from contactbench.pipeline.study.hard_meshes import Body, Float

    from .theory import FacetTouches

PART = "amplification"
MEASURED = "measured"
OFF = "change of the point, off its first-order prediction by"
GROWS = "point moved, of each unit of relative error"
SPREAD = "rms error with the default noise"
FORCE = "force, N"
_FIRST_ORDER = 1.0  # %


def run(samples: int, seed: int) -> list[Row]:
    """Measure amplification towards n . F = 0 and towards F = 0."""
    body = hm.ellipsoid()
    rows: list[Row] = []
    for i, cosine in enumerate(COSINES):
        rows += _steep(body, cosine, samples, np.random.default_rng((seed, i)))
    for power in range(2, -7, -1):
        rows += _weak(body, 10.0**power, samples, np.random.default_rng((seed, 10 - power)))
    return rows


def _steep(body: Body, cosine: float, samples: int, rng: np.random.Generator) -> list[Row]:
    """Turn the force towards the facet; the error shrinks with the cosine, or theory would not be first order."""
    angle = np.full(samples, np.degrees(np.arccos(cosine)))
    touches = theory.touch(body, samples, rng, angle=angle)
    change = theory.nudge(touches.wrenches, np.full(samples, 1e-4 * cosine), rng)
    more: Where = {"x": cosine, "axis": COSINE}
    return _compared(body, touches, change, 1e-4 * cosine, "ellipsoid, force turned towards the facet", more)


def _weak(body: Body, force: float, samples: int, rng: np.random.Generator) -> list[Row]:
    """Make the force small and keep the noise: first a millionth of it, then all of it."""
    touches = theory.touch(body, samples, rng, angle=(0.0, 30.0))
    size = force / np.linalg.norm(touches.wrenches[:, :3], axis=1, keepdims=True)
    touches = theory.FacetTouches(touches.wrenches * size, touches.points, touches.faces)
    noise, still = WrenchNoise(), np.zeros_like(touches.wrenches)
    change = 1e-6 * add_noise(still, noise, rng)
    more: Where = {"x": force, "axis": FORCE}
    case = "ellipsoid, force made small under the same noise"
    rows = _compared(body, touches, change * force / 100.0, None, case, more)
    normals = body.normals[touches.faces].astype(np.float64)
    whole = change * 1e6
    found = ContactSolver(body.probe(), QUIET, OPEN, EXACT).locate_batch(touches.wrenches + whole)
    off = 1e3 * np.linalg.norm(found.points - touches.points, axis=1)
    off = off[np.isfinite(off)]
    predicted = 1e3 * np.linalg.norm(theory.moved(normals, touches.points, touches.wrenches, whole), axis=1)
    for by, values in ((MEASURED, off), (PREDICTED, predicted)):
        rms = float(np.sqrt(np.mean(values**2))) if len(values) else np.nan
        rows.append(Row(PART, case, by, SPREAD, "mm", len(values), rms, rms, **more))
    return rows


def _compared(
    body: Body, touches: FacetTouches, change: Float, size: float | None, case: str, more: Where
) -> list[Row]:
    """Compare the solver's two answers with theory where the same facet gives both."""
    solver = ContactSolver(body.probe(), QUIET, OPEN, EXACT)
    before, after = (solver.locate_batch(w) for w in (touches.wrenches, touches.wrenches + change))
    same = (before.faces == touches.faces) & (after.faces == touches.faces)
    same &= (before.vertices < 0) & (after.vertices < 0)
    normals = body.normals[touches.faces].astype(np.float64)
    # What the sum rounded to is what changed.
    done = (touches.wrenches + change) - touches.wrenches
    predicted = theory.moved(normals, touches.points, touches.wrenches, done)[same]
    measured = (after.points - before.points)[same]
    length = np.linalg.norm(predicted, axis=1)
    off = 100.0 * np.linalg.norm(measured - predicted, axis=1) / length
    rows = [Row.of(PART, case, MEASURED, OFF, "%", off, most=_FIRST_ORDER, **more)]
    rows.append(_share(case, int(same.sum()), len(touches), more))
    if size is not None:
        for by, values in ((MEASURED, np.linalg.norm(measured, axis=1)), (PREDICTED, length)):
            rows.append(Row.of(PART, case, by, GROWS, "m", values / size, **more))
    return rows


def _share(case: str, same: int, tries: int, more: Where) -> Row:
    left = 100.0 * (1 - same / tries)
    figure = "left out: another facet answers"
    return Row(PART, case, MEASURED, figure, "%", tries, left, left, most=10.0, **more)
