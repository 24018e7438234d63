"""Numbers in text to floats, many at once, each to the same bit as Python's `float`."""

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from contactbench.pipeline.errors import message
from contactbench.pipeline.kernel import plain_rows


def numbers_of(
    block: bytes,
    cells: int,
    columns: Sequence[int],
    required: Sequence[bool],
    text: int | None = None,
    longest_text: int = 256,
) -> tuple[npt.NDArray[np.float64], npt.NDArray[np.bytes_] | None] | None:
    """
    Read lines of cells without quotes.

    Parameters
    ----------
    block : bytes
        Whole lines.
    cells : int
        In each of them.
    columns : sequence of int
        Those of the k columns of numbers.
    required : sequence of bool
        Of each of them: whether no cell may be empty, which else is NaN.
    text : int, optional
        A column to pass on as it stands.
    longest_text : int
        In bytes.

    Returns
    -------
    The numbers (n, k), and the texts (n,) if there are any; None: a line is not like that.
    """
    found = plain_rows(
        block, cells, list(columns), list(required), -1 if text is None else text, longest_text
    )
    if found is None:
        return None
    numbers, unsure, where, texts = found
    cells_left = [block[first:last] for first, last in where.tolist()]
    try:
        # Python also takes 1_000, which no other reader does.
        numbers.ravel()[unsure] = [float(b"no number" if b"_" in each else each) for each in cells_left]
    except ValueError:
        return None
    return numbers, None if texts is None else texts.view(f"S{texts.shape[1]}")[:, 0]


def floats_of(cells: Sequence[bytes]) -> npt.NDArray[np.float64]:
    """Read texts (n,) without commas as numbers; NaN where one is empty, and ValueError where one is no number."""
    found = numbers_of(b"".join((b"\n".join(cells), b"\n")), 1, (0,), (False,)) if cells else None
    if found is None or len(found[0]) != len(cells):
        raise ValueError(message("one of the cells is no number"))
    return found[0][:, 0]
