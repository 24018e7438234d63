"""What each modelling choice takes away from the error of a contact: left out and put in, on the same touches."""

from __future__ import annotations

from itertools import product
from typing import TYPE_CHECKING

import numpy as np
from benchmarks.ablation import locating, reading
from benchmarks.ablation.locating import locators, sigmas_of
from benchmarks.ablation.reading import ANYWHERE, ARM, PLATFORM, SCENES, SceneRecord, drawn, record

from contactbench.assets import PROBE_NAMES
from contactbench.pipeline.control.settings import LEFT
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.simulation.marker_touches import check_bundled
from contactbench.pipeline.study.pages import environment, origin
from contactbench.pipeline.study.report import Figure, Sheet, StudyReport
from contactbench.pipeline.study.sweep.plan import FILTERS

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from numpy.typing import NDArray

    Array = NDArray[np.float64]

INERTIA = "inertia of the tool"  # of what moves
CHOICES = (*locating.CHOICES, *reading.CHOICES, INERTIA)
FILTERED = FILTERS["kalman"]  # noise of a wrench, times that of one reading
_GROSS_MM = 10.0
_MATTERS, _SIGMAS, _ANSWERS = 0.05, 2.0, 1e-3
_ABOUT = (
    "Every choice is left out and put in on the same touches with the same noise: what the Kalman filter leaves of the"
    " paper's sensor's. Errors are mean distances from the true contact over the touches that are sure with the choice"
    f" and that neither misses by 10 mm. A choice is worth modelling where it takes away {_MATTERS:.0%} of the error -"
    " by twice the standard error of what it takes away -, or locates one touch in a thousand more. The touches of the"
    " whole head are drawn all over it, 8 to 10 N, up to 30° from the normal, without physics; the others are tips on"
    " markers, and a probe that follows a phantom. The tool's inertia is taken off as well as the controller does it,"
    " by two thirds. Drift is 4 K, the mount is turned by 2°, crosstalk is 0.5 % of full scale. Smooth normals are"
    " timed as NumPy on whole batches: compiled they cost less."
)


def run(
    probes: Sequence[str] = PROBE_NAMES,
    *,
    seeds: int = 5,
    facets: int = 2_000,
    touches: int = 4_000,
    tips: int = 15,
    rounds: int = 20,
    seed: int = 0,
    progress: Callable[[str], None] = lambda _: None,
) -> StudyReport:
    """Locate with and without every choice in every scene, and time it."""
    names = check_bundled(probes)
    if not 1 <= seeds <= 100:
        raise InputError(f"--seeds {seeds}: give 1 to 100.")
    figures: list[Figure] = []
    rows: list[tuple[str | float, ...]] = []
    records = []
    for scene in SCENES:
        for name in names:
            progress(f"{name}: {scene}")
            if scene == ANYWHERE:
                records.append(drawn(name, touches, np.random.default_rng([seed, 14])))
            else:
                records.append(record(scene, name, tips))
    for choice, scene in product(CHOICES, SCENES):
        if choice == INERTIA and scene not in (PLATFORM, ARM):
            continue
        progress(f"{choice}: {scene}")
        found = [
            effect(choice, each, facets, FILTERED, seed + number)
            for each in records
            for number in range(seeds)
            if each.scene == scene
        ]
        means = {name: float(np.nanmean([one[name] for one in found])) for name in found[0]}
        sigma = np.sqrt(np.nansum([one["sigma"] ** 2 for one in found])) / len(found)
        taken, more = means["taken"], means["located_with"] - means["located_without"]
        matters = taken > max(_MATTERS * means["without"], _SIGMAS * sigma) or more >= _ANSWERS
        gains = [one["taken"] for one in found]
        figures.append(Figure.of(f"{choice}, {scene}", "error taken away", gains, "mm", measured=taken))
        rows.append((choice, scene, means["without"], means["with"], 100 * more, "yes" if matters else "no"))
    columns = ("choice", "scene", "without, mm", "with, mm", "located more, %", "worth modelling")
    sheets = (
        Sheet("choices", "Model this, leave this out", columns, tuple(rows)),
        _costs(names, facets, rounds, seed),
    )
    settings = {"probes": ", ".join(names), "facets": facets, "seeds": seeds, "seed": seed}
    notes = (_ABOUT, "", origin(environment(), "packaging/run benchmark ablation"))
    return StudyReport("What a scene needs", settings, tuple(figures), notes, sheets)


