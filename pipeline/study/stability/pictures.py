"""The pictures of the stability study, PNG."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from contactbench.pipeline.study.stability import amplification as am
from contactbench.pipeline.study.stability import bias, precision, thin
from contactbench.pipeline.study.stability import rounding as ro
from contactbench.pipeline.study.stability.rows import Row, of_part

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence
    from pathlib import Path

    from matplotlib.axes import Axes

# Okabe and Ito: colours that everybody can tell apart.
_COLOURS = ("#0072b2", "#d55e00", "#009e73", "#cc79a7", "#56b4e9", "#e69f00")
_SIZE_INCHES, _DOTS_PER_INCH = (8.0, 3.1), 100


def draw(rows: Sequence[Row], folder: Path) -> list[tuple[str, str]]:
    """
    Draw what there are figures of, and return the files' names and what they show.

    Parameters
    ----------
    rows : sequence of Row
    folder : Path
        Where the files go.
    """
    made = []
    for name, alt, left, right in _PICTURES:
        if _two(rows, folder / name, left, right):
            made.append((name, alt))
    return made


def _two(rows: Sequence[Row], file: Path, left: _Panel, right: _Panel) -> bool:
    from matplotlib.figure import Figure

    figure = Figure(figsize=_SIZE_INCHES, dpi=_DOTS_PER_INCH, layout="constrained")
    drawn = [panel(axes, rows) for panel, axes in zip((left, right), figure.subplots(1, 2), strict=True)]
    if not any(drawn):
        return False
    for axes in figure.axes:
        axes.grid(visible=True, color="#d9dcdf", linewidth=0.6)
        axes.set_axisbelow(True)
        axes.spines[["top", "right"]].set_visible(False)
        axes.tick_params(labelsize=8)
        if axes.lines:
            axes.legend(fontsize=7, frameon=False)
    # No version of Matplotlib in the file: the same results give the same picture.
    figure.savefig(file, metadata={"Software": None})
    return True


def _lines(axes: Axes, series: dict[str, list[Row]], what: str, *, worst: bool = True) -> bool:
    """Draw the worst or the median of each series over its axis, both logarithmic."""
    drawn = False
    for i, (name, found) in enumerate(series.items()):
        x = np.array([r.x for r in found], dtype=np.float64)
        y = np.array([r.worst if worst else r.median for r in found])
        fits = np.isfinite(x) & (x > 0) & np.isfinite(y) & (y > 0)
        if not fits.any():
            continue
        order = np.argsort(x[fits])
        style = "--" if i % 2 and name == am.PREDICTED else "o-"
        colour = _COLOURS[i % len(_COLOURS)]
        axes.loglog(
            x[fits][order], y[fits][order], style, color=colour, markersize=3, linewidth=1, label=name
        )
        axes.set_xlabel(found[0].axis, fontsize=8)
        drawn = True
    axes.set_ylabel(what, fontsize=8)
    return drawn


def _by(rows: Sequence[Row], bys: Sequence[str], **which: object) -> dict[str, list[Row]]:
    return {
        by: [r for r in rows if r.by == by and all(getattr(r, k) == v for k, v in which.items())]
        for by in bys
    }


def _cosines(axes: Axes, rows: Sequence[Row]) -> bool:
    series = _by(rows, (am.MEASURED, am.PREDICTED), part=am.PART, figure=am.GROWS)
    return _lines(axes, series, "point moved, m, of each unit of relative error", worst=False)


def _forces(axes: Axes, rows: Sequence[Row]) -> bool:
    return _lines(
        axes, _by(rows, (am.MEASURED, am.PREDICTED), part=am.PART, figure=am.SPREAD), "rms error, mm"
    )


def _rounding(axes: Axes, rows: Sequence[Row]) -> bool:
    series = _by(rows, (ro.DOUBLE, ro.SINGLE, ro.ALGORITHM1), part=ro.PART, figure=ro.ERROR, axis=am.COSINE)
    return _lines(axes, series, "worst error, mm")


def _facets(axes: Axes, rows: Sequence[Row]) -> bool:
    series = _by(rows, (ro.DOUBLE, ro.SINGLE, ro.ALGORITHM1), part=ro.PART, figure=ro.RATIO, axis=ro.FACETS)
    return _lines(axes, series, "worst error, roundoffs x condition")


def _heights(axes: Axes, rows: Sequence[Row]) -> bool:
    series = {
        f"{kind}, {by}": found
        for kind in (thin.CAP, thin.NEEDLE)
        for by, found in _by(
            rows, (ro.DOUBLE, ro.SINGLE), part=thin.PART, figure=thin.FROM_TRUTH, case=kind
        ).items()
    }
    return _lines(axes, series, "worst error, mm")


def _biases(axes: Axes, rows: Sequence[Row]) -> bool:
    series = _by(rows, (ro.DOUBLE, bias.WIRE, ro.SINGLE), part=bias.PART, figure=bias.ERROR)
    return _lines(axes, series, "worst error, mm")


def _singles(axis: str) -> _Panel:
    def panel(axes: Axes, rows: Sequence[Row]) -> bool:
        own = of_part(rows, precision.PART, figure=precision.APART, axis=axis)
        names = dict.fromkeys(r.case.partition(", ")[0] for r in own)
        series = {name: [r for r in own if r.case.startswith(f"{name}, ")] for name in names}
        return _lines(axes, series, "single from double precision, worst, mm")

    return panel


if TYPE_CHECKING:
    _Panel = Callable[[Axes, Sequence[Row]], bool]

_PICTURES: tuple[tuple[str, str, _Panel, _Panel], ...] = (
    (
        "amplification.png",
        "Amplification against the cosine of the friction angle and the force",
        _cosines,
        _forces,
    ),
    (
        "rounding.png",
        "Rounding against the cosine of the friction angle and the number of facets",
        _rounding,
        _facets,
    ),
    (
        "precision.png",
        "Single from double precision against the number of facets and the local torque",
        _singles(precision.FACETS),
        _singles(precision.PITCH),
    ),
    ("thin-and-biased.png", "Errors on thin facets and under a bias", _heights, _biases),
)
