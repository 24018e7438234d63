"""
A contact with an area: its footprint, where the patch is, how far the centre of pressure is off its middle, its lean.

One wrench has one line of action, and where that leaves the surface is the centre of pressure of whatever touches. On
soft tissue that is not the middle of the patch: a probe that leans presses more on one side. With the probe's shape and
the tissue's - flat, or of a known curvature - the centre of pressure and the force say how it lies.
"""

from dataclasses import dataclass
from typing import Any, Self

import numpy as np
from numpy.typing import ArrayLike, NDArray

from contactbench.pipeline.errors import InputError, arg, message
from contactbench.pipeline.kernel import Batch, Contact, RuntimeContact, SurfaceIndex
from contactbench.pipeline.mesh import Probe

FACE_DEPTH_M = 0.012
_OUTSIDE_M = 0.001
Array = NDArray[np.float64]

_PLACES = 1500
_FEWEST_PLACES = 6  # places in contact: fewer are a point, and a point does not lean
_STEEPEST = np.radians(10.0)  # standard deviation of the lean: beyond, the patch tells nothing of it
_STEPS, _NEAR = 60, 1e-7  # m, of the centre of pressure
_HALVINGS = 12
_NUDGE = 2e-4  # m, to see how the patch follows the centre of pressure
_ROUNDS = 3  # the line of action is nearly upright: the height is settled after two
_MOST_CURVED = 100.0  # 1/m, a ball of 10 mm


@dataclass(frozen=True)
class Bed:
    """
    What is pressed: a bed of springs (Winkler 1867), each place of it pushed by its own depth.

    Parameters
    ----------
    curvature : (float, float)
        Of its surface along S's x and y, 1/m: 0 flat, positive where it bulges towards the probe.
    modulus : float
        Pressure per depth, N/m³. Deep tissue of 50 kPa under a probe has 3e6.
    factor : float
        The modulus may be this many times less or more, 1 sigma.

    Raises
    ------
    InputError
        A curvature beyond 100 per metre, a modulus that is not positive, a factor below 1.
    """

    curvature: tuple[float, float] = (0.0, 0.0)
    modulus: float = 3e6
    factor: float = 3.0

    @classmethod
    def parse(cls, text: str) -> Self:
        """
        Read a shape: ``flat``, or the radii of curvature along S's x and y, mm, ``RX,RY``, 0 for flat.

        Raises
        ------
        InputError
            It is neither, or curved beyond what a bed may be.
        """
        if text.strip() == "flat":
            return cls()
        try:
            x, y = (float(each) for each in text.split(","))
        except ValueError:
            raise InputError(
                f"patch {arg(text[:40])!r}: give flat, or the radii of the touched surface along S's x"
                " and y, mm, such as 80,0."
            ) from None
        return cls((1000 / x if x else 0.0, 1000 / y if y else 0.0))

    def __post_init__(self) -> None:
        if len(self.curvature) != 2 or not np.all(np.abs(self.curvature) <= _MOST_CURVED):
            raise InputError(
                f"Bed.curvature {arg(self.curvature)}: give two numbers within ±{arg(_MOST_CURVED):g} 1/m."
            )
        if not 0 < self.modulus < np.inf:
            raise InputError(f"Bed.modulus {arg(self.modulus)}: give a pressure per depth above 0, N/m³.")
        if not 1 <= self.factor < np.inf:
            raise InputError(
                f"Bed.factor {arg(self.factor)}: give the factor by which the modulus may be off, 1 or more."
            )


