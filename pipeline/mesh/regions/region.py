"""Regions as values: names and colours in the order of their priority, and the facets that belong to each."""

from __future__ import annotations

import re
import unicodedata
from collections import Counter
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from contactbench.pipeline.errors import MeshError, arg, message
from contactbench.pipeline.mesh.colours import PALETTE
from contactbench.pipeline.mesh.probe import Probe, check_region

if TYPE_CHECKING:
    from collections.abc import Collection, Sequence

    import numpy.typing as npt

    from contactbench.pipeline.mesh.arrays import Floats, Ints, Longs
    from contactbench.pipeline.mesh.regions.facet_graph import MeshEdit

MOST_REGIONS = 255
LONGEST_NAME = 64

_COLOUR = re.compile(r"#[0-9a-f]{6}")


@dataclass(frozen=True)
class Region:
    """
    What people see of a region.

    Attributes
    ----------
    name : str
        1 to 64 printable characters; normalised to NFC, without spaces around it.
    colour : str
        ``#rrggbb``; normalised to lower case.
    untouchable : bool
        Nothing can touch these facets: a clamp or a drape hides them.

    Raises
    ------
    RegionError
        A name or colour that is not like that.
    """

    name: str
    colour: str
    untouchable: bool = False

    def __post_init__(self) -> None:
        object.__setattr__(self, "name", _checked_name(self.name))
        colour = self.colour.lower()
        if not _COLOUR.fullmatch(colour):
            raise RegionError(
                f"region {arg(self.name)!r}: {arg(self.colour[:40])!r} is not a colour: write it as #rrggbb."
            )
        object.__setattr__(self, "colour", colour)


def _checked_name(name: str) -> str:
    text = unicodedata.normalize("NFC", name).strip()
    if not text or len(text) > LONGEST_NAME:
        raise RegionError(
            f"a region is called {arg(name[:LONGEST_NAME])!r} ({arg(len(text))} characters): give it a name of 1 to"
            f" {arg(LONGEST_NAME)} characters."
        )
    if not text.isprintable():
        raise RegionError(
            f"the region name {arg(text)!r} contains characters that cannot be displayed: leave them out."
        )
    return text


@dataclass(frozen=True, eq=False)
class RegionSet:
    """
    The regions of one mesh: every facet belongs to at most one.

    Attributes
    ----------
    regions : tuple of Region
        In the order of their priority; the first has rank 1.
    labels : (m,) int32
        Per facet the rank of its region, 0 for none; read-only. This is what `Probe.region` holds.
    cut : MeshEdit or None
        What makes their mesh, whose facets are cut along the outlines, of the one that they are kept for; None: it is
        that one.

    Raises
    ------
    RegionError
        Two regions of the same name, more than 255, or a label that is the rank of no region.
    MeshError
        Labels that are not one integer from 0 per facet.
    """

    regions: tuple[Region, ...]
    labels: Ints
    cut: MeshEdit | None = None

    def __post_init__(self) -> None:
        check_list(self.regions)
        labels = check_region(self.labels, len(self.labels))
        highest = int(labels.max(initial=0))
        if highest > len(self.regions):
            face = int(np.argmax(labels > len(self.regions)))
            raise RegionError(
                f"facet {arg(face)} has the region {arg(labels[face])}, but there are"
                f" {arg(len(self.regions))} regions: add the missing ones, or use ranks from 0."
            )
        labels.flags.writeable = False
        object.__setattr__(self, "labels", labels)

    @classmethod
    def empty(cls, facet_count: int) -> RegionSet:
        """No regions on a mesh of so many facets."""
        return cls((), np.zeros(facet_count, dtype=np.int32))

    def mesh(self, kept_for: Probe) -> Probe:
        """Return the probe that they are on, with them, given the one that they are kept for."""
        probe = kept_for if self.cut is None else self.cut.put_on(kept_for)
        return probe.with_region(self.labels, self.untouchable)

    @property
    def untouchable(self) -> tuple[int, ...]:
        """Ranks of the regions that nothing can touch, as `Probe.untouchable` holds them."""
        return tuple(rank for rank, region in enumerate(self.regions, 1) if region.untouchable)

    @classmethod
    def from_labels(
        cls, labels: npt.ArrayLike, regions: Sequence[Region] = (), untouchable: Collection[int] = ()
    ) -> RegionSet:
        """
        Make a set of labels alone; ranks without a region get one with the next free name and colour.

        Parameters
        ----------
        labels : (m,) array_like of integers
            Ranks, 0 for none, such as `Probe.region`.
        regions : sequence of Region
            The first of them, as far as they are known.
        untouchable : collection of int
            Ranks that nothing can touch, among those that `regions` does not know.

        Raises
        ------
        RegionError, MeshError
            As for the class.
        """
        ranks = check_region(labels, len(np.atleast_1d(np.asarray(labels))))
        highest = int(ranks.max(initial=0))
        if highest > MOST_REGIONS:
            raise RegionError(
                f"a facet has the region {arg(highest)}, but there may be at most {arg(MOST_REGIONS)}:"
                " number them from 1."
            )
        known = list(regions)
        while len(known) < highest:
            known.append(Region(free_name(known), free_colour(known), len(known) + 1 in untouchable))
        return cls(tuple(known), ranks)

    def rank_of(self, name: str) -> int:
        """Return the rank of the region of this name; RegionError if there is none."""
        return find_rank(self.regions, name)

    def faces_of(self, rank: int) -> Longs:
        """Return the facets of one rank, ascending."""
        return np.flatnonzero(self.labels == rank)

    def areas(self, facet_areas: Floats) -> Floats:
        """Return the area per region, (k,), given the area per facet (m,), in the same unit."""
        count = len(self.regions) + 1
        sums = np.bincount(self.labels, weights=facet_areas, minlength=count)
        return sums[1:count].astype(np.float64)


def check_list(regions: Sequence[Region]) -> None:
    """
    Check that regions can stand in one list.

    Raises
    ------
    RegionError
        More than 255, or a name that occurs twice.
    """
    if len(regions) > MOST_REGIONS:
        raise RegionError(
            f"{arg(len(regions))} regions, more than {arg(MOST_REGIONS)}: merge or remove some."
        )
    names = [region.name for region in regions]
    if len(set(names)) < len(names):
        twice = next(name for name, count in Counter(names).items() if count > 1)
        raise RegionError(f"two regions are called {arg(twice)!r}: rename one.")


def find_rank(regions: Sequence[Region], name: str) -> int:
    """Return the rank of the region of this name; RegionError if there is none."""
    wanted = unicodedata.normalize("NFC", name).strip()
    for rank, region in enumerate(regions, 1):
        if region.name == wanted:
            return rank
    known = ", ".join(region.name for region in regions) or message("none yet")
    raise RegionError(f"there is no region {arg(name[:LONGEST_NAME])!r}: choose one of: {arg(known)}.")


def free_name(regions: Collection[Region]) -> str:
    """Return the first of "Region 1", "Region 2", ... from the next rank on that is not taken."""
    taken = {region.name for region in regions}
    number = len(regions) + 1
    while f"Region {number}" in taken:
        number += 1
    return f"Region {number}"


def free_colour(regions: Collection[Region]) -> str:
    """Return the first colour of the palette that is used least."""
    used = [region.colour for region in regions]
    return min(PALETTE, key=used.count)


# ---- what the regions package raises -------------------------------------------------------------


class RegionError(MeshError):
    """Regions, an edit of them, or a file of them that cannot be used: names what is wrong and the remedy."""
