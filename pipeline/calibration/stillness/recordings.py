"""Whole recordings: the captures in them, and advice on averaging."""

from __future__ import annotations

from math import inf, isfinite
from typing import TYPE_CHECKING

import numpy as np

from contactbench.pipeline.errors import InputError

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from contactbench.pipeline.calibration.model import GravityModel

    Floats = NDArray[np.float64]
from contactbench.pipeline.calibration.stillness.blocks import Intake, Window
from contactbench.pipeline.calibration.stillness.captures import (
    LEAST,
    AveragingAdvice,
    CaptureReport,
    StillnessSettings,
    both,
    checked,
)
from contactbench.pipeline.calibration.stillness.detector import StillnessDetector
from contactbench.pipeline.calibration.stillness.noise import ALL_FITS, NoiseMemory, rounding_variance
from contactbench.pipeline.calibration.stillness.quiet import advise


def find_captures(
    t: ArrayLike,
    wrenches: ArrayLike,
    settings: StillnessSettings | None = None,
    R_WS: ArrayLike | None = None,
    model: GravityModel | None = None,
) -> CaptureReport:
    """Find the captures in a recording: those that the live detector makes of it, to the last bit.

    Parameters
    ----------
    t : array_like (n,)
        s.
    wrenches : array_like (n, 6)
        As the sensor gave them, S, N and N·m; rows with NaN are skipped.
    settings : StillnessSettings, optional
    R_WS : array_like (n, 3, 3), optional
        Orientation of the sensor at each sample.
    model : GravityModel, optional
        A preliminary calibration, to see steady touches.

    Raises
    ------
    InputError
        A shape is wrong, or the times run backwards.
    """
    detector = StillnessDetector(None, settings, model)
    detector.update_block(t, wrenches, R_WS)
    detector.finish()
    return CaptureReport(tuple(detector.captures), tuple(detector.rejected))


def averaging_time(
    samples: ArrayLike, rate: float, settings: StillnessSettings | None = None
) -> AveragingAdvice:
    """Advise how long to average, from a recording of the still sensor.

    The Allan variances of its block means show white noise, 1/f noise and drift; from them follows the
    standard error of a mean over any time. The advice is the shortest time that reaches the target on every
    axis, or beyond which twice the time gains less than a tenth on the axis that is furthest from it.

    Parameters
    ----------
    samples : array_like (n, 6)
        Regular samples, S, N and N·m; rows with NaN are skipped. At least 1 s; a minute shows the 1/f noise.
    rate : float
        Samples a second, Hz.
    settings : StillnessSettings, optional
        Targets, floor, durations, horizon.

    Raises
    ------
    InputError
        A shape or the rate is wrong, or the recording is too short.
    """
    if not (isfinite(rate) and rate > 0):
        raise InputError(f"averaging_time: the rate must be positive and finite, not {rate}")
    s, intake, count = settings or StillnessSettings(), Intake(rate), len(np.asarray(samples))
    times, w, _ = checked(np.arange(count) / rate, samples, None, -inf)
    blocks = [block for block in intake.feed(times, w, None) if block is not None]
    if len(blocks) < 6:
        raise InputError(
            f"averaging_time: {count} samples make {len(blocks)} blocks of {intake.length:g} s; give"
            f" {7 * intake.length:g} s or more"
        )
    whole, given = Window(blocks), both(s.floor_force, s.floor_torque)
    floor = np.maximum(np.where(given > 0, given, np.sqrt(whole.variance)), LEAST)
    rounding = rounding_variance(whole.variance, intake.step)
    memory = NoiseMemory(intake.length, s.horizon)
    return advise(memory.fit(whole.means, whole.variance / rate, rounding, ALL_FITS), s, floor)
