"""What a controller is built on, and what a step of it decides."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from contactbench.pipeline.errors import InputError

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from contactbench.pipeline.control.intake import Sensed
    from contactbench.pipeline.control.inverse import JointStep
    from contactbench.pipeline.control.states import ControlState, StateChange


@dataclass(frozen=True, eq=False)
class SensorMount:
    """
    How the sensor sits on the flange.

    Raises
    ------
    InputError
        It is no rotation, or a number is not finite.
    """

    R_ES: NDArray[np.float64]  # (3, 3)
    p_ES_E: NDArray[np.float64]  # (3,) m

    def __post_init__(self) -> None:
        R, p = np.array(self.R_ES, dtype=np.float64), np.array(self.p_ES_E, dtype=np.float64)
        proper = (
            R.shape == (3, 3)
            and np.isfinite(R).all()
            and np.allclose(R @ R.T, np.eye(3), atol=1e-6)
            and np.linalg.det(R) > 0
        )
        if not proper or p.shape != (3,) or not np.isfinite(p).all():
            raise InputError(
                "mount: R_ES must be a rotation (3, 3), p_ES_E three finite numbers (m): take both from the drawing"
                " of the adapter between flange and sensor."
            )
        object.__setattr__(self, "R_ES", R)
        object.__setattr__(self, "p_ES_E", p)


@dataclass(frozen=True, eq=False)
class ControlCommand:
    """What a step decided."""

    q: NDArray[np.float64]  # (n,) Set-point of the joints at the end of the period
    state: ControlState
    change: StateChange | None  # what changed in this step, and why
    twist: NDArray[np.float64]  # (6,) wanted velocity of the tip and angular velocity, in B, m/s and rad/s
    force: float  # pressing force, N; NaN without a fresh sample
    # (2,) contact minus wanted contact along S's x and y, m; NaN where it is not known
    offset: NDArray[np.float64]
    sensed: Sensed
    step: JointStep  # what the arm makes of the twist
