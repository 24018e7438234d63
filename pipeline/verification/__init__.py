"""Is the contact point right? Markers, touches on them, and what the errors say."""

from contactbench.pipeline.verification.figures import Verification
from contactbench.pipeline.verification.markers import Marker, MarkerError, MarkerSet, load_markers, snap
from contactbench.pipeline.verification.spread import grid_markers, spread_markers

__all__ = [
    "Marker",
    "MarkerError",
    "MarkerSet",
    "Verification",
    "grid_markers",
    "load_markers",
    "snap",
    "spread_markers",
]
