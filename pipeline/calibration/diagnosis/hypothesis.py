"""One way to read poses."""

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from contactbench.pipeline.calibration.diagnosis.prior import Prior

AS_DECLARED = "as_declared"


@dataclass(frozen=True, eq=False)
class Hypothesis:
    """One way to read the poses."""

    key: str  # For programs
    title: str  # For tables, such as "orientations transposed"
    fact: str  # What is then true, a sentence without its full stop
    reading: str  # How to read the data then; completes "with ..."
    remedy: str  # What to do, whole sentences
    R_WS: NDArray[np.float64]  # (n, 3, 3) orientations, so read
    # (6,) what the recorded channels, in the order of `channels`, are to be multiplied by to give N and N·m
    # on the probe
    factor: NDArray[np.float64] = field(default_factory=lambda: np.ones(6))
    # (6,) which recorded channel is fx, fy, fz, mx, my, mz
    channels: NDArray[np.intp] = field(default_factory=lambda: np.arange(6))
    change: int = 0  # Index of the first pose with another bias; 0 when it never jumps
    # (n, 6) what is in the readings beside bias and weight, N and N·m; None: nothing
    beside: NDArray[np.float64] | None = None
    # (2,) whether forces, and torques, were recorded along the axes of the world, not of S
    in_world: tuple[bool, bool] = (False, False)
    share: float = 1.0  # How often it is made, among the mistakes of its family
    # How many differ from it by a number alone, such as the pose of a re-zero: they share one prior
    variants: int = 1
    # What is known of the load if it holds; left out: what was said. Such a reading leaves the data as they
    # are.
    prior: Prior | None = None
    telling: str = ""  # What tells it from others that explain the poses as well, a sentence

    @property
    def scales(self) -> bool:
        """Whether units are read as others."""
        return bool((np.abs(self.factor) != 1).any())

    def wrenches(self, recorded: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return recorded readings (n, 6), so read."""
        read = recorded[:, self.channels] * self.factor
        for half, in_world in zip((slice(0, 3), slice(3, 6)), self.in_world, strict=True):
            if in_world:
                read[:, half] = np.einsum("nji,nj->ni", self.R_WS, read[:, half])
        return read if self.beside is None else read - self.beside
