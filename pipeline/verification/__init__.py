"""Is the contact point right? Markers, touches on them, and what the errors say."""

from contactbench.pipeline.verification.figures import Cause, Limits, Times, Verification
from contactbench.pipeline.verification.markers import (
    Marker,
    MarkerError,
    MarkerSet,
    load_markers,
    make_markers,
    snap,
)
from contactbench.pipeline.verification.protocol import (
    ProtocolSettings,
    State,
    Touch,
    TouchEvent,
    TouchProtocol,
    Why,
)
from contactbench.pipeline.verification.spread import grid_markers, spread_markers
from contactbench.pipeline.verification.verify import VerifySettings, verify

__all__ = [
    "Cause",
    "Limits",
    "Marker",
    "MarkerError",
    "MarkerSet",
    "ProtocolSettings",
    "State",
    "Times",
    "Touch",
    "TouchEvent",
    "TouchProtocol",
    "Verification",
    "VerifySettings",
    "Why",
    "grid_markers",
    "load_markers",
    "make_markers",
    "snap",
    "spread_markers",
    "verify",
]
