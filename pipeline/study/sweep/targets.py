"""What a sweep is judged by, from its rows alone."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from contactbench.pipeline.study.report import FigureVerdict, verdict_of
from contactbench.pipeline.study.sweep.growth import Row, beaten, each_of, enough_facets, merged

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

OURS = "contactbench"
STEEP_DEG = 45.0  # friction of 1 allows no more
MOST_OVER_BOUND = 1.05
_FINE = (15_000, 30_000)  # about 20,000 facets
_FORCES_N, _STEEPEST_DEG, _TWISTED_M = (2.0, 20.0), 60.0, 0.0005
# A root mean square over so many touches is known to this share of itself: of two tangent errors together, half of
# one over the root of the count.
_SPREAD = 0.5


@dataclass(frozen=True)
class SweepTarget:
    """A figure that should be reached."""

    what: str
    measured: str
    met: bool


def is_noisy(row: Row) -> bool:
    """Tell whether a row has noise."""
    return bool(row["noise"] != "none")


def of_meshes(rows: Iterable[Row]) -> list[Row]:
    """Return the rows that tell what a mesh does: without noise, and not on the very mesh that is touched."""
    return [row for row in rows if not is_noisy(row) and not row.get("exact")]


def targets(rows: Sequence[Row]) -> list[SweepTarget]:
    """Return the targets that the rows can tell about."""
    beyond = [row for row in rows if row["angle"] > STEEP_DEG]
    return [*over_bound(rows), *on_front(usual(rows)), *on_front(beyond, f", beyond {STEEP_DEG:g}°")]


def usual(rows: Iterable[Row]) -> list[Row]:
    """Return the rows of touches that are not steep."""
    return [row for row in rows if row["angle"] <= STEEP_DEG]


def over_bound(rows: Iterable[Row]) -> list[SweepTarget]:
    """
    Judge, for each probe, the error over the noise bound, 2-20 N within 60 degrees at about 20,000 facets.

    Of a torsion as large as friction of a small contact makes it; more of it makes a wrong normal count for more.
    """
    wanted = [
        row
        for row in rows
        if row["method"] == OURS
        and is_noisy(row)
        and not row["failed"]
        and _FINE[0] <= row["facets_found"] <= _FINE[1]
        and _FORCES_N[0] <= row["force"] <= _FORCES_N[1]
        and row["angle"] <= _STEEPEST_DEG
        and row["torsion"] <= _TWISTED_M
    ]
    found = []
    for [probe], own in each_of(wanted, "probe"):
        cells = merged(own, ("force", "angle"))
        worst = max(cells, key=lambda cell: float(cell["over_bound"]))
        [whole] = merged(own, ())
        # The worst of many is too high by chance alone.
        met = all(
            verdict_of(ratio, (ratio - 2 * off, ratio + 2 * off), most=MOST_OVER_BOUND)
            is not FigureVerdict.MISSED
            for ratio, off in ((each["over_bound"], _off(each)) for each in (whole, worst))
        )
        what = f"error over the noise bound at most {MOST_OVER_BOUND} (2-20 N, within 60°, 20,000 facets)"
        measured = (
            f"{whole['over_bound']:.3f} of all; worst {worst['over_bound']:.3f} ± {_off(worst):.3f}"
            f" at {worst['force']:g} N, {worst['angle']:g}°"
        )
        found.append(SweepTarget(f"{plain(probe)}: {what}", measured, met))
    return found


def _off(cell: Row) -> float:
    return float(_SPREAD * cell["over_bound"] / np.sqrt(max(cell["touches"] * cell["sure"], 1.0)))


def on_front(rows: Iterable[Row], where: str = "") -> list[SweepTarget]:
    """Judge, for each probe, whether at any resolution a rival is both faster and more accurate; both from Python."""
    points = merged([row for row in rows if is_noisy(row)], ("probe", "facets", "method"))
    found = []
    for [probe], here in each_of(points, "probe"):
        ours = [row for row in here if row["method"] == OURS and np.isfinite(row["python_median_ns"])]
        worse = [
            f"{row['facets']:,}: {each['method']}"
            for row in ours
            for each in beaten(row, [r for r in here if r["facets"] == row["facets"] and r["method"] != OURS])
        ]
        if ours and len({row["method"] for row in here}) > 1:
            what = f"{plain(probe)}: no rival is both faster and more accurate at the same resolution{where}"
            said = f"{len(ours)} of {len(ours)} resolutions" if not worse else "beaten at " + ", ".join(worse)
            found.append(SweepTarget(what, said, not worse))
    return found


def needed_facets(rows: Iterable[Row]) -> list[tuple[str, float, float | None, float]]:
    """
    Return, for each probe and force, the facets at which the mesh adds 1 % to the noise.

    Returns
    -------
    list of (probe, force in N, facets or None, fewest facets that were tried)
    """
    ours = [
        row
        for row in usual(rows)
        if row["method"] == OURS and row["filter"] == "none" and row["torsion"] <= _TWISTED_M
    ]
    meshes = dict(each_of(merged(of_meshes(ours), ("probe", "facets")), "probe"))
    found = []
    for row in merged([row for row in ours if is_noisy(row)], ("probe", "force")):
        here = meshes.get((row["probe"],), [])
        facets = [each["facets_found"] for each in here]
        if len(set(facets)) >= 3:
            enough = enough_facets(facets, [each["rms_near_mm"] for each in here], row["bound_mm"])
            found.append((row["probe"], row["force"], enough, min(facets)))
    return found


def plain(probe: str) -> str:
    """Return what a probe is called on a page."""
    return probe.removesuffix(".ply")
