from __future__ import annotations

import json
import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from pipeline.runtime import Answer
from pipeline.runtime.lines import number


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
    assert number(value) == text


@given(st.floats(allow_nan=False, allow_infinity=False))
def test_numbers_read_back(value: float) -> None:
    back = float(number(value))
    assert back == json.loads(number(value)) == value
    assert math.copysign(1, back) == math.copysign(1, value)


def test_without_a_pose() -> None:
    answer = Answer(2.5, None)
    told = json.loads(answer.line)
    assert answer.reason == told["reason"] == "stale"
    assert told["time"] == 2.5
    assert told["point_S_m"] is told["force_S_N"] is told["misfit"] is None
    assert told["accepted"] is False
    assert answer.line.endswith(b"}\n")
