"""The pictures of a fleet's page: one sensor with one tool over time. Importing this module imports Matplotlib."""

from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from contactbench.pipeline.page.figures import WIDTH, page_style, to_svg
from contactbench.pipeline.page.palette import BLUE, GREEN, VERMILION

_COLOURS = (BLUE, VERMILION, GREEN)
_STYLE: dict[str, Any] = {
    "font.size": 8.0,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "date.converter": "concise",
}
_NEWEST_POINTS = 300  # points of a line: the newest
# Title, factor and columns of each panel.
_PANELS = (
    ("Force bias less its median, N", 1.0, tuple(f"force_bias_{axis}_N" for axis in "xyz")),
    ("Torque bias less its median, mN·m", 1e3, tuple(f"torque_bias_{axis}_Nm" for axis in "xyz")),
    ("Mass, g", 1e3, ("mass_kg",)),
    ("Centre of mass less its median, mm", 1e3, tuple(f"centre_{axis}_m" for axis in "xyz")),
    ("Verification error (mean), mm", 1e3, ("error_mean_m",)),
    ("Temperature, °C", 1.0, ("temperature_C",)),
)


def draw_group(table: Any, outliers: Sequence[bool], prefix: str) -> str:
    """
    Return the SVG of one group.

    Parameters
    ----------
    table : pyarrow.Table
        Its rows that have a time, by time.
    outliers : sequence of bool
        For each row, whether it stands out: it is circled.
    prefix : str
        Of the ids in the SVG.
    """
    table = table.slice(max(0, table.num_rows - _NEWEST_POINTS))
    marked = np.array(outliers[-table.num_rows :], dtype=bool)
    when = np.asarray(table["calibrated"].cast("timestamp[s]").to_numpy())
    with page_style(**_STYLE):
        figure = Figure(figsize=(WIDTH, 4.6), layout="constrained")
        for panel, (title, scale, columns) in zip(
            figure.subplots(3, 2, sharex=True).flat, _PANELS, strict=True
        ):
            _draw(panel, table, when, marked, scale, columns)
            panel.set_title(title, loc="left", fontsize=8.0)
        return to_svg(figure, prefix, "Calibrations of one sensor and tool over time")


def _draw(panel: Axes, table: Any, when: Any, marked: Any, scale: float, columns: Sequence[str]) -> None:
    for column, colour, axis in zip(columns, _COLOURS, "xyz", strict=False):
        values = scale * np.asarray(table[column].to_numpy(), dtype=np.float64)
        if (
            columns[1:] and np.isfinite(values).any()
        ):  # axes that are far apart would look like straight lines
            values -= np.nanmedian(values)
        panel.plot(
            when,
            values,
            marker="o",
            markersize=2.5,
            linewidth=0.8,
            color=colour,
            label=axis if columns[1:] else None,
        )
        panel.plot(
            when[marked],
            values[marked],
            "o",
            markersize=6.5,
            markerfacecolor="none",
            markeredgecolor=VERMILION,
        )
    if columns[1:]:
        panel.legend(frameon=False, ncols=3, fontsize=7.0, loc="best")
    panel.grid(visible=True)
