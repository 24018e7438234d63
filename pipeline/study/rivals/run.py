"""All rivals in one run."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from contactbench import assets
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.study.rivals.place import place_rows

if TYPE_CHECKING:
    from collections.abc import Callable

    from contactbench.pipeline.study.rivals.rows import Row

KIND = "rivals"
_FEWEST, _MOST = 300, 200_000


@dataclass(frozen=True)
class RivalsSizes:
    """How much is measured."""

    probes: tuple[str, ...] = assets.PROBE_NAMES
    facets: tuple[int, ...] = (500, 2_000, 20_000)  # of the meshes that contacts are located on
    touches: int = 4_000
    rounds: int = 15

    def __post_init__(self) -> None:
        for probe in self.probes:
            if probe not in assets.PROBE_NAMES:
                raise InputError(f"--probe {probe}: choose of {', '.join(assets.PROBE_NAMES)}.")
        for count in self.facets:
            if not _FEWEST <= count <= _MOST:
                raise InputError(f"--facets {count}: give {_FEWEST} to {_MOST:,}.")
        if self.rounds < 1:
            raise InputError(f"--rounds {self.rounds}: give at least 1.")


QUICK = RivalsSizes(probes=("linear",), facets=(500,), touches=500, rounds=3)


def run(sizes: RivalsSizes, *, seed: int = 0, progress: Callable[[str], None] = lambda _: None) -> list[Row]:
    """
    Measure everything that is installed.

    Parameters
    ----------
    seed : int
        Of touches and noise.
    progress : callable
        Told what is being measured.

    Returns
    -------
    list of dict
        Plain rows of four kinds: ``version``, ``missing``, ``time`` and ``error``.
    """
    rows: list[Row] = []
    for probe in sizes.probes:
        for facets in sizes.facets:
            progress(f"location: {probe}, {facets:,} facets")
            rows += place_rows(probe, facets, sizes.touches, sizes.rounds, seed)
    return _once(rows)


def _once(rows: list[Row]) -> list[Row]:
    """Leave out versions and missing packages that were said before."""
    said = set()
    kept = []
    for row in rows:
        if row["kind"] in ("version", "missing"):
            key = (row["kind"], row["family"], row["contender"])
            if key in said:
                continue
            said.add(key)
        kept.append(row)
    return kept
