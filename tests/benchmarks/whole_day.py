"""
A whole day on a bench that is not ideal: calibrate, prepare, align, verify, export, run, and compare with the truth.

Presses are taken at rest, where physics gives just the sums that `RealBench` takes; everything from the recordings on
is what a user has: files, and the same steps. Each held-out touch is located by the day's bundle, with the gate of
nearness and without it.
"""

import shutil
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
from benchmarks.real_bench import VERIFIED_S, MarkedPresses, RealBench, RealTape

from contactbench import assets
from contactbench.pipeline.calibration import Calibration
from contactbench.pipeline.calibration.files.calibration_file import creation_time
from contactbench.pipeline.calibration.files.capture_file import capture_poses
from contactbench.pipeline.calibration.files.pose_csv import write_poses
from contactbench.pipeline.config.runtime import RuntimeConfig
from contactbench.pipeline.config.runtime.bench import export_from_files
from contactbench.pipeline.demo.gravity import calibrate_folder, planned_poses
from contactbench.pipeline.demo.housing import prepare_probe
from contactbench.pipeline.demo.tape import RATE_HZ, DemoTool, draw_tool, write_tape
from contactbench.pipeline.demo.verification import BUNDLE, answers_of, export_settings, verify
from contactbench.pipeline.durable import make_folder
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.mesh.arrays import Floats
from contactbench.pipeline.mesh.sidecar import load_probe_file, save_probe_file
from contactbench.pipeline.preparation.alignment.touches.align import Advice, align_touches
from contactbench.pipeline.preparation.alignment.touches.fit import MarkerTouches
from contactbench.pipeline.preparation.prepare import align_step
from contactbench.pipeline.reality import Reality
from contactbench.pipeline.simulation.loads import orientations_in_use
from contactbench.pipeline.simulation.marker_touches import check_bundled
from contactbench.pipeline.simulation.scenes.indenter import TipPress, draw_press
from contactbench.pipeline.simulation.virtual.markers import markers
from contactbench.pipeline.study.report import Figure, Sheet, StudyReport

_ALIGNED_S, _RUN_S = 5400.0, 10_800.0  # since the sensor was switched on; verified between them
_ALIGNING_DEG = 10.0
_RUN_TOUCHES = 60
_RUN_N, _RUN_DEG, _RUN_TORSION_M = (3.0, 15.0), 30.0, 0.0003
_HEAD_M, _LOWEST_NORMAL = 0.040, -0.3  # below the tip, and where a tip reaches
_FAR_MM = 5.0
# Targets by bench: mean error, mm; accepted and far, and kept of what is accepted without the gate, per cent.
_MEAN_MM, _FAR_SHARE, _KEPT = (
    {"typical": 0.6},
    {"typical": 0.1, "harsh": 0.5},
    {"typical": 90.0, "ideal": 96.0},
)


@dataclass(frozen=True, eq=False)
class DayResult:
    """One day on one bench."""

    reality: str
    probe: str
    seed: int
    weighed: str  # the calibration's verdict
    contact_error_mm: float  # by the calibration alone, as it says
    aligned: bool  # whether the alignment by touches was taken
    verified: bool  # whether the verification passed
    marker_mean_mm: float  # as verification says it: from markers as they are told; NaN: none was located
    # (n,) errors of the accepted answers from the true points, NaN for each other touch: with the gate of nearness
    # and without it; and the standard deviation that each answer states, mm
    errors: Floats
    ungated: Floats
    said: Floats


