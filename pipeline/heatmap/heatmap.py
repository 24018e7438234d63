"""A quantity spread over a probe's surface by a kernel density, and its colours."""

from dataclasses import dataclass
from functools import cached_property
from math import prod
from typing import Any, get_args

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.sparse import csr_array

from contactbench.pipeline.colour_ramp import PLAIN, ColourScale
from contactbench.pipeline.errors import InputError, arg, message
from contactbench.pipeline.kernel import Geodesic, SurfaceIndex
from contactbench.pipeline.mesh import Probe
from contactbench.pipeline.settings import Normalisation, Quantity

REACH = 3.0  # bandwidths
_CELL = 0.5  # bandwidths
_MOST_PLACES = 2**25  # where a table of them is faster than sorting


class Bells:
    """
    Bells of one bandwidth around n contacts on one probe.

    Parameters
    ----------
    probe : Probe
    points : (n, 3) float64
        S, m; on the surface or near it.
    bandwidth : float
        Standard deviation of a bell along the surface, m.

    Attributes
    ----------
    areas : (v,) float64
        A third of the facets around each vertex, m². Their sum is the whole surface.
    """

    def __init__(self, probe: Probe, points: NDArray[np.float64], bandwidth: float) -> None:
        self._probe, self._bandwidth = probe, bandwidth
        self.areas = vertex_areas(probe)
        index = SurfaceIndex(probe.vertices, probe.faces)
        _, faces, nearest = index.closest(np.ascontiguousarray(points, dtype=np.float64))
        self._source_of, middles = _cells(probe, nearest, faces, _CELL * bandwidth)
        _, self._faces, self._middles = index.closest(middles)

    def spread(
        self, weights: NDArray[np.float64], rows: NDArray[np.intp] | None = None
    ) -> NDArray[np.float64]:
        """
        Return the density (v,) of weights (n,), in units of a weight per m²; its integral is their sum.

        With `rows` (k,), the weights (k,) are those of these contacts, and only they count; so too below.
        """
        spread: NDArray[np.float64] = self._matrix @ np.bincount(
            self._sources(rows), weights, minlength=len(self._faces)
        )
        return spread

    def mean(
        self, values: NDArray[np.float64], weights: NDArray[np.float64], rows: NDArray[np.intp] | None = None
    ) -> NDArray[np.float64]:
        """Return the mean (v,) of values (n,) under the bells; NaN beyond their reach."""
        total = self.spread(weights, rows)
        with np.errstate(invalid="ignore", divide="ignore"):
            mean = self.spread(weights * values, rows) / total
        # A mean lies among its values; so far out in the bells rounding may say otherwise.
        return np.where(total > 0, np.clip(mean, values.min(initial=0), values.max(initial=0)), np.nan)

    def peak(self, values: NDArray[np.float64], rows: NDArray[np.intp] | None = None) -> NDArray[np.float64]:
        """Return the largest value (v,) within one bandwidth, and at the corners of its facet; else NaN."""
        largest = np.full(len(self._faces), -np.inf)
        np.maximum.at(largest, self._sources(rows), values)
        sources, vertices, begins = self._near
        peak = np.full(len(self.areas), np.nan)
        found = np.maximum.reduceat(largest[sources], begins)
        peak[vertices] = np.where(np.isfinite(found), found, np.nan)
        return peak

    def at(self, vertex: int, rows: NDArray[np.intp]) -> NDArray[np.float64]:
        """Return how high the bell of each of these contacts (k,) is at a vertex, 1/m²."""
        begin, end = self._matrix.indptr[vertex : vertex + 2]
        heights = np.zeros(len(self._faces))
        heights[self._matrix.indices[begin:end]] = self._matrix.data[begin:end]
        return np.asarray(heights[self._sources(rows)])

    def _sources(self, rows: NDArray[np.intp] | None) -> NDArray[np.intp]:
        return self._source_of if rows is None else self._source_of[rows]

    @cached_property
    def _near(self) -> tuple[NDArray[np.intp], NDArray[np.int32], NDArray[np.intp]]:
        """Sources within one bandwidth in the order of the vertices, these vertices, and where each one's begin."""
        rows, vertices, distances = self._reached
        near = distances <= self._bandwidth
        corners = self._probe.faces[self._faces]
        sources = np.concatenate([rows[near], np.repeat(np.arange(len(corners)), 3)])
        vertices = np.concatenate([vertices[near], corners.ravel()])
        order = np.argsort(vertices, kind="stable")
        return sources[order], *np.unique(vertices[order], return_index=True)

    @cached_property
    def _reached(self) -> tuple[NDArray[np.intp], NDArray[np.int32], NDArray[np.float64]]:
        """Pairs of a source and a vertex within reach, and how far they are apart, m."""
        geodesic = Geodesic(self._probe.vertices, self._probe.faces)
        first, vertices, distances = geodesic.around(self._faces, self._middles, REACH * self._bandwidth)
        return np.repeat(np.arange(len(self._faces)), np.diff(first)), vertices, distances

    @cached_property
    def _matrix(self) -> csr_array:
        """(vertices, sources) 1/m²; a column's integral over the surface is 1."""
        rows, vertices, distances = self._reached
        heights = np.exp(-0.5 * (distances / self._bandwidth) ** 2)
        lost = np.flatnonzero(np.bincount(rows, minlength=len(self._faces)) == 0)
        corners = self._probe.faces[self._faces[lost]]
        shares = barycentric(self._probe.vertices[corners], self._middles[lost])
        rows, vertices = np.append(rows, np.repeat(lost, 3)), np.append(vertices, corners.ravel())
        heights = np.append(heights, (shares / self.areas[corners]).ravel())
        integrals = np.bincount(rows, heights * self.areas[vertices], minlength=len(self._faces))
        shape = (len(self._faces), len(self.areas))
        return csr_array((heights / integrals[rows], (rows, vertices)), shape=shape).T.tocsr()


