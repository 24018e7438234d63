"""Marked points on a probe, the table that holds them, and which of them a touch belongs to."""

import csv
import io
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike, NDArray

from contactbench.pipeline.calibration import GravityModel
from contactbench.pipeline.calibration.suggest import contact_sensitivity
from contactbench.pipeline.contact import ContactSolver, Reason, TouchModel, WrenchNoise
from contactbench.pipeline.durable import write_file
from contactbench.pipeline.errors import InputError, arg, message
from contactbench.pipeline.files import File, read_bytes
from contactbench.pipeline.kernel import Contact, SurfaceIndex
from contactbench.pipeline.mesh import Probe

_ALLOWED = 0.002  # m: what alignment and mesh may be off without another marker being nearer
_RIVAL = 1.0  # standard deviations by which a second marker must be further away
_FAR = 6.0  # standard deviations from the nearest marker
_SHORTEST, _MOST_LAGS = 24, 200  # samples of a run that tells anything about correlation
_CHANCE = 0.1  # autocorrelation that means nothing
_MUCH_TORSION = TouchModel(torsion_arm=0.01)  # ten times what is usual
COLUMNS = ("name", "x_mm", "y_mm", "z_mm")
MOST_MARKERS = 10_000
OFF_PROBE = 0.005  # m: further away it is a marker of something else, or in another frame
_MOST_BYTES = 4 << 20
_FARTHEST_MM = 1e6
_LONGEST_NAME = 100


class MarkerError(InputError):
    """A marker, or a file of markers, that cannot be used."""


@dataclass(frozen=True, eq=False)
class Marker:
    """
    A point that is touched on purpose.

    Attributes
    ----------
    name : str
    point_S : (3,)
        m.
    normal_S : (3,)
        Outward, of length 1; NaN: not known before it is snapped to a probe.
    """

    name: str
    point_S: NDArray[np.float64]
    normal_S: NDArray[np.float64]

    def __post_init__(self) -> None:
        check_name(self.name)
        point, normal = (np.array(each, dtype=np.float64) for each in (self.point_S, self.normal_S))
        if point.shape != (3,) or not np.isfinite(point).all():
            raise MarkerError(
                f"marker {arg(self.name)}: give three finite coordinates, not {arg(point.tolist())}."
            )
        if normal.shape != (3,):
            raise MarkerError(
                f"marker {arg(self.name)}: the normal needs three numbers, not {arg(normal.tolist())}."
            )
        for name, value in (("point_S", point), ("normal_S", normal)):
            value.flags.writeable = False
            object.__setattr__(self, name, value)


@dataclass(frozen=True, eq=False)
class MarkerSet:
    """
    The markers of one probe; at least one, every name once.

    Raises
    ------
    MarkerError
        There is none, or a name is taken twice.
    """

    markers: tuple[Marker, ...]

    def __post_init__(self) -> None:
        if not self.markers:
            raise MarkerError("there are no markers: give at least one.")
        seen: set[str] = set()
        for marker in self.markers:
            if marker.name in seen:
                raise MarkerError(f"marker {arg(marker.name)} appears twice: give each marker its own name.")
            seen.add(marker.name)

    def __len__(self) -> int:
        return len(self.markers)

    def __iter__(self) -> Iterator[Marker]:
        return iter(self.markers)

    def __getitem__(self, place: int) -> Marker:
        return self.markers[place]

    @property
    def names(self) -> tuple[str, ...]:
        """The names, in order."""
        return tuple(marker.name for marker in self.markers)

    @cached_property
    def points(self) -> NDArray[np.float64]:
        """(n, 3) S, m."""
        return np.array([marker.point_S for marker in self.markers])

    @cached_property
    def normals(self) -> NDArray[np.float64]:
        """(n, 3) S, outward."""
        return np.array([marker.normal_S for marker in self.markers])

    def to_bytes(self) -> bytes:
        """Return the table, UTF-8: name, then millimetres in S to the nanometre."""
        text = io.StringIO()
        table = csv.writer(text, lineterminator="\n")
        table.writerow(COLUMNS)
        for marker in self.markers:
            table.writerow([marker.name, *(f"{1e3 * value:.6f}" for value in marker.point_S)])
        return text.getvalue().encode()

    def save(self, file: Path) -> None:
        """
        Write the table in one step.

        Raises
        ------
        MarkerError
            It cannot be written.
        """
        write_file(file, self.to_bytes(), MarkerError, message("the markers cannot be written"))


