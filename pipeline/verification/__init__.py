"""Is the contact point right? Markers, touches on them, and what the errors say."""

from pipeline.verification.figures import Cause, Limits, Times, Verification
from pipeline.verification.markers import Marker, MarkerError, MarkerSet, load_markers, make_markers, snap
from pipeline.verification.protocol import ProtocolSettings, State, Touch, TouchEvent, TouchProtocol, Why
from pipeline.verification.spread import grid_markers, spread_markers
from pipeline.verification.verify import VerifySettings, verify

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
