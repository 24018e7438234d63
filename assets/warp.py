"""Shears along the probe axis that turn a plane sweep into a curved face or a square shoulder."""

from dataclasses import dataclass
from typing import NamedTuple, Protocol

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


class Shift(NamedTuple):
    """An axial shift ``W(x, z)`` [m] with its first and second derivatives."""

    value: Array
    x: Array
    z: Array
    xx: Array
    xz: Array
    zz: Array


class Warp(Protocol):
    """Moves a point ``(x, y, z)`` to ``(x, y, z + W(x, z))``; invertible as long as ``1 + dW/dz > 0``."""

    def shift(self, x: Array, z: Array) -> Shift:
        """Evaluate ``W`` at points given in frame S [m]."""
        ...


def smooth_step(value: Array, start: float, stop: float) -> tuple[Array, Array, Array]:
    """Rise from 0 at ``start`` to 1 at ``stop`` with two continuous derivatives, all three returned."""
    width = stop - start
    s = np.clip((value - start) / width, 0.0, 1.0)
    step = s**3 * (10 - 15 * s + 6 * s**2)
    slope = 30 * s**2 * (1 - s) ** 2 / width
    bend = 60 * s * (1 - s) * (1 - 2 * s) / width**2
    return step, slope, bend


@dataclass(frozen=True)
class Arc:
    """Bend the head over a circle about the y direction, so that its plane face becomes a cylinder.

    ``W = w(z) (sqrt(R^2 - x^2) - R)``, with ``w`` rising from 0 at ``start`` to 1 at ``stop``.

    Parameters
    ----------
    radius : float
        Radius R of the face [m]; larger than any ``|x|`` of the body.
    start, stop : float
        Heights between which the bend sets in [m].
    """

    radius: float
    start: float
    stop: float

    def shift(self, x: Array, z: Array) -> Shift:
        """Evaluate ``W`` at points given in frame S [m]."""
        w, w_z, w_zz = smooth_step(z, self.start, self.stop)
        root = np.sqrt(self.radius**2 - x**2)
        sag, sag_x, sag_xx = root - self.radius, -x / root, -(self.radius**2) / root**3
        return Shift(w * sag, w * sag_x, w_z * sag, w * sag_xx, w_z * sag_x, w_zz * sag)


@dataclass(frozen=True)
class Shoulder:
    """Pull the flanks of a fan-shaped head down until its slanted sides lie square to the axis.

    A sweep whose width jumps at constant height has all its sections pass through one line on the narrow
    sides, where the chart degenerates. Sweeping a fan and shearing it afterwards gives the same square
    shoulder with a regular chart. ``W = -w(z) f(|x|)``; ``f`` is 0 up to ``inner`` and has slope ``slope``
    from ``inner + blend`` on; ``w`` falls from 1 at ``start`` to 0 at ``stop`` so that the face stays plane.

    Parameters
    ----------
    slope : float
        dz/dx of the slanted sides of the fan [1].
    inner, blend : float
        Where the shear sets in and the width over which it does [m].
    foot : float
        Height below which nothing moves [m]; the body must be inside ``inner`` there and a little above.
    start, stop : float
        Heights between which the shear dies out below the face [m].
    """

    slope: float
    inner: float
    blend: float
    foot: float
    start: float
    stop: float

    def shift(self, x: Array, z: Array) -> Shift:
        """Evaluate ``W`` at points given in frame S [m]."""
        fall, fall_z, fall_zz = smooth_step(z, self.start, self.stop)
        # The body lies inside `inner` at `foot`, so switching off below it needs no ramp.
        above = (z > self.foot).astype(np.float64)
        w, w_z, w_zz = above * (1 - fall), -above * fall_z, -above * fall_zz
        s = np.maximum(np.abs(x) - self.inner, 0.0) / self.blend
        near = s < 1
        reach = self.slope * self.blend
        f = reach * np.where(near, s**3 - s**4 / 2, s - 0.5)
        f_x = self.slope * np.where(near, s**2 * (3 - 2 * s), 1.0) * np.sign(x)
        f_xx = self.slope / self.blend * np.where(near, 6 * s * (1 - s), 0.0)
        return Shift(-w * f, -w * f_x, -w_z * f, -w * f_xx, -w_z * f_x, -w_zz * f)
