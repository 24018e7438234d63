"""The contacts behind a heatmap: from what `contactbench locate` wrote, or located in a recording, sample by sample."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from contactbench.pipeline.contact import ContactSolver, Gates, WrenchNoise
from contactbench.pipeline.contact.contact_csv import HEADER, REASONS
from contactbench.pipeline.contact.wrench_csv import WrenchReader
from contactbench.pipeline.errors import arg, message
from contactbench.pipeline.files import File, Progress, unheard
from contactbench.pipeline.heatmap.heatmap import HeatmapError
from contactbench.pipeline.tables import TableReader, Wording

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from numpy.typing import ArrayLike, NDArray

    from contactbench.pipeline.calibration import GravityModel
    from contactbench.pipeline.mesh import Probe
    from contactbench.pipeline.recording.reader import FlangeTrack, WrenchTrack
    from contactbench.pipeline.verification.figures import TouchFigure, Verification

_BESIDE = 0.1  # s before and after a sample in which its force must be the same
_CHANGE = 0.05  # of the force, between the one and the other
_LAG = 0.025  # s: samples further apart are independent, also behind a filter
_FEWEST_DIFFERENCES = 30  # differences that a noise is measured from
_ORIENTATIONS = 64  # over which a calibration's uncertainty is averaged
_MAD = 0.6744897501960817  # of a normal distribution of SD 1
_LEAST = 1e-3  # of the usual noise: a channel without any would count for all the others
# At these the point is surely where the wrench says.
USED = ("ok", "vertex", "by_region")
_WORTH_SAYING = 0.1  # of the contacts: a larger share that could be elsewhere, or is not near, is told
_REMEDIES = {
    "ambiguous": message("mark the touched region, and locate them again"),
    "uncertain": message("press harder, or allow a larger sigma"),
}
_LONGEST_STEPS = 5.0  # medians: a contact does not last through a gap in the recording
_BLOCK_ROWS = 65_536

_CONTACTS = Wording(
    header=HEADER.decode().strip(),
    rows="contacts",
    meaning=message("m, in the sensor frame S"),
    text="a reason",
    error=HeatmapError,
)
_POINTS = Wording(
    header="x_mm,y_mm,z_mm", rows="points", meaning=message("mm, in the sensor frame S"), error=HeatmapError
)


@dataclass(frozen=True, eq=False)
class Contacts:
    """Contacts as arrays; n of them."""

    points: NDArray[np.float64]  # (n, 3) S, m
    # (n,) how long each stands for: until the next sample, at most five usual steps
    seconds: NDArray[np.float64]
    sigmas: NDArray[np.float64]  # (n,) largest standard deviation of each point, m; NaN: unknown
    forces: NDArray[np.float64] | None  # (n,) or None |F|, N; None: unknown
    duration: float  # of the whole recording, s
    left_out: dict[str, int]  # samples without a contact, by reason
    notes: tuple[str, ...] = ()  # sentences
    counted: str = "samples"  # what one of them is
    # (n,) or None Distance to the marker that was touched, m; None: not known by itself
    known_errors: NDArray[np.float64] | None = None
    settled: NDArray[np.bool_] | None = None  # (n,) or None Where the force was steady; None: not known
    # of a sample, with what the calibration leaves uncertain; None: the contacts came with theirs
    noise: WrenchNoise | None = None
    # (n,) or None s since the recording's first sample, or the start of the first touch; None: not known
    times: NDArray[np.float64] | None = None
    # (n,) or None How sure each place is, 0 to 1; None: not known
    confidences: NDArray[np.float64] | None = None

    @property
    def moments(self) -> NDArray[np.float64]:
        """The times (n,), s; all 0 where they are not known."""
        return np.zeros(len(self.points)) if self.times is None else self.times

    @property
    def onset(self) -> float:
        """When the probe was touched first, s on the contacts' own clock: what two of them are aligned by."""
        if self.counted == "touches":  # their clock begins with the first, and a touch stands at its end
            return 0.0
        return float(self.moments.min()) if len(self.points) else 0.0

    def errors(self, truth: ArrayLike, most: float) -> tuple[NDArray[np.float64], NDArray[np.bool_]]:
        """Return the distance (n,) to the nearest of true points (k, 3), m, and which (n,) are within `most`."""
        from scipy.spatial import cKDTree

        distance, _ = cKDTree(np.asarray(truth, dtype=np.float64)).query(self.points)
        return np.asarray(distance), np.asarray(distance <= most)


