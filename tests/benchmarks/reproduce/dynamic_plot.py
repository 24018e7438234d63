"""Figures of the dynamic experiments: the course of one run (the paper's Fig. 10), and errors of all methods."""

from __future__ import annotations

from importlib import import_module
from io import BytesIO
from typing import TYPE_CHECKING, Any

import numpy as np
from benchmarks.reproduce.dynamic_cells import IN_PLANE, MOTIONS, OUT_OF_PLANE, START_S
from benchmarks.reproduce.dynamic_paper import FORCES

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from benchmarks.reproduce.dynamic_cells import Cell, Outcome

    from contactbench.pipeline.control.trace import Trace

_COLOURS = {"plain": "#d55e00", "aware": "#0072b2"}
_BARS = ("#0072b2", "#56b4e9", "#e69f00", "#009e73")
_PHANTOM, _BAND = "#303030", "#b0b0b0"


def draw_course(traces: Mapping[Cell, Trace]) -> bytes:
    """Draw force, and height or angle, against time for the slowest motion, as a PNG image."""
    figure = _figure(14, 10)
    panels = figure.subplots(len(MOTIONS), 2, sharex=True)
    slowest = max(cell.period for cell in traces)
    for row, motion in zip(panels, MOTIONS, strict=True):
        shown = {c: t for c, t in traces.items() if (c.motion, c.period) == (motion, slowest)}
        column = list(MOTIONS).index(motion)
        unit, name = ("mm", "height") if column == 0 else ("deg", "angle")
        for number, (cell, trace) in enumerate(shown.items()):
            seen = trace.between(START_S - 1)
            time, variant = seen.time - START_S, str(cell.variant)
            colour = _COLOURS[variant]
            row[0].plot(time, seen.force, color=colour, lw=1, label=variant)
            if number == 0:
                row[1].plot(time, _path(seen.phantom, column), color=_PHANTOM, lw=1.5, label="phantom")
            row[1].plot(time, _path(seen.probe, column), color=colour, lw=1, label=f"probe, {variant}")
        low, high = FORCES[motion]
        if slowest == 10.0:
            row[0].axhspan(low, high, color=_BAND, alpha=0.3, label="paper's range")
        row[0].set(title=f"{motion}, T = {slowest:g} s", ylabel="force, N")
        row[1].set(title=f"{name} of phantom and probe", ylabel=unit)
        for panel in row:
            panel.legend(fontsize=8)
            panel.grid(alpha=0.3)
    for panel in panels[-1]:
        panel.set_xlabel("s since the platform began to move")
    return _png(figure)


def draw_methods(outcomes: Sequence[Outcome]) -> bytes:
    """Draw mean angle errors of all methods, with their scatter over the seeds, as a PNG image."""
    figure = _figure(14, 5)
    panels = figure.subplots(1, 2, sharey=True)
    periods = sorted({o.cell.period for o in outcomes}, reverse=True)
    methods = list(dict.fromkeys(o.cell.method for o in outcomes))
    variants = list(dict.fromkeys(str(o.cell.variant) for o in outcomes))
    width = 0.8 / (len(methods) * len(variants))
    for panel, motion in zip(panels, (IN_PLANE, OUT_OF_PLANE), strict=True):
        for k, (variant, method) in enumerate((v, m) for v in variants for m in methods):
            found = [
                [o.angle[0] for o in outcomes
                 if (str(o.cell.variant), o.cell.method, o.cell.motion, o.cell.period) == (variant, method, motion, T)]
                for T in periods
            ]  # fmt: skip
            panel.bar(
                np.arange(len(periods)) + (k + 0.5) * width - 0.4,
                [np.mean(each) for each in found],
                width,
                yerr=[np.std(each) for each in found],
                color=_BARS[methods.index(method) % len(_BARS)],
                hatch="//" if variant == "plain" else None,
                label=f"{method}, {variant}",
            )
        panel.set_xticks(range(len(periods)), [f"T = {T:g} s" for T in periods])
        panel.set(title=motion, ylabel="mean absolute angle error, deg")
        panel.grid(axis="y", alpha=0.3)
    panels[1].legend(fontsize=8)
    return _png(figure)


def _path(body: Any, column: int) -> Any:
    return 1e3 * (body[:, 0] - body[0, 0]) if column == 0 else np.degrees(body[:, column])


def _figure(wide: float, high: float) -> Any:
    return import_module("matplotlib.figure").Figure(figsize=(wide, high), dpi=100, layout="constrained")


def _png(figure: Any) -> bytes:
    data = BytesIO()
    figure.savefig(data, format="png", metadata={"Software": None})
    return data.getvalue()
