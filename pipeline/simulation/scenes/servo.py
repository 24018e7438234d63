"""The joints of an arm as its controller sees them: set-points in, rounded angles out."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from contactbench.pipeline.errors import InputError, arg
from contactbench.pipeline.simulation.scenes.setpoints import ServoPath

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from contactbench.pipeline.robot import Robot

_MOST_HELD = 500.0  # rad/s², of what it has learned to hold against: motors at their end shall not wind it up


@dataclass(frozen=True)
class ServoSettings:
    """
    What the makers of arms do not print, chosen as usual for a light one.

    Attributes
    ----------
    period : float
        s between set-points.
    bandwidth : float
        rad/s, with which it follows its set-points; speed is fed forward.
    stiffness : float
        rad/s, all three poles of the loop that holds the joints on the path: what pushes them aside for long is met
        wholly, what comes suddenly within some times 1 / stiffness.
    counts : int
        Of an encoder per turn of its joint.
    """

    period: float = 0.02
    bandwidth: float = 60.0
    stiffness: float = 120.0
    counts: int = 2**17

    def __post_init__(self) -> None:
        values = (self.period, self.bandwidth, self.stiffness, self.counts)
        if not (np.isfinite(values).all() and min(values) > 0):
            raise InputError(
                f"servo: period, bandwidth, stiffness and counts are {arg(values)}: give positive numbers."
            )


class JointServo:
    """
    The position servo of an arm: a path along the set-points, and a loop that keeps the joints on it.

    The path keeps the arm's limits of speed and acceleration at every moment. The loop knows no such limits, as it
    pushes back what pushes; the motors' torque ends it.

    Parameters
    ----------
    start : (n,)
        rad.
    step : float
        s between two calls of `acceleration`.
    """

    def __init__(
        self, robot: Robot, start: NDArray[np.float64], settings: ServoSettings, step: float
    ) -> None:
        self._robot, self._settings = robot, settings
        fastest, hardest = robot.velocity_limits, robot.acceleration_limits
        self._path = ServoPath(start, fastest, hardest, settings.period, settings.bandwidth, step)
        self._off, self._sum = np.zeros(len(start)), np.zeros(len(start))  # of the joints, off the path

    def command(self, time: float, joints: NDArray[np.float64]) -> None:
        """
        Take the next set-point, (n,), rad.

        Raises
        ------
        InputError
            The arm cannot go there, or these are no angles.
        """
        self._path.give(time, self._robot.check_joints(joints, "set-point"))

    def acceleration(
        self, time: float, q: NDArray[np.float64], speed: NDArray[np.float64]
    ) -> NDArray[np.float64]:
        """
        Return the acceleration (n,) that it asks of the joints, rad/s², where they are and go as they do.

        Asked twice at one time, it answers the same.
        """
        path, k = self._path, self._settings.stiffness
        passed = path.go_on(time)
        most = _MOST_HELD / k**3
        # What the joints were off until now; since then they went on.
        self._sum = np.clip(self._sum + passed * self._off, -most, most)
        self._off = path.place - q
        held = k**3 * self._sum + 3 * k * k * self._off + 3 * k * (path.speed - speed)
        return np.asarray(path.change + held)

    def read(self, q: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return what the encoders say, rad."""
        count = 2 * np.pi / self._settings.counts
        return np.asarray(np.round(q / count) * count)
