"""The JSON schemas of the messages: what Foxglove and PlotJuggler are told about them.

Flange poses are a `foxglove.FrameTransform` and events a `foxglove.Log`, with fields of our own beside
theirs: a viewer shows them without being told how, and reading gives back exactly what was written.
"""

import json
from typing import Any

WRENCH_SCHEMA, FLANGE_SCHEMA, EVENT_SCHEMA = "contactbench.Wrench", "foxglove.FrameTransform", "foxglove.Log"


def _object(**properties: Any) -> dict[str, Any]:
    return {"type": "object", "properties": properties}


_NUMBER, _INTEGER, _STRING = {"type": "number"}, {"type": "integer"}, {"type": "string"}
_STAMP = _object(sec=_INTEGER, nsec=_INTEGER)
_XYZ = _object(x=_NUMBER, y=_NUMBER, z=_NUMBER)
_TIME = {"type": "number", "description": "When it was measured, on the samples' clock, s."}
_ARRIVAL = {"type": "number", "description": "When it arrived, on the same clock, s; left out where unknown."}
_DEVICE_TIME = {"type": "number", "description": "The device's clock, s; left out where it has none."}
_NUMBERS = {"type": "array", "items": _NUMBER}

_SCHEMAS = {
    WRENCH_SCHEMA: _object(
        timestamp=_STAMP,
        frame_id=_STRING,
        time=_TIME,
        force={**_XYZ, "description": "As the sensor gives it, N; null: not a number."},
        torque={**_XYZ, "description": "About the sensor's origin, N·m."},
        status={
            **_INTEGER,
            "description": "Flags: 1 overrange, 2 invalid, 4 raw, 8 late, 16 other error, 32 time is a guess.",
        },
        sequence={**_INTEGER, "description": "The device's own count; left out where it has none."},
        device_time=_DEVICE_TIME,
        arrival=_ARRIVAL,
        temperature={"type": "number", "description": "°C; left out where there is none."},
    ),
    FLANGE_SCHEMA: _object(
        timestamp=_STAMP,
        parent_frame_id=_STRING,
        child_frame_id=_STRING,
        translation={**_XYZ, "description": "m; null: unknown."},
        rotation=_object(x=_NUMBER, y=_NUMBER, z=_NUMBER, w=_NUMBER),
        time=_TIME,
        R={**_NUMBERS, "description": "The rotation once more, row by row: exactly as it was given."},
        joints={**_NUMBERS, "description": "rad; left out where unknown."},
        device_time=_DEVICE_TIME,
        arrival=_ARRIVAL,
    ),
    EVENT_SCHEMA: _object(
        timestamp=_STAMP,
        level=_INTEGER,
        message=_STRING,
        name=_STRING,
        file=_STRING,
        line=_INTEGER,
        time={"type": "number", "description": "When it happened, on the samples' clock, s."},
        event=_STRING,
        fields={"type": "object"},
    ),
}


def schema(name: str) -> bytes:
    """Return the JSON schema of that name."""
    return json.dumps({"title": name, **_SCHEMAS[name]}, ensure_ascii=False).encode()
