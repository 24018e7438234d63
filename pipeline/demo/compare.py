"""How far each method is from the truth, and how near the noise lets it be."""

from dataclasses import dataclass
from math import sqrt
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from contactbench import assets
from contactbench.pipeline.calibration import Calibration
from contactbench.pipeline.calibration.files.compensate_file import compensate_file
from contactbench.pipeline.contact import Batch, ContactSolver, Reason, TouchModel, WrenchNoise
from contactbench.pipeline.contact.methods import METHODS, ContactMethod
from contactbench.pipeline.contact.stream import locate_file
from contactbench.pipeline.contact.wrench_csv import WrenchReader
from contactbench.pipeline.demo.tape import (
    RATE_HZ,
    STEP_S,
    WARM_S,
    DemoTape,
    DemoTool,
    write_marked,
    write_recording,
    write_truth,
    write_wrenches,
)
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.filtering import KalmanFilter
from contactbench.pipeline.mesh import Probe
from contactbench.pipeline.mesh.arrays import Floats
from contactbench.pipeline.recording.convert import write_csv as convert_to_csv
from contactbench.pipeline.simulation import Touches, draw_touches
from contactbench.pipeline.simulation.loads import orientations_in_use
from contactbench.pipeline.simulation.scenes.indenter import TouchScene, draw_press
from contactbench.pipeline.simulation.scenes.physics import SceneMoment, TrueSurface
from contactbench.pipeline.simulation.sensor_model import SensorModel
from contactbench.pipeline.simulation.virtual.markers import markers

ALL = "all"

# Enough solves for a median; the literal loop takes up to a millisecond each.
_TIMED = 400

OURS = "contactbench"
TILTS = (0.0, 30.0)  # degrees between the force and the inward normal

# The bound is what noise and calibration give a method that takes any torque for torsion: nothing else is added to it.
_BARE = TouchModel(torsion_arm=1000.0, model_error=WrenchNoise(0.0, 0.0), mesh_curved=False)


@dataclass(frozen=True)
class MethodErrors:
    """One method on the touches of one part of one probe."""

    method: str  # as in contactbench.pipeline.contact.methods
    where: str  # which touches: "all"; "face" and "head" where they were drawn; "0°" and "30°" on markers
    touches: int  # how many
    # mean_mm, p95_mm, max_mm: distance from the true point, mm, over the settled touches: those whose
    # answer is accepted. This and the next two are None where no touch is settled.
    mean_mm: float | None
    p95_mm: float | None
    max_mm: float | None
    # the noise bound: the root mean square error that noise and calibration alone give, mm; the root of the
    # mean trace of the covariance of the settled touches
    bound_mm: float | None
    # their root mean square error over the bound: 1 is as good as the noise allows
    over_bound: float | None
    answered: float  # share of the touches that got a point
    ambiguous: float  # share of the touches that got one with the warning that another is as likely
    median_us: float | None  # median time of a compiled solve, µs; None where there is none


def compare_methods(
    probe: Probe, noise: WrenchNoise, wrenches: Floats, points: Floats, where: NDArray[np.str_]
) -> tuple[list[MethodErrors], list[str]]:
    """Compare every method with the truth.

    Parameters
    ----------
    probe : Probe
        The mesh, S, metres.
    noise : WrenchNoise
        Of the wrenches, with what calibration leaves uncertain.
    wrenches : (n, 6)
        What is located, S, N and N·m.
    points : (n, 3)
        Where the touches truly were, S, m.
    where : (n,) of str
        The part that each touch is on, or how it was pressed.

    Returns
    -------
    errors : list of MethodErrors
        Per method: all touches, then part by part.
    notes : list of str
        A sentence for each method that is left out.
    """
    errors, notes = [], []
    for name, make in METHODS.items():
        try:
            method = make(probe, noise, None, None if name == OURS else _BARE)
        except InputError as error:
            notes.append(f"{name} is left out: {error}.")
            continue
        batch = method.locate_batch(wrenches)
        covariances = batch.covariances
        if name == OURS:
            bare = ContactSolver(probe, noise, model=_BARE)
            covariances = bare.foreign_batch(wrenches, batch.points, batch.faces, batch.torques).covariances
        median_us = _median_us(method, wrenches[:_TIMED])
        for part in (ALL, *np.unique(where).tolist()):
            rows = np.flatnonzero((where == part) | (part == ALL))
            errors.append(_errors(name, part, batch, covariances, points, rows, median_us))
    return errors, notes


