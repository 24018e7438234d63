"""What first-order theory says of a contact; touches, conditions and rows are the study's own."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from contactbench.pipeline.study.stability import (
    ROUNDOFF,
    FacetTouches,
    answers_on,
    condition,
    errors,
    next_to,
    touch,
)
from contactbench.pipeline.study.stability import StabilityRow as Row

if TYPE_CHECKING:
    from collections.abc import Iterable

    from contactbench.pipeline.study.hard_meshes import Float

__all__ = ["ROUNDOFF", "FacetTouches", "Row", "answers_on", "condition", "errors", "next_to", "touch"]

FLOAT_ROUNDOFF = 2.0**-24
# Where on an axis a figure belongs: `x`, `axis`, and `most`.
Where = dict[str, Any]


def count(part: str, case: str, by: str, figure: str, found: int, tries: int, **more: Any) -> Row:
    """Give a count."""
    return Row(part, case, by, figure, "", tries, float(found), float(found), **more)


def of_part(rows: Iterable[Row], part: str, **more: Any) -> list[Row]:
    """Return the rows of a part whose other fields are as given."""
    return [row for row in rows if row.part == part and all(getattr(row, k) == v for k, v in more.items())]


def moved(normals: Float, points: Float, wrenches: Float, change: Float) -> Float:
    """Return how a change (n, 6) of wrenches moves their contacts, to first order (n, 3), m."""
    dF, dM = np.split(change, 2, axis=1)
    along = np.einsum("ni,ni->n", normals, wrenches[:, :3])[:, None]
    return np.asarray(np.cross(normals, dM - np.cross(points, dF)) / along)


def nudge(wrenches: Float, size: Float, rng: np.random.Generator) -> Float:
    """Return changes (n, 6) of wrenches: force and torque each by `size` (n,) of its length, any direction."""
    parts = []
    for part in np.split(wrenches, 2, axis=1):
        way = rng.standard_normal(part.shape)
        way *= np.linalg.norm(part, axis=1, keepdims=True) / np.linalg.norm(way, axis=1, keepdims=True)
        parts.append(size[:, None] * way)
    return np.hstack(parts)
