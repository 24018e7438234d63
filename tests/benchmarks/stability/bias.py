"""A bias far above the contact: what is left of the contact when reading and bias nearly cancel."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from contactbench.pipeline.calibration import GravityModel
from contactbench.pipeline.contact import ContactSolver
from contactbench.pipeline.study import hard_meshes as hm
from contactbench.pipeline.study.hard_trials import EXACT
from contactbench.pipeline.study.stability import DOUBLE, OPEN, QUIET

from . import builds, theory
from .rounding import SINGLE
from .theory import Row, Where

if TYPE_CHECKING:
    from contactbench.pipeline.study.hard_meshes import Body, Float

    from .builds import Workshop
    from .theory import FacetTouches

PART = "bias"
RATIO = "bias, of the contact's force and torque"
ERROR = "error of the point"
OVER = "error over unit roundoff times (1 + bias) times condition"
WIRE = "double, readings as single"
# Stated: cancellation costs the readings' own rounding, and that of two more operations.
MOST_ROUNDOFFS = 16.0
_WEIGHT_N, _ARM_M = 4.0, np.array([0.003, -0.002, 0.045])
_UNITS = {DOUBLE: theory.ROUNDOFF, SINGLE: theory.FLOAT_ROUNDOFF, WIRE: theory.FLOAT_ROUNDOFF}


def run(samples: int, seed: int, workshop: Workshop | None) -> list[Row]:
    """Add a bias to contacts, take it off again, and locate."""
    rows: list[Row] = []
    body = hm.ellipsoid()
    for power in range(0, 15, 2):
        rng = np.random.default_rng((seed, power))
        rows += _biased(body, theory.touch(body, samples, rng), 10.0**power, rng, workshop)
    return rows


def _biased(
    body: Body, touches: FacetTouches, ratio: float, rng: np.random.Generator, workshop: Workshop | None
) -> list[Row]:
    model = _model(touches, ratio, rng)
    long = touches.wrenches.astype(np.longdouble)
    weight = np.asarray(model.gravity_W, np.longdouble)
    untouched = np.concatenate([weight, np.cross(_ARM_M.astype(np.longdouble), weight)])
    untouched += np.concatenate([model.force_bias, model.torque_bias])
    readings = (long + untouched).astype(np.float64)
    solver = ContactSolver(body.probe(), QUIET, OPEN, EXACT)
    answers = {
        DOUBLE: solver.locate_batch(model.compensate(np.eye(3), readings)).points,
        WIRE: solver.locate_batch(model.compensate(np.eye(3), readings.astype(np.float32))).points,
    }
    if workshop is not None:
        left = readings.astype(np.float32) - untouched.astype(np.float32)
        answers[SINGLE] = workshop.solve(builds.SINGLE, solver, left.astype(np.float64))[0]["point"]
    truth = theory.answers_on(body, touches.faces, touches.wrenches)
    normals = body.normals[touches.faces].astype(np.float64)
    scale = theory.condition(normals, touches.points, touches.wrenches)
    case = "ellipsoid, force and torque biased alike"
    more: Where = {"x": ratio, "axis": RATIO}
    rows = []
    for by, points in answers.items():
        off = np.linalg.norm((points - truth).astype(np.float64), axis=1)
        rows.append(Row.of(PART, case, by, ERROR, "mm", 1e3 * off, **more))
        over = off / (_UNITS[by] * (1 + ratio) * scale)
        # Where more than the point's facet is lost, there is no first order to compare with.
        judged = by != SINGLE and _UNITS[by] * ratio < 1e-8
        rows.append(Row.of(PART, case, by, OVER, "", over, most=MOST_ROUNDOFFS if judged else None, **more))
    return rows


def _model(touches: FacetTouches, ratio: float, rng: np.random.Generator) -> GravityModel:
    """Make a load with a bias of force and torque, `ratio` times those of the touches."""
    sizes: list[Float] = []
    for part in np.split(touches.wrenches, 2, axis=1):
        way = rng.standard_normal(3)
        sizes.append(ratio * np.linalg.norm(part, axis=1).mean() * way / np.linalg.norm(way))
    return GravityModel(np.array([0.0, 0.0, -_WEIGHT_N]), sizes[0], _ARM_M, sizes[1])
