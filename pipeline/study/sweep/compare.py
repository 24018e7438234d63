"""Whether a small sweep says what a large one says: the order of methods, and the exponents of their growth."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import combinations
from typing import TYPE_CHECKING, Any

import numpy as np

from contactbench.pipeline.errors import InputError
from contactbench.pipeline.study.sweep.growth import ERROR, TIME, merged
from contactbench.pipeline.study.sweep.tables import exponents
from contactbench.pipeline.study.sweep.targets import is_noisy, plain

if TYPE_CHECKING:
    from collections.abc import Sequence

    from contactbench.pipeline.study.sweep.growth import Row

MOST_EXPONENT = 0.1
# Two methods closer than this are in no order: chance, in times of a shared machine more of it.
_EQUAL = {TIME: 1.25, ERROR: 1.1}
_NAMES = {TIME: "time", ERROR: "error"}
_VARIED = ("probe", "facets", "force", "angle", "torsion", "noise", "filter")


@dataclass(frozen=True)
class Conclusion:
    """One conclusion of both sweeps."""

    # what, small, large: what it is about, and what each says
    what: str
    small: str
    large: str
    same: bool


def compare(small: Sequence[Row], large: Sequence[Row]) -> list[Conclusion]:
    """
    Compare the conclusions of two sweeps.

    The order of methods is compared mesh by mesh on the conditions that both have; exponents are those that each fits
    to all of its own.

    Parameters
    ----------
    small, large : sequences of dict
        Rows of results.

    Raises
    ------
    InputError
        They have nothing in common.
    """
    found = _orders(small, large) + _exponents(small, large)
    if not found:
        raise InputError("the two studies have no probe and mesh in common: compare others.")
    return found


def _orders(small: Sequence[Row], large: Sequence[Row]) -> list[Conclusion]:
    shared = {name: {row[name] for row in small} & {row[name] for row in large} for name in _VARIED}
    points = []
    for rows in (small, large):
        kept = [row for row in rows if is_noisy(row) and all(row[name] in shared[name] for name in _VARIED)]
        points.append({_where(row): row for row in merged(kept, ("probe", "facets", "method"))})
    both = sorted(set(points[0]) & set(points[1]))
    found = []
    for figure in (TIME, ERROR):
        for probe, facets in sorted({key[:2] for key in both}):
            methods = [key[2] for key in both if key[:2] == (probe, facets)]
            if len(methods) < 2:
                continue
            mine, theirs = (" < ".join(_order(each, probe, facets, methods, figure)) for each in points)
            pairs = [_swapped(points, probe, facets, pair, figure) for pair in combinations(methods, 2)]
            what = f"{_NAMES[figure]}: {plain(probe)}, {facets:,} facets"
            found.append(Conclusion(what, mine, theirs, not any(pairs)))
    return found


def _where(row: Row) -> tuple[str, int, str]:
    return row["probe"], row["facets"], row["method"]


def _order(points: dict[Any, Row], probe: str, facets: int, methods: list[str], figure: str) -> list[str]:
    return sorted(methods, key=lambda method: float(points[probe, facets, method][figure]))


def _swapped(
    points: list[dict[Any, Row]], probe: str, facets: int, pair: tuple[str, str], figure: str
) -> bool:
    """Tell whether both sweeps find a clear order of two methods, and not the same."""
    ratios = [
        float(each[probe, facets, pair[0]][figure] / each[probe, facets, pair[1]][figure]) for each in points
    ]
    signs = [
        0 if not np.isfinite(r) or 1 / _EQUAL[figure] < r < _EQUAL[figure] else np.sign(r - 1) for r in ratios
    ]
    return bool(signs[0] * signs[1] < 0)


def _exponents(small: Sequence[Row], large: Sequence[Row]) -> list[Conclusion]:
    found = []
    mine, theirs = exponents(small), exponents(large)
    for key in (key for key in mine if key in theirs):
        for what, few, many in zip(("time", "error of the mesh"), mine[key], theirs[key], strict=True):
            if few is not None and many is not None:
                name = f"exponent of {what}: {plain(key[0])}, {key[1]}"
                same = abs(few.exponent - many.exponent) <= MOST_EXPONENT
                found.append(Conclusion(name, f"{few.exponent:.2f}", f"{many.exponent:.2f}", same))
    return found
