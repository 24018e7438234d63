"""Gains for a probe: chosen by their margins, drawn against the tissue's stiffness, and tried in simulation."""

from __future__ import annotations

import json
from dataclasses import dataclass
from importlib import import_module
from typing import TYPE_CHECKING, Any

import numpy as np

from contactbench.pipeline.control.foundation import USUAL_MODULUS
from contactbench.pipeline.control.gains import (
    MarginRow,
    Tuned,
    WantedMargins,
    rows_of,
    settings_content,
    spread_of,
    tune,
)
from contactbench.pipeline.control.loop import run_loop
from contactbench.pipeline.control.margins import AXES
from contactbench.pipeline.control.settings import Variant
from contactbench.pipeline.control.states import ControlState
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.simulation.marker_touches import check_bundled
from contactbench.pipeline.simulation.scenes import Tissue
from contactbench.pipeline.study.control_rig import SCENES, foundation_of, make_rig
from contactbench.pipeline.study.pages import png
from contactbench.pipeline.study.report import Figure, Sheet, StudyReport

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence
    from pathlib import Path

_TRIAL_S, _SETTLED_S = 6.0, 1.5
_TRIALS = 3  # softest, usual, stiffest
_MOST_SHARE, _MOST_N, _MOST_DEG = 130.0, 0.25, 3.0


@dataclass(frozen=True, eq=False)
class TuningResult:
    """Gains, and the report of how they did: what is judged are presses on tissue that rests."""

    tuned: Tuned
    report: StudyReport

    def to_json(self) -> dict[str, Any]:
        """Return plain data for ``--json``."""
        return {**self.report.to_json(), "config": settings_content(self.tuned.settings)}

    def write(self, out: Path) -> None:
        """Write gains.json, tuning.md, margins.png and a CSV file per table in a folder; InputError."""
        self.report.write(out, "tuning.md")


def run(
    probe: str = "convex",
    *,
    stiffness: float | None = None,
    scene: str = "platform",
    variant: Variant = Variant.PLAIN,
    force: float = 7.0,
    wanted: WantedMargins | None = None,
    seed: int = 0,
    progress: Callable[[int, int], None] = lambda _done, _total: None,
) -> TuningResult:
    """
    Choose gains and try them.

    Parameters
    ----------
    probe : str
        One of assets.PROBE_NAMES.
    stiffness : float, optional
        Of the usual tissue at the wanted force, N/m.
    force : float
        N.
    progress : callable, optional
        Told how many of how many trials are done.

    Raises
    ------
    InputError
        An argument is out of its range, the margins cannot be had, or MuJoCo is missing.
    """
    check_bundled([probe])
    world = next((each for each in SCENES if each == scene), None)
    if world is None:
        raise InputError(f"there is no scene {scene!r}: choose one of {', '.join(SCENES)}.")
    if not 1 <= force <= 20:
        raise InputError(f"a force of {force:g} N: give 1 to 20 N.")
    foundation = foundation_of(probe)
    modulus = USUAL_MODULUS
    if stiffness is not None:
        if not 50 <= stiffness <= 100_000:
            raise InputError(
                f"a stiffness of {stiffness:g} N/m: give 50 to 100,000; soft tissue has some 2,000."
            )
        modulus = foundation.modulus_of(force, stiffness)
    tuned = tune(foundation, modulus, variant=variant, wanted=wanted, desired_force=force)
    figures: list[Figure] = []
    for number, each in enumerate(spread_of(modulus, tuned.wanted.spread, _TRIALS)):
        rig = make_rig(
            world,
            probe,
            tuned.settings,
            seed,
            tissue=Tissue(each, each / 60, 0.1),
            coarse=world == "platform",
        )
        trace = run_loop(rig.scene, rig.controller, rig.sensor, _TRIAL_S)
        last = trace.between(trace.time[-1] - _SETTLED_S)
        swing = float(np.degrees(last.angles.std(axis=0).max()))
        subject = f"{foundation.at(force, each).stiffness:,.0f} N/m"
        figures += [
            Figure(subject, "tracked at the end", float(trace.ended is ControlState.TRACK), "", 1),
            Figure(
                subject,
                "largest force, of the wanted",
                float(100 * trace.peak.max() / force),
                "%",
                most=_MOST_SHARE,
            ),
            Figure(subject, "SD of the force at rest", float(last.force.std()), "N", most=_MOST_N),
            Figure(subject, "SD of the angle at rest", swing, "deg", most=_MOST_DEG),
        ]
        progress(number + 1, _TRIALS)
    told = {"probe": probe, "variant": str(variant), "force": f"{force:g} N", "scene": world, "seed": seed}
    told["stiffness"] = f"{foundation.at(force, modulus).stiffness:,.0f} N/m"
    rows = rows_of(tuned, foundation)
    note = (
        f"Wanted on all stiffnesses: gain margin {tuned.wanted.gain:g}, phase margin"
        f" {np.degrees(tuned.wanted.phase):.0f} degrees; no gain above {tuned.wanted.fastest:g}/s. The figures are of"
        " simulation, on tissue that rests."
    )
    files = {
        "gains.json": f"{json.dumps(settings_content(tuned.settings), indent=2)}\n".encode(),
        "margins.png": _draw(rows, tuned.wanted),
    }
    sheets = (_gains(tuned), _margins(rows))
    return TuningResult(tuned, StudyReport("control tune", told, tuple(figures), (note,), sheets, files))