@dataclass(frozen=True)
class Patch:
    """
    An area of contact; S, along its x and y.

    Attributes
    ----------
    pressure_S, centre_S : (3,) float64
        Centre of pressure, and the middle of the area, on the probe's face, m.
    offset, offset_sigma : (2,) float64
        Of the centre of pressure from the middle, m.
    lean, lean_sigma : (2,) float64
        How the bed rises against the face along x and y, rad: positive where the +x or +y side is pressed in more.
    balance, balance_sigma : (2,) float64
        Share of the force on the + side of the middle less that on the other: -1 to 1, 0 even.
    area : float
        m².
    depth : float
        Of the deepest place, m.
    """

    pressure_S: NDArray[np.float64]
    centre_S: NDArray[np.float64]
    offset: NDArray[np.float64]
    offset_sigma: NDArray[np.float64]
    lean: NDArray[np.float64]
    lean_sigma: NDArray[np.float64]
    balance: NDArray[np.float64]
    balance_sigma: NDArray[np.float64]
    area: float
    depth: float

    @property
    def sentence(self) -> str:
        """What it says, in words."""
        x, y = 1e3 * self.offset
        dx, dy = 1e3 * self.offset_sigma
        (tx, ty), (sx, sy) = np.degrees(self.lean), np.degrees(self.lean_sigma)
        sides = [
            f"{50 * (1 - share):.0f}/{50 * (1 + share):.0f} ± {50 * sigma:.0f} % along {axis}"
            for axis, share, sigma in zip("xy", self.balance, self.balance_sigma, strict=True)
        ]
        return message(
            f"The point is the centre of pressure of a patch of {arg(1e4 * self.area):.1f} cm²:"
            f" {arg(x):+.1f} ± {arg(dx):.1f} mm along x and {arg(y):+.1f} ± {arg(dy):.1f} mm along y from"
            f" its middle; it is pressed at a tilt of {arg(tx):+.1f} ± {arg(sx):.1f}° along x and"
            f" {arg(ty):+.1f} ± {arg(sy):.1f}° along y; the force is {arg(sides[0])} and {arg(sides[1])}."
        )


