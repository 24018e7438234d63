"""Where words stand on screen: beside their points, and on no marker and no other word."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

_MOST = 80  # words at once: more are not read, and looking for their places costs time
_GAP = 3.0  # pixels between two words
_NEAR, _RINGS = 10.0, (1.0, 2.2, 4.0, 6.5, 9.5)  # pixels from the point; in how many of them it is looked
# To the right first, as one reads; then left, above, below and the corners.
_DIRECTIONS = np.array(
    [(1.0, 0.0), (-1.0, 0.0), (0.8, -0.7), (0.8, 0.7), (-0.8, -0.7), (-0.8, 0.7), (0.0, -1.0), (0.0, 1.0)]
)
BESIDE = len(_DIRECTIONS)
"""Places before this number are right beside the point: no line need lead to it."""
_CANDIDATES = np.concatenate([ring * _DIRECTIONS for ring in _RINGS])


@dataclass(frozen=True)
class Word:
    """A word that looks for its place; all in device pixels, from the left and the top."""

    x: float  # x, y: the point that it belongs to
    y: float
    width: float
    height: float
    near: bool = False  # it stands right beside its point or nowhere
    last: int = 0  # where it stood in the frame before: there it stays as long as it can


def label_places(
    words: Sequence[Word],
    kept_free: NDArray[np.float64],
    size: tuple[int, int],
    ratio: float = 1.0,
) -> list[tuple[float, float, int] | None]:
    """
    Return where words stand: left, top, and the number of the place among those that were tried; None: nowhere.

    Words are placed one after the other, each at the first of forty places about its point that is free; the more
    important ones come first. What finds none is not shown, rather than covering something.

    Parameters
    ----------
    words : sequence of Word
        The most important first.
    kept_free : (k, 4)
        Left, top, right and bottom of what must not be covered.
    size : (width, height)
        Of the picture.
    ratio : float
        Device pixels per pixel.
    """
    taken = np.empty((len(kept_free) + len(words), 4))
    taken[: len(kept_free)] = kept_free
    count = len(kept_free)
    found: list[tuple[float, float, int] | None] = []
    for word in words[:_MOST]:
        boxes = _boxes(word, ratio)
        inside = (boxes[:, :2] >= 0).all(axis=1) & (boxes[:, 2] <= size[0]) & (boxes[:, 3] <= size[1])
        others = taken[:count, None]
        covers = (
            (boxes[:, 0] < others[..., 2] + _GAP)
            & (boxes[:, 2] > others[..., 0] - _GAP)
            & (boxes[:, 1] < others[..., 3] + _GAP)
            & (boxes[:, 3] > others[..., 1] - _GAP)
        ).any(axis=0)
        free = np.flatnonzero(inside & ~covers)
        free = free[free < BESIDE] if word.near else free
        if not len(free):
            found.append(None)
            continue
        place = word.last if word.last in free else int(free[0])
        taken[count] = boxes[place]
        count += 1
        found.append((float(boxes[place, 0]), float(boxes[place, 1]), place))
    return found + [None] * (len(words) - len(found))


def _boxes(word: Word, ratio: float) -> NDArray[np.float64]:
    """Return left, top, right and bottom (40, 4) of the places that a word may have."""
    middle = np.array([word.x, word.y]) + ratio * _NEAR * _CANDIDATES
    # a word to the right of its point begins there, one to the left ends there, one above stands centred
    shift = 0.5 * (np.sign(np.round(_CANDIDATES, 9)) - 1.0) * [word.width, word.height]
    corner = middle + shift
    corner = np.where(_CANDIDATES == 0.0, middle - 0.5 * np.array([word.width, word.height]), corner)
    return np.concatenate([corner, corner + [word.width, word.height]], axis=1)
