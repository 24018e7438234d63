"""What is wrong with a simplified mesh that was not wrong with the original."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from pipeline.mesh.deviation import Comparison
    from pipeline.mesh.probe import Probe

# What a count may be exceeded by where no engine reaches it, as when many edges are held.
OVER = 1.05

# An engine that stops a little short has done its work; closed meshes lose two facets at a time.
_SHORT, _SPARE = 0.9, 4

# Of the area. On thin walls and sharp edges the nearest original facet may be on the other side.
_FLIPPED = 0.002

# A surface with so many facets that is so far off, as a share of its size, has been ruined.
_RUINED_COUNT, _RUINED = 200, 0.02


def find_faults(original: Probe, made: Probe, count: int, comparison: Comparison) -> list[str]:
    """
    List the reasons not to use what an engine made.

    Parameters
    ----------
    original, made : Probe
        Before and after.
    count : int
        The facets asked for.
    comparison : Comparison
        Of the two.

    Returns
    -------
    list of str
        Empty when it can be used.
    """
    before, after, got = original.health, made.health, len(made.faces)
    checks = {
        f"stopped at {got} facets instead of {count}": got > count,
        f"left {got} facets instead of {count}": got < min(_SHORT * count, count - _SPARE),
        "opened the surface": before.watertight and not after.watertight,
        "joined more than two facets at an edge": after.nonmanifold_edges > before.nonmanifold_edges,
        "turned facets over": before.winding_consistent
        and (not after.winding_consistent or comparison.flipped_share > _FLIPPED),
        "turned the surface inside out": before.outward is True and after.outward is not True,
        "made facets twice": after.duplicate_facets > before.duplicate_facets,
        "broke the surface into parts": after.components > before.components,
        "ruined the shape": got >= _RUINED_COUNT and _relative_rms(original, comparison) > _RUINED,
    }
    return [fault for fault, found in checks.items() if found]


def _relative_rms(original: Probe, comparison: Comparison) -> float:
    deviation = comparison.deviation()
    return 0.0 if deviation is None else deviation.rms / original.size
