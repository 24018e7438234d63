"""The whole job on the virtual bench: weigh, prepare, touch, locate from files, and compare with the truth."""

from __future__ import annotations

from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import asdict, dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from contactbench import assets
from contactbench.pipeline.demo.compare import (
    ALL,
    OURS,
    LocatedTouches,
    MethodErrors,
    Pressed,
    compare_methods,
    draw_points,
    locate_folder,
    press_markers,
)
from contactbench.pipeline.demo.gravity import (
    GravityResult,
    calibrate_folder,
    weigh_by_formula,
    weigh_on_bench,
)
from contactbench.pipeline.demo.housing import MeshResult, prepare_probe
from contactbench.pipeline.demo.picture import LocatedProbe, draw
from contactbench.pipeline.demo.tape import DemoTool, draw_tool, write_csv
from contactbench.pipeline.demo.verification import CheckResult, check, clear
from contactbench.pipeline.durable import make_folder, write_file
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.mesh import Probe, load_probe
from contactbench.pipeline.mesh.engines import EngineError
from contactbench.pipeline.simulation.marker_touches import check_bundled
from contactbench.pipeline.simulation.scenes.physics import physics
from contactbench.pipeline.simulation.virtual.bench import bundled

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence
    from pathlib import Path

    from rich.table import Table

    from contactbench.pipeline.calibration import Calibration

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
    recording to truth for touches drawn by formula. Beside the folders: errors.csv, errors.md and
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
    picture = out / "contacts.png"
    write_file(picture, draw(located))
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
    job: _Job, prepared: Future[Prepared], touches: int, notes: list[str], progress: Callable[[str], None]
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


# ---- what the demo found: as data, as tables, and in sentences -----------------------------------


# Noise alone gives a mean error of 0.9 times the bound, and the facets add little; a wrong sign, frame or unit
# gives many times it. The mean, because one rare wrong facet would rule the root mean square of few touches.
LIMIT = 1.3
# Few touches with one calibration: its error is the same in all of them and does not average out.
TOUCHED_LIMIT = 1.5

MARKERS, DRAWN = "markers", "drawn"
_HEADINGS = ("mean", "p95", "max", "× bound", "answered", "ambiguous", "µs")


@dataclass(frozen=True)
class ProbeResult:
    """One probe."""

    probe: str  # its name
    # facets, region_facets: of the mesh, and of its contact region
    facets: int
    region_facets: int
    # every method on the markers of the virtual bench; empty without MuJoCo
    touched: tuple[MethodErrors, ...]
    drawn: tuple[MethodErrors, ...]  # every method on touches drawn by formula
    gravity: GravityResult  # how its gravity calibration did
    # how the preparation of its mesh did; None where it could not be done, and a note says why
    mesh: MeshResult | None
    checked: CheckResult | None  # its verification and bundle; None without MuJoCo

    @property
    def shown(self) -> tuple[MethodErrors, ...]:
        """What a newcomer should look at: touches of markers, or drawn ones where there is no physics."""
        return self.touched or self.drawn

    @property
    def verified(self) -> bool:
        """Whether mesh, gravity and bundle are right, and contactbench is as near to the truth as noise explains."""
        prepared = self.mesh is None or self.mesh.verified
        touched = not self.touched or within(ours(self.touched), TOUCHED_LIMIT)
        checked = self.checked is None or self.checked.verified
        return prepared and self.gravity.verified and touched and within(ours(self.drawn), LIMIT) and checked


