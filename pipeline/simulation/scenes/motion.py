"""How a hand moves: slow turns and slides, and a tremor on top."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from contactbench.pipeline.errors import InputError, arg

_TREMOR_HZ = (8.0, 12.0)
_SLOW_HZ = (0.1, 0.6)
_WAVES = 3


@dataclass(frozen=True, eq=False)
class Motion:
    """
    A sum of sines in each of x, y, z (m) and the three angles about x, y, z (rad); smooth at every time.

    Attributes
    ----------
    offset : (6,)
        Mean.
    amplitudes, frequencies, phases : (k, 6)
        m or rad, Hz, rad.
    """

    offset: NDArray[np.float64]
    amplitudes: NDArray[np.float64]
    frequencies: NDArray[np.float64]
    phases: NDArray[np.float64]

    def at(self, time: float) -> NDArray[np.float64]:
        """Return the pose, (6,), at a time, s."""
        return np.asarray(
            self.offset
            + (self.amplitudes * np.sin(2 * np.pi * self.frequencies * time + self.phases)).sum(axis=0)
        )


def hand_motion(
    seed: int = 0,
    *,
    depth: float = 0.004,
    heave: float = 0.002,
    slide: float = 0.004,
    turn: float = np.radians(8.0),
    tremor: float = 1e-4,
) -> Motion:
    """
    Draw a motion as a hand's.

    Parameters
    ----------
    seed : int
    depth, heave : float
        How deep the probe is pressed on average, and how far that goes up and down, m.
    slide : float
        How far it slides to either side, m.
    turn : float
        How far it turns to either side, rad; a third of it about the vertical.
    tremor : float
        Amplitude at 8 to 12 Hz, m.

    Raises
    ------
    InputError
        A number is negative or not finite.
    """
    sizes = np.array([depth, heave, slide, turn, tremor])
    if not np.isfinite(sizes).all() or (sizes < 0).any():
        raise InputError(f"hand motion: {arg(sizes)}: give finite numbers of 0 or more.")
    rng = np.random.default_rng(seed)
    largest = np.array([slide, slide, heave, turn, turn, turn / 3])
    shares = rng.uniform(0.3, 1.0, (_WAVES, 6))
    slow = largest * shares / shares.sum(axis=0)
    fast = np.array([tremor] * 3 + [0.0] * 3)[None] * rng.uniform(0.3, 1.0, (1, 6))
    frequencies = np.vstack([rng.uniform(*_SLOW_HZ, (_WAVES, 6)), rng.uniform(*_TREMOR_HZ, (1, 6))])
    return Motion(
        np.array([0.0, 0.0, -depth, 0.0, 0.0, 0.0]),
        np.vstack([slow, fast]),
        frequencies,
        rng.uniform(0, 2 * np.pi, frequencies.shape),
    )
