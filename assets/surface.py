"""Closed, smooth probe surfaces that are known exactly: points, normals, curvatures, samples, feet."""

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cached_property
from typing import NamedTuple, Protocol

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.interpolate import BSpline
from scipy.spatial import cKDTree
from scipy.special import xlogy

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


class Axis(NamedTuple):
    """One coordinate of the unit section with its derivatives in the angle ``phi`` and the exponent ``m``."""

    value: Array
    phi: Array
    m: Array
    phi_phi: Array
    phi_m: Array
    m_m: Array


def unit_section(phi: Array, m: Array) -> tuple[Axis, Axis]:
    """Evaluate the superellipse ``|x|^m + |y|^m = 1`` in polar form.

    The point is ``rho (cos phi, sin phi)`` with ``rho = (|cos phi|^m + |sin phi|^m)^(-1/m)``. Scaling it by
    the half widths afterwards, rather than putting them inside ``rho``, keeps the derivatives finite where
    a half width vanishes.

    Parameters
    ----------
    phi : (n,) array
        Polar angle on the unit section [rad].
    m : (n,) array
        Exponent, at least 2: 2 is an ellipse, larger values approach a rectangle.

    Returns
    -------
    x, y : Axis
        The two coordinates, each with first and second derivatives.
    """
    # A spline of exponents that are all 2 may fall short of 2 by rounding, where 0^(m-2) is infinite.
    m = np.maximum(m, 2.0)
    cos, sin = np.cos(phi), np.sin(phi)
    c, s = np.abs(cos), np.abs(sin)
    cm, sm = c**m, s**m
    total = cm + sm
    log_total = np.log(total)
    rho = np.exp(-log_total / m)
    first = (xlogy(cm, c) + xlogy(sm, s)) / total
    second = (xlogy(xlogy(cm, c), c) + xlogy(xlogy(sm, s), s)) / total
    # growth = d(log rho)/dm and its own derivative in m.
    growth = log_total / m**2 - first / m
    growth_m = 2 * first / m**2 - 2 * log_total / m**3 - (second - first**2) / m
    # With p = rho^(m+1), the angular derivatives collapse to x' = -p s^(m-1), y' = p c^(m-1).
    p = rho / total
    c_lower, s_lower = c ** (m - 1), s ** (m - 1)
    cs, sc = c_lower * np.sign(cos), s_lower * np.sign(sin)
    log_rho_phi = (cs * sin - sc * cos) / total
    p_phi, p_m = (m + 1) * p * log_rho_phi, p * (-log_total / m + (m + 1) * growth)

    def axis(turn: int, base: Array, lower: Array, side: Array, other: Array) -> Axis:
        value, edge = rho * other, lower * np.sign(side)
        return Axis(
            value=value,
            phi=turn * p * edge,
            m=value * growth,
            phi_phi=turn * p_phi * edge - p * (m - 1) * base ** (m - 2) * other,
            phi_m=turn * p_m * edge + turn * p * xlogy(lower, base) * np.sign(side),
            m_m=value * (growth**2 + growth_m),
        )

    return axis(-1, s, s_lower, sin, cos), axis(1, c, c_lower, cos, sin)


Where = Callable[[Array, Array], NDArray[np.bool_]]

_SEEDS = 50_000
_STEPS = 80
_SETTLED = 1e-13  # [m] a tangential step this short is rounding
_STUCK = 1e9  # damping at which no downhill step is left
_POLE = 1e-3  # closest the curvature formula may come to the ends of the chart


class Jet(NamedTuple):
    """Points of a surface (n, 3) [m] with their first and second derivatives in ``phi`` and ``t``."""

    p: Array
    phi: Array
    t: Array
    phi_phi: Array
    phi_t: Array
    tt: Array


# Nowhere, and what is known of it.
_NOTHING = np.empty(0), np.empty(0), Jet(*[np.empty((0, 3))] * 6)


class Station(NamedTuple):
    """A curve once around the probe that meshes should follow, such as a rounded edge.

    ``side`` is its profile parameter where it crosses the x axis' ends and ``front`` where it crosses the
    ends of the y axis; the two differ where the edge exists at the x ends only.
    """

    side: float
    front: float


