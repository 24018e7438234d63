"""How far each method is from the truth, and how near the noise lets it be."""

from __future__ import annotations

from dataclasses import dataclass
from math import sqrt
from typing import TYPE_CHECKING, Any

import numpy as np

from contactbench.pipeline.contact import ContactSolver, Reason, TouchModel, WrenchNoise
from contactbench.pipeline.contact.methods import METHODS
from contactbench.pipeline.errors import InputError

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from contactbench.pipeline.contact import Batch
    from contactbench.pipeline.contact.methods import ContactMethod
    from contactbench.pipeline.mesh import Probe

ALL = "all"

# Enough solves for a median; the literal loop takes up to a millisecond each.
_TIMED = 400

OURS = "contactbench"

# The bound is what noise and calibration give a method that takes any torque for torsion: nothing else is added to it.
_BARE = TouchModel(torsion_arm=1000.0, model_error=WrenchNoise(0.0, 0.0), mesh_curved=False)


@dataclass(frozen=True)
class MethodErrors:
    """One method on the touches of one part of one probe."""

    method: str  # as in contactbench.pipeline.contact.methods
    where: str  # which touches: "all"; "face" and "head" where they were drawn; "0°" and "30°" on markers
    touches: int  # how many
    # mean_mm, p95_mm, max_mm: distance from the true point, mm, over the settled touches: those whose
    # answer is accepted. This and the next two are None where no touch is settled.
    mean_mm: float | None
    p95_mm: float | None
    max_mm: float | None
    # the noise bound: the root mean square error that noise and calibration alone give, mm; the root of the
    # mean trace of the covariance of the settled touches
    bound_mm: float | None
    # their root mean square error over the bound: 1 is as good as the noise allows
    over_bound: float | None
    answered: float  # share of the touches that got a point
    ambiguous: float  # share of the touches that got one with the warning that another is as likely
    median_us: float | None  # median time of a compiled solve, µs; None where there is none


def compare_methods(
    probe: Probe,
    noise: WrenchNoise,
    wrenches: NDArray[np.float64],
    points: NDArray[np.float64],
    where: NDArray[np.str_],
) -> tuple[list[MethodErrors], list[str]]:
    """Compare every method with the truth.

    Parameters
    ----------
    probe : Probe
        The mesh, S, metres.
    noise : WrenchNoise
        Of the wrenches, with what calibration leaves uncertain.
    wrenches : (n, 6)
        What is located, S, N and N·m.
    points : (n, 3)
        Where the touches truly were, S, m.
    where : (n,) of str
        The part that each touch is on, or how it was pressed.

    Returns
    -------
    errors : list of MethodErrors
        Per method: all touches, then part by part.
    notes : list of str
        A sentence for each method that is left out.
    """
    errors, notes = [], []
    for name, make in METHODS.items():
        try:
            method = make(probe, noise, None, None if name == OURS else _BARE)
        except InputError as error:
            notes.append(f"{name} is left out: {error}.")
            continue
        batch = method.locate_batch(wrenches)
        covariances = batch.covariances
        if name == OURS:
            bare = ContactSolver(probe, noise, model=_BARE)
            covariances = bare.foreign_batch(wrenches, batch.points, batch.faces, batch.torques).covariances
        median_us = _median_us(method, wrenches[:_TIMED])
        for part in (ALL, *np.unique(where).tolist()):
            rows = np.flatnonzero((where == part) | (part == ALL))
            errors.append(_errors(name, part, batch, covariances, points, rows, median_us))
    return errors, notes


def errors_mm(batch: Batch, points: NDArray[np.float64]) -> NDArray[np.float64]:
    """Distance from the true points (n, 3), mm, (n,); NaN without an answer."""
    return np.asarray(np.linalg.norm(batch.points - points, axis=1) * 1e3)


def _errors(
    method: str,
    where: str,
    batch: Batch,
    covariances: NDArray[np.float64],
    points: NDArray[np.float64],
    rows: NDArray[np.intp],
    median_us: float | None,
) -> MethodErrors:
    sure = rows[batch.accepted[rows]]
    error = errors_mm(batch, points)[sure]
    mean, p95, largest, bound, ratio = _statistics(error, covariances[sure])
    return MethodErrors(
        method,
        where,
        len(rows),
        mean_mm=mean,
        p95_mm=p95,
        max_mm=largest,
        bound_mm=bound,
        over_bound=ratio,
        answered=float(np.isfinite(batch.points[rows, 0]).mean()),
        ambiguous=float((batch.reasons[rows] == Reason.AMBIGUOUS).mean()),
        median_us=median_us,
    )


def _statistics(
    error_mm: NDArray[np.float64], covariances: NDArray[np.float64]
) -> tuple[float | None, float | None, float | None, float | None, float | None]:
    """Mean, 95th percentile, largest, bound (mm), and root mean square over the bound."""
    if not len(error_mm):
        return None, None, None, None, None
    bound = 1e3 * sqrt(float(np.trace(covariances, axis1=1, axis2=2).mean()))
    rms = sqrt(float(np.mean(error_mm**2)))
    return (
        float(error_mm.mean()),
        float(np.percentile(error_mm, 95)),
        float(error_mm.max()),
        bound,
        rms / bound,
    )


def _median_us(method: ContactMethod, wrenches: NDArray[np.float64]) -> float | None:
    engine: Any = method.engine
    if not hasattr(engine, "time_each"):
        return None
    return float(np.median(engine.time_each(wrenches))) / 1e3
