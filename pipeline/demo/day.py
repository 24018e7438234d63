"""
A whole day on a bench that is not ideal: calibrate, prepare, align, verify, export, run, and compare with the truth.

Presses are taken at rest, where physics gives just the sums that `RealBench` takes; everything from the recordings on
is what a user has: files, and the same steps.
"""

from __future__ import annotations

import shutil
from dataclasses import asdict, dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from contactbench import assets
from contactbench.pipeline.calibration import GravityModel
from contactbench.pipeline.calibration.files.calibration_file import creation_time
from contactbench.pipeline.calibration.files.capture_file import capture_poses
from contactbench.pipeline.calibration.files.pose_csv import write_poses
from contactbench.pipeline.calibration.model import two_stage
from contactbench.pipeline.calibration.poses import stack
from contactbench.pipeline.config.runtime import RuntimeConfig
from contactbench.pipeline.config.runtime.bench import export_from_files
from contactbench.pipeline.demo.gravity import calibrate_folder
from contactbench.pipeline.demo.housing import prepare_probe
from contactbench.pipeline.demo.tape import RATE_HZ, draw_tool, write_csv, write_tape
from contactbench.pipeline.demo.verification import BUNDLE, answers_of, export_settings, verify
from contactbench.pipeline.durable import make_folder, write_file
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.mesh.sidecar import load_probe_file, save_probe_file
from contactbench.pipeline.preparation.alignment import Advice, MarkerTouches, align_touches
from contactbench.pipeline.preparation.prepare import align_step
from contactbench.pipeline.simulation.loads import orientations_in_use
from contactbench.pipeline.simulation.marker_touches import check_bundled
from contactbench.pipeline.simulation.reality.bench import VERIFIED_S, MarkedPresses, RealBench, planned_poses
from contactbench.pipeline.simulation.scenes import TipPress
from contactbench.pipeline.simulation.scenes.indenter import draw_press
from contactbench.pipeline.simulation.virtual.markers import markers
from contactbench.pipeline.study.report import Figure, Sheet, StudyReport
from contactbench.pipeline.verification.causes import across, sensitivities
from contactbench.pipeline.verification.figures import ErrorCause

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence
    from pathlib import Path

    from contactbench.pipeline.calibration import Calibration
    from contactbench.pipeline.demo.tape import DemoTool
    from contactbench.pipeline.mesh.arrays import Floats
    from contactbench.pipeline.reality import Reality
    from contactbench.pipeline.simulation.loads import LoadedSensor
    from contactbench.pipeline.simulation.reality.bench import RealTape, RealTouch
    from contactbench.pipeline.verification import Verification
    from contactbench.pipeline.verification.figures import ModelError


_ALIGNED_S, _RUN_S = 5400.0, 10_800.0  # since the sensor was switched on; verified between them
_ALIGNING_DEG = 10.0
_RUN_TOUCHES = 60
_RUN_N, _RUN_DEG, _RUN_TORSION_M = (3.0, 15.0), 30.0, 0.0003
_HEAD_M, _LOWEST_NORMAL = 0.040, -0.3  # below the tip, and where a tip reaches
_FAR_MM = 5.0
_TYPICAL = "typical"


@dataclass(frozen=True)
class DayResult:
    """One day on one bench."""

    reality: str
    probe: str
    seed: int
    weighed: str  # the calibration's verdict
    weighing_cause: str  # what it says is behind its residuals
    contact_error_mm: float  # by the calibration alone, as it says
    aligned: bool  # whether the alignment by touches was taken
    verified: bool  # whether the verification passed
    marker_mean_mm: float | None  # as verification says it: from markers as they are told
    told_cause: str | None
    true_cause: str
    true_share: float  # that it has of the squared errors
    # what the model leaves, as an error of the contact, rms: as verification says, and as it is
    told_floor_mm: float | None
    true_floor_mm: float
    # errors of the answers that were sure, from the true points; touches that were run, and what became of them
    errors_mm: tuple[float, ...]
    touches: int
    far_unsaid: int  # sure answers that are far off, and by more than twice what they say

    @property
    def sure(self) -> float:
        """Share of the touches with an answer that is sure."""
        return len(self.errors_mm) / self.touches

    @property
    def named(self) -> bool:
        """Whether the cause that makes most of the errors was named first."""
        return self.told_cause == self.true_cause


