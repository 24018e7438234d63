"""What a calibration is made from: still, contact-free poses of the sensor."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from contactbench.pipeline.errors import InputError, arg, message

# A rotation typed with four digits is off by 1e-4; one with a wrong sign by 1.
_ROTATION_TOLERANCE = 1e-3
# No sensor behind a hand-held probe reads this much; a count or a float misread does.
_LARGEST_FORCE, _LARGEST_TORQUE = 1e5, 1e5


class PoseError(InputError):
    """A pose that cannot be used: names the pose, the field, and the remedy."""


@dataclass(frozen=True, eq=False)
class PoseSample:
    """One still, contact-free pose: orientation and mean reading of the sensor.

    Parameters
    ----------
    R_WS : array_like (3, 3)
        Orientation of the sensor frame S in the world W (z up): ``v_W = R_WS @ v_S``.
    force, torque : array_like (3,)
        Mean raw reading in S, N and N·m about the sensor origin, with bias and weight.
    count : int
        Samples averaged.
    force_sd, torque_sd : array_like (3,), optional
        Standard deviation of the single samples, N and N·m.
    temperature : float, optional
        Of the sensor, degrees Celsius.
    time : float, optional
        s, from any start that all poses share.
    name : str
        Name in messages; empty: its number, from 1.

    Raises
    ------
    PoseError
        A value is not finite or not plausible, a shape is wrong, or R_WS is not a rotation.
    """

    R_WS: NDArray[np.float64]
    force: NDArray[np.float64]
    torque: NDArray[np.float64]
    count: int = 1
    force_sd: NDArray[np.float64] | None = None
    torque_sd: NDArray[np.float64] | None = None
    temperature: float | None = None
    time: float | None = None
    name: str = ""

    def __post_init__(self) -> None:
        put = object.__setattr__  # frozen for everybody else
        put(self, "R_WS", self._rotation())
        put(self, "force", self._three("force", self.force, _LARGEST_FORCE, "N"))
        put(self, "torque", self._three("torque", self.torque, _LARGEST_TORQUE, "N·m"))
        for field, largest, unit in (
            ("force_sd", _LARGEST_FORCE, "N"),
            ("torque_sd", _LARGEST_TORQUE, "N·m"),
        ):
            value = getattr(self, field)
            if value is not None:
                array = self._three(field, value, largest, unit)
                if (array < 0).any():
                    what = message(f"{arg(field)} is negative: a standard deviation is at least 0")
                    raise self._error(what)
                put(self, field, array)
        if not isinstance(self.count, int | np.integer) or isinstance(self.count, bool) or self.count < 1:
            what = message(
                f"count is {arg(self.count)}: a mean needs at least one sample, and a whole number of them"
            )
            raise self._error(what)
        for field in ("temperature", "time"):
            value = getattr(self, field)
            if value is not None and not np.isfinite(value):
                what = message(f"{arg(field)} is {arg(value)}: give a finite number, or leave it out")
                raise self._error(what)

    def _error(self, what: str) -> PoseError:
        return PoseError(f"{arg(self.name or 'pose')}: {arg(what)}.")

    def _rotation(self) -> NDArray[np.float64]:
        R = np.array(self.R_WS, dtype=np.float64)
        if R.shape != (3, 3) or not np.isfinite(R).all():
            what = message(
                f"R_WS must be a finite (3, 3) rotation, not shape {arg(R.shape)} with {arg(R.ravel()[:3])}..."
            )
            raise self._error(what)
        if np.abs(R.T @ R - np.eye(3)).max() > _ROTATION_TOLERANCE:
            what = message("R_WS is not a rotation: its columns are not unit vectors at right angles")
            raise self._error(what)
        U, _, Vt = np.linalg.svd(R)  # the nearest rotation: typed digits are rounded
        R = U @ Vt
        if np.linalg.det(R) < 0:
            raise self._error(message("R_WS is a reflection (determinant -1): one axis has the wrong sign"))
        return _frozen(R)

    def _three(self, field: str, value: ArrayLike, largest: float, unit: str) -> NDArray[np.float64]:
        array = np.array(value, dtype=np.float64)
        if array.shape != (3,):
            what = message(f"{arg(field)} needs three numbers, {arg(unit)}, not shape {arg(array.shape)}")
            raise self._error(what)
        if not (np.abs(array) <= largest).all():
            what = message(
                f"{arg(field)} is {arg(array)} {arg(unit)}: give finite numbers below {arg(largest):g} {arg(unit)}"
            )
            raise self._error(what)
        return _frozen(array)


@dataclass(frozen=True, eq=False)
class Stack:
    """Poses as arrays, for computing."""

    # (n, 3, 3) world components to sensor components: the transposes of the poses' R_WS
    R_SW: NDArray[np.float64]
    wrenches: NDArray[np.float64]  # (n, 6) mean readings, force before torque, S, N and N·m
    # (n,) when, from 0 at the first pose to 1 at the last one: by time, or by number where not all have one
    moments: NDArray[np.float64]
    duration: float | None = None  # s from the first pose to the last; None where they have no times

    def __len__(self) -> int:
        return len(self.wrenches)

    @property
    def F(self) -> NDArray[np.float64]:
        """(n, 3) forces, N."""
        return self.wrenches[:, :3]

    @property
    def M(self) -> NDArray[np.float64]:
        """(n, 3) torques, N·m."""
        return self.wrenches[:, 3:]

    def first_from(self, moment: float) -> int:
        """Return the number of the first pose at a moment or later."""
        return int(np.argmin(np.where(self.moments >= moment, self.moments, np.inf)))

    def take(self, chosen: NDArray[np.bool_] | NDArray[np.intp]) -> Stack:
        """Return some of the poses."""
        return Stack(self.R_SW[chosen], self.wrenches[chosen], self.moments[chosen], self.duration)


def stack(poses: Sequence[PoseSample]) -> Stack:
    """Return the arrays of `poses`."""
    R_WS = np.array([pose.R_WS for pose in poses]).reshape(-1, 3, 3)
    wrenches = np.empty((len(R_WS), 6))
    wrenches[:, :3], wrenches[:, 3:] = [pose.force for pose in poses], [pose.torque for pose in poses]
    moments, duration = _moments([pose.time for pose in poses])
    return Stack(np.ascontiguousarray(R_WS.transpose(0, 2, 1)), wrenches, moments, duration)


def _moments(times: Sequence[float | None]) -> tuple[NDArray[np.float64], float | None]:
    known = np.array([time for time in times if time is not None], dtype=np.float64)
    if len(known) == len(times) > 0 and np.ptp(known) > 0:
        return (known - known.min()) / np.ptp(known), float(np.ptp(known))
    return np.arange(len(times)) / max(len(times) - 1, 1), None


def named(poses: Sequence[PoseSample], index: int) -> str:
    """Return what to call a pose: its name, or its number from 1."""
    return poses[index].name or message(f"pose {arg(index + 1)}")


def _frozen(array: NDArray[np.float64]) -> NDArray[np.float64]:
    array.flags.writeable = False
    return array
