"""Gains for a probe: chosen by their margins, drawn against the tissue's stiffness, and tried in simulation."""

from __future__ import annotations

import json
from dataclasses import dataclass
from importlib import import_module
from io import BytesIO
from typing import TYPE_CHECKING, Any

import numpy as np

from contactbench import assets
from contactbench.pipeline.control.foundation import USUAL_MODULUS
from contactbench.pipeline.control.loop import run_loop
from contactbench.pipeline.control.margins import AXES
from contactbench.pipeline.control.settings import Variant
from contactbench.pipeline.control.states import State
from contactbench.pipeline.control.tuning import (
    Row,
    Tuned,
    Wanted,
    rows_of,
    settings_content,
    spread_of,
    tune,
)
from contactbench.pipeline.durable import make_folder
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.simulation.scenes import Tissue
from contactbench.pipeline.study.control_rig import SCENES, foundation_of, make_rig
from contactbench.pipeline.study.report import Figure, Report
from contactbench.pipeline.study.sheets import Sheet, write_bytes, write_text

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

_TRIAL_S, _SETTLED_S = 6.0, 1.5
_TRIALS = 3  # softest, usual, stiffest
_MOST_SHARE, _MOST_N, _MOST_DEG = 130.0, 0.25, 3.0


@dataclass(frozen=True)
class Trial:
    """
    A press on tissue that rests, with the chosen gains.

    Attributes
    ----------
    stiffness : float
        N/m.
    peak : float
        Largest force, of the wanted one, %.
    force, angle : float
        Standard deviations in the last 1.5 s, N and degrees: what swings has a large one.
    tracked : bool
        Whether it tracked at the end.
    """

    stiffness: float
    peak: float
    force: float
    angle: float
    tracked: bool


@dataclass(frozen=True, eq=False)
class TuningResult:
    """
    Gains, their margins, and the trials.

    Attributes
    ----------
    settings : dict
        What they were chosen for.
    tuned : Tuned
    rows : tuple of Row
    trials : tuple of Trial
    """

    settings: dict[str, Any]
    tuned: Tuned
    rows: tuple[Row, ...]
    trials: tuple[Trial, ...]

    @property
    def sheets(self) -> tuple[Sheet, ...]:
        """Gains, and margins."""
        return (self._gains(), self._margins())

    @property
    def report(self) -> Report:
        """What is judged: the trials."""
        figures = []
        for trial in self.trials:
            subject = f"{trial.stiffness:,.0f} N/m"
            figures += [
                Figure(subject, "tracked at the end", float(trial.tracked), "", 1),
                Figure(subject, "largest force, of the wanted", trial.peak, "%", most=_MOST_SHARE),
                Figure(subject, "SD of the force at rest", trial.force, "N", most=_MOST_N),
                Figure(subject, "SD of the angle at rest", trial.angle, "deg", most=_MOST_DEG),
            ]
        wanted = self.tuned.wanted
        note = (
            f"Wanted on all stiffnesses: gain margin {wanted.gain:g}, phase margin {np.degrees(wanted.phase):.0f}"
            f" degrees; no gain above {wanted.fastest:g}/s. The figures are of simulation, on tissue that rests."
        )
        return Report("control tune", self.settings, tuple(figures), (note,))

    def to_json(self) -> dict[str, Any]:
        """Return plain data for ``--json``."""
        tables = {sheet.name: sheet.to_json() for sheet in self.sheets}
        return {**self.report.to_json(), **tables, "config": settings_content(self.tuned.settings)}

    def write(self, out: Path) -> None:
        """
        Write gains.json, tuning.md, margins.png and a CSV file per table in a folder.

        Raises
        ------
        InputError
            It cannot be written.
        """
        make_folder(out)
        write_text(out / "gains.json", json.dumps(settings_content(self.tuned.settings), indent=2) + "\n")
        for sheet in self.sheets:
            write_text(out / f"{sheet.name}.csv", sheet.csv())
        parts = [self.report.markdown(), *(sheet.markdown() for sheet in self.sheets)]
        head = ["# Gains", "", "![margins](margins.png)", ""]
        write_text(out / "tuning.md", "\n".join([*head, *parts]))
        write_bytes(out / "margins.png", _draw(self.rows, self.tuned.wanted))

    def _gains(self) -> Sheet:
        s = self.tuned.settings
        x, y = s.angle_gains
        rows = (
            (
                "force",
                s.force_gain,
                s.force_mass,
                s.force_damping,
                s.bandwidth[0],
                self.tuned.reached["force"],
            ),
            (
                "about x",
                x,
                s.angle_inertia[0],
                s.angle_damping[0],
                s.bandwidth[1],
                self.tuned.reached["about x"],
            ),
            (
                "about y",
                y,
                s.angle_inertia[1],
                s.angle_damping[1],
                s.bandwidth[2],
                self.tuned.reached["about y"],
            ),
        )
        columns = ("loop", "gain 1/s", "mass or inertia", "damping", "lead 1/s", "stopped by")
        return Sheet("gains", "Gains (SI units)", columns, rows)

    def _margins(self) -> Sheet:
        rows = tuple(
            (
                row.axis,
                row.stiffness,
                "yes" if row.margins.stable else "NO",
                row.margins.gain,
                float(np.degrees(row.margins.phase)),
                row.margins.crossover,
            )
            for row in self.rows
        )
        columns = ("loop", "stiffness N/m", "stable", "gain margin", "phase margin deg", "crossover rad/s")
        return Sheet("margins", "Margins against stiffness", columns, rows)


def run(
    probe: str = "convex",
    *,
    stiffness: float | None = None,
    scene: str = "platform",
    variant: Variant = Variant.PLAIN,
    force: float = 7.0,
    wanted: Wanted | None = None,
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
    scene : {"platform", "arm"}
    variant : Variant
    force : float
        N.
    wanted : Wanted, optional
    seed : int
    progress : callable, optional
        Told how many of how many trials are done.

    Raises
    ------
    InputError
        An argument is out of its range, the margins cannot be had, or MuJoCo is missing.
    """
    if probe not in assets.PROBE_NAMES:
        raise InputError(f"there is no probe {probe!r}: choose one of {', '.join(assets.PROBE_NAMES)}.")
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
    trials = []
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
        trials.append(
            Trial(
                foundation.at(force, each).stiffness,
                float(100 * trace.peak.max() / force),
                float(last.force.std()),
                float(np.degrees(last.angles.std(axis=0).max())),
                tracked=trace.ended is State.TRACK,
            )
        )
        progress(number + 1, _TRIALS)
    told = {"probe": probe, "variant": str(variant), "force": f"{force:g} N", "scene": world, "seed": seed}
    told["stiffness"] = f"{foundation.at(force, modulus).stiffness:,.0f} N/m"
    return TuningResult(told, tuned, tuple(rows_of(tuned, foundation)), tuple(trials))


def _draw(rows: tuple[Row, ...], wanted: Wanted) -> bytes:
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
    data = BytesIO()
    figure.savefig(data, format="png", metadata={"Software": None})
    return data.getvalue()