def run_days(
    out: Path,
    realities: Sequence[Reality],
    probes: Sequence[str] = assets.PROBE_NAMES,
    seeds: int = 1,
    seed: int = 0,
    progress: Callable[[str], None] = lambda _: None,
    *,
    follow: bool = False,
) -> StudyReport:
    """
    Do a day's work on each bench, with each probe, with each seed.

    Writes a folder per bench, probe and seed: gravity.mcap, poses.csv, calibration.json, calibration.html; probe.ply,
    probe.json; touches.mcap, markers.csv, verification.json, the bundle runtime/, run.mcap and run.csv, which has the
    truth beside each answer. Beside them probes/ with what all days begin from, days.csv and days.md.

    Parameters
    ----------
    seeds, seed : int
        How many, and the first; at least 1 and 0.
    follow : bool
        Align, verify and run with a zero that follows.

    Raises
    ------
    InputError
        An argument is out of its range, or a file cannot be written.
    """
    if seeds < 1 or seed < 0:
        raise InputError(f"--seeds {seeds}, --seed {seed}: give at least one seed, from 0 on.")
    probes = check_bundled(probes)
    days = []
    for name in probes:
        progress(f"{name}: preparing the mesh")
        made = out / "probes" / name
        make_folder(made)
        prepare_probe(made, name)
        for reality in realities:
            for number in range(seed, seed + seeds):
                progress(f"{name}: a day on a {reality} bench, seed {number}")
                folder = out / str(reality).replace(",", "_") / name / str(number)
                make_folder(folder)
                days.append(_day(folder, made, name, reality, number, follow=follow))
    report = _report(days, seeds, seed)
    write_csv(out / "days.csv", _COLUMNS, [_row(day) for day in days])
    write_file(out / "days.md", report.markdown().encode())
    return report


def _day(
    folder: Path, made: Path, name: str, reality: Reality, seed: int, *, follow: bool = False
) -> DayResult:
    rng = np.random.default_rng([seed, assets.PROBE_NAMES.index(name), 4])
    tool = draw_tool(rng)
    bench = RealBench(name, reality, seed, tool, R_BW=tool.R_BW)
    planned = tool.R_BW.T @ planned_poses()
    _written(folder / "gravity.mcap", bench.weigh(planned))
    write_poses(folder / "poses.csv", capture_poses(folder / "gravity.mcap").poses)
    calibration, gravity = calibrate_folder(folder, tool.truth, ())
    bench.warm()
    bench.time = _ALIGNED_S
    T, aligned = _aligned(folder, made, name, bench, tool, calibration, rng, follow=follow)
    bench.time = VERIFIED_S
    pressed = MarkedPresses.drawn(name, rng)
    tape = bench.press(pressed.on(bench), pressed.R_WS)
    _written(folder / "touches.mcap", tape)
    found = verify(folder, markers(name) @ T[:3, :3].T + T[:3, 3], follow=follow)
    bench.time = _RUN_S
    errors, said = _run(folder, name, bench, tool, rng)
    noise = np.diag(tool.noise().covariance) / tape_length(tape)
    causes = true_causes(name, reality, seed, tool, planned, pressed, np.diag(noise), T)
    return _result(
        reality, name, seed, calibration, gravity.verdict, aligned, found, causes, tape, noise, errors, said
    )


def tape_length(tape: RealTape) -> int:
    """Return of how many readings the mean of a hold is."""
    hold = tape.holds[0]
    return int(hold.stop - hold.start)


def _written(file: Path, tape: RealTape) -> None:
    # A recording begins at its own zero; whole samples, as a device counts them.
    times = np.round((tape.times - tape.times[0]) * RATE_HZ) / RATE_HZ
    write_tape(file, times.tolist(), tape.readings, tape.told)