@dataclass(frozen=True, eq=False)
class Snapped:
    """Markers on a probe's surface."""

    markers: MarkerSet  # Moved to the nearest point of the surface, with the normals there
    distances: NDArray[np.float64]  # (n,) how far each was from it, m


def check_name(name: str) -> None:
    """
    Refuse a name that a table or a report could not show.

    Raises
    ------
    MarkerError
        It is empty, too long, or holds what cannot be printed.
    """
    if not name or name != name.strip() or len(name) > _LONGEST_NAME or not name.isprintable():
        raise MarkerError(
            f"marker name {arg(name[:_LONGEST_NAME])!r}: give 1 to {arg(_LONGEST_NAME)} printable characters"
            " without spaces at the ends."
        )


def make_markers(points_S: ArrayLike, names: Sequence[str] | None = None) -> MarkerSet:
    """
    Return markers at points (n, 3), S, m, called M1, M2, ... unless names are given; normals are not known yet.

    Raises
    ------
    MarkerError
        A name or a point cannot be used.
    """
    points = np.asarray(points_S, dtype=np.float64)
    if points.ndim != 2 or points.shape[1] != 3:
        raise MarkerError(f"markers: give points of shape (n, 3), not {arg(points.shape)}.")
    called = [f"M{number}" for number in range(1, len(points) + 1)] if names is None else list(names)
    if len(called) != len(points):
        raise MarkerError(
            f"markers: {arg(len(called))} names for {arg(len(points))} points: give one for each."
        )
    unknown = np.full(3, np.nan)
    return MarkerSet(tuple(Marker(*each, unknown) for each in zip(called, points, strict=True)))


def snap(markers: MarkerSet, probe: Probe, limit: float = OFF_PROBE) -> Snapped:
    """
    Move markers to the nearest points of a probe's surface.

    Parameters
    ----------
    markers : MarkerSet
    probe : Probe
    limit : float
        Further away, m, a marker is not on the probe.

    Raises
    ------
    MarkerError
        A marker is off the probe; all of these are named.
    """
    index = SurfaceIndex(probe.vertices, probe.faces)
    distances, faces, feet = index.closest(np.ascontiguousarray(markers.points))
    off = [
        f"{marker.name} ({1e3 * distance:.1f} mm)"
        for marker, distance in zip(markers, distances, strict=True)
        if distance > limit
    ]
    if off:
        more = message(f" and {arg(len(off) - 5)} more") if len(off) > 5 else ""
        raise MarkerError(
            f"markers off the probe's surface: {arg(', '.join(off[:5]))}{arg(more)}; {arg(1e3 * limit):g} mm are"
            " allowed. Check that they are in millimetres in the sensor frame S, and belong to"
            " this probe."
        )
    moved = (
        Marker(marker.name, foot, normal)
        for marker, foot, normal in zip(markers, feet, probe.normals[faces], strict=True)
    )
    return Snapped(MarkerSet(tuple(moved)), np.asarray(distances))


def with_normals(markers: MarkerSet, probe: Probe) -> tuple[MarkerSet, NDArray[np.float64]]:
    """
    Return the markers where they are, with the normals of the surface nearby, and their signed heights (n,), m.

    A marker above the mesh (on the side that its normal points to) has a positive height.

    Raises
    ------
    MarkerError
        A marker is off the probe.
    """
    snapped = snap(markers, probe)
    heights = np.einsum("nk,nk->n", markers.points - snapped.markers.points, snapped.markers.normals)
    kept = (
        Marker(marker.name, marker.point_S, foot.normal_S)
        for marker, foot in zip(markers, snapped.markers, strict=True)
    )
    return MarkerSet(tuple(kept)), heights


