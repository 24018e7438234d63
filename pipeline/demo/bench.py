"""The whole job on the virtual bench: weigh, prepare, touch, locate from files, and compare with the truth."""

from __future__ import annotations

from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from contactbench import assets
from contactbench.pipeline.demo.compare import compare_methods
from contactbench.pipeline.demo.files import write_csv
from contactbench.pipeline.demo.gravity import calibrate_folder, weigh_by_formula, weigh_on_bench
from contactbench.pipeline.demo.housing import MeshResult, prepare_probe
from contactbench.pipeline.demo.picture import LocatedProbe, PictureError, draw
from contactbench.pipeline.demo.report import DemoReport, ProbeResult, ours
from contactbench.pipeline.demo.tool import draw_tool
from contactbench.pipeline.demo.touches import draw_points, locate_folder, press_markers
from contactbench.pipeline.demo.verification import check, clear
from contactbench.pipeline.durable import make_folder, write_file
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.mesh import load_probe
from contactbench.pipeline.mesh.engines import EngineError
from contactbench.pipeline.simulation.marker_touches import check_bundled
from contactbench.pipeline.simulation.scenes.physics import physics
from contactbench.pipeline.simulation.virtual.bench import bundled

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence
    from pathlib import Path

    from contactbench.pipeline.calibration import Calibration
    from contactbench.pipeline.demo.compare import MethodErrors
    from contactbench.pipeline.demo.gravity import GravityResult
    from contactbench.pipeline.demo.tool import DemoTool
    from contactbench.pipeline.demo.touches import LocatedTouches, Pressed
    from contactbench.pipeline.mesh import Probe

    Prepared = tuple[MeshResult | None, str | None]

FEWEST_TOUCHES = 10

_ON_BENCH = ("gravity.mcap", "touches.mcap", "recording.csv", "wrenches.csv", "touches.csv", "truth.csv")
_DRAWN = "drawn"


@dataclass(frozen=True, eq=False)
class _Job:
    """One probe: where its files are, what hangs on the sensor, and how it was weighed."""

    name: str
    folder: Path
    seed: int
    tool: DemoTool
    calibration: Calibration
    gravity: GravityResult
    pressed: Pressed | None

    def chance(self, step: int) -> np.random.Generator:
        return _chance(self.seed, self.name, step)


def run(
    out: Path,
    probes: Sequence[str] = assets.PROBE_NAMES,
    touches: int = 1_000,
    seed: int = 0,
    progress: Callable[[str], None] = lambda _: None,
) -> DemoReport:
    """
    Do the whole job on bundled probes, and check it against the known truth.

    Writes in a folder per probe: housing.stl, probe.ply, probe.json; gravity.mcap, poses.csv, calibration.json,
    calibration.html; touches.mcap, recording.csv, wrenches.csv, touches.csv, contacts.csv, truth.csv; markers.csv,
    verification.json, report.html, the bundle runtime/ and contacts.jsonl, see `checking.check`; and in drawn/
    recording to truth for touches drawn by formula. Beside the folders: errors.csv, errors.md and, if it can be drawn,
    contacts.png. Files that are there are replaced, each in one step. Without MuJoCo poses and touches are drawn
    only, nothing is verified or exported, and a note says so.

    Parameters
    ----------
    out : Path
        The folder to write in; made if need be.
    probes : sequence of str
        Which of assets.PROBE_NAMES.
    touches : int
        Drawn per probe, at least 10: seven tenths on the acoustic face, the rest anywhere on the head.
    seed : int
        Of chance, at least 0. The same seed gives the same bytes in every CSV and MCAP file, and a probe the same
        touches whichever others are asked for.
    progress : callable, optional
        Told what is being done, in a few words.

    Raises
    ------
    InputError
        An argument is out of its range, or a file cannot be written.
    """
    names = _checked(probes, touches, seed)
    make_folder(out)
    notes: list[str] = []
    bench = _has_bench(notes)
    results, located = [], []
    # Preparing waits for programs of its own most of the time: meanwhile the bench can work.
    with ThreadPoolExecutor(1) as pool:
        meshes = {name: pool.submit(_prepared, out / name, name) for name in names}
        try:
            for name in names:
                job = _weigh_and_press(out / name, name, seed, bench, progress)
                result, seen = _locate(job, meshes[name], touches, notes, progress)
                results.append(result)
                located.append(seen)
        finally:
            pool.shutdown(cancel_futures=True)
    progress("drawing the picture")
    picture = _draw(out / "contacts.png", located, notes)
    sigmas = job.tool.settings.noise.tolist()
    report = DemoReport(out, touches, seed, sigmas[0], sigmas[3], tuple(results), picture, tuple(notes))
    write_csv(out / "errors.csv", *report.csv_rows())
    write_file(out / "errors.md", report.markdown().encode())
    return report