@dataclass(frozen=True, eq=False)
class Surface:
    """A closed probe surface in frame S (origin on the flange plane, +z to the tip), all lengths in metres.

    ``S(phi, t) = (a X, b Y, z + W)``: (X, Y)(phi, m) is the unit superellipse, ``(a, b, z, m)(t)`` a spline
    from the flange centre (t = 0, a = b = 0) to the middle of the face (t = 1), and ``W(x, z)`` an
    optional axial shear. The face ends in the segment ``|x| <= a(1)``, ``y = 0``, where ``b`` vanishes: on
    a long, narrow face the sections then stay a constant distance apart. Both ends are plane, so
    the surface is smooth there. It is symmetric in x and in y.

    Parameters
    ----------
    profile : BSpline
        Half widths a and b [m], height z [m] and exponent m of the section, for t in [0, 1].
    warp : Warp, optional
        Shear along z applied to the sweep.
    stations : tuple of Station
        Edges that meshes follow, by increasing parameter.
    """

    profile: BSpline
    warp: Warp | None = None
    stations: tuple[Station, ...] = ()
    _last: tuple[Array, Array, Jet] = field(default=_NOTHING, init=False, repr=False)

    def points(self, phi: ArrayLike, t: ArrayLike) -> Array:
        """Return the surface points (n, 3) [m, S] at angles ``phi`` [rad] and profile parameters ``t``."""
        angle, along = _pair(phi, t)
        a, b, z, m = np.moveaxis(self._curve[0](along), -1, 0)
        x_axis, y_axis = unit_section(angle, m)
        x = a * x_axis.value
        lift = 0.0 if self.warp is None else self.warp.shift(x, z).value
        return np.stack([x, b * y_axis.value, z + lift], axis=-1)

    def normals(self, phi: ArrayLike, t: ArrayLike) -> Array:
        """Return the outward unit normals (n, 3) in S at ``phi`` [rad] and ``t``."""
        angle, along = _pair(phi, t)
        return self._unit_normals(self.jet(angle, along), along)

    def principal_curvatures(self, phi: ArrayLike, t: ArrayLike) -> Array:
        """Return the principal curvatures (n, 2) [1/m], smaller first, positive where convex.

        At the two ends, where the chart is singular and the surface plane or cylindrical, the value a
        thousandth of the profile away stands in.
        """
        angle, along = _pair(phi, t)
        along = np.clip(along, _POLE, 1 - _POLE)
        jet = self.jet(angle, along)
        n = self._unit_normals(jet, along)
        e, f, g = _dot(jet.phi, jet.phi), _dot(jet.phi, jet.t), _dot(jet.t, jet.t)
        l2, m2, n2 = -_dot(jet.phi_phi, n), -_dot(jet.phi_t, n), -_dot(jet.tt, n)
        area2 = e * g - f**2
        mean = (e * n2 - 2 * f * m2 + g * l2) / (2 * area2)
        spread = np.sqrt(np.maximum(mean**2 - (l2 * n2 - m2**2) / area2, 0.0))
        return np.stack([mean - spread, mean + spread], axis=-1)

    def sample(
        self, n: int, rng: np.random.Generator, where: Where | None = None
    ) -> tuple[Array, Array, Array, Array]:
        """Draw points uniformly by area.

        Parameters
        ----------
        n : int
            How many points to return.
        rng : numpy.random.Generator
            Source of randomness; the same state gives the same points.
        where : callable, optional
            Takes points (k, 3) [m, S] and normals (k, 3) and returns a mask (k,) of those to keep.

        Returns
        -------
        points, normals : (n, 3) arrays
            In S [m] and unit.
        phi, t : (n,) arrays
            Their parameters.

        Raises
        ------
        ValueError
            If ``where`` keeps nothing in a hundred thousand draws.
        """
        kept: list[tuple[Array, Array, Array, Array]] = []
        have = drawn = 0
        while have < n or not kept:
            phi, t = self._draw(2 * n + 1000, rng)
            drawn += len(phi)
            points, normals = self.points(phi, t), self.normals(phi, t)
            mask = np.ones(len(phi), bool) if where is None else np.asarray(where(points, normals), bool)
            kept.append((points[mask], normals[mask], phi[mask], t[mask]))
            have += int(mask.sum())
            if have == 0 and drawn > 100_000:
                raise ValueError("`where` rejected every point of the surface: loosen the condition")
        points, normals, phi, t = (np.concatenate(part)[:n] for part in zip(*kept, strict=True))
        return points, normals, phi, t

    def project(self, points: ArrayLike) -> tuple[Array, Array, Array]:
        """Find the nearest surface points.

        Parameters
        ----------
        points : (n, 3) array
            Anywhere near the surface [m, S]. The search starts at the nearest of fifty thousand samples, so
            points about equally far from two sheets may be given either foot. At a centre of curvature of the
            surface the foot, though not the distance, is undetermined.

        Returns
        -------
        points, normals : (n, 3) arrays
            Feet in S [m] and the outward unit normals there.
        distance : (n,) array
            Signed distance [m], positive outside.
        """
        target = np.asarray(points, np.float64).reshape(-1, 3)
        phi, t = self.parameters(target)
        foot, normal = self.points(phi, t), self.normals(phi, t)
        gap = target - foot
        return foot, normal, np.copysign(np.linalg.norm(gap, axis=-1), _dot(gap, normal))

    def parameters(self, points: ArrayLike) -> tuple[Array, Array]:
        """Return ``phi`` [rad] and ``t`` of the surface points nearest to ``points`` (n, 3) [m, S]."""
        target = np.asarray(points, np.float64).reshape(-1, 3)
        seed_phi, seed_t, tree = self._seeds
        nearest = tree.query(target)[1]
        phi, t = seed_phi[nearest].copy(), seed_t[nearest].copy()
        damping = np.full(len(target), 1e-6)
        active = np.arange(len(target))
        for _ in range(_STEPS):
            if not len(active):
                break
            new_phi, new_t, new_damping, done = self._descend(
                target[active], phi[active], t[active], damping[active]
            )
            phi[active], t[active], damping[active] = new_phi, new_t, new_damping
            active = active[~done]
        return phi, t

    def jet(self, phi: Array, t: Array) -> Jet:
        """Evaluate points and exact first and second derivatives at ``phi`` [rad] and ``t``, both (n,).

        Normals and curvatures are mostly asked for at the same points, one after the other: the last are remembered.
        """
        *where, jet = self._last
        if np.array_equal(where[0], phi) and np.array_equal(where[1], t):
            return jet
        (a, b, z, m), (a1, b1, z1, m1), (a2, b2, z2, m2) = (
            np.moveaxis(curve(t), -1, 0) for curve in self._curve
        )
        section = unit_section(phi, m)
        x, y = _swept(section[0], a, a1, a2, m1, m2), _swept(section[1], b, b1, b2, m1, m2)
        zero = np.zeros_like(z)
        plane = (z, zero, z1, zero, zero, z2)
        heights = plane if self.warp is None else _sheared(self.warp, x, plane)
        jet = Jet(*(np.stack(part, axis=-1) for part in zip(x, y, heights, strict=True)))
        object.__setattr__(self, "_last", (phi.copy(), t.copy(), jet))
        return jet

    def _unit_normals(self, jet: Jet, t: Array) -> Array:
        cross = np.cross(jet.phi, jet.t)
        size = np.linalg.norm(cross, axis=-1)
        scale = np.linalg.norm(jet.phi, axis=-1) * np.linalg.norm(jet.t, axis=-1)
        singular = size <= 1e-12 * scale + 1e-18
        normals = cross / np.where(singular, 1.0, size)[:, None]
        if singular.any():
            normals[singular] = self._end_normals(jet.p[singular, 0], t[singular])
        return np.asarray(normals)

    def _end_normals(self, x: Array, t: Array) -> Array:
        """Return normals at the chart's ends: the flange faces -z, the acoustic face is a graph over x."""
        slope = np.zeros_like(x)
        if self.warp is not None:
            slope = self.warp.shift(x, np.full_like(x, float(self.profile(1.0)[2]))).x
        face = np.stack([-slope, np.zeros_like(x), np.ones_like(x)], axis=-1)
        face /= np.linalg.norm(face, axis=-1, keepdims=True)
        return np.where(t[:, None] < 0.5, np.array([0.0, 0.0, -1.0]), face)

    @cached_property
    def _curve(self) -> tuple[BSpline, BSpline, BSpline]:
        return self.profile, self.profile.derivative(), self.profile.derivative(2)

    @cached_property
    def _cells(self) -> tuple[Array, Array, Array, Array]:
        """Return a parameter grid's edges, a bound of the area element per cell, and its running total."""
        phi, t = np.linspace(0, 2 * np.pi, 193), np.linspace(0, 1, 769)
        grid = np.meshgrid(phi, t)
        jet = self.jet(grid[0].ravel(), grid[1].ravel())
        area = np.linalg.norm(np.cross(jet.phi, jet.t), axis=-1).reshape(len(t), len(phi))
        corners = [area[:-1, :-1], area[1:, :-1], area[:-1, 1:], area[1:, 1:]]
        # Rejection needs a bound: the area element may exceed the corners' maximum inside a cell.
        bound = 1.1 * np.max(corners, axis=0) + 1e-3 * area.max()
        return phi, t, bound, np.cumsum(bound)

    @cached_property
    def _seeds(self) -> tuple[Array, Array, cKDTree]:
        points, _, phi, t = self.sample(_SEEDS, np.random.default_rng(0))
        return phi, t, cKDTree(points)

    def _draw(self, n: int, rng: np.random.Generator) -> tuple[Array, Array]:
        """Propose ``n`` parameters and keep those that make the area density uniform."""
        phi_edges, t_edges, bound, total = self._cells
        cell = np.searchsorted(total, rng.random(n) * total[-1], side="right")
        row, column = np.divmod(cell, bound.shape[1])
        phi = phi_edges[column] + rng.random(n) * (phi_edges[1] - phi_edges[0])
        t = t_edges[row] + rng.random(n) * (t_edges[1] - t_edges[0])
        jet = self.jet(phi, t)
        keep = rng.random(n) * bound[row, column] < np.linalg.norm(np.cross(jet.phi, jet.t), axis=-1)
        return phi[keep], t[keep]

    def _descend(
        self, target: Array, phi: Array, t: Array, damping: Array
    ) -> tuple[Array, Array, Array, NDArray[np.bool_]]:
        """Take one damped Newton step on the squared distance; a step that climbs is undone."""
        jet = self.jet(phi, t)
        gap = jet.p - target
        e, f, g = _dot(jet.phi, jet.phi), _dot(jet.phi, jet.t), _dot(jet.t, jet.t)
        h11, h12, h22 = e + _dot(gap, jet.phi_phi), f + _dot(gap, jet.phi_t), g + _dot(gap, jet.tt)
        # Away from a minimum the Hessian may be indefinite; Gauss-Newton then still goes downhill.
        poor = (h11 <= 0) | (h11 * h22 - h12**2 <= 1e-3 * (e * g - f**2))
        h11, h12, h22 = np.where(poor, e, h11), np.where(poor, f, h12), np.where(poor, g, h22)
        h11, h22 = h11 + damping * e + 1e-18, h22 + damping * g + 1e-18
        r1, r2 = -_dot(jet.phi, gap), -_dot(jet.t, gap)
        det = h11 * h22 - h12**2
        d_phi, d_t = (h22 * r1 - h12 * r2) / det, (h11 * r2 - h12 * r1) / det
        new_phi, new_t = _move(phi, t, d_phi, d_t)
        new_gap = self.points(new_phi, new_t) - target
        # Close to the foot the distance changes by less than its rounding, but Newton's step is still good.
        better = _dot(new_gap, new_gap) <= _dot(gap, gap) * (1 + 1e-14)
        length = np.sqrt(np.maximum(e * d_phi**2 + 2 * f * d_phi * d_t + g * d_t**2, 0.0))
        damping = np.where(better, damping / 10, np.maximum(damping * 10, 1e-3))
        done = (length < _SETTLED) | (damping > _STUCK)
        return np.where(better, new_phi, phi), np.where(better, new_t, t), damping, done


