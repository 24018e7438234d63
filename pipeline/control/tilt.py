"""How tissue is tilted against a probe: from where it touches, and from where its force leans."""

from __future__ import annotations

import math
from dataclasses import dataclass

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
        self,
        drag_sigma: float = LEAN_SIGMA,
        drag_seconds: float = LEAN_SECONDS,
        error_sigma: float = 3e-4,
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
