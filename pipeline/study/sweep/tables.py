"""A sweep as tables."""

from __future__ import annotations

from itertools import groupby
from typing import TYPE_CHECKING

import numpy as np

from contactbench.pipeline.study.pages import number, table
from contactbench.pipeline.study.sweep.growth import (
    COMPILED,
    ERROR,
    TIME,
    Row,
    front,
    knee,
    merged,
    power,
    settling,
)
from contactbench.pipeline.study.sweep.targets import (
    OURS,
    STEEP_DEG,
    is_noisy,
    needed_facets,
    of_meshes,
    plain,
    targets,
    usual,
)

if TYPE_CHECKING:
    from collections.abc import Sequence

    from contactbench.pipeline.study.sweep.growth import Power

_AXIS = "wrench_axis"
_REASONS = ("ok", "vertex", "ambiguous", "implausible", "off_surface", "tangential", "low_force")


def tables(rows: Sequence[Row]) -> list[tuple[str, str]]:
    """Return (title, Markdown) of every table that the rows have something for."""
    noisy = [row for row in rows if is_noisy(row)]
    made = [
        ("Targets", target_table(rows)),
        ("Speed against error: the knees", knee_table(usual(noisy))),
        ("Growth with the mesh", growth_table(rows)),
        ("Facets at which the mesh adds 1 % to the noise", needed_table(rows)),
        ("Steep touches, without noise", steep_table(rows)),
        ("The local torque: solved for, or taken for zero", torque_table(rows)),
        ("Reasons, and answers on another part of the probe", reason_table(noisy or rows)),
    ]
    return [(title, text) for title, text in made if text]


def target_table(rows: Sequence[Row]) -> str:
    """Return the targets; empty if the rows tell about none."""
    found = targets(rows)
    shown = [[each.what, each.measured, "met" if each.met else "**missed**"] for each in found]
    return table(("target", "measured", ""), shown) if shown else ""


def knee_table(rows: Sequence[Row]) -> str:
    """Return, for each probe, where on the front of all methods and meshes going on costs more than it buys."""
    points = merged(rows, ("probe", "method", "facets"))
    if not any(np.isfinite(row[TIME]) for row in points):
        return ""
    shown = []
    for probe in dict.fromkeys(row["probe"] for row in points):
        here = [row for row in points if row["probe"] == probe]
        best = knee(here)
        if best is not None:
            ours = knee([row for row in here if row["method"] == OURS])
            shown.append([plain(probe), _knee(best), _knee(ours), _in_short(front(here))])
    columns = ("probe", "knee of all methods", f"knee of {OURS}", "the front, fastest first")
    return table(columns, shown)


def _in_short(line: Sequence[Row]) -> str:
    """Return the methods of a front in order, with the meshes of each stretch."""
    stretches = []
    for method, group in groupby(line, key=lambda row: str(row["method"])):
        facets = [row["facets"] for row in group]
        span = f"{min(facets):,}" if len(facets) == 1 else f"{min(facets):,} to {max(facets):,}"
        stretches.append(f"{method} {span}")
    return "; ".join(stretches)


def _knee(row: Row | None) -> str:
    if row is None:
        return "–"
    return (
        f"**{row['method']}, {row['facets']:,} facets**: {_us(row[TIME])} µs, {number(row[ERROR], '.2f')} mm"
    )


def steep_table(rows: Sequence[Row]) -> str:
    """Return how far all answers and sure ones are off, by angle, without noise; empty without steep angles."""
    quiet = [row for row in rows if not is_noisy(row)]
    points = merged(quiet, ("angle", "method"))
    if not any(row["angle"] > STEEP_DEG for row in points):
        return ""
    shown = []
    for row in sorted(points, key=lambda row: (row["angle"], row["method"])):
        figures = [number(row[name], ".2f") for name in (ERROR, "mean_sure_mm")]
        figures += [number(100 * row[name], ".2f") for name in ("sure", "astray", "astray_sure")]
        shown.append([f"{row['angle']:g}°", row["method"], *figures])
    columns = (
        "angle",
        "method",
        "mean of all, mm",
        "mean of sure ones, mm",
        "sure %",
        "astray %",
        "astray, yet sure %",
    )
    return table(columns, shown)


def torque_table(rows: Sequence[Row]) -> str:
    """Return, by force and torsion, what it brings to solve for the local torque; empty with one torsion or method."""
    noisy = [row for row in usual(rows) if is_noisy(row) and not row["failed"]]
    torsions = sorted({row["torsion"] for row in noisy})
    most = max((row["facets"] for row in noisy), default=0)
    finest = [row for row in noisy if row["facets"] == most]
    points = {
        (r["force"], r["torsion"], r["method"]): r for r in merged(finest, ("force", "torsion", "method"))
    }
    both = [OURS, _AXIS]
    if len(torsions) < 2 or not all(any(key[2] == method for key in points) for method in both):
        return ""
    shown = []
    for force in sorted({key[0] for key in points}):
        found = [points[force, torsion, method] for torsion in torsions for method in both]
        shown.append(
            [f"{force:g} N", *(number(row["rms_near_mm"] / row["bound_mm"], ".2f") for row in found)]
        )
    columns = [f"{method}, torsion {1e3 * torsion:g} mm" for torsion in torsions for method in both]
    return table(("RMS error over the bound", *columns), shown)


