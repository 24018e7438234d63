"""What the detector is told, and what it tells: settings, states, captures."""

from dataclasses import dataclass
from enum import StrEnum
from math import inf, isfinite, pi, sqrt
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from contactbench.pipeline.calibration.poses import PoseSample
from contactbench.pipeline.errors import InputError, arg, message

Floats = NDArray[np.float64]

BLOCK = 0.1  # s: five periods of 50 Hz, six of 60 Hz
LEAST = np.repeat([1e-7, 1e-9], 3)  # N, N·m: keeps constant readings from dividing by zero


class StillState(StrEnum):
    """What a reading is doing."""

    MOVING = "moving"
    SETTLING = "settling"
    STILL = "still"
    BUMPED = "bumped"
    TOUCHED = "touched"
    STALE = "stale"  # no samples come


@dataclass(frozen=True)
class StillnessSettings:
    """What counts as still, and how long to average.

    Raises
    ------
    InputError
        A number is not positive and finite, or the durations contradict one another.
    """

    # s that must be quiet before the reading is called still. Default 1: a vibration of 8 Hz shows eight
    # times, and a creep of the slope allowed stands out of usual noise.
    window: float = 1.0
    # Largest scatter of samples and of block means over the noise floor. Default 2: servos that hold a pose
    # add up to that; the tremor of a moving robot is ten times the floor.
    scatter_ratio: float = 2.0
    # Largest drift, N/s and N·m/s. Default 0.05 and 0.002: over 2 s of averaging the error stays that of one
    # sample; an arm that creeps by 0.3 degrees a second with 10 N of load does as much.
    slope_force: float = 0.05
    slope_torque: float = 0.002
    # s of a capture. Default 1 and 10: shorter ones cannot tell their own error, longer ones only gather
    # drift.
    min_duration: float = 1.0
    max_duration: float = 10.0
    # Standard deviation of a sample without hum, N and N·m, on every axis. Left out: learnt from the quietest
    # window so far.
    floor_force: float | None = None
    floor_torque: float | None = None
    # A floor that is learnt is not believed beyond this, N and N·m: before the first quiet window, a steady
    # tremor would pass for noise. Default 0.5 and 0.02, ten times a usual sensor.
    loudest_force: float = 0.5
    loudest_torque: float = 0.02
    # Standard error to reach, N and N·m. Left out: a fifth of the floor.
    target_force: float | None = None
    target_torque: float | None = None
    # s without a sample that are bridged. Default 0.25: a bump could hide in a longer one.
    longest_gap: float = 0.25
    # Largest share of samples that may be excluded as spikes. Default 0.02: a line that is worse has another
    # fault.
    most_spikes: float = 0.02
    # Largest turn of the sensor in a capture, rad, where orientations are given. Default 0.1 degrees: 10 N of
    # load change by 0.02 N.
    rotation: float = pi / 1800
    # 1 sigma of what a gravity model leaves, beside its covariance, N and N·m: errors of the orientation, and
    # drift. Default 0.05 and 0.002: touches beyond six times that are seen.
    model_force: float = 0.05
    model_torque: float = 0.002
    # s for which 1/f noise is counted: slower than that it is bias. Default 120, the time that a set of poses
    # takes; ten times longer adds a quarter to a standard error that is all 1/f noise.
    horizon: float = 120.0

    def __post_init__(self) -> None:
        for name, value in vars(self).items():
            if value is not None and not (isfinite(value) and value > 0):
                raise InputError(
                    f"StillnessSettings.{arg(name)} must be positive and finite, not {arg(value)}"
                )
        if self.min_duration > self.max_duration:
            raise InputError(
                f"StillnessSettings.min_duration, {arg(self.min_duration)} s, is above max_duration,"
                f" {arg(self.max_duration)} s: lower the first or raise the second"
            )
        if self.window < 6 * BLOCK:
            raise InputError(
                f"StillnessSettings.window: {arg(self.window)} s; give {arg(6 * BLOCK):.1f} s or more"
            )


@dataclass(frozen=True, eq=False)
class Capture:
    """A pose's reading, averaged while it was still."""

    # Of the samples, counted from the first that was given; the last is one beyond
    start_index: int
    stop_index: int
    # Times of the first and last sample, s
    start: float
    stop: float
    mean: Floats  # (6,) robust mean: spikes excluded, mains hum taken out, N and N·m
    sd: Floats  # (6,) standard deviation of the single samples around it, without spikes and hum
    # (6,) of the mean: white and 1/f noise, drift in the capture, rounding by the converter
    standard_error: Floats
    # Samples averaged and excluded
    count: int
    spikes: int
    R_WS: Floats | None = None  # (3, 3) orientation at the end, where one was given

    @property
    def duration(self) -> float:
        """Seconds averaged."""
        return self.stop - self.start

    def to_pose(
        self, R_WS: ArrayLike | None = None, name: str = "", temperature: float | None = None
    ) -> PoseSample:
        """Return the pose for `calibrate`.

        Parameters
        ----------
        R_WS : array_like (3, 3), optional
            Orientation of the sensor; left out: the capture's own.
        name : str
        temperature : float, optional
            Of the sensor, degrees Celsius.

        Raises
        ------
        InputError
            There is no orientation, or it is no rotation (PoseError).
        """
        R = self.R_WS if R_WS is None else np.asarray(R_WS, dtype=np.float64)
        if R is None:
            raise InputError(f"to_pose: the capture at {arg(self.start):.1f} s has no orientation: give R_WS")
        return PoseSample(
            R, self.mean[:3], self.mean[3:], self.count, self.sd[:3], self.sd[3:],
            temperature, 0.5 * (self.start + self.stop), name,
        )  # fmt: skip


