"""What the stability study measures: one row for each figure, and what it must keep."""

from __future__ import annotations

from dataclasses import asdict, dataclass, fields
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    import numpy.typing as npt

# Where on an axis a figure belongs: `x`, `axis`, and `most`.
Where = dict[str, Any]

PARTS = {
    "amplification": "What an error of the wrench does to the point",
    "rounding": "Rounding",
    "edges": "Edges and vertices",
    "precision": "Single precision",
    "thin facets": "Thin facets",
    "units": "Units",
    "bias": "Bias far above the contact",
    "exact": "Exact arithmetic",
    "repeatability": "The same bits",
}


@dataclass(frozen=True)
class Row:
    """
    One figure.

    Attributes
    ----------
    part : str
        A key of :data:`PARTS`.
    case : str
        What was tried, in words.
    by : str
        What computed: ``double``, ``single``, a build.
    figure : str
        What was measured, in words.
    unit : str
        "" for counts and ratios.
    tries : int
    median, worst : float
        Worst is the largest; NaN where nothing was measured.
    x : float or None
        Place on the axis `axis`, which has a unit in its name.
    axis : str
    most : float or None
        What `worst` may be; None where the figure is only shown.
    """

    part: str
    case: str
    by: str
    figure: str
    unit: str
    tries: int
    median: float
    worst: float
    x: float | None = None
    axis: str = ""
    most: float | None = None

    @property
    def met(self) -> bool:
        """Whether the bound is kept; what is no number keeps none."""
        return self.most is None or bool(self.worst <= self.most)

    def to_json(self) -> dict[str, Any]:
        """Return plain values; None for what is no number."""
        plain = {
            name: None if isinstance(value, float) and not np.isfinite(value) else value
            for name, value in asdict(self).items()
        }
        return plain | {"met": self.met}

    @classmethod
    def of(
        cls, part: str, case: str, by: str, figure: str, unit: str, values: npt.ArrayLike, **more: Any
    ) -> Row:
        """Sum up several values, (n,); those that are no numbers are left out."""
        numbers = np.asarray(values, dtype=np.float64).ravel()
        numbers = numbers[~np.isnan(numbers)]
        middle, worst = (
            (float(np.median(numbers)), float(numbers.max())) if len(numbers) else (np.nan, np.nan)
        )
        return cls(part, case, by, figure, unit, len(numbers), middle, worst, **more)

    @classmethod
    def count(cls, part: str, case: str, by: str, figure: str, found: int, tries: int, **more: Any) -> Row:
        """Give a count."""
        return cls(part, case, by, figure, "", tries, float(found), float(found), **more)

    @classmethod
    def from_json(cls, data: Mapping[str, Any]) -> Row:
        """Read back what :meth:`to_json` gave."""
        known: dict[str, Any] = {f.name: data.get(f.name) for f in fields(cls)}
        for name in ("median", "worst"):
            known[name] = np.nan if known[name] is None else known[name]
        return cls(**known)


def of_part(rows: Iterable[Row], part: str, **more: Any) -> list[Row]:
    """Return the rows of a part whose other fields are as given."""
    return [row for row in rows if row.part == part and all(getattr(row, k) == v for k, v in more.items())]
