import json
import math

import numpy as np
import pytest
from config.runtime.bundles import example
from hypothesis import given
from hypothesis import strategies as st

from contactbench.pipeline.runtime import Answer, make_runtime
from contactbench.pipeline.runtime.lines import HEALTH, health_names


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (0.0, "0"),
        (-0.0, "-0"),
        (1.0, "1"),
        (-2.5, "-2.5"),
        (0.001, "0.001"),
        (0.0001, "1e-04"),
        (0.00012, "0.00012"),
        (1e-7, "1e-07"),
        (1.5e-7, "1.5e-07"),
        (10_000.0, "10000"),
        (100_000.0, "1e+05"),
        (120_000.0, "120000"),
        (123_456.5, "123456.5"),
        (1e22, "1e+22"),
        (123456789012345680000.0, "123456789012345683968"),
        (5e-324, "5e-324"),
        (-1.5e300, "-1.5e+300"),
        (math.nan, "null"),
        (math.inf, "null"),
    ],
)
def test_number(value: float, text: str) -> None:
    assert written(value) == text


@given(st.floats(allow_nan=False, allow_infinity=False))
def test_numbers_read_back(value: float) -> None:
    back = float(written(value))
    assert back == json.loads(written(value)) == value
    assert math.copysign(1, back) == math.copysign(1, value)


def written(value: float) -> str:
    """Return a number as a line has it: a sample that is refused is told with its time."""
    runtime = make_runtime(example())
    contact = runtime.update(np.full(6, np.nan), np.eye(3), value)
    told: str = contact.line(runtime.zero(), 0.0).decode().partition(",")[0]
    return told.removeprefix('{"time":')


def test_without_a_pose() -> None:
    runtime = make_runtime(example())
    contact = runtime.locate(np.zeros(6), 2.5, 2.625)
    answer = Answer(contact, contact.latency, runtime.zero())
    told = json.loads(answer.line)
    assert answer.reason == told["reason"] == "stale"
    assert (told["time"], told["latency_s"], told["pose_age_s"]) == (2.5, 0.125, None)
    assert told["health"] == ["no_pose"]
    assert told["point_S_m"] is told["force_S_N"] is told["misfit"] is None
    assert told["accepted"] is False
    assert told["on"] is None
    assert answer.line.endswith(b"}\n")
    nothing = dict.fromkeys(("age_s", "force_S_N", "torque_S_Nm", "shift_m", "shift_sigma_m"))
    assert told["zero"] == {"state": "unknown", **nothing}
    message = json.loads(answer.message(1_500_000_000))
    assert message.pop("timestamp") == {"sec": 1, "nsec": 500_000_000}
    assert message.pop("frame_id") == "sensor"
    assert message == {key: value for key, value in told.items() if value is not None and key != "zero"} | {
        "zero": {"state": "unknown"}
    }
    before = answer.line, answer.message(7)
    answer.let_go()
    assert answer.contact is answer.zero is None
    assert (answer.line, answer.message(7)) == before


def test_every_bit_of_a_health_word_has_a_name() -> None:
    assert health_names(0) == ()
    assert health_names(0b10101) == ("frozen", "flagged", "clock")
    assert health_names(31) == HEALTH
