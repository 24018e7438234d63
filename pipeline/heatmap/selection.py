"""
Parts of what was touched: a window of time, a range of force, and what to show of it.

Times count from the first sample of a recording or table, and from the start of the first touch of a verification.
"""

from dataclasses import dataclass, replace
from functools import cached_property, reduce
from typing import Any

import numpy as np
from numpy.typing import NDArray

from contactbench.pipeline.colour_ramp import ColourScale
from contactbench.pipeline.errors import arg, join, message
from contactbench.pipeline.heatmap.contacts import Contacts
from contactbench.pipeline.heatmap.heatmap import (
    Bells,
    Heatmap,
    HeatmapError,
    barycentric,
    check_bandwidth,
    default_bandwidth,
    heatmap,
    quantity_at,
    scale_of,
    unit_of,
)
from contactbench.pipeline.heatmap.subdivide import drawing_of
from contactbench.pipeline.mesh import Probe
from contactbench.pipeline.settings import Normalisation, Quantity

_WINDOWS = 16  # places of the window at which the end of the colours is looked for
_PAUSE = 0.5  # s without a contact: the next one is another touch
OUTSIDE_TIME, OUTSIDE_FORCE = message("outside the time window"), message("outside the force range")


@dataclass(frozen=True)
class Selection:
    """What to show of contacts."""

    quantity: Quantity = "density"
    normalisation: Normalisation = "contacts"  # of a density
    bandwidth: float | None = None  # standard deviation of the Gaussian, m; None: that of the contacts
    # start, end: window of time, s, both ends in it; None: no limit
    start: float | None = None
    end: float | None = None
    # least_force, most_force: range of |F|, N, both ends in it; None: no limit
    least_force: float | None = None
    most_force: float | None = None
    by_confidence: bool = False  # each contact counts as much as its place is sure
    logarithmic: bool = False  # colours

    @property
    def timed(self) -> bool:
        """Whether it asks for a part of the time."""
        return self.start is not None or self.end is not None

    @property
    def forced(self) -> bool:
        """Whether it asks for a range of force."""
        return self.least_force is not None or self.most_force is not None


def in_order(contacts: Contacts) -> Contacts:
    """Return contacts sorted by their times; HeatmapError if they have none."""
    if contacts.times is None:
        raise HeatmapError("these contacts have no times: give a recording, or a table with times.")
    order = np.argsort(contacts.times, kind="stable")
    return contacts if (np.diff(order) == 1).all() else _of(contacts, order)


def _of(contacts: Contacts, which: NDArray[Any]) -> Contacts:
    """Return some contacts, by a mask or by their numbers."""

    def part(array: NDArray[Any] | None) -> Any:
        return None if array is None else array[which]

    return replace(
        contacts,
        points=contacts.points[which],
        seconds=contacts.seconds[which],
        sigmas=contacts.sigmas[which],
        forces=part(contacts.forces),
        known_errors=part(contacts.known_errors),
        settled=part(contacts.settled),
        times=part(contacts.times),
        confidences=part(contacts.confidences),
    )


def windowed(contacts: Contacts, selection: Selection) -> Contacts:
    """
    Return the contacts in a selection's window of time and range of force; the others are counted in `left_out`.

    A rate is then one of the window, as far as it lies in the recording. A window needs contacts that know their times.

    Raises
    ------
    HeatmapError
        Nothing is left, a limit makes no sense, or the forces are unknown.
    """
    if not selection.timed and not selection.forced:
        return contacts
    start = 0.0 if selection.start is None else selection.start
    end = np.inf if selection.end is None else selection.end
    if not start <= end:
        raise HeatmapError(
            f"the time window ends at {arg(end):g} s, before it starts at {arg(start):g} s: swap them."
        )
    inside = np.ones(len(contacts.points), dtype=bool)
    if selection.timed:
        if contacts.times is None:
            raise HeatmapError("a time window needs contacts with times.")
        inside = (contacts.moments >= start) & (contacts.moments <= end)
    strong = force_mask(contacts, selection)
    left_out = dict(contacts.left_out)
    for why, count in ((OUTSIDE_TIME, (~inside).sum()), (OUTSIDE_FORCE, (inside & ~strong).sum())):
        if count:
            left_out[why] = left_out.get(why, 0) + int(count)
    kept = inside & strong
    if not kept.any():
        raise HeatmapError(empty_words(contacts, selection))
    length = max(min(end, contacts.duration) - max(start, 0.0), 0.0) if selection.timed else contacts.duration
    return replace(_of(contacts, kept), left_out=left_out, duration=length)


