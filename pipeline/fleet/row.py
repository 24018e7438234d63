"""What the table has of a session: one declaration of its columns."""

from __future__ import annotations

from dataclasses import dataclass, fields
from datetime import date, datetime
from typing import Any, get_type_hints

AXES = "xyz"


@dataclass(frozen=True)
class FleetRow:
    """
    One session: its newest calibration and verification. SI units; None: it has none, or nobody said.

    Bias, mass and centre of mass have their standard deviations beside them, in ``..._sigma_...``.
    """

    journal: str  # SHA-256: it changes with whatever is in the session
    files: str  # JSON: size and time of each other file that was read
    place: str  # Of the folder or archive
    session: str  # Its id; a copy has the same
    records: int  # Of its journal
    sensor: str  # Serial number
    model: str
    tool: str
    operator: str
    certificate: str
    due: date | None  # Until when the sensor's certificate is valid
    due_unreadable: str  # What is said in place of that date, and is none
    calibrated: datetime | None
    verdict: str
    stale: bool  # Whether the calibration no longer follows from what the session holds
    poses: int | None
    temperature_C: float | None  # Mean over the poses
    force_bias_x_N: float | None = None
    force_bias_y_N: float | None = None
    force_bias_z_N: float | None = None
    torque_bias_x_Nm: float | None = None
    torque_bias_y_Nm: float | None = None
    torque_bias_z_Nm: float | None = None
    mass_kg: float | None = None
    centre_x_m: float | None = None
    centre_y_m: float | None = None
    centre_z_m: float | None = None
    force_bias_sigma_x_N: float | None = None
    force_bias_sigma_y_N: float | None = None
    force_bias_sigma_z_N: float | None = None
    torque_bias_sigma_x_Nm: float | None = None
    torque_bias_sigma_y_Nm: float | None = None
    torque_bias_sigma_z_Nm: float | None = None
    mass_sigma_kg: float | None = None
    centre_sigma_x_m: float | None = None
    centre_sigma_y_m: float | None = None
    centre_sigma_z_m: float | None = None
    verified: datetime | None = None
    verification_passed: bool | None = None
    error_mean_m: float | None = None
    error_p95_m: float | None = None
    error_max_m: float | None = None


def vector(name: str, unit: str, values: Any) -> dict[str, float]:
    """Return the three columns of a vector (3,)."""
    return {f"{name}_{axis}_{unit}": float(value) for axis, value in zip(AXES, values, strict=True)}


def column_types() -> dict[str, type]:
    """Return the type of each column, without None."""
    hints = get_type_hints(FleetRow)
    return {
        each.name: next(
            kind
            for kind in (date, datetime, bool, int, float, str)
            if hints[each.name] in (kind, kind | None)
        )
        for each in fields(FleetRow)
    }
