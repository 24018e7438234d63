"""How recordings are read, beside the files that are given."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class HowRead:
    """
    What a recording does not say itself; as the options of ``contactbench heatmap draw``.

    Attributes
    ----------
    mount : (3,) or None
        How the sensor is turned against the flange: degrees about the fixed axes x, y, z. None: as a session says,
        not at all without one.
    delay : float
        How much later a wrench is heard than its pose, s.
    min_force : float
        Touches are above this, N.
    """

    mount: tuple[float, float, float] | None = None
    delay: float = 0.0
    min_force: float = 0.5
