"""Who is faster, who is more accurate, and whether anybody is both."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from contactbench.pipeline.study.rivals import place
from contactbench.pipeline.study.rivals.rows import OURS

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

Row = dict[str, Any]
MARGIN = 1.02  # below it is chance
_SIGMAS, _ANSWERS = 2.0, 0.99
_ROUNDING_MM = 1e-6


@dataclass(frozen=True)
class Duel:
    """One rival against ours on one subject."""

    family: str
    subject: str
    condition: str
    contender: str
    facets: int | None
    # its time over ours: the least of those that can be compared; a ray alone counts as a whole solve
    ratio: float | None
    mode: str  # of that time
    # mean, ours: errors on what both answer, mm
    mean: float
    ours: float
    answered: float  # share that it answers of what ours answers
    better: bool  # more accurate by more than chance, and it answers as much

    @property
    def faster(self) -> bool:
        """Whether it takes less time by more than chance."""
        return self.ratio is not None and self.ratio * MARGIN < 1

    @property
    def beats(self) -> bool:
        """Whether it is both faster and more accurate."""
        return self.faster and self.better

    @property
    def words(self) -> str:
        """It as a sentence."""
        where = self.subject + (f", {self.facets:,} facets" if self.facets else "")
        times = "" if self.ratio is None else f"{self.ratio:.2g} times our time ({self.mode})"
        return f"{self.contender} on {where}, {self.condition}: {times}, {self.mean:.3g} mm against {self.ours:.3g} mm"


def duels(rows: Sequence[Row]) -> list[Duel]:
    """Return every rival against ours, on every subject and in every condition."""
    times = {_key(row) + (row["mode"],): row["median_us"] for row in rows if row["kind"] == "time"}
    errors = {_key(row) + (row["condition"],): row for row in rows if row["kind"] == "error"}
    found = []
    for key, row in errors.items():
        family, contender, subject, facets, condition = key
        if contender.startswith(OURS):
            continue
        mine = errors[family, OURS, subject, facets, condition]
        ratios = list(_ratios(times, key[:4]))
        ratio, mode = min(ratios, default=(None, ""), key=lambda each: each[0] or 0.0)
        found.append(Duel(family, subject, condition, contender, facets, ratio, mode, *_accuracy(row, mine)))
    return found


def _accuracy(row: Row, mine: Row) -> tuple[float, float, float, bool]:
    share = row["answered"] / mine["answered"] if mine["answered"] else 0.0
    mean, ours = row["common_mm"], row["ours_common_mm"]
    less = row["worse_mm"] < -max(_SIGMAS * row["worse_se_mm"], _ROUNDING_MM) and mean * MARGIN < ours
    return mean, ours, share, bool(less and share >= _ANSWERS)


def _ratios(times: dict[Any, float], key: tuple[Any, ...]) -> Iterator[tuple[float, str]]:
    family, _, subject, facets = key
    for (*name, mode), us in times.items():
        if tuple(name) != key:
            continue
        # A ray alone is not yet a contact; that it costs nothing more is in the rival's favour.
        own = times.get((family, OURS, subject, facets, place.WRENCH if mode == place.RAY else mode))
        if own:
            yield us / own, mode


def _key(row: Row) -> tuple[Any, ...]:
    facets = row.get("facets") if row["family"] == place.FAMILY else None
    return row["family"], row["contender"], row["subject"], facets