def read_contacts(file: File, wrenches: Path | None = None) -> Contacts:
    """
    Read a file of contacts.

    Parameters
    ----------
    file : path
        CSV as ``contactbench locate`` writes it.
    wrenches : path, optional
        The CSV file that the contacts were located from, for the forces: row by row the same.

    Raises
    ------
    HeatmapError
        A file cannot be used, or the two do not belong together.
    """
    columns = ("t", "x", "y", "z", "sigma_max_mm")
    try:
        with file.open("rb") as stream:
            table = TableReader(stream, str(file), _CONTACTS)
            table.select(
                columns, optional=("confidence",), text="reason", allow_nan=(*columns[1:], "confidence")
            )
            blocks = [(rows.numbers, rows.text) for rows in table]
    except (OSError, ValueError) as error:
        raise _unread(file, error) from error
    numbers = np.concatenate([each for each, _ in blocks])
    reasons = np.concatenate([text for _, text in blocks if text is not None])
    known = np.isin(reasons, np.array(REASONS, dtype=np.bytes_))
    if not known.all():
        row = int(np.argmin(known))
        raise HeatmapError(
            f"{arg(file)}: row {arg(row + 1)}: {arg(reasons[row].decode())!r} is not a reason: give a file"
            " written by `contactbench locate`."
        )
    forces = None if wrenches is None else _forces(wrenches, len(numbers), file)
    # Files from before contacts had a confidence have no such column.
    confidences = numbers[:, 5] if table.columns[5:] else None
    if confidences is not None:
        _check_confidences(file, confidences, _used(reasons, numbers[:, 1:4]))
    return _contacts(numbers[:, 0], numbers[:, 1:4], reasons, 1e-3 * numbers[:, 4], forces, confidences, ())


def _check_confidences(file: File, confidences: NDArray[np.float64], used: NDArray[np.bool_]) -> None:
    bad = used & ~((confidences >= 0) & (confidences <= 1))
    if bad.any():
        row = int(np.argmax(bad))
        raise HeatmapError(
            f"{arg(file)}: row {arg(row + 1)}: the confidence is {arg(confidences[row]):g}, not between 0"
            " and 1: locate the contacts again."
        )


def read_points(file: Path) -> NDArray[np.float64]:
    """Return points (k, 3), S, m, of a CSV file with x_mm, y_mm, z_mm: markers, for instance; HeatmapError."""
    try:
        with file.open("rb") as stream:
            table = TableReader(stream, str(file), _POINTS)
            table.select(("x_mm", "y_mm", "z_mm"))
            return 1e-3 * np.concatenate([rows.numbers for rows in table])
    except (OSError, ValueError) as error:
        raise _unread(file, error) from error


def touches_of(verification: Verification) -> Contacts:
    """
    Return a verification's accepted touches, with their distances to the marker; `left_out` counts the others.

    Raises
    ------
    HeatmapError
        No touch was accepted.
    """
    used = [t for t in verification.touches if t.accepted and t.point_mm and t.distance_mm is not None]
    if not used:
        raise HeatmapError("the verification has no accepted touch: see its reasons, and touch again.")
    starts = np.array([t.start_s for t in verification.touches])
    ends = np.array([t.time_s for t in verification.touches])
    return Contacts(
        points=1e-3 * np.array([t.point_mm for t in used], dtype=np.float64),
        seconds=np.array([max(t.time_s - t.start_s, 0.0) for t in used]),
        sigmas=1e-3 * np.array([np.nan if t.predicted_mm is None else t.predicted_mm for t in used]),
        forces=np.array([t.force_N for t in used]),
        duration=float(ends.max() - starts.min()),
        left_out=dict(verification.rejected),
        counted="touches",
        times=np.array([t.time_s for t in used]) - float(starts.min()),
        known_errors=1e-3 * np.array([t.distance_mm for t in used], dtype=np.float64),
        confidences=_confidences(used),
    )


def _confidences(touches: list[TouchFigure]) -> NDArray[np.float64] | None:
    sure = [touch.confidence for touch in touches if touch.confidence is not None]
    return np.array(sure) if len(sure) == len(touches) else None  # a verification of before does not say it


