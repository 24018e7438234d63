"""Floats to their shortest text that reads back as the same float, many at once.

Python's ``repr`` takes about a microsecond for a float of 17 digits, and five of them per contact would
take longer than reading the wrench and locating the contact together.
"""

from typing import Any

import numpy as np
import numpy.typing as npt

# The longest repr of a float: -1.7976931348623157e+308.
WIDTH = 24

# Decimal exponents done here; all other numbers are left to repr. In this range every step below is exact.
_LOWEST, _END = -4, 12
_SPLITTER = float(2**27 + 1)
_BOUNDS = np.array([float(f"1e{e}") for e in range(_LOWEST, _END + 1)])

_QUADS = np.array([f"{i:04}" for i in range(10_000)], dtype="S4")
_STRIPPED = np.array([f"{i:04}".rstrip("0") for i in range(10_000)], dtype="S4")
# The second half ends a number: without trailing zeros.
_QUADS = np.concatenate((_QUADS, _STRIPPED)).view(np.uint32)


def shortest(values: npt.NDArray[np.float64]) -> npt.NDArray[np.uint8]:
    """
    Write each float as ``repr`` does: the fewest digits that give the same float when read.

    Parameters
    ----------
    values : (n,) float64
        Any numbers; NaN stands for a cell without a number.

    Returns
    -------
    (n, 24) uint8
        ASCII, with NUL bytes wherever there is no character, also between characters; NaN is all NUL.

    Notes
    -----
    For absolute values from 1e-4 to 1e12 the number x 10^p with 17 digits before the point is worked out
    exactly, as the sum of two floats. The shortest text is the nearest multiple of 100, else of 10, else
    of 1, that lies within half the distance to the neighbouring floats. Ties are left to ``repr``.
    """
    out = np.zeros((len(values), WIDTH), dtype=np.uint8)
    rows_out = out.view(f"V{WIDTH}")[:, 0]
    size = np.abs(values)
    exponent = np.searchsorted(_BOUNDS, size, side="right") + (_LOWEST - 1)  # NaN sorts behind all bounds
    left = ~np.isnan(values)
    counts = np.bincount(exponent - (_LOWEST - 1), minlength=_END - _LOWEST + 2)[1:-1]
    for e in (np.flatnonzero(counts) + _LOWEST).tolist():
        rows = np.flatnonzero(exponent == e)
        digits, sure = _digits(size[rows], 16 - e)
        rows, digits = rows[sure], digits[sure]
        rows_out[rows] = _layout(digits, e).view(f"V{WIDTH}")[:, 0]
        left[rows] = False
    out[(values < 0) & ~left, 0] = ord("-")
    rows = np.flatnonzero(left)
    if len(rows):
        texts = np.array([repr(x) for x in values[rows].tolist()], dtype=f"S{WIDTH}")
        out[rows] = texts.view(np.uint8).reshape(-1, WIDTH)
    return out


def csv_rows(*columns: npt.NDArray[Any]) -> bytes:
    """Write CSV lines of columns (n,), of floats or of texts without NUL bytes.

    Rows are laid side by side in a byte matrix, each column as wide as its longest cell, with NUL bytes in
    the gaps; taking these out leaves the text. No Python object is made per row.
    """
    widths = [WIDTH if column.dtype.kind == "f" else column.itemsize for column in columns]
    rows = np.empty((len(columns[0]), sum(widths) + len(widths)), dtype=np.uint8)
    end = -1
    for column, width in zip(columns, widths, strict=True):
        start, end = end + 1, end + 1 + width
        if column.dtype.kind == "f":
            rows[:, start:end] = shortest(column)
        else:
            rows[:, start:end] = column.view(np.uint8).reshape(-1, width)
        rows[:, end] = ord(",")
    rows[:, end] = ord("\n")
    return rows.tobytes().translate(None, b"\0")


def _digits(x: npt.NDArray[np.float64], p: int) -> tuple[npt.NDArray[np.int64], npt.NDArray[np.bool_]]:
    """Seventeen digits of the shortest text of x, as an integer near x 10^p, and whether that is certain."""
    high, low = _exact_product(x, float(10**p))
    below = np.floor(low)
    part = low - below  # exact: low has at most 50 bits
    whole = high.astype(np.int64) + below.astype(np.int64)
    half = np.spacing(x) * (0.5 * 10**p)  # to the ends of the interval that reads back as x
    hundreds = whole // 100
    tens = whole // 10
    from_hundred = (whole - 100 * hundreds) + part
    from_ten = (whole - 10 * tens) + part
    to_hundred = np.minimum(from_hundred, 100.0 - from_hundred)
    to_ten = np.minimum(from_ten, 10.0 - from_ten)
    digits = np.where(to_ten < half, 10 * (tens + (from_ten > 5.0)), whole + (part > 0.5))
    digits = np.where(to_hundred < half, 100 * (hundreds + (from_hundred > 50.0)), digits)
    sure = (to_hundred != half) & (to_ten != half) & (from_ten != 5.0) & (part != 0.5)
    sure &= x != np.trunc(x)  # whole numbers keep a zero behind the point
    sure &= np.frexp(x)[0] != 0.5  # below a power of two the floats are twice as dense
    return digits, sure


def _layout(digits: npt.NDArray[np.int64], e: int) -> npt.NDArray[np.uint8]:
    """Put the point of a number between 10^e and 10^(e+1) into its seventeen digits; (n, 24) uint8."""
    first = 2 - min(e, 0)
    names = ["lead", "a", "b", "c", "d"]
    offsets = [first, first + 1, first + 5, first + 9, first + 13]
    fields = np.dtype({"names": names, "formats": ["u1", *4 * ["u4"]], "offsets": offsets, "itemsize": WIDTH})
    records = np.zeros(len(digits), dtype=fields)
    last = np.ones(len(digits), dtype=bool)
    for name in reversed(names[1:]):
        rest = digits // 10_000
        quad = digits - 10_000 * rest
        records[name] = _QUADS.take(quad + 10_000 * last)
        last &= quad == 0
        digits = rest
    records["lead"] = digits + ord("0")
    out = records.view(np.uint8).reshape(-1, WIDTH)
    if e < 0:
        out[:, 1:first] = np.frombuffer(b"0." + b"0" * (-e - 1), dtype=np.uint8)
    else:
        out[:, 1 : e + 2] = out[:, 2 : e + 3].copy()
        out[:, e + 2] = ord(".")
    return out


def _exact_product(
    x: npt.NDArray[np.float64], y: Any
) -> tuple[npt.NDArray[np.float64], npt.NDArray[np.float64]]:
    """Veltkamp's and Dekker's product: the rounded x y, and what rounding took away."""
    big = _SPLITTER * x
    x_high = big - (big - x)
    x_low = x - x_high
    big = _SPLITTER * y
    y_high = big - (big - y)
    y_low = y - y_high
    product = x * y
    error = ((x_high * y_high - product) + x_high * y_low + x_low * y_high) + x_low * y_low
    return product, error