class PatchReader:
    """
    Tells from a contact how the probe's face lies on what it presses.

    With depths ``u_i = max(0, d + t . xi_i - g_i)`` of places xi_i of the face, whose gap to the bed is g_i, the
    force is ``E a sum u`` and the centre of pressure ``sum u xi / sum u``: three equations for the depth d and the
    lean t. Friction along the bed moves neither.

    Parameters
    ----------
    probe : Probe
        In S, its face towards +z.
    bed : Bed, optional

    Raises
    ------
    InputError
        Nothing of the probe faces +z.
    """

    # The columns of `rows`, as a table of contacts has them.
    header = (
        b"centre_x,centre_y,centre_z,offset_x_mm,offset_y_mm,offset_sigma_x_mm,offset_sigma_y_mm"
        b",balance_x,balance_y,balance_sigma_x,balance_sigma_y\n"
    )

    def __init__(self, probe: Probe, bed: Bed | None = None) -> None:
        self.bed = bed or Bed()
        places, _, self._area = spread(probe, _PLACES)
        self._places = places
        self._middle = places[:, :2].mean(axis=0)
        self._xi = places[:, :2] - self._middle
        self._gaps = (
            float(places[:, 2].max()) - places[:, 2] + 0.5 * self._xi**2 @ np.array(self.bed.curvature)
        )
        self._rows = np.column_stack([np.ones(len(places)), self._xi])

    def read(self, force: ArrayLike, point: ArrayLike, covariance: ArrayLike) -> Patch | None:
        """
        Return the patch of a contact; None where its place and force show none.

        Parameters
        ----------
        force : (3,) array_like
            On the probe, S, N.
        point : (3,) array_like
            Where the line of action leaves the surface, S, m.
        covariance : (3, 3) array_like
            Of the point, m².
        """
        F, p, C = (np.asarray(each, dtype=np.float64) for each in (force, point, covariance))
        if not (np.isfinite(F).all() and np.isfinite(p).all() and np.isfinite(C).all()) or F[2] >= 0:
            return None
        found = self._patch(F, p, self.bed.modulus)
        if found is None:
            return None
        rows, patch, near = found
        # How all that is said follows the centre of pressure, and the modulus that is only nearly known.
        spread_by = []
        for axis, sigma in enumerate(np.sqrt(np.diag(C)[:2])):
            moved = p.copy()
            moved[axis] += _NUDGE
            other = self._patch(F, moved, self.bed.modulus, near)
            if other is None:
                moved[axis] -= 2 * _NUDGE
                other = self._patch(F, moved, self.bed.modulus, near)
            if other is None:
                return None
            spread_by.append((other[0] - rows) * sigma / _NUDGE)
        softer, harder = (
            self._patch(F, p, self.bed.modulus * f, near) for f in (1 / self.bed.factor, self.bed.factor)
        )
        by_modulus = [abs(other[0] - rows) for other in (softer, harder) if other is not None]
        if by_modulus:
            spread_by.append(np.max(by_modulus, axis=0))
        sigmas = np.sqrt((np.array(spread_by) ** 2).sum(axis=0))
        if sigmas[2:4].max() > _STEEPEST:
            return None
        return Patch(
            pressure_S=patch[0],
            centre_S=patch[1],
            offset=rows[:2],
            offset_sigma=sigmas[:2],
            lean=rows[2:4],
            lean_sigma=sigmas[2:4],
            balance=rows[4:],
            balance_sigma=sigmas[4:],
            area=patch[2],
            depth=patch[3],
        )

    def rows(self, wrenches: NDArray[np.float64], answers: Batch) -> NDArray[np.float64]:
        """
        Return a row for each answer, (n, 11), of what `read` says of it.

        Middle of the area in S, m; along x and y: offset from it, mm, with its sigma, and balance, with its sigma. NaN
        where the contact was not accepted, or shows no patch.
        """
        out = np.full((len(wrenches), 11), np.nan)
        points, covariances = answers.points, answers.covariances
        for row in np.flatnonzero(answers.accepted):
            patch = self.read(wrenches[row, :3], points[row], covariances[row])
            if patch is not None:
                mm = 1e3 * np.concatenate([patch.offset, patch.offset_sigma])
                out[row] = np.concatenate([patch.centre_S, mm, patch.balance, patch.balance_sigma])
        return out

    def _patch(
        self, F: Array, p: Array, modulus: float, near: Array | None = None
    ) -> tuple[Array, tuple[Array, Array, float, float], Array] | None:
        """
        Solve for one contact, from the depth and lean `near` by (3,), if they are known.

        Returns
        -------
        row : (6,)
            Offset, lean and balance.
        patch : tuple
            Centre of pressure, middle, area and depth.
        x : (3,)
            Depth and lean.
        """
        wanted = -F[2] / (modulus * self._area)  # sum of the depths, m
        at, x = p[:2] - self._middle, near
        # The pressures act on the face, whose height the line of action is followed to.
        for _ in range(_ROUNDS):
            solved = self._solve(wanted, at, x)
            if solved is None:
                return None
            deep, found = solved
            x = found
            height = float(deep @ self._places[:, 2]) / wanted
            at = (p + (height - p[2]) / F[2] * F)[:2] - self._middle
        inside = deep > 0
        if inside.sum() < _FEWEST_PLACES:
            return None
        middle: Array = self._xi[inside].mean(axis=0)
        centre = self._places[np.argmin(((self._xi - middle) ** 2).sum(axis=1))]
        # A place stands for its cell: where the middle runs through it, it counts to both sides.
        beyond = np.clip((self._xi - middle) / (0.5 * np.sqrt(self._area)), -1.0, 1.0)
        balance: Array = deep @ beyond / wanted
        pressure_S = np.array([*(at + self._middle), height])
        row: Array = np.concatenate([at - middle, found[1:], balance])
        patch = (
            pressure_S,
            np.array([*(middle + self._middle), centre[2]]),
            float(inside.sum() * self._area),
            float(deep.max()),
        )
        return row, patch, found

    def _solve(self, wanted: float, at: Array, near: Array | None) -> tuple[Array, Array] | None:
        """Return the depths of all places (n,), and depth and lean (3,); None where no lean has its pressure there."""
        targets, found = wanted * np.array([1.0, *at]), None
        # What there is to find is one point (the potential is convex); to begin beside it is only quicker.
        if near is not None:
            found = self._descend(targets, near)
        if found is None:
            found = self._descend(targets, np.array([self._depth_of(wanted), 0.0, 0.0]))
        return found if found is not None and found[0].max() < FACE_DEPTH_M else None

    def _descend(self, targets: Array, x: Array) -> tuple[Array, Array] | None:
        """Return depths (n,), and depth and lean (3,), by Newton steps from `x`; None: they lead nowhere."""
        wanted, at = targets[0], targets[1:] / targets[0]
        deep = np.maximum(self._rows @ x - self._gaps, 0.0)
        for _ in range(_STEPS):
            error = self._rows.T @ deep - targets
            misfit = float(np.abs(error[1:] - at * error[0]).max()) / wanted
            if misfit < _NEAR and abs(error[0]) < 1e-6 * wanted:
                return deep, x
            inside = self._rows[deep > 0]
            jacobian = inside.T @ inside
            if len(inside) < 3 or np.linalg.cond(jacobian) > 1e14:
                return None
            step = np.linalg.solve(jacobian, error)
            x, deep = self._stepped(x, deep, step, targets, float(step @ error))
        return None

    def _stepped(
        self, x: Array, deep: Array, step: Array, targets: Array, slope: float
    ) -> tuple[Array, Array]:
        """Return depth and lean, and depths, after the largest halving of a step that lowers the potential enough."""
        before = 0.5 * float(deep @ deep) - float(targets @ x)
        share = 1.0
        for _ in range(_HALVINGS):
            there = x - share * step
            deep = np.maximum(self._rows @ there - self._gaps, 0.0)
            after = 0.5 * float(deep @ deep) - float(targets @ there)
            # Armijo (1966); near the end the change is below what the sums resolve.
            if after <= before - 1e-4 * share * slope + 1e-12 * abs(before):
                break
            share *= 0.5
        return there, deep

    def _depth_of(self, wanted: float) -> float:
        """Return the depth, m, at which the depths of all places without a lean add up to what is wanted, m."""
        gaps = np.sort(self._gaps)
        sums = np.arange(1, len(gaps) + 1) * gaps - np.cumsum(gaps)  # at the depth of each gap
        count = max(int(np.searchsorted(sums, wanted)), 1)
        return float((wanted + gaps[:count].sum()) / count)


