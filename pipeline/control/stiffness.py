"""How stiff the tissue is while the probe tracks: asked by a small press where there is a doubt."""

import math
from collections import deque

import numpy as np

_HZ = 6.25  # eight periods; tissue moves more slowly, and the servo is still with it
_WINDOW_S = 0.31  # two periods of it
_LEAST_ROWS = 12
_ASKED_N = 0.15  # of the force, peak: six times the noise of a period
_DOUBT_S = 0.7  # how long a doubt lasts: a window, and what it takes to go there
_LEAST_M = 5e-7  # of the way's amplitude: less is what encoders and readings make of nothing
_BAND = 2.5  # standard errors on either side of what a window shows
_TAKEN = 0.5  # of the way there, in logarithms, in a period
_MOST = 0.3  # of that way, in a period: a factor of 6 takes 0.12 s


class StiffnessTrack:
    """
    Follows the stiffness of what is pressed; a quiet loop changes nothing.

    Where the force is off, or swings, the tissue may have become another: then the probe presses in and out a little,
    at one frequency w. Over a window force and way are fitted as a drift, a cubic in time for tissue that moves, and a
    complex amplitude each, F and S. Of a spring and a damper F / S = k + i w d: the least squares of force over way of
    Erickson, Weber and Sharf (2003), Contact stiffness and damping estimation for robotic systems, Int. J. Robotics
    Research 22(1), with the press as an instrument, so that what else pushes does not spoil it.

    What is believed goes to the nearer edge of a band around what the window shows, and stays where it is within: a
    window without a press has a wide band, and says nothing.
    """

    def __init__(self) -> None:
        self._rows: deque[tuple[float, float, float]] = deque()
        self._doubt = 0.0  # s that it lasts yet
        self._turn = 0.0  # of the small press, rad

    def reset(self) -> None:
        """Forget what was seen."""
        self._rows.clear()
        self._doubt = self._turn = 0.0

    @property
    def doubted(self) -> bool:
        """Whether it asks the tissue."""
        return self._doubt > 0

    def doubt(self) -> None:
        """Have it ask the tissue."""
        self._doubt = _DOUBT_S

    def asking(self, known: float, dt: float) -> float:
        """Return the mean speed of the small press over the next dt (s), into the tissue, m/s; 0 without a doubt."""
        self._doubt -= dt
        if self._doubt <= 0:
            self._turn = 0.0
            return 0.0
        before, self._turn = self._turn, self._turn + 2 * math.pi * _HZ * dt
        return _ASKED_N / known * (math.sin(self._turn) - math.sin(before)) / dt

    def take(self, time: float, way: float, force: float, known: float) -> float:
        """
        Take a period, and return the stiffness to go on with, N/m.

        Parameters
        ----------
        time, way, force : float
            s, m into the tissue, N; all at the time of the readings.
        known : float
            Stiffness that is believed now, N/m.
        """
        self._rows.append((time, way, force))
        while time - self._rows[0][0] > _WINDOW_S + 1e-6:
            self._rows.popleft()
        if self._doubt <= 0 or len(self._rows) < _LEAST_ROWS:
            return known
        low, high = self._band()
        nearest = min(max(known, low), high)
        if nearest <= 0:  # what moves the force is the tissue
            return known
        return known * math.exp(min(max(_TAKEN * math.log(nearest / known), -_MOST), _MOST))

    def _band(self) -> tuple[float, float]:
        """Return between what the stiffness is, N/m, by the rows of the window."""
        time, way, force = np.array(self._rows).T
        t = (time - time[0]) / (_WINDOW_S / 2) - 1
        turn = 2 * math.pi * _HZ * (time - time[0])
        A = np.column_stack([np.ones_like(t), t, t * t, t**3, np.cos(turn), np.sin(turn)])
        both = np.column_stack([way - way.mean(), force - force.mean()])
        found, _, rank, _ = np.linalg.lstsq(A, both, rcond=None)
        left = both - A @ found
        S, F = found[4] + 1j * found[5]
        size = abs(S)
        if rank < A.shape[1] or size < _LEAST_M:
            return 0.0, math.inf
        stiffness = float((F / S).real)
        noise = (left * left).sum(axis=0) / (len(t) - A.shape[1])
        error = math.sqrt(2 / len(t) * (noise[1] + stiffness**2 * noise[0])) / size
        return stiffness - _BAND * error, stiffness + _BAND * error


# ---- how stiff the tissue is: a small press, twice in and out, before anything is tracked --------


