"""The poses of a gravity calibration as a technician sees them: taken, left out, rejected."""

from __future__ import annotations

from dataclasses import dataclass, replace
from enum import StrEnum
from typing import TYPE_CHECKING

import numpy as np

from contactbench.pipeline.errors import arg, message

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from numpy.typing import NDArray

    from contactbench.pipeline.calibration import Calibration, PoseSample
    from contactbench.pipeline.calibration.stillness import Capture, Rejected
    from contactbench.pipeline.workbench.gravity_fit import GravitySettings


class PoseState(StrEnum):
    """Whether a pose counts."""

    TAKEN = "taken"
    LEFT_OUT = message("left out")  # by the technician
    REJECTED = "rejected"  # by what it reads, or because it was disturbed


@dataclass(frozen=True, eq=False)
class PoseRow:
    """A pose for a table."""

    name: str  # Such as "pose 3"
    time: float  # A moment within it, s on the recording's clock; NaN: of an earlier recording
    R_WS: NDArray[np.float64] | None  # (3, 3); None: nobody knows any more
    words: str  # How the sensor stood, or what happened
    state: PoseState
    reason: str = ""  # Why it does not count, or is doubted
    # The larger of how far force and torque are from what the poses predict, as a normal deviate; NaN: not
    # computed
    sigmas: float = float("nan")
    force_sigmas: float = float("nan")
    torque_sigmas: float = float("nan")
    earlier: bool = False  # It is of an interrupted recording, and cannot be left out by its time
    changeable: bool = True  # It can be left out and taken back


def short_description(R_WS: NDArray[np.float64]) -> str:
    """Say in a few words how the sensor stands: the tilt of z from straight down, and which side is lowest."""
    z_W = R_WS[:, 2]
    tilt = float(np.degrees(np.arccos(np.clip(-z_W[2], -1, 1))))
    down_S = -R_WS[2]
    side = int(np.argmax(np.abs(down_S)))
    return f"{tilt:.0f}°, {'-' if down_S[side] < 0 else '+'}{'xyz'[side]} down"


def middle(capture: Capture) -> float:
    """Return the moment that names a capture, s."""
    return 0.5 * (capture.start + capture.stop)


def calibrated_rows(
    calibration: Calibration, left_out: tuple[float, ...] = (), earlier: int = 0
) -> tuple[PoseRow, ...]:
    """
    Return the poses of a calibration, then those that were left out of it.

    Parameters
    ----------
    calibration : Calibration
    left_out : tuple of float
        Moments of those that it was not given, s.
    earlier : int
        How many of its poses are of an earlier recording.
    """
    rows = [
        _row(
            message(f"pose {arg(index + 1)}"),
            float("nan") if index < earlier or pose.time is None else pose.time,
            pose.R_WS,
            calibration,
            index,
        )
        for index, pose in enumerate(calibration.poses)
    ]
    rows[:earlier] = map(_of_earlier, rows[:earlier])
    rows += [
        PoseRow(
            f"out {number}",
            moment,
            None,
            message("does not count"),
            PoseState.LEFT_OUT,
            message("You left it out."),
        )
        for number, moment in enumerate(left_out, 1)
    ]
    return tuple(rows)


def earlier_rows(
    poses: Sequence[PoseSample], settings: GravitySettings, fitted: Calibration | None
) -> tuple[PoseRow, ...]:
    """Return the poses (R_WS of the flange) of an interrupted run, which cannot be left out one by one."""
    return tuple(
        _of_earlier(_live_row(pose.name, float("nan"), pose.R_WS, settings, fitted)) for pose in poses
    )


def _of_earlier(row: PoseRow) -> PoseRow:
    return replace(row, earlier=True, changeable=False)


def live_rows(
    captures: Iterable[tuple[Capture, bool]],
    rejected: Iterable[Rejected],
    first: int,
    settings: GravitySettings,
    fitted: Calibration | None,
    origin: float,
) -> tuple[PoseRow, ...]:
    """
    Return the poses of a run that goes on, and what was disturbed, in the order in which they came.

    Parameters
    ----------
    captures : iterable of (Capture, bool)
        R_WS of the flange; whether it counts.
    rejected : iterable of Rejected
    first : int
        Number of the first one.
    settings : GravitySettings
    fitted : Calibration or None
        Of the poses that count, by their names.
    origin : float
        s on the samples' clock, from which people count.
    """
    rows: list[tuple[float, PoseRow]] = []
    for number, (capture, counts) in enumerate(captures, first):
        if capture.R_WS is None:
            continue
        row = _live_row(
            message(f"pose {arg(number)}"),
            middle(capture),
            capture.R_WS,
            settings,
            fitted if counts else None,
        )
        if not counts:
            reason = message("It does not count. Restore it if it was good.")
            row = replace(row, state=PoseState.LEFT_OUT, reason=reason)
        rows.append((capture.start, row))
    for each in rejected:
        row = PoseRow(
            f"at {each.start - origin:.0f} s", 0.5 * (each.start + each.stop), None,
            message(f"{arg(each.state.value)}: not captured"), PoseState.REJECTED, each.reason, changeable=False,
        )  # fmt: skip
        rows.append((each.start, row))
    return tuple(row for _, row in sorted(rows, key=lambda each: each[0]))


def _live_row(
    name: str,
    moment: float,
    R_WE: NDArray[np.float64],
    settings: GravitySettings,
    fitted: Calibration | None,
) -> PoseRow:
    index = next((i for i, pose in enumerate(fitted.poses) if pose.name == name), None) if fitted else None
    return _row(name, moment, settings.sensor_orientations(R_WE), fitted, index)


def _row(
    name: str, moment: float, R_WS: NDArray[np.float64], fitted: Calibration | None, index: int | None
) -> PoseRow:
    """Return a row, with what a calibration says of its pose there."""
    row = PoseRow(name, moment, R_WS, short_description(R_WS), PoseState.TAKEN)
    if fitted is None or index is None:
        return row
    force, torque = map(float, fitted.deviates[index])
    reason = next((each.reason for each in fitted.rejected if each.index == index), "")
    return replace(
        row,
        state=PoseState.REJECTED if reason else PoseState.TAKEN,
        reason=reason,
        sigmas=max(force, torque),
        force_sigmas=force,
        torque_sigmas=torque,
    )
