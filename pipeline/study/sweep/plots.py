"""A sweep as pictures, by Matplotlib; importing this module imports it, which takes a while."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib import rc_context
from matplotlib.figure import Figure

from contactbench.pipeline.study.pages import STYLE, png
from contactbench.pipeline.study.sweep.growth import COMPILED, ERROR, TIME, Row, front, knee, merged
from contactbench.pipeline.study.sweep.tables import exponents
from contactbench.pipeline.study.sweep.targets import OURS, is_noisy, of_meshes, plain, usual

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

# Okabe and Ito: everybody can tell them apart.
_LOOK = {
    "contactbench": ("#0072b2", "o"),
    "algorithm1": ("#d55e00", "s"),
    "wrench_axis": ("#009e73", "^"),
    "iterative": ("#cc79a7", "D"),
    "scan": ("#56b4e9", "v"),
}
_PANEL, _HEIGHT, _DPI = 3.1, 2.9, 90  # inches


def plots(rows: Sequence[Row]) -> dict[str, bytes]:
    """Return PNG images by file name: those that the rows have something for."""
    noisy = [row for row in rows if is_noisy(row) and not row["failed"]]
    made = {"speed-error.png": _pareto(usual(noisy)), "growth.png": _growth(rows)}
    made |= {f"{name}.png": _against(noisy, name) for name in ("force", "angle")}
    return {name: data for name, data in made.items() if data}


def _pareto(rows: Sequence[Row]) -> bytes:
    points = merged(rows, ("probe", "method", "facets"))
    points = [row for row in points if np.isfinite(row[TIME]) and row[ERROR] > 0]
    if len(points) < 3:
        return b""

    def draw(axes: Any, probe: str) -> None:
        here = [row for row in points if row["probe"] == probe]
        for method in dict.fromkeys(row["method"] for row in here):
            line = [row for row in here if row["method"] == method]
            colour, mark = _LOOK[method]
            axes.plot(
                [row[TIME] / 1e3 for row in line],
                [row[ERROR] for row in line],
                mark + "-",
                c=colour,
                label=method,
            )
            for row in (line[0], line[-1]):
                at = (row[TIME] / 1e3, row[ERROR])
                axes.annotate(
                    _short(row["facets"]), at, (3, 3), textcoords="offset points", fontsize=6.5, c=colour
                )
        best = front(here)
        axes.plot(
            [row[TIME] / 1e3 for row in best], [row[ERROR] for row in best], c="#222222", lw=0.7, ls=":"
        )
        bend = knee(here)
        if bend is not None:
            axes.plot(bend[TIME] / 1e3, bend[ERROR], "o", ms=11, mfc="none", mec="#222222")
        axes.set(xscale="log", yscale="log", xlabel="µs a solve, from Python")

    return _panels(points, draw, "mean error, mm")


def _growth(rows: Sequence[Row]) -> bytes:
    if len({row["facets"] for row in rows}) < 3:
        return b""
    times = [row for row in merged(rows, ("probe", "method", "facets")) if np.isfinite(row[TIME])]
    quiet = merged(of_meshes(rows), ("probe", "method", "facets"))
    bounds = merged([row for row in rows if is_noisy(row) and row["method"] == OURS], ("probe", "force"))
    laws = exponents(rows)
    probes = list(dict.fromkeys(row["probe"] for row in rows))
    halves: list[tuple[str | Callable[[Row], float], list[Row], str, int]] = [
        (_time, times, "µs a solve, compiled (dashed: from Python)", 0),
        ("rms_near_mm", quiet, "error without noise, mm", 1),
    ]
    halves = [half for half in halves if half[1]]
    if not halves:
        return b""
    with rc_context(STYLE):
        figure, grid = _grid(len(halves), len(probes))
        for (name, points, said, which), line in zip(halves, grid, strict=True):
            for axes, probe in zip(line, probes, strict=True):
                here = [row for row in points if row["probe"] == probe]
                for method in dict.fromkeys(row["method"] for row in here):
                    own = [row for row in here if row["method"] == method]
                    law = laws[probe, method][which]
                    tail = f" {law.exponent:+.2f}" if law else ""
                    _draw_line(axes, own, name, method, tail)
                if which:
                    for row in (row for row in bounds if row["probe"] == probe):
                        axes.axhline(row["bound_mm"], c="#888888", lw=0.7, ls="--")
                        axes.text(
                            1,
                            row["bound_mm"],
                            f"noise, {row['force']:g} N",
                            fontsize=6,
                            c="#666666",
                            ha="right",
                            va="bottom",
                            transform=axes.get_yaxis_transform(),
                        )
                axes.set(xscale="log", yscale="log", xlabel="facets", title=plain(probe))
                axes.legend(fontsize=6.5)
            line[0].set_ylabel(said)
        return png(figure)


def _time(row: Row) -> float:
    return float(row[COMPILED] if np.isfinite(row[COMPILED]) else row[TIME]) / 1e3


def _draw_line(
    axes: Any, rows: Sequence[Row], name: str | Callable[[Row], float], method: str, tail: str
) -> None:
    colour, mark = _LOOK[method]
    y = [name(row) if callable(name) else row[name] for row in rows]
    ls = "--" if callable(name) and not np.isfinite(rows[0][COMPILED]) else "-"
    x = [row["facets_found"] for row in rows]
    axes.plot(x, y, marker=mark, ls=ls, c=colour, label=method + tail)


def _against(rows: Sequence[Row], name: str) -> bytes:
    """Draw the errors of sure answers against a condition, with the bound: on each method's finest mesh."""
    if len({row[name] for row in rows}) < 3:
        return b""
    finest: dict[tuple[str, str], int] = {}
    for row in rows:
        key = row["probe"], row["method"]
        finest[key] = max(finest.get(key, 0), row["facets"])
    least = min(row["torsion"] for row in rows)
    chosen = [
        row
        for row in rows
        if row["facets"] == finest[row["probe"], row["method"]] and row["torsion"] == least
    ]
    said = "RMS of sure answers, mm"
    if name == "force":
        chosen = usual(chosen)
    else:  # the smallest force would hide the others
        forces = sorted({row["force"] for row in rows})
        middle = forces[len(forces) // 2]
        chosen, said = [row for row in chosen if row["force"] == middle], f"{said}, {middle:g} N"
    points = merged(chosen, ("probe", "method", name))

    def draw(axes: Any, probe: str) -> None:
        here = [row for row in points if row["probe"] == probe]
        for method in dict.fromkeys(row["method"] for row in here):
            line = sorted((row for row in here if row["method"] == method), key=lambda row: float(row[name]))
            x = [row[name] for row in line]
            colour, mark = _LOOK[method]
            axes.plot(x, [row["rms_sure_mm"] for row in line], mark + "-", c=colour, label=method)
            if method == OURS:
                axes.plot(x, [row["bound_mm"] for row in line], "--", c="#222222", label="noise bound")
        scale = "log" if name == "force" else "linear"
        unit = "force, N" if name == "force" else "angle between force and normal, degrees"
        axes.set(xscale=scale, yscale="log", xlabel=unit)

    return _panels(points, draw, said)


def _panels(points: Sequence[Row], draw: Callable[[Any, str], None], said: str) -> bytes:
    probes = list(dict.fromkeys(row["probe"] for row in points))
    with rc_context(STYLE):
        figure, [line] = _grid(1, len(probes))
        for axes, probe in zip(line, probes, strict=True):
            draw(axes, probe)
            axes.set_title(plain(probe))
        line[0].set_ylabel(said)
        line[0].legend(fontsize=6.5)
        return png(figure)


def _grid(rows: int, columns: int) -> tuple[Figure, Any]:
    figure = Figure(figsize=(_PANEL * columns, _HEIGHT * rows), dpi=_DPI, layout="constrained")
    return figure, figure.subplots(rows, columns, squeeze=False, sharey="row")


def _short(facets: int) -> str:
    for size, letter in ((1_000_000, "M"), (1_000, "k")):
        if facets >= size:
            return f"{facets / size:g}{letter}"
    return str(facets)
