"""A quantity spread over a probe's surface, and its colours."""

from dataclasses import dataclass
from typing import Any, get_args

import numpy as np
from numpy.typing import ArrayLike, NDArray

from contactbench.pipeline.colour_ramp import PLAIN, end_of_colours, ramp_colours
from contactbench.pipeline.errors import InputError, arg, message
from contactbench.pipeline.heatmap.surface_kde import REACH, Bells, vertex_areas
from contactbench.pipeline.mesh import Probe
from contactbench.pipeline.settings import Normalisation, Quantity

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
    def top(self) -> float:
        """
        Where the colours end: 95 % of the contacts lie where it is below, unless that is nearly the largest value.

        One wrong contact would else leave a single colour for all the others, see `end_of_colours`; by the touched
        surface instead of the contacts, a few strays would, for each touches a place of its own.
        """
        return end_of_colours(self.values, self.counts)

    def facts(self) -> dict[str, Any]:
        """Return what is known about it as JSON values."""
        areas = vertex_areas(self.probe)
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
            "colours_to": self.top,
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


def colours(heatmap: Heatmap, largest: float | None = None) -> NDArray[np.float64]:
    """Return the sRGB colour (v, 3), 0 to 1, of each vertex; `largest`, or else its `top`, has the last colour."""
    top = heatmap.top if largest is None else largest
    return np.where(heatmap.known[:, None], ramp_colours(heatmap.values, top), NO_DATA)


def linear(srgb: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return sRGB colours as shares of light, which is how glTF keeps them (IEC 61966-2-1)."""
    return np.where(srgb <= 0.04045, srgb / 12.92, ((srgb + 0.055) / 1.055) ** 2.4)