def _pair(phi: ArrayLike, t: ArrayLike) -> tuple[Array, Array]:
    angle, along = np.broadcast_arrays(np.asarray(phi, np.float64), np.asarray(t, np.float64))
    return angle.ravel(), along.ravel()


def _dot(a: Array, b: Array) -> Array:
    return np.asarray(np.einsum("ij,ij->i", a, b))


def _move(phi: Array, t: Array, d_phi: Array, d_t: Array) -> tuple[Array, Array]:
    """Apply a parameter step, walking through either end of the chart to its far side."""
    # Near the flange centre (phi, t) are polar coordinates: a straight step there is straight in the plane.
    ahead, aside = t + d_t, t * d_phi
    flat = t < 0.05
    new_t = np.where(flat, np.hypot(ahead, aside), ahead)
    new_phi = phi + np.where(flat, np.arctan2(aside, ahead), np.clip(d_phi, -0.5, 0.5))
    new_phi = np.where(new_t < 0, new_phi + np.pi, new_phi)
    # Crossing the face's middle segment y = 0 mirrors the angle.
    new_phi = np.where(new_t > 1, -new_phi, new_phi)
    new_t = np.abs(new_t)
    return new_phi, np.clip(np.where(new_t > 1, 2 - new_t, new_t), 0.0, 1.0)


