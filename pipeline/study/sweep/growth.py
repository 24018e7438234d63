"""What rows of results say: how figures grow with the mesh, who is on the front, and which targets are met."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import groupby
from typing import TYPE_CHECKING, Any

import numpy as np

from contactbench.pipeline.study.pages import number, table
from contactbench.pipeline.study.report import FigureVerdict, verdict_of

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Sequence

    from contactbench.pipeline.mesh.arrays import Floats


Row = dict[str, Any]
TIME, COMPILED, ERROR = "python_median_ns", "compiled_median_ns", "mean_mm"
_TIMES = (COMPILED, "compiled_p99_ns", TIME, "python_p99_ns")
_SHARES = ("answered", "sure", "astray", "astray_sure")
_MATTERS = 1.01
_BENT = 0.1  # of the squares that a power leaves: with less left than this a floor is there
_FALLS = 3.0  # a figure that falls less than this has no power to tell
OURS = "contactbench"
STEEP_DEG = 45.0  # friction of 1 allows no more
MOST_OVER_BOUND = 1.05
_FINE = (15_000, 30_000)  # about 20,000 facets
_FORCES_N, _STEEPEST_DEG, _TWISTED_M = (2.0, 20.0), 60.0, 0.0005
# A root mean square over so many touches is known to this share of itself: of two tangent errors together, half of
# one over the root of the count.
_SPREAD = 0.5


def each_of(rows: Iterable[Row], *by: str) -> Iterable[tuple[Any, list[Row]]]:
    """Return the rows of each combination of `by`, a tuple, as they first come."""
    groups: dict[tuple[Any, ...], list[Row]] = {}
    for row in rows:
        groups.setdefault(tuple(row[name] for name in by), []).append(row)
    return groups.items()


def merged(rows: Iterable[Row], by: Sequence[str]) -> list[Row]:
    """
    Return one row for each combination of `by`: times as medians, shares and mean errors as means, the rest as RMS.

    Rows that failed are left out.
    """
    done = [row for row in rows if not row.get("failed")]
    return [dict(zip(by, key, strict=True)) | _summary(group) for key, group in each_of(done, *by)]


def _summary(group: list[Row]) -> Row:
    def of(name: str, what: Any) -> float:
        found = np.array([np.nan if (x := row.get(name)) is None else x for row in group], dtype=np.float64)
        some = found[np.isfinite(found)]
        return float(what(some)) if len(some) else float("nan")

    def rms(x: Floats) -> float:
        return float(np.sqrt(np.mean(x * x)))

    sure, bound = of("rms_sure_mm", rms), of("bound_mm", rms)
    return {
        "cells": len(group),
        "touches": sum(int(row["touches"]) for row in group),
        "facets_found": of("facets_found", np.median),
        "max_mm": of("max_mm", np.max),
        "p95_mm": of("p95_mm", np.median),
        "rms_sure_mm": sure,
        "rms_near_mm": of("rms_near_mm", rms),
        "bound_mm": bound,
        "over_bound": sure / bound if bound > 0 else float("nan"),
        **{name: of(name, np.mean) for name in ("mean_mm", "mean_sure_mm", *_SHARES)},
        **{name: of(name, np.median) for name in _TIMES},
    }


def front(rows: Sequence[Row]) -> list[Row]:
    """Return the rows that no other beats in both time and error, the fastest first."""
    known = [row for row in rows if np.isfinite(row[TIME]) and np.isfinite(row[ERROR])]
    best: list[Row] = []
    for row in sorted(known, key=lambda row: (row[TIME], row[ERROR])):
        if not best or row[ERROR] < best[-1][ERROR]:
            best.append(row)
    return best


def beaten(row: Row, rivals: Iterable[Row]) -> list[Row]:
    """Return the rivals that are both faster and more accurate, each by more than 2 %: below it is chance."""
    return [each for each in rivals if all(1.02 * each[name] < row[name] for name in (TIME, ERROR))]


def knee(rows: Sequence[Row]) -> Row | None:
    """Return the row of a front where going on costs more than it buys: farthest from the line between its ends."""
    line = front(rows)
    if len(line) < 3:
        return line[-1] if line else None
    x = np.log([row[TIME] for row in line])
    y = np.log([max(row[ERROR], 1e-9) for row in line])
    x, y = (x - x[0]) / (x[-1] - x[0]), (y - y[-1]) / (y[0] - y[-1])
    return line[int(np.argmax(1 - x - y))]


@dataclass(frozen=True)
class Power:
    """A figure that grows as a power of the facets: figure = scale * facets ** exponent."""

    # exponent, sigma: with its standard error
    exponent: float
    sigma: float
    scale: float
    count: int  # of the points it is fitted to
    # what is left however fine the mesh is: its square adds to that of the power. 0: nothing that shows.
    floor: float = 0.0


def power(facets: Sequence[float], figures: Sequence[float]) -> Power | None:
    """Fit a power; None with fewer than three points that are positive."""
    x, y = np.array(facets, dtype=np.float64), np.array(figures, dtype=np.float64)
    kept = np.isfinite(y) & (y > 0) & (x > 0)
    if len(np.unique(x[kept])) < 3:
        return None
    A = np.column_stack([np.log(x[kept]), np.ones(kept.sum())])
    found, *_ = np.linalg.lstsq(A, np.log(y[kept]), rcond=None)
    left = np.log(y[kept]) - A @ found
    variance = float(left @ left) / max(kept.sum() - 2, 1)
    sigma = float(np.sqrt(variance * np.linalg.inv(A.T @ A)[0, 0]))
    return Power(float(found[0]), sigma, float(np.exp(found[1])), int(kept.sum()))


def settling(facets: Sequence[float], figures: Sequence[float]) -> Power | None:
    """
    Fit a power with a floor, where that explains the figures much better than a power alone.

    An error of the mesh ends where the method's own begins: a power fitted across that bend says nothing.
    """
    plain = power(facets, figures)
    if plain is None or plain.count < 4 or np.nanmax(figures) < _FALLS * np.nanmin(figures):
        return plain
    from scipy.optimize import least_squares

    x, y = np.array(facets, dtype=np.float64), np.array(figures, dtype=np.float64)
    kept = np.isfinite(y) & (y > 0)
    x, y = np.log(x[kept]), np.log(y[kept])

    def left(u: Floats) -> Floats:
        return np.asarray(0.5 * np.logaddexp(2 * u[2], 2 * (u[1] + u[0] * x)) - y)

    start = [min(plain.exponent, -0.5), float(y[np.argmin(x)]) + 0.8 * float(x.min()), float(y.min())]
    found = least_squares(left, start, bounds=([-3.0, -np.inf, -np.inf], [0.0, np.inf, np.inf]))
    straight = float(np.sum((np.log(plain.scale) + plain.exponent * x - y) ** 2))
    if 2 * found.cost > _BENT * straight:
        return plain
    variance = 2 * found.cost / max(len(x) - 3, 1)
    jacobian: Floats = np.array(found.jac, dtype=np.float64)
    sigma = float(np.sqrt(variance * np.linalg.pinv(jacobian.T @ jacobian)[0, 0]))
    exponent, scale, floor = (float(v) for v in found.x)
    return Power(exponent, sigma, float(np.exp(scale)), len(x), float(np.exp(floor)))


def enough_facets(facets: Sequence[float], mesh_mm: Sequence[float], bound_mm: float) -> float | None:
    """
    Return the facets from which on the error of the mesh adds less than 1 % to that of the noise.

    Errors of the two add as squares. Between the meshes that were tried a power is taken.

    Parameters
    ----------
    facets, mesh_mm : sequences
        The error without noise, RMS, mm, on each mesh.
    bound_mm : float
        The bound of the noise, RMS, mm.

    Returns
    -------
    float or None
        None: not even the finest mesh is enough. The fewest that were tried: all are.
    """
    order = np.argsort(facets)
    n, e = np.array(facets, dtype=np.float64)[order], np.array(mesh_mm, dtype=np.float64)[order]
    n, e = n[np.isfinite(e)], e[np.isfinite(e)]
    allowed = bound_mm * np.sqrt(_MATTERS**2 - 1)
    if not len(n) or not e[-1] <= allowed:
        return None
    above = np.flatnonzero(e > allowed)
    if not len(above):
        return float(n[0])
    i = int(above[-1])
    share = np.log(e[i] / allowed) / np.log(e[i] / max(e[i + 1], 1e-12))
    return float(np.exp(np.log(n[i]) + share * np.log(n[i + 1] / n[i])))


# ---- what a sweep is judged by -----------------------------------------------------------------------


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


# ---- A sweep as tables ---------------------------------------------------------------------------


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
