"""The ablation's chapter of the results page, from its rows alone."""

from __future__ import annotations

from itertools import groupby
from typing import TYPE_CHECKING, Any

import numpy as np

from contactbench.pipeline.study.ablation import location_choices, scenery
from contactbench.pipeline.study.ablation.effects import INERTIA, NOISES
from contactbench.pipeline.study.ablation.records import ANYWHERE, SCENES
from contactbench.pipeline.study.ablation.sensor_choices import MOUNT
from contactbench.pipeline.study.ablation.verdicts import (
    MATTERS,
    NOISE,
    ChoiceVerdict,
    about_choices,
    bought,
    crossings,
    unit_of,
)
from contactbench.pipeline.study.pages import chapter, number, table

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from contactbench.pipeline.study.results import Results

Row = dict[str, Any]
_ALL = (ANYWHERE, *SCENES)

_SAID = {
    "smooth.png": "Share of the mean error that interpolated normals take away, alone and with facets that bulge as the"
    f" normals say. Dotted: {MATTERS:.0%}, where it begins to matter.",
    "torque.png": "Share of the mean error that local torque takes away; share of touches that the friction"
    " gate locates more.",
    "reading.png": "Mean error with what the sensor does wrong, left out (dashed) and modelled, after the"
    " Kalman filter.",
}
_ABOUT = f"""Every choice is left out and put in on the same touches with the same noise. *Without* and *with* are mean
distances from the true contact, mm, over the touches that are sure with the choice and that neither misses by 10 mm.
Noise is that of the paper's sensor: a single reading, what the Kalman filter leaves of it, or none. A choice is worth
modelling where it takes away {MATTERS:.0%} of the error - by twice the standard error of what it takes away -, or
locates one touch in a thousand more. The touches of `whole head` are drawn all over it, 8 to 10 N, up to 30° from
the normal, without physics. The truth of the scenes `touch` and `bench` is a tip on the true surface; of the
others, where the line of action of all forces leaves it. Of a deformable phantom and of arm dynamics, *without* is how
far the true contact is off in a scene that leaves them out, *with* what half the time step changes. The tool's inertia
is taken off as well as the controller does it, by two thirds. Smooth normals are timed as NumPy on whole batches:
compiled they cost less."""


def make(results: Results, folder: Path) -> str:
    """
    Write the pictures and return the chapter.

    Parameters
    ----------
    folder : Path
        For the pictures.

    Raises
    ------
    InputError
        A picture cannot be written.
    """
    from contactbench.pipeline.study.ablation.plots import plots

    pictures = plots(results.rows)
    return chapter("What a scene needs", _ABOUT, tables(results.rows), pictures, _SAID, folder)


def tables(rows: Sequence[Row]) -> list[tuple[str, str]]:
    """Return the tables, each with its title; the first is the verdict."""
    found = about_choices(rows)
    made = [
        ("Model this, leave this out", _verdicts(found)),
        ("What each choice costs", _costs(found)),
        ("Where each choice begins to matter", _crossings(rows)),
        ("Smooth normals", _smooth(rows)),
        ("Sure answers on another part of the probe", _gross(rows)),
        ("The mount's rotation, as a robot sees the contact", _flange(rows)),
        ("The same at other noise", _noises(rows)),
        ("What leaving out tissue or arm changes", _scenery(rows)),
        ("On each probe", _probes(rows)),
    ]
    return [(title, text) for title, text in made if text]


def _verdicts(found: Sequence[ChoiceVerdict]) -> str:
    scenes = [scene for scene in _ALL if any(each.scene == scene for v in found for each in v.scenes)]
    rows = []
    for verdict in found:
        cells = {each.scene: each for each in verdict.scenes}
        amount = unit_of(verdict.choice)
        rows.append(
            [
                verdict.choice + (f" ({amount})" if amount else ""),
                *(_cell(cells.get(scene)) for scene in scenes),
                "–" if verdict.cost is None else f"{verdict.cost.more:+.3g} {verdict.cost.per}",
                f"**{verdict.verdict}**",
            ]
        )
    return table(["choice", *(f"{scene}, mm" for scene in scenes), "costs, µs", "verdict"], rows)


def _cell(each: Any) -> str:
    if each is None:
        return "–"
    digits = 3 if each.without < 1 else 2  # a twentieth must be seen
    text = f"{each.without:.{digits}f} → {each.made:.{digits}f}"
    return f"**{text}**" if each.models else text


def _costs(found: Sequence[ChoiceVerdict]) -> str:
    rows = [
        [v.choice, v.cost.per, f"{v.cost.without:.3g}", f"{v.cost.made:.3g}", f"{v.cost.more:+.3g}"]
        for v in found
        if v.cost is not None
    ]
    return table(["choice", "of", "without, µs", "with, µs", "difference, µs"], rows)


def _crossings(rows: Sequence[Row]) -> str:
    found = sorted(crossings(rows), key=lambda c: (c.choice, c.varied, _facets(c.at), c.at, c.probe))
    if not found:
        return ""
    probes = sorted({each.probe for each in found})
    lines = []
    for (choice, varied, at), group in groupby(found, key=lambda c: (c.choice, c.varied, c.at)):
        by_probe = {each.probe: each.words for each in group}
        shown = "noise, times a reading's" if varied == "noise" else varied
        lines.append([choice, shown, at, *(by_probe.get(probe, "–") for probe in probes)])
    return (
        f"Where the choice takes away {MATTERS:.0%} of the mean error of touches all over the head, with 0.3 mm of"
        " torsion where nothing else is said; the gate: where it loses one touch in a"
        " thousand. Smooth normals are on the mesh that is named.\n\n"
        + table(["choice", "varied", "at", *probes], lines)
    )


