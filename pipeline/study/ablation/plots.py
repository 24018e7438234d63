"""The ablation's curves as pictures, by Matplotlib; importing this module imports it, which takes a while."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib import rc_context
from matplotlib.figure import Figure

from contactbench.pipeline.study.ablation import location_choices, sensor_choices
from contactbench.pipeline.study.ablation.effects import FILTERED
from contactbench.pipeline.study.ablation.verdicts import ANSWERS, MATTERS, located_more, noise_name, share_of
from contactbench.pipeline.study.pages import COLOURS, STYLE, png

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

Row = dict[str, Any]
_PANEL, _HEIGHT, _DPI = 3.4, 2.9, 80


def plots(rows: Sequence[Row]) -> dict[str, bytes]:
    """Return PNG images by file name."""
    curves = [row for row in rows if row["kind"] == "curve"]
    if not curves:
        return {}
    return {
        "smooth.png": _panels(_smooth(curves)),
        "torque.png": _panels(_torque(curves)),
        "reading.png": _panels(_readings(curves)),
    }


Panel = tuple[str, str, str, dict[str, tuple[list[float], list[float], str]], float | None]


def _smooth(curves: Sequence[Row]) -> list[Panel]:
    panels: list[Panel] = []
    for choice in location_choices.SMOOTHED:
        mine = [r for r in curves if r["choice"] == choice]
        noisy = [r for r in mine if r["x_name"] == "noise"]
        lines = _lines(noisy, "facets", lambda facets: f"{facets:,} facets")
        panels.append((choice, "noise, times that of a reading", "share of the error bought", lines, MATTERS))
        twisted = [r for r in mine if r["x_name"] != "noise" and r["noise_times"] == FILTERED]
        lines = _lines(twisted, "facets", lambda facets: f"{facets:,} facets")
        panels.append((choice, "torsion, mm (noise filtered)", "share of the error bought", lines, MATTERS))
    return panels


def _torque(curves: Sequence[Row]) -> list[Panel]:
    panels: list[Panel] = []
    for choice, name in (
        (location_choices.LOCAL_TORQUE, "torsion, mm"),
        (location_choices.LOCAL_TORQUE, "noise"),
        (location_choices.GATE, "force angle up to, deg"),
    ):
        mine = [r for r in curves if r["choice"] == choice and r["x_name"] == name]
        split = "probe" if name == "noise" else "noise_times"
        gate = choice == location_choices.GATE
        figure = located_more if gate else share_of
        lines = _lines(mine, split, lambda v: v if isinstance(v, str) else f"noise: {noise_name(v)}", figure)
        shown = "noise, times that of a reading" if name == "noise" else name
        what = "share of touches located more" if gate else "share of the error bought"
        panels.append((choice, shown, what, lines, ANSWERS if gate else MATTERS))
    return panels


def _readings(curves: Sequence[Row]) -> list[Panel]:
    panels: list[Panel] = []
    for choice in sensor_choices.CHOICES:
        mine = [r for r in curves if r["choice"] == choice]
        lines: dict[str, tuple[list[float], list[float], str]] = {}
        for which, style in (("without", "--"), ("made", "-")):
            for label, (xs, ys, _) in _lines(mine, "probe", str, _mean_of(f"{which}_mean_mm")).items():
                lines[f"{label}, {'modelled' if which == 'made' else 'left out'}"] = (xs, ys, style)
        panels.append((choice, sensor_choices.UNITS[choice], "mean error, mm", lines, None))
    return panels


def _mean_of(name: str) -> Callable[[Sequence[Row]], float]:
    return lambda rows: float(np.mean([row[name] for row in rows]))


def _lines(
    rows: Sequence[Row],
    split: str,
    label: Callable[[Any], str],
    figure: Callable[[Sequence[Row]], float] = share_of,
) -> dict[str, tuple[list[float], list[float], str]]:
    """Return x, y and the style of a line for each value of a column, over probes and repetitions."""
    found = {}
    for value in dict.fromkeys(row[split] for row in rows):
        mine = [row for row in rows if row[split] == value]
        xs = sorted({row["x"] for row in mine})
        ys = [figure([row for row in mine if row["x"] == x]) for x in xs]
        found[label(value)] = (xs, ys, "-")
    return found


def _panels(panels: Sequence[Panel]) -> bytes:
    with rc_context(STYLE):
        figure = Figure(figsize=(_PANEL * len(panels), _HEIGHT), dpi=_DPI, layout="constrained")
        for axes, (title, x_name, y_name, lines, mark) in zip(
            figure.subplots(1, len(panels), squeeze=False)[0], panels, strict=True
        ):
            colours: dict[str, str] = {}
            for name, (xs, ys, style) in lines.items():
                colour = colours.setdefault(name.split(", ")[0], COLOURS[len(colours) % len(COLOURS)])
                axes.plot(xs, ys, style, marker="o", color=colour, label=name)
            least = min((x for xs, _, _ in lines.values() for x in xs if x > 0), default=1.0)
            if "angle" not in x_name:
                axes.set_xscale("symlog", linthresh=least)
                axes.set_xlim(left=0)
            if mark is not None:
                axes.axhline(mark, color="#6b6b6b", linewidth=0.8, linestyle=":")
            axes.set(title=title, xlabel=x_name, ylabel=y_name)
            axes.legend(fontsize=6.5)
        return png(figure)
