"""What a simplification is to reach."""

import math
from collections.abc import Callable
from dataclasses import dataclass

from contactbench.pipeline.errors import arg, message
from contactbench.pipeline.mesh.errors import MeshError
from contactbench.pipeline.mesh.probe import Probe

# A tetrahedron; a closed surface has no fewer.
FEWEST = 4


@dataclass(frozen=True)
class Count:
    """
    So many facets.

    Attributes
    ----------
    facets : int
        At least 4. A probe that has no more is left as it is.

    Raises
    ------
    MeshError
        Fewer than 4.
    """

    facets: int

    def __post_init__(self) -> None:
        if self.facets < FEWEST:
            raise MeshError(
                f"{arg(self.facets)} facets are too few: no closed surface has fewer than {arg(FEWEST)}."
            )


@dataclass(frozen=True)
class MaxDeviation:
    """
    The fewest facets found whose Hausdorff distance from the original is within a limit.

    Attributes
    ----------
    metres : float
        The limit, above 0.

    Raises
    ------
    MeshError
        Not a length above 0.
    """

    metres: float

    def __post_init__(self) -> None:
        _refuse_unless_positive(self.metres, message("the largest deviation"))


@dataclass(frozen=True)
class MaxError:
    """
    The fewest facets found whose error, by a measure of the caller's, is within a limit.

    Attributes
    ----------
    measure : callable
        Takes a simplified probe, returns its error; 0 or more, and on the whole smaller for more facets.
    limit : float
        In the measure's unit, above 0.
    farthest : float
        Hausdorff distance from the original that no facet count may exceed, metres: a measure over the whole
        surface may not see a small part of it vanish, such as letters.
    enough : int
        Fewer facets than this gain nothing: a probe that has no more is left as it is.

    Raises
    ------
    MeshError
        A limit that is not above 0.
    """

    measure: Callable[[Probe], float]
    limit: float
    farthest: float = math.inf
    enough: int = FEWEST

    def __post_init__(self) -> None:
        _refuse_unless_positive(self.limit, message("the largest error"))


Target = Count | MaxDeviation | MaxError


def _refuse_unless_positive(value: float, what: str) -> None:
    if not (math.isfinite(value) and value > 0):
        raise MeshError(f"{arg(what)} is {arg(value):g}: give a number above 0.")
