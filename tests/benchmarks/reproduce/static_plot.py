"""The figures of the static experiments on one page."""

from __future__ import annotations

from importlib import import_module
from io import BytesIO
from typing import TYPE_CHECKING, Any

import numpy as np
from benchmarks.reproduce.locating import OURS
from benchmarks.reproduce.statistics import distances_mm

from contactbench.pipeline.study.marker_touches import ANGLES, PERPENDICULAR

if TYPE_CHECKING:
    from benchmarks.reproduce.static import StaticResult

_COLOURS = ("#0072b2", "#d55e00", "#009e73")
_PAPER = "#6b6b6b"
_PAPER_MEANS = {"t-shape": 0.94, "linear": 1.28, "convex": 0.91}


def draw(result: StaticResult) -> bytes:
    """Draw six panels as a PNG image."""
    figure = import_module("matplotlib.figure").Figure(figsize=(16, 9), dpi=100, layout="constrained")
    panels = figure.subplots(2, 3).ravel()
    _by_marker(panels[0], result)
    _by_force(panels[1], result)
    _scatter(panels[2], result)
    _force_errors(panels[3], result)
    _by_probe(panels[4], result)
    _causes(panels[5], result)
    data = BytesIO()
    figure.savefig(data, format="png", metadata={"Software": None})
    return data.getvalue()


def _by_marker(axes: Any, result: StaticResult) -> None:
    first = result.probes[0]
    error = distances_mm(first.located[OURS].points, first.touched.points)
    numbers = np.unique(first.touched.markers)
    for k, (angle, colour) in enumerate(zip(ANGLES, _COLOURS, strict=True)):
        means = [
            np.nanmean(error[(first.touched.markers == n) & (first.touched.angles == k)]) for n in numbers
        ]
        axes.plot(numbers, means, "o-", color=colour, label=angle)
    axes.set(title=f"{first.name}: error by marker", xlabel="marker", ylabel="mm", ylim=(0, None))
    axes.legend()


def _by_force(axes: Any, result: StaticResult) -> None:
    for angle, colour in zip(ANGLES, _COLOURS, strict=True):
        mine = [one for one in result.forces if one.angle == angle]
        where = [one.force for one in mine]
        means, sds = [one.errors.mean for one in mine], [one.errors.sd for one in mine]
        axes.errorbar(where, means, yerr=sds, fmt="o-", color=colour, capsize=3, label=angle)
    axes.set(title="marker 3: error by force", xlabel="N", ylabel="mm", ylim=(0, None))
    axes.legend()


def _scatter(axes: Any, result: StaticResult) -> None:
    colours = (*_COLOURS, _PAPER)
    shown = [one for one in result.forces if one.angle == PERPENDICULAR and one.force in (1, 5, 10, 20)]
    for one, colour in zip(shown, colours, strict=True):
        axes.plot(*one.answers_mm.T, ".", color=colour, label=f"{one.force:g} N", markersize=4)
    axes.set(title="marker 3, perpendicular: located less true", xlabel="x, mm", ylabel="y, mm")
    axes.set_aspect("equal", adjustable="datalim")
    axes.legend()


def _force_errors(axes: Any, result: StaticResult) -> None:
    numbers = np.arange(1, len(result.force_errors) + 1)
    for k, (angle, colour) in enumerate(zip(ANGLES, _COLOURS, strict=True)):
        axes.bar(numbers + 0.27 * (k - 1), result.force_errors[:, k], 0.25, color=colour, label=angle)
    axes.set(title="mean error of the filtered force, 5 to 20 N", xlabel="marker", ylabel="N")
    axes.legend()


def _by_probe(axes: Any, result: StaticResult) -> None:
    names = [one.name for one in result.probes]
    upright = [one.errors[PERPENDICULAR, OURS] for one in result.probes]
    where = np.arange(len(names))
    means, sds = [e.mean for e in upright], [e.sd for e in upright]
    axes.bar(where - 0.15, means, 0.3, yerr=sds, capsize=3, color=_COLOURS[0], label="here")
    axes.bar(where + 0.15, [_PAPER_MEANS[name] for name in names], 0.3, color=_PAPER, label="paper")
    axes.set(title="perpendicular", ylabel="mm", xticks=where, xticklabels=names)
    axes.legend()


def _causes(axes: Any, result: StaticResult) -> None:
    names = [one.cause for one in result.attributed]
    where = np.arange(len(names))
    for k, (angle, colour) in enumerate(zip(ANGLES, _COLOURS, strict=True)):
        means = [one.means[k] for one in result.attributed]
        axes.barh(where + 0.27 * (k - 1), means, 0.25, color=colour, label=angle)
    axes.set(title="distance to the marker, by cause", xlabel="mm", yticks=where, yticklabels=names)
    axes.invert_yaxis()
    axes.legend()
