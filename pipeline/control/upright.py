"""How a probe turns to stand upright on what it presses."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from contactbench.pipeline.control.inverse import Admittance
from contactbench.pipeline.control.settings import ControlSettings, Variant

if TYPE_CHECKING:
    from numpy.typing import NDArray

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
        self,
        offset: NDArray[np.float64],
        R_BS: NDArray[np.float64],
        lead: float,
        dt: float,
        share: float,
        led: float,
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
        share, led : float
            Of the aware variant's gain, and of what it leads by.
        """
        settings = self._settings
        if settings.variant is Variant.AWARE:
            # The tilt itself instead of a place, with the damping that gives the wanted gain.
            tilt, gains, damping = self._surface.tilt, settings.angle_gains, settings.angle_damping
            torques = [share * tilt[axis] * gains[axis] * damping[axis] for axis in (0, 1)]
        else:
            x, y = offset.tolist()
            known = math.isfinite(x) and math.isfinite(y)
            here = np.array([x, y, 0.0]) if known else np.zeros(3)
            torques = (settings.desired_force * turn_of(here, _UP))[:2].tolist()
        self._means = [turn.step(torque, dt) for turn, torque in zip(self._turns, torques, strict=True)]
        turning = np.array([*self._means, 0.0])
        if settings.variant is Variant.AWARE:
            turning += led * self._led(R_BS, lead, dt)
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


# ---- how tissue is tilted against a probe --------------------------------------------------------


LEAN_SIGMA = math.radians(2.0)
LEAN_SECONDS = 1.0
_WALK = 2e-5  # m per root second, how the place's own error wanders


@dataclass(frozen=True)
class TiltReading:
    """What one wrench says about one axis."""

    lean: float  # angle of the force against S's z, rad
    place: float  # of the contact from where it should be, m; positive where a positive tilt moves it
    gain: float  # how far a tilt moves the place, m/rad
    lever: float  # height of the place over the sensor's origin, m
    # force_sigma, torque_sigma: of the wrench over its force: rad and m
    force_sigma: float
    torque_sigma: float


class Tilt:
    """
    The tilt about one axis: three unknowns, of which the wrench shows two sums.

    The force leans by ``lean = tilt + drag + n_F``, where drag is what friction adds: it changes with how the probe is
    dragged, and is 0 on average. The contact lies at ``place = gain tilt + error + lever n_F + n_M``, where error is
    constant: what a calibration leaves. On a narrow face the gain is so small that one place says nothing; but over a
    second it tells the drag from the tilt. The noise of the force is in both, so they are taken together: without it,
    ``place - lever lean`` is known five times better than either.

    Two states (drag, error) are kept, each with its variance: the drag is a first-order Gauss-Markov process, the
    error a constant that wanders slowly. The tilt itself may jump by any amount between two readings: nothing is
    smoothed here.

    Parameters
    ----------
    drag_sigma : float
        rad.
    drag_seconds : float
        How long it lasts.
    error_sigma : float
        m, of the place.
    """

    def __init__(
        self, drag_sigma: float = LEAN_SIGMA, drag_seconds: float = LEAN_SECONDS, error_sigma: float = 3e-4
    ) -> None:
        self._sigma2, self._seconds = drag_sigma**2, drag_seconds
        self._error2 = error_sigma**2
        self.reset()

    def reset(self) -> None:
        """Forget what was dragged; what the calibration leaves stays as unknown as at first."""
        self.drag = self.error = 0.0
        self._bb, self._bc, self._cc = self._sigma2, 0.0, self._error2

    def update(self, reading: TiltReading, dt: float) -> float:
        """Take a reading, dt (s) after the one before; returns the likeliest tilt, rad."""
        kept = math.exp(-dt / self._seconds)
        self.drag *= kept
        self._bb = kept * kept * self._bb + (1 - kept * kept) * self._sigma2
        self._bc *= kept
        self._cc += _WALK**2 * dt
        tilt = self._likeliest(reading)
        self._separate(reading)
        return tilt

    def sigma(self, reading: TiltReading) -> float:
        """Return the standard deviation of the tilt that a reading like this gives now, rad."""
        s11, s12, s22 = self._covariance(reading)
        second = reading.gain - reading.lever
        return math.sqrt((s11 * s22 - s12 * s12) / (s22 - 2 * s12 * second + s11 * second * second))

    def _covariance(self, r: TiltReading) -> tuple[float, float, float]:
        """S = B P B^T + R of m = (lean, place - lever lean): B = [[1, 0], [-z, 1]], and R is diagonal."""
        z, bb, bc, cc = r.lever, self._bb, self._bc, self._cc
        s22 = z * z * bb - 2 * z * bc + cc + r.torque_sigma**2
        return bb + r.force_sigma**2, -z * bb + bc, s22

    def _likeliest(self, r: TiltReading) -> float:
        """Generalised least squares: m = a tilt + B (drag, error) + noise, m = (lean, place - lever lean)."""
        z = r.lever
        first, second = 1.0, r.gain - z
        s11, s12, s22 = self._covariance(r)
        m1 = r.lean - self.drag
        m2 = r.place - z * r.lean + z * self.drag - self.error
        # a^T S^-1, but for the determinant, which falls out.
        w1, w2 = s22 * first - s12 * second, s11 * second - s12 * first
        return (w1 * m1 + w2 * m2) / (w1 * first + w2 * second)

    def _separate(self, r: TiltReading) -> None:
        """Kalman update by place - gain lean = error - gain drag + noise, from which the tilt is gone."""
        g = r.gain
        off = r.place - g * r.lean - (self.error - g * self.drag)
        variance = ((r.lever - g) * r.force_sigma) ** 2 + r.torque_sigma**2
        hb, hc = -g * self._bb + self._bc, -g * self._bc + self._cc
        total = -g * hb + hc + variance
        kb, kc = hb / total, hc / total
        self.drag += kb * off
        self.error += kc * off
        self._bb -= kb * hb
        self._bc -= kb * hc
        self._cc -= kc * hc


# ---- which error turns which axis ----------------------------------------------------------------


def turn_of(offset: NDArray[np.float64], normal: NDArray[np.float64]) -> NDArray[np.float64]:
    """
    Return the axis, times the length of the offset, about which a probe must turn to bring the contact back.

    Where the contact lies off its wanted place, the tissue is nearer there: that side must give way. A turn w moves a
    place e by w x e; with w = n x e that is (n x e) x e = -n |e|² for a tangent e: away from the tissue.
    A contact off in +x, with n = +z, needs a turn about +y; one off in +y, about -x.

    Parameters
    ----------
    offset : (3,)
        Contact minus wanted contact, m; what is along the normal does not count.
    normal : (3,)
        Outward unit normal n of the probe at the wanted contact, same frame.

    Returns
    -------
    (3,)
        n x e, m.
    """
    return cross(normal, offset)


def cross(a: NDArray[np.float64], b: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return a x b of two (3,); numpy's own takes ten times as long for one pair."""
    ax, ay, az = a.tolist()
    bx, by, bz = b.tolist()
    return np.array([ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx])


def pressing(force: NDArray[np.float64], normal: NDArray[np.float64]) -> float:
    """Return how hard the tissue is pressed, N: -n . F of the force F (3,) on the probe; negative if it pulls."""
    return -float(force @ normal)
