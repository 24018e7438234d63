"""A sweep as pictures, by Matplotlib; importing this module imports it, which takes a while."""

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from matplotlib import rc_context
from matplotlib.figure import Figure

from contactbench.pipeline.study.pages import STYLE, png
from contactbench.pipeline.study.sweep.growth import (
    COMPILED,
    ERROR,
    OURS,
    TIME,
    Row,
    each_of,
    exponents,
    front,
    is_noisy,
    knee,
    merged,
    of_meshes,
    plain,
    usual,
)

Value = str | Callable[[Row], float]  # of a row: a column, or what is made of several

# Okabe and Ito: everybody can tell them apart.
_LOOK = {
    "contactbench": ("#0072b2", "o"),
    "algorithm1": ("#d55e00", "s"),
    "wrench_axis": ("#009e73", "^"),
    "iterative": ("#cc79a7", "D"),
    "scan": ("#56b4e9", "v"),
}
_PANEL, _HEIGHT, _DPI = 3.1, 2.9, 90  # inches
_DARK = "#222222"


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

    def draw(axes: Any, here: Sequence[Row]) -> None:
        for [method], line in each_of(here, "method"):
            _line(axes, line, _python_us, ERROR, method)
            for row in (line[0], line[-1]):
                at, colour = (_python_us(row), row[ERROR]), _LOOK[method][0]
                axes.annotate(
                    _short(row["facets"]), at, (3, 3), textcoords="offset points", fontsize=6.5, c=colour
                )
        best = front(here)
        axes.plot([_python_us(row) for row in best], [row[ERROR] for row in best], c=_DARK, lw=0.7, ls=":")
        if bend := knee(here):
            axes.plot(_python_us(bend), bend[ERROR], "o", ms=11, mfc="none", mec=_DARK)
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
    halves = [
        (points, y, said, which)
        for points, y, said, which in (
            (times, _us, "µs a solve, compiled (dashed: from Python)", 0),
            (quiet, "rms_near_mm", "error without noise, mm", 1),
        )
        if points
    ]
    if not halves:
        return b""
    with rc_context(STYLE):
        figure, grid = _grid(len(halves), len(probes))
        for (points, y, said, which), line in zip(halves, grid, strict=True):
            for axes, probe in zip(line, probes, strict=True):
                here = [row for row in points if row["probe"] == probe]
                for [method], own in each_of(here, "method"):
                    law = laws[probe, method][which]
                    dashed = not which and not np.isfinite(own[0][COMPILED])
                    tail = f" {law.exponent:+.2f}" if law else ""
                    _line(axes, own, "facets_found", y, method, "--" if dashed else "-", tail)
                for row in bounds if which else ():
                    if row["probe"] == probe:
                        _level(axes, row["bound_mm"], f"noise, {row['force']:g} N")
                axes.set(xscale="log", yscale="log", xlabel="facets", title=plain(probe))
                axes.legend(fontsize=6.5)
            line[0].set_ylabel(said)
        return png(figure)


def _against(rows: Sequence[Row], name: str) -> bytes:
    """Draw the errors of sure answers against a condition, with the bound: on each method's finest mesh."""
    if len({row[name] for row in rows}) < 3:
        return b""
    least = min(row["torsion"] for row in rows)
    finest = {key: max(row["facets"] for row in own) for key, own in each_of(rows, "probe", "method")}
    chosen = [
        row
        for row in rows
        if row["facets"] == finest[row["probe"], row["method"]] and row["torsion"] == least
    ]
    said, scale, unit = "RMS of sure answers, mm", "log", "force, N"
    if name == "force":
        chosen = usual(chosen)
    else:  # the smallest force would hide the others
        forces = sorted({row["force"] for row in rows})
        middle = forces[len(forces) // 2]
        chosen, said = [row for row in chosen if row["force"] == middle], f"{said}, {middle:g} N"
        scale, unit = "linear", "angle between force and normal, degrees"
    points = merged(chosen, ("probe", "method", name))

    def draw(axes: Any, here: Sequence[Row]) -> None:
        for [method], own in each_of(here, "method"):
            line = sorted(own, key=lambda row: float(row[name]))
            _line(axes, line, name, "rms_sure_mm", method)
            if method == OURS:
                x, y = ([row[each] for row in line] for each in (name, "bound_mm"))
                axes.plot(x, y, "--", c=_DARK, label="noise bound")
        axes.set(xscale=scale, yscale="log", xlabel=unit)

    return _panels(points, draw, said)


def _line(
    axes: Any, rows: Sequence[Row], x: Value, y: Value, method: str, style: str = "-", tail: str = ""
) -> None:
    colour, mark = _LOOK[method]
    xs, ys = ([each(row) if callable(each) else row[each] for row in rows] for each in (x, y))
    axes.plot(xs, ys, marker=mark, ls=style, c=colour, label=method + tail)


def _level(axes: Any, height: float, said: str) -> None:
    axes.axhline(height, c="#888888", lw=0.7, ls="--")
    look: dict[str, Any] = {"fontsize": 6, "c": "#666666", "ha": "right", "va": "bottom"}
    axes.text(1, height, said, transform=axes.get_yaxis_transform(), **look)


def _python_us(row: Row) -> float:
    return float(row[TIME]) / 1e3


def _us(row: Row) -> float:
    return float(row[COMPILED] if np.isfinite(row[COMPILED]) else row[TIME]) / 1e3


def _panels(points: Sequence[Row], draw: Callable[[Any, Sequence[Row]], None], said: str) -> bytes:
    by_probe = dict(each_of(points, "probe"))
    with rc_context(STYLE):
        figure, [line] = _grid(1, len(by_probe))
        for axes, ([probe], here) in zip(line, by_probe.items(), strict=True):
            draw(axes, here)
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
