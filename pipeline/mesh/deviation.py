"""
How far two surfaces are apart, measured with the project's own search tree and with no mesh library.

What an engine says about its own result is not believed: every simplified or repaired surface is compared
with the original here.
"""

from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from contactbench.pipeline.errors import arg, message
from contactbench.pipeline.kernel import SurfaceIndex
from contactbench.pipeline.mesh.arrays import Floats, Ints, Longs, Mask
from contactbench.pipeline.mesh.probe import Probe

_SEED = 20240521

_PORTION = 1 << 16

# Metres: less is the rounding of distances.
_NOTHING = 1e-9


@dataclass(frozen=True)
class Deviation:
    """
    Distance between two surfaces, both ways: from samples of each to the nearest point of the other.

    Attributes
    ----------
    hausdorff : float
        Largest distance found, metres; a lower bound of the true one, which exceeds it by at most about
        `spacing`, and by much less where the surfaces are smooth.
    rms : float
        Root of the mean squared distance over both areas, metres.
    p95 : float
        Distance that 95 % of both areas stay within, metres.
    normal_mean_deg, normal_p95_deg, normal_max_deg : float
        Angle between the normal at a sample and the normal at its nearest point, over both areas, degrees.
    spacing : float
        Side of the square that each area sample stands for, metres; the larger one of the two surfaces.
    samples : int
        Distances measured.
    """

    hausdorff: float
    rms: float
    p95: float
    normal_mean_deg: float
    normal_p95_deg: float
    normal_max_deg: float
    spacing: float
    samples: int

    @property
    def sentence(self) -> str:
        """The distances in words."""
        if self.hausdorff < _NOTHING:
            return message("identical to the original")
        return message(
            f"at most {arg(1e3 * self.hausdorff):.3g} mm, {arg(1e3 * self.rms):.2g} mm RMS, normals"
            f" {arg(self.normal_mean_deg):.2g}° off on average"
        )

    def to_json(self) -> dict[str, Any]:
        """Give the figures as plain values, lengths in mm."""
        return {
            "hausdorff_mm": 1e3 * self.hausdorff,
            "rms_mm": 1e3 * self.rms,
            "p95_mm": 1e3 * self.p95,
            "normal_mean_deg": self.normal_mean_deg,
            "normal_p95_deg": self.normal_p95_deg,
            "normal_max_deg": self.normal_max_deg,
            "spacing_mm": 1e3 * self.spacing,
            "samples": self.samples,
        }


# A simplified surface is farthest off inside a few large facets: those are looked at again, on a lattice.
_WORST = 24
_LATTICE = np.array([(i, j, 10 - i - j) for i in range(11) for j in range(11 - i)]) / 10.0


@dataclass(frozen=True, eq=False)
class Samples:
    """
    Points on a surface: `uniform` of them spread evenly over the area, then vertices and facet centroids.

    Attributes
    ----------
    points : (k, 3) float64
        Metres in S.
    facets : (k,) int64
        The facet that each point is on; for a vertex, one of those that use it.
    uniform : int
        How many come first that are spread by area.
    spacing : float
        Root of the area that each of those stands for, metres.
    """

    points: Floats
    facets: Longs
    uniform: int
    spacing: float


def sample_surface(probe: Probe, uniform: int = 20_000, most: int | None = None) -> Samples:
    """
    Spread points over a surface, the same ones every time.

    Parameters
    ----------
    probe : Probe
        The surface.
    uniform : int
        Points spread by area: one at a random place in each of as many equal shares of it.
    most : int, optional
        Take no more than this many vertices and this many centroids, evenly from their lists; all by default.

    Returns
    -------
    Samples
    """
    rng = np.random.default_rng(_SEED)
    total = np.cumsum(doubled_areas(probe.vertices, probe.faces))
    shares = (np.arange(uniform) + rng.random(uniform)) / uniform * total[-1]
    chosen = np.minimum(np.searchsorted(total, shares, side="right"), len(total) - 1)
    u, v = rng.random((2, uniform))
    # The unit square folded on its diagonal covers the triangle evenly.
    u, v = np.where(u + v > 1, 1 - u, u)[:, None], np.where(u + v > 1, 1 - v, v)[:, None]
    a, b, c = (probe.vertices[probe.faces[chosen, corner]] for corner in range(3))
    spread = a + u * (b - a) + v * (c - a)

    centres = _every(np.arange(len(probe.faces)), most)
    owner = np.full(len(probe.vertices), -1, dtype=np.int64)
    owner[probe.faces.T] = np.arange(len(probe.faces))
    corners = _every(np.flatnonzero(owner >= 0), most)
    middles = probe.vertices[probe.faces[centres]].mean(axis=1)
    return Samples(
        points=np.concatenate((spread, probe.vertices[corners], middles)),
        facets=np.concatenate((chosen, owner[corners], centres)),
        uniform=uniform,
        spacing=float(np.sqrt(total[-1] / 2 / uniform)),
    )


