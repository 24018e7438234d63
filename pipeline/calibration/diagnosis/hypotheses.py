"""Conventions that people get wrong: what each would make of the same recorded poses."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from contactbench.pipeline.calibration.diagnosis.hypothesis import AS_DECLARED, Hypothesis
from contactbench.pipeline.calibration.diagnosis.prior import Prior
from contactbench.pipeline.calibration.diagnosis.rereadings import RawOrientations, Rereadings
from contactbench.pipeline.calibration.diagnosis.rows import changes, orders
from contactbench.pipeline.calibration.diagnosis.turned import directions, mounts
from contactbench.pipeline.calibration.diagnosis.wrenches import signs, swaps, units

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from contactbench.pipeline.calibration.poses import Stack

__all__ = ["AS_DECLARED", "Hypothesis", "RawOrientations", "hypotheses"]


def hypotheses(
    poses: Stack,
    raw: RawOrientations | None,
    prior: Prior | None = None,
    times: NDArray[np.float64] | None = None,
) -> tuple[tuple[Hypothesis, ...], tuple[str, ...]]:
    """Return every way to read poses, as declared first, and in sentences what these data do not test.

    Mistakes come in families; each family is as probable as any other beforehand, so that many variants of one
    mistake do not add up.

    Parameters
    ----------
    poses : Stack
        As declared.
    raw : RawOrientations or None
        The numbers behind the orientations.
    prior : Prior, optional
        What is known of the load.
    times : (n,), optional
        Of the poses, s.

    Raises
    ------
    InputError
        `raw` are not the numbers behind the poses.
    """
    R_WS = poses.R_SW.transpose(0, 2, 1)
    rereadings = Rereadings(R_WS, raw)
    found = [
        Hypothesis(AS_DECLARED, "as declared", "The data are as declared", "the data as they are", "", R_WS)
    ]
    for family in (
        rereadings,
        units(R_WS),
        signs(R_WS),
        swaps(R_WS),
        mounts(R_WS),
        directions(R_WS, prior or Prior()),
        orders(R_WS, poses),
        changes(R_WS, times),
    ):
        members = list(family)
        total = sum(member.share / member.variants for member in members)
        found += [replace(member, share=member.share / total) for member in members]
    return tuple(found), tuple(rereadings.not_testable)
