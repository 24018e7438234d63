"""Is the contact point right? Markers, touches on them, and what the errors say."""

from contactbench.pipeline.verification.figures import ErrorCause, Times, Verification, VerificationLimits
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
    ProtocolState,
    Touch,
    TouchEvent,
    TouchProtocol,
    Why,
)
from contactbench.pipeline.verification.spread import grid_markers, spread_markers
from contactbench.pipeline.verification.verify import VerifySettings, verify

__all__ = [
    "ErrorCause",
    "Marker",
    "MarkerError",
    "MarkerSet",
    "ProtocolSettings",
    "ProtocolState",
    "Times",
    "Touch",
    "TouchEvent",
    "TouchProtocol",
    "Verification",
    "VerificationLimits",
    "VerifySettings",
    "Why",
    "grid_markers",
    "load_markers",
    "make_markers",
    "snap",
    "spread_markers",
    "verify",
]
