"""An uncertainty budget of a contact point, in the manner of the GUM (JCGM 100:2008, section 5), and as a table.

Every row is one input quantity: its standard uncertainty u(x), how far a contact moves with it, c, and what that comes
to, c u(x). Inputs that were fitted together are correlated; what their errors share is a row of its own (5.2.2), which
is negative where they cancel. So the squares of all rows add up to the square of the combined uncertainty.
"""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from enum import StrEnum
from typing import Any

import numpy as np
from numpy.typing import NDArray

from contactbench.pipeline.calibration.calibrate import Calibration
from contactbench.pipeline.calibration.model import CENTRE_OF_MASS, FORCE_BIAS, GRAVITY, TORQUE_BIAS
from contactbench.pipeline.calibration.orientation import plain, signed

Array = NDArray[np.float64]

COVERAGE = 2.0  # k: about 95 % of a contact's errors are within U


class BudgetSource(StrEnum):
    """Where an uncertainty comes from."""

    NOISE_FORCE = "noise_force"
    NOISE_TORQUE = "noise_torque"
    FORCE_BIAS = "force_bias"
    TORQUE_BIAS = "torque_bias"
    MASS = "mass"
    CENTRE_OF_MASS = "centre_of_mass"
    CORRELATION = "correlation"
    MOUNT = "mount"
    MESH = "mesh"
    MARKERS = "markers"
    MODEL_FORCE = "model_force"
    MODEL_TORQUE = "model_torque"
    MODEL = "model"


@dataclass(frozen=True)
class BudgetRow:
    """One input quantity of a budget."""

    source: BudgetSource
    kind: str  # "A": from statistics of readings; "B": from anything else; empty: it is in another row
    variance_mm2: float  # c² u(x)²; of a correlation it may be negative
    standard: float | None = None  # u(x), in `unit`; None: the row is no single quantity
    unit: str = ""
    sensitivity: float | None = None  # c, mm per `unit`

    @property
    def contribution_mm(self) -> float:
        """C u(x); negative where it takes from the sum of squares."""
        return float(np.copysign(np.sqrt(abs(self.variance_mm2)), self.variance_mm2))


def combined_mm(rows: Iterable[BudgetRow]) -> float:
    """Return the combined standard uncertainty u_c, mm: the root of the sum of all squares."""
    return float(np.sqrt(max(sum(row.variance_mm2 for row in rows), 0.0)))


def input_row(source: BudgetSource, kind: str, S: Array, C: Array, unit: str, scale: float) -> BudgetRow:
    """
    Return the row of one vector of inputs.

    Parameters
    ----------
    source, kind
        See `BudgetRow`.
    S : (n, r, m)
        How the contacts of n touches move with the inputs, m per SI unit, in r directions.
    C : (m, m)
        Covariance of the inputs, SI.
    unit : str
    scale : float
        From SI to `unit`: 1e3 for mN·m.

    Returns
    -------
    BudgetRow
        The variance is the mean over the touches, of all directions together; u(x) is that of one axis.
    """
    variance = 1e6 * mean_variance(S, C)
    sensitivity = 1e3 * float(np.sqrt((S**2).sum() / len(S))) / scale
    standard = np.sqrt(max(variance, 0.0)) / sensitivity if sensitivity > 0 else 0.0
    return BudgetRow(source, kind, variance, float(standard), unit, sensitivity)


def mean_variance(S: Array, C: Array) -> float:
    """Return the mean over n of trace(S[n] C S[n]'), for S (n, r, m) and C (m, m)."""
    return float(np.einsum("nri,ij,nrj->", S, C, S)) / len(S)


