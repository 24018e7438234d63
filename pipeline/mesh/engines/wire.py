"""
Messages between the program and its mesh engines, and what is kept of a preparation: a JSON header, then arrays.

A message is ``b"MESH"``, the header's length as an unsigned 32-bit little-endian integer, the header in
UTF-8, and the arrays one after the other. The header is an object with ``kind``, ``fields`` (plain JSON
values) and ``arrays`` (name, dtype and shape of each). Nothing is ever unpickled, and no length, dtype or
shape is believed before it is checked, because the other side may have been corrupted by a bad mesh.
"""

import json
import math
from dataclasses import dataclass, field
from typing import Any, BinaryIO

import numpy as np
import numpy.typing as npt

from contactbench.pipeline.errors import arg, message

_Layout = dict[str, tuple[np.dtype[Any], tuple[int, ...]]]

_MAGIC = b"MESH"
_LONGEST_HEADER, _MOST_ARRAYS = 1 << 16, 16
# |i1 is also the bytes of a file.
_DTYPES = {text: np.dtype(text) for text in ("<f8", "<i8", "<i4", "|b1", "|u1", "|i1")}

# A hundred million facets; a length beyond it is a corrupt header, not a mesh.
MOST_BYTES = 100_000_000 * 12


class WireError(Exception):
    """Bytes on the pipe that are no message; within the package only."""


@dataclass(frozen=True)
class WireMessage:
    """
    One message.

    Attributes
    ----------
    kind : str
        What it is: a call, its result, a failure, or a sign of life.
    fields : dict
        Plain values.
    arrays : dict
        float64, int64, int32, int8, uint8 or bool arrays of one or two dimensions.
    """

    kind: str
    fields: dict[str, Any] = field(default_factory=dict)
    arrays: dict[str, npt.NDArray[Any]] = field(default_factory=dict)


def write_message(stream: BinaryIO, packet: WireMessage) -> None:
    """
    Write a message and flush.

    Raises
    ------
    WireError
        An array of another dtype.
    OSError, ValueError
        The pipe is broken or closed.
    """
    arrays = {name: _portable(name, array) for name, array in packet.arrays.items()}
    header = {
        "kind": packet.kind,
        "fields": packet.fields,
        "arrays": [[name, array.dtype.str, list(array.shape)] for name, array in arrays.items()],
    }
    text = json.dumps(header).encode()
    stream.write(_MAGIC + len(text).to_bytes(4, "little") + text)
    for array in arrays.values():
        # An empty array has no bytes that could be cast.
        if array.size:
            stream.write(array.reshape(-1).view(np.uint8).data)
    stream.flush()


def read_message(
    stream: BinaryIO,
    most_bytes: int = MOST_BYTES,
    longest_header: int = _LONGEST_HEADER,
    most_arrays: int = _MOST_ARRAYS,
) -> WireMessage | None:
    """
    Read a message.

    Parameters
    ----------
    stream : binary stream
        A pipe; it is read to the end of the message and no further.
    most_bytes : int
        Refuse arrays that together take more.
    longest_header, most_arrays : int
        Refuse a header of more bytes, or that names more arrays.

    Returns
    -------
    WireMessage or None
        None when the stream ended before the message began.

    Raises
    ------
    WireError
        The bytes are no message, or it is cut short.
    """
    first = stream.read(1)
    if not first:
        return None
    start = first + _exactly(stream, 7)
    length = int.from_bytes(start[4:], "little")
    if start[:4] != _MAGIC or not 0 < length <= longest_header:
        raise WireError(message("the bytes are not the start of a message"))
    kind, fields, layout = _parse_header(_exactly(stream, length))
    if len(layout) > most_arrays:
        raise WireError(message("the header lacks its kind, fields or arrays"))
    total = sum(dtype.itemsize * math.prod(shape) for dtype, shape in layout.values())
    if total > most_bytes:
        raise WireError(message(f"the header announces {arg(total)} bytes, more than {arg(most_bytes)}"))
    arrays = {name: _read_array(stream, dtype, shape) for name, (dtype, shape) in layout.items()}
    return WireMessage(kind, fields, arrays)


def _portable(name: str, array: npt.NDArray[Any]) -> npt.NDArray[Any]:
    if array.dtype.newbyteorder("<").str not in _DTYPES:
        raise WireError(
            message(f"array {arg(name)!r} is {arg(array.dtype)}: send float64, an integer or bool")
        )
    return np.ascontiguousarray(array, dtype=array.dtype.newbyteorder("<"))


def _parse_header(text: bytes) -> tuple[str, dict[str, Any], _Layout]:
    try:
        header = json.loads(text)
    except (ValueError, RecursionError) as error:
        raise WireError(message("the header is not JSON")) from error
    match header:
        case {"kind": str(kind), "fields": dict(fields), "arrays": list(rows)}:
            return kind, fields, _layout(rows)
    raise WireError(message("the header lacks its kind, fields or arrays"))


def _layout(rows: list[Any]) -> _Layout:
    layout: _Layout = {}
    for row in rows:
        match row:
            case [str(name), str(dtype), [*shape]] if dtype in _DTYPES and 1 <= len(shape) <= 2:
                # bool is an int to Python, and True would pass for a length of 1.
                if not all(type(length) is int and 0 <= length < 2**31 for length in shape):
                    raise WireError(message(f"array {arg(name)!r} has an impossible shape"))
                layout[name] = (_DTYPES[dtype], tuple(shape))
            case _:
                raise WireError(message("the header describes an array wrongly"))
    if len(layout) != len(rows):
        raise WireError(message("the header names an array twice"))
    return layout


def _read_array(stream: BinaryIO, dtype: np.dtype[Any], shape: tuple[int, ...]) -> npt.NDArray[Any]:
    array = np.empty(shape, dtype=dtype)
    view = array.reshape(-1).view(np.uint8).data
    done = 0
    while done < len(view):
        count = stream.readinto(view[done:])  # type: ignore[attr-defined]
        if not count:
            raise WireError(message("the message is cut short"))
        done += count
    if dtype == np.bool_:
        # Any byte but 0 and 1 would be a bool that equals neither.
        return np.not_equal(array.view(np.uint8), 0)
    return array.astype(dtype.newbyteorder("="), copy=False)


def _exactly(stream: BinaryIO, count: int) -> bytes:
    data = stream.read(count)
    if len(data) != count:
        raise WireError(message("the message is cut short"))
    return data