@dataclass(frozen=True)
class DemoReport:
    """Everything that the demo found."""

    out: Path  # the folder with the files
    # touches, seed: drawn touches per probe, and the seed of chance
    touches: int
    seed: int
    # force_noise, torque_noise: standard deviations of one reading of the simulated sensor, N and N·m
    force_noise: float
    torque_noise: float
    probes: tuple[ProbeResult, ...]
    picture: Path
    notes: tuple[str, ...]  # what was left out, and how to get it

    @property
    def verified(self) -> bool:
        """Whether every probe is verified."""
        return all(result.verified for result in self.probes)

    def to_json(self) -> dict[str, Any]:
        """Return plain data for ``--json``."""
        data = asdict(self)
        for entry, result in zip(data["probes"], self.probes, strict=True):
            entry["verified"] = result.verified
            entry["gravity"]["verified"] = result.gravity.verified
            if result.mesh is not None:
                entry["mesh"]["verified"] = result.mesh.verified
            if result.checked is not None:
                entry["checked"]["verified"] = result.checked.verified
        return {
            **data,
            "out": str(self.out),
            "picture": str(self.picture),
            "notes": list(self.notes),
            "limit": LIMIT,
            "verified": self.verified,
        }

    def table(self) -> Table:
        """Return the table for the terminal: every method over all touches of each probe."""
        from rich.table import Table

        table = Table(box=None, pad_edge=False, caption=_CAPTION, caption_justify="left")
        for heading in ("probe", "method"):
            table.add_column(heading, no_wrap=True)
        for heading in _HEADINGS:
            table.add_column(heading, justify="right")
        for result in self.probes:
            rows = [row for row in result.shown if row.where == ALL]
            for row in rows:
                first = result.probe if row is rows[0] else ""
                style = "bold" if row.method == OURS else ""
                table.add_row(first, row.method, *_cells(row), style=style, end_section=row is rows[-1])
        return table

    def csv_rows(self) -> tuple[tuple[str, ...], list[tuple[object, ...]]]:
        """Return columns and rows of errors.csv; times are left out, because they differ from run to run."""
        names = ("method", "where", "touches", "mean_mm", "p95_mm", "max_mm", "bound_mm", "over_bound")
        shares = ("answered", "ambiguous")
        rows = [
            (result.probe, kind, *(getattr(row, name) for name in (*names, *shares)))
            for result in self.probes
            for kind, row in _rows(result)
        ]
        return ("probe", "kind", *names, *shares), rows

    def markdown(self) -> str:
        """Return the content of errors.md."""
        headings = ("probe", "touches", "method", *_HEADINGS)
        lines = ["# Errors against the known truth", "", *(f"{line}  " for line in self.sentences()[:-1]), ""]
        lines += [_line(headings), _line(["---"] * 3 + ["---:"] * len(_HEADINGS))]
        for result in self.probes:
            for kind, row in _rows(result):
                touches = f"{row.touches:,} {kind}, {row.where}"
                lines.append(_line((result.probe, touches, row.method, *_cells(row))))
        return "\n".join([*lines, "", _CAPTION, ""])

    def sentences(self) -> list[str]:
        """Return what was done and found, for people."""
        return [
            self._done(),
            *(result.mesh.sentence(result.probe) for result in self.probes if result.mesh is not None),
            *(result.gravity.sentence(result.probe) for result in self.probes),
            *map(_verdict, self.probes),
            *(result.checked.sentence(result.probe) for result in self.probes if result.checked is not None),
            *self.notes,
            f"The files are in {self.out}.",
        ]

    def _done(self) -> str:
        names = ", ".join(result.probe for result in self.probes)
        noise = f"a sensor noise of {self.force_noise:g} N and {self.torque_noise:g} N·m"
        drawn = f"{self.touches:,} points drawn on its head"
        if not all(result.touched for result in self.probes):
            return (
                f"On each probe ({names}), with {noise}: located {drawn}, each from one reading of 8 to 10 N."
            )
        return (
            f"On the virtual bench, with each probe ({names}) and {noise}: weighed the tool, pressed every marker"
            f" with 8 to 10 N, straight and at 30 degrees, filtered half a second of readings and located it; verified"
            f" that, and ran the same readings through the bundle that a robot would load; then located {drawn}, each"
            f" from one reading."
        )


def ours(errors: Sequence[MethodErrors]) -> MethodErrors:
    """Return how contactbench did over all touches."""
    return next(row for row in errors if (row.method, row.where) == (OURS, ALL))


def within(row: MethodErrors, limit: float) -> bool:
    """Tell whether the mean error is at most `limit` times the noise bound."""
    return row.mean_mm is not None and row.bound_mm is not None and row.mean_mm <= limit * row.bound_mm


_CAPTION = (
    "mean, p95 and max are errors in mm, of touches answered without doubt. × bound is their root mean square"
    " over what noise and calibration would give. Only contactbench ever says ambiguous; iterative"
    " knows the contact face only. µs is the median time of one compiled solve."
)


def _rows(result: ProbeResult) -> list[tuple[str, MethodErrors]]:
    return [*((MARKERS, row) for row in result.touched), *((DRAWN, row) for row in result.drawn)]


def _verdict(result: ProbeResult) -> str:
    parts = [(ours(result.drawn), "drawn touches", LIMIT)]
    if result.touched:
        parts.insert(0, (ours(result.touched), "touches of markers", TOUCHED_LIMIT))
    return f"{result.probe}: {'; '.join(_found(*part) for part in parts)}."


def _found(row: MethodErrors, what: str, limit: float) -> str:
    if row.mean_mm is None or row.over_bound is None:
        return f"FAILED, not one of {row.touches:,} {what} was located without doubt"
    found = f"mean error {row.mean_mm:.2f} mm over {row.touches:,} {what}, {row.over_bound:.2f} times the noise bound"
    if within(row, limit):
        return found
    return f"{found}, FAILED: even the mean is more than {limit:g} times the {row.bound_mm:.2f} mm of noise"


def _cells(row: MethodErrors) -> list[str]:
    lengths = [_number(value) for value in (row.mean_mm, row.p95_mm, row.max_mm, row.over_bound)]
    shares = [f"{100 * share:.1f} %" for share in (row.answered, row.ambiguous)]
    return [*lengths, *shares, _number(row.median_us)]


def _number(value: float | None) -> str:
    return "-" if value is None else f"{value:.2f}"


def _line(cells: tuple[str, ...] | list[str]) -> str:
    return "| " + " | ".join(cells) + " |"