def _aligned(
    folder: Path,
    made: Path,
    name: str,
    bench: RealBench,
    tool: DemoTool,
    calibration: Calibration,
    rng: np.random.Generator,
    *,
    follow: bool,
) -> tuple[Floats, bool]:
    """Press every marker, and move the probe where that says, if it is believed; return T_SS' (4, 4)."""
    told = markers(name)
    presses = [draw_press(rng, _ALIGNING_DEG) for _ in told]
    tape = bench.press(
        [bench.marked(number, press) for number, press in enumerate(presses, 1)],
        orientations_in_use(len(told), rng),
    )
    content = load_probe_file(made / "probe.ply")
    touches = MarkerTouches(told, tape.compensated(calibration.model, follow=follow))
    left = 1 / np.sqrt(tape_length(tape))
    found = align_touches(content.probe, touches, np.eye(4), tool.noise(left))
    for file in ("housing.stl", "probe.json", "probe.ply"):
        shutil.copyfile(made / file, folder / file)
    if found.advice is not Advice.ADOPT:
        return np.eye(4), False
    save_probe_file(align_step(content, found.fitted, again=True), folder / "probe.ply")
    return np.asarray(found.fitted.T_SP), True


def _run(
    folder: Path, name: str, bench: RealBench, tool: DemoTool, rng: np.random.Generator
) -> tuple[Floats, Floats]:
    """Run new touches; return errors of sure answers, NaN for each other touch, and standard deviations told, mm."""
    exported = export_from_files(
        folder / "calibration.json", folder / "probe.ply", folder / "verification.json", None,
        export_settings(tool, folder / "probe.ply"), created=creation_time(), unverified=True,
    )  # fmt: skip
    exported.write(folder / BUNDLE)
    touches = [bench.anywhere(place, _press(rng)) for place in _places(name, rng)]
    tape = bench.press(touches, orientations_in_use(len(touches), rng))
    _written(folder / "run.mcap", tape)
    answers = answers_of(RuntimeConfig.load(folder / BUNDLE), folder / "run.mcap")
    rows, errors, said = [], [], []
    for touch, hold in zip(tape.touches, tape.holds, strict=True):
        answer = answers[hold.stop - 1]
        point = None if answer.contact is None else answer.contact.point
        sure = answer.contact is not None and answer.contact.accepted and point is not None
        off = np.nan if point is None else 1e3 * float(np.linalg.norm(point - touch.point))
        covariance = None if answer.contact is None else answer.contact.covariance
        sigma = np.nan if covariance is None else 1e3 * float(np.sqrt(np.trace(covariance)))
        errors.append(off if sure else np.nan)
        said.append(sigma)
        where = [None] * 3 if point is None else np.asarray(point).tolist()
        rows.append(
            (answer.time, touch.press.force, *touch.point.tolist(), *where, answer.reason, off, sigma)
        )
    columns = ("t", "force", "true_x", "true_y", "true_z", "x", "y", "z", "reason", "error_mm", "sigma_mm")
    write_csv(folder / "run.csv", columns, rows)
    return np.array(errors), np.array(said)


def _press(rng: np.random.Generator) -> TipPress:
    force = float(rng.uniform(*_RUN_N))
    torsion = float(_RUN_TORSION_M * force * rng.standard_normal())
    return TipPress(force, float(rng.uniform(0, _RUN_DEG)), float(rng.uniform(0, 360)), torsion)


def _places(name: str, rng: np.random.Generator) -> Floats:
    """Draw places anywhere on the head that a tip reaches, (n, 3), as the mesh is told."""
    surface = assets.surface(name)
    points, normals, *_ = surface.sample(50 * _RUN_TOUCHES, rng)
    head = (points[:, 2] > points[:, 2].max() - _HEAD_M) & (normals[:, 2] > _LOWEST_NORMAL)
    return np.asarray(points[head][:_RUN_TOUCHES])