def _smooth(rows: Sequence[Row]) -> str:
    """Return the errors of flat facets, interpolated normals and bulged facets, by mesh and noise."""
    curve = [r for r in rows if r["kind"] == "curve" and r["x_name"] == "noise"]
    lines = []
    for probe, facets in sorted(
        {(r["probe"], r["facets"]) for r in curve if r["choice"] in location_choices.SMOOTHED}
    ):
        cells = [probe, f"{facets:,}"]
        for noise in NOISES.values():
            for choice, which in (
                (location_choices.SMOOTH, "without"),
                (location_choices.SMOOTH, "made"),
                (location_choices.BULGE, "made"),
            ):
                mine = [
                    r[f"{which}_mean_mm"]
                    for r in curve
                    if (r["probe"], r["facets"], r["x"], r["choice"]) == (probe, facets, noise, choice)
                ]
                cells.append(f"{np.mean(mine):.3f}" if mine else "–")
        lines.append(cells)
    columns = [f"{way}, {noise}" for noise in NOISES for way in ("flat", "normals", "bulged")]
    return table(["probe", "facets", *columns], lines) if lines else ""


def _gross(rows: Sequence[Row]) -> str:
    """Return how many sure answers of flat facets miss by 10 mm, by mesh and noise."""
    curve = [
        r
        for r in rows
        if r["kind"] == "curve" and r["x_name"] == "noise" and r["choice"] == location_choices.SMOOTH
    ]
    lines = []
    for probe, facets in sorted({(r["probe"], r["facets"]) for r in curve}):
        mine = [r for r in curve if (r["probe"], r["facets"]) == (probe, facets)]
        cells = [
            f"{1e4 * np.mean([r['without_gross'] for r in mine if r['x'] == noise]):.1f}"
            for noise in NOISES.values()
        ]
        lines.append([probe, f"{facets:,}", *cells])
    if not lines:
        return ""
    return (
        "Of 10,000 sure answers, how many miss by 10 mm. How far a coarse mesh is from the surface is only estimated,"
        " from how much its facets turn.\n\n"
        + table(["probe", "facets", *(f"noise: {noise}" for noise in NOISES)], lines)
    )


def _flange(rows: Sequence[Row]) -> str:
    """Return the errors in the flange's frame: an unknown rotation turns the contact about the sensor there."""
    mine = [r for r in rows if r["kind"] == "effect" and r["choice"] == MOUNT and r["noise"] == NOISE]
    lines = []
    for scene in (scene for scene in _ALL if any(r["scene"] == scene for r in mine)):
        some = [r for r in mine if r["scene"] == scene]
        names = ("without_mean_mm", "made_mean_mm", "flange_without_mean_mm", "flange_made_mean_mm")
        lines.append([scene, *(f"{np.mean([r[name] for r in some]):.2f}" for name in names)])
    columns = ["scene", "in S without", "with", "on the flange without", "with, mm"]
    return table(columns, lines) if lines else ""


def _facets(at: str) -> int:
    return int(at.split()[0].replace(",", ""))


def _noises(rows: Sequence[Row]) -> str:
    lines = []
    for choice in (*location_choices.CHOICES, INERTIA):
        for noise in NOISES:
            cells = []
            for scene in _ALL:
                there = any(
                    (r["kind"], r["choice"], r.get("scene"), r.get("noise"))
                    == ("effect", choice, scene, noise)
                    for r in rows
                )
                cells.append(_cell(bought(choice, scene, rows, noise)) if there else "–")
            if noise != NOISE and any(cell != "–" for cell in cells):
                lines.append([choice, noise, *cells])
    return table(["choice", "noise", *(f"{scene}, mm" for scene in _ALL)], lines) if lines else ""


def _scenery(rows: Sequence[Row]) -> str:
    mine = [row for row in rows if row["kind"] == "scenery"]
    lines = [
        [
            row["choice"],
            row["scene"],
            row["probe"],
            row["motion"],
            *(number(row[name], ".2f") for name in ("mean_mm", "rms_mm", "p95_mm")),
            number(row["floor_mm"], ".3f"),
            number(row["force_n"], ".2f"),
            number(row["without_us"]),
            number(row["made_us"]),
        ]
        for row in sorted(mine, key=lambda r: (scenery.CHOICES.index(r["choice"]), r["scene"], r["probe"]))
    ]
    columns = ["left out", "scene", "probe", "motion", "mean mm", "RMS mm", "p95 mm", "half step, mm"]
    columns += ["force, N RMS", "µs a ms without", "with"]
    return table(columns, lines) if lines else ""


def _probes(rows: Sequence[Row]) -> str:
    mine = [r for r in rows if r["kind"] == "effect" and r["noise"] == NOISE]
    lines = []
    for key, group in groupby(
        sorted(mine, key=lambda r: (r["choice"], _ALL.index(r["scene"]), r["probe"], r["seed"])),
        key=lambda r: (r["choice"], r["scene"], r["probe"]),
    ):
        some = list(group)
        gains = np.array([r["bought_mm"] for r in some])
        cells = [np.mean([r[name] for r in some]) for name in ("without_mean_mm", "made_mean_mm")]
        spread = gains.std(ddof=1) if len(gains) > 1 else float("nan")
        lines.append(
            [*key, *(f"{c:.3f}" for c in cells), f"{gains.mean():+.3f}", number(float(spread), ".3f")]
        )
    if not lines:
        return ""
    text = table(["choice", "scene", "probe", "without, mm", "with, mm", "bought, mm", "SD of seeds"], lines)
    return f"<details><summary>{len(lines)} rows</summary>\n\n{text}\n\n</details>"