def locate_recording(
    file: File,
    probe: Probe,
    model: GravityModel,
    *,
    gates: Gates | None = None,
    R_ES: ArrayLike | None = None,
    delay: float = 0.0,
    progress: Progress = unheard,
) -> Contacts:
    """
    Compensate and locate the wrenches of a recording of one sensor and one robot; it shows a sample's noise itself.

    What the calibration leaves uncertain is added to that noise.

    Parameters
    ----------
    probe : Probe
        In S.
    R_ES : (3, 3), optional
        Orientation of the sensor in the flange.
    delay : float
        How much later a wrench is heard than its pose, s.
    progress : callable, optional
        Gets the bytes read so far, and those in the file.

    Raises
    ------
    InputError
        The recording cannot be used.
    """
    from contactbench.pipeline.recording import read_recording

    recording = read_recording(file, progress)
    track, poses = recording.pair(file)
    parts = list(_compensated(track, poses, model, R_ES, delay))
    if not parts:
        raise HeatmapError(f"{arg(file)}: no reading has a pose: record the robot throughout.")
    times, wrenches, R_WS = (np.concatenate(column) for column in zip(*parts, strict=True))
    said, count = [*recording.warnings], len(track.times)
    del recording, track, poses, parts  # nothing is held twice while contacts are located
    if lost := count - len(times):
        said.append(message(f"{arg(lost):,} readings left out: flagged as bad, or without a pose."))
    own = measured_noise(times, wrenches)
    if own is None:
        said.append(message("The recording does not show its noise, so a typical sensor noise is assumed."))
    total = with_calibration(own or WrenchNoise(), model, R_WS)
    solver = ContactSolver(probe, total, gates)
    found = [
        solver.locate_batch(wrenches[row : row + _BLOCK_ROWS], threads=0)
        for row in range(0, len(times), _BLOCK_ROWS)
    ]
    columns = ((each.points, each.reasons, each.sigma_max, each.confidences) for each in found)
    points, reasons, sigmas, confidences = (np.concatenate(column) for column in zip(*columns, strict=True))
    names = np.array(REASONS, dtype=np.bytes_)[reasons]
    forces = np.linalg.norm(wrenches[:, :3], axis=1)
    return replace(_contacts(times, points, names, sigmas, forces, confidences, tuple(said)), noise=total)


def _compensated(
    track: WrenchTrack, poses: FlangeTrack, model: GravityModel, R_ES: ArrayLike | None, delay: float
) -> Iterator[tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]]:
    """Yield times, wrenches without weight and bias, and orientations of the readings that are good and have a pose."""
    from contactbench.pipeline.calibration.files.pose_csv import sensor_orientations
    from contactbench.pipeline.calibration.orientation import Convention
    from contactbench.pipeline.recording.convert import poses_at

    for begin in range(0, len(track.times), _BLOCK_ROWS):
        rows = slice(begin, begin + _BLOCK_ROWS)
        quaternions, there = poses_at(poses, track.times[rows] - delay)
        kept = there & track.usable[rows]
        if not kept.any():
            continue
        R_WS = sensor_orientations(quaternions[kept, :4], Convention(), R_ES)
        wrenches = np.ascontiguousarray(model.compensate(R_WS, track.wrenches[rows][kept]))
        yield track.times[rows][kept], wrenches, R_WS


def _contacts(
    times: NDArray[np.float64],
    points: NDArray[np.float64],
    reasons: NDArray[np.bytes_],
    sigmas: NDArray[np.float64],
    forces: NDArray[np.float64] | None,
    confidences: NDArray[np.float64] | None,
    notes: tuple[str, ...],
) -> Contacts:
    used = _used(reasons, points)
    names, counts = np.unique(reasons[~used], return_counts=True)
    for reason, remedy in _REMEDIES.items():
        doubtful = int(counts[names == reason.encode()].sum())
        if doubtful > _WORTH_SAYING * (doubtful + used.sum()):
            said = message(
                f"{arg(doubtful):,} of {arg(doubtful + used.sum()):,} contacts are {arg(reason)} and not in the map:"
                f" {arg(remedy)}."
            )
            notes = (*notes, said)
    usual = usual_step(times)
    seconds = np.clip(np.append(np.diff(times), usual), 0.0, _LONGEST_STEPS * usual)
    return Contacts(
        points[used],
        seconds[used],
        sigmas[used],
        None if forces is None else forces[used],
        float(np.ptp(times)) + usual,
        {name.decode(): int(count) for name, count in zip(names, counts, strict=True)},
        notes,
        settled=None if forces is None else settled(times, forces)[used],
        times=times[used] - times[0],
        confidences=None if confidences is None else confidences[used],
    )