def _result(
    reality: Reality, name: str, seed: int, calibration: Calibration, verdict: str, aligned: bool,
    found: Verification, causes: TrueCauses, tape: RealTape, noise: Floats, errors: Floats, said: Floats
) -> DayResult:  # fmt: skip
    left = tape.compensated(calibration.model, follow=bool(found.settings.get("follow")))
    off = true_floor(tape, left, np.diag(noise))
    told = None if found.model_error is None else 1e3 * told_floor(tape, found.model_error)
    return DayResult(
        reality=str(reality),
        probe=name,
        seed=seed,
        weighed=verdict,
        weighing_cause=calibration.causes[0].key if calibration.causes else "",
        contact_error_mm=1e3 * calibration.contact_error,
        aligned=aligned,
        verified=not found.verdict.reasons,
        marker_mean_mm=None if found.overall is None else found.overall.mean_mm,
        told_cause=None if found.diagnosis is None else str(found.diagnosis.first),
        true_cause=str(causes.first),
        true_share=causes.share,
        told_floor_mm=told,
        true_floor_mm=1e3 * off,
        errors_mm=tuple(errors[np.isfinite(errors)].tolist()),
        touches=len(errors),
        far_unsaid=int(((errors > _FAR_MM) & (errors > 2 * said)).sum()),
    )


# ---- the table -------------------------------------------------------------------------------------

_OF_RUN = ("touches", "sure", "mean_mm", "p95_mm", "max_mm", "far", "far_unsaid")
_COLUMNS = (
    *(name for name in DayResult.__dataclass_fields__ if name not in ("errors_mm", "touches", "far_unsaid")),
    *_OF_RUN,
)


def _row(day: DayResult) -> list[Any]:
    values = asdict(replace(day, errors_mm=()))
    fields = [values[name] for name in _COLUMNS[: -len(_OF_RUN)]]
    errors = np.array(day.errors_mm)
    far = int((errors > _FAR_MM).sum())
    return [*fields, day.touches, day.sure, *_sizes(errors), far, day.far_unsaid]


def _sizes(errors: Floats) -> tuple[float | None, float | None, float | None]:
    """Return mean, 95 of 100 and largest of errors (n,); where nothing was sure there are none."""
    if not len(errors):
        return None, None, None
    return float(errors.mean()), float(np.percentile(errors, 95)), float(errors.max())


def _report(days: list[DayResult], seeds: int, seed: int) -> StudyReport:
    figures: list[Figure] = []
    rows: list[tuple[str | float | None, ...]] = []
    for reality in dict.fromkeys(day.reality for day in days):
        mine = [day for day in days if day.reality == reality]
        figures += _figures(reality, mine)
        rows += [
            _summed([day for day in mine if day.probe == name])
            for name in dict.fromkeys(d.probe for d in mine)
        ]
    sheet = Sheet("days", "The day", _HEADINGS, tuple(rows))
    settings = {"seeds": seeds, "first seed": seed, "touches run": _RUN_TOUCHES}
    return StudyReport("A day on a real bench", settings, tuple(figures), _NOTES, (sheet,))


_NOTES = (
    "Errors against the true points, for confident answers to held-out touches; the spread is over days.",
    (
        "Sure: no other place explains the wrench equally well; the covariance of the answer"
        " states its accuracy."
    ),
    "Not said: off by more than twice the standard deviation stated by the covariance of the answer.",
    "Floor: what the wrenches are off beyond noise, as an error of the contact, rms; told by verification over true.",
)
_HEADINGS = (
    "bench", "probe", "days", "mean mm", "over days", "p95 mm", "max mm", "sure %", "sure, > 5 mm off %",
    "and did not say so %", "verified", "aligned", "mean at markers mm", "floor told mm", "floor true mm", "ratio",
    "mostly", "named first", "calibration says", "and adds mm",
)  # fmt: skip


