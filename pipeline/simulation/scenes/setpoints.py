"""The set-points of a position servo: what it makes of them between two."""

from dataclasses import dataclass

import numpy as np

from contactbench.pipeline.errors import InputError, arg
from contactbench.pipeline.mesh.arrays import Floats
from contactbench.pipeline.robot import Robot


class SetPoints:
    """
    The path of a servo that gets a set-point every `period`: to it until the next one is due, without a jump in speed.

    Between two set-points it is the cubic whose speed at each is the mean speed towards it. A set-point that is too far
    is gone to as fast as the machine can, and passed by as much as stopping takes; after one that does not come it
    stops as hard as the machine can.

    The speed never passes `fastest`. From one set-point to the next it changes by at most `hardest` times the period;
    on the way a cubic accelerates up to four times as hard, for some milliseconds: a servo with a bandwidth smooths it.

    Parameters
    ----------
    start : (n,)
    fastest, hardest : (n,)
        Largest speed and acceleration, per s and per s².
    period : float
        s.

    Raises
    ------
    InputError
        A limit or the period is not positive.
    """

    def __init__(self, start: Floats, fastest: Floats, hardest: Floats, period: float) -> None:
        self._from = self._to = np.array(start, dtype=np.float64)
        self._speed_to = np.zeros_like(self._from)
        self._given = -period
        self._fastest, self._hardest, self._period = np.asarray(fastest), np.asarray(hardest), period
        if not (0 < period < np.inf and (self._fastest > 0).all() and (self._hardest > 0).all()):
            raise InputError(
                f"set-points every {arg(period)} s, speeds up to {arg(self._fastest.tolist())}, accelerations up to"
                f" {arg(self._hardest.tolist())}: give positive numbers."
            )
        self._set(np.zeros_like(self._from))

    def give(self, time: float, point: Floats) -> None:
        """
        Take the next one; numbers as those of `start`.

        Raises
        ------
        InputError
            They are not finite, or not as many.
        """
        if point.shape != self._to.shape or not np.isfinite(point).all():
            raise InputError(f"set-point {arg(point.tolist())}: give {arg(len(self._to))} finite numbers.")
        here, speed = self.state(time)
        # A cubic that ends with speed b after a is fastest at 4/3 b - a/3, two thirds of the way.
        most = 0.75 * self._fastest
        wanted = np.clip((point - here) / self._period, speed / 4 - most, speed / 4 + most)
        reach = self._hardest * self._period
        going = speed + np.clip(wanted - speed, -reach, reach)
        self._from, self._to = here, here + going * self._period
        self._speed_to = going
        self._given = time
        self._set(speed)

    def _set(self, speed: Floats) -> None:
        """Have the cubic begin with a speed, (n,): Hermite, u³ (a + b - 2 g) + u² (3 g - 2 a - b) + u a."""
        gone, a, b = self._to - self._from, speed * self._period, self._speed_to * self._period
        self._first, self._second, self._third = a, 3 * gone - 2 * a - b, a + b - 2 * gone

    def at(self, time: float) -> Floats:
        """Return where it should be at a time, (n,)."""
        return self.state(time)[0]

    def state(self, time: float) -> tuple[Floats, Floats]:
        """Return where it should be at a time, and how fast it should go, both (n,)."""
        u = (time - self._given) / self._period
        if u >= 1 + 1e-9:
            return self._stopping((u - 1) * self._period)
        u = max(u, 0.0)
        speed = (self._first + u * (2 * self._second + 3 * u * self._third)) / self._period
        return self._from + u * (self._first + u * (self._second + u * self._third)), speed

    def _stopping(self, late: float) -> tuple[Floats, Floats]:
        """Return the same when the next set-point is late, by some s: braking, within a period at the earliest."""
        takes = np.maximum(np.abs(self._speed_to) / self._hardest, self._period)
        over = np.minimum(late / takes, 1.0)
        return self._to + self._speed_to * takes * (over - over * over / 2), self._speed_to * (1 - over)


class ServoPath:
    """
    What a position servo of some bandwidth makes of `SetPoints`: a path without jumps in acceleration.

    It follows their cubics critically damped, speed fed forward, within the limits of speed and acceleration at every
    moment.

    Parameters
    ----------
    start, fastest, hardest, period
        As of `SetPoints`.
    bandwidth : float
        rad/s.
    step : float
        s between two calls of `go_on`.

    Attributes
    ----------
    place, speed, change : (n,)
        Where it is, its speed and its acceleration, at the time of the last call.
    """

    def __init__(
        self, start: Floats, fastest: Floats, hardest: Floats, period: float, bandwidth: float, step: float
    ) -> None:
        self._points = SetPoints(start, fastest, hardest, period)
        self._fastest, self._hardest, self._w, self._step = fastest, hardest, bandwidth, step
        self.place, self._last = np.array(start, dtype=np.float64), 0.0
        self.speed, self.change = np.zeros_like(self.place), np.zeros_like(self.place)

    def give(self, time: float, point: Floats) -> None:
        """Take the next set-point; InputError as of `SetPoints.give`."""
        self._points.give(time, point)

    def go_on(self, time: float) -> float:
        """Go on to a time, s; returns how long after the one before that is."""
        passed, self._last = time - self._last, time
        self.speed = self.speed + passed * self.change
        self.place = self.place + passed * self.speed
        wanted, going = self._points.state(time)
        asked = self._w * self._w * (wanted - self.place) + 2 * self._w * (going - self.speed)
        low = np.maximum(-self._hardest, (-self._fastest - self.speed) / self._step)
        high = np.minimum(self._hardest, (self._fastest - self.speed) / self._step)
        self.change = np.maximum(np.minimum(asked, high), low)
        return passed


# ---- the joints of an arm as its controller sees them: set-points in, rounded angles out ---------


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

    def __init__(self, robot: Robot, start: Floats, settings: ServoSettings, step: float) -> None:
        self._robot, self._settings = robot, settings
        fastest, hardest = robot.velocity_limits, robot.acceleration_limits
        self._path = ServoPath(start, fastest, hardest, settings.period, settings.bandwidth, step)
        self._off, self._sum = np.zeros(len(start)), np.zeros(len(start))  # of the joints, off the path

    def command(self, time: float, joints: Floats) -> None:
        """
        Take the next set-point, (n,), rad.

        Raises
        ------
        InputError
            The arm cannot go there, or these are no angles.
        """
        self._path.give(time, self._robot.check_joints(joints, "set-point"))

    def acceleration(self, time: float, q: Floats, speed: Floats) -> Floats:
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

    def read(self, q: Floats) -> Floats:
        """Return what the encoders say, rad."""
        count = 2 * np.pi / self._settings.counts
        return np.asarray(np.round(q / count) * count)
