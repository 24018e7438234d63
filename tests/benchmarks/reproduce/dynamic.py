"""A probe on a phantom that moves: force and angle kept by every method, plain and aware of the motion."""

from __future__ import annotations

import os
from dataclasses import dataclass
from itertools import product
from typing import TYPE_CHECKING, Any

import numpy as np
from benchmarks.reproduce.dynamic_cells import (
    FORCE_N,
    METHODS,
    MOTIONS,
    PERIODS_S,
    VERTICAL,
    Cell,
    Outcome,
)
from benchmarks.reproduce.dynamic_paper import DIFFERENCES
from benchmarks.reproduce.dynamic_plot import draw_course, draw_methods
from benchmarks.reproduce.dynamic_runs import run_cells
from benchmarks.reproduce.dynamic_store import Store
from benchmarks.reproduce.dynamic_tables import order_notes, runs, table_one, table_two

from contactbench import assets
from contactbench.pipeline.control.bounds import tilt_bound
from contactbench.pipeline.control.foundation import USUAL_MODULUS
from contactbench.pipeline.control.settings import ControlSettings, Variant
from contactbench.pipeline.durable import make_folder
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.study.control_rig import SCENES, foundation_of
from contactbench.pipeline.study.report import Figure, Report
from contactbench.pipeline.study.sheets import write_bytes, write_text

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence
    from pathlib import Path

    from contactbench.pipeline.control.trace import Trace
    from contactbench.pipeline.study.control_rig import SceneName
    from contactbench.pipeline.study.sheets import Sheet

OURS = "contactbench"
MOST_DEGREES = {10.0: 0.8, 5.0: 1.8, 2.0: 4.0}
FORCE_RANGE_N = (6.5, 7.5)
_FIRST_N = 1.15 * FORCE_N  # an overshoot of more than this is the beginning of an oscillation
_MOST_SEEDS = 100


@dataclass(frozen=True, eq=False)
class DynamicResult:
    """All that was measured."""

    settings: dict[str, Any]
    outcomes: tuple[Outcome, ...]
    traces: dict[Cell, Trace]  # Of the first seed and our method
    # (out of plane, in plane). Standard deviation of the tilt that one period of readings leaves, degrees.
    bound: tuple[float, float]

    differences = DIFFERENCES

    @property
    def sheets(self) -> tuple[Sheet, ...]:
        """Table I, Table II, and every run."""
        return (*self.summaries, runs(self.outcomes))

    @property
    def summaries(self) -> tuple[Sheet, ...]:
        """What fits a terminal."""
        return (table_one(self.outcomes), table_two(self.outcomes))

    @property
    def report(self) -> Report:
        """What is judged: our method, aware of the motion - or plain, if only that was run."""
        variant = Variant.AWARE if self._of(Variant.AWARE) else Variant.PLAIN
        figures = [
            figure
            for period in sorted({each.cell.period for each in self.outcomes}, reverse=True)
            for motion in MOTIONS
            if (mine := [o for o in self._of(variant) if (o.cell.motion, o.cell.period) == (motion, period)])
            for figure in _judged(motion, period, mine)
        ]
        mine = self._of(variant)
        figures.append(Figure.of("all", "largest force before the motion", [o.first for o in mine], "N",
                                 most=_FIRST_N, judged="worst"))  # fmt: skip
        figures.append(Figure.of("all", "times that the phantom was lost", [o.lost for o in mine], most=0,
                                 judged="worst"))  # fmt: skip
        figures.append(Figure.of("all", "largest share of a joint's speed limit", [100 * o.speed for o in mine],
                                 "%", most=100.0, judged="worst"))  # fmt: skip
        for axis, value in zip(("out of plane", "in plane"), self.bound, strict=True):
            figures.append(
                Figure("bound", f"tilt that one period of readings leaves unknown, {axis}", value, "deg")
            )
        notes = [f"Judged: {OURS}, {variant}.", *self._missed(figures), *order_notes(self.outcomes)]
        return Report("reproduce dynamic", self.settings, tuple(figures), tuple(notes))

    def markdown(self) -> str:
        """Write everything but the runs, which are in their CSV file."""
        differs = "\n".join(f"- {sentence}" for sentence in DIFFERENCES)
        parts = [self.report.markdown(), *(sheet.markdown() for sheet in self.summaries)]
        head = [
            "# The paper's dynamic experiments",
            "",
            "![course](course.png)",
            "",
            "![methods](methods.png)",
            "",
        ]
        return "\n".join([*head, *parts, "## What differs", "", differs, ""])

    def to_json(self) -> dict[str, Any]:
        """Return plain data for ``--json``."""
        tables = {sheet.name: sheet.to_json() for sheet in self.sheets}
        return {**self.report.to_json(), **tables, "differences": list(DIFFERENCES)}

    def write(self, out: Path) -> None:
        """
        Write dynamic.md, course.png, methods.png, a CSV file per table, and one per course in ``traces``.
        """
        make_folder(out / "traces")
        for sheet in self.sheets:
            write_text(out / f"{sheet.name}.csv", sheet.csv())
        write_text(out / "dynamic.md", self.markdown())
        write_bytes(out / "course.png", draw_course(self.traces))
        write_bytes(out / "methods.png", draw_methods(self.outcomes))
        for cell, trace in self.traces.items():
            name = f"{cell.variant}-{cell.motion.replace(' ', '-')}-{cell.period:g}s.csv"
            write_text(out / "traces" / name, trace.csv())

    def _of(self, variant: Variant) -> list[Outcome]:
        return [o for o in self.outcomes if (o.cell.method, o.cell.variant) == (OURS, variant)]

    def _missed(self, figures: Sequence[Figure]) -> list[str]:
        """Say what stands behind targets that are missed."""
        missed = [each for each in figures if not each.passed]
        if not missed:
            return []
        out, within = self.bound
        fastest = max(o.speed for o in self.outcomes)
        names = ", ".join(f"{each.subject}: {each.name}" for each in missed)
        bound = (
            f"Missed: {names}. What bounds them: with 0.05 N and 1.4 N·mm a reading and friction, one period"
            f" of readings leaves the tilt unknown by {out:.1f} degrees out of plane, {within:.1f} in plane;"
            " readings are 10 ms old on average when they are acted on, and the set-point holds for 20 ms."
            f" The joints were asked for at most {100 * fastest:.0f} % of their speed."
        )
        return [bound]