def _used(reasons: NDArray[np.bytes_], points: NDArray[np.float64]) -> NDArray[np.bool_]:
    return np.isin(reasons, np.array(USED, dtype=np.bytes_)) & np.isfinite(points).all(axis=1)


def _forces(file: Path, count: int, contacts: File) -> NDArray[np.float64]:
    try:
        with file.open("rb") as stream:
            parts = [
                np.linalg.norm(rows.wrenches[:, :3], axis=1)
                for rows in WrenchReader(stream, str(file), allow_nan=True)
            ]
    except (OSError, ValueError) as error:
        raise _unread(file, error) from error
    forces = np.concatenate(parts)
    if len(forces) != count:
        raise HeatmapError(
            f"{arg(file)} has {arg(len(forces)):,} rows, {arg(contacts)} {arg(count):,}: give the wrenches"
            " that these contacts were located from."
        )
    return forces


def _unread(file: File, error: Exception) -> Exception:
    if isinstance(error, HeatmapError) or not isinstance(error, OSError):
        return error
    return HeatmapError(f"{arg(file)}: the file cannot be read ({arg(error)}): check the path.")


def settled(times: NDArray[np.float64], forces: NDArray[np.float64]) -> NDArray[np.bool_]:
    """
    Tell at which samples the force is steady: the means over 0.1 s before and after differ by 5 % at most.

    Parameters
    ----------
    times : (n,) float64
        Increasing, s.
    forces : (n,) float64
        |F|, N; NaN is not steady.

    Returns
    -------
    (n,) bool
        False beside a gap, and at the ends.
    """
    steady = np.zeros(len(times), dtype=bool)
    step = usual_step(times)
    half = max(1, round(_BESIDE / step)) if step > 0 else len(times)
    if len(times) <= 2 * half:
        return steady
    sums = np.concatenate([[0.0], np.cumsum(np.nan_to_num(forces))])
    at = np.arange(half, len(times) - half)
    before = (sums[at] - sums[at - half]) / half
    after = (sums[at + half + 1] - sums[at + 1]) / half
    whole = times[at + half] - times[at - half] <= 3 * half * step
    steady[at] = whole & (np.abs(after - before) <= _CHANGE * np.minimum(before, after)) & (forces[at] > 0)
    return steady


def usual_step(times: NDArray[np.float64]) -> float:
    """Return the median time between samples, s; 0: there is none."""
    steps = np.diff(times)
    return float(np.median(steps[steps > 0])) if (steps > 0).any() else 0.0


def measured_noise(times: NDArray[np.float64], wrenches: NDArray[np.float64]) -> WrenchNoise | None:
    """
    Return the noise of a sample of compensated wrenches (n, 6), N and N·m; None: it cannot be told.

    It is taken from second differences over 25 ms, so that what rises evenly is no noise, and from their median, so
    that touching and letting go are none.
    """
    step = usual_step(times)
    lag = max(1, round(_LAG / step)) if step > 0 else len(times)
    if len(times) < 2 * lag + _FEWEST_DIFFERENCES:
        return None
    there = times[2 * lag :] - times[: -2 * lag] <= 3 * lag * step
    curved = (wrenches[2 * lag :] - 2 * wrenches[lag:-lag] + wrenches[: -2 * lag])[there]
    if len(curved) < _FEWEST_DIFFERENCES:
        return None
    sigma = np.median(np.abs(curved), axis=0) / (_MAD * np.sqrt(6.0))
    usual = np.sqrt(np.diag(WrenchNoise().covariance))
    if (sigma <= _LEAST * usual).all():  # made up, or rounded off
        return None
    sigma = np.maximum(sigma, _LEAST * usual)
    return WrenchNoise(sigma[:3], sigma[3:])


def with_calibration(noise: WrenchNoise, model: GravityModel, R_WS: NDArray[np.float64]) -> WrenchNoise:
    """Return a noise with what the calibration leaves uncertain, averaged over orientations (n, 3, 3)."""
    chosen = R_WS[np.linspace(0, len(R_WS) - 1, min(len(R_WS), _ORIENTATIONS)).astype(np.intp)]
    extra = np.mean(model.wrench_covariance(chosen), axis=0)
    if noise.extra is not None:
        extra = extra + np.asarray(noise.extra)
    return WrenchNoise(noise.force, noise.torque, extra=0.5 * (extra + extra.T))
