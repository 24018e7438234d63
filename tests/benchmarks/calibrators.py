"""Gravity calibration: ours beside the plain least squares of public tools, on the same poses."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np
from benchmarks.gravity import measured_regressor

from contactbench.pipeline.calibration import calibrate
from contactbench.pipeline.calibration.contact_error import usual_task
from contactbench.pipeline.calibration.model import STANDARD_GRAVITY, cross_matrix
from contactbench.pipeline.calibration.poses import stack
from contactbench.pipeline.simulation.weighing import bump, draw_weighing
from contactbench.pipeline.study.rivals.interleave import medians
from contactbench.pipeline.study.rivals.rows import OURS, TOLD, Contender, Row, erred, known, timed

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from numpy.typing import NDArray

    from contactbench.pipeline.calibration.poses import Stack
    from contactbench.pipeline.simulation.weighing import Weighing

FAMILY = "gravity calibration"
ONE = "one calibration of 12 poses"
MEASURED = "two-stage least squares, measured force"
VERTICAL = "one least squares, vertical known"
_TILT = np.radians(1.0)
_LIGHT: dict[str, Any] = {"mass": (0.1, 0.1), "force_noise": (0.2, 0.2), "torque_noise": (0.002, 0.002)}


def known_vertical(R_SW: NDArray[np.float64], F: NDArray[np.float64], M: NDArray[np.float64]) -> Any:
    """
    Return the parameters (12,) by one plain least squares for mass, mass times centre, and biases: ten unknowns.

    Gravity is taken to point along -z of W, and newtons weigh as much as newton metres.
    """
    n = len(R_SW)
    g = R_SW @ np.array([0.0, 0.0, -STANDARD_GRAVITY])
    A = np.zeros((n, 6, 10))
    A[:, :3, 0] = g
    A[:, 3:, 1:4] = -cross_matrix(g)
    A[:, :3, 4:7] = A[:, 3:, 7:10] = np.eye(3)
    x = np.linalg.lstsq(A.reshape(-1, 10), np.hstack([F, M]).ravel(), rcond=None)[0]
    return np.concatenate([[0.0, 0.0, -STANDARD_GRAVITY * x[0]], x[4:7], x[1:4] / x[0], x[7:10]])


PLAIN: dict[str, Callable[..., Any]] = {MEASURED: measured_regressor, VERTICAL: known_vertical}


def calibration_rows(trials: int, rounds: int, seed: int) -> Iterator[Row]:
    """Measure all on clean poses, on a light load, with a bumped pose, and with a base that is not level."""
    yield known(FAMILY, Contender(OURS))
    for name in PLAIN:
        yield {**known(FAMILY, Contender(name)), "version": f"as described, NumPy {np.__version__}"}
    conditions: dict[str, Callable[[np.random.Generator], Weighing]] = {
        "clean, 8 to 12 poses": lambda rng: draw_weighing(rng, poses=(8, 12)),
        "0.1 kg, 0.2 N of noise": lambda rng: draw_weighing(rng, poses=(8, 12), **_LIGHT),
        "two of ten poses bumped": lambda rng: bump(draw_weighing(rng, poses=(10, 10)), 0.2, rng),
    }
    for condition, draw in conditions.items():
        rng = np.random.default_rng([seed, 23])
        yield from _errors(condition, [draw(rng) for _ in range(trials)], level=True)
    rng = np.random.default_rng([seed, 23])
    drawn = [draw_weighing(rng, poses=(8, 12)) for _ in range(trials)]
    yield from _errors("base tilted by 1°", drawn, level=False)
    yield from _times(draw_weighing(np.random.default_rng([seed, 24]), poses=(12, 12)), rounds)


def _errors(condition: str, drawn: list[Weighing], *, level: bool) -> Iterator[Row]:
    errors: dict[str, list[float]] = {OURS: [], TOLD: [], **{name: [] for name in PLAIN}}
    cosine, sine = np.cos(_TILT), np.sin(_TILT)
    tilt = np.eye(3) if level else np.array([[1, 0, 0], [0, cosine, -sine], [0, sine, cosine]])
    for weighing in drawn:
        true = weighing.truth.vector
        arrays = stack(weighing.poses)
        # Orientations are told in a base that is taken for level: gravity is tilted in it.
        R_SW = arrays.R_SW @ tilt.T
        true = np.concatenate([tilt @ true[:3], true[3:]])
        poses = [replace(pose, R_WS=R.T) for pose, R in zip(weighing.poses, R_SW, strict=True)]
        errors[OURS].append(_shift(calibrate(poses).model.vector, true))
        errors[TOLD].append(_shift(calibrate(poses, weighing.noise).model.vector, true))
        for name, fit in PLAIN.items():
            errors[name].append(_shift(fit(R_SW, arrays.F, arrays.M), true))
    ours = np.array(errors[OURS])
    for name, metres in errors.items():
        yield erred(FAMILY, name, "worst of the usual task", condition, np.array(metres), ours)


def _shift(theta: NDArray[np.float64], true: NDArray[np.float64]) -> float:
    """Return by how much wrong parameters move a contact, m: the largest of the usual task's touches."""
    moved = usual_task().parameter_sensitivity(true) @ (theta - true)
    return float(np.linalg.norm(moved, axis=-1).max())


def _times(weighing: Weighing, rounds: int) -> Iterator[Row]:
    arrays: Stack = stack(weighing.poses)
    nothing = [None]
    calls: dict[str, Any] = {
        OURS: (lambda _: calibrate(weighing.poses), nothing),
        TOLD: (lambda _: calibrate(weighing.poses, weighing.noise), nothing),
    }
    for name, fit in PLAIN.items():
        calls[name] = (lambda _, fit=fit: fit(arrays.R_SW, arrays.F, arrays.M), nothing)
    for name, us in medians(calls, rounds).items():
        yield timed(FAMILY, name, "worst of the usual task", ONE, us)