def _swept(axis: Axis, a: Array, a1: Array, a2: Array, m1: Array, m2: Array) -> tuple[Array, ...]:
    """Return one coordinate ``a(t) X(phi, m(t))`` in the order of a jet."""
    return (
        a * axis.value,
        a * axis.phi,
        a1 * axis.value + a * axis.m * m1,
        a * axis.phi_phi,
        a1 * axis.phi + a * axis.phi_m * m1,
        a2 * axis.value + 2 * a1 * axis.m * m1 + a * (axis.m_m * m1**2 + axis.m * m2),
    )


def _sheared(warp: Warp, x: tuple[Array, ...], z: tuple[Array, ...]) -> tuple[Array, ...]:
    """Apply the chain rule to ``z + W(x, z)`` in the order of a jet; the plain ``z`` is free of ``phi``."""
    w = warp.shift(x[0], z[0])
    grow = 1 + w.z
    return (
        z[0] + w.value,
        w.x * x[1],
        grow * z[2] + w.x * x[2],
        w.x * x[3] + w.xx * x[1] ** 2,
        w.x * x[4] + w.xx * x[1] * x[2] + w.xz * x[1] * z[2],
        grow * z[5] + w.x * x[5] + w.xx * x[2] ** 2 + 2 * w.xz * x[2] * z[2] + w.zz * z[2] ** 2,
    )