def force_mask(contacts: Contacts, selection: Selection) -> NDArray[np.bool_]:
    """Return which contacts (n,) are in a selection's range of force; HeatmapError if the forces are unknown."""
    if not selection.forced:
        return np.ones(len(contacts.points), dtype=bool)
    if contacts.forces is None:
        raise HeatmapError(
            "a force range needs the forces: give the wrenches that the contacts were located from."
        )
    least = 0.0 if selection.least_force is None else selection.least_force
    most = np.inf if selection.most_force is None else selection.most_force
    if not least <= most:
        raise HeatmapError(f"the force range goes from {arg(least):g} N down to {arg(most):g} N: swap them.")
    mask: NDArray[np.bool_] = (contacts.forces >= least) & (contacts.forces <= most)
    return mask


def empty_words(contacts: Contacts, selection: Selection) -> str:
    """Say that a selection holds no contact, and what to do."""
    parts = []
    if selection.timed:
        start, end = selection.start, selection.end
        parts.append(
            message(f"from {arg(start):.4g} s on")
            if end is None
            else message(f"from {arg(0.0 if start is None else start):.4g} to {arg(end):.4g} s")
        )
    if selection.forced:
        least = 0.0 if selection.least_force is None else selection.least_force
        upto = "" if selection.most_force is None else f" to {selection.most_force:.4g}"
        parts.append(f"with {least:.4g}{upto} N" if upto else message(f"with {arg(least):.4g} N or more"))
    place = message(f" {arg(join(' ', parts))}") if parts else ""
    return message(
        f"there is no contact{arg(place)}: widen the time window or the force range (the recording"
        f" lasts {arg(contacts.duration):.4g} s)."
    )


def shown(
    contacts: Contacts, selection: Selection, errors: NDArray[np.float64] | None = None
) -> tuple[NDArray[np.float64] | None, NDArray[np.bool_]]:
    """
    Return what each contact (n,) has of a quantity, in SI units (None for a density), and which (n,) count.

    Parameters
    ----------
    errors : (n,), optional
        Distances to what was touched, m, NaN where one does not count; by default those that a verification knows.

    Raises
    ------
    HeatmapError
        The contacts do not have it.
    """
    everyone = np.ones(len(contacts.points), dtype=bool)
    if selection.quantity == "density":
        return None, everyone
    if selection.quantity == "uncertainty":
        return contacts.sigmas, np.isfinite(contacts.sigmas)
    if selection.quantity == "error":
        known = contacts.known_errors if errors is None else errors
        if known is None:
            raise HeatmapError(
                "the error needs the touched points: open a verification, or give the markers."
            )
        return known, np.isfinite(known)
    if contacts.forces is None:
        raise HeatmapError("the forces are unknown: give the wrenches that the contacts were located from.")
    return contacts.forces, everyone


def weights_of(contacts: Contacts, selection: Selection) -> NDArray[np.float64] | None:
    """
    Return what each contact (n,) counts for a selection, a rate's duration apart; None: each counts 1.

    Raises
    ------
    HeatmapError
        It should be weighed by confidence, and that is not known, or makes no sense for the quantity.
    """
    per_second = selection.quantity == "density" and selection.normalisation == "seconds"
    if not selection.by_confidence:
        return contacts.seconds if per_second else None
    if selection.quantity == "peak":
        raise HeatmapError(
            "a peak is the largest force, so its contacts cannot be weighted: choose another"
            " quantity, or turn off confidence weights."
        )
    if contacts.confidences is None:
        raise HeatmapError(
            "these contacts have no confidence: locate them again for a column `confidence`, or"
            " turn off confidence weights."
        )
    return contacts.confidences * contacts.seconds if per_second else contacts.confidences


def drawn(
    probe: Probe,
    contacts: Contacts,
    selection: Selection,
    values: NDArray[np.float64] | None,
    use: NDArray[np.bool_],
) -> Heatmap:
    """
    Return the heatmap of contacts that were selected already; it is drawn on facets small enough, see `drawing_of`.

    Parameters
    ----------
    values : (n,) or None
        See `shown`.
    use : (n,) bool
        Which of them count.
    """
    weights = weights_of(contacts, selection)
    if weights is not None and not weights[use].any():
        raise HeatmapError("none of these contacts has any confidence: turn off confidence weights.")
    made = heatmap(
        drawing_of(probe),
        contacts.points[use],
        None if weights is None else weights[use],
        selection.quantity,
        default_bandwidth(contacts.sigmas) if selection.bandwidth is None else selection.bandwidth,
        values=None if values is None else values[use],
        normalisation=selection.normalisation,
        duration=contacts.duration,
        counted=contacts.counted,
    )
    return replace(made, by_confidence=selection.by_confidence, logarithmic=selection.logarithmic)


def selected_heatmap(probe: Probe, contacts: Contacts, selection: Selection) -> Heatmap:
    """Return the heatmap of a selection, as ``contactbench heatmap draw`` writes it; HeatmapError."""
    part = windowed(contacts, selection)
    values, use = shown(part, selection)
    if not use.any():
        raise HeatmapError(
            f"there is no contact with a known {arg(selection.quantity)}: choose another quantity."
        )
    return drawn(probe, part, selection, values, use)


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