def _figures(reality: str, days: list[DayResult]) -> list[Figure]:
    typical = reality == _TYPICAL
    means = np.array([np.mean(day.errors_mm) for day in days if day.errors_mm])
    errors = np.concatenate([day.errors_mm for day in days])
    far, touches = int((errors > _FAR_MM).sum()), sum(day.touches for day in days)
    unsaid = sum(day.far_unsaid for day in days)
    by_seed = [_ratio([d for d in days if d.seed == seed]) for seed in dict.fromkeys(d.seed for d in days)]
    mean = [
        Figure.of(reality, "mean error", means, "mm", measured=float(errors.mean()), most=0.6 if typical else None)
    ] if len(means) else []  # fmt: skip
    return [
        *mean,
        Figure.share(reality, "confident and more than 5 mm off", far, touches, most=0.2 if typical else None),
        Figure.share(reality, "the same, and by more than twice the stated sigma", unsaid, touches),
        Figure.of(reality, "floor, told over true, rms of all days", by_seed, measured=_ratio(days),
                  least=0.75 if typical else None, most=1.25 if typical else None),
    ]  # fmt: skip


def _ratio(days: list[DayResult]) -> float:
    return floor_ratio([day.told_floor_mm for day in days], [day.true_floor_mm for day in days])


def _summed(days: list[DayResult]) -> tuple[str | float | None, ...]:
    errors = np.concatenate([day.errors_mm for day in days])
    means = [float(np.mean(day.errors_mm)) for day in days if day.errors_mm]
    mean, p95, most = _sizes(errors)
    count = sum(day.touches for day in days)
    at_markers = [day.marker_mean_mm for day in days if day.marker_mean_mm is not None]
    told = [day.told_floor_mm for day in days if day.told_floor_mm is not None]
    return (
        days[0].reality,
        days[0].probe,
        len(days),
        mean,
        f"{min(means):.2f} to {max(means):.2f}" if means else None,
        p95,
        most,
        100 * len(errors) / count,
        100 * float((errors > _FAR_MM).sum()) / count,
        100 * sum(day.far_unsaid for day in days) / count,
        f"{sum(day.verified for day in days)} of {len(days)}",
        f"{sum(day.aligned for day in days)} of {len(days)}",
        float(np.mean(at_markers)) if at_markers else None,
        float(np.sqrt(np.mean(np.square(told)))) if told else None,
        float(np.sqrt(np.mean([day.true_floor_mm**2 for day in days]))),
        _ratio(days),
        _most([day.true_cause for day in days]),
        f"{sum(day.named for day in days)} of {len(days)}",
        _most([f"{day.weighed}, {day.weighing_cause}" for day in days]),
        float(np.mean([day.contact_error_mm for day in days])),
    )


def _most(words: list[str]) -> str:
    return max(dict.fromkeys(words), key=words.count)


# ---- what really makes the contacts of a real bench wrong, cause by cause ------------------------


_RATE_HZ = 20.0  # without noise a few readings tell all

# The effects that each cause names.
EFFECTS: dict[ErrorCause, tuple[str, ...]] = {
    ErrorCause.GRAVITY: ("cable", "drag", "warming"),
    ErrorCause.SENSOR: ("hysteresis", "hysteresis_of_load", "creep", "crosstalk", "hand"),
    ErrorCause.MOUNT: ("mount",),
    ErrorCause.ALIGNMENT: ("seat", "bend"),
    ErrorCause.MESH: ("lens", "scale"),
    ErrorCause.MARKERS: ("markers", "tip"),
    ErrorCause.TORSION: ("patch", "lean", "twist", "second"),
}


@dataclass(frozen=True)
class TrueCauses:
    """Mean squares of the errors that each cause alone makes on touches of markers, mm²."""

    squares: dict[ErrorCause, float]

    @property
    def first(self) -> ErrorCause:
        """The largest."""
        return max(self.squares, key=lambda cause: self.squares[cause])

    @property
    def share(self) -> float:
        """What the largest has of all."""
        return self.squares[self.first] / max(sum(self.squares.values()), 1e-12)