def parameter_rows(S: Array, C: Array) -> tuple[BudgetRow, ...]:
    """
    Return what a calibration's twelve parameters do, and their correlation.

    Parameters
    ----------
    S : (n, r, 12)
        How the contacts of n touches move with the parameters, m per SI unit, in r directions.
    C : (12, 12)
        Their covariance.
    """
    rows = tuple(
        input_row(source, "A", S[:, :, part], C[part, part], unit, scale)
        for source, part, unit, scale in (
            (BudgetSource.FORCE_BIAS, FORCE_BIAS, "N", 1.0),
            (BudgetSource.TORQUE_BIAS, TORQUE_BIAS, "mN·m", 1e3),
            (BudgetSource.MASS, GRAVITY, "N", 1.0),
            (BudgetSource.CENTRE_OF_MASS, CENTRE_OF_MASS, "mm", 1e3),
        )
    )
    shared = 1e6 * mean_variance(S, C) - sum(row.variance_mm2 for row in rows)
    return (*rows, BudgetRow(BudgetSource.CORRELATION, "A", shared))


def calibration_budget(calibration: Calibration) -> tuple[BudgetRow, ...]:
    """
    Return what makes up ``calibration.contact_error``: of the touch, and the direction, in which it is largest.

    Where the sensor's mounting was estimated as well, the row of the mount is what that adds to the worst case.
    """
    theta, C = calibration.model.vector, calibration.covariance
    every = calibration.task.parameter_sensitivity(theta)
    values, vectors = np.linalg.eigh(every @ C @ every.swapaxes(1, 2))
    worst = int(values[:, -1].argmax())
    rows = parameter_rows((vectors[worst, :, -1] @ every[worst])[None, None], C)
    model = 1e6 * calibration.model_error**2
    mount = 1e6 * calibration.contact_error**2 - model - sum(row.variance_mm2 for row in rows)
    if abs(mount) < _ROUNDING * 1e6 * calibration.contact_error**2:  # it was known, and this is rounding
        mount = 0.0
    return (
        *rows,
        BudgetRow(BudgetSource.MOUNT, "A" if mount else "", mount),
        BudgetRow(BudgetSource.MODEL, "B" if model else "", model),
    )


_ROUNDING = 1e-6


_NONE = "\N{EN DASH}"
SOURCE_WORDS = {
    BudgetSource.NOISE_FORCE: "noise of the force",
    BudgetSource.NOISE_TORQUE: "noise of the torque",
    BudgetSource.FORCE_BIAS: "force bias",
    BudgetSource.TORQUE_BIAS: "torque bias",
    BudgetSource.MASS: "mass (weight vector)",
    BudgetSource.CENTRE_OF_MASS: "centre of mass",
    BudgetSource.CORRELATION: "correlation of bias, mass and centre of mass",
    BudgetSource.MOUNT: "mount of the sensor",
    BudgetSource.MESH: "mesh",
    BudgetSource.MARKERS: "markers",
    BudgetSource.MODEL_FORCE: "model error of the force",
    BudgetSource.MODEL_TORQUE: "model error of the torque",
    BudgetSource.MODEL: "model error",
}


def budget_table(rows: Sequence[BudgetRow], said: Mapping[BudgetSource, str]) -> dict[str, Any] | None:
    """
    Return a budget in words; None: there is none.

    Parameters
    ----------
    rows : sequence of BudgetRow
    said : mapping
        What stands instead of a contribution, in rows that are none.
    """
    if not rows:
        return None
    u = combined_mm(rows)
    return {
        "rows": [_row(row, said) for row in rows],
        "combined": f"{length_mm(u)} mm",
        "expanded": f"{length_mm(COVERAGE * u)} mm",
        "k": f"{COVERAGE:g}",
    }


def _row(row: BudgetRow, said: Mapping[BudgetSource, str]) -> dict[str, str]:
    counts, name = bool(row.kind), SOURCE_WORDS[row.source]
    per = f"mm/({row.unit})" if "·" in row.unit else f"mm/{row.unit}"
    return {
        "source": name[:1].upper() + name[1:],
        "kind": row.kind,
        "standard": "" if row.standard is None else f"{plain(row.standard)} {row.unit}",
        "sensitivity": "" if row.sensitivity is None else f"{plain(row.sensitivity)} {per}",
        "contribution": f"{length_mm(row.contribution_mm)} mm" if counts else said.get(row.source, _NONE),
    }


def length_mm(value: float) -> str:
    """Return a length of a budget: to the micrometre, so that the squares on the page add up."""
    return signed(f"{value:.3f}")
