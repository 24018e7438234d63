"""What is measured of a contender, as plain rows; who is faster, who is more accurate, and whether anybody is both."""

from __future__ import annotations

from dataclasses import dataclass
from importlib.metadata import PackageNotFoundError, version
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from numpy.typing import NDArray

Row = dict[str, Any]
OURS = "contactbench"
SURE = f"{OURS}, sure answers"  # its own subset, no contender
TOLD = f"{OURS}, noise told"
REMEDY = "pip install contactbench[rivals]"
_MM = 1e3
FAMILY = "contact location"  # earlier versions measured planes, meshes and calibrations, too
WRENCH, RAY, BATCH, COMPILED = (
    "one wrench, from Python",
    "one ray, from Python",
    "1,000 wrenches, each",
    "compiled",
)
MARGIN = 1.02  # below it is chance
_SIGMAS, _ANSWERS = 2.0, 0.99
_ROUNDING_MM = 1e-6


@dataclass(frozen=True)
class Contender:
    """Somebody's code."""

    name: str
    package: str = ""  # on PyPI; empty for code of this project

    @property
    def version(self) -> str:
        """Its version; empty where it is not installed."""
        try:
            return version(self.package or OURS)
        except PackageNotFoundError:
            return ""


def missing(family: str, contender: Contender, error: BaseException) -> Row:
    """Return the row of something that cannot be measured here."""
    why = str(error).splitlines()[0] if str(error) else type(error).__name__
    said = f"not installed: {REMEDY}" if not contender.version else f"cannot be used here ({why})"
    return {
        "kind": "missing",
        "family": family,
        "contender": contender.name,
        "package": contender.package,
        "note": said,
    }


def known(family: str, contender: Contender) -> Row:
    """Return the row that says which version was measured."""
    return {
        "kind": "version",
        "family": family,
        "contender": contender.name,
        "package": contender.package or "of this project",
        "version": contender.version,
    }


def timed(family: str, contender: str, subject: str, mode: str, us: Sequence[float], **more: Any) -> Row:
    """Return the row of some timed rounds: the median of each round, µs."""
    low, middle, high = np.percentile(np.asarray(us, dtype=np.float64), [5, 50, 95]).tolist()
    return {
        "kind": "time",
        "family": family,
        "contender": contender,
        "subject": subject,
        "mode": mode,
        "median_us": middle,
        "low_us": low,
        "high_us": high,
        "rounds": len(us),
        **more,
    }


def erred(
    family: str,
    contender: str,
    subject: str,
    condition: str,
    error: NDArray[np.float64],
    ours: NDArray[np.float64],
    **more: Any,
) -> Row:
    """
    Return the row of a contender's errors beside ours on the same inputs.

    Parameters
    ----------
    error, ours : (n,)
        m; NaN where nothing was answered.
    """
    both = np.isfinite(error) & np.isfinite(ours)
    there = np.isfinite(error)
    apart = _MM * (error[both] - ours[both])
    count = int(both.sum())
    mm = _MM * error[there]
    return {
        "kind": "error",
        "family": family,
        "contender": contender,
        "subject": subject,
        "condition": condition,
        "inputs": len(error),
        "answered": float(there.mean()),
        "mean_mm": _or_nan(mm, np.mean),
        "median_mm": _or_nan(mm, np.median),
        "p95_mm": _or_nan(mm, lambda x: np.percentile(x, 95)),
        "max_mm": _or_nan(mm, np.max),
        "worse_mm": _or_nan(apart, np.mean),
        "worse_se_mm": float(apart.std(ddof=1) / np.sqrt(count)) if count > 1 else float("nan"),
        "common_mm": _or_nan(_MM * error[both], np.mean),
        "ours_common_mm": _or_nan(_MM * ours[both], np.mean),
        **more,
    }


def _or_nan(values: NDArray[np.float64], what: Any) -> float:
    return float(what(values)) if len(values) else float("nan")


# ---- duels --------------------------------------------------------------------------------


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
        own = times.get((family, OURS, subject, facets, WRENCH if mode == RAY else mode))
        if own:
            yield us / own, mode


def _key(row: Row) -> tuple[Any, ...]:
    return row["family"], row["contender"], row["subject"], row.get("facets")