def run(
    probe: str = "convex",
    *,
    scene: str = "platform",
    variants: Sequence[Variant] = tuple(Variant),
    methods: Sequence[str] = METHODS,
    periods: Sequence[float] = PERIODS_S,
    seeds: int = 5,
    friction: float = 0.1,
    quick: bool = False,
    workers: int | None = None,
    settings: ControlSettings | None = None,
    kept: Path | None = None,
    progress: Callable[[int, int], None] = lambda _done, _total: None,
) -> DynamicResult:
    """Track a moving phantom with every method, the same gains and seeds for all."""
    variants = [Variant(each) for each in variants]
    chosen = _checked(probe, scene, variants, methods, periods, seeds, friction)
    cells = [
        Cell(chosen, probe, method, variant, motion, float(period), seed, friction, quick)
        for variant, period, motion, method, seed in product(
            variants, periods, MOTIONS, methods, range(seeds)
        )
    ]
    count = min(workers or os.cpu_count() or 1, len(cells))
    outcomes, traces = run_cells(
        cells,
        lambda cell: cell.seed == 0 and cell.method == methods[0],
        workers=count,
        progress=progress,
        settings=settings,
        store=None if kept is None else Store(kept, settings),
    )
    base = settings or ControlSettings.for_probe(foundation_of(probe), desired_force=FORCE_N)
    about_x, about_y = np.degrees(tilt_bound(base, foundation_of(probe), USUAL_MODULUS)).tolist()
    told = {"scene": scene, "probe": probe, "seeds": seeds, "friction": friction, "quick": quick}
    return DynamicResult(told, tuple(outcomes), traces, (about_x, about_y))


def _checked(
    probe: str,
    scene: str,
    variants: Sequence[Variant],
    methods: Sequence[str],
    periods: Sequence[float],
    seeds: int,
    friction: float,
) -> SceneName:
    if probe not in assets.PROBE_NAMES:
        raise InputError(f"there is no probe {probe!r}: choose one of {', '.join(assets.PROBE_NAMES)}.")
    chosen: SceneName | None = next((each for each in SCENES if each == scene), None)
    if chosen is None:
        raise InputError(f"there is no scene {scene!r}: choose one of {', '.join(SCENES)}.")
    if strange := [name for name in methods if name not in METHODS]:
        raise InputError(f"there is no method {strange[0]!r}: choose among {', '.join(METHODS)}.")
    if not variants or not methods or not periods or not all(0.5 <= each <= 60 for each in periods):
        raise InputError("give at least one variant, one method, and periods from 0.5 to 60 s.")
    if not 1 <= seeds <= _MOST_SEEDS:
        raise InputError(f"{seeds} seeds: give 1 to {_MOST_SEEDS}.")
    if not 0 <= friction <= 1:
        raise InputError(f"friction {friction:g}: give 0 to 1.")
    return chosen


def _judged(motion: str, period: float, mine: list[Outcome]) -> list[Figure]:
    subject = f"T = {period:g} s, {motion}"
    found = [Figure.of(subject, "followed", [100 * o.followed for o in mine], "%", least=100, judged="worst")]
    if motion != VERTICAL:
        name = "mean angle error in the plane of motion"
        found.append(
            Figure.of(subject, name, [o.angle[0] for o in mine], "deg", most=MOST_DEGREES.get(period))
        )
    low, high = FORCE_RANGE_N if period >= PERIODS_S[0] else (None, None)
    found.append(
        Figure.of(subject, "least force", [o.force[0] for o in mine], "N", least=low, judged="worst")
    )
    found.append(
        Figure.of(subject, "largest force", [o.force[2] for o in mine], "N", most=high, judged="worst")
    )
    return found