def true_causes(
    name: str,
    reality: Reality,
    seed: int,
    loaded: LoadedSensor,
    planned: Floats,
    pressed: MarkedPresses,
    noise: Floats,
    told: Floats | None = None,
) -> TrueCauses:
    """
    Repeat weighing and presses with the effects of one cause after the other, without noise.

    Parameters
    ----------
    planned : (k, 3, 3)
        R_WS of the poses to calibrate with.
    noise : (6, 6)
        Covariance of the mean wrench of a touch by the sensor's noise alone.
    told : (4, 4), optional
        Where an alignment has put the probe, against where it was said to sit.
    """
    squares = dict.fromkeys((*EFFECTS, ErrorCause.NOISE), 0.0)
    for cause, effects in EFFECTS.items():
        alone = reality.only(*effects)
        if not alone.on:
            continue
        bench = RealBench(name, alone, seed, loaded, rate=_RATE_HZ, noise=False)
        # Without noise there is nothing to weigh or to doubt: least squares do.
        theta = two_stage(stack(bench.weigh(planned).poses()))
        model = GravityModel.from_vector(theta, np.zeros((12, 12)))
        bench.warm()
        bench.time = VERIFIED_S
        tape = bench.press(pressed.on(bench), pressed.R_WS)
        places = markers(name)
        if told is not None and cause is ErrorCause.ALIGNMENT:
            places = places @ told[:3, :3].T + told[:3, 3]
        errors = along_surface(tape, tape.compensated(model), places[np.asarray(pressed.markers) - 1])
        squares[cause] = 1e6 * float((errors**2).sum(axis=1).mean())
    ideal = RealBench(name, type(reality)(), seed, loaded)
    J = _across(pressed.on(ideal))
    squares[ErrorCause.NOISE] = 1e6 * float(np.einsum("nij,jk,nik->n", J, noise, J).mean())
    return TrueCauses(squares)


def true_floor(tape: RealTape, wrenches: Floats, noise: Floats) -> float:
    """
    Return what the wrenches (n, 6) of touches are off beyond noise, as an error of the contact, rms, m.

    Parameters
    ----------
    wrenches : (n, 6)
        Compensated means.
    noise : (6, 6)
        Their covariance by the sensor's noise alone.
    """
    J = _across(tape.touches)
    off = wrenches - np.array([touch.contact for touch in tape.touches])
    square = (np.einsum("nij,nj->ni", J, off) ** 2).sum(axis=1).mean()
    return float(np.sqrt(max(square - np.einsum("nij,jk,nik->n", J, noise, J).mean(), 0.0)))


def floor_ratio(told: Sequence[float | None], true: Sequence[float]) -> float:
    """Return the told floors over the true ones, rms of all days with both; NaN where noise alone is to be found."""
    pairs = np.array([pair for pair in zip(told, true, strict=True) if pair[0] is not None], float).reshape(
        -1, 2
    )
    pairs = pairs[np.isfinite(pairs).all(axis=1)]
    if not pairs[:, 1].any():
        return float("nan")
    return float(np.sqrt(np.mean(pairs[:, 0] ** 2) / np.mean(pairs[:, 1] ** 2)))


def told_floor(tape: RealTape, found: ModelError) -> float:
    """Return what verification says of the same, as likely too large as too small, m."""
    sigma = np.repeat([found.likely_force_N, found.likely_torque_Nm], 3)
    return float(np.sqrt(((_across(tape.touches) * sigma) ** 2).sum(axis=(1, 2)).mean()))


def along_surface(tape: RealTape, wrenches: Floats, places: Floats) -> Floats:
    """Return how far wrenches (n, 6) of touches put their contacts from places (n, 3), along the surface, (n, 2), m."""
    F, M = wrenches[:, :3], wrenches[:, 3:]
    return np.asarray((_across(tape.touches)[:, :, 3:] @ (M - np.cross(places, F))[:, :, None])[:, :, 0])


def _across(touches: Sequence[RealTouch]) -> Floats:
    """Return (n, 2, 6) how contacts move along the surface with their wrenches, m/N and m/(N·m)."""
    points = np.array([touch.point for touch in touches])
    normals = np.array([touch.normal for touch in touches])
    forces = np.array([touch.contact[:3] for touch in touches])
    return across(normals) @ sensitivities(points, normals, forces)