def _gains(tuned: Tuned) -> Sheet:
    s = tuned.settings
    loops = (
        ("force", s.force_gain, s.force_mass, s.force_damping, s.bandwidth[0]),
        *(
            (axis, s.angle_gains[i], s.angle_inertia[i], s.angle_damping[i], s.bandwidth[1 + i])
            for i, axis in enumerate(AXES[1:])
        ),
    )
    columns = ("loop", "gain 1/s", "mass or inertia", "damping", "lead 1/s", "stopped by")
    rows = tuple((*loop, tuned.reached[loop[0]]) for loop in loops)
    return Sheet("gains", "Gains (SI units)", columns, rows)


def _margins(rows: Sequence[MarginRow]) -> Sheet:
    columns = ("loop", "stiffness N/m", "stable", "gain margin", "phase margin deg", "crossover rad/s")
    cells = tuple(
        (
            row.axis,
            row.stiffness,
            "yes" if row.margins.stable else "NO",
            row.margins.gain,
            float(np.degrees(row.margins.phase)),
            row.margins.crossover,
        )
        for row in rows
    )
    return Sheet("margins", "Margins against stiffness", columns, cells)


def _draw(rows: Sequence[MarginRow], wanted: WantedMargins) -> bytes:
    """Draw both margins of all loops against stiffness, as a PNG image."""
    figure = import_module("matplotlib.figure").Figure(figsize=(12, 5), dpi=100, layout="constrained")
    left, right = figure.subplots(1, 2)
    for axis in AXES:
        mine = [row for row in rows if row.axis == axis]
        stiffness = [row.stiffness for row in mine]
        left.loglog(stiffness, [row.margins.gain for row in mine], "o-", label=axis)
        right.semilogx(stiffness, [np.degrees(row.margins.phase) for row in mine], "o-", label=axis)
    left.axhline(wanted.gain, color="black", ls=":", label="wanted")
    right.axhline(np.degrees(wanted.phase), color="black", ls=":", label="wanted")
    left.set(title="gain margin", xlabel="stiffness of the tissue, N/m", ylabel="factor")
    right.set(title="phase margin", xlabel="stiffness of the tissue, N/m", ylabel="degrees", ylim=(0, 95))
    for panel in (left, right):
        panel.legend(fontsize=8)
        panel.grid(alpha=0.3)
    return png(figure)
