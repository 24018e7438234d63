"""Messages survive the pipe, and bytes that are no message are refused, whatever they are."""

import io
import json

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

from contactbench.pipeline.mesh.engines.wire import WireError, WireMessage, read_message, write_message

_ARRAYS = st.sampled_from([np.float64, np.int64, np.int32, np.uint8, np.bool_]).flatmap(
    lambda dtype: hnp.arrays(dtype, hnp.array_shapes(min_dims=1, max_dims=2, min_side=0, max_side=5))
)
_FIELDS = st.dictionaries(st.text(max_size=5), st.integers(-1000, 1000) | st.booleans() | st.text(max_size=5))


def _bytes(message: WireMessage) -> bytes:
    stream = io.BytesIO()
    write_message(stream, message)
    return stream.getvalue()


def _message(header: object, content: bytes = b"") -> bytes:
    text = json.dumps(header).encode()
    return b"MESH" + len(text).to_bytes(4, "little") + text + content


@settings(max_examples=40, deadline=None)
@given(st.text(max_size=9), _FIELDS, st.dictionaries(st.text(max_size=5), _ARRAYS, max_size=3))
def test_a_message_arrives_as_it_was_sent(
    kind: str, fields: dict[str, object], arrays: dict[str, np.ndarray]
) -> None:
    stream = io.BytesIO(_bytes(WireMessage(kind, fields, arrays)) * 2)
    for _ in range(2):
        message = read_message(stream)
        assert message is not None
        assert (message.kind, message.fields) == (kind, fields)
        assert message.arrays.keys() == arrays.keys()
        for name, array in arrays.items():
            assert message.arrays[name].dtype == array.dtype
            np.testing.assert_array_equal(message.arrays[name], array)
    assert read_message(stream) is None


@given(st.integers(1, 200))
def test_a_message_cut_short_is_refused(length: int) -> None:
    whole = _bytes(WireMessage("done", {"a": 1}, {"x": np.arange(12.0)}))
    with pytest.raises(WireError):
        read_message(io.BytesIO(whole[: min(length, len(whole) - 1)]))


@given(st.lists(st.tuples(st.integers(0, 120), st.integers(0, 255)), min_size=1, max_size=4))
def test_damaged_bytes_give_a_message_or_are_refused(damage: list[tuple[int, int]]) -> None:
    data = bytearray(_bytes(WireMessage("done", {"a": 1}, {"x": np.ones((2, 3)), "y": np.ones(3, bool)})))
    for place, value in damage:
        data[place % len(data)] = value
    try:
        message = read_message(io.BytesIO(bytes(data)), most_bytes=1 << 16)
    except WireError:
        return
    assert isinstance(message, WireMessage)


@pytest.mark.parametrize(
    "row",
    [
        ["x", "<f8", [-1]],
        ["x", "<f8", [2**40]],
        ["x", "<f8", [True]],
        ["x", "<f8", [1.0]],
        ["x", "<f8", []],
        ["x", "<f8", [1, 1, 1]],
        ["x", "|O", [1]],
        ["x", "<f8"],
        [1, "<f8", [1]],
        "x",
    ],
)
def test_an_array_that_cannot_be_is_refused(row: object) -> None:
    with pytest.raises(WireError):
        read_message(io.BytesIO(_message({"kind": "done", "fields": {}, "arrays": [row]}, bytes(64))))


def test_an_announced_length_is_refused_before_memory_is_taken_for_it() -> None:
    header = {"kind": "done", "fields": {}, "arrays": [["x", "<f8", [2**30, 2**30]]]}
    with pytest.raises(WireError, match="more than"):
        read_message(io.BytesIO(_message(header)))


@pytest.mark.parametrize("header", [[], {}, {"kind": 1, "fields": {}, "arrays": []}, {"kind": "a"}, None])
def test_a_header_of_another_form_is_refused(header: object) -> None:
    with pytest.raises(WireError, match="header"):
        read_message(io.BytesIO(_message(header)))


def test_the_same_name_twice_is_refused() -> None:
    header = {"kind": "a", "fields": {}, "arrays": [["x", "<f8", [0]], ["x", "<f8", [0]]]}
    with pytest.raises(WireError, match="twice"):
        read_message(io.BytesIO(_message(header)))


def test_a_byte_that_is_no_truth_value_becomes_one() -> None:
    header = {"kind": "a", "fields": {}, "arrays": [["x", "|b1", [3]]]}
    message = read_message(io.BytesIO(_message(header, bytes([0, 1, 77]))))
    assert message is not None
    assert message.arrays["x"].view(np.uint8).tolist() == [0, 1, 1]


def test_other_dtypes_are_not_sent() -> None:
    with pytest.raises(WireError, match="'x' is float32"):
        _bytes(WireMessage("a", arrays={"x": np.zeros(3, np.float32)}))


def test_an_array_in_any_order_is_sent_as_its_rows() -> None:
    array = np.arange(12.0).reshape(3, 4).T[::2]
    message = read_message(io.BytesIO(_bytes(WireMessage("a", arrays={"x": array}))))
    assert message is not None
    np.testing.assert_array_equal(message.arrays["x"], array)
