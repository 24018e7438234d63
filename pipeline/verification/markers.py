"""Marked points on a probe, and the table that holds them."""

import csv
import io
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike, NDArray

from contactbench.pipeline.durable import write_file
from contactbench.pipeline.errors import InputError, arg, message
from contactbench.pipeline.files import File, read_bytes
from contactbench.pipeline.kernel import SurfaceIndex
from contactbench.pipeline.mesh import Probe

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