@dataclass(frozen=True)
class Rejected:
    """A stretch that was not captured, or whose capture was dropped."""

    # Of the samples, as for `Capture`
    start_index: int
    stop_index: int
    # s
    start: float
    stop: float
    state: StillState  # BUMPED, TOUCHED, MOVING (it went on too early, or crept) or STALE
    reason: str


@dataclass(frozen=True, eq=False)
class Stillness:
    """The state of a reading."""

    state: StillState
    seconds_until_still: float | None  # None: cannot be told, because it still moves
    # (6,) robust standard deviation of the samples in the window, N and N·m; NaN before the first block
    sd: Floats
    # each (6,): Drift over the window with 1 sigma, N/s and N·m/s; NaN before the window has three blocks
    slope: Floats
    slope_sigma: Floats
    # s averaged so far, and needed
    averaged: float
    recommended: float
    sentence: str  # For the technician
    captured: Capture | None = None  # On the one update that completes a capture
    rejected: Rejected | None = None  # On the one update that drops a capture


def both(force: float | None, torque: float | None) -> Floats:
    """Return two settings as (6,); 0 where one was left out."""
    return np.repeat([force or 0.0, torque or 0.0], 3)


def checked(
    t: ArrayLike, wrenches: ArrayLike, R_WS: ArrayLike | None, latest: float
) -> tuple[Floats, Floats, Floats | None]:
    """Return samples as arrays, or raise InputError; `latest` is the time before the first."""
    times, w = np.asarray(t, dtype=np.float64), np.ascontiguousarray(wrenches, dtype=np.float64)
    if w.ndim != 2 or w.shape[1] != 6:
        raise InputError(f"wrenches: give rows of six numbers, force before torque, not shape {arg(w.shape)}")
    if times.shape != (len(w),):
        raise InputError(
            f"times: give one for each of the {arg(len(w))} samples, s, not shape {arg(times.shape)}"
        )
    before = np.concatenate([[latest], times[:-1]])
    wrong = np.flatnonzero(~((times >= before) & (times < inf)))
    if len(wrong):
        at = int(wrong[0])
        raise InputError(f"sample {arg(at + 1)}: {arg(backwards(times[at], before[at]))}")
    return times, w, None if R_WS is None else orientation(R_WS, times.shape)


def orientation(R_WS: ArrayLike, many: tuple[int, ...]) -> Floats:
    """Return one orientation, or as many as there are samples, or raise InputError."""
    R = np.array(R_WS, dtype=np.float64)
    if R.shape not in {(3, 3), (*many, 3, 3)}:
        raise InputError(f"R_WS: give (3, 3) or one (3, 3) for each sample, not shape {arg(R.shape)}")
    return R


def backwards(t: float, before: float) -> str:
    """Say what is wrong with the time of a sample."""
    return message(
        f"time {arg(t)} s after {arg(before)} s: times must be finite and must not decrease; sort the"
        " samples, or start a new detector after the clock restarts"
    )


def angle(first: Floats, second: Floats) -> float:
    """Return the angle between two orientations, rad; for small ones."""
    return float(np.linalg.norm(first - second)) / sqrt(2)


def size(wrench: Floats, weight: Floats) -> str:
    """Return the size of what weighs most in a wrench: of its force in N, or of its torque in mN·m."""
    if weight[:3].max() >= weight[3:].max():
        return f"{short(np.linalg.norm(wrench[:3]))} N"
    return f"{short(1e3 * np.linalg.norm(wrench[3:]))} mN·m"


def short(value: float | np.floating[Any]) -> str:
    """Return two digits that count, never with an exponent for large values."""
    return f"{float(f'{value:.2g}'):g}"


def done_words(capture: Capture) -> str:
    """Say that a pose is captured."""
    force, torque = capture.standard_error[:3].max(), capture.standard_error[3:].max()
    return message(
        f"Captured: {arg(capture.duration):.1f} s averaged, ± {arg(force):.1g} N and ± {arg(1e3 * torque):.1g} mN·m."
        " Go to the next pose."
    )


def stale_words(silent: float) -> str:
    """Say that no samples have come for so many s."""
    return message(
        f"Too few samples, or none, for {arg(silent):.1f} s: check the sensor's plug, connection and rate."
    )