class StiffnessProbe:
    """
    A small press, twice in and out, by which the stiffness of what is touched is measured.

    The force is fitted as a + b t + c t² + k s with the travel s of the tip, so that tissue that moves meanwhile does
    not spoil k.

    Parameters
    ----------
    amplitude : float
        m.

    Attributes
    ----------
    began : float or None
        When it was started, s; None: it was not.
    """

    _FREQUENCY, _PERIODS = 5.0, 2
    _SECONDS = _PERIODS / _FREQUENCY

    def __init__(self, amplitude: float) -> None:
        self._amplitude = amplitude
        self._rows: list[tuple[float, float, float]] = []
        self.began: float | None = None

    def begin(self, now: float) -> None:
        """Start."""
        self.began = now
        self._rows.clear()

    def speed(self, now: float) -> float:
        """Return the speed into the tissue, m/s; 0 before and after."""
        if self.began is None or not 0 <= now - self.began < self._SECONDS - 1e-6:
            return 0.0
        turn = 2 * math.pi * self._FREQUENCY
        return self._amplitude * turn * math.cos(turn * (now - self.began))

    def take(self, time: float, travel: float, force: float) -> None:
        """Take how far the tip was into the tissue, m, and the force then, N."""
        if self.began is not None:
            self._rows.append((time, travel, force))

    def over(self, now: float) -> bool:
        """Whether it is done."""
        return self.began is not None and now - self.began > self._SECONDS + 0.04

    def stiffness(self) -> tuple[float, float] | None:
        """Return the stiffness and its standard error, N/m; None: the readings do not tell."""
        if len(self._rows) < 10:
            return None
        rows = np.array(self._rows)
        t = rows[:, 0] - rows[:, 0].mean()
        s = rows[:, 1] - rows[:, 1].mean()
        A = np.column_stack([np.ones_like(t), t, t * t, s / self._amplitude])
        found, _, rank, _ = np.linalg.lstsq(A, rows[:, 2], rcond=None)
        if rank < 4:
            return None
        left = rows[:, 2] - A @ found
        variance = float(left @ left) / (len(t) - 4)
        error = math.sqrt(variance * float(np.linalg.inv(A.T @ A)[3, 3])) / self._amplitude
        stiffness = float(found[3]) / self._amplitude
        return (stiffness, error) if stiffness > 4 * error else None


# ---- whether the force swings: its half-waves, and how much slower the force loop should be ------


_SLOW_S = 0.3  # time constant of the mean that a swing is around
_HALF_WAVE_S = (0.015, 0.26)  # of a loop that swings; tissue that moves is slower
_SEEN = 0.05  # of the wanted force: a half-wave of less is no swing
_GROWN = 0.35  # of the wanted force: a half-wave of more is one that a lower gain did not stop
_LOWERED = 0.65  # by each half-wave from the second on
_LEAST = 0.1  # of the gain
_HALVES = 4  # such half-waves one after the other, after which it should stand still
_ALONE_S = 0.45  # after which the next half-wave is the first of another swing
_QUIET_S, _BACK_S = 0.8, 2.0  # how long it must be quiet, and time constant of the way back


class Swing:
    """
    Watches the force error for half-waves one after the other, and lowers the gain before they grow.

    An unstable admittance loop shows itself by an alternating force; its detection and the gain that follows it are
    those of Dimeas and Aspragathos (2016), Online stability in human-robot cooperation with admittance control, IEEE
    Trans. Haptics 9(2), with amplitudes between zero crossings in place of a spectrum: they are known after half a
    period.

    Parameters
    ----------
    wanted : float
        Force, N: what is much is a share of it.

    Attributes
    ----------
    share : float
        Of the force loop's gain that is left, 0.1 to 1.
    beyond : bool
        Whether the swing is beyond what a lower gain stops.
    amplitude : float
        Of the newest half-wave, N.
    """

    def __init__(self, wanted: float) -> None:
        self._wanted = wanted
        self.share = 1.0
        self.reset()

    def reset(self) -> None:
        """Begin a new watch; the share that is left stays."""
        self.beyond, self.amplitude = False, 0.0
        self._mean: float | None = None
        self._sign, self._most, self._length = 0.0, 0.0, 0.0
        self._halves = self._large = 0
        self._quiet = 0.0  # s since a half-wave of a swing ended

    @property
    def seen(self) -> bool:
        """Whether it swings: two half-waves one after the other."""
        return self._halves > 1

    def take(self, error: float, dt: float) -> None:
        """Take the force error of a period of dt, N and s."""
        if self._mean is None:
            self._mean = error
        self._mean += (1 - math.exp(-dt / _SLOW_S)) * (error - self._mean)
        off = error - self._mean
        self._length += dt
        self._quiet += dt
        if off * self._sign < 0 or self._sign == 0:
            self._half()
            self._sign, self._most, self._length = math.copysign(1.0, off), 0.0, 0.0
        self._most = max(self._most, abs(off))
        if self._quiet > _ALONE_S:
            self._halves = self._large = 0
        if self._quiet > _QUIET_S:
            self.share += (1 - math.exp(-dt / _BACK_S)) * (1 - self.share)

    def explained(self, factor: float) -> None:
        """Take off what a stiffness that is so many times larger than was believed explains: the gain stays."""
        self.share = min(max(factor, 1.0) * self.share, 1.0)

    def _half(self) -> None:
        """Judge the half-wave that is over."""
        low, high = _HALF_WAVE_S
        if not (low <= self._length <= high and self._most > _SEEN * self._wanted):
            return
        self.amplitude, self._quiet = self._most, 0.0
        self._halves += 1
        self._large = self._large + 1 if self._most > _GROWN * self._wanted else 0
        if self._halves > 1:
            self.share = max(_LEAST, _LOWERED * self.share)
        self.beyond = self._large >= _HALVES
