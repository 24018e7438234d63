"""How the tissue moves, and how stiff it is: what the aware controller leads by."""

import math

import numpy as np
from numpy.typing import ArrayLike, NDArray

from contactbench.pipeline.control.settings import USUAL_MODULUS, FacePress, Foundation
from contactbench.pipeline.control.upright import Tilt, TiltReading, cross

_SOFTEST, _STIFFEST = USUAL_MODULUS / 20, USUAL_MODULUS * 20


class TissueSurface:
    """
    Follows the tissue's undeformed surface, as a place along the probe's axis and as a normal.

    What is pressed by a force f is d deep, which `Foundation` knows, so the surface lies d before the tip; and where
    the contact is off by e, the tissue is tilted by e over the gain. Both are the tissue's own: they do not depend on
    how the probe moves, but for what the tool's inertia adds to a reading.

    Parameters
    ----------
    bandwidth : (place, tilt about x, tilt about y)
        1/s.
    tilts : (about x, about y) of Tilt, optional
        How the place of the contact and the lean of the force are taken together.

    Attributes
    ----------
    tilt : (about x, about y)
        Of the tissue against the probe, rad.
    """

    def __init__(
        self,
        foundation: Foundation,
        bandwidth: tuple[float, float, float],
        tilts: tuple[Tilt, Tilt] | None = None,
    ) -> None:
        self._foundation = foundation
        place, about_x, about_y = bandwidth
        self._place = Follower(np.full(3, place))
        # In the axes that the sensor had first: a turn about x moves a normal near z along y.
        self._normal = Follower([about_y, about_x, max(about_x, about_y)])
        self._axes = np.eye(3)
        self._tilts = tilts or (Tilt(), Tilt())
        self.modulus = USUAL_MODULUS  # N/m³, a first guess
        self.tilt = (0.0, 0.0)

    def press(self, force: float) -> FacePress:
        """Return what is known of a press of that force, N."""
        return self._foundation.at(max(force, 0.1), self.modulus)

    def learn(
        self, force: float, stiffness: float, share: float = 1.0, inward: NDArray[np.float64] | None = None
    ) -> None:
        """
        Take a stiffness that was measured.

        Parameters
        ----------
        force, stiffness : float
            N, N/m.
        share : float
            Of the bandwidth to follow the surface with from now on.
        inward : (3,), optional
            The probe's axis, in B, if it was measured while it tracks: the surface does not jump then. Else it is
            followed from anew: with another depth it is elsewhere, it did not go there.
        """
        before = self.press(force).depth
        found = self._foundation.modulus_of(force, stiffness)
        self.modulus = min(max(found, _SOFTEST), _STIFFEST)
        if inward is None:
            self._place.reset()
            inward = np.zeros(3)
        self._place.shift((before - self.press(force).depth) * inward, share)

    def forget(self) -> None:
        """Begin anew: the tissue was left."""
        self._place.reset()
        self._normal.reset()
        for each in self._tilts:
            each.reset()
        self.tilt = (0.0, 0.0)

    def update(
        self,
        dt: float,
        tip: NDArray[np.float64],
        axes: NDArray[np.float64],
        force: float,
        offset: tuple[float, float] | None,
        leaning: tuple[float, float],
        sigmas: tuple[float, float],
    ) -> None:
        """
        Take what was sensed.

        Parameters
        ----------
        dt : float
            s since the last time.
        tip : (3,)
            The wanted contact's place in B, m, at the time of the readings.
        axes : (3, 3)
            R_BS then: its third column points into the tissue.
        force : float
            N.
        offset : (x, y) or None
            Of the contact from where it should be, along S's x and y, m; None: not known.
        leaning : (about x, about y)
            How far the force leans from S's z, rad.
        sigmas : (force, torque)
            Of the wrench, N and N·m.
        """
        press = self.press(force)
        inward = axes[:, 2]
        self._place.update(tip - press.depth * inward, dt)
        if offset is None:
            self._normal.update(None, dt)
            self.tilt = (0.0, 0.0)
            return
        if not self._normal.running:
            self._axes = axes.copy()
        # A contact off in +x: the tissue is nearer there, its inward normal turned about +y.
        places = (-offset[1], offset[0])
        gains = (press.gain_y, press.gain_x)
        noise = sigmas[0] / force, sigmas[1] / force
        about_x, about_y = (
            tilt.update(TiltReading(lean, place, gain, self._foundation.height, *noise), dt)
            for tilt, lean, place, gain in zip(self._tilts, leaning, places, gains, strict=True)
        )
        self.tilt = (about_x, about_y)
        self._normal.update(self._axes.T @ _turned(axes, about_x, about_y), dt)

    def speed_along(self, inward: NDArray[np.float64], lead: float) -> float:
        """Return how fast the surface goes along an axis in `lead` s, m/s."""
        return float(self._place.speed(lead) @ inward) if self._place.running else 0.0

    def turning(self, lead: float) -> NDArray[np.float64]:
        """Return how fast the surface turns, (3,) in B, rad/s, without its spin."""
        normal = self._normal.value(lead)
        if normal is None:
            return np.zeros(3)
        length2 = float(normal @ normal)
        return np.asarray(self._axes @ cross(normal, self._normal.speed(lead)) / length2)


