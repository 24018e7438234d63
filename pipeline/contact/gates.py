"""When an answer is given, and when it is not."""

from dataclasses import dataclass, field
from math import cos, inf, isfinite, isnan, radians
from typing import Any

import numpy as np

from pipeline.errors import InputError

_UNLIMITED = (inf, inf, inf, inf, inf, inf)


@dataclass(frozen=True)
class Gates:
    """Limits that decide between the reason codes; every length in metres, force in newtons.

    Parameters
    ----------
    min_force : float
        ``low_force`` under this |F|, N. Default 0.5: with 0.05 N of noise the force direction is then known
        to 6 degrees and the point to some 15 mm; below, an answer would only be noise.
    friction_angle : float
        Largest angle between -F and the outward normal, degrees, under 90. Default 75: friction would
        have to exceed 3.7, and the noise bound is already four times that of a perpendicular touch.
        Candidates beyond it lose; if there are no others the reason is ``tangential``.
    ambiguity_distance : float
        ``ambiguous`` when another candidate this far from the likeliest one cannot be ruled out, m.
        Default 5 mm: less is within the spread of a light touch and does no harm to a controller. A near miss
        (`rival_sigmas`) counts from twice this distance and the noise of the axis on.
    torque_ratio : float
        A candidate counts against the likeliest one only while its local torque is at most this many times
        larger, at least 1. Default 1.5: for one wrench the torque grows as 1/cos(friction angle), so the true
        contact can lose unnoticed only where friction exceeds 48 degrees. A steeper world needs more. For
        near misses the ratio of those cosines is taken.
    rival_sigmas : float
        A facet that would accept the wrench were it this many standard deviations different counts as
        such a candidate; finite. Default 3. On the rim of a T-shape noise can hide the true contact
        altogether. Where so many of them turn the force by half a radian, every answer on a probe that is
        not convex is ``ambiguous``.
    follow_distance : float
        Candidates this near to the previous accepted contact are preferred to all others, m. Default
        10 mm: at 200 Hz a probe that slides at 1 m/s moves 5 mm, and a light touch scatters by 5 mm.
    recent_samples : int
        The previous contact is forgotten after this many samples in a row without an accepted one.
        Default 20: 0.1 s at 200 Hz, shorter than any deliberate lift and touch.
    max_age : float
        ``stale`` when a sample is older, s. Default 0.1: five control cycles of a 50 Hz robot.
    saturation : tuple of 6 floats
        ``saturated`` when a channel reaches this, N and N·m. Default none: take it from the data sheet
        of the sensor, because a clipped channel looks like any other number.
    region_only : bool
        ``outside_region`` for a contact outside every declared region. Default off: regions are a
        preference among candidates, not a fence.

    Raises
    ------
    InputError
        A limit is out of its range.
    """

    min_force: float = 0.5
    friction_angle: float = 75.0
    ambiguity_distance: float = 0.005
    torque_ratio: float = 1.5
    rival_sigmas: float = 3.0
    follow_distance: float = 0.010
    recent_samples: int = 20
    max_age: float = 0.1
    saturation: tuple[float, float, float, float, float, float] = field(default=_UNLIMITED)
    region_only: bool = False

    def __post_init__(self) -> None:
        for name in ("min_force", "ambiguity_distance", "rival_sigmas", "follow_distance", "max_age"):
            value = getattr(self, name)
            if isnan(value) or value < 0:
                raise InputError(f"Gates.{name} must be at least 0, not {value}")
        if not 0 < self.friction_angle < 90:
            raise InputError(
                f"Gates.friction_angle must be between 0 and 90 degrees, not {self.friction_angle}"
            )
        if not self.torque_ratio >= 1:
            raise InputError(f"Gates.torque_ratio must be at least 1, not {self.torque_ratio}")
        if not isfinite(self.rival_sigmas):
            raise InputError(f"Gates.rival_sigmas must be finite, not {self.rival_sigmas}")
        if not isinstance(self.recent_samples, int) or not 0 <= self.recent_samples < 2**63:
            raise InputError(
                f"Gates.recent_samples must be a whole number of at least 0, not {self.recent_samples}"
            )
        if len(self.saturation) != 6 or any(isnan(v) or v <= 0 for v in self.saturation):
            raise InputError(f"Gates.saturation needs six positive limits (N, N·m), not {self.saturation}")

    def kernel_arguments(self) -> dict[str, Any]:
        """Return the keyword arguments of :class:`pipeline.kernel.Solver`."""
        return {
            "min_force": self.min_force,
            "cos_friction": cos(radians(self.friction_angle)),
            "ambiguity_distance": self.ambiguity_distance,
            "torque_ratio": self.torque_ratio,
            "rival_sigmas": self.rival_sigmas,
            "follow_distance": self.follow_distance,
            "recent_samples": self.recent_samples,
            "max_age": self.max_age,
            "saturation": np.array(self.saturation, dtype=np.float64),
            "region_only": self.region_only,
        }
