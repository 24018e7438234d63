"""
What a controller does with a contact, by the reason that stands beside it.

==============================================================  =====================================================
reason                                                          what it does
==============================================================  =====================================================
ok, vertex, by_region                                           turns by the place: who declares regions says where
                                                                it may be touched
ambiguous, uncertain,                                           turns by the likeliest place or the second, whichever
by_region where a bundle's gates do not accept it               is within 10 mm of the last sure one; else as below
two_touches, low_force, tangential, off_surface,                keeps the force and does not turn; after 2 s it goes
outside_region, implausible                                     back
stale, not_finite, not_a_rotation, unhealthy                    holds: the readings are not to be believed
saturated                                                       goes back: the force may be anything
==============================================================  =====================================================
"""

from enum import StrEnum

import numpy as np
from numpy.typing import NDArray

from contactbench.pipeline.errors import message
from contactbench.pipeline.kernel import Contact, Reason

NEAR_M, NEAR_S = 0.01, 0.5  # how far from the last sure place, and how old that may be


class Heed(StrEnum):
    """What is done."""

    TURN = message("turn by it")
    NEAR = message("turn by what is near the last sure place")
    KEEP = message("keep the force")
    HOLD = "hold"
    RETRACT = message("go back")


HEED = {
    Reason.OK: Heed.TURN,
    Reason.VERTEX: Heed.TURN,
    Reason.BY_REGION: Heed.NEAR,
    Reason.AMBIGUOUS: Heed.NEAR,
    Reason.UNCERTAIN: Heed.NEAR,
    Reason.TWO_TOUCHES: Heed.KEEP,
    Reason.LOW_FORCE: Heed.KEEP,
    Reason.TANGENTIAL: Heed.KEEP,
    Reason.OFF_SURFACE: Heed.KEEP,
    Reason.OUTSIDE_REGION: Heed.KEEP,
    Reason.IMPLAUSIBLE: Heed.KEEP,
    Reason.STALE: Heed.HOLD,
    Reason.NOT_FINITE: Heed.HOLD,
    Reason.NOT_A_ROTATION: Heed.HOLD,
    Reason.UNHEALTHY: Heed.HOLD,
    Reason.SATURATED: Heed.RETRACT,
}


def heed(contact: Contact) -> Heed:
    """Return what is done with a contact; what its own gates accept is as good as sure."""
    return Heed.TURN if contact.accepted else HEED[Reason(contact.reason)]


class SurePlace:
    """Where the probe was touched for sure the last time."""

    def __init__(self) -> None:
        self._place: NDArray[np.float64] | None = None
        self._since = -np.inf

    def take(self, contact: Contact, time: float) -> NDArray[np.float64] | None:
        """Return the place to turn by, (3,) in S; None: there is none. `time` is that of the readings, s."""
        what = heed(contact)
        if what is Heed.TURN:
            self._place, self._since = contact.point, time
            return contact.point
        if what is not Heed.NEAR or self._place is None or time - self._since > NEAR_S:
            return None
        places = [each for each in (contact.point, contact.second) if each is not None]
        off = [float(np.linalg.norm(each - self._place)) for each in places]
        if not off or min(off) > NEAR_M:
            return None
        self._place = places[int(np.argmin(off))]
        return self._place
