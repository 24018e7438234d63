"""An uncertainty budget as the macro ``budget`` of the pages shows it."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from contactbench.pipeline.calibration.budget import COVERAGE, BudgetSource, combined_mm
from contactbench.pipeline.calibration.number_text import plain, signed

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from contactbench.pipeline.calibration.budget import BudgetRow

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
    return {
        "source": name[:1].upper() + name[1:],
        "kind": row.kind,
        "standard": "" if row.standard is None else f"{plain(row.standard)} {row.unit}",
        "sensitivity": "" if row.sensitivity is None else f"{plain(row.sensitivity)} {_per(row.unit)}",
        "contribution": f"{length_mm(row.contribution_mm)} mm" if counts else said.get(row.source, _NONE),
    }


def _per(unit: str) -> str:
    return f"mm/({unit})" if "·" in unit else f"mm/{unit}"


def length_mm(value: float) -> str:
    """Return a length of a budget: to the micrometre, so that the squares on the page add up."""
    return signed(f"{value:.3f}")