def vertex_areas(probe: Probe) -> NDArray[np.float64]:
    """Return a third of the area of the facets around each vertex, (v,) m²; 0 for one that no facet uses."""
    shares = np.repeat(probe.areas / 3, 3)
    return np.asarray(
        np.bincount(probe.faces.ravel(), shares, minlength=len(probe.vertices)), dtype=np.float64
    )


def barycentric(corners: NDArray[np.float64], points: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the weights (n, 3) of points (n, 3) on facets with these corners (n, 3, 3); none is negative."""
    a, b, c = np.moveaxis(corners, 1, 0)
    normal = np.cross(b - a, c - a)
    parts = [np.cross(c - b, points - b), np.cross(a - c, points - c), np.cross(b - a, points - a)]
    shares = np.clip(np.column_stack([np.einsum("ij,ij->i", part, normal) for part in parts]), 0.0, None)
    weights: NDArray[np.float64] = shares / shares.sum(axis=1, keepdims=True)
    return weights


def _cells(
    probe: Probe, points: NDArray[np.float64], faces: NDArray[np.int32], cell: float
) -> tuple[NDArray[np.intp], NDArray[np.float64]]:
    """Return for each point (n, 3) the number of its source, (n,), and the middles (k, 3) of the sources."""
    # Two sides of a thin wall are near each other and must not become one: they face different ways.
    facing = ((probe.normals > 0) @ np.array([1, 2, 4])).take(faces)
    places = [np.floor((points[:, k] - probe.bounds[0, k]) / cell).astype(np.int64) for k in range(3)]
    group = _numbered([*places, facing])
    sums = np.column_stack([np.bincount(group, points[:, k]) for k in range(3)])
    return group, np.ascontiguousarray(np.divide(sums, np.bincount(group)[:, None]))


def _numbered(columns: list[NDArray[np.int64]]) -> NDArray[np.intp]:
    """Return for each row of columns of integers (n,) its place (n,) among the different ones in ascending order."""
    lowest = [int(column.min()) for column in columns]
    sizes = [int(column.max()) - low + 1 for column, low in zip(columns, lowest, strict=True)]
    if prod(sizes) > _MOST_PLACES:
        rows = np.column_stack(columns)
        return np.asarray(np.unique(rows, axis=0, return_inverse=True)[1].ravel(), dtype=np.intp)
    place = np.zeros(len(columns[0]), dtype=np.int64)
    for column, low, size in zip(columns, lowest, sizes, strict=True):
        place *= size
        place += column
        place -= low
    taken = np.zeros(prod(sizes), dtype=bool)
    taken[place] = True
    there = np.flatnonzero(taken)
    numbers = np.empty(len(taken), dtype=np.intp)  # most of it is never touched
    numbers[there] = np.arange(len(there))
    return np.asarray(numbers[place])


def vertex_normals(probe: Probe) -> NDArray[np.float64]:
    """Return unit normals (v, 3), those of the facets around weighted by area; 0 for a vertex without facets."""
    scaled = np.repeat(probe.normals * probe.areas[:, None], 3, axis=0)
    at, count = probe.faces.ravel(), len(probe.vertices)
    total = np.column_stack([np.bincount(at, scaled[:, k], minlength=count) for k in range(3)])
    length = np.linalg.norm(total, axis=1, keepdims=True)
    return total / np.where(length > 0, length, 1.0)


NO_DATA = (PLAIN / 255,) * 3
SMALLEST_BANDWIDTH = 1.5e-3  # m: the default where contacts are surer than that
_LARGEST_SHARE = 0.5  # of the probe's size: a wider bell says nothing of any place

_UNITS = {"force": "N", "peak": "N", "error": "mm", "uncertainty": "mm"}
_DENSITY_UNITS = {"contacts": "1/mm²", "seconds": "s/mm²", "rate": "1/(mm²·s)"}
_SCALES = {"density": 1e-6, "error": 1e3, "uncertainty": 1e3}  # from SI
_WORDS = {
    "density": message("contact density"),
    "force": message("mean force"),
    "peak": message("peak force"),
    "error": message("mean error"),
    "uncertainty": message("uncertainty (1 sigma)"),
}


class HeatmapError(InputError):
    """No heatmap can be made of this; the message says why and what to do."""


@dataclass(frozen=True, eq=False)
class Heatmap:
    """
    A number per vertex of a probe.

    Attributes
    ----------
    probe : Probe
    values : (v,) float64
        In `unit`; NaN: no contact within three bandwidths (of a peak: within one).
    quantity : str
    unit : str
        For people: ``1/mm²``, ``s/mm²``, ``1/(mm²·s)``, ``N`` or ``mm``.
    bandwidth : float
        Standard deviation of the bells, m.
    normalisation : str
        What the integral of a density over the area is: the number of contacts, their seconds, or contacts per second.
    contacts : int
        How many went into it.
    total : float
        Of a density: its integral over the surface (contacts, s, or 1/s); otherwise the contacts' own mean, or peak.
    notes : tuple of str
        What limits it, in sentences.
    counted : str
        What went into it, for people: contacts, samples or touches.
    by_confidence : bool
        Each of them counts as much as its place is sure: of a density, the integral is the sum of that.
    counts : (v,) float64, optional
        How much of the contacts lies at each vertex.
    logarithmic : bool
        Its colours are: equal factors are equal steps.
    """

    probe: Probe
    values: NDArray[np.float64]
    quantity: Quantity
    unit: str
    bandwidth: float
    normalisation: Normalisation
    contacts: int
    total: float
    notes: tuple[str, ...] = ()
    counted: str = "contacts"
    by_confidence: bool = False
    counts: NDArray[np.float64] | None = None
    logarithmic: bool = False

    @property
    def title(self) -> str:
        """The quantity in words."""
        return _WORDS[self.quantity] + (message(", weighed by confidence") if self.by_confidence else "")

    @property
    def known(self) -> NDArray[np.bool_]:
        """(v,) vertices with a value."""
        return np.isfinite(self.values)

    @property
    def largest(self) -> float:
        """The largest value."""
        return float(np.nanmax(self.values))

    @property
    def scale(self) -> ColourScale:
        """
        Which value has which colour; the last one ends 95 % of the contacts, unless it is nearly the largest.

        One wrong contact would else leave a single colour for all the others, see `end_of_colours`; by the touched
        surface instead of the contacts, a few strays would, for each touches a place of its own.
        """
        return ColourScale.of(self.values, self.counts, self.logarithmic)

    def facts(self) -> dict[str, Any]:
        """Return what is known about it as JSON values."""
        areas, scale = vertex_areas(self.probe), self.scale
        return {
            "quantity": self.quantity,
            "unit": self.unit,
            "bandwidth_mm": 1e3 * self.bandwidth,
            "kernel": message(
                f"Gaussian of the distance along the surface, cut off at {arg(REACH):g} bandwidths"
            ),
            "normalisation": self.normalisation if self.quantity == "density" else None,
            "contacts": self.contacts,
            "counted": self.counted,
            "by_confidence": self.by_confidence,
            "total": self.total,
            "largest": self.largest,
            "colours_from": scale.low,
            "colours_to": scale.top,
            "logarithmic": self.logarithmic,
            "covered_mm2": 1e6 * float(areas[self.known].sum()),
            "surface_mm2": 1e6 * float(areas.sum()),
            "notes": list(self.notes),
        }


def unit_of(quantity: Quantity, normalisation: Normalisation) -> str:
    """Return the unit of a quantity, for people."""
    return _UNITS.get(quantity, _DENSITY_UNITS[normalisation])


def scale_of(quantity: Quantity) -> float:
    """Return what a quantity in SI units is multiplied by to have its `unit_of`."""
    return _SCALES.get(quantity, 1.0)


def quantity_at(
    bells: Bells,
    quantity: Quantity,
    weights: NDArray[np.float64],
    values: NDArray[np.float64] | None,
    rows: NDArray[np.intp] | None = None,
) -> NDArray[np.float64]:
    """Return a quantity (v,) of contacts, or of these `rows` of them, see `Bells.spread`; NaN: no data."""
    scale = scale_of(quantity)
    if quantity == "density":
        spread = bells.spread(weights, rows)
        return np.where(spread > 0, scale * spread, np.nan)
    if values is None:
        return np.full(len(bells.areas), np.nan)
    return scale * (bells.peak(values, rows) if quantity == "peak" else bells.mean(values, weights, rows))


def default_bandwidth(sigmas: ArrayLike | None = None) -> float:
    """Return the bandwidth for contacts of such uncertainties (n,), m: their median, 1.5 mm at the least."""
    known = np.asarray([] if sigmas is None else sigmas, dtype=np.float64)
    known = known[np.isfinite(known)]
    return max(SMALLEST_BANDWIDTH, float(np.median(known))) if len(known) else SMALLEST_BANDWIDTH


def heatmap(
    probe: Probe,
    points: ArrayLike,
    weights: ArrayLike | None = None,
    quantity: Quantity = "density",
    bandwidth: float = SMALLEST_BANDWIDTH,
    *,
    values: ArrayLike | None = None,
    normalisation: Normalisation = "contacts",
    duration: float | None = None,
    counted: str = "contacts",
) -> Heatmap:
    """
    Spread contacts over a probe.

    Parameters
    ----------
    probe : Probe
        In S.
    points : (n, 3) array_like
        Contacts, S, m; each is moved to the nearest point of the surface.
    weights : (n,) array_like, optional
        What each contact counts: 1 when left out; its seconds for the normalisation ``seconds``.
    quantity : {"density", "force", "peak", "error", "uncertainty"}
    bandwidth : float
        Standard deviation of the Gaussian of the distance along the surface, m.
    values : (n,) array_like
        For all but the density: force in N, error or uncertainty in m.
    normalisation : {"contacts", "seconds", "rate"}
        What the integral of a density over the area is.
    duration : float
        For ``rate``: of the whole recording, s.
    counted : str
        What the contacts are, for people: samples or touches.

    Raises
    ------
    HeatmapError
        There is no contact, a shape or number is wrong, or the bandwidth does not suit the probe.
    """
    at, w = _checked(points, weights)
    check_bandwidth(probe, bandwidth)
    if quantity not in get_args(Quantity) or normalisation not in get_args(Normalisation):
        raise HeatmapError(
            f"there is no heatmap of quantity {arg(quantity)!r} with normalisation {arg(normalisation)!r}."
        )
    bells, scale = Bells(probe, at, bandwidth), scale_of(quantity)
    if quantity == "density":
        if normalisation == "rate":
            w = w / _positive(duration, "duration", "s")
        v, total = None, float(w.sum())
    else:
        v = _numbers(values, len(at), "values")
        total = scale * float(v.max() if quantity == "peak" else np.average(v, weights=w))
    result, unit = quantity_at(bells, quantity, w, v), unit_of(quantity, normalisation)
    notes = _notes(probe, result, bandwidth)
    return Heatmap(
        probe, result, quantity, unit, bandwidth, normalisation, len(at), total, notes, counted,
        counts=bells.spread(w) * bells.areas,
    )  # fmt: skip


def _checked(points: ArrayLike, weights: ArrayLike | None) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    at = np.asarray(points, dtype=np.float64)
    if at.ndim != 2 or at.shape[1:] != (3,) or not np.isfinite(at).all():
        raise HeatmapError(f"points: give finite numbers (n, 3), m, not shape {arg(at.shape)}.")
    if not len(at):
        raise HeatmapError(
            "there is no contact to draw: touch the probe while recording, or lower --min-force."
        )
    w = np.ones(len(at)) if weights is None else _numbers(weights, len(at), "weights")
    if (w < 0).any() or not w.any():
        raise HeatmapError("weights: none may be negative, and at least one must be above 0.")
    return at, w


def _numbers(values: ArrayLike | None, count: int, name: str) -> NDArray[np.float64]:
    array = np.asarray(np.nan if values is None else values, dtype=np.float64)
    if array.shape != (count,) or not np.isfinite(array).all():
        raise HeatmapError(f"{arg(name)}: give {arg(count)} finite numbers, one for each contact.")
    return array


def _positive(value: float | None, name: str, unit: str) -> float:
    if value is None or not 0 < value < np.inf:
        raise HeatmapError(f"{arg(name)} is {arg(value)}: give a positive number, {arg(unit)}.")
    return value


def check_bandwidth(probe: Probe, bandwidth: float) -> None:
    """Refuse a bandwidth, m, that does not suit a probe; HeatmapError."""
    largest = _LARGEST_SHARE * probe.size
    if not 1e-5 <= bandwidth <= largest:
        raise HeatmapError(
            f"a bandwidth of {arg(1e3 * bandwidth):g} mm does not suit a probe of"
            f" {arg(1e3 * probe.size):.0f} mm: choose 0.01 to {arg(1e3 * largest):.0f} mm."
        )


def _notes(probe: Probe, values: NDArray[np.float64], bandwidth: float) -> tuple[str, ...]:
    """Say where facets are too large to show a bell."""
    there = np.isfinite(values)[probe.faces].any(axis=1)
    corners = probe.vertices[probe.faces[there]]
    edge = float(np.median(np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2)))
    if edge <= 1.5 * bandwidth:
        return ()
    return (
        message(
            f"The mesh's edges there are {arg(1e3 * edge):.1f} mm long, longer than the bandwidth of"
            f" {arg(1e3 * bandwidth):.1f} mm, so the map is no finer than the mesh. Use a mesh with"
            " more facets."
        ),
    )


def colours(heatmap: Heatmap, scale: ColourScale | None = None) -> NDArray[np.float64]:
    """Return the sRGB colour (v, 3), 0 to 1, of each vertex, by its own scale or another."""
    return np.where(heatmap.known[:, None], (scale or heatmap.scale).colours(heatmap.values), NO_DATA)


def linear(srgb: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return sRGB colours as shares of light, which is how glTF keeps them (IEC 61966-2-1)."""
    return np.where(srgb <= 0.04045, srgb / 12.92, ((srgb + 0.055) / 1.055) ** 2.4)
