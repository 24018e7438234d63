"""
A contact with an area: where the patch is, how far the centre of pressure is off its middle, and how it leans.

One wrench has one line of action, and where that leaves the surface is the centre of pressure of whatever touches. On
soft tissue that is not the middle of the patch: a probe that leans presses more on one side. With the probe's shape and
the tissue's - flat, or of a known curvature - the centre of pressure and the force say how it lies.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from contactbench.pipeline.contact.footprint import FACE_DEPTH_M, spread
from contactbench.pipeline.errors import InputError

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from contactbench.pipeline.kernel import Batch
    from contactbench.pipeline.mesh import Probe

_PLACES = 1500
_FEWEST = 6  # places in contact: fewer are a point, and a point does not lean
_STEEPEST = np.radians(10.0)  # standard deviation of the lean: beyond, the patch tells nothing of it
_STEPS, _NEAR = 60, 1e-7  # m, of the centre of pressure
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

    def __post_init__(self) -> None:
        if len(self.curvature) != 2 or not np.all(np.abs(self.curvature) <= _MOST_CURVED):
            raise InputError(
                f"Bed.curvature {self.curvature}: give two numbers within ±{_MOST_CURVED:g} 1/m."
            )
        if not 0 < self.modulus < np.inf:
            raise InputError(f"Bed.modulus {self.modulus}: give a pressure per depth above 0, N/m³.")
        if not 1 <= self.factor < np.inf:
            raise InputError(
                f"Bed.factor {self.factor}: give how many times off the modulus may be, 1 or more."
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
        sides = [
            f"{50 * (1 - share):.0f}/{50 * (1 + share):.0f} ± {50 * sigma:.0f} % along {axis}"
            for axis, share, sigma in zip("xy", self.balance, self.balance_sigma, strict=True)
        ]
        x, y = 1e3 * self.offset
        dx, dy = 1e3 * self.offset_sigma
        return (
            f"Centre of pressure of a patch of {1e4 * self.area:.1f} cm²: {x:+.1f} ± {dx:.1f} mm along x and"
            f" {y:+.1f} ± {dy:.1f} mm along y from its middle; the force is {sides[0]} and {sides[1]}."
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
        rows, patch = found
        # How all that is said follows the centre of pressure, and the modulus that is only nearly known.
        spread_by = []
        for axis, sigma in enumerate(np.sqrt(np.diag(C)[:2])):
            moved = p.copy()
            moved[axis] += _NUDGE
            other = self._patch(F, moved, self.bed.modulus)
            if other is None:
                moved[axis] -= 2 * _NUDGE
                other = self._patch(F, moved, self.bed.modulus)
            if other is None:
                return None
            spread_by.append((other[0] - rows) * sigma / _NUDGE)
        softer, harder = (
            self._patch(F, p, self.bed.modulus * f) for f in (1 / self.bed.factor, self.bed.factor)
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
        self, F: NDArray[np.float64], p: NDArray[np.float64], modulus: float
    ) -> tuple[NDArray[np.float64], tuple[NDArray[np.float64], NDArray[np.float64], float, float]] | None:
        """Offset, lean and balance in one row (6,), and centre of pressure, middle, area and depth."""
        wanted = -F[2] / (modulus * self._area)  # sum of the depths, m
        at = p[:2] - self._middle
        # The pressures act on the face, whose height the line of action is followed to.
        for _ in range(_ROUNDS):
            solved = self._solve(wanted, at)
            if solved is None:
                return None
            deep, lean = solved
            height = float(deep @ self._places[:, 2]) / wanted
            at = (p + (height - p[2]) / F[2] * F)[:2] - self._middle
        inside = deep > 0
        if inside.sum() < _FEWEST:
            return None
        middle = self._xi[inside].mean(axis=0)
        centre = self._places[np.argmin(((self._xi - middle) ** 2).sum(axis=1))]
        # A place stands for its cell: where the middle runs through it, it counts to both sides.
        beyond = np.clip((self._xi - middle) / (0.5 * np.sqrt(self._area)), -1.0, 1.0)
        balance = deep @ beyond / wanted
        pressure_S = np.array([*(at + self._middle), height])
        row = np.concatenate([at - middle, lean, balance])
        return row, (
            pressure_S,
            np.array([*(middle + self._middle), centre[2]]),
            float(inside.sum() * self._area),
            float(deep.max()),
        )

    def _solve(
        self, wanted: float, at: NDArray[np.float64]
    ) -> tuple[NDArray[np.float64], NDArray[np.float64]] | None:
        """Return the depths of all places (n,), and the lean (2,); None where no lean has its pressure there."""
        rows = np.column_stack([np.ones(len(self._xi)), self._xi])
        x = np.array([self._depth_of(wanted), 0.0, 0.0])
        targets = wanted * np.array([1.0, *at])
        misfit = np.inf
        for _ in range(_STEPS):
            deep = np.maximum(rows @ x - self._gaps, 0.0)
            error = rows.T @ deep - targets
            misfit = float(np.abs(error[1:] - at * error[0]).max()) / wanted
            if misfit < _NEAR and abs(error[0]) < 1e-6 * wanted:
                return (deep, x[1:]) if deep.max() < FACE_DEPTH_M else None
            inside = rows[deep > 0]
            jacobian = inside.T @ inside
            if len(inside) < 3 or np.linalg.cond(jacobian) > 1e14:
                return None
            step = np.linalg.solve(jacobian, error)
            x = x - self._damped(rows, x, step, targets) * step
        return None

    def _damped(
        self,
        rows: NDArray[np.float64],
        x: NDArray[np.float64],
        step: NDArray[np.float64],
        targets: NDArray[np.float64],
    ) -> float:
        """Return the share of a step that makes the potential least among halvings: it is convex, so one is found."""

        def potential(share: float) -> float:
            there = x - share * step
            return float(0.5 * (np.maximum(rows @ there - self._gaps, 0.0) ** 2).sum() - targets @ there)

        shares = 0.5 ** np.arange(12)
        return float(min(shares, key=potential))

    def _depth_of(self, wanted: float) -> float:
        """Return the depth, m, at which the depths of all places without a lean add up to what is wanted, m."""
        gaps = np.sort(self._gaps)
        sums = np.arange(1, len(gaps) + 1) * gaps - np.cumsum(gaps)  # at the depth of each gap
        count = max(int(np.searchsorted(sums, wanted)), 1)
        return float((wanted + gaps[:count].sum()) / count)