def errors_mm(batch: Batch, points: Floats) -> Floats:
    """Distance from the true points (n, 3), mm, (n,); NaN without an answer."""
    return np.asarray(np.linalg.norm(batch.points - points, axis=1) * 1e3)


def _errors(
    method: str,
    where: str,
    batch: Batch,
    covariances: Floats,
    points: Floats,
    rows: NDArray[np.intp],
    median_us: float | None,
) -> MethodErrors:
    sure = rows[batch.accepted[rows]]
    return MethodErrors(
        method,
        where,
        len(rows),
        **_statistics(errors_mm(batch, points)[sure], covariances[sure]),
        answered=float(np.isfinite(batch.points[rows, 0]).mean()),
        ambiguous=float((batch.reasons[rows] == Reason.AMBIGUOUS).mean()),
        median_us=median_us,
    )


def _statistics(error_mm: Floats, covariances: Floats) -> dict[str, float | None]:
    if not len(error_mm):
        return dict.fromkeys(("mean_mm", "p95_mm", "max_mm", "bound_mm", "over_bound"))
    bound = 1e3 * sqrt(float(np.trace(covariances, axis1=1, axis2=2).mean()))
    rms = sqrt(float(np.mean(error_mm**2)))
    return {
        "mean_mm": float(error_mm.mean()),
        "p95_mm": float(np.percentile(error_mm, 95)),
        "max_mm": float(error_mm.max()),
        "bound_mm": bound,
        "over_bound": rms / bound,
    }


def _median_us(method: ContactMethod, wrenches: Floats) -> float | None:
    engine: Any = method.engine
    if not hasattr(engine, "time_each"):
        return None
    return float(np.median(engine.time_each(wrenches))) / 1e3


# ---- touches with a known truth: markers pressed on the virtual bench, and points drawn by formula ----


FACE, HEAD = "face", "head"

HELD_S = 0.5  # seven time constants of the filter
_PAUSE_S = 1.5

_FACE_SHARE = 0.7
# The face lies at most 12 mm below the tip (the convex one is curved), the head reaches 40 mm down.
_FACE_DEPTH, _HEAD_DEPTH = 0.012, 0.040
_FACING = 0.85  # cos 32°: the whole of the convex face, little of the rounding around a flat one


@dataclass(frozen=True, eq=False)
class Pressed:
    """Touches whose raw readings are in a folder's recording.csv, with the truth; one row each."""

    points: Floats  # (n, 3) True points, S, m
    where: NDArray[np.str_]  # (n,) str The part that each is on, or how it was pressed
    R_WS: Floats  # (n, 3, 3)
    # (n,) or None When the filter's answer counts, s; None where every reading is a touch
    times: Floats | None = None
    slipped: int = 0  # how many came to no rest and are left out


@dataclass(frozen=True, eq=False)
class LocatedTouches:
    """What locating made of touches."""

    noise: WrenchNoise  # of what was located: the sensor's, and what the calibration leaves uncertain
    wrenches: Floats  # (n, 6) what was located, S, N and N·m
    batch: Batch  # contactbench's answers


def press_markers(
    folder: Path,
    name: str,
    tool: DemoTool,
    truth: TrueSurface,
    rng: np.random.Generator,
    *,
    rests: bool = False,
) -> Pressed:
    """
    Press every marker of a probe, straight and at 30 degrees: touches.mcap, recording.csv and truth.csv.

    Each touch has 8 to 10 N in a direction around the normal that is drawn, and is recorded for half a second once the
    tip rests.

    Parameters
    ----------
    rests : bool
        Also record half a second of nothing before each touch and at the end, as somebody who records a bench does;
        otherwise a touch follows a gap.

    Raises
    ------
    InputError
        MuJoCo is missing, or a file cannot be written.
    """
    places = [(number, place, tilt) for number, place in enumerate(markers(name), 1) for tilt in TILTS]
    tape, rows, moments = DemoTape(), [], []
    for place, R_WS in zip(places, orientations_in_use(len(places), rng), strict=True):
        number, marker, tilt = place
        scene = TouchScene(truth, marker, payload=tool.payload, R_WS=R_WS)
        scene.press(draw_press(rng, tilt))
        if scene.settle() is None:
            continue
        if rests:
            tape.rest(tool.weight(R_WS[None])[0], R_WS, HELD_S)
        start = tape.end + (STEP_S if rests else _PAUSE_S) if tape.times else 0.0
        tape.run(scene, HELD_S, start)
        moments.append(scene.moment())
        rows.append((tape.end, number, tilt))
    if rests:
        tape.rest(tool.weight(R_WS[None])[0], R_WS, HELD_S)
    tape.write(folder / "touches.mcap", tool, rng)
    convert_to_csv(folder / "recording.csv", folder / "touches.mcap")
    write_marked(folder / "truth.csv", rows, moments)
    return _pressed(rows, moments, len(places) - len(rows))


