"""A sweep as tables."""

from __future__ import annotations

from itertools import groupby
from typing import TYPE_CHECKING, Any

import numpy as np

from contactbench.pipeline.study.pages import number, table
from contactbench.pipeline.study.sweep.growth import (
    COMPILED,
    ERROR,
    OURS,
    STEEP_DEG,
    TIME,
    Row,
    each_of,
    front,
    is_noisy,
    knee,
    merged,
    needed_facets,
    of_meshes,
    plain,
    power,
    settling,
    targets,
    usual,
)

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Sequence

    from contactbench.pipeline.study.sweep.growth import Power

_AXIS = "wrench_axis"
_REASONS = ("ok", "vertex", "ambiguous", "implausible", "off_surface", "tangential", "low_force")
_Column = tuple[str, "Callable[[Row], str]"]  # heading, and what a row has in it


def _table(rows: Iterable[Row], *columns: _Column) -> str:
    """Return a table of rows; empty without any."""
    shown = [[cell(row) for _, cell in columns] for row in rows]
    return table([heading for heading, _ in columns], shown) if shown else ""


def _figure(heading: str, name: str, digits: str = ".2f", times: float = 1.0) -> _Column:
    return heading, lambda row: number(times * row[name], digits)


_PROBE: _Column = ("probe", lambda row: plain(row["probe"]))
_METHOD: _Column = ("method", lambda row: str(row["method"]))


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
    found = [[each.what, each.measured, "met" if each.met else "**missed**"] for each in targets(rows)]
    return table(("target", "measured", ""), found) if found else ""


def knee_table(rows: Sequence[Row]) -> str:
    """Return, for each probe, where on the front of all methods and meshes going on costs more than it buys."""
    points = merged(rows, ("probe", "method", "facets"))
    if not any(np.isfinite(row[TIME]) for row in points):
        return ""
    shown = []
    for [probe], here in each_of(points, "probe"):
        ours = [row for row in here if row["method"] == OURS]
        if best := knee(here):
            shown.append([plain(probe), _knee(best), _knee(knee(ours)), _in_short(front(here))])
    return table(("probe", "knee of all methods", f"knee of {OURS}", "the front, fastest first"), shown)


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
    where = f"**{row['method']}, {row['facets']:,} facets**"
    return f"{where}: {number(row[TIME] / 1e3)} µs, {number(row[ERROR], '.2f')} mm"


def steep_table(rows: Sequence[Row]) -> str:
    """Return how far all answers and sure ones are off, by angle, without noise; empty without steep angles."""
    points = merged([row for row in rows if not is_noisy(row)], ("angle", "method"))
    if not any(row["angle"] > STEEP_DEG for row in points):
        return ""
    return _table(
        sorted(points, key=lambda row: (row["angle"], row["method"])),
        ("angle", lambda row: f"{row['angle']:g}°"),
        _METHOD,
        _figure("mean of all, mm", ERROR),
        _figure("mean of sure ones, mm", "mean_sure_mm"),
        _figure("sure %", "sure", times=100),
        _figure("astray %", "astray", times=100),
        _figure("astray, yet sure %", "astray_sure", times=100),
    )


def torque_table(rows: Sequence[Row]) -> str:
    """Return, by force and torsion, what it brings to solve for the local torque; empty with one torsion or method."""
    noisy = [row for row in usual(rows) if is_noisy(row) and not row["failed"]]
    most = max((row["facets"] for row in noisy), default=0)
    finest = [row for row in noisy if row["facets"] == most]
    points = {
        (r["force"], r["torsion"], r["method"]): r for r in merged(finest, ("force", "torsion", "method"))
    }
    torsions = sorted({row["torsion"] for row in noisy})
    if len(torsions) < 2 or not {OURS, _AXIS} <= {method for *_, method in points}:
        return ""
    both = [(torsion, method) for torsion in torsions for method in (OURS, _AXIS)]
    shown = []
    for force in sorted({key[0] for key in points}):
        found = (points[force, *key] for key in both)
        shown.append(
            [f"{force:g} N", *(number(row["rms_near_mm"] / row["bound_mm"], ".2f") for row in found)]
        )
    columns = [f"{method}, torsion {1e3 * torsion:g} mm" for torsion, method in both]
    return table(("RMS error over the bound", *columns), shown)