def run(
    reality: str = "typical",
    probes: Sequence[str] = assets.PROBE_NAMES,
    *,
    seeds: int = 1,
    seed: int = 0,
    follow: bool = False,
    folder: Path | None = None,
    progress: Callable[[str], None] = lambda _: None,
) -> StudyReport:
    """
    Do a day's work on a bench with each probe, with each seed.

    Writes a folder per probe and seed: gravity.mcap, poses.csv, calibration.json, calibration.html; probe.ply,
    probe.json; touches.mcap, markers.csv, verification.json, the bundle runtime/ and run.mcap. Beside them probes/
    with what all days begin from.

    Parameters
    ----------
    reality : str
        As `Reality.parse` reads it.
    seeds, seed : int
        How many, and the first; at least 1 and 0.
    follow : bool
        Align, verify and run with a zero that follows.
    folder : Path, optional
        Where the files are kept.
    """
    bench = Reality.parse(reality)
    if seeds < 1 or seed < 0:
        raise InputError(f"{seeds} seeds, seed {seed}: give at least one seed, from 0 on.")
    days = []
    with TemporaryDirectory() as scratch:
        for name in check_bundled(probes):
            progress(f"{name}: preparing the mesh")
            made = (folder or Path(scratch)) / "probes" / name
            make_folder(made)
            prepare_probe(made, name)
            for number in range(seed, seed + seeds):
                progress(f"{name}: a day on a {bench} bench, seed {number}")
                mine = made.parents[1] / name / str(number)
                make_folder(mine)
                days.append(_day(mine, made, name, bench, number, follow=follow))
    settings = {"seeds": seeds, "first seed": seed, "touches run": _RUN_TOUCHES}
    rows = [
        _summed([day for day in days if day.probe == name]) for name in dict.fromkeys(d.probe for d in days)
    ]
    sheet = Sheet("days", "The day", _HEADINGS, tuple(rows))
    return StudyReport("A day on a real bench", settings, tuple(_figures(str(bench), days)), _NOTES, (sheet,))


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
    _written(folder / "touches.mcap", bench.press(pressed.on(bench), pressed.R_WS))
    found = verify(folder, markers(name) @ T[:3, :3].T + T[:3, 3], follow=follow)
    bench.time = _RUN_S
    mean = np.nan if found.overall is None else found.overall.mean_mm
    how = gravity.verdict, 1e3 * calibration.contact_error, aligned, not found.verdict.reasons
    return DayResult(str(reality), name, seed, *how, mean, *_run(folder, name, bench, tool, rng))


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
    hold = tape.holds[0]
    noise = tool.noise((hold.stop - hold.start) ** -0.5)
    found = align_touches(content.probe, touches, np.eye(4), noise)
    for file in ("housing.stl", "probe.json", "probe.ply"):
        shutil.copyfile(made / file, folder / file)
    if found.advice is not Advice.ADOPT:
        return np.eye(4), False
    save_probe_file(align_step(content, found.fitted, again=True), folder / "probe.ply")
    return np.asarray(found.fitted.T_SP), True


def _run(folder: Path, name: str, bench: RealBench, tool: DemoTool, rng: np.random.Generator) -> list[Floats]:
    """Run new touches; errors of accepted answers, NaN for each other touch, the same without the gate, and sigmas."""
    exported = export_from_files(
        folder / "calibration.json", folder / "probe.ply", folder / "verification.json", None,
        export_settings(tool, folder / "probe.ply"), created=creation_time(), unverified=True,
    )  # fmt: skip
    exported.write(folder / BUNDLE)
    touches = [bench.anywhere(place, _press(rng)) for place in _places(name, rng)]
    tape = bench.press(touches, orientations_in_use(len(touches), rng))
    _written(folder / "run.mcap", tape)
    config = RuntimeConfig.load(folder / BUNDLE)
    open_gates = config.model.gates.model_copy(update={"sigma_max_m": 0.0})
    ungated = replace(config, model=config.model.model_copy(update={"gates": open_gates}))
    (errors, said), (before, _) = (_errors(each, folder / "run.mcap", tape) for each in (config, ungated))
    return [errors, before, said]


def _errors(config: RuntimeConfig, recording: Path, tape: RealTape) -> tuple[Floats, Floats]:
    """Return errors (n,) of accepted answers at the end of each press, else NaN, and the sigmas they state, mm."""
    answers = answers_of(config, recording)
    errors, said = np.full((2, len(tape.touches)), np.nan)
    for i, (touch, hold) in enumerate(zip(tape.touches, tape.holds, strict=True)):
        contact = answers[hold.stop - 1].contact
        if contact is not None and contact.accepted and contact.point is not None:
            errors[i] = 1e3 * np.linalg.norm(contact.point - touch.point)
            said[i] = 1e3 * np.sqrt(np.trace(contact.covariance))
    return errors, said


