"""The chance of an effect: a stream of its own, so that turning one on does not move another."""

from zlib import crc32

import numpy as np

_REALITY = 22  # beside the streams of noise, load and touches, which begin with other numbers


def chance(seed: int, effect: str) -> np.random.Generator:
    """Return what an effect of a bench is drawn from."""
    return np.random.default_rng([seed, _REALITY, crc32(effect.encode())])
