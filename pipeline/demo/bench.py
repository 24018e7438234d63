"""Simulate touches of the bundled probes, locate them from files, and compare with the truth."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

import assets
from pipeline.contact import ContactSolver, WrenchNoise
from pipeline.contact.stream import locate_file
from pipeline.contact.wrench_csv import WrenchReader
from pipeline.demo.compare import FACE, HEAD, compare_methods
from pipeline.demo.files import write_bytes, write_csv, write_truth
from pipeline.demo.gravity import GravityResult, weigh_and_compensate
from pipeline.demo.housing import FACETS, MeshResult, prepare_probe
from pipeline.demo.picture import Located, PictureError, draw
from pipeline.demo.report import DemoReport, ProbeResult
from pipeline.durable import make_folder
from pipeline.errors import InputError
from pipeline.mesh import Probe, load_probe
from pipeline.mesh.engines import EngineError
from pipeline.simulation import Touches, draw_touches

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence
    from pathlib import Path

    from numpy.typing import NDArray

    from pipeline.contact import Batch

FEWEST_TOUCHES = 10

_FACE_SHARE = 0.7
# The face lies at most 12 mm below the tip (the convex one is curved), the head reaches 40 mm down.
_FACE_DEPTH, _HEAD_DEPTH = 0.012, 0.040
_FACING = 0.85  # cos 32°: the whole of the convex face, little of the rounding around a flat one


@dataclass(frozen=True, eq=False)
class _Bench:
    """The files of one probe and what they hold."""

    name: str
    probe: Probe
    truth: Touches
    where: NDArray[np.str_]
    mesh: MeshResult | None
    gravity: GravityResult
    noise: WrenchNoise
    wrenches: NDArray[np.float64]
    batch: Batch
    note: str | None


def run(
    out: Path,
    probes: Sequence[str] = assets.PROBE_NAMES,
    touches: int = 1_000,
    seed: int = 0,
    progress: Callable[[str], None] = lambda _: None,
) -> DemoReport:
    """Do the main job on bundled probes, and check it against the known truth.

    Writes housing.stl, probe.ply, probe.json, poses.csv, calibration.json, calibration.html, recording.csv,
    wrenches.csv, truth.csv and contacts.csv in a folder per probe, and errors.csv, errors.md and, if it can be
    drawn, contacts.png. Files that are there are replaced, each in one step.

    Parameters
    ----------
    out : Path
        The folder to write in; made if need be.
    probes : sequence of str
        Which of assets.PROBE_NAMES.
    touches : int
        Per probe, at least 10: seven tenths on the acoustic face, the rest anywhere on the head.
    seed : int
        Of chance, at least 0. The same seed gives the same bytes in every CSV file, and a probe the same
        touches whichever others are asked for.
    progress : callable, optional
        Told what is being done, in a few words.

    Returns
    -------
    DemoReport

    Raises
    ------
    InputError
        An argument is out of its range, or a file cannot be written.
    """
    names = _checked(probes, touches, seed)
    make_folder(out)
    noise = WrenchNoise()
    results, located, notes = [], [], []
    for name in names:
        progress(
            f"{name}: preparing the mesh, calibrating gravity, simulating and locating {touches:,} touches"
        )
        bench = _simulate(out / name, name, touches, seed, noise)
        progress(f"{name}: comparing the methods")
        errors, left_out = compare_methods(bench.probe, bench.noise, bench.wrenches, bench.truth, bench.where)
        region = int(np.count_nonzero(bench.probe.region))
        result = ProbeResult(name, len(bench.probe.faces), region, tuple(errors), bench.gravity, bench.mesh)
        results.append(result)
        located.append(Located(name, bench.batch, bench.truth.points, result.ours.mean_mm))
        told = left_out if bench.note is None else (bench.note, *left_out)
        notes += [sentence for sentence in told if sentence not in notes]
    progress("drawing the picture")
    picture = _draw(out / "contacts.png", located, notes)
    sigmas = np.sqrt(np.diagonal(noise.covariance)).tolist()
    report = DemoReport(out, touches, seed, sigmas[0], sigmas[3], tuple(results), picture, tuple(notes))
    write_csv(out / "errors.csv", *report.csv_rows())
    write_bytes(out / "errors.md", report.markdown().encode())
    return report


def _draw(file: Path, located: Sequence[Located], notes: list[str]) -> Path | None:
    try:
        write_bytes(file, draw(located))
    except PictureError as error:
        file.unlink(missing_ok=True)  # an older one would not show these contacts
        notes.append(f"There is no picture: {error}")
        return None
    return file


def _checked(probes: Sequence[str], touches: int, seed: int) -> list[str]:
    names = list(dict.fromkeys(probes))
    unknown = [name for name in names if name not in assets.PROBE_NAMES]
    if unknown or not names:
        raise InputError(
            f"there is no probe {', '.join(unknown)!r}: choose one of {', '.join(assets.PROBE_NAMES)}."
        )
    if touches < FEWEST_TOUCHES:
        raise InputError(f"{touches} touches say nothing about an error: ask for at least {FEWEST_TOUCHES}.")
    if seed < 0:
        raise InputError(f"the seed must be at least 0, not {seed}.")
    return names


def _simulate(folder: Path, name: str, count: int, seed: int, noise: WrenchNoise) -> _Bench:
    """Write the files of one probe, and locate its touches as ``contactbench locate`` would."""
    make_folder(folder)
    mesh, note = _prepared(folder, name)
    rng = np.random.default_rng([seed, assets.PROBE_NAMES.index(name)])
    tip = float(assets.make(name, FACETS)[0][:, 2].max())
    truth, where = _touches(name, tip, count, rng)
    write_truth(folder / "truth.csv", truth, where.tolist())
    gravity, left = weigh_and_compensate(folder, truth.wrenches, noise, rng)
    probe = load_probe(folder / "probe.ply", units="m", name=name)
    whole = WrenchNoise(noise.force, noise.torque, extra=left)
    solver = ContactSolver(probe, whole)
    locate_file(solver, folder / "wrenches.csv", folder / "contacts.csv")
    wrenches = _read_wrenches(folder / "wrenches.csv")
    batch = solver.locate_batch(wrenches)
    return _Bench(name, probe, truth, where, mesh, gravity, whole, wrenches, batch, note)


def _prepared(folder: Path, name: str) -> tuple[MeshResult | None, str | None]:
    """Prepare the probe's mesh; without pymeshlab the design stands in, and a note says so."""
    try:
        return prepare_probe(folder, name), None
    except EngineError as error:
        return None, f"The probes' meshes were not prepared, their designs were used: {error}"


def _touches(name: str, tip: float, count: int, rng: np.random.Generator) -> tuple[Touches, NDArray[np.str_]]:
    """Draw touches on the acoustic face, then anywhere on the head; `tip` is the largest z, m."""
    surface = assets.surface(name)
    on_face = round(_FACE_SHARE * count)
    face = draw_touches(surface, on_face, rng, above=tip - _FACE_DEPTH, facing=_FACING)
    head = draw_touches(surface, count - on_face, rng, above=tip - _HEAD_DEPTH)
    fields = ("points", "normals", "torques", "angles", "wrenches")
    both = [np.concatenate([getattr(face, field), getattr(head, field)]) for field in fields]
    return Touches(*both), np.repeat([FACE, HEAD], [on_face, count - on_face])


def _read_wrenches(file: Path) -> NDArray[np.float64]:
    with file.open("rb") as stream:
        return np.concatenate([rows.wrenches for rows in WrenchReader(stream, str(file))])