def _turned(axes: NDArray[np.float64], about_x: float, about_y: float) -> NDArray[np.float64]:
    """Return S's z axis in B after a turn about S's x and y, rad."""
    angle = math.hypot(about_x, about_y)
    if angle < 1e-12:
        return np.array(axes[:, 2])
    angle_used = min(angle, 0.6)  # what the linear gain says of more is no angle any more
    c, s = math.cos(angle_used), math.sin(angle_used) / angle
    return np.asarray(axes @ np.array([s * about_y, -s * about_x, c]))


# ---- where something that moves smoothly will be -------------------------------------------------


class Follower:
    """
    A critically damped filter of third order: an error of the speed or the acceleration dies out, without swinging.

    The three poles lie at exp(-bandwidth dt), as in a fading-memory filter; a value that moves with a steady
    acceleration is followed without lag.

    Parameters
    ----------
    bandwidth : array_like (k,)
        1/s, for each component.
    """

    def __init__(self, bandwidth: ArrayLike) -> None:
        self._bandwidth = np.array(bandwidth, dtype=np.float64)
        self._share = 1.0
        self._x: NDArray[np.float64] | None = None
        self._v = self._a = np.zeros_like(self._bandwidth)

    @property
    def running(self) -> bool:
        """Whether there was a value yet."""
        return self._x is not None

    def reset(self) -> None:
        """Forget everything."""
        self._x = None
        self._v = self._a = np.zeros_like(self._bandwidth)

    def update(self, value: NDArray[np.float64] | None, dt: float) -> None:
        """Go on by dt (s) and take a value (k,); None: there is none, and the speed fades out."""
        if self._x is None:
            self._x = None if value is None else value.copy()
            return
        x = self._x + self._v * dt + 0.5 * self._a * dt * dt
        v = self._v + self._a * dt
        if value is None:
            fade = np.exp(-self._share * self._bandwidth * dt)
            self._x, self._v, self._a = x, v * fade, self._a * fade * fade
            return
        r = np.exp(-self._share * self._bandwidth * dt)
        error = value - x
        self._x = x + (1 - r**3) * error
        self._v = v + 1.5 * (1 - r) ** 2 * (1 + r) / dt * error
        self._a = self._a + (1 - r) ** 3 / dt**2 * error

    def shift(self, by: NDArray[np.float64], share: float) -> None:
        """Take the value for one that is off by (k,), at the same speed; go on with a share of the bandwidth."""
        self._share = share
        if self._x is not None:
            self._x = self._x + by

    def speed(self, lead: float = 0.0) -> NDArray[np.float64]:
        """Return the speed (k,) in `lead` s from the newest value."""
        return np.asarray(self._v + self._a * lead)

    def value(self, lead: float = 0.0) -> NDArray[np.float64] | None:
        """Return the value (k,) then; None before there was one."""
        return None if self._x is None else self._x + self._v * lead + 0.5 * self._a * lead * lead