def _has_bench(notes: list[str]) -> bool:
    """Tell whether there is physics; a note says what is done without."""
    try:
        physics()
    except InputError as error:
        notes.append(
            "No marker was pressed, so there is no verification and no bundle; poses and touches"
            f" were computed by formula: {error}."
        )
        return False
    return True


def _chance(seed: int, name: str, step: int) -> np.random.Generator:
    """Return the chance of one step: what one step draws is the same whatever the others do."""
    return np.random.default_rng([seed, assets.PROBE_NAMES.index(name), step])


def _weigh_and_press(
    folder: Path, name: str, seed: int, bench: bool, progress: Callable[[str], None]
) -> _Job:
    make_folder(folder)
    tool = draw_tool(_chance(seed, name, 0))
    pressed: Pressed | None = None
    if bench:
        truth = bundled(name)
        progress(f"{name}: weighing the tool on the virtual bench")
        bumped = weigh_on_bench(folder, tool, truth, _chance(seed, name, 1))
    else:
        for file in _ON_BENCH:  # of another run: they would not belong to this one
            (folder / file).unlink(missing_ok=True)
        clear(folder)
        bumped = weigh_by_formula(folder, tool, _chance(seed, name, 1))
    calibration, gravity = calibrate_folder(folder, tool.truth, bumped)
    if bench:
        progress(f"{name}: pressing the markers")
        pressed = press_markers(folder, name, tool, truth, _chance(seed, name, 2))
    return _Job(name, folder, seed, tool, calibration, gravity, pressed)


def _locate(
    job: _Job,
    prepared: Future[Prepared],
    touches: int,
    notes: list[str],
    progress: Callable[[str], None],
) -> tuple[ProbeResult, LocatedProbe]:
    """Locate the touches as ``contactbench locate`` would, and compare all methods."""
    progress(f"{job.name}: preparing the mesh")
    mesh, note = prepared.result()
    probe = load_probe(job.folder / "probe.ply", units="m", name=job.name)
    said = [] if note is None else [note]
    checked = None
    if job.pressed is not None:
        progress(f"{job.name}: verifying the touches, and running them through the bundle")
        checked = check(job.folder, job.name, job.tool)
    progress(f"{job.name}: locating and comparing the methods, {touches:,} drawn touches too")
    touched: tuple[MethodErrors, ...] = ()
    if job.pressed is not None:
        touched, found = _compare(job, probe, job.folder, job.pressed, said)
        if job.pressed.slipped:
            said.append(
                f"{job.name}: the tip slipped off in {job.pressed.slipped} touches; these are left out."
            )
    make_folder(job.folder / _DRAWN)
    points = draw_points(job.folder / _DRAWN, job.name, touches, job.tool, job.chance(3))
    drawn, found_drawn = _compare(job, probe, job.folder / _DRAWN, points, said)
    notes += [sentence for sentence in dict.fromkeys(said) if sentence not in notes]
    region = int(np.count_nonzero(probe.region))
    result = ProbeResult(job.name, len(probe.faces), region, touched, drawn, job.gravity, mesh, checked)
    if job.pressed is None:
        return result, LocatedProbe(job.name, found_drawn.batch, points.points, ours(drawn).mean_mm)
    return result, LocatedProbe(job.name, found.batch, job.pressed.points, ours(touched).mean_mm)


def _compare(
    job: _Job, probe: Probe, folder: Path, pressed: Pressed, said: list[str]
) -> tuple[tuple[MethodErrors, ...], LocatedTouches]:
    found = locate_folder(folder, probe, job.calibration, job.tool, pressed)
    errors, left_out = compare_methods(probe, found.noise, found.wrenches, pressed.points, pressed.where)
    said += left_out
    return tuple(errors), found


def _draw(file: Path, located: Sequence[LocatedProbe], notes: list[str]) -> Path | None:
    try:
        write_file(file, draw(located))
    except PictureError as error:
        file.unlink(missing_ok=True)  # an older one would not show these contacts
        notes.append(f"No picture was made: {error}")
        return None
    return file


def _checked(probes: Sequence[str], touches: int, seed: int) -> list[str]:
    names = check_bundled(probes)
    if touches < FEWEST_TOUCHES:
        raise InputError(f"{touches} touches are too few to judge an error: give at least {FEWEST_TOUCHES}.")
    if seed < 0:
        raise InputError(f"the seed must be at least 0, not {seed}.")
    return names


def _prepared(folder: Path, name: str) -> Prepared:
    """Prepare the probe's mesh; without pymeshlab the design stands in, and a note says so."""
    make_folder(folder)
    try:
        return prepare_probe(folder, name), None
    except EngineError as error:
        return None, f"The probes' meshes were not prepared, so their designs were used: {error}"