def doubled_areas(vertices: Floats, faces: Ints) -> Floats:
    """
    Compute twice the area of every facet, a third as long as with numpy's own cross product.

    Parameters
    ----------
    vertices : (n, 3) float64
        Any length unit in which squares do not underflow.
    faces : (m, 3) int32
        Indices in range.

    Returns
    -------
    (m,) float64
        In the unit's square.
    """
    doubled = np.empty(len(faces))
    # In portions, so that a mesh of a million facets needs no hundreds of megabytes for a moment.
    for start in range(0, len(faces), _PORTION):
        a, b, c = (vertices[faces[start : start + _PORTION, corner]].T for corner in range(3))
        (ux, uy, uz), (vx, vy, vz) = b - a, c - a
        doubled[start : start + _PORTION] = np.sqrt(
            (uy * vz - uz * vy) ** 2 + (uz * vx - ux * vz) ** 2 + (ux * vy - uy * vx) ** 2
        )
    return doubled


@dataclass(frozen=True, eq=False)
class _Side:
    """What the samples of one surface found on the other: distances of all, angles of the area samples."""

    samples: Samples
    distance: Floats
    angle_deg: Floats

    def chosen(self, mask: Mask | None) -> Mask:
        if mask is None:
            return np.ones(len(self.distance), dtype=np.bool_)
        return np.asarray(mask, dtype=np.bool_)[self.samples.facets]


class SurfaceComparison:
    """
    Two surfaces compared; ask for the deviation as a whole or of some of their facets.

    Made by `Reference.compare` or `compare`.
    """

    def __init__(self, there: _Side, back: _Side) -> None:
        self._there = there
        self._back = back

    def deviation(
        self, reference_mask: Mask | None = None, other_mask: Mask | None = None
    ) -> Deviation | None:
        """
        Sum up the distances.

        Parameters
        ----------
        reference_mask : (m,) bool, optional
            Facets of the reference that count; all by default. Their nearest points may lie on any facet.
        other_mask : (l,) bool, optional
            Facets of the other surface that count.

        Returns
        -------
        Deviation or None
            None when no area sample lies on the facets chosen.
        """
        distances, spread, angles = [], [], []
        for side, mask in ((self._there, reference_mask), (self._back, other_mask)):
            chosen = side.chosen(mask)
            distances.append(side.distance[chosen])
            chosen = chosen[: side.samples.uniform]
            spread.append(side.distance[: side.samples.uniform][chosen])
            angles.append(side.angle_deg[chosen])
        distance, even, angle = (np.concatenate(parts) for parts in (distances, spread, angles))
        if not len(even):
            return None
        return Deviation(
            hausdorff=float(distance.max()),
            rms=float(np.sqrt(np.mean(even**2))),
            p95=float(np.quantile(even, 0.95)),
            normal_mean_deg=float(angle.mean()),
            normal_p95_deg=float(np.quantile(angle, 0.95)),
            normal_max_deg=float(angle.max()),
            spacing=max(self._there.samples.spacing, self._back.samples.spacing),
            samples=len(distance),
        )

    def whole(self) -> Deviation:
        """Sum the samples of both surfaces up."""
        deviation = self.deviation()
        if deviation is None:
            raise AssertionError("a surface without a mask always has samples")
        return deviation


