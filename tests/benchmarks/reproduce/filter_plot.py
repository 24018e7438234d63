"""The figure of the filters."""

from __future__ import annotations

from importlib import import_module
from io import BytesIO
from typing import TYPE_CHECKING

import numpy as np

from contactbench.pipeline.study.paper_setup import RATE_HZ

if TYPE_CHECKING:
    from benchmarks.reproduce.filter import FilterResult

_SHOWN_S = (2.0, 5.0)
_FAINT, _BLUE, _RED, _GREEN = "#b0b0b0", "#0072b2", "#d55e00", "#009e73"


def draw(result: FilterResult) -> bytes:
    """Draw spectra on the left, contacts over time on the right, x above y, as a PNG image."""
    figure = import_module("matplotlib.figure").Figure(figsize=(14, 8), dpi=100, layout="constrained")
    panels = figure.subplots(2, 2)
    located, quiet = result.spectra["located"], result.spectra["no noise"]
    times = np.arange(len(result.slide.raw_mm)) / RATE_HZ
    seen = (times >= _SHOWN_S[0]) & (times < _SHOWN_S[1])
    colours = {"none": _FAINT, "low-pass 10 Hz": _BLUE, "Kalman filter of wrenches": _RED}
    for k, axis in enumerate("xy"):
        left, right = panels[k]
        left.loglog(located.frequencies[1:], located.density[1:, k], color=_FAINT, label="located")
        left.loglog(quiet.frequencies[1:], quiet.density[1:, k], color=_GREEN, label="without noise")
        floor = 2 * result.slide.sigma_mm[k] ** 2 / RATE_HZ
        left.axhline(floor, color="black", ls=":", label="noise predicted")
        left.axvline(10.0, color=_BLUE, ls="--", label="the paper's 10 Hz")
        if result.suggestion.cutoff_hz is not None:
            left.axvline(result.suggestion.cutoff_hz, color=_RED, ls="--", label="suggested")
        left.set(title=f"{axis} of the contact", xlabel="Hz", ylabel="mm²/Hz", ylim=(floor / 100, None))
        left.legend(fontsize=8)
        for name, colour in colours.items():
            right.plot(times[seen], result.shown[name][seen, k], color=colour, label=name, lw=1)
        right.plot(times[seen], result.slide.quiet_mm[seen, k], color=_GREEN, label="without noise", lw=1)
        right.set(title=f"{axis} of the contact", xlabel="s", ylabel="mm")
        right.legend(fontsize=8)
    data = BytesIO()
    figure.savefig(data, format="png", metadata={"Software": None})
    return data.getvalue()
