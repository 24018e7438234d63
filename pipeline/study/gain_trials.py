"""Gains for a probe: chosen by their margins, drawn against the tissue's stiffness, and tried in simulation."""

import json
from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cache
from importlib import import_module
from pathlib import Path
from typing import Any, Literal

import numpy as np

from contactbench.pipeline.calibration import Calibration, PoseSample, calibrate
from contactbench.pipeline.calibration.suggest import by_hand, plan_poses
from contactbench.pipeline.contact import WrenchNoise
from contactbench.pipeline.control.controller import Controller
from contactbench.pipeline.control.intake import SampleIntake
from contactbench.pipeline.control.loop import Rig, arm_of, run_loop
from contactbench.pipeline.control.margins import (
    AXES,
    MarginRow,
    Tuned,
    WantedMargins,
    rows_of,
    settings_content,
    spread_of,
    tune,
)
from contactbench.pipeline.control.settings import USUAL_MODULUS, ControlSettings, Foundation, Variant
from contactbench.pipeline.control.states import ControlState, SensorMount
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.files import Progress, unheard
from contactbench.pipeline.mesh.arrays import Floats
from contactbench.pipeline.simulation.loads import LoadedSensor, draw_load
from contactbench.pipeline.simulation.marker_touches import check_bundled, model_of, truth_of
from contactbench.pipeline.simulation.scenes.arm import ArmScene
from contactbench.pipeline.simulation.scenes.physics import Payload
from contactbench.pipeline.simulation.scenes.platform import PlatformMotion, PlatformScene, Tissue
from contactbench.pipeline.simulation.sensor_model import SensorModel
from contactbench.pipeline.study.pages import png
from contactbench.pipeline.study.report import Figure, Sheet, StudyReport

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
    progress: Progress = unheard,
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
        tissue, coarse = Tissue(each, each / 60, 0.1), world == "platform"
        rig = make_rig(world, probe, tuned.settings, seed, tissue=tissue, coarse=coarse)
        trace = run_loop(rig.scene, rig.controller, rig.sensor, _TRIAL_S)
        last = trace.between(trace.time[-1] - _SETTLED_S)
        swing = float(np.degrees(last.angles.std(axis=0).max()))
        subject, largest = (
            f"{foundation.at(force, each).stiffness:,.0f} N/m",
            100 * float(trace.peak.max()) / force,
        )
        figures += [
            Figure(subject, "tracked at the end", float(trace.ended is ControlState.TRACK), "", 1),
            Figure(subject, "largest force, of the wanted", largest, "%", most=_MOST_SHARE),
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
    right.set(ylim=(0, 95))
    for panel, title, unit, least in (
        (left, "gain margin", "factor", wanted.gain),
        (right, "phase margin", "degrees", np.degrees(wanted.phase)),
    ):
        panel.axhline(least, color="black", ls=":", label="wanted")
        panel.set(title=title, xlabel="stiffness of the tissue, N/m", ylabel=unit)
        panel.legend(fontsize=8)
        panel.grid(alpha=0.3)
    return png(figure)


# ---- A closed loop on a bundled probe ------------------------------------------------------------


SceneName = Literal["platform", "arm"]
SCENES: tuple[SceneName, ...] = ("platform", "arm")
FACETS = 2_000
POSES, RATE_HZ = 8, 200.0
WARM_S = 3600.0  # since the sensor was switched on
_POSE_S, _BETWEEN_S = 1.0, 5.0
_MASS_KG = (0.3, 0.8)
COARSE: dict[str, Any] = {"step": 0.002, "places": 40}  # quicker; figures are for a first look


@dataclass(frozen=True, eq=False)
class CalibratedSensor(LoadedSensor):
    """A sensor, its load, and the gravity calibration that was made of it."""

    seed: int = 0
    calibration: Calibration = field(kw_only=True)


def draw_sensor(seed: int, sensor: str = "paper", calibrated_at: float = WARM_S) -> CalibratedSensor:
    """
    Draw load and biases, and calibrate.

    Each pose is a second of readings of weight, bias and noise. The physics is left out there: at rest it gives just
    these sums.

    Parameters
    ----------
    sensor : str
        A preset.
    calibrated_at : float
        s since the sensor was switched on; a cold one drifts afterwards.
    """
    rng = np.random.default_rng([seed, 1])
    loaded = LoadedSensor(draw_load(rng, _MASS_KG), sensor)
    model = SensorModel(loaded.settings, rng)
    poses = []
    for number, R_WS in enumerate(_orientations()):
        times = calibrated_at + _BETWEEN_S * number + np.arange(0.0, _POSE_S, 1 / RATE_HZ)
        read = model.read(times, np.tile(loaded.weight(R_WS), (len(times), 1))).wrenches
        mean, scatter = read.mean(axis=0), read.std(axis=0, ddof=1)
        poses.append(PoseSample(R_WS, mean[:3], mean[3:], len(read), scatter[:3], scatter[3:]))
    return CalibratedSensor(loaded.load, sensor, seed, calibration=calibrate(poses))


@cache
def _orientations() -> Floats:
    return plan_poses(POSES, by_hand()).R_WS


@cache
def foundation_of(probe: str) -> Foundation:
    """Return what is known of a bundled probe's press."""
    return Foundation(model_of(probe, FACETS))


def make_rig(
    scene: SceneName,
    probe: str,
    settings: ControlSettings,
    seed: int,
    *,
    method: str = "contactbench",
    tissue: Tissue | None = None,
    motion: PlatformMotion | None = None,
    gap: float = 0.003,
    coarse: bool = False,
) -> Rig:
    """
    Put one together.

    Parameters
    ----------
    probe : str
        One of assets.PROBE_NAMES.
    seed : int
        Of load, biases, calibration and noise: the calibration is made from readings, it is not the truth.
    gap : float
        m between probe and phantom at the beginning.
    coarse : bool
        Physics with a step of 2 ms and fewer places.

    Raises
    ------
    InputError
        Something needed is missing, such as MuJoCo or Embree.
    """
    bench = draw_sensor(seed)
    made = ArmScene if scene == "arm" else PlatformScene
    world = made(
        truth_of(probe),
        payload=Payload(bench.load.mass, bench.load.centre_of_mass_S),
        tissue=tissue or Tissue(friction=0.1),
        motion=motion,
        gap=gap,
        **(COARSE if coarse else {}),
    )
    model = model_of(probe, FACETS)
    noise = WrenchNoise(bench.settings.noise[:3], bench.settings.noise[3:])
    intake = SampleIntake(model, bench.calibration.model, noise, method=method, stale=settings.stale)
    mount = SensorMount(world.R_ES, world.p_ES_E)
    controller = Controller(settings, arm_of(world), model, intake, mount, world.start)
    return Rig(world, controller, SensorModel(bench.settings, np.random.default_rng([seed, 3])))