def load_markers(file: File) -> MarkerSet:
    """
    Read a table of markers: name,x_mm,y_mm,z_mm in any order of columns, S.

    Raises
    ------
    MarkerError
        The file cannot be read, or a row cannot be used; the message names file and line.
    """
    return read_markers(read_bytes(file, _MOST_BYTES, MarkerError), str(file))


def read_markers(data: bytes, name: str = "markers") -> MarkerSet:
    """
    Read the bytes of a table of markers; see `load_markers`.

    Raises
    ------
    MarkerError
        As there.
    """
    if len(data) > _MOST_BYTES:
        raise MarkerError(
            f"{arg(name)}: larger than {arg(_MOST_BYTES >> 20)} MiB: not a table of markers. Choose the right file."
        )
    try:
        rows = csv.reader(io.StringIO(data.decode("utf-8-sig"), newline=""), strict=True)
        header = [cell.strip() for cell in next(rows, [])]
        missing = [column for column in COLUMNS if header.count(column) != 1]
        if missing:
            raise MarkerError(
                f"{arg(name)}: line 1: each of {arg(', '.join(COLUMNS))} must appear once; check"
                f" {arg(', '.join(missing))}."
            )
        places = [header.index(column) for column in COLUMNS]
        markers = [_row(row, places, f"{name}: line {rows.line_num}") for row in rows if any(row)]
    except (UnicodeDecodeError, csv.Error) as error:
        raise MarkerError(f"{arg(name)}: not CSV text ({arg(error)}): save it as UTF-8 CSV.") from error
    if len(markers) > MOST_MARKERS:
        raise MarkerError(
            f"{arg(name)}: {arg(len(markers)):,} markers, at most {arg(MOST_MARKERS):,} are allowed: choose"
            " the right file."
        )
    try:
        return MarkerSet(tuple(markers))
    except MarkerError as error:
        raise MarkerError(f"{arg(name)}: {arg(error)}") from error


def _row(row: list[str], places: list[int], where: str) -> Marker:
    if len(row) <= max(places):
        raise MarkerError(f"{arg(where)}: {arg(len(row))} cells; one is needed for each column.")
    name, *cells = (row[place].strip() for place in places)
    point = []
    for column, cell in zip(COLUMNS[1:], cells, strict=True):
        try:
            value = float(cell)
        except ValueError:
            value = np.nan
        if not abs(value) <= _FARTHEST_MM:
            raise MarkerError(
                f"{arg(where)}: {arg(column)} is {arg(cell[:30])!r}: give a number of millimetres."
            )
        point.append(value / 1e3)
    try:
        return Marker(name, np.array(point), np.full(3, np.nan))
    except MarkerError as error:
        raise MarkerError(f"{arg(where)}: {arg(error)}") from error


@dataclass(frozen=True, eq=False)
class TouchLocation:
    """The contact of a touch."""

    point: NDArray[np.float64]  # (3,) of the mean wrench, S, m
    # (3, 3) of that point: sensor noise over the samples, and the calibration; m²
    covariance: NDArray[np.float64]
    wrench: NDArray[np.float64]  # (6,) mean over the samples, S, N and N·m
    R_WS: NDArray[np.float64]  # (3, 3)
    torque: float  # Local torque k, N·m
    normal: NDArray[np.float64]  # (3,) of the facet that was touched
    count: int  # Samples
    # How far the point moved between the halves of the samples, and the 1 sigma of that by noise alone, m
    drift: float
    drift_sigma: float
    ambiguous: bool
    # No single touch explains the wrench, unless with more torque about the normal than a tip can give
    implausible: bool = False
    confidence: float = float("nan")  # 1 / (1 + odds of its rivals), no probability
    # Other places that explain the wrench, the likeliest first
    rivals: tuple[tuple[float, float, float], ...] = ()