def _press(rng: np.random.Generator) -> TipPress:
    force = float(rng.uniform(*_RUN_N))
    torsion = float(_RUN_TORSION_M * force * rng.standard_normal())
    return TipPress(force, float(rng.uniform(0, _RUN_DEG)), float(rng.uniform(0, 360)), torsion)


def _places(name: str, rng: np.random.Generator) -> Floats:
    """Draw places anywhere on the head that a tip reaches, (n, 3), as the mesh is told."""
    points, normals, *_ = assets.surface(name).sample(50 * _RUN_TOUCHES, rng)
    head = (points[:, 2] > points[:, 2].max() - _HEAD_M) & (normals[:, 2] > _LOWEST_NORMAL)
    return np.asarray(points[head][:_RUN_TOUCHES])


# ---- the table -------------------------------------------------------------------------------------


_NOTES = (
    "Errors against the true points, for accepted answers to held-out touches; the spread is over days.",
    "Not said: off by more than twice the standard deviation stated by the covariance of the answer.",
    "Kept: of the answers that are accepted without the gate of nearness.",
)
_HEADINGS = (
    "bench", "probe", "days", "mean mm", "over days", "p95 mm", "max mm", "sure %", "sure, > 5 mm off %",
    "and did not say so %", "without the gate: sure %", "> 5 mm off %", "verified", "aligned", "mean at markers mm",
    "calibration says", "and adds mm",
)  # fmt: skip


def _together(days: list[DayResult]) -> Iterator[Floats]:
    return (np.concatenate([getattr(day, name) for day in days]) for name in ("errors", "ungated", "said"))


def _figures(bench: str, days: list[DayResult]) -> Iterator[Figure]:
    errors, ungated, said = _together(days)
    sure, before = (max(int(np.isfinite(each).sum()), 1) for each in (errors, ungated))
    if np.isfinite(errors).any():
        means = [float(np.nanmean(day.errors)) for day in days if np.isfinite(day.errors).any()]
        mean = float(np.nanmean(errors))
        yield Figure.of(bench, "mean error", means, "mm", measured=mean, most=_MEAN_MM.get(bench))
    far = errors > _FAR_MM
    unsaid = int((far & (errors > 2 * said)).sum())
    yield Figure.share(bench, "near and more than 5 mm off", int(far.sum()), sure, most=_FAR_SHARE.get(bench))
    yield Figure.share(bench, "the same, and by more than twice the stated sigma", unsaid, sure)
    yield Figure.share(bench, "sure and more than 5 mm off", int((ungated > _FAR_MM).sum()), before)
    yield Figure.share(bench, "kept", int(np.isfinite(errors).sum()), before, least=_KEPT.get(bench))


def _summed(days: list[DayResult]) -> tuple[str | float | None, ...]:
    errors, ungated, said = _together(days)
    means = [float(np.nanmean(day.errors)) for day in days if np.isfinite(day.errors).any()]
    known = errors[np.isfinite(errors)]
    weighed = [day.weighed for day in days]
    return (
        days[0].reality,
        days[0].probe,
        len(days),
        float(known.mean()) if means else None,
        f"{min(means):.2f} to {max(means):.2f}" if means else None,
        float(np.percentile(known, 95)) if means else None,
        float(known.max()) if means else None,
        100 * len(known) / len(errors),
        100 * float(np.mean(errors > _FAR_MM)),
        100 * float(np.mean((errors > _FAR_MM) & (errors > 2 * said))),
        100 * float(np.isfinite(ungated).mean()),
        100 * float(np.mean(ungated > _FAR_MM)),
        f"{sum(day.verified for day in days)} of {len(days)}",
        f"{sum(day.aligned for day in days)} of {len(days)}",
        float(np.nanmean([day.marker_mean_mm for day in days])),
        max(dict.fromkeys(weighed), key=weighed.count),
        float(np.mean([day.contact_error_mm for day in days])),
    )
