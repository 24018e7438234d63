"""The markers of a session: made, edited and kept; an edit gives new markers, so that it can be undone."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike

from contactbench.pipeline.errors import arg
from contactbench.pipeline.mesh import Probe
from contactbench.pipeline.session import Session, State
from contactbench.pipeline.verification.markers import (
    COLUMNS,
    Marker,
    MarkerError,
    MarkerSet,
    check_name,
    load_markers,
    read_markers,
    snap,
)
from contactbench.pipeline.verification.spread import grid_markers, spread_markers

KIND, NAME = "markers", "markers.csv"
_NOWHERE = np.full(3, np.nan)
_EMPTY = (",".join(COLUMNS) + "\n").encode()


@dataclass(frozen=True, eq=False)
class Markers:
    """Markers of a session, perhaps none."""

    all: tuple[Marker, ...] = ()  # Points in S, m

    def __len__(self) -> int:
        return len(self.all)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Markers) and self.to_bytes() == other.to_bytes()

    def __hash__(self) -> int:
        return hash(self.to_bytes())

    @property
    def names(self) -> tuple[str, ...]:
        """The names, in order."""
        return tuple(each.name for each in self.all)

    def to_bytes(self) -> bytes:
        """Return the table; without markers only its header."""
        return MarkerSet(self.all).to_bytes() if self.all else _EMPTY

    def as_set(self) -> MarkerSet:
        """Return them as a verification takes them; MarkerError: there are none."""
        return MarkerSet(self.all)

    # ---- edits -------------------------------------------------------------------------------

    def added(self, point_S: ArrayLike, name: str | None = None) -> Markers:
        """Return them with one more at a point, m, called as it is free; MarkerError: the name is taken."""
        called = self._free() if name is None else name
        point = np.asarray(point_S, dtype=np.float64)
        return _checked((*self.all, Marker(called, point, _NOWHERE)))

    def without(self, names: Iterable[str]) -> Markers:
        """Return them without some."""
        gone = set(names)
        return Markers(tuple(each for each in self.all if each.name not in gone))

    def renamed(self, name: str, new: str) -> Markers:
        """Return them with one called otherwise; MarkerError: the name is taken, or cannot be one."""
        check_name(new)
        if new != name and new in self.names:
            raise MarkerError(f"there is already a marker {arg(new)}: choose another name.")
        return Markers(
            tuple(
                Marker(new, each.point_S, each.normal_S) if each.name == name else each for each in self.all
            )
        )

    def moved(self, name: str, point_S: ArrayLike) -> Markers:
        """Return them with one at another point, m."""
        point = np.asarray(point_S, dtype=np.float64)
        return Markers(
            tuple(Marker(name, point, _NOWHERE) if each.name == name else each for each in self.all)
        )

    def _free(self) -> str:
        number = len(self.all) + 1
        while f"M{number}" in self.names:
            number += 1
        return f"M{number}"


def _checked(markers: tuple[Marker, ...]) -> Markers:
    MarkerSet(markers)  # refuses names that are taken twice
    return Markers(markers)


# ---- where they come from ----------------------------------------------------------------------


def imported(file: Path) -> Markers:
    """Read a table of markers; MarkerError."""
    return Markers(load_markers(file).markers)


def spread(probe: Probe, count: int, region: int | None = None) -> Markers:
    """Return markers spread evenly over a probe, or a region of it; as ``contactbench probe markers generate``."""
    return _rounded(spread_markers(probe, count, region))


def grid(probe: Probe, pitch: float, region: int | None = None) -> Markers:
    """Return markers on a grid of a pitch, m; as ``contactbench probe markers generate --grid``."""
    return _rounded(grid_markers(probe, pitch, region))


def on_surface(markers: Markers, probe: Probe) -> tuple[Markers, float]:
    """Return markers moved to the nearest points of a probe, and the farthest that one was moved, m; MarkerError."""
    snapped = snap(markers.as_set(), probe)
    return _rounded(snapped.markers), float(snapped.distances.max())


def _rounded(markers: MarkerSet) -> Markers:
    """Return markers as a file keeps them: what is shown is what is computed with."""
    return Markers(read_markers(markers.to_bytes()).markers)


# ---- in a session ------------------------------------------------------------------------------


def kept(folder: Path, state: State) -> Markers:
    """Return the markers that a session keeps; reads a file. MarkerError: it cannot be read."""
    found = state.newest(KIND)
    if found is None:
        return Markers()
    file = folder / found.file.path
    try:
        data = file.read_bytes()
    except OSError as error:
        raise MarkerError(
            f"{arg(file)}: the markers cannot be read ({arg(error)}): run `session verify`."
        ) from error
    return Markers() if data == _EMPTY else Markers(read_markers(data, NAME).markers)


def keep(session: Session, markers: Markers) -> None:
    """Keep markers in a session, in place of those before."""
    session.add_input(markers.to_bytes(), KIND, name=NAME)
