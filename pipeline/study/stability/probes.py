"""The probes that single precision and the condition are tried on: bundled ones, or an engineer's own."""

from __future__ import annotations

from functools import lru_cache
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from contactbench.pipeline.errors import InputError
from contactbench.pipeline.study.hard_meshes import Body
from contactbench.pipeline.study.sweep.bodies import file_facets, mesh_of

if TYPE_CHECKING:
    from collections.abc import Sequence

    from contactbench.pipeline.study.hard_meshes import Float

BUNDLED = ("linear", "convex", "t-shape")


@lru_cache
def body_of(name: str, facets: int) -> Body:
    """Return a probe of about so many facets, or the file's own if it has fewer; InputError."""
    probe = mesh_of(name, facets)
    return Body(np.asarray(probe.vertices), probe.faces.astype(np.int64))


def sizes_of(name: str, wanted: tuple[int, ...]) -> list[int]:
    """Return the numbers of facets of `wanted` that a probe can have, and all that a file has; InputError."""
    own = file_facets(name)
    return list(wanted) if own is None else [*(n for n in wanted if n < own), own]


def title_of(name: str) -> str:
    """Return a probe's name without a comma, folder or ending."""
    return name if name in BUNDLED else Path(name).stem.replace(",", " ")


def check(names: Sequence[str]) -> None:
    """
    Refuse probes that cannot be told apart or read.

    Raises
    ------
    InputError
    """
    titles = [title_of(name) for name in names]
    for name, title in zip(names, titles, strict=True):
        if titles.count(title) > 1:
            raise InputError(f"--probe {name}: another one is named {title}, too: rename the file.")
        body_of(name, 1000)


def slenderness(body: Body) -> Float:
    """Return the longest edge over the height of each facet (m,)."""
    edges = body.corners - np.roll(body.corners, -1, axis=1)
    longest = np.einsum("fei,fei->fe", edges, edges).max(axis=1)
    areas = np.sqrt(np.einsum("fi,fi->f", body.areas, body.areas))
    return np.asarray(longest / areas, np.float64)
