"""What a sensor's noise and friction leave of a tissue's tilt: no controller can stand more upright than it knows."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from contactbench.pipeline.control.upright import Tilt, TiltReading

if TYPE_CHECKING:
    from contactbench.pipeline.control.settings import ControlSettings, Foundation

_SECONDS = 10.0


def tilt_bound(
    settings: ControlSettings,
    foundation: Foundation,
    modulus: float,
    noise: tuple[float, float] = (0.05, 0.0014),
    count: int = 4,
) -> tuple[float, float]:
    """
    Return the standard deviation of the tilt that is known of one period, rad, about x and about y.

    The steady state of `Tilt`: with a drag of sigma s_d that lasts t_d, and the place's noise s_p = (z s_F + s_M) / f,
    a face of gain g cannot tell the tilt better than about the smaller of s_d and
    (s_p / g) sqrt(period / t_d) for long. Smoothing over time, as a controller does, takes off the share that is new
    in each period; what drag leaves stays.

    Parameters
    ----------
    foundation : Foundation
        Of the probe.
    modulus : float
        Of the tissue, N/m³.
    noise : (force, torque)
        Of one reading, N and N·m.
    count : int
        Readings in a period.
    """
    force, root = settings.desired_force, np.sqrt(count)
    press = foundation.at(force, modulus)
    sigmas = float(noise[0] / root / force), float(noise[1] / root / force)
    left = float(np.hypot(settings.calibration_sigma[0] * foundation.height, settings.calibration_sigma[1]))
    found = []
    for gain in (press.gain_y, press.gain_x):
        axis = Tilt(*settings.lean, left / force)
        reading = TiltReading(0.0, 0.0, gain, foundation.height, *sigmas)
        for _ in range(round(_SECONDS / settings.period)):
            axis.update(reading, settings.period)
        found.append(axis.sigma(reading))
    return found[0], found[1]
