"""A contact as one JSON object with its schema, as MCAP files and Foxglove take it."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from contactbench.pipeline.runtime.lines import Answer

CONTACT_SCHEMA = "contactbench.Contact"


def contact_message(answer: Answer, stamp: int) -> bytes:
    """Return a contact with its Unix time, ns, before the fields of its line."""
    seconds, nanoseconds = divmod(stamp, 1_000_000_000)
    head = f'{{"timestamp":{{"sec":{seconds},"nsec":{nanoseconds}}},"frame_id":"sensor",'
    return head.encode("ascii") + answer.line[1:-1]


def contact_schema() -> bytes:
    """Return the JSON schema of a contact."""
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
        "point_S_m": _numbers("In the sensor's frame, m; null: none."),
        "filtered_point_S_m": _numbers("Low-passed, m; held for a moment without contact."),
        "normal_S": _numbers("Outward."),
        "torque_Nm": _numbers("About the normal, N·m.", array=False),
        "force_S_N": _numbers("Of the tissue on the probe, compensated and filtered, N."),
        "torque_S_Nm": _numbers("The same, about the sensor's origin, N·m."),
        "covariance_S_m2": _numbers("Of the point, row by row, m²."),
        "within_m": _numbers("How far the 95 % ellipse of the point reaches, m; null: none.", array=False),
        "face": {**whole, "description": "-1: none."},
        "vertex": {**whole, "description": "-1: none."},
        "region": {**whole, "description": "Rank; 0: none."},
        "on": {
            **text,
            "description": "What the facet is: measured, invented (the file had an opening there) or untouchable;"
            " null: none.",
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
            "For how long that was learned of this touch, s; null: it is declared.", array=False
        ),
        "runner_up_S_m": _numbers("The likeliest other place, m; null: none."),
        "second_S_m": _numbers("Where a second touch has joined this one, m; null: none."),
        "zero": {
            "type": "object",
            "description": "What is known of the sensor's zero.",
            "properties": {
                "state": {
                    **text,
                    "description": "unknown, confirmed, doubtful (off, unless something touches the probe) or off.",
                },
                "age_s": _numbers(
                    "Since the last moment without touch, s; null: there was none.", array=False
                ),
                "force_S_N": _numbers("What the readings have too much, N; null: not known."),
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
                "raw_S": _numbers("As the sensor reads it, N and N·m; null: not used."),
            },
        },
    }
    schema = {"title": CONTACT_SCHEMA, "type": "object", "properties": fields}
    return json.dumps(schema, ensure_ascii=False).encode()


def _numbers(description: str, *, array: bool = True) -> dict[str, Any]:
    number = {"type": "number"}
    kind: dict[str, Any] = {"type": "array", "items": number} if array else number
    return {**kind, "description": description}