@dataclass(frozen=True)
class MarkerMatch:
    """The marker that a contact belongs to."""

    marker: int  # Its place in the set
    sigmas: float  # Mahalanobis distance; covariance of the contact, and what alignment may be off
    rival: bool  # A second marker is about as near
    far: bool  # It is none of the markers


class TouchLocator:
    """
    Locate touches on a probe, and find their markers.

    Parameters
    ----------
    probe : Probe
    markers : MarkerSet
    model : GravityModel
        Its covariance is part of that of a contact; the wrenches are compensated already.
    noise : WrenchNoise
        Of one sample, such that the mean of n has 1/n of its variance.
    samples : int
        That a touch is the mean of: what is ambiguous follows from the noise of the mean, and from the model's error
        as it is assumed before it is measured, which no mean makes smaller.
    correlation : float
        By what that variance is larger than half the mean square between neighbouring samples.
    """

    def __init__(
        self,
        probe: Probe,
        markers: MarkerSet,
        model: GravityModel,
        noise: WrenchNoise,
        samples: int = 50,
        correlation: float = 1.0,
    ) -> None:
        self.probe, self.markers, self.model, self.noise = probe, markers, model, noise
        self._correlation = correlation
        root = np.sqrt(samples)
        of_mean = WrenchNoise(np.asarray(noise.force) / root, np.asarray(noise.torque) / root)
        self.solver = ContactSolver(probe, of_mean)

    @cached_property
    def _lenient(self) -> ContactSolver:
        """What tells where a touch is whose torque is not to be believed."""
        return ContactSolver(self.probe, self.solver.noise, model=_MUCH_TORSION)

    def locate(self, wrenches: NDArray[np.float64], R_WS: NDArray[np.float64]) -> TouchLocation | Reason:
        """Return where samples (n, 6) taken at orientations (n, 3, 3) have touched, or why that is nowhere."""
        count, mean = len(wrenches), wrenches.mean(axis=0)
        whole = self.solver.locate(mean)
        implausible = whole.reason is Reason.IMPLAUSIBLE
        if implausible:
            whole = self._lenient.locate(mean)
        if whole.point is None or whole.normal is None:
            return whole.reason
        per_wrench = self._sensitivity(whole.point, whole.normal, mean[:3])
        total = self.noise.covariance / count + self.model.wrench_covariance(R_WS[count // 2])
        halves = np.array([each.mean(axis=0) for each in np.array_split(wrenches, 2)])
        # Linear, because a far rival may win one half by chance; steps of wrench, so what turns is not a slip.
        forces = np.linalg.norm(halves[:, :3], axis=1)  # more force is no slip
        moved = np.linalg.norm(per_wrench @ (halves[1] - halves[0] * (forces[1] / forces[0])))
        seen = _high_pass(wrenches) * self._correlation
        left = per_wrench @ (seen * 4 / count) @ per_wrench.T
        return TouchLocation(
            point=np.array(whole.point),
            covariance=per_wrench @ total @ per_wrench.T,
            wrench=mean,
            R_WS=np.array(R_WS[count // 2]),
            torque=float(whole.torque),
            normal=np.array(whole.normal),
            count=count,
            drift=float(moved),
            drift_sigma=float(np.sqrt(np.linalg.eigvalsh(left)[-1].clip(0))),
            ambiguous=not whole.accepted,
            implausible=implausible,
            confidence=float(whole.confidence),
            rivals=_rivals(whole),
        )

    def moved(self, located: TouchLocation, wrenches: NDArray[np.float64]) -> float:
        """Return how far, m, from a contact later samples (n, 6) have touched; along the surface, to first order."""
        mean = wrenches.mean(axis=0)
        per_wrench = self._sensitivity(located.point, located.normal, mean[:3])
        at_point = np.concatenate([mean[:3], np.cross(located.point, mean[:3]) + _along(located, mean[:3])])
        return float(np.linalg.norm(per_wrench @ (mean - at_point)))

    def place(self, located: TouchLocation, expected: int | None = None) -> MarkerMatch:
        """Return the nearest marker by the contact's own covariance, or what the expected one is to it."""
        C = located.covariance + _ALLOWED**2 * np.eye(3)
        away = self.markers.points - located.point
        sigmas = np.sqrt(np.einsum("nk,nk->n", away, np.linalg.solve(C, away.T).T))
        if expected is not None:
            near = float(sigmas[expected])
            return MarkerMatch(expected, near, False, near > _FAR)
        order = np.argsort(sigmas, kind="stable")
        rival = len(order) > 1 and sigmas[order[1]] - sigmas[order[0]] < _RIVAL
        near = float(sigmas[order[0]])
        return MarkerMatch(int(order[0]), near, bool(rival and near <= _FAR), near > _FAR)

    @staticmethod
    def _sensitivity(
        point: NDArray[np.float64], normal: NDArray[np.float64], force: NDArray[np.float64]
    ) -> NDArray[np.float64]:
        return np.asarray(contact_sensitivity(point, normal, force[None])[0])


def _rivals(contact: Contact) -> tuple[tuple[float, float, float], ...]:
    if contact.reason not in (Reason.AMBIGUOUS, Reason.BY_REGION):
        return ()
    return tuple((float(x), float(y), float(z)) for x, y, z in (each.point for each in contact.candidates))


def _along(located: TouchLocation, force: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the local torque that goes along with a force, N·m: it moves no contact."""
    return np.asarray(located.torque * force / np.linalg.norm(force))


def _high_pass(wrenches: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the covariance (6, 6) of a sample, from differences: what drifts is not noise."""
    steps = np.diff(wrenches, axis=0)
    return np.asarray(steps.T @ steps / (2 * len(steps)))


def sample_noise(touches: list[NDArray[np.float64]]) -> WrenchNoise:
    """Return the noise of one sample, measured between neighbours within touches (n, 6) each."""
    # The median touch: one that slips says nothing about the sensor.
    usual = np.median([np.diag(_high_pass(each)) for each in touches], axis=0)
    sigma = np.sqrt(np.maximum(usual, 1e-18))
    return WrenchNoise(sigma[:3], sigma[3:])


def memory(runs: list[NDArray[np.float64]]) -> tuple[float, float] | None:
    """
    Tell how alike the samples of runs (n, 6) each are to their neighbours: a filter makes them so.

    Returns
    -------
    float
        tau = 1 + 2 sum of the autocorrelations: a mean of n has tau / n times the variance of a sample; 1: white.
    float
        The autocorrelation of neighbours; 0: white. None instead of both: no run is long enough.
    """
    usable = [run for run in runs if len(run) >= _SHORTEST]
    if not usable:
        return None
    lags = min(_MOST_LAGS, min(map(len, usable)) // 3)
    total = np.zeros(lags + 1)
    for run in usable:
        total += _autocorrelation(run, lags)
    rho = total / len(usable)
    small = np.flatnonzero(rho < _CHANCE)
    last = int(small[0]) if len(small) else lags + 1
    return float(1 + 2 * rho[1:last].sum()), float(rho[1]) if last > 1 else 0.0


def _autocorrelation(run: NDArray[np.float64], lags: int) -> NDArray[np.float64]:
    """Return that of a run at lags 0 to `lags`, all channels together; what drifts evenly or bends is taken out."""
    n = len(run)
    powers = np.polynomial.polynomial.polyvander(np.linspace(-1, 1, n), 2)
    left = run - powers @ np.linalg.lstsq(powers, run, rcond=None)[0]
    left /= np.sqrt(np.maximum((left**2).mean(axis=0), 1e-30))
    return np.array(
        [float((left[lag:] * left[: n - lag]).sum(axis=0).mean()) / (n - lag) for lag in range(lags + 1)]
    )