class LivePatch:
    """
    What a stream's contacts say of the patch, a few times a second: to read one costs milliseconds.

    Call it beside the stream, not in its thread.
    """

    def __init__(self, reader: PatchReader, every: float = 0.1) -> None:
        self._reader, self._every = reader, every
        self._time = -np.inf
        self._told: Patch | None = None

    def read(self, time: float, force: ArrayLike, contact: Contact | RuntimeContact | None) -> Patch | None:
        """
        Return the patch of a contact at a time of the stream, s; the one before, where that is still new.

        Parameters
        ----------
        force : (3,) array_like
            S, N.
        contact : contact, optional
            None, or one without a point or not accepted: nothing is told.
        """
        if contact is None or not contact.accepted or contact.point is None or contact.covariance is None:
            self._told = None
        elif not 0 <= time - self._time < self._every:
            self._time = time
            self._told = self._reader.read(force, contact.point, contact.covariance)
        return self._told


def spread(probe: Probe, count: int) -> tuple[NDArray[np.float64], NDArray[np.float64], float]:
    """
    Spread places over what tissue can reach of a probe: what is within 12 mm of its tip, seen from above.

    Parameters
    ----------
    count : int
        About how many.

    Returns
    -------
    places, normals : (n, 3)
        S, m, and outward.
    area : float
        Of the tissue's top for each place, m².
    """
    low, high = probe.vertices.min(axis=0) - _OUTSIDE_M, probe.vertices.max(axis=0) + _OUTSIDE_M
    index = SurfaceIndex(probe.vertices, probe.faces)
    cell = float(np.prod((high - low)[:2])) / count
    # The first grid shows how much of the rectangle is covered; the second has the right size.
    for _ in range(2):
        places, normals = _seen_from_above(probe, index, low, high, cell)
        if not len(places):
            raise InputError(
                f"probe {arg(probe.name)}: no part of it lies within 12 mm of its tip: check that it is aligned."
            )
        cell, area = cell * len(places) / count, cell
    return places, normals, area


def _seen_from_above(
    probe: Probe, index: Any, low: NDArray[np.float64], high: NDArray[np.float64], cell: float
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return the surface under the middles of a triangular grid, one per `cell` (m²)."""
    side = np.sqrt(2 * cell / np.sqrt(3))
    row = side * np.sqrt(3) / 2
    count = np.ceil((high - low)[:2] / [side, row]).astype(int) + 1
    x, y = np.meshgrid(np.arange(count[0]) * side, np.arange(count[1]) * row)
    x[1::2] += side / 2
    # Centred: a probe that is the same on both sides gets the same places there.
    middle = (low + high)[:2] / 2
    flat = np.column_stack([(x - x.mean()).ravel(), (y - y.mean()).ravel()]) + middle
    starts = np.column_stack([flat, np.full(len(flat), high[2] + _OUTSIDE_M)])
    down = np.broadcast_to([0.0, 0.0, -1.0], starts.shape)
    distances, facets = index.first_hit(starts, np.ascontiguousarray(down))
    hit = (facets >= 0) & (distances < 2 * _OUTSIDE_M + FACE_DEPTH_M)
    # Only what is hit: elsewhere the distance is infinite.
    return starts[hit] + distances[hit, None] * down[hit], probe.normals[facets[hit]]
