"""What a small error of the wrench does to the point: measured against first-order theory."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from contactbench.pipeline.contact import ContactSolver, Gates, WrenchNoise
from contactbench.pipeline.simulation import add_noise
from contactbench.pipeline.study import hard_meshes as hm
from contactbench.pipeline.study.hard_trials import EXACT
from contactbench.pipeline.study.stability import probes, theory
from contactbench.pipeline.study.stability.rows import Row, Where

if TYPE_CHECKING:
    from collections.abc import Sequence

    from contactbench.pipeline.study.hard_meshes import Body, Float
    from contactbench.pipeline.study.stability.theory import Touches

PART = "amplification"
# No preference for the surface that is met first: it is no part of the closed form.
OPEN = Gates(friction_angle=89.9999999, min_force=0.0, first_odds=1.0)
QUIET = WrenchNoise(0.0, 0.0)
MEASURED, PREDICTED = "measured", "first order"
OFF = "change of the point, off its first-order prediction by"
GROWS = "point moved, of each unit of relative error"
SPREAD = "rms error with the default noise"
CONDITION = "condition: most that the point moves, of each unit of relative error"
COSINE, FORCE, ANGLE = "cosine of the friction angle", "force, N", "friction angle, degrees"
_FIRST_ORDER = 1.0  # %
# Down to nearly the least at which a facet answers, 0.001: what is steeper is edge-on.
COSINES = (1.0, 0.3, 0.1, 0.03, 0.01, 0.003, 0.0015)


def run(samples: int, seed: int, names: Sequence[str] = probes.BUNDLED) -> list[Row]:
    """
    Measure amplification towards n . F = 0 and towards F = 0, and the condition of ordinary solves.

    Parameters
    ----------
    samples : int
        Touches of each figure.
    seed : int
    names : sequence of str
        Probes: bundled, or prepared files in S.
    """
    body = hm.ellipsoid()
    rows: list[Row] = []
    for i, cosine in enumerate(COSINES):
        rows += _steep(body, cosine, samples, np.random.default_rng((seed, i)))
    for power in range(2, -7, -1):
        rows += _weak(body, 10.0**power, samples, np.random.default_rng((seed, 10 - power)))
    for i, name in enumerate(names):
        rows += _ordinary(name, samples, np.random.default_rng((seed, 100 + i)))
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
    touches = theory.Touches(touches.wrenches * size, touches.points, touches.faces)
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
    body: Body, touches: Touches, change: Float, size: float | None, case: str, more: Where
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


def _ordinary(name: str, samples: int, rng: np.random.Generator) -> list[Row]:
    """Give the condition of solves inside the friction cone."""
    body = probes.body_of(name, 1000)
    rows = []
    for angle in (0.0, 30.0, 60.0, 75.0):
        touches = theory.touch(body, samples, rng, angle=np.full(samples, angle))
        normals = body.normals[touches.faces].astype(np.float64)
        values = theory.condition(normals, touches.points, touches.wrenches)
        rows.append(
            Row.of(PART, probes.title_of(name), PREDICTED, CONDITION, "m", values, x=angle, axis=ANGLE)
        )
    return rows
