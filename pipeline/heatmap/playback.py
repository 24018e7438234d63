"""
A heatmap that moves through time: the bells of all contacts once, and then only weights that change.

A frame is one product of a sparse matrix with the weights of the sources in the window, so that it takes
milliseconds. Contacts that share a cell of half a bandwidth stay one source at the middle of all of them, whatever the
window: a frame differs from the heatmap of only these contacts by about 1 % of a bell's width.
"""

from dataclasses import dataclass, replace
from functools import cached_property, reduce

import numpy as np
from numpy.typing import NDArray

from contactbench.pipeline.colour_ramp import ColourScale
from contactbench.pipeline.heatmap.contacts import Contacts
from contactbench.pipeline.heatmap.heatmap import (
    Heatmap,
    HeatmapError,
    check_bandwidth,
    default_bandwidth,
    quantity_at,
    scale_of,
    unit_of,
)
from contactbench.pipeline.heatmap.selection import Selection, force_mask, shown, weights_of
from contactbench.pipeline.heatmap.subdivide import drawing_of
from contactbench.pipeline.heatmap.surface_kde import Bells, barycentric
from contactbench.pipeline.mesh import Probe

_WINDOWS = 16  # places of the window at which the end of the colours is looked for
_PAUSE = 0.5  # s without a contact: the next one is another touch


@dataclass(frozen=True, eq=False)
class HeatmapFrame:
    """A heatmap at one moment."""

    values: NDArray[np.float64]  # (v,) in `unit`; NaN: no data
    unit: str
    contacts: int  # how many are in it


@dataclass(frozen=True)
class Value:
    """What a frame says of one place."""

    value: float  # in `unit`; NaN: no data
    # 1 sigma, in `unit`: of a density, by the number of touches behind it; of a mean, the spread of what it
    # is the mean of; of a peak, the sensor's noise; NaN: unknown
    plus_minus: float
    unit: str


