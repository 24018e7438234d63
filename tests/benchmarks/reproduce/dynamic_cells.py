"""One run of the closed loop over the moving phantom, and what is measured of it."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np
from benchmarks.trials import in_processes, rms

from contactbench.pipeline.control.loop import arm_of, run_loop
from contactbench.pipeline.control.settings import ControlSettings, Variant
from contactbench.pipeline.control.states import ControlState
from contactbench.pipeline.simulation.scenes import PlatformMotion, Tissue
from contactbench.pipeline.simulation.scenes.platform import AXES
from contactbench.pipeline.simulation.scenes.tissue import TissueCylinder
from contactbench.pipeline.study.gain_trials import SceneName, foundation_of, make_rig

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from contactbench.pipeline.control.loop import Trace
    from contactbench.pipeline.simulation.scenes import MovedScene

START_S = 4.0  # by then it tracks: half a second in the air, touch, ramp, one small press
FORCE_N = 7.0
VERTICAL, IN_PLANE, OUT_OF_PLANE = "vertical", "in plane", "out of plane"
# The paper's Eq. 11: 10 mm or 10 degrees.
MOTIONS = {VERTICAL: ("z", 0.010), IN_PLANE: ("ry", np.radians(10)), OUT_OF_PLANE: ("rx", np.radians(10))}
# Across the direction in which a tilt moves the contact: a force along it moves the wrench's axis where a tilt would.
_ASIDE = {VERTICAL: "x", IN_PLANE: "y", OUT_OF_PLANE: "x"}
PERIODS_S = (10.0, 5.0, 2.0)
METHODS = ("contactbench", "algorithm1", "wrench_axis", "iterative")
_MOVING_S = 10.0


@dataclass(frozen=True)
class Phantom:
    """What is pressed on, and how it slides and twists under the probe while it makes its motion."""

    friction: float
    slide: float = 0.0  # m, to either side
    twist: float = 0.0  # rad, to either side, about the phantom's normal
    cylinder: TissueCylinder | None = None

    @property
    def tissue(self) -> Tissue:
        """Its tissue."""
        return Tissue(friction=self.friction, cylinder=self.cylinder)

    def moved(self, motion: str, period: float) -> PlatformMotion:
        """Return one of `MOTIONS`, with what comes on top."""
        axis, size = MOTIONS[motion]
        whole = np.zeros(6)
        whole[[AXES.index(axis), AXES.index("rz")]] = size, self.twist
        whole[AXES.index(_ASIDE[motion])] = self.slide
        return PlatformMotion(whole, period, START_S)


# The paper's, and two on which a contact has a torque about its normal: dry skin that slides and twists, and a limb.
PHANTOMS = {
    "flat": Phantom(0.1),
    "twisting": Phantom(0.6, slide=0.005, twist=np.radians(20)),
    "curved": Phantom(0.6, slide=0.005, cylinder=TissueCylinder(0.1, np.radians(45))),
}


@dataclass(frozen=True)
class Cell:
    """One run."""

    scene: SceneName  # {"platform", "arm"}
    probe: str
    method: str
    variant: Variant
    motion: str  # A key of `MOTIONS`
    period: float  # Of the motion, s
    seed: int  # Of load, biases, calibration and noise
    phantom: str = "flat"  # A key of `PHANTOMS`
    quick: bool = False  # One period only, with coarser physics

    @property
    def seconds(self) -> float:
        """How long the platform moves: whole periods, two of them and 10 s at least."""
        periods = 1 if self.quick else max(round(_MOVING_S / self.period), 2)
        return periods * self.period


@dataclass(frozen=True)
class Outcome:
    """What is measured while the platform moves, from its first moment on."""

    cell: Cell
    followed: float  # Share of the time in which it tracked
    force: tuple[float, float, float]  # (least, mean, largest). True, along the probe's axis, N.
    # (mean, SD). Of the absolute angle error in the plane of the motion - for a vertical one in plane - and
    # in the other one, degrees.
    angle: tuple[float, float]
    # (mean, SD). Of the absolute angle error in the plane of the motion - for a vertical one in plane - and
    # in the other one, degrees.
    other: tuple[float, float]
    whole: float  # Mean whole angle between axis and normal, degrees
    first: float  # Largest force before the platform moves, N
    lost: int  # How often the probe left the phantom after its first touch, until the end
    place: float  # Root mean square distance from sensed to true contact, mm
    # Root mean square of the true contact's torque about its own normal, N·mm, and of how far that moves
    # the wrench's axis from the contact, mm
    torsion: tuple[float, float]
    speed: float  # Largest share of a joint's speed limit that a set-point asked for
    held: float  # Share of the time in which the arm's limits cut what was wanted
    step_ms: tuple[float, float]  # (median, 99th percentile). Of the controller, ms.
    ended: str  # What happened before the end, if it did not follow


def run_cell(cell: Cell, settings: ControlSettings | None = None) -> tuple[Outcome, Trace]:
    """Run one."""
    phantom = PHANTOMS[cell.phantom]
    base = settings or ControlSettings.for_probe(foundation_of(cell.probe), desired_force=FORCE_N)
    rig = make_rig(
        cell.scene,
        cell.probe,
        replace(base, variant=cell.variant),
        cell.seed,
        method=cell.method,
        tissue=phantom.tissue,
        motion=phantom.moved(cell.motion, cell.period),
        coarse=cell.quick,
    )
    trace = run_loop(rig.scene, rig.controller, rig.sensor, START_S + cell.seconds)
    return outcome_of(cell, trace, rig.scene), trace


def outcome_of(cell: Cell, trace: Trace, scene: MovedScene) -> Outcome:
    """Sum up a run."""
    moving = trace.between(START_S)
    limits = arm_of(scene).velocity_limits
    period = float(np.median(np.diff(trace.time)))
    speeds = np.abs(np.diff(trace.joints, axis=0)) / period / limits
    first = trace.between(0.0, START_S - 1.5 * period)  # the last one may end in the jump in speed
    touched = np.flatnonzero(trace.force > 1.0)
    away = trace.force[touched[0] :] < 0.05 if len(touched) else np.zeros(1, dtype=np.bool_)
    ms = 1e3 * np.percentile(trace.step_s, [50, 99])
    # A run that ended itself early did not follow for the rest; where its periods begin does not matter.
    missing = max(round(cell.seconds / period) - len(moving) - 1, 0)
    followed = float(moving.was(ControlState.TRACK).sum()) / max(len(moving) + missing, 1)
    if not len(moving):
        nothing = (float("nan"), float("nan"))
        moved: dict[str, Any] = {"force": (*nothing, float("nan")), "angle": nothing, "other": nothing}
        moved |= {"whole": float("nan"), "place": float("nan"), "torsion": nothing, "held": float("nan")}
    else:
        moved = _moving(cell, moving)
    return Outcome(
        cell=cell,
        followed=followed,
        first=float(first.peak.max()),
        lost=int(np.count_nonzero(np.diff(away.astype(int)) == 1)),
        speed=float(speeds.max()),
        step_ms=(float(ms[0]), float(ms[1])),
        ended="" if followed > 0.999 else " ".join(f"{each.reason}" for each in trace.changes[2:]),
        **moved,
    )


def _moving(cell: Cell, moving: Trace) -> dict[str, Any]:
    errors = np.degrees(np.abs(moving.angles))
    mine = 1 if cell.motion == OUT_OF_PLANE else 0
    off = moving.offset - moving.place
    return {
        "force": (float(moving.force.min()), float(moving.force.mean()), float(moving.force.max())),
        "angle": (float(errors[:, mine].mean()), float(errors[:, mine].std())),
        "other": (float(errors[:, 1 - mine].mean()), float(errors[:, 1 - mine].std())),
        "whole": float(np.degrees(moving.tilt).mean()),
        "place": rms(1e3 * np.linalg.norm(off, axis=1)),
        "torsion": (rms(1e3 * moving.torsion), rms(1e3 * moving.shift)),
        "held": float((moving.share < 0.999).mean()),
    }


def run_cells(
    cells: Sequence[Cell],
    traced: Callable[[Cell], bool],
    *,
    workers: int | None = None,
    progress: Callable[[int, int], None] = lambda _done, _total: None,
    settings: ControlSettings | None = None,
) -> tuple[list[Outcome], dict[Cell, Trace]]:
    """Run many: the results do not depend on how many processes share them."""
    outcomes: dict[Cell, Outcome] = {}
    traces: dict[Cell, Trace] = {}
    for outcome, trace in in_processes(partial(_run, settings), [(c, traced(c)) for c in cells], workers):
        outcomes[outcome.cell] = outcome
        if trace is not None:
            traces[outcome.cell] = trace
        progress(len(outcomes), len(cells))
    return [outcomes[cell] for cell in cells], traces


def _run(settings: ControlSettings | None, job: tuple[Cell, bool]) -> tuple[Outcome, Trace | None]:
    cell, traced = job
    outcome, trace = run_cell(cell, settings)
    return outcome, trace if traced else None
