"""
Keep more facets in the priority regions than elsewhere.

The ratio is that of facets per area, in the regions over the rest. The whole surface is simplified until
the regions have about the facets they are to keep; then regions and rest go on apart, with the vertices on their
common border held where they are. Cutting the original there would leave the border as fine as it was, and use up
the rest's facets on it; after the first step it is as coarse as the regions themselves.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Unpack

import numpy as np

from pipeline.mesh import engines

if TYPE_CHECKING:
    from collections.abc import Callable

    import numpy.typing as npt

    from pipeline.mesh.simplify.canonical import Canonical
    from pipeline.mesh.simplify.recipe import Mesh, Recipe

    # Which facets of a simplified mesh lie in a region.
    Locate = Callable[[npt.NDArray[np.float64], npt.NDArray[np.int32]], npt.NDArray[np.bool_]]

_TRIES = 8

# The first step may leave this many times the facets that the regions keep in the end.
_ENOUGH = 1.3


def inside_count(count: int, ratio: float, share: float) -> int:
    """
    Compute how many of `count` facets the regions get.

    Parameters
    ----------
    count : int
        All facets.
    ratio : float
        Facets per area in the regions over that in the rest.
    share : float
        The regions' share of the area, 0 to 1.

    Returns
    -------
    int
        count r a / (r a + 1 - a).
    """
    return round(count * ratio * share / (ratio * share + 1 - share))


def simplify_apart(
    recipe: Recipe,
    mesh: Canonical,
    count: int,
    inside: int,
    locate: Locate,
    **control: Unpack[engines.Control],
) -> Mesh:
    """
    Simplify with `inside` facets in the regions and the others outside.

    Parameters
    ----------
    recipe : Recipe
        For the first step; the parts go through fast-simplification, which alone holds borders still.
    mesh : Canonical
        The original.
    count : int
        All facets to reach.
    inside : int
        Those in the regions.
    locate : callable
        Takes a simplified mesh, returns which facets lie in a region.
    **control
        See `engines.run`.

    Returns
    -------
    vertices : (k, 3) float64
        In the engines' unit.
    faces : (l, 3) int32

    Raises
    ------
    EngineError, Cancelled
        See `engines.run`.
    """
    vertices, faces, chosen = _even(recipe, mesh, max(count, inside), inside, locate, **control)
    # Regions that have fewer facets than their share keep all; what they do not use goes to the rest.
    inside = min(inside, int(np.count_nonzero(chosen)))
    parts = [
        _part(vertices, faces[chosen], inside, **control),
        _part(vertices, faces[~chosen], count - inside, **control),
    ]
    return _glued(parts)


def _even(
    recipe: Recipe,
    mesh: Canonical,
    count: int,
    inside: int,
    locate: Locate,
    **control: Unpack[engines.Control],
) -> tuple[npt.NDArray[np.float64], npt.NDArray[np.int32], npt.NDArray[np.bool_]]:
    """Simplify evenly to a count that leaves at least `inside` facets in the regions, and not many more."""
    finest = (mesh.vertices, mesh.faces, locate(mesh.vertices, mesh.faces))
    low, high = count, len(mesh.faces)
    tried, have = high, int(np.count_nonzero(finest[2]))
    for _ in range(_TRIES):
        if inside <= have <= _ENOUGH * inside or high <= 1.05 * low:
            break
        # In proportion, aiming inside the interval that will do; halfway when that is out of bounds.
        guess = round(tried * (1 + _ENOUGH) / 2 * inside / max(have, 1))
        tried = guess if low < guess < high else round((low * high) ** 0.5)
        vertices, faces = recipe.simplify(mesh.vertices, mesh.faces, tried, **control)
        chosen = locate(vertices, faces)
        have = int(np.count_nonzero(chosen))
        if have >= inside:
            finest, high = (vertices, faces, chosen), tried
        else:
            low = tried
    return finest


def _part(
    vertices: npt.NDArray[np.float64],
    faces: npt.NDArray[np.int32],
    count: int,
    **control: Unpack[engines.Control],
) -> Mesh:
    used, renumbered = np.unique(faces, return_inverse=True)
    own = renumbered.reshape(-1, 3).astype(np.int32)
    if count >= len(faces):
        return vertices[used], own
    return engines.fast_quadric(vertices[used], own, max(count, 1), keep_border=True, **control)


def _glued(parts: list[Mesh]) -> Mesh:
    """Join parts at the vertices of their common border, which are the same to the last bit."""
    offsets = np.cumsum([0] + [len(vertices) for vertices, _ in parts[:-1]])
    vertices = np.concatenate([vertices for vertices, _ in parts])
    faces = np.concatenate([faces + offset for (_, faces), offset in zip(parts, offsets, strict=True)])
    merged, number = np.unique(vertices, axis=0, return_inverse=True)
    return merged, number.reshape(-1)[faces].astype(np.int32)