class Playback:
    """
    Contacts on a probe, ready to be shown for any window of time and range of force.

    Making one takes as long as a heatmap; its frames take milliseconds. Any thread may use it, one at a time.
    `probe` is then the one that it draws on, whose facets are small enough, see `drawing_of`.

    Parameters
    ----------
    contacts : Contacts
        In order of time; see `in_order`.
    bandwidth : float, optional
        Standard deviation of the Gaussian, m; by default that of the contacts.

    Raises
    ------
    HeatmapError
        There is no contact, or the bandwidth does not suit the probe.
    """

    def __init__(self, probe: Probe, contacts: Contacts, bandwidth: float | None = None) -> None:
        self.probe, self.contacts = drawing_of(probe), contacts
        self.bandwidth = default_bandwidth(contacts.sigmas) if bandwidth is None else bandwidth
        if not len(contacts.points):
            raise HeatmapError("there is no contact to draw: touch the probe while recording.")
        check_bandwidth(probe, self.bandwidth)
        self._bells = Bells(self.probe, contacts.points, self.bandwidth)
        self._scales: dict[tuple[object, ...], ColourScale] = {}
        self._masks: dict[tuple[object, ...], NDArray[np.bool_]] = {}

    @property
    def duration(self) -> float:
        """Of the recording, s; the last contact is not later."""
        return max(self.contacts.duration, float(self.contacts.moments[-1]))

    # ---- frames ----------------------------------------------------------------------------------

    def frame(self, selection: Selection) -> HeatmapFrame:
        """
        Return what a selection looks like; its bandwidth is not looked at.

        Nothing selected is no error: every value is NaN then. HeatmapError: the contacts do not have the quantity.
        """
        rows, values = self._chosen(selection)
        quantity, unit = selection.quantity, unit_of(selection.quantity, selection.normalisation)
        if not len(rows):
            return HeatmapFrame(np.full(len(self.probe.vertices), np.nan), unit, 0)
        # A peak has no weights, but what cannot be weighed is refused.
        weights = self._weights(rows, selection) if quantity == "density" else self._counts(rows, selection)
        picked = None if values is None else values[rows]
        return HeatmapFrame(quantity_at(self._bells, quantity, weights, picked, rows), unit, len(rows))

    def heatmap(self, selection: Selection) -> Heatmap:
        """Return a frame as a heatmap, to be drawn."""
        made = self.frame(selection)
        return Heatmap(
            self.probe,
            made.values,
            selection.quantity,
            made.unit,
            self.bandwidth,
            selection.normalisation,
            made.contacts,
            float("nan"),
            (),
            self.contacts.counted,
            selection.by_confidence,
            self._lying(selection),
            selection.logarithmic,
        )

    def _lying(self, selection: Selection) -> NDArray[np.float64] | None:
        """Return how much of the contacts of a selection lies at each vertex; None: there are none."""
        rows, _ = self._chosen(selection)
        bells = self._bells
        return bells.spread(self._counts(rows, selection), rows) * bells.areas if len(rows) else None

    def scale(self, selection: Selection, window: float | None = None) -> ColourScale:
        """
        Return the colours for every moment of a selection; they end at 0 where there is no contact.

        Parameters
        ----------
        window : float, optional
            s: a window of this length will move through the selection's time; left out, it stays or grows.
        """
        key = (selection, window)
        if key not in self._scales:
            parts = self._moments(selection, window)
            scales = (
                ColourScale.of(self.frame(part).values, self._lying(part), selection.logarithmic)
                for part in parts
            )
            self._scales[key] = reduce(ColourScale.joined, scales)
        return self._scales[key]

    def at(self, selection: Selection, frame: HeatmapFrame, face: int, point: NDArray[np.float64]) -> Value:
        """Return what a frame of a selection says at a point (3,) of a facet, S, m."""
        corners = self.probe.faces[face]
        values = frame.values[corners]
        shares = barycentric(self.probe.vertices[corners][None], point[None])[0]
        known = np.isfinite(values) & (shares > 1e-9)
        if not known.any():
            return Value(float("nan"), float("nan"), frame.unit)
        value = float((shares * np.nan_to_num(values))[known].sum() / shares[known].sum())
        nearest = int(corners[np.argmax(np.where(known, shares, -1.0))])
        return Value(value, self._plus_minus(selection, nearest), frame.unit)

    # ---- what is in it ---------------------------------------------------------------------------

    def _chosen(self, selection: Selection) -> tuple[NDArray[np.intp], NDArray[np.float64] | None]:
        """Return the numbers of the contacts in a selection, and what each of all has of the quantity."""
        values, use = shown(self.contacts, selection)
        key = (selection.quantity, selection.least_force, selection.most_force)
        if key not in self._masks:
            self._masks = {key: use & force_mask(self.contacts, selection)}
        moments = self.contacts.moments
        first = 0 if selection.start is None else int(np.searchsorted(moments, selection.start, "left"))
        last = (
            len(moments) if selection.end is None else int(np.searchsorted(moments, selection.end, "right"))
        )
        return first + np.flatnonzero(self._masks[key][first:last]), values

    def _weights(self, rows: NDArray[np.intp], selection: Selection) -> NDArray[np.float64]:
        weights = self._counts(rows, selection)
        if selection.normalisation == "rate":
            start, end = selection.start or 0.0, selection.end
            length = min(np.inf if end is None else end, self.contacts.duration) - max(start, 0.0)
            return weights / max(length if selection.timed else self.contacts.duration, 1e-9)
        return weights

    def _counts(self, rows: NDArray[np.intp], selection: Selection) -> NDArray[np.float64]:
        """Return what each of these contacts counts."""
        weights = weights_of(self.contacts, selection)
        return np.ones(len(rows)) if weights is None else weights[rows]

    def _moments(self, selection: Selection, window: float | None) -> list[Selection]:
        start = selection.start or 0.0
        end = self.duration if selection.end is None else selection.end
        if window is None or window >= end - start:
            return [selection]
        return [
            replace(selection, start=float(at), end=float(at) + window)
            for at in np.linspace(start, end - window, _WINDOWS)
        ]

    # ---- how sure --------------------------------------------------------------------------------

    def _plus_minus(self, selection: Selection, vertex: int) -> float:
        """Return 1 sigma at a vertex, in the unit; NaN: unknown."""
        rows, values = self._chosen(selection)
        if selection.quantity == "peak":
            noise = self.contacts.noise
            return (
                float("nan")
                if noise is None
                else float(np.sqrt(np.linalg.eigvalsh(noise.covariance[:3, :3])[-1]))
            )
        bell = self._bells.at(vertex, rows)
        scale = scale_of(selection.quantity)
        if selection.quantity == "density":
            # samples of one touch say the same thing: what counts is how many touches there were
            each = np.bincount(self._touch_of[rows], bell * self._weights(rows, selection))
            return scale * float(np.sqrt(each @ each))
        bell *= self._counts(rows, selection)
        if values is None or not bell.sum() > 0:
            return float("nan")
        mean = float(np.average(values[rows], weights=bell))
        return scale * float(np.sqrt(np.average((values[rows] - mean) ** 2, weights=bell)))

    @cached_property
    def _touch_of(self) -> NDArray[np.intp]:
        """(n,) number of the touch that each contact belongs to."""
        if self.contacts.counted == "touches":
            return np.arange(len(self.contacts.points))
        return np.concatenate([[0], np.cumsum(np.diff(self.contacts.moments) > _PAUSE)])
