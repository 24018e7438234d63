"""Mistakes in the readings: units, signs, swapped and reversed channels."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from contactbench.pipeline.calibration.diagnosis.hypothesis import Hypothesis
from contactbench.pipeline.calibration.model import STANDARD_GRAVITY

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.typing import NDArray

_KGF, _LBF, _INCH, _FOOT = STANDARD_GRAVITY, 0.45359237 * STANDARD_GRAVITY, 0.0254, 0.3048
_NAMES = ("fx", "fy", "fz", "mx", "my", "mz")
_REMEDY = "Multiply {} by -1, or set the sign in the driver."
_OFTEN, _MOST = 5.0, 20.0  # as often as the rarest variants


def units(R_WS: NDArray[np.float64]) -> Iterator[Hypothesis]:
    """Yield other units of the readings.

    Parameters
    ----------
    R_WS : (n, 3, 3)
        Orientations as declared.
    """
    for key, title, fact, force, torque, share in (
        ("torque_Nmm", "torques in N·mm", "Torques are in N·mm", 1, 1e-3, _OFTEN),
        ("torque_Ncm", "torques in N·cm", "Torques are in N·cm", 1, 1e-2, 1.0),
        (
            "torque_1000_too_small",
            "torques 1000 times too small",
            "Torques are 1000 times too small, as if N·m had been taken for N·mm and divided once too often",
            1,
            1e3,
            1.0,
        ),
        ("torque_lbfin", "torques in lbf·in", "Torques are in lbf·in", 1, _LBF * _INCH, 1.0),
        ("torque_kgfcm", "torques in kgf·cm", "Torques are in kgf·cm", 1, _KGF / 100, 0.5),
        ("force_kgf", "forces in kgf", "Forces are in kgf", _KGF, 1, 1.0),
        ("force_kgf_torque_Nmm", "forces in kgf with torques in N·mm", "Forces are in kgf and torques in N·mm",
         _KGF, 1e-3, 1.0),
        ("force_kgf_torque_Ncm", "forces in kgf with torques in N·cm", "Forces are in kgf and torques in N·cm",
         _KGF, 1e-2, 0.5),
        ("force_kgf_torque_kgfcm", "forces in kgf with torques in kgf·cm",
         "Forces are in kgf and torques in kgf·cm", _KGF, _KGF / 100, 1.0),
        ("force_kgf_torque_kgfm", "forces in kgf with torques in kgf·m", "Forces are in kgf and torques in kgf·m",
         _KGF, _KGF, 1.0),
        ("force_lbf", "forces in lbf", "Forces are in lbf", _LBF, 1, 1.0),
        ("force_lbf_torque_lbfin", "forces in lbf with torques in lbf·in",
         "Forces are in lbf and torques in lbf·in", _LBF, _LBF * _INCH, 2.0),
        ("force_lbf_torque_lbfft", "forces in lbf with torques in lbf·ft",
         "Forces are in lbf and torques in lbf·ft", _LBF, _LBF * _FOOT, 2.0),
    ):  # fmt: skip
        what = " and ".join(
            f"{name} by {value:.6g}" for name, value in (("forces", force), ("torques", torque)) if value != 1
        )
        yield Hypothesis(
            key,
            title,
            fact,
            f"{what.replace(' by', ' multiplied by')}",
            f"Multiply {what}.",
            R_WS,
            np.repeat([force, torque], 3).astype(np.float64),
            share=share,
        )


def signs(R_WS: NDArray[np.float64]) -> Iterator[Hypothesis]:
    """Yield readings with reversed signs: of all channels, of forces or torques, of an axis, of one channel."""
    every = np.arange(6)
    for key, what, wrong, why, share in (
        ("wrench_negated", "forces and torques", every < 6, ", as a sensor that reports the reaction has", _MOST),
        ("torque_negated", "torques", every >= 3, "", _MOST),
        ("force_negated", "forces", every < 3, "", _OFTEN),
    ):  # fmt: skip
        yield Hypothesis(
            key,
            f"{what} with the wrong sign",
            f"The {what} have the wrong sign{why}",
            f"{what} negated",
            _REMEDY.format(what),
            R_WS,
            np.where(wrong, -1.0, 1.0),
            share=share,
        )
    for axis, name in enumerate("xyz"):
        yield Hypothesis(
            f"axis_{name}_reversed",
            f"{name} axis reversed",
            f"The sensor's {name} axis is reversed",
            f"f{name} and m{name} negated",
            _REMEDY.format(f"f{name} and m{name}"),
            R_WS,
            np.where(every % 3 == axis, -1.0, 1.0),
        )
    for channel, name in enumerate(_NAMES):
        yield Hypothesis(
            f"{name}_negated",
            f"{name} with the wrong sign",
            f"The channel {name} has the wrong sign",
            f"{name} negated",
            _REMEDY.format(name),
            R_WS,
            np.where(every == channel, -1.0, 1.0),
        )


def swaps(R_WS: NDArray[np.float64]) -> Iterator[Hypothesis]:
    """Yield readings whose channels are in another order."""
    for a, b in ((0, 1), (1, 2), (0, 2)):
        for pairs in (((a, b), (a + 3, b + 3)), ((a, b),), ((a + 3, b + 3),)):
            channels = np.arange(6)
            for one, other in pairs:
                channels[[one, other]] = other, one
            words = [f"{_NAMES[one]} with {_NAMES[other]}" for one, other in pairs]
            key = "_".join(f"{_NAMES[one]}_{_NAMES[other]}" for one, other in pairs) + "_swapped"
            yield _swapped(R_WS, key, " and ".join(words), channels)
    yield _swapped(R_WS, "force_torque_swapped", "forces with torques", np.roll(np.arange(6), 3))


def _swapped(R_WS: NDArray[np.float64], key: str, what: str, channels: NDArray[np.intp]) -> Hypothesis:
    return Hypothesis(
        key,
        f"{what} swapped",
        f"Channels are swapped: {what}",
        "them swapped back",
        f"Swap {what} in the columns' names or the driver.",
        R_WS,
        channels=channels,
    )
