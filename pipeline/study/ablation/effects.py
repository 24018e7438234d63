"""One choice on one record: what is located without it and with it, and how far that is off."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from contactbench.pipeline.control.settings import LEFT
from contactbench.pipeline.study.ablation import location_choices, sensor_choices
from contactbench.pipeline.study.ablation.location_choices import Locators, locators, sigmas_of
from contactbench.pipeline.study.sweep.noise import FILTERS

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from contactbench.pipeline.study.ablation.records import SceneRecord

INERTIA = sensor_choices.INERTIA
CHOICES = (*location_choices.CHOICES, *sensor_choices.CHOICES, INERTIA)
# Noise of a wrench, times that of one sensor_choices.
QUIET, FILTERED, RAW = 0.0, FILTERS["kalman"], 1.0
NOISES = {"none": QUIET, "filtered": FILTERED, "one reading": RAW}
MOVING = ("platform", "arm")
_GROSS_MM = 10.0


def meaningful(choice: str, scene: str) -> bool:
    """Tell whether a choice can matter in a scene: where nothing moves there is no inertia."""
    return choice != INERTIA or scene in MOVING


def effect(
    choice: str, record: SceneRecord, facets: int, noise: float, seed: int, amount: float | None = None
) -> dict[str, Any]:
    """
    Locate a record without a choice and with it.

    Parameters
    ----------
    choice : str
        Of CHOICES.
    facets : int
        Of the mesh.
    noise : float
        Times that of one sensor_choices.
    seed : int
        Of the noise; the same for both, and for all choices of how a wrench is located.
    amount : float, optional
        Of what a sensor does wrong, for the choices of how it is read; as `sensor_choices.USUAL` when left out.

    Returns
    -------
    dict
        Plain figures, mm: mean, root mean square, 95th percentile and largest over the rows that are sure with the
        choice and that neither misses by 10 mm, another place of the probe; the mean difference and its standard error;
        and the shares of rows with such a miss, with a point, and with no doubt.
    """
    rng = np.random.default_rng([seed, 11])
    made = locators(record.probe, facets, noise)
    if choice in sensor_choices.CHOICES:
        size = sensor_choices.USUAL[choice] if amount is None else amount
        return _read(choice, record, made, size, noise, rng)
    drawn = sigmas_of(noise) * rng.standard_normal(record.felt.shape)
    if choice == INERTIA:
        # The controller's own model does not take all of it off.
        kept = record.contacts + LEFT * (record.felt - record.contacts)
        pair = made.ours.locate_batch(record.felt + drawn), made.ours.locate_batch(kept + drawn)
    elif choice in location_choices.SMOOTHED:
        flat, points = made.smoothed(choice, record.contacts + drawn)
        sure = flat.accepted
        return compared(record.points, flat.points, points, sure, sure)
    else:
        pair = made.pair(choice, record.contacts + drawn)
    without, with_it = pair
    return compared(
        record.points,
        without.points,
        with_it.points,
        without.accepted,
        with_it.accepted,
    )


def compared(
    truth: NDArray[np.float64],
    without: NDArray[np.float64],
    made: NDArray[np.float64],
    sure_without: NDArray[np.bool_],
    sure_made: NDArray[np.bool_],
) -> dict[str, Any]:
    """Return the figures of `effect` for points (n, 3), m."""
    before, after = (1e3 * np.linalg.norm(points - truth, axis=1) for points in (without, made))
    judged = np.isfinite(before) & np.isfinite(after) & sure_made
    both = judged & (before < _GROSS_MM) & (after < _GROSS_MM)
    bought = before[both] - after[both]
    count = int(both.sum())
    return {
        "touches": len(truth),
        "common": count,
        **_figures("without", before[both]),
        **_figures("made", after[both]),
        "bought_mm": float(bought.mean()) if count else float("nan"),
        "bought_se_mm": float(bought.std(ddof=1) / np.sqrt(count)) if count > 1 else float("nan"),
        "without_gross": float((before[judged] >= _GROSS_MM).mean()) if judged.any() else float("nan"),
        "made_gross": float((after[judged] >= _GROSS_MM).mean()) if judged.any() else float("nan"),
        "without_answered": float(np.isfinite(before).mean()),
        "made_answered": float(np.isfinite(after).mean()),
        "without_sure": float(sure_without.mean()),
        "made_sure": float(sure_made.mean()),
    }


def _figures(name: str, mm: NDArray[np.float64]) -> dict[str, float]:
    if not len(mm):
        return {f"{name}_{figure}_mm": float("nan") for figure in ("mean", "rms", "p95", "max")}
    return {
        f"{name}_mean_mm": float(mm.mean()),
        f"{name}_rms_mm": float(np.sqrt(np.mean(mm**2))),
        f"{name}_p95_mm": float(np.percentile(mm, 95)),
        f"{name}_max_mm": float(mm.max()),
    }


def _read(
    choice: str, record: SceneRecord, made: Locators, amount: float, noise: float, rng: np.random.Generator
) -> dict[str, Any]:
    read = sensor_choices.read(choice, record, amount, noise, rng)
    without, with_it = made.ours.locate_batch(read.without), made.ours.locate_batch(read.made)
    sure = without.accepted, with_it.accepted
    figures = compared(record.points, without.points, with_it.points, *sure)
    true, taken, found = read.turns
    if choice == sensor_choices.MOUNT:
        # A robot goes to where the contact is on its flange, not in the sensor.
        seen = [points @ R.T for points, R in zip((record.points, without.points, with_it.points),
                                                  (true, taken, found), strict=True)]  # fmt: skip
        flange = compared(seen[0], seen[1], seen[2], *sure)
        figures |= {f"flange_{name}": flange[name] for name in ("without_mean_mm", "made_mean_mm")}
    return figures | {"amount": amount}