def speed_table(rows: Sequence[Row]) -> str:
    """Return every method on every mesh: times and errors over all noisy conditions."""
    points = merged(rows, ("probe", "facets", "method"))
    best = {
        id(row)
        for probe in {r["probe"] for r in points}
        for row in front([r for r in points if r["probe"] == probe])
    }
    shown = [
        [
            plain(row["probe"]),
            f"{row['facets']:,}",
            f"**{row['method']}**" if id(row) in best else row["method"],
        ]
        + [_us(row[name]) for name in (COMPILED, "compiled_p99_ns", TIME, "python_p99_ns")]
        + [number(row[name], ".2f") for name in (ERROR, "p95_mm")]
        + [number(row["max_mm"], ".0f"), number(row["over_bound"], ".2f")]
        + [number(100 * row[name], ".2f") for name in ("sure", "astray_sure")]
        for row in points
    ]
    columns = (
        "probe",
        "facets",
        "method",
        "C++ µs",
        "p99",
        "Python µs",
        "p99",
        "mean mm",
        "95 % mm",
        "max mm",
    )
    return table((*columns, "sure RMS / bound", "sure %", "sure, yet astray %"), shown)


def growth_table(rows: Sequence[Row]) -> str:
    """Return how time and error grow as powers of the facets; empty with fewer than three meshes."""
    shown = []
    for (probe, method), (time, error) in exponents(rows).items():
        if time or error:
            shown.append([plain(probe), method, _power(time), _power(error)])
    columns = ("probe", "method", "time grows as facets to the power", "error without noise, to the power")
    return table(columns, shown) if shown else ""


def exponents(rows: Sequence[Row]) -> dict[tuple[str, str], tuple[Power | None, Power | None]]:
    """
    Return, for each probe and method, the powers of the facets that time and error grow as.

    Time is that of the compiled solve where there is one. The error is that of sure answers on the right part of the
    probe, without noise: that of the mesh, and of the method.
    """
    times = merged(rows, ("probe", "method", "facets"))
    quiet = merged(of_meshes(rows), ("probe", "method", "facets"))
    found = {}
    for probe, method in dict.fromkeys((row["probe"], row["method"]) for row in times):
        mine, own = (
            [r for r in each if (r["probe"], r["method"]) == (probe, method)] for each in (times, quiet)
        )
        facets = [row["facets_found"] for row in mine]
        time = power(facets, [row[COMPILED] for row in mine]) or power(facets, [row[TIME] for row in mine])
        error = settling([row["facets_found"] for row in own], [row["rms_near_mm"] for row in own])
        found[probe, method] = time, error
    return found


def needed_table(rows: Sequence[Row]) -> str:
    """Return the facets at which the mesh adds 1 % to the noise, by probe and force; empty if not told."""
    found = needed_facets(rows)
    if not found:
        return ""
    forces = sorted({force for _, force, _, _ in found})
    shown = []
    for probe in dict.fromkeys(each[0] for each in found):
        by_force = {force: (enough, least) for name, force, enough, least in found if name == probe}
        shown.append([plain(probe)] + [_facets(*by_force.get(force, (None, 0.0))) for force in forces])
    return table(("probe", *(f"{force:g} N" for force in forces)), shown)


def reason_table(rows: Sequence[Row]) -> str:
    """Return the share of each reason, and where a method goes astray most."""
    shown = []
    for probe, method in dict.fromkeys((row["probe"], row["method"]) for row in rows):
        here = [row for row in rows if (row["probe"], row["method"]) == (probe, method) and not row["failed"]]
        if not here:
            continue
        worst = max(here, key=lambda row: float(row["astray_sure"]))
        shares = [
            number(100 * float(np.mean([row[f"reason_{name}"] for row in here])), ".2f") for name in _REASONS
        ]
        where = "nowhere" if not worst["astray_sure"] else _condition(worst)
        astray = [100 * float(np.mean([row[name] for row in here])) for name in ("astray", "astray_sure")]
        shown.append([plain(probe), method, *shares, *(number(x, ".2f") for x in astray), where])
    columns = ("probe", "method, %", *(name.replace("_", " ") for name in _REASONS))
    return table((*columns, "astray", "astray, yet sure", "most of these at"), shown) if shown else ""


def _condition(row: Row) -> str:
    return (
        f"{row['facets']:,} facets, {row['force']:g} N, {row['angle']:g}°, torsion {1e3 * row['torsion']:g} mm,"
        f" filter {row['filter']}: {100 * row['astray_sure']:.2f}"
    )


def _facets(enough: float | None, least: float) -> str:
    if enough is None:
        return "more than tried" if least else "–"
    return f"under {least:,.0f}" if enough <= least else f"{float(f'{enough:.2g}'):,.0f}"


def _power(found: Power | None) -> str:
    if found is None:
        return "–"
    floor = f", down to {found.floor:.2g} mm" if found.floor else ""
    return f"{found.exponent:.2f} ± {found.sigma:.2f}{floor}"


def _us(ns: float) -> str:
    return number(ns / 1e3)
