"""Frames that are not where they were said to be: the sensor on the flange, gravity in the world, the tool."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
from scipy.spatial.transform import Rotation

from contactbench.pipeline.calibration.diagnosis.hypothesis import Hypothesis
from contactbench.pipeline.calibration.diagnosis.prior import angle_between

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.typing import NDArray

    from contactbench.pipeline.calibration.diagnosis.evidence import Evidence
    from contactbench.pipeline.calibration.diagnosis.prior import Prior

YAW, MOUNT, WORLD, TOOL_BEHIND = "yaw", "mount", "world_turned", "tool_behind"
_YAWS = (90, 180, 270)
_OFTEN = 3.0  # right angles are more common than any other turn
_APART = np.radians(30)  # gravity along an axis this far from down is another hypothesis


def mounts(R_WS: NDArray[np.float64]) -> Iterator[Hypothesis]:
    """Yield sensors that are turned on the flange: by right angles, by any angle about z, in any way."""
    for angle in _YAWS:
        turn = Rotation.from_euler("z", angle, degrees=True).as_matrix()
        yield Hypothesis(f"yaw_{angle}", *_about_z(angle), R_WS @ turn, share=_OFTEN)
    for key, free in ((YAW, (False, False, True)), (MOUNT, (True, True, True))):
        yield Hypothesis(key, "", "", "", "", R_WS, free=free, fitted=True)


def directions(R_WS: NDArray[np.float64], prior: Prior) -> Iterator[Hypothesis]:
    """Yield other directions of gravity in the world, and of the tool from the sensor: the data stay as they are."""
    down = np.array(prior.down_W)
    for axis in np.concatenate([np.eye(3), -np.eye(3)]):
        if angle_between(axis, down) > _APART:
            name = f"{'-' if axis.sum() < 0 else '+'}{'xyz'[int(np.argmax(np.abs(axis)))]}"
            often = 8.0 if axis @ down < -0.9 else 1.0  # a ceiling is more common than a wall
            there = replace(prior, down_W=tuple(axis))
            yield Hypothesis(f"gravity_along_{name}", *_gravity(axis, name), R_WS, share=often, prior=there)
    yield Hypothesis(WORLD, "", "", "", "", R_WS, share=4.0, prior=prior, fitted=True)
    behind = replace(prior, tool_axis_S=tuple(-np.array(prior.tool_axis_S)))
    yield Hypothesis(
        TOOL_BEHIND,
        "tool on the other side of the sensor",
        "The sensor's z axis points away from the tool",
        "the tool on the other side of the sensor",
        "If the sensor is mounted so, the data are right as they are.",
        R_WS,
        share=8.0,
        prior=behind,
    )


def settled(hypothesis: Hypothesis, evidence: Evidence, prior: Prior) -> Hypothesis:
    """Return a hypothesis with the turn, or the direction of gravity, that was found, and its words."""
    if not hypothesis.fitted:
        return hypothesis
    if hypothesis.key == WORLD:
        g = evidence.gravity_W
        down = g / max(float(np.linalg.norm(g)), 1e-12)
        words = ", ".join(f"{value:.2f}" for value in down + 0.0)
        title, fact, reading, remedy = _gravity(down, f"({words})")
        found = replace(prior, down_W=tuple(down)) if g.any() else prior
        return replace(hypothesis, title=title, fact=fact, reading=reading, remedy=remedy, prior=found)
    turn = Rotation.from_matrix(hypothesis.R_WS[0].T @ evidence.R_WS[0])
    vector = turn.as_rotvec()
    if hypothesis.key == YAW:
        title, fact, reading, remedy = _about_z(float(np.degrees(vector[2])) % 360)
    else:
        axis = vector / max(float(np.linalg.norm(vector)), 1e-12)
        words = ", ".join(f"{value:.2f}" for value in axis + 0.0)
        angle = f"{np.degrees(np.linalg.norm(vector)):.1f}°"
        title = f"sensor turned by {angle} on the flange"
        fact = f"The sensor is turned by {angle} about its axis ({words}) on the flange"
        reading = "the orientations turned so"
        remedy = "Run calibrate --estimate-mount, or correct the sensor's mounting."
    return replace(hypothesis, title=title, fact=fact, reading=reading, remedy=remedy, R_WS=evidence.R_WS)


def _about_z(degrees: float) -> tuple[str, str, str, str]:
    """Return title, fact, reading and remedy of a sensor that is turned about its z axis."""
    angle = f"{degrees:.4g}°"
    return (
        f"sensor turned by {angle} about z on the flange",
        f"The sensor is turned by {angle} about its z axis on the flange",
        f"the orientations turned by {angle} about the sensor's z axis",
        f"Correct the sensor's mounting: R_WS becomes R_WS · Rz({angle}).",
    )


def _gravity(down_W: NDArray[np.float64], name: str) -> tuple[str, str, str, str]:
    """Return title, fact, reading and remedy of gravity in another direction."""
    option = ",".join(f"{value:.3g}" for value in down_W + 0.0)
    remedy = (
        "If the robot hangs from a ceiling or a wall, or the orientations are those of another frame,"
        f" pass --down {option}."
    )
    return (
        f"gravity along {name} of the world",
        f"Gravity points along {name} of the world frame",
        "gravity there",
        remedy,
    )
