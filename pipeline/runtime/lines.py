"""Contacts as lines of JSON, which the kernel writes as the C library does, and as messages with a schema."""

import json
from typing import Any

from contactbench.pipeline import kernel
from contactbench.pipeline.contact.facet_marks import MARKS

CONTACT_SCHEMA = "contactbench.Contact"

HEALTH = ("frozen", "silent", "flagged", "no_pose", "clock")
"""Names of the bits of a health word, from the lowest."""


def health_names(word: int) -> tuple[str, ...]:
    """Return what is wrong, by a health word; empty: nothing."""
    return tuple(name for bit, name in enumerate(HEALTH) if word >> bit & 1)


class Answer:
    """
    What the runtime says of one sample.

    Parameters
    ----------
    contact : kernel.RuntimeContact
    latency : float
        How old what the contact rests on was when this was known, the lag of the wrench filter included, s; NaN: not
        known.
    zero : kernel.Zero
        What is known of the sensor's zero at this sample.
    mark : int, optional
        Of the facet that the contact lies on, a place in `contactbench.pipeline.contact.facet_marks.MARKS`; -1: none.

    Attributes
    ----------
    contact : kernel.RuntimeContact or None
    zero : kernel.Zero or None
        None after `let_go`.
    time : float
        Of the sample, s of its own clock.
    reason : str
        Why there is a contact, or none.
    health : int
        Health word; see `health_names`.
    latency
        As given.
    on : str or None
        The word of the mark.
    """

    __slots__ = ("_fields", "_line", "_mark", "contact", "health", "latency", "on", "reason", "time", "zero")

    def __init__(
        self, contact: kernel.RuntimeContact, latency: float, zero: kernel.Zero, mark: int = -1
    ) -> None:
        self.contact: kernel.RuntimeContact | None = contact
        self.zero: kernel.Zero | None = zero
        self.time, self.reason, self.health, self.latency = (
            contact.time,
            contact.reason_name,
            contact.health,
            latency,
        )
        self._mark, self.on = mark, None if mark < 0 else MARKS[mark]
        self._line = self._fields = b""

    def let_go(self) -> None:
        """Keep the texts, not the contact: nothing of the kernel may outlive a program."""
        self._line, self._fields = self.line, self._without_nulls()
        self.contact = self.zero = None

    @property
    def line(self) -> bytes:
        """One line of JSON, its end included; made once, however many publish it."""
        # Two threads may both make it: it is the same.
        contact, zero = self.contact, self.zero
        if not self._line and contact is not None and zero is not None:
            self._line = contact.line(zero, self.latency, self._mark)
        return self._line

    def message(self, stamp: int) -> bytes:
        """Return it as one JSON object that `contact_schema` describes, with its Unix time, ns."""
        seconds, nanoseconds = divmod(stamp, 1_000_000_000)
        head = f'{{"timestamp":{{"sec":{seconds},"nsec":{nanoseconds}}},"frame_id":"sensor",'
        return head.encode("ascii") + self._without_nulls()[1:-1]

    def _without_nulls(self) -> bytes:
        contact, zero = self.contact, self.zero
        if not self._fields and contact is not None and zero is not None:
            self._fields = contact.line(zero, self.latency, self._mark, nulls=False)
        return self._fields


def contact_schema() -> bytes:
    """Return the JSON schema of a contact, of the plain types that viewers know: what there is none of is absent."""
    whole, text = {"type": "integer"}, {"type": "string"}
    fields = {
        "timestamp": {"type": "object", "properties": {"sec": whole, "nsec": whole}},
        "frame_id": text,
        "time": _numbers("The samples' clock, s.", array=False),
        "reason": {**text, "description": "Why there is a contact, or none."},
        "accepted": {"type": "boolean", "description": "Act only where it is true."},
        "health": {
            "type": "array",
            "items": text,
            "description": "What is wrong with sample, sensor or pose; empty: nothing.",
        },
        "latency_s": _numbers(
            "How old what the contact rests on was when it was known, the filter's lag included, s.",
            array=False,
        ),
        "pose_age_s": _numbers("How much older than the sample the last pose before it is, s.", array=False),
        "point_S_m": _numbers("In the sensor's frame, m; absent: none."),
        "filtered_point_S_m": _numbers("Low-passed, m; held for a moment without contact."),
        "normal_S": _numbers("Outward."),
        "torque_Nm": _numbers("About the normal, N·m.", array=False),
        "force_S_N": _numbers("Of the tissue on the probe, compensated and filtered, N."),
        "torque_S_Nm": _numbers("The same, about the sensor's origin, N·m."),
        "covariance_S_m2": _numbers("Of the point, row by row, m²."),
        "within_m": _numbers("How far the 95 % ellipse of the point reaches, m; absent: none.", array=False),
        "face": {**whole, "description": "-1: none."},
        "vertex": {**whole, "description": "-1: none."},
        "region": {**whole, "description": "Rank; 0: none."},
        "on": {
            **text,
            "description": "What the facet is: measured, invented (the file had an opening there) or untouchable;"
            " absent: none.",
        },
        "candidates": whole,
        "confidence": _numbers(
            "1 / (1 + the odds of every other place): 0 to 1, no probability.", array=False
        ),
        "misfit": _numbers("Of the best touch, in standard deviations squared.", array=False),
        "left_over_Nm": _numbers("Torque that the best touch does not explain, N·m.", array=False),
        "arm_m": _numbers("Torque along the force over the force, m.", array=False),
        "torsion_arm_m": _numbers("Torsion over force, 1 sigma, that it was judged by, m.", array=False),
        "torsion_since_s": _numbers(
            "For how long that was learned of this touch, s; absent: it is declared.", array=False
        ),
        "runner_up_S_m": _numbers("The likeliest other place, m; absent: none."),
        "second_S_m": _numbers("Where a second touch has joined this one, m; absent: none."),
        "zero": {
            "type": "object",
            "description": "What is known of the sensor's zero.",
            "properties": {
                "state": {
                    **text,
                    "description": "unknown, confirmed, doubtful (off, unless something touches the probe) or off.",
                },
                "age_s": _numbers(
                    "Since the last moment without touch, s; absent: there was none.", array=False
                ),
                "force_S_N": _numbers("What the readings have too much, N; absent: not known."),
                "torque_S_Nm": _numbers("The same, N·m."),
                "shift_m": _numbers("By how much that moves a contact of 10 N at most, m.", array=False),
                "shift_sigma_m": _numbers("One standard deviation of it, m.", array=False),
                "follows": {
                    **text,
                    "description": "waiting, following or stopped; absent where the zero does not follow.",
                },
                "seen_s": _numbers("Since the zero that follows was last seen, s.", array=False),
                "taken_S": _numbers("What was subtracted from the readings, N and N·m."),
                "taken_sigma_S": _numbers("One standard deviation of it at the last sample, N and N·m."),
                "raw_S": _numbers("As the sensor reads it, N and N·m; absent: not used."),
            },
        },
    }
    schema = {"title": CONTACT_SCHEMA, "type": "object", "properties": fields}
    return json.dumps(schema, ensure_ascii=False).encode()


def _numbers(description: str, *, array: bool = True) -> dict[str, Any]:
    number = {"type": "number"}
    kind: dict[str, Any] = {"type": "array", "items": number} if array else number
    return {**kind, "description": description}