def draw_points(folder: Path, name: str, count: int, tool: DemoTool, rng: np.random.Generator) -> Pressed:
    """
    Draw touches on the acoustic face, then anywhere on the head, by formula: recording.csv and truth.csv.

    Every reading is a touch of its own, in an orientation of its own.
    """
    surface = assets.surface(name)
    tip = float(assets.make(name, _TIP_FACETS)[0][:, 2].max())
    on_face = round(_FACE_SHARE * count)
    face = draw_touches(surface, on_face, rng, above=tip - _FACE_DEPTH, facing=_FACING)
    head = draw_touches(surface, count - on_face, rng, above=tip - _HEAD_DEPTH)
    fields = ("points", "normals", "torques", "angles", "wrenches")
    touches = Touches(*(np.concatenate([getattr(face, each), getattr(head, each)]) for each in fields))
    where = np.repeat([FACE, HEAD], [on_face, count - on_face])
    R_WS = orientations_in_use(count, rng)
    true = touches.wrenches + tool.weight(R_WS)
    read = SensorModel(tool.settings, rng).read(WARM_S + STEP_S * np.arange(count), true)
    write_recording(folder / "recording.csv", read.wrenches, tool.R_BW @ R_WS)
    write_truth(folder / "truth.csv", touches, where.tolist())
    return Pressed(touches.points, where, R_WS)


def locate_folder(
    folder: Path, probe: Probe, calibration: Calibration, tool: DemoTool, pressed: Pressed
) -> LocatedTouches:
    """
    Compensate recording.csv, filter it where touches are held, and locate: wrenches.csv and contacts.csv.

    Where touches are held, wrenches.csv has every reading, and touches.csv what the filter says at the end of each.
    """
    compensate_file(calibration, folder / "recording.csv", folder / "wrenches.csv")
    file, left = folder / "wrenches.csv", 1.0
    if pressed.times is not None:
        file, left = folder / "touches.csv", KalmanFilter(RATE_HZ).figures().noise_left
        _filter(folder / "wrenches.csv", file, pressed.times)
    noise = tool.noise(left)
    uncertain = calibration.model.wrench_covariance(tool.R_BW @ pressed.R_WS).mean(axis=0)
    whole = WrenchNoise(noise.force, noise.torque, extra=uncertain)
    solver = ContactSolver(probe, whole)
    locate_file(solver, file, folder / "contacts.csv")
    _, wrenches = read_wrenches(file)
    return LocatedTouches(whole, wrenches, solver.locate_batch(wrenches))


def read_wrenches(file: Path) -> tuple[Floats, Floats]:
    """Return times (n,), s, and wrenches (n, 6) of a file."""
    with file.open("rb") as stream:
        blocks = list(WrenchReader(stream, str(file)))
    times = np.array([float(t) for rows in blocks for t in rows.times])
    return times, np.concatenate([rows.wrenches for rows in blocks])


_TIP_FACETS = 2_000


def _pressed(rows: list[tuple[float, int, float]], moments: list[SceneMoment], slipped: int) -> Pressed:
    return Pressed(
        np.array([moment.point_S for moment in moments]),
        np.array([f"{tilt:g}°" for _, _, tilt in rows]),
        np.array([moment.R_WS for moment in moments]),
        np.array([time for time, _, _ in rows]),
        slipped,
    )


def _filter(source: Path, out: Path, times: Floats) -> None:
    """Filter wrenches as they would come live, and keep those at some times."""
    all_times, wrenches = read_wrenches(source)
    filtered = KalmanFilter(RATE_HZ).filter(wrenches, all_times)
    nearest = np.abs(all_times[:, None] - times).argmin(axis=0)
    write_wrenches(out, all_times[nearest], filtered[nearest])