def speed_table(rows: Sequence[Row]) -> str:
    """Return every method on every mesh: times and errors over all noisy conditions."""
    points = merged(rows, ("probe", "facets", "method"))
    best = {id(row) for _, here in each_of(points, "probe") for row in front(here)}

    def method(row: Row) -> str:
        return f"**{row['method']}**" if id(row) in best else str(row["method"])

    return _table(
        points,
        _PROBE,
        ("facets", lambda row: f"{row['facets']:,}"),
        ("method", method),
        _figure("C++ µs", COMPILED, ".3g", 1e-3),
        _figure("p99", "compiled_p99_ns", ".3g", 1e-3),
        _figure("Python µs", TIME, ".3g", 1e-3),
        _figure("p99", "python_p99_ns", ".3g", 1e-3),
        _figure("mean mm", ERROR),
        _figure("95 % mm", "p95_mm"),
        _figure("max mm", "max_mm", ".0f"),
        _figure("sure RMS / bound", "over_bound"),
        _figure("sure %", "sure", times=100),
        _figure("sure, yet astray %", "astray_sure", times=100),
    )


def growth_table(rows: Sequence[Row]) -> str:
    """Return how time and error grow as powers of the facets; empty with fewer than three meshes."""
    shown = [
        [plain(probe), method, _power(time), _power(error)]
        for (probe, method), (time, error) in exponents(rows).items()
        if time or error
    ]
    columns = ("probe", "method", "time grows as facets to the power", "error without noise, to the power")
    return table(columns, shown) if shown else ""


def exponents(rows: Sequence[Row]) -> dict[tuple[str, str], tuple[Power | None, Power | None]]:
    """
    Return, for each probe and method, the powers of the facets that time and error grow as.

    Time is that of the compiled solve where there is one. The error is that of sure answers on the right part of the
    probe, without noise: that of the mesh, and of the method.
    """
    quiet = dict(each_of(merged(of_meshes(rows), ("probe", "method", "facets")), "probe", "method"))
    found = {}
    for key, mine in each_of(merged(rows, ("probe", "method", "facets")), "probe", "method"):
        facets, own = [row["facets_found"] for row in mine], quiet.get(key, [])
        time = power(facets, [row[COMPILED] for row in mine]) or power(facets, [row[TIME] for row in mine])
        error = settling([row["facets_found"] for row in own], [row["rms_near_mm"] for row in own])
        found[key] = time, error
    return found


def needed_table(rows: Sequence[Row]) -> str:
    """Return the facets at which the mesh adds 1 % to the noise, by probe and force; empty if not told."""
    found = {(probe, force): rest for probe, force, *rest in needed_facets(rows)}
    forces = sorted({force for _, force in found})
    shown = [
        [plain(probe), *(_facets(*found.get((probe, force), (None, 0.0))) for force in forces)]
        for probe in dict.fromkeys(probe for probe, _ in found)
    ]
    return table(("probe", *(f"{force:g} N" for force in forces)), shown) if shown else ""


def reason_table(rows: Sequence[Row]) -> str:
    """Return the share of each reason, and where a method goes astray most."""

    def mean(name: str) -> Callable[[Row], str]:
        return lambda row: number(100 * float(np.mean([one[name] for one in row["all"]])), ".2f")

    def where(row: Row) -> str:
        worst = max(row["all"], key=lambda one: float(one["astray_sure"]))
        return _condition(worst) if worst["astray_sure"] else "nowhere"

    done = [row for row in rows if not row["failed"]]
    return _table(
        [{"probe": key[0], "method": key[1], "all": own} for key, own in each_of(done, "probe", "method")],
        _PROBE,
        ("method, %", _METHOD[1]),
        *((name.replace("_", " "), mean(f"reason_{name}")) for name in _REASONS),
        ("astray", mean("astray")),
        ("astray, yet sure", mean("astray_sure")),
        ("most of these at", where),
    )


def _condition(row: Row) -> str:
    return (
        f"{row['facets']:,} facets, {row['force']:g} N, {row['angle']:g}°, torsion {1e3 * row['torsion']:g} mm,"
        f" filter {row['filter']}: {100 * row['astray_sure']:.2f}"
    )


def _facets(enough: Any, least: Any) -> str:
    if enough is None:
        return "more than tried" if least else "–"
    return f"under {least:,.0f}" if enough <= least else f"{float(f'{enough:.2g}'):,.0f}"


def _power(found: Power | None) -> str:
    if found is None:
        return "–"
    floor = f", down to {found.floor:.2g} mm" if found.floor else ""
    return f"{found.exponent:.2f} ± {found.sigma:.2f}{floor}"
