"""How a probe turns to stand upright on what it presses."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from contactbench.pipeline.control.admittance import Admittance
from contactbench.pipeline.control.axes import turn_of
from contactbench.pipeline.control.settings import Variant

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from contactbench.pipeline.control.settings import ControlSettings
    from contactbench.pipeline.control.surface import TissueSurface

_UP = np.array([0.0, 0.0, 1.0])


class Upright:
    """
    Turns by Eq. 8, from the place of the contact; the aware variant from the tissue's tilt, and ahead of its turning.

    Parameters
    ----------
    surface : TissueSurface
        What is known of the tissue.
    """

    def __init__(self, settings: ControlSettings, surface: TissueSurface) -> None:
        self._settings, self._surface = settings, surface
        inertia, damping, stiffness = settings.angle_inertia, settings.angle_damping, settings.angle_stiffness
        if settings.variant is Variant.AWARE:
            inertia = (damping[0] * settings.settling, damping[1] * settings.settling)
        self._turns = [Admittance(*gains) for gains in zip(inertia, damping, stiffness, strict=True)]
        self._leading = np.zeros(3)
        self._means = [0.0, 0.0]

    def reset(self) -> None:
        """Begin at rest."""
        self._leading = np.zeros(3)
        for turn in self._turns:
            turn.reset()

    def speed(
        self, offset: NDArray[np.float64], R_BS: NDArray[np.float64], lead: float, dt: float
    ) -> NDArray[np.float64]:
        """
        Return the angular velocity for the next dt (s), (3,) in B, rad/s.

        Parameters
        ----------
        offset : (2,)
            Contact minus wanted contact along S's x and y, m; NaN: not known.
        R_BS : (3, 3)
        lead : float
            How much older than the middle of that time what was sensed is, s.
        """
        settings = self._settings
        if settings.variant is Variant.AWARE:
            # The tilt itself instead of a place, with the damping that gives the wanted gain.
            tilt, gains, damping = self._surface.tilt, settings.angle_gains, settings.angle_damping
            torques = [tilt[axis] * gains[axis] * damping[axis] for axis in (0, 1)]
        else:
            x, y = offset.tolist()
            known = math.isfinite(x) and math.isfinite(y)
            here = np.array([x, y, 0.0]) if known else np.zeros(3)
            torques = (settings.desired_force * turn_of(here, _UP))[:2].tolist()
        self._means = [turn.step(torque, dt) for turn, torque in zip(self._turns, torques, strict=True)]
        turning = np.array([*self._means, 0.0])
        if settings.variant is Variant.AWARE:
            turning += self._led(R_BS, lead, dt)
        return np.asarray(R_BS @ turning)

    def hold_back(self, share: float, dt: float) -> None:
        """Take back what a limit left out of the step before (s): `share` of it was done."""
        for turn, mean in zip(self._turns, self._means, strict=True):
            turn.hold_back(share, dt, mean)
        self._leading *= share

    def _led(self, R_BS: NDArray[np.float64], lead: float, dt: float) -> NDArray[np.float64]:
        """Return the tissue's turning, in S, rad/s; smoothed, and ahead by as much as that is late."""
        along = R_BS.T @ self._surface.turning(lead + self._settings.smoothing)
        along[2] = 0.0  # about its own axis it does not turn
        share = 1 - math.exp(-dt / self._settings.smoothing)
        self._leading += share * (along - self._leading)
        return self._leading
