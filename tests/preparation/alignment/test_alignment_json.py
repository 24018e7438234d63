"""JSON carries an alignment bit for bit, and nothing else passes for one."""

import json

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from contactbench.pipeline.preparation.alignment import (
    Alignment,
    AlignmentError,
    AlignmentMethod,
    align_points,
    from_angles,
    from_json,
)

PLAIN = json.loads(from_angles([1, 2, 3], [4, 5, 6]).to_json())


def same(a: Alignment, b: Alignment) -> bool:
    def equal(x, y):
        return (x is None) == (y is None) and (x is None or np.array_equal(x, y))

    return (
        (a.method, a.how, a.warnings, a.residual_m) == (b.method, b.how, b.warnings, b.residual_m)
        and np.array_equal(a.T_SP, b.T_SP)
        and equal(a.covariance, b.covariance)
        and equal(a.about_S, b.about_S)
    )


def test_what_is_written_is_read():
    points = np.random.default_rng(0).normal(size=(5, 3)) * 0.05
    full = align_points(points, points + [0.1, 0, 0])
    assert full.covariance is not None
    for alignment in (full, from_angles([1, 2, 3], [4, 5, 6])):
        text = alignment.to_json()
        assert same(from_json(text), alignment)
        assert from_json(text.encode()).method is alignment.method
        assert from_json(text).to_json() == text


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"schema": "contactbench.calibration"}, "choose an alignment file"),
        ({"version": 2}, "newer contactbench"),
        ({"method": "guessed"}, "method"),
        ({"T_SP_m": [[1, 0, 0, 0]] * 4}, "last row"),
        ({"T_SP_m": [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, -1, 0], [0, 0, 0, 1]]}, "mirrors"),
        ({"T_SP_m": [[1, 0, 0]]}, "T_SP_m"),
        ({"T_SP_m": "here"}, "T_SP_m"),
        ({"covariance": [[0.0] * 6] * 6}, "both or neither"),
        ({"how": ["x"] * 1000}, "how"),
        ({"how": "one sentence"}, "how"),
        ({"extra": 1}, "extra"),
        ({"residual_m": -1}, "residual_m"),
    ],
)
def test_a_file_that_says_something_else_is_refused(change, words):
    with pytest.raises(AlignmentError, match=words) as caught:
        from_json(json.dumps({**PLAIN, **change}), "mount.json")
    assert str(caught.value).startswith("mount.json: ")


@pytest.mark.parametrize("field", sorted(set(PLAIN) - {"schema"}))
def test_every_field_must_be_there(field):
    with pytest.raises(AlignmentError, match=field):
        from_json(json.dumps({key: value for key, value in PLAIN.items() if key != field}))


def test_what_is_not_json_is_refused():
    for data in (b"", b"\xff\xfe", "[" * 100_000, "null", "[]", '{"schema": NaN}', " " * 2_000_000):
        with pytest.raises(AlignmentError, match="alignment"):
            from_json(data)


@given(st.text(max_size=60), st.integers(0, 500))
def test_a_damaged_file_never_does_worse_than_an_alignment_error(text, at):
    whole = json.dumps(PLAIN)
    damaged = whole[:at] + text + whole[at + len(text) :]
    try:
        from_json(damaged)
    except AlignmentError:
        return
    assert AlignmentMethod(json.loads(damaged)["method"]) in AlignmentMethod