class Reference:
    """
    A surface made ready to be compared with others.

    Making one takes most of the time (0.1 s for 100,000 facets) and needs the interpreter for little of it, so
    it can be done in a thread while an engine works.

    Parameters
    ----------
    probe : Probe
        The surface.
    uniform, most : int
        See `sample_surface`; also for the surfaces compared with it.
    """

    def __init__(self, probe: Probe, *, uniform: int = 20_000, most: int | None = None) -> None:
        self.probe = probe
        self.index = SurfaceIndex(probe.vertices, probe.faces)
        self._uniform, self._most = uniform, most
        self._samples = sample_surface(probe, uniform, most)

    def compare(self, other: Probe) -> SurfaceComparison:
        """
        Measure another surface against this one.

        Parameters
        ----------
        other : Probe
            The other surface, in the same frame.

        Returns
        -------
        SurfaceComparison
        """
        index = SurfaceIndex(other.vertices, other.faces)
        samples = sample_surface(other, self._uniform, self._most)
        # The search works without the interpreter, so both ways can go at once.
        with ThreadPoolExecutor(1) as pool:
            back = pool.submit(_measure, samples, other, self.index, self.probe)
            there = _measure(self._samples, self.probe, index, other)
            return SurfaceComparison(there, _look_again(back.result(), other, self.index))

    def nearest_facet(self, points: Floats) -> Ints:
        """
        Find the facets that points are nearest to.

        Parameters
        ----------
        points : (k, 3) float64
            Metres in S.

        Returns
        -------
        (k,) int32
        """
        return self.index.closest(np.ascontiguousarray(points))[1]


def compare(
    reference: Probe, other: Probe, *, uniform: int = 20_000, most: int | None = None
) -> SurfaceComparison:
    """
    Compare two surfaces in the same frame.

    Parameters
    ----------
    reference, other : Probe
        The surfaces.
    uniform, most : int
        See `sample_surface`.

    Returns
    -------
    SurfaceComparison
    """
    return Reference(reference, uniform=uniform, most=most).compare(other)


def measure_deviation(reference: Probe, other: Probe) -> Deviation:
    """
    Measure how far two surfaces in the same frame are apart, at every vertex, every centroid, and 20,000 points.

    Parameters
    ----------
    reference, other : Probe
        The surfaces; the result is the same in either order but for the places of the samples.

    Returns
    -------
    Deviation
    """
    return compare(reference, other).whole()


def _measure(samples: Samples, own: Probe, index: SurfaceIndex, other: Probe) -> _Side:
    distance, facets, _ = index.closest(samples.points)
    even = slice(samples.uniform)
    ours, theirs = _normals(own, samples.facets[even]), _normals(other, facets[even])
    # atan2 of sine and cosine: arccos would lose the small angles to rounding.
    sine = np.linalg.norm(np.cross(ours, theirs), axis=1)
    angle = np.degrees(np.arctan2(sine, np.einsum("ij,ij->i", ours, theirs)))
    return _Side(samples, distance, angle)


def _look_again(side: _Side, own: Probe, index: SurfaceIndex) -> _Side:
    """Add points on the facets where the largest distances were found, which raises the bound most cheaply."""
    facets = side.samples.facets[np.argsort(-side.distance)[: 8 * _WORST]]
    _, first = np.unique(facets, return_index=True)
    worst = facets[np.sort(first)[:_WORST]]
    points = np.einsum("ij,kjl->kil", _LATTICE, own.vertices[own.faces[worst]]).reshape(-1, 3)
    samples = replace(
        side.samples,
        points=np.concatenate((side.samples.points, points)),
        facets=np.concatenate((side.samples.facets, np.repeat(worst, len(_LATTICE)))),
    )
    distance, _, _ = index.closest(points)
    return _Side(samples, np.concatenate((side.distance, distance)), side.angle_deg)


def _normals(probe: Probe, facets: Longs | Ints) -> Floats:
    """Take normals of some facets, of any length: those of all would take longer than the search."""
    a, b, c = (probe.vertices[probe.faces[facets, corner]] for corner in range(3))
    # To unit size, or products of tiny edges underflow.
    size = probe.size
    normals: Floats = np.cross((b - a) / size, (c - a) / size)
    return normals


def _every(indices: Longs, most: int | None) -> Longs:
    if most is None or len(indices) <= most:
        return indices
    return indices[np.linspace(0, len(indices) - 1, most).astype(np.int64)]
