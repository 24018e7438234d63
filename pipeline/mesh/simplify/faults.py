"""What is wrong with a simplified mesh that was not wrong with the original."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Callable

    from contactbench.pipeline.mesh.soundness import Soundness


def find_faults(after: Soundness, original_soundness: Callable[[], Soundness]) -> tuple[str, ...]:
    """
    List the reasons not to use a simplified mesh.

    A surface that is open or crosses may stay so, where the original does, but no worse.

    Parameters
    ----------
    after : Soundness
        Of the simplified mesh, compared with the original.
    original_soundness : callable
        Checks the original by itself; called only when it counts, for it takes long on a large mesh.

    Returns
    -------
    tuple of str
        Sentences; empty when it can be used.
    """
    if after.sound:
        return ()
    before, now = _counts(original_soundness()), _counts(after)
    return after.faults if any(now[what] > before[what] for what in now) else ()


def _counts(soundness: Soundness) -> dict[str, int]:
    health = soundness.health
    return {
        "openings": health.boundary_edges,
        "nonmanifold edges": health.nonmanifold_edges,
        "winding": int(not health.winding_consistent),
        "inside out": int(health.outward is False),
        "repeated": health.duplicate_facets,
        "inward parts": soundness.inward_parts,
        "nested parts": soundness.nested_parts,
        "pinched": len(soundness.pinched_vertices),
        "crossing": soundness.crossing,
        "overlapping": soundness.overlapping,
        "unchecked": int(not soundness.every_pair_checked),
        "folded": len(soundness.folded_facets),
        "without area": len(soundness.flat_facets),
    }