def _costs(names: Sequence[str], facets: int, rounds: int, seed: int) -> Sheet:
    rng, found = np.random.default_rng([seed, 12]), []
    for name in names:
        wrenches = drawn(name, 2_000, rng).contacts
        wrenches = wrenches + sigmas_of(FILTERED) * rng.standard_normal(wrenches.shape)
        found.append(locators(name, facets, FILTERED).costs(wrenches, rounds))
    rows = []
    for choice in found[0]:
        without, made = np.mean([each[choice] for each in found], axis=0).tolist()
        rows.append((choice, without, made, made - without))
    return Sheet("costs", "What a solve takes, µs", ("choice", "without", "with", "difference"), tuple(rows))


def effect(choice: str, made: SceneRecord, facets: int, noise: float, seed: int) -> dict[str, float]:
    """
    Locate a record without a choice and with it; see `compared`.

    Parameters
    ----------
    facets : int
        Of the mesh.
    noise : float
        Times that of one reading.
    seed : int
        Of the noise; the same for both, and for all choices of how a wrench is located.
    """
    rng = np.random.default_rng([seed, 11])
    mesh = locators(made.probe, facets, noise)
    if choice in reading.CHOICES:
        read = reading.read(choice, made, reading.AMOUNTS[choice], noise, rng)
        without, with_it = map(mesh.ours.locate_batch, read)
    else:
        drawn = sigmas_of(noise) * rng.standard_normal(made.felt.shape)
        if choice in locating.SMOOTHED:
            without, points = mesh.smoothed(choice, made.contacts + drawn)
            return compared(made.points, without.points, points, without.accepted, without.accepted)
        if choice == INERTIA:
            # The controller's own model does not take all of it off.
            kept = made.contacts + LEFT * (made.felt - made.contacts)
            without, with_it = map(mesh.ours.locate_batch, (made.felt + drawn, kept + drawn))
        else:
            without, with_it = mesh.pair(choice, made.contacts + drawn)
    return compared(made.points, without.points, with_it.points, without.accepted, with_it.accepted)


def compared(
    truth: Array, without: Array, made: Array, sure_without: NDArray[np.bool_], sure_made: NDArray[np.bool_]
) -> dict[str, float]:
    """
    Compare points (n, 3), m.

    Returns
    -------
    dict
        Mean errors without and with, mm, what is taken away and its standard error (sigma), over the rows that are sure
        with the choice and that neither misses by 10 mm, another place of the probe; and the shares of rows that are
        located: without doubt, and without such a miss.
    """
    before, after = (1e3 * np.linalg.norm(points - truth, axis=1) for points in (without, made))
    judged = np.isfinite(before) & np.isfinite(after) & sure_made
    both = judged & (before < _GROSS_MM) & (after < _GROSS_MM)
    taken = before[both] - after[both]
    count = len(taken)
    right = [1.0 - float((mm[judged] >= _GROSS_MM).mean()) if judged.any() else 1.0 for mm in (before, after)]
    return {
        "without": float(before[both].mean()) if count else float("nan"),
        "with": float(after[both].mean()) if count else float("nan"),
        "taken": float(taken.mean()) if count else float("nan"),
        "sigma": float(taken.std(ddof=1) / np.sqrt(count)) if count > 1 else float("nan"),
        "located_without": float(sure_without.mean()) * right[0],
        "located_with": float(sure_made.mean()) * right[1],
    }
